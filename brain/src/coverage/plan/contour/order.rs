//! The order of ring sections: always the one that costs least to reach, turning included.

use std::collections::BTreeSet;

use super::ring_sections::{RingSection, Sweeper};
use super::shape::corners;
use crate::coverage::plan::Departure;
use crate::coverage::plan::parameters::RINGS;
use crate::coverage::plan::timing::{EndHeadings, path_s};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;
use crate::navigation::heading::heading_rad;
use crate::navigation::router::{CostField, PATH_WORK, Router};

/// Work to read a cell of a section.
const READ_WORK: usize = 2;

/// A path along rings.
pub(in crate::coverage::plan) struct RingPath {
    pub(in crate::coverage::plan) corners: Vec<Point2>,
    pub(in crate::coverage::plan) sections: usize,
    /// The cell where it ends, and the heading there.
    pub(in crate::coverage::plan) end: (usize, f64),
    /// The floor that is open after it.
    pub(in crate::coverage::plan) open: Vec<bool>,
}

/// A path along ring sections under construction.
pub(super) struct RingTour<'plan> {
    router: &'plan Router<'plan>,
    departure: &'plan Departure,
    sweeper: Sweeper,
    /// Sections that may still be worth driving.
    sections: Vec<RingSection>,
    /// Block, section and cell of each entry.
    entries: BTreeSet<(usize, usize, usize)>,
    at: usize,
    heading_rad: f64,
    corners: Vec<Point2>,
    driven: usize,
}

/// Where a path along rings starts.
#[derive(Clone, Copy)]
pub(in crate::coverage::plan) struct RingStart<'plan> {
    pub(in crate::coverage::plan) departure: &'plan Departure,
    /// The free cell from which the robot sets out.
    pub(in crate::coverage::plan) cell: usize,
}

/// Where a section is entered, and whether it is driven against the order of its cells.
#[derive(Clone, Copy)]
struct SectionEntry {
    section: usize,
    place: usize,
    is_backwards: bool,
}

impl<'plan> RingTour<'plan> {
    pub(super) fn new(router: &'plan Router<'plan>, sweeper: Sweeper, start: RingStart<'plan>) -> Self {
        Self {
            router,
            departure: start.departure,
            sweeper,
            sections: Vec::new(),
            entries: BTreeSet::new(),
            at: start.cell,
            heading_rad: start.departure.start.heading_rad,
            corners: vec![router.space().point(start.cell)],
            driven: 0,
        }
    }

    /// Drives one of the outermost or one of the innermost sections.
    pub(super) async fn begin(&mut self, is_innermost: bool, budget: &mut StepBudget) {
        let levels = self.sections.iter().map(|section| section.level);
        let Some(level) = (if is_innermost { levels.max() } else { levels.min() }) else {
            return;
        };
        let mut cost_field = self.router.cost_field();
        let is_eligible = |section: &RingSection| section.level == level;
        if let Some(entry) = self.nearest(&mut cost_field, is_eligible, budget).await {
            self.enter(entry, &cost_field, budget).await;
        }
    }

    /// Drives all sections that are worth it.
    pub(super) async fn go_through(&mut self, budget: &mut StepBudget) {
        let mut cost_field = self.router.cost_field();
        while let Some(entry) = self.nearest(&mut cost_field, |_| true, budget).await {
            self.enter(entry, &cost_field, budget).await;
        }
    }

    pub(super) fn path(self) -> RingPath {
        RingPath {
            corners: self.corners,
            sections: self.driven,
            end: (self.at, self.heading_rad),
            open: self.sweeper.open,
        }
    }

    /// A closed section can be entered in each block that it passes, an open one only at its ends.
    pub(super) fn add(&mut self, section: RingSection) {
        let number = self.sections.len();
        let mut before = None;
        for (place, cell) in section.cells.iter().enumerate() {
            let block = self.router.block(*cell);
            let is_end = place == 0 || place + 1 == section.cells.len();
            if is_end || section.is_closed && before != Some(block) {
                self.entries.insert((block, number, place));
            }
            before = Some(block);
        }
        self.sections.push(section);
    }

    /// Removes a section.
    fn remove(&mut self, number: usize) -> RingSection {
        self.entries.retain(|(_, section, _)| *section != number);
        let section = &mut self.sections[number];
        RingSection {
            level: section.level,
            cells: core::mem::take(&mut section.cells),
            is_closed: section.is_closed,
        }
    }

