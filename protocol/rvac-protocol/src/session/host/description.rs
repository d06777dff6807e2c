//! Collects the rows of the robot's description.

use rvac_units::Tick;

use crate::message::{Capabilities, CommandNames, DescribeRow, Description, Limits, MotorGaps, RowContent};

/// Pause before a row is requested again.
pub(super) const ASK_AGAIN_MS: u32 = 250;
/// Number of requests for a row before the rest stays unknown.
const ASKS_MAX: u8 = 20;

/// The rows received so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gathering {
    progress: GatheringProgress,
    limits: Option<Limits>,
    capabilities: Option<Capabilities>,
    commands: CommandNames,
    motors: MotorGaps,
}

#[derive(Clone, Copy, Debug, Default)]
enum GatheringProgress {
    #[default]
    Finished,
    Asking {
        row: u8,
        asked: Option<Tick>,
        asks: u8,
    },
}

impl Gathering {
    /// Begins with row 0.
    pub(super) fn begin() -> Self {
        Self {
            progress: GatheringProgress::Asking {
                row: 0,
                asked: None,
                asks: 0,
            },
            ..Self::default()
        }
    }

    /// The row to request now.
    pub(super) fn take_due(&mut self, now: Tick) -> Option<u8> {
        let GatheringProgress::Asking { row, asked, asks } = self.progress else {
            return None;
        };
        if asked.is_some_and(|asked| now.since(asked) < ASK_AGAIN_MS) {
            return None;
        }
        self.progress = if asks == ASKS_MAX {
            GatheringProgress::Finished
        } else {
            GatheringProgress::Asking {
                row,
                asked: Some(now),
                asks: asks.saturating_add(1),
            }
        };
        Some(row)
    }

    /// Takes a row; returns the whole description with the last one.
    pub(super) fn take(&mut self, row: &DescribeRow) -> Option<Description> {
        let GatheringProgress::Asking { row: expected, .. } = self.progress else {
            return None;
        };
        if row.row != expected {
            return None;
        }
        match row.content {
            RowContent::Limits(limits) => self.limits = Some(limits),
            RowContent::Capabilities(capabilities) => self.capabilities = Some(capabilities),
            RowContent::Commands(commands) => self.commands = commands,
            RowContent::Motors(gaps) => self.motors = gaps,
            RowContent::Parameter { .. } | RowContent::Unknown => {}
        }
        if row.row.saturating_add(1) < row.rows {
            self.progress = GatheringProgress::Asking {
                row: row.row.saturating_add(1),
                asked: None,
                asks: 0,
            };
            return None;
        }
        self.progress = GatheringProgress::Finished;
        Some(Description {
            capabilities: self.capabilities?,
            limits: self.limits?,
            motors: self.motors,
        })
    }

    pub(super) fn understood(&self) -> CommandNames {
        self.commands
    }

    pub(super) fn is_finished(&self) -> bool {
        matches!(self.progress, GatheringProgress::Finished)
    }
}
