//! Energy consumption of driving and cleaning, learnt from the battery charge.
//!
//! Terms. *Rate*: share of the full charge (0..1) per second. *Learning window*: minutes over which the predicted consumption is
//! compared with the measured one. The error corrects the rates in proportion to the time spent in each activity.
//!
//! A model belongs to one robot and its pack. It has two activities: driving with and without cleaning motors.

use super::config::BrainConfig;

/// Parameters of the energy model. The rates are the data sheet values of `robots/samsung-sr8730/robot.toml`, used until the
/// robot has learnt its own: a pack of 2 Ah lasts an hour of cleaning, or three of driving.
struct EnergyParameters {
    /// Rate of cleaning.
    cleaning_per_s: f64,
    /// Rate of driving.
    driving_per_s: f64,
    /// Least learnt rate, as a factor of the data sheet value.
    rate_factor_min: f64,
    /// Greatest learnt rate, as a factor of the data sheet value.
    rate_factor_max: f64,
    /// Length of a window, seconds: the reported charge is quantized and varies by some percent with the load.
    window_s: f64,
    /// Share of a window's error that corrects the rates.
    gain: f64,
    /// Safety factor on the predicted consumption of the return to the dock.
    margin: f64,
    /// Charge that must remain at the dock, 0..1.
    reserve: f64,
    /// Ratio of the driving time along a planned path to its length at cruise speed.
    path_time_factor: f64,
    /// Time to find the dock's centre line and drive in, with a few attempts, seconds.
    approach_s: f64,
    /// Ratio of the cleaning time in corners to that of the same area in the open.
    corner_factor: f64,
    /// Largest share of a job's floor that may be left: in clutter a normal job leaves about as much.
    negligible_share_max: f64,
}

const PARAMETERS: EnergyParameters = EnergyParameters {
    cleaning_per_s: 1.0 / 3_600.0,
    driving_per_s: 1.0 / 10_800.0,
    rate_factor_min: 0.2,
    rate_factor_max: 5.0,
    window_s: 300.0,
    gain: 0.4,
    margin: 1.3,
    reserve: 0.05,
    path_time_factor: 1.5,
    approach_s: 90.0,
    corner_factor: 2.0,
    negligible_share_max: 0.05,
};

/// The work that remains when the pack is low.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RemainingWork {
    /// Floor in square metres, and its share of the job's floor, 0..=1.
    pub(crate) left_m2: f64,
    pub(crate) share: f64,
    /// Path length to the dock, metres.
    pub(crate) dock_path_m: f64,
}

/// Activity of wheels and cleaning motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Driving and cleaning.
    Cleaning,
    /// Driving.
    Driving,
    /// Rest, charging or handling by a person: nothing is learnt.
    Other,
}

/// Learnt rates, shares of the full charge per second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyModel {
    /// Driving with cleaning motors.
    pub cleaning_per_s: f64,
    /// Driving without cleaning motors.
    pub driving_per_s: f64,
    /// Seconds of learning; 0 = the rates are those of the data sheet.
    pub seen_s: f64,
}

impl Default for EnergyModel {
    fn default() -> Self {
        Self {
            cleaning_per_s: PARAMETERS.cleaning_per_s,
            driving_per_s: PARAMETERS.driving_per_s,
            seen_s: 0.0,
        }
    }
}

impl EnergyModel {
    /// A model from outside, limited to plausible values.
    #[must_use]
    pub fn checked(self) -> Self {
        Self {
            cleaning_per_s: limited(self.cleaning_per_s, PARAMETERS.cleaning_per_s),
            driving_per_s: limited(self.driving_per_s, PARAMETERS.driving_per_s),
            seen_s: if self.seen_s.is_finite() {
                self.seen_s.max(0.0)
            } else {
                0.0
            },
        }
    }

    /// Share of the full charge that a job of this duration takes.
    #[must_use]
    pub fn charge_for(&self, cleaning_s: f64, driving_s: f64) -> f64 {
        self.cleaning_per_s * cleaning_s + self.driving_per_s * driving_s
    }

