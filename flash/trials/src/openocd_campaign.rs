//! OpenOCD, which nobody here wrote, at the port of the emulated PIC32.

use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::Context as _;
use flash_trials::fixtures::{chip_with, content_of, flash_image, noise};
use flash_trials::{SimulatedIcsp, WireFaults, serve_jtag};
use pic32::icsp::PortFaults;

use crate::pic32_campaign::Scratch;

/// Bytes that are read of each flash, and written.
const BYTES: usize = 512;
/// The emulated chip's identity: a PIC32MX360F256L of the first revision.
const IDENTITY: &str = "0x00934053";
/// Where it writes: a page of program flash that the image leaves alone.
const WRITTEN_AT: usize = 0x2_0000;

/// It halts the core, lets it run from RAM, reads both flashes, erases a page, writes it by a program of its own in RAM, and compares. What
/// it read and wrote is what the chip holds.
pub(crate) fn openocd_agrees(openocd: &Path) -> anyhow::Result<bool> {
    let scratch = Scratch::new("openocd")?;
    let image = flash_image(0x2_1000, 0x2FF0, 21);
    let faults = (WireFaults::default(), PortFaults::default());
    let mut chip = SimulatedIcsp::new(chip_with(&image), 10_000_000, faults);
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let words = noise(BYTES, 33);
    std::fs::write(scratch.0.join("words"), &words)?;
    let mut child = Command::new(openocd)
        .current_dir(&scratch.0)
        .args(["-c", &adapter(listener.local_addr()?.port())])
        .args(["-f", "target/pic32mx.cfg", "-c", &work()])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .with_context(|| openocd.display().to_string())?;
    let (stream, _) = listener.accept()?;
    serve_jtag(stream, &mut chip)?;
    let ended_well = child.wait()?.success();
    let read = |name: &str| std::fs::read(scratch.0.join(name)).unwrap_or_default();
    let is_read = read("boot") == image.boot()[..BYTES] && read("program") == image.program()[..BYTES];
    let is_written = content_of(chip.machine()).program()[WRITTEN_AT..WRITTEN_AT + BYTES] == words[..];
    Ok(ended_well && is_read && is_written)
}

fn adapter(port: u16) -> String {
    format!(
        "adapter driver remote_bitbang; remote_bitbang host 127.0.0.1; remote_bitbang port {port}; transport select jtag; \
         gdb_port disabled; tcl_port disabled; telnet_port disabled; set CPUTAPID {IDENTITY}; set WORKAREASIZE 0x8000"
    )
}

fn work() -> String {
    format!(
        "adapter speed 1000; init; reset init; dump_image boot 0xbfc00000 {BYTES}; dump_image program 0xbd000000 {BYTES}; \
         flash write_image erase words {0:#x} bin; verify_image words {0:#x} bin; shutdown",
        0xBD00_0000_u32 + WRITTEN_AT as u32
    )
}
