//! The robot's map of the home: as a picture, and as rows of text.

use rvac_api::{HomeView, Pose, RoomView, SimulatedPlan};

use crate::figures::area_text;
use crate::room_settings::room_settings_text;
use crate::words::Words;

/// Kinds of cells of a plan that only the robot's own map has, beside those of [`SimulatedPlan`]: not to be entered, and
/// floor of a room. Rooms share the tints in turn.
pub(crate) const NO_GO: u32 = 5;
/// Floor of a room that a person has chosen.
pub(crate) const CHOSEN: u32 = 6;
/// First kind for floor of a room.
pub(crate) const ROOM: u32 = 16;
/// The value of a cell with detected carpet.
const FELT_CARPET: u32 = 2;
/// Added to a kind of floor where it has. Chosen rooms are one tint: what a person chooses must be salient.
pub(crate) const CARPET: u32 = 64;
/// Tints of rooms.
pub const ROOM_TINTS: u32 = 6;
/// Largest window that is drawn, in cells.
const CELLS_MAX: u64 = 1 << 24;
/// Rooms, doors and walls that are drawn or listed at most.
pub const ITEMS_MAX: usize = 1_000;

/// The home as a plan, each room in its tint; those that are chosen share one.
#[must_use]
pub fn home_plan(home: &HomeView, chosen: &[u16]) -> SimulatedPlan {
    let total = u64::from(home.width) * u64::from(home.height);
    SimulatedPlan {
        name: String::new(),
        cell_m: home.cell_m,
        width: home.width,
        height: home.height,
        origin: Pose {
            x: f64::from(home.x) * home.cell_m,
            y: f64::from(home.y) * home.cell_m,
            heading: 0.0,
            t: 0.0,
        },
        cells: merged(home, chosen, total.min(CELLS_MAX)),
        dock: home.dock,
    }
}

/// Runs of cells with rooms and carpets in them. None of the three needs to be as long as it should.
fn merged(home: &HomeView, chosen: &[u16], total: u64) -> Vec<u32> {
    let mut rooms = Runs::new(&home.room_cells);
    let mut felt = Runs::new(home.carpet.as_ref().map_or(&[], |carpet| &carpet.cells));
    let mut merged = Vec::new();
    let mut left = total;
    for run in home.cells.chunks_exact(2) {
        let &[kind, length] = run else { continue };
        let mut length = u64::from(length).min(left);
        left -= length;
        while length > 0 {
            let (floor, alike) = felt.ahead(length);
            let (room, span) = rooms.ahead(alike);
            felt.pass(span);
            rooms.pass(span);
            let bare = match kind {
                1 if chosen.iter().any(|id| u32::from(*id) == room) => CHOSEN,
                1 if room > 0 => ROOM + (room - 1) % ROOM_TINTS,
                1..=3 => kind,
                4 => NO_GO,
                _ => 0,
            };
            let shown = if kind == 1 && bare != CHOSEN && floor == FELT_CARPET {
                bare + CARPET
            } else {
                bare
            };
            merged.extend([shown, u32::try_from(span).unwrap_or(u32::MAX)]);
            length -= span;
        }
    }
    merged
}

/// Whether carpet is to be seen in a plan.
#[must_use]
pub fn has_carpet(plan: &SimulatedPlan) -> bool {
    plan.cells.chunks_exact(2).any(|run| run.first() >= Some(&CARPET))
}

/// Runs that are read piece by piece.
struct Runs<'a> {
    runs: core::slice::ChunksExact<'a, u32>,
    value: u32,
    left: u64,
}

impl<'a> Runs<'a> {
    fn new(runs: &'a [u32]) -> Self {
        Self {
            runs: runs.chunks_exact(2),
            value: 0,
            left: 0,
        }
    }

    /// The value of the next cells and for how many of them, at most `most`, it holds.
    fn ahead(&mut self, most: u64) -> (u32, u64) {
        while self.left == 0 {
            let Some(run) = self.runs.next() else {
                return (0, most);
            };
            if let &[value, length] = run {
                (self.value, self.left) = (value, length.into());
            }
        }
        (self.value, self.left.min(most))
    }

    /// Goes on by some of those cells; behind the last run there is nothing to go on in.
    fn pass(&mut self, span: u64) {
        self.left = self.left.saturating_sub(span);
    }
}

/// A room as a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoomRow {
    /// Its identity.
    pub id: u16,
    /// `Room 2`, or what people call it
    pub name: String,
    /// `12.4 m², doors to Kitchen and Room 3`
    pub words: String,
}

/// The rooms by their identities.
#[must_use]
pub fn room_rows(words: &Words, home: &HomeView) -> Vec<RoomRow> {
    let mut rows: Vec<RoomRow> = home
        .rooms
        .iter()
        .take(ITEMS_MAX)
        .map(|room| RoomRow {
            id: room.id,
            name: room_name(words, room),
            words: format!(
                "{}{}{}",
                area_text(words, room.area_m2),
                room.settings
                    .map(|settings| room_settings_text(words, &settings))
                    .unwrap_or_default(),
                doors_text(words, home, room.id)
            ),
        })
        .collect();
    rows.sort_by_key(|row| row.id);
    rows
}

/// What people call a room, else its number.
#[must_use]
pub fn room_name(words: &Words, room: &RoomView) -> String {
    room.name
        .clone()
        .unwrap_or_else(|| words.home.room.fill([&room.id]))
}

