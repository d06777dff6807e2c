//! A simulated robot behind a pseudoterminal, for a daemon in another process.
//!
//! One thread, one loop: it sleeps until the next millisecond or until bytes arrive, transfers bytes, and advances the
//! robot to the present. Only this level uses the wall clock.

mod clients;
mod hand;
mod pace;
mod pty;
mod radio;
mod request;
mod socket;
mod speedometer;

use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use home::{Pose, SensorFault, SensorId};
use robot::RobotSettings;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rvac_api::Update;

use crate::report::{Driven, RunReport, StuckWatch};
use crate::{Robot, Scene, SceneError, plan};
use clients::{Clients, Number};
use hand::{AMOUNT_MAX, Hand, HandPath, PathEnd};
use pace::Pacer;
use pty::{Peer, Pty, PtyError};
use radio::Radio;
use request::{RequestReply, SimulatorRequest, blocked};
use socket::{SocketError, SocketListener};
use speedometer::Speedometer;

/// Settings of the server.
#[derive(Clone, Debug, PartialEq)]
pub struct ServeSettings {
    /// Seed of everything random.
    pub seed: u64,
    /// How many times as fast as the wall clock.
    pub speed: u32,
    /// Bits per second of the line.
    pub baud: u32,
    /// Where the symbolic link to the terminal goes.
    pub link: PathBuf,
    /// Where the socket goes.
    pub socket: PathBuf,
    /// A DWM1001 module on the Linux board, if there is one.
    pub radio: Option<RadioSettings>,
}

/// The module and its measurements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RadioSettings {
    /// Where the symbolic link to its terminal goes.
    pub link: PathBuf,
    /// Beacons at the edges of the home.
    pub beacons: usize,
}

/// Why the server cannot start or go on.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// No scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// No terminal.
    #[error(transparent)]
    Pty(#[from] PtyError),
    /// No socket.
    #[error(transparent)]
    Socket(#[from] SocketError),
    /// The system fails in the middle of the work.
    #[error("the simulator cannot go on: {0}")]
    System(#[from] io::Error),
}

/// Truths a client gets in a second of the wall clock.
const TRUTHS_PER_S: u32 = 10;
/// Longest time on the wall for the ticks of one turn, so that clients and the terminal are served however slow the
/// machine is.
const TURN_MAX: Duration = Duration::from_millis(20);
/// How long a press of a button lasts, simulated.
const PRESS_MS: u64 = 200;
/// Simulated milliseconds between two checks whether the robot is stuck.
const STUCK_SAMPLE_MS: u64 = 100;

/// Opens everything, says `ready` on standard output, and serves until SIGTERM or SIGINT.
///
/// # Errors
/// See [`ServeError`].
pub fn serve(scene: &Scene, settings: &ServeSettings) -> Result<(), ServeError> {
    let ended = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&ended))?;
    }
    let mut server = Server::open(scene, settings)?;
    writeln!(io::stdout(), "ready")?;
    io::stdout().flush()?;
    while !ended.load(Ordering::Relaxed) {
        server.turn()?;
    }
    Ok(())
}

struct Server {
    robot: Robot,
    pty: Pty,
    radio: Option<Radio>,
    listener: SocketListener,
    clients: Clients,
    pace: Pacer,
    speedometer: Speedometer,
    map_from_plan: Pose,
    stuck: StuckWatch,
    presses: Vec<(u8, u64)>,
    hand: Option<(Number, Hand)>,
    to_host: Vec<u8>,
    started: Instant,
    truths: u32,
}

impl Server {
    fn open(scene: &Scene, settings: &ServeSettings) -> Result<Self, ServeError> {
        let robot = scene.robot(
            settings.seed,
            &RobotSettings {
                baud: settings.baud,
                seed: settings.seed,
                ..RobotSettings::default()
            },
        );
        let map_from_plan = robot.world().truth().pose.inverse();
        let greeting = Update::SimulatedPlan(plan::plan(robot.world().home(), map_from_plan));
        let radio = settings.radio.as_ref().map(|radio| {
            let beacons = scene.beacons(settings.seed, radio.beacons);
            Radio::open(&radio.link, beacons)
        });
        let started = Instant::now();
        Ok(Self {
            radio: radio.transpose()?,
            listener: SocketListener::open(&settings.socket)?,
            pty: Pty::open(&settings.link)?,
            clients: Clients::new(&greeting),
            pace: Pacer::starting(started, settings.speed),
            speedometer: Speedometer::starting(started, settings.speed),
            robot,
            map_from_plan,
            stuck: StuckWatch::default(),
            presses: Vec::new(),
            hand: None,
            to_host: Vec::new(),
            started,
            truths: 0,
        })
    }

