//! The DWM1001 module of Qorvo (Decawave) with its stock firmware PANS, as a tag: what its shell prints for each
//! measurement, and how it is made to.
//!
//! The commands and their output are those of the DWM1001 Firmware API Guide 2.2: two returns within a second open the
//! shell, `lec` switches the output of distances on and off, and a further return repeats the last command. A line is
//!
//! ```text
//! DIST,2,AN0,1151,5.00,8.00,2.25,6.48,AN1,0CA8,0.00,8.00,2.25,6.51,POS,2.57,1.98,1.68,100
//! ```
//!
//! with number, address, place in the module's own frame and distance of each anchor; `les` prints
//!
//! ```text
//! 1151[5.00,8.00,2.25]=6.48 0CA8[0.00,8.00,2.25]=6.51 le_us=2576 est[2.57,1.98,1.68,100]
//! ```
//!
//! Both are read. Places and position are not used: whoever hangs up the anchors need not measure them. At high rates the
//! module mixes up a line now and then; such a line is refused whole.

use std::time::Duration;

use super::reading::{BeaconName, LineError, Reading};

/// Anchors in a line at most: the module measures four, newer firmware some more.
const ANCHORS_MAX: usize = 15;
/// Fields of an anchor in the output of `lec`: number, address, x, y, z, distance.
const FIELDS: usize = 6;
/// Letters of an address.
const ADDRESS: usize = 4;

/// What a line of the shell says; nothing where the shell talks of something else.
pub(super) fn read(line: &str) -> Result<Vec<Reading>, LineError> {
    let line = line.trim();
    if let Some(fields) = line.strip_prefix("DIST,") {
        return read_lec(fields);
    }
    let is_les = line.split(' ').next().is_some_and(|word| {
        let (address, place) = word.split_at_checked(ADDRESS).unwrap_or_default();
        place.starts_with('[') && is_address(address)
    });
    if is_les { read_les(line) } else { Ok(Vec::new()) }
}

fn read_lec(fields: &str) -> Result<Vec<Reading>, LineError> {
    let fields: Vec<&str> = fields.split(',').collect();
    let wrong_count = || LineError::Count(fields.first().copied().unwrap_or_default().to_owned());
    let count: usize = fields
        .first()
        .and_then(|count| count.parse().ok())
        .filter(|count| *count <= ANCHORS_MAX)
        .ok_or_else(wrong_count)?;
    let anchors = fields.get(1..=count * FIELDS).ok_or_else(wrong_count)?;
    // After the anchors come the position or nothing; anything else is a line that was mixed up.
    match fields.get(count * FIELDS + 1) {
        None | Some(&"POS") => {}
        Some(_) => return Err(wrong_count()),
    }
    anchors
        .chunks_exact(FIELDS)
        .enumerate()
        .map(|(number, anchor)| match anchor {
            [label, address, x, y, z, range]
                if *label == format!("AN{number}") && [x, y, z].into_iter().all(|field| is_number(field)) =>
            {
                reading(number, address, range)
            }
            _ => Err(LineError::Anchor(number)),
        })
        .collect()
}

fn read_les(line: &str) -> Result<Vec<Reading>, LineError> {
    line.split_ascii_whitespace()
        .take_while(|word| !word.starts_with("le_us=") && !word.starts_with("est["))
        .take(ANCHORS_MAX)
        .enumerate()
        .map(|(number, word)| {
            let parts = word
                .split_once('[')
                .and_then(|(address, rest)| Some((address, rest.split_once("]=")?)));
            match parts {
                Some((address, (place, range)))
                    if place.split(',').count() == 3 && place.split(',').all(is_number) =>
                {
                    reading(number, address, range)
                }
                _ => Err(LineError::Anchor(number)),
            }
        })
        .collect()
}

fn reading(number: usize, address: &str, range: &str) -> Result<Reading, LineError> {
    let broken = LineError::Anchor(number);
    if !is_address(address) || !is_number(range) {
        return Err(broken);
    }
    let (Ok(name), Ok(range_m)) = (BeaconName::new(address), range.parse()) else {
        return Err(broken);
    };
    Reading::range(name, range_m, None)
}

fn is_address(text: &str) -> bool {
    text.len() == ADDRESS
        && text
            .bytes()
            .all(|byte| byte.is_ascii_digit() || (b'A'..=b'F').contains(&byte))
}

/// Digits with a point, as the module writes them; not all that Rust would take for a number.
fn is_number(text: &str) -> bool {
    let digits = text.strip_prefix('-').unwrap_or(text);
    digits.starts_with(|letter: char| letter.is_ascii_digit())
        && digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.')
}

/// A module that already prints sends a line within this time.
const LISTEN: Duration = Duration::from_secs(2);
/// Time that the module takes to open its shell.
const SHELL: Duration = Duration::from_secs(1);
/// Longest silence before the module gets the command again. A tag that rests measures every ten seconds if it is left as it comes.
const SILENCE: Duration = Duration::from_secs(30);

