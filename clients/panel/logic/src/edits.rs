//! Edits of the map, each with the one that takes it back and with what asks the robot for it.
//!
//! An edit is known by what it changed, not by the number under which the robot keeps it: what is brought back gets a new number,
//! and another client may have been there in between.

use std::mem::swap;

use rvac_api::{
    HomeView, NoGoShape, NoGoView, PlaceShape, PlaceView, RequestBody, RoomBefore, RoomChangeView,
    RoomNaming, RoomSettings, RoomSplitting,
};

use crate::dock_place::{DockPose, is_same_dock, known_dock};
use crate::words::Words;

/// Places that differ by less are the same: the robot may round them, metres.
const SAME_M: f64 = 0.005;

/// What a person forbids, and its name, which comes back with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Forbidden {
    /// What it forbids.
    pub shape: NoGoShape,
    /// What it is called, if it has a name.
    pub name: Option<String>,
}

/// A zone or spot that is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// The number under which it comes back, for schedules know it by that; none for what was not kept before.
    pub number: Option<u16>,
    /// What it is called.
    pub name: String,
    /// Where it is.
    pub shape: PlaceShape,
}

/// A change of the map.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Floor was forbidden.
    Forbid(Forbidden),
    /// It was allowed again.
    Allow(Forbidden),
    /// What is forbidden got another name, or none.
    NameForbidden {
        /// What it forbids.
        shape: NoGoShape,
        /// What it was called.
        before: Option<String>,
        /// What it shall be called.
        after: Option<String>,
    },
    /// What is forbidden lies elsewhere.
    ReshapeForbidden {
        /// What it forbade.
        before: NoGoShape,
        /// What it shall forbid.
        after: NoGoShape,
    },
    /// A zone or spot was kept under a name.
    Keep(Kept),
    /// It is kept no longer.
    Forget(Kept),
    /// A kept place got another name.
    NamePlace {
        /// What it was called.
        before: String,
        /// What it shall be called.
        after: String,
    },
    /// A kept place lies elsewhere.
    ReshapePlace {
        /// What it is called.
        name: String,
        /// Where it was.
        before: PlaceShape,
        /// Where it shall be.
        after: PlaceShape,
    },
    /// A room got another name, or none.
    Name {
        /// Its identity.
        room: u16,
        /// What it was called.
        before: Option<String>,
        /// What it shall be called.
        after: Option<String>,
    },
    /// A room is cleaned otherwise.
    Settings {
        /// Its identity.
        room: u16,
        /// How it was cleaned.
        before: Option<RoomSettings>,
        /// How it shall be cleaned.
        after: Option<RoomSettings>,
    },
    /// A room was cut in two along a line.
    Split([[f64; 2]; 2]),
    /// That was taken back.
    Unsplit([[f64; 2]; 2]),
    /// Two rooms were made one.
    Join([u16; 2]),
    /// That was taken back.
    Unjoin([u16; 2]),
    /// The dock was moved.
    Dock {
        /// Its previous pose.
        before: DockPose,
        /// Its new pose.
        after: DockPose,
    },
    /// A version of the map was taken up again.
    TakeUp {
        /// The floor of which it is a map.
        floor: Option<u16>,
        /// The version that was the newest.
        before: u64,
        /// The version that was taken up.
        after: u64,
    },
}

/// Why an edit cannot be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditError {
    /// What it changes is not there any more, or another client changed it.
    ChangedMeanwhile,
    /// The robot has confirmed what it changes, but not sent it yet.
    NotReportedYet,
}

impl EditError {
    /// What it is and what to do, for people.
    #[must_use]
    pub const fn text(self, words: &Words) -> &'static str {
        match self {
            Self::ChangedMeanwhile => words.map.changed_meanwhile,
            Self::NotReportedYet => words.map.not_reported_yet,
        }
    }
}

impl Edit {
    /// The edit that takes this one back.
    #[must_use]
    pub(crate) fn inverse(&self) -> Self {
        match self.clone() {
            Self::Forbid(shape) => Self::Allow(shape),
            Self::Allow(shape) => Self::Forbid(shape),
            Self::Keep(kept) => Self::Forget(kept),
            Self::Forget(kept) => Self::Keep(kept),
            Self::Split(line) => Self::Unsplit(line),
            Self::Unsplit(line) => Self::Split(line),
            Self::Join(rooms) => Self::Unjoin(rooms),
            Self::Unjoin(rooms) => Self::Join(rooms),
            mut edit => {
                edit.swap_sides();
                edit
            }
        }
    }

