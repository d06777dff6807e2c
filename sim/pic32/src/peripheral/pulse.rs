//! A pin that pulse-width modulation drives: worked out for any interval, without an event for each edge.

use super::counter::Counter;
use crate::pins::Level;

/// The output stage of an output compare module in PWM mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pulse {
    high: bool,
    /// OCxR: counts for which the pin is high in this period.
    duty: u32,
    /// OCxRS: the duty of the next period.
    next_duty: u32,
    /// Up to which cycle all this is worked out.
    at: u64,
    high_cycles: u64,
}

impl Pulse {
    /// A module that is switched on at `cycle`: low until a period begins.
    pub(crate) fn new(duty: u32, next_duty: u32, cycle: u64) -> Pulse {
        Pulse {
            high: false,
            duty,
            next_duty,
            at: cycle,
            high_cycles: 0,
        }
    }

    /// The timer starts at 0 at this cycle, which begins a period with the duty that OCxR was given.
    pub(crate) fn begin(&mut self) {
        self.high = self.duty > 0;
    }

    pub(crate) fn level(&self) -> Level {
        Level::of(self.high)
    }

    /// OCxR as the program reads it.
    pub(crate) fn duty(&self) -> u32 {
        self.duty
    }

    pub(crate) fn high_cycles(&self) -> u64 {
        self.high_cycles
    }

    /// A new OCxRS, which counts from the next period on. All before must be worked out.
    pub(crate) fn set_next_duty(&mut self, duty: u32) {
        self.next_duty = duty;
    }

    /// The same at a later cycle, the counter going on as it does.
    pub(crate) fn advanced(mut self, counter: &Counter, to: u64) -> Pulse {
        self.advance(counter, to, None);
        self
    }

    /// Works out all up to and including the cycle `to`; edges are appended if they are wanted.
    pub(crate) fn advance(&mut self, counter: &Counter, to: u64, mut edges: Option<&mut Vec<(u64, Level)>>) {
        if to <= self.at {
            return;
        }
        loop {
            let matched = counter.next_match(self.at);
            self.finish_period(counter, matched.min(to), edges.as_deref_mut());
            if matched > to {
                return;
            }
            self.begin_period(matched, edges.as_deref_mut());
            if edges.is_none() {
                self.skip_periods(counter, to);
            }
        }
    }

    /// To the end of the period or to `to`, whichever is first: the falling edge.
    fn finish_period(&mut self, counter: &Counter, to: u64, edges: Option<&mut Vec<(u64, Level)>>) {
        if self.high {
            let falls = counter.next_reach(self.at, self.duty);
            self.high_cycles += falls.min(to) - self.at;
            if falls <= to {
                self.high = false;
                note(edges, falls, Level::Low);
            }
        }
        self.at = to;
    }

    /// A match: OCxRS is taken over, and the pin goes high unless the duty is 0.
    fn begin_period(&mut self, cycle: u64, edges: Option<&mut Vec<(u64, Level)>>) {
        self.duty = self.next_duty;
        let high = self.duty > 0;
        if high != self.high {
            note(edges, cycle, Level::of(high));
        }
        self.high = high;
    }

    /// Right after a match: as many whole periods as fit, at once.
    fn skip_periods(&mut self, counter: &Counter, to: u64) {
        let Some(period) = counter.period_cycles() else {
            return;
        };
        let whole = (to - self.at) / period;
        let length = u64::from(counter.period) + 1;
        let high = period / length * u64::from(self.duty).min(length);
        self.high_cycles += whole * high;
        self.at += whole * period;
    }
}

fn note(edges: Option<&mut Vec<(u64, Level)>>, cycle: u64, level: Level) {
    if let Some(edges) = edges {
        edges.push((cycle, level));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peripheral::rate::Rate;

    const PERIOD: u32 = 3999;

    fn counter() -> Counter {
        let mut counter = Counter::STOPPED.with(0, PERIOD, 0);
        counter.restart(0, Rate::from_hz(80_000_000), 0);
        counter
    }

    #[test]
    fn one_count_is_one_count_and_beyond_the_period_is_always() {
        for (duty, per_period) in [
            (0, 0),
            (1, 1),
            (133, 133),
            (2000, 2000),
            (3999, 3999),
            (4000, 4000),
            (9999, 4000),
        ] {
            let mut pulse = Pulse::new(0, duty, 0);
            pulse.advance(&counter(), 4000, None);
            let before = pulse.high_cycles();
            pulse.advance(&counter(), 4000 * 1001, None);
            assert_eq!(pulse.high_cycles() - before, 1000 * per_period, "duty {duty}");
        }
    }

    #[test]
    fn a_new_duty_counts_from_the_next_period() {
        let mut pulse = Pulse::new(0, 1000, 0);
        let mut edges = Vec::new();
        pulse.advance(&counter(), 4500, Some(&mut edges));
        pulse.set_next_duty(0);
        pulse.advance(&counter(), 8100, Some(&mut edges));
        pulse.set_next_duty(4000);
        pulse.advance(&counter(), 16_100, Some(&mut edges));
        pulse.set_next_duty(5);
        pulse.advance(&counter(), 24_000, Some(&mut edges));
        let (high, low) = (Level::High, Level::Low);
        assert_eq!(
            edges,
            [
                (4000, high),
                (5000, low),
                (12_000, high),
                (20_005, low),
                (24_000, high)
            ]
        );
    }

    #[test]
    fn it_does_not_matter_in_how_many_steps_it_is_worked_out() {
        let mut random = 1u64;
        for seed in 0..200u64 {
            let (mut fine, mut coarse) = (Pulse::new(7, 900, 0), Pulse::new(7, 900, 0));
            let mut edges = Vec::new();
            let mut cycle = 0;
            for _ in 0..20 {
                random = random
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(seed | 1);
                let duty = u32::try_from(random >> 48).unwrap_or(0) % 4200;
                let end = cycle + (random >> 32) % 30_000;
                while cycle < end {
                    cycle = (cycle + 1 + (cycle * 7919) % 613).min(end);
                    fine.advance(&counter(), cycle, Some(&mut edges));
                }
                coarse.advance(&counter(), end, None);
                assert_eq!(fine, coarse);
                fine.set_next_duty(duty);
                coarse.set_next_duty(duty);
            }
            let mut by_edges = 0;
            for pair in edges.windows(2).filter(|pair| pair[0].1.is_high()) {
                by_edges += pair[1].0 - pair[0].0;
            }
            let open = edges
                .last()
                .filter(|edge| edge.1.is_high())
                .map_or(0, |edge| cycle - edge.0);
            assert_eq!(by_edges + open, fine.high_cycles());
        }
    }

    #[test]
    fn a_stopped_timer_holds_the_pin() {
        let mut pulse = Pulse::new(0, 1000, 0);
        pulse.advance(&counter(), 4500, None);
        let mut stopped = counter();
        stopped.restart(stopped.count_at(4500), Rate::STOPPED, 4500);
        pulse.advance(&stopped, 104_500, None);
        assert_eq!((pulse.level(), pulse.high_cycles()), (Level::High, 100_500));
    }
}
