//! A home: everything about it that does not change while a robot drives in it, except its doors.

use std::path::Path;

use crate::load::{self, DockWish, Draft, HomeError, HomeNotice};
use crate::model::RobotModel;
use crate::plan::{
    Cell, DistanceField, DockSearch, Door, Grid, Regions, SurfaceMap, WalkerPlan, Ways, blocked_field,
    cliff_field, docked_pose, solid_field,
};
use crate::pose::Pose;

/// A floor plan, prepared for one model of robot. All poses are in the plan frame (see [`Grid`]).
#[derive(Clone, Debug)]
pub struct Home {
    name: String,
    rooms: Option<u32>,
    grid: Grid,
    file_from_plan: Pose,
    dock: Option<Pose>,
    start: Pose,
    reachable: Vec<bool>,
    reachable_cells: u32,
    connected_share: f64,
    can_leave: bool,
    t0_s: f64,
    pub(crate) solid: DistanceField,
    pub(crate) cliffs: Option<DistanceField>,
    pub(crate) surfaces: SurfaceMap,
    pub(crate) doors: Vec<Door>,
    /// For each cell whether it belongs to a mirror; empty where there is none.
    pub(crate) mirrors: Vec<bool>,
    pub(crate) walkers: Vec<WalkerPlan>,
    notices: Vec<HomeNotice>,
}

impl Home {
    /// Reads a home and prepares it for this model. The format is recognised by the content: a ROS `map_server` YAML
    /// (with the PGM or PNG that it names), a Valetudo map JSON of version 1 or 2, or a home TOML of our own.
    ///
    /// # Errors
    /// [`HomeError`]; no file content can cause anything else.
    pub fn load(path: &Path, model: &RobotModel) -> Result<Self, HomeError> {
        let draft = load::read_draft(path, model.body.climb_m)?;
        Self::prepare(draft, model, path)
    }

    /// As [`Self::load`], for the text of a home TOML that is not in a file. `name` takes the place of the file in
    /// errors, and for the home's name if the text gives none.
    ///
    /// # Errors
    /// [`HomeError`], as for a file with this text.
    pub fn from_floorplan(name: &str, text: &str, model: &RobotModel) -> Result<Self, HomeError> {
        let path = Path::new(name);
        let draft = load::read_floorplan(path, text, model.body.climb_m)?;
        Self::prepare(draft, model, path)
    }

    fn prepare(draft: Draft, model: &RobotModel, path: &Path) -> Result<Self, HomeError> {
        if !draft.grid.cells.iter().any(|cell| cell.is_floor()) {
            return Err(HomeError::NoFloor {
                path: path.to_owned(),
            });
        }
        let widest = without_black(&draft, with_doors_open(&draft));
        let blocked = blocked_field(&widest);
        let regions = Regions::new(&widest, &blocked, model.body.radius_m);
        let search = Search {
            grid: &widest,
            blocked: &blocked,
            regions: &regions,
            model,
            path,
            notices: &draft.notices,
        };
        let place = search.place(draft.dock)?;
        let ways = Ways::new(&widest, &blocked);
        let walkers = draft.walkers.iter().map(|wish| WalkerPlan {
            kind: wish.kind,
            legs: ways.round(&wish.goals, wish.kind),
            rest_ms: wish.rest_ms,
            from_ms: wish.from_ms,
            until_ms: wish.until_ms,
        });
        let walkers = walkers.collect();
        let reachable = regions.swept_from(place.region, &widest, model.body.swath_m);
        let reachable_cells = reachable.iter().filter(|cell| **cell).count() as u32;
        let area_m2 = f64::from(reachable_cells) * widest.cell_area_m2();
        let start = draft.start.unwrap_or(place.start);
        let beside = |(right_m, up_m)| widest.index(start.x_m + right_m, start.y_m + up_m);
        let can_leave = NEIGHBOURS
            .iter()
            .map(|(right, up)| (right * widest.cell_m, up * widest.cell_m))
            .filter_map(beside)
            .any(|index| regions.label(index) == place.region);
        Ok(Self {
            name: draft.name,
            rooms: draft.rooms,
            file_from_plan: draft.file_from_plan,
            dock: place.dock,
            start,
            can_leave,
            connected_share: regions.share(place.region),
            reachable,
            reachable_cells,
            t0_s: area_m2 / (model.body.swath_m * model.drive.cruise_m_per_s),
            solid: solid_field(&draft.grid),
            cliffs: cliff_field(&draft.grid),
            surfaces: draft.surfaces,
            mirrors: draft.mirrors,
            walkers,
            doors: draft.doors,
            grid: draft.grid,
            notices: draft.notices,
        })
    }

