//! A reference run of the robot without any fault, for comparison with runs in which a bit has flipped.

use std::collections::HashMap;

use monitor::Bridges;
use pic32::board::{CYCLES_PER_MS, Contact, EmulatedRobot, Hold, MotorOutput};
use pic32::machine::{Machine, Touch};
use rvac_protocol::message::{Command, Inhibits};
use rvac_units::{AngularSpeed, Speed, Throttle};
use serde::Serialize;

use crate::scene::OperatingState;
use crate::testbed::{Fixture, Testbed, TestbedError};

use super::place::{BitLocation, BitStorage};

/// Bits flip within this many milliseconds. Then an event requires all motors or the charger to be off, or not to
/// start.
pub(super) const FLIP_MS: usize = 150;
/// Longest time for which the monitor observes, see [`Situation::look_ms`].
const LOOK_MS_MAX: usize = 450;
/// Observation time of a robot after a reset with correct memory, while everything is off.
const AFTER_RESET_MS: u32 = 60;
/// With a bit of flash still flipped it must have started again, too: 30 ms for the checks of all memories and a
/// hundred for all else; and what happens must have happened.
const AFTER_START_MS: u32 = 130;
/// A charger begins within this time on the dock.
const CHARGE_BEGINS_MS: u64 = 60_000;
/// Current above which it has begun, ampere.
const CHARGING_A: f64 = 0.3;

/// What the robot does when bits flip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Situation {
    /// At rest, not armed.
    Idle,
    /// At rest, armed.
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

    fn set(self, fixture: &Fixture, seed: u64, late_cycles: u64) -> Result<Testbed, TestbedError> {
        match self {
            Self::Standing => OperatingState::Standing.set(fixture, seed, late_cycles),
            Self::Driving => OperatingState::Driving.set(fixture, seed, late_cycles),
            Self::Cleaning => OperatingState::Cleaning.set(fixture, seed, late_cycles),
            Self::Idle => {
                let mut testbed = fixture.testbed(seed, Bridges::Sound, late_cycles)?;
                testbed.connect()?;
                testbed.run(200);
                Ok(testbed)
            }
            Self::Charging => charging(fixture, seed, late_cycles),
        }
    }

    /// Observation time after the event, ms: longer than the watchdog's 256 ms and the reaction to the event, as the
    /// monitor counts it.
    const fn look_ms(self, number: usize) -> usize {
        match (self, number % 4) {
            (Self::Driving | Self::Cleaning, 3) => LOOK_MS_MAX,
            (Self::Charging, _) => 380,
            _ => 330,
        }
    }

    /// The event after the flip, chosen by `number`.
    fn provoke(self, testbed: &mut Testbed, number: usize) {
        let now = testbed.robot().cycle();
        let wheel_hangs = |testbed: &mut Testbed| {
            testbed
                .robot_mut()
                .hold_contact(Contact::WheelDropLeft, Hold::On, now);
        };
        let wants_to_drive = |testbed: &mut Testbed| {
            testbed.drive(Some((Speed(150_000), AngularSpeed(0))));
            testbed.clean(Throttle::saturating_from_millionths(800_000));
        };
        match (self, number % 4) {
            (Self::Idle, _) => wants_to_drive(testbed),
            (Self::Standing, _) => {
                wheel_hangs(testbed);
                wants_to_drive(testbed);
            }
            (Self::Driving | Self::Cleaning, 0) => wheel_hangs(testbed),
            (Self::Driving | Self::Cleaning, 1) => {
                testbed.drive(None);
                testbed.clean(Throttle::ZERO);
                testbed.say(Command::Stop);
            }
            (Self::Driving | Self::Cleaning, 2) => {
                testbed
                    .robot_mut()
                    .hold_contact(Contact::BumperLeft, Hold::On, now);
            }
            (Self::Driving | Self::Cleaning, _) => testbed.set_speaking(false),
            (Self::Charging, 0 | 2) => testbed.robot_mut().world_mut().lift(),
            (Self::Charging, _) => wants_to_drive(testbed),
        }
    }
}

/// On the dock with a pack that is neither full nor empty.
fn charging(fixture: &Fixture, seed: u64, late_cycles: u64) -> Result<Testbed, TestbedError> {
    let mut testbed = fixture.testbed(seed, Bridges::Sound, late_cycles)?;
    let world = testbed.robot_mut().world_mut();
    let dock = world.home().start();
    world.put_down_at(dock);
    world.set_battery_charge(0.4);
    testbed.connect()?;
    for _ in 0..CHARGE_BEGINS_MS {
        testbed.tick();
        if testbed.robot().world().truth().battery_a > CHARGING_A {
            // Until the current has settled.
            testbed.run(1_000);
            return Ok(testbed);
        }
    }
    Err(TestbedError::OperatingState("it does not charge"))
}

/// The whole state of a robot, as far as it can be read from outside.
#[derive(Clone, Debug)]
struct Snapshot {
    ram: Vec<u8>,
    core: [u32; 35],
    chip: Vec<u32>,
    cycle: u64,
    digest: u64,
    wheels: [f64; 2],
}

