//! What earlier runs found in a cell. It ages in runs, not in time: a robot that stands for a month has learnt nothing meanwhile.
//!
//! *Touch*: an obstacle that only the bumper has found. The planner keeps away from it, so a wrong one is never disproven. It therefore
//! expires after some runs without a new touch, later each time that it was met again.

/// What earlier runs found in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct CellPast {
    /// Runs that touched something there, up to [`CellPast::TOUCHED_MAX`].
    pub(super) touched_runs: u8,
    /// Runs without a touch after which the touch expires; 0 = it has.
    pub(super) runs_left: u8,
}

/// Runs that a touch lasts, by the number of runs that touched it. Two runs are as in the trial that ended the collapse of kept maps;
/// that it lasts twice as long each time is a choice against bumps, not compared with others.
const LASTS_RUNS: [u8; 4] = [0, 2, 4, 8];

impl CellPast {
    /// Largest number of runs that is counted.
    const TOUCHED_MAX: u8 = 3;
    /// Bits of a packed past; all others are 0.
    pub(super) const BITS: u16 = 0b11_1111;

    /// After a run that touched something there.
    pub(super) fn after_touch(self) -> Self {
        let touched_runs = (self.touched_runs + 1).min(Self::TOUCHED_MAX);
        Self {
            touched_runs,
            runs_left: LASTS_RUNS.get(usize::from(touched_runs)).copied().unwrap_or(0),
        }
    }

    /// After a run that passed and touched nothing there.
    pub(super) fn after_passing(self) -> Self {
        Self {
            runs_left: self.runs_left.saturating_sub(1),
            ..self
        }
    }

    /// Past of a cell with this contact evidence, as a map of a version without pasts keeps it.
    pub(super) fn of_contact(contact: u8) -> Self {
        if contact == 0 {
            Self::default()
        } else {
            Self::default().after_touch()
        }
    }

    /// From the lowest bit: 2 bits runs that touched, 4 bits runs left.
    pub(super) fn packed(self) -> u16 {
        u16::from(self.touched_runs.min(Self::TOUCHED_MAX)) | u16::from(self.runs_left.min(15)) << 2
    }

    pub(super) fn unpacked(bits: u16) -> Self {
        Self {
            touched_runs: (bits & 0b11) as u8,
            runs_left: (bits >> 2 & 0b1111) as u8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::CellPast;

    #[test]
    fn a_past_is_unpacked_as_it_was_packed() {
        for touched_runs in 0..=3 {
            for runs_left in 0..=15 {
                let past = CellPast {
                    touched_runs,
                    runs_left,
                };
                assert_eq!(CellPast::unpacked(past.packed()), past);
                assert_eq!(past.packed() & !CellPast::BITS, 0);
            }
        }
    }
}
