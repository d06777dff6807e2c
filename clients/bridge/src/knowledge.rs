//! The newest of what the daemon has said.

use rvac_api::{
    Activity, DeviceTable, FloorsView, HomeView, MapDelta, MapSnapshot, Pose, RobotDescription, Schedules,
    Status, Update, Versions,
};

/// A map of a home of 400 square metres has 160 000 cells of 5 cm; what grows beyond that is not kept.
const SWEPT_MAX: usize = 4 << 20;

/// What an update has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// The robot or its software.
    Robot,
    /// What it does.
    Status,
    /// What it measures.
    Device,
    /// What it has swept.
    Map,
    /// The map of the home.
    Home,
    /// The floors.
    Floors,
    /// The schedules.
    Schedules,
    /// The pose.
    Pose,
    /// Nothing that is kept here.
    Nothing,
}

/// What is known of the robot. What the daemon has not said yet is absent.
#[derive(Clone, Debug, Default)]
pub struct Knowledge {
    /// Versions of the parts.
    pub versions: Versions,
    /// The robot.
    pub robot: Option<RobotDescription>,
    /// What it does.
    pub status: Option<Status>,
    /// What it measures.
    pub device: Option<DeviceTable>,
    /// What it has swept.
    pub map: MapSnapshot,
    /// The map of the home.
    pub home: Option<HomeView>,
    /// The floors.
    pub floors: Option<FloorsView>,
    /// The schedules.
    pub schedules: Option<Schedules>,
    /// The pose.
    pub pose: Option<Pose>,
    /// A robot answers, and nobody has asked who it is.
    is_new: bool,
    /// Of the last status.
    is_connected: bool,
}

impl Knowledge {
    /// Whether it is time to say `hello` again: the daemon describes the robot in its answer alone, and a robot may come later than its
    /// daemon, or be another one. Once for each robot that comes.
    pub fn wants_hello(&mut self) -> bool {
        std::mem::take(&mut self.is_new)
    }

    /// Takes what an update tells.
    pub fn take(&mut self, update: &Update) -> Change {
        match update {
            Update::Hello { versions, robot, .. } => {
                self.versions = versions.clone();
                // A daemon that has just started does not know its robot yet.
                if robot.is_some() {
                    self.robot.clone_from(robot);
                }
                Change::Robot
            }
            Update::Status(status) => {
                let is_connected = Activity::from_name(&status.state) != Some(Activity::Disconnected);
                self.is_new |= is_connected && !self.is_connected;
                self.is_connected = is_connected;
                self.status = Some(status.clone());
                Change::Status
            }
            Update::Device(device) => {
                self.versions = device.versions.clone();
                self.device = Some(device.clone());
                Change::Device
            }
            Update::Map(map) => {
                self.map = map.clone();
                Change::Map
            }
            Update::MapDelta(delta) => self.grow(delta),
            Update::Home(home) => {
                self.home = Some(home.clone());
                Change::Home
            }
            Update::Floors(floors) => {
                self.floors = Some(floors.clone());
                Change::Floors
            }
            Update::Schedules(schedules) => {
                self.schedules = Some(schedules.clone());
                Change::Schedules
            }
            Update::Pose(pose) => {
                self.pose = Some(*pose);
                Change::Pose
            }
            _ => Change::Nothing,
        }
    }

    /// The daemon is gone: what it said of the robot's state holds no more. The home does.
    pub fn forget_state(&mut self) {
        self.status = None;
        self.is_connected = false;
        self.device = None;
        self.pose = None;
    }

    fn grow(&mut self, delta: &MapDelta) -> Change {
        if delta.map != self.map.map || self.map.swept.len() > SWEPT_MAX {
            return Change::Nothing;
        }
        self.map.swept.extend_from_slice(&delta.swept);
        self.map.path_mm.extend_from_slice(&delta.path_mm);
        self.map.bumps.extend_from_slice(&delta.bumps);
        Change::Map
    }

    /// Where the robot is: its pose, else the dock that it stands on, else where its path ends. Metres and radians.
    #[must_use]
    pub fn place(&self) -> Option<Pose> {
        let docked = self.device.as_ref().is_some_and(|device| device.docked);
        let dock = self.home.as_ref().and_then(|home| home.dock);
        self.pose
            .or(dock.filter(|_| docked))
            .or_else(|| end_of(&self.map.path_mm))
    }
}

/// The end of a path in millimetres, looking where the path leads.
fn end_of(path_mm: &[i32]) -> Option<Pose> {
    let mut corners = path_mm.chunks_exact(2).rev();
    let mut corner = || match corners.next() {
        Some([x, y]) => Some([f64::from(*x) / 1e3, f64::from(*y) / 1e3]),
        _ => None,
    };
    let [x, y] = corner()?;
    let heading = corner().map_or(0.0, |[before_x, before_y]| (y - before_y).atan2(x - before_x));
    Some(Pose {
        x,
        y,
        heading,
        t: 0.0,
    })
}

#[cfg(test)]
mod tests {
    use rvac_api::{MapDelta, MapSnapshot, Status, Update};

    use super::{Change, Knowledge};

    #[test]
    fn a_robot_that_comes_is_asked_once_who_it_is() {
        let mut known = Knowledge::default();
        let mut asked = |state: &str| {
            known.take(&Update::Status(Status {
                state: state.to_owned(),
                ..Status::default()
            }));
            known.wants_hello()
        };
        let states = ["disconnected", "idle", "cleaning", "disconnected", "idle"];
        assert_eq!(states.map(&mut asked), [false, true, false, false, true]);
    }

    #[test]
    fn a_delta_belongs_to_its_own_map_alone() {
        let mut known = Knowledge::default();
        known.take(&Update::Map(MapSnapshot {
            map: 3,
            path_mm: vec![0, 0],
            ..MapSnapshot::default()
        }));
        let delta = |map| {
            Update::MapDelta(MapDelta {
                map,
                path_mm: vec![0, 1000],
                ..MapDelta::default()
            })
        };
        assert_eq!(known.take(&delta(2)), Change::Nothing);
        assert_eq!(known.take(&delta(3)), Change::Map);
        let place = known.place().expect("a path has an end");
        assert!((place.y - 1.0).abs() < 1e-9 && (place.heading - core::f64::consts::FRAC_PI_2).abs() < 1e-9);
    }
}
