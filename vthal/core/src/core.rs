//! The one entry point: inputs come in, the parts are asked in turn.

mod clock;
pub(crate) mod desk_request;
mod facts;
mod firmware;
mod hand;
mod requests;
mod thinking;

use rvac_api::{DaemonLoad, LogLevel, Topic};

use crate::brain_session::{BrainSession, Recorder};
use crate::desk::audience::Audience;
use crate::desk::button_desk::ButtonDesk;
use crate::desk::calibration::CalibrationDesk;
use crate::desk::checkpoints::{CheckpointClock, checkpoint_without_job};
use crate::desk::driver::DriverDesk;
use crate::desk::estimates::EstimateDesk;
use crate::desk::feed::Feed;
use crate::desk::floors::{FloorDesk, KeptFloors, RestoredMap};
use crate::desk::health::HealthDesk;
use crate::desk::history::HistoryDesk;
use crate::desk::home::HomeDesk;
use crate::desk::input_desk::InputDesk;
use crate::desk::journal::LogSource;
use crate::desk::learnt::LearntDesk;
use crate::desk::link::LinkDesk;
use crate::desk::link_loan::LinkLoan;
use crate::desk::schedules::ScheduleDesk;
use crate::desk::sources::Sources;
use crate::desk::standstills::StandstillDesk;
use crate::desk::system_zone::SystemZoneDesk;
use crate::device::DeviceCommand;
use crate::learnt::RobotRecord;
use crate::{Checkpoints, ClientId, CoreConfig, Input, LinkLoss, Outputs, RunEnd};

/// The brain is called at least this often while there is one.
const STEP_MAX_US: u64 = 100_000;
/// After so long without a step this computer was suspended, or too busy.
const HOST_AWAY_US: u64 = 5 * STEP_MAX_US;
/// Pause between two steps of making a home ready: whatever else comes is served in between.
const PREPARE_US: u64 = 2_000;

/// When the brain was called last, and what it was given to do.
#[derive(Debug, Default)]
struct Pace {
    stepped_us: u64,
    /// When a step of making a home ready was done last.
    prepared_us: u64,
    /// Commands wait for the home of the next run, and were not carried out in the brain's last step.
    commands_wait: bool,
}

/// All state of the daemon that is not a file, a socket or a clock: the desks, and the brain session whose facts they use.
#[derive(Debug)]
pub struct Core {
    config: CoreConfig,
    /// The daemon ends.
    ended: bool,
    audience: Audience,
    link: LinkDesk,
    loan: LinkLoan,
    calibration: CalibrationDesk,
    brain_session: Option<BrainSession>,
    pace: Pace,
    driver: DriverDesk,
    buttons: ButtonDesk,
    inputs: InputDesk,
    home: HomeDesk,
    floors: FloorDesk,
    schedules: ScheduleDesk,
    system_zone: SystemZoneDesk,
    history: HistoryDesk,
    health: HealthDesk,
    learnt: LearntDesk,
    standstills: StandstillDesk,
    estimates: EstimateDesk,
    checkpoints: CheckpointClock,
    feed: Feed,
    /// What the shell measured last of the daemon.
    load: Option<DaemonLoad>,
}

impl Core {
    /// A core that has no robot yet.
    #[must_use]
    pub fn new(mut config: CoreConfig) -> Self {
        let mut audience = Audience::default();
        for complaint in core::mem::take(&mut config.complaints) {
            audience.note_before_start(LogLevel::Error, complaint);
        }
        let book = core::mem::take(&mut config.schedules);
        Self {
            ended: false,
            audience,
            link: LinkDesk::default(),
            loan: LinkLoan::default(),
            calibration: CalibrationDesk::default(),
            brain_session: None,
            pace: Pace::default(),
            driver: DriverDesk::default(),
            buttons: ButtonDesk::default(),
            inputs: InputDesk::default(),
            home: HomeDesk::default(),
            floors: FloorDesk::new(core::mem::take(&mut config.floors)),
            schedules: ScheduleDesk::new(book, config.schedules_distrusted),
            system_zone: SystemZoneDesk::default(),
            history: HistoryDesk::new(config.next_run),
            health: HealthDesk::new(core::mem::take(&mut config.health)),
            learnt: LearntDesk::new(core::mem::take(&mut config.learnt)),
            standstills: StandstillDesk::default(),
            estimates: EstimateDesk::default(),
            checkpoints: CheckpointClock::default(),
            feed: Feed::default(),
            load: None,
            config,
        }
    }

