//! Clocks that jump, daemons that die, people who move: no run happens twice.

use std::collections::BTreeSet;

use jiff::civil::{date, time};
use rvac_api::InQuiet;
use vthal_core::schedule::{
    Book, Days, Outcome, Plan, Quiet, ScheduleEdit, StoredBook, Verdict, When, Zone, verdict,
};

use crate::{Draw, book, plan};

const HOUR_S: i64 = 3_600;
const ZONES: [&str; 6] = [
    "Europe/Tallinn",
    "Pacific/Auckland",
    "America/New_York",
    "Pacific/Apia",
    "Australia/Lord_Howe",
    "Africa/Casablanca",
];

/// A daemon with its disk: what it decides is kept before it is done, and it may die in between.
struct Daemon {
    book: Book,
    disk: StoredBook,
    zone: Zone,
    started: BTreeSet<(u32, String)>,
}

impl Daemon {
    fn pass(&mut self, now_s: i64, draw: &mut Draw) {
        self.book.meet(now_s);
        while let Some(found) = verdict(&self.book, self.zone.at(now_s), |_| Ok(())) {
            if draw.below(8) == 0 {
                return self.die();
            }
            self.book.note(found.clone(), self.zone.at(now_s));
            self.disk = StoredBook::from(&self.book);
            if draw.below(8) == 0 {
                return self.die();
            }
            if found.outcome == Outcome::Starting {
                self.start(&found);
                self.book.note(
                    Verdict {
                        outcome: Outcome::Fired,
                        ..found
                    },
                    self.zone.at(now_s),
                );
            }
        }
    }

    fn start(&mut self, run: &Verdict) {
        let key = (run.entry, run.date.to_string());
        assert!(self.started.insert(key), "{run:?} has started before");
    }

    fn die(&mut self) {
        self.book = Book::try_from(self.disk.clone()).expect("is readable");
    }

    fn edit(&mut self, edit: ScheduleEdit, now_s: i64) {
        if self.book.edit(edit, self.zone.at(now_s)).is_ok() {
            self.disk = StoredBook::from(&self.book);
            self.zone = self.book.zone().unwrap_or(&self.zone).clone();
        }
    }
}

fn plans() -> Vec<Plan> {
    let day = date(2026, 10, 24);
    let all = (0..7).fold(Days::default(), |all, shift| {
        all.with(day.saturating_add(jiff::Span::new().days(shift)).weekday())
    });
    let hours = [0, 2, 3, 8, 23].into_iter();
    let weekly = hours.map(|hour| {
        plan(When::Weekly {
            days: all,
            at: time(hour, 30, 0, 0),
        })
    });
    let once = plan(When::Once {
        date: day,
        at: time(12, 0, 0, 0),
    });
    let late = |(number, plan): (usize, Plan)| Plan {
        late_min: [0, 10, 720][number % 3],
        in_quiet: [InQuiet::Refuse, InQuiet::Wait][number % 2],
        ..plan
    };
    weekly.chain([once]).enumerate().map(late).collect()
}

fn edit(daemon: &mut Daemon, now_s: i64, draw: &mut Draw) {
    let number = 1 + draw.below(7) as u32;
    let edit = match draw.below(6) {
        0 => ScheduleEdit::Zone(Zone::named(ZONES[draw.below(6) as usize])),
        1 => ScheduleEdit::Enable(number, draw.below(3) != 0),
        2 => ScheduleEdit::SkipNext(number, true),
        3 => ScheduleEdit::Quiet(Quiet::new(
            time(draw.below(24) as i8, 0, 0, 0),
            time(draw.below(24) as i8, 0, 0, 0),
        )),
        4 => ScheduleEdit::Change(number, plans()[draw.below(6) as usize].clone()),
        _ => ScheduleEdit::Quiet(None),
    };
    daemon.edit(edit, now_s);
}

#[test]
fn no_run_starts_twice_whatever_happens() {
    let mut starts = 0;
    for seed in 0..60 {
        let mut draw = Draw(seed);
        let zone = Zone::named(ZONES[draw.below(6) as usize]).expect("known");
        let mut now_s = crate::instant(&zone, date(2026, 10, 23), time(0, 0, 0, 0));
        let book = book(&plans(), &zone, now_s);
        let disk = StoredBook::from(&book);
        let mut daemon = Daemon {
            book,
            disk,
            zone,
            started: BTreeSet::new(),
        };
        for _ in 0..4_000 {
            now_s += match draw.below(60) {
                0 => draw.below(5 * 24 * 3_600) as i64 - 60 * HOUR_S,
                1 => -HOUR_S,
                2 => HOUR_S,
                _ => 60 * (1 + draw.below(10) as i64),
            };
            match draw.below(100) {
                0 => daemon.die(),
                1 => edit(&mut daemon, now_s, &mut draw),
                _ => {}
            }
            daemon.pass(now_s, &mut draw);
        }
        starts += daemon.started.len();
    }
    assert!(starts > 1_000, "only {starts} runs started");
}
