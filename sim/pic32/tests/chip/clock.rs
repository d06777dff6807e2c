//! The clock: what the configuration words give, switching, and the crystal that stops.

use crate::program::{
    CLR, DEVCFG1, DEVCFG1_MONITOR, FOREVER, IEC1, IFS1, MS, NOP, Program, SET, T0, T1, WAIT_FOREVER, WDTCON,
    branch, interrupting, ipc, lui, pin, run, store, sw, timer, word,
};
use pic32::machine::Machine;
use pic32::peripheral::Misuse;

const OSCCON: u32 = 0xBF80_F000;
const SYSKEY: u32 = 0xBF80_F230;
const TMR1: u32 = 0xBF80_0610;

/// Counts turns of three instructions at RAM 0.
const COUNTING: [u32; 4] = [0x2529_0001, sw(T1, 0, T0), branch(-3), NOP];

fn counting(devcfg1: u32) -> Machine {
    Program::new(&[[lui(T0, 0x8000)].as_slice(), &COUNTING].concat())
        .devcfg1(devcfg1)
        .machine()
}

fn unlock(machine: &mut Machine) {
    for key in [0, 0xAA99_6655, 0x5566_99AA] {
        machine.write_register(SYSKEY, key);
    }
}

fn turns_in(machine: &mut Machine, cycles: u64) -> u32 {
    let (begin, before) = (machine.cycle(), word(machine, 0));
    run(machine, begin + cycles);
    word(machine, 0) - before
}

fn has(machine: &Machine, misuse: Misuse) -> bool {
    machine.misuses().iter().any(|record| record.misuse == misuse)
}

#[test]
fn the_board_runs_at_80_mhz_and_says_so() {
    let mut machine = counting(DEVCFG1);
    run(&mut machine, 100);
    // COSC and NOSC: crystal with PLL; PLLMULT 5; locked.
    assert_eq!(machine.read_register(OSCCON), 0x0105_3320);
    machine.write_register(0xBF80_0600, 0x8000);
    run(&mut machine, 1_100);
    assert_eq!(machine.read_register(TMR1), 1000);
}

#[test]
fn too_few_wait_states_are_named() {
    let mut machine = counting(DEVCFG1);
    machine.write_register(0xBF88_4000, 0x32);
    assert!(machine.misuses().is_empty());
    machine.write_register(0xBF88_4000, 0x31);
    assert!(has(&machine, Misuse::FlashTooFast { wait_states: 1 }));
}

#[test]
fn oscillators_give_their_rates() {
    // FNOSC and how many cycles of the time base its clock takes; FRCDIV as after a reset: by 2.
    for (oscillator, cycles) in [(0, 10), (1, 1), (2, 10), (3, 1), (5, 2_500), (6, 160), (7, 20)] {
        let mut machine = counting(DEVCFG1 & !7 | oscillator);
        machine.write_register(0xBF80_0600, 0x8000);
        run(&mut machine, 8_000);
        // An instruction that has begun is finished, which takes its time with a slow clock.
        let expected = machine.cycle() / cycles;
        assert_eq!(
            u64::from(machine.read_register(TMR1)),
            expected,
            "FNOSC {oscillator}"
        );
    }
}

#[test]
fn a_slower_core_does_less() {
    let (mut fast, mut slow) = (counting(DEVCFG1), counting(DEVCFG1 & !7));
    for machine in [&mut fast, &mut slow] {
        machine.write_register(0xBF88_4000, 0x30);
        run(machine, 10 * MS);
    }
    let (many, few) = (turns_in(&mut fast, 80 * MS), turns_in(&mut slow, 80 * MS));
    assert!(few.abs_diff(many / 10) <= 1, "{many} and {few}");
}

#[test]
fn a_clock_that_is_no_divisor_of_80_mhz() {
    // Multiplied by 18: 72 MHz.
    let program = Program::new(&WAIT_FOREVER).at(0x1FC0_2FF4, &[0xFFF8_FFB9]);
    let mut machine = program.machine();
    machine.write_register(0xBF80_0600, 0x8000);
    run(&mut machine, 80_000);
    assert_eq!(machine.read_register(TMR1), 72_000 - 65_536);
    let program = Program::new(&WAIT_FOREVER).at(0x1FC0_2FF4, &[0xFFF8_FFF9]);
    assert!(has(&program.machine(), Misuse::ClockTooFast(96_000_000)));
}

#[test]
fn the_program_switches_the_clock_only_unlocked_and_allowed() {
    let switch_to_internal = |machine: &mut Machine| {
        machine.write_register(OSCCON + CLR, 7 << 8);
        machine.write_register(OSCCON + SET, 1);
        let at = machine.cycle() + 2_000;
        run(machine, at);
        machine.read_register(OSCCON) >> 12 & 7
    };
    let mut machine = counting(DEVCFG1_MONITOR);
    assert_eq!(switch_to_internal(&mut machine), 3);
    assert!(has(&machine, Misuse::Locked));
    unlock(&mut machine);
    assert_eq!(switch_to_internal(&mut machine), 0);
    assert_eq!(
        machine.read_register(OSCCON) & 1,
        0,
        "OSWEN is cleared when it is done"
    );
    machine.write_register(0xBF80_0600, 0x8000);
    let begin = machine.cycle();
    run(&mut machine, begin + 1_000);
    assert_eq!(
        u64::from(machine.read_register(TMR1)),
        (machine.cycle() - begin) / 10
    );
    let mut machine = counting(DEVCFG1);
    unlock(&mut machine);
    assert_eq!(switch_to_internal(&mut machine), 3);
    assert!(has(&machine, Misuse::ClockSwitchForbidden));
}

