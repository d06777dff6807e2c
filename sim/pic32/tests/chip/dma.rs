//! DMA: registers, cells and blocks, what starts and ends them, chains, priorities, CRC, wrong addresses.

use crate::program::{
    CLR, IEC1, IFS0, IFS1, INTCON, MS, SET, bare, interrupting, ipc, pin, run, timer, word,
};
use pic32::machine::{Halt, Machine, Outputs, Surroundings, Uart};
use pic32::peripheral::{DmaRequests, Misuse, Sent};
use pic32::pins::Level;

const DMACON: u32 = 0xBF88_3000;
const DMASTAT: u32 = 0xBF88_3010;
const DMAADDR: u32 = 0xBF88_3020;
const DCRCCON: u32 = 0xBF88_3030;
const DCRCDATA: u32 = 0xBF88_3040;
const DCRCXOR: u32 = 0xBF88_3050;
const ON: u32 = 1 << 15;
const SUSPEND: u32 = 1 << 12;

/// Registers of a channel, by their distance from its first.
const CON: u32 = 0;
const ECON: u32 = 0x10;
const INT: u32 = 0x20;
const SSA: u32 = 0x30;
const DSA: u32 = 0x40;
const SSIZ: u32 = 0x50;
const DSIZ: u32 = 0x60;
const SPTR: u32 = 0x70;
const DPTR: u32 = 0x80;
const CSIZ: u32 = 0x90;
const CPTR: u32 = 0xA0;
const DAT: u32 = 0xB0;

const CHAEN: u32 = 1 << 4;
const CHCHN: u32 = 1 << 5;
const CHAED: u32 = 1 << 6;
const CHEN: u32 = 1 << 7;
const CHCHNS: u32 = 1 << 8;
const CHEDET: u32 = 1 << 2;
const AIRQEN: u32 = 1 << 3;
const SIRQEN: u32 = 1 << 4;
const PATEN: u32 = 1 << 5;
const CABORT: u32 = 1 << 6;
const CFORCE: u32 = 1 << 7;

const CHER: u32 = 1 << 0;
const CHTA: u32 = 1 << 1;
const CHCC: u32 = 1 << 2;
const CHBC: u32 = 1 << 3;
const CHDH: u32 = 1 << 4;
const CHDD: u32 = 1 << 5;
const CHSH: u32 = 1 << 6;
const CHSD: u32 = 1 << 7;

const FROM: u32 = 0x100;
const TO: u32 = 0x400;
const FLASH: u32 = 0x1D00_0000;

const fn channel(number: u32) -> u32 {
    0xBF88_3060 + 0xC0 * number
}

/// A machine with DMA on and the numbers from 1 on in RAM.
fn opened() -> Machine {
    let mut machine = bare();
    let numbers: Vec<u8> = (1..=255).collect();
    machine.memory_mut().write(FROM, &numbers).expect("in RAM");
    machine.write_register(DMACON, ON);
    machine
}

/// Sets up a channel that is not on yet: from, to, their sizes and that of a cell.
fn set_up(
    machine: &mut Machine,
    number: u32,
    (from, to): (u32, u32),
    (source, destination, cell): (u32, u32, u32),
) {
    for (register, value) in [
        (SSA, from),
        (DSA, to),
        (SSIZ, source),
        (DSIZ, destination),
        (CSIZ, cell),
    ] {
        machine.write_register(channel(number) + register, value);
    }
}

fn pass(machine: &mut Machine, cycles: u64) {
    let next = machine.cycle() + cycles;
    run(machine, next);
}

fn ram(machine: &Machine, address: u32, length: usize) -> Vec<u8> {
    let mut bytes = vec![0; length];
    machine.memory().read(address, &mut bytes).expect("in RAM");
    bytes
}

fn flags(machine: &mut Machine, number: u32) -> u32 {
    machine.read_register(channel(number) + INT) & 0xFF
}

fn is_on(machine: &mut Machine, number: u32) -> bool {
    machine.read_register(channel(number) + CON) & CHEN != 0
}

