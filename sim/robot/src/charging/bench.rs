//! One charger on one pack, 20 ms at a time.

use cordlib::PackParameters;
use cordlib::board::{ChargeDrive, ChargerReadings, DockRequest};
use cordlib::charge::{ChargeContext, ChargeController, ChargeOutput, Docking, MotorActivity, Stops};
use home::{Pack, Pcg};
use rvac_units::Tick;

use super::conditions::{Conditions, InjectedFault};
use super::converter::Converter;

/// An envelope of the switch.
pub(crate) const STEP_MS: u32 = 20;
const STEP_S: f64 = STEP_MS as f64 / 1_000.0;
/// Chemistry and heat.
const SLOW_STEPS: u32 = 50;
/// Time of docking; before it the charger learns its current offset.
const DOCKS_S: f64 = 6.0;
const READINGS: u64 = 0xAD0;
const EVENTS: u64 = 0xE7E;
/// The contacts open for so long when they bounce, ms.
const BOUNCE_MS: u32 = 60;
const HIGH_SUPPLY_V: f64 = 33.0;
/// Most that the air around the robot warms or cools during a charge, kelvin.
const AMBIENT_DRIFT_MAX_K: f64 = 12.0;

/// A pack on a charger.
#[derive(Debug)]
pub struct ChargeBench<S> {
    conditions: Conditions,
    pack: Pack,
    converter: Converter,
    charger: ChargeController<S>,
    events: Pcg,
    output: ChargeOutput,
    steps: u32,
    start: u32,
    current_a: f64,
    /// Sum over the steps of the present second, ampere.
    sum_a: f64,
    thermistor: f64,
    bounce_ms: u32,
    supply_share: f64,
    last: Option<ChargerReadings>,
    stalled_ms: u32,
}

impl<S: Stops> ChargeBench<S> {
    /// The robot is in front of the dock.
    #[must_use]
    pub fn new(conditions: &Conditions, stops: S) -> Self {
        let mut pack = Pack::new(conditions.make, conditions.charge, conditions.ambient_c);
        pack.set_temperature(conditions.pack_c);
        let random = Pcg::new(conditions.seed, READINGS);
        let converter = Converter::new(conditions, random);
        let parameters = PackParameters {
            drain_ma: 15,
            ..PackParameters::NIMH_12
        };
        let mut events = Pcg::new(conditions.seed, EVENTS);
        Self {
            thermistor: conditions.thermistor.counts(conditions.pack_c),
            pack,
            converter,
            charger: ChargeController::with_stops(parameters, stops),
            output: ChargeOutput::default(),
            steps: 0,
            // Clocks start at any value, so that many of these charges include a wrap.
            start: events.next_u32(),
            events,
            current_a: 0.0,
            sum_a: 0.0,
            bounce_ms: 0,
            supply_share: 1.0,
            last: None,
            stalled_ms: 0,
            conditions: conditions.clone(),
        }
    }

