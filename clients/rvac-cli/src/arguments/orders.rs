//! What can be said of rooms and zones.

use std::str::FromStr;

use clap::{ArgGroup, Args, ValueEnum};
use rvac_api::{CleaningPattern, CleaningPower};

use super::Daemon;

#[derive(Debug, Args)]
pub(crate) struct OrderOptions {
    #[command(flatten)]
    pub(crate) parts: OrderParts,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
}

/// What of the home a job cleans.
#[derive(Debug, Args)]
pub(crate) struct OrderParts {
    /// A room by its name or number, as `rvac rooms` shows them; may be given several times, rooms are cleaned in this order.
    #[arg(long, value_name = "ROOM")]
    pub(crate) room: Vec<String>,
    /// A rectangle between two opposite corners, in metres of the map; may be given several times, zones come after rooms.
    #[arg(long, value_names = ["X,Y", "X,Y"], num_args = 2, allow_hyphen_values = true)]
    pub(crate) zone: Vec<Place>,
    /// A place in metres of the map: a disc of one metre around it is cleaned; may be given several times, spots come after zones.
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub(crate) spot: Vec<Place>,
    /// A saved zone or spot by its name or number, as `rvac places` shows them; may be given several times, they come last.
    #[arg(long, value_name = "PLACE")]
    pub(crate) place: Vec<String>,
    /// A rectangle between two opposite corners, metres in the map, that the robot keeps out of until the next job begins; may be
    /// given several times. `rvac zone` forbids floor for good.
    #[arg(long, value_names = ["X,Y", "X,Y"], num_args = 2, allow_hyphen_values = true)]
    pub(crate) avoid: Vec<Place>,
    /// How often each room, zone and spot is cleaned before the next, 1 to 3.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) passes: u8,
    /// Power of brushes and suction in this job; when not given, the setting of each room.
    #[arg(long, value_enum)]
    pub(crate) power: Option<PowerChoice>,
    /// Cleaning pattern of this job; when not given, the setting of each room.
    #[arg(long, value_enum)]
    pub(crate) pattern: Option<PatternChoice>,
}

/// How hard brushes and suction run in a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PowerChoice {
    /// Suction at 40 %, brushes at 60 %.
    Quiet,
    /// Suction at 70 %, brushes at 80 %.
    Normal,
    /// Full power.
    Full,
}

