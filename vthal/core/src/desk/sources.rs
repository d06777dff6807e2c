//! What clients can be shown at this moment, put together from what the desks know.

use brain::{BehaviorState, Brain, LinkFault};
use rvac_api::{API_VERSION, DaemonLoad, DeviceTable, HomeView, Pose, RoomHere, Status, Topic, Update};

use super::floors::FloorDesk;
use super::link::LinkDesk;
use crate::brain_session::BrainSession;
use crate::{CoreConfig, ExpertAccess, to_api};

/// Where it comes from.
#[derive(Clone, Debug)]
pub(crate) struct Sources<'a> {
    pub(crate) brain_session: Option<&'a BrainSession>,
    pub(crate) link: &'a LinkDesk,
    pub(crate) floors: &'a FloorDesk,
    /// The name of whoever drives.
    pub(crate) driver: Option<String>,
    pub(crate) config: &'a CoreConfig,
    /// What the daemon takes, as far as the shell has measured it.
    pub(crate) load: Option<DaemonLoad>,
}

impl Sources<'_> {
    /// The robot's pose as the brain estimates it.
    pub(crate) fn pose(&self) -> Pose {
        self.brain_session.map_or_else(Pose::default, |brain_session| {
            to_api::pose(
                brain_session.brain().pose(),
                brain_session.observer.observation().time_us,
            )
        })
    }

    /// What the robot is doing.
    pub(crate) fn status(&self) -> Status {
        let Some(brain_session) = self.brain_session else {
            return Status {
                state: BehaviorState::Disconnected.name().to_owned(),
                reason: self.why_no_robot().to_owned(),
                ..Status::default()
            };
        };
        let mut status = to_api::status(brain_session.brain().status(), brain_session.brain().job());
        let inhibits = brain_session.observer.observation().inhibits;
        status.inhibits = inhibits.names().map(str::to_owned).collect();
        status.room = room_here(brain_session.brain()).filter(|_| self.knows_rooms());
        status.driver.clone_from(&self.driver);
        if status.state == BehaviorState::Disconnected.name()
            && let Some(cause) = self.link.strange_cause()
        {
            cause.clone_into(&mut status.reason);
        }
        status
    }

    /// What is known of the home. Rooms that a first job is still finding come and go: they are told when it is over.
    pub(crate) fn home(&self) -> Option<HomeView> {
        let home = self.brain_session?.home_view();
        if self.knows_rooms() {
            return Some(home);
        }
        let room_cells = if home.room_cells.is_empty() {
            Vec::new()
        } else {
            vec![0, home.width.saturating_mul(home.height)]
        };
        Some(HomeView {
            room_cells,
            rooms: Vec::new(),
            doors: Vec::new(),
            sureness: home
                .sureness
                .into_iter()
                .filter(|sureness| sureness.room.is_none())
                .collect(),
            ..home
        })
    }

    /// Whether the rooms are those of a whole home: one whose map is kept, or one of which a job has seen all that it would.
    pub(crate) fn knows_rooms(&self) -> bool {
        self.brain_session.is_some_and(|brain_session| {
            let kept = brain_session
                .floor()
                .and_then(|floor| self.floors.floors().home(floor));
            kept.is_some() || brain_session.rests()
        })
    }

    /// Why there is no robot.
    fn why_no_robot(&self) -> &'static str {
        let fault = || self.link.fault().map(LinkFault::name);
        self.link.strange_cause().or_else(fault).unwrap_or("no-robot")
    }

    pub(crate) fn device_table(&self, now_us: u64) -> DeviceTable {
        DeviceTable {
            daemon: self.load,
            ..self.link.table(now_us, &self.config.version)
        }
    }

    /// Answer to `hello`.
    pub(crate) fn greeting(&self) -> Update {
        Update::Hello {
            api: API_VERSION,
            versions: self.link.versions(&self.config.version),
            robot: self.link.description().map(|description| {
                let lacking = self.brain_session.map(BrainSession::lacking);
                to_api::robot(description, lacking.unwrap_or_default())
            }),
            strategies: brain::StrategyName::ALL
                .iter()
                .map(|strategy| strategy.name().to_owned())
                .collect(),
            expert: self.config.expert == ExpertAccess::Allowed,
        }
    }

    /// What a new follower of a topic gets at once, if that is known here.
    pub(crate) fn first(&self, topic: Topic, now_us: u64) -> Option<Update> {
        match topic {
            Topic::Status => Some(Update::Status(self.status())),
            Topic::Pose => Some(Update::Pose(self.pose())),
            Topic::Device => Some(Update::Device(self.device_table(now_us))),
            Topic::Floors => Some(Update::Floors(self.floors.view(self.brain_session))),
            Topic::Estimate => self.brain_session.map(|brain_session| {
                let brain = brain_session.brain();
                Update::Estimate(to_api::estimate(brain, brain.swept_share()))
            }),
            Topic::PlannedPath => self
                .brain_session
                .map(|brain_session| Update::PlannedPath(to_api::planned_path(brain_session.brain()))),
            Topic::Home
            | Topic::Map
            | Topic::Log
            | Topic::Decisions
            | Topic::Schedules
            | Topic::Standstills
            | Topic::Inputs
            | Topic::Packets
            | Topic::Runs
            | Topic::Buttons => None,
        }
    }
}

fn room_here(brain: &Brain) -> Option<RoomHere> {
    let id = brain.room()?;
    let name = brain.map().annotations().name(id);
    Some(RoomHere {
        id,
        name: name.map(|name| name.as_str().to_owned()),
    })
}
