//! The pins of all parts in one list.
//!
//! Each pin is named twice: by its port, whose type the compiler checks, and by its signal in
//! `robots/samsung-sr8730/pinout.toml`. If the two disagree, this file does not compile.

use cordlib::board::Board;
use pic32mx3_hal::Peripherals;
use pic32mx3_hal::gpio::Level::{High, Low};
use pic32mx3_hal::pwm::PwmTimer;
use pic32mx3_hal::timer::Prescaler;

use super::bus_clock::BusClock;
use super::charger::PackCharger;
use super::checks::SelfChecks;
use super::cleaners::{BrushMain, Switched};
use super::contacts::{Adapter, BumperContacts, ButtonLines, DropSwitches, DustBoxSwitch};
use super::encoders::{EncoderLines, WheelEncoders};
use super::interlock::InterlockedMotor;
use super::kept::KeptCopies;
use super::link::BoardLink;
#[cfg(feature = "link-i2c")]
use super::link::i2c::I2cParts;
#[cfg(feature = "link-spi")]
use super::link::spi::SpiParts;
#[cfg(serial_link)]
use super::link::uart::InputParts;
use super::panel::{DisplayPins, LightPins, PanelLights, SoundPins, Speaker};
use super::probe::RawReadings;
use super::receivers::{BeamReceivers, ReceiverPins};
use super::resets::{Starts, Supervised};
use super::sensing::{CliffReceivers, ProximityReceivers, WheelCurrents};
use super::serial::{GyroModule, SerialParts, SerialPorts};
use super::tick::TickClock;
use super::wheels::Wheels;
use super::{Sr8730, converter};
use crate::calibration::{Calibration, CliffEmitters};
use crate::generated::pins::{self, Signal};
use crate::logic::bridge::PERIOD_COUNTS;

/// A pin by its port, if that is where the signal is.
macro_rules! pin {
    ($pins:ident.$field:ident is $signal:ident) => {{
        const _: () = assert!(
            is_on(pins::$signal, stringify!($field)),
            "the signal is on another pin"
        );
        $pins.$field
    }};
}

/// A pin that keeps the state it was given, without an owner.
fn leave<P>(_pin: P) {}

/// Whether a signal is on a pin that is named as `rg9`.
const fn is_on(signal: Signal, name: &str) -> bool {
    let digits = match *name.as_bytes() {
        [b'r', port, ref digits @ ..] if port == b'a' + signal.port.index() as u8 => digits,
        _ => return false,
    };
    match *digits {
        [ones] => ones - b'0' == signal.bit,
        [tens, ones] => 10 * (tens - b'0') + ones - b'0' == signal.bit,
        _ => false,
    }
}

// The groups of the list are macros, because the parts of a struct can be moved out only within one function.

/// Everything with a motor. Timer3 is the common 20 kHz time base of all motors and the charger: no code stops it or
/// changes its period.
macro_rules! motors {
    ($chip:ident, $p:ident, $time:ident, $calibration:ident) => {
        (
            Wheels::take(
                (
                    $time.channel($chip.compare1, pin!($p.rd0 is WHEEL_LEFT_ENABLE).into_output(Low)),
                    pin!($p.rc1 is WHEEL_LEFT_PHASE).into_output(Low),
                ),
                (
                    $time.channel($chip.compare4, pin!($p.rd3 is WHEEL_RIGHT_ENABLE).into_output(Low)),
                    pin!($p.rg7 is WHEEL_RIGHT_PHASE).into_output(Low),
                ),
                (
                    pin!($p.re7 is WHEEL_LEFT_MODE).into_output(High),
                    pin!($p.rg6 is WHEEL_RIGHT_MODE).into_output(High),
                ),
            ),
            BrushMain::take(
                $time.channel($chip.compare2, pin!($p.rd1 is BRUSH_MAIN_ENABLE).into_output(Low)),
                pin!($p.rc2 is BRUSH_MAIN_PHASE).into_output(Low),
                pin!($p.rc3 is BRUSH_MAIN_DECAY).into_output(Low),
                $calibration.brush_gives_pulses(),
            ),
            Switched::take(pin!($p.ra4 is BRUSH_SIDES).into_output(Low), InterlockedMotor::BrushSides),
            Switched::take(pin!($p.rd5 is VACUUM).into_output(Low), InterlockedMotor::Vacuum),
        )
    };
}

