//! What is known at this moment, for whoever holds the core and for its desks.

use brain::BehaviorState;
use rvac_api::{ComponentHealth, FloorsView, HomeView, Pose, Schedules, Status};

use super::Core;
use crate::Outputs;
use crate::brain_session::BrainSession;
use crate::desk::arbiter::Source;
use crate::desk::audience::{Now, Teller};
use crate::desk::readiness::{Readiness, StartFacts};
use crate::desk::sources::Sources;
use crate::lights::Lights;
use crate::refusal::Refused;

impl Core {
    /// The robot's pose as the brain estimates it.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.sources().pose()
    }

    /// What the robot is doing.
    #[must_use]
    pub fn status(&self) -> Status {
        self.sources().status()
    }

    /// What lights of the Linux board should show.
    #[must_use]
    pub fn lights(&self) -> Lights {
        match self.brain() {
            _ if self.ended => Lights::default(),
            Some(brain) => Lights::of(brain.status().state),
            None => Lights::of(BehaviorState::Disconnected),
        }
    }

    /// The floors, and on which of them the robot is.
    #[must_use]
    pub fn floors_view(&self) -> FloorsView {
        self.floors.view(self.brain_session.as_ref())
    }

    /// All schedules, and what is to be expected of them.
    #[must_use]
    pub fn schedules(&self) -> Schedules {
        self.schedules.view(&self.readiness())
    }

    /// How worn or dirty the parts are whose loads are measured or whose hours are counted.
    #[must_use]
    pub fn component_health(&self) -> Vec<ComponentHealth> {
        let fitted = self.link.description().map(|known| known.parts.as_slice());
        self.health.components(fitted)
    }

    /// What is known of the home, as clients receive it.
    #[must_use]
    pub fn home_view(&self) -> Option<HomeView> {
        self.sources().home()
    }

    /// The brain, once a robot has described itself.
    #[must_use]
    pub fn brain(&self) -> Option<&brain::Brain> {
        self.brain_session.as_ref().map(BrainSession::brain)
    }

    /// Whether the robot measures what its motors draw, and so can feel carpets.
    #[must_use]
    pub fn measures_currents(&self) -> bool {
        self.brain_session
            .as_ref()
            .is_some_and(BrainSession::measures_currents)
    }

    /// Gives the brain the map of a home it has not seen itself, in which it stands on the dock, or at the origin if the map
    /// has no dock. For simulators; to be called while no job runs. `false` before a robot was seen.
    pub fn take_up_home(&mut self, home: &brain::mapping::StoredMap) -> bool {
        self.brain_session
            .as_mut()
            .map(|brain_session| brain_session.take_up(home))
            .is_some()
    }

    /// Gives the brain the robot's pose in the map, for simulators that know it.
    pub fn place_at(&mut self, pose: brain::Pose2) {
        if let Some(brain_session) = &mut self.brain_session {
            brain_session.place_at(pose);
        }
    }

    /// Whether nothing moves as far as the newest reports since [`Input::Shutdown`] (or the start) tell, or nothing is
    /// known because no robot is there.
    #[must_use]
    pub fn stands_still(&self) -> bool {
        self.link.stands_still()
    }

    pub(super) fn now(&self, time_us: u64) -> Now {
        Now {
            time_us,
            recording: self.config.recording,
            is_run: self.brain_session.as_ref().is_some_and(BrainSession::is_recorded),
        }
    }

    /// Through which the core itself informs clients and the log.
    pub(super) fn teller<'a>(&'a mut self, now_us: u64, outputs: &'a mut Outputs) -> Teller<'a> {
        let now = self.now(now_us);
        self.audience.teller(now, outputs)
    }

    pub(super) fn sources(&self) -> Sources<'_> {
        let driver = self.driver.arbiter.driver();
        Sources {
            brain_session: self.brain_session.as_ref(),
            link: &self.link,
            floors: &self.floors,
            driver: driver.map(|client| self.audience.clients.name(client)),
            config: &self.config,
            load: self.load,
        }
    }

    pub(super) fn readiness(&self) -> Readiness<'_> {
        Readiness::new(self.start_facts(), self.brain_session.as_ref(), &self.floors)
    }

    pub(super) fn start_facts(&self) -> StartFacts {
        let suits = || self.brain().map(brain::Brain::usual_strategy);
        StartFacts {
            robot: self.require_robot(),
            schedule: self.driver.admit_now(Source::Schedule),
            usual_strategy: self.config.strategy.or_else(suits).unwrap_or_default(),
        }
    }

    pub(super) fn require_robot(&self) -> Result<(), Refused> {
        if self.ended {
            return Err("ending");
        }
        if self.link.is_attached() && self.brain_session.is_some() {
            Ok(())
        } else {
            Err("no-robot")
        }
    }

    /// The distance between the robot's wheels, once it is known.
    pub(super) fn track_m(&self) -> Option<f64> {
        let description = self.link.description();
        description.map(|description| description.drive.track_m)
    }
}
