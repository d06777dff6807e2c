//! Why a request is refused: a name for programs, and a sentence for people that says what was wrong, where, and what to
//! do.

use brain::{
    Brain, CELL_M, Cell, CellKnowledge, CleaningOrder, EditError, JobRefusal, NoGoShape, OrderRefusal,
};
use rvac_api::{Explanation, explain};

/// Why a request is refused, by name.
pub(crate) type Refused = &'static str;

/// A refusal without an explanation.
const NOT_NOW: &str = "The robot cannot do this in its present state; the reason has the name of the cause.";

/// A refusal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Refusal {
    pub(crate) reason: &'static str,
    pub(crate) text: String,
}

impl From<&'static str> for Refusal {
    fn from(reason: &'static str) -> Self {
        Self {
            reason,
            text: text(reason),
        }
    }
}

impl From<EditError> for Refusal {
    fn from(error: EditError) -> Self {
        Self::from(error.name())
    }
}

impl From<JobRefusal> for Refusal {
    fn from(refusal: JobRefusal) -> Self {
        Self::from(refusal.name())
    }
}

impl Refusal {
    pub(crate) fn because(error: EditError, text: String) -> Self {
        Self {
            reason: error.name(),
            text,
        }
    }

    /// No room of this identity; the sentence names those that there are.
    pub(crate) fn no_such_room(room: u16, brain: &Brain) -> Self {
        let names = brain.map().annotations();
        let rooms = brain.map().rooms().rooms().iter();
        let known: Vec<String> = rooms
            .map(|room| match names.name(room.id) {
                Some(name) => format!("{} ({})", room.id, name.as_str()),
                None => room.id.to_string(),
            })
            .collect();
        let text = if known.is_empty() {
            format!("The map has no room {room}: it has no rooms yet, let the robot clean once.")
        } else {
            format!(
                "The map has no room {room}: it has the rooms {}.",
                known.join(", ")
            )
        };
        Self::because(EditError::NoSuchRoom, text)
    }

    /// A part of an order lies where the map has no floor.
    pub(crate) fn no_floor_there(what: &str, brain: &Brain) -> Self {
        let known = brain.map().knowledge();
        let free = (0..known.values().len())
            .filter(|index| known.values().get(*index) == Some(&CellKnowledge::Free))
            .map(|index| known.cell(index));
        let span = free.fold(None, |span: Option<(Cell, Cell)>, cell| {
            let (low, high) = span.unwrap_or((cell, cell));
            Some((
                Cell {
                    x: low.x.min(cell.x),
                    y: low.y.min(cell.y),
                },
                Cell {
                    x: high.x.max(cell.x),
                    y: high.y.max(cell.y),
                },
            ))
        });
        let text = match span {
            Some((low, high)) => format!(
                "The map knows no floor {what}: its floor spans x {} and y {}.",
                metres(low.x, high.x),
                metres(low.y, high.y)
            ),
            None => "The robot has no map yet: let it clean once.".to_owned(),
        };
        Self::because(EditError::NoFloorThere, text)
    }

    /// No-go zones and virtual walls shut floor off; the sentence names those that do so alone.
    fn in_the_way(refusal: &OrderRefusal, brain: &Brain) -> Self {
        let no_gos = brain.map().annotations().no_go();
        let named: Vec<String> = no_gos
            .filter(|(number, _)| refusal.in_the_way.contains(number))
            .map(|(number, no_go)| {
                let kind = match no_go.shape() {
                    NoGoShape::Zone => "no-go zone",
                    NoGoShape::Wall { .. } => "virtual wall",
                };
                let name = no_go.name().map(|name| format!(" ({})", name.as_str()));
                format!("the {kind} {number}{}", name.unwrap_or_default())
            })
            .collect();
        let plain = Self::from(refusal.reason);
        if named.is_empty() {
            return plain;
        }
        Self {
            text: format!("{} It is {}.", plain.text, named.join(" or ")),
            ..plain
        }
    }

    /// What is wrong with an order that the brain refuses.
    pub(crate) fn of_order(refusal: &OrderRefusal, order: &CleaningOrder, brain: &Brain) -> Self {
        let rooms = brain.map().rooms().rooms();
        let is_missing = |part: &brain::HomePart| match part {
            brain::HomePart::Room(id) if rooms.iter().all(|room| room.id != *id) => Some(*id),
            _ => None,
        };
        match (refusal.reason, order.parts().iter().find_map(is_missing)) {
            (JobRefusal::Order(EditError::NoSuchRoom), Some(room)) => Self::no_such_room(room, brain),
            (JobRefusal::Order(EditError::NoFloorThere), _) => {
                Self::no_floor_there("in one of the zones and spots", brain)
            }
            (JobRefusal::NoGoInTheWay | JobRefusal::VirtualWallInTheWay, _) => {
                Self::in_the_way(refusal, brain)
            }
            (reason, _) => Self::from(reason),
        }
    }
}

/// The sentences of a named reason: what, and what to do.
pub(crate) fn text(reason: &str) -> String {
    explain(reason).map_or_else(|| NOT_NOW.to_owned(), Explanation::text)
}

/// From the lower edge of one cell to the upper edge of another.
fn metres(low: i32, high: i32) -> String {
    let from_m = f64::from(low) * CELL_M;
    let to_m = (f64::from(high) + 1.0) * CELL_M;
    format!("{from_m:.1} to {to_m:.1} m")
}

#[cfg(test)]
mod tests {
    use brain::{Inhibit, JobRefusal, Reason};
    use rvac_api::explain;

    #[test]
    fn everything_that_stops_the_robot_or_refuses_is_explained() {
        let reasons = Reason::all().map(Reason::name);
        let refusals = JobRefusal::all().map(JobRefusal::name);
        let inhibits = Inhibit::all().map(Inhibit::name);
        let missing: Vec<&str> = reasons
            .chain(refusals)
            .chain(inhibits)
            .filter(|code| explain(code).is_none())
            .collect();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
