//! The wheels' bridges (A3950) and the main brush's (DRV8840).

use cordlib::board::{WheelDrive, WheelMotors};
use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::gpio::{Output, Pin};
use pic32mx3_hal::pwm::PwmChannel;
use rvac_units::Throttle;

use super::interlock::InterlockedMotor;
use crate::logic::bridge::{BridgeLines, BridgeSequence, MotorDirection};
use crate::logic::renewal::Renewal;

/// A bridge with ENABLE and PHASE.
#[derive(Debug)]
pub struct MotorBridge<E, P> {
    enable: E,
    phase: P,
    forward: Level,
    motor: InterlockedMotor,
    sequence: BridgeSequence,
    written: BridgeLines,
}

impl<E: SetDutyCycle, P: OutputPin> MotorBridge<E, P> {
    /// Braking. `forward` is the level of PHASE for forward.
    #[must_use]
    pub fn new(enable: E, phase: P, forward: Level, motor: InterlockedMotor) -> Self {
        let mut bridge = Self {
            enable,
            phase,
            forward,
            motor,
            sequence: BridgeSequence::new(),
            written: BridgeLines {
                compare: 0,
                turn: MotorDirection::Backward,
            },
        };
        bridge.write(BridgeLines::default());
        bridge
    }

    /// Takes a new duty.
    pub fn command(&mut self, duty: Throttle) {
        let lines = self.sequence.command(duty);
        self.write(lines);
    }

    /// Called once a millisecond: the second half of a reversal.
    pub fn service(&mut self) {
        let lines = self.sequence.service();
        self.write(lines);
    }

    /// Writes width and direction in a safe order: PHASE changes only while the width is 0, and the width is written
    /// last.
    fn write(&mut self, lines: BridgeLines) {
        if lines.compare != 0 {
            self.motor.note(true);
        }
        if lines.turn != self.written.turn {
            let level = match lines.turn {
                MotorDirection::Forward => self.forward,
                MotorDirection::Backward => self.forward.inverted(),
            };
            // Pins of this chip cannot fail.
            match level {
                Level::High => self.phase.set_high().ok(),
                Level::Low => self.phase.set_low().ok(),
            };
        }
        self.enable.set_duty_cycle(lines.compare).ok();
        self.written = lines;
        if lines.compare == 0 {
            self.motor.note(false);
        }
    }
}

/// ENABLE of the left wheel: RD0, OC1 on Timer3.
pub type LeftEnable = PwmChannel<1, 3, Pin<'D', 0, Output>>;
/// ENABLE of the right wheel: RD3, OC4 on Timer3.
pub type RightEnable = PwmChannel<4, 3, Pin<'D', 3, Output>>;

/// Both wheels.
#[derive(Debug)]
pub struct Wheels {
    left: MotorBridge<LeftEnable, Pin<'C', 1, Output>>,
    right: MotorBridge<RightEnable, Pin<'G', 7, Output>>,
    renewal: Renewal,
}

/// Lines that hold a wheel's bridge in the mode in which it brakes in the off-time. They never change.
pub type LeftMode = Pin<'E', 7, Output>;
/// See [`LeftMode`].
pub type RightMode = Pin<'G', 6, Output>;

impl Wheels {
    /// The left wheel drives forward with PHASE low, the right one, which is mirrored, with PHASE high.
    #[must_use]
    pub fn take(
        (left_enable, left_phase): (LeftEnable, Pin<'C', 1, Output>),
        (right_enable, right_phase): (RightEnable, Pin<'G', 7, Output>),
        (mut left_mode, mut right_mode): (LeftMode, RightMode),
    ) -> Self {
        left_mode.set_high();
        right_mode.set_high();
        Self {
            left: MotorBridge::new(left_enable, left_phase, Level::Low, InterlockedMotor::WheelLeft),
            right: MotorBridge::new(
                right_enable,
                right_phase,
                Level::High,
                InterlockedMotor::WheelRight,
            ),
            renewal: Renewal::default(),
        }
    }

    /// Called once a millisecond. Brakes if the drive was not renewed for 50 ms.
    pub fn service(&mut self) {
        if self.renewal.is_overdue() {
            self.left.command(Throttle::ZERO);
            self.right.command(Throttle::ZERO);
        }
        self.left.service();
        self.right.service();
    }
}

impl WheelMotors for Wheels {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        self.renewal.renew();
        self.left.command(left.duty());
        self.right.command(right.duty());
    }
}

#[cfg(test)]
mod tests {
    use super::MotorBridge;
    use crate::board::interlock::InterlockedMotor;
    use core::cell::RefCell;
    use core::convert::Infallible;
    use embedded_hal::digital::{self, OutputPin};
    use embedded_hal::pwm::{self, SetDutyCycle};
    use pic32mx3_hal::gpio::Level;
    use rvac_units::Throttle;

    /// What the lines carry, and whether PHASE ever changed while ENABLE had a width.
    #[derive(Debug, Default)]
    struct Lines {
        width: u16,
        phase: bool,
        changes_under_current: u32,
    }

    #[derive(Debug)]
    struct Enable<'a>(&'a RefCell<Lines>);
    #[derive(Debug)]
    struct Phase<'a>(&'a RefCell<Lines>);

    impl pwm::ErrorType for Enable<'_> {
        type Error = Infallible;
    }

    impl SetDutyCycle for Enable<'_> {
        fn max_duty_cycle(&self) -> u16 {
            4_000
        }

        fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
            self.0.borrow_mut().width = duty;
            Ok(())
        }
    }

    impl digital::ErrorType for Phase<'_> {
        type Error = Infallible;
    }

    impl OutputPin for Phase<'_> {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.set(false)
        }

        fn set_high(&mut self) -> Result<(), Infallible> {
            self.set(true)
        }
    }

    impl Phase<'_> {
        fn set(&mut self, high: bool) -> Result<(), Infallible> {
            let mut lines = self.0.borrow_mut();
            if lines.phase != high && lines.width != 0 {
                lines.changes_under_current += 1;
            }
            lines.phase = high;
            Ok(())
        }
    }

    fn duty(millionths: i32) -> Throttle {
        Throttle::from_millionths(millionths).unwrap()
    }

    #[test]
    fn forward_is_the_level_that_the_wiring_says() {
        for (forward, phase) in [(Level::Low, false), (Level::High, true)] {
            let lines = RefCell::default();
            let mut bridge = MotorBridge::new(
                Enable(&lines),
                Phase(&lines),
                forward,
                InterlockedMotor::WheelLeft,
            );
            bridge.command(duty(500_000));
            assert_eq!((lines.borrow().width, lines.borrow().phase), (2_000, phase));
            bridge.command(duty(-500_000));
            assert_eq!(lines.borrow().width, 0);
            bridge.service();
            bridge.service();
            assert_eq!((lines.borrow().width, lines.borrow().phase), (2_000, !phase));
        }
    }

    #[test]
    fn no_order_of_commands_changes_phase_while_the_line_has_a_width() {
        let lines = RefCell::default();
        let mut bridge = MotorBridge::new(
            Enable(&lines),
            Phase(&lines),
            Level::High,
            InterlockedMotor::WheelRight,
        );
        let mut seed = 11_u32;
        for _ in 0..50_000 {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            match seed >> 30 {
                0 => bridge.command(duty((seed >> 10) as i32 % 1_000_001)),
                1 => bridge.command(duty(-((seed >> 10) as i32 % 1_000_001))),
                _ => bridge.service(),
            }
        }
        assert_eq!(lines.borrow().changes_under_current, 0);
    }
}
