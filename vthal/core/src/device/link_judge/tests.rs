//! The judge on a virtual clock.

use brain::LinkFault;

use super::{LinkJudge, LinkNews};
use crate::device::{Arrivals, LinkQuality};

const FRESH_US: u64 = 300_000;
const PERIOD_US: u64 = 20_000;

/// A judge, and what has come so far.
#[derive(Default)]
struct Bench {
    judge: LinkJudge,
    quality: LinkQuality,
    now_us: u64,
}

/// What comes in the place of a report.
type Piece = fn(&mut Arrivals);

const REPORT: Piece = |come| come.reports += 1;
const NOTHING: Piece = |_| {};

impl Bench {
    /// A link over which reports have come for a second.
    fn sound() -> Self {
        let mut bench = Self::default();
        bench.judge.open(0);
        bench.pass_ms(1_000, REPORT);
        assert_eq!(bench.judge.fault(), None);
        bench
    }

    fn pass_ms(&mut self, ms: u64, piece: Piece) {
        for _ in 0..ms * 1_000 / PERIOD_US {
            self.now_us += PERIOD_US;
            piece(&mut self.quality.arrivals);
            self.judge.look(self.now_us, self.quality, Some(FRESH_US));
        }
    }

    /// Milliseconds until something is so.
    fn ms_until(&mut self, piece: Piece, is_so: impl Fn(&LinkJudge) -> bool) -> u64 {
        let begun_us = self.now_us;
        while !is_so(&self.judge) && self.now_us < begun_us + 60_000_000 {
            self.pass_ms(PERIOD_US / 1_000, piece);
        }
        (self.now_us - begun_us) / 1_000
    }
}

#[test]
fn what_comes_in_the_place_of_reports_gives_the_fault_its_name() {
    let cases: [(Piece, LinkFault); 4] = [
        (|come| come.garbled += 2, LinkFault::Garbled),
        (|come| come.corrupted += 1, LinkFault::Corrupted),
        (|come| come.repeated += 1, LinkFault::ClockFrozen),
        (|come| come.stray += 1, LinkFault::ClockJumped),
    ];
    for (piece, fault) in cases {
        let mut bench = Bench::sound();
        assert_eq!(bench.ms_until(piece, |judge| judge.fault().is_some()), 320);
        assert_eq!(bench.judge.fault(), Some(fault));
        bench.pass_ms(30_000, piece);
        assert_eq!(bench.ms_until(REPORT, |judge| judge.fault().is_none()), 1_020);
    }
}

#[test]
fn what_comes_beside_sound_reports_is_no_fault() {
    let noisy: Piece = |come| {
        come.reports += 1;
        come.garbled += 40;
        come.corrupted += 5;
        come.repeated += 10;
        come.stray += 3;
    };
    let mut bench = Bench::sound();
    bench.pass_ms(60_000, noisy);
    assert_eq!(bench.judge.fault(), None);
    assert_eq!(bench.judge.speed_share(FRESH_US), 1.0);
}

#[test]
fn seldom_reports_halve_the_speed_and_late_ones_are_a_fault() {
    let mut bench = Bench::sound();
    for _ in 0..20 {
        bench.pass_ms(180, NOTHING);
        bench.pass_ms(20, REPORT);
    }
    assert_eq!(
        (bench.judge.fault(), bench.judge.speed_share(FRESH_US)),
        (None, 0.5)
    );
    bench.pass_ms(3_000, REPORT);
    assert_eq!(bench.judge.speed_share(FRESH_US), 1.0);
    for _ in 0..2 {
        assert_eq!(bench.judge.fault(), None, "one pause is a moment of silence");
        bench.pass_ms(480, NOTHING);
        bench.pass_ms(20, REPORT);
    }
    assert_eq!(bench.judge.fault(), Some(LinkFault::Late));
}

#[test]
fn silence_has_another_name() {
    let mut bench = Bench::sound();
    bench.pass_ms(10_000, NOTHING);
    assert_eq!(bench.judge.fault(), None);
    bench.pass_ms(1_000, |come| come.garbled += 1);
    assert_eq!(bench.judge.fault(), Some(LinkFault::Garbled));
    bench.pass_ms(3_000, NOTHING);
    assert_eq!(bench.judge.fault(), None, "it did not come back by itself");
}

#[test]
fn a_jump_that_is_believed_is_a_fault_for_a_second() {
    let mut bench = Bench::sound();
    bench.quality.arrivals.clock_jumps += 1;
    bench.pass_ms(20, REPORT);
    assert_eq!(bench.judge.fault(), Some(LinkFault::ClockJumped));
    assert_eq!(bench.ms_until(REPORT, |judge| judge.fault().is_none()), 1_000);
}

#[test]
fn commands_that_do_not_arrive_are_a_fault_too() {
    let mut bench = Bench::sound();
    bench.quality.lost_share = 0.3;
    bench.pass_ms(1_000, REPORT);
    assert_eq!(
        (bench.judge.fault(), bench.judge.speed_share(FRESH_US)),
        (None, 0.5)
    );
    bench.quality.lost_share = 0.8;
    bench.pass_ms(20, REPORT);
    assert_eq!(bench.judge.fault(), Some(LinkFault::CommandsLost));
    bench.quality.lost_share = 0.0;
    bench.pass_ms(2_000, REPORT);
    assert_eq!(bench.judge.fault(), None);
    for _ in 0..9 {
        bench.judge.refused_as_stale(bench.now_us);
    }
    assert_eq!(bench.judge.fault(), None);
    bench.judge.refused_as_stale(bench.now_us);
    assert_eq!(bench.judge.fault(), Some(LinkFault::CommandsStale));
}

#[test]
fn a_fault_that_comes_back_must_stay_away_for_longer_and_is_told_once() {
    let mut bench = Bench::sound();
    let mut healed_ms = Vec::new();
    for _ in 0..5 {
        bench.pass_ms(1_000, |come| come.corrupted += 1);
        healed_ms.push(bench.ms_until(REPORT, |judge| judge.fault().is_none()));
    }
    assert_eq!(healed_ms, [1_020, 2_020, 4_020, 8_020, 8_020]);
    bench.pass_ms(20_000, REPORT);
    let news = bench.judge.take_news();
    let [LinkNews::Began(LinkFault::Corrupted), LinkNews::Ended(episode)] = news.as_slice() else {
        panic!("not {news:?}")
    };
    assert_eq!((episode.times, episode.fault), (5, LinkFault::Corrupted));
    assert!(
        (27.0..28.0).contains(&episode.lasted_s()),
        "{} s",
        episode.lasted_s()
    );
    bench.pass_ms(1_000, |come| come.corrupted += 1);
    assert_eq!(
        bench.ms_until(REPORT, |judge| judge.fault().is_none()),
        1_020,
        "it stayed away for long"
    );
}
