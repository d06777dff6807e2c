//! Comparators and their reference: inputs, polarity, events, pins.

use crate::program::{CLR, IFS1, US, bare, pin};
use pic32::machine::{Halt, Machine, Outputs, Surroundings};
use pic32::peripheral::{Misuse, Unmodelled};
use pic32::pins::Level;

const CM1CON: u32 = 0xBF80_A000;
const CM2CON: u32 = 0xBF80_A010;
const CMSTAT: u32 = 0xBF80_A060;
const CVRCON: u32 = 0xBF80_9800;
const ON: u32 = 1 << 15;
const COE: u32 = 1 << 14;
const CPOL: u32 = 1 << 13;
const COUT: u32 = 1 << 8;
const CREF: u32 = 1 << 4;
const EVENTS: u32 = 3 << 3;

/// Levels of AN2 to AN5.
struct Levels([u16; 4]);

impl Surroundings for Levels {
    fn analog(&mut self, channel: u8, _: u64, _: &Outputs<'_>) -> u16 {
        self.0[usize::from(channel) - 2]
    }
}

fn settle(machine: &mut Machine, levels: [u16; 4]) {
    let next = machine.cycle() + US;
    assert_eq!(machine.run_until(next, &mut Levels(levels)), Halt::Reached);
}

#[test]
fn each_input_is_where_it_belongs() {
    // Control; levels of AN2 to AN5 that make it high, and that make it low.
    for (register, control, high, low) in [
        (CM1CON, 0, [0, 0, 500, 501], [1023, 1023, 501, 500]),
        (CM1CON, 2, [0, 500, 0, 501], [0, 501, 0, 500]),
        (CM1CON, 3, [0, 0, 0, 373], [0, 0, 0, 372]),
        (CM2CON, 0, [500, 501, 0, 0], [501, 500, 0, 0]),
        (CM2CON, 2, [0, 501, 0, 500], [0, 500, 0, 501]),
        (CM2CON, 3, [0, 373, 0, 0], [0, 372, 0, 0]),
    ] {
        for inverted in [0, CPOL] {
            let mut machine = bare();
            machine.write_register(register, ON | control | inverted);
            for (levels, above) in [(high, true), (low, false), (high, true)] {
                settle(&mut machine, levels);
                let expected = above != (inverted != 0);
                assert_eq!(
                    machine.read_register(register) & COUT != 0,
                    expected,
                    "{control} at {register:#x}"
                );
                let bit = if register == CM1CON { 1 } else { 2 };
                assert_eq!(machine.read_register(CMSTAT) & bit != 0, expected);
            }
            assert_eq!(machine.misuses(), []);
        }
    }
}

#[test]
fn the_reference_has_sixteen_steps_in_two_ranges() {
    for step in 0..16_u32 {
        for (range, volts) in [(1 << 5, step as f64 / 24.0), (0, 0.25 + step as f64 / 32.0)] {
            let mut machine = bare();
            machine.write_register(CVRCON, ON | range | step);
            machine.write_register(CM1CON, ON | CREF);
            let level = (volts * 1023.0) as u16;
            settle(&mut machine, [0, 0, level + 1, 0]);
            assert_eq!(machine.read_register(CM1CON) & COUT, 0, "step {step}");
            if level > 0 {
                settle(&mut machine, [0, 0, level - 1, 0]);
                assert_eq!(machine.read_register(CM1CON) & COUT, COUT, "step {step}");
            }
        }
    }
    let mut machine = bare();
    machine.write_register(CVRCON, ON | 1 << 4);
    assert_eq!(
        machine.misuses()[0].misuse,
        Misuse::NotModelled(Unmodelled::VoltageReference)
    );
}

#[test]
fn events_are_those_that_were_asked_for() {
    for (events, rises, falls) in [
        (0, false, false),
        (1, true, false),
        (2, false, true),
        (3, true, true),
    ] {
        let mut machine = bare();
        machine.write_register(CM1CON, ON | events << 6);
        machine.write_register(CM2CON, ON | events << 6);
        settle(&mut machine, [1, 0, 1, 0]);
        machine.write_register(IFS1 + CLR, EVENTS);
        settle(&mut machine, [0, 1, 0, 1]);
        assert_eq!(
            machine.read_register(IFS1) & EVENTS == EVENTS,
            rises,
            "EVPOL {events}"
        );
        machine.write_register(IFS1 + CLR, EVENTS);
        settle(&mut machine, [1, 0, 1, 0]);
        assert_eq!(
            machine.read_register(IFS1) & EVENTS == EVENTS,
            falls,
            "EVPOL {events}"
        );
    }
}

#[test]
fn pins_are_driven_when_wanted_and_inputs_must_be_analog() {
    let mut machine = bare();
    machine.write_register(CM1CON, ON | COE);
    settle(&mut machine, [0, 0, 0, 9]);
    assert_eq!(machine.output(pin("RB8")).level(), Some(Level::High));
    assert_eq!(machine.output(pin("RB9")).level(), None);
    machine.write_register(CM1CON, ON);
    assert_eq!(machine.output(pin("RB8")).level(), None);
    machine.write_register(0xBF80_9060, 1 << 5);
    settle(&mut machine, [0, 0, 0, 9]);
    assert_eq!(
        machine.misuses()[0].misuse,
        Misuse::AnalogPinIsDigital(pin("RB5"))
    );
}

#[test]
fn registers_hold_their_bits_and_no_others() {
    let mut machine = bare();
    assert_eq!(machine.read_register(CM1CON), 0x00C3);
    assert_eq!(machine.read_register(CM2CON), 0x00C3);
    machine.write_register(CM2CON, !ON);
    assert_eq!(machine.read_register(CM2CON), 0x60D3);
    machine.write_register(CMSTAT, u32::MAX);
    assert_eq!(machine.read_register(CMSTAT), 1 << 13);
    machine.write_register(CVRCON, !ON);
    assert_eq!(machine.read_register(CVRCON), 0x7F);
}
