//! Which requests are taken, where their handlers are, and which registers they see.

use crate::bench::{
    BEV, BRANCH, Bench, CAUSE, EPC, ERET, ERL, EXCEPTION_BASE, EXL, FLASH, IE, INTERRUPT_CONTROL, NOP,
    SHADOW_CONTROL, STATUS, WAIT,
};
use pic32::cpu::{Exit, InterruptRequest};

const IV: u32 = 1 << 23;

fn request(level: u8, vector: u8) -> Option<InterruptRequest> {
    Some(InterruptRequest {
        level,
        vector,
        shadow_set: 0,
    })
}

fn taken(bench: &Bench) -> bool {
    bench.get(STATUS) & EXL != 0 && bench.get(CAUSE) & 0x7C == 0 && bench.bus.taken.len() == 1
}

#[test]
fn a_request_must_be_above_the_level_and_allowed() {
    let level = |level: u32| level << 10;
    let cases = [
        (IE, 1, true),
        (0, 7, false),
        (IE | ERL, 7, false),
        (IE | level(3), 3, false),
        (IE | level(3), 4, true),
        (IE | level(7), 7, false),
        (IE | level(32), 7, false),
        (IE | level(6), 7, true),
    ];
    for (status, requested, expected) in cases {
        let mut bench = Bench::new(&[NOP, NOP]);
        bench.set(STATUS, status);
        bench.cpu.interrupt(request(requested, 0));
        bench.step();
        assert_eq!(taken(&bench), expected, "status {status:x}, level {requested}");
    }
    let mut bench = Bench::new(&[NOP, NOP]);
    bench.set(STATUS, IE | EXL);
    bench.cpu.interrupt(request(7, 0));
    bench.step();
    assert_eq!(bench.bus.taken, []);
}

#[test]
fn handlers_stand_where_the_registers_say() {
    let base = 0x9D01_0000;
    let cases = [
        (0, IV, 1 << 5, 26, base + 0x200 + 26 * 32),
        (0, IV, 2 << 5, 26, base + 0x200 + 26 * 64),
        (0, IV, 16 << 5, 3, base + 0x200 + 3 * 512),
        (0, IV, 0, 26, base + 0x200),
        (0, 0, 1 << 5, 26, base + 0x180),
        (BEV, IV, 1 << 5, 26, 0xBFC0_0400),
        (BEV, 0, 1 << 5, 26, 0xBFC0_0380),
    ];
    for (status, cause, spacing, vector, address) in cases {
        let mut bench = Bench::new(&[NOP, NOP]);
        bench.set(STATUS, IE | status);
        bench.set(CAUSE, cause);
        bench.set(INTERRUPT_CONTROL, spacing);
        bench.cpu.interrupt(request(5, vector));
        bench.step();
        assert_eq!(
            bench.cpu.pc(),
            address,
            "{status:x} {cause:x} {spacing:x} {vector}"
        );
        assert_eq!(bench.get(EPC), FLASH);
        assert_eq!(bench.get(CAUSE), cause | 5 << 10);
        assert_eq!(bench.bus.taken[0].request, request(5, vector).unwrap());
        assert_eq!(bench.bus.taken[0].cycle, bench.cpu.cycle());
    }
}

#[test]
fn before_a_delay_slot_the_branch_is_interrupted() {
    let mut bench = Bench::new(&[NOP, BRANCH, NOP]);
    bench.set(STATUS, IE);
    bench.run(2);
    assert_eq!(bench.cpu.pc(), FLASH + 8);
    bench.cpu.interrupt(request(1, 0));
    bench.run(1);
    assert_eq!((bench.get(EPC), bench.get(CAUSE) >> 31), (FLASH + 4, 1));
}

