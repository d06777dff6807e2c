//! What clients receive, and how often.

use brain::{MapCursor, SweptShare};
use rvac_api::{Estimate, FloorsView, HomeView, MapSnapshot, PlannedPath, Pose, Status, Topic, Update};

use super::audience::Teller;
use super::clients::Clients;
use super::kept_view::KeptView;
use super::sources::Sources;
use crate::brain_session::BrainSession;
use crate::swept_sigma::SweptSigma;
use crate::{Record, to_api};

/// Poses go out at most this often.
const POSE_US: u64 = 50_000;
/// The device table goes out this often.
const DEVICE_US: u64 = 500_000;
/// The device table goes to a recording this often.
const RECORDED_DEVICE_US: u64 = 1_000_000;
/// Map deltas go out at most this often.
const MAP_US: u64 = 200_000;
/// A status whose figures alone changed goes out at most this often.
const FIGURES_US: u64 = 1_000_000;
/// Pause between two views of the home: each searches the map for walls.
const HOME_US: u64 = 5_000_000;
/// Estimates go out at most this often.
const ESTIMATE_US: u64 = 500_000;
/// Pause between two measurements of coverage: each counts cells.
const SHARE_US: u64 = 5_000_000;
/// Changes of an estimate that are too small to see: metres or radians, and shares.
const UNSEEN: f64 = 0.002;
/// Planned paths are sent at most this often.
const PLANNED_PATH_US: u64 = 2_000_000;

/// What a view of the home shows: its revision, and whether rooms stand in it.
type HomeVersion = (u32, bool);

/// When each kind of update last went out.
#[derive(Debug, Default)]
pub(crate) struct Feed {
    status: Option<Status>,
    status_us: u64,
    pose: Pose,
    pose_us: u64,
    device_us: u64,
    recorded_device_us: u64,
    map_us: u64,
    map_cursor: MapCursor,
    map_number: u32,
    swept_us: u64,
    swept_cursor: MapCursor,
    swept_number: u32,
    swept_sigma: SweptSigma,
    home_us: u64,
    /// The version of the home that was told.
    home_version: HomeVersion,
    /// For whoever follows it next.
    home: KeptView<HomeVersion, HomeView>,
    estimate_us: u64,
    estimate: Estimate,
    share_us: u64,
    share: Option<SweptShare>,
    floors: Option<FloorsView>,
    planned_path_us: u64,
    planned_path: PlannedPath,
    state_changed_us: Option<u64>,
}

impl Feed {
    /// The behaviour state has changed.
    pub(crate) fn state_changed(&mut self, now_us: u64) {
        self.state_changed_us = Some(now_us);
    }

    /// A person has changed the home and waits to see it: it is sent at once.
    pub(crate) fn tell_home_now(&mut self) {
        self.home_us = 0;
    }

    /// Whether it has changed within the last `span_us`.
    pub(crate) fn state_changed_within(&self, now_us: u64, span_us: u64) -> bool {
        self.state_changed_us
            .is_some_and(|then_us| now_us < then_us + span_us)
    }

    /// When something is due that no report of the robot would bring.
    pub(crate) fn next_wake_us(&self, clients: &Clients) -> Option<u64> {
        clients.any(Topic::Device).then_some(self.device_us + DEVICE_US)
    }

    /// Tells followers and the recording what is due.
    pub(crate) fn feed(&mut self, sources: &Sources<'_>, teller: &mut Teller<'_>) {
        let now_us = teller.now_us;
        if teller.has_any_follower() || teller.records_run() {
            self.feed_status(sources, teller);
            self.feed_pose(sources, teller);
        }
        if teller.has_followers(Topic::Device) && now_us >= self.device_us + DEVICE_US {
            self.device_us = now_us;
            teller.tell(Topic::Device, Update::Device(sources.device_table(now_us)));
        }
        if teller.records_run() && now_us >= self.recorded_device_us + RECORDED_DEVICE_US {
            self.recorded_device_us = now_us;
            teller.record(|| Record::Device {
                time_us: now_us,
                table: Box::new(sources.device_table(now_us)),
            });
        }
        // Independent of clients: the uncertainty of that moment cannot be computed later.
        if now_us >= self.swept_us + MAP_US {
            self.swept_us = now_us;
            self.note_swept(sources.brain_session);
        }
        self.feed_home_and_path(sources, teller);
    }

