//! The examples of SPI and I2C, in two chips that are joined by wires.

use crate::joined::{JoinedChips, back, forth, open};
use crate::{MS, assert_clean, image, pin, text};
use pic32::machine::{Machine, Uart};
use pic32::pins::Level;

#[test]
fn spi_master_and_slave_exchange_every_byte() {
    let (Some(master), Some(slave)) = (image("spi_master"), image("spi_slave")) else {
        return;
    };
    let wires = vec![
        forth("RG6", "RG6"),
        forth("RG8", "RG7"),
        back("RG8", "RG7"),
        forth("RG9", "RG9"),
    ];
    let mut joined = JoinedChips::new(Machine::new(&master), Machine::new(&slave), wires);
    joined.second.set_input(pin("RG9"), Level::High);
    joined.first.watch(pin("RG6"));
    joined.run(25 * MS);
    let said = text(&mut joined.first, Uart::One);
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.len() >= 10, "{said:?}");
    for line in &lines[..lines.len() - 1] {
        assert_eq!(*line, "00 9F 01 02");
    }
    let edges = joined.first.take_edges(pin("RG6"));
    let bit = edges[2].0 - edges[0].0;
    assert_eq!(bit, 80, "1 MHz");
    assert_eq!(joined.second.level(pin("RD1")), Level::Low, "no byte was lost");
    assert_clean(&joined.first);
    assert_clean(&joined.second);
}

#[test]
fn frames_arrive_in_their_order_both_ways() {
    let Some(image) = image("spi_framed") else { return };
    let wires = vec![
        forth("RG6", "RG6"),
        forth("RG8", "RG7"),
        back("RG8", "RG7"),
        forth("RG9", "RG9"),
    ];
    let mut joined = JoinedChips::new(Machine::new(&image), Machine::new(&image), wires);
    joined.first.set_input(pin("RE0"), Level::High);
    joined.run(20 * MS);
    for machine in [&mut joined.first, &mut joined.second] {
        let said = text(machine, Uart::One);
        let numbers: Vec<&str> = said.lines().collect();
        assert!(numbers.len() >= 12, "{said:?}");
        for (number, line) in (1..).zip(&numbers[..numbers.len() - 1]) {
            assert_eq!(line.parse(), Ok(number), "{said:?}");
        }
        assert_clean(machine);
    }
}

#[test]
fn i2c_master_finds_its_memory_and_names_who_is_absent() {
    let (Some(master), Some(slave)) = (image("i2c_master"), image("i2c_slave")) else {
        return;
    };
    let wires = vec![open("RG3", "RA3"), open("RG2", "RA2")];
    let mut joined = JoinedChips::new(Machine::new(&master), Machine::new(&slave), wires);
    joined.first.watch(pin("RG2"));
    joined.run(30 * MS);
    let said = text(&mut joined.first, Uart::One);
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.len() >= 8, "{said:?}");
    for (round, pair) in (1..).zip(lines[..lines.len() - 1].chunks(2)) {
        assert_eq!(pair[0], format!("{round} A5 00 FF"));
        if let Some(nobody) = pair.get(1) {
            assert_eq!(*nobody, "nobody: no device acknowledged the address");
        }
    }
    let edges = joined.first.take_edges(pin("RG2"));
    let shortest = edges.windows(3).map(|three| three[2].0 - three[0].0).min();
    // 400 kHz is 200 cycles; the chips see each other up to five cycles late.
    assert!(
        (200..=215).contains(&shortest.unwrap_or(0)),
        "{shortest:?} cycles a clock"
    );
    assert_clean(&joined.first);
    assert_clean(&joined.second);
}

/// A device that holds data, as after a reset within a byte, is clocked until it lets go; then the memory answers again.
#[test]
fn a_bus_that_somebody_holds_is_named_and_freed() {
    let Some(master) = image("i2c_master") else { return };
    let mut machine = Machine::new(&master);
    machine.pull_up(pin("RG2"));
    machine.pull_up(pin("RG3"));
    machine.set_input(pin("RG3"), Level::Low);
    machine.watch(pin("RG2"));
    crate::run(&mut machine, 8 * MS);
    let said = text(&mut machine, Uart::One);
    assert!(
        said.starts_with("memory: another one drove the bus in step Start"),
        "{said:?}"
    );
    let falls = machine
        .take_edges(pin("RG2"))
        .iter()
        .filter(|edge| !edge.1.is_high())
        .count();
    assert!(falls >= 9, "nine clocks by hand: {falls}");
    machine.release_input(pin("RG3"));
    crate::run(&mut machine, 30 * MS);
    let said = text(&mut machine, Uart::One);
    let last = said.lines().last().unwrap_or_default();
    assert!(last.contains("no device"), "nobody is on this bus: {said:?}");
}
