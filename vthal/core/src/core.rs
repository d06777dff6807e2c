//! The one entry point: inputs come in, the parts are asked in turn.

mod awaited;
mod buttons;
mod checkpoints;
mod client_inputs;
mod feed;
mod firmware;
mod floors;
mod health;
mod history;
mod learnt;
mod link_facts;
mod manual;
pub(crate) mod orders;
pub(crate) mod places;
mod refusal;
mod refusal_log;
mod requests;
mod room_edits;
pub(crate) mod room_power;
mod schedules;
mod standstill;
mod thinking;

use rvac_api::{Pose, RoomHere, Schedules, Status, Topic, Update};

use crate::arbiter::Arbiter;
use crate::buttons::Buttons;
use crate::client_inputs::ClientInputs;
use crate::clients::Clients;
use crate::device::{CleanerPower, DeviceCommand, DeviceEvent, DeviceIo, Supervisor};
use crate::diary::Diary;
use crate::evidence::Evidence;
use crate::floors::Floors;
use crate::history::RunFollower;
use crate::journal::{Journal, Part};
use crate::mind::{Mind, Recorder};
use crate::outputs::{Delivery, Recipients};
use crate::scheduler::Scheduler;
use crate::{Checkpoints, ClientId, CoreConfig, Input, LinkLoss, Outputs, Record, Recording, RunEnd, to_api};
use checkpoints::CheckpointClock;
use feed::Feed;
use health::HealthDesk;
use history::UnkeptRuns;
use learnt::LearntDesk;
use link_facts::LinkFacts;
use refusal_log::RefusalLog;
use rvac_api::LogLevel;
use standstill::Standstills;

/// The brain is called at least this often while there is one.
const STEP_MAX_US: u64 = 100_000;
/// Pause between two steps of making a home ready: whatever else comes is served in between.
const PREPARE_US: u64 = 2_000;

/// All state of the daemon that is not a file, a socket or a clock.
#[derive(Debug)]
pub struct Core {
    config: CoreConfig,
    clients: Clients,
    arbiter: Arbiter,
    buttons: Buttons,
    client_inputs: ClientInputs,
    /// START went down while nothing ran that it had to stop.
    start_means_more: bool,
    /// How hard the robot cleans while a person drives it.
    driver_power: CleanerPower,
    journal: Journal,
    refusal_log: RefusalLog,
    diary: Diary,
    felt: Evidence,
    standstills: Standstills,
    /// The robot's link, while it is open.
    device: Option<Supervisor>,
    /// The robot whose link was lost: what its wheels have counted goes on when it is back.
    lost_device: Option<Supervisor>,
    mind: Option<Mind>,
    facts: LinkFacts,
    feed: Feed,
    checkpoints: CheckpointClock,
    /// Scratch, so that packets cost no list of their own.
    packets: Vec<(crate::Direction, String)>,
    events: Vec<DeviceEvent>,
    stepped_us: u64,
    /// When a step of making a home ready was done last.
    prepared_us: u64,
    ended: bool,
    /// Whoever changed the map since the brain's last step: client and number of the request.
    edits: Vec<(ClientId, Option<u32>)>,
    /// Commands wait for the home of the next run, and were not carried out in the brain's last step.
    commands_wait: bool,
    floors: Floors,
    scheduler: Scheduler,
    schedules_told: Option<Schedules>,
    schedules_told_us: u64,
    health: HealthDesk,
    learnt: LearntDesk,
    runs: RunFollower,
    unkept: UnkeptRuns,
}

impl Core {
    /// A core that has no robot yet.
    #[must_use]
    pub fn new(mut config: CoreConfig) -> Self {
        let (book, zone) = (core::mem::take(&mut config.schedules), config.zone.clone());
        let mut journal = Journal::default();
        for complaint in core::mem::take(&mut config.complaints) {
            journal.write(0, LogLevel::Error, (Part::Vthal, complaint));
        }
        Self {
            scheduler: Scheduler::new(book, zone, config.schedules_distrusted),
            floors: Floors::new(core::mem::take(&mut config.floors)),
            schedules_told: None,
            schedules_told_us: 0,
            health: HealthDesk::new(core::mem::take(&mut config.health)),
            learnt: LearntDesk::default(),
            runs: RunFollower::new(config.next_run),
            unkept: UnkeptRuns::default(),
            config,
            clients: Clients::default(),
            arbiter: Arbiter::default(),
            buttons: Buttons::default(),
            client_inputs: ClientInputs::default(),
            start_means_more: false,
            driver_power: CleanerPower::FULL,
            journal,
            refusal_log: RefusalLog::default(),
            diary: Diary::default(),
            felt: Evidence::default(),
            standstills: Standstills::default(),
            device: None,
            lost_device: None,
            mind: None,
            facts: LinkFacts::default(),
            feed: Feed::default(),
            checkpoints: CheckpointClock::default(),
            packets: Vec::new(),
            events: Vec::new(),
            stepped_us: 0,
            prepared_us: 0,
            ended: false,
            edits: Vec::new(),
            commands_wait: false,
        }
    }

