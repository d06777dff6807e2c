//! What comes over the line while no robot describes itself: how much, what it looks like, and the likely cause.
//!
//! A robot at the wrong speed sends as many bytes as ever, and they look like noise. A login console or the messages of another
//! computer are text. Both used to sound like a pulled cable. Where the serial port tells how many bytes had no stop bit in its place,
//! that decides what their look leaves open.

use core::fmt;

/// What is judged at a time, microseconds: a console that only prompts has said something by then.
const LOOK_US: u64 = 3_000_000;
/// Fewer bytes in that time are a cable that is touched.
const BYTES_MIN: u32 = 48;
/// Share of text above which it is text,
const TEXT_SHARE: f64 = 0.9;
/// and below which it is no text. Bytes at random are text in 38 of 100.
const NOISE_SHARE: f64 = 0.75;
/// Share of bytes with framing errors above which the speed is wrong, whatever the bytes look like: a sound line has next to none.
const FRAMING_SHARE: f64 = 0.05;
/// The same cause is told again after this time.
const AGAIN_US: u64 = 600_000_000;

/// Why bytes come and no robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineCause {
    /// They look like noise: most likely the line is set to another speed than the robot's.
    WrongSpeed,
    /// They are text: a login console or another program.
    Console,
}

impl LineCause {
    /// Its name, for people and for status.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::WrongSpeed => "line-wrong-speed",
            Self::Console => "line-has-console",
        }
    }
}

/// What was seen in a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineSight {
    pub(crate) cause: LineCause,
    pub(crate) bytes_per_s: f64,
    pub(crate) text_share: f64,
    /// None came, or the link has no port that tells them.
    pub(crate) framing_errors_per_s: f64,
}

impl fmt::Display for LineSight {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            bytes_per_s,
            text_share,
            framing_errors_per_s,
            ..
        } = self;
        let text_percent = 100.0 * text_share;
        write!(
            formatter,
            "{bytes_per_s:.0} bytes a second, {text_percent:.0} % of them text"
        )?;
        if *framing_errors_per_s > 0.0 {
            write!(formatter, ", {framing_errors_per_s:.0} framing errors a second")?;
        }
        Ok(())
    }
}

/// Counts what comes while nobody describes himself.
#[derive(Debug, Default)]
pub(crate) struct StrangeLine {
    since_us: u64,
    bytes: u32,
    text: u32,
    framing_errors: u32,
    /// Packets of a robot that had come at the last look.
    packets: u32,
    cause: Option<LineCause>,
    told: Option<(u64, LineCause)>,
}

impl StrangeLine {
    /// The line was opened, or a robot has described itself.
    pub(crate) fn restart(&mut self, now_us: u64) {
        (self.since_us, self.bytes, self.text, self.framing_errors) = (now_us, 0, 0, 0);
        self.cause = None;
    }

    /// A robot has described itself: what comes next is a new outage.
    pub(crate) fn forget(&mut self, now_us: u64) {
        self.restart(now_us);
        self.told = None;
    }

    pub(crate) fn count(&mut self, bytes: &[u8]) {
        let is_text = |byte: &&u8| matches!(byte, b' '..=b'~' | b'\n' | b'\r' | b'\t' | 0x1B);
        let text = bytes.iter().filter(is_text).count();
        let narrow = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        self.bytes = self.bytes.saturating_add(narrow(bytes.len()));
        self.text = self.text.saturating_add(narrow(text));
    }

    pub(crate) fn count_framing_errors(&mut self, count: u32) {
        self.framing_errors = self.framing_errors.saturating_add(count);
    }

    /// The likely cause.
    pub(crate) const fn cause(&self) -> Option<LineCause> {
        self.cause
    }

