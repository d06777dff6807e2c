//! A map as plain data, for the disk and for the beginning of a recording; who keeps it makes bytes of its [parts](StoredMapParts).
//!
//! What a cell holds is rounded to what decides about it; equal cells side by side are one run. A home of 150 square
//! metres takes some ten kilobytes.

mod parts;

use std::collections::BTreeSet;

pub use parts::{Numbered, StoredMapError, StoredMapParts};

use super::annotations::Annotations;
use super::layers::{CellBox, Evidence, Flag, Layers, TILES_MAX};
use super::rooms::Rooms;
use super::tile_grid::TILE_CELLS;
use super::{Cell, CellKnowledge, DockPlace, FloorKind, Raster};
use crate::model::geometry::Pose2;
use crate::model::gradual::{StepBudget, at_once};

/// Most cells of a stored map's window.
pub(super) const CELLS_MAX: u64 = TILES_MAX as u64 * (TILE_CELLS * TILE_CELLS) as u64;

/// A map as plain data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StoredMap {
    dock: DockPlace,
    origin: Cell,
    width: u32,
    height: u32,
    cells: Vec<Run>,
    /// Room of each cell as it was found, 0 = none; no runs at all when the map has no rooms yet.
    rooms: Vec<Run>,
    /// Identity of the next room that has none yet.
    next_room: u16,
    annotations: Annotations,
}

/// Equal cells side by side, rows joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Run {
    /// What the cells hold, packed, or their room.
    pub value: u16,
    /// How many they are.
    pub length: u32,
}

/// Work on a cell that is written down or taken up, beside one that is only looked at.
const CELL_WORK: usize = 4;

/// Occupancy is stored in 15 steps of this size.
const OCCUPANCY_STEP: i8 = 12;

impl StoredMap {
    /// A map of what is known of each cell, for instance of a home that somebody measured.
    #[must_use]
    pub fn from_raster(knowledge: &Raster<CellKnowledge>, dock: Option<Pose2>) -> Self {
        let cells = runs_of(knowledge.values().iter().map(|kind| pack(sure(*kind))));
        Self {
            dock: dock.map(DockPlace::sure).unwrap_or_default(),
            origin: knowledge.origin(),
            width: knowledge.width().try_into().unwrap_or(u32::MAX),
            height: knowledge.height().try_into().unwrap_or(u32::MAX),
            cells,
            rooms: Vec::new(),
            next_room: 1,
            annotations: Annotations::default(),
        }
    }

    /// Pose of a robot that stands on the dock, if that is known.
    #[must_use]
    pub fn dock(&self) -> Option<Pose2> {
        self.dock.pose()
    }

    /// The same with what it is known from.
    #[must_use]
    pub fn dock_place(&self) -> DockPlace {
        self.dock
    }

    /// The same map with another dock.
    #[must_use]
    pub fn with_dock_place(self, dock: DockPlace) -> Self {
        Self { dock, ..self }
    }

    /// What people have said of the home.
    #[must_use]
    pub fn annotations(&self) -> &Annotations {
        &self.annotations
    }

    /// The same map with other words of people.
    #[must_use]
    pub fn with_annotations(self, annotations: Annotations) -> Self {
        Self { annotations, ..self }
    }

    /// What is known of each cell.
    #[must_use]
    pub fn knowledge(&self) -> Raster<CellKnowledge> {
        at_once(self.knowledge_in_steps(&mut StepBudget::unlimited()))
    }

    /// As [`Self::knowledge`], in steps.
    pub(crate) async fn knowledge_in_steps(&self, budget: &mut StepBudget) -> Raster<CellKnowledge> {
        let mut raster = Raster::filled(
            self.origin,
            self.width as usize,
            self.height as usize,
            CellKnowledge::Unknown,
        );
        for (place, value) in raster.values_mut().iter_mut().zip(values_of(&self.cells)) {
            *place = unpack(value).knowledge();
            budget.spend(1).await;
        }
        raster
    }

    /// Number of rooms in it.
    #[must_use]
    pub fn room_count(&self) -> usize {
        let labels: BTreeSet<u16> = if self.annotations.room_changes().is_empty() {
            self.rooms.iter().map(|run| run.value).collect()
        } else {
            let changes = self.annotations.room_changes();
            let changed = at_once(changes.made_in(self.rooms().found(), &mut StepBudget::unlimited()));
            changed.values().iter().copied().collect()
        };
        labels.iter().filter(|label| **label != 0).count()
    }

