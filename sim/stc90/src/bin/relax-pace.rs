//! How the Relax's firmware keeps up: `relax-pace FILE.ihx LOOP [--seconds N] [--full]`, LOOP being the hexadecimal address of the
//! function that is one pass of the main loop.
//!
//! A host connects over the serial line, arms, drives the robot to and fro and lets it clean, for so many simulated seconds.
//! Prints one JSON object: passes a second at rest and while driving, the deepest stack, bytes lost, telemetry.
//!
//! With `--full` the host fills its line, so that both ways are busy all the time.
//!
//! With `--corrupted N` (and `--seed`) the host sends so many damaged packets of motion instead, after it has armed, and none that is sound:
//! each millisecond in which a motor is on is a wrong actuation. A sound one at the end shows that the robot was ready all along.

use home::Pcg;
use rvac_protocol::message::{BinaryKinds, Command, Drive, Motor, MotorCommand, Sequence};
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};
use stc90::board::Motor as RelaxMotor;
use stc90::hosted::{HostedBlueprint, HostedRelax};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// The check of the flash at the start takes no longer.
const START_MS: u64 = 1_000;
/// Milliseconds before anybody speaks.
const REST_MS: u64 = 1_000;
/// A drive and the motors are renewed so often: as vthal does it.
const DRIVE_MS: u64 = 20;
const CLEAN_MS: u64 = 300;
/// Ahead and back again.
const LEG_MS: u64 = 1_500;
const SECONDS: u64 = 20;
/// What the first motion takes at most.
const FIRST_MS: u64 = 200;
/// And what a full line holds.
const LINE_MS: u64 = 1_200;
/// The host holds so many bytes before the next damaged packet: the line stays busy, and answers in time.
const WAITING_MOST: usize = 200;
/// With so many bytes before it a full line has no pause.
const LINE_LEAST: usize = 8;
/// Flipped bits of a damaged packet, at most.
const FLIPS_MOST: u32 = 8;
const SEED: u64 = 33;
const STREAM: u64 = 0x0BAD;

/// How long a count stood still at most.
struct Gap {
    last: u64,
    waited_ms: u64,
    longest_ms: u64,
}

impl Gap {
    const fn new(count: u64) -> Self {
        Self {
            last: count,
            waited_ms: 0,
            longest_ms: 0,
        }
    }

    /// To be called each millisecond.
    fn look(&mut self, count: u64) {
        self.waited_ms += 1;
        self.longest_ms = self.longest_ms.max(self.waited_ms);
        if count != self.last {
            self.waited_ms = 0;
        }
        self.last = count;
    }
}

/// What is asked for.
struct Wanted {
    file: String,
    pass: u16,
    seconds: u64,
    corrupted: u64,
    /// Of the damage.
    seed: u64,
    /// The host leaves no pause on the line.
    is_full: bool,
}

fn main() -> Outcome<()> {
    let wanted = wanted()?;
    let blueprint = HostedBlueprint::from_hex(&std::fs::read_to_string(&wanted.file)?)?;
    let kinds = BinaryKinds {
        state: true,
        drive: true,
    };
    let mut pair = blueprint.robot(kinds);
    pair.set_speaking(false);
    pair.run(START_MS);
    let idle_hz = rest(&mut pair, wanted.pass);
    pair.set_speaking(true);
    pair.connect()?;
    pair.arm()?;
    if wanted.corrupted > 0 {
        return corrupt(&mut pair, (wanted.corrupted, wanted.seed));
    }
    let (states, passes) = (pair.states(), pair.robot().machine().cpu().passes());
    let (mut pass_gap, mut state_gap) = (Gap::new(passes), Gap::new(states));
    for _ in 0..wanted.seconds * 1_000 {
        command(&mut pair);
        if wanted.is_full && pair.waiting() + pair.robot().line_waiting() < LINE_LEAST {
            pair.say(ahead(0.15));
        }
        pair.tick();
        pass_gap.look(pair.robot().machine().cpu().passes());
        state_gap.look(pair.states());
    }
    let per_s = |count: u64| count as f64 / wanted.seconds.max(1) as f64;
    let machine = pair.robot().machine();
    println!(
        "{{\"seconds\": {}, \"main_loop_idle_hz\": {idle_hz:.0}, \"main_loop_driving_hz\": {:.0}, \"stack_to\": {}, \
         \"bytes_overrun\": {}, \"host_bad_packets\": {}, \
         \"robot_lost\": {}, \"longest_pass_ms\": {}, \"longest_state_gap_ms\": {}, \"states_per_s\": {:.1}, \"refused\": {}, \"resets\": {}, \
         \"violations\": {}, \"bridge_shorts\": {}, \"misuses\": {}, \"is_armed\": {}}}",
        wanted.seconds,
        per_s(machine.cpu().passes() - passes),
        machine.cpu().sp_max(),
        machine.overruns(),
        pair.bad_packets(),
        pair.lost_by_robot(),
        pass_gap.longest_ms,
        state_gap.longest_ms,
        per_s(pair.states() - states),
        pair.refusals().len(),
        pair.robot().resets(),
        pair.robot().monitor().count(),
        pair.robot().short_cycles(),
        machine.misuses().len(),
        pair.is_connected()
    );
    Ok(())
}

