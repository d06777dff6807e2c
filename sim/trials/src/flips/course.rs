//! A stretch of a robot's life without any fault, to compare with those in which a bit has flipped.

use std::collections::HashMap;

use monitor::Bridges;
use pic32::board::{CYCLES_PER_MS, Contact, EmulatedRobot, Hold};
use pic32::machine::{Machine, Touch};
use rvac_protocol::message::{Command, Inhibits};
use rvac_units::{AngularSpeed, Speed, Throttle};
use serde::Serialize;

use crate::stage::{Stage, StageError, Workshop};
use crate::trial::Scene;

use super::place::{Place, Storage};

/// Bits flip within so many milliseconds.
pub(super) const FLIP_MS: usize = 250;
/// Then something happens after which all motors, or the charger, must be off, or may not start; and this long the judge
/// looks on: longer than the watchdog's 256 ms and every reaction to what happens.
const LOOK_MS: usize = 450;
pub(super) const WHOLE_MS: usize = FLIP_MS + LOOK_MS;
/// A charger begins within this time on the dock.
const CHARGE_BEGINS_MS: u64 = 60_000;
/// Current that tells that it has begun, ampere.
const CHARGING_A: f64 = 0.3;

/// What the robot does when bits flip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Situation {
    /// It stands, not armed.
    Idle,
    /// It stands, armed.
    Standing,
    /// It drives.
    Driving,
    /// It drives with brushes and suction.
    Cleaning,
    /// It charges.
    Charging,
}

impl Situation {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Driving,
        Self::Charging,
        Self::Cleaning,
        Self::Standing,
        Self::Idle,
    ];

    /// A name for tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Standing => "standing, armed",
            Self::Driving => "driving",
            Self::Cleaning => "cleaning",
            Self::Charging => "charging",
        }
    }

    fn set(self, workshop: &Workshop, seed: u64, late_cycles: u64) -> Result<Stage, StageError> {
        match self {
            Self::Standing => Scene::Standing.set(workshop, seed, late_cycles),
            Self::Driving => Scene::Driving.set(workshop, seed, late_cycles),
            Self::Cleaning => Scene::Cleaning.set(workshop, seed, late_cycles),
            Self::Idle => {
                let mut stage = workshop.stage(seed, Bridges::Sound, late_cycles);
                stage.connect()?;
                stage.run(200);
                Ok(stage)
            }
            Self::Charging => charging(workshop, seed, late_cycles),
        }
    }

    /// What happens after the flip; `number` chooses.
    fn provoke(self, stage: &mut Stage, number: usize) {
        let now = stage.robot().cycle();
        let wheel_hangs = |stage: &mut Stage| {
            stage
                .robot_mut()
                .hold_contact(Contact::WheelDropLeft, Hold::On, now);
        };
        let wants_to_drive = |stage: &mut Stage| {
            stage.drive(Some((Speed(150_000), AngularSpeed(0))));
            stage.clean(Throttle::saturating_from_millionths(800_000));
        };
        match (self, number % 4) {
            (Self::Idle, _) => wants_to_drive(stage),
            (Self::Standing, _) => {
                wheel_hangs(stage);
                wants_to_drive(stage);
            }
            (Self::Driving | Self::Cleaning, 0) => wheel_hangs(stage),
            (Self::Driving | Self::Cleaning, 1) => {
                stage.drive(None);
                stage.clean(Throttle::ZERO);
                stage.say(Command::Stop);
            }
            (Self::Driving | Self::Cleaning, 2) => {
                stage.robot_mut().hold_contact(Contact::BumperLeft, Hold::On, now);
            }
            (Self::Driving | Self::Cleaning, _) => stage.set_speaking(false),
            (Self::Charging, 0 | 2) => stage.robot_mut().world_mut().lift(),
            (Self::Charging, _) => wants_to_drive(stage),
        }
    }
}

/// On the dock with a pack that is neither full nor empty.
fn charging(workshop: &Workshop, seed: u64, late_cycles: u64) -> Result<Stage, StageError> {
    let mut stage = workshop.stage(seed, Bridges::Sound, late_cycles);
    let world = stage.robot_mut().world_mut();
    let dock = world.home().start();
    world.put_down_at(dock);
    world.set_battery_charge(0.4);
    stage.connect()?;
    for _ in 0..CHARGE_BEGINS_MS {
        stage.tick();
        if stage.robot().world().truth().battery_a > CHARGING_A {
            // Until the current has settled.
            stage.run(1_000);
            return Ok(stage);
        }
    }
    Err(StageError::Scene("it does not charge"))
}

