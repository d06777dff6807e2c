//! Count and Compare as the program and the machine see them.

use crate::bench::{Bench, CAUSE, COMPARE, COUNT, NOP, WAIT, mfc0, mtc0};
use pic32::cpu::Exit;

const TI: u32 = 1 << 30;
const DC: u32 = 1 << 27;

#[test]
fn a_match_is_reported_once_and_stays_pending_until_compare_is_written() {
    let mut bench = Bench::new(&[mtc0(COUNT, 0), mtc0(COMPARE, 2), WAIT, mtc0(COMPARE, 2), NOP]);
    bench.cpu.set_register(2, 40_000);
    assert_eq!(bench.run(200_000), Exit::CoreTimer);
    assert_eq!(bench.cpu.cycle(), 80_000);
    assert_eq!((bench.get(COUNT), bench.get(CAUSE) & TI), (40_000, TI));
    assert!(bench.cpu.is_timer_pending());
    assert_eq!(bench.run(100_000), Exit::Reached);
    assert!(bench.cpu.is_timer_pending());
    bench.set(COMPARE, 0);
    assert!(!bench.cpu.is_timer_pending());
}

#[test]
fn count_is_read_at_half_the_clock() {
    let words: Vec<u32> = (2..8).map(|register| mfc0(COUNT, register)).collect();
    let mut bench = Bench::new(&words);
    bench.set(COUNT, 100);
    bench.run(6);
    let found: Vec<u32> = (2..8).map(|register| bench.cpu.register(register)).collect();
    assert_eq!(found, [100, 100, 101, 101, 102, 102]);
}

#[test]
fn count_can_stand_still() {
    let mut bench = Bench::new(&[WAIT]);
    bench.set(COUNT, 5);
    bench.set(COMPARE, 6);
    bench.set(CAUSE, DC);
    assert_eq!(bench.run(1000), Exit::Reached);
    assert_eq!((bench.get(COUNT), bench.get(CAUSE)), (5, DC));
    bench.set(CAUSE, 0);
    assert_eq!(bench.run(1000), Exit::CoreTimer);
    assert_eq!(bench.cpu.cycle(), 1002);
}

#[test]
fn a_compare_that_has_passed_waits_for_a_whole_turn() {
    let mut bench = Bench::new(&[WAIT]);
    bench.set(COUNT, 1000);
    bench.set(COMPARE, 1000);
    assert_eq!(bench.run(1 << 40), Exit::CoreTimer);
    assert_eq!(bench.cpu.cycle(), 1 << 33);
}
