//! In which order runs are driven: each time that which takes least to get to, turning included.

use std::collections::BTreeSet;

use super::runs::{Run, Sweeper};
use super::shape::corners;
use crate::coverage::plan::Departure;
use crate::coverage::plan::timing::way_s;
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;
use crate::navigation::heading::heading_rad;
use crate::navigation::router::{Router, Spread};

/// Nearest places to enter a run that are compared.
const NEAR_ENTRIES: usize = 16;
/// Cells along a run over which its direction at a place is taken.
const AHEAD: usize = 8;
/// Work of the search for a way beyond that for its end, and of looking at a cell of a run.
const WAY_WORK: usize = 3_000;
const LOOK_WORK: usize = 2;

/// A way along rings.
pub(in crate::coverage::plan) struct RingWay {
    pub(in crate::coverage::plan) corners: Vec<Point2>,
    pub(in crate::coverage::plan) runs: usize,
    /// The cell where it ends, and the heading there.
    pub(in crate::coverage::plan) end: (usize, f64),
    /// What is open after it.
    pub(in crate::coverage::plan) open: Vec<bool>,
}

/// A way along runs in the making.
pub(super) struct Drive<'plan> {
    router: &'plan Router<'plan>,
    departure: &'plan Departure,
    sweeper: Sweeper,
    /// What may still be worth driving.
    runs: Vec<Run>,
    /// Block, run and place of each entry.
    entries: BTreeSet<(usize, usize, usize)>,
    at: usize,
    heading_rad: f64,
    corners: Vec<Point2>,
    driven: usize,
}

/// Where a run is entered, and whether it is driven against the order of its cells.
#[derive(Clone, Copy)]
struct Entry {
    run: usize,
    place: usize,
    is_backwards: bool,
}

