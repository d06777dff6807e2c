//! The watchdog and resets.

use crate::rig::{STAY, after, machine, ram, with_options};
use stc90::machine::Options;
use stc90::peripheral::{Misuse, ResetSource};

const WDT_CONTR: u8 = 0xE1;
const ISP_CONTR: u8 = 0xE7;

/// 26.2 ms at 5 MHz with the prescaler at 1.
const PERIOD: u64 = 131_072;

#[test]
fn a_program_that_hangs_is_reset() {
    let program = after(&[(WDT_CONTR, 0x31)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(PERIOD + 1);
    assert_eq!(machine.resets(), []);
    machine.run_until(10 * PERIOD);
    assert_eq!(machine.reset_count(), 9);
    let first = machine.resets()[0];
    assert_eq!((first.source, first.pc), (ResetSource::Watchdog, 3));
    assert!((PERIOD + 1..PERIOD + 4).contains(&first.cycle), "{}", first.cycle);
}

#[test]
fn a_program_that_feeds_it_is_not() {
    // MOV WDT_CONTR, #0x31; SJMP back
    let mut machine = machine(&[(0, &[0x75, WDT_CONTR, 0x31, 0x80, 0xFB])]);
    machine.run_until(10 * PERIOD);
    assert_eq!(machine.reset_count(), 0);
}

/// Where the compiler's header has it there is nothing, which a person should hear.
#[test]
fn the_address_of_other_families_is_misuse() {
    let program = after(&[(0xC1, 0x31)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(10 * PERIOD);
    assert_eq!(machine.reset_count(), 0);
    assert_eq!(machine.misuses()[0].misuse, Misuse::UnknownRegister(0xC1));
}

#[test]
fn an_option_starts_it_with_the_chip() {
    let options = Options {
        watchdog_at_power_up: true,
        ..Options::RELAX
    };
    let mut machine = with_options(&[(0, &STAY)], options);
    machine.run_until(8_388_607);
    assert_eq!(machine.reset_count(), 0);
    machine.run_until(8_388_620);
    assert_eq!(machine.reset_count(), 1);
}

/// A program begins again, or asks for the boot loader; memory and ports tell that it was a reset.
#[test]
fn a_program_can_reset_the_chip() {
    for (bits, source) in [(0x20, ResetSource::Program), (0x60, ResetSource::BootLoader)] {
        let options = Options {
            loader_cycles: 1000,
            ..Options::RELAX
        };
        // INC 0x30; MOV P1, #0; reset
        let program = [0x05, 0x30, 0x75, 0x90, 0, 0x75, ISP_CONTR, bits];
        let mut machine = with_options(&[(0, &program)], options);
        machine.run_until(999);
        assert!(machine.is_in_loader());
        assert_eq!(ram(&machine, 0x30), 0);
        machine.run_until(1006);
        assert_eq!(machine.resets()[0].source, source);
        assert_eq!(machine.outputs().0[1], 0xFF);
        assert_eq!(machine.is_in_loader(), source == ResetSource::BootLoader);
        machine.run_until(1_000_000);
        assert!(ram(&machine, 0x30) > 0);
        assert!(machine.reset_count() > 900);
        assert_eq!(machine.resets().len(), 64);
    }
}

/// POF tells power-on from other resets, if the program clears it.
#[test]
fn a_program_can_tell_how_it_began() {
    let program = after(&[(0x87, 0), (WDT_CONTR, 0x30)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    assert_eq!(machine.register(0x87), 0x10);
    machine.run_until(5);
    machine.reset(ResetSource::Pin);
    assert_eq!(machine.register(0x87), 0);
    assert_eq!(machine.register(WDT_CONTR), 0);
    machine.reset(ResetSource::PowerOn);
    assert_eq!(machine.register(0x87), 0x10);
}
