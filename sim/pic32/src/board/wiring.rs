//! Connections of the pins to the robot's parts.

use super::BoardError;
use super::display::DisplayWiring;
use super::pinout::{Pinout, PinoutSignal, Pull, SignalLevel};
use crate::pins::{Level, Pin, PinDriver};

/// A digital line: its pin, and the level that means "on".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DigitalLine {
    /// Where.
    pub pin: Pin,
    /// Which level is "on".
    pub active: Level,
}

impl DigitalLine {
    pub(super) fn of(pinout: &Pinout, name: &'static str) -> Result<Self, BoardError> {
        Self::of_signal(pinout.signal(name)?).ok_or(BoardError::NoLevel(name))
    }

    /// That of a signal whose active level is known.
    pub(super) fn of_signal(signal: &PinoutSignal) -> Option<Self> {
        let active = match signal.active {
            SignalLevel::High => Level::High,
            SignalLevel::Low => Level::Low,
            SignalLevel::Unknown => return None,
        };
        Some(Self {
            pin: signal.pin,
            active,
        })
    }

    /// The level for this state.
    #[must_use]
    pub const fn level(self, on: bool) -> Level {
        Level::of(on == self.active.is_high())
    }

    /// Whether the chip switches the line on. A line that the chip leaves alone is off: the bridges and transistors
    /// behind the outputs hold it there.
    #[must_use]
    pub fn is_on(self, output: PinDriver) -> bool {
        output == PinDriver::from(self.active)
    }
}

/// A wheel's bridge and encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelPins {
    /// PWM.
    pub enable: DigitalLine,
    /// On = forward.
    pub phase: DigitalLine,
    /// On = brake in the off-time.
    pub mode: DigitalLine,
    /// The two encoder lines.
    pub encoder: [Pin; 2],
    /// Number of the analog input of the current.
    pub current: u8,
}

/// All pins that end in something of the simulated robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// Left and right.
    pub wheels: [WheelPins; 2],
    /// PWM of the main brush.
    pub brush_enable: DigitalLine,
    /// On = forward.
    pub brush_phase: DigitalLine,
    /// Pulses of the turning brush.
    pub brush_encoder: DigitalLine,
    /// Side brushes.
    pub brush_sides: DigitalLine,
    /// Suction.
    pub vacuum: DigitalLine,
    /// Left and right half.
    pub bumpers: [DigitalLine; 2],
    /// Left and right wheel.
    pub wheel_drops: [DigitalLine; 2],
    /// On = the box is in.
    pub dust_box: DigitalLine,
    /// On while any button is pressed.
    pub button_any: DigitalLine,
    /// Analog input of the ladder.
    pub button_ladder: u8,
    /// Analog inputs of the cliff sensors: left, middle, right.
    pub cliffs: [u8; 3],
    /// What may light the cliff sensors' emitters.
    pub cliff_emitters: DigitalLine,
    /// Select lines of the sensor multiplexers, bit 0 first.
    pub sensor_select: [DigitalLine; 3],
    /// Common of the transmit multiplexer.
    pub emit: DigitalLine,
    /// Analog input of the receive multiplexer's common.
    pub receive: u8,
    /// 38 kHz receivers: dock left, dock right, rear left, rear right. On while they receive a carrier.
    pub beam_receivers: [DigitalLine; 4],
    /// On while the contacts or the adapter carry voltage.
    pub adapter: DigitalLine,
    /// The charging switch.
    pub charge: DigitalLine,
    /// Analog input of the charger's side of the shunt.
    pub charger_volts: u8,
    /// Analog input of the battery.
    pub battery_volts: u8,
    /// Analog input of the thermistor.
    pub thermistor: u8,
    /// Supplies of the light groups: main, battery, unknown.
    pub light_supplies: [DigitalLine; 3],
    /// Light lines 0 to 4.
    pub light_lines: [DigitalLine; 5],
    /// A display, which is fitted on sisters of the robot.
    pub display: DisplayWiring,
    /// Select lines of the sound multiplexer, bit 0 first.
    pub sound_select: [DigitalLine; 3],
    /// Tone.
    pub sound_tone: DigitalLine,
    /// Amplifier.
    pub sound_enable: DigitalLine,
    /// Serial line from the host: it reaches both inputs, and the firmware listens on one of them.
    pub link_receive: [DigitalLine; 2],
    /// Serial line to the host.
    pub link_transmit: DigitalLine,
    /// Power of the gyro module.
    pub gyro_power: DigitalLine,
    /// Inputs of the two hardware UARTs.
    pub uart_receive: [Pin; 2],
    /// Pins that a resistor holds at the supply.
    pub pulled_up: Vec<Pin>,
}

