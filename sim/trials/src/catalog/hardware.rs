//! Resets, a program that hangs, and parts of the chip that fail.

use rvac_protocol::message::{Inhibit, ResetCause};

use crate::limits;
use crate::scene::OperatingState::{Cleaning, Driving, Standing};
use crate::testbed::Testbed;
use crate::trial::Expectation::{Off, OffSaying, Says, SaysAfterReset};
use crate::trial::{MotorGroup, Trial};

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
/// Between two resets of a loop: the robot has started.
const UP_MS: u64 = 1_000;
/// A robot that was reset has been found again.
const RESTART_MS: u64 = 3_000;

fn reset(testbed: &mut Testbed, cause: ResetCause) -> u64 {
    let at = testbed.robot().cycle();
    testbed.robot_mut().reset(cause);
    at
}

fn reset_thrice(testbed: &mut Testbed, _: u64) -> u64 {
    for _ in 0..2 {
        reset(testbed, ResetCause::Watchdog);
        testbed.run(UP_MS);
    }
    reset(testbed, ResetCause::Watchdog)
}

fn write(testbed: &mut Testbed, register: u32, value: u32) -> u64 {
    let at = testbed.robot().cycle();
    testbed.robot_mut().machine_mut().write_register(register, value);
    at
}

fn flip_register(testbed: &mut Testbed, address: u32, mask: u32) -> u64 {
    let at = testbed.robot().cycle();
    testbed.robot_mut().damage_pulses(address, mask);
    at
}

/// Flips a bit of a text that the program says on another fault only: what it does goes on, and its memory is wrong.
fn flip_text(testbed: &mut Testbed) -> u64 {
    let at = testbed.robot().cycle();
    let robot = testbed.robot_mut();
    let mut flash = vec![0; FLASH_BYTES];
    if robot.machine().memory().read(FLASH, &mut flash).is_err() {
        return at;
    }
    let text = Inhibit::ChargerShorted.name().as_bytes();
    if let Some(place) = (0_u32..)
        .zip(flash.windows(text.len()))
        .find(|(_, bytes)| *bytes == text)
    {
        // The place was just read from the flash, so it is one.
        robot.damage_image(FLASH + place.0, 3).ok();
    }
    at
}

/// The program counter lands in an endless loop, with interrupts (from its third word) or without.
fn hang(testbed: &mut Testbed, first: u32) -> u64 {
    let at = testbed.robot().cycle();
    let machine = testbed.robot_mut().machine_mut();
    let bytes: Vec<u8> = DEAF_LOOP.iter().flat_map(|word| word.to_le_bytes()).collect();
    if machine.memory_mut().write(LOOP_PHYSICAL, &bytes).is_ok() {
        machine.cpu_mut().set_pc(LOOP + 4 * first);
    }
    at
}

pub(super) fn trials() -> Vec<Trial> {
    [starts(), hangs(), parts()].concat()
}

fn starts() -> Vec<Trial> {
    vec![
        Trial::new("reset-pin", "reset at the MCLR pin", Cleaning, |testbed, _| {
            reset(testbed, ResetCause::External)
        })
        .expects(Off(MotorGroup::All), limits::S4_OFF),
        Trial::new("brown-out", "brown-out", Cleaning, |testbed, _| {
            reset(testbed, ResetCause::BrownOut)
        })
        .expects(Off(MotorGroup::All), limits::S4_OFF),
        Trial::new(
            "reset-then-still",
            "after a reset the host drives on without arming",
            Driving,
            |testbed, _| reset(testbed, ResetCause::Watchdog),
        )
        .expects(OffSaying(MotorGroup::All, Inhibit::NotArmed), limits::S4_OFF)
        .watched_for(RESTART_MS),
        Trial::new(
            "three-resets",
            "the third reset in a minute; reported",
            Standing,
            reset_thrice,
        )
        .expects(SaysAfterReset(Inhibit::ResetLoop), limits::S4_OFF),
    ]
}

fn hangs() -> Vec<Trial> {
    let off = Off(MotorGroup::All);
    vec![
        Trial::new(
            "loop-with-interrupts",
            "the program loops, interrupts go on",
            Cleaning,
            |testbed, _| hang(testbed, 2),
        )
        .expects(off, limits::S5_RESET),
        Trial::new(
            "loop-without-interrupts",
            "the program loops without interrupts",
            Cleaning,
            |testbed, _| hang(testbed, 0),
        )
        .expects(off, limits::S5_RESET),
        Trial::new(
            "tick-interrupt-off",
            "the millisecond interrupt is off",
            Cleaning,
            |testbed, _| write(testbed, IEC0_CLEAR, CORE_TIMER_ENABLE),
        )
        .expects(off, limits::S5_RESET),
        Trial::new(
            "converter-interrupt-off",
            "the converter's interrupt is off",
            Cleaning,
            |testbed, _| write(testbed, IEC1_CLEAR, CONVERTER_ENABLE),
        )
        .expects(off, limits::S5_RESET),
        Trial::new(
            "wild-program-counter",
            "the program counter is wild: an exception",
            Cleaning,
            |testbed, _| {
                let at = testbed.robot().cycle();
                testbed.robot_mut().machine_mut().cpu_mut().set_pc(LOOP + 2);
                at
            },
        )
        .expects(off, limits::S22_RESET),
    ]
}

fn parts() -> Vec<Trial> {
    let off = Off(MotorGroup::All);
    vec![
        Trial::new("crystal-stops", "the crystal stops", Cleaning, |testbed, _| {
            let at = testbed.robot().cycle();
            testbed.robot_mut().stop_crystal();
            at
        })
        .expects(off, limits::S20_OFF),
        Trial::new(
            "pulse-timer-stops",
            "the timer of the motors' pulses stops",
            Cleaning,
            |testbed, _| flip_register(testbed, TIMER_3_CONTROL, COUNTS_PIN),
        )
        .expects(off, limits::S21_REGISTER),
        Trial::new(
            "pulse-latch-set",
            "the latch beneath a wheel's pulses is set",
            Driving,
            |testbed, _| flip_register(testbed, LATCH_D, LEFT_ENABLE),
        )
        .expects(off, limits::S21_REGISTER),
        Trial::new(
            "image-bit-flips",
            "a bit of the program memory flips; reported",
            Standing,
            |testbed, _| flip_text(testbed),
        )
        .expects(Says(Inhibit::Memory), limits::S21_MEMORY),
    ]
}
