//! All trials, rule by rule in the order of SAFETY.md.

use home::{SensorFault, SensorId};
use pic32::board::{Contact, Hold};
use rvac_channel::FaultRates;
use rvac_protocol::message::{Inhibit, ResetCause};
use rvac_units::Throttle;

use crate::stage::Stage;
use crate::trial::{Aim, Scene, Trial};

/// Channels of the converter (pinout.toml).
const PACK: u8 = 3;
const THERMISTOR: u8 = 4;
const CLIFF_RIGHT: u8 = 8;
const CLIFF_MIDDLE: u8 = 10;
const CLIFF_LEFT: u8 = 11;
const CURRENT_LEFT: u8 = 14;
/// Counts of a lit receiver above a drop, and of one that is stuck in the middle of its range.
const DROP: u16 = 30;
const STUCK: u16 = 600;
/// Counts of pack voltages: 0.95, 0.85 and 1.05 V a cell at 32.55 mV a count.
const PACK_WEAK: u16 = 350;
const PACK_EMPTY: u16 = 313;
const PACK_LOW: u16 = 387;
/// Counts of the thermistor: 25 °C, 62 °C, not plugged in, shorted (sr8730: ADC 621 at 60 °C, above 880 open).
const WARM: u16 = 790;
const HOT: u16 = 610;
const HEATING_MS: u64 = 18_500;
const OPEN: u16 = 1_000;
const SHORTED: u16 = 20;
/// A report comes every 20 ms and takes some to cross the line: what the robot says is known so much later.
const REPORT_MS: u64 = 40;

/// INTC and ADC registers that a fault may hit (pic32mx360.md sections 5 and 13): CLR addresses.
const IEC0_CLEAR: u32 = 0xBF88_1064;
const IEC1_CLEAR: u32 = 0xBF88_1074;
const CORE_TIMER_ENABLE: u32 = 1;
const CONVERTER_ENABLE: u32 = 1 << 1;
/// T3CON and its bit TCS, with which the timer counts edges of a pin (pic32mx360.md section 10); LATD and the left wheel's
/// ENABLE. Physical addresses.
const TIMER_3_CONTROL: u32 = 0x1F80_0A00;
const COUNTS_PIN: u32 = 1 << 1;
const LATCH_D: u32 = 0x1F88_60E0;
const LEFT_ENABLE: u32 = 1;
/// Where a runaway program loops: free flash before the calibration page.
const LOOP: u32 = 0x9D03_E000;
const LOOP_PHYSICAL: u32 = 0x1D03_E000;
/// The program memory.
const FLASH: u32 = 0x1D00_0000;
const FLASH_BYTES: usize = 256 * 1024;
/// `di`, `ehb`, `b .`, `nop`.
const DEAF_LOOP: [u32; 4] = [0x4160_6000, 0x0000_00C0, 0x1000_FFFF, 0];

fn hold(stage: &mut Stage, contact: Contact, cycle: u64) {
    stage.robot_mut().hold_contact(contact, Hold::On, cycle);
}

fn read(stage: &mut Stage, channel: u8, counts: u16, cycle: u64) {
    stage.robot_mut().hold_analog(channel, counts, (cycle, u64::MAX));
}

fn fault(stage: &mut Stage, sensor: SensorId, fault: SensorFault) {
    stage.robot_mut().world_mut().set_fault(sensor, Some(fault));
}

/// The pack warms from 25 to 62 °C at 2 °C/s: faster would be no temperature but a broken sensor.
fn heat_up(stage: &mut Stage, _: u64) {
    for counts in (HOT..WARM).rev() {
        let now = stage.robot().cycle();
        read(stage, THERMISTOR, counts, now);
        stage.run(HEATING_MS / u64::from(WARM - HOT));
    }
}

fn flip_register(stage: &mut Stage, address: u32, mask: u32) {
    let machine = stage.robot_mut().machine_mut();
    let value = machine.peek_register(address).unwrap_or_default();
    machine.write_register(address, value ^ mask);
}

