//! Ports, change notice, external interrupts and who drives what.

use crate::program::{CLR, IEC1, IFS0, IFS1, INTCON, INV, Program, SET, WAIT_FOREVER, bare, pin, run};
use pic32::peripheral::{AccessDirection, Misuse};
use pic32::pins::{Level, PinDriver};

const TRISA: u32 = 0xBF88_6000;
const LATA: u32 = 0xBF88_6020;
const TRISC: u32 = 0xBF88_6080;
const PORTC: u32 = 0xBF88_6090;
const LATC: u32 = 0xBF88_60A0;
const TRISE: u32 = 0xBF88_6100;
const PORTE: u32 = 0xBF88_6110;
const LATE: u32 = 0xBF88_6120;
const ODCE: u32 = 0xBF88_6130;
const PORTG: u32 = 0xBF88_6190;
const PORTB: u32 = 0xBF88_6050;
const CNCON: u32 = 0xBF88_61C0;
const CNEN: u32 = 0xBF88_61D0;
const CNPUE: u32 = 0xBF88_61E0;
const DDPCON: u32 = 0xBF80_F200;
const AD1PCFG: u32 = 0xBF80_9060;

#[test]
fn only_bits_that_exist_are_there() {
    let mut machine = bare();
    let present = [0xC6FF, 0xFFFF, 0xF01E, 0xFFFF, 0x03FF, 0x31FF, 0xF3CF];
    for (port, mask) in (0..).zip(present) {
        let base = 0xBF88_6000 + 0x40 * port;
        assert_eq!(
            machine.read_register(base),
            mask,
            "TRIS is all ones after a reset"
        );
        machine.write_register(base + 0x20, u32::MAX);
        assert_eq!(machine.read_register(base + 0x20), mask);
    }
}

#[test]
fn clear_set_and_invert_leave_the_rest() {
    let mut machine = bare();
    machine.write_register(LATE, 0x0F0);
    machine.write_register(LATE + SET, 0x003);
    machine.write_register(LATE + CLR, 0x030);
    machine.write_register(LATE + INV, 0x181);
    assert_eq!(machine.read_register(LATE), 0x142);
    machine.write_register(PORTE + INV, 0x002);
    assert_eq!(machine.read_register(LATE), 0x140, "PORT writes go to LAT");
}

#[test]
fn outputs_inputs_and_open_drains() {
    let mut machine = bare();
    let re3 = pin("RE3");
    assert_eq!(machine.output(re3), PinDriver::Floating);
    machine.write_register(LATE + SET, 8);
    machine.write_register(TRISE + CLR, 8);
    assert_eq!(
        (machine.output(re3), machine.level(re3)),
        (PinDriver::High, Level::High)
    );
    assert_eq!(machine.read_register(PORTE) & 8, 8);
    machine.write_register(ODCE + SET, 8);
    assert_eq!(
        (machine.output(re3), machine.level(re3)),
        (PinDriver::Floating, Level::Low)
    );
    machine.pull_up(re3);
    assert_eq!(machine.level(re3), Level::High);
    machine.write_register(LATE + CLR, 8);
    assert_eq!(
        (machine.output(re3), machine.level(re3)),
        (PinDriver::Low, Level::Low)
    );
    machine.write_register(TRISE + SET, 8);
    machine.set_input(re3, Level::High);
    assert_eq!(
        (machine.output(re3), machine.read_register(PORTE) & 8),
        (PinDriver::Floating, 8)
    );
    assert!(machine.misuses().is_empty());
}

#[test]
fn high_time_is_counted_to_the_cycle() {
    let mut machine = bare();
    let re0 = pin("RE0");
    machine.write_register(TRISE + CLR, 1);
    let mut high = 0;
    for (at, length) in [(100, 7), (1_000, 1), (5_000, 2_500)] {
        run(&mut machine, at);
        machine.write_register(LATE + SET, 1);
        run(&mut machine, at + length);
        assert_eq!(machine.high_cycles(re0), high + length, "while it is high");
        machine.write_register(LATE + CLR, 1);
        high += length;
    }
    run(&mut machine, 100_000);
    assert_eq!(machine.high_cycles(re0), 2_508);
}

