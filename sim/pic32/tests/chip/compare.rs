//! Output compare: pulse widths, one-off modes, and who has the pin.

use crate::program::{CLR, IFS0, bare, oc, pin, run, timer};
use pic32::machine::Machine;
use pic32::pins::{Level, Pin, PinDriver};

const R: u32 = 0x10;
const RS: u32 = 0x20;
const LATD: u32 = 0xBF88_60E0;
const TRISD: u32 = 0xBF88_60C0;
const PORTD: u32 = 0xBF88_60D0;

fn modulating(duty: u32) -> Machine {
    let mut machine = bare();
    machine.write_register(oc(1) + R, duty);
    machine.write_register(oc(1) + RS, duty);
    machine.write_register(oc(1), 0x800E);
    machine.write_register(timer(3) + 0x20, 3999);
    machine.write_register(timer(3), 0x8000);
    machine
}

fn high_in(machine: &mut Machine, pin: Pin, cycles: u64) -> u64 {
    let (begin, before) = (machine.cycle(), machine.high_cycles(pin));
    run(machine, begin + cycles);
    machine.high_cycles(pin) - before
}

#[test]
fn the_mean_duty_is_exact() {
    let rd0 = pin("RD0");
    for (duty, expected) in [
        (0, 0),
        (1, 1),
        (133, 133),
        (2600, 2600),
        (3999, 3999),
        (4000, 4000),
        (65_535, 4000),
    ] {
        let mut machine = modulating(duty);
        run(&mut machine, 4000);
        assert_eq!(
            high_in(&mut machine, rd0, 80_000_000),
            20_000 * expected,
            "OC1RS {duty}"
        );
    }
}

#[test]
fn a_new_duty_waits_for_the_end_of_the_period() {
    let mut machine = modulating(1000);
    let rd0 = pin("RD0");
    machine.watch(rd0);
    run(&mut machine, 2000);
    machine.write_register(oc(1) + RS, 3000);
    assert_eq!(machine.read_register(oc(1) + R), 1000);
    run(&mut machine, 8500);
    assert_eq!(machine.read_register(oc(1) + R), 3000);
    assert_eq!(machine.output(rd0), PinDriver::High);
    assert_eq!(machine.read_register(PORTD) & 1, 1);
    let (high, low) = (Level::High, Level::Low);
    let edges = [(1000, low), (4000, high), (7000, low), (8000, high)];
    assert_eq!(machine.take_edges(rd0), edges);
}

#[test]
fn watching_changes_nothing() {
    let rd0 = pin("RD0");
    let (mut seen, mut unseen) = (modulating(700), modulating(700));
    seen.watch(rd0);
    for machine in [&mut seen, &mut unseen] {
        run(machine, 41_234);
        machine.write_register(oc(1) + RS, 20);
        run(machine, 99_999);
    }
    assert_eq!(seen.high_cycles(rd0), unseen.high_cycles(rd0));
    let edges = seen.take_edges(rd0);
    let low = |number: usize| edges.get(number + 1).map_or(99_999, |edge| edge.0);
    let high = edges.iter().enumerate().filter(|(_, edge)| edge.1.is_high());
    let sum: u64 = high.map(|(number, edge)| low(number) - edge.0).sum();
    // The first period was high from its begin, which is no edge after watching began.
    assert_eq!(sum + edges[0].0, seen.high_cycles(rd0));
}

#[test]
fn the_pin_falls_back_to_latch_and_direction() {
    let mut machine = modulating(4000);
    let rd0 = pin("RD0");
    run(&mut machine, 10_000);
    assert_eq!(machine.output(rd0), PinDriver::High);
    machine.write_register(TRISD + CLR, 1);
    machine.write_register(oc(1), 0);
    assert_eq!(machine.output(rd0), PinDriver::Low, "LAT is 0");
    machine.write_register(oc(1), 0x800E);
    machine.write_register(LATD, 1);
    assert_eq!(machine.output(rd0), PinDriver::Low, "the module has the pin");
    machine.write_register(oc(1), 0x000E);
    assert_eq!(
        machine.output(rd0),
        PinDriver::High,
        "a module that is off has not"
    );
    let total = machine.high_cycles(rd0);
    assert_eq!(high_in(&mut machine, rd0, 500), 500);
    assert_eq!(total, 10_000);
}

#[test]
fn modes_that_are_no_modulation() {
    // Mode, edges of RD0 with OC1R = 1000, OC1RS = 1500 and a period of 4000, and how often the flag is raised till 10000.
    let (high, low) = (Level::High, Level::Low);
    let table: [(u32, &[(u64, Level)]); 5] = [
        (1, &[(1000, high)]),
        (2, &[(0, high), (1000, low)]),
        (3, &[(1000, high), (5000, low), (9000, high)]),
        (4, &[(1000, high), (1500, low)]),
        (
            5,
            &[
                (1000, high),
                (1500, low),
                (5000, high),
                (5500, low),
                (9000, high),
                (9500, low),
            ],
        ),
    ];
    for (mode, edges) in table {
        let mut machine = bare();
        let rd0 = pin("RD0");
        machine.watch(rd0);
        machine.write_register(oc(1) + R, 1000);
        machine.write_register(oc(1) + RS, 1500);
        machine.write_register(oc(1), 0x8008 | mode);
        machine.write_register(timer(3) + 0x20, 3999);
        machine.write_register(timer(3), 0x8000);
        run(&mut machine, 10_000);
        assert_eq!(machine.take_edges(rd0), edges, "mode {mode}");
        assert_eq!(machine.read_register(IFS0) & 1 << 6, 1 << 6, "mode {mode}");
    }
}

#[test]
fn a_tone_on_timer_2_with_a_prescaler() {
    let mut machine = bare();
    let rd4 = pin("RD4");
    machine.write_register(timer(2) + 0x20, 9_999);
    machine.write_register(oc(5) + RS, 5_000);
    machine.write_register(oc(5), 0x8006);
    machine.write_register(timer(2), 0x8000 | 3 << 4);
    run(&mut machine, 80_000);
    machine.watch(rd4);
    assert_eq!(high_in(&mut machine, rd4, 80_000 * 100), 40_000 * 100);
    let edges = machine.take_edges(rd4);
    assert_eq!(edges.len(), 200, "1 kHz");
    assert!(edges.windows(2).all(|pair| pair[1].0 - pair[0].0 == 40_000));
}

#[test]
fn stopping_the_timer_holds_the_pin_which_is_why_nobody_may_stop_it() {
    let mut machine = modulating(2000);
    let rd0 = pin("RD0");
    run(&mut machine, 4100);
    machine.write_register(timer(3), 0);
    assert_eq!(high_in(&mut machine, rd0, 1_000_000), 1_000_000);
}