/// Flips a bit of a text that the program says on another fault only: what it does goes on, and its memory is wrong.
fn flip_text(stage: &mut Stage) {
    let machine = stage.robot_mut().machine_mut();
    let mut flash = vec![0; FLASH_BYTES];
    if machine.memory().read(FLASH, &mut flash).is_err() {
        return;
    }
    let text = Inhibit::ChargerShorted.name().as_bytes();
    if let Some(place) = (0_u32..)
        .zip(flash.windows(text.len()))
        .find(|(_, bytes)| *bytes == text)
    {
        // The place was just read from the flash, so it is one.
        machine.flip_flash_bit(FLASH + place.0, 3).ok();
    }
}

/// The program counter lands in an endless loop, with interrupts (from its third word) or without.
fn hang(stage: &mut Stage, first: u32) {
    let machine = stage.robot_mut().machine_mut();
    let bytes: Vec<u8> = DEAF_LOOP.iter().flat_map(|word| word.to_le_bytes()).collect();
    if machine.memory_mut().write(LOOP_PHYSICAL, &bytes).is_ok() {
        machine.cpu_mut().set_pc(LOOP + 4 * first);
    }
}

const fn trial(
    (rule, what): (&'static str, &'static str),
    scene: Scene,
    event: fn(&mut Stage, u64),
    (aim, limit_ms): (Aim, u64),
) -> Trial {
    Trial {
        rule,
        what,
        scene,
        event,
        aim,
        limit_ms,
    }
}

/// All of them.
#[must_use]
pub fn trials() -> Vec<Trial> {
    [
        link().as_slice(),
        &start(),
        &hangs(),
        &touch(),
        &cliffs(),
        &motors(),
        &battery(),
        &others(),
    ]
    .concat()
}

fn link() -> [Trial; 4] {
    [
        trial(
            ("S1", "the host falls silent: wheels"),
            Scene::Driving,
            |stage, _| stage.set_speaking(false),
            (Aim::WheelsOffSaying(Inhibit::LinkLost), 300),
        ),
        trial(
            ("S1", "the cable is cut: brushes and suction"),
            Scene::Cleaning,
            |stage, _| stage.robot_mut().cut_line(4_000),
            (Aim::AllOff, 2_300),
        ),
        trial(
            ("S2", "one bit in a hundred is wrong for half a second"),
            Scene::Cleaning,
            |stage, _| {
                stage.robot_mut().set_line_rates(FaultRates {
                    bit_error: 0.01,
                    ..FaultRates::NONE
                });
            },
            (Aim::Lawful, 500),
        ),
        trial(
            ("S3", "0.6 s of commands arrive late, all at once"),
            Scene::Driving,
            |stage, _| stage.robot_mut().hold_line(600),
            (Aim::Lawful, 1_000),
        ),
    ]
}

fn start() -> [Trial; 4] {
    [
        trial(
            ("S4", "reset at the MCLR pin"),
            Scene::Cleaning,
            |stage, _| stage.robot_mut().reset(ResetCause::External),
            (Aim::AllOff, 1),
        ),
        trial(
            ("S4", "brown-out"),
            Scene::Cleaning,
            |stage, _| stage.robot_mut().reset(ResetCause::BrownOut),
            (Aim::AllOff, 1),
        ),
        trial(
            ("S4", "after a reset nothing moves without arming"),
            Scene::Driving,
            |stage, _| stage.robot_mut().reset(ResetCause::Watchdog),
            (Aim::AllOffSaying(Inhibit::NotArmed), 5_000),
        ),
        trial(
            ("S4", "three resets in a minute"),
            Scene::Standing,
            |stage, _| {
                for _ in 0..3 {
                    stage.robot_mut().reset(ResetCause::Watchdog);
                    stage.run(4_000);
                }
            },
            (Aim::Says(Inhibit::ResetLoop), 13_000),
        ),
    ]
}

