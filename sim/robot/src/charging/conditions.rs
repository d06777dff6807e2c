//! The conditions of a charge, all drawn from one seed.

use home::{OddCell, PackMake, Pcg, Supply, Thermistor};

/// Streams of random numbers of a seed.
const CONDITIONS: u64 = 0xC4A1;
const THERMISTOR: u64 = 0x47C;
const WEATHER: u64 = 0x3A7;

/// An injected fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InjectedFault {
    /// Nothing.
    None,
    /// The thermistor's wire breaks at this second.
    ThermistorOpen(f64),
    /// The thermistor's wire is shorted from this second on.
    ThermistorShorted(f64),
    /// The thermistor's reading stands still from this second on, without its noise.
    ThermistorFrozen(f64),
    /// The reading of the pack's voltage stands still from this second on.
    VoltageFrozen(f64),
    /// The reading of the current stands still from this second on.
    CurrentFrozen(f64),
    /// The reading of the current is 0 from this second on.
    CurrentDead(f64),
    /// The whole converter stands still from this second on.
    ConverterStalled(f64),
    /// The dock's contacts open for some tens of milliseconds, so many times an hour.
    ContactBounce(f64),
    /// The mains sag and rise, by this share of the supply's voltage.
    Flicker(f64),
    /// The switch conducts for good from this second on.
    SwitchShorted(f64),
    /// The supply gives more than 30 V from this second on.
    SupplyHigh(f64),
}

impl InjectedFault {
    /// A name for tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::ThermistorOpen(_) => "thermistor open",
            Self::ThermistorShorted(_) => "thermistor shorted",
            Self::ThermistorFrozen(_) => "thermistor frozen",
            Self::VoltageFrozen(_) => "voltage frozen",
            Self::CurrentFrozen(_) => "current frozen",
            Self::CurrentDead(_) => "current dead",
            Self::ConverterStalled(_) => "converter stalled",
            Self::ContactBounce(_) => "contact bounce",
            Self::Flicker(_) => "mains flicker",
            Self::SwitchShorted(_) => "switch shorted",
            Self::SupplyHigh(_) => "supply above 30 V",
        }
    }

    /// The kinds of faults, in the order of [`InjectedFault::drawn`].
    pub const KINDS: u32 = 12;

    /// The kind with this number, with figures of its own.
    fn drawn(kind: u32, random: &mut Pcg) -> Self {
        let at_s = 10.0 + random.unit() * 9_000.0;
        match kind {
            1 => Self::ThermistorOpen(at_s),
            2 => Self::ThermistorShorted(at_s),
            3 => Self::ThermistorFrozen(at_s),
            4 => Self::VoltageFrozen(at_s),
            5 => Self::CurrentFrozen(at_s),
            6 => Self::CurrentDead(at_s),
            7 => Self::ConverterStalled(at_s),
            8 => Self::ContactBounce(2.0 + random.unit() * 400.0),
            9 => Self::Flicker(0.02 + random.unit() * 0.1),
            10 => Self::SwitchShorted(at_s),
            11 => Self::SupplyHigh(at_s),
            _ => Self::None,
        }
    }
}

/// One charge.
#[derive(Clone, Debug)]
pub struct Conditions {
    /// The seed it came from.
    pub seed: u64,
    /// The pack.
    pub make: PackMake,
    /// Its charge when it docks.
    pub charge: f64,
    /// Around the robot, degrees Celsius.
    pub ambient_c: f64,
    /// The pack when it docks, degrees Celsius.
    pub pack_c: f64,
    /// Standby current of the electronics, ampere.
    pub drain_a: f64,
    /// The adapter in the dock.
    pub supply: Supply,
    /// How fast that warms, kelvin an hour; negative where it cools.
    pub ambient_drift_k_per_h: f64,
    /// The pack's thermistor and the circuit that reads it.
    pub thermistor: Thermistor,
    /// The owner has measured two points of the thermistor's curve.
    pub calibrated: bool,
    /// Noise of a reading, counts.
    pub noise_counts: f64,
    /// Error of the pack's divider, relative.
    pub gain: f64,
    /// Mismatch of the two dividers, relative.
    pub mismatch: f64,
    /// The injected fault.
    pub trouble: InjectedFault,
}