#[test]
fn registers_hold_their_bits_and_no_others() {
    let mut machine = bare();
    for (register, reset, all) in [
        (DMACON, 0, 0xB000),
        (DMASTAT, 0, 0),
        (DMAADDR, 0, 0),
        (DCRCCON, 0, 0x0FC3),
        (DCRCDATA, 0, 0xFFFF),
        (DCRCXOR, 0, 0xFFFF),
    ] {
        assert_eq!(machine.read_register(register), reset, "{register:#x}");
        machine.write_register(register, u32::MAX);
        assert_eq!(machine.read_register(register), all, "{register:#x}");
    }
    machine.write_register(DMACON, 0);
    for number in 0..4 {
        for (register, reset, written, all) in [
            (CON, 0, !(CHEN | CHCHN), 0x153),
            (ECON, 0x00FF_FF00, !(CFORCE | CABORT), 0x00FF_FF38),
            (INT, 0, u32::MAX, 0x00FF_00FF),
            (SSA, 0, u32::MAX, u32::MAX),
            (DSA, 0, u32::MAX, u32::MAX),
            (SSIZ, 0, u32::MAX, 0xFF),
            (DSIZ, 0, u32::MAX, 0xFF),
            (SPTR, 0, u32::MAX, 0),
            (DPTR, 0, u32::MAX, 0),
            (CSIZ, 0, u32::MAX, 0xFF),
            (CPTR, 0, u32::MAX, 0),
            (DAT, 0, u32::MAX, 0xFF),
        ] {
            let address = channel(number) + register;
            assert_eq!(machine.read_register(address), reset, "{address:#x}");
            machine.write_register(address, written);
            assert_eq!(machine.read_register(address), all, "{address:#x}");
        }
    }
    assert_eq!(machine.unknown_accesses(), []);
    assert_eq!(machine.misuses(), []);
}

#[test]
fn a_forced_block_comes_cell_by_cell_and_tells_its_halves() {
    let mut machine = opened();
    set_up(&mut machine, 0, (FROM, TO), (8, 8, 4));
    machine.write_register(channel(0) + CON, CHEN);
    pass(&mut machine, 100);
    assert_eq!(flags(&mut machine, 0), 0, "nothing starts it");
    machine.write_register(channel(0) + ECON + SET, CFORCE);
    pass(&mut machine, 100);
    assert_eq!(ram(&machine, TO, 8), [1, 2, 3, 4, 0, 0, 0, 0]);
    assert_eq!(flags(&mut machine, 0), CHCC | CHDH | CHSH);
    let pointers = [SPTR, DPTR, CPTR].map(|register| machine.read_register(channel(0) + register));
    assert_eq!(pointers, [4, 4, 0]);
    assert!(is_on(&mut machine, 0));
    machine.write_register(channel(0) + INT + CLR, 0xFF);
    machine.write_register(channel(0) + ECON + SET, CFORCE);
    pass(&mut machine, 100);
    assert_eq!(ram(&machine, TO, 9), [1, 2, 3, 4, 5, 6, 7, 8, 0]);
    assert_eq!(flags(&mut machine, 0), CHCC | CHBC | CHDD | CHSD);
    assert!(!is_on(&mut machine, 0));
    assert_eq!(machine.read_register(channel(0) + DPTR), 0);
    assert_eq!(machine.misuses(), []);
}

#[test]
fn the_smaller_side_wraps_and_sizes_of_zero_are_256() {
    let mut machine = opened();
    set_up(&mut machine, 2, (FROM, TO), (3, 8, 0));
    machine.write_register(channel(2) + CON, CHEN);
    machine.write_register(channel(2) + ECON, CFORCE);
    pass(&mut machine, 100);
    assert_eq!(ram(&machine, TO, 9), [1, 2, 3, 1, 2, 3, 1, 2, 0]);
    set_up(&mut machine, 2, (FROM + 1, TO + 2), (0, 0, 0));
    machine.write_register(channel(2) + CON, CHEN);
    machine.write_register(channel(2) + ECON, CFORCE);
    pass(&mut machine, 2_000);
    let copied = ram(&machine, TO + 2, 256);
    assert_eq!(copied[..254], ram(&machine, FROM + 1, 254)[..]);
    assert_eq!((copied[253], copied[254]), (255, 0));
    assert_eq!(machine.read_register(DMAADDR), TO + 2 + 255);
    assert_eq!(machine.read_register(DMASTAT), 2, "channel 2 wrote last");
}

