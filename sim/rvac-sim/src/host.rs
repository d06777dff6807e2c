//! The daemon's core without the daemon, connected to the robot in memory.

use brain::command::StrategyName;
use brain::mapping::StoredMap;
use brain::observation::{BeaconRange, BeaconSignal, BeaconStrength};
use brain::{BehaviorState, Brain, Pose2};
use home::{Beacons, Measured, Pose as TruePose};
use rvac_api::{
    ComponentHealth, FloorsView, HomeView, LogEntry, Pose, Request, RequestBody, RunRecord, Schedules,
    Status, Topic, Update,
};
use vthal_core::health::StoredHealth;
use vthal_core::learnt::StoredLearnings;
use vthal_core::schedule::{Book, StoredBook};
use vthal_core::{
    Checkpoint, ClientId, Core, CoreConfig, FloorHome, HealthOrder, Input, LearntOrder, Outputs, Record,
};

use crate::HostCost;
use crate::host_floors::HostFloors;
use crate::host_wall::HostWall;

/// A core and the shell's duties towards it.
#[derive(Debug)]
pub struct Host {
    core: Core,
    outputs: Outputs,
    /// Bytes for the robot that its line has not taken yet.
    pending: Vec<u8>,
    checkpoint: Option<Checkpoint>,
    /// Lines of its log, if enabled.
    log: Option<Vec<LogEntry>>,
    /// Records of its core that have not been taken, if enabled.
    records: Option<Vec<Record>>,
    /// Processor time of its core, if enabled.
    cost: Option<HostCost>,
    born_us: u64,
    /// Its clock on the wall, if it has one.
    wall: Option<HostWall>,
    schedules: Option<StoredBook>,
    health: Option<StoredHealth>,
    learnt: Option<StoredLearnings>,
    /// Runs that are over.
    runs: Vec<RunRecord>,
    floors: HostFloors,
    /// What it has written since that was taken, if enabled.
    writes: Option<Vec<KeptWrite>>,
    /// Its disk accepts writes but never confirms them.
    disk_is_mute: bool,
    /// Its disk refuses writes with these words.
    disk_refuses: Option<&'static str>,
    /// Why the newest request was refused, if it was.
    refusal: Option<String>,
}

pub(crate) const CLIENT: ClientId = ClientId(1);

/// Something that a daemon writes to its disk, in the order in which it does.
#[derive(Clone, Debug)]
pub enum KeptWrite {
    /// The map of a floor.
    Home(Box<FloorHome>),
    /// The newest map of this floor is doubted.
    Doubt(u16),
    /// What robots have learnt of themselves.
    Learnt(Box<StoredLearnings>),
    /// The loads of motors.
    Health(Box<StoredHealth>),
    /// The record of a run.
    Run(Box<RunRecord>),
}

impl Host {
    /// Starts at `now_us` with an open link and one client. `now_us` is any clock; the core's own begins with 0.
    #[must_use]
    pub fn start(now_us: u64, config: CoreConfig) -> Self {
        let floors = HostFloors::of(&config.floors);
        let mut host = Self {
            core: Core::new(config),
            floors,
            outputs: Outputs::default(),
            pending: Vec::new(),
            checkpoint: None,
            log: None,
            records: None,
            cost: None,
            born_us: now_us,
            wall: None,
            schedules: None,
            health: None,
            learnt: None,
            runs: Vec::new(),
            writes: None,
            disk_is_mute: false,
            disk_refuses: None,
            refusal: None,
        };
        host.handle(now_us, Input::ClientConnected(CLIENT));
        host.handle(now_us, Input::LinkOpened);
        host
    }

    /// A core for `strategy` that keeps no checkpoints.
    #[must_use]
    pub fn config(seed: u64, strategy: StrategyName) -> CoreConfig {
        CoreConfig {
            seed,
            strategy: Some(strategy),
            ..CoreConfig::default()
        }
    }

    /// The gyro on the Linux board has turned so far in total.
    pub(crate) fn board_heading(&mut self, now_us: u64, heading_urad: i32) {
        self.handle(now_us, Input::BoardHeading { heading_urad });
    }

