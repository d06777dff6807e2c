//! Traps: places in which robots get stuck in real homes, drawn from a kind and a seed.
//!
//! A *trap* is a room of 4 x 3 m with a dock, and the robot in a tight place in it. The seed draws its sizes, down to
//! gaps that are hardly wider than the body. The robot is *free* when it is outside of the trap's rectangle. Two kinds
//! have no exit: there the robot can only stop and report that.

mod recipes;
mod sketch;

use core::fmt;

use crate::{Home, HomeError, Pose, RobotModel};
use sketch::Sketch;

macro_rules! kinds {
    ($($(#[$doc:meta])* $variant:ident => $name:literal,)+) => {
        /// What holds the robot.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum TrapKind {
            $($(#[$doc])* $variant,)+
        }

        impl TrapKind {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)+];

            /// The name.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }
        }
    };
}

kinds! {
    /// Two bars of a clothes airer, closed at one end.
    Airer => "airer",
    /// Below a bed, between boxes.
    Bed => "bed",
    /// An island of floor in a black carpet, which cliff sensors see as a cliff. No exit.
    BlackIsland => "black-island",
    /// The same with an exit along the wall.
    BlackRug => "black-rug",
    /// Cables all around.
    Cables => "cables",
    /// A thick carpet on which wheels slip much.
    Carpet => "carpet",
    /// A cage of chair legs with one gap.
    Chairs => "chairs",
    /// A closet whose door has fallen shut. No exit.
    Closet => "closet",
    /// A closet whose door opens after some minutes.
    Door => "door",
    /// Behind the leaf of an open door.
    DoorLeaf => "door-leaf",
    /// A landing between stairs.
    Landing => "landing",
    /// A slot between two mirrors.
    Mirror => "mirror",
    /// People who stand around the robot and leave.
    People => "people",
    /// A rug with a thick edge.
    RugEdge => "rug-edge",
    /// A dead end hardly wider than the robot.
    Slot => "slot",
    /// Below a sofa on legs before a wall.
    Sofa => "sofa",
    /// Between the round feet of bar stools, onto which wheels climb.
    Stools => "stools",
    /// Below a dining table with its chairs.
    Table => "table",
    /// A small room whose threshold is nearly too high.
    Threshold => "threshold",
    /// Beside the bowl of a toilet.
    Toilet => "toilet",
    /// A dead end with a corner in it.
    Hook => "hook",
    /// Two walls that come together.
    Wedge => "wedge",
}

impl TrapKind {
    /// Whether there is an exit, now or within some minutes.
    #[must_use]
    pub const fn can_be_left(self) -> bool {
        !matches!(self, Self::BlackIsland | Self::Closet)
    }
}

/// A drawn trap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trap {
    /// What holds the robot.
    pub kind: TrapKind,
    /// Draws the sizes.
    pub seed: u32,
}

/// The rectangle of a trap in its file's frame: whoever is outside is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrapBounds {
    /// Lower left corner, metres.
    pub low: [f64; 2],
    /// Upper right corner, metres.
    pub high: [f64; 2],
}

impl TrapBounds {
    /// Whether a place of the file's frame is inside.
    #[must_use]
    pub fn contains(&self, place: Pose) -> bool {
        let within = |at: f64, axis: usize| (self.low[axis]..=self.high[axis]).contains(&at);
        within(place.x_m, 0) && within(place.y_m, 1)
    }
}

impl Trap {
    /// Reads `KIND/SEED`, or `KIND` for seed 1.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let (name, seed) = text.split_once('/').unwrap_or((text, "1"));
        let kind = TrapKind::ALL.iter().copied().find(|kind| kind.name() == name)?;
        Some(Self {
            kind,
            seed: seed.parse().ok()?,
        })
    }

    /// The text of the trap's home TOML.
    #[must_use]
    pub fn floorplan(self) -> String {
        self.draw().text(&self.to_string())
    }

    /// Where the robot is still trapped.
    #[must_use]
    pub fn bounds(self) -> TrapBounds {
        self.draw().bounds
    }

    /// The home.
    ///
    /// # Errors
    /// [`HomeError`] when the robot does not fit.
    pub fn home(self, model: &RobotModel) -> Result<Home, HomeError> {
        Home::from_floorplan(&format!("trap:{self}"), &self.floorplan(), model)
    }

    fn draw(self) -> Sketch {
        let mut sketch = Sketch::new(u64::from(self.seed), self.kind as u64);
        recipes::draw(self.kind, &mut sketch);
        sketch
    }
}

impl fmt::Display for Trap {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.kind.name(), self.seed)
    }
}