#[test]
fn each_period_of_a_timer_starts_a_cell_with_its_interrupt_off() {
    let mut machine = opened();
    set_up(&mut machine, 1, (FROM, TO), (3, 3, 1));
    machine.write_register(channel(1) + ECON, 8 << 8 | SIRQEN);
    machine.write_register(channel(1) + CON, CHEN);
    machine.write_register(timer(2) + 0x20, 999);
    machine.write_register(timer(2), 1 << 15);
    for (cycles, moved) in [(900, 0), (200, 1), (1_000, 2), (1_000, 3), (1_000, 3)] {
        pass(&mut machine, cycles);
        assert_eq!(
            ram(&machine, TO, 4).iter().filter(|byte| **byte != 0).count(),
            moved
        );
    }
    assert_eq!(
        machine.read_register(IFS0) & 1 << 8,
        1 << 8,
        "the flag is set besides"
    );
}

#[test]
fn events_before_a_channel_is_on_count_when_it_wants_them() {
    for (wanted, detected) in [(0, false), (CHAED, true)] {
        let mut machine = opened();
        set_up(&mut machine, 0, (FROM, TO), (1, 1, 1));
        machine.write_register(channel(0) + ECON, SIRQEN | 4 << 8);
        machine.write_register(channel(0) + CON, wanted);
        machine.write_register(timer(1) + 0x20, 99);
        machine.write_register(timer(1), 1 << 15);
        pass(&mut machine, 150);
        machine.write_register(timer(1), 0);
        assert_eq!(machine.read_register(channel(0) + CON) & CHEDET != 0, detected);
        machine.write_register(channel(0) + CON + SET, CHEN);
        pass(&mut machine, 100);
        assert_eq!(ram(&machine, TO, 1), [u8::from(detected)]);
    }
}

/// UART 1 at a million bits a second, sends; pin RF2 is idle.
fn start_uart(machine: &mut Machine) {
    machine.set_input(pin("RF2"), Level::High);
    machine.write_register(0xBF80_6040, 19);
    machine.write_register(0xBF80_6000, ON | 1 << 3);
    machine.write_register(0xBF80_6010, 1 << 10 | 1 << 12);
}

#[test]
fn a_uart_sends_and_receives_however_its_requests_count() {
    for requests in [DmaRequests::WhileUp, DmaRequests::OncePerEvent] {
        let mut machine = opened();
        machine.set_dma_requests(requests);
        start_uart(&mut machine);
        set_up(&mut machine, 0, (FROM, 0x1F80_6020), (20, 1, 1));
        machine.write_register(channel(0) + ECON, 28 << 8 | SIRQEN);
        set_up(&mut machine, 1, (0x1F80_6030, TO), (1, 20, 1));
        machine.write_register(channel(1) + ECON, 27 << 8 | SIRQEN);
        machine.write_register(channel(1) + CON, CHEN | 3);
        machine.write_register(channel(0) + CON, CHEN);
        machine.write_register(channel(0) + ECON + SET, CFORCE);
        for (number, byte) in (1..=20_u64).zip(101_u8..) {
            machine.send_characters(
                pin("RF2"),
                &[byte],
                (number * 1_000, pic32::machine::LineRate { baud: 1_000_000 }),
            );
        }
        let begun = machine.cycle();
        while flags(&mut machine, 0) & CHBC == 0 {
            pass(&mut machine, 100);
            assert!(machine.cycle() < begun + MS, "{requests:?}");
        }
        pass(&mut machine, 20_000);
        let sent: Vec<Sent> = machine
            .take_sent(Uart::One)
            .into_iter()
            .map(|(_, sent)| sent)
            .collect();
        let expected: Vec<Sent> = (1..=20).map(Sent::Character).collect();
        assert_eq!(sent, expected, "{requests:?}");
        assert_eq!(
            ram(&machine, TO, 20),
            (101..=120).collect::<Vec<u8>>(),
            "{requests:?}"
        );
        assert_eq!(flags(&mut machine, 1) & CHBC, CHBC);
        assert_eq!(machine.misuses(), [], "{requests:?}");
    }
}