    /// Seconds since the beginning.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        f64::from(self.steps) * STEP_S
    }

    /// The pack.
    #[must_use]
    pub const fn pack(&self) -> &Pack {
        &self.pack
    }

    /// The charger.
    #[must_use]
    pub const fn charger(&self) -> &ChargeController<S> {
        &self.charger
    }

    /// Output of the charger to the board.
    #[must_use]
    pub const fn output(&self) -> ChargeOutput {
        self.output
    }

    /// Current into the pack through the switch, ampere.
    #[must_use]
    pub const fn current_a(&self) -> f64 {
        self.current_a
    }

    /// Whether the contacts carry a supply now.
    #[must_use]
    pub fn is_supplied(&self) -> bool {
        self.seconds() >= DOCKS_S && self.bounce_ms == 0
    }

    /// Advances one envelope.
    pub fn step(&mut self) {
        self.steps += 1;
        self.happen();
        let duty = self.duty();
        let net_v = self.pack.terminal_v(self.current_a - self.conditions.drain_a);
        self.current_a = if self.is_supplied() {
            let asked =
                self.output.request == DockRequest::Current || self.is_past(InjectedFault::shorted_at);
            let mut supply = self.conditions.supply;
            supply.open_v *= self.supply_share;
            if self.is_past(InjectedFault::high_at) {
                supply.open_v = HIGH_SUPPLY_V;
            }
            supply.current_a(duty, net_v, asked)
        } else {
            0.0
        };
        self.sum_a += self.current_a;
        if self.steps.is_multiple_of(SLOW_STEPS) {
            let mean_a = self.sum_a / f64::from(SLOW_STEPS);
            let drifted_k = self.conditions.ambient_drift_k_per_h * self.seconds() / 3_600.0;
            let drifted_k = drifted_k.clamp(-AMBIENT_DRIFT_MAX_K, AMBIENT_DRIFT_MAX_K);
            self.pack.set_ambient(self.conditions.ambient_c + drifted_k);
            self.pack.step(mean_a - self.conditions.drain_a, 1.0);
            self.sum_a = 0.0;
            self.thermistor = self.conditions.thermistor.counts(self.pack.sensor_c());
        }
        let readings = self.read();
        let context = ChargeContext {
            // The contacts are debounced by 300 ms, so a bounce leaves the robot docked.
            docking: if self.seconds() >= DOCKS_S {
                Docking::Docked
            } else {
                Docking::Away
            },
            motors: MotorActivity::Idle,
            load_ma: 15,
        };
        let now = Tick(self.start.wrapping_add(self.steps.wrapping_mul(STEP_MS)));
        self.output = self.charger.step(Some(readings), context, now);
    }

    fn duty(&self) -> f64 {
        if self.is_past(InjectedFault::shorted_at) {
            return 1.0;
        }
        match self.output.drive {
            ChargeDrive::Off => 0.0,
            ChargeDrive::Duty(duty) => duty.as_f64(),
        }
    }

    /// Whether the fault of this kind has begun.
    fn is_past(&self, of: impl Fn(&InjectedFault) -> Option<f64>) -> bool {
        of(&self.conditions.trouble).is_some_and(|at_s| self.seconds() >= at_s)
    }

    /// Bounces and flicker.
    fn happen(&mut self) {
        self.bounce_ms = self.bounce_ms.saturating_sub(STEP_MS);
        match self.conditions.trouble {
            InjectedFault::ContactBounce(per_hour) if self.events.unit() < per_hour * STEP_S / 3_600.0 => {
                self.bounce_ms = BOUNCE_MS;
            }
            InjectedFault::Flicker(share) if self.steps.is_multiple_of(15) => {
                self.supply_share = 1.0 + share * self.events.symmetric();
            }
            _ => {}
        }
    }

    fn read(&mut self) -> ChargerReadings {
        let pack_v = self.pack.terminal_v(self.current_a - self.conditions.drain_a);
        let fresh = ChargerReadings {
            pack_mv: self.converter.pack_mv(pack_v),
            input_mv: self.input_mv(pack_v),
            current_ma: self.converter.current_ma(self.current_a, pack_v),
            temperature: self.converter.temperature(self.thermistor_counts()),
            age_ms: 0,
            adapter: self.is_supplied(),
        };
        let last = self.last.unwrap_or(fresh);
        let mut shown = fresh;
        match self.conditions.trouble {
            InjectedFault::ThermistorFrozen(at_s) if self.seconds() >= at_s => {
                shown.temperature = last.temperature
            }
            InjectedFault::VoltageFrozen(at_s) if self.seconds() >= at_s => shown.pack_mv = last.pack_mv,
            InjectedFault::CurrentFrozen(at_s) if self.seconds() >= at_s => {
                shown.current_ma = last.current_ma
            }
            InjectedFault::CurrentDead(at_s) if self.seconds() >= at_s => shown.current_ma = 0,
            InjectedFault::ConverterStalled(at_s) if self.seconds() >= at_s => {
                self.stalled_ms += STEP_MS;
                shown = ChargerReadings {
                    age_ms: self.stalled_ms,
                    adapter: fresh.adapter,
                    ..last
                };
            }
            _ => {}
        }
        self.last = Some(shown);
        shown
    }

    /// While current flows the charger's side shows the supply's voltage behind the switch.
    fn input_mv(&self, pack_v: f64) -> i32 {
        let volts = if self.is_past(InjectedFault::high_at) && self.current_a > 0.0 {
            HIGH_SUPPLY_V
        } else {
            pack_v + 0.3 * self.current_a
        };
        (volts * 1_000.0) as i32
    }

    fn thermistor_counts(&self) -> f64 {
        match self.conditions.trouble {
            InjectedFault::ThermistorOpen(at_s) if self.seconds() >= at_s => 893.0,
            InjectedFault::ThermistorShorted(at_s) if self.seconds() >= at_s => 4.0,
            _ => self.thermistor,
        }
    }
}

impl InjectedFault {
    const fn shorted_at(&self) -> Option<f64> {
        match self {
            Self::SwitchShorted(at_s) => Some(*at_s),
            _ => None,
        }
    }

    const fn high_at(&self) -> Option<f64> {
        match self {
            Self::SupplyHigh(at_s) => Some(*at_s),
            _ => None,
        }
    }
}
