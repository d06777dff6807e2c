//! Main brush, side brushes and suction.

use cordlib::board::CleaningMotor;
use embedded_hal::digital::OutputPin;
use pic32mx3_hal::gpio::{Level, Output, Pin};
use pic32mx3_hal::pwm::PwmChannel;
use rvac_units::Throttle;

use super::interlock::InterlockedMotor;
use super::link::brush::brush_pulses;
use super::off;
use super::wheels::MotorBridge;
use crate::logic::renewal::Renewal;

/// A motor with a plain switch runs above this duty, in millionths.
const SWITCH_ON: i32 = 500_000;

/// ENABLE of the main brush: RD1, OC2 on Timer3.
pub type BrushEnable = PwmChannel<2, 3, Pin<'D', 1, Output>>;

/// The main brush.
#[derive(Debug)]
pub struct BrushMain {
    bridge: MotorBridge<BrushEnable, Pin<'C', 2, Output>>,
    renewal: Renewal,
    has_pulses: bool,
}

impl BrushMain {
    /// PHASE low is forward, DECAY low brakes in the off-time. `has_pulses` = its encoder is known to give pulses.
    #[must_use]
    pub fn take(
        enable: BrushEnable,
        phase: Pin<'C', 2, Output>,
        mut decay: Pin<'C', 3, Output>,
        has_pulses: bool,
    ) -> Self {
        decay.set_low();
        Self {
            bridge: MotorBridge::new(enable, phase, Level::Low, InterlockedMotor::BrushMain),
            renewal: Renewal::default(),
            has_pulses,
        }
    }

    /// Called once a millisecond.
    pub fn service(&mut self) {
        if self.renewal.is_overdue() {
            self.bridge.command(Throttle::ZERO);
        }
        self.bridge.service();
    }
}

impl CleaningMotor for BrushMain {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        self.renewal.renew();
        self.bridge.command(duty);
    }

    fn pulses(&mut self) -> Option<u32> {
        self.has_pulses.then(brush_pulses)
    }
}

/// A motor with a plain switch.
#[derive(Debug)]
pub struct Switched<P> {
    pin: P,
    motor: InterlockedMotor,
    renewal: Renewal,
}

impl<P: OutputPin> Switched<P> {
    /// Off.
    #[must_use]
    pub fn take(pin: P, motor: InterlockedMotor) -> Self {
        let mut switched = Self {
            pin,
            motor,
            renewal: Renewal::default(),
        };
        switched.write(Throttle::ZERO);
        switched
    }

    /// Called once a millisecond.
    pub fn service(&mut self) {
        if self.renewal.is_overdue() {
            self.write(Throttle::ZERO);
        }
    }

    #[inline(never)]
    fn write(&mut self, duty: Throttle) {
        let on = duty.millionths() > SWITCH_ON && !off::is_held();
        self.motor.note(on);
        // Pins of this chip cannot fail.
        if on {
            self.pin.set_high().ok();
        }
        // Everything may have been switched off by an interrupt just before the pin was set.
        if !on || off::is_held() {
            self.pin.set_low().ok();
        }
    }
}

impl<P: OutputPin> CleaningMotor for Switched<P> {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        self.renewal.renew();
        self.write(duty);
    }
}
