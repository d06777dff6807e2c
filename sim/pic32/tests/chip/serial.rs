//! UARTs: bit times, queues, errors, both ways.

use crate::program::{IFS0, IFS1, bare, pin, run};
use pic32::machine::{LineRate, Machine, Uart};
use pic32::peripheral::{Misuse, Sent};
use pic32::pins::Level;

const MODE: u32 = 0xBF80_6000;
const STA: u32 = 0xBF80_6010;
const TX: u32 = 0xBF80_6020;
const RX: u32 = 0xBF80_6030;
const BRG: u32 = 0xBF80_6040;
const ERROR: u32 = 1 << 26;
const RECEIVED: u32 = 1 << 27;
const TRANSMITTED: u32 = 1 << 28;

fn opened(brg: u32, mode: u32) -> Machine {
    let mut machine = bare();
    machine.set_input(pin("RF2"), Level::High);
    machine.write_register(BRG, brg);
    machine.write_register(MODE, 0x8000 | mode);
    machine.write_register(STA, 1 << 12 | 1 << 10);
    machine
}

#[test]
fn baud_rates_are_those_of_the_divider() {
    // BRGH, UxBRG, cycles of a bit.
    for (fast, brg, cycles) in [(1, 173, 696), (1, 86, 348), (0, 42, 688), (0, 129, 2080)] {
        let mut machine = opened(brg, fast << 3);
        machine.watch(pin("RF3"));
        let begin = machine.cycle();
        machine.write_register(TX, 0x55);
        run(&mut machine, begin + 20 * cycles);
        let edges: Vec<u64> = machine
            .take_edges(pin("RF3"))
            .iter()
            .map(|edge| edge.0 - begin)
            .collect();
        let expected: Vec<u64> = (0..10).map(|bit| bit * cycles).collect();
        assert_eq!(edges, expected, "BRG {brg}");
        assert_eq!(
            machine.take_sent(Uart::One),
            [(begin + 10 * cycles, Sent::Character(0x55))]
        );
    }
    // 115200 with BRGH = 1 and BRG = 173 is 114943 baud, -0.22 %.
    assert_eq!(80_000_000 / 696, 114_942);
}

#[test]
fn the_queue_holds_four_and_status_says_so() {
    let mut machine = opened(173, 8);
    assert_eq!(machine.read_register(STA) & 0x300, 0x100);
    for byte in 0..5 {
        machine.write_register(TX, byte);
    }
    assert_eq!(
        machine.read_register(STA) & 0x300,
        0x200,
        "one is on its way, four wait"
    );
    machine.write_register(TX, 99);
    assert_eq!(machine.misuses()[0].misuse, Misuse::TransmitQueueFull(1));
    run(&mut machine, 100 * 696);
    let sent: Vec<_> = machine.take_sent(Uart::One);
    let expected: Vec<_> = (0..5)
        .map(|byte| ((byte + 1) * 6960, Sent::Character(byte as u16)))
        .collect();
    assert_eq!(sent, expected, "without a pause");
    assert_eq!(machine.read_register(STA) & 0x300, 0x100);
}

#[test]
fn transmit_interrupts_by_their_selection() {
    for (selection, after_write, at_end) in [(0, true, true), (1, false, true), (2, true, true)] {
        let mut machine = opened(173, 8);
        machine.write_register(STA, 1 << 10 | selection << 14);
        machine.write_register(TX, 1);
        machine.write_register(IFS0, 0);
        assert_eq!(
            machine.read_register(IFS0) & TRANSMITTED != 0,
            after_write,
            "UTXISEL {selection}"
        );
        run(&mut machine, 6_959);
        assert_eq!(machine.read_register(IFS0) & TRANSMITTED != 0, after_write);
        run(&mut machine, 6_960);
        assert_eq!(machine.read_register(IFS0) & TRANSMITTED != 0, at_end);
    }
}

fn received(machine: &mut Machine) -> Vec<u32> {
    let mut bytes = Vec::new();
    while machine.read_register(STA) & 1 != 0 {
        let status = machine.read_register(STA) & 0xC;
        bytes.push(machine.read_register(RX) | status << 8);
    }
    bytes
}

#[test]
fn all_bytes_arrive_at_rates_within_four_percent() {
    for baud in [115_200, 114_943, 111_000, 119_000] {
        let mut machine = opened(173, 8);
        let mut got = Vec::new();
        let bytes: Vec<u8> = (0..=255).collect();
        let end = machine.send_to_uart(Uart::One, &bytes, (1_000, LineRate { baud }));
        while machine.cycle() < end + 1_000 {
            let next = machine.cycle() + 5_000;
            run(&mut machine, next);
            got.extend(received(&mut machine));
        }
        assert_eq!(got, (0..256).collect::<Vec<u32>>(), "{baud} baud");
    }
}

