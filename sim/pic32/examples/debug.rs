//! Waits for a debugger of a program: `cargo run --release -p pic32 --example debug -- FILE.elf [PORT]`, then
//! `gdb-multiarch FILE.elf -ex 'target remote :3333'`. Inputs of the chip are open, analog ones at ground.

use pic32::gdb::{DebugChip, serve};
use pic32::image::Image;
use pic32::machine::{Grounded, Machine};
use std::error::Error;
use std::net::TcpListener;

const PORT: u16 = 3333;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let file = words.next().ok_or("which file? debug FILE.elf [PORT]")?;
    let port = words.next().map_or(Ok(PORT), |word| word.parse())?;
    let bytes = std::fs::read(&file).map_err(|error| format!("{file}: {error}"))?;
    let image = Image::from_elf(&bytes).map_err(|error| format!("{file}: {error}"))?;
    let mut machine = Machine::new(&image);
    // A debugger can do anything, so only this machine may connect.
    let listener = TcpListener::bind(("127.0.0.1", port))?;
    println!(
        "waiting for: gdb-multiarch {file} -ex 'target remote :{}'",
        listener.local_addr()?.port()
    );
    serve(&listener, &mut DebugChip::new(&mut machine, &mut Grounded))?;
    println!("the debugger left at cycle {}", machine.cycle());
    Ok(())
}