/// Makes a module print, and leaves one alone that does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waker {
    step: Step,
    due: Duration,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Shell,
    Command,
}

impl Waker {
    /// The device was opened at `now`.
    pub(super) const fn opened(now: Duration) -> Self {
        Self {
            step: Step::Shell,
            due: now.saturating_add(LISTEN),
        }
    }

    /// The module printed distances.
    pub(super) const fn heard(&mut self, now: Duration) {
        *self = Self {
            step: Step::Shell,
            due: now.saturating_add(SILENCE),
        };
    }

    /// When there is something to be done.
    pub(super) const fn due(&self) -> Duration {
        self.due
    }

    /// What is to be sent now.
    pub(super) fn send(&mut self, now: Duration) -> Option<&'static [u8]> {
        if now < self.due {
            return None;
        }
        let (bytes, step, pause): (&[u8], _, _) = match self.step {
            Step::Shell => (b"\r\r", Step::Command, SHELL),
            Step::Command => (b"lec\r", Step::Shell, SILENCE),
        };
        *self = Self {
            step,
            due: now.saturating_add(pause),
        };
        Some(bytes)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::super::reading::Measured;
    use super::{Waker, read};

    fn ranges(line: &str) -> Vec<(String, f64)> {
        let readings = read(line).unwrap();
        readings
            .into_iter()
            .map(|reading| match reading.measured {
                Measured::Range(range_m, None) => (reading.beacon.to_string(), range_m),
                other => panic!("{other:?}"),
            })
            .collect()
    }

    #[test]
    fn both_outputs_of_the_module_are_read() {
        let expected = vec![("1151".to_owned(), 6.48), ("0CA8".to_owned(), 6.51)];
        let lec =
            "DIST,2,AN0,1151,5.00,8.00,2.25,6.48,AN1,0CA8,0.00,-8.00,2.25,6.51,POS,2.57,1.98,1.68,100\r";
        assert_eq!(ranges(lec), expected);
        assert_eq!(
            ranges("DIST,2,AN0,1151,5.00,8.00,2.25,6.48,AN1,0CA8,0.00,8.00,2.25,6.51"),
            expected
        );
        let les = "1151[5.00,8.00,2.25]=6.48 0CA8[0.00,-8.00,2.25]=6.51 le_us=2576 est[2.57,1.98,1.68,100]";
        assert_eq!(ranges(les), expected);
        assert_eq!(ranges("DIST,0"), []);
    }

    #[test]
    fn what_else_the_shell_says_is_no_fault_and_no_distance() {
        for line in [
            "",
            "dwm>",
            "dwm> lec",
            " DWM1001 TWR Real Time Location System",
            "POS,7.10,5.24,-2.03,53",
            "[000541.890 INF] mode: tn (act,twr,np,le)",
        ] {
            assert_eq!(ranges(line), [], "{line}");
        }
    }

    #[test]
    fn mixed_up_lines_are_refused_whole() {
        for line in [
            // As a module printed it at a high rate: the last anchor begins twice.
            "DIST,4,AN0,0090,0.00,0.00,0.00,3.25,AN1,D91E,0.00,0.00,0.00,3.33,AN2,0487,0.00,0.00,0.00,0.18,AN3,15BA,0.00,0,AN3,15BA,0.00,0.00,0.00,0.00",
            "DIST,4,AN0,0090,0.00,0.00,0.00,3.25",
            "DIST,x",
            "DIST,99",
            "DIST,1,AN1,0090,0.00,0.00,0.00,3.25",
            "DIST,1,AN0,009,0.00,0.00,0.00,3.25",
            "DIST,1,AN0,0090,0.00,0.00,0.00,inf",
            "DIST,1,AN0,0090,0.00,0.00,0.00,-3.25",
            "DIST,1,AN0,0090,0.00,0.00,0.00,1e1",
            "1151[5.00,8.00,2.25]=6.48 0CA8[0.00,8.00]=6.51",
            "1151[5.00,8.00,2.25]=",
            "1151[5.00,8.00,2.25",
        ] {
            assert!(read(line).is_err(), "{line}");
        }
    }

    #[test]
    fn a_silent_module_is_told_to_print_and_one_that_prints_is_left_alone() {
        let s = Duration::from_secs;
        let mut waker = Waker::opened(s(0));
        assert_eq!(waker.send(s(1)), None);
        assert_eq!(waker.send(s(2)), Some(&b"\r\r"[..]));
        assert_eq!(waker.send(s(2)), None);
        assert_eq!(waker.send(s(3)), Some(&b"lec\r"[..]));
        for second in 4..60 {
            waker.heard(s(second));
            assert_eq!(waker.send(s(second)), None, "second {second}");
        }
        assert_eq!(waker.send(s(88)), None);
        assert_eq!(
            waker.send(s(89)),
            Some(&b"\r\r"[..]),
            "it was switched off and on"
        );
    }
}
