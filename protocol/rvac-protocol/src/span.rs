//! Resolution and range of every number on the wire, written once for both forms.

/// Spelling and range of a number. The integer is counted in the unit of its type (for example micrometres per
/// second); the text shows it as a decimal of the SI unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Decimal places between the integer and the SI unit.
    pub decimals: u8,
    /// Smallest integer.
    pub min: i64,
    /// Largest integer.
    pub max: i64,
}

impl Span {
    const fn new(decimals: u8, min: i64, max: i64) -> Self {
        Self { decimals, min, max }
    }

    /// Whether `value` is allowed.
    #[must_use]
    pub const fn contains(self, value: i64) -> bool {
        self.min <= value && value <= self.max
    }

    /// The nearest allowed value. For measurements only; commands are refused instead.
    #[must_use]
    pub fn saturate(self, value: i64) -> i64 {
        // Not `clamp`, which would add a panic to the firmware for a span whose ends are swapped.
        value.max(self.min).min(self.max)
    }
}

/// Forward speed, m/s.
pub const SPEED: Span = Span::new(6, -2_000_000, 2_000_000);
/// Turn rate, rad/s.
pub const TURN: Span = Span::new(6, -8_000_000, 8_000_000);
/// Life of a motion command, ms.
pub const LEASE: Span = Span::new(0, 1, 1_000);
/// Life of a probe, ms; 0 = one answer.
pub const PROBE_LEASE: Span = Span::new(0, 0, 1_000);
/// Rate of a serial port, bits a second.
pub const BAUD: Span = Span::new(0, 300, 1_000_000);
/// Throttle of a motor.
pub const THROTTLE: Span = Span::new(6, -1_000_000, 1_000_000);
/// Length of a `move`, m (rad on the spot).
pub const MOVE_LENGTH: Span = Span::new(6, -10_000_000, 10_000_000);
/// Radius of a `move`, m.
pub const MOVE_RADIUS: Span = Span::new(6, -10_000_000, 10_000_000);
/// Pitch of a tone, Hz; 1 to 19 are refused besides.
pub const PITCH: Span = Span::new(0, 0, 20_000);
/// Length of a tone, s.
pub const DURATION: Span = Span::new(3, 1, 10_000);
/// A ratio.
pub const RATIO: Span = Span::new(6, 0, 1_000_000);
/// Number of a light.
pub const LED: Span = Span::new(0, 0, 15);
/// Any `u8`.
pub const BYTE: Span = Span::new(0, 0, u8::MAX as i64);
/// Any `u16`: numbers of commands and events, sessions.
pub const WORD: Span = Span::new(0, 0, u16::MAX as i64);
/// Any `u32`: ticks in ms, totals.
pub const TOTAL: Span = Span::new(0, 0, u32::MAX as i64);
/// Any `i32`: encoder counts, parameters.
pub const COUNT: Span = Span::new(0, i32::MIN as i64, i32::MAX as i64);
/// Lengths, angles and rates of reports: any `i32` in millionths of the SI unit.
pub const MICRO: Span = Span::new(6, i32::MIN as i64, i32::MAX as i64);
/// Distance per encoder count, m: any `u32` of nanometres.
pub const NANO: Span = Span::new(9, 0, u32::MAX as i64);
/// Current, A.
pub const CURRENT: Span = Span::new(3, -32_767, 32_767);
/// Voltage, V.
pub const VOLTAGE: Span = Span::new(3, 0, 65_535);
/// Temperature, degrees Celsius.
pub const TEMPERATURE: Span = Span::new(1, i16::MIN as i64, i16::MAX as i64);

/// Whether a tone may have this pitch: 0 is a pause, else 20 to 20,000 Hz.
#[must_use]
pub const fn is_pitch(pitch_hz: i64) -> bool {
    pitch_hz == 0 || (20 <= pitch_hz && pitch_hz <= PITCH.max)
}
