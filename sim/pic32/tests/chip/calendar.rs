//! The calendar: who may write it, how digits go on, alarms, calibration.

use crate::program::{CLR, IFS1, MS, SET, bare, run};
use pic32::machine::Machine;
use pic32::peripheral::Misuse;

const CON: u32 = 0xBF80_0200;
const ALRM: u32 = 0xBF80_0210;
const TIME: u32 = 0xBF80_0220;
const DATE: u32 = 0xBF80_0230;
const ALRMTIME: u32 = 0xBF80_0240;
const ALRMDATE: u32 = 0xBF80_0250;
const OSCCON: u32 = 0xBF80_F000;
const SYSKEY: u32 = 0xBF80_F230;

const ON: u32 = 1 << 15;
const RTCWREN: u32 = 1 << 3;
const RTCCLKON: u32 = 1 << 6;
const RTCSYNC: u32 = 1 << 2;
const HALFSEC: u32 = 1 << 1;
const ALRMEN: u32 = 1 << 15;
const CHIME: u32 = 1 << 14;
const ALARM: u32 = 1 << 15;
const S: u64 = 1_000 * MS;

fn unlock(machine: &mut Machine) {
    for key in [0, 0xAA99_6655, 0x5566_99AA] {
        machine.write_register(SYSKEY, key);
    }
}

/// A calendar that runs from this time and date.
fn running(time: u32, date: u32, calibration: u32) -> Machine {
    let mut machine = bare();
    machine.fit_watch_crystal();
    unlock(&mut machine);
    machine.write_register(OSCCON + SET, 2);
    machine.write_register(CON + SET, RTCWREN);
    machine.write_register(SYSKEY, 0x3333_3333);
    machine.write_register(DATE, date);
    machine.write_register(TIME, time);
    machine.write_register(CON + SET, ON | calibration << 16);
    machine.write_register(CON + CLR, RTCWREN);
    machine
}

#[test]
fn digits_go_on_to_the_end_of_the_century() {
    for (time, date, then_time, then_date) in [
        (0x1209_5900, 0x2603_0905, 0x1210_0000, 0x2603_0905),
        (0x0959_5900, 0x2603_0905, 0x1000_0000, 0x2603_0905),
        (0x2359_5900, 0x2603_0905, 0x0000_0000, 0x2603_1006),
        (0x2359_5900, 0x2602_2806, 0x0000_0000, 0x2603_0100),
        (0x2359_5900, 0x2802_2801, 0x0000_0000, 0x2802_2902),
        (0x2359_5900, 0x2404_3003, 0x0000_0000, 0x2405_0104),
        (0x2359_5900, 0x2412_3103, 0x0000_0000, 0x2501_0104),
        (0x2359_5900, 0x9912_3104, 0x0000_0000, 0x0001_0105),
    ] {
        let mut machine = running(time, date, 0);
        run(&mut machine, S - MS);
        assert_eq!(machine.read_register(TIME), time);
        run(&mut machine, S);
        assert_eq!(machine.read_register(TIME), then_time, "{date:x}");
        assert_eq!(machine.read_register(DATE), then_date, "{date:x}");
        assert_eq!(machine.misuses(), []);
    }
}

#[test]
fn nothing_is_written_without_leave() {
    let mut machine = bare();
    machine.write_register(CON + SET, RTCWREN);
    assert_eq!(machine.read_register(CON), 0);
    assert_eq!(machine.misuses()[0].misuse, Misuse::Locked);
    for (register, value) in [(TIME, 0x1200_0000), (DATE, 0x2601_0104), (CON, ON)] {
        let before = machine.read_register(register);
        machine.write_register(register, value);
        assert_eq!(machine.read_register(register), before, "{register:#x}");
    }
    unlock(&mut machine);
    machine.write_register(CON + SET, RTCWREN);
    machine.write_register(CON + SET, ON);
    assert_eq!(
        machine.read_register(CON),
        ON | RTCWREN,
        "on, without an oscillator"
    );
    run(&mut machine, 3 * S);
    assert_eq!(machine.read_register(TIME), 0);
}

