//! Properties of a pack, new or old.

use crate::Pcg;
use crate::model;

/// Figures of one pack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackMake {
    /// Cells in series.
    pub cells: u8,
    /// What it really holds, ampere hours.
    pub capacity_ah: f64,
    /// Resistance of all cells and contacts, ohm.
    pub resistance_ohm: f64,
    /// Heat capacity, joule per degree.
    pub heat_j_per_k: f64,
    /// Heat that leaves it, watt per degree above what surrounds it.
    pub cooling_w_per_k: f64,
    /// The sensor follows with this time constant, seconds.
    pub sensor_lag_s: f64,
    /// How clearly the voltage shows that it is full, 1 = as new cells do.
    pub signs: f64,
    /// Share of the charge that is lost in a day at rest.
    pub self_discharge_per_day: f64,
    /// A cell that is not like the others.
    pub odd: Option<OddCell>,
}

/// A cell that is not like the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OddCell {
    /// Shorted inside: no voltage, no charge.
    Dead,
    /// Holds less, and is emptier than the others: below nothing it is reversed.
    Weak {
        /// Its capacity in parts of the others'.
        capacity_share: f64,
        /// How much emptier it is, in parts of its capacity.
        behind: f64,
    },
}

impl OddCell {
    pub(super) fn charge(self, of_others: f64) -> f64 {
        match self {
            Self::Dead => 0.0,
            Self::Weak { behind, .. } => (of_others - behind).max(-0.1),
        }
    }

    pub(super) const fn capacity_share(self) -> f64 {
        match self {
            Self::Dead => 0.0,
            Self::Weak { capacity_share, .. } => capacity_share,
        }
    }

    pub(super) const fn volts(self, sound_v: f64) -> f64 {
        match self {
            Self::Dead => 0.0,
            Self::Weak { .. } => sound_v,
        }
    }
}

impl PackMake {
    /// Twelve new sub-C cells of 2 Ah: 55 g each at 0.9 J per gram and degree.
    pub const NIMH_12: Self = Self {
        cells: 12,
        capacity_ah: 2.0,
        resistance_ohm: 0.3,
        heat_j_per_k: 600.0,
        cooling_w_per_k: 0.25,
        sensor_lag_s: 40.0,
        signs: 1.0,
        self_discharge_per_day: 0.0,
        odd: None,
    };

    /// The pack of a robot's description.
    #[must_use]
    pub fn of(part: &model::BatteryModel) -> Self {
        Self {
            cells: part.cells,
            capacity_ah: part.capacity_ah,
            resistance_ohm: part.resistance_ohm,
            ..Self::NIMH_12
        }
    }

    /// A good pack, new or aged: 1.6 to 2.4 Ah, up to twice the resistance.
    #[must_use]
    pub fn sound(random: &mut Pcg) -> Self {
        Self {
            capacity_ah: between(random, 1.6, 2.4),
            resistance_ohm: between(random, 0.2, 0.6),
            heat_j_per_k: between(random, 540.0, 680.0),
            cooling_w_per_k: between(random, 0.18, 0.35),
            sensor_lag_s: between(random, 20.0, 70.0),
            signs: between(random, 0.6, 1.3),
            self_discharge_per_day: between(random, 0.003, 0.02),
            ..Self::NIMH_12
        }
    }

    /// A worn pack: half of its capacity and many times the resistance, or a cell that has failed.
    #[must_use]
    pub fn worn(random: &mut Pcg) -> Self {
        let odd = match random.below(4) {
            0 => Some(OddCell::Dead),
            1 => Some(OddCell::Weak {
                capacity_share: between(random, 0.6, 0.95),
                behind: 0.0,
            }),
            2 => Some(OddCell::Weak {
                capacity_share: between(random, 0.6, 0.95),
                behind: between(random, 0.1, 0.9),
            }),
            _ => None,
        };
        Self {
            capacity_ah: between(random, 0.8, 1.7),
            resistance_ohm: between(random, 0.4, 1.6),
            signs: between(random, 0.3, 1.0),
            self_discharge_per_day: between(random, 0.01, 0.05),
            odd,
            ..Self::sound(random)
        }
    }
}

fn between(random: &mut Pcg, least: f64, most: f64) -> f64 {
    least + (most - least) * random.unit()
}
