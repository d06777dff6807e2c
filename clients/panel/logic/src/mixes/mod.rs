//! Editing of control mixes, without the browser: fields, the draft, learning and calibration.

mod draft;
mod field;
mod learning;
mod parts;

pub use draft::MixDraft;
pub use field::{Field, FieldKind, Group};
pub use learning::{CalibrationRun, Learning};
pub use parts::{InputPart, LinePart, OutputPart, SwitchPart};