#[test]
fn an_spi_exchanges_words_without_a_pause() {
    for requests in [DmaRequests::WhileUp, DmaRequests::OncePerEvent] {
        for (width, bytes) in [(0, 1), (1 << 10, 2), (1 << 11, 4)] {
            let mut machine = opened();
            machine.set_dma_requests(requests);
            let spi = 0xBF80_5A00;
            machine.write_register(spi + 0x30, 3);
            machine.write_register(spi, ON | 1 << 5 | 1 << 8 | width);
            machine.set_input(pin("RG7"), Level::High);
            set_up(&mut machine, 3, (0x1F80_5A20, TO), (bytes, 8 * bytes, bytes));
            machine.write_register(channel(3) + ECON, 39 << 8 | SIRQEN);
            machine.write_register(channel(3) + CON, CHEN | 3);
            set_up(&mut machine, 2, (FROM, 0x1F80_5A20), (8 * bytes, bytes, bytes));
            machine.write_register(channel(2) + ECON, 38 << 8 | SIRQEN);
            machine.write_register(channel(2) + CON, CHEN);
            let begun = machine.cycle();
            machine.write_register(channel(2) + ECON + SET, CFORCE);
            // 8 words at 10 MHz.
            let clocks = u64::from(8 * bytes * 8 * 8);
            run(&mut machine, begun + clocks + 40);
            assert_eq!(flags(&mut machine, 3) & CHBC, CHBC, "{requests:?} {bytes}");
            assert_eq!(
                ram(&machine, TO, 8 * bytes as usize),
                vec![0xFF; 8 * bytes as usize]
            );
            assert_eq!(machine.read_register(spi + 0x10) & 0x40, 0, "no overrun");
            assert_eq!(machine.misuses(), [], "{requests:?} {bytes}");
        }
    }
}

/// Each sample is one more than the one before.
#[derive(Default)]
struct Stairs(u16);

impl Surroundings for Stairs {
    fn analog(&mut self, _: u8, _: u64, _: &Outputs<'_>) -> u16 {
        self.0 += 1;
        self.0
    }
}

#[test]
fn each_result_of_the_converter_is_taken() {
    let mut machine = opened();
    set_up(&mut machine, 0, (0x1F80_9070, TO), (4, 40, 4));
    machine.write_register(channel(0) + ECON, 33 << 8 | SIRQEN);
    machine.write_register(channel(0) + CON, CHEN);
    machine.write_register(0xBF80_9020, 1 << 8 | 2);
    machine.write_register(0xBF80_9000, ON | 7 << 5 | 1 << 2);
    let end = machine.cycle() + 20_000;
    assert_eq!(machine.run_until(end, &mut Stairs::default()), Halt::Reached);
    let results: Vec<u32> = (0..10).map(|index| word(&machine, TO + 4 * index)).collect();
    assert_eq!(results, (1..=10).collect::<Vec<u32>>());
    assert_eq!(word(&machine, TO + 40), 0, "and no more");
}

#[test]
fn a_pattern_ends_the_block_behind_itself() {
    for (control, stays) in [(CHEN, false), (CHEN | CHAEN, true)] {
        let mut machine = opened();
        set_up(&mut machine, 0, (FROM, TO), (100, 100, 100));
        machine.write_register(channel(0) + DAT, 7);
        machine.write_register(channel(0) + ECON, PATEN);
        machine.write_register(channel(0) + CON, control);
        machine.write_register(channel(0) + ECON + SET, CFORCE);
        pass(&mut machine, 1_000);
        assert_eq!(ram(&machine, TO, 9), [1, 2, 3, 4, 5, 6, 7, 0, 0]);
        assert_eq!(flags(&mut machine, 0) & (CHBC | CHCC), CHBC | CHCC);
        assert_eq!(is_on(&mut machine, 0), stays);
        assert_eq!(machine.read_register(channel(0) + DPTR), 0);
    }
}

#[test]
fn higher_priorities_go_first_and_equal_ones_in_turn() {
    for (priorities, winner) in [([0, 3], Some(1)), ([2, 1], Some(0)), ([1, 1], None)] {
        let mut machine = opened();
        for number in 0..2 {
            set_up(&mut machine, number, (FROM, TO + 0x100 * number), (32, 32, 32));
            machine.write_register(channel(number) + CON, CHEN | priorities[number as usize]);
        }
        machine.write_register(DMACON + SET, SUSPEND);
        for number in 0..2 {
            machine.write_register(channel(number) + ECON + SET, CFORCE);
        }
        pass(&mut machine, 100);
        assert_eq!(
            [flags(&mut machine, 0), flags(&mut machine, 1)],
            [0, 0],
            "suspended"
        );
        machine.write_register(DMACON + CLR, SUSPEND);
        // Seven accesses of four cycles, of four bytes each.
        pass(&mut machine, 30);
        let pointers = [0, 1].map(|number| machine.read_register(channel(number) + DPTR));
        match winner {
            Some(winner) => assert_eq!(
                (pointers[winner], pointers[1 - winner]),
                (28, 0),
                "{priorities:?}"
            ),
            None => assert!(pointers == [12, 16] || pointers == [16, 12], "{pointers:?}"),
        }
        pass(&mut machine, 200);
        assert_eq!(ram(&machine, TO, 32), ram(&machine, TO + 0x100, 32));
    }
}

