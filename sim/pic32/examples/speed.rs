//! How fast the core executes compiled code: `cargo run --release -p pic32 --example speed [ELF] [ROUNDS]`.
//!
//! The ELF is the program `chip` of `sim/pic32/proof`, which tells the end of each round by a system call. Instructions are
//! counted by executing some rounds one instruction at a time.

use pic32::cpu::{Access, Bus, BusFault, Cpu, ExceptionCode, Exit};
use pic32::image::Image;
use pic32::memory::{FlashTiming, Memory, Prefetch};

const PROGRAM: &str = "target/cross/mipsel-unknown-none/release/chip";
/// Rounds whose instructions are counted.
const COUNTED: u32 = 8;

/// A chip without peripherals.
struct Bare;

impl Bus for Bare {
    fn load(&mut self, _: Access) -> Result<u32, BusFault> {
        Err(BusFault)
    }

    fn store(&mut self, _: Access, _: u32) -> Result<(), BusFault> {
        Err(BusFault)
    }

    fn horizon(&self) -> u64 {
        u64::MAX
    }
}

/// A core with its memories.
#[derive(Clone)]
struct DebugChip {
    cpu: Cpu,
    memory: Memory,
}

impl DebugChip {
    fn new(image: &Image) -> Self {
        let mut memory = Memory::new(image);
        // As the firmware sets it up at 80 MHz.
        memory.set_ram_wait_states(0);
        memory.set_flash_timing(FlashTiming {
            wait_states: 2,
            prefetch: Prefetch::Both,
        });
        Self {
            cpu: Cpu::new(),
            memory,
        }
    }

    /// Runs to the end of a round; `stride` is the number of cycles after which the core is asked again.
    fn round(&mut self, stride: u64) -> Result<u64, String> {
        let mut runs = 0;
        loop {
            let until = self.cpu.cycle().saturating_add(stride);
            runs += 1;
            match self.cpu.run(&mut self.memory, &mut Bare, until) {
                Exit::Reached | Exit::CoreTimer => {}
                Exit::Exception(exception) if exception.code == ExceptionCode::Syscall => {
                    self.cpu.set_pc(exception.address.wrapping_add(4));
                    return Ok(runs);
                }
                other => return Err(format!("the program ended with {other:x?}")),
            }
        }
    }
}

/// Seconds that this thread was executed, so that other programs on the machine do not count; from the kernel of Linux.
fn processor_time() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds: f64 = text
        .split(' ')
        .next()
        .and_then(|word| word.parse().ok())
        .unwrap_or(f64::NAN);
    nanoseconds / 1e9
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let program = arguments.next().unwrap_or_else(|| PROGRAM.to_owned());
    let rounds: u32 = arguments.next().map_or(Ok(2000), |text| text.parse())?;
    let bytes = std::fs::read(&program).map_err(|error| format!("{program}: {error}"))?;
    let image = Image::from_elf(&bytes)?;

    let mut counted = DebugChip::new(&image);
    let mut instructions = 0;
    for _ in 0..COUNTED {
        instructions += counted.round(1)?;
    }
    let per_cycle = instructions as f64 / counted.cpu.cycle() as f64;

    let mut chip = DebugChip::new(&image);
    let begin = processor_time();
    for _ in 0..rounds {
        chip.round(u64::MAX)?;
    }
    let seconds = processor_time() - begin;
    let cycles = chip.cpu.cycle() as f64;
    println!(
        "{rounds} rounds, {:.0} M cycles, {:.2} instructions per cycle",
        cycles / 1e6,
        per_cycle
    );
    println!("{:.1} M instructions/s", cycles * per_cycle / seconds / 1e6);
    println!(
        "{:.1} M cycles/s: {:.2} times real time at 80 MHz",
        cycles / seconds / 1e6,
        cycles / seconds / 80e6
    );
    Ok(())
}