    /// The radio on the Linux board has measured something of a beacon.
    pub(crate) fn beacon(&mut self, now_us: u64, beacon: u16, measured: Measured) {
        let signal = match measured {
            Measured::Range(range_m) => BeaconSignal::Range(BeaconRange {
                beacon,
                range_m,
                sigma_m: Beacons::SIGMA_M,
            }),
            Measured::Strength(dbm) => BeaconSignal::Strength(BeaconStrength { beacon, dbm }),
        };
        self.handle(now_us, Input::Beacon(signal));
    }

    /// Gives it a clock on the wall, or sets it.
    pub fn set_wall(&mut self, now_us: u64, utc_s: i64) {
        self.wall = Some(HostWall::showing(now_us, utc_s));
    }

    /// From now on its disk accepts writes but never confirms them.
    pub fn mute_disk(&mut self) {
        self.disk_is_mute = true;
    }

    /// From now on its disk refuses writes with these words.
    pub fn refuse_writes(&mut self, words: &'static str) {
        self.disk_refuses = Some(words);
    }

    /// Schedules that a daemon after this one finds on its disk.
    #[must_use]
    pub fn kept_schedule_count(&self) -> usize {
        self.kept_schedules().entries().count()
    }

    /// The floors of the home, as clients receive them.
    #[must_use]
    pub fn floors(&self) -> FloorsView {
        self.core.floors_view()
    }

    /// All schedules, as clients receive them.
    #[must_use]
    pub fn schedules(&self) -> Schedules {
        self.core.schedules()
    }

    /// The loads of motors that a daemon after this one finds on its disk.
    #[must_use]
    pub fn kept_health(&self) -> Option<StoredHealth> {
        self.health.clone()
    }

    /// The calibration that its robot has learned, which the next daemon finds on its disk.
    #[must_use]
    pub fn kept_learnt(&self) -> Option<StoredLearnings> {
        self.learnt.clone()
    }

    /// What is known of the home, as clients receive it.
    #[must_use]
    pub fn home_view(&self) -> Option<HomeView> {
        self.core.home_view()
    }

    /// Health of the parts, as clients receive it.
    #[must_use]
    pub fn health(&self) -> Vec<ComponentHealth> {
        self.core.component_health()
    }

    /// The schedules that a daemon after this one finds on its disk.
    #[must_use]
    pub fn kept_schedules(&self) -> Book {
        let kept = self.schedules.clone().map(Book::try_from);
        kept.and_then(Result::ok).unwrap_or_default()
    }

    /// Hands over the bytes from the robot and lets time pass.
    pub fn step(&mut self, now_us: u64, from_robot: &[u8]) {
        if !from_robot.is_empty() {
            self.handle(now_us, Input::LinkBytes(from_robot));
        }
        if self
            .core
            .next_wake_us()
            .is_some_and(|wake| wake <= now_us - self.born_us)
        {
            self.handle(now_us, Input::Wake);
        }
        if let Some(utc_s) = self.wall.as_mut().and_then(|wall| wall.look(now_us)) {
            self.handle(now_us, Input::WallClock { utc_s });
        }
    }

    /// The client asks for something.
    pub fn ask(&mut self, now_us: u64, body: RequestBody) {
        self.ask_as(now_us, CLIENT, body);
    }

    /// This client asks for something; gives why that is refused, if it is.
    pub fn ask_as(&mut self, now_us: u64, client: ClientId, body: RequestBody) -> Option<String> {
        self.refusal = None;
        let request = Request { id: None, body };
        self.handle(now_us, Input::Client { client, request });
        self.refusal.take()
    }

