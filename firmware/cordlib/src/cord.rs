//! The main loop.

use rvac_protocol::message::{ArmingState, Capabilities, Cliffs, Inhibits, LogLevel, MotionPhase, MoveEnd};
use rvac_protocol::session::RobotSession;
use rvac_units::{Throttle, Tick};

use crate::arming::ArmingFacts;
use crate::board::{
    Board, BumperSwitches, Charger, Clock, CurrentSense, Encoders, HardwareChecks, HardwareFault, Link,
    Parts, Received, ResetRecord, Watchdog, WheelDrive, WheelDropSwitches, WheelMotors,
};
use crate::charge::{ChargeController, ChargeOutput};
use crate::cleaning::{BrushLoad, Cleaning};
use crate::dock_escape::DockEscape;
use crate::fitted::{fitted, gaps};
use crate::floor::FloorWatch;
use crate::identity::identity;
use crate::journal::Journal;
use crate::kept::{CLOCKS_MS, Keeper, KeptRecord};
use crate::lights::LightPatterns;
use crate::motion::{Motion, Period};
use crate::parameters::Parameters;
use crate::permit::{MotionPermit, ReverseBound};
use crate::probing::Probing;
use crate::reflex::Reflexes;
use crate::report::Reporter;
use crate::rules::session::MOVE_SILENCE_MS;
use crate::senses::Senses;
use crate::sound::Sound;
use crate::timing::{HoldTimer, LongClock};
use crate::transmitter::PacketSender;
use crate::watch::{Supervisor, Watch};

/// Most bytes taken from the link in one pass, so that a flood cannot delay the reflexes. At 230,400 baud 23 bytes arrive
/// in a millisecond.
const BYTES_PER_PASS: usize = 64;

/// The firmware of one robot: everything between the board's parts and the wire.
#[derive(Debug)]
pub struct Cord<P: Parts> {
    pub(crate) board: Board<P>,
    pub(crate) parameters: Parameters,
    pub(crate) session: RobotSession,
    pub(crate) reflexes: Reflexes,
    pub(crate) motion: Motion,
    pub(crate) cleaning: Cleaning,
    pub(crate) sound: Sound,
    pub(crate) lights: LightPatterns,
    pub(crate) journal: Journal,
    pub(crate) reporter: Reporter,
    pub(crate) transmitter: PacketSender,
    pub(crate) senses: Senses,
    pub(crate) clock: LongClock,
    pub(crate) heard: Tick,
    pub(crate) fitted: Capabilities,
    pub(crate) charger: ChargeController,
    pub(crate) charge_output: ChargeOutput,
    pub(crate) probing: Probing,
    pub(crate) dock_escape: DockEscape,
    /// How long nothing has moved.
    pub(crate) rest: HoldTimer,
    pub(crate) keeper: Keeper,
    accepted: u32,
    floor: FloorWatch,
    watch: Watch,
    applied: (WheelDrive, WheelDrive),
    /// The outputs are to be written to the board again, changed or not.
    renew: bool,
    /// There was a pass already.
    stepped: bool,
}

