//! All trials, rule by rule in the order of SAFETY.md.

use home::{SensorFault, SensorId};
use pic32::board::{Contact, Hold};
use rvac_channel::FaultRates;
use rvac_protocol::message::{Inhibit, ResetCause};
use rvac_units::Throttle;

use crate::testbed::Testbed;
use crate::trial::{Expectation, OperatingState, Trial};

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

fn hold(testbed: &mut Testbed, contact: Contact, cycle: u64) {
    testbed.robot_mut().hold_contact(contact, Hold::On, cycle);
}

fn read(testbed: &mut Testbed, channel: u8, counts: u16, cycle: u64) {
    testbed
        .robot_mut()
        .hold_analog(channel, counts, (cycle, u64::MAX));
}

fn fault(testbed: &mut Testbed, sensor: SensorId, fault: SensorFault) {
    testbed.robot_mut().world_mut().set_fault(sensor, Some(fault));
}

/// The host falls silent until its session is over; then somebody types motion and arms nothing.
fn type_without_a_host(testbed: &mut Testbed, _: u64) {
    testbed.set_speaking(false);
    testbed.run(2_300);
    for _ in 0..10 {
        testbed.type_in(r#"{"c":"drive","v":0.1,"w":0,"ttl":500}"#);
        testbed.type_in(r#"{"c":"motor","motor":"vacuum","throttle":1,"ttl":500}"#);
        testbed.run(50);
    }
}

/// The pack warms from 25 to 62 °C at 2 °C/s: faster would be no temperature but a broken sensor.
fn heat_up(testbed: &mut Testbed, _: u64) {
    for counts in (HOT..WARM).rev() {
        let now = testbed.robot().cycle();
        read(testbed, THERMISTOR, counts, now);
        testbed.run(HEATING_MS / u64::from(WARM - HOT));
    }
}

fn flip_register(testbed: &mut Testbed, address: u32, mask: u32) {
    let machine = testbed.robot_mut().machine_mut();
    let value = machine.peek_register(address).unwrap_or_default();
    machine.write_register(address, value ^ mask);
}

/// Flips a bit of a text that the program says on another fault only: what it does goes on, and its memory is wrong.
fn flip_text(testbed: &mut Testbed) {
    let machine = testbed.robot_mut().machine_mut();
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
fn hang(testbed: &mut Testbed, first: u32) {
    let machine = testbed.robot_mut().machine_mut();
    let bytes: Vec<u8> = DEAF_LOOP.iter().flat_map(|word| word.to_le_bytes()).collect();
    if machine.memory_mut().write(LOOP_PHYSICAL, &bytes).is_ok() {
        machine.cpu_mut().set_pc(LOOP + 4 * first);
    }
}

const fn trial(
    (rule, what): (&'static str, &'static str),
    scene: OperatingState,
    event: fn(&mut Testbed, u64),
    (expected, limit_ms): (Expectation, u64),
) -> Trial {
    Trial {
        rule,
        what,
        scene,
        event,
        expected,
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
        &flooded(),
        &cliffs(),
        &motors(),
        &battery(),
        &others(),
    ]
    .concat()
}

fn link() -> [Trial; 5] {
    [
        trial(
            ("S1", "the host falls silent: wheels"),
            OperatingState::Driving,
            |testbed, _| testbed.set_speaking(false),
            (Expectation::WheelsOffSaying(Inhibit::LinkLost), 300),
        ),
        trial(
            ("S1", "the cable is cut: brushes and suction"),
            OperatingState::Cleaning,
            |testbed, _| testbed.robot_mut().cut_line(4_000),
            (Expectation::AllOff, 300),
        ),
        trial(
            ("S2", "one bit in a hundred is wrong for half a second"),
            OperatingState::Cleaning,
            |testbed, _| {
                testbed.robot_mut().set_line_rates(FaultRates {
                    bit_error: 0.01,
                    ..FaultRates::NONE
                });
            },
            (Expectation::Lawful, 500),
        ),
        trial(
            ("S2", "packets are typed after the host has died"),
            OperatingState::Cleaning,
            type_without_a_host,
            (Expectation::AllOff, 2_300),
        ),
        trial(
            ("S3", "0.6 s of commands arrive late, all at once"),
            OperatingState::Driving,
            |testbed, _| testbed.robot_mut().hold_line(600),
            (Expectation::Lawful, 1_000),
        ),
    ]
}

fn start() -> [Trial; 4] {
    [
        trial(
            ("S4", "reset at the MCLR pin"),
            OperatingState::Cleaning,
            |testbed, _| testbed.robot_mut().reset(ResetCause::External),
            (Expectation::AllOff, 1),
        ),
        trial(
            ("S4", "brown-out"),
            OperatingState::Cleaning,
            |testbed, _| testbed.robot_mut().reset(ResetCause::BrownOut),
            (Expectation::AllOff, 1),
        ),
        trial(
            ("S4", "after a reset nothing moves without arming"),
            OperatingState::Driving,
            |testbed, _| testbed.robot_mut().reset(ResetCause::Watchdog),
            (Expectation::AllOffSaying(Inhibit::NotArmed), 5_000),
        ),
        trial(
            ("S4", "three resets in a minute"),
            OperatingState::Standing,
            |testbed, _| {
                for _ in 0..3 {
                    testbed.robot_mut().reset(ResetCause::Watchdog);
                    testbed.run(4_000);
                }
            },
            (Expectation::Says(Inhibit::ResetLoop), 13_000),
        ),
    ]
}

fn hangs() -> [Trial; 5] {
    [
        trial(
            ("S5", "the program loops, interrupts go on"),
            OperatingState::Cleaning,
            |testbed, _| hang(testbed, 2),
            (Expectation::AllOff, 256),
        ),
        trial(
            ("S5", "the program loops without interrupts"),
            OperatingState::Cleaning,
            |testbed, _| hang(testbed, 0),
            (Expectation::AllOff, 256),
        ),
        trial(
            ("S5", "the millisecond interrupt is off"),
            OperatingState::Cleaning,
            |testbed, _| {
                testbed
                    .robot_mut()
                    .machine_mut()
                    .write_register(IEC0_CLEAR, CORE_TIMER_ENABLE)
            },
            (Expectation::AllOff, 256),
        ),
        trial(
            ("S5", "the converter's interrupt is off"),
            OperatingState::Cleaning,
            |testbed, _| {
                testbed
                    .robot_mut()
                    .machine_mut()
                    .write_register(IEC1_CLEAR, CONVERTER_ENABLE)
            },
            (Expectation::AllOff, 256),
        ),
        trial(
            ("S22", "the program counter is wild: an exception"),
            OperatingState::Cleaning,
            |testbed, _| testbed.robot_mut().machine_mut().cpu_mut().set_pc(LOOP + 2),
            (Expectation::AllOff, 1),
        ),
    ]
}

fn touch() -> [Trial; 6] {
    [
        trial(
            ("S6", "bumper, left"),
            OperatingState::Driving,
            |testbed, cycle| hold(testbed, Contact::BumperLeft, cycle),
            (Expectation::WheelsOffSaying(Inhibit::Bumper), 20),
        ),
        trial(
            ("S6", "bumper, right (polled)"),
            OperatingState::Driving,
            |testbed, cycle| hold(testbed, Contact::BumperRight, cycle),
            (Expectation::WheelsOffSaying(Inhibit::Bumper), 20),
        ),
        trial(
            ("S7", "bumper held"),
            OperatingState::Driving,
            |testbed, cycle| hold(testbed, Contact::BumperLeft, cycle),
            (Expectation::Says(Inhibit::BumperStuck), 10_000 + REPORT_MS),
        ),
        trial(
            ("S10", "left wheel hangs"),
            OperatingState::Cleaning,
            |testbed, cycle| hold(testbed, Contact::WheelDropLeft, cycle),
            (Expectation::AllOffSaying(Inhibit::WheelDrop), 50),
        ),
        trial(
            ("S10", "right wheel hangs"),
            OperatingState::Cleaning,
            |testbed, cycle| hold(testbed, Contact::WheelDropRight, cycle),
            (Expectation::AllOffSaying(Inhibit::WheelDrop), 50),
        ),
        trial(
            ("S28", "button"),
            OperatingState::Cleaning,
            |testbed, cycle| hold(testbed, Contact::AnyButton, cycle),
            (Expectation::AllOffSaying(Inhibit::ButtonStop), 50),
        ),
    ]
}

/// Another sender on the wire to the robot, from this cycle on: 750,000 edges a second, for longer than a trial looks.
fn flood(testbed: &mut Testbed, cycle: u64) {
    testbed.robot_mut().flood_line(1_500_000, cycle, 1_000);
}

fn flooded() -> [Trial; 5] {
    [
        trial(
            ("S1", "edges flood the receive pin: wheels"),
            OperatingState::Driving,
            flood,
            (Expectation::WheelsOff, 300),
        ),
        trial(
            ("S6", "bumper, and edges flood the receive pin"),
            OperatingState::Driving,
            |testbed, cycle| {
                flood(testbed, cycle);
                hold(testbed, Contact::BumperRight, cycle);
            },
            (Expectation::WheelsOff, 20),
        ),
        trial(
            ("S8", "cliff, and edges flood the receive pin"),
            OperatingState::Driving,
            |testbed, cycle| {
                flood(testbed, cycle);
                read(testbed, CLIFF_MIDDLE, DROP, cycle);
            },
            (Expectation::WheelsOff, 20),
        ),
        trial(
            ("S10", "a wheel hangs, and edges flood the receive pin"),
            OperatingState::Cleaning,
            |testbed, cycle| {
                flood(testbed, cycle);
                hold(testbed, Contact::WheelDropLeft, cycle);
            },
            (Expectation::AllOff, 50),
        ),
        trial(
            ("S28", "button, and edges flood the receive pin"),
            OperatingState::Cleaning,
            |testbed, cycle| {
                flood(testbed, cycle);
                hold(testbed, Contact::AnyButton, cycle);
            },
            (Expectation::AllOff, 50),
        ),
    ]
}

fn cliffs() -> [Trial; 4] {
    let seen = (Expectation::WheelsOffSaying(Inhibit::Cliff), 20);
    [
        trial(
            ("S8", "cliff, left"),
            OperatingState::Driving,
            |testbed, cycle| read(testbed, CLIFF_LEFT, DROP, cycle),
            seen,
        ),
        trial(
            ("S8", "cliff, middle"),
            OperatingState::Driving,
            |testbed, cycle| read(testbed, CLIFF_MIDDLE, DROP, cycle),
            seen,
        ),
        trial(
            ("S8", "cliff, right, while turning"),
            OperatingState::Turning,
            |testbed, cycle| read(testbed, CLIFF_RIGHT, DROP, cycle),
            seen,
        ),
        trial(
            ("S9", "a cliff receiver sticks"),
            OperatingState::Driving,
            |testbed, cycle| read(testbed, CLIFF_MIDDLE, STUCK, cycle),
            (Expectation::WheelsOff, 1_000),
        ),
    ]
}

fn motors() -> [Trial; 5] {
    [
        trial(
            ("S11", "a wheel draws too much"),
            OperatingState::Driving,
            |testbed, cycle| read(testbed, CURRENT_LEFT, 1_023, cycle),
            (Expectation::WheelsOffSaying(Inhibit::WheelStall), 100),
        ),
        trial(
            ("S11", "a wheel stands though driven"),
            OperatingState::Driving,
            |testbed, _| fault(testbed, SensorId::EncoderLeft, SensorFault::StuckAt(0)),
            (Expectation::WheelsOff, 300),
        ),
        trial(
            ("S12", "bridges go on after a bumper's brake"),
            OperatingState::DeafBridges,
            |testbed, cycle| hold(testbed, Contact::BumperLeft, cycle),
            (Expectation::SaysBroken(Inhibit::Runaway), 250 + REPORT_MS),
        ),
        trial(
            ("S13", "an encoder counts backward"),
            OperatingState::Driving,
            |testbed, _| fault(testbed, SensorId::EncoderRight, SensorFault::Inverted),
            (Expectation::WheelsOff, 500),
        ),
        trial(
            ("S29", "brushes and suction while a wheel hangs"),
            OperatingState::Standing,
            |testbed, cycle| {
                hold(testbed, Contact::WheelDropLeft, cycle);
                testbed.run(60);
                testbed.clean(Throttle::saturating_from_millionths(800_000));
            },
            (Expectation::AllOff, 1),
        ),
    ]
}

fn battery() -> [Trial; 6] {
    [
        trial(
            ("S16", "pack below 0.9 V a cell"),
            OperatingState::Cleaning,
            |testbed, cycle| read(testbed, PACK, PACK_EMPTY, cycle),
            (Expectation::AllOffSaying(Inhibit::BatteryEmpty), 600),
        ),
        trial(
            ("S16", "pack below 1.0 V a cell"),
            OperatingState::Cleaning,
            |testbed, cycle| read(testbed, PACK, PACK_WEAK, cycle),
            (Expectation::Says(Inhibit::BatteryWeak), 2_100 + REPORT_MS),
        ),
        trial(
            ("S16", "pack below 1.1 V a cell"),
            OperatingState::Standing,
            |testbed, cycle| read(testbed, PACK, PACK_LOW, cycle),
            (Expectation::Says(Inhibit::BatteryLow), 10_100 + REPORT_MS),
        ),
        trial(
            ("S17", "pack above 60 °C"),
            OperatingState::Cleaning,
            heat_up,
            (
                Expectation::AllOffSaying(Inhibit::BatteryOverheated),
                HEATING_MS + 1_000,
            ),
        ),
        trial(
            ("S17", "thermistor unplugged"),
            OperatingState::Standing,
            |testbed, cycle| read(testbed, THERMISTOR, OPEN, cycle),
            (Expectation::Says(Inhibit::Thermistor), 2_000 + REPORT_MS),
        ),
        trial(
            ("S17", "thermistor shorted"),
            OperatingState::Standing,
            |testbed, cycle| read(testbed, THERMISTOR, SHORTED, cycle),
            (Expectation::Says(Inhibit::Thermistor), 2_000 + REPORT_MS),
        ),
    ]
}

fn others() -> [Trial; 5] {
    [
        trial(
            ("S19", "the dock's contacts close"),
            OperatingState::Cleaning,
            |testbed, cycle| hold(testbed, Contact::Adapter, cycle),
            (Expectation::WheelsOffSaying(Inhibit::Docked), 50),
        ),
        trial(
            ("S20", "the crystal stops"),
            OperatingState::Cleaning,
            |testbed, _| testbed.robot_mut().machine_mut().fail_oscillator(),
            (Expectation::AllOff, 10),
        ),
        trial(
            ("S21", "the timer of the motors' pulses stops"),
            OperatingState::Cleaning,
            |testbed, _| flip_register(testbed, TIMER_3_CONTROL, COUNTS_PIN),
            (Expectation::AllOff, 20),
        ),
        trial(
            ("S21", "the latch beneath a wheel's pulses is set"),
            OperatingState::Driving,
            |testbed, _| flip_register(testbed, LATCH_D, LEFT_ENABLE),
            (Expectation::AllOff, 20),
        ),
        trial(
            ("S21", "a bit of the program memory flips"),
            OperatingState::Standing,
            |testbed, _| flip_text(testbed),
            (Expectation::Says(Inhibit::Memory), 60_000 + REPORT_MS),
        ),
    ]
}