#[test]
fn a_wrong_rate_shows_as_framing_errors_or_other_bytes() {
    let mut machine = opened(173, 8);
    machine.send_to_uart(Uart::One, b"\0", (1_000, LineRate { baud: 57_600 }));
    run(&mut machine, 50_000);
    assert_eq!(machine.read_register(IFS0) & ERROR, ERROR);
    assert_eq!(received(&mut machine)[0], 4 << 8, "FERR");
}

#[test]
fn the_fifth_byte_overruns_and_clearing_empties_the_queue() {
    let mut machine = opened(173, 8);
    machine.send_to_uart(Uart::One, b"abcdefg", (0, LineRate { baud: 115_200 }));
    run(&mut machine, 80_000);
    assert_eq!(machine.read_register(STA) & 3, 3);
    assert_eq!(machine.read_register(IFS0) & (ERROR | RECEIVED), ERROR | RECEIVED);
    machine.write_register(IFS0, 0);
    assert_eq!(
        machine.read_register(IFS0) & ERROR,
        ERROR,
        "the cause is still there"
    );
    machine.write_register(STA + 4, 2);
    assert_eq!(machine.read_register(STA) & 3, 0);
    machine.write_register(IFS0, 0);
    assert_eq!(machine.read_register(IFS0) & (ERROR | RECEIVED), 0);
    let at = machine.cycle();
    machine.send_to_uart(Uart::One, b"h", (at, LineRate { baud: 115_200 }));
    run(&mut machine, at + 8_000);
    assert_eq!(received(&mut machine), [u32::from(b'h')]);
}

#[test]
fn a_break_both_ways() {
    let mut machine = opened(173, 8);
    machine.write_register(STA + 8, 1 << 11);
    machine.write_register(TX, 0x41);
    machine.write_register(TX, 0x42);
    run(&mut machine, 30_000);
    assert_eq!(
        machine.take_sent(Uart::One),
        [(14 * 696, Sent::Break), (24 * 696, Sent::Character(0x42))]
    );
    let rf2 = pin("RF2");
    machine.set_input(rf2, Level::Low);
    run(&mut machine, 60_000);
    machine.set_input(rf2, Level::High);
    assert_eq!(received(&mut machine), [4 << 8]);
}

#[test]
fn a_short_dip_is_no_start_bit() {
    let mut machine = opened(173, 8);
    machine.schedule_input(1_000, pin("RF2"), Level::Low);
    machine.schedule_input(1_300, pin("RF2"), Level::High);
    machine.send_to_uart(Uart::One, b"x", (2_000, LineRate { baud: 115_200 }));
    run(&mut machine, 20_000);
    assert_eq!(received(&mut machine), [u32::from(b'x')]);
}

#[test]
fn parity_nine_bits_and_loopback() {
    // PDSEL even, odd, nine bits.
    for (shape, bits, value) in [(1, 11, 0xA7), (2, 11, 0xA7), (3, 11, 0x1A7)] {
        let mut machine = opened(173, 8 | 1 << 6 | shape << 1);
        machine.write_register(TX, value);
        run(&mut machine, 20_000);
        assert_eq!(received(&mut machine), [value], "PDSEL {shape}");
        assert_eq!(machine.take_sent(Uart::One)[0].0, bits * 696);
    }
    // Even sent, odd expected: a parity error.
    let mut machine = opened(173, 8 | 2 << 1);
    machine.send_to_uart(Uart::One, &[0x01], (0, LineRate { baud: 114_943 }));
    run(&mut machine, 20_000);
    assert_eq!(
        received(&mut machine),
        [0x01 | 8 << 8],
        "the stop bit taken for parity"
    );
}

#[test]
fn uart_2_has_its_own_pins_and_interrupts() {
    let mut machine = bare();
    machine.set_input(pin("RF4"), Level::High);
    machine.write_register(BRG + 0x200, 173);
    machine.write_register(MODE + 0x200, 0x8008);
    machine.write_register(STA + 0x200, 1 << 12 | 1 << 10);
    machine.write_register(TX + 0x200, 7);
    assert_eq!(machine.level(pin("RF5")), Level::Low, "start bit");
    machine.send_to_uart(Uart::Two, &[9], (0, LineRate { baud: 115_200 }));
    run(&mut machine, 20_000);
    assert_eq!(machine.read_register(IFS1) & 0x700, 0x600);
    assert_eq!(machine.read_register(RX + 0x200), 9);
    assert_eq!(machine.take_sent(Uart::Two).len(), 1);
    assert_eq!(machine.take_sent(Uart::One).len(), 0);
}