impl<P: Parts> Cord<P> {
    /// Takes over the board. All motors are switched off, and motion is inhibited until the host arms (S4).
    #[must_use]
    pub fn new(mut board: Board<P>, mut parameters: Parameters) -> Self {
        board.all_off();
        let now = board.clock.tick();
        let fitted = fitted::<P>(&parameters);
        if !fitted.encoders {
            // Without a calibrated distance per count the encoder counts are meaningless.
            parameters.limits.count_nm = 0;
        }
        let session = RobotSession::new(identity(&mut board, &parameters, fitted), now);
        let floor_level_min = (fitted.cliffs > 0).then_some(parameters.guard.floor_level_min);
        let floor = FloorWatch::new(&mut board.cliffs, now, floor_level_min);
        let kept = KeptRecord::load(&mut board.kept);
        let mut reflexes = Reflexes::new(&mut board.reset, fitted.encoders, now);
        let mut charger = if P::Charger::CHARGES {
            ChargeController::new(parameters.pack)
        } else {
            ChargeController::observing(parameters.pack)
        };
        if let Some(record) = &kept {
            reflexes = reflexes.taking_up(record.latched, record.battery);
            charger = charger.taking_up(&record.charge, CLOCKS_MS);
        }
        reflexes.charger_fault = charger.status().fault;
        let counts = board.encoders.counts();
        Self {
            motion: Motion::new(counts, parameters.limits.count_nm, now),
            cleaning: Cleaning::default(),
            sound: Sound::default(),
            lights: LightPatterns::new(now),
            journal: Journal::of_start(kept.as_ref(), board.reset.cause()),
            reporter: Reporter::new(&reflexes, now),
            transmitter: PacketSender::default(),
            senses: Senses {
                now,
                counts,
                ..Senses::default()
            },
            clock: LongClock::starting_at(now),
            heard: now,
            fitted,
            probing: Probing::starting_at(now),
            dock_escape: DockEscape::starting_at(now),
            charger,
            charge_output: ChargeOutput::default(),
            accepted: 0,
            watch: Watch::starting_at(now),
            applied: (WheelDrive::Brake, WheelDrive::Brake),
            renew: false,
            stepped: false,
            rest: HoldTimer::default(),
            keeper: Keeper::starting_at(now, kept.as_ref()),
            board,
            parameters,
            session,
            reflexes,
            floor,
        }
    }

    /// One pass of the main loop: senses, reflexes, commands, motion, outputs, telemetry, in this order. Call it as often
    /// as the board can, at least every 5 ms for the reaction times of SAFETY.md; a simulator calls it once for each
    /// simulated millisecond.
    ///
    /// Time is counted in milliseconds. A second pass within the same millisecond only reads the link, unless a bumper or a
    /// wheel drop switch has changed: the reflexes react to those without waiting for the next millisecond.
    pub fn step(&mut self) {
        if self.is_within_last_millisecond() {
            let now = self.senses.now;
            self.take_bytes(now);
            self.reporter.count_pass();
            return;
        }
        self.stepped = true;
        self.senses = Senses::read(&mut self.board, &mut self.floor, &self.fitted);
        let now = self.senses.now;
        self.clock.advance(now);
        self.reflexes.age(&mut self.board.reset, now);
        self.check_hardware();
        self.run_reflexes(now);
        self.poll_link(now);
        self.control(now);
        self.power(now);
        self.escape_shorted_dock(now);
        self.apply();
        self.sound.play(&mut self.board.beeper, now);
        self.lights.blink(&mut self.board.lights, now);
        self.report(now);
        self.keep(now);
        if self.watch.is_complete(now) {
            self.board.watchdog.feed();
        }
    }

    /// Says which motors nothing guards against a stall (S11), so that nobody relies on it.
    pub(crate) fn tell_unguarded_motors(&mut self) {
        for (name, is_unguarded) in gaps(&mut self.board, &self.fitted).unguarded.named() {
            if is_unguarded {
                self.journal.note(LogLevel::Info, "no stall detection:", name);
            }
        }
    }

    fn run_reflexes(&mut self, now: Tick) {
        let count_nm = self.parameters.limits.count_nm;
        let ending = self.motion.expire(self.senses.counts, count_nm, now);
        self.end(ending);
        self.cleaning.expire(now);
        let findings = self.reflexes.check_contacts(&self.senses, &self.motion.status());
        self.react(&findings, now);
        let facts = ArmingFacts {
            docked: self.reflexes.dock.is_docked(),
            session: self.session.session(),
        };
        if let Some(event) = self.reflexes.arming.pass(facts, now) {
            self.react_to_time(event);
        }
    }

