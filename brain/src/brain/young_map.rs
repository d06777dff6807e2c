//! How long a robot that was carried in its first run searches for its place in the map of that run.
//!
//! Whoever carries the robot off within the first minutes leaves it with a map of one room, in which it may never be again; and a robot
//! that is put back where it was drives on into floor that the map does not show. It cannot know which of the two happened, so it
//! searches for half the time in which it could map that floor once more, and then begins anew: a place is found early or seldom (the
//! ski-rental problem). In one room it does not search at all.

/// Time of a search for a square metre of floor, seconds. A first run maps one in 18 s: 3 m2 in the first minute, 51 m2 in a quarter of
/// an hour (first runs of ten generated homes).
const SEARCH_S_PER_M2: f64 = 9.0;
/// A map of less floor than this shows one room, m2. Rooms look alike: robots took the place where they were for another one in such
/// maps, and drove for minutes before the sensors contradicted it.
const ROOM_M2: f64 = 15.0;
/// A map of less floor than this is no loss, m2: who has just unpacked the robot and carries it to its dock has no lost robot.
const NOTHING_M2: f64 = 0.5;

/// How long a robot has been searching for its place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct YoungMapSearch {
    time_s: f64,
    /// What it searches in, judged when the search began.
    worth: Option<MapWorth>,
}

/// What the map of a first run is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MapWorth {
    /// Nothing is lost with it.
    Nothing,
    /// A search of so many seconds.
    Search { time_s: f64 },
}

impl MapWorth {
    /// Of a map with so much known floor, m2, in which a place can be found at all or not.
    pub(super) fn of(floor_m2: f64, may_relocalize: bool) -> Self {
        if floor_m2 < NOTHING_M2 {
            Self::Nothing
        } else if floor_m2 >= ROOM_M2 && may_relocalize {
            Self::Search {
                time_s: SEARCH_S_PER_M2 * floor_m2,
            }
        } else {
            Self::Search { time_s: 0.0 }
        }
    }
}

impl YoungMapSearch {
    /// Takes `time_s` more seconds, which count while the robot cleans. Returns whether the search has cost what the map is worth.
    pub(super) fn is_over_after(
        &mut self,
        time_s: f64,
        is_cleaning: bool,
        worth: impl FnOnce() -> MapWorth,
    ) -> bool {
        if is_cleaning {
            self.time_s += time_s;
        }
        match *self.worth.get_or_insert_with(worth) {
            MapWorth::Nothing => true,
            MapWorth::Search { time_s } => is_cleaning && self.time_s >= time_s,
        }
    }

    /// Time of the search, seconds.
    pub(super) fn time_s(self) -> f64 {
        self.time_s
    }
}

#[cfg(test)]
mod tests {
    use super::{MapWorth, YoungMapSearch};

    #[test]
    fn a_search_ends_when_it_has_cost_what_the_map_is_worth() {
        let mut search = YoungMapSearch::default();
        let worth = || MapWorth::of(20.0, true);
        assert!(!search.is_over_after(1_000.0, false, worth), "it rests");
        assert!(!search.is_over_after(179.0, true, worth));
        assert!(
            search.is_over_after(1.0, true, || MapWorth::of(100.0, true)),
            "judged at the begin"
        );
        assert_eq!(search.time_s(), 180.0);
    }

    #[test]
    fn one_room_and_a_vague_map_are_not_searched_and_a_few_cells_are_dropped_by_a_robot_at_rest() {
        for (floor_m2, may_relocalize) in [(14.0, true), (60.0, false)] {
            let over = |is_cleaning| {
                YoungMapSearch::default()
                    .is_over_after(0.02, is_cleaning, || MapWorth::of(floor_m2, may_relocalize))
            };
            assert!(over(true) && !over(false), "{floor_m2} m2");
        }
        assert!(YoungMapSearch::default().is_over_after(0.02, false, || MapWorth::of(0.3, true)));
    }
}
