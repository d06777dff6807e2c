//! Measures how smoothly the map moves.

use std::collections::VecDeque;

/// Span of the measurement in seconds.
const SPAN_S: f64 = 2.0;

/// A longer pause means that nothing moved in between, not that a frame took so long.
const PAUSE_S: f64 = 0.5;

/// Times of the frames of the last two seconds of motion.
#[derive(Clone, Debug, Default)]
pub struct FrameMeter {
    frames_s: VecDeque<f64>,
}

impl FrameMeter {
    /// A frame was drawn at `now_s`.
    pub fn frame(&mut self, now_s: f64) {
        if self.frames_s.back().is_some_and(|last| now_s - last > PAUSE_S) {
            self.frames_s.clear();
        }
        self.frames_s.push_back(now_s);
        while self.frames_s.front().is_some_and(|first| now_s - first > SPAN_S) {
            self.frames_s.pop_front();
        }
    }

    /// Frames per second, once half a second was measured.
    #[must_use]
    pub fn per_second(&self) -> Option<f64> {
        let span = self.frames_s.back()? - self.frames_s.front()?;
        (span >= 0.5).then(|| (self.frames_s.len() - 1) as f64 / span)
    }

    /// The longest time between two frames in ms.
    #[must_use]
    pub fn longest_ms(&self) -> f64 {
        let gaps = self
            .frames_s
            .iter()
            .zip(self.frames_s.iter().skip(1))
            .map(|(a, b)| (b - a) * 1000.0);
        gaps.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::FrameMeter;

    #[test]
    fn counts_frames_and_forgets_pauses() {
        let mut meter = FrameMeter::default();
        for frame in 0..20 {
            meter.frame(f64::from(frame) / 60.0);
        }
        assert_eq!(meter.per_second(), None);
        for frame in 0..300 {
            meter.frame(100.0 + f64::from(frame) / 60.0);
        }
        assert!((meter.per_second().unwrap() - 60.0).abs() < 0.1);
        assert!((meter.longest_ms() - 16.7).abs() < 0.1);
    }
}
