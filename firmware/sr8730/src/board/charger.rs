//! Battery measurement, the charger's gate, and the code that requests current from the dock.
//!
//! cordlib decides whether and how much to charge. This file does what must be exact to the microsecond. The gate is an
//! interrupt of Timer3 in each PWM period while the charger is on; otherwise the interrupt is off.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use super::{contacts, converter, interlock, off, tick};
use crate::calibration::Calibration;
use crate::generated::calibration::Calibrated;
use crate::generated::pins;
use crate::logic::dock_code::{CarrierHalf, DockCode, HALF_PERIOD_COUNTS, LeadingOnes, REPEAT_MS};
use crate::logic::envelope::{Envelope, pulses_for};
use crate::logic::guarded::Guarded;
use crate::logic::pack::PackScale;
use crate::logic::renewal::Renewal;
use crate::logic::thermistor::{self, temperature};
use cordlib::board::{ChargeDrive, Charger, ChargerReadings, DockRequest};
use cordlib::thermistor::ThermistorCurve;
use pic32mx3_hal::gpio::{Output, Pin};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::pwm::{self, PwmChannel};
use pic32mx3_hal::timer::{SlowPrescaler, Timer};
use pic32mx3_hal::{cpu, interrupt};

/// Output compare of the charger.
const COMPARE: u8 = 3;

/// ENABLE of the charger: RD2, OC3 on Timer3.
pub type GateChannel = PwmChannel<COMPARE, 3, Pin<'D', 2, Output>>;

/// Pulses in each envelope, 0 = off. Stored with its complement, so that a flipped bit cannot switch the charger on.
static PULSES: Guarded = Guarded::new(0);
/// The two copies of [`PULSES`] disagreed.
static DAMAGED: AtomicBool = AtomicBool::new(false);
/// Periods that the gate's interrupt has served, wrapping.
static PERIODS: AtomicU32 = AtomicU32::new(0);
static GATE: HandlerCell<vector::TIMER_3, Gate> = HandlerCell::empty();
static CODE: HandlerCell<vector::TIMER_1, CodeSender> = HandlerCell::empty();
/// A code is being sent or is about to be.
static SENDING: AtomicBool = AtomicBool::new(false);

#[derive(Debug)]
struct Gate {
    channel: GateChannel,
    envelope: Envelope,
}

fn on_period(context: &mut Context<vector::TIMER_3>) {
    Source::Timer3.clear();
    PERIODS.store(PERIODS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
    let pulses = match PULSES.get() {
        Ok(pulses) if pulses != 0 && !interlock::any_motor_driven() && !off::is_held() => pulses,
        Ok(_) => return shut(),
        Err(_) => {
            DAMAGED.store(true, Ordering::Relaxed);
            return shut();
        }
    };
    let Some(gate) = GATE.get(context) else {
        return shut();
    };
    if !gate.channel.is_enabled() {
        gate.channel.enable();
        gate.envelope = Envelope::new();
    }
    gate.channel.set_width(gate.envelope.next(pulses as u16));
}
interrupt!(TIMER_3, on_period);

/// Switches off at once: when this returns the pin is low and the interrupt is disabled.
fn shut() {
    pwm::stop(COMPARE);
    Source::Timer3.disable();
}

/// Sends the code for the dock once.
#[derive(Debug)]
struct CodeSender {
    timer: Timer<1>,
    code: DockCode,
    ones: LeadingOnes,
}

fn on_half_period(context: &mut Context<vector::TIMER_1>) {
    Source::Timer1.clear();
    let Some(sender) = CODE.get(context) else {
        return;
    };
    match sender.code.next() {
        CarrierHalf::High => converter::write_pin(pins::PROXIMITY_EMIT, true),
        CarrierHalf::Low => converter::write_pin(pins::PROXIMITY_EMIT, false),
        CarrierHalf::Over if sender.timer.is_running() => {
            sender.timer.stop();
            converter::return_emitter();
            SENDING.store(false, Ordering::Relaxed);
        }
        CarrierHalf::Over => {
            sender.code = DockCode::start(sender.ones);
            sender
                .timer
                .start(SlowPrescaler::By1, u32::from(HALF_PERIOD_COUNTS));
        }
    }
}
interrupt!(TIMER_1, on_half_period);

/// Battery and charger.
#[derive(Debug)]
pub struct PackCharger {
    scale: PackScale,
    curve: ThermistorCurve,
    allowed: bool,
    drive: ChargeDrive,
    renewal: Renewal,
    periods: u32,
    request: DockRequest,
    code: CodePhase,
}

/// Phase of the code for the dock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CodePhase {
    /// Not sent before this millisecond.
    Resting { until: u32 },
    /// The emitter was requested for a code that was due at this time.
    Waiting { since: u32 },
    /// Being sent; it was due at this time.
    Sending { since: u32 },
}

