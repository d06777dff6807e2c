//! Programs that write anything anywhere: nothing panics, and it does not matter in which steps time passes or who watches.

use crate::program::{MS, interrupting, oc, run, timer};
use pic32::machine::{Grounded, LineRate, Machine, ResetSource, Uart};
use pic32::pins::{Level, Pin};

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ mixed >> 31
    }

    fn below(&mut self, limit: u64) -> u64 {
        self.next() % limit
    }

    fn word(&mut self) -> u32 {
        let word = self.next() as u32;
        // Registers are more interesting with few bits, and with ON.
        match self.below(4) {
            0 => word,
            1 => word & 0xFFFF,
            2 => word & 0xFF | 0x8000,
            _ => 1 << (word % 32),
        }
    }
}

/// All registers, by asking.
fn registers(machine: &mut Machine) -> Vec<u32> {
    let windows = [0xBF80_0000..0xBF81_0000, 0xBF88_0000..0xBF89_0000u32];
    let addresses = windows.into_iter().flat_map(|window| window.step_by(16));
    addresses
        .filter(|&address| machine.peek_register(address).is_some())
        .collect()
}

/// Something that a program, a person or an accident does, as one number says.
fn disturb(machine: &mut Machine, registers: &[u32], seed: u64) {
    let mut random = Random(seed);
    let pins: Vec<Pin> = Pin::all().collect();
    let pin = pins[random.below(pins.len() as u64) as usize];
    let soon = machine.cycle() + random.below(3_000);
    match random.below(64) {
        0 => machine.reset(
            [
                ResetSource::BrownOut,
                ResetSource::PowerOn,
                ResetSource::MasterClear,
            ][random.below(3) as usize],
        ),
        1 => machine.fail_oscillator(),
        2 => machine.release_input(pin),
        3 => machine.pull_up(pin),
        4 => _ = machine.send_to_uart(Uart::One, &seed.to_le_bytes(), (soon, LineRate { baud: 230_400 })),
        5..=9 => machine.set_input(pin, Level::of(random.below(2) == 0)),
        10..=15 => machine.schedule_input(soon, pin, Level::of(random.below(2) == 0)),
        16..=20 => _ = machine.read_register(registers[random.below(registers.len() as u64) as usize]),
        21..=26 => {
            let number = 1 + random.below(5) as u32;
            machine.write_register(timer(number) + 0x20, random.below(5_000) as u32);
            machine.write_register(timer(number), 0x8000 | (random.below(3) as u32) << 4);
        }
        27..=36 => {
            let number = 1 + random.below(5) as u32;
            machine.write_register(oc(number) + 0x20, random.below(5_000) as u32);
            machine.write_register(oc(number), 0x8006 | (random.below(2) as u32) << 3);
        }
        _ => {
            let register = registers[random.below(registers.len() as u64) as usize];
            machine.write_register(register + 4 * random.below(4) as u32, random.word());
        }
    }
}

/// What can be seen of a machine.
fn seen(machine: &mut Machine, registers: &[u32]) -> (u64, Vec<u32>, Vec<(u64, bool)>) {
    let values = registers
        .iter()
        .filter_map(|&register| machine.peek_register(register))
        .collect();
    let pins = Pin::all()
        .map(|pin| (machine.high_cycles(pin), machine.level(pin).is_high()))
        .collect();
    (machine.cycle(), values, pins)
}

fn disturbed(seed: u64, monitor: bool) {
    let vectors: Vec<(u32, u32, u32)> = (0..23).map(|vector| (vector, 0xBF88_1030, vector)).collect();
    let program = interrupting(&[(timer(3), 0x8000)], &vectors);
    let program = if monitor {
        program.devcfg1(crate::program::DEVCFG1_MONITOR)
    } else {
        program
    };
    let mut coarse = program.machine();
    let registers = registers(&mut coarse);
    run(&mut coarse, MS);
    let mut fine = coarse.clone();
    Pin::all().for_each(|pin| fine.watch(pin));
    let mut random = Random(seed);
    for _ in 0..60 {
        let what = random.next();
        disturb(&mut coarse, &registers, what);
        disturb(&mut fine, &registers, what);
        let end = coarse.cycle() + random.below(9_000);
        coarse.run_until(end, &mut Grounded);
        while fine.cycle() < coarse.cycle() {
            let next = (fine.cycle() + 1 + random.below(700)).min(coarse.cycle());
            fine.run_until(next, &mut Grounded);
        }
        assert_eq!(
            seen(&mut coarse, &registers),
            seen(&mut fine, &registers),
            "seed {seed}"
        );
    }
}

#[test]
fn steps_and_watching_change_nothing() {
    for seed in 0..150 {
        disturbed(seed, seed % 2 == 0);
    }
}