impl<'plan> Drive<'plan> {
    pub(super) fn new(
        router: &'plan Router<'plan>,
        (sweeper, runs): (Sweeper, Vec<Run>),
        (departure, origin): (&'plan Departure, usize),
    ) -> Self {
        let mut drive = Self {
            router,
            departure,
            sweeper,
            runs: Vec::new(),
            entries: BTreeSet::new(),
            at: origin,
            heading_rad: departure.start.heading_rad,
            corners: vec![router.ground().point(origin)],
            driven: 0,
        };
        runs.into_iter().for_each(|run| drive.add(run));
        drive
    }

    /// Drives one of the outermost runs, or of the innermost ones.
    pub(super) async fn begin(&mut self, is_innermost: bool, budget: &mut StepBudget) {
        let levels = self.runs.iter().map(|run| run.level);
        let Some(level) = (if is_innermost { levels.max() } else { levels.min() }) else {
            return;
        };
        let mut spread = self.router.spread();
        let is_eligible = |run: &Run| run.level == level;
        if let Some(entry) = self.nearest(&mut spread, is_eligible, budget).await {
            self.enter(entry, &spread, budget).await;
        }
    }

    /// Drives all that is worth it.
    pub(super) async fn go_through(&mut self, budget: &mut StepBudget) {
        let mut spread = self.router.spread();
        while let Some(entry) = self.nearest(&mut spread, |_| true, budget).await {
            self.enter(entry, &spread, budget).await;
        }
    }

    pub(super) fn way(self) -> RingWay {
        RingWay {
            corners: self.corners,
            runs: self.driven,
            end: (self.at, self.heading_rad),
            open: self.sweeper.open,
        }
    }

    /// A closed run can be entered in each block that it leads through, another one at its ends.
    fn add(&mut self, run: Run) {
        let number = self.runs.len();
        let mut before = None;
        for (place, cell) in run.cells.iter().enumerate() {
            let block = self.router.block(*cell);
            let is_end = place == 0 || place + 1 == run.cells.len();
            if is_end || run.is_closed && before != Some(block) {
                self.entries.insert((block, number, place));
            }
            before = Some(block);
        }
        self.runs.push(run);
    }

    /// Takes a run out.
    fn remove(&mut self, number: usize) -> Run {
        self.entries.retain(|(_, run, _)| *run != number);
        let run = &mut self.runs[number];
        Run {
            level: run.level,
            cells: core::mem::take(&mut run.cells),
            is_closed: run.is_closed,
        }
    }

    /// The entry that takes least to get to, of the nearest ones; `spread` then knows the way.
    async fn nearest(
        &self,
        spread: &mut Spread,
        is_eligible: impl Fn(&Run) -> bool,
        budget: &mut StepBudget,
    ) -> Option<Entry> {
        let mut found: Vec<(usize, usize)> = Vec::new();
        let enough = |block| {
            let in_block = self
                .entries
                .range((block, 0, 0)..=(block, usize::MAX, usize::MAX));
            found.extend(
                in_block
                    .filter(|(_, run, _)| is_eligible(&self.runs[*run]))
                    .map(|(_, run, place)| (*run, *place)),
            );
            found.len() >= NEAR_ENTRIES
        };
        if self.entries.is_empty() {
            return None;
        }
        self.router.explore(self.at, (spread, budget), enough).await;
        let mut best: Option<(f32, Entry)> = None;
        for (run, place) in found {
            let way = self.router.way(spread, self.at, self.runs[run].cells[place]);
            for entry in self.directions(run, place) {
                let cost = self.cost_s(&way, entry);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, entry));
                }
            }
            budget.spend(WAY_WORK).await;
        }
        best.map(|(_, entry)| entry)
    }

    /// A run that is open at its ends leads away from the one where it is entered.
    fn directions(&self, run: usize, place: usize) -> impl Iterator<Item = Entry> + use<> {
        let Run { cells, is_closed, .. } = &self.runs[run];
        let forwards = *is_closed || place == 0;
        let backwards = *is_closed || place + 1 == cells.len();
        [(forwards, false), (backwards, true)]
            .into_iter()
            .filter(|(is_possible, _)| *is_possible)
            .map(move |(_, is_backwards)| Entry {
                run,
                place,
                is_backwards,
            })
    }

    fn cost_s(&self, way: &[usize], entry: Entry) -> f32 {
        let cells = &self.runs[entry.run].cells;
        let count = cells.len();
        let ahead = AHEAD.min(count - 1);
        let next = if entry.is_backwards {
            (entry.place + count - ahead) % count
        } else {
            (entry.place + ahead) % count
        };
        let ground = self.router.ground();
        let (from, to) = (ground.point(cells[entry.place]), ground.point(cells[next]));
        let against_rad = (ahead > 0).then(|| heading_rad(to, from));
        way_s(
            ground,
            way,
            (Some(self.heading_rad), against_rad),
            &self.departure.settings,
        )
    }

    /// Drives along a run from an entry, as far as that is worth it. If less of it is worth it than was when it was found,
    /// its parts take its place instead.
    async fn enter(&mut self, entry: Entry, spread: &Spread, budget: &mut StepBudget) {
        let run = self.remove(entry.run);
        budget
            .spend(LOOK_WORK * (run.cells.len() + self.entries.len()))
            .await;
        let count = run.cells.len();
        let was_closed = run.is_closed;
        let parts = self.sweeper.parts(run, budget).await;
        let (mut run, is_whole) = match <[Run; 1]>::try_from(parts) {
            Ok([only]) => {
                let is_whole = only.cells.len() == count && only.is_closed == was_closed;
                (only, is_whole)
            }
            Err(parts) => {
                parts.into_iter().for_each(|part| self.add(part));
                return;
            }
        };
        if !is_whole {
            self.add(run);
            return;
        }
        if run.is_closed {
            run.cells.rotate_left(entry.place);
        }
        if entry.is_backwards {
            run.cells.reverse();
            if run.is_closed {
                run.cells.rotate_right(1);
            }
        }
        run.is_closed = false;
        let driven = self.sweeper.sweep(&run, budget).await;
        if driven > 0 {
            self.follow(&run.cells[..driven], spread);
            run.cells.drain(..driven);
            for part in self.sweeper.parts(run, budget).await {
                self.add(part);
            }
        }
    }

    /// Goes to the first cell of a row, and along it.
    fn follow(&mut self, cells: &[usize], spread: &Spread) {
        let Some(first) = cells.first() else { return };
        let ground = self.router.ground();
        let link = self.router.way(spread, self.at, *first);
        for cell in link.into_iter().chain(corners(ground, cells)) {
            let (point, before) = (ground.point(cell), self.corners.last().copied());
            if before != Some(point) {
                self.heading_rad = before.map_or(self.heading_rad, |before| heading_rad(before, point));
                self.corners.push(point);
            }
            self.at = cell;
        }
        self.driven += 1;
    }
}
