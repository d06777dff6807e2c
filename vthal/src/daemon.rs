//! The event loop: one closed enum of events goes in, what the core answers is carried out.

mod calibrating;
mod disk;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Duration;

use rvac_api::{Failure, LogEntry, LogLevel, Update};
use tokio::net::UnixStream;
use tokio::sync::mpsc::{Receiver, Sender};
use tokio::sync::watch;
use tokio::task::spawn_local;
use tokio::time::{Instant, sleep_until};
use vthal_core::schedule::ZoneReading;
use vthal_core::{ClientId, Core, Delivery, Input, LineHolder, Outputs, Recipients};

use calibrating::CalibrationSession;

use crate::board::{BoardEvent, LightsHandle};
use crate::checkpoint_thread::CheckpointHandle;
use crate::client::{self, Client, Flushed, Incoming};
use crate::client_stream::ClientStream;
use crate::clock::Clock;
use crate::event::{Event, LinkEvent};
use crate::imu::ImuEvent;
use crate::link::LineOrder;
use crate::load_meter::LoadMeter;
use crate::outbox::Class;
use crate::radio::RadioEvent;
use crate::recording::RecorderHandle;
use crate::run_thread::RunHandle;
use crate::socket;
use crate::told_lines::{CORE_LINES, ToldLine, ToldLines};

/// Longest wait for the wheels to stop when the daemon ends.
const STOP_WAIT: Duration = Duration::from_millis(500);
/// Events handled before clients get their mail and the clock is read again.
const BATCH_MAX: usize = 64;
/// Pause between two readings of the wall clock.
const WALL_US: u64 = 1_000_000;

/// Ends of the daemon's parts that the loop holds.
#[derive(Debug)]
pub(crate) struct Wiring {
    /// Everything that happens.
    pub events: Receiver<Event>,
    /// For tasks that the loop starts.
    pub event_sender: Sender<Event>,
    /// Bytes for the robot.
    pub to_robot: Sender<LineOrder>,
    /// Whose that line is.
    pub line_holder: watch::Sender<LineHolder>,
    /// Recordings, if enabled.
    pub recorder: Option<RecorderHandle>,
    /// Checkpoints.
    pub checkpoints: CheckpointHandle,
    /// What is kept of runs.
    pub runs: RunHandle,
    /// Lights on the Linux board, if there are any.
    pub lights: Option<LightsHandle>,
    /// What was measured of the robot.
    pub calibration_file: PathBuf,
    /// The socket's file, removed at the end.
    pub socket: PathBuf,
    /// Clients at the same time.
    pub clients_max: usize,
    /// Warnings and errors of the shell for clients.
    pub told: ToldLines,
}

/// The daemon while it runs.
#[derive(Debug)]
pub(crate) struct Daemon {
    core: Core,
    clock: Clock,
    wiring: Wiring,
    outputs: Outputs,
    clients: BTreeMap<ClientId, Client>,
    clients_seen: u64,
    congested: bool,
    calibration: Option<CalibrationSession>,
    load: LoadMeter,
    /// When the wall clock is read again.
    wall_due_us: u64,
    /// When the daemon gives up waiting for the wheels; `None` until it is ordered to end.
    ends_at: Option<Instant>,
}

impl Daemon {
    /// A daemon at the start.
    #[must_use]
    pub(crate) fn new(core: Core, clock: Clock, wiring: Wiring) -> Self {
        Self {
            core,
            clock,
            wiring,
            outputs: Outputs::default(),
            clients: BTreeMap::new(),
            clients_seen: 0,
            congested: false,
            calibration: None,
            load: LoadMeter::default(),
            wall_due_us: 0,
            ends_at: None,
        }
    }

    /// Runs until a signal ends it: the wheels have stopped (or their time for it is over), and everything is on disk.
    /// The system's time zone is `zone` at the start: schedules need it before the first clock.
    pub(crate) async fn run(mut self, zone: ZoneReading) {
        self.handle(Input::SystemZone(zone));
        while !self.is_over() {
            self.poll_wall_clock();
            let event = self.next_event().await;
            self.take(event);
            for _ in 1..BATCH_MAX {
                let Ok(event) = self.wiring.events.try_recv() else {
                    break;
                };
                self.take(event);
            }
            self.flush_clients();
        }
        self.finish();
    }