fn doors_text(words: &Words, home: &HomeView, room: u16) -> String {
    let beyond = |rooms: [u16; 2]| match rooms {
        [one, other] if one == room => Some(other),
        [one, other] if other == room => Some(one),
        _ => None,
    };
    let doors = home.doors.iter().take(ITEMS_MAX);
    let mut others: Vec<u16> = doors.filter_map(|door| beyond(door.rooms)).collect();
    others.sort_unstable();
    others.dedup();
    let name = |id: &u16| match home.rooms.iter().find(|room| room.id == *id) {
        Some(room) => room_name(words, room),
        None => words.home.room.fill([id]),
    };
    let names: Vec<String> = others.iter().map(name).collect();
    match names.as_slice() {
        [] => String::new(),
        [only] => words.home.door_to.fill([only]),
        [first @ .., last] => words.home.doors_to.fill([&first.join(", "), last]),
    }
}

/// Walls as strokes `[x0,y0,x1,y1,...]` in metres.
#[must_use]
pub fn wall_strokes(home: &HomeView) -> Vec<f32> {
    let walls = home.walls.iter().take(ITEMS_MAX);
    let ends = walls.flat_map(|wall| [wall.from[0], wall.from[1], wall.to[0], wall.to[1]]);
    ends.map(|metres| metres as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::{has_carpet, home_plan, merged, room_rows};
    use crate::words::Language;
    use rvac_api::{CarpetView, DoorView, HomeView, RoomView};

    #[test]
    fn known_cells_are_drawn_each_room_in_its_tint() {
        let home = HomeView {
            cell_m: 0.025,
            x: -40,
            y: 8,
            width: 6,
            height: 1,
            cells: vec![0, 1, 1, 2, 2, 1, 4, 1, 3, 1],
            room_cells: vec![0, 2, 2, 3, 0, 1],
            ..HomeView::default()
        };
        let plan = home_plan(&home, &[]);
        assert_eq!(plan.cells, [0, 1, 1, 1, 17, 1, 2, 1, 5, 1, 3, 1]);
        assert_eq!(home_plan(&home, &[2]).cells, [0, 1, 1, 1, 6, 1, 2, 1, 5, 1, 3, 1]);
        assert_eq!((plan.origin.x, plan.origin.y), (-1.0, 0.2));
        assert_eq!((plan.width, plan.height), (6, 1));
    }

    #[test]
    fn carpet_is_drawn_on_floor_of_every_kind_and_on_nothing_else() {
        let home = HomeView {
            width: 6,
            height: 1,
            cells: vec![1, 4, 2, 1, 1, 1],
            room_cells: vec![0, 1, 2, 5],
            carpet: Some(CarpetView {
                cells: vec![1, 2, 2, 4],
                ..CarpetView::default()
            }),
            ..HomeView::default()
        };
        let plan = home_plan(&home, &[]);
        assert_eq!(plan.cells, [1, 1, 17, 1, 81, 2, 2, 1, 81, 1]);
        assert!(has_carpet(&plan));
        let chosen = home_plan(&home, &[2]);
        assert_eq!(chosen.cells, [1, 1, 6, 1, 6, 2, 2, 1, 6, 1]);
        assert!(!has_carpet(&home_plan(&HomeView { carpet: None, ..home }, &[])));
    }

    #[test]
    fn runs_that_do_not_fit_do_no_harm() {
        let drawn = |cells: &[u32], room_cells: &[u32], total: u64| {
            let home = HomeView {
                cells: cells.to_vec(),
                room_cells: room_cells.to_vec(),
                carpet: Some(CarpetView {
                    cells: vec![0, 1, 7],
                    ..CarpetView::default()
                }),
                ..HomeView::default()
            };
            merged(&home, &[], total)
        };
        assert_eq!(drawn(&[1, u32::MAX], &[], 4), [1, 1, 1, 3]);
        assert_eq!(drawn(&[1, 3, 7], &[9, 0, 1, 1], 9), [16, 1, 1, 2]);
        assert_eq!(
            drawn(&[1, 2, 2, u32::MAX], &[u32::MAX, u32::MAX], 3),
            [16 + (u32::MAX - 1) % 6, 1, 16 + (u32::MAX - 1) % 6, 1, 2, 1]
        );
        let huge = HomeView {
            width: u32::MAX,
            height: u32::MAX,
            cells: vec![1, u32::MAX],
            ..HomeView::default()
        };
        assert_eq!(home_plan(&huge, &[]).cells, [1, 1 << 24]);
    }

    #[test]
    fn rooms_are_rows_with_their_neighbours() {
        let room = |id| RoomView {
            id,
            area_m2: 12.44,
            x: 0.0,
            y: 0.0,
            name: (id == 2).then(|| "Kitchen".to_owned()),
            settings: None,
        };
        let door = |rooms| DoorView {
            rooms,
            x: 0.0,
            y: 0.0,
            width_m: 0.8,
        };
        let home = HomeView {
            rooms: vec![room(3), room(1), room(2)],
            doors: vec![door([1, 3]), door([2, 1]), door([1, 2])],
            ..HomeView::default()
        };
        let rows = room_rows(Language::English.words(), &home);
        assert_eq!(rows[0].words, "12.4\u{a0}m², doors to Kitchen and Room\u{a0}3");
        assert_eq!(
            (rows[2].name.as_str(), rows[2].words.as_str()),
            ("Room\u{a0}3", "12.4\u{a0}m², door to Room\u{a0}1")
        );
    }
}