#[test]
fn the_end_of_a_block_turns_the_chained_neighbour_on() {
    // The channel that ends, its neighbour, and where that looks.
    for (first, second, which) in [(0, 1, 0), (2, 3, 0), (1, 0, CHCHNS), (3, 2, CHCHNS)] {
        for other in [0, CHCHNS] {
            let mut machine = opened();
            set_up(&mut machine, first, (FROM, TO), (4, 4, 4));
            set_up(&mut machine, second, (FROM, TO + 0x100), (4, 4, 4));
            machine.write_register(channel(second) + CON, CHCHN | CHAED | other);
            machine.write_register(channel(second) + ECON + SET, CFORCE);
            machine.write_register(channel(first) + CON, CHEN);
            pass(&mut machine, 100);
            assert!(!is_on(&mut machine, second), "not before the other's end");
            machine.write_register(channel(first) + ECON + SET, CFORCE);
            pass(&mut machine, 100);
            let expected = if which == other { CHBC } else { 0 };
            assert_eq!(
                flags(&mut machine, second) & CHBC,
                expected,
                "{first} {second} {other:#x}"
            );
        }
    }
}

#[test]
fn auto_enable_goes_round_and_round() {
    let mut machine = opened();
    set_up(&mut machine, 0, (FROM, TO), (1, 4, 1));
    machine.write_register(channel(0) + CON, CHEN | CHAEN);
    for moved in 1..=9_u32 {
        machine.write_register(channel(0) + ECON + SET, CFORCE);
        pass(&mut machine, 20);
        assert_eq!(machine.read_register(channel(0) + DPTR), moved % 4);
        assert!(is_on(&mut machine, 0));
    }
    machine.write_register(channel(0) + CON + SET, CHCHN);
    assert_eq!(machine.misuses()[0].misuse, Misuse::DmaSettings(0));
}

#[test]
fn an_abort_comes_from_the_program_or_from_a_request() {
    for by_request in [false, true] {
        let mut machine = opened();
        set_up(&mut machine, 0, (FROM, TO), (8, 8, 2));
        machine.write_register(channel(0) + ECON, AIRQEN | 4 << 16);
        machine.write_register(channel(0) + CON, CHEN);
        machine.write_register(channel(0) + ECON + SET, CFORCE);
        pass(&mut machine, 50);
        assert_eq!(machine.read_register(channel(0) + DPTR), 2);
        if by_request {
            machine.write_register(timer(1) + 0x20, 9);
            machine.write_register(timer(1), 1 << 15);
            pass(&mut machine, 50);
        } else {
            machine.write_register(channel(0) + ECON + SET, CABORT);
        }
        assert_eq!(flags(&mut machine, 0) & (CHTA | CHBC), CHTA);
        assert!(!is_on(&mut machine, 0));
        assert_eq!(machine.read_register(channel(0) + DPTR), 0);
        machine.write_register(channel(0) + ECON + SET, CFORCE);
        pass(&mut machine, 50);
        assert_eq!(ram(&machine, TO, 4), [1, 2, 0, 0]);
    }
}

#[test]
fn a_wrong_address_turns_the_channel_off_and_is_named() {
    // From, to, and which of them is wrong. Flash can be read only.
    for (from, to, wrong) in [
        (0x9000, TO, 0x9000),
        (FROM, 0x0001_0000, 0x0001_0000),
        (FROM, FLASH, FLASH),
        (0x1D04_0000, TO, 0x1D04_0000),
    ] {
        let mut machine = opened();
        set_up(&mut machine, 0, (from, to), (4, 4, 4));
        machine.write_register(channel(0) + CON, CHEN);
        machine.write_register(channel(0) + ECON + SET, CFORCE);
        pass(&mut machine, 50);
        assert_eq!(flags(&mut machine, 0), CHER, "{from:#x} to {to:#x}");
        assert!(!is_on(&mut machine, 0));
        assert_eq!(machine.read_register(DMAADDR), wrong);
        assert_eq!(
            machine.read_register(DMASTAT) & 8 != 0,
            wrong == from,
            "reading or writing"
        );
    }
    let mut machine = opened();
    set_up(&mut machine, 0, (FLASH, TO), (4, 4, 4));
    machine.write_register(channel(0) + CON, CHEN);
    machine.write_register(channel(0) + ECON + SET, CFORCE);
    pass(&mut machine, 50);
    assert_eq!(ram(&machine, TO, 4), [0xFF; 4], "erased flash");
}