    /// Takes one input at `now_us` (microseconds of a monotonic clock since the daemon's start; never decreasing) and
    /// appends what must be done to `outputs`.
    pub fn handle(&mut self, now_us: u64, input: Input<'_>, outputs: &mut Outputs) {
        let link_before = outputs.link.len();
        let delivered_before = outputs.deliveries.len();
        self.end_leases(now_us, outputs);
        match input {
            Input::LinkOpened => self.link_opened(now_us, outputs),
            Input::LinkBytes(bytes) => self.link_bytes(now_us, bytes, outputs),
            Input::LinkClosed { reason } => self.link_closed(now_us, &reason, outputs),
            Input::BoardHeading { heading_urad } => {
                if let Some(mind) = &mut self.mind {
                    mind.observer.take_board_heading(now_us, heading_urad);
                }
            }
            Input::Beacon(signal) => {
                if let Some(mind) = &mut self.mind {
                    mind.observer.take_beacon(signal);
                }
            }
            Input::ClientConnected(client) => self.clients.connect(client),
            Input::Client { client, request } => self.request(now_us, (client, request), outputs),
            Input::Refused { client, failure } => Self::refuse(client, failure, outputs),
            Input::MapRestored { floor, number, home } => {
                self.map_restored(now_us, (floor, number, home), outputs)
            }
            Input::FloorsKept { task, floors, made } => {
                self.floors_kept(now_us, (&task, floors, made), outputs);
            }
            Input::FloorsTakenIn { floors, taken } => self.floors_taken_in(now_us, (floors, &taken), outputs),
            Input::ClientSilent(client) => self.client_silent(now_us, client, outputs),
            Input::ClientGone(client) => self.client_gone(now_us, client, outputs),
            Input::WallClock { utc_s } => self.set_clock(now_us, utc_s, outputs),
            Input::SchedulesKept { number, result } => self.schedules_kept(now_us, (number, result), outputs),
            Input::HealthKept { number, result } => {
                self.on_kept(now_us, (&health::RESET, number, result), outputs);
            }
            Input::LearntKept { number, result } => {
                self.on_kept(now_us, (&learnt::FORGETTING, number, result), outputs);
            }
            Input::RunKept { number, result } => self.run_kept(now_us, (number, result), outputs),
            Input::RecordingOpened { run, name } => self.runs.recorded_as(run, name),
            Input::Wake => {}
            Input::Shutdown => self.shutdown(now_us, outputs),
        }
        self.pass_time(now_us, outputs);
        self.tap_sent(now_us, link_before, outputs);
        self.log_refusals(now_us, delivered_before, outputs);
        self.feed(now_us, outputs);
    }

    /// When the core wants [`Input::Wake`], in microseconds; `None` when only other inputs matter.
    #[must_use]
    pub fn next_wake_us(&self) -> Option<u64> {
        let device = self.device.as_ref().map(Supervisor::next_wake_us);
        let step = self.mind.as_ref().map(|_| self.stepped_us + STEP_MAX_US);
        let feed = self.feed.next_wake_us(&self.clients);
        let is_preparing = self.mind.as_ref().is_some_and(Mind::is_preparing);
        let prepare = is_preparing.then_some(self.prepared_us + PREPARE_US);
        let leases = [self.arbiter.lease_end_us(), self.client_inputs.lease_end_us()];
        [device, step, prepare, feed]
            .into_iter()
            .chain(leases)
            .flatten()
            .min()
    }