fn hangs() -> [Trial; 5] {
    [
        trial(
            ("S5", "the program loops, interrupts go on"),
            Scene::Cleaning,
            |stage, _| hang(stage, 2),
            (Aim::AllOff, 256),
        ),
        trial(
            ("S5", "the program loops without interrupts"),
            Scene::Cleaning,
            |stage, _| hang(stage, 0),
            (Aim::AllOff, 256),
        ),
        trial(
            ("S5", "the millisecond interrupt is off"),
            Scene::Cleaning,
            |stage, _| {
                stage
                    .robot_mut()
                    .machine_mut()
                    .write_register(IEC0_CLEAR, CORE_TIMER_ENABLE)
            },
            (Aim::AllOff, 256),
        ),
        trial(
            ("S5", "the converter's interrupt is off"),
            Scene::Cleaning,
            |stage, _| {
                stage
                    .robot_mut()
                    .machine_mut()
                    .write_register(IEC1_CLEAR, CONVERTER_ENABLE)
            },
            (Aim::AllOff, 256),
        ),
        trial(
            ("S22", "the program counter is wild: an exception"),
            Scene::Cleaning,
            |stage, _| stage.robot_mut().machine_mut().cpu_mut().set_pc(LOOP + 2),
            (Aim::AllOff, 1),
        ),
    ]
}

fn touch() -> [Trial; 6] {
    [
        trial(
            ("S6", "bumper, left"),
            Scene::Driving,
            |stage, cycle| hold(stage, Contact::BumperLeft, cycle),
            (Aim::WheelsOffSaying(Inhibit::Bumper), 20),
        ),
        trial(
            ("S6", "bumper, right (polled)"),
            Scene::Driving,
            |stage, cycle| hold(stage, Contact::BumperRight, cycle),
            (Aim::WheelsOffSaying(Inhibit::Bumper), 20),
        ),
        trial(
            ("S7", "bumper held"),
            Scene::Driving,
            |stage, cycle| hold(stage, Contact::BumperLeft, cycle),
            (Aim::Says(Inhibit::BumperStuck), 10_000 + REPORT_MS),
        ),
        trial(
            ("S10", "left wheel hangs"),
            Scene::Cleaning,
            |stage, cycle| hold(stage, Contact::WheelDropLeft, cycle),
            (Aim::AllOffSaying(Inhibit::WheelDrop), 50),
        ),
        trial(
            ("S10", "right wheel hangs"),
            Scene::Cleaning,
            |stage, cycle| hold(stage, Contact::WheelDropRight, cycle),
            (Aim::AllOffSaying(Inhibit::WheelDrop), 50),
        ),
        trial(
            ("S28", "button"),
            Scene::Cleaning,
            |stage, cycle| hold(stage, Contact::AnyButton, cycle),
            (Aim::AllOffSaying(Inhibit::ButtonStop), 50),
        ),
    ]
}

fn cliffs() -> [Trial; 4] {
    let seen = (Aim::WheelsOffSaying(Inhibit::Cliff), 20);
    [
        trial(
            ("S8", "cliff, left"),
            Scene::Driving,
            |stage, cycle| read(stage, CLIFF_LEFT, DROP, cycle),
            seen,
        ),
        trial(
            ("S8", "cliff, middle"),
            Scene::Driving,
            |stage, cycle| read(stage, CLIFF_MIDDLE, DROP, cycle),
            seen,
        ),
        trial(
            ("S8", "cliff, right, while turning"),
            Scene::Turning,
            |stage, cycle| read(stage, CLIFF_RIGHT, DROP, cycle),
            seen,
        ),
        trial(
            ("S9", "a cliff receiver sticks"),
            Scene::Driving,
            |stage, cycle| read(stage, CLIFF_MIDDLE, STUCK, cycle),
            (Aim::WheelsOff, 1_000),
        ),
    ]
}