impl Snapshot {
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

    /// Whether this robot will continue like the one of the snapshot, whose program reads the `live` bytes of RAM
    /// before it writes them.
    fn is_met_by(&self, robot: &mut EmulatedRobot, registers: &[u32], live: impl Fn(u32) -> bool) -> bool {
        let machine = robot.machine();
        machine.cpu().cycle() == self.cycle
            && core_of(machine) == self.core
            && robot.state_hash() == self.digest
            && robot.world().encoder_positions() == self.wheels
            && !differences(machine.memory().ram().as_slice(), &self.ram).any(live)
            && registers
                .iter()
                .zip(&self.chip)
                .all(|(address, value)| robot.machine_mut().peek_register(*address) == Some(*value))
    }
}

/// Addresses of bytes that differ.
fn differences<'a>(mine: &'a [u8], theirs: &'a [u8]) -> impl Iterator<Item = u32> + 'a {
    const PART: usize = 64;
    let parts = mine.chunks(PART).zip(theirs.chunks(PART)).enumerate();
    parts
        .filter(|(_, (mine, theirs))| mine != theirs)
        .flat_map(|(number, (mine, theirs))| {
            let bytes = mine.iter().zip(theirs).enumerate();
            bytes
                .filter(|(_, (mine, theirs))| mine != theirs)
                // Addresses of RAM fit.
                .map(move |(byte, _)| (number * PART + byte) as u32)
        })
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

/// Result of a flip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// The word is not accessed in the observed time. Flipped flash is found by the check of the image.
    Untouched,
    /// The word is written before it is read.
    Overwritten,
    /// It was read without a visible effect, or the robot soon was in its reference state again.
    Masked,
    /// A reset, an exception or a named inhibit.
    Detected,
    /// The robot behaved differently than without the flip, within the rules.
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

/// Observation of a flip that was tried.
#[derive(Clone, Debug)]
pub(super) struct FlipTrace {
    /// Its result.
    pub(super) fate: Fate,
    /// Longest time that a rule was broken without a gap, ms.
    pub(super) broken_ms: u32,
    /// The first breach.
    pub(super) breach: Option<String>,
}

/// A reference run without fault.
#[derive(Debug)]
pub(super) struct Course {
    /// Activity of the robot.
    pub(super) situation: Situation,
    number: usize,
    registers: Vec<u32>,
    /// At the beginning of each millisecond in which a bit may flip.
    testbeds: Vec<Testbed>,
    /// At the end of each millisecond.
    looks: Vec<Snapshot>,
    /// Milliseconds in which a word was accessed, and the kind of the first access to its bytes.
    touches: HashMap<u32, Vec<(usize, Touch)>>,
    /// All inhibits that the robot reported.
    inhibits: Vec<Inhibits>,
}

/// The watchdog's time, ms, with a millisecond at either end.
const WATCHDOG_MS: u32 = 258;

impl Course {
    /// Runs it. `registers` are the chip registers that are compared.
    ///
    /// # Errors
    /// When the robot does not get into the situation, or breaks a rule without any fault.
    pub(super) fn live(
        fixture: &Fixture,
        situation: Situation,
        number: usize,
        places: impl FnOnce(&mut Machine) -> Vec<u32>,
    ) -> Result<Self, TestbedError> {
        // Any other phase between core and surroundings for each course.
        let late_cycles = (number as u64 * 29_741 + 1_013) % CYCLES_PER_MS;
        let mut testbed = situation.set(fixture, number as u64 + 1, late_cycles)?;
        let registers = places(testbed.robot_mut().machine_mut());
        let mut course = Self {
            situation,
            number,
            registers,
            testbeds: Vec::new(),
            looks: Vec::new(),
            touches: HashMap::new(),
            inhibits: Vec::new(),
        };
        for ms in 0..course.whole_ms() {
            if ms < FLIP_MS {
                course.testbeds.push(testbed.clone());
            }
            // A core that is followed instruction by instruction may be some cycles late, so it begins anew each time.
            let mut noted = testbed.clone();
            noted.robot_mut().machine_mut().note_touches();
            course.pass(&mut noted, ms);
            course.pass(&mut testbed, ms);
            for (address, touch) in noted.robot_mut().machine_mut().take_touches() {
                course.touches.entry(address).or_default().push((ms, touch));
            }
            course
                .looks
                .push(Snapshot::of(testbed.robot_mut(), &course.registers));
            if course.inhibits.last() != Some(&testbed.inhibits()) {
                course.inhibits.push(testbed.inhibits());
            }
        }
        if testbed.robot().monitor().count() != 0 {
            return Err(TestbedError::OperatingState("it breaks a rule without any fault"));
        }
        Ok(course)
    }

    const fn whole_ms(&self) -> usize {
        FLIP_MS + self.situation.look_ms(self.number)
    }

    /// Its number among those of its situation.
    #[must_use]
    pub(super) const fn number(&self) -> usize {
        self.number
    }

    /// The robot at the beginning.
    #[must_use]
    pub(super) fn first(&self) -> Option<Testbed> {
        self.testbeds.first().cloned()
    }

    fn pass(&self, testbed: &mut Testbed, ms: usize) {
        if ms == FLIP_MS {
            self.situation.provoke(testbed, self.number);
        }
        testbed.tick();
    }

    /// What a flip at this millisecond surely comes to without trying it.
    #[must_use]
    pub(super) fn foreseen(&self, place: BitLocation, at_ms: usize) -> Option<Fate> {
        match place.storage {
            BitStorage::Core | BitStorage::Chip => None,
            // The first instructions of handlers are not seen, and configuration words act without being read.
            BitStorage::Flash if place.address < 0x1D00_1000 || place.address >= 0x1FC0_2FF0 => None,
            BitStorage::Ram | BitStorage::Flash => match self.next_touch(place.byte(), at_ms) {
                Next::Nothing => Some(Fate::Untouched),
                Next::Written => Some(Fate::Overwritten),
                Next::Read => None,
            },
        }
    }

    /// Whether the word is executed.
    #[must_use]
    pub(super) fn executes(&self, place: BitLocation) -> bool {
        let touches = self.touches.get(&place.address);
        touches.is_some_and(|all| all.iter().any(|(_, touch)| touch.executed))
    }

    /// What the program does next to a byte from this millisecond on.
    fn next_touch(&self, address: u32, from_ms: usize) -> Next {
        let bit = 1 << (address & 3);
        let touches = self.touches.get(&(address & !3)).map_or(&[][..], Vec::as_slice);
        let next = touches
            .iter()
            .find(|(ms, touch)| *ms >= from_ms && (touch.read | touch.written) & bit != 0);
        match next {
            None => Next::Nothing,
            Some((_, touch)) if touch.read & bit != 0 => Next::Read,
            Some(_) => Next::Written,
        }
    }

    /// Flips the bit at this millisecond and looks what comes of it.
    #[must_use]
    pub(super) fn try_out(&self, place: BitLocation, at_ms: usize) -> FlipTrace {
        let Some(mut testbed) = self.testbeds.get(at_ms).cloned() else {
            return FlipTrace::of(Fate::Untouched);
        };
        let before = testbed.robot().machine().exception_count();
        let resets = testbed.robot().machine().reset_count();
        place.flip(testbed.robot_mut().machine_mut());
        let (mut broken_ms, mut longest_ms, mut off_ms) = (0, 0, 0);
        let mut is_detected = false;
        for ms in at_ms..self.whole_ms() {
            self.pass(&mut testbed, ms);
            let is_broken = testbed.robot().monitor().is_broken();
            broken_ms = if is_broken { broken_ms + 1 } else { 0 };
            longest_ms = longest_ms.max(broken_ms);
            is_detected |= self.gives_another_reason(&testbed);
            let is_new = testbed.robot().machine().reset_count() != resets;
            off_ms = if is_new && is_off(&testbed) { off_ms + 1 } else { 0 };
            let enough_ms = match place.storage {
                BitStorage::Flash if ms < FLIP_MS => u32::MAX,
                BitStorage::Flash => AFTER_START_MS,
                BitStorage::Ram | BitStorage::Core | BitStorage::Chip => AFTER_RESET_MS,
            };
            if off_ms > enough_ms || self.is_as_before(place, ms, &mut testbed) {
                break;
            }
        }
        let robot = testbed.robot();
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
        FlipTrace {
            fate,
            broken_ms: longest_ms,
            breach: robot.monitor().violations().first().map(ToString::to_string),
        }
    }

    fn end_ms(&self) -> u64 {
        self.testbeds
            .first()
            .map_or(0, |testbed| testbed.robot().now_ms() + self.whole_ms() as u64)
    }

    fn gives_another_reason(&self, testbed: &Testbed) -> bool {
        testbed
            .inhibits()
            .iter()
            .any(|inhibit| !self.inhibits.iter().any(|known| known.contains(inhibit)))
    }

    /// Whether the robot is as if the bit had not flipped, and will not come across it again.
    fn is_as_before(&self, place: BitLocation, ms: usize, testbed: &mut Testbed) -> bool {
        let is_over =
            place.storage != BitStorage::Flash || self.next_touch(place.byte(), ms + 1) == Next::Nothing;
        is_over
            && self.looks.get(ms).is_some_and(|look| {
                let live = |address| self.next_touch(address, ms + 1) == Next::Read;
                look.is_met_by(testbed.robot_mut(), &self.registers, live)
            })
    }
}

/// What a program does next to a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    Nothing,
    Read,
    Written,
}

/// Neither a motor nor the charger is driven.
pub(super) fn is_off(testbed: &Testbed) -> bool {
    let robot = testbed.robot();
    let charges = robot.world().truth().battery_a > 0.0;
    !charges && MotorOutput::ALL.into_iter().all(|motor| robot.duty(motor) == 0.0)
}

impl FlipTrace {
    const fn of(fate: Fate) -> Self {
        Self {
            fate,
            broken_ms: 0,
            breach: None,
        }
    }
}
