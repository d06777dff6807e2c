//! How fast the chip runs: `cargo run --release -p stc90 --example stc90_speed [FILE.ihx] [SECONDS]`.
//!
//! Without a file it runs a program of its own that resembles a firmware: a check sum over 512 bytes of external memory,
//! again and again, with a timer's interrupt each millisecond and a byte on the serial line each ten.

use stc90::image::Image;
use stc90::machine::{Machine, Options};
use stc90::peripheral::{LineFrame, Source};

/// Seconds of the chip's time.
const SECONDS: f64 = 20.0;

/// At 0: LJMP 0x40.
const ENTRY: [u8; 3] = [0x02, 0x00, 0x40];
/// Timer 0: PUSH ACC; PUSH PSW; reload; INC 0x30; CPL P2.7; POP; POP; RETI.
const TIMER: [u8; 20] = [
    0xC0, 0xE0, 0xC0, 0xD0, 0x75, 0x8A, 0x78, 0x75, 0x8C, 0xEC, 0x05, 0x30, 0xB2, 0xA7, 0xD0, 0xD0, 0xD0,
    0xE0, 0x32, 0x00,
];
/// UART: JNB RI, over; CLR RI; MOV 0x31, SBUF; CLR TI; RETI.
const SERIAL: [u8; 11] = [0x30, 0x98, 0x05, 0xC2, 0x98, 0x85, 0x99, 0x31, 0xC2, 0x99, 0x32];
/// Timers, UART and interrupts on; then the sum.
const MAIN: [u8; 53] = [
    0x75, 0x89, 0x01, 0x75, 0x8A, 0x78, 0x75, 0x8C, 0xEC, // timer 0
    0x75, 0xCB, 0xFF, 0x75, 0xCA, 0xCF, 0x75, 0xC8, 0x34, 0x75, 0x98, 0x50, // timer 2, UART
    0xD2, 0x8C, 0x75, 0xA8, 0x92, // go
    0x90, 0x00, 0x00, 0x7E, 0x02, 0x7F, 0x00, // each round: DPTR, R6, R7
    0xE0, 0x65, 0x30, 0x2D, 0xFD, 0x33, 0x6C, 0xFC, 0xF0, 0xA3, // a byte
    0xDF, 0xF4, 0xDE, 0xF2, // the next one
    0x05, 0x32, 0x85, 0x32, 0x90, 0x80, // show the round on P1
];
/// Distance of the last jump, back to the round's begin.
const BACK: u8 = 0xE4;

fn built_in() -> Option<Image> {
    let mut main = MAIN.to_vec();
    main.push(BACK);
    let mut image = Image::erased();
    let parts: [(u32, &[u8]); 4] = [(0, &ENTRY), (0x0B, &TIMER), (0x23, &SERIAL), (0x40, &main)];
    let fits = parts.iter().all(|(address, bytes)| image.write(*address, bytes));
    fits.then_some(image)
}

/// Seconds that this thread was executed, so that other programs on the machine do not count; from the kernel of Linux.
fn processor_time() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split(' ').next().and_then(|word| word.parse::<f64>().ok());
    nanoseconds.unwrap_or(f64::NAN) / 1e9
}

/// Runs for a time in steps of a millisecond, as a board does, with a byte each ten.
fn run(machine: &mut Machine, seconds: f64) -> u64 {
    let cycles_per_ms = (machine.cycles_per_s() / 1e3) as u64;
    let mut sent = 0;
    for millisecond in 0..(seconds * 1e3) as u64 {
        if let Some(bit) = machine.bit_ticks().filter(|_| millisecond % 10 == 0) {
            machine.hear(LineFrame::byte(machine.cycle(), bit, millisecond as u8));
        }
        machine.run_until((millisecond + 1) * cycles_per_ms);
        sent += machine.take_sent().len() as u64;
    }
    sent
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let image = match arguments.next() {
        Some(file) => Image::from_hex(&std::fs::read_to_string(file)?)?,
        None => built_in().ok_or("the program does not fit")?,
    };
    let seconds = arguments.next().map_or(Ok(SECONDS), |text| text.parse())?;
    let mut machine = Machine::new(&image, Options::RELAX);
    let begin = processor_time();
    let sent = run(&mut machine, seconds);
    let taken = processor_time() - begin;
    let cycles = machine.cycle() as f64;
    println!(
        "{:.0} M cycles, {:.0} M cycles/s: {:.1} times real time",
        cycles / 1e6,
        cycles / taken / 1e6,
        seconds / taken
    );
    for source in Source::ALL {
        let account = machine.account().of(source);
        if account.calls > 0 {
            println!(
                "{source:?}: {} calls, {} cycles at most",
                account.calls, account.longest_cycles
            );
        }
    }
    println!(
        "{sent} bytes sent, {} lost, {} unheard",
        machine.overruns(),
        machine.unheard()
    );
    println!("misuse: {:?}", machine.misuses());
    Ok(())
}
