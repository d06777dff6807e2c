//! Raw readings of the pins for calibration, without threshold or unit.

use heapless::Vec;
use rvac_units::Tick;

use super::Sequence;

/// Analogue channels that a probe can carry.
pub const PROBE_CHANNELS: usize = 16;
/// Ports of digital lines that a probe can carry.
pub const PROBE_PORTS: usize = 8;
/// Most bytes of a serial port in one packet.
pub const PROBE_BYTES: usize = 64;
/// Longest lease of a probe in ms.
pub const PROBE_LEASE_MS_MAX: u16 = 1_000;

/// What to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeTarget {
    /// Raw counts of the converter.
    Analog,
    /// Raw totals of the wheel encoders.
    Encoders,
    /// Levels of all digital lines.
    Lines,
    /// The analogue line of the buttons.
    Buttons,
    /// Bytes that a hardware serial port receives.
    Serial {
        /// Port by the number that the chip's maker gives it.
        port: u8,
        /// Bits a second.
        baud: u32,
    },
}

/// Asks for raw readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Probe {
    /// What to read.
    pub target: ProbeTarget,
    /// 0: one answer, only while the robot is not armed. Else answers come until this many ms have passed, armed or
    /// not.
    pub lease_ms: u16,
    /// Number for the acknowledgement.
    pub sequence: Sequence,
}

/// A raw reading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Probed {
    /// When it was taken.
    pub tick: Tick,
    /// The readings.
    pub content: ProbedContent,
}

/// Readings of a probe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProbedContent {
    /// Counts by channel; channels that the board does not convert are 0.
    Analog([u16; PROBE_CHANNELS]),
    /// Encoders.
    Encoders(EncoderProbe),
    /// One word for each port in the order of the chip (A, B, C ...), bit by bit the level of a pin, 1 = high. Ports
    /// that the chip does not have are 0.
    Lines([u16; PROBE_PORTS]),
    /// Buttons.
    Buttons(ButtonProbe),
    /// Bytes of a serial port.
    Serial(SerialProbe),
}

/// Encoders without any unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EncoderProbe {
    /// Left total since reset, wraps.
    pub left: i32,
    /// Right total since reset, wraps.
    pub right: i32,
    /// Transitions of the left encoder in which both lines changed at once: lost edges or noise.
    pub left_illegal: u32,
    /// The same of the right encoder.
    pub right_illegal: u32,
    /// Pulses of the main brush since reset, wrapping; `None` without a sensor.
    pub brush: Option<u32>,
}

/// The buttons, before it is known which is which.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ButtonProbe {
    /// Count of the line that distinguishes the buttons.
    pub level: u16,
    /// Whether the line for any button is active.
    pub pressed: bool,
}

/// A piece of the bytes that a serial port received.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SerialProbe {
    /// Bytes received before this piece since the port was opened; a gap shows bytes lost on the link.
    pub at: u32,
    /// Bytes that the receiver itself lost or saw with a wrong stop bit, since the port was opened.
    pub lost: u32,
    /// The piece.
    pub bytes: Vec<u8, PROBE_BYTES>,
}
