//! Runs firmware in the emulated chip and tells what it did:
//! `cargo run --release -p pic32 --example run -- FILE.elf --ms 100 --watch RD0,RB7 --vcd OUT.vcd`.
//!
//! The file is an ELF, or an Intel HEX if its name ends in `.hex`. `--set RC13=1` drives an input from the begin on,
//! `--adc 3=512` gives an analog input counts, `--uart1 TEXT` and `--uart2 TEXT` send characters at 115200 baud after a
//! tenth of the time. `--line RC13=230400` sends characters on a pin all the time, for firmware that receives by software.

use pic32::image::Image;
use pic32::machine::{Halt, LineRate, Machine, Outputs, Surroundings, Uart};
use pic32::peripheral::Sent;
use pic32::pins::{Level, Pin, PinDriver};
use pic32::trace::Vcd;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

const CYCLES_PER_MS: u64 = 80_000;
/// How many characters of a UART and how many resets are shown.
const SHOWN: usize = 200;

/// What the command line says.
struct Options {
    file: String,
    ms: u64,
    watched: Vec<Pin>,
    vcd: Option<String>,
    inputs: Vec<(Pin, Level)>,
    counts: Counts,
    characters: [String; 2],
    line: Option<(Pin, LineRate)>,
}

/// Analog inputs that do not change.
struct Counts([u16; 16]);