#[test]
fn the_crc_is_that_of_the_known_vector() {
    let mut machine = opened();
    machine.memory_mut().write(FROM, b"123456789").expect("in RAM");
    // Polynomial, length, seed, expected: XMODEM, IBM without reflection, and one of 8 bits.
    for (taps, length, seed, expected) in [
        (0x1021, 16, 0, 0x31C3),
        (0x1020, 16, 0xFFFF, 0x29B1),
        (0x8005, 16, 0, 0xFEE8),
        (0x07, 8, 0, 0xF4),
    ] {
        let unit = 1 << 7 | (length - 1) << 8 | 3;
        for appended in [0, 1 << 6] {
            machine.write_register(DCRCCON, 0);
            machine.write_register(DCRCDATA, seed);
            machine.write_register(DCRCXOR, taps);
            machine.write_register(DCRCCON, unit | appended);
            machine.memory_mut().write(TO, &[0; 16]).expect("in RAM");
            let size = if appended == 0 { 9 } else { 2 };
            set_up(&mut machine, 3, (FROM, TO), (9, size, 9));
            machine.write_register(channel(3) + CON, CHEN);
            machine.write_register(channel(3) + ECON + SET, CFORCE);
            pass(&mut machine, 100);
            assert_eq!(machine.read_register(DCRCDATA), expected, "{taps:#x}");
            let written = ram(&machine, TO, 9);
            if appended == 0 {
                assert_eq!(written, b"123456789");
            } else {
                assert_eq!(written[..2], (expected as u16).to_le_bytes());
                assert_eq!(written[2..], [0; 7], "nothing else is written");
            }
        }
    }
}

#[test]
fn requests_of_channels_reach_their_vectors() {
    for number in 0..4 {
        let registers = [
            (ipc(9), 0x0404_0404),
            (IEC1, 0xF << 16),
            (DMACON, ON),
            (channel(number) + SSA, FROM),
            (channel(number) + DSA, TO),
            (channel(number) + SSIZ, 1),
            (channel(number) + DSIZ, 1),
            (channel(number) + CSIZ, 1),
            (channel(number) + INT, CHBC << 16),
            (channel(number) + CON, CHEN),
            (channel(number) + ECON, CFORCE),
        ];
        let vector = 36 + number;
        let mut machine = interrupting(&registers, &[(vector, channel(number) + INT, 3)]).machine();
        run(&mut machine, 10_000);
        // The handler takes the cause back, not the flag, so it comes at least once.
        assert!(word(&machine, 4 * vector) >= 1, "channel {number}");
        assert_eq!(machine.read_register(INTCON) & 1 << 12, 1 << 12);
        assert_eq!(machine.read_register(IFS1) >> 16 & 0xF, 1 << number);
    }
}

#[test]
fn what_moves_between_the_two_keys_spoils_them() {
    const SYSKEY: u32 = 0xBF80_F230;
    const OSCCON: u32 = 0xBF80_F000;
    for (moves, opens) in [(false, true), (true, false)] {
        let mut machine = opened();
        set_up(&mut machine, 0, (FROM, TO), (4, 4, 4));
        machine.write_register(channel(0) + CON, CHEN);
        machine.write_register(SYSKEY, 0xAA99_6655);
        if moves {
            machine.write_register(channel(0) + ECON + SET, CFORCE);
        }
        pass(&mut machine, 20);
        machine.write_register(SYSKEY, 0x5566_99AA);
        machine.write_register(OSCCON + SET, 1 << 4);
        assert_eq!(machine.read_register(OSCCON) & 1 << 4 != 0, opens);
    }
}

#[test]
fn addresses_and_sizes_are_left_alone_while_a_channel_is_on() {
    for register in [SSA, DSA, SSIZ, DSIZ, CSIZ, DAT] {
        let mut machine = opened();
        machine.write_register(channel(2) + CON, CHEN);
        assert_eq!(machine.misuses(), []);
        machine.write_register(channel(2) + register, 1);
        assert_eq!(
            machine.misuses()[0].misuse,
            Misuse::DmaChannelOn(2),
            "{register:#x}"
        );
    }
}