    async fn next_event(&mut self) -> Event {
        let due_us = self.core.next_wake_us().unwrap_or(u64::MAX).min(self.wall_due_us);
        let due = self.clock.moment(due_us);
        let due = self.ends_at.map_or(due, |end| due.min(end));
        tokio::select! {
            // The core's own deadlines include the dead man: they come before the next event.
            biased;
            () = sleep_until(due) => Event::Wake,
            Some(event) = self.wiring.events.recv() => event,
        }
    }

    fn poll_wall_clock(&mut self) {
        let now_us = self.clock.now_us();
        if now_us >= self.wall_due_us {
            self.wall_due_us = now_us + WALL_US;
            let utc_s = self.clock.utc_s();
            self.handle(Input::WallClock { utc_s });
            let load = self.load.reading();
            self.handle(Input::Load(load));
            for ToldLine { level, text } in self.wiring.told.take() {
                self.handle(Input::Told { level, text });
            }
        }
    }

    fn is_over(&self) -> bool {
        self.ends_at
            .is_some_and(|end| self.core.stands_still() || Instant::now() >= end)
    }

    fn take(&mut self, event: Event) {
        match event {
            Event::Wake => self.handle(Input::Wake),
            Event::WatchdogDue => systemd_notice::tell_alive(),
            Event::Link(event) => {
                if let Some(event) = self.divert_link(event) {
                    self.take_link(event);
                }
            }
            Event::Calibration(event) => self.take_calibration(event),
            Event::Imu(event) => self.take_imu(event),
            Event::Board(event) => self.take_board(event),
            Event::Radio(event) => self.take_radio(event),
            Event::Zone(zone) => self.handle(Input::SystemZone(zone)),
            Event::Connected(stream) => self.connect(stream),
            Event::ClientBytes(client, bytes, _turn) => self.client_bytes(client, &bytes),
            Event::ClientWritable(client) => {
                if let Some(client) = self.clients.get_mut(&client) {
                    client.unblock();
                }
            }
            Event::ClientSilent(client) => self.handle(Input::ClientSilent(client)),
            Event::ClientClosed(client) => self.disconnect(client),
            Event::Maps(answer) => self.take_map_answer(answer),
            Event::Floors(answer) => self.take_floor_answer(*answer),
            Event::Archive(answer) => self.take_archive_answer(*answer),
            Event::Mixes(answer) => self.take_mix_answer(answer),
            Event::Runs(answer) => self.take_run_answer(answer),
            Event::RunKept(number, result) => self.handle(Input::RunKept { number, result }),
            Event::RecordingOpened(run, name) => self.handle(Input::RecordingOpened { run, name }),
            Event::Health(number, result) => self.handle(Input::HealthKept { number, result }),
            Event::Learnt(number, result) => self.handle(Input::LearntKept { number, result }),
            Event::Schedules(number, result) => self.handle(Input::SchedulesKept { number, result }),
            Event::Terminate(signal) => self.terminate(signal),
        }
    }

    fn take_link(&mut self, event: LinkEvent) {
        match event {
            LinkEvent::Opened(abilities) => {
                tracing::debug!(part = "link", "the link passes {abilities}");
                self.handle(Input::LinkOpened);
            }
            LinkEvent::Bytes(bytes) => self.handle(Input::LinkBytes(&bytes)),
            LinkEvent::FramingErrors(count) => self.handle(Input::FramingErrors(count)),
            LinkEvent::Closed(reason) => self.handle(Input::LinkClosed { reason }),
            LinkEvent::Absent(error) => tracing::warn!(part = "link", "{error}"),
        }
    }

    fn take_imu(&mut self, event: ImuEvent) {
        match event {
            ImuEvent::Turned(heading_urad) => self.handle(Input::BoardHeading { heading_urad }),
            ImuEvent::Opened(manner) => tracing::info!(part = "imu", "heading sensor is read {manner}"),
            ImuEvent::Absent(text) => {
                tracing::warn!(
                    part = "imu",
                    "no heading from the board's gyro: {text}; looking again every 2 s"
                );
            }
        }
    }

