//! Averages signal strengths over short paths: packets fade one by one, their mean does not.

use super::mean_rssi::{BEACONS_MAX, MeanRssi};
use super::parameters::FINGERPRINT;
use crate::model::advance::Advance;
use crate::model::observation::{BeaconSignal, Observation};

/// Means in progress.
#[derive(Clone, Debug, Default)]
pub(super) struct RssiAverager {
    distance_m: f64,
    sums: Vec<RssiSum>,
}

#[derive(Clone, Copy, Debug)]
struct RssiSum {
    beacon: u16,
    count: u32,
    dbm: f64,
}

impl RssiAverager {
    /// Adds a step, and puts the means into `levels` at the end of each distance. A robot in the air receives signals of another
    /// place.
    pub(super) fn take(&mut self, observation: &Observation, advance: Advance, levels: &mut Vec<MeanRssi>) {
        if observation.wheel_drop {
            *self = Self::default();
            return;
        }
        self.distance_m += advance.distance_m.abs();
        for signal in &observation.beacons {
            if let BeaconSignal::Strength(strength) = signal
                && strength.beacon < BEACONS_MAX
                && (FINGERPRINT.least_dbm..=FINGERPRINT.most_dbm).contains(&strength.dbm)
            {
                self.add(strength.beacon, strength.dbm);
            }
        }
        if self.distance_m >= FINGERPRINT.averaging_m {
            self.distance_m = 0.0;
            levels.extend(self.sums.drain(..).map(|sum| MeanRssi {
                beacon: sum.beacon,
                dbm: sum.dbm / f64::from(sum.count),
            }));
        }
    }

    fn add(&mut self, beacon: u16, dbm: f64) {
        match self.sums.iter_mut().find(|sum| sum.beacon == beacon) {
            Some(sum) => {
                sum.count = sum.count.saturating_add(1);
                sum.dbm += dbm;
            }
            None => self.sums.push(RssiSum {
                beacon,
                count: 1,
                dbm,
            }),
        }
    }
}
