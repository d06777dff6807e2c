//! Which part of an order is being cleaned, and how often it was.

use crate::coverage::target_floor::TargetFloor;
use crate::mapping::Map;
use crate::model::no_go::NoGo;
use crate::model::order::{CleaningOrder, HomePart};

/// An order, and its progress.
#[derive(Debug, Default)]
pub(super) struct Assignment {
    order: CleaningOrder,
    /// Index of the current part.
    part: usize,
    /// Finished passes over it.
    passes_done: u8,
    /// A part could not be reached completely.
    pub(super) is_missed: bool,
}

impl Assignment {
    pub(super) fn of(order: CleaningOrder) -> Self {
        Self {
            order,
            ..Self::default()
        }
    }

    /// The current part; `None` = the whole home.
    pub(super) fn part(&self) -> Option<&HomePart> {
        self.order.parts().get(self.part)
    }

    /// Floor that this job keeps out of.
    pub(super) fn avoided(&self) -> &[NoGo] {
        self.order.avoid()
    }

    /// Whether the order names no parts.
    pub(super) fn is_whole_home(&self) -> bool {
        self.order.is_for_whole_home()
    }

    /// The floor to sweep now.
    pub(super) fn target_floor(&self, map: &Map) -> TargetFloor {
        TargetFloor::of(&self.order, self.part(), map)
    }

    /// Finishes one pass over the current part.
    pub(super) fn advance(&mut self, map: &Map) -> Next {
        self.passes_done += 1;
        if self.passes_done < map.annotations().passes_over(&self.order, self.part()) {
            return Next::Again;
        }
        if self.part + 1 >= self.order.parts().len() {
            return Next::End;
        }
        self.passes_done = 0;
        self.part += 1;
        Next::Part
    }
}

/// What follows a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The same part once more.
    Again,
    /// Another part.
    Part,
    /// Nothing.
    End,
}
