//! A robot on a bench: cordlib on a board of plain memory, wheels that follow their duty with a lag, and the real host
//! end of the protocol, on a virtual clock of 1 ms.
#![allow(
    unreachable_pub,
    reason = "shared by the files of one program, public to none"
)]

pub mod judge;
pub mod limits;
pub mod parts;

use cordlib::board::{Board, Received};
use cordlib::{Cord, Parameters};
use judge::Judge;
use limits::Limit;
pub use parts::LIMITS;
use parts::{Memory, board};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Command, Description, Drive, Event, Gyro, Inhibit, Inhibits, Motor, MotorCommand, Move,
    MoveEnd, Refusal, Report, ResetCause, Sequence, State,
};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::{Angle, AngularSpeed, Length, Speed, Throttle, Tick};

/// What the line to the host takes at a time: less than a packet.
const LINE_BYTES: usize = 23;

/// What the mechanics do besides following the duty.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mechanics {
    /// Wheels that do not turn, whatever their duty: left, right.
    pub blocked: [bool; 2],
    /// Encoders that count backwards.
    pub swapped: bool,
    /// Encoders that are silent.
    pub silent: bool,
    /// Duty that a broken bridge puts on the left wheel.
    pub stuck_duty: Option<i32>,
}

/// The bench.
pub struct Rig {
    pub cord: Cord<Memory>,
    pub host: HostSession,
    pub mechanics: Mechanics,
    /// Speeds of the rims in m/s.
    pub rims: [f64; 2],
    /// Ways of the rims in m.
    pub distances: [f64; 2],
    pub edges: Vec<Event>,
    pub reports: Vec<Report>,
    pub refusals: Vec<Refusal>,
    pub described: Option<Description>,
    pub answered: usize,
    /// The host is dead: nothing it would send arrives.
    pub host_dead: bool,
    /// Sent every 50 ms.
    pub repeated: Vec<Command>,
    /// Somebody independent, if the test wants one.
    pub judge: Option<Judge>,
    now_ms: u64,
    start: u32,
}

/// A small generator of phases, not of quality.
pub struct Phases(pub u64);

impl Phases {
    pub fn below(&mut self, bound: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % u64::from(bound)) as u32
    }
}

fn parameters() -> Parameters {
    let mut parameters = Parameters::for_machine("rig", "0.1.0", LIMITS);
    parameters.wheel.dead_band = Throttle::saturating_from_millionths(120_000);
    parameters.wheel.speed_at_full = Speed(480_000);
    parameters
}

impl Rig {
    /// Switched on when the board's clock shows `start`.
    pub fn switched_on(start: u32) -> Self {
        Self::switched_on_with(start, |_| {})
    }

    /// As [`Self::switched_on`], with something different about the board.
    pub fn switched_on_with(start: u32, prepare: impl FnOnce(&mut Board<Memory>)) -> Self {
        let mut board = board(LINE_BYTES);
        board.clock.0 = start;
        prepare(&mut board);
        Self::with(board, parameters(), start)
    }

    /// As [`Self::switched_on`], with something different about the parameters.
    pub fn switched_on_as(start: u32, prepare: impl FnOnce(&mut Parameters)) -> Self {
        let mut board = board(LINE_BYTES);
        board.clock.0 = start;
        let mut parameters = parameters();
        prepare(&mut parameters);
        Self::with(board, parameters, start)
    }

    fn with(board: Board<Memory>, parameters: Parameters, start: u32) -> Self {
        Self {
            cord: Cord::new(board, parameters),
            host: HostSession::new(BinaryKinds::default(), Tick(0)),
            mechanics: Mechanics::default(),
            rims: [0.0; 2],
            distances: [0.0; 2],
            edges: Vec::new(),
            reports: Vec::new(),
            refusals: Vec::new(),
            described: None,
            answered: 0,
            host_dead: false,
            repeated: Vec::new(),
            judge: None,
            now_ms: 0,
            start,
        }
    }

    /// Switched on, with an open session.
    pub fn connected(start: u32) -> Self {
        let mut rig = Self::switched_on(start);
        rig.connect();
        rig
    }

    /// Connected, with the monitor watching from power-on.
    pub fn judged(start: u32) -> Self {
        let mut rig = Self::switched_on(start);
        rig.judge = Some(Judge::new(start));
        rig.connect();
        rig
    }

    /// The monitor has seen no breach.
    pub fn acquit(&self) {
        let judge = self.judge.as_ref().expect("a rig with a judge");
        assert!(judge.violations().is_empty(), "{:?}", judge.violations());
    }

