//! Drives over known floor to one of several places: before the dock, where one of its beams was received, or where a person sends the
//! robot.

mod drive;
mod parameters;
mod path_inputs;
mod unseen_specks;
mod visit;

pub(crate) use drive::{PastFloor, Travel, TravelStep};
pub(crate) use path_inputs::path_length_m;
pub(crate) use visit::Visit;
