//! Homes that are drawn from a number: rooms, doors and furniture of real sizes.
//!
//! A home has a *number*, which fixes its walls and large furniture, an *arrangement*, which fixes where people left chairs,
//! boxes and toys today, and perhaps *people* who stand in the robot's path and leave. The published set are the numbers 1 to 50 in
//! arrangement 0: those with odd numbers are for tuning, those with even numbers for reports.

mod draw;
mod furnisher;
mod half;
mod layout;
mod recipes;
mod shape;
mod sizes;
mod things;
mod write;

use core::fmt;
use core::ops::RangeInclusive;

use crate::{Home, HomeError, RobotModel};
use draw::Draw;
use furnisher::Furnisher;
pub use half::Half;
use layout::{HomeSize, draw_rooms};
use shape::{Rect, RoomSide, WallFrame};
use things::{Piece, PlacedWalker, Room, RoomKind, Things, Visitor};
use write::Turn;

/// Which generated home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GeneratedHome {
    /// Number of the home, from 1.
    pub number: u32,
    /// How the things that people move are arranged; 0 is the first day.
    pub arrangement: u32,
    /// Whether people and pets block the robot's path for a while.
    pub people: People,
}

/// Whether there are people and pets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum People {
    /// The home is empty.
    #[default]
    Out,
    /// Some stand in the robot's path for a minute or a few, some walk about.
    In,
}

/// The published set.
pub const PUBLISHED: RangeInclusive<u32> = 1..=50;
/// Every so many homes there is a black rug, an odd number, so that both halves have some.
const BLACK_EVERY: u32 = 5;
/// Draws before a home is given up.
const ATTEMPTS: u64 = 60;
/// Share of the floor where the body fits that must hang together.
const CONNECTED_MIN: f64 = 0.95;
/// Free floor in front of the dock: half its width, and its depth.
const DOCK_ASIDE_M: f64 = 0.5;
const DOCK_FRONT_M: f64 = 1.4;

impl GeneratedHome {
    /// A home on its first day, empty.
    #[must_use]
    pub const fn number(number: u32) -> Self {
        Self {
            number,
            arrangement: 0,
            people: People::Out,
        }
    }

    /// Reads `N`, `N/ARRANGEMENT`, either with `+people` behind it.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let (text, people) = match text.strip_suffix("+people") {
            Some(before) => (before, People::In),
            None => (text, People::Out),
        };
        let (number, arrangement) = text.split_once('/').unwrap_or((text, "0"));
        let number = number.parse().ok().filter(|number| *number > 0)?;
        Some(Self {
            number,
            arrangement: arrangement.parse().ok()?,
            people,
        })
    }

    /// The text of the home's TOML: the first draw whose dock can be reached and whose floor hangs together for this robot.
    ///
    /// # Errors
    /// [`HomeError`] of the last draw, when none of them was good.
    pub fn floorplan(self, model: &RobotModel) -> Result<String, HomeError> {
        // The walls are those of the first day and do not change with the loose things.
        let first_day = Self::number(self.number);
        let (walls, text) = first_day.first_good(model, |attempt| first_day.draw(attempt, attempt))?;
        if self == first_day {
            return Ok(text);
        }
        let later = |attempt| self.draw(walls, u64::from(self.arrangement) * ATTEMPTS + attempt + walls);
        self.first_good(model, later).map(|(_, text)| text)
    }

    /// The first attempt whose home is good.
    fn first_good(
        self,
        model: &RobotModel,
        draw: impl Fn(u64) -> String,
    ) -> Result<(u64, String), HomeError> {
        let mut failed = None;
        for attempt in 0..ATTEMPTS {
            let text = draw(attempt);
            match Home::from_floorplan(&self.to_string(), &text, model) {
                Ok(home) if home.connected_share() >= CONNECTED_MIN => return Ok((attempt, text)),
                Ok(_) => {}
                Err(error) => failed = Some(error),
            }
        }
        Err(failed.unwrap_or_else(|| HomeError::Invalid {
            path: self.to_string().into(),
            place: "the generator".to_owned(),
            problem: "no draw gave a floor that hangs together".to_owned(),
        }))
    }

    /// The home itself.
    ///
    /// # Errors
    /// As [`Self::floorplan`].
    pub fn home(self, model: &RobotModel) -> Result<Home, HomeError> {
        let text = self.floorplan(model)?;
        Home::from_floorplan(&self.to_string(), &text, model)
    }

    /// The home with the walls and large furniture of one attempt and the loose things of another.
    fn draw(self, fixed: u64, loose: u64) -> String {
        let seed = u64::from(self.number);
        let mut draw = Draw::new(seed, 100 + fixed);
        let mut moved = Draw::new(seed, 10_000 + loose);
        let extent = match self.number % 7 {
            0 => HomeSize::Studio,
            1 | 4 => HomeSize::Small,
            2 | 5 | 6 => HomeSize::Medium,
            _ => HomeSize::Large,
        };
        let mut things = draw_rooms(&mut draw, extent);
        let dock_clear = place_dock(&mut draw, &mut things);
        slant(&mut draw, &mut things);
        door_leaves(&mut draw, &mut things);
        furnish(&mut draw, &mut moved, &mut things, dock_clear);
        if self.number % BLACK_EVERY == 3 {
            blacken(&mut draw, &mut things);
        }
        if self.people == People::In {
            invite(&mut moved, &mut things);
        }
        let turn = Turn {
            swap: draw.chance(0.5),
            mirror_x: draw.chance(0.5),
            mirror_y: draw.chance(0.5),
        };
        write::write(&format!("Generated {self}"), &things, turn)
    }
}

