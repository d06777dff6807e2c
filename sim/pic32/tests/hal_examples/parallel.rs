//! The examples of the parallel port, in two chips on one bus.

use crate::joined::{JoinedChips, Wire, back, forth};
use crate::{MS, assert_clean, image, pin, text};
use pic32::machine::{Machine, Uart};
use pic32::pins::Level;

#[test]
fn a_slave_answers_each_byte_of_the_master() {
    let (Some(master), Some(slave)) = (image("parallel_master"), image("parallel_slave")) else {
        return;
    };
    let mut wires: Vec<Wire> = ["RD4", "RD5", "RD11"].map(|name| forth(name, name)).to_vec();
    for line in 0..8 {
        let name = format!("RE{line}");
        wires.extend([forth(&name, &name), back(&name, &name)]);
    }
    let mut joined = JoinedChips::new(Machine::new(&master), Machine::new(&slave), wires);
    for name in ["RD4", "RD5", "RD11"] {
        joined.second.set_input(pin(name), Level::High);
    }
    for name in ["RD4", "RD5"] {
        joined.first.watch(pin(name));
    }
    joined.run(25 * MS);
    let said = text(&mut joined.first, Uart::One);
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.len() >= 18, "{said:?}");
    let mut byte = 0x5A_u8;
    for line in &lines[..lines.len() - 1] {
        assert_eq!(*line, format!("{byte:02X} {:02X}", !byte));
        byte = byte.wrapping_mul(5).wrapping_add(1);
    }
    assert_eq!(joined.second.level(pin("RG7")), Level::Low, "no byte was lost");
    for name in ["RD4", "RD5"] {
        let edges = joined.first.take_edges(pin(name));
        let strobes: Vec<u64> = edges
            .windows(2)
            .filter(|pair| !pair[0].1.is_high())
            .map(|pair| pair[1].0 - pair[0].0)
            .collect();
        assert!(
            strobes.len() >= lines.len(),
            "one access a byte: {} of {name}",
            strobes.len()
        );
        assert!(
            strobes.len() <= lines.len() + 1,
            "and no more: {} of {name}",
            strobes.len()
        );
        assert!(strobes.iter().all(|&cycles| cycles == 16), "{strobes:?}");
    }
    assert_clean(&joined.first);
    assert_clean(&joined.second);
}
