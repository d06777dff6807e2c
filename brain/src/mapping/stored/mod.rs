//! A map as plain data, for the disk and for the start of a recording. Callers serialize its [parts](StoredMapParts).
//!
//! Evidence is quantized, and equal adjacent cells form runs. A home of 150 square metres takes some ten kilobytes.

mod parts;

use std::collections::BTreeSet;

pub use parts::{Numbered, StoredMapError, StoredMapParts};

use super::annotations::Annotations;
use super::cell_past::CellPast;
use super::next_numbers::NextNumbers;
use super::occupancy_grid::{CellBox, Evidence, Flag, OccupancyGrid, TILES_MAX};
use super::rooms::Rooms;
use super::tile_grid::TILE_CELLS;
use super::{Cell, CellKnowledge, DockLocation, Raster, SurfaceKind};
use crate::model::geometry::Pose2;
use crate::model::gradual::{StepBudget, at_once};
use crate::model::known_beacon::KnownBeacon;

/// Most cells of a stored map.
pub(super) const CELLS_MAX: u64 = TILES_MAX as u64 * (TILE_CELLS * TILE_CELLS) as u64;

/// A map as plain data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StoredMap {
    dock: DockLocation,
    origin: Cell,
    width: u32,
    height: u32,
    cells: Vec<CellRun>,
    /// Segmented room of each cell, 0 = none; empty when the map has no rooms yet.
    rooms: Vec<CellRun>,
    /// Packed past of each cell; empty when no earlier run is known.
    past: Vec<CellRun>,
    /// Identity of the next new room.
    next_room: u16,
    annotations: Annotations,
    /// Radio beacons with places in the frame of the map.
    beacons: Vec<KnownBeacon>,
}

/// A run of equal cells; it may continue over several rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellRun {
    /// Packed evidence of the cells, or their room.
    pub value: u16,
    /// Number of cells.
    pub length: u32,
}

/// Work of writing or reading a cell, beside visiting it.
const CELL_WORK: usize = 4;

/// Occupancy is quantized to 15 steps of this size.
const OCCUPANCY_STEP: i8 = 12;

impl StoredMap {
    /// A map with this knowledge, for instance of a measured home.
    #[must_use]
    pub fn from_raster(knowledge: &Raster<CellKnowledge>, dock: Option<Pose2>) -> Self {
        let cells = runs_of(knowledge.values().iter().map(|kind| pack(certain(*kind))));
        Self {
            dock: dock.map(DockLocation::converged).unwrap_or_default(),
            origin: knowledge.origin(),
            width: knowledge.width().try_into().unwrap_or(u32::MAX),
            height: knowledge.height().try_into().unwrap_or(u32::MAX),
            cells,
            rooms: Vec::new(),
            past: Vec::new(),
            next_room: 1,
            annotations: Annotations::default(),
            beacons: Vec::new(),
        }
    }

    /// Pose of a docked robot, if known.
    #[must_use]
    pub fn dock(&self) -> Option<Pose2> {
        self.dock.pose()
    }

    /// Location of the dock and its source.
    #[must_use]
    pub fn dock_location(&self) -> DockLocation {
        self.dock
    }

    /// The same map with another dock.
    #[must_use]
    pub fn with_dock_location(self, dock: DockLocation) -> Self {
        Self { dock, ..self }
    }

    /// The numbers that it gives next.
    #[must_use]
    pub fn next_numbers(&self) -> NextNumbers {
        NextNumbers {
            room: self.next_room,
            ..self.annotations.next_numbers()
        }
    }

    /// The same map, whose new rooms, changes, zones and places get these numbers or higher ones.
    #[must_use]
    pub fn numbered_after(mut self, next: NextNumbers) -> Self {
        self.next_room = self.next_room.max(next.room);
        self.annotations.number_after(next);
        self
    }

    /// Everything that people added to the map.
    #[must_use]
    pub fn annotations(&self) -> &Annotations {
        &self.annotations
    }

    /// The same map with other annotations.
    #[must_use]
    pub fn with_annotations(self, annotations: Annotations) -> Self {
        Self { annotations, ..self }
    }

    /// Radio beacons whose places are known.
    #[must_use]
    pub fn beacons(&self) -> &[KnownBeacon] {
        &self.beacons
    }

    /// The same map with these beacons.
    #[must_use]
    pub fn with_beacons(self, beacons: Vec<KnownBeacon>) -> Self {
        Self { beacons, ..self }
    }

    /// Knowledge of each cell.
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

    /// Number of rooms.
    #[must_use]
    pub fn room_count(&self) -> usize {
        let labels: BTreeSet<u16> = if self.annotations.room_changes().is_empty() {
            self.rooms.iter().map(|run| run.value).collect()
        } else {
            let changes = self.annotations.room_changes();
            let changed = at_once(changes.apply_to(self.rooms().found(), &mut StepBudget::unlimited()));
            changed.values().iter().copied().collect()
        };
        labels.iter().filter(|label| **label != 0).count()
    }

