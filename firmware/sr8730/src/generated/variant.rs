//! What a variant changes: a feature of its name chooses it. Made by cargo xtask codegen from robots/samsung-sr8730/variants. Do not edit.

use super::pins::Signal;

/// Lines of a display.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    /// Commons of the digits, from the left.
    pub digits: [Signal; 4],
    /// Segments a to g.
    pub segments: [Signal; 7],
    /// The colon.
    pub colon: Signal,
}

#[cfg(all(feature = "sr8750", feature = "sr8751"))]
compile_error!("a robot is one variant at most");

/// Name and version of the firmware, as the host is told.
#[cfg(not(any(feature = "sr8750", feature = "sr8751")))]
pub const FIRMWARE: &str = concat!("sr8730-", env!("CARGO_PKG_VERSION"));

/// The display, if one is fitted.
#[cfg(not(any(feature = "sr8750", feature = "sr8751")))]
pub const DISPLAY: Option<Display> = None;

/// Name and version of the firmware, as the host is told.
#[cfg(feature = "sr8750")]
pub const FIRMWARE: &str = concat!("sr8730-", env!("CARGO_PKG_VERSION"), "+sr8750");

/// The display, if one is fitted.
#[cfg(feature = "sr8750")]
pub const DISPLAY: Option<Display> = Some(Display {
    digits: [
        super::pins::DISPLAY_DIGIT_1,
        super::pins::DISPLAY_DIGIT_2,
        super::pins::DISPLAY_DIGIT_3,
        super::pins::DISPLAY_DIGIT_4,
    ],
    segments: [
        super::pins::DISPLAY_SEGMENT_A,
        super::pins::DISPLAY_SEGMENT_B,
        super::pins::LIGHT_LINE_0,
        super::pins::LIGHT_LINE_1,
        super::pins::LIGHT_LINE_2,
        super::pins::LIGHT_LINE_3,
        super::pins::LIGHT_LINE_4,
    ],
    colon: super::pins::DISPLAY_COLON,
});

/// Name and version of the firmware, as the host is told.
#[cfg(feature = "sr8751")]
pub const FIRMWARE: &str = concat!("sr8730-", env!("CARGO_PKG_VERSION"), "+sr8751");

/// The display, if one is fitted.
#[cfg(feature = "sr8751")]
pub const DISPLAY: Option<Display> = Some(Display {
    digits: [
        super::pins::DISPLAY_DIGIT_1,
        super::pins::DISPLAY_DIGIT_2,
        super::pins::DISPLAY_DIGIT_3,
        super::pins::DISPLAY_DIGIT_4,
    ],
    segments: [
        super::pins::DISPLAY_SEGMENT_A,
        super::pins::DISPLAY_SEGMENT_B,
        super::pins::LIGHT_LINE_0,
        super::pins::LIGHT_LINE_1,
        super::pins::LIGHT_LINE_2,
        super::pins::LIGHT_LINE_3,
        super::pins::LIGHT_LINE_4,
    ],
    colon: super::pins::DISPLAY_COLON,
});
