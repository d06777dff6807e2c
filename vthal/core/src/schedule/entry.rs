//! An entry: what starts, when, and what was decided of it.

use rvac_api::{InQuiet, ScheduledJob};

use super::When;
use super::marks::Marks;

/// What a person asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// For people.
    pub name: String,
    /// Whether it starts anything.
    pub enabled: bool,
    /// What starts.
    pub job: ScheduledJob,
    /// When.
    pub when: When,
    /// How late it may start, minutes.
    pub late_min: u16,
    /// What happens in the quiet hours.
    pub in_quiet: InQuiet,
    /// The floor on which it starts; none for any.
    pub floor: Option<u16>,
}

/// A plan that is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its number, never used twice.
    pub(super) number: u32,
    /// What was asked for.
    pub(super) plan: Plan,
    /// Its next run is left out.
    pub(super) skip_next: bool,
    /// Runs that were due before this instant do not count: the plan was made or changed then.
    pub(super) since_s: i64,
    /// The decided runs.
    pub(super) marks: Marks,
}

impl Entry {
    /// Its number.
    #[must_use]
    pub fn number(&self) -> u32 {
        self.number
    }

    /// What was asked for.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Whether its next run is left out.
    #[must_use]
    pub fn skips_next(&self) -> bool {
        self.skip_next
    }
}