/// The converter's pins stay analog; the lines of the sensors' multiplexers are moved by its interrupt.
macro_rules! converter {
    ($chip:ident, $p:ident) => {{
        leave(pin!($p.rb0 is BUTTON_LADDER).into_analog());
        leave(pin!($p.rb2 is CHARGER_VOLTAGE).into_analog());
        leave(pin!($p.rb3 is BATTERY_VOLTAGE).into_analog());
        leave(pin!($p.rb4 is BATTERY_THERMISTOR).into_analog());
        leave(pin!($p.rb8 is CLIFF_RIGHT).into_analog());
        leave(pin!($p.rb10 is CLIFF_MIDDLE).into_analog());
        leave(pin!($p.rb11 is CLIFF_LEFT).into_analog());
        leave(pin!($p.rb12 is PROXIMITY_RECEIVE).into_analog());
        leave(pin!($p.rb13 is WHEEL_RIGHT_CURRENT).into_analog());
        leave(pin!($p.rb14 is WHEEL_LEFT_CURRENT).into_analog());
        leave(pin!($p.rd15 is PROXIMITY_SELECT_A).into_output(Low));
        leave(pin!($p.rd14 is PROXIMITY_SELECT_B).into_output(Low));
        leave(pin!($p.rb15 is PROXIMITY_SELECT_C).into_output(Low));
        leave(pin!($p.rd12 is PROXIMITY_EMIT).into_output(Low));
        converter::take($chip.adc)
    }};
}

/// Switches, encoders, and the receivers of the dock's beams.
macro_rules! feelers {
    ($chip:ident, $p:ident, $calibration:ident) => {
        (
            WheelEncoders::take(
                EncoderLines {
                    capture1: ($chip.capture1, pin!($p.rd8 is WHEEL_LEFT_ENCODER_1).into_input()),
                    capture2: ($chip.capture2, pin!($p.rd9 is WHEEL_LEFT_ENCODER_2).into_input()),
                    capture3: ($chip.capture3, pin!($p.rd10 is WHEEL_RIGHT_ENCODER_2).into_input()),
                    capture4: ($chip.capture4, pin!($p.rd11 is WHEEL_RIGHT_ENCODER_1).into_input()),
                },
                $calibration,
            ),
            BumperContacts {
                left: pin!($p.rg9 is BUMPER_LEFT).into_input(),
                right: pin!($p.rg15 is BUMPER_RIGHT).into_input(),
            },
            DropSwitches {
                left: pin!($p.rd6 is WHEEL_DROP_LEFT).into_input(),
                right: pin!($p.rd7 is WHEEL_DROP_RIGHT).into_input(),
            },
            BeamReceivers::take(
                ReceiverPins {
                    dock_left: pin!($p.ra14 is DOCK_RECEIVER_LEFT).into_input(),
                    dock_right: pin!($p.ra15 is DOCK_RECEIVER_RIGHT).into_input(),
                    #[cfg(not(feature = "link-spi"))]
                    rear_left: pin!($p.rf6 is REAR_RECEIVER_LEFT).into_input(),
                    rear_right: pin!($p.re8 is REAR_RECEIVER_RIGHT).into_input(),
                },
                $calibration.beams(),
            ),
        )
    };
}

