//! Values that a kept profile leaves out. Serde wants references.

pub(crate) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

pub(crate) fn is_none_ms(value: &u16) -> bool {
    *value == 0
}