impl fmt::Display for GeneratedHome {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.number)?;
        if self.arrangement > 0 {
            write!(formatter, "/{}", self.arrangement)?;
        }
        match self.people {
            People::In => formatter.write_str("+people"),
            People::Out => Ok(()),
        }
    }
}

/// Puts the dock at a wall away from doors; gives the floor that must stay clear for it.
fn place_dock(draw: &mut Draw, things: &mut Things) -> Option<Rect> {
    let rooms: Vec<Room> = things
        .rooms
        .iter()
        .filter(|room| {
            matches!(
                room.kind,
                RoomKind::Living | RoomKind::Studio | RoomKind::Office | RoomKind::Bedroom
            )
        })
        .copied()
        .collect();
    for _ in 0..200 {
        let room = rooms.get(draw.below(rooms.len()))?;
        let side = RoomSide::ALL[draw.below(4)];
        let length = WallFrame::length_of(&room.rect, side);
        let along = draw.length(DOCK_ASIDE_M, length - DOCK_ASIDE_M);
        let frame = WallFrame::of_side(&room.rect, side).moved(along, 0.0);
        let clear = frame.rect([-DOCK_ASIDE_M, 0.0], [DOCK_ASIDE_M, DOCK_FRONT_M]);
        let at_door = things.doors.iter().any(|door| door.clear().overlaps(&clear));
        let other_room = things
            .rooms
            .iter()
            .any(|other| other.rect != room.rect && other.rect.grown(0.1).overlaps(&clear));
        if room.rect.contains(&clear) && !at_door && !other_room {
            things.dock = Some((frame.point(0.0, 0.0), frame.into));
            return Some(clear);
        }
    }
    None
}

/// Some homes have a slanted outer wall in a corner of their largest room: not all walls are at right angles.
fn slant(draw: &mut Draw, things: &mut Things) {
    if !draw.chance(0.15) {
        return;
    }
    let Some(room) = things.rooms.first().filter(|room| room.kind == RoomKind::Living) else {
        return;
    };
    let (across, deep) = (draw.length(0.8, 1.6), draw.length(0.8, 1.6));
    let [x, y] = room.rect.low;
    let corner = Rect::new([x, y], [x + across, y + deep]);
    let dock = things.dock.map(|(place, _)| Rect::new(place, place).grown(0.7));
    let in_the_way = things.doors.iter().any(|door| door.clear().overlaps(&corner));
    if in_the_way || dock.is_some_and(|dock| dock.overlaps(&corner)) {
        return;
    }
    things.pieces.push(Piece {
        name: SLANTED,
        polygon: vec![[x, y], [x + across, y], [x, y + deep]],
        legs: Vec::new(),
        leg_diameter_m: furnisher::LEG_M,
    });
}

const SLANTED: &str = "Slanted outer wall";