    fn take_board(&mut self, event: BoardEvent) {
        match event {
            BoardEvent::Buttons(down) => self.handle(Input::BoardButtons { down }),
            BoardEvent::Opened(0) => tracing::info!(part = "board", "buttons and lights are open"),
            BoardEvent::Opened(down) => tracing::warn!(
                part = "board",
                "buttons are down at the start (bits {down:#b}): they count once they were released; if nobody holds \
                 them, board.pressed is the other level"
            ),
            BoardEvent::Absent(text) => {
                tracing::warn!(
                    part = "board",
                    "no buttons and lights: {text}; looking again every 2 s"
                );
                // A button that nobody can see any more is not held.
                self.handle(Input::BoardButtons { down: 0 });
            }
        }
    }

    fn take_radio(&mut self, event: RadioEvent) {
        match event {
            RadioEvent::Heard(signals) => {
                for signal in signals {
                    self.handle(Input::Beacon(signal));
                }
            }
            RadioEvent::Speaks => tracing::info!(part = "radio", "the radio speaks of beacons"),
            RadioEvent::NewBeacon(name, number) => {
                tracing::info!(part = "radio", "hears the beacon {name} (number {number})");
            }
            RadioEvent::Refused(refused) => tracing::warn!(
                part = "radio",
                "lines that could not be used: {}; the last, {:?}: {}",
                refused.count,
                refused.line,
                refused.reason
            ),
            RadioEvent::Absent(reason) => tracing::warn!(
                part = "radio",
                "nothing of beacons: {reason}; looking again every 2 s"
            ),
        }
    }

    fn terminate(&mut self, signal: &'static str) {
        if self.ends_at.is_none() {
            tracing::info!(part = "vthal", "{signal}: stops the wheels and ends");
            systemd_notice::tell_stopping();
            self.ends_at = Some(Instant::now() + STOP_WAIT);
            self.handle(Input::Shutdown);
        }
    }

    fn connect(&mut self, stream: UnixStream) {
        if self.clients.len() >= self.wiring.clients_max {
            let text = "As many clients are connected as may be: close one, or raise socket.clients_max.";
            let failure = refusal(None, "too-many-clients", text.to_owned());
            socket::turn_away(&stream, &client::encode(&failure));
            return;
        }
        let stream = match ClientStream::new(stream) {
            Ok(stream) => Rc::new(stream),
            Err(error) => {
                tracing::warn!(part = "client", "a client could not be watched: {error}");
                return;
            }
        };
        self.clients_seen += 1;
        let id = ClientId(self.clients_seen);
        let reads = client::read_for(id, Rc::clone(&stream), self.wiring.event_sender.clone());
        let mut client = Client::new(stream);
        client.own(spawn_local(reads).abort_handle());
        self.clients.insert(id, client);
        self.handle(Input::ClientConnected(id));
    }

    fn disconnect(&mut self, id: ClientId) {
        if self.clients.remove(&id).is_some() {
            self.handle(Input::ClientGone(id));
        }
    }

    fn client_bytes(&mut self, id: ClientId, bytes: &[u8]) {
        let Some(client) = self.clients.get_mut(&id) else {
            return;
        };
        for incoming in client.receive(bytes) {
            match incoming {
                Incoming::Request(request) => self.handle(Input::Client {
                    client: id,
                    request: *request,
                }),
                Incoming::Broken(failure) => {
                    self.handle(Input::Refused { client: id, failure });
                }
                Incoming::TooLong(failure) => {
                    if let Some(client) = self.clients.get_mut(&id) {
                        client.dismiss(failure, "too-long");
                    }
                }
            }
        }
    }

    fn handle(&mut self, input: Input<'_>) {
        let now_us = self.clock.now_us();
        let began = Instant::now();
        self.core.handle(now_us, input, &mut self.outputs);
        self.perform();
        self.load.count(began.elapsed());
        if let Some(lights) = &mut self.wiring.lights {
            lights.show(self.core.lights());
        }
    }

    /// Whose the line is, and its rate.
    fn order_line(&mut self) {
        if let Some(holder) = self.outputs.line_holder.take() {
            self.wiring.line_holder.send_replace(holder);
        }
        if self.outputs.next_rate && self.wiring.to_robot.try_send(LineOrder::NextRate).is_err() {
            tracing::warn!(part = "link", "the link is too busy to try another rate");
        }
    }

