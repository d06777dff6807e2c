//! Turning on the spot to find the direction of the dock.
//!
//! The two front receivers face to the left and to the right of straight ahead. As the robot turns, both begin to receive
//! the dock at one angle and cease at another. The dock is in the middle of the two.
//!
//! A beam counts as lost only after a while, in which the robot turns on: one turn finds both edges too far in its direction, and so the
//! dock by 5 degrees beside its place. So each edge is the place where the beams cease, the left one in a turn to the left and the right
//! one in a turn to the right: both lie too far outside by the same angle, whatever the delay is.

use super::parameters::SCAN;
use crate::mapping::DockBeamFilter;
use crate::model::action::Motion;

/// A scan in progress.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan {
    /// +1 turns left, -1 right.
    side: f64,
    /// Angle turned since the start, left positive, and the sum of absolute turns.
    turned_rad: f64,
    total_turn_rad: f64,
    /// Angle at which both receivers ceased to receive in the turn to the other side; `None` before.
    edge_rad: Option<f64>,
    was_ahead: bool,
    is_begun: bool,
}

/// State of a scan after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ScanStep {
    /// It goes on.
    Going(Motion),
    /// The dock lies in this direction, left of straight ahead, radians.
    Found(f64),
    /// Nothing that resembles a dock.
    Failed,
}

impl Scan {
    pub(super) fn new() -> Self {
        Self {
            side: 1.0,
            turned_rad: 0.0,
            total_turn_rad: 0.0,
            edge_rad: None,
            was_ahead: false,
            is_begun: false,
        }
    }

    /// One step in which the robot has turned by `turn_rad`.
    pub(super) fn step(&mut self, hearing: &DockBeamFilter, turn_rad: f64) -> ScanStep {
        let ahead = hearing.is_ahead();
        if !self.is_begun {
            self.begin(hearing, ahead);
        } else {
            self.turned_rad += turn_rad;
            self.total_turn_rad += turn_rad.abs();
        }
        let ceases = self.was_ahead && !ahead;
        self.was_ahead = ahead;
        if ceases && let Some(bearing_rad) = self.meet_edge() {
            return ScanStep::Found(bearing_rad);
        }
        if self.total_turn_rad > SCAN.turn_max_rad {
            return ScanStep::Failed;
        }
        ScanStep::Going(Motion::Drive {
            speed_m_per_s: 0.0,
            turn_rad_per_s: self.side * SCAN.turn_rad_per_s,
        })
    }

    /// Both receivers have ceased to receive. Gives the direction of the dock once both edges are known, left of straight ahead, radians.
    fn meet_edge(&mut self) -> Option<f64> {
        let width_rad = self.edge_rad.map(|edge_rad| (self.turned_rad - edge_rad).abs());
        match (self.edge_rad, width_rad) {
            (Some(edge_rad), Some(width_rad)) if SCAN.width_rad.contains(&width_rad) => {
                return Some(0.5 * (edge_rad - self.turned_rad));
            }
            // The beams were lost for a moment.
            (_, Some(width_rad)) if width_rad <= SCAN.width_rad.start => {}
            _ => {
                self.edge_rad = Some(self.turned_rad);
                self.side = -self.side;
            }
        }
        None
    }

    fn begin(&mut self, hearing: &DockBeamFilter, ahead: bool) {
        self.is_begun = true;
        self.was_ahead = ahead;
        if hearing.side() != 0.0 {
            self.side = hearing.side();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Scan, ScanStep};
    use crate::mapping::DockBeamFilter;
    use crate::model::action::Motion;

    /// Turns with a dock at `dock_rad`; gives the direction that the scan finds.
    fn scanned(dock_rad: f64, symbols: u8) -> Option<f64> {
        let (mut scan, mut hearing, mut heading_rad) = (Scan::new(), DockBeamFilter::default(), 0.0_f64);
        let mut turn_rad = 0.0;
        let word = |heading_rad: f64| {
            [0.436, -0.436, 2.618, -2.618].map(|mount_rad: f64| {
                let off = (dock_rad - heading_rad - mount_rad)
                    .sin()
                    .atan2((dock_rad - heading_rad - mount_rad).cos());
                if off.abs() < 1.047 { symbols } else { 0 }
            })
        };
        for _ in 0..20 {
            hearing.update(&word(heading_rad));
        }
        for _ in 0..2_000 {
            hearing.update(&word(heading_rad));
            match scan.step(&hearing, turn_rad) {
                ScanStep::Going(Motion::Drive { turn_rad_per_s, .. }) => turn_rad = 0.02 * turn_rad_per_s,
                ScanStep::Going(_) => return None,
                ScanStep::Found(bearing_rad) => return Some(heading_rad + bearing_rad),
                ScanStep::Failed => return None,
            }
            heading_rad += turn_rad;
        }
        None
    }

    #[test]
    fn the_dock_is_found_in_any_direction_to_within_a_degree() {
        for step in 0..24 {
            let dock_rad = f64::from(step) * 0.26 - 3.1;
            let found_rad = scanned(dock_rad, 3).unwrap();
            let off_rad = (found_rad - dock_rad).sin().atan2((found_rad - dock_rad).cos());
            assert!(off_rad.abs() < 0.02, "{found_rad} instead of {dock_rad}");
        }
    }

    #[test]
    fn a_scan_without_beams_fails() {
        assert_eq!(scanned(0.0, 0), None);
    }
}
