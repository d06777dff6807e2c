//! Edits of the map that can be taken back and done again.
//!
//! An edit is known by what it changed, not by the number under which the robot keeps it: what is brought back gets a new number,
//! and another client may have been there in between. Nothing counts before the robot has confirmed it.

use rvac_api::{
    HomeView, NoGoShape, NoGoView, PlaceShape, PlaceView, Request, RequestBody, RoomChangeView, RoomNaming,
    RoomSettings, RoomSplitting,
};

use crate::dock_place::{DockPose, is_same_dock, known_dock};
use crate::words::Words;

/// Most edits that can be taken back.
const KEPT_MAX: usize = 100;
/// Numbers of requests that are edits, so that their answers are known from all others.
const FIRST_ID: u32 = 500;
const LAST_ID: u32 = 999;
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
    /// The dock stands elsewhere.
    Dock {
        /// Where it was known to stand.
        before: DockPose,
        /// Where it stands.
        after: DockPose,
    },
}

/// Why an edit cannot be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditError {
    /// What it changes is not there any more, or was changed by somebody else.
    ChangedMeanwhile,
    /// The robot has confirmed what it changes, but not told of it yet.
    NotToldYet,
}

impl EditError {
    /// What it is and what to do, for people.
    #[must_use]
    pub const fn text(self, words: &Words) -> &'static str {
        match self {
            Self::ChangedMeanwhile => words.map.changed_meanwhile,
            Self::NotToldYet => words.map.not_told_yet,
        }
    }
}

impl Edit {
    /// The edit that takes this one back.
    #[must_use]
    fn inverse(&self) -> Self {
        match self.clone() {
            Self::Forbid(shape) => Self::Allow(shape),
            Self::Allow(shape) => Self::Forbid(shape),
            Self::NameForbidden { shape, before, after } => Self::NameForbidden {
                shape,
                before: after,
                after: before,
            },
            Self::Keep(kept) => Self::Forget(kept),
            Self::Forget(kept) => Self::Keep(kept),
            Self::NamePlace { before, after } => Self::NamePlace {
                before: after,
                after: before,
            },
            Self::Name { room, before, after } => Self::Name {
                room,
                before: after,
                after: before,
            },
            Self::Settings { room, before, after } => Self::Settings {
                room,
                before: after,
                after: before,
            },
            Self::Split(line) => Self::Unsplit(line),
            Self::Unsplit(line) => Self::Split(line),
            Self::Join(rooms) => Self::Unjoin(rooms),
            Self::Unjoin(rooms) => Self::Join(rooms),
            Self::Dock { before, after } => Self::Dock {
                before: after,
                after: before,
            },
        }
    }

    /// What a person changed.
    #[must_use]
    pub const fn what(&self, words: &Words) -> &'static str {
        let told = &words.map;
        match self {
            Self::Forbid(forbidden) => match forbidden.shape {
                NoGoShape::Wall(_) => told.edit_wall,
                NoGoShape::Zone(_) => told.edit_zone,
            },
            Self::Allow(forbidden) => match forbidden.shape {
                NoGoShape::Wall(_) => told.edit_no_wall,
                NoGoShape::Zone(_) => told.edit_no_zone,
            },
            Self::NameForbidden { .. } => told.edit_no_go_name,
            Self::Keep(_) => told.edit_keep,
            Self::Forget(_) => told.edit_forget,
            Self::NamePlace { .. } => told.edit_place_name,
            Self::Name { .. } => told.edit_name,
            Self::Settings { .. } => told.edit_settings,
            Self::Split(_) => told.edit_split,
            Self::Unsplit(_) => told.edit_unsplit,
            Self::Join(_) => told.edit_join,
            Self::Unjoin(_) => told.edit_unjoin,
            Self::Dock { .. } => told.edit_dock,
        }
    }

    /// What asks the robot for it.
    fn request(&self, home: &HomeView) -> Result<RequestBody, EditError> {
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

fn is_same(one: &NoGoShape, other: &NoGoShape) -> bool {
    match (one, other) {
        (NoGoShape::Wall(one), NoGoShape::Wall(other)) => is_same_line(one, other),
        (NoGoShape::Zone(one), NoGoShape::Zone(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(a, b)| is_near(a, b))
        }
        _ => false,
    }
}

/// Which way an edit goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    Anew,
    Back,
    Again,
}

/// What was edited on this page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EditLog {
    done: Vec<Edit>,
    undone: Vec<Edit>,
    asked: Vec<(u32, Course, Edit)>,
    /// Revision of the home when the robot confirmed the last edit.
    confirmed_at: Option<u32>,
    count: u32,
}

impl EditLog {
    /// What would be taken back.
    #[must_use]
    pub fn last(&self) -> Option<&Edit> {
        self.done.last()
    }