/// Everything that decides how a robot goes on, as far as it can be seen from outside.
#[derive(Clone, Debug)]
struct Look {
    ram: Vec<u8>,
    core: [u32; 35],
    chip: Vec<u32>,
    cycle: u64,
    digest: u64,
    wheels: [f64; 2],
}

impl Look {
    fn of(robot: &mut EmulatedRobot, registers: &[u32]) -> Self {
        let machine = robot.machine_mut();
        let chip = registers
            .iter()
            .map(|address| machine.peek_register(*address).unwrap_or_default());
        Self {
            chip: chip.collect(),
            ram: machine.memory().ram().to_vec(),
            core: core_of(machine),
            cycle: machine.cpu().cycle(),
            digest: robot.state_hash(),
            wheels: robot.world().encoder_positions(),
        }
    }

    /// Whether this robot goes on as the one that was looked at.
    fn is_met_by(&self, robot: &mut EmulatedRobot, registers: &[u32]) -> bool {
        let machine = robot.machine();
        machine.memory().ram().as_slice() == self.ram
            && machine.cpu().cycle() == self.cycle
            && core_of(machine) == self.core
            && robot.state_hash() == self.digest
            && robot.world().encoder_positions() == self.wheels
            && registers
                .iter()
                .zip(&self.chip)
                .all(|(address, value)| robot.machine_mut().peek_register(*address) == Some(*value))
    }
}

fn core_of(machine: &Machine) -> [u32; 35] {
    let core = machine.cpu();
    let (high, low) = core.product();
    let mut registers = [0; 35];
    for (number, register) in (0..32).zip(&mut registers) {
        *register = core.register(number);
    }
    [registers[32], registers[33], registers[34]] = [high, low, core.pc()];
    registers
}

/// What a flip comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// The word is not touched in the time that is looked at. Flipped flash is found by the check of the image.
    Untouched,
    /// The word is written before anybody reads it.
    Overwritten,
    /// It was read and changed nothing that can be seen outside, or the robot was soon as if nothing had happened.
    Masked,
    /// A reset, an exception or a named inhibit.
    Detected,
    /// The robot did something else than without the flip, within the rules.
    Lawful,
    /// Against the rules, but ended within the watchdog's time.
    Ended,
    /// Against the rules for longer than the watchdog allows.
    Unsafe,
}

impl Fate {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Untouched,
        Self::Overwritten,
        Self::Masked,
        Self::Detected,
        Self::Lawful,
        Self::Ended,
        Self::Unsafe,
    ];
}

/// What was seen of a flip that was tried.
#[derive(Clone, Debug)]
pub(super) struct Trace {
    /// What it came to.
    pub(super) fate: Fate,
    /// Longest time that a rule was broken without a gap, ms.
    pub(super) broken_ms: u32,
    /// The first breach.
    pub(super) breach: Option<String>,
}

/// A stretch of life without fault.
#[derive(Debug)]
pub(super) struct Course {
    /// What the robot does in it.
    pub(super) situation: Situation,
    number: usize,
    registers: Vec<u32>,
    /// At the beginning of each millisecond in which a bit may flip.
    stages: Vec<Stage>,
    /// At the end of each millisecond.
    looks: Vec<Look>,
    /// Milliseconds in which a word was touched, and how first.
    touches: HashMap<u32, Vec<(usize, Touch)>>,
    /// Everything that the robot ever gave as a reason.
    inhibits: Vec<Inhibits>,
}

/// The watchdog's time, ms, with a millisecond at either end.
const WATCHDOG_MS: u32 = 258;

impl Course {
    /// Lives it. `registers` are those of the chip that are compared.
    ///
    /// # Errors
    /// When the robot does not get into the situation, or breaks a rule without any fault.
    pub(super) fn live(
        workshop: &Workshop,
        situation: Situation,
        number: usize,
        places: impl FnOnce(&mut Machine) -> Vec<u32>,
    ) -> Result<Self, StageError> {
        // Any other phase between core and surroundings for each course.
        let late_cycles = (number as u64 * 29_741 + 1_013) % CYCLES_PER_MS;
        let mut stage = situation.set(workshop, number as u64 + 1, late_cycles)?;
        let registers = places(stage.robot_mut().machine_mut());
        let mut course = Self {
            situation,
            number,
            registers,
            stages: Vec::new(),
            looks: Vec::new(),
            touches: HashMap::new(),
            inhibits: Vec::new(),
        };
        for ms in 0..WHOLE_MS {
            if ms < FLIP_MS {
                course.stages.push(stage.clone());
            }
            // A core that is followed instruction by instruction may be some cycles late, so it begins anew each time.
            let mut noted = stage.clone();
            noted.robot_mut().machine_mut().note_touches();
            course.pass(&mut noted, ms);
            course.pass(&mut stage, ms);
            for (address, touch) in noted.robot_mut().machine_mut().take_touches() {
                course.touches.entry(address).or_default().push((ms, touch));
            }
            course.looks.push(Look::of(stage.robot_mut(), &course.registers));
            if course.inhibits.last() != Some(&stage.inhibits()) {
                course.inhibits.push(stage.inhibits());
            }
        }
        if stage.robot().monitor().count() != 0 {
            return Err(StageError::Scene("it breaks a rule without any fault"));
        }
        Ok(course)
    }