    /// Judges what came, of which so many in all were packets of a robot; gives what is worth a line. Who sends packets is a robot at the
    /// right speed, even if it has not described itself yet.
    pub(crate) fn look(&mut self, now_us: u64, packets: u32) -> Option<LineSight> {
        if core::mem::replace(&mut self.packets, packets) != packets {
            self.restart(now_us);
            return None;
        }
        let passed_us = now_us.saturating_sub(self.since_us);
        if passed_us < LOOK_US {
            return None;
        }
        let text_share = f64::from(self.text) / f64::from(self.bytes.max(1));
        let framing_share = f64::from(self.framing_errors) / f64::from(self.bytes.max(1));
        let per_s = |count: u32| f64::from(count) * 1e6 / passed_us as f64;
        let sight = |cause| LineSight {
            cause,
            bytes_per_s: per_s(self.bytes),
            text_share,
            framing_errors_per_s: per_s(self.framing_errors),
        };
        let seen = match self.bytes {
            bytes if bytes < BYTES_MIN => None,
            _ if framing_share >= FRAMING_SHARE => Some(sight(LineCause::WrongSpeed)),
            _ if text_share >= TEXT_SHARE => Some(sight(LineCause::Console)),
            _ if text_share < NOISE_SHARE => Some(sight(LineCause::WrongSpeed)),
            _ => None,
        };
        self.restart(now_us);
        self.cause = seen.map(|sight| sight.cause);
        let is_told = |cause: LineCause| {
            self.told
                .is_some_and(|(at_us, told)| told == cause && now_us.saturating_sub(at_us) < AGAIN_US)
        };
        let news = seen.filter(|sight| !is_told(sight.cause))?;
        self.told = Some((now_us, news.cause));
        Some(news)
    }
}

#[cfg(test)]
mod tests {
    use super::{LineCause, StrangeLine};

    fn look_after(line: &mut StrangeLine, from_s: u64, bytes: &[u8]) -> Vec<(LineCause, u64, u64)> {
        let mut seen = Vec::new();
        for second in from_s..from_s + 60 {
            line.count(bytes);
            if let Some(sight) = line.look((second + 1) * 1_000_000, 0) {
                let percent = (100.0 * sight.text_share).round() as u64;
                seen.push((sight.cause, sight.bytes_per_s.round() as u64, percent));
            }
        }
        seen
    }

    #[test]
    fn noise_and_text_have_their_names_and_a_change_is_told() {
        let mut line = StrangeLine::default();
        let noise: Vec<u8> = (0..2300_u32).map(|number| (number * 193 % 256) as u8).collect();
        assert_eq!(
            look_after(&mut line, 0, &noise),
            [(LineCause::WrongSpeed, 2300, 39)]
        );
        let prompt = b"\r\nDebian GNU/Linux 13 robot ttyS0\r\n\r\nrobot login: ";
        assert_eq!(
            look_after(&mut line, 60, prompt),
            [(LineCause::Console, prompt.len() as u64, 100)]
        );
        assert_eq!(look_after(&mut line, 120, prompt), [], "told already");
        assert_eq!(line.cause(), Some(LineCause::Console));
        assert_eq!(look_after(&mut line, 180, b""), []);
        assert_eq!(line.cause(), None, "silence is silence");
    }

    #[test]
    fn framing_errors_are_told_and_tell_a_wrong_speed_whatever_it_looks_like() {
        let mut line = StrangeLine::default();
        let looks_like_text = b"pppp~~~~xxxx";
        let mut seen = Vec::new();
        for second in 0..6 {
            for _ in 0..100 {
                line.count(looks_like_text);
                line.count_framing_errors(4);
            }
            seen.extend(line.look((second + 1) * 1_000_000, 0));
        }
        let [sight] = seen.as_slice() else {
            panic!("told once: {seen:?}")
        };
        assert_eq!(sight.cause, LineCause::WrongSpeed);
        assert_eq!(
            sight.to_string(),
            "1200 bytes a second, 100 % of them text, 400 framing errors a second"
        );
    }

    #[test]
    fn who_sends_packets_is_a_robot() {
        let mut line = StrangeLine::default();
        for second in 1..60 {
            line.count(&[0x81; 2300]);
            assert_eq!(line.look(second * 1_000_000, second as u32), None);
        }
        assert_eq!(line.cause(), None);
    }

    #[test]
    fn a_cable_that_is_touched_is_neither() {
        assert_eq!(look_after(&mut StrangeLine::default(), 0, &[0, 255, 0]), []);
    }
}