#[test]
fn what_opens_the_door_lets_the_request_in_at_once() {
    let enable = 0x4160_6020;
    for (open, status) in [(enable, 0), (crate::bench::mtc0(STATUS, 2), 0), (ERET, IE | EXL)] {
        let mut bench = Bench::new(&[NOP, open, NOP]);
        bench.set(STATUS, status);
        bench.set(EPC, FLASH + 8);
        bench.cpu.set_register(2, IE);
        bench.cpu.interrupt(request(1, 0));
        bench.run(12);
        assert_eq!(
            (bench.bus.taken.len(), bench.get(EPC)),
            (1, FLASH + 8),
            "{open:x}"
        );
    }
    // And `di` closes it.
    let mut bench = Bench::new(&[0x4162_6000, NOP, NOP]);
    bench.set(STATUS, IE);
    bench.step();
    bench.cpu.interrupt(request(7, 0));
    bench.run(2);
    assert_eq!(
        (bench.bus.taken.len(), bench.get(STATUS), bench.cpu.register(2)),
        (0, 0, IE)
    );
}

#[test]
fn waiting_ends_with_a_request_above_the_level() {
    let cases = [
        (IE, 1, true),
        (0, 1, true),
        (IE | 3 << 10, 3, false),
        (3 << 10, 4, true),
    ];
    for (status, level, expected) in cases {
        let mut bench = Bench::new(&[WAIT, NOP, NOP]);
        bench.set(STATUS, status);
        assert_eq!(bench.run(1000), Exit::Reached);
        assert!(bench.cpu.is_waiting());
        assert_eq!(bench.cpu.idle_cycles(), 999);
        bench.cpu.interrupt(request(level, 0));
        bench.run(1);
        assert_eq!(
            !bench.cpu.is_waiting(),
            expected,
            "status {status:x}, level {level}"
        );
        // Without permission to interrupt, the program goes on behind `wait`.
        let is_handled = expected && status & IE != 0;
        assert_eq!(bench.bus.taken.len(), usize::from(is_handled));
        if is_handled {
            assert_eq!(bench.get(EPC), FLASH + 4);
        }
    }
}

#[test]
fn a_handler_can_have_registers_of_its_own() {
    // rdpgpr $2, $29; addiu $29, $0, 5; wrpgpr $3, $29; eret
    let handler = [0x415D_1000, 0x241D_0005, 0x41DD_1800, ERET];
    let mut bench = Bench::new(&[NOP, NOP]);
    bench.set(STATUS, IE);
    bench.set(CAUSE, IV);
    bench
        .memory
        .write(0x1D01_0200, &crate::bench::bytes(&handler))
        .unwrap();
    bench.cpu.set_register(29, 0x8000_7000);
    bench.cpu.interrupt(Some(InterruptRequest {
        level: 7,
        vector: 0,
        shadow_set: 1,
    }));
    bench.step();
    bench.cpu.interrupt(None);
    // Highest set 1; requested 1, previous 0, current 1.
    assert_eq!(bench.get(SHADOW_CONTROL), 1 << 26 | 1 << 18 | 1);
    assert_eq!(bench.cpu.register(29), 0);
    bench.step();
    assert_eq!(bench.cpu.register(2), 0x8000_7000);
    bench.step();
    bench.step();
    bench.step();
    assert_eq!(bench.get(SHADOW_CONTROL), 1 << 26 | 1 << 18);
    assert_eq!(
        [2, 3, 29].map(|number| bench.cpu.register(number)),
        [0, 5, 0x8000_7000]
    );
}

#[test]
fn exceptions_can_have_registers_of_their_own() {
    let mut bench = Bench::new(&[crate::bench::SYSCALL]);
    bench.set(SHADOW_CONTROL, 1 << 12);
    bench.cpu.set_register(4, 44);
    bench.step();
    assert_eq!(bench.get(SHADOW_CONTROL), 1 << 26 | 1 << 12 | 1);
    assert_eq!(bench.cpu.register(4), 0);
    // Not while the vectors are those of the boot flash.
    let mut bench = Bench::new(&[crate::bench::SYSCALL]);
    bench.set(STATUS, BEV);
    bench.set(SHADOW_CONTROL, 1 << 12);
    bench.step();
    assert_eq!(bench.get(SHADOW_CONTROL), 1 << 26 | 1 << 12);
}

#[test]
fn the_exception_base_is_where_it_was_written() {
    let mut bench = Bench::new(&[NOP]);
    bench.set(EXCEPTION_BASE, 0xFFFF_FFFF);
    assert_eq!(bench.get(EXCEPTION_BASE), 0xBFFF_F000);
}
