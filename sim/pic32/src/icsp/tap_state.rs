//! The state machine of a test access port, IEEE 1149.1.

/// Where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TapState {
    TestLogicReset,
    Idle,
    SelectData,
    CaptureData,
    ShiftData,
    Exit1Data,
    PauseData,
    Exit2Data,
    UpdateData,
    SelectInstruction,
    CaptureInstruction,
    ShiftInstruction,
    Exit1Instruction,
    PauseInstruction,
    Exit2Instruction,
    UpdateInstruction,
}

impl TapState {
    /// Where it goes with this level of TMS.
    pub(super) const fn next(self, tms: bool) -> Self {
        let (low, high) = match self {
            Self::TestLogicReset => (Self::Idle, Self::TestLogicReset),
            Self::Idle | Self::UpdateData | Self::UpdateInstruction => (Self::Idle, Self::SelectData),
            Self::SelectData => (Self::CaptureData, Self::SelectInstruction),
            Self::CaptureData | Self::ShiftData => (Self::ShiftData, Self::Exit1Data),
            Self::Exit1Data => (Self::PauseData, Self::UpdateData),
            Self::PauseData => (Self::PauseData, Self::Exit2Data),
            Self::Exit2Data => (Self::ShiftData, Self::UpdateData),
            Self::SelectInstruction => (Self::CaptureInstruction, Self::TestLogicReset),
            Self::CaptureInstruction | Self::ShiftInstruction => {
                (Self::ShiftInstruction, Self::Exit1Instruction)
            }
            Self::Exit1Instruction => (Self::PauseInstruction, Self::UpdateInstruction),
            Self::PauseInstruction => (Self::PauseInstruction, Self::Exit2Instruction),
            Self::Exit2Instruction => (Self::ShiftInstruction, Self::UpdateInstruction),
        };
        if tms { high } else { low }
    }
}

#[cfg(test)]
mod tests {
    use super::TapState;

    fn walk(from: TapState, levels: &[u8]) -> TapState {
        levels.iter().fold(from, |state, level| state.next(*level == 1))
    }

    #[test]
    fn five_ones_lead_to_reset_from_everywhere() {
        let mut reached = vec![TapState::TestLogicReset];
        let mut next = 0;
        while let Some(state) = reached.get(next).copied() {
            for tms in [false, true] {
                if !reached.contains(&state.next(tms)) {
                    reached.push(state.next(tms));
                }
            }
            next += 1;
        }
        assert_eq!(reached.len(), 16);
        for state in reached {
            assert_eq!(
                walk(state, &[1, 1, 1, 1, 1]),
                TapState::TestLogicReset,
                "{state:?}"
            );
        }
    }

    #[test]
    fn the_usual_sequences_end_where_they_began() {
        assert_eq!(walk(TapState::Idle, &[1, 1, 0, 0]), TapState::ShiftInstruction);
        assert_eq!(
            walk(TapState::ShiftInstruction, &[0, 0, 0, 0, 1, 1, 0]),
            TapState::Idle
        );
        assert_eq!(walk(TapState::Idle, &[1, 0, 0]), TapState::ShiftData);
        assert_eq!(walk(TapState::ShiftData, &[0, 1, 1, 0]), TapState::Idle);
    }
}
