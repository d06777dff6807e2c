//! What starts by itself: the schedules, and what is decided about each of their runs.
//!
//! *Entry*: a job with a rule that says when. *Due*: the instant that the rule means on a date, in the local time of the robot's
//! zone. *Run*: an entry on a local date; that pair is its key. *Mark*: the note that a run was decided. A mark is on the disk
//! before the robot receives the command, so no run happens twice, whatever the clock does. *Verdict*: what was decided of a run,
//! by name. *Late*: started after its time, because the daemon did not run or had no robot.
//!
//! Nothing here reads a clock: the present is an argument, in seconds since 1970 (UTC). [`Book`] holds the entries,
//! [`verdict`] decides, [`planned`] foretells. Storing and starting is the business of whoever calls.

mod book;
mod entry;
mod from_api;
mod marks;
mod planned;
mod quiet;
mod stored;
mod to_api;
mod verdict;
mod when;
mod zone;
mod zone_reading;

pub use book::{Book, EditError, ScheduleEdit};
pub use entry::{Entry, Plan};
pub use from_api::ScheduleError;
pub use planned::{Blocker, Held, Planned, planned};
pub use quiet::Quiet;
pub use stored::{StoredBook, StoredError};
pub(crate) use to_api::{Keeping, view};
pub use verdict::{GRACE_S, NO_ROBOT, Outcome, Verdict, verdict};
pub use when::{Days, When};
pub use zone::{WallClock, Zone};
pub use zone_reading::ZoneReading;

/// Before 2024 no clock of a robot is right: a board without a battery for its clock begins in 1970, or when its system was
/// made.
pub const CLOCK_IS_SET_FROM_S: i64 = 1_704_067_200;

/// A clock that differs by so much from what it should show was set by somebody, seconds; less is the clock itself.
pub const CLOCK_WAS_SET_S: u64 = 60;
