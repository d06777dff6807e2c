//! Runs a program on the bare chip: `cargo run --release -p stc90 --example stc90_run -- FILE.ihx [--ms N] [--watch P1.3,P2.3]
//! [--loop ADDRESS]`.
//!
//! Prints what it sends, what it does to watched pins, how often it passes an address (hexadecimal, from the linker's
//! map), what each interrupt takes, how deep the stack gets, and what it does wrong.

use stc90::image::Image;
use stc90::machine::{Machine, Options};
use stc90::peripheral::Source;
use stc90::pins::Pin;

/// Milliseconds without `--ms`.
const MS: u64 = 1000;

/// What the words of the command line ask for.
struct Wish {
    file: String,
    ms: u64,
    watched: Vec<Pin>,
    counted_pc: Option<u16>,
}

fn wish() -> Result<Wish, Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let mut wish = Wish {
        file: words.next().ok_or("name the HEX file of a program")?,
        ms: MS,
        watched: Vec::new(),
        counted_pc: None,
    };
    while let Some(word) = words.next() {
        let value = words.next().ok_or(format!("{word} wants a value"))?;
        match word.as_str() {
            "--ms" => wish.ms = value.parse()?,
            "--watch" => wish.watched = value.split(',').map(str::parse).collect::<Result<_, _>>()?,
            "--loop" => wish.counted_pc = Some(u16::from_str_radix(value.trim_start_matches("0x"), 16)?),
            _ => return Err(format!("{word} is unknown").into()),
        }
    }
    Ok(wish)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wish = wish()?;
    let image = Image::from_hex(&std::fs::read_to_string(&wish.file)?)?;
    let mut machine = Machine::new(&image, Options::RELAX);
    for pin in &wish.watched {
        machine.watch(*pin);
    }
    if let Some(pc) = wish.counted_pc {
        machine.cpu_mut().count_passes(pc);
    }
    let cycles = wish.ms as f64 * machine.cycles_per_s() / 1e3;
    machine.run_until(cycles as u64);
    tell(&mut machine, &wish);
    Ok(())
}

fn tell(machine: &mut Machine, wish: &Wish) {
    let us_per_cycle = 1e6 / machine.cycles_per_s();
    let sent: Vec<u8> = machine.take_sent().iter().map(|frame| frame.byte).collect();
    println!("sent {} bytes: {}", sent.len(), sent.escape_ascii());
    for edge in machine.take_edges() {
        println!(
            "{:12.1} us {} {:?}",
            edge.cycle as f64 * us_per_cycle,
            edge.pin,
            edge.level
        );
    }
    if wish.counted_pc.is_some() {
        let passes = machine.cpu().passes() as f64;
        println!("{:.0} passes a second", passes * 1e3 / wish.ms as f64);
    }
    for source in Source::ALL {
        let account = machine.account().of(source);
        if account.calls > 0 {
            println!(
                "{source:?}: {} calls, {:.1} us at most, {:.1} % of the time",
                account.calls,
                account.longest_cycles as f64 * us_per_cycle,
                100.0 * account.cycles as f64 / machine.cycle() as f64
            );
        }
    }
    println!(
        "stack up to {:#04x}; {:.1} % asleep; {} resets",
        machine.cpu().sp_max(),
        100.0 * machine.account().idle_cycles() as f64 / machine.cycle() as f64,
        machine.reset_count()
    );
    for record in machine.misuses() {
        println!(
            "misuse, {} times, first at {:#06x}: {:?}",
            record.count, record.pc, record.misuse
        );
    }
}
