//! What a link can, whatever it is made of.

use std::fmt;

/// Whether both ends may speak at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Duplex {
    /// Both at once.
    Full,
    /// One at a time.
    Half,
}

/// Who says when a byte passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clocking {
    /// Each sender by itself.
    Sender,
    /// The host alone: what the robot has to say waits until it is fetched.
    Host,
}

/// How it looks when nobody speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Idle {
    /// No byte passes.
    Silence,
    /// Bytes pass that mean nothing.
    Fill,
}

/// What a link can.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    /// Both ends at once, or one at a time.
    pub duplex: Duplex,
    /// Who clocks.
    pub clocking: Clocking,
    /// Bytes of one transfer, where it has a limit.
    pub transfer_max: Option<usize>,
    /// How it looks at rest.
    pub idle: Idle,
}

impl Abilities {
    /// A stream in both directions: a UART with two wires, a connection of a network.
    pub const STREAM: Self = Self {
        duplex: Duplex::Full,
        clocking: Clocking::Sender,
        transfer_max: None,
        idle: Idle::Silence,
    };
    /// One wire or one pair for both directions.
    pub const SHARED_WIRE: Self = Self {
        duplex: Duplex::Half,
        ..Self::STREAM
    };
}

impl fmt::Display for Abilities {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(match self.duplex {
            Duplex::Full => "both directions at once",
            Duplex::Half => "one direction at a time",
        })?;
        if self.clocking == Clocking::Host {
            to.write_str(", clocked by the host")?;
        }
        if let Some(bytes) = self.transfer_max {
            write!(to, ", at most {bytes} bytes a transfer")?;
        }
        if self.idle == Idle::Fill {
            to.write_str(", fill bytes at rest")?;
        }
        Ok(())
    }
}