    /// Whether all cells are unknown. Annotations do not count.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells.iter().all(|run| run.value == 0)
    }

    /// Whether all cells are unknown, and nothing has had a number yet.
    #[must_use]
    pub fn is_blank(&self) -> bool {
        self.is_empty() && self.next_numbers().after(NextNumbers::FIRST) == NextNumbers::FIRST
    }

    pub(super) async fn of_layers(grid: &OccupancyGrid, rooms: &Rooms, budget: &mut StepBudget) -> Self {
        let mut around: Option<CellBox> = None;
        for (cell, _) in grid.gathered() {
            let here = CellBox::of(cell);
            around = Some(around.map_or(here, |before| before.joined(here)));
            budget.spend(CELL_WORK).await;
        }
        let Some(around) = around else {
            return Self {
                next_room: rooms.next_id(),
                ..Self::default()
            };
        };
        let (width, height) = around.size();
        let mut raster = Raster::filled(around.low, width, height, (0_u16, 0_u16));
        for (cell, evidence) in grid.gathered() {
            if let Some(place) = raster.get_mut(cell) {
                *place = (pack(evidence), evidence.past.packed());
            }
            budget.spend(CELL_WORK).await;
        }
        let (mut cells, mut labels, mut pasts) = (Vec::new(), Vec::new(), Vec::new());
        for (index, (value, past)) in raster.values().iter().enumerate() {
            let label = rooms.found().get(raster.cell(index)).copied();
            push_value(&mut cells, *value);
            push_value(&mut labels, label.unwrap_or(0));
            push_value(&mut pasts, *past);
            budget.spend(CELL_WORK).await;
        }
        Self {
            dock: DockLocation::default(),
            origin: around.low,
            width: width.try_into().unwrap_or(u32::MAX),
            height: height.try_into().unwrap_or(u32::MAX),
            cells,
            rooms: labels,
            past: pasts,
            next_room: rooms.next_id(),
            annotations: Annotations::default(),
            beacons: Vec::new(),
        }
    }

    /// The segmented rooms: cells and identities.
    pub(super) fn rooms(&self) -> Rooms {
        let mut labels = Raster::filled(self.origin, self.width as usize, self.height as usize, 0);
        for (place, value) in labels.values_mut().iter_mut().zip(values_of(&self.rooms)) {
            *place = value;
        }
        Rooms::from_stored(labels, self.next_room)
    }

    /// The stored cells as an occupancy grid.
    pub(super) async fn grid(&self, budget: &mut StepBudget) -> OccupancyGrid {
        let mut grid = OccupancyGrid::default();
        let raster: Raster<()> = Raster::filled(self.origin, self.width as usize, self.height as usize, ());
        for (index, value) in values_of(&self.cells).enumerate() {
            if value != 0 {
                grid.change(raster.cell(index), |evidence| *evidence = unpack(value));
                budget.spend(CELL_WORK).await;
            }
            budget.spend(1).await;
        }
        for (index, bits) in values_of(&self.past).enumerate() {
            if bits != 0 {
                let past = CellPast::unpacked(bits);
                grid.change(raster.cell(index), |evidence| evidence.past = past);
            }
            budget.spend(1).await;
        }
        grid
    }
}

/// Evidence that makes a knowledge certain.
fn certain(kind: CellKnowledge) -> Evidence {
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

/// Bits of the surface in a cell: 0 unknown, 1 hard, 2 carpet.
const SURFACE_BITS: u16 = 0b11 << 8;
/// Evidence of a stored surface: certain, but weak enough that a removed rug soon disappears.
const SURFACE_REMEMBERED: i8 = 12;

fn surface_number(kind: Option<SurfaceKind>) -> u16 {
    match kind {
        None => 0,
        Some(SurfaceKind::Hard) => 1,
        Some(SurfaceKind::Carpet) => 2,
    }
}

fn surface_kind(number: u8) -> Option<SurfaceKind> {
    match number {
        1 => Some(SurfaceKind::Hard),
        2 => Some(SurfaceKind::Carpet),
        _ => None,
    }
}

/// From the lowest bit: 4 bits occupancy, 2 contact, 2 cliff, 2 surface ([`SURFACE_BITS`]), 1 body, 1 no-go, 1 seen, 3
/// uncertainty.
fn pack(evidence: Evidence) -> u16 {
    // Rounding preserves free and occupied.
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
        (surface_number(evidence.surface()), 2),
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
        past: CellPast::of_contact(2 * field(4, 2)),
    };
    if let Some(kind) = surface_kind(field(8, 2)) {
        evidence.add_surface(kind, SURFACE_REMEMBERED);
    }
    for (shift, flag) in [(10, Flag::Body), (11, Flag::NoGo), (12, Flag::Seen)] {
        if field(shift, 1) == 1 {
            evidence.set(flag);
        }
    }
    evidence
}

pub(super) fn runs_of(values: impl Iterator<Item = u16>) -> Vec<CellRun> {
    let mut runs = Vec::new();
    for value in values {
        push_value(&mut runs, value);
    }
    runs
}

/// Extends the last run, or begins another one.
fn push_value(runs: &mut Vec<CellRun>, value: u16) {
    match runs.last_mut() {
        Some(run) if run.value == value && run.length < u32::MAX => run.length += 1,
        _ => runs.push(CellRun { value, length: 1 }),
    }
}

pub(super) fn values_of(runs: &[CellRun]) -> impl Iterator<Item = u16> + '_ {
    runs.iter()
        .flat_map(|run| core::iter::repeat_n(run.value, run.length as usize))
}
