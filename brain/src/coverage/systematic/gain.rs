//! Ends a job whose last floor costs too much time: among chair legs that are not on the map each touch wins some square
//! centimetres, so no plan is without effect, and the robot would go on for hours.

use super::parameters::GAIN;

/// How much floor the work of the last minutes has won.
#[derive(Debug, Default)]
pub(super) struct Gain {
    /// Time of work so far, microseconds: pauses and charges do not count.
    worked_us: u64,
    stepped_us: Option<u64>,
    /// Most floor that was counted as swept since some was last taken back, square metres, and the time of work when it was.
    swept_m2: f64,
    won_us: u64,
}

impl Gain {
    /// A step of work at this time of the host, microseconds.
    pub(super) fn work(&mut self, now_us: u64) {
        let before_us = self.stepped_us.replace(now_us).unwrap_or(now_us);
        self.worked_us += now_us.saturating_sub(before_us).min(GAIN.step_max_us);
    }

    /// So much floor is swept now, square metres. It is less than before when a correction of the pose took back what was swept
    /// on the way to it: what is won afterwards is won, although it was counted elsewhere before.
    pub(super) fn count(&mut self, swept_m2: f64) {
        if swept_m2 >= self.swept_m2 + GAIN.worth_m2 {
            (self.swept_m2, self.won_us) = (swept_m2, self.worked_us);
        } else if swept_m2 <= self.swept_m2 - GAIN.worth_m2 {
            self.swept_m2 = swept_m2;
        }
    }

    /// Whether the last minutes were worth their time.
    pub(super) fn is_worth_it(&self) -> bool {
        self.worked_us - self.won_us < GAIN.within_us
    }

    /// Another part begins, or the robot looks once more for what it could not reach.
    pub(super) fn begin_anew(&mut self) {
        (self.swept_m2, self.won_us) = (0.0, self.worked_us);
    }
}

#[cfg(test)]
mod tests {
    use super::{GAIN, Gain};

    const STEP_US: u64 = 20_000;

    fn work(gain: &mut Gain, from_us: u64, for_us: u64) -> u64 {
        let end_us = from_us + for_us;
        (from_us..end_us)
            .step_by(STEP_US as usize)
            .for_each(|now_us| gain.work(now_us));
        end_us
    }

    #[test]
    fn minutes_that_win_too_little_are_not_worth_it_and_pauses_do_not_count() {
        let mut gain = Gain::default();
        let now_us = work(&mut gain, 7_000_000, GAIN.within_us / 2);
        gain.count(3.0);
        let now_us = work(&mut gain, now_us, GAIN.within_us - 2 * GAIN.step_max_us);
        gain.count(3.0 + 0.9 * GAIN.worth_m2);
        assert!(gain.is_worth_it());
        // Two hours on the charger.
        let now_us = work(&mut gain, now_us + 7_200_000_000, 5 * STEP_US);
        assert!(gain.is_worth_it());
        let now_us = work(&mut gain, now_us, 2 * GAIN.step_max_us);
        assert!(!gain.is_worth_it());
        gain.count(3.0 + GAIN.worth_m2);
        assert!(gain.is_worth_it());
        work(&mut gain, now_us, 2 * GAIN.within_us);
        gain.begin_anew();
        assert!(gain.is_worth_it());
    }

    #[test]
    fn floor_that_is_taken_back_and_swept_again_is_won() {
        let mut gain = Gain::default();
        gain.count(292.0);
        let now_us = work(&mut gain, 0, GAIN.within_us / 2);
        gain.count(276.0);
        let now_us = work(&mut gain, now_us, GAIN.within_us / 4);
        gain.count(276.0 + 2.0 * GAIN.worth_m2);
        let now_us = work(&mut gain, now_us, GAIN.within_us / 2);
        assert!(gain.is_worth_it());
        // That it was taken back is no gain.
        gain.count(270.0);
        work(&mut gain, now_us, GAIN.within_us);
        assert!(!gain.is_worth_it());
    }
}