    /// Something reaches the core: clients come and go, the link opens and closes.
    pub fn handle(&mut self, now_us: u64, input: Input<'_>) {
        let (core, outputs) = (&mut self.core, &mut self.outputs);
        let age_us = now_us - self.born_us;
        let step = || core.handle(age_us, input, outputs);
        match &mut self.cost {
            Some(cost) => cost.measure(age_us, step),
            None => step(),
        }
        self.pending.append(&mut self.outputs.link);
        if let Some(checkpoint) = self.outputs.checkpoint.take() {
            self.checkpoint = Some(checkpoint);
        }
        if let Some(log) = &mut self.log {
            log.append(&mut self.outputs.log);
        }
        if let Some(records) = &mut self.records {
            records.append(&mut self.outputs.records);
        }
        let schedules = self.outputs.schedules.take();
        let health = self.outputs.health.take();
        let run = self.outputs.run.take();
        let learnt = self.outputs.learnt.take();
        let floor_orders = core::mem::take(&mut self.outputs.floor_orders);
        if let Some(floor) = self.outputs.doubted_floor.take() {
            self.note_write(|| KeptWrite::Doubt(floor));
        }
        if let Some(kept) = self.outputs.home.take() {
            self.note_write(|| KeptWrite::Home(Box::new(kept.clone())));
            self.floors.keep(kept);
        }
        for delivery in &self.outputs.deliveries {
            if let Update::Failed(failure) = &delivery.update {
                self.refusal = Some(failure.reason.clone());
            }
        }
        self.outputs.clear();
        if let Some(record) = run {
            self.keep_run(now_us, *record);
        }
        if let Some(order) = health {
            self.keep_health(now_us, order);
        }
        if let Some(order) = learnt {
            self.keep_learnt(now_us, order);
        }
        for order in floor_orders {
            let input = self.floors.obey(order.task);
            self.handle(now_us, input);
        }
        if let Some(order) = schedules {
            let result = self.write_result();
            if result.is_ok() {
                self.schedules = Some(order.book);
            }
            if !self.disk_is_mute {
                let number = order.number;
                self.handle(now_us, Input::SchedulesKept { number, result });
            }
        }
    }

    fn note_write(&mut self, write: impl FnOnce() -> KeptWrite) {
        if let Some(writes) = &mut self.writes {
            writes.push(write());
        }
    }

    fn keep_health(&mut self, now_us: u64, order: HealthOrder) {
        self.note_write(|| KeptWrite::Health(Box::new(order.health.clone())));
        let result = self.write_result();
        if result.is_ok() {
            self.health = Some(order.health);
        }
        if !self.disk_is_mute {
            let number = order.number;
            self.handle(now_us, Input::HealthKept { number, result });
        }
    }

    fn keep_learnt(&mut self, now_us: u64, order: LearntOrder) {
        self.note_write(|| KeptWrite::Learnt(Box::new(order.learnt.clone())));
        let result = self.write_result();
        if result.is_ok() {
            self.learnt = Some(order.learnt);
        }
        if !self.disk_is_mute {
            let number = order.number;
            self.handle(now_us, Input::LearntKept { number, result });
        }
    }

    fn write_result(&self) -> Result<(), String> {
        self.disk_refuses.map_or(Ok(()), |words| Err(words.to_owned()))
    }

    fn keep_run(&mut self, now_us: u64, record: RunRecord) {
        self.note_write(|| KeptWrite::Run(Box::new(record.clone())));
        let run = Box::new(record.run.clone());
        self.runs.push(record);
        if !self.disk_is_mute {
            let (number, result) = (run.number, Ok(run));
            self.handle(now_us, Input::RunKept { number, result });
        }
    }

    /// The runs that are on its disk, oldest first.
    #[must_use]
    pub fn runs(&self) -> &[RunRecord] {
        &self.runs
    }

    /// Shuts it down in good order.
    pub fn shut_down(&mut self, now_us: u64) {
        self.handle(now_us, Input::Shutdown);
    }

    /// From now on it is measured what its core takes of a processor, which costs some of that itself.
    pub fn measure_cost(&mut self) {
        self.cost.get_or_insert_default();
    }

    /// Processor time of its core since [`Self::measure_cost`]; `None` = not measured.
    #[must_use]
    pub const fn cost(&self) -> Option<HostCost> {
        self.cost
    }

    /// What was measured since [`Self::measure_cost`] or since the last call.
    pub fn take_cost(&mut self) -> HostCost {
        self.cost.as_mut().map(core::mem::take).unwrap_or_default()
    }