    /// Swaps before and after; an edit without sides stays as it is.
    fn swap_sides(&mut self) {
        match self {
            Self::NameForbidden { before, after, .. } | Self::Name { before, after, .. } => {
                swap(before, after)
            }
            Self::ReshapeForbidden { before, after } => swap(before, after),
            Self::ReshapePlace { before, after, .. } => swap(before, after),
            Self::TakeUp { before, after, .. } => swap(before, after),
            Self::NamePlace { before, after } => swap(before, after),
            Self::Settings { before, after, .. } => swap(before, after),
            Self::Dock { before, after } => swap(before, after),
            Self::Forbid(_) | Self::Allow(_) | Self::Keep(_) | Self::Forget(_) => {}
            Self::Split(_) | Self::Unsplit(_) | Self::Join(_) | Self::Unjoin(_) => {}
        }
    }

    /// What a person changed.
    #[must_use]
    pub const fn what(&self, words: &Words) -> &'static str {
        let texts = &words.map;
        match self {
            Self::Forbid(forbidden) => match forbidden.shape {
                NoGoShape::Wall(_) => texts.edit_wall,
                NoGoShape::Zone(_) => texts.edit_zone,
            },
            Self::Allow(forbidden) => match forbidden.shape {
                NoGoShape::Wall(_) => texts.edit_no_wall,
                NoGoShape::Zone(_) => texts.edit_no_zone,
            },
            Self::NameForbidden { .. } => texts.edit_no_go_name,
            Self::ReshapeForbidden { .. } => texts.edit_no_go_shape,
            Self::ReshapePlace { .. } => texts.edit_place_shape,
            Self::TakeUp { .. } => texts.edit_take_up,
            Self::Keep(_) => texts.edit_keep,
            Self::Forget(_) => texts.edit_forget,
            Self::NamePlace { .. } => texts.edit_place_name,
            Self::Name { .. } => texts.edit_name,
            Self::Settings { .. } => texts.edit_settings,
            Self::Split(_) => texts.edit_split,
            Self::Unsplit(_) => texts.edit_unsplit,
            Self::Join(_) => texts.edit_join,
            Self::Unjoin(_) => texts.edit_unjoin,
            Self::Dock { .. } => texts.edit_dock,
        }
    }

    /// What asks the robot for it.
    pub(crate) fn request(&self, home: &HomeView) -> Result<RequestBody, EditError> {
        match self {
            Self::Forbid(Forbidden { shape, name }) => Ok(RequestBody::AddNoGo {
                shape: shape.clone(),
                name: name.clone(),
            }),
            Self::Allow(Forbidden { shape, .. }) => {
                let number = kept(home, shape)?.number;
                Ok(RequestBody::RemoveNoGo { number })
            }
            Self::NameForbidden { shape, before, after } => {
                let found = kept(home, shape).ok().filter(|kept| kept.name == *before);
                let number = found.ok_or(EditError::ChangedMeanwhile)?.number;
                let name = after.clone();
                Ok(RequestBody::NameNoGo { number, name })
            }
            Self::ReshapeForbidden { before, after } => {
                let found = kept(home, before)?;
                Ok(RequestBody::ReshapeNoGo {
                    number: found.number,
                    shape: after.clone(),
                    was: Some(found.shape.clone()),
                })
            }
            Self::ReshapePlace { name, before, after } => {
                let found = place_called(home, name)?;
                if !is_same_place(&found.shape, before) {
                    return Err(EditError::ChangedMeanwhile);
                }
                Ok(RequestBody::ReshapePlace {
                    number: found.number,
                    shape: after.clone(),
                    was: Some(found.shape.clone()),
                })
            }
            Self::Keep(Kept { number, name, shape }) => Ok(RequestBody::KeepPlace {
                name: name.clone(),
                shape: shape.clone(),
                number: *number,
            }),
            Self::Forget(Kept { name, .. }) => {
                let number = place_called(home, name)?.number;
                Ok(RequestBody::ForgetPlace { number })
            }
            Self::NamePlace { before, after } => Ok(RequestBody::NamePlace {
                number: place_called(home, before)?.number,
                name: after.clone(),
            }),
            // The robot knows which versions it keeps.
            Self::TakeUp { floor, after, .. } => Ok(RequestBody::RestoreMap {
                number: *after,
                floor: *floor,
            }),
            Self::Name { .. }
            | Self::Settings { .. }
            | Self::Split(_)
            | Self::Unsplit(_)
            | Self::Join(_)
            | Self::Unjoin(_)
            | Self::Dock { .. } => self.request_of_rooms(home),
        }
    }

    /// The same of an edit of rooms or of the dock.
    fn request_of_rooms(&self, home: &HomeView) -> Result<RequestBody, EditError> {
        match self {
            Self::Name { room, before, after } => {
                let named = home.rooms.iter().find(|known| known.id == *room);
                if named.is_none_or(|known| known.name != *before) {
                    return Err(EditError::ChangedMeanwhile);
                }
                Ok(RequestBody::NameRoom(RoomNaming {
                    room: *room,
                    name: after.clone(),
                }))
            }
            Self::Settings { room, before, after } => {
                let known = home.rooms.iter().find(|known| known.id == *room);
                if known.is_none_or(|known| known.settings != *before) {
                    return Err(EditError::ChangedMeanwhile);
                }
                Ok(RequestBody::SetRoom {
                    room: *room,
                    settings: *after,
                    was: Some(RoomBefore { settings: *before }),
                })
            }
            Self::Split(line) => Ok(RequestBody::SplitRoom(RoomSplitting {
                room: None,
                line: *line,
            })),
            Self::Unsplit(line) => take_back(home, |change| {
                change.line.is_some_and(|cut| is_same_line(&cut, line))
            }),
            Self::Join(rooms) => Ok(RequestBody::JoinRooms { rooms: *rooms }),
            Self::Dock { before, after } => {
                let known = known_dock(home);
                if known.is_none_or(|known| !is_same_dock(known, *before)) {
                    return Err(EditError::ChangedMeanwhile);
                }
                let [x, y, heading] = *after;
                Ok(RequestBody::MoveDock { x, y, heading })
            }
            // Which of them goes on is the robot's choice.
            Self::Unjoin([one, other]) => take_back(home, |change| {
                change.line.is_none() && [[*one, *other], [*other, *one]].contains(&change.rooms)
            }),
            _ => Err(EditError::ChangedMeanwhile),
        }
    }
}

