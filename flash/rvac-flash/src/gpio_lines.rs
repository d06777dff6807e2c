//! Three lines of a GPIO chip as the lines to the programming port.

use std::time::{Duration, Instant};

use gpiocdev::Request;
use gpiocdev::line::{Direction, Value};
use gpiocdev::request::Config;
use pic32_icsp::{IcspPins, LineLevel};

use crate::settings::IcspLines;

/// The lines, held as long as this lives. When it ends, the kernel makes them inputs: the board's resistor ends the reset.
#[derive(Debug)]
pub(crate) struct GpioLines {
    request: Request,
    lines: IcspLines,
    /// What is set now, so that nothing is set twice: each is a call of the kernel.
    clock: Option<LineLevel>,
    data: Option<LineLevel>,
    reset: LineLevel,
    half: Duration,
    turned: Instant,
    begun: Instant,
}

impl GpioLines {
    /// Takes the lines, all as inputs: the robot does not notice.
    pub(crate) fn open(lines: &IcspLines) -> gpiocdev::Result<Self> {
        let mut builder = Request::builder();
        builder.on_chip(&lines.chip).with_consumer("rvac flash");
        builder
            .with_lines(&[lines.reset, lines.clock, lines.data])
            .as_input();
        let now = Instant::now();
        Ok(Self {
            request: builder.request()?,
            half: Duration::from_nanos(500_000_000 / u64::from(lines.clock_hz.max(1))),
            lines: lines.clone(),
            clock: None,
            data: None,
            reset: LineLevel::High,
            turned: now,
            begun: now,
        })
    }

    /// Sets directions and levels of all three lines.
    fn configure(&self) -> gpiocdev::Result<()> {
        let mut config = Config::default();
        let outputs = [
            // An open drain: high lets go.
            (
                self.lines.reset,
                Some(self.reset).filter(|level| !level.is_high()),
            ),
            (self.lines.clock, self.clock),
            (self.lines.data, self.data),
        ];
        for (line, level) in outputs {
            config.with_line(line);
            match level {
                Some(level) => config.as_output(value(level)),
                None => config.with_direction(Direction::Input),
            };
        }
        self.request.reconfigure(&config)
    }
}

const fn value(level: LineLevel) -> Value {
    match level {
        LineLevel::Low => Value::Inactive,
        LineLevel::High => Value::Active,
    }
}

impl IcspPins for GpioLines {
    type Error = gpiocdev::Error;

    fn set_reset(&mut self, level: LineLevel) -> Result<(), gpiocdev::Error> {
        if self.reset == level {
            return Ok(());
        }
        self.reset = level;
        self.configure()
    }

    fn set_clock(&mut self, level: LineLevel) -> Result<(), gpiocdev::Error> {
        let before = self.clock.replace(level);
        while self.turned.elapsed() < self.half {
            std::hint::spin_loop();
        }
        self.turned = Instant::now();
        match before {
            Some(before) if before == level => Ok(()),
            Some(_) => self.request.set_value(self.lines.clock, value(level)).map(|_| ()),
            None => self.configure(),
        }
    }

    fn drive_data(&mut self, level: LineLevel) -> Result<(), gpiocdev::Error> {
        match self.data.replace(level) {
            Some(before) if before == level => Ok(()),
            Some(_) => self.request.set_value(self.lines.data, value(level)).map(|_| ()),
            None => self.configure(),
        }
    }

    fn release_data(&mut self) -> Result<(), gpiocdev::Error> {
        match self.data.take() {
            Some(_) => self.configure(),
            None => Ok(()),
        }
    }

    fn read_data(&mut self) -> Result<LineLevel, gpiocdev::Error> {
        let read = self.request.value(self.lines.data)?;
        Ok(LineLevel::of(read == Value::Active))
    }

    fn pause_us(&mut self, us: u32) {
        std::thread::sleep(Duration::from_micros(us.into()));
    }

    fn now_us(&self) -> u64 {
        u64::try_from(self.begun.elapsed().as_micros()).unwrap_or(u64::MAX)
    }
}