#[test]
fn driving_against_the_outside_is_named_once() {
    let mut machine = bare();
    let re1 = pin("RE1");
    machine.set_input(re1, Level::High);
    machine.write_register(TRISE + CLR, 2);
    machine.write_register(TRISE + SET, 2);
    machine.write_register(TRISE + CLR, 2);
    let found: Vec<_> = machine
        .misuses()
        .iter()
        .map(|record| (record.misuse, record.count))
        .collect();
    assert_eq!(found, [(Misuse::PinConflict(re1), 2)]);
}

#[test]
fn jtag_holds_its_pins_until_it_is_off() {
    let mut machine = bare();
    let ra4 = pin("RA4");
    machine.write_register(LATA + SET, 0x10);
    machine.write_register(TRISA + CLR, 0x10);
    assert_eq!(machine.output(ra4), PinDriver::Floating);
    machine.write_register(DDPCON + CLR, 8);
    assert_eq!(machine.output(ra4), PinDriver::High);
}

#[test]
fn the_crystal_has_its_pins() {
    let mut machine = bare();
    machine.write_register(TRISC, 0);
    machine.write_register(LATC, 0xFFFF);
    assert_eq!(machine.output(pin("RC12")), PinDriver::Floating);
    assert_eq!(machine.output(pin("RC15")), PinDriver::Floating);
    assert_eq!(machine.output(pin("RC14")), PinDriver::High);
    let frc = Program::new(&WAIT_FOREVER).devcfg1(0xFF67_CFD8);
    let mut machine = frc.machine();
    machine.write_register(TRISC, 0);
    machine.write_register(LATC, 0xFFFF);
    assert_eq!(machine.output(pin("RC12")), PinDriver::High, "POSCMOD is off");
}

#[test]
fn analog_pins_read_zero() {
    let mut machine = bare();
    machine.set_input(pin("RB1"), Level::High);
    assert_eq!(machine.read_register(PORTB), 0);
    machine.write_register(AD1PCFG + SET, 2);
    assert_eq!(machine.read_register(PORTB), 2);
}

#[test]
fn a_weak_pull_up_decides_only_for_who_is_alone() {
    let mut machine = bare();
    let rc13 = pin("RC13");
    machine.write_register(CNPUE, 1 << 1);
    assert_eq!(machine.level(rc13), Level::High);
    machine.set_input(rc13, Level::Low);
    assert_eq!(machine.level(rc13), Level::Low);
    machine.release_input(rc13);
    assert_eq!(machine.level(rc13), Level::High);
    assert_eq!(machine.output(rc13), PinDriver::Floating);
}

#[test]
fn change_notice_lasts_until_the_port_is_read() {
    let mut machine = bare();
    let rc13 = pin("RC13");
    machine.set_input(rc13, Level::High);
    machine.write_register(CNCON, 0x8000);
    machine.read_register(PORTC);
    machine.write_register(CNEN, 1 << 1);
    machine.write_register(IFS1 + CLR, 1);
    run(&mut machine, 100);
    assert_eq!(machine.read_register(IFS1) & 1, 0);
    machine.schedule_input(150, rc13, Level::Low);
    run(&mut machine, 149);
    assert_eq!(machine.read_register(IFS1) & 1, 0);
    run(&mut machine, 150);
    assert_eq!(machine.read_register(IFS1) & 1, 1);
    machine.write_register(IFS1 + CLR, 1);
    assert_eq!(machine.read_register(IFS1) & 1, 1, "the mismatch is still there");
    machine.read_register(PORTC);
    machine.write_register(IFS1 + CLR, 1);
    assert_eq!(machine.read_register(IFS1) & 1, 0);
    // There and back: the flag stays although the mismatch is gone.
    machine.schedule_input(200, rc13, Level::High);
    machine.schedule_input(201, rc13, Level::Low);
    run(&mut machine, 300);
    assert_eq!(machine.read_register(IFS1) & 1, 1);
    // A pin without change notice has none.
    machine.read_register(PORTC);
    machine.write_register(IFS1 + CLR, 1);
    machine.write_register(CNEN, u32::MAX);
    machine.read_register(PORTG);
    machine.write_register(IFS1 + CLR, 1);
    machine.set_input(pin("RG15"), Level::High);
    assert_eq!(machine.read_register(IFS1) & 1, 0);
}

