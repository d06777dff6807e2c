//! The schedules against the clocks of the world.
//!
//! `cargo test -p vthal-core --test schedule` tries 5,000 sampled changes of clocks,
//! `cargo xtask test --only tests --long` all of them.

mod clocks;
mod decisions;
mod zones;

use jiff::civil::{Date, Time};
use rvac_api::{InQuiet, ScheduledJob};
use vthal_core::schedule::{Book, Outcome, Plan, ScheduleEdit, StoredBook, Verdict, When, Zone, verdict};

/// A plan to clean all, and nothing special about it.
fn plan(when: When) -> Plan {
    Plan {
        name: "All".to_owned(),
        enabled: true,
        job: ScheduledJob::Start { strategy: None },
        when,
        late_min: 0,
        in_quiet: InQuiet::Refuse,
        floor: None,
    }
}

/// A book of plans that were made at `now_s`.
fn book(plans: &[Plan], zone: &Zone, now_s: i64) -> Book {
    let mut book = Book::default();
    for plan in plans {
        book.edit(ScheduleEdit::Add(plan.clone()), zone.at(now_s))
            .expect("is a plan");
    }
    book
}

/// Everything that is decided at an instant, while nothing keeps the robot.
fn decide(book: &mut Book, zone: &Zone, now_s: i64) -> Vec<Verdict> {
    book.meet(now_s);
    let mut all = Vec::new();
    while let Some(verdict) = verdict(book, zone.at(now_s), |_| Ok(())) {
        book.note(verdict.clone(), zone.at(now_s));
        all.push(verdict);
    }
    all
}

/// What a daemon finds on its disk after this one.
fn restarted(book: &Book) -> Book {
    Book::try_from(StoredBook::from(book)).expect("is readable")
}

fn instant(zone: &Zone, date: Date, at: Time) -> i64 {
    zone.first_instant(date, at).expect("exists")
}

fn outcomes(verdicts: &[Verdict]) -> Vec<&Outcome> {
    verdicts.iter().map(|verdict| &verdict.outcome).collect()
}

/// Numbers that look random and are always the same ones.
struct Draw(u64);

impl Draw {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        (mixed ^ mixed >> 31) % limit
    }
}
