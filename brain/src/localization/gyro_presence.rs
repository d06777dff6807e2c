//! Whether a gyro that was heard before has fallen silent.

/// Silence after which a gyro is missed, microseconds.
const MISSED_US: u64 = 2_000_000;
/// It must be heard for so long before it counts as back, microseconds; doubled with each loss,
const BACK_US: u64 = 1_000_000;
/// up to this: a gyro with a loose plug is told as silent and not as coming and going.
const BACK_MAX_US: u64 = 60_000_000;

/// Presence of the gyro.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GyroPresence {
    /// First reading since the last gap, and the newest reading.
    heard_us: Option<(u64, u64)>,
    is_silent: bool,
    losses: u32,
}

impl GyroPresence {
    /// Takes whether an observation has a heading of the gyro.
    pub(super) fn follow(&mut self, now_us: u64, is_heard: bool) {
        let Some((since_us, last_us)) = self.heard_us else {
            self.heard_us = is_heard.then_some((now_us, now_us));
            return;
        };
        let was_away = now_us.saturating_sub(last_us) >= MISSED_US;
        if was_away && !self.is_silent {
            self.is_silent = true;
            self.losses = self.losses.saturating_add(1);
        }
        if !is_heard {
            return;
        }
        let since_us = if was_away { now_us } else { since_us };
        self.heard_us = Some((since_us, now_us));
        let wait_us = BACK_US
            .saturating_mul(1 << self.losses.saturating_sub(1).min(16))
            .min(BACK_MAX_US);
        if now_us.saturating_sub(since_us) >= wait_us {
            self.is_silent = false;
        }
    }

    /// It was heard before, and is not heard now or comes and goes.
    pub(super) fn is_silent(self) -> bool {
        self.is_silent
    }
}

#[cfg(test)]
mod tests {
    use super::GyroPresence;

    fn pass(presence: &mut GyroPresence, now_us: &mut u64, seconds: u64, is_heard: bool) -> u32 {
        let mut changes = 0;
        for _ in 0..seconds * 50 {
            *now_us += 20_000;
            let before = presence.is_silent();
            presence.follow(*now_us, is_heard);
            changes += u32::from(presence.is_silent() != before);
        }
        changes
    }

    #[test]
    fn silence_is_noticed_after_two_seconds_and_its_end_too() {
        let (mut presence, mut now_us) = (GyroPresence::default(), 0);
        assert_eq!(pass(&mut presence, &mut now_us, 60, false), 0, "there is none");
        assert_eq!(pass(&mut presence, &mut now_us, 60, true), 0);
        assert_eq!(pass(&mut presence, &mut now_us, 1, false), 0);
        assert_eq!(pass(&mut presence, &mut now_us, 2, false), 1);
        assert!(presence.is_silent());
        assert_eq!(pass(&mut presence, &mut now_us, 2, true), 1);
        assert!(!presence.is_silent());
    }

    #[test]
    fn a_loose_plug_is_not_told_at_each_contact() {
        let (mut presence, mut now_us) = (GyroPresence::default(), 0);
        let mut changes = 0;
        for _ in 0..360 {
            changes += pass(&mut presence, &mut now_us, 7, true);
            changes += pass(&mut presence, &mut now_us, 3, false);
        }
        assert!(changes < 10, "{changes} changes in an hour");
    }
}