    /// The clients that follow `topic`, in the order in which they connected.
    pub fn followers(&self, topic: Topic) -> impl Iterator<Item = ClientId> + '_ {
        self.clients.followers(topic)
    }

    /// Where the brain believes the robot to be.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.mind.as_ref().map_or_else(Pose::default, |mind| {
            to_api::pose(mind.brain().pose(), mind.observer.observation().time_us)
        })
    }

    /// What the robot is doing.
    #[must_use]
    pub fn status(&self) -> Status {
        let Some(mind) = &self.mind else {
            return Status {
                state: brain::BehaviorState::Disconnected.name().to_owned(),
                reason: "no-robot".to_owned(),
                ..Status::default()
            };
        };
        let mut status = to_api::status(mind.brain().status(), mind.brain().job());
        status.inhibits = mind
            .observer
            .observation()
            .inhibits
            .names()
            .map(str::to_owned)
            .collect();
        status.room = room_here(mind.brain());
        status.driver = self.arbiter.driver().map(|client| self.clients.name(client));
        status
    }

    /// The brain, once a robot has described itself.
    #[must_use]
    pub fn brain(&self) -> Option<&brain::Brain> {
        self.mind.as_ref().map(Mind::brain)
    }

    /// Whether the robot measures what its motors draw, and so can feel carpets.
    #[must_use]
    pub fn measures_currents(&self) -> bool {
        self.mind.as_ref().is_some_and(Mind::measures_currents)
    }

    /// Gives the brain the map of a home it has not seen itself, in which it stands on the dock, or at the origin if the map
    /// has no dock. For simulators; to be called while no job runs. `false` before a robot was seen.
    pub fn take_up_home(&mut self, home: &brain::mapping::StoredMap) -> bool {
        self.mind.as_mut().map(|mind| mind.take_up(home)).is_some()
    }

    /// Tells the brain where the robot stands in the map, for simulators that know it.
    pub fn place_at(&mut self, pose: brain::Pose2) {
        if let Some(mind) = &mut self.mind {
            mind.place_at(pose);
        }
    }

    /// Whether nothing moves as far as the newest reports since [`Input::Shutdown`] (or the start) tell, or nothing is
    /// known because no robot is there.
    #[must_use]
    pub fn stands_still(&self) -> bool {
        let device = self.device.as_ref().filter(|device| device.is_attached());
        device.is_none_or(|device| device.still_reports() > 0)
    }

    fn link_opened(&mut self, now_us: u64, outputs: &mut Outputs) {
        let known = self.device.take().or_else(|| self.lost_device.take());
        let device = self
            .device
            .insert(known.unwrap_or_else(|| Supervisor::new(&self.config.make)));
        device.open(&mut DeviceIo {
            now_us,
            link: &mut outputs.link,
            events: &mut self.events,
        });
        self.facts.opened(now_us);
        self.log(
            now_us,
            (LogLevel::Info, Part::Link, "serial device open".to_owned()),
            outputs,
        );
    }

    fn link_closed(&mut self, now_us: u64, reason: &LinkLoss, outputs: &mut Outputs) {
        self.lost_device = self.device.take().or_else(|| self.lost_device.take());
        self.facts.closed();
        self.buttons.forget();
        let text = match reason {
            LinkLoss::HungUp => "serial device lost: the other end hung up; waiting for it".to_owned(),
            LinkLoss::Failed(error) => format!("serial device lost: {error}; waiting for it"),
        };
        self.log(now_us, (LogLevel::Warn, Part::Link, text), outputs);
    }

    fn link_bytes(&mut self, now_us: u64, bytes: &[u8], outputs: &mut Outputs) {
        self.facts.count_in(bytes.len());
        self.tap_received(now_us, bytes, outputs);
        let mut events = core::mem::take(&mut self.events);
        if let Some(device) = &mut self.device {
            device.receive(
                bytes,
                &mut DeviceIo {
                    now_us,
                    link: &mut outputs.link,
                    events: &mut events,
                },
            );
        }
        self.device_events(now_us, &mut events, outputs);
        self.events = events;
    }

    fn shutdown(&mut self, now_us: u64, outputs: &mut Outputs) {
        self.ended = true;
        self.arbiter.preempt();
        self.device_command(now_us, DeviceCommand::EmergencyStop, outputs);
        if let Some(device) = &mut self.device {
            device.forget_stillness();
            device.release(&mut DeviceIo {
                now_us,
                link: &mut outputs.link,
                events: &mut self.events,
            });
        }
        self.log(
            now_us,
            (LogLevel::Info, Part::Vthal, "ends: wheels stop".to_owned()),
            outputs,
        );
        self.shut_down_run(now_us, outputs);
        let recording = self.config.recording;
        if let Some(mind) = &mut self.mind {
            if self.config.checkpoints == Checkpoints::On {
                outputs.checkpoint = Some(checkpoints::checkpoint_without_job(mind));
            }
            outputs.home = mind.home_to_keep();
            mind.end_run(now_us, RunEnd::Shutdown, &mut recorder(recording, outputs));
        }
        self.keep_learnt(outputs);
    }

    /// Before anything else: the brain, which sees the same end, must not let the wheels roll out in its own way first.
    fn end_leases(&mut self, now_us: u64, outputs: &mut Outputs) {
        if let Some(client) = self.arbiter.expire(now_us) {
            self.lease_ended(now_us, client, outputs);
        }
        self.expire_inputs(now_us, outputs);
    }

    fn pass_time(&mut self, now_us: u64, outputs: &mut Outputs) {
        self.facts.pass_time(now_us);
        let mut events = core::mem::take(&mut self.events);
        if let Some(device) = &mut self.device
            && now_us >= device.next_wake_us()
        {
            device.poll(&mut DeviceIo {
                now_us,
                link: &mut outputs.link,
                events: &mut events,
            });
        }
        self.device_events(now_us, &mut events, outputs);
        self.events = events;
        let recording = self.config.recording;
        if let Some(mind) = &mut self.mind
            && mind.is_preparing()
            && now_us >= self.prepared_us + PREPARE_US
        {
            self.prepared_us = now_us;
            mind.prepare(now_us, &mut recorder(recording, outputs));
        }
        if self.mind.is_some() && now_us >= self.stepped_us + STEP_MAX_US {
            self.think(now_us, outputs);
        }
    }

    fn device_command(&mut self, now_us: u64, command: DeviceCommand, outputs: &mut Outputs) {
        let Some(device) = &mut self.device else { return };
        let mut io = DeviceIo {
            now_us,
            link: &mut outputs.link,
            events: &mut self.events,
        };
        if let Err(error) = device.command(command, &mut io)
            && self.facts.is_new_error(error)
        {
            let text = format!("{command:?} was not sent: {error}");
            self.log(now_us, (LogLevel::Debug, Part::Link, text), outputs);
        }
    }

    fn log(&mut self, now_us: u64, (level, part, text): (LogLevel, Part, String), outputs: &mut Outputs) {
        let entry = self.journal.write(now_us, level, (part, text));
        if self.clients.any(Topic::Log) {
            outputs.deliveries.push(Delivery {
                to: Recipients::Followers(Topic::Log),
                update: Update::Log(entry.clone()),
            });
        }
        if self.records() {
            outputs.records.push(Record::Log(entry.clone()));
        }
        outputs.log.push(entry);
    }

    /// Whether a run is going on that is recorded.
    fn records(&self) -> bool {
        self.config.recording == Recording::On && self.mind.as_ref().is_some_and(Mind::is_recorded)
    }

    fn wants_packets(&self) -> bool {
        self.records() || self.clients.any(Topic::Packets)
    }

    fn tap_received(&mut self, now_us: u64, bytes: &[u8], outputs: &mut Outputs) {
        if self.wants_packets() {
            self.tap(now_us, (crate::Direction::FromRobot, bytes), outputs);
        }
    }

    fn tap_sent(&mut self, now_us: u64, link_before: usize, outputs: &mut Outputs) {
        let sent = outputs.link.len() - link_before;
        if sent == 0 {
            return;
        }
        self.facts.count_out(sent);
        if self.wants_packets() {
            let link = core::mem::take(&mut outputs.link);
            let bytes = link.get(link_before..).unwrap_or_default();
            self.tap(now_us, (crate::Direction::ToRobot, bytes), outputs);
            outputs.link = link;
        }
    }

    fn tap(&mut self, now_us: u64, (direction, bytes): (crate::Direction, &[u8]), outputs: &mut Outputs) {
        let Some(device) = &mut self.device else { return };
        let mut packets = core::mem::take(&mut self.packets);
        device.tap(direction, bytes, &mut packets);
        self.tell_packets(now_us, &mut packets, outputs);
        self.packets = packets;
    }

    fn tell_packets(
        &mut self,
        now_us: u64,
        packets: &mut Vec<(crate::Direction, String)>,
        outputs: &mut Outputs,
    ) {
        let recorded = self.records();
        let followed = self.clients.any(Topic::Packets);
        for (direction, text) in packets.drain(..) {
            if recorded {
                outputs.records.push(Record::Packet {
                    time_us: now_us,
                    direction,
                    text: text.clone(),
                });
            }
            if followed {
                outputs.deliveries.push(Delivery {
                    to: Recipients::Followers(Topic::Packets),
                    update: Update::Packet {
                        t: to_api::seconds(now_us),
                        direction: direction.symbol(),
                        text,
                    },
                });
            }
        }
    }
}

fn recorder(recording: Recording, outputs: &mut Outputs) -> Recorder<'_> {
    Recorder {
        records: (recording == Recording::On).then_some(&mut outputs.records),
    }
}

fn room_here(brain: &brain::Brain) -> Option<RoomHere> {
    let id = brain.room()?;
    let name = brain.map().annotations().name(id);
    Some(RoomHere {
        id,
        name: name.map(|name| name.as_str().to_owned()),
    })
}