#[test]
fn the_second_half_and_its_end_are_told() {
    let mut machine = running(0, 0x2601_0104, 0);
    for (ms, bits) in [(499, 0), (501, HALFSEC), (998, HALFSEC), (999, 0)] {
        let extra = if ms == 999 { HALFSEC | RTCSYNC } else { bits };
        run(&mut machine, ms * MS + if ms == 999 { MS / 2 } else { 0 });
        assert_eq!(
            machine.read_register(CON) & (HALFSEC | RTCSYNC | RTCCLKON),
            extra | RTCCLKON,
            "{ms} ms"
        );
    }
}

#[test]
fn each_mask_compares_its_digits() {
    // Mask; time and date of the alarm; begin; seconds until it rings.
    for (mask, at_time, at_date, begin, seconds) in [
        (1, 0, 0, 0x1200_0000, 1),
        (2, 0x0000_0700, 0, 0x1200_0300, 4),
        (3, 0x0000_1000, 0, 0x1200_0300, 7),
        (4, 0x0001_0000, 0, 0x1200_5800, 2),
        (5, 0x0001_0000, 0, 0x1200_5800, 2),
        (6, 0x1201_0000, 0, 0x1200_5800, 2),
        (7, 0x1201_0000, 4, 0x1200_5800, 2),
        (8, 0x1201_0000, 0x0100, 0x1200_5800, 2),
        (9, 0x1201_0000, 0x0001_0100, 0x1200_5800, 2),
    ] {
        let mut machine = running(begin, 0x2601_0104, 0);
        machine.write_register(ALRMTIME, at_time);
        machine.write_register(ALRMDATE, at_date);
        machine.write_register(ALRM, ALRMEN | mask << 8);
        run(&mut machine, seconds * S - MS);
        assert_eq!(machine.read_register(IFS1) & ALARM, 0, "mask {mask}");
        run(&mut machine, seconds * S);
        assert_eq!(machine.read_register(IFS1) & ALARM, ALARM, "mask {mask}");
        assert_eq!(machine.read_register(ALRM) & ALRMEN, 0, "once");
    }
    let mut machine = running(0x1200_5800, 0x2601_0104, 0);
    machine.write_register(ALRMTIME, 0x1201_0000);
    machine.write_register(ALRMDATE, 0x0001_0200);
    machine.write_register(ALRM, ALRMEN | 9 << 8);
    run(&mut machine, 3 * S);
    assert_eq!(machine.read_register(IFS1) & ALARM, 0, "another day");
}

#[test]
fn an_alarm_repeats_or_chimes_for_ever() {
    for (chime, repeats, rings) in [(0, 0, 1), (0, 2, 3), (CHIME, 0, 5)] {
        let mut machine = running(0, 0x2601_0104, 0);
        machine.write_register(ALRM, ALRMEN | chime | 1 << 8 | repeats);
        let mut heard = 0;
        for second in 1..=5 {
            run(&mut machine, second * S);
            heard += machine.read_register(IFS1) >> 15 & 1;
            machine.write_register(IFS1 + CLR, ALARM);
        }
        assert_eq!(heard, rings, "ARPT {repeats}");
    }
    let mut machine = running(0, 0x2601_0104, 0);
    machine.write_register(ALRM, ALRMEN | CHIME);
    run(&mut machine, S / 2);
    assert_eq!(machine.read_register(IFS1) & ALARM, ALARM, "each half second");
}

#[test]
fn calibration_changes_the_length_of_a_minute() {
    // 512 clocks fewer and 511 more, a minute.
    for (calibration, cycles) in [(0x200, 60 * S + S / 64), (0x1FF, 60 * S - 511 * S / 32_768)] {
        let mut machine = running(0x0000_5900, 0x2601_0104, calibration);
        run(&mut machine, S + cycles - MS);
        assert_eq!(machine.read_register(TIME), 0x0001_5900);
        run(&mut machine, S + cycles + MS);
        assert_eq!(machine.read_register(TIME), 0x0002_0000);
    }
}

#[test]
fn a_reset_leaves_the_calendar_alone() {
    let mut machine = running(0x1200_0000, 0x2601_0104, 0);
    run(&mut machine, S + S / 2);
    machine.reset(pic32::machine::ResetSource::MasterClear);
    assert_eq!(machine.read_register(TIME), 0x1200_0100);
    assert_eq!(machine.read_register(CON) & (ON | RTCWREN), ON);
}
