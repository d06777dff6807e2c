//! The schedules and the disk: nothing counts, and nothing starts, before it is kept.
//!
//! One change is written to the disk at a time. It is made on a copy of the book, and the copy takes the book's place when
//! the disk has it. Requests of people wait meanwhile in order; runs that are due wait behind them.

use std::collections::VecDeque;

use rvac_api::Schedules;

use super::audience::Asker;
use crate::ScheduleOrder;
use crate::schedule::{
    Book, CLOCK_IS_SET_FROM_S, EditError, Entry, Keeping, Outcome, ScheduleEdit, StoredBook, Verdict, Zone,
    verdict, view,
};

/// Changes of people that may wait for the disk.
const WAITING_MAX: usize = 16;
/// After the disk has refused a decision it is tried again so much later.
const RETRY_S: i64 = 60;

/// The schedules between clock, people and disk.
#[derive(Debug)]
pub(super) struct Scheduler {
    book: Book,
    system_zone: Zone,
    /// The present, seconds since 1970, once the clock is set.
    now_s: Option<i64>,
    /// What was kept last may lack the newest marks, so what was due before the start is left alone.
    distrusts_marks: bool,
    writes: u64,
    writing: Option<Writing>,
    waiting: VecDeque<(Asker, ScheduleEdit)>,
    retry_s: i64,
}

#[derive(Debug)]
struct Writing {
    number: u64,
    book: Book,
    then: Then,
}

#[derive(Debug)]
enum Then {
    Answer(Asker),
    Decided(Verdict),
    Nothing,
}

/// What is to be done now.
#[derive(Debug, PartialEq)]
pub(super) enum Task {
    /// The disk shall keep this.
    Keep(ScheduleOrder),
    /// A change is kept.
    Done(Asker),
    /// A change was refused.
    Refused(Asker, EditError),
    /// A change could not be kept.
    Unkept(Asker, String),
    /// A decision could not be kept, so nothing starts.
    Undecided(String),
    /// A decision is kept: if it is [`Outcome::Starting`], the robot shall start.
    Decided(Verdict),
}

impl Scheduler {
    pub(super) fn new(book: Book, distrusts_marks: bool) -> Self {
        Self {
            book,
            system_zone: Zone::utc(),
            now_s: None,
            distrusts_marks,
            writes: 0,
            writing: None,
            waiting: VecDeque::new(),
            retry_s: i64::MIN,
        }
    }

    pub(super) fn book(&self) -> &Book {
        &self.book
    }

    /// All that clients receive.
    pub(super) fn view(&self, keeping: &impl Keeping) -> Schedules {
        view(&self.book, self.zone(), self.now_s, keeping)
    }

    /// What the clock shows, if it was ever set.
    pub(super) fn set_clock_s(&self) -> Option<i64> {
        self.now_s.filter(|now_s| *now_s >= CLOCK_IS_SET_FROM_S)
    }

    /// The clock shows this. Whatever it showed before: it may have been set.
    pub(super) fn set_clock(&mut self, now_s: i64) {
        self.now_s = Some(now_s);
        self.book.meet(now_s);
        self.retry_s = self.retry_s.min(now_s + RETRY_S);
        if self.distrusts_marks && now_s >= CLOCK_IS_SET_FROM_S {
            self.distrusts_marks = false;
            self.book.forget_before(now_s);
        }
    }

    /// Takes a person's change; `false` when too many wait.
    #[must_use]
    pub(super) fn take(&mut self, asker: Asker, edit: ScheduleEdit) -> bool {
        let has_room = self.waiting.len() < WAITING_MAX;
        if has_room {
            self.waiting.push_back((asker, edit));
        }
        has_room
    }

    /// The next change that waits, if the disk is free.
    pub(super) fn next_change(&mut self) -> Option<Task> {
        if self.writing.is_some() {
            return None;
        }
        let (asker, edit) = self.waiting.pop_front()?;
        let mut book = self.book.clone();
        Some(match book.edit(edit, self.zone().at(self.now_s.unwrap_or(0))) {
            Ok(()) => self.keep(book, Then::Answer(asker)),
            Err(error) => Task::Refused(asker, error),
        })
    }

    /// What is decided of the run that was due first, if the disk is free. `ready` says why the robot could not start an
    /// entry's job at this moment.
    pub(super) fn due(&self, ready: impl Fn(&Entry) -> Result<(), &'static str>) -> Option<Verdict> {
        if self.writing.is_some() {
            return None;
        }
        let now_s = self
            .now_s
            .filter(|now_s| *now_s >= CLOCK_IS_SET_FROM_S.max(self.retry_s))?;
        verdict(&self.book, self.zone().at(now_s), ready)
    }

    /// Takes a decision to the disk.
    pub(super) fn decide(&mut self, verdict: Verdict) -> Task {
        let mut book = self.book.clone();
        book.note(verdict.clone(), self.zone().at(self.now_s.unwrap_or(0)));
        self.keep(book, Then::Decided(verdict))
    }

    /// The disk has what it was given under this number, or says why it has not.
    pub(super) fn kept(&mut self, number: u64, result: Result<(), String>) -> Option<Task> {
        let writing = self.writing.take_if(|writing| writing.number == number)?;
        match (result, writing.then) {
            (Ok(()), then) => {
                self.book = writing.book;
                match then {
                    Then::Answer(asker) => Some(Task::Done(asker)),
                    Then::Decided(verdict) => Some(Task::Decided(verdict)),
                    Then::Nothing => None,
                }
            }
            (Err(text), Then::Answer(asker)) => Some(Task::Unkept(asker, text)),
            (Err(text), Then::Decided(_)) => {
                self.retry_s = self.now_s.unwrap_or(0) + RETRY_S;
                Some(Task::Undecided(text))
            }
            // The run is marked; only what people read of it is not kept.
            (Err(_), Then::Nothing) => None,
        }
    }

    /// What became of a run after it was marked.
    pub(super) fn follow_up(&mut self, verdict: &Verdict, outcome: Outcome) -> Task {
        let verdict = Verdict {
            outcome,
            ..verdict.clone()
        };
        let zone = self.zone().clone();
        self.book.note(verdict, zone.at(self.now_s.unwrap_or(0)));
        self.keep(self.book.clone(), Then::Nothing)
    }

    /// The zone of the system; gives the name of the one before. What was due in the past of a zone that people moved to is not made
    /// up for, as when a person sets the zone of the schedules.
    pub(super) fn set_system_zone(&mut self, zone: Zone, change: bool) -> String {
        let before = std::mem::replace(&mut self.system_zone, zone);
        let moved = change && before != self.system_zone && self.book.zone().is_none();
        if let Some(now_s) = self.set_clock_s().filter(|_| moved) {
            let written = self.writing.as_mut().map(|writing| &mut writing.book);
            for book in written.into_iter().chain([&mut self.book]) {
                book.forget_before(now_s);
            }
        }
        before.name().to_owned()
    }

    /// The zone that schedules are in.
    pub(super) fn zone(&self) -> &Zone {
        self.book.zone().unwrap_or(&self.system_zone)
    }

    fn keep(&mut self, book: Book, then: Then) -> Task {
        self.writes += 1;
        let order = ScheduleOrder {
            number: self.writes,
            book: StoredBook::from(&book),
        };
        self.writing = Some(Writing {
            number: self.writes,
            book,
            then,
        });
        Task::Keep(order)
    }
}
