//! A QR code in half blocks, for the camera of a phone.

use qrcodegen::{QrCode, QrCodeEcc};

/// Light cells around it, without which cameras do not find it.
const QUIET: i32 = 4;

/// Black cells on white ones, independent of the terminal's colours.
const COLOURS: &str = "\u{1b}[30;107m";
const PLAIN: &str = "\u{1b}[0m";

/// The lines that show `text`; none if it is too long for a code.
pub(crate) fn lines(text: &str) -> Vec<String> {
    let Ok(code) = QrCode::encode_text(text, QrCodeEcc::Low) else {
        return Vec::new();
    };
    let cells = -QUIET..code.size() + QUIET;
    cells
        .clone()
        .step_by(2)
        .map(|y| {
            let halves = cells
                .clone()
                .map(|x| half_blocks([y, y + 1].map(|y| code.get_module(x, y))));
            format!("{COLOURS}{}{PLAIN}", halves.collect::<String>())
        })
        .collect()
}

/// Two cells, the upper one first, as one letter.
const fn half_blocks(dark: [bool; 2]) -> char {
    match dark {
        [true, true] => '█',
        [true, false] => '▀',
        [false, true] => '▄',
        [false, false] => ' ',
    }
}

#[cfg(test)]
mod tests {
    use super::{COLOURS, PLAIN, lines};

    /// The cells of the lines, row by row.
    fn cells(lines: &[String]) -> Vec<Vec<bool>> {
        let mut rows = Vec::new();
        for line in lines {
            let line = line.strip_prefix(COLOURS).unwrap().strip_suffix(PLAIN).unwrap();
            rows.push(line.chars().map(|c| matches!(c, '█' | '▀')).collect());
            rows.push(line.chars().map(|c| matches!(c, '█' | '▄')).collect());
        }
        rows
    }

    #[test]
    fn the_marks_by_which_cameras_find_it_are_in_three_corners() {
        let rows = cells(&lines("https://192.168.1.20:8443/"));
        let size = rows[0].len() - 8;
        let mark = |x: usize, y: usize| {
            (0..7).all(|dy| {
                (0..7).all(|dx| {
                    let ring = dx.min(6 - dx).min(dy.min(6 - dy));
                    rows[4 + y + dy][4 + x + dx] == (ring != 1)
                })
            })
        };
        assert!(mark(0, 0) && mark(size - 7, 0) && mark(0, size - 7));
        assert!(!mark(size - 7, size - 7));
        assert!(rows[..4].iter().flatten().all(|dark| !dark), "a light border");
    }

    #[test]
    fn what_is_too_long_is_not_shown() {
        assert!(lines(&"x".repeat(5000)).is_empty());
    }
}