    /// Connected and armed.
    pub fn armed(start: u32) -> Self {
        let mut rig = Self::connected(start);
        rig.arm();
        assert!(rig.cord.is_armed(), "inhibits {:?}", rig.names());
        rig
    }

    /// Armed, and driving forward at 0.25 m/s for a second.
    pub fn driving(start: u32) -> Self {
        let mut rig = Self::armed(start);
        rig.repeated = vec![drive(0.25, 0.0)];
        rig.run(1_000);
        assert!(
            rig.rims[0] > 0.2 && rig.rims[1] > 0.2,
            "{:?} {:?}",
            rig.rims,
            rig.names()
        );
        rig
    }

    /// Resets the chip: its memory is lost, but for what is kept over a reset, which only power takes away. Pins and
    /// mechanics stay as they are; the host begins a new session.
    pub fn reset(&mut self, cause: ResetCause) {
        let before = self.cord.board();
        let mut board = board(LINE_BYTES);
        board.clock.0 = self.now().0;
        board.reset.cause = cause;
        if cause != ResetCause::PowerOn {
            board.kept = before.kept;
        }
        board.checks.0.clone_from(&before.checks.0);
        board.bumpers.0 = before.bumpers.0;
        board.cliffs.missing = before.cliffs.missing;
        board.wheel_drops.0 = before.wheel_drops.0;
        board.currents.0 = before.currents.0;
        board.encoders.0 = before.encoders.0;
        board.dock_contacts.0 = before.dock_contacts.0;
        board.charger.readings = before.charger.readings;
        self.cord = Cord::new(board, *self.cord.parameters());
        self.host = HostSession::new(BinaryKinds::default(), self.host_now());
        self.repeated.clear();
        self.reports.clear();
    }

    /// Log lines since the last reset.
    pub fn log(&self) -> Vec<&str> {
        self.reports
            .iter()
            .filter_map(|report| match report {
                Report::Log { text, .. } => Some(text.as_str()),
                _ => None,
            })
            .collect()
    }

    pub fn connect(&mut self) {
        for _ in 0..2_000 {
            if self.host.is_open() && self.host.robot_tick().is_some() {
                break;
            }
            self.run(1);
        }
        assert!(self.host.is_open(), "no session");
    }

    pub fn arm(&mut self) {
        self.ask(arm(false)).expect("arming");
    }

    /// Sends a command that must arrive and waits for its answer.
    pub fn ask(&mut self, command: Command) -> Result<(), Refusal> {
        let (answered, refused) = (self.answered, self.refusals.len());
        self.send(command);
        for _ in 0..500 {
            self.run(1);
            if self.answered > answered {
                return Ok(());
            }
            if self.refusals.len() > refused {
                return Err(self.refusals[refused]);
            }
        }
        panic!("no answer to {command:?}");
    }

    pub fn send(&mut self, command: Command) {
        let mut packet = PacketBuffer::new();
        let now = self.host_now();
        self.host.send(command, now, &mut packet).expect("sending");
        self.deliver(packet.as_bytes());
    }

    /// Sends a motion command and runs until the robot has read it; the refusal, if any.
    pub fn try_motion(&mut self, command: Command) -> Result<(), Refusal> {
        let refused = self.refusals.len();
        self.send(command);
        self.run(30);
        self.refusals.get(refused).map_or(Ok(()), |refusal| Err(*refusal))
    }

    pub fn deliver(&mut self, bytes: &[u8]) {
        if !self.host_dead {
            if let Some(judge) = &mut self.judge {
                judge.hear(bytes);
            }
            let received = bytes.iter().map(|byte| Received::Byte(*byte));
            self.cord.board_mut().link.to_robot.extend(received);
        }
    }

    /// A person types a packet without a CRC, whatever has become of the host.
    pub fn type_in(&mut self, text: &str) {
        let received = text.bytes().chain([0x1F]).map(Received::Byte);
        self.cord.board_mut().link.to_robot.extend(received);
        self.run(20);
    }

    pub fn host_now(&self) -> Tick {
        Tick(self.now_ms as u32)
    }

    pub fn now(&self) -> Tick {
        Tick(self.start).after(self.now_ms as u32)
    }

    pub fn run(&mut self, milliseconds: u32) {
        for _ in 0..milliseconds {
            self.pass();
        }
    }

