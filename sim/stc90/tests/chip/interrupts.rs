//! Interrupts: when they are called, in which order, and by which pins.

use crate::rig::{STAY, after, edge, machine, pin, ram};
use stc90::machine::Machine;
use stc90::peripheral::Source;
use stc90::pins::Level;

const TCON: u8 = 0x88;
const IE: u8 = 0xA8;
const IPH: u8 = 0xB7;
const IP: u8 = 0xB8;
const XICON: u8 = 0xC0;

/// INC direct; RETI
const fn counting(address: u8) -> [u8; 3] {
    [0x05, address, 0x32]
}

/// Runs to an address and says in which cycle it is reached.
fn cycle_at(machine: &mut Machine, pc: u16) -> u64 {
    for _ in 0..10_000 {
        if machine.cpu().pc() == pc {
            return machine.cycle();
        }
        machine.step();
    }
    panic!("{pc:#x} is not reached");
}

/// A falling edge in one cycle is seen in the next; if that ends an instruction, the call takes the two after it.
#[test]
fn the_shortest_answer_takes_three_cycles() {
    let nops = [0; 64];
    let program = after(&[(TCON, 1), (IE, 0x81)], &nops);
    let mut machine = machine(&[(0, &[0x80, 0x3E]), (3, &counting(0x30)), (0x40, &program)]);
    machine.schedule_input(edge(20, "P3.2", Level::Low));
    assert_eq!(cycle_at(&mut machine, 3), 20 + 3);
    assert_eq!(machine.account().of(Source::External0).calls, 1);
}

/// MUL takes four cycles, and a call waits for its end.
#[test]
fn an_instruction_is_not_interrupted() {
    let products = [0xA4; 64];
    let program = after(&[(TCON, 1), (IE, 0x81)], &products);
    let answers: Vec<u64> = (20..24)
        .map(|cycle| {
            let parts: [(u16, &[u8]); 3] = [(0, &[0x80, 0x3E]), (3, &counting(0x30)), (0x40, &program)];
            let mut machine = machine(&parts);
            machine.schedule_input(edge(cycle, "P3.2", Level::Low));
            cycle_at(&mut machine, 3) - cycle
        })
        .collect();
    let mut sorted = answers.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, [3, 4, 5, 6], "{answers:?}");
}

/// After RETI, and after a write to IE or IP, one more instruction is executed first.
#[test]
fn one_instruction_comes_before_the_next_call() {
    // The level at P3.2 stays low: the handler is called again and again, with one INC between.
    let main = after(&[(IE, 0x81)], &[0x05, 0x31, 0x80, 0xFC]);
    let mut machine = machine(&[(0, &[0x80, 0x3E]), (3, &counting(0x30)), (0x40, &main)]);
    machine.set_input(pin("P3.2"), Level::Low);
    cycle_at(&mut machine, 3);
    assert_eq!([ram(&machine, 0x30), ram(&machine, 0x31)], [0, 1]);
    for count in 1..10 {
        machine.step();
        cycle_at(&mut machine, 3);
        assert_eq!(ram(&machine, 0x30), count);
    }
}

/// An edge is remembered and answered once; a level as long as it lasts.
#[test]
fn edges_are_answered_once() {
    for (kind, calls) in [(1, 1), (0, 4)] {
        let main = after(&[(TCON, kind), (IE, 0x81)], &STAY);
        let mut machine = machine(&[(0, &[0x80, 0x3E]), (3, &counting(0x30)), (0x40, &main)]);
        machine.schedule_input(edge(100, "P3.2", Level::Low));
        machine.schedule_input(edge(130, "P3.2", Level::High));
        machine.run_until(1000);
        assert!(ram(&machine, 0x30) >= calls, "{kind}");
        assert_eq!(ram(&machine, 0x30) == 1, kind == 1);
    }
}

/// INT2 is P4.3 and INT3 is P4.2; XICON has their bits, IPH the upper half of their priority.
#[test]
fn port_4_has_two_more() {
    // INT2: wait in the handler for INT3, which has the higher level.
    let waiting = [0xE5, 0x31, 0x60, 0xFC, 0x05, 0x30, 0x32];
    let main = after(&[(IPH, 0x80), (XICON, 0x55), (IE, 0x80)], &STAY);
    let mut machine = machine(&[
        (0, &[0x80, 0x4E]),
        (0x33, &waiting),
        (0x3B, &counting(0x31)),
        (0x50, &main),
    ]);
    machine.schedule_input(edge(100, "P4.3", Level::Low));
    machine.schedule_input(edge(200, "P4.2", Level::Low));
    machine.run_until(190);
    assert_eq!([ram(&machine, 0x30), ram(&machine, 0x31)], [0, 0]);
    machine.run_until(300);
    assert_eq!([ram(&machine, 0x30), ram(&machine, 0x31)], [1, 1]);
    assert_eq!(machine.register(XICON), 0x55);
}

/// Four levels: timer 0 at 0, timer 1 at 1, INT0 at 2, INT1 at 3, each of which interrupts the ones below.
#[test]
fn four_levels_nest() {
    let stay = |address: u8| [0x05, address, 0x80, 0xFE];
    let main = after(&[(IP, 0x0C), (IPH, 0x05), (TCON, 0x05), (IE, 0x8F)], &STAY);
    let mut machine = machine(&[
        (0, &[0x80, 0x4E]),
        (0x03, &stay(0x32)),
        (0x0B, &stay(0x30)),
        (0x13, &stay(0x33)),
        (0x1B, &stay(0x31)),
        (0x50, &main),
    ]);
    machine.run_until(100);
    let mut told = Vec::new();
    for step in 0..4 {
        match step {
            0 => _ = machine.cpu_mut(),
            1 => {}
            2 => machine.set_input(pin("P3.2"), Level::Low),
            _ => machine.set_input(pin("P3.3"), Level::Low),
        }
        machine.run_until(machine.cycle() + 20);
        told.push([0x30, 0x31, 0x32, 0x33].map(|address| ram(&machine, address)));
    }
    assert_eq!(told[3], [0, 0, 1, 1]);
    // A lower one does not come through.
    machine.set_input(pin("P3.2"), Level::High);
    machine.set_input(pin("P3.2"), Level::Low);
    machine.run_until(machine.cycle() + 50);
    assert_eq!(ram(&machine, 0x32), 1);
}

#[test]
fn time_in_handlers_is_accounted() {
    // Timer 0 every 256 cycles; the handler takes call 2, INC 1, RETI 2.
    let main = after(&[(0x89, 2), (TCON, 0x10), (IE, 0x82)], &STAY);
    let mut machine = machine(&[(0, &[0x80, 0x3E]), (0x0B, &counting(0x30)), (0x40, &main)]);
    machine.run_until(256 * 100 + 50);
    let account = machine.account().of(Source::Timer0);
    assert_eq!(account.calls, 100);
    assert_eq!((account.cycles, account.longest_cycles), (500, 5));
}
