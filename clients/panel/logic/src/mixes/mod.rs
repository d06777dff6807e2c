//! Editing of control mixes, without the browser: fields, the draft, learning and calibration.

mod curve;
mod curve_points;
mod draft;
mod field;
mod flight_part;
mod learning;
mod parts;
mod problem;
mod switch_part;
#[cfg(test)]
mod tests;

pub use curve::LineCurve;
pub use curve_points::CurvePoints;
pub use draft::{MixDraft, robot_has};
pub use field::{Field, FieldKind, Group, output_title};
pub use flight_part::{ModePart, TrimPart};
pub use learning::{CalibrationRun, Learning};
pub use parts::{InputPart, LinePart, OutputPart};
pub use problem::{FieldError, MixProblem, profile_problem_text};
pub use switch_part::SwitchPart;