fn motors() -> [Trial; 5] {
    [
        trial(
            ("S11", "a wheel draws too much"),
            Scene::Driving,
            |stage, cycle| read(stage, CURRENT_LEFT, 1_023, cycle),
            (Aim::WheelsOffSaying(Inhibit::WheelStall), 100),
        ),
        trial(
            ("S11", "a wheel stands though driven"),
            Scene::Driving,
            |stage, _| fault(stage, SensorId::EncoderLeft, SensorFault::StuckAt(0)),
            (Aim::WheelsOff, 300),
        ),
        trial(
            ("S12", "bridges go on after a bumper's brake"),
            Scene::DeafBridges,
            |stage, cycle| hold(stage, Contact::BumperLeft, cycle),
            (Aim::SaysBroken(Inhibit::Runaway), 250 + REPORT_MS),
        ),
        trial(
            ("S13", "an encoder counts backward"),
            Scene::Driving,
            |stage, _| fault(stage, SensorId::EncoderRight, SensorFault::Inverted),
            (Aim::WheelsOff, 500),
        ),
        trial(
            ("S29", "brushes and suction while a wheel hangs"),
            Scene::Standing,
            |stage, cycle| {
                hold(stage, Contact::WheelDropLeft, cycle);
                stage.run(60);
                stage.clean(Throttle::saturating_from_millionths(800_000));
            },
            (Aim::AllOff, 1),
        ),
    ]
}

fn battery() -> [Trial; 6] {
    [
        trial(
            ("S16", "pack below 0.9 V a cell"),
            Scene::Cleaning,
            |stage, cycle| read(stage, PACK, PACK_EMPTY, cycle),
            (Aim::AllOffSaying(Inhibit::BatteryEmpty), 600),
        ),
        trial(
            ("S16", "pack below 1.0 V a cell"),
            Scene::Cleaning,
            |stage, cycle| read(stage, PACK, PACK_WEAK, cycle),
            (Aim::Says(Inhibit::BatteryWeak), 2_100 + REPORT_MS),
        ),
        trial(
            ("S16", "pack below 1.1 V a cell"),
            Scene::Standing,
            |stage, cycle| read(stage, PACK, PACK_LOW, cycle),
            (Aim::Says(Inhibit::BatteryLow), 10_100 + REPORT_MS),
        ),
        trial(
            ("S17", "pack above 60 °C"),
            Scene::Cleaning,
            heat_up,
            (Aim::AllOffSaying(Inhibit::BatteryOverheated), HEATING_MS + 1_000),
        ),
        trial(
            ("S17", "thermistor unplugged"),
            Scene::Standing,
            |stage, cycle| read(stage, THERMISTOR, OPEN, cycle),
            (Aim::Says(Inhibit::Thermistor), 2_000 + REPORT_MS),
        ),
        trial(
            ("S17", "thermistor shorted"),
            Scene::Standing,
            |stage, cycle| read(stage, THERMISTOR, SHORTED, cycle),
            (Aim::Says(Inhibit::Thermistor), 2_000 + REPORT_MS),
        ),
    ]
}

fn others() -> [Trial; 5] {
    [
        trial(
            ("S19", "the dock's contacts close"),
            Scene::Cleaning,
            |stage, cycle| hold(stage, Contact::Adapter, cycle),
            (Aim::WheelsOffSaying(Inhibit::Docked), 50),
        ),
        trial(
            ("S20", "the crystal stops"),
            Scene::Cleaning,
            |stage, _| stage.robot_mut().machine_mut().fail_oscillator(),
            (Aim::AllOff, 10),
        ),
        trial(
            ("S21", "the timer of the motors' pulses stops"),
            Scene::Cleaning,
            |stage, _| flip_register(stage, TIMER_3_CONTROL, COUNTS_PIN),
            (Aim::AllOff, 20),
        ),
        trial(
            ("S21", "the latch beneath a wheel's pulses is set"),
            Scene::Driving,
            |stage, _| flip_register(stage, LATCH_D, LEFT_ENABLE),
            (Aim::AllOff, 20),
        ),
        trial(
            ("S21", "a bit of the program memory flips"),
            Scene::Standing,
            |stage, _| flip_text(stage),
            (Aim::Says(Inhibit::Memory), 60_000 + REPORT_MS),
        ),
    ]
}