    fn is_within_last_millisecond(&mut self) -> bool {
        self.stepped
            && self.board.clock.tick() == self.senses.now
            && self.board.bumpers.pressed() == self.senses.bumpers
            && self.board.wheel_drops.hanging() == self.senses.wheel_drops
    }

    /// Reads bytes from the link, executes the commands in them, then lets the session's own timers run.
    fn poll_link(&mut self, now: Tick) {
        self.take_bytes(now);
        if let Some(event) = self.session.poll(now) {
            self.dispatch(&event, now);
        }
    }

    fn take_bytes(&mut self, now: Tick) {
        for _ in 0..BYTES_PER_PASS {
            let event = match self.board.link.receive() {
                None => break,
                Some(Received::Byte(byte)) => {
                    self.reporter.bytes_in.add(1);
                    self.session.receive(byte, now)
                }
                Some(Received::FramingError) => {
                    self.session.framing_error();
                    None
                }
                Some(Received::Overrun) => {
                    self.session.overrun();
                    None
                }
            };
            if let Some(event) = event {
                self.dispatch(&event, now);
            }
        }
    }

    /// One control period of wheels and brushes, when it is due.
    fn control(&mut self, now: Tick) {
        let Some(elapsed_ms) = self.motion.begin_period(&self.parameters, now) else {
            return;
        };
        self.renew = true;
        let status = self.motion.status();
        let stalled = self
            .reflexes
            .judge_wheels(&self.senses, &status, &self.parameters);
        for motor in stalled.into_iter().flatten() {
            self.note_stall(motor);
        }
        self.watch_link(now);
        let current = self
            .senses
            .currents
            .filter(|_| P::Currents::BRUSH_MAIN)
            .map(|all| (all.brush_main, self.parameters.guard.brush_current_max));
        match self.cleaning.control(&mut self.board, current, now) {
            BrushLoad::Free => {}
            BrushLoad::Reversing => self
                .journal
                .note(LogLevel::Warn, "brush main blocked,", "reversing"),
            BrushLoad::Blocked => self.give_up_brush(),
        }
        let period = Period {
            elapsed_ms,
            parameters: &self.parameters,
            gyro: self.senses.gyro,
            permit: self.motion_permit(),
        };
        let ending = self.motion.control(&period);
        self.end(ending);
    }

    /// A `move` has no lease of its own: it ends when the link falls silent.
    fn watch_link(&mut self, now: Tick) {
        let accepted = self.session.counters().accepted;
        if accepted != self.accepted {
            self.accepted = accepted;
            self.heard = now;
        }
        let checked = self.session.mode() == rvac_protocol::session::Mode::Checked;
        if checked && self.motion.is_following() && now.since(self.heard) >= MOVE_SILENCE_MS {
            self.reflexes.arming.lose_link();
        }
    }

    /// Drives the motors. Motion that is no longer permitted is dropped, and [`MotionPermit`] limits the rest.
    fn apply(&mut self) {
        let mut permit = self.motion_permit();
        if !self.motion.suits(&permit, &self.parameters) {
            let ending = self.motion.brake();
            self.end(ending);
            permit = self.motion_permit();
        }
        let (left, right) = self.motion.asked();
        let permitted = permit.restrict(left, right);
        let renew = core::mem::take(&mut self.renew);
        if permitted != (WheelDrive::Brake, WheelDrive::Brake) || self.cleaning.is_running() {
            self.cut_charger();
        }
        if permitted != self.applied || renew {
            self.board.wheels.drive(permitted.0, permitted.1);
            self.applied = permitted;
            self.motion.applied(permitted);
        }
        if renew {
            self.renew_charger();
            self.cleaning.renew(&mut self.board, &permit);
        }
        self.cleaning.apply(&mut self.board, &permit);
        self.watch.check_in(Supervisor::Loop);
    }

    fn report(&mut self, now: Tick) {
        self.queue_events(now);
        self.fill_transmitter(now);
        let sent = self.transmitter.serve(&mut self.board.link);
        self.reporter
            .bytes_out
            .add(u32::try_from(sent).unwrap_or(u32::MAX));
        self.watch.check_in(Supervisor::Comms);
    }

