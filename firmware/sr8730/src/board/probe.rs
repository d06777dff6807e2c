//! Raw readings of the pins for calibration, without threshold or unit.

use cordlib::board::PinProbe;
use pic32mx3_hal::gpio::Port;
use rvac_protocol::message::{ButtonProbe, EncoderProbe, PROBE_CHANNELS, PROBE_PORTS, Refusal};

use super::link::port_c;
use super::serial::SerialPorts;
use super::{contacts, converter, encoders};

/// All raw readings.
#[derive(Debug)]
pub struct RawReadings {
    ports: SerialPorts,
}

impl RawReadings {
    /// Owns the serial ports, which a probe can open at any rate.
    #[must_use]
    pub const fn take(ports: SerialPorts) -> Self {
        Self { ports }
    }

    /// Called once a millisecond.
    pub fn service(&mut self) {
        self.ports.service();
    }
}

impl PinProbe for RawReadings {
    const PRESENT: bool = true;

    fn analog(&mut self) -> [u16; PROBE_CHANNELS] {
        converter::counts()
    }

    fn encoders(&mut self) -> EncoderProbe {
        encoders::raw()
    }

    fn lines(&mut self) -> [u16; PROBE_PORTS] {
        let mut lines = [0; PROBE_PORTS];
        for (line, port) in lines.iter_mut().zip(Port::ALL) {
            *line = match port {
                Port::C => port_c(),
                _ => port.read(),
            };
        }
        lines
    }

    fn buttons(&mut self) -> ButtonProbe {
        contacts::raw_buttons()
    }

    fn open_serial(&mut self, port: u8, baud: u32) -> Result<(), Refusal> {
        self.ports.probe(port, baud)
    }

    fn read_serial(&mut self, bytes: &mut [u8]) -> usize {
        self.ports.read_probed(bytes)
    }

    fn serial_lost(&mut self) -> u32 {
        self.ports.probed_lost()
    }

    fn close_serial(&mut self) {
        self.ports.end_probe();
    }
}
