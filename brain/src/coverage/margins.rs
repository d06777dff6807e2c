//! Margins of planned paths.

/// Gap between the body and known obstacles on planned paths, metres; the cell size adds a little.
pub(crate) const CLEARANCE_M: f64 = 0.01;
/// Lanes overlap by at least twice this, metres, whatever deviation the pose estimate reports.
pub(crate) const SIGMA_MIN_M: f64 = 0.01;
