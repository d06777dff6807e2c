//! What ends a run, and what a debugger may do between.

use crate::program::{
    FOREVER, MS, NOP, Program, T0, T1, WAIT_FOREVER, bare, branch, li, run, store, sw, word,
};
use pic32::cpu::ExceptionCode;
use pic32::machine::{Grounded, Halt, Machine, ProgramFault, StopAt};
use pic32::peripheral::Misuse;

/// CHECON with too few wait states, then `break`, then an endless loop; the handler of the bootstrap counts at RAM 0.
fn faulty() -> Machine {
    let code = [store(0xBF88_4000, 0x31).as_slice(), &[NOP, 0x0000_000D], &FOREVER].concat();
    let handler = [
        li(T0, 0x8000_0000).as_slice(),
        &[0x2529_0001, sw(T1, 0, T0), branch(-1), NOP],
    ]
    .concat();
    Program::new(&code).at(0x1FC0_0380, &handler).machine()
}

#[test]
fn by_default_the_chip_goes_on() {
    let mut machine = faulty();
    run(&mut machine, MS);
    assert_eq!((machine.exceptions().len(), machine.misuses().len()), (1, 1));
    assert_eq!(word(&machine, 0), 0x32, "the handler ran");
}

#[test]
fn faults_end_a_run_if_they_are_to_and_it_goes_on_behind_them() {
    let mut machine = faulty();
    machine.stop_at(StopAt::ExceptionsAndMisuse);
    let misuse = Misuse::FlashTooFast { wait_states: 1 };
    assert_eq!(
        machine.run_until(MS, &mut Grounded),
        Halt::Fault(ProgramFault::Misuse(misuse))
    );
    let Halt::Fault(ProgramFault::Exception(exception)) = machine.run_until(MS, &mut Grounded) else {
        panic!("no exception")
    };
    assert_eq!(
        (exception.code, exception.address),
        (ExceptionCode::Breakpoint, 0xBFC0_0018)
    );
    assert_eq!(machine.run_until(MS, &mut Grounded), Halt::Reached);
    let mut machine = faulty();
    machine.stop_at(StopAt::Exceptions);
    assert!(matches!(
        machine.run_until(MS, &mut Grounded),
        Halt::Fault(ProgramFault::Exception(_))
    ));
}

#[test]
fn breakpoints_and_steps() {
    let mut machine = Program::new(&[NOP, NOP, branch(-3), NOP]).machine();
    machine.memory_mut().set_breakpoint(0x1FC0_0004).expect("flash");
    assert_eq!(machine.run_until(MS, &mut Grounded), Halt::Breakpoint);
    assert_eq!(machine.cpu().pc(), 0xBFC0_0004);
    machine.memory_mut().clear_breakpoint(0x1FC0_0004).expect("flash");
    let places: Vec<u32> = (0..4)
        .map(|_| {
            assert_eq!(machine.step(&mut Grounded), Halt::Reached);
            machine.cpu().pc()
        })
        .collect();
    assert_eq!(places, [0xBFC0_0008, 0xBFC0_0000, 0xBFC0_0004, 0xBFC0_0008]);
}

#[test]
fn steps_let_time_pass_where_nothing_is_executed() {
    let mut machine = Program::new(&WAIT_FOREVER).machine();
    run(&mut machine, 1_000);
    machine.step(&mut Grounded);
    assert_eq!(machine.cycle(), 1_001, "in WAIT");
    let mut machine = bare();
    run(&mut machine, 1_000);
    machine.fail_oscillator();
    machine.step(&mut Grounded);
    machine.step(&mut Grounded);
    assert_eq!(machine.cycle(), 1_002, "without a clock");
}