    /// The entry that costs least to reach, of the nearest ones; `cost_field` then holds the path.
    async fn nearest(
        &self,
        cost_field: &mut CostField<'_>,
        is_eligible: impl Fn(&RingSection) -> bool,
        budget: &mut StepBudget,
    ) -> Option<SectionEntry> {
        let mut found: Vec<(usize, usize)> = Vec::new();
        let enough = |block| {
            let in_block = self
                .entries
                .range((block, 0, 0)..=(block, usize::MAX, usize::MAX));
            found.extend(
                in_block
                    .filter(|(_, section, _)| is_eligible(&self.sections[*section]))
                    .map(|(_, section, place)| (*section, *place)),
            );
            found.len() >= RINGS.near_entries
        };
        if self.entries.is_empty() {
            return None;
        }
        cost_field.explore(self.at, enough, budget).await;
        let mut best: Option<(f32, SectionEntry)> = None;
        for (section, place) in found {
            let path = cost_field.path(self.sections[section].cells[place]);
            for entry in self.directions(section, place) {
                let cost = self.cost_s(&path, entry);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, entry));
                }
            }
            budget.spend(PATH_WORK).await;
        }
        best.map(|(_, entry)| entry)
    }

    /// An open section can only be driven away from the end at which it is entered.
    fn directions(&self, section: usize, place: usize) -> impl Iterator<Item = SectionEntry> + use<> {
        let RingSection { cells, is_closed, .. } = &self.sections[section];
        let forwards = *is_closed || place == 0;
        let backwards = *is_closed || place + 1 == cells.len();
        [(forwards, false), (backwards, true)]
            .into_iter()
            .filter(|(is_possible, _)| *is_possible)
            .map(move |(_, is_backwards)| SectionEntry {
                section,
                place,
                is_backwards,
            })
    }

    fn cost_s(&self, path: &[usize], entry: SectionEntry) -> f32 {
        let cells = &self.sections[entry.section].cells;
        let count = cells.len();
        let ahead = RINGS.direction_cells.min(count - 1);
        let next = if entry.is_backwards {
            (entry.place + count - ahead) % count
        } else {
            (entry.place + ahead) % count
        };
        let space = self.router.space();
        let (from, to) = (space.point(cells[entry.place]), space.point(cells[next]));
        let against_rad = (ahead > 0).then(|| heading_rad(to, from));
        path_s(
            space,
            path,
            EndHeadings {
                start_rad: Some(self.heading_rad),
                leave_rad: against_rad,
            },
            &self.departure.settings,
        )
    }

    /// Drives along a section from an entry, as far as that is worth it. If less of it is worth driving now than when it
    /// was found, its remaining parts replace it.
    async fn enter(&mut self, entry: SectionEntry, cost_field: &CostField<'_>, budget: &mut StepBudget) {
        let section = self.remove(entry.section);
        budget
            .spend(READ_WORK * (section.cells.len() + self.entries.len()))
            .await;
        let count = section.cells.len();
        let was_closed = section.is_closed;
        let parts = self.sweeper.parts(section, budget).await;
        let (mut section, is_whole) = match <[RingSection; 1]>::try_from(parts) {
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
            self.add(section);
            return;
        }
        if section.is_closed {
            section.cells.rotate_left(entry.place);
        }
        if entry.is_backwards {
            section.cells.reverse();
            if section.is_closed {
                section.cells.rotate_right(1);
            }
        }
        section.is_closed = false;
        let driven = self.sweeper.sweep(&section, budget).await;
        if driven > 0 {
            self.follow(&section.cells[..driven], cost_field);
            section.cells.drain(..driven);
            for part in self.sweeper.parts(section, budget).await {
                self.add(part);
            }
        }
    }

    /// Drives to the first cell of a chain, and along it.
    fn follow(&mut self, cells: &[usize], cost_field: &CostField<'_>) {
        let Some(first) = cells.first() else { return };
        let space = self.router.space();
        let link = cost_field.path(*first);
        for cell in link.into_iter().chain(corners(space, cells)) {
            let (point, before) = (space.point(cell), self.corners.last().copied());
            if before != Some(point) {
                self.heading_rad = before.map_or(self.heading_rad, |before| heading_rad(before, point));
                self.corners.push(point);
            }
            self.at = cell;
        }
        self.driven += 1;
    }
}