fn analog(pinout: &Pinout, name: &'static str) -> Result<u8, BoardError> {
    pinout
        .signal(name)?
        .pin
        .analog()
        .ok_or(BoardError::NotAnalog(name))
}

fn cliffs(pinout: &Pinout) -> Result<[u8; 3], BoardError> {
    Ok([
        analog(pinout, "cliff-left")?,
        analog(pinout, "cliff-middle")?,
        analog(pinout, "cliff-right")?,
    ])
}

fn pulled_up(pinout: &Pinout) -> Vec<Pin> {
    let by_board = pinout.signals().filter(|signal| signal.pull == Pull::BoardUp);
    by_board.map(|signal| signal.pin).collect()
}

fn lines<const N: usize>(pinout: &Pinout, names: [&'static str; N]) -> Result<[DigitalLine; N], BoardError> {
    let mut lines = Vec::with_capacity(N);
    for name in names {
        lines.push(DigitalLine::of(pinout, name)?);
    }
    // As many lines as names went in.
    lines.try_into().map_err(|_| BoardError::NoSignal("signal"))
}

fn wheel(pinout: &Pinout, names: [&'static str; 6]) -> Result<WheelPins, BoardError> {
    let [enable, phase, mode, encoder_1, encoder_2, current] = names;
    Ok(WheelPins {
        enable: DigitalLine::of(pinout, enable)?,
        phase: DigitalLine::of(pinout, phase)?,
        mode: DigitalLine::of(pinout, mode)?,
        encoder: [pinout.signal(encoder_1)?.pin, pinout.signal(encoder_2)?.pin],
        current: analog(pinout, current)?,
    })
}

const LEFT: [&str; 6] = [
    "wheel-left-enable",
    "wheel-left-phase",
    "wheel-left-mode",
    "wheel-left-encoder-1",
    "wheel-left-encoder-2",
    "wheel-left-current",
];
const RIGHT: [&str; 6] = [
    "wheel-right-enable",
    "wheel-right-phase",
    "wheel-right-mode",
    "wheel-right-encoder-1",
    "wheel-right-encoder-2",
    "wheel-right-current",
];

impl Wiring {
    /// Looks up every signal that the simulated robot needs.
    ///
    /// # Errors
    /// The first signal that is missing or does not fit.
    pub fn of(pinout: &Pinout) -> Result<Self, BoardError> {
        let line = |name| DigitalLine::of(pinout, name);
        Ok(Self {
            wheels: [wheel(pinout, LEFT)?, wheel(pinout, RIGHT)?],
            brush_enable: line("brush-main-enable")?,
            brush_phase: line("brush-main-phase")?,
            brush_encoder: line("brush-main-encoder")?,
            brush_sides: line("brush-sides")?,
            vacuum: line("vacuum")?,
            bumpers: lines(pinout, ["bumper-left", "bumper-right"])?,
            wheel_drops: lines(pinout, ["wheel-drop-left", "wheel-drop-right"])?,
            dust_box: line("dust-box")?,
            button_any: line("button-any")?,
            button_ladder: analog(pinout, "button-ladder")?,
            cliffs: cliffs(pinout)?,
            cliff_emitters: line("light-supply-unknown")?,
            sensor_select: lines(
                pinout,
                ["proximity-select-a", "proximity-select-b", "proximity-select-c"],
            )?,
            emit: line("proximity-emit")?,
            receive: analog(pinout, "proximity-receive")?,
            beam_receivers: lines(
                pinout,
                [
                    "dock-receiver-left",
                    "dock-receiver-right",
                    "rear-receiver-left",
                    "rear-receiver-right",
                ],
            )?,
            adapter: line("adapter")?,
            charge: line("charge-enable")?,
            charger_volts: analog(pinout, "charger-voltage")?,
            battery_volts: analog(pinout, "battery-voltage")?,
            thermistor: analog(pinout, "battery-thermistor")?,
            light_supplies: lines(
                pinout,
                [
                    "light-supply-main",
                    "light-supply-battery",
                    "light-supply-unknown",
                ],
            )?,
            light_lines: lines(
                pinout,
                [
                    "light-line-0",
                    "light-line-1",
                    "light-line-2",
                    "light-line-3",
                    "light-line-4",
                ],
            )?,
            display: DisplayWiring::of(pinout)?,
            sound_select: lines(pinout, ["sound-select-a", "sound-select-b", "sound-select-c"])?,
            sound_tone: line("sound-tone")?,
            sound_enable: line("sound-enable")?,
            link_receive: lines(pinout, ["link-receive", "link-receive-sampled"])?,
            link_transmit: line("link-transmit")?,
            gyro_power: line("gyro-power")?,
            pulled_up: pulled_up(pinout),
            uart_receive: [
                pinout.signal("uart1-receive")?.pin,
                pinout.signal("uart2-receive")?.pin,
            ],
        })
    }
}

/// The number that the select lines of a multiplexer show, bit 0 first.
#[must_use]
pub fn selected(lines: &[DigitalLine; 3], output: impl Fn(Pin) -> PinDriver) -> u8 {
    lines.iter().rev().fold(0, |number, line| {
        number << 1 | u8::from(line.is_on(output(line.pin)))
    })
}

#[cfg(test)]
mod tests {
    use super::{DigitalLine, Wiring, selected};
    use crate::board::BoardError;
    use crate::board::pinout::Pinout;
    use crate::pins::{Level, PinDriver};

    #[test]
    fn every_part_of_the_robot_has_its_pin() {
        let wiring = Wiring::of(&Pinout::sr8730().unwrap()).unwrap();
        // From the table of the board, by hand.
        assert_eq!(wiring.wheels[0].enable.pin.to_string(), "RD0");
        assert_eq!(
            wiring.wheels[1].encoder.map(|pin| pin.to_string()),
            ["RD11", "RD10"]
        );
        assert_eq!(wiring.cliffs, [11, 10, 8]);
        assert_eq!(wiring.beam_receivers[3].pin.to_string(), "RE8");
        assert_eq!(
            (wiring.wheels[0].phase.active, wiring.wheels[1].phase.active),
            (Level::Low, Level::High)
        );
    }

    #[test]
    fn a_floating_pin_switches_nothing_on() {
        let pin = "RA4".parse().unwrap();
        for active in [Level::Low, Level::High] {
            let line = DigitalLine { pin, active };
            assert!(!line.is_on(PinDriver::Floating));
            assert!(line.is_on(line.level(true).into()));
            assert!(!line.is_on(line.level(false).into()));
        }
    }

    #[test]
    fn select_lines_make_a_number() {
        let wiring = Wiring::of(&Pinout::sr8730().unwrap()).unwrap();
        let [a, b, c] = wiring.sensor_select;
        for (on, number) in [
            (vec![], 0),
            (vec![a], 1),
            (vec![b], 2),
            (vec![a, b], 3),
            (vec![c, b], 6),
        ] {
            let output = |pin| PinDriver::from(Level::of(on.iter().any(|line| line.pin == pin)));
            assert_eq!(selected(&wiring.sensor_select, output), number);
        }
    }

    #[test]
    fn a_missing_signal_is_named() {
        let text =
            include_str!("../../../../robots/samsung-sr8730/pinout.toml").replace("\"vacuum\"", "\"broom\"");
        let error = Wiring::of(&Pinout::parse(&text).unwrap()).unwrap_err();
        assert_eq!(error, BoardError::NoSignal("vacuum"));
    }
}