fn wanted() -> Outcome<Wanted> {
    let mut words = std::env::args().skip(1);
    let file = words.next().ok_or("name the HEX file of the firmware")?;
    let pass = words.next().ok_or("name the address of the main loop")?;
    let mut wanted = Wanted {
        file,
        pass: u16::from_str_radix(&pass, 16)?,
        seconds: SECONDS,
        corrupted: 0,
        seed: SEED,
        is_full: false,
    };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--seconds" => wanted.seconds = words.next().ok_or("how many seconds?")?.parse()?,
            "--corrupted" => wanted.corrupted = words.next().ok_or("how many packets?")?.parse()?,
            "--seed" => wanted.seed = words.next().ok_or("which seed?")?.parse()?,
            "--full" => wanted.is_full = true,
            other => return Err(format!("{other} is unknown").into()),
        }
    }
    Ok(wanted)
}

/// Passes a second with nobody at the other end.
fn rest(pair: &mut HostedRelax, pass: u16) -> f64 {
    pair.robot_mut().machine_mut().cpu_mut().count_passes(pass);
    pair.run(REST_MS);
    pair.robot().machine().cpu().passes() as f64 * 1e3 / REST_MS as f64
}

/// What a host that cleans says in this millisecond.
fn command(pair: &mut HostedRelax) {
    let ms = pair.robot().now_ms();
    if ms.is_multiple_of(DRIVE_MS) {
        let is_back = ms / LEG_MS % 2 == 1;
        pair.say(ahead(if is_back { -0.15 } else { 0.15 }));
    }
    if ms.is_multiple_of(CLEAN_MS) {
        for motor in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
            pair.say(clean(motor));
        }
    }
}

/// Sends damaged packets of motion to an armed robot, and at the end a sound one.
fn corrupt(pair: &mut HostedRelax, (packets, seed): (u64, u64)) -> Outcome<()> {
    let mut random = Pcg::new(seed, STREAM);
    let (mut wrong_ms, mut sent) = (0_u64, 0);
    while sent < packets {
        // What the host's session sends by itself goes out in between, and sound.
        if pair.waiting() < WAITING_MOST {
            let packet = damaged(pair, &mut random);
            pair.send(&packet);
            sent += 1;
        }
        pair.tick();
        wrong_ms += u64::from(is_moved(pair));
    }
    for _ in 0..LINE_MS {
        pair.tick();
        wrong_ms += u64::from(is_moved(pair));
    }
    pair.say(ahead(0.1));
    pair.run(FIRST_MS);
    println!(
        "{{\"corrupted\": {packets}, \"wrong_actuation_ms\": {wrong_ms}, \"sound_one_moves\": {}, \"resets\": {}, \
         \"violations\": {}, \"bytes_overrun\": {}}}",
        is_moved(pair),
        pair.robot().resets(),
        pair.robot().monitor().count(),
        pair.robot().machine().overruns()
    );
    match (wrong_ms, is_moved(pair)) {
        (0, true) => Ok(()),
        (0, false) => Err("a sound packet moved nothing".into()),
        _ => Err("a damaged packet moved something".into()),
    }
}

fn is_moved(pair: &HostedRelax) -> bool {
    [
        RelaxMotor::WheelLeft,
        RelaxMotor::WheelRight,
        RelaxMotor::Brush,
        RelaxMotor::Suction,
    ]
    .into_iter()
    .any(|motor| pair.robot().duty(motor) != 0.0)
}

/// A sound packet of motion with one to eight bits flipped, its separators left alone.
fn damaged(pair: &mut HostedRelax, random: &mut Pcg) -> Vec<u8> {
    let command = match random.below(2) {
        0 => ahead(0.15),
        _ => clean(Motor::BrushMain),
    };
    let sound = pair.packet(command);
    let mut packet = sound.clone();
    let last = packet.len().saturating_sub(1) as u32;
    while packet == sound {
        for _ in 0..=random.below(FLIPS_MOST) {
            if let Some(byte) = packet.get_mut(random.below(last) as usize) {
                *byte ^= 1 << random.below(8);
            }
        }
    }
    packet
}

/// The session puts in number and tick.
fn ahead(speed_m_per_s: f64) -> Command {
    Command::Drive(Drive {
        speed: Speed::from_m_per_s(speed_m_per_s),
        turn: AngularSpeed::from_rad_per_s(0.3),
        lease_ms: 250,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    })
}

fn clean(motor: Motor) -> Command {
    Command::Motor(MotorCommand {
        motor,
        throttle: Throttle::FULL,
        lease_ms: 1_000,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    })
}