    /// What would be done again.
    #[must_use]
    pub fn next(&self) -> Option<&Edit> {
        self.undone.last()
    }

    /// Forgets everything: another floor has another map.
    pub fn clear(&mut self) {
        *self = Self {
            count: self.count,
            ..Self::default()
        };
    }

    /// Asks for a new edit.
    ///
    /// # Errors
    /// When there is nothing that it could change.
    pub fn begin(&mut self, edit: Edit, home: &HomeView) -> Result<Request, EditError> {
        let body = edit.request(home)?;
        Ok(self.ask((Course::Anew, edit), body))
    }

    /// Asks to take the last edit back; none when there is none.
    pub fn undo(&mut self, home: &HomeView) -> Option<Result<Request, EditError>> {
        let edit = self.done.pop()?;
        let request = edit.inverse().request(home);
        Some(self.go(Course::Back, edit, (request, home.revision)))
    }

    /// Asks to do again what was taken back last; none when nothing was.
    pub fn redo(&mut self, home: &HomeView) -> Option<Result<Request, EditError>> {
        let edit = self.undone.pop()?;
        let request = edit.request(home);
        Some(self.go(Course::Again, edit, (request, home.revision)))
    }

    fn go(
        &mut self,
        course: Course,
        edit: Edit,
        (body, revision): (Result<RequestBody, EditError>, u32),
    ) -> Result<Request, EditError> {
        match body {
            Ok(body) => Ok(self.ask((course, edit), body)),
            Err(EditError::ChangedMeanwhile) if self.confirmed_at == Some(revision) => {
                self.put_back(course, edit);
                Err(EditError::NotToldYet)
            }
            Err(error) => Err(error),
        }
    }

    fn ask(&mut self, (course, edit): (Course, Edit), body: RequestBody) -> Request {
        let id = FIRST_ID + self.count % (LAST_ID - FIRST_ID + 1);
        self.count = self.count.wrapping_add(1);
        self.asked.push((id, course, edit));
        Request { id: Some(id), body }
    }

    fn take_asked(&mut self, id: u32) -> Option<(Course, Edit)> {
        let place = self.asked.iter().position(|(asked, ..)| *asked == id)?;
        let (_, course, edit) = self.asked.remove(place);
        Some((course, edit))
    }

    fn put_back(&mut self, course: Course, edit: Edit) {
        match course {
            Course::Anew => {}
            Course::Back => self.done.push(edit),
            Course::Again => self.undone.push(edit),
        }
    }

    /// The robot has done what was asked under this number; `revision` is that of the home as it was told last.
    pub fn on_done(&mut self, id: u32, revision: u32) {
        let Some((course, edit)) = self.take_asked(id) else {
            return;
        };
        self.confirmed_at = Some(revision);
        match course {
            Course::Anew => {
                self.undone.clear();
                self.done.push(edit);
            }
            Course::Back => self.undone.push(edit),
            Course::Again => self.done.push(edit),
        }
        if self.done.len() > KEPT_MAX {
            self.done.remove(0);
        }
    }

