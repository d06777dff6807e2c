//! What fails on and around a robot's Linux board in real homes, one or two faults at a time and under control: whether people are told, soon and
//! with the right cause, whether nothing moves that must not, and whether what was acknowledged is kept.
//!
//! A fault that shows only while the robot turns, as a gyro's, is told within [`TOLD_MS`] of the first turn.

mod fault;
mod gap;
mod pad;
mod trial;
mod zone;

pub use fault::{BoardFault, BoardFaults};
pub use gap::{CarriedGap, Gap, Resumed};
pub use pad::PadFault;
pub use trial::{BoardFigures, BoardPassage, TOLD_MS, campaign, passage};
pub use zone::ZoneFault;