    /// Its number among those of its situation.
    #[must_use]
    pub(super) const fn number(&self) -> usize {
        self.number
    }

    /// The robot at the beginning.
    #[must_use]
    pub(super) fn first(&self) -> Option<Stage> {
        self.stages.first().cloned()
    }

    fn pass(&self, stage: &mut Stage, ms: usize) {
        if ms == FLIP_MS {
            self.situation.provoke(stage, self.number);
        }
        stage.tick();
    }

    /// What a flip at this millisecond surely comes to without trying it.
    #[must_use]
    pub(super) fn foreseen(&self, place: Place, at_ms: usize) -> Option<Fate> {
        match place.storage {
            Storage::Core | Storage::Chip => None,
            // The first instructions of handlers are not seen, and configuration words act without being read.
            Storage::Flash if place.address < 0x1D00_1000 || place.address >= 0x1FC0_2FF0 => None,
            Storage::Ram | Storage::Flash => {
                let touches = self.touches.get(&place.address);
                let next = touches.and_then(|all| all.iter().find(|(ms, _)| *ms >= at_ms));
                match next {
                    None => Some(Fate::Untouched),
                    Some((_, Touch::Written)) => Some(Fate::Overwritten),
                    Some((_, Touch::Read)) => None,
                }
            }
        }
    }

    /// Flips the bit at this millisecond and looks what comes of it.
    #[must_use]
    pub(super) fn try_out(&self, place: Place, at_ms: usize) -> Trace {
        let Some(mut stage) = self.stages.get(at_ms).cloned() else {
            return Trace::of(Fate::Untouched);
        };
        let before = stage.robot().machine().exception_count();
        let resets = stage.robot().machine().reset_count();
        place.flip(stage.robot_mut().machine_mut());
        let (mut broken_ms, mut longest_ms) = (0, 0);
        let mut is_detected = false;
        for ms in at_ms..WHOLE_MS {
            self.pass(&mut stage, ms);
            let is_broken = stage.robot().monitor().is_broken();
            broken_ms = if is_broken { broken_ms + 1 } else { 0 };
            longest_ms = longest_ms.max(broken_ms);
            is_detected |= self.gives_another_reason(&stage);
            if self.is_as_before(place, ms, &mut stage) {
                break;
            }
        }
        let robot = stage.robot();
        is_detected |= robot.machine().exception_count() != before || robot.machine().reset_count() != resets;
        let same = self
            .looks
            .last()
            .is_some_and(|look| robot.state_hash() == look.digest);
        let fate = match longest_ms {
            0 if is_detected => Fate::Detected,
            0 if same || robot.now_ms() < self.end_ms() => Fate::Masked,
            0 => Fate::Lawful,
            1..=WATCHDOG_MS => Fate::Ended,
            _ => Fate::Unsafe,
        };
        Trace {
            fate,
            broken_ms: longest_ms,
            breach: robot.monitor().violations().first().map(ToString::to_string),
        }
    }

    fn end_ms(&self) -> u64 {
        self.stages
            .first()
            .map_or(0, |stage| stage.robot().now_ms() + WHOLE_MS as u64)
    }

    fn gives_another_reason(&self, stage: &Stage) -> bool {
        stage
            .inhibits()
            .iter()
            .any(|inhibit| !self.inhibits.iter().any(|known| known.contains(inhibit)))
    }

    /// Whether the robot is as if the bit had not flipped, and will not come across it again.
    fn is_as_before(&self, place: Place, ms: usize, stage: &mut Stage) -> bool {
        let last_read = match place.storage {
            Storage::Flash => self.touches.get(&place.address).and_then(|all| all.last()),
            Storage::Ram | Storage::Core | Storage::Chip => None,
        };
        let is_over = place.storage != Storage::Flash || last_read.is_some_and(|(last, _)| *last <= ms);
        is_over
            && self
                .looks
                .get(ms)
                .is_some_and(|look| look.is_met_by(stage.robot_mut(), &self.registers))
    }
}

impl Trace {
    const fn of(fate: Fate) -> Self {
        Self {
            fate,
            broken_ms: 0,
            breach: None,
        }
    }
}