    /// Least charge at which the robot must start its return over `path_m` metres at `cruise_m_per_s`.
    #[must_use]
    pub fn charge_to_return(&self, path_m: f64, cruise_m_per_s: f64) -> f64 {
        PARAMETERS.margin * self.charge_for(0.0, time_to_return_s(path_m, cruise_m_per_s))
            + PARAMETERS.reserve
    }

    /// Whether the rest is too small to charge for, because driving there and back takes more than cleaning it. Then the job
    /// ends.
    pub(crate) fn is_negligible(&self, left: RemainingWork, config: &BrainConfig) -> bool {
        let cruise_m_per_s = config.speeds.cruise_m_per_s;
        let cleaning_s =
            PARAMETERS.corner_factor * left.left_m2 / (config.body.swath_m * cruise_m_per_s).max(0.01);
        let driving_s = 2.0 * time_to_return_s(left.dock_path_m, cruise_m_per_s);
        left.share <= PARAMETERS.negligible_share_max
            && self.charge_for(cleaning_s, 0.0) < self.charge_for(0.0, driving_s)
    }
}

/// What a job may take of the pack before the robot must drive home, as shares of the full charge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PackUse {
    /// What it holds before the job.
    pub(crate) held: f64,
    /// What it holds after a recharge.
    pub(crate) recharged: f64,
    /// With what it turns home.
    pub(crate) least: f64,
}

impl PackUse {
    /// How often a job that takes `charge` must recharge.
    pub(crate) fn recharges(self, charge: f64) -> u32 {
        let beyond = charge - (self.held - self.least).max(0.0);
        let portion = (self.recharged - self.least).max(PARAMETERS.reserve);
        // A share of a charge that is not a number is as good as none.
        if beyond > 0.0 {
            libm::ceil(beyond / portion) as u32
        } else {
            0
        }
    }
}

/// Time to return over `path_m` metres, including docking, seconds.
pub(crate) fn time_to_return_s(path_m: f64, cruise_m_per_s: f64) -> f64 {
    PARAMETERS.path_time_factor * path_m / cruise_m_per_s.max(0.05) + PARAMETERS.approach_s
}

fn limited(rate: f64, guess: f64) -> f64 {
    if rate.is_finite() {
        rate.clamp(
            PARAMETERS.rate_factor_min * guess,
            PARAMETERS.rate_factor_max * guess,
        )
    } else {
        guess
    }
}

/// Learns an energy model.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EnergyLearner {
    model: EnergyModel,
    window: Option<LearningWindow>,
}

#[derive(Clone, Copy, Debug)]
struct LearningWindow {
    charge: f64,
    cleaning_s: f64,
    driving_s: f64,
}

impl EnergyLearner {
    pub(crate) fn of(model: EnergyModel) -> Self {
        Self {
            model: model.checked(),
            window: None,
        }
    }

    pub(crate) fn model(&self) -> EnergyModel {
        self.model
    }

    /// Adds `time_s` of an activity, after which the pack holds `charge`.
    pub(crate) fn update(&mut self, time_s: f64, activity: Activity, charge: Option<f32>) {
        let charge = charge.map(f64::from).filter(|charge| charge.is_finite());
        let (Some(charge), true) = (charge, activity != Activity::Other) else {
            self.window = None;
            return;
        };
        let window = self.window.get_or_insert(LearningWindow {
            charge,
            cleaning_s: 0.0,
            driving_s: 0.0,
        });
        match activity {
            Activity::Cleaning => window.cleaning_s += time_s,
            Activity::Driving => window.driving_s += time_s,
            Activity::Other => {}
        }
        if window.cleaning_s + window.driving_s >= PARAMETERS.window_s {
            let window = *window;
            self.learn(window, window.charge - charge);
            self.window = None;
        }
    }

    fn learn(&mut self, window: LearningWindow, lost: f64) {
        // A rising charge means that the pack was exchanged or its charge estimate was corrected.
        if lost <= 0.0 {
            return;
        }
        let error = lost - self.model.charge_for(window.cleaning_s, window.driving_s);
        let square_s2 = window.cleaning_s * window.cleaning_s + window.driving_s * window.driving_s;
        let step_per_s2 = PARAMETERS.gain * error / square_s2;
        self.model = EnergyModel {
            cleaning_per_s: self.model.cleaning_per_s + step_per_s2 * window.cleaning_s,
            driving_per_s: self.model.driving_per_s + step_per_s2 * window.driving_s,
            seen_s: self.model.seen_s + window.cleaning_s + window.driving_s,
        }
        .checked();
    }
}