impl Conditions {
    /// The charge of a seed. Half of them are good packs at room temperature without a fault; the others have worn
    /// packs, any temperature, or a fault.
    #[must_use]
    pub fn drawn(seed: u64) -> Self {
        let mut random = Pcg::new(seed, CONDITIONS);
        let random = &mut random;
        let mut conditions = Self::sound(seed, random);
        match seed % 6 {
            0..=2 => {}
            3 => {
                conditions.make = PackMake::worn(random);
                conditions.charge = random.unit() * 0.7;
            }
            4 => {
                conditions.ambient_c = -10.0 + 55.0 * random.unit();
                conditions.pack_c = conditions.ambient_c + 8.0 * random.unit();
            }
            _ => {
                let kind = 1 + random.below(InjectedFault::KINDS - 1);
                conditions.trouble = InjectedFault::drawn(kind, random);
                if random.below(3) == 0 {
                    conditions.make = PackMake::worn(random);
                }
            }
        }
        conditions
    }

    /// A good pack without a fault, at a temperature at which charging begins with any sensor.
    fn sound(seed: u64, random: &mut Pcg) -> Self {
        let mut between = |least: f64, most: f64| least + (most - least) * random.unit();
        let ambient_c = between(9.0, 34.0);
        let pack_c = ambient_c + between(-2.0, 3.0).max(0.0);
        let charge = between(0.02, 0.7);
        let drain_a = between(0.01, 0.16);
        let supply = Supply {
            open_v: between(22.5, 26.5),
            series_ohm: between(3.5, 7.0),
            limit_a: between(1.2, 2.0),
            unasked_a: 0.02,
        };
        let ambient_drift_k_per_h = between(-1.0, 1.0);
        let noise_counts = between(0.1, 1.5);
        let gain = between(-0.01, 0.01);
        let mismatch = between(-0.006, 0.006);
        Self {
            seed,
            make: PackMake::sound(random),
            charge,
            ambient_c,
            pack_c,
            drain_a,
            supply,
            ambient_drift_k_per_h,
            thermistor: Thermistor::drawn(&mut Pcg::new(seed, THERMISTOR)),
            calibrated: (seed / 6).is_multiple_of(2),
            noise_counts,
            gain,
            mismatch,
            trouble: InjectedFault::None,
        }
    }

    /// A charge of a good pack without a fault, for any seed.
    #[must_use]
    pub fn healthy(seed: u64) -> Self {
        Self::sound(seed, &mut Pcg::new(seed, CONDITIONS))
    }

    /// A good pack without a fault anywhere between frost and heat, in air that warms or cools meanwhile.
    #[must_use]
    pub fn weather(seed: u64, calibrated: bool) -> Self {
        let random = &mut Pcg::new(seed, WEATHER);
        let ambient_c = -10.0 + 55.0 * random.unit();
        Self {
            ambient_c,
            pack_c: ambient_c + 10.0 * random.symmetric(),
            ambient_drift_k_per_h: 8.0 * random.symmetric(),
            calibrated,
            ..Self::healthy(seed)
        }
    }

    /// Whether the pack should become full: good cells, a start at which the full current begins with every thermistor, and no
    /// fault except those that a charger must tolerate.
    #[must_use]
    pub fn is_healthy(&self) -> bool {
        let sound =
            self.make.capacity_ah >= 1.6 && self.make.odd.is_none() && self.make.resistance_ohm <= 0.6;
        let (least_c, most_c) = if self.calibrated {
            (11.0, 36.0)
        } else {
            (22.0, 30.0)
        };
        let is_mild = |celsius: f64| (least_c..=most_c).contains(&celsius);
        let drifts = self.ambient_drift_k_per_h.abs() > 1.0;
        sound
            && is_mild(self.ambient_c)
            && is_mild(self.pack_c)
            && !drifts
            && self.trouble == InjectedFault::None
    }

    /// Whether a cell has failed.
    #[must_use]
    pub const fn has_dead_cell(&self) -> bool {
        matches!(self.make.odd, Some(OddCell::Dead))
    }
}