    /// Takes one input at `now_us` (microseconds of a monotonic clock since the daemon's start; never decreasing) and
    /// appends what must be done to `outputs`.
    pub fn handle(&mut self, now_us: u64, input: Input<'_>, outputs: &mut Outputs) {
        let link_before = outputs.link.len();
        let delivered_before = outputs.deliveries.len();
        self.end_leases(now_us, outputs);
        if self.brain_session.is_some() && now_us > self.pace.stepped_us + HOST_AWAY_US {
            // Before anything new comes the brain shall know that the link is old.
            self.think(now_us, outputs);
        }
        self.take(now_us, input, outputs);
        self.pass_time(now_us, outputs);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.link.tap_sent(link_before, &mut teller);
        self.audience
            .log_refusals(self.now(now_us), delivered_before, outputs);
        self.feed(now_us, outputs);
    }

    fn take(&mut self, now_us: u64, input: Input<'_>, outputs: &mut Outputs) {
        match input {
            Input::LinkOpened => self.link_opened(now_us, outputs),
            Input::LinkBytes(bytes) => self.link_bytes(now_us, bytes, outputs),
            Input::FramingErrors(count) => self.link.count_framing_errors(count),
            Input::LinkClosed { reason } => self.link_closed(now_us, &reason, outputs),
            Input::BoardHeading { heading_urad } => {
                if let Some(brain_session) = &mut self.brain_session {
                    brain_session.observer.take_board_heading(now_us, heading_urad);
                }
            }
            Input::BoardButtons { down } => self.board_buttons(now_us, down, outputs),
            Input::Beacon(signal) => {
                if let Some(brain_session) = &mut self.brain_session {
                    brain_session.observer.take_beacon(now_us, signal);
                }
            }
            Input::Told { level, text } => self.teller(now_us, outputs).log_of_shell(level, text),
            Input::ClientConnected(client) => self.audience.clients.connect(client),
            Input::Client { client, request } => self.request(now_us, (client, request), outputs),
            Input::Refused { client, failure } => self.teller(now_us, outputs).refuse(client, failure),
            Input::ClientSilent(client) => self.client_silent(now_us, client, outputs),
            Input::ClientGone(client) => {
                self.client_silent(now_us, client, outputs);
                self.estimates.forget(client);
                self.audience.clients.forget(client);
            }
            Input::WallClock { utc_s } => self.set_clock(now_us, utc_s, outputs),
            Input::Load(load) => self.load = Some(load),
            Input::SystemZone(reading) => self.set_system_zone(now_us, reading, outputs),
            Input::RecordingOpened { run, name } => self.history.recorded_as(run, name),
            Input::CalibrationOver => self.calibration.over(),
            Input::Wake => {}
            Input::Shutdown => self.shutdown(now_us, outputs),
            Input::MapRestored { floor, number, home } => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                let (restored, session) =
                    (RestoredMap::new(number, floor, home), self.brain_session.as_mut());
                self.floors.map_restored(&restored, session, &mut teller);
            }
            Input::FloorsKept { task, floors, made } => {
                let task = &task;
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                let kept = KeptFloors { task, floors, made };
                self.floors.kept(kept, self.brain_session.as_mut(), &mut teller);
            }
            Input::FloorsTakenIn { floors, taken } => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                self.floors.taken_in(floors, &taken, &mut teller);
            }
            Input::SchedulesKept { number, result } => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                let decision = self.schedules.kept(number, result, &mut teller);
                self.go_on_with_schedules(now_us, decision, outputs);
            }
            Input::HealthKept { number, result } => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                self.health.kept(number, result, &mut teller);
            }
            Input::LearntKept { number, result } => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                self.learnt.kept(number, result, &mut teller);
            }
            Input::RunKept { number, result } => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                self.history.kept(number, result, &mut teller);
            }
        }
    }

    /// When the core needs [`Input::Wake`], in microseconds; `None` when only other inputs matter.
    #[must_use]
    pub fn next_wake_us(&self) -> Option<u64> {
        let step = self
            .brain_session
            .as_ref()
            .map(|_| self.pace.stepped_us + STEP_MAX_US);
        let feed = self.feed.next_wake_us(&self.audience.clients);
        let is_preparing = self
            .brain_session
            .as_ref()
            .is_some_and(BrainSession::is_preparing);
        let prepare = is_preparing.then_some(self.pace.prepared_us + PREPARE_US);
        let leases = [self.driver.arbiter.lease_end_us(), self.inputs.lease_end_us()];
        [
            self.link.next_wake_us(),
            step,
            prepare,
            feed,
            self.estimates.next_wake_us(),
        ]
        .into_iter()
        .chain(leases)
        .flatten()
        .min()
    }

    /// The clients that follow `topic`, in the order in which they connected.
    pub fn followers(&self, topic: Topic) -> impl Iterator<Item = ClientId> + '_ {
        self.audience.clients.followers(topic)
    }

    fn link_opened(&mut self, now_us: u64, outputs: &mut Outputs) {
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.link.opened(&self.config.make, &mut teller);
    }

    fn link_closed(&mut self, now_us: u64, reason: &LinkLoss, outputs: &mut Outputs) {
        self.buttons.forget();
        self.driver.arbiter.preempt();
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.link.closed(reason, &mut teller);
    }

    fn link_bytes(&mut self, now_us: u64, bytes: &[u8], outputs: &mut Outputs) {
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        let events = self.link.receive(bytes, &mut teller);
        self.take_events(now_us, events, outputs);
    }

    fn shutdown(&mut self, now_us: u64, outputs: &mut Outputs) {
        self.ended = true;
        self.schedules.end();
        self.driver.arbiter.preempt();
        self.device_command(now_us, DeviceCommand::EmergencyStop, outputs);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.link.release(&mut teller);
        teller.log(LogLevel::Info, LogSource::Vthal, "ends: wheels stop".to_owned());
        if let Some(brain_session) = &mut self.brain_session {
            let over = self.history.shut_down(now_us, brain_session.at_home());
            self.history.keep(over, brain_session.floor(), outputs);
            if self.config.checkpoints == Checkpoints::On {
                outputs.checkpoint = Some(checkpoint_without_job(brain_session));
            }
            outputs.home = brain_session.home_left();
            let mut recorder = Recorder::new(self.config.recording, outputs);
            brain_session.end_run(now_us, RunEnd::Shutdown, &mut recorder);
        }
        self.keep_learnt(outputs);
        self.health.end(outputs);
    }

    /// Before anything else: the brain notices the same end and must not let the wheels roll out first.
    fn end_leases(&mut self, now_us: u64, outputs: &mut Outputs) {
        if let Some(client) = self.driver.arbiter.expire(now_us) {
            self.lease_ended(now_us, client, outputs);
        }
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.inputs.expire(&mut teller);
        // Another client may take the name in the same moment: whoever mixes must have seen it free.
        self.inputs.feed(&mut teller);
    }

    fn pass_time(&mut self, now_us: u64, outputs: &mut Outputs) {
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        let events = self.link.pass_time(&mut teller);
        self.take_events(now_us, events, outputs);
        if let Some(brain_session) = &mut self.brain_session
            && brain_session.is_preparing()
            && now_us >= self.pace.prepared_us + PREPARE_US
        {
            self.pace.prepared_us = now_us;
            let left = brain_session.prepare(now_us, &mut Recorder::new(self.config.recording, outputs));
            if let Some(left) = left {
                self.floors.note_kept(&left);
                outputs.home = Some(left);
            }
        }
        if self.brain_session.is_some() && now_us >= self.pace.stepped_us + STEP_MAX_US {
            self.think(now_us, outputs);
        }
        self.make_estimate(now_us, outputs);
    }

    /// At most a step of one, so that whatever has come meanwhile is served before the next.
    fn make_estimate(&mut self, now_us: u64, outputs: &mut Outputs) {
        if let Some((asker, answer)) = self.estimates.go_on(now_us, self.brain_session.as_ref()) {
            self.teller(now_us, outputs).answer(asker, answer);
        }
    }

    /// Tells followers, the recording and the disk what is due.
    fn feed(&mut self, now_us: u64, outputs: &mut Outputs) {
        let now = self.now(now_us);
        let driver = self.driver.arbiter.driver();
        let sources = Sources {
            brain_session: self.brain_session.as_ref(),
            link: &self.link,
            floors: &self.floors,
            driver: driver.map(|client| self.audience.clients.name(client)),
            config: &self.config,
            load: self.load,
        };
        let mut teller = self.audience.teller(now, outputs);
        self.feed.feed(&sources, &mut teller);
        self.inputs.feed(&mut teller);
        if let Some(brain_session) = &self.brain_session
            && self.config.checkpoints == Checkpoints::On
            && !self.ended
        {
            let run = || self.history.so_far(now_us);
            if let Some(checkpoint) = self.checkpoints.follow(now_us, brain_session, run) {
                outputs.checkpoint = Some(checkpoint);
            }
        }
    }

    fn device_command(&mut self, now_us: u64, command: DeviceCommand, outputs: &mut Outputs) {
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.link.command(command, &mut teller);
    }

    /// Hands out what the robot has learnt, if it is news.
    fn keep_learnt(&mut self, outputs: &mut Outputs) {
        if let Some(brain_session) = self
            .brain_session
            .as_ref()
            .filter(|brain_session| !brain_session.brain().estimate().lost)
        {
            let kept = RobotRecord {
                device: brain_session.device().to_owned(),
                learnt: brain_session.brain().learnt(),
                learnt_s: self.schedules.clock_s(),
            };
            self.learnt.keep(kept, outputs);
        }
    }
}