impl From<PowerChoice> for CleaningPower {
    fn from(choice: PowerChoice) -> Self {
        match choice {
            PowerChoice::Quiet => Self::QUIET,
            PowerChoice::Normal => Self::NORMAL,
            PowerChoice::Full => Self::FULL,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct EstimateOptions {
    #[command(flatten)]
    pub(crate) order: OrderOptions,
    /// Print the daemon's own JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// In which way floor is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PatternChoice {
    /// Straight lanes side by side.
    Lines,
    /// Rings along walls and furniture, from the wall inwards.
    Contour,
}

impl From<PatternChoice> for CleaningPattern {
    fn from(choice: PatternChoice) -> Self {
        match choice {
            PatternChoice::Lines => Self::Lines,
            PatternChoice::Contour => Self::Contour,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct RoomsJob {
    #[command(subcommand)]
    pub(crate) verb: Option<RoomsVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum RoomsVerb {
    /// Name a room.
    Name {
        /// Its number or its present name.
        room: String,
        /// One line of 1 to 40 characters.
        name: String,
    },
    /// Remove the name of a room.
    Unname {
        /// Its name or number.
        room: String,
    },
    /// Set how a room is cleaned; what is not given stays.
    #[command(group = ArgGroup::new("settings").required(true).multiple(true))]
    Set {
        /// Its name or number.
        room: String,
        /// Least number of passes, 1 to 3, whenever a job names the room.
        #[arg(long, group = "settings", value_name = "N")]
        passes: Option<u8>,
        /// Power of the suction, percent.
        #[arg(long, group = "settings", value_name = "PERCENT")]
        suction: Option<u8>,
        /// Power of the main brush, percent.
        #[arg(long, group = "settings", value_name = "PERCENT")]
        main_brush: Option<u8>,
        /// Power of the side brushes, percent.
        #[arg(long, group = "settings", value_name = "PERCENT")]
        side_brushes: Option<u8>,
        /// Cleaning pattern.
        #[arg(long, group = "settings", value_enum)]
        pattern: Option<PatternChoice>,
    },
    /// Reset a room to the defaults: one pass, full power, lines.
    Unset {
        /// Its name or number.
        room: String,
    },
    /// Split a room along a line; the larger part keeps number and name.
    Split {
        /// Its name or number.
        room: String,
        /// One end of the line, in metres of the map, at a wall of the room.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        from: Place,
        /// The other end, at another wall.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        to: Place,
    },
    /// Join two neighbouring rooms; the result keeps the number of the named one, else of the larger one.
    Join {
        /// Name or number of one room.
        room: String,
        /// Name or number of the other room.
        other: String,
    },
    /// List how the rooms were split and joined, or undo such a change.
    Undo {
        /// Number of the change to undo; without it, all changes are listed.
        number: Option<u16>,
    },
}

#[derive(Debug, Args)]
pub(crate) struct ZoneJob {
    #[command(subcommand)]
    pub(crate) verb: Option<ZoneVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum ZoneVerb {
    /// Forbid a rectangle between two opposite corners, or a polygon.
    Add {
        /// A corner, metres in the map.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        from: Place,
        /// The opposite corner; of a polygon the next one.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        to: Place,
        /// The third corner of a polygon; again for each further one.
        #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
        corner: Vec<Place>,
        /// Its name, one line of 1 to 40 characters.
        #[arg(long)]
        name: Option<String>,
    },
    /// Add a virtual wall.
    Wall {
        /// One end, metres in the map.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        from: Place,
        /// The other end.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        to: Place,
        /// Its name, one line of 1 to 40 characters.
        #[arg(long)]
        name: Option<String>,
    },
    /// Name a zone or wall.
    Name {
        /// Its number, as `rvac zone` shows it, or its present name.
        zone: String,
        /// One line of 1 to 40 characters.
        name: String,
    },
    /// Remove the name of a zone or wall.
    Unname {
        /// Its name or number.
        zone: String,
    },
    /// Move or reshape a zone or wall; its number and name stay.
    Reshape {
        /// Its name or number.
        zone: String,
        /// A corner of the zone or one end of the wall, metres in the map.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        from: Place,
        /// The opposite corner, of a polygon the next one, or the other end of the wall.
        #[arg(value_name = "X,Y", allow_hyphen_values = true)]
        to: Place,
        /// The third corner of a polygon; again for each further one. A wall has none.
        #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
        corner: Vec<Place>,
    },
    /// Remove a zone or wall.
    Remove {
        /// Its name or number.
        zone: String,
    },
}

#[derive(Debug, Args)]
pub(crate) struct PlacesJob {
    #[command(subcommand)]
    pub(crate) verb: Option<PlacesVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum PlacesVerb {
    /// Save a zone or spot under a name.
    #[command(group = ArgGroup::new("shape").required(true))]
    Keep {
        /// One line of 1 to 40 characters.
        name: String,
        /// A rectangle between two opposite corners, metres in the map; of a polygon its first two corners.
        #[arg(long, group = "shape", value_names = ["X,Y", "X,Y"], num_args = 2, allow_hyphen_values = true)]
        zone: Vec<Place>,
        /// The third corner of a polygon; again for each further one.
        #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "zone")]
        corner: Vec<Place>,
        /// The middle of a spot, metres in the map.
        #[arg(long, group = "shape", value_name = "X,Y", allow_hyphen_values = true)]
        spot: Option<Place>,
    },
    /// Rename a saved place.
    Name {
        /// Its number or its present name.
        place: String,
        /// One line of 1 to 40 characters.
        name: String,
    },
    /// Move or reshape a saved place; its number and name stay.
    #[command(group = ArgGroup::new("where").required(true))]
    Reshape {
        /// Its name or number.
        place: String,
        /// A rectangle between two opposite corners, metres in the map; of a polygon its first two corners.
        #[arg(long, group = "where", value_names = ["X,Y", "X,Y"], num_args = 2, allow_hyphen_values = true)]
        zone: Vec<Place>,
        /// The third corner of a polygon; again for each further one.
        #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "zone")]
        corner: Vec<Place>,
        /// The middle of a spot, metres in the map.
        #[arg(long, group = "where", value_name = "X,Y", allow_hyphen_values = true)]
        spot: Option<Place>,
    },
    /// Remove a saved place.
    Forget {
        /// Its name or number.
        place: String,
    },
}

/// A place in the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
}

/// Text that is no place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoPlace;

impl core::fmt::Display for NoPlace {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter
            .write_str("a place is two numbers of metres with a comma between them, for example 1.5,-0.25")
    }
}

impl core::error::Error for NoPlace {}

impl FromStr for Place {
    type Err = NoPlace;

    fn from_str(text: &str) -> Result<Self, NoPlace> {
        let (x, y) = text.split_once(',').ok_or(NoPlace)?;
        let metres = |text: &str| text.trim().parse().ok().filter(|metres: &f64| metres.is_finite());
        Ok(Self {
            x_m: metres(x).ok_or(NoPlace)?,
            y_m: metres(y).ok_or(NoPlace)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{NoPlace, Place};

    #[test]
    fn a_place_is_two_finite_numbers() {
        assert_eq!("1.5,-0.25".parse(), Ok(Place { x_m: 1.5, y_m: -0.25 }));
        for wrong in ["", "1", "1;2", "1,2,3", "nan,0", "inf,1", "a,b"] {
            assert_eq!(wrong.parse::<Place>(), Err(NoPlace), "{wrong}");
        }
    }
}