    fn feed_home_and_path(&mut self, sources: &Sources<'_>, teller: &mut Teller<'_>) {
        let now_us = teller.now_us;
        if teller.has_followers(Topic::Map) && now_us >= self.map_us + MAP_US {
            self.map_us = now_us;
            self.feed_map(sources.brain_session, teller);
        }
        if teller.has_followers(Topic::Home) && now_us >= self.home_us + HOME_US {
            self.home_us = now_us;
            self.feed_home(sources, teller);
        }
        if teller.has_followers(Topic::Estimate) && now_us >= self.estimate_us + ESTIMATE_US {
            self.estimate_us = now_us;
            self.feed_estimate(sources.brain_session, teller);
        }
        if teller.has_followers(Topic::PlannedPath) && now_us >= self.planned_path_us + PLANNED_PATH_US {
            self.planned_path_us = now_us;
            self.feed_planned_path(sources.brain_session, teller);
        }
        if teller.has_followers(Topic::Floors) {
            self.feed_floors(sources, teller);
        }
    }

    fn feed_estimate(&mut self, brain_session: Option<&BrainSession>, teller: &mut Teller<'_>) {
        let Some(brain_session) = brain_session else {
            return;
        };
        if teller.now_us >= self.share_us + SHARE_US {
            self.share_us = teller.now_us;
            self.share = brain_session.brain().swept_share();
        }
        let estimate = to_api::estimate(brain_session.brain(), self.share);
        if !looks_alike(&self.estimate, &estimate) {
            self.estimate = estimate;
            teller.tell(Topic::Estimate, Update::Estimate(estimate));
        }
    }

    fn feed_floors(&mut self, sources: &Sources<'_>, teller: &mut Teller<'_>) {
        if sources
            .floors
            .is_news(self.floors.as_ref(), sources.brain_session)
        {
            let floors = sources.floors.view(sources.brain_session);
            self.floors = Some(floors.clone());
            teller.tell(Topic::Floors, Update::Floors(floors));
        }
    }

    fn feed_planned_path(&mut self, brain_session: Option<&BrainSession>, teller: &mut Teller<'_>) {
        let Some(brain_session) = brain_session else {
            return;
        };
        let path = to_api::planned_path(brain_session.brain());
        if path != self.planned_path {
            self.planned_path = path.clone();
            teller.tell(Topic::PlannedPath, Update::PlannedPath(path));
        }
    }

    fn feed_home(&mut self, sources: &Sources<'_>, teller: &mut Teller<'_>) {
        let Some(brain_session) = sources.brain_session else {
            return;
        };
        let version = (brain_session.home_revision(), sources.knows_rooms());
        if version != self.home_version
            && let Some(home) = self.home_now(sources, teller.now_us)
        {
            self.home_version = version;
            teller.tell(Topic::Home, Update::Home(home));
        }
    }

    /// What a new follower of the home gets at once. It is drawn once for all who come within seconds: a large one takes tens of
    /// milliseconds, in which nobody else is served.
    pub(crate) fn first_home(&mut self, sources: &Sources<'_>, now_us: u64) -> Option<Update> {
        self.home_now(sources, now_us).map(Update::Home)
    }

    fn home_now(&mut self, sources: &Sources<'_>, now_us: u64) -> Option<HomeView> {
        let version = (sources.brain_session?.home_revision(), sources.knows_rooms());
        self.home.at((version, now_us), || sources.home())
    }

    fn feed_status(&mut self, sources: &Sources<'_>, teller: &mut Teller<'_>) {
        let now_us = teller.now_us;
        let status = sources.status();
        let due = match &self.status {
            Some(old) if is_same_situation(old, &status) => {
                *old != status && now_us >= self.status_us + FIGURES_US
            }
            _ => true,
        };
        if !due {
            return;
        }
        self.status_us = now_us;
        self.status = Some(status.clone());
        teller.record(|| Record::Status {
            time_us: now_us,
            status: status.clone(),
        });
        if teller.has_followers(Topic::Status) {
            teller.tell(Topic::Status, Update::Status(status));
        }
    }

