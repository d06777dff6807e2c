//! The port of the emulated PIC32 as a JTAG adapter on the network, for programs that know four wires: the protocol `remote_bitbang` of
//! OpenOCD, a byte for each change of the lines.
//!
//! As in adapters for two wires each rising edge of the clock is a cycle of four clocks on the chip's port: TDI, TMS, and TDO in the
//! last one.

use std::io::{self, BufReader, Read, Write};
use std::net::TcpStream;

use pic32_icsp::{IcspPins, LineLevel};

use crate::{LinesLost, SimulatedIcsp};

/// "MCHP", most significant bit first: what opens the port.
const KEY: u32 = 0x4D43_4850;

/// Serves one program until it says goodbye or goes.
///
/// # Errors
/// When the connection fails.
pub fn serve_jtag(stream: TcpStream, chip: &mut SimulatedIcsp) -> io::Result<()> {
    stream.set_nodelay(true)?;
    let mut answers = stream.try_clone()?;
    let mut adapter = Adapter {
        chip,
        clock: false,
        tdo: false,
    };
    adapter.open().map_err(io::Error::other)?;
    for byte in BufReader::new(stream).bytes() {
        match byte? {
            b'R' => answers.write_all(if adapter.tdo { b"1" } else { b"0" })?,
            b'Q' => break,
            lines @ b'0'..=b'7' => adapter.set(lines - b'0').map_err(io::Error::other)?,
            // Lamps, and resets that the port has no line for.
            _ => {}
        }
    }
    Ok(())
}

struct Adapter<'chip> {
    chip: &'chip mut SimulatedIcsp,
    clock: bool,
    tdo: bool,
}

impl Adapter<'_> {
    /// A short pulse of the reset line, the key, and the reset line high.
    fn open(&mut self) -> Result<(), LinesLost> {
        self.chip.set_reset(LineLevel::Low)?;
        self.chip.set_reset(LineLevel::High)?;
        self.chip.set_reset(LineLevel::Low)?;
        self.chip.pause_us(10);
        for bit in (0..32).rev() {
            self.send(KEY >> bit & 1 != 0)?;
        }
        self.chip.release_data()?;
        self.chip.set_reset(LineLevel::High)?;
        self.chip.pause_us(1_000);
        Ok(())
    }

    fn send(&mut self, bit: bool) -> Result<(), LinesLost> {
        self.chip.drive_data(LineLevel::of(bit))?;
        self.tick()
    }

    fn tick(&mut self) -> Result<(), LinesLost> {
        self.chip.set_clock(LineLevel::High)?;
        self.chip.set_clock(LineLevel::Low)
    }

    /// Takes the levels of TDI, TMS and TCK, the bits 0 to 2.
    fn set(&mut self, lines: u8) -> Result<(), LinesLost> {
        let [tdi, tms, clock] = [1, 2, 4].map(|bit| lines & bit != 0);
        if clock && !self.clock {
            self.send(tdi)?;
            self.send(tms)?;
            self.chip.release_data()?;
            self.tick()?;
            self.chip.set_clock(LineLevel::High)?;
            self.tdo = self.chip.read_data()?.is_high();
            self.chip.set_clock(LineLevel::Low)?;
        }
        self.clock = clock;
        Ok(())
    }
}