/// What forbids this floor; the newest if there are several.
fn kept<'home>(home: &'home HomeView, shape: &NoGoShape) -> Result<&'home NoGoView, EditError> {
    let found = home.no_go.iter().rev().find(|kept| is_same(&kept.shape, shape));
    found.ok_or(EditError::ChangedMeanwhile)
}

/// Names of places are used once.
fn place_called<'home>(home: &'home HomeView, name: &str) -> Result<&'home PlaceView, EditError> {
    let found = home.places.iter().find(|place| place.name == name.trim());
    found.ok_or(EditError::ChangedMeanwhile)
}

/// Takes back the newest such change of the rooms.
fn take_back(home: &HomeView, is_it: impl Fn(&RoomChangeView) -> bool) -> Result<RequestBody, EditError> {
    let found = home.room_changes.iter().rev().find(|change| is_it(change));
    let number = found.ok_or(EditError::ChangedMeanwhile)?.number;
    Ok(RequestBody::UndoRoomChange { number })
}

fn is_near(one: &[f64; 2], other: &[f64; 2]) -> bool {
    (one[0] - other[0]).hypot(one[1] - other[1]) < SAME_M
}

fn is_same_line(one: &[[f64; 2]; 2], other: &[[f64; 2]; 2]) -> bool {
    one.iter().zip(other).all(|(a, b)| is_near(a, b))
}

fn is_same_border(one: &[[f64; 2]], other: &[[f64; 2]]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(a, b)| is_near(a, b))
}

fn is_same_place(one: &PlaceShape, other: &PlaceShape) -> bool {
    match (one, other) {
        (PlaceShape::Zone(one), PlaceShape::Zone(other)) => is_same_border(one, other),
        (PlaceShape::Spot(one), PlaceShape::Spot(other)) => is_near(one, other),
        _ => false,
    }
}

fn is_same(one: &NoGoShape, other: &NoGoShape) -> bool {
    match (one, other) {
        (NoGoShape::Wall(one), NoGoShape::Wall(other)) => is_same_line(one, other),
        (NoGoShape::Zone(one), NoGoShape::Zone(other)) => is_same_border(one, other),
        _ => false,
    }
}