    fn turn(&mut self) -> Result<(), ServeError> {
        self.sleep()?;
        self.clients.accept(&self.listener)?;
        self.answer();
        self.carry()?;
        let due = self.started.elapsed().as_millis() * u128::from(TRUTHS_PER_S) / 1000;
        if due > u128::from(self.truths) {
            self.truths = u32::try_from(due).unwrap_or(u32::MAX);
            let truth = plan::truth(&self.robot, self.map_from_plan);
            self.clients.tell_newest(&Update::SimulatedTruth(truth));
        }
        self.clients.flush();
        Ok(())
    }

    /// Until the next tick is due or somebody connects or asks. The terminal is polled with each tick: its bytes are
    /// paced anyway.
    fn sleep(&self) -> Result<(), ServeError> {
        let pause = self.pace.until_next(Instant::now());
        let timeout = Timespec::try_from(pause).map_err(|_| io::Error::other("pause does not fit"))?;
        let mut watched = vec![PollFd::new(&self.listener, PollFlags::IN)];
        watched.extend(
            self.clients
                .sources()
                .map(|client| PollFd::new(client, PollFlags::IN)),
        );
        match poll(&mut watched, Some(&timeout)) {
            Ok(_) | Err(rustix::io::Errno::INTR) => Ok(()),
            Err(error) => Err(io::Error::from(error).into()),
        }
    }

    /// Advances the robot to the present with the bytes of the terminal.
    fn carry(&mut self) -> Result<(), ServeError> {
        let due = self.pace.take_due(Instant::now());
        if due == 0 {
            return Ok(());
        }
        let mut buffer = [0; 1024];
        let room = self.robot.line_room().min(buffer.len());
        let peer = match buffer.get_mut(..room) {
            Some(free) if !free.is_empty() => self.pty.read(free)?,
            _ => Peer::Present(0),
        };
        if let Peer::Present(count) = peer {
            self.robot.send(buffer.get(..count).unwrap_or_default());
        }
        self.to_host.clear();
        self.advance(due);
        if let Some(radio) = &mut self.radio {
            radio.carry(self.robot.now_ms())?;
        }
        if peer != Peer::Absent && !self.to_host.is_empty() {
            // What does not fit is lost, as bytes are that a receiver does not take in time.
            self.pty.write(&self.to_host)?;
        }
        Ok(())
    }

    /// Does these ticks, or as many of them as there is time for. The others are given up: simulated time passes more
    /// slowly then, and nothing else changes.
    fn advance(&mut self, due: u64) {
        let begun = Instant::now();
        let mut done = 0;
        while done < due && (done == 0 || begun.elapsed() < TURN_MAX) {
            self.robot.tick(&mut self.to_host);
            self.release_buttons();
            self.move_hand();
            self.watch_stuck();
            if let Some(radio) = &mut self.radio {
                radio.pass_ms(&self.robot);
            }
            done += 1;
        }
        if let Some(notice) = self.speedometer.pass(Instant::now(), done) {
            // If standard error is closed, the message is lost.
            writeln!(io::stderr(), "rvac-sim: {notice}").ok();
        }
    }

    fn watch_stuck(&mut self) {
        if self.robot.now_ms().is_multiple_of(STUCK_SAMPLE_MS) {
            let driven = Driven::of(&self.robot);
            self.stuck
                .watch(STUCK_SAMPLE_MS as u32, self.robot.world().truth(), driven);
        }
    }

    fn release_buttons(&mut self) {
        let now_ms = self.robot.now_ms();
        while let Some(index) = self.presses.iter().position(|(_, until)| *until <= now_ms) {
            let (button, _) = self.presses.swap_remove(index);
            self.robot.world_mut().release_button(button);
        }
    }