    fn feed_pose(&mut self, sources: &Sources<'_>, teller: &mut Teller<'_>) {
        if teller.now_us < self.pose_us + POSE_US {
            return;
        }
        let pose = sources.pose();
        let moved = Pose {
            t: self.pose.t,
            ..pose
        } != self.pose;
        if !moved {
            return;
        }
        self.pose = pose;
        self.pose_us = teller.now_us;
        teller.record(|| Record::Pose(pose));
        if teller.has_followers(Topic::Pose) {
            teller.tell(Topic::Pose, Update::Pose(pose));
        }
    }

    /// Notes how sure the robot was of its place when it swept what is new.
    fn note_swept(&mut self, brain_session: Option<&BrainSession>) {
        let Some(brain_session) = brain_session else {
            return;
        };
        let (number, map) = (brain_session.map_number(), brain_session.brain().map());
        let new = (number == self.swept_number)
            .then(|| map.since(self.swept_cursor))
            .flatten();
        self.swept_cursor = brain_session.map_cursor();
        self.swept_number = number;
        let present_m = brain_session.brain().estimate().sigma_m;
        if let Some(part) = new {
            self.swept_sigma.add(part.swept.len(), present_m);
            return;
        }
        // Redrawn or read from the disk: the map stores the confidence.
        self.swept_sigma = SweptSigma::default();
        for cell in map.snapshot().swept {
            let sigma_m = map.sigma_m(*cell).unwrap_or(present_m);
            self.swept_sigma.add(1, sigma_m);
        }
    }

    fn feed_map(&mut self, brain_session: Option<&BrainSession>, teller: &mut Teller<'_>) {
        self.note_swept(brain_session);
        let Some(brain_session) = brain_session else {
            return;
        };
        let number = brain_session.map_number();
        let delta = (number == self.map_number)
            .then(|| brain_session.brain().map().since(self.map_cursor))
            .flatten();
        self.map_cursor = brain_session.map_cursor();
        self.map_number = number;
        let update = match delta {
            Some(part) if part.swept.is_empty() && part.path.is_empty() && part.hazards.is_empty() => return,
            Some(part) => Update::MapDelta(to_api::map_delta(number, &part, &self.swept_sigma)),
            None => Update::Map(self.whole_map(brain_session)),
        };
        teller.tell(Topic::Map, update);
    }

    fn whole_map(&self, brain_session: &BrainSession) -> MapSnapshot {
        let snapshot = brain_session.brain().map().snapshot();
        to_api::map_snapshot(brain_session.map_number(), &snapshot, &self.swept_sigma)
    }

    /// What a new follower of the map gets at once. Others first receive what is new, so that one cursor serves all.
    pub(crate) fn first_map(
        &mut self,
        brain_session: Option<&BrainSession>,
        teller: &mut Teller<'_>,
    ) -> Option<Update> {
        self.feed_map(brain_session, teller);
        brain_session.map(|brain_session| Update::Map(self.whole_map(brain_session)))
    }
}

/// Whether two estimates are the same for people.
fn looks_alike(old: &Estimate, new: &Estimate) -> bool {
    let near = |one: f64, other: f64| (one - other).abs() < UNSEEN;
    let both = |one: Option<f64>, other: Option<f64>| match (one, other) {
        (Some(one), Some(other)) => near(one, other),
        (one, other) => one.is_none() && other.is_none(),
    };
    old.lost == new.lost
        && old.map_doubt == new.map_doubt
        && near(old.sigma_m, new.sigma_m)
        && near(old.sigma_rad, new.sigma_rad)
        && both(old.agreement, new.agreement)
        && both(old.covered, new.covered)
        && both(old.covered_low, new.covered_low)
}

/// Whether only figures differ, which change all the time.
fn is_same_situation(old: &Status, new: &Status) -> bool {
    old.state == new.state
        && old.reason == new.reason
        && old.strategy == new.strategy
        && old.inhibits == new.inhibits
        && old.driver == new.driver
        && old.bumps == new.bumps
}