    /// The same home with one door open or closed. A number that it has not changes nothing.
    pub(crate) fn with_door(&self, number: usize, open: bool) -> Self {
        let mut changed = self.clone();
        if let Some(door) = changed.doors.get_mut(number) {
            door.open = open;
            set_door(&mut changed.grid, door, open);
            changed.solid = solid_field(&changed.grid);
        }
        changed
    }

    /// The same home with every door open that is ever open, and without people.
    #[must_use]
    pub fn with_doors_open(&self) -> Self {
        let mut changed = self.clone();
        for door in &mut changed.doors {
            if door.ever_open() {
                door.open = true;
                set_door(&mut changed.grid, door, true);
            }
        }
        changed.solid = solid_field(&changed.grid);
        changed
    }

    /// Name of the home: the `name` in its file, else the file's name without extension.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What its file may mean otherwise than its maker thinks: to be told before a robot drives in it.
    #[must_use]
    pub fn notices(&self) -> &[HomeNotice] {
        &self.notices
    }

    /// Rooms that its file knows; `None` = it knows of no rooms.
    #[must_use]
    pub const fn rooms(&self) -> Option<u32> {
        self.rooms
    }

    /// The cells.
    #[must_use]
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The plan frame in the frame that the file uses (ROS `origin`, the pixels of Valetudo in metres with y up, the
    /// coordinates of our own format).
    #[must_use]
    pub const fn file_from_plan(&self) -> Pose {
        self.file_from_plan
    }

    /// The dock: the middle of its back at the wall, heading into the room. Maps without a dock get one at a wall where
    /// there is room for it.
    #[must_use]
    pub const fn dock(&self) -> Option<Pose> {
        self.dock
    }

    /// Default start of the robot: on the dock if the file has one, else at the roomiest place.
    #[must_use]
    pub const fn start(&self) -> Pose {
        self.start
    }

    /// Area of all floor cells, square metres.
    #[must_use]
    pub fn free_area_m2(&self) -> f64 {
        let free = self.grid.cells.iter().filter(|cell| cell.is_floor()).count();
        free as f64 * self.grid.cell_area_m2()
    }

    /// Area that a disc of the swath's width can sweep from poses that the body can reach from the start, square
    /// metres. Doors that are ever open count as open.
    #[must_use]
    pub fn reachable_area_m2(&self) -> f64 {
        f64::from(self.reachable_cells) * self.grid.cell_area_m2()
    }

    /// The cells of that area, in the order of [`Grid::cells`].
    #[must_use]
    pub fn reachable(&self) -> &[bool] {
        &self.reachable
    }

    pub(crate) const fn reachable_cells(&self) -> u32 {
        self.reachable_cells
    }

    /// Lower bound of the cleaning time in seconds: reachable area / (swath x cruise speed).
    #[must_use]
    pub const fn t0_s(&self) -> f64 {
        self.t0_s
    }

    /// Share of all floor where the body fits that it can reach from the start, 0..1.
    #[must_use]
    pub const fn connected_share(&self) -> f64 {
        self.connected_share
    }

    /// Whether the path from the start to the dock, or to most of the floor, is wide enough for the body, once all
    /// doors that are ever open have been opened and all people have left.
    #[must_use]
    pub const fn can_leave(&self) -> bool {
        self.can_leave
    }

    /// Distance in metres from a place to the nearest solid thing; negative inside of one.
    #[must_use]
    pub fn clearance_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.solid.at(x_m, y_m)
    }
}