/// Lights, display and sound.
macro_rules! panel {
    ($chip:ident, $p:ident, $unknown_supply:ident) => {{
        let tone_time = Speaker::time_base($chip.timer2);
        let tone = tone_time.channel($chip.compare5, pin!($p.rd4 is SOUND_TONE).into_output(Low));
        let sound = SoundPins {
            select: (
                pin!($p.ra1 is SOUND_SELECT_A).into_output(Low),
                pin!($p.rf13 is SOUND_SELECT_B).into_output(Low),
                pin!($p.rc4 is SOUND_SELECT_C).into_output(Low),
            ),
            enable: pin!($p.rd13 is SOUND_ENABLE).into_output(Low),
        };
        let lights = LightPins {
            lines: [
                pin!($p.re2 is LIGHT_LINE_0).into_output(Low).erase(),
                pin!($p.re3 is LIGHT_LINE_1).into_output(Low).erase(),
                pin!($p.re4 is LIGHT_LINE_2).into_output(Low).erase(),
                pin!($p.re5 is LIGHT_LINE_3).into_output(Low).erase(),
                pin!($p.re6 is LIGHT_LINE_4).into_output(Low).erase(),
            ],
            main: pin!($p.ra6 is LIGHT_SUPPLY_MAIN).into_output(Low),
            battery: pin!($p.rg1 is LIGHT_SUPPLY_BATTERY).into_output(Low),
            unknown: $unknown_supply,
            display: DisplayPins {
                commons: [
                    pin!($p.ra7 is DISPLAY_DIGIT_1).into_output(Low).erase(),
                    pin!($p.rg14 is DISPLAY_DIGIT_2).into_output(Low).erase(),
                    pin!($p.rg13 is DISPLAY_DIGIT_3).into_output(Low).erase(),
                    pin!($p.rg12 is DISPLAY_DIGIT_4).into_output(Low).erase(),
                ],
                segments: [
                    pin!($p.re0 is DISPLAY_SEGMENT_A).into_output(Low).erase(),
                    pin!($p.re1 is DISPLAY_SEGMENT_B).into_output(Low).erase(),
                ],
                colon: pin!($p.rf1 is DISPLAY_COLON).into_output(Low),
            },
        };
        (Speaker::take(tone_time, tone, sound), PanelLights::take(lights))
    }};
}

/// The link's input.
#[cfg(all(serial_link, not(feature = "link-sampled")))]
macro_rules! link_input {
    ($chip:ident, $p:ident) => {
        InputParts {
            receive: pin!($p.rc13 is LINK_RECEIVE).into_input(),
            brush: pin!($p.rb5 is BRUSH_MAIN_ENCODER).into_input(),
            notice: $chip.change_notice,
        }
    };
}

/// The link's input, sampled.
#[cfg(feature = "link-sampled")]
macro_rules! link_input {
    ($chip:ident, $p:ident) => {
        InputParts {
            receive: pin!($p.rb6 is LINK_RECEIVE_SAMPLED).into_input(),
            brush: pin!($p.rb5 is BRUSH_MAIN_ENCODER).into_input(),
            notice: $chip.change_notice,
            timer: $chip.timer5,
        }
    };
}

/// The serial link.
#[cfg(serial_link)]
macro_rules! link {
    ($chip:ident, $p:ident) => {{
        #[cfg(feature = "link-rs485")]
        leave(pin!($p.rg2 is SPARE_RG2).into_output(Low));
        BoardLink::take(
            link_input!($chip, $p),
            pin!($p.rb7 is LINK_TRANSMIT).into_output(High),
            $chip.timer4,
        )
    }};
}

/// The link by SPI.
#[cfg(feature = "link-spi")]
macro_rules! link {
    ($chip:ident, $p:ident) => {
        BoardLink::take(SpiParts {
            spi: $chip.spi1,
            pins: (
                pin!($p.rf6 is REAR_RECEIVER_LEFT).into_input(),
                pin!($p.rf8 is SPARE_RF8).into_output(Low),
                pin!($p.rf7 is GYRO_POWER).into_input(),
            ),
            select: pin!($p.rc13 is LINK_RECEIVE).into_input(),
            attention: pin!($p.rb7 is LINK_TRANSMIT).into_output(Low),
            brush: pin!($p.rb5 is BRUSH_MAIN_ENCODER).into_input(),
            notice: $chip.change_notice,
        })
    };
}

/// The link by I2C.
#[cfg(feature = "link-i2c")]
macro_rules! link {
    ($chip:ident, $p:ident) => {
        BoardLink::take(I2cParts {
            i2c: $chip.i2c1,
            lines: (
                pin!($p.rg3 is SPARE_RG3).into_input(),
                pin!($p.rg2 is SPARE_RG2).into_input(),
            ),
            attention: pin!($p.rb7 is LINK_TRANSMIT).into_output(Low),
            brush: pin!($p.rb5 is BRUSH_MAIN_ENCODER).into_input(),
            notice: $chip.change_notice,
        })
    };
}

/// The switch of the gyro module.
#[cfg(not(feature = "link-spi"))]
macro_rules! gyro_switch {
    ($p:ident) => {
        pin!($p.rf7 is GYRO_POWER).into_output(High)
    };
}