#[test]
fn the_monitor_replaces_a_dead_crystal_and_interrupts() {
    let registers = [(ipc(8), 6 << 18), (IEC1, 1 << 14), (timer(1), 0x8000)];
    let program = interrupting(&registers, &[(34, IFS1, 14)]).devcfg1(DEVCFG1_MONITOR);
    let mut machine = program.machine();
    run(&mut machine, MS);
    machine.fail_oscillator();
    let before = machine.read_register(TMR1);
    run(&mut machine, 2 * MS);
    assert!(machine.is_clock_dead());
    assert_eq!(
        machine.read_register(TMR1),
        before,
        "peripherals stand still, too"
    );
    assert_eq!(word(&machine, 4 * 34), 0);
    run(&mut machine, 4 * MS);
    assert!(!machine.is_clock_dead());
    assert_eq!(word(&machine, 4 * 34), 1);
    assert_eq!(
        machine.read_register(OSCCON) & (1 << 3 | 7 << 12),
        1 << 3,
        "CF, COSC = FRC"
    );
    let (begin, before) = (machine.cycle(), machine.read_register(TMR1));
    run(&mut machine, begin + 10_000);
    assert_eq!(machine.read_register(TMR1) - before, 1_000, "8 MHz");
}

#[test]
fn without_the_monitor_outputs_freeze_until_the_watchdog_resets() {
    let code = [
        store(0xBF80_3020, 2_000),
        store(0xBF80_3000, 0x800E),
        store(timer(3) + 0x20, 3_999),
        store(timer(3), 0x8000),
        store(WDTCON + SET, 0x8000),
        FOREVER.to_vec(),
    ]
    .concat();
    let mut machine = Program::new(&code).machine();
    let rd0 = pin("RD0");
    run(&mut machine, MS);
    while !machine.output(rd0).is_high() {
        let next = machine.cycle() + 1;
        run(&mut machine, next);
    }
    machine.fail_oscillator();
    let (begin, before) = (machine.cycle(), machine.high_cycles(rd0));
    run(&mut machine, 100 * MS);
    assert!(machine.is_clock_dead());
    assert_eq!(machine.high_cycles(rd0) - before, 100 * MS - begin, "stuck high");
    run(&mut machine, 140 * MS);
    assert_eq!(machine.resets().len(), 1);
    assert!(!machine.output(rd0).is_high());
    assert!(machine.is_clock_dead(), "there is nothing to start with");
}

#[test]
fn with_the_monitor_a_reset_starts_on_the_internal_oscillator() {
    let mut machine = counting(DEVCFG1_MONITOR);
    run(&mut machine, MS);
    machine.fail_oscillator();
    run(&mut machine, 10 * MS);
    machine.reset(pic32::machine::ResetSource::MasterClear);
    assert_eq!(turns_in(&mut machine, MS), 0);
    run(&mut machine, 20 * MS);
    assert!(turns_in(&mut machine, MS) > 100);
    assert_eq!(machine.read_register(OSCCON) >> 12 & 7, 0);
}

#[test]
fn bytes_and_samples_under_way_stand_still_and_go_on_slowly() {
    let mut machine = Program::new(&WAIT_FOREVER).devcfg1(DEVCFG1_MONITOR).machine();
    // UART1 at 696 cycles a bit; a sample of 31 TAD and a conversion of 12, of 32 cycles each.
    for (address, value) in [
        (0xBF80_6040, 173),
        (0xBF80_6000, 0x8008),
        (0xBF80_6010, 1 << 10),
        (0xBF80_6020, 0x41),
    ] {
        machine.write_register(address, value);
    }
    for (address, value) in [
        (0xBF80_9020, 31 << 8 | 15),
        (0xBF80_9000, 0x80E0),
        (0xBF80_9008, 2),
    ] {
        machine.write_register(address, value);
    }
    run(&mut machine, 32 * 40);
    let (dead, stopped) = (160_000, 32 * 40);
    machine.fail_oscillator();
    let converted = stopped + dead + 10 * 32 * 3;
    run(&mut machine, converted - 20);
    assert_eq!(machine.read_register(IFS1) & 2, 0);
    run(&mut machine, converted);
    assert_eq!(machine.read_register(IFS1) & 2, 2);
    run(&mut machine, 400_000);
    let sent = machine.take_sent(pic32::machine::Uart::One);
    assert_eq!(sent[0].0, stopped + dead + 10 * (6_960 - stopped));
}
