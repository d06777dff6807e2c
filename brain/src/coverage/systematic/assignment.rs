//! Which part of an order is being cleaned, and how often it was.

use crate::coverage::target_floor::TargetFloor;
use crate::mapping::Map;
use crate::model::order::{CleaningOrder, HomePart};

/// An order, and how far it is.
#[derive(Debug, Default)]
pub(super) struct Assignment {
    order: CleaningOrder,
    /// Index of the present part.
    part: usize,
    /// Passes over it that are done.
    passes_done: u8,
    /// Some part could not be reached, or not all of it.
    pub(super) is_missed: bool,
}

impl Assignment {
    pub(super) fn of(order: CleaningOrder) -> Self {
        Self {
            order,
            ..Self::default()
        }
    }

    /// The present part; `None` = the whole home.
    pub(super) fn part(&self) -> Option<&HomePart> {
        self.order.parts().get(self.part)
    }

    /// No parts were ordered.
    pub(super) fn is_whole_home(&self) -> bool {
        self.order.is_for_whole_home()
    }

    /// What shall be swept now.
    pub(super) fn target_floor(&self, map: &Map) -> TargetFloor {
        TargetFloor::of(&self.order, self.part(), map)
    }

    /// The present part is done once more.
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

/// What comes after a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The same part once more.
    Again,
    /// Another part.
    Part,
    /// Nothing.
    End,
}
