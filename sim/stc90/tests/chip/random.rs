//! Nothing that a program or a line does ends in a panic, and it does not matter how a run is cut into pieces.

use crate::rig::{edge, set};
use stc90::image::Image;
use stc90::machine::{Machine, Options};
use stc90::peripheral::LineFrame;
use stc90::pins::Level;

/// Numbers from a seed (splitmix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut value = self.0;
        value = (value ^ value >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        value = (value ^ value >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        value ^ value >> 31
    }
}

/// A chip with a program of noise, noise on its pins and on its line.
fn noise(seed: u64, cycles: u64) -> Machine {
    let mut numbers = Numbers(seed);
    let code: Vec<u8> = (0..0x8000).map(|_| numbers.next() as u8).collect();
    let mut image = Image::erased();
    assert!(image.write(0, &code), "it fits");
    assert!(image.write(0, &[0x02, 0x00, 0x80]), "it fits");
    for vector in 0..8 {
        // PUSH PSW; INC A; POP PSW; RETI
        let handler = [0xC0, 0xD0, 0x04, 0xD0, 0xD0, 0x32];
        assert!(image.write(3 + 8 * vector, &handler), "it fits");
    }
    let registers = [
        0x89, 0x8C, 0x8D, 0xC8, 0xCA, 0xCB, 0x98, 0x99, 0xB7, 0xB8, 0xC0, 0x88, 0xA8,
    ];
    let values = registers.map(|register| (register, numbers.next() as u8 | 0x80 & register));
    assert!(image.write(0x80, &set(&values)), "it fits");
    let mut machine = Machine::new(&image, Options::RELAX);
    for byte in machine.cpu_mut().ram_mut() {
        *byte = numbers.next() as u8;
    }
    for _ in 0..cycles / 200 {
        let number = numbers.next();
        let name = format!("P{}.{}", number % 5, number >> 8 & 7);
        let level = Level::of(number >> 16 & 1 != 0);
        machine.schedule_input(edge((number >> 20) % cycles, &name, level));
    }
    let mut cycle = 0;
    while cycle < cycles {
        let number = numbers.next();
        cycle += number % 3000;
        machine.hear(LineFrame::byte(cycle, number >> 12 & 0x3FF, (number >> 32) as u8));
    }
    machine
}

/// Everything that can be seen, and where the program is.
fn seen(machine: &mut Machine) -> Vec<String> {
    let registers: Vec<u8> = (0x80..=0xFF).map(|address| machine.register(address)).collect();
    let sent = machine.take_sent();
    vec![
        format!("cycle {}, pc {:04x}", machine.cycle(), machine.cpu().pc()),
        format!("registers {registers:02x?}"),
        format!("ram {:02x?}", machine.cpu().ram()),
        format!("sent {sent:?}"),
        format!("account {:?}", machine.account()),
        format!("misuses {:?}", machine.misuses()),
        format!("resets {:?}", machine.resets()),
    ]
}

#[test]
fn noise_harms_nothing_and_is_the_same_in_any_pieces() {
    const CYCLES: u64 = 60_000;
    for seed in 0..60 {
        let start = noise(seed, CYCLES);
        let mut whole = start.clone();
        whole.run_until(CYCLES);
        let mut stepped = start.clone();
        while stepped.cycle() < CYCLES {
            stepped.step();
        }
        let mut pieces = start.clone();
        let mut numbers = Numbers(seed + 1);
        while pieces.cycle() < CYCLES {
            let next = pieces.cycle() + numbers.next() % 500;
            pieces.run_until(next.min(CYCLES));
        }
        let whole = seen(&mut whole);
        let cut = [seen(&mut stepped), seen(&mut pieces)];
        for (part, other) in cut.iter().flat_map(|other| other.iter().zip(&whole)) {
            assert_eq!(part, other, "seed {seed}");
        }
    }
}