    /// Whether nothing is known, whatever people have said.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells.iter().all(|run| run.value == 0)
    }

    pub(super) async fn of_layers(layers: &Layers, rooms: &Rooms, budget: &mut StepBudget) -> Self {
        let mut around: Option<CellBox> = None;
        for (cell, _) in layers.gathered() {
            let here = CellBox::of(cell);
            around = Some(around.map_or(here, |before| before.joined(here)));
            budget.spend(CELL_WORK).await;
        }
        let Some(around) = around else {
            return Self {
                next_room: rooms.next(),
                ..Self::default()
            };
        };
        let (width, height) = around.size();
        let mut raster = Raster::filled(around.low, width, height, 0_u16);
        for (cell, evidence) in layers.gathered() {
            if let Some(place) = raster.get_mut(cell) {
                *place = pack(evidence);
            }
            budget.spend(CELL_WORK).await;
        }
        let (mut cells, mut labels) = (Vec::new(), Vec::new());
        for (index, value) in raster.values().iter().enumerate() {
            let label = rooms.found().get(raster.cell(index)).copied();
            lengthen(&mut cells, *value);
            lengthen(&mut labels, label.unwrap_or(0));
            budget.spend(CELL_WORK).await;
        }
        Self {
            dock: DockPlace::default(),
            origin: around.low,
            width: width.try_into().unwrap_or(u32::MAX),
            height: height.try_into().unwrap_or(u32::MAX),
            cells,
            rooms: labels,
            next_room: rooms.next(),
            annotations: Annotations::default(),
        }
    }

    /// Cells and identities of the rooms that were found.
    pub(super) fn rooms(&self) -> Rooms {
        let mut labels = Raster::filled(self.origin, self.width as usize, self.height as usize, 0);
        for (place, value) in labels.values_mut().iter_mut().zip(values_of(&self.rooms)) {
            *place = value;
        }
        Rooms::remembered(labels, self.next_room)
    }

    /// What is stored, as layers.
    pub(super) async fn layers(&self, budget: &mut StepBudget) -> Layers {
        let mut layers = Layers::default();
        let raster: Raster<()> = Raster::filled(self.origin, self.width as usize, self.height as usize, ());
        for (index, value) in values_of(&self.cells).enumerate() {
            if value != 0 {
                layers.change(raster.cell(index), |evidence| *evidence = unpack(value));
                budget.spend(CELL_WORK).await;
            }
            budget.spend(1).await;
        }
        layers
    }
}

/// Evidence that stands for a sure knowledge.
fn sure(kind: CellKnowledge) -> Evidence {
    let mut evidence = Evidence::default();
    match kind {
        CellKnowledge::Unknown => return evidence,
        CellKnowledge::Free => evidence.occupancy = -84,
        CellKnowledge::Occupied => evidence.occupancy = 84,
        CellKnowledge::Cliff => evidence.cliff = 6,
        CellKnowledge::NoGo => evidence.set(Flag::NoGo),
    }
    evidence.set(Flag::Seen);
    evidence
}

/// Bits of the kind of floor in a cell: 0 not felt, 1 hard, 2 carpet.
const FLOOR_BITS: u16 = 0b11 << 8;
/// Evidence of a kind of floor that was stored: sure, and not so sure that a rug which was taken away stays for long.
const FLOOR_REMEMBERED: i8 = 12;

fn floor_number(kind: Option<FloorKind>) -> u16 {
    match kind {
        None => 0,
        Some(FloorKind::Hard) => 1,
        Some(FloorKind::Carpet) => 2,
    }
}

fn floor_kind(number: u8) -> Option<FloorKind> {
    match number {
        1 => Some(FloorKind::Hard),
        2 => Some(FloorKind::Carpet),
        _ => None,
    }
}

/// From the lowest bit: 4 bits occupancy, 2 contact, 2 cliff, 2 kind of floor ([`FLOOR_BITS`]), 1 body, 1 no-go, 1 seen,
/// 3 uncertainty.
fn pack(evidence: Evidence) -> u16 {
    // Rounded so that what counts as free or occupied still does.
    let rounding = if evidence.occupancy < 0 {
        OCCUPANCY_STEP - 4
    } else {
        0
    };
    let steps = evidence.occupancy.saturating_sub(rounding) / OCCUPANCY_STEP;
    let occupancy = steps.clamp(-7, 7) + 7;
    let fields = [
        (occupancy as u16 ^ 7, 4),
        (u16::from(evidence.contact / 2).min(3), 2),
        (u16::from(evidence.cliff / 2).min(3), 2),
        (floor_number(evidence.floor()), 2),
        (u16::from(evidence.has(Flag::Body)), 1),
        (u16::from(evidence.has(Flag::NoGo)), 1),
        (u16::from(evidence.has(Flag::Seen)), 1),
        (u16::from(evidence.sigma_cm / 5).min(7), 3),
    ];
    let mut packed = 0;
    let mut shift = 0;
    for (value, bits) in fields {
        packed |= value << shift;
        shift += bits;
    }
    packed
}

fn unpack(packed: u16) -> Evidence {
    let field = |shift: u16, bits: u16| (packed >> shift & ((1 << bits) - 1)) as u8;
    let occupancy = ((field(0, 4) ^ 7) as i8 - 7) * OCCUPANCY_STEP;
    let mut evidence = Evidence {
        occupancy,
        contact: 2 * field(4, 2),
        cliff: 2 * field(6, 2),
        sigma_cm: 5 * field(13, 3),
        flags: 0,
        carpet: 0,
    };
    if let Some(kind) = floor_kind(field(8, 2)) {
        evidence.feel(kind, FLOOR_REMEMBERED);
    }
    for (shift, flag) in [(10, Flag::Body), (11, Flag::NoGo), (12, Flag::Seen)] {
        if field(shift, 1) == 1 {
            evidence.set(flag);
        }
    }
    evidence
}

pub(super) fn runs_of(values: impl Iterator<Item = u16>) -> Vec<Run> {
    let mut runs = Vec::new();
    for value in values {
        lengthen(&mut runs, value);
    }
    runs
}

/// Adds a cell to the last run, or begins another one.
fn lengthen(runs: &mut Vec<Run>, value: u16) {
    match runs.last_mut() {
        Some(run) if run.value == value && run.length < u32::MAX => run.length += 1,
        _ => runs.push(Run { value, length: 1 }),
    }
}

pub(super) fn values_of(runs: &[Run]) -> impl Iterator<Item = u16> + '_ {
    runs.iter()
        .flat_map(|run| core::iter::repeat_n(run.value, run.length as usize))
}