/// A cell and those around it, columns and rows: a robot that just fits may be between two cells.
const NEIGHBOURS: [(f64, f64); 5] = [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];

fn set_door(grid: &mut Grid, door: &Door, open: bool) {
    for (index, behind) in &door.cells {
        if let Some(cell) = grid.cells.get_mut(*index) {
            *cell = if open { *behind } else { Cell::Obstacle };
        }
    }
}

fn with_doors_open(draft: &Draft) -> Grid {
    let mut grid = draft.grid.clone();
    for door in draft.doors.iter().filter(|door| door.ever_open()) {
        set_door(&mut grid, door, true);
    }
    grid
}

/// The same plan with drops where cliff sensors report drops: on black rugs.
fn without_black(draft: &Draft, mut grid: Grid) -> Grid {
    if draft.surfaces.has_black() {
        for (index, cell) in grid.cells.iter_mut().enumerate() {
            if cell.is_floor() && draft.surfaces.at(index).black {
                *cell = Cell::Cliff;
            }
        }
    }
    grid
}

/// Region, dock and start that belong together.
struct Placement {
    region: u32,
    dock: Option<Pose>,
    start: Pose,
}

struct Search<'a> {
    grid: &'a Grid,
    blocked: &'a DistanceField,
    regions: &'a Regions,
    model: &'a RobotModel,
    path: &'a Path,
    notices: &'a [HomeNotice],
}

impl Search<'_> {
    fn place(&self, wish: DockWish) -> Result<Placement, HomeError> {
        let biggest = self.regions.biggest().ok_or_else(|| self.no_place())?;
        let radius_m = self.model.body.radius_m;
        let docks = DockSearch {
            grid: self.grid,
            blocked: self.blocked,
            regions: self.regions,
            radius_m,
        };
        let (region, dock, on_dock) = match wish {
            DockWish::Anywhere => (biggest, docks.find(biggest, None), false),
            DockWish::Near(x_m, y_m) => (biggest, docks.find(biggest, Some((x_m, y_m))), true),
            DockWish::At(dock) => (self.region_of_dock(dock)?, Some(dock), true),
        };
        let start = match dock {
            Some(dock) if on_dock => docked_pose(dock, radius_m),
            _ => self.roomiest(region),
        };
        Ok(Placement { region, dock, start })
    }

    /// The region in front of the dock.
    fn region_of_dock(&self, dock: Pose) -> Result<u32, HomeError> {
        let docked = docked_pose(dock, self.model.body.radius_m);
        let steps = 10;
        (0..=steps)
            .map(|step| docked.point(-0.3 * f64::from(step) / f64::from(steps), 0.0))
            .filter_map(|(x_m, y_m)| self.grid.index(x_m, y_m))
            .map(|index| self.regions.label(index))
            .find(|region| *region != 0)
            .ok_or_else(|| HomeError::Invalid {
                path: self.path.to_owned(),
                place: "`dock`".to_owned(),
                problem: format!(
                    "there is no room for the robot (radius {} m) in front of it; move the dock or turn it into the room",
                    self.model.body.radius_m
                ),
            })
    }

    fn roomiest(&self, region: u32) -> Pose {
        let mut best = (f32::NEG_INFINITY, 0);
        for index in self.regions.cells(region) {
            let clearance = self.blocked.cell(index);
            if clearance > best.0 {
                best = (clearance, index);
            }
        }
        let (x_m, y_m) = self.grid.centre(best.1);
        Pose::new(x_m, y_m, 0.0)
    }

    fn no_place(&self) -> HomeError {
        let clear = (0..self.grid.cells.len())
            .map(|index| self.blocked.cell(index))
            .fold(0.0, f32::max);
        HomeError::NoPlace {
            path: self.path.to_owned(),
            radius_m: self.model.body.radius_m,
            clear_m: f64::from(clear),
            notices: self.notices.to_vec(),
        }
    }
}