    fn move_hand(&mut self) {
        let Some((client, hand)) = &mut self.hand else {
            return;
        };
        let answer = match hand.follow(self.robot.world_mut()) {
            None => return,
            Some(PathEnd::Done) => RequestReply::Done,
            Some(PathEnd::Blocked) => blocked("something is in the way"),
        };
        self.clients.answer(*client, &answer);
        self.hand = None;
    }

    fn answer(&mut self) {
        for (client, request) in self.clients.requests() {
            match request {
                Ok(request) => self.obey(client, request),
                Err(refusal) => self.clients.answer(client, &RequestReply::Failed(refusal)),
            }
        }
    }

    fn obey(&mut self, client: Number, request: SimulatorRequest) {
        match request {
            SimulatorRequest::Report => {
                let report = RunReport {
                    wall_seconds: self.started.elapsed().as_secs_f64(),
                    ..RunReport::of(&self.robot, &self.stuck)
                };
                self.clients.answer(client, &RequestReply::Report(report));
            }
            SimulatorRequest::Truth => {
                let truth = plan::truth(&self.robot, self.map_from_plan);
                self.clients.answer(client, &Update::SimulatedTruth(truth));
            }
            SimulatorRequest::Meters => {
                let truth = self.robot.world().truth();
                let (pack_v, drawn_a) = (truth.battery_v, -truth.battery_a);
                self.clients
                    .answer(client, &RequestReply::Meters { pack_v, drawn_a });
            }
            SimulatorRequest::Push { distance } => self.grip(client, HandPath::Push(distance)),
            SimulatorRequest::Turn { turns } => self.grip(client, HandPath::Turn(turns)),
            SimulatorRequest::Roll { wheel, distance } => self.grip(client, HandPath::Roll(wheel, distance)),
            SimulatorRequest::Lift
            | SimulatorRequest::PutDown
            | SimulatorRequest::Press { .. }
            | SimulatorRequest::Hold { .. }
            | SimulatorRequest::Paper { .. }
            | SimulatorRequest::Hair { .. }
            | SimulatorRequest::Place { .. } => {
                self.touch(request);
                self.clients.answer(client, &RequestReply::Done);
            }
        }
    }

    /// What is done in a moment.
    fn touch(&mut self, request: SimulatorRequest) {
        let now_ms = self.robot.now_ms();
        let sensors = self
            .robot
            .model()
            .proximity
            .as_ref()
            .map_or(0, |part| part.headings_rad.len());
        let world = self.robot.world_mut();
        match request {
            SimulatorRequest::Lift => world.lift(),
            SimulatorRequest::PutDown => world.put_down(),
            SimulatorRequest::Press { button, ms } => {
                self.presses
                    .push((button, now_ms + ms.map_or(PRESS_MS, u64::from)));
                world.press_button(button);
            }
            SimulatorRequest::Hold { on } => world.turn_wheels(on.then_some([0.0; 2])),
            SimulatorRequest::Paper { sensor } => {
                for number in (0..=u8::MAX).take(sensors) {
                    let white = SensorFault::StuckAt(i32::from(u8::MAX));
                    world.set_fault(
                        SensorId::Proximity(number),
                        (sensor == Some(number)).then_some(white),
                    );
                }
            }
            SimulatorRequest::Hair { times } => world.wind_brush(times),
            SimulatorRequest::Place { x, y, heading } => {
                let there = Pose {
                    x_m: x,
                    y_m: y,
                    heading_rad: heading,
                };
                world.put_down_at(self.map_from_plan.inverse().then(there));
            }
            _ => {}
        }
    }

    fn grip(&mut self, client: Number, distance: HandPath) {
        if !distance.is_possible() {
            let text = format!("the hand moves {AMOUNT_MAX} metres or turns at most");
            self.clients.answer(client, &blocked(&text));
        } else if self.hand.is_some() {
            self.clients
                .answer(client, &blocked("the hand is still on its way"));
        } else {
            self.hand = Some((client, Hand::grip(distance, self.robot.world_mut())));
        }
    }
}
