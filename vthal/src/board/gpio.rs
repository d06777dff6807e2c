//! Lines of a GPIO chip, through the kernel's character device.

use std::time::Duration;

use gpiocdev::Request;
use gpiocdev::line::{EdgeDetection, Value, Values};
use vthal_core::Lights;

use super::{BoardLines, BoardSettings, LinesError, PressedLevel};

/// How long a contact must rest before it counts.
const DEBOUNCE: Duration = Duration::from_millis(10);
/// What the kernel shows as the user of the lines.
const CONSUMER: &str = "vthal";

const BUTTONS: &str = "buttons";
const LIGHTS: &str = "lights";

/// The lines of buttons and lights, held as long as this lives.
#[derive(Debug)]
pub(super) struct GpioLines {
    buttons: Option<Request>,
    button_lines: Vec<u32>,
    lights: Option<Request>,
    settings: BoardSettings,
}

impl GpioLines {
    /// Takes the lines.
    pub(super) fn open(settings: &BoardSettings) -> Result<Self, LinesError> {
        let refused = |what| {
            let chip = settings.chip.clone();
            move |error: gpiocdev::Error| LinesError::Refused {
                what,
                chip,
                reason: error.to_string(),
            }
        };
        let buttons = match settings.buttons.as_slice() {
            [] => None,
            lines => Some(request_buttons(settings, lines).map_err(refused(BUTTONS))?),
        };
        let light_lines: Vec<u32> = settings
            .lights
            .pairs(Lights::default())
            .map(|(line, _)| line)
            .collect();
        let lights = match light_lines.as_slice() {
            [] => None,
            lines => {
                let mut builder = Request::builder();
                builder.on_chip(&settings.chip).with_consumer(CONSUMER);
                builder.with_lines(lines).as_output(Value::Inactive);
                Some(builder.request().map_err(refused(LIGHTS))?)
            }
        };
        Ok(Self {
            buttons,
            button_lines: settings.buttons.clone(),
            lights,
            settings: settings.clone(),
        })
    }
}

fn request_buttons(settings: &BoardSettings, lines: &[u32]) -> gpiocdev::Result<Request> {
    let mut builder = Request::builder();
    builder.on_chip(&settings.chip).with_consumer(CONSUMER);
    builder.with_lines(lines).as_input();
    match settings.pressed {
        PressedLevel::Low => builder.as_active_low(),
        PressedLevel::High => builder.as_active_high(),
    };
    builder
        .with_edge_detection(EdgeDetection::BothEdges)
        .with_debounce_period(DEBOUNCE);
    builder.request()
}

impl BoardLines for GpioLines {
    fn buttons(&mut self, at_most: Duration) -> Result<u8, LinesError> {
        let lost = |error: gpiocdev::Error| LinesError::Lost {
            what: BUTTONS,
            reason: error.to_string(),
        };
        let Some(request) = &self.buttons else {
            std::thread::sleep(at_most);
            return Ok(0);
        };
        // The edges only wake; what counts is how the lines are afterwards.
        if request.wait_edge_event(at_most).map_err(lost)? {
            request.read_edge_event().map_err(lost)?;
        }
        let mut values = Values::from_offsets(&self.button_lines);
        request.values(&mut values).map_err(lost)?;
        let bits = self
            .button_lines
            .iter()
            .enumerate()
            .map(|(button, line)| u8::from(values.get(*line) == Some(Value::Active)) << button);
        Ok(bits.fold(0, |all, bit| all | bit))
    }

    fn show(&mut self, lights: Lights) -> Result<(), LinesError> {
        let lost = |error: gpiocdev::Error| LinesError::Lost {
            what: LIGHTS,
            reason: error.to_string(),
        };
        let Some(request) = &self.lights else {
            return Ok(());
        };
        let mut values = Values::default();
        for (line, is_on) in self.settings.lights.pairs(lights) {
            values.set(line, if is_on { Value::Active } else { Value::Inactive });
        }
        request.set_values(&values).map_err(lost)
    }
}
