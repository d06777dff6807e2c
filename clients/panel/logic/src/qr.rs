//! A QR code as a picture, for the camera of a phone.

use std::fmt::Write as _;

use qrcodegen::{QrCode, QrCodeEcc};

/// Light cells around it, without which cameras do not find it.
const QUIET: i32 = 4;

/// A QR code; a cell is one unit wide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QrPicture {
    /// Width and height, with the light border.
    pub size: i32,
    /// The dark cells, as `d` of an SVG path.
    pub path: String,
}

impl QrPicture {
    /// The picture of a text; none if it is too long for a code.
    #[must_use]
    pub fn of(text: &str) -> Option<Self> {
        let code = QrCode::encode_text(text, QrCodeEcc::Low).ok()?;
        let mut path = String::new();
        for y in 0..code.size() {
            let dark = (0..code.size()).filter(|x| code.get_module(*x, y));
            for x in dark {
                write!(path, "M{} {}h1v1h-1z", x + QUIET, y + QUIET).ok()?;
            }
        }
        Some(Self {
            size: code.size() + 2 * QUIET,
            path,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::QrPicture;

    #[test]
    fn the_marks_by_which_cameras_find_it_are_in_three_corners() {
        let picture = QrPicture::of("https://192.168.1.20:8443/").unwrap();
        let is_dark = |x: i32, y: i32| picture.path.contains(&format!("M{x} {y}h"));
        let is_mark = |left: i32, top: i32| {
            (0..7).all(|y| {
                (0..7).all(|x: i32| {
                    let ring = x.min(6 - x).min(y.min(6 - y));
                    is_dark(left + x, top + y) == (ring != 1)
                })
            })
        };
        let far = picture.size - 4 - 7;
        assert!(is_mark(4, 4) && is_mark(far, 4) && is_mark(4, far));
        assert!(!is_mark(far, far));
        let edge = (0..picture.size).any(|place| is_dark(place, 3) || is_dark(3, place));
        assert!(!edge, "a light border");
    }

    #[test]
    fn what_is_too_long_is_not_shown() {
        assert_eq!(QrPicture::of(&"x".repeat(5000)), None);
    }
}