/// The switch of the gyro module, whose pin the link has.
#[cfg(feature = "link-spi")]
macro_rules! gyro_switch {
    ($p:ident) => {
        super::serial::GyroSwitch
    };
}

/// The second clock of the self-checks.
#[cfg(not(feature = "link-sampled"))]
macro_rules! bus_clock {
    ($chip:ident) => {
        BusClock::take($chip.timer5)
    };
}

/// The second clock of the self-checks, whose timer the link has.
#[cfg(feature = "link-sampled")]
macro_rules! bus_clock {
    ($chip:ident) => {
        BusClock
    };
}

/// The serial lines.
macro_rules! lines {
    ($chip:ident, $p:ident, $calibration:ident) => {
        (
            SerialPorts::take(
                SerialParts {
                    uart1: ($chip.uart1, pin!($p.rf2 is UART1_RECEIVE).into_input()),
                    uart2: ($chip.uart2, pin!($p.rf4 is UART2_RECEIVE).into_input()),
                    power: gyro_switch!($p),
                },
                $calibration.gyro(),
            ),
            link!($chip, $p),
        )
    };
}

/// Builds the board from the chip's peripherals. Everything is off; interrupts have their levels but are not enabled
/// yet. The start-up code has set level and direction of every output already; here they only get their owners.
#[must_use]
pub fn assemble(chip: Peripherals, calibration: &Calibration, starts: Starts) -> Board<Sr8730> {
    let p = chip.pins;
    let motor_time = PwmTimer::timer3(chip.timer3, Prescaler::By1, u32::from(PERIOD_COUNTS));
    let (wheels, brush_main, brush_sides, vacuum) = motors!(chip, p, motor_time, calibration);
    let gate = motor_time.channel(chip.compare3, pin!(p.rd2 is CHARGE_ENABLE).into_output(Low));
    let adapter = pin!(p.rb1 is ADAPTER).into_input();
    let charger = PackCharger::take(gate, chip.timer1, calibration);
    let (encoders, bumpers, wheel_drops, dock_beams) = feelers!(chip, p, calibration);
    let supply = pin!(p.rg0 is LIGHT_SUPPLY_UNKNOWN).into_output(Low);
    let (emitters, unknown_supply) = match calibration.cliffs().map(|known| known.emitters) {
        Some(CliffEmitters::Switched) => (Some(supply), None),
        Some(CliffEmitters::AlwaysLit(_)) | None => (None, Some(supply)),
    };
    let (beeper, lights) = panel!(chip, p, unknown_supply);
    let (ports, link) = lines!(chip, p, calibration);
    let (scanner, channels) = converter!(chip, p);
    let gyro = GyroModule::take(ports.gyro());
    Board {
        clock: TickClock::take(chip.core_timer, scanner, channels),
        link,
        wheels,
        reset: starts,
        watchdog: Supervised::take(chip.watchdog),
        kept: KeptCopies,
        checks: SelfChecks::take(bus_clock!(chip), &motor_time),
        encoders,
        bumpers,
        cliffs: CliffReceivers::take(emitters, calibration),
        wheel_drops,
        proximity: ProximityReceivers::take(calibration.proximity()),
        gyro,
        currents: WheelCurrents::take(calibration.currents()),
        brush_main,
        brush_sides,
        vacuum,
        charger,
        dock_contacts: Adapter { pin: adapter },
        dock_beams,
        dust_box: DustBoxSwitch {
            pin: pin!(p.rf0 is DUST_BOX).into_input(),
        },
        beeper,
        lights,
        buttons: ButtonLines::take(pin!(p.re9 is BUTTON_ANY).into_input(), calibration.ladder()),
        probe: RawReadings::take(ports),
    }
}

#[cfg(test)]
mod tests {
    use super::is_on;
    use crate::generated::pins;

    #[test]
    fn names_of_pins_are_compared_whole() {
        assert!(is_on(pins::BUMPER_LEFT, "rg9") && is_on(pins::BUMPER_RIGHT, "rg15"));
        for wrong in ["rg1", "rg5", "rf15", "g15", "rg", "rg150", ""] {
            assert!(!is_on(pins::BUMPER_RIGHT, wrong), "{wrong}");
        }
    }
}