    /// From now on what it writes to its disk is kept in order, for a disk of files.
    pub fn keep_writes(&mut self) {
        self.writes.get_or_insert_default();
    }

    /// What it has written since the last call.
    pub fn take_writes(&mut self) -> Vec<KeptWrite> {
        self.writes.as_mut().map_or_else(Vec::new, core::mem::take)
    }

    /// From now on its log is kept.
    pub fn keep_log(&mut self) {
        self.log.get_or_insert_default();
    }

    /// What it has logged since [`Self::keep_log`].
    #[must_use]
    pub fn log(&self) -> &[LogEntry] {
        self.log.as_deref().unwrap_or_default()
    }

    /// The lines of its log that a client reads who comes now.
    pub fn read_log(&mut self, now_us: u64) -> Vec<LogEntry> {
        let updates = self.read(now_us, Topic::Log).into_iter();
        let lines = updates.filter_map(|update| match update {
            Update::Log(entry) => Some(entry),
            _ => None,
        });
        lines.collect()
    }

    /// The schedules that a client reads who comes now.
    pub fn read_schedules(&mut self, now_us: u64) -> Option<Schedules> {
        let updates = self.read(now_us, Topic::Schedules).into_iter();
        let mut schedules = updates.filter_map(|update| match update {
            Update::Schedules(schedules) => Some(schedules),
            _ => None,
        });
        schedules.next()
    }

    /// What a client receives of a topic who comes now.
    fn read(&mut self, now_us: u64, topic: Topic) -> Vec<Update> {
        let client = ClientId(u64::MAX);
        let request = Request {
            id: None,
            body: RequestBody::Watch { topics: vec![topic] },
        };
        let age_us = now_us - self.born_us;
        let mut read = Vec::new();
        for input in [
            Input::ClientConnected(client),
            Input::Client { client, request },
            Input::ClientGone(client),
        ] {
            self.core.handle(age_us, input, &mut self.outputs);
            self.pending.append(&mut self.outputs.link);
            let deliveries = self.outputs.deliveries.drain(..);
            read.extend(deliveries.map(|delivery| delivery.update));
        }
        self.outputs.clear();
        read
    }

    /// From now on what its core records is kept; a core records when its settings say so.
    pub fn keep_records(&mut self) {
        self.records.get_or_insert_default();
    }

    /// What was recorded since it was taken last.
    pub fn take_records(&mut self) -> Vec<Record> {
        self.records.as_mut().map_or_else(Vec::new, core::mem::take)
    }

    /// Bytes for the robot; what is not taken stays.
    pub fn pending(&mut self) -> &mut Vec<u8> {
        &mut self.pending
    }

    /// What a daemon that comes after this one finds on its disk.
    #[must_use]
    pub fn checkpoint(&self) -> Option<&Checkpoint> {
        self.checkpoint.as_ref()
    }

    /// The host's estimate of the robot's pose.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.core.pose()
    }

    /// What the brain is doing; `None` before it has the robot's description.
    #[must_use]
    pub fn state(&self) -> Option<BehaviorState> {
        self.core.brain().map(|brain| brain.status().state)
    }

    /// The brain, once the robot's description is known.
    #[must_use]
    pub fn brain(&self) -> Option<&Brain> {
        self.core.brain()
    }

    /// Whether its robot measures what its motors draw.
    #[must_use]
    pub fn measures_currents(&self) -> bool {
        self.core.measures_currents()
    }

    /// Gives the brain a map of the home; `false` before it has the robot's description.
    pub(crate) fn take_up_home(&mut self, home: &StoredMap) -> bool {
        self.core.take_up_home(home)
    }

    /// Tells the brain where it really is, in the map frame.
    pub(crate) fn place(&mut self, truth: TruePose) {
        self.core.place_at(Pose2 {
            x_m: truth.x_m,
            y_m: truth.y_m,
            heading_rad: home::wrap_angle(truth.heading_rad),
        });
    }

    /// What the host says the robot is doing.
    #[must_use]
    pub fn status(&self) -> Status {
        self.core.status()
    }
}