#[test]
fn external_interrupts_see_the_edge_that_they_are_set_to() {
    let mut machine = bare();
    let pins = [("RF6", 3), ("RE8", 7), ("RE9", 11), ("RA14", 15), ("RA15", 19)];
    machine.write_register(INTCON, 0b10101);
    for (number, (name, bit)) in pins.into_iter().enumerate() {
        let rising = number % 2 == 0;
        machine.set_input(pin(name), Level::of(!rising));
        machine.write_register(IFS0, 0);
        machine.set_input(pin(name), Level::of(rising));
        assert_eq!(machine.read_register(IFS0), 1 << bit, "{name}");
        machine.write_register(IFS0, 0);
        machine.set_input(pin(name), Level::of(!rising));
        assert_eq!(machine.read_register(IFS0), 0, "{name}");
    }
}

#[test]
fn unknown_registers_read_zero_and_are_reported_with_their_place() {
    use crate::program::{FOREVER, T0, T1, li, lw, sw};
    let code = [
        li(T0, 0xBF80_6800).as_slice(),
        &[lw(T1, 0, T0), lw(T1, 0, T0), sw(T1, 16, T0)],
        &FOREVER,
    ]
    .concat();
    let mut machine = Program::new(&code).machine();
    run(&mut machine, 1000);
    let told: Vec<_> = machine
        .unknown_accesses()
        .iter()
        .map(|one| (one.address, one.direction, one.pc, one.count))
        .collect();
    let read = (0x1F80_6800, AccessDirection::Read, 0xBFC0_0008, 2);
    assert_eq!(
        told,
        [read, (0x1F80_6810, AccessDirection::Write, 0xBFC0_0010, 1)]
    );
}

#[test]
fn bytes_and_halves_go_where_they_belong() {
    use crate::program::{FOREVER, T0, T1, li, ori, sb, sw};
    // LATD = 0x1234, then its upper byte, then LATDSET and LATDCLR by byte.
    let code = [
        li(T0, 0xBF88_60E0).as_slice(),
        &[ori(T1, 0, 0x1234), sw(T1, 0, T0), ori(T1, 0, 0xAB), sb(T1, 1, T0)],
        &[ori(T1, 0, 0x40), sb(T1, 9, T0), ori(T1, 0, 0x04), sb(T1, 4, T0)],
        &FOREVER,
    ]
    .concat();
    let mut machine = Program::new(&code).machine();
    run(&mut machine, 1000);
    assert_eq!(machine.peek_register(0xBF88_60E0), Some(0xEB30));
}

#[test]
fn scheduled_levels_come_in_order_and_change_notice_is_disabled_without_its_enable() {
    let mut machine = bare();
    let rf4 = pin("RF4");
    machine.watch(rf4);
    machine.write_register(CNCON, 0x8000);
    machine.write_register(IEC1, 1);
    machine.schedule_input(50, rf4, Level::Low);
    machine.schedule_input(40, rf4, Level::High);
    machine.schedule_input(50, rf4, Level::High);
    machine.schedule_input(60, rf4, Level::Low);
    run(&mut machine, 100);
    let (high, low) = (Level::High, Level::Low);
    assert_eq!(
        machine.take_edges(rf4),
        [(40, high), (50, low), (50, high), (60, low)]
    );
    assert_eq!(machine.read_register(IFS1), 0);
}

#[test]
fn after_a_reset_change_notice_knows_the_levels() {
    let mut machine = bare();
    let rc13 = pin("RC13");
    machine.set_input(rc13, Level::High);
    machine.reset(pic32::machine::ResetSource::MasterClear);
    machine.write_register(CNCON, 0x8000);
    machine.read_register(PORTC);
    machine.write_register(CNEN, 1 << 1);
    machine.write_register(IFS1 + CLR, 1);
    assert_eq!(machine.read_register(IFS1) & 1, 0);
    machine.set_input(rc13, Level::Low);
    assert_eq!(machine.read_register(IFS1) & 1, 1);
}
