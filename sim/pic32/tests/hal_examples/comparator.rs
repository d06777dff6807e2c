//! The example of the comparators, with voltages that rise and fall.

use crate::{MS, assert_clean, image, pin};
use pic32::machine::{Halt, Machine, Outputs, Surroundings};

/// AN4 goes up and down between ground and the supply, 10 ms each way; AN3 is above 1.2 V from 25 ms on.
struct Triangle;

impl Surroundings for Triangle {
    fn analog(&mut self, channel: u8, cycle: u64, _: &Outputs<'_>) -> u16 {
        match channel {
            4 => {
                let phase = cycle % (20 * MS);
                let distance = phase.min(20 * MS - phase);
                (distance * 1023 / (10 * MS)) as u16
            }
            3 if cycle < 25 * MS => 371,
            3 => 375,
            _ => panic!("AN{channel} is not compared"),
        }
    }
}

#[test]
fn crossings_of_the_reference_are_seen_at_once() {
    let Some(image) = image("comparator") else { return };
    let mut machine = Machine::new(&image);
    machine.watch(pin("RG7"));
    machine.watch(pin("RG8"));
    assert_eq!(machine.run_until(50 * MS, &mut Triangle), Halt::Reached);
    let edges = machine.take_edges(pin("RG7"));
    assert_eq!(edges.len(), 5, "{edges:?}");
    for (number, (cycle, level)) in (0..).zip(edges) {
        // Half of the supply at 5 ms, 15 ms ..; a count of the level is 782 cycles.
        let expected = (5 + 10 * number) * MS;
        let off = cycle as i64 - expected as i64;
        assert!(off.abs() < 1_500, "crossing {number}: {off} cycles");
        assert_eq!(level.is_high(), number % 2 == 0);
    }
    let edges = machine.take_edges(pin("RG8"));
    assert_eq!(edges.len(), 1, "{edges:?}");
    assert!((25 * MS..27 * MS).contains(&edges[0].0) && edges[0].1.is_high());
    assert_clean(&machine);
}
