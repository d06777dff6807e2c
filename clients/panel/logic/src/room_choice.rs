//! Which rooms a person has chosen, in which order, and what cleaning them takes.

use rvac_api::{HomeView, JobEstimate, JobOrder, JobPart};

use crate::figures::{area_text, percent_text};

/// Most passes over a room.
pub const PASSES_MAX: u8 = 3;

/// Rooms in the order in which they were chosen, and how often each is cleaned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoomChoice {
    rooms: Vec<u16>,
    passes: u8,
}

impl Default for RoomChoice {
    fn default() -> Self {
        Self {
            rooms: Vec::new(),
            passes: 1,
        }
    }
}

impl RoomChoice {
    /// Chooses a room as the last one, or takes it out.
    pub fn toggle(&mut self, room: u16) {
        if self.place(room).is_some() {
            self.rooms.retain(|chosen| *chosen != room);
        } else {
            self.rooms.push(room);
        }
    }

    /// Place of a room in the order, from 1; none if it is not chosen.
    #[must_use]
    pub fn place(&self, room: u16) -> Option<usize> {
        let index = self.rooms.iter().position(|chosen| *chosen == room)?;
        Some(index + 1)
    }

    /// The chosen rooms in their order.
    #[must_use]
    pub fn rooms(&self) -> &[u16] {
        &self.rooms
    }

    /// Drops rooms that the home does not have any more. `true` when there were any.
    pub fn retain_known(&mut self, home: &HomeView) -> bool {
        let before = self.rooms.len();
        self.rooms
            .retain(|chosen| home.rooms.iter().any(|room| room.id == *chosen));
        self.rooms.len() != before
    }

    /// Chooses nothing.
    pub fn clear(&mut self) {
        self.rooms.clear();
    }

    /// How often each room is cleaned.
    #[must_use]
    pub fn passes(&self) -> u8 {
        self.passes
    }

    /// Cleans each room so often, within what a robot takes.
    pub fn set_passes(&mut self, passes: u8) {
        self.passes = passes.clamp(1, PASSES_MAX);
    }

    /// The job; none while no room is chosen.
    #[must_use]
    pub fn order(&self) -> Option<JobOrder> {
        let parts: Vec<JobPart> = self.rooms.iter().copied().map(JobPart::Room).collect();
        (!parts.is_empty()).then_some(JobOrder {
            parts,
            passes: self.passes,
            ..JobOrder::default()
        })
    }
}

/// `18.2 m², about 25 min, 41 % of a full battery; 97 % of the floor will be swept, 91 % if the robot is less sure of its
/// place than it believes`
#[must_use]
pub fn job_estimate_text(estimate: &JobEstimate) -> String {
    let charge = 100.0 * estimate.charge.max(0.0);
    let pauses = if estimate.charge > 1.0 {
        ", with pauses to charge"
    } else {
        ""
    };
    format!(
        "{}, about {:.0} min, {charge:.0} % of a full battery{pauses}; {} of the floor will be swept, {} if the robot is \
         less sure of its place than it believes",
        area_text(estimate.floor_m2),
        (estimate.time_s / 60.0).ceil(),
        percent_text(estimate.share),
        percent_text(estimate.share_low),
    )
}

/// The room under a place of the map.
#[must_use]
pub fn room_at(home: &HomeView, (x_m, y_m): (f64, f64)) -> Option<u16> {
    let cell = |metres: f64, origin: i32| (metres / home.cell_m).floor() - f64::from(origin);
    let (column, row) = (cell(x_m, home.x), cell(y_m, home.y));
    // Written so that NaN is nowhere.
    let is_inside =
        (0.0..f64::from(home.width)).contains(&column) && (0.0..f64::from(home.height)).contains(&row);
    if !is_inside {
        return None;
    }
    let mut ahead = row as u64 * u64::from(home.width) + column as u64;
    for run in home.room_cells.chunks_exact(2) {
        let &[room, length] = run else { continue };
        match ahead.checked_sub(length.into()) {
            Some(rest) => ahead = rest,
            None => return u16::try_from(room).ok().filter(|room| *room > 0),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{RoomChoice, job_estimate_text, room_at};
    use rvac_api::{HomeView, JobEstimate, JobPart};

    #[test]
    fn rooms_are_cleaned_in_the_order_in_which_they_were_chosen() {
        let mut choice = RoomChoice::default();
        assert_eq!(choice.order(), None);
        for room in [4, 2, 7, 2] {
            choice.toggle(room);
        }
        choice.set_passes(9);
        let order = choice.order().expect("two rooms");
        assert_eq!(order.parts, [JobPart::Room(4), JobPart::Room(7)]);
        assert_eq!(order.passes, 3);
        assert_eq!((choice.place(7), choice.place(2)), (Some(2), None));
        assert!(choice.retain_known(&HomeView::default()) && choice.order().is_none());
    }

    #[test]
    fn a_tap_finds_the_room_under_it() {
        let home = HomeView {
            cell_m: 0.5,
            x: -2,
            y: 4,
            width: 3,
            height: 2,
            room_cells: vec![1, 2, 0, 1, 2, 3],
            ..HomeView::default()
        };
        for (place, room) in [
            ((-0.9, 2.1), Some(1)),
            ((-0.1, 2.1), Some(1)),
            ((0.1, 2.4), None),
            ((0.1, 2.6), Some(2)),
            ((-1.1, 2.1), None),
            ((0.6, 2.1), None),
            ((f64::NAN, 2.1), None),
        ] {
            assert_eq!(room_at(&home, place), room, "{place:?}");
        }
        assert_eq!(room_at(&HomeView::default(), (0.0, 0.0)), None);
    }

    #[test]
    fn an_estimate_is_one_line() {
        let estimate = JobEstimate {
            floor_m2: 18.2,
            time_s: 1450.0,
            charge: 1.2,
            share: 0.974,
            share_low: 0.91,
            ..JobEstimate::default()
        };
        let text = job_estimate_text(&estimate);
        assert!(
            text.starts_with("18.2 m², about 25 min, 120 % of a full battery, with pauses to charge; 97 %"),
            "{text}"
        );
    }
}
