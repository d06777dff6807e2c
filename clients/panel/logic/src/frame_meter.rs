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

    /// Half of the frames take at most this long, ms; and so do 95 of a hundred.
    #[must_use]
    pub fn median_and_p95_ms(&self) -> Option<(f64, f64)> {
        let next = self.frames_s.iter().skip(1);
        let mut gaps: Vec<f64> = self
            .frames_s
            .iter()
            .zip(next)
            .map(|(a, b)| (b - a) * 1000.0)
            .collect();
        gaps.sort_by(f64::total_cmp);
        let at = |share: f64| gaps.get((share * gaps.len() as f64) as usize).copied();
        at(0.5).zip(at(0.95))
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
        let (median, p95) = meter.median_and_p95_ms().unwrap();
        assert!((median - 16.7).abs() < 0.1 && (p95 - 16.7).abs() < 0.1);
        for slow in 1..=9 {
            meter.frame(105.0 + f64::from(slow) / 10.0);
        }
        let (median, p95) = meter.median_and_p95_ms().unwrap();
        assert!(
            (median - 16.7).abs() < 0.1 && (p95 - 100.0).abs() < 0.1,
            "{median} {p95}"
        );
    }
}
