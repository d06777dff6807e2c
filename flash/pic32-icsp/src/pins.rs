//! The lines, as whoever has them offers them.

/// What a voltmeter would see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineLevel {
    /// Ground.
    Low,
    /// 3.3 V.
    High,
}

impl LineLevel {
    /// High for `true`.
    pub const fn of(high: bool) -> Self {
        if high { Self::High } else { Self::Low }
    }

    /// Whether it is high.
    pub const fn is_high(self) -> bool {
        matches!(self, Self::High)
    }
}

/// The three lines to the chip, and the time.
///
/// Clock and data are 3.3 V. Reset is an open drain: high means that the host lets it go. Between two calls may lie any time: the
/// port has no longest period. The shortest half period, 50 ns, is below what any host of ours can do.
pub trait IcspPins {
    /// Why a line could not be set or read.
    type Error;

    /// Pulls the reset line low, or lets it go.
    ///
    /// # Errors
    /// When the line cannot be set.
    fn set_reset(&mut self, level: LineLevel) -> Result<(), Self::Error>;

    /// Drives the clock line. Whoever has the lines keeps a level for half of the period that was chosen.
    ///
    /// # Errors
    /// When the line cannot be set.
    fn set_clock(&mut self, level: LineLevel) -> Result<(), Self::Error>;

    /// Drives the data line.
    ///
    /// # Errors
    /// When the line cannot be set.
    fn drive_data(&mut self, level: LineLevel) -> Result<(), Self::Error>;

    /// Makes the data line an input.
    ///
    /// # Errors
    /// When the line cannot be set.
    fn release_data(&mut self) -> Result<(), Self::Error>;

    /// Reads the data line.
    ///
    /// # Errors
    /// When the line cannot be read.
    fn read_data(&mut self) -> Result<LineLevel, Self::Error>;

    /// Lets at least so much time pass.
    fn pause_us(&mut self, us: u32);

    /// Time since any fixed moment.
    fn now_us(&self) -> u64;
}