    fn perform(&mut self) {
        if !self.outputs.link.is_empty() {
            let bytes = std::mem::take(&mut self.outputs.link);
            let congested = self.wiring.to_robot.try_send(LineOrder::Send(bytes)).is_err();
            if congested && !self.congested {
                tracing::warn!(
                    part = "link",
                    "the link does not take what is sent: packets are dropped"
                );
            }
            self.congested = congested;
        }
        self.order_line();
        for delivery in self.outputs.deliveries.drain(..) {
            deliver(&self.core, &mut self.clients, &delivery);
        }
        for entry in self.outputs.log.drain(..) {
            log(&entry);
        }
        if let Some(recorder) = &mut self.wiring.recorder {
            for record in self.outputs.records.drain(..) {
                recorder.send(record);
            }
        }
        if let Some(checkpoint) = self.outputs.checkpoint.take() {
            self.wiring.checkpoints.send(checkpoint);
        }
        self.keep_maps();
        for edit in std::mem::take(&mut self.outputs.map_edits) {
            self.keep_edit(edit);
        }
        for order in std::mem::take(&mut self.outputs.calibration_orders) {
            self.order_calibration(order);
        }
        for order in std::mem::take(&mut self.outputs.map_orders) {
            self.order_map(order);
        }
        for order in std::mem::take(&mut self.outputs.floor_orders) {
            self.order_floor(order);
        }
        for order in std::mem::take(&mut self.outputs.archive_orders) {
            self.order_archive(order);
        }
        for order in std::mem::take(&mut self.outputs.mix_orders) {
            self.order_mix(order);
        }
        for query in std::mem::take(&mut self.outputs.run_queries) {
            if !self.wiring.runs.ask(query) {
                self.tell_busy(query.client, query.id);
            }
        }
        let schedules = self.outputs.schedules.take();
        let health = self.outputs.health.take();
        let learnt = self.outputs.learnt.take();
        let run = self.outputs.run.take();
        self.outputs.clear();
        if let Some(record) = run {
            self.keep_run(record);
        }
        if let Some(order) = schedules {
            self.keep_schedules(order);
        }
        if let Some(order) = health {
            self.keep_health(order);
        }
        if let Some(order) = learnt {
            self.keep_learnt(order);
        }
    }

    fn flush_clients(&mut self) {
        let mut gone = Vec::new();
        for (id, client) in self.clients.iter_mut().filter(|(_, client)| client.has_mail()) {
            match client.flush() {
                Flushed::Done | Flushed::Waits => {}
                Flushed::Blocks => {
                    let watch = client::watch_writable(
                        *id,
                        Rc::clone(client.stream()),
                        self.wiring.event_sender.clone(),
                    );
                    client.own(spawn_local(watch).abort_handle());
                }
                Flushed::Gone(reason) => gone.push((*id, reason)),
            }
        }
        for (id, reason) in gone {
            tracing::info!(part = "client", "client {} is disconnected: {reason}", id.0);
            self.disconnect(id);
        }
    }

    fn finish(self) {
        if !self.core.stands_still() {
            tracing::warn!(
                part = "vthal",
                "the robot did not confirm within 500 ms that it stands"
            );
        }
        std::fs::remove_file(&self.wiring.socket).ok();
        drop(self.wiring.events);
        self.wiring.checkpoints.finish();
        if let Some(recorder) = self.wiring.recorder {
            recorder.finish();
        }
    }
}

fn refusal(id: Option<u32>, reason: &str, text: String) -> Update {
    Update::Failed(Failure {
        id,
        reason: reason.to_owned(),
        text,
    })
}

/// Spells an update once for all who get it.
fn deliver(core: &Core, clients: &mut BTreeMap<ClientId, Client>, delivery: &Delivery) {
    let class = Class::of(&delivery.update);
    let message = client::encode(&delivery.update);
    match delivery.to {
        Recipients::One(id) => {
            if let Some(client) = clients.get_mut(&id) {
                client.push(class, message);
            }
        }
        Recipients::Followers(topic) => {
            for id in core.followers(topic) {
                if let Some(client) = clients.get_mut(&id) {
                    client.push(class, Rc::clone(&message));
                }
            }
        }
    }
}

fn log(entry: &LogEntry) {
    let LogEntry { part, text, .. } = entry;
    match entry.level {
        LogLevel::Debug => tracing::debug!(target: CORE_LINES, part, "{text}"),
        LogLevel::Info => tracing::info!(target: CORE_LINES, part, "{text}"),
        LogLevel::Warn => tracing::warn!(target: CORE_LINES, part, "{text}"),
        LogLevel::Error => tracing::error!(target: CORE_LINES, part, "{text}"),
    }
}