impl PackCharger {
    /// Off.
    #[must_use]
    pub fn take(channel: GateChannel, code_timer: Timer<1>, calibration: &Calibration) -> Self {
        pwm::stop(COMPARE);
        let gate = Gate {
            channel,
            envelope: Envelope::new(),
        };
        let sender = CodeSender {
            timer: code_timer,
            code: DockCode::IDLE,
            ones: calibration.dock_code(),
        };
        // Each is given once, because `Peripherals` gives its parts once.
        GATE.hand_over(gate).ok();
        CODE.hand_over(sender).ok();
        interrupt::set_priority(Vector::Timer3, Priority::Level3, SubPriority::Sub1).ok();
        interrupt::set_priority(Vector::Timer1, Priority::Level3, SubPriority::Sub2).ok();
        Source::Timer1.enable();
        let known = |which| calibration.known(which).unwrap_or_default();
        Self {
            scale: PackScale::new(
                known(Calibrated::BatteryScale),
                known(Calibrated::ChargeCurrentZero),
            ),
            curve: ThermistorCurve::new(thermistor::DIVIDER, calibration.thermistor()),
            allowed: calibration.allows_charging(),
            drive: ChargeDrive::Off,
            renewal: Renewal::default(),
            periods: 0,
            request: DockRequest::Silent,
            code: CodePhase::Resting { until: tick::ticks() },
        }
    }

    /// Whether power stage, divider and pack are calibrated, which charging requires.
    #[must_use]
    pub const fn may_charge(&self) -> bool {
        self.allowed
    }

    /// Called once a millisecond: shuts the gate if its drive was not renewed or its interrupt has stopped, and sends
    /// the code for the dock. Returns whether the gate's variable is damaged.
    pub fn service(&mut self) -> bool {
        let overdue = self.renewal.is_overdue();
        let periods = PERIODS.load(Ordering::Relaxed);
        let dead = periods == self.periods && Source::Timer3.is_enabled();
        self.periods = periods;
        if overdue || dead || self.drive == ChargeDrive::Off {
            self.stop();
        }
        self.send_code();
        DAMAGED.load(Ordering::Relaxed)
    }

    fn stop(&mut self) {
        cpu::with_level(Priority::Level3, || PULSES.set(0));
        shut();
        self.drive = ChargeDrive::Off;
    }

    /// Sends the code five times a second while current is requested. The emitter is shared with the proximity sensors.
    fn send_code(&mut self) {
        let now = tick::ticks();
        match self.code {
            CodePhase::Resting { until } => {
                let due = now.wrapping_sub(until) < 1 << 31;
                if due && self.request == DockRequest::Current {
                    converter::ask_for_emitter();
                    self.code = CodePhase::Waiting { since: now };
                }
            }
            CodePhase::Waiting { since } if converter::emitter_is_lent() => {
                SENDING.store(true, Ordering::Relaxed);
                // The timer is stopped, so this begins the code.
                Source::Timer1.request();
                self.code = CodePhase::Sending { since };
            }
            CodePhase::Sending { since } if !SENDING.load(Ordering::Relaxed) => {
                self.code = CodePhase::Resting {
                    until: since.wrapping_add(REPEAT_MS),
                };
            }
            CodePhase::Waiting { .. } | CodePhase::Sending { .. } => {}
        }
    }
}

impl Charger for PackCharger {
    const PRESENT: bool = true;
    const CHARGES: bool = true;

    fn readings(&mut self) -> Option<ChargerReadings> {
        let age_ms = converter::age_ms()?;
        let signals = [
            pins::CHARGER_VOLTAGE,
            pins::BATTERY_VOLTAGE,
            pins::BATTERY_THERMISTOR,
        ];
        let [before, after, thermistor] = converter::whole(|| signals.map(converter::count));
        let reading = self.scale.reading(before, after);
        Some(ChargerReadings {
            pack_mv: reading.pack_mv,
            input_mv: reading.input_mv,
            current_ma: reading.current_ma,
            temperature: temperature(&self.curve, thermistor),
            age_ms,
            adapter: contacts::adapter_is_live(),
        })
    }

    fn drive(&mut self, drive: ChargeDrive) {
        self.renewal.renew();
        let pulses = match drive {
            ChargeDrive::Duty(share) if self.allowed && !off::is_held() => pulses_for(share),
            ChargeDrive::Duty(_) | ChargeDrive::Off => 0,
        };
        if pulses == 0 {
            self.stop();
            return;
        }
        self.drive = drive;
        cpu::with_level(Priority::Level3, || PULSES.set(u32::from(pulses)));
        if !Source::Timer3.is_enabled() {
            Source::Timer3.clear();
            Source::Timer3.enable();
        }
    }

    fn ask_dock(&mut self, request: DockRequest) {
        self.request = request;
    }
}
