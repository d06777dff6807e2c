//! Margins of planned ways.

/// Gap between body and known obstacles on planned ways, metres; the size of cells adds a little.
pub(crate) const KEEP_OFF_M: f64 = 0.01;
/// Lanes overlap by twice this at least, whatever the estimate says of itself.
pub(crate) const SIGMA_MIN_M: f64 = 0.01;