#[cfg(test)]
mod tests {
    use super::{Activity, EnergyLearner, EnergyModel, PackUse, RemainingWork};
    use crate::model::config::BrainConfig;

    #[test]
    fn the_rest_is_worth_a_charge_unless_driving_takes_more_than_cleaning() {
        let model = EnergyModel::default();
        let is_negligible = |left_m2, share, dock_path_m| {
            let left = RemainingWork {
                left_m2,
                share,
                dock_path_m,
            };
            model.is_negligible(left, &BrainConfig::of_tests())
        };
        assert!(is_negligible(0.3, 0.005, 8.0));
        assert!(!is_negligible(0.3, 0.06, 8.0), "a corner of a small room");
        assert!(!is_negligible(4.0, 0.03, 8.0), "some minutes of a large home");
        assert!(is_negligible(4.0, 0.03, 60.0), "far away");
        assert!(!is_negligible(f64::NAN, 0.01, 8.0));
    }

    /// Hours of alternating cleaning and driving at these rates.
    fn learnt(cleaning_per_s: f64, driving_per_s: f64) -> EnergyModel {
        let mut learner = EnergyLearner::default();
        for round in 0..8 {
            let mut charge = 1.0;
            for second in 0..3_000 {
                let cleans = (second / 300 + round) % 3 != 0;
                let (activity, rate) = if cleans {
                    (Activity::Cleaning, cleaning_per_s)
                } else {
                    (Activity::Driving, driving_per_s)
                };
                charge -= rate;
                // The wire quantizes the charge.
                let reported = (charge * 1_000.0_f64).round() / 1_000.0;
                learner.update(1.0, activity, Some(reported as f32));
            }
            learner.update(60.0, Activity::Other, Some(1.0));
        }
        learner.model()
    }

    #[test]
    fn both_rates_are_learnt() {
        let (cleaning, driving) = (1.0 / 5_000.0, 1.0 / 12_000.0);
        let model = learnt(cleaning, driving);
        assert!((model.cleaning_per_s / cleaning - 1.0).abs() < 0.1, "{model:?}");
        assert!((model.driving_per_s / driving - 1.0).abs() < 0.2, "{model:?}");
        assert!(model.seen_s > 10_000.0);
    }

    #[test]
    fn implausible_charges_are_not_learnt() {
        let mut learner = EnergyLearner::default();
        for charge in [Some(f32::NAN), None, Some(0.2), Some(0.9)] {
            learner.update(400.0, Activity::Cleaning, charge);
        }
        let wild = EnergyModel {
            cleaning_per_s: f64::NAN,
            driving_per_s: 9.0,
            seen_s: f64::INFINITY,
        };
        let checked = wild.checked();
        assert_eq!(checked.cleaning_per_s, EnergyModel::default().cleaning_per_s);
        assert!(checked.driving_per_s < 1e-3 && checked.seen_s == 0.0);
    }

    #[test]
    fn a_job_recharges_as_often_as_its_portions_need() {
        let pack = |held| PackUse {
            held,
            recharged: 0.9,
            least: 0.1,
        };
        let recharges = |charges: [f64; 5], held| charges.map(|charge| pack(held).recharges(charge));
        let charges = [0.2, 0.79, 0.81, 1.7, 4.0];
        assert_eq!(recharges(charges, 0.9), [0, 0, 1, 2, 4]);
        assert_eq!(
            recharges(charges, 0.4),
            [0, 1, 1, 2, 5],
            "less than after a recharge"
        );
        assert_eq!(recharges(charges, 0.05)[0], 1, "it would turn home at once");
        assert_eq!(pack(0.9).recharges(f64::NAN), 0);
    }

    #[test]
    fn a_longer_return_needs_more_charge() {
        let model = EnergyModel::default();
        let near = model.charge_to_return(2.0, 0.25);
        let far = model.charge_to_return(60.0, 0.25);
        assert!(near > 0.05 && near < 0.1, "{near}");
        assert!(far > near + 0.03, "{far}");
        assert!(model.charge_to_return(10.0, 0.0).is_finite());
    }
}
