//! After a touch on one side the robot keeps a little to the other side: its pose was wrong there, and it would touch the
//! same thing again on the same path.

use super::parameters::STANDOFF;
use crate::model::advance::Advance;
use crate::model::reason::Reason;

/// The current offset.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactOffset {
    offset_m: f64,
    left_m: f64,
}

impl ContactOffset {
    /// Records a touch.
    pub(super) fn touched(&mut self, reason: Reason) {
        let offset_m = match reason {
            Reason::BumpLeft => -STANDOFF.contact_offset_m,
            Reason::BumpRight => STANDOFF.contact_offset_m,
            _ => 0.0,
        };
        *self = Self {
            offset_m,
            left_m: STANDOFF.contact_offset_for_m,
        };
    }

    /// Offset to the left of the path (negative: to the right), metres.
    pub(super) fn offset_m(&mut self, advance: Advance) -> f64 {
        self.left_m -= advance.distance_m.max(0.0);
        if self.left_m > 0.0 { self.offset_m } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::{ContactOffset, STANDOFF};
    use crate::model::advance::Advance;
    use crate::model::reason::Reason;

    fn ahead(distance_m: f64) -> Advance {
        Advance {
            distance_m,
            ..Advance::default()
        }
    }

    #[test]
    fn it_keeps_away_from_the_touched_side_for_a_distance() {
        let mut contact_offset = ContactOffset::default();
        assert_eq!(contact_offset.offset_m(ahead(0.1)), 0.0);
        contact_offset.touched(Reason::BumpLeft);
        assert_eq!(
            contact_offset.offset_m(ahead(-0.03)),
            -STANDOFF.contact_offset_m,
            "backing off does not count"
        );
        assert_eq!(
            contact_offset.offset_m(ahead(0.9 * STANDOFF.contact_offset_for_m)),
            -STANDOFF.contact_offset_m
        );
        assert_eq!(
            contact_offset.offset_m(ahead(0.2 * STANDOFF.contact_offset_for_m)),
            0.0
        );
        contact_offset.touched(Reason::BumpRight);
        assert_eq!(contact_offset.offset_m(ahead(0.0)), STANDOFF.contact_offset_m);
        contact_offset.touched(Reason::BumpFront);
        assert_eq!(contact_offset.offset_m(ahead(0.0)), 0.0);
    }
}
