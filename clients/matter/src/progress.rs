//! How far a job is, room by room.
//!
//! The daemon says in which room the robot works and which cells it has swept. A room that it leaves is completed when most of its
//! floor is swept, and waits when it is not: the robot may only have passed through.

use std::collections::HashSet;

use bridge::Knowledge;
use bridge::rle::cells;
use rvac_api::{HomeView, MapSnapshot};

/// A room counts as completed from this share of its free floor on. Along walls and legs some cells are never swept.
const COMPLETED_SHARE: f64 = 0.8;
/// What a cell of the home is where the robot can be.
const FREE: u32 = 1;

/// What a job does with a room, as in `OperationalStatusEnum`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RoomState {
    Pending,
    Operating,
    Skipped,
    Completed,
}

/// A room of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RoomProgress {
    pub(crate) room: u16,
    pub(crate) state: RoomState,
    /// From the first work in it until it was completed or skipped, seconds of the job.
    pub(crate) took_s: Option<u32>,
    /// When it was first worked in, seconds of the job.
    begun_s: Option<u32>,
}

/// What of the robot's state it needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    pub(crate) cleans: bool,
    /// The room in which it works.
    pub(crate) here: Option<u16>,
    /// Seconds of the job.
    pub(crate) job_s: u32,
}

/// The rooms of the running or last job.
#[derive(Clone, Debug, Default)]
pub(crate) struct Progress {
    rows: Vec<RoomProgress>,
    /// The rooms of the next job, if it was ordered here.
    ordered: Option<Vec<u16>>,
    cleans: bool,
    here: Option<u16>,
}

impl Progress {
    /// These rooms are asked for next, in this order. Without it nobody has said which a job cleans: then they are listed as the robot
    /// comes to work in them.
    pub(crate) fn order(&mut self, rooms: Vec<u16>) {
        self.ordered = Some(rooms);
    }

    /// That was refused.
    pub(crate) fn refused(&mut self) {
        self.ordered = None;
    }

    pub(crate) fn rows(&self) -> &[RoomProgress] {
        &self.rows
    }

    /// Takes what the robot does now; `swept` gives the share of a room's floor that is swept.
    pub(crate) fn take(&mut self, now: Moment, swept: impl Fn(u16) -> f64) {
        if now.cleans && !self.cleans {
            let rooms = self.ordered.take().unwrap_or_default();
            self.rows = rooms.into_iter().map(RoomProgress::pending).collect();
            self.here = None;
        }
        if self.here != now.here {
            if let Some(left) = self.here {
                self.leave((left, RoomState::Pending), now.job_s, &swept);
            }
            if let Some(entered) = now.here.filter(|_| now.cleans) {
                self.enter(entered, now.job_s);
            }
            self.here = now.here;
        }
        if self.cleans && !now.cleans {
            let open: Vec<u16> = self
                .rows
                .iter()
                .filter(|row| row.is_open())
                .map(|row| row.room)
                .collect();
            for room in open {
                self.leave((room, RoomState::Skipped), now.job_s, &swept);
            }
        }
        self.cleans = now.cleans;
    }

    /// Rooms that the map has no more are none of a job.
    pub(crate) fn keep_only(&mut self, is_there: impl Fn(u16) -> bool) {
        self.rows.retain(|row| is_there(row.room));
    }

    fn enter(&mut self, room: u16, job_s: u32) {
        let place = self
            .rows
            .iter()
            .position(|row| row.room == room)
            .unwrap_or_else(|| {
                self.rows.push(RoomProgress::pending(room));
                self.rows.len() - 1
            });
        if let Some(row) = self.rows.get_mut(place) {
            row.state = RoomState::Operating;
            row.begun_s = row.begun_s.or(Some(job_s));
            row.took_s = None;
        }
    }

    /// The robot works elsewhere, or no more: the room is completed, or what the caller says.
    fn leave(&mut self, (room, otherwise): (u16, RoomState), job_s: u32, swept: impl Fn(u16) -> f64) {
        let Some(row) = self.rows.iter_mut().find(|row| row.room == room) else {
            return;
        };
        row.state = if swept(room) >= COMPLETED_SHARE {
            RoomState::Completed
        } else {
            otherwise
        };
        let since = row.begun_s.filter(|_| !row.is_open());
        row.took_s = since.map(|begun_s| job_s.saturating_sub(begun_s));
    }
}

impl RoomProgress {
    const fn pending(room: u16) -> Self {
        Self {
            room,
            state: RoomState::Pending,
            took_s: None,
            begun_s: None,
        }
    }

    const fn is_open(&self) -> bool {
        matches!(self.state, RoomState::Pending | RoomState::Operating)
    }
}

/// Share of a room's free floor that the running or last job has swept; 0 for a room that the home has not.
pub(crate) fn swept_share(known: &Knowledge, room: u16) -> f64 {
    known
        .home
        .as_ref()
        .map_or(0.0, |home| share(home, &known.map, room))
}