    /// The robot has refused it: nothing has changed.
    pub fn on_failed(&mut self, id: u32) {
        if let Some((course, edit)) = self.take_asked(id) {
            self.put_back(course, edit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Edit, EditError, EditLog, Forbidden, Kept};
    use rvac_api::{
        HomeView, NoGoShape, NoGoView, PlaceShape, PlaceView, RequestBody, RoomChangeView, RoomView,
    };

    fn wall(x: f64) -> NoGoShape {
        NoGoShape::Wall([[x, 0.0], [x, 1.0]])
    }

    fn forbid(x: f64) -> Edit {
        Edit::Forbid(Forbidden {
            shape: wall(x),
            name: None,
        })
    }

    fn home(revision: u32, walls: &[(u16, f64)], name: Option<&str>) -> HomeView {
        HomeView {
            revision,
            no_go: walls
                .iter()
                .map(|(number, x)| NoGoView {
                    number: *number,
                    shape: wall(*x),
                    name: None,
                })
                .collect(),
            rooms: vec![RoomView {
                id: 3,
                area_m2: 9.0,
                x: 0.0,
                y: 0.0,
                name: name.map(str::to_owned),
                settings: None,
            }],
            ..HomeView::default()
        }
    }

    fn number(request: &rvac_api::Request) -> u32 {
        request.id.expect("edits are numbered")
    }

    #[test]
    fn a_wall_goes_and_comes_back_under_whatever_number_it_has() {
        let mut log = EditLog::default();
        let asked = log.begin(forbid(1.0), &home(1, &[], None)).unwrap();
        assert_eq!(log.last(), None, "nothing counts before it is confirmed");
        log.on_done(number(&asked), 1);
        let kept = home(2, &[(6, 4.0), (7, 1.001)], None);
        let asked = log.undo(&kept).unwrap().unwrap();
        assert_eq!(asked.body, RequestBody::RemoveNoGo { number: 7 });
        log.on_done(number(&asked), 2);
        let asked = log.redo(&home(3, &[(6, 4.0)], None)).unwrap().unwrap();
        let again = RequestBody::AddNoGo {
            shape: wall(1.0),
            name: None,
        };
        assert_eq!(asked.body, again);
        log.on_done(number(&asked), 3);
        let asked = log.undo(&home(4, &[(6, 4.0), (8, 1.0)], None)).unwrap().unwrap();
        assert_eq!(asked.body, RequestBody::RemoveNoGo { number: 8 });
    }

    #[test]
    fn a_name_of_forbidden_floor_goes_back_and_comes_with_what_is_brought_back() {
        let mut log = EditLog::default();
        let named = |revision, name: Option<&str>| {
            let mut home = home(revision, &[(7, 1.0)], None);
            home.no_go[0].name = name.map(str::to_owned);
            home
        };
        let edit = Edit::NameForbidden {
            shape: wall(1.0),
            before: None,
            after: Some("Cats".to_owned()),
        };
        let asked = log.begin(edit, &named(1, None)).unwrap();
        let naming = |number, name: Option<&str>| RequestBody::NameNoGo {
            number,
            name: name.map(str::to_owned),
        };
        assert_eq!(asked.body, naming(7, Some("Cats")));
        log.on_done(number(&asked), 1);
        let allow = Edit::Allow(Forbidden {
            shape: wall(1.0),
            name: Some("Cats".to_owned()),
        });
        let asked = log.begin(allow, &named(2, Some("Cats"))).unwrap();
        log.on_done(number(&asked), 2);
        let asked = log.undo(&home(3, &[], None)).unwrap().unwrap();
        let back = RequestBody::AddNoGo {
            shape: wall(1.0),
            name: Some("Cats".to_owned()),
        };
        assert_eq!(asked.body, back);
        log.on_done(number(&asked), 3);
        let asked = log.undo(&named(4, Some("Cats"))).unwrap().unwrap();
        assert_eq!(asked.body, naming(7, None));
    }

    #[test]
    fn a_place_that_was_forgotten_comes_back_under_its_number() {
        let mut log = EditLog::default();
        let bowl = |number| Kept {
            number,
            name: "Bowl".to_owned(),
            shape: PlaceShape::Spot([1.0, 2.0]),
        };
        let with = |revision, name: &str| HomeView {
            places: vec![PlaceView {
                number: 4,
                name: name.to_owned(),
                shape: PlaceShape::Spot([1.0, 2.0]),
            }],
            ..home(revision, &[], None)
        };
        let naming = Edit::NamePlace {
            before: "Bowl".to_owned(),
            after: "Dish".to_owned(),
        };
        let asked = log.begin(naming, &with(1, "Bowl")).unwrap();
        log.on_done(number(&asked), 1);
        let asked = log.undo(&with(2, "Dish")).unwrap().unwrap();
        let back = RequestBody::NamePlace {
            number: 4,
            name: "Bowl".to_owned(),
        };
        assert_eq!(asked.body, back);
        log.on_done(number(&asked), 2);
        let asked = log.begin(Edit::Forget(bowl(Some(4))), &with(3, "Bowl")).unwrap();
        assert_eq!(asked.body, RequestBody::ForgetPlace { number: 4 });
        log.on_done(number(&asked), 3);
        let asked = log.undo(&home(4, &[], None)).unwrap().unwrap();
        let back = RequestBody::KeepPlace {
            name: "Bowl".to_owned(),
            shape: PlaceShape::Spot([1.0, 2.0]),
            number: Some(4),
        };
        assert_eq!(asked.body, back);
        log.on_done(number(&asked), 4);
        let new = log.begin(Edit::Keep(bowl(None)), &home(5, &[], None)).unwrap();
        log.on_done(number(&new), 5);
        assert_eq!(
            log.undo(&with(6, "Dish")),
            Some(Err(EditError::ChangedMeanwhile)),
            "somebody else has named it"
        );
    }

    #[test]
    fn what_is_refused_has_not_happened() {
        let mut log = EditLog::default();
        let empty = home(1, &[], None);
        let asked = log.begin(forbid(1.0), &empty).unwrap();
        log.on_failed(number(&asked));
        assert!(log.undo(&empty).is_none());
        let asked = log.begin(forbid(2.0), &empty).unwrap();
        log.on_done(number(&asked), 1);
        let asked = log.undo(&home(2, &[(1, 2.0)], None)).unwrap().unwrap();
        log.on_failed(number(&asked));
        assert_eq!(log.last(), Some(&forbid(2.0)));
        assert_eq!(log.next(), None);
    }

    #[test]
    fn a_name_goes_back_unless_somebody_else_has_changed_it() {
        let mut log = EditLog::default();
        let edit = Edit::Name {
            room: 3,
            before: None,
            after: Some("Hall".to_owned()),
        };
        let asked = log.begin(edit, &home(1, &[], None)).unwrap();
        log.on_done(number(&asked), 1);
        assert_eq!(
            log.undo(&home(1, &[], None)),
            Some(Err(EditError::NotToldYet)),
            "the robot has not told of the name"
        );
        let asked = log.undo(&home(2, &[], Some("Hall"))).unwrap().unwrap();
        log.on_done(number(&asked), 2);
        let changed = home(3, &[], Some("Den"));
        assert_eq!(log.redo(&changed), Some(Err(EditError::ChangedMeanwhile)));
        assert_eq!(log.redo(&changed), None, "it is dropped");
    }

    fn home_with(revision: u32, changes: &[(u16, [u16; 2], Option<f64>)]) -> HomeView {
        let view = |(number, rooms, x): &(u16, [u16; 2], Option<f64>)| RoomChangeView {
            number: *number,
            rooms: *rooms,
            line: x.map(|x| [[x, 0.0], [x, 3.0]]),
        };
        HomeView {
            room_changes: changes.iter().map(view).collect(),
            ..home(revision, &[], None)
        }
    }

    #[test]
    fn a_split_and_a_join_go_and_come_back_under_whatever_number_they_have() {
        let mut log = EditLog::default();
        let line = [[1.0, 0.0], [1.0, 3.0]];
        let asked = log.begin(Edit::Split(line), &home_with(1, &[])).unwrap();
        log.on_done(number(&asked), 1);
        let cut = (4, [3, 5], Some(1.001));
        let asked = log.begin(Edit::Join([5, 2]), &home_with(2, &[cut])).unwrap();
        assert_eq!(asked.body, RequestBody::JoinRooms { rooms: [5, 2] });
        log.on_done(number(&asked), 2);
        let both = home_with(3, &[(2, [2, 5], Some(7.0)), cut, (6, [2, 5], None)]);
        let asked = log.undo(&both).unwrap().unwrap();
        assert_eq!(asked.body, RequestBody::UndoRoomChange { number: 6 });
        log.on_done(number(&asked), 3);
        assert_eq!(
            log.undo(&home_with(4, &[(2, [2, 5], Some(7.0))])),
            Some(Err(EditError::ChangedMeanwhile)),
            "somebody else has taken the split back"
        );
        let asked = log.redo(&home_with(4, &[cut])).unwrap().unwrap();
        assert_eq!(asked.body, RequestBody::JoinRooms { rooms: [5, 2] });
    }

    fn home_with_dock(revision: u32, x: f64) -> HomeView {
        HomeView {
            dock: Some(rvac_api::Pose {
                x,
                ..rvac_api::Pose::default()
            }),
            ..home(revision, &[], None)
        }
    }

    #[test]
    fn a_dock_goes_back_to_where_it_stood_unless_the_robot_has_found_it_elsewhere() {
        let mut log = EditLog::default();
        let (before, after) = ([1.0, 0.0, 0.0], [3.0, 0.5, 1.5]);
        let edit = Edit::Dock { before, after };
        let asked = log.begin(edit, &home_with_dock(1, 1.0)).unwrap();
        let moved_to = |[x, y, heading]: [f64; 3]| RequestBody::MoveDock { x, y, heading };
        assert_eq!(asked.body, moved_to(after));
        log.on_done(number(&asked), 1);
        let mut told = home_with_dock(2, 3.0);
        told.dock = told.dock.map(|dock| rvac_api::Pose {
            y: 0.501,
            heading: 1.5,
            ..dock
        });
        let asked = log.undo(&told).unwrap().unwrap();
        assert_eq!(asked.body, moved_to(before));
        log.on_done(number(&asked), 2);
        assert_eq!(
            log.redo(&home_with_dock(3, 1.2)),
            Some(Err(EditError::ChangedMeanwhile)),
            "it has docked and found the dock elsewhere"
        );
    }

    #[test]
    fn a_new_edit_ends_what_could_be_done_again() {
        let mut log = EditLog::default();
        let none = home(1, &[], None);
        let asked = log.begin(forbid(1.0), &none).unwrap();
        log.on_done(number(&asked), 1);
        let asked = log.undo(&home(2, &[(1, 1.0)], None)).unwrap().unwrap();
        log.on_done(number(&asked), 2);
        let asked = log.begin(forbid(5.0), &none).unwrap();
        log.on_done(number(&asked), 3);
        assert_eq!(log.next(), None);
        log.clear();
        assert_eq!(log.last(), None);
    }
}