impl Surroundings for Counts {
    fn analog(&mut self, channel: u8, _: u64, _: &Outputs<'_>) -> u16 {
        self.0[usize::from(channel & 15)]
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut options = parse(std::env::args().skip(1))?;
    let mut machine = Machine::new(&load(&options.file)?);
    for &(pin, level) in &options.inputs {
        machine.set_input(pin, level);
    }
    for uart in [Uart::One, Uart::Two] {
        machine.set_input(uart.receive_pin(), Level::High);
    }
    let begun = Instant::now();
    let edges = run(&mut machine, &mut options)?;
    let speed = options.ms as f64 / 1000.0 / begun.elapsed().as_secs_f64();
    tell_pins(&machine, &edges);
    tell_serial(&mut machine);
    tell_faults(&machine);
    tell_time(&machine);
    println!("speed      {speed:.2} x real time");
    Ok(())
}

fn load(file: &str) -> Result<Image, Box<dyn Error>> {
    let bytes = std::fs::read(file).map_err(|error| format!("{file}: {error}"))?;
    let image = if file.ends_with(".hex") {
        Image::from_hex(&String::from_utf8(bytes)?)
    } else {
        Image::from_elf(&bytes)
    };
    Ok(image.map_err(|error| format!("{file}: {error}"))?)
}

fn parse(mut words: impl Iterator<Item = String>) -> Result<Options, Box<dyn Error>> {
    let mut options = Options {
        file: String::new(),
        ms: 100,
        watched: Vec::new(),
        vcd: None,
        inputs: Vec::new(),
        counts: Counts([0; 16]),
        characters: [String::new(), String::new()],
        line: None,
    };
    while let Some(word) = words.next() {
        if !word.starts_with("--") {
            options.file = word;
            continue;
        }
        let value = words.next().ok_or_else(|| format!("{word} wants a value"))?;
        let pair = || {
            value
                .split_once('=')
                .ok_or_else(|| format!("{word} wants NAME=VALUE, not {value}"))
        };
        match word.as_str() {
            "--ms" => options.ms = value.parse()?,
            "--watch" => options.watched = value.split(',').map(str::parse).collect::<Result<_, _>>()?,
            "--vcd" => options.vcd = Some(value),
            "--set" => options
                .inputs
                .push((pair()?.0.parse()?, Level::of(pair()?.1 != "0"))),
            "--adc" => {
                let channel: usize = pair()?.0.parse()?;
                *options
                    .counts
                    .0
                    .get_mut(channel)
                    .ok_or("analog inputs are 0 to 15")? = pair()?.1.parse()?;
            }
            "--line" => {
                let baud = pair()?.1.parse()?;
                options.line = Some((pair()?.0.parse()?, LineRate { baud }));
            }
            "--uart1" => options.characters[0] = value,
            "--uart2" => options.characters[1] = value,
            _ => return Err(format!("{word} is unknown").into()),
        }
    }
    if options.file.is_empty() {
        return Err("which file? run FILE.elf [--ms N] [--watch PINS] [--vcd FILE] [--set PIN=0|1]".into());
    }
    if options.vcd.is_some() && options.watched.is_empty() {
        return Err("--vcd wants to know of which pins: --watch RD0,RB7".into());
    }
    Ok(options)
}

/// Runs, and returns how many edges each watched pin had.
fn run(machine: &mut Machine, options: &mut Options) -> Result<Vec<(Pin, usize)>, Box<dyn Error>> {
    let mut vcd = match &options.vcd {
        None => None,
        Some(file) => Some(Vcd::begin(
            BufWriter::new(File::create(file)?),
            machine,
            &options.watched,
        )?),
    };
    for &pin in &options.watched {
        machine.watch(pin);
    }
    // With a dump the edges go into its file, and nobody counts them.
    let counted: &[Pin] = if vcd.is_none() { &options.watched } else { &[] };
    let mut edges: Vec<(Pin, usize)> = counted.iter().map(|&pin| (pin, 0)).collect();
    let rate = LineRate { baud: 115_200 };
    let begin = options.ms / 10 * CYCLES_PER_MS;
    for (uart, text) in [Uart::One, Uart::Two].into_iter().zip(&options.characters) {
        machine.send_to_uart(uart, text.as_bytes(), (begin, rate));
    }
    let mut line_end = 0;
    for ms in 1..=options.ms {
        if let Some((pin, rate)) = options.line {
            while line_end < (ms + 1) * CYCLES_PER_MS {
                // The multiplier visits all 256 characters.
                let character = (line_end.wrapping_mul(167) >> 3) as u8;
                line_end = machine.send_characters(pin, &[character], (line_end, rate));
            }
        }
        if machine.run_until(ms * CYCLES_PER_MS, &mut options.counts) != Halt::Reached {
            break;
        }
        match &mut vcd {
            Some(vcd) => vcd.record(machine)?,
            None => edges
                .iter_mut()
                .for_each(|(pin, count)| *count += machine.take_edges(*pin).len()),
        }
    }
    if let Some(vcd) = vcd {
        vcd.end(machine)?;
    }
    Ok(edges)
}

fn tell_pins(machine: &Machine, edges: &[(Pin, usize)]) {
    for pin in Pin::all() {
        let state = match machine.output(pin) {
            PinDriver::Floating => continue,
            PinDriver::High => "high",
            PinDriver::Low => "low",
        };
        let share = 100.0 * machine.high_cycles(pin) as f64 / machine.cycle() as f64;
        let seen = edges.iter().find(|(watched, _)| *watched == pin);
        let seen = seen.map_or(String::new(), |(_, count)| format!(", {count} edges"));
        println!("{pin:<5}      {state:<4} {share:7.3} % of the time high{seen}");
    }
}

fn tell_serial(machine: &mut Machine) {
    for (name, uart) in [("uart1", Uart::One), ("uart2", Uart::Two)] {
        let sent = machine.take_sent(uart);
        let characters = sent.iter().filter_map(|(_, sent)| match sent {
            Sent::Character(character) => u8::try_from(*character).ok(),
            Sent::Break => None,
        });
        let bytes: Vec<u8> = characters.collect();
        if !sent.is_empty() {
            let begin = &bytes[..bytes.len().min(SHOWN)];
            println!(
                "{name}      sent {} characters: {:?}",
                bytes.len(),
                String::from_utf8_lossy(begin)
            );
        }
    }
}

fn tell_faults(machine: &Machine) {
    for access in machine.unknown_accesses() {
        println!("unknown    {access:x?}");
    }
    for record in machine.misuses() {
        println!("misuse     {record:x?}");
    }
    for record in machine.exceptions() {
        println!("exception  {record:x?}");
    }
    for record in machine.resets().iter().take(SHOWN / 50) {
        println!("reset      {record:x?}");
    }
    if machine.reset_count() > 0 {
        println!("resets     {} in all", machine.reset_count());
    }
}

fn tell_time(machine: &Machine) {
    let accounting = machine.accounting();
    let total = accounting.total_cycles(machine.cycle()).max(1) as f64;
    for (vector, account) in accounting.vectors() {
        let share = 100.0 * account.cycles as f64 / total;
        println!(
            "vector {vector:<3} {:>8} times, {share:6.3} % of the time, longest {} cycles, latency at most {} cycles",
            account.entries, account.longest_cycles, account.worst_latency_cycles
        );
    }
    let idle = 100.0 * accounting.idle_share(machine.cycle());
    let stack = machine
        .deepest_stack()
        .map_or("none".to_owned(), |address| format!("down to {address:#x}"));
    println!(
        "idle       {idle:.2} % of {} cycles; stack {stack}; pc {:#x}",
        machine.cycle(),
        machine.cpu().pc()
    );
}