    /// Passes until `condition` holds; milliseconds it took.
    pub fn run_until(&mut self, limit_ms: u32, condition: impl Fn(&Self) -> bool) -> u32 {
        for passed in 0..=limit_ms {
            if condition(self) {
                return passed;
            }
            self.pass();
        }
        panic!(
            "not within {limit_ms} ms; inhibits {:?}, edges {:?}",
            self.names(),
            self.edges
        );
    }

    fn pass(&mut self) {
        self.now_ms += 1;
        if self.now_ms.is_multiple_of(50) && !self.host_dead && self.host.is_open() {
            for command in self.repeated.clone() {
                self.send(command);
            }
        }
        self.turn_wheels();
        self.cord.board_mut().clock.0 = self.now().0;
        self.cord.step();
        self.check_gate();
        if let Some(judge) = &mut self.judge {
            judge.look(self.cord.board(), self.rims);
        }
        self.serve_host();
    }

    /// What cordlib's own permit says holds in every pass. Whether the permit is right is the judge's question.
    fn check_gate(&self) {
        let board = self.cord.board();
        let (left, right) = (
            board.wheels.left.duty().millionths(),
            board.wheels.right.duty().millionths(),
        );
        let permit = self.cord.motion_permit();
        if left != 0 || right != 0 {
            assert!(
                permit.armed && permit.fresh,
                "unarmed or stale motion at {:?}",
                self.now()
            );
            let mut hard = permit.inhibits;
            for telling in [
                Inhibit::BatteryLow,
                Inhibit::BatteryWeak,
                Inhibit::ChargerFault,
                Inhibit::ChargerShorted,
            ] {
                hard.remove(telling);
            }
            let standing_against = hard;
            for soft in [Inhibit::Bumper, Inhibit::Cliff, Inhibit::CliffSensorFault] {
                hard.remove(soft);
            }
            assert!(hard.is_empty(), "moves in spite of {:?}", self.names());
            assert!(
                hard == standing_against || left + right <= 0,
                "moves forward in spite of {:?}",
                self.names()
            );
        }
        let cleaners = [&board.brush_main, &board.brush_sides, &board.vacuum];
        if cleaners.iter().any(|brush| brush.duty != Throttle::ZERO) {
            assert!(permit.armed, "unarmed brush");
            for inhibit in [
                Inhibit::WheelDrop,
                Inhibit::Stopped,
                Inhibit::ButtonStop,
                Inhibit::Docked,
            ] {
                assert!(
                    !permit.inhibits.contains(inhibit),
                    "brush in spite of {inhibit:?}"
                );
            }
        }
    }

    fn turn_wheels(&mut self) {
        const FULL_M_PER_S: f64 = 0.48;
        const LAG_MS: f64 = 60.0;
        const DEAD_BAND: f64 = 0.12;
        let board = self.cord.board_mut();
        let duties = [board.wheels.left, board.wheels.right];
        for (side, drive) in duties.into_iter().enumerate() {
            let duty = match (side, self.mechanics.stuck_duty) {
                (0, Some(stuck)) => f64::from(stuck) / 1e6,
                _ => drive.duty().as_f64(),
            };
            let beyond = (duty.abs() - DEAD_BAND).max(0.0) / (1.0 - DEAD_BAND);
            let target = beyond * duty.signum() * FULL_M_PER_S;
            self.rims[side] += (target - self.rims[side]) / LAG_MS;
            if self.mechanics.blocked[side] {
                self.rims[side] = 0.0;
            }
            self.distances[side] += self.rims[side] / 1_000.0;
        }
        if !self.mechanics.silent {
            let sign = if self.mechanics.swapped { -1.0 } else { 1.0 };
            let counts = self
                .distances
                .map(|way| (sign * way * 1e9 / f64::from(LIMITS.count_nm)).floor() as i32);
            (board.encoders.0.left, board.encoders.0.right) = (counts[0], counts[1]);
        }
    }

    fn serve_host(&mut self) {
        let now = self.host_now();
        let bytes = std::mem::take(&mut self.cord.board_mut().link.to_host);
        if let Some(judge) = &mut self.judge {
            judge.overhear(&bytes);
        }
        let mut events: Vec<HostEvent> = bytes
            .into_iter()
            .filter_map(|byte| self.host.receive(byte, now))
            .collect();
        while let Some(event) = self.host.poll(now) {
            events.push(event);
        }
        let mut packet = PacketBuffer::new();
        while self.host.next_packet(&mut packet) {
            self.deliver(packet.as_bytes());
        }
        for event in events {
            match event {
                HostEvent::Report(Report::Event(edge)) => self.edges.push(edge.kind),
                HostEvent::Report(report) => self.reports.push(report),
                HostEvent::Described(table) => self.described = Some(table),
                HostEvent::Answered {
                    refusal: Some(refusal),
                    ..
                } => self.refusals.push(refusal),
                HostEvent::Answered { refusal: None, .. } => self.answered += 1,
                _ => {}
            }
        }
    }

