//! What driving and cleaning take from the pack, learnt from its charge.
//!
//! Terms. *Rate*: share of the whole charge (0..1) that a second takes. *LearningWindow*: minutes over which what was expected is
//! compared with what the pack lost; the error is given to the rates by the time spent with each.
//!
//! A model belongs to one robot and its pack. It knows two activities, because one brain drives with two: with cleaning
//! parts and without.

/// A pack of 2 Ah empties in an hour of cleaning, and in three of driving alone: the data sheet figures of
/// `robots/samsung-sr8730/robot.toml`, until the robot knows better.
const CLEANING_PER_S: f64 = 1.0 / 3_600.0;
const DRIVING_PER_S: f64 = 1.0 / 10_800.0;
/// Length of a window: the charge is told in steps and wavers by some percent with the load.
const WINDOW_S: f64 = 300.0;
/// Share of a window's error that the rates take up.
const GAIN: f64 = 0.4;
/// A rate is believed within these factors of the first guess.
const FACTOR: (f64, f64) = (0.2, 5.0);
/// The way home may take so many times what the model tells.
const MARGIN: f64 = 1.3;
/// Charge that is left on the dock after that.
const RESERVE: f64 = 0.05;
/// A way by the map takes so many times its length at cruise speed.
const WAY_FACTOR: f64 = 1.5;
/// Finding the line and driving in, with a few tries, seconds.
const APPROACH_S: f64 = 90.0;

/// Lanes in corners take so many times what the same floor takes in the open.
const CORNER_FACTOR: f64 = 2.0;
/// Rest of a job that may be left at all, share of its floor: in clutter a job ends by itself with hardly less.
const CRUMBS_MAX: f64 = 0.05;

/// What of a job is left when the pack is low.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RemainingWork {
    /// Floor, square metres, and its share of what the job wants, 0..=1.
    pub(crate) left_m2: f64,
    pub(crate) share: f64,
    /// Way to the dock, metres.
    pub(crate) way_m: f64,
}

/// What the wheels and the cleaning parts do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// The robot drives and cleans.
    Cleaning,
    /// It drives.
    Driving,
    /// It rests, is charged, or is in somebody's hands: nothing is learnt.
    Other,
}

/// Learnt rates, shares of the whole charge a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyModel {
    /// Driving with cleaning parts.
    pub cleaning_per_s: f64,
    /// Driving without.
    pub driving_per_s: f64,
    /// Seconds that were learnt from; 0 = the rates are those of the data sheet.
    pub seen_s: f64,
}

impl Default for EnergyModel {
    fn default() -> Self {
        Self {
            cleaning_per_s: CLEANING_PER_S,
            driving_per_s: DRIVING_PER_S,
            seen_s: 0.0,
        }
    }
}

impl EnergyModel {
    /// A model from outside, within what is believed.
    #[must_use]
    pub fn checked(self) -> Self {
        Self {
            cleaning_per_s: within(self.cleaning_per_s, CLEANING_PER_S),
            driving_per_s: within(self.driving_per_s, DRIVING_PER_S),
            seen_s: if self.seen_s.is_finite() {
                self.seen_s.max(0.0)
            } else {
                0.0
            },
        }
    }

    /// Share of the whole charge that a job of so many seconds takes.
    #[must_use]
    pub fn charge_for(&self, cleaning_s: f64, driving_s: f64) -> f64 {
        self.cleaning_per_s * cleaning_s + self.driving_per_s * driving_s
    }

    /// The charge with which the robot must set out on a way home of `way_m` metres at `cruise_m_per_s`.
    #[must_use]
    pub fn charge_to_return(&self, way_m: f64, cruise_m_per_s: f64) -> f64 {
        MARGIN * self.charge_for(0.0, time_to_return_s(way_m, cruise_m_per_s)) + RESERVE
    }

    /// Whether so little is left that a charge for it would mostly go into the ways there and back: then the job is over.
    pub(crate) fn is_negligible(&self, left: RemainingWork, (swath_m, cruise_m_per_s): (f64, f64)) -> bool {
        let cleaning_s = CORNER_FACTOR * left.left_m2 / (swath_m * cruise_m_per_s).max(0.01);
        let ways_s = 2.0 * time_to_return_s(left.way_m, cruise_m_per_s);
        left.share <= CRUMBS_MAX && self.charge_for(cleaning_s, 0.0) < self.charge_for(0.0, ways_s)
    }
}

/// Seconds that a way home of `way_m` metres takes, docking included.
pub(crate) fn time_to_return_s(way_m: f64, cruise_m_per_s: f64) -> f64 {
    WAY_FACTOR * way_m / cruise_m_per_s.max(0.05) + APPROACH_S
}

fn within(rate: f64, guess: f64) -> f64 {
    if rate.is_finite() {
        rate.clamp(FACTOR.0 * guess, FACTOR.1 * guess)
    } else {
        guess
    }
}

/// A model that learns.
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

    /// Takes in `time_s` of an activity, after which the pack holds `charge`.
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
        if window.cleaning_s + window.driving_s >= WINDOW_S {
            let window = *window;
            self.learn(window, window.charge - charge);
            self.window = None;
        }
    }

    fn learn(&mut self, window: LearningWindow, lost: f64) {
        // A pack that gained was exchanged, or its charge is a guess that was put right.
        if lost <= 0.0 {
            return;
        }
        let error = lost - self.model.charge_for(window.cleaning_s, window.driving_s);
        let square_s2 = window.cleaning_s * window.cleaning_s + window.driving_s * window.driving_s;
        let step_per_s2 = GAIN * error / square_s2;
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
    use super::{Activity, EnergyLearner, EnergyModel, RemainingWork};

    #[test]
    fn what_is_left_is_worth_a_charge_unless_the_ways_take_more_than_the_floor() {
        let model = EnergyModel::default();
        let is_negligible = |left_m2, share, way_m| {
            let left = RemainingWork {
                left_m2,
                share,
                way_m,
            };
            model.is_negligible(left, (0.3, 0.25))
        };
        assert!(is_negligible(0.3, 0.005, 8.0));
        assert!(!is_negligible(0.3, 0.06, 8.0), "a corner of a small room");
        assert!(!is_negligible(4.0, 0.03, 8.0), "some minutes of a large home");
        assert!(is_negligible(4.0, 0.03, 60.0), "far away");
        assert!(!is_negligible(f64::NAN, 0.01, 8.0));
    }

    /// Hours of cleaning and driving in turns, with these rates.
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
                // The wire tells the charge in steps.
                let told = (charge * 1_000.0_f64).round() / 1_000.0;
                learner.update(1.0, activity, Some(told as f32));
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
    fn nonsense_is_not_learnt() {
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
    fn a_longer_way_home_needs_more() {
        let model = EnergyModel::default();
        let near = model.charge_to_return(2.0, 0.25);
        let far = model.charge_to_return(60.0, 0.25);
        assert!(near > 0.05 && near < 0.1, "{near}");
        assert!(far > near + 0.03, "{far}");
        assert!(model.charge_to_return(10.0, 0.0).is_finite());
    }
}