    /// Switches everything off at once and forgets all requests. Reflexes, `stop`, buttons and faults all stop the robot
    /// through this function.
    pub(crate) fn stop_all(&mut self, end: MoveEnd) {
        self.board.motors_off();
        self.applied = (WheelDrive::Brake, WheelDrive::Brake);
        let ending = self.motion.halt(end);
        self.motion.applied(self.applied);
        self.cleaning.stopped();
        self.sound.clear();
        self.end(ending);
    }

    /// The board's own checks found a fault: everything off, and the fault is latched under its name.
    pub fn hardware_fault(&mut self, fault: HardwareFault) {
        self.reflexes.latch(fault.inhibit());
        self.cut_charger();
        self.stop_all(MoveEnd::Inhibited);
        self.keep(self.senses.now);
    }

    /// Latches what stands; once latched it forbids motion and charging, and cannot be cleared meanwhile.
    fn check_hardware(&mut self) {
        for fault in HardwareFault::ALL {
            let is_latched = self.reflexes.latched().contains(fault.inhibit());
            if self.board.checks.stands(fault) && !is_latched {
                self.hardware_fault(fault);
            }
        }
    }

    /// Puts a line into the log that goes to the host.
    pub fn log(&mut self, level: LogLevel, line: &'static str) {
        self.journal.note(level, line, "");
    }

    /// Which motion is allowed now, and what inhibits the rest.
    #[must_use]
    pub fn motion_permit(&self) -> MotionPermit {
        MotionPermit {
            reverse: ReverseBound::of(self.motion.rims_um_per_s(), &self.parameters.wheel),
            ..self.reflexes.motion_permit(self.motion.is_fresh())
        }
    }

    /// Everything that keeps the robot from moving now.
    #[must_use]
    pub fn inhibits(&self) -> Inhibits {
        self.reflexes.inhibits()
    }

    /// Who may move the robot.
    #[must_use]
    pub const fn arming(&self) -> ArmingState {
        self.reflexes.arming.state()
    }

    /// Whether anybody may move the robot.
    #[must_use]
    pub const fn is_armed(&self) -> bool {
        !self.reflexes.arming.is_locked()
    }

    /// Whether a lease (or a `move` with a live link) covers wheel motion now.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        self.motion.is_fresh()
    }

    /// What motion control does.
    #[must_use]
    pub fn phase(&self) -> MotionPhase {
        self.motion.phase()
    }

    /// What was sent to the wheels last.
    #[must_use]
    pub const fn wheel_outputs(&self) -> (Throttle, Throttle) {
        (self.applied.0.duty(), self.applied.1.duty())
    }

    pub(crate) const fn applied_wheels(&self) -> (Throttle, Throttle) {
        self.wheel_outputs()
    }

    /// Cliff sensors that count as seeing no floor.
    #[must_use]
    pub const fn cliffs(&self) -> Cliffs {
        self.reflexes.cliffs()
    }

    /// Seconds since reset. For tests and tools: it is the only floating point in this crate.
    pub fn time_s(&mut self) -> f64 {
        let microseconds = f64::from(self.board.clock.microseconds());
        self.time_ms() as f64 / 1e3 + microseconds / 1e6
    }

    /// Milliseconds since reset, without the wrap of the board's clock.
    pub fn time_ms(&mut self) -> u64 {
        let now = self.board.clock.tick();
        self.clock.advance(now)
    }

    /// The board, for example to see what was written to its parts.
    pub const fn board(&self) -> &Board<P> {
        &self.board
    }

    /// The board, to be changed: a simulator sets readings of the parts between two steps.
    pub const fn board_mut(&mut self) -> &mut Board<P> {
        &mut self.board
    }

    /// The parameters.
    pub const fn parameters(&self) -> &Parameters {
        &self.parameters
    }
}