fn share(home: &HomeView, map: &MapSnapshot, room: u16) -> f64 {
    let width = home.width.max(1) as usize;
    let count = width.saturating_mul(home.height as usize);
    let swept: HashSet<(i32, i32)> = map.swept.as_chunks().0.iter().map(|[x, y]| (*x, *y)).collect();
    let of_rooms = cells(&home.room_cells, count).zip(cells(&home.cells, count));
    let (mut all, mut done) = (0_u32, 0_u32);
    for (number, (_, _)) in of_rooms
        .enumerate()
        .filter(|(_, (of, is))| *of == u32::from(room) && *is == FREE)
    {
        all += 1;
        let centre = |first: i32, place: usize| {
            let metres = (f64::from(first) + place as f64 + 0.5) * home.cell_m;
            (metres / map.cell_m).floor() as i32
        };
        let cell = (centre(home.x, number % width), centre(home.y, number / width));
        done += u32::from(swept.contains(&cell));
    }
    if all == 0 {
        0.0
    } else {
        f64::from(done) / f64::from(all)
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{HomeView, MapSnapshot};

    use super::RoomState::{Completed, Operating, Pending, Skipped};
    use super::{Moment, Progress, RoomState, share};

    fn at(here: Option<u16>, job_s: u32) -> Moment {
        Moment {
            cleans: true,
            here,
            job_s,
        }
    }

    fn ended(job_s: u32) -> Moment {
        Moment {
            cleans: false,
            here: None,
            job_s,
        }
    }

    fn rows(progress: &Progress) -> Vec<(u16, RoomState, Option<u32>)> {
        progress
            .rows()
            .iter()
            .map(|row| (row.room, row.state, row.took_s))
            .collect()
    }

    #[test]
    fn an_ordered_job_lists_its_rooms_and_completes_those_that_are_swept() {
        let mut progress = Progress::default();
        progress.order(vec![3, 1, 2]);
        progress.take(at(None, 0), |_| 0.0);
        assert_eq!(
            rows(&progress),
            [(3, Pending, None), (1, Pending, None), (2, Pending, None)]
        );
        progress.take(at(Some(1), 10), |_| 0.0);
        assert_eq!(
            rows(&progress)[1],
            (1, Operating, None),
            "on its way through room 1"
        );
        progress.take(at(Some(3), 15), |_| 0.1);
        assert_eq!(rows(&progress)[..2], [(3, Operating, None), (1, Pending, None)]);
        progress.take(at(Some(1), 615), |room| if room == 3 { 0.93 } else { 0.1 });
        assert_eq!(
            rows(&progress)[..2],
            [(3, Completed, Some(600)), (1, Operating, None)]
        );
        progress.take(ended(900), |room| if room == 3 { 0.93 } else { 0.5 });
        assert_eq!(
            rows(&progress),
            [
                (3, Completed, Some(600)),
                (1, Skipped, Some(890)),
                (2, Skipped, None)
            ]
        );
    }

    #[test]
    fn a_completed_room_that_the_robot_passes_through_stays_completed() {
        let mut progress = Progress::default();
        progress.order(vec![1]);
        progress.take(at(Some(1), 0), |_| 0.0);
        progress.take(at(None, 60), |_| 0.9);
        progress.take(at(Some(1), 80), |_| 0.9);
        assert_eq!(rows(&progress), [(1, Operating, None)]);
        progress.take(at(None, 90), |_| 0.9);
        assert_eq!(rows(&progress), [(1, Completed, Some(90))]);
    }

    #[test]
    fn of_a_job_that_was_ordered_elsewhere_only_rooms_with_work_are_listed() {
        let mut progress = Progress::default();
        progress.order(vec![7]);
        progress.refused();
        progress.take(at(None, 0), |_| 0.0);
        assert_eq!(rows(&progress), []);
        progress.take(at(Some(2), 5), |_| 0.0);
        assert_eq!(rows(&progress), [(2, Operating, None)]);
        progress.take(ended(50), |_| 1.0);
        assert_eq!(
            rows(&progress),
            [(2, Completed, Some(45))],
            "it stays until the next job"
        );
        progress.keep_only(|room| room != 2);
        assert_eq!(rows(&progress), []);
    }

    #[test]
    fn the_share_is_that_of_the_rooms_free_floor_whatever_the_grids_are() {
        // Two columns of 10 cm: room 1 left, room 2 right; three rows, the highest of which is an obstacle.
        let home = HomeView {
            cell_m: 0.1,
            x: -1,
            y: 0,
            width: 2,
            height: 3,
            cells: vec![1, 4, 2, 2],
            room_cells: vec![1, 1, 2, 1, 1, 1, 2, 1, 1, 1, 2, 1],
            ..HomeView::default()
        };
        // Cells of 5 cm: those around the centres of the lower left and lower right cells of the home.
        let map = MapSnapshot {
            cell_m: 0.05,
            swept: vec![-1, 1, 1, 1, 1, 3],
            ..MapSnapshot::default()
        };
        assert_eq!(
            [
                share(&home, &map, 1),
                share(&home, &map, 2),
                share(&home, &map, 3)
            ],
            [0.5, 1.0, 0.0]
        );
    }
}
