//! From wishes to what is asked of the robot, one at a time: who drives holds a seat under a lease, and must hold on to it.

use crate::{Axes, Cleaning, Wish};

/// What to ask now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Nothing.
    Nothing,
    /// Drive like this, until the lease ends.
    Drive {
        /// How it should move.
        axes: Axes,
        /// How hard it should clean.
        cleaning: Cleaning,
    },
    /// Leave the seat.
    Release,
}

/// Whether the robot has been commanded to drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Helm {
    driving: bool,
    refused: bool,
}

impl Helm {
    /// What to ask for a wish. To be called at least ten times a second, so that the lease is renewed.
    pub fn order(&mut self, wish: &Wish) -> Order {
        if !wish.drives {
            self.refused = false;
            return if core::mem::take(&mut self.driving) {
                Order::Release
            } else {
                Order::Nothing
            };
        }
        if self.refused {
            return Order::Nothing;
        }
        // A hold begins at the centre, because the daemon requires that no stick is held through a stop.
        if !core::mem::replace(&mut self.driving, true) {
            return Order::Drive {
                axes: Axes::default(),
                cleaning: Cleaning::default(),
            };
        }
        Order::Drive {
            axes: wish.axes,
            cleaning: wish.cleaning,
        }
    }

    /// The robot refused to be driven: nothing more is asked until everything was let go once.
    pub fn refuse(&mut self) {
        self.refused = true;
        self.driving = false;
    }
}

#[cfg(test)]
mod tests {
    use super::{Helm, Order};
    use crate::{Axes, Cleaning, Wish};

    const AHEAD: Axes = Axes {
        forward: 1.0,
        turn: 0.0,
    };

    fn order(axes: Axes) -> Order {
        Order::Drive {
            axes,
            cleaning: Cleaning::default(),
        }
    }

    #[test]
    fn every_hold_begins_in_the_middle_and_is_released_once() {
        let mut helm = Helm::default();
        let (held, free) = (
            Wish {
                drives: true,
                axes: AHEAD,
                ..Wish::default()
            },
            Wish::default(),
        );
        for _ in 0..2 {
            assert_eq!(helm.order(&free), Order::Nothing);
            assert_eq!(helm.order(&held), order(Axes::default()));
            assert_eq!(helm.order(&held), order(AHEAD));
            assert_eq!(helm.order(&free), Order::Release);
        }
        helm.order(&held);
        helm.refuse();
        assert_eq!(
            helm.order(&held),
            Order::Nothing,
            "a refused driver is silent until all is let go"
        );
        assert_eq!(helm.order(&free), Order::Nothing);
        assert_eq!(helm.order(&held), order(Axes::default()));
    }
}
