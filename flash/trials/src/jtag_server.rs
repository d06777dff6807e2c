//! The port of the emulated PIC32 as a JTAG adapter on the network, for programs that know four wires: the protocol `remote_bitbang` of
//! OpenOCD, a byte for each change of the lines. As in adapters for two wires each rising edge of TCK is a cycle of the chip's port.

use std::io::{self, BufReader, Read, Write};
use std::net::TcpStream;

use pic32_icsp::TestPort;

use crate::SimulatedIcsp;

/// Serves one program until it says goodbye or goes.
///
/// # Errors
/// When the connection fails.
pub fn serve_jtag(stream: TcpStream, chip: &mut SimulatedIcsp) -> io::Result<()> {
    stream.set_nodelay(true)?;
    let mut answers = stream.try_clone()?;
    let mut port = TestPort::new(chip);
    port.enter().map_err(io::Error::other)?;
    let (mut clock, mut tdo) = (false, false);
    for byte in BufReader::new(stream).bytes() {
        match byte? {
            b'R' => answers.write_all(if tdo { b"1" } else { b"0" })?,
            b'Q' => break,
            lines @ b'0'..=b'7' => {
                let [tdi, tms, rises] = [1, 2, 4].map(|bit| (lines - b'0') & bit != 0);
                if rises && !clock {
                    tdo = port.cycle([tdi, tms]).map_err(io::Error::other)?;
                }
                clock = rises;
            }
            // Lamps, and resets that the port has no line for.
            _ => {}
        }
    }
    Ok(())
}
