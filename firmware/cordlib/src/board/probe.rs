//! Raw readings, for calibration.

use rvac_protocol::message::{ButtonProbe, EncoderProbe, PROBE_CHANNELS, PROBE_PORTS, Refusal};

/// Raw readings of the pins, without threshold or unit. Reading them changes nothing in the machine.
pub trait PinProbe {
    /// Whether raw readings can be had.
    const PRESENT: bool;

    /// Newest count of each channel of the converter; channels that the board does not convert are 0.
    fn analog(&mut self) -> [u16; PROBE_CHANNELS];

    /// Totals of the encoders, calibrated or not.
    fn encoders(&mut self) -> EncoderProbe;

    /// Levels of the digital lines, a word for each port in the order of the chip (A, B, C ...), a bit for each pin.
    fn lines(&mut self) -> [u16; PROBE_PORTS];

    /// The buttons, before it is calibrated which is which.
    fn buttons(&mut self) -> ButtonProbe;

    /// Opens a serial port for reading; one that was open is closed. It never sends.
    ///
    /// # Errors
    /// `Absent` without such a port, `Range` if the chip cannot make this rate.
    fn open_serial(&mut self, port: u8, baud: u32) -> Result<(), Refusal>;

    /// Takes received bytes of the open port out of the board's queue into `bytes` and returns how many.
    fn read_serial(&mut self, bytes: &mut [u8]) -> usize;

    /// Bytes that were lost or had a wrong stop bit since the port was opened.
    fn serial_lost(&mut self) -> u32;

    /// Closes the port, if one is open.
    fn close_serial(&mut self);
}
