//! A place for the dock in plans that have none, or only an approximate position.

use super::distance::DistanceField;
use super::grid::Grid;
use super::reach::Regions;
use crate::Pose;

/// Gap between the body and the back of the dock when the robot is on its contacts, metres.
pub(crate) const DOCK_GAP_M: f64 = 0.01;
/// Length of the path in front of a dock that must be free for the body, metres.
const APPROACH_M: f64 = 0.6;
/// Most candidates that are checked, to bound the time in a huge hall.
const CANDIDATES_MAX: usize = 4_000;

/// Pose of the robot on its dock, facing it.
pub(crate) fn docked_pose(dock: Pose, radius_m: f64) -> Pose {
    let (x_m, y_m) = dock.point(radius_m + DOCK_GAP_M, 0.0);
    Pose::new(x_m, y_m, dock.heading_rad + core::f64::consts::PI)
}

/// Finds a dock at a wall of the region: the candidate nearest to `hint` (metres), or the one with most room in front.
pub(crate) struct DockSearch<'a> {
    pub(crate) grid: &'a Grid,
    pub(crate) blocked: &'a DistanceField,
    pub(crate) regions: &'a Regions,
    pub(crate) radius_m: f64,
}

impl DockSearch<'_> {
    pub(crate) fn find(&self, region: u32, hint: Option<(f64, f64)>) -> Option<Pose> {
        let near_wall: Vec<usize> = self
            .regions
            .cells(region)
            .filter(|index| f64::from(self.blocked.cell(*index)) < self.radius_m + 2.0 * self.grid.cell_m)
            .collect();
        let mut best: Option<(f64, Pose)> = None;
        for index in self.thinned(&near_wall, hint) {
            let Some(dock) = self.candidate(index) else {
                continue;
            };
            let cost = match hint {
                Some((x_m, y_m)) => dock.distance_m(Pose::new(x_m, y_m, 0.0)),
                None => -self.room_in_front(dock),
            };
            if best.is_none_or(|(lowest, _)| cost < lowest) {
                best = Some((cost, dock));
            }
        }
        best.map(|(_, dock)| dock)
    }

    /// With a hint the nearest candidates, without every n-th.
    fn thinned(&self, cells: &[usize], hint: Option<(f64, f64)>) -> Vec<usize> {
        if let Some((x_m, y_m)) = hint {
            let mut sorted: Vec<(f64, usize)> = cells
                .iter()
                .map(|index| {
                    let (x, y) = self.grid.centre(*index);
                    ((x - x_m) * (x - x_m) + (y - y_m) * (y - y_m), *index)
                })
                .collect();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            return sorted
                .into_iter()
                .take(CANDIDATES_MAX)
                .map(|(_, index)| index)
                .collect();
        }
        let every = cells.len() / CANDIDATES_MAX + 1;
        cells.iter().copied().step_by(every).collect()
    }

    /// A dock at the wall next to this cell, if the wall is straight enough there and the path to it is free.
    fn candidate(&self, index: usize) -> Option<Pose> {
        let (x_m, y_m) = self.grid.centre(index);
        let (nx, ny) = self.blocked.away(x_m, y_m);
        let distance = self.blocked.at(x_m, y_m);
        let dock = Pose::new(x_m - nx * distance, y_m - ny * distance, libm::atan2(ny, nx));
        let free = |along: f64, aside: f64, radius: f64| {
            let (x, y) = dock.point(along, aside);
            self.blocked.at(x, y) >= radius
        };
        let docked = self.radius_m + DOCK_GAP_M;
        let tolerance = 0.5 * self.grid.cell_m;
        let path_free = (0..=6).all(|step| {
            free(
                docked + APPROACH_M * f64::from(step) / 6.0,
                0.0,
                self.radius_m - tolerance,
            )
        });
        let wall_straight = [-0.08, 0.08].iter().all(|aside| {
            let (x, y) = dock.point(0.1, *aside);
            (self.blocked.at(x, y) - 0.1).abs() < self.grid.cell_m
        });
        (path_free && wall_straight).then_some(dock)
    }

    fn room_in_front(&self, dock: Pose) -> f64 {
        let (x, y) = dock.point(self.radius_m + APPROACH_M, 0.0);
        self.blocked.at(x, y)
    }
}