    /// Gives the gyro what the ideal body does.
    pub fn follow_gyro(&mut self) {
        let heading = (self.distances[1] - self.distances[0]) / LIMITS.track.as_m();
        self.cord.board_mut().gyro.0 = Some(Gyro {
            heading: Angle::from_rad(heading),
            rate: AngularSpeed::ZERO,
        });
    }

    pub fn duties(&self) -> (i32, i32) {
        let wheels = &self.cord.board().wheels;
        (wheels.left.duty().millionths(), wheels.right.duty().millionths())
    }

    pub fn wheels_off(&self) -> bool {
        self.duties() == (0, 0)
    }

    pub fn cleaners_off(&self) -> bool {
        let board = self.cord.board();
        [&board.brush_main, &board.brush_sides, &board.vacuum]
            .iter()
            .all(|motor| motor.duty == Throttle::ZERO)
    }

    pub fn has(&self, inhibit: Inhibit) -> bool {
        self.cord.inhibits().contains(inhibit)
    }

    pub fn names(&self) -> Vec<&'static str> {
        self.cord.inhibits().iter().map(Inhibit::name).collect()
    }

    pub fn last_state(&self) -> State {
        self.reports
            .iter()
            .rev()
            .find_map(|report| match report {
                Report::State(state) => Some(*state),
                _ => None,
            })
            .expect("a state report")
    }

    pub fn move_ends(&self) -> Vec<MoveEnd> {
        self.edges
            .iter()
            .filter_map(|edge| match edge {
                Event::MoveFinished(end) => Some(*end),
                _ => None,
            })
            .collect()
    }

    pub fn inhibit_edges(&self) -> Vec<Inhibits> {
        self.edges
            .iter()
            .filter_map(|edge| match edge {
                Event::Inhibits(set) => Some(*set),
                _ => None,
            })
            .collect()
    }
}

pub fn drive(speed_m_per_s: f64, turn_rad_per_s: f64) -> Command {
    Command::Drive(Drive {
        speed: Speed::from_m_per_s(speed_m_per_s),
        turn: AngularSpeed::from_rad_per_s(turn_rad_per_s),
        lease_ms: 250,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    })
}

pub fn motor(motor: Motor, throttle: f64) -> Command {
    Command::Motor(MotorCommand {
        motor,
        throttle: Throttle::from_millionths((throttle * 1e6) as i32).expect("a throttle"),
        lease_ms: 250,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    })
}

pub fn movement(length_m: f64, radius_m: Option<f64>) -> Command {
    Command::Move(Move {
        length: Length::from_m(length_m),
        radius: radius_m.map(Length::from_m),
        sequence: Sequence(0),
        seen_tick: Tick(0),
    })
}

pub fn arm(undock: bool) -> Command {
    Command::Arm {
        sequence: Sequence(0),
        undock,
    }
}

pub fn clear(inhibit: Inhibit) -> Command {
    Command::Clear {
        sequence: Sequence(0),
        inhibit,
    }
}

/// Two hundred runs, each with the fault at another phase of the loop, the lease and the self-test, and another start of
/// the clock, some of them around its wrap. Asserts the limit, prints the worst reaction for `cargo xtask bench safety --write`
/// and returns it in ms.
pub fn worst_reaction(
    limit: Limit,
    prepare: impl Fn(u32) -> Rig,
    fault: impl Fn(&mut Rig),
    reacted: impl Fn(&Rig) -> bool,
) -> u32 {
    let mut phases = Phases(0x5EED);
    let mut worst_ms = 0;
    for run in 0..200 {
        let start = if run % 2 == 0 {
            u32::MAX - phases.below(3_000)
        } else {
            phases.below(u32::MAX)
        };
        let mut rig = prepare(start);
        rig.run(phases.below(1_000));
        fault(&mut rig);
        worst_ms = worst_ms.max(rig.run_until(limit.ms + 1, &reacted));
    }
    keep(limit, worst_ms);
    worst_ms
}

/// Prints a worst figure and asserts its limit.
pub fn keep(limit: Limit, worst_ms: u32) {
    let said = format!("worst {} {worst_ms} ms, limit {} ms", limit.name, limit.ms);
    println!("{said}");
    assert!(worst_ms <= limit.ms, "{said}");
}