/// Some doors are open at a right angle to their wall.
fn door_leaves(draw: &mut Draw, things: &mut Things) {
    let south_of = |door: &things::PlacedDoor| door.ends[0][1] == door.ends[1][1];
    let doors: Vec<things::PlacedDoor> = things
        .doors
        .iter()
        .filter(|door| south_of(door))
        .copied()
        .collect();
    for door in doors {
        let [start, end] = door.ends;
        let width = end[0] - start[0];
        if !door.open || width > 0.95 || !draw.chance(0.4) {
            continue;
        }
        // Into the room, not into the corridor.
        let Some(corridor) = things.rooms.iter().find(|room| room.kind == RoomKind::Corridor) else {
            return;
        };
        let up = corridor.rect.high[1] < start[1];
        let y = if up { start[1] + 0.06 } else { start[1] - 0.06 };
        let tip = if up { y + width } else { y - width };
        things.pieces.push(Piece {
            name: "Open door",
            polygon: Rect::new([start[0] - 0.06, y], [start[0] - 0.02, tip]).corners(),
            legs: Vec::new(),
            leg_diameter_m: furnisher::LEG_M,
        });
    }
}

fn furnish(draw: &mut Draw, moved: &mut Draw, things: &mut Things, dock_clear: Option<Rect>) {
    let rooms = things.rooms.clone();
    let standing: Vec<Rect> = things.pieces.iter().map(|piece| bounds(&piece.polygon)).collect();
    for room in &rooms {
        let clear = things
            .doors
            .iter()
            .map(things::PlacedDoor::clear)
            .chain(dock_clear)
            .collect();
        let others = rooms
            .iter()
            .filter(|other| other.rect != room.rect && room.rect.contains(&other.rect))
            .map(|other| other.rect.grown(0.12));
        let solid = others
            .chain(standing.iter().copied())
            .chain(things.stairs.iter().copied());
        let solid = solid.collect();
        let mut furnisher = Furnisher {
            room: room.rect,
            draw,
            moved,
            things,
            solid,
            clear,
        };
        recipes::furnish(&mut furnisher, room.kind);
    }
}

fn bounds(corners: &[crate::point::Point]) -> Rect {
    let mut bounds = Rect::new([f64::MAX; 2], [f64::MAX; 2]);
    for (number, corner) in corners.iter().enumerate() {
        let point = Rect::new(*corner, *corner);
        bounds = if number == 0 {
            point
        } else {
            Rect::new(
                [bounds.low[0].min(corner[0]), bounds.low[1].min(corner[1])],
                [bounds.high[0].max(corner[0]), bounds.high[1].max(corner[1])],
            )
        };
    }
    bounds
}

/// One rug of the home is black.
fn blacken(draw: &mut Draw, things: &mut Things) {
    let chosen = draw.below(things.rugs.len());
    if let Some(rug) = things.rugs.get_mut(chosen) {
        rug.black = true;
    }
}

/// People who stand in rooms and doors, and who walk from room to room; a pet.
fn invite(moved: &mut Draw, things: &mut Things) {
    let mut places: Vec<crate::point::Point> = things
        .rooms
        .iter()
        .map(|room| write::middle(&room.rect))
        .collect();
    places.extend(
        things
            .doors
            .iter()
            .filter(|door| door.open)
            .map(|door| write::middle(&Rect::new(door.ends[0], door.ends[1]))),
    );
    let mut now_s = 60.0;
    for _ in 0..8 {
        let place = moved.pick(&places);
        let (stays_s, diameter_m) = if moved.chance(0.5) {
            (moved.number(30.0, 120.0), 0.34)
        } else {
            (moved.number(60.0, 300.0), 0.26)
        };
        things.visitors.push(Visitor {
            place,
            diameter_m,
            from_s: now_s,
            until_s: now_s + stays_s,
        });
        now_s += moved.number(60.0, 400.0);
    }
    let rooms = things.rooms.clone();
    for kind in ["person", "person", "pet"] {
        let goals = (0..4).map(|_| within(moved, &rooms)).collect();
        let from_s = moved.number(20.0, 300.0);
        things.walkers.push(PlacedWalker {
            kind,
            goals,
            rest_s: moved.number(3.0, 40.0),
            from_s,
            until_s: from_s + moved.number(900.0, 3_600.0),
        });
    }
}

/// Some place in some room.
fn within(moved: &mut Draw, rooms: &[Room]) -> crate::point::Point {
    let Some(room) = rooms.get(moved.below(rooms.len())) else {
        return [0.0, 0.0];
    };
    let (low, high) = (room.rect.low, room.rect.high);
    [moved.number(low[0], high[0]), moved.number(low[1], high[1])]
}
