//! What was changed on this page, taken back and done again.
//!
//! Edits of the map count when the robot has confirmed them; what is chosen for a job is known to this page alone, and is among
//! them in the order in which it was chosen.

use std::collections::VecDeque;

use rvac_api::{HomeView, Request, RequestBody};

use crate::edits::{Edit, EditError};
use crate::room_choice::RoomChoice;
use crate::words::Words;

/// Most edits that can be taken back.
const KEPT_MAX: usize = 100;
/// Numbers of requests that are edits, so that their answers are known from all others.
const FIRST_ID: u32 = 500;
const LAST_ID: u32 = 999;

/// Anything that can be taken back on this page.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// An edit of the map, which the robot has confirmed.
    Home(Edit),
    /// Something else was chosen for a job that is not sent yet: the choice before and after.
    Choice(Box<[RoomChoice; 2]>),
}

impl Change {
    /// What a person changed.
    #[must_use]
    pub const fn what(&self, words: &Words) -> &'static str {
        match self {
            Self::Home(edit) => edit.what(words),
            Self::Choice(_) => words.map.edit_choice,
        }
    }
}

/// What a person asks of the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Take the last change back.
    Undo,
    /// Do again what was taken back last.
    Redo,
}

/// An edit that the robot has not answered yet.
#[derive(Clone, Debug, PartialEq)]
struct Asked {
    course: Course,
    edit: Edit,
}

/// The direction of an edit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    Anew,
    Back,
    Again,
}

/// What was edited on this page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EditLog {
    done: Vec<Change>,
    undone: Vec<Change>,
    asked: Vec<(u32, Asked)>,
    /// What a person asked for meanwhile.
    put_off: VecDeque<Step>,
    /// Revision of the home when the robot confirmed the last edit.
    confirmed_at: Option<u32>,
    count: u32,
}

impl EditLog {
    /// What would be taken back.
    #[must_use]
    pub fn last(&self) -> Option<&Change> {
        self.done.last()
    }

    /// What would be done again.
    #[must_use]
    pub fn next(&self) -> Option<&Change> {
        self.undone.last()
    }

    /// Forgets everything: another floor has another map.
    pub fn clear(&mut self) {
        *self = Self {
            count: self.count,
            ..Self::default()
        };
    }

    /// Whether the robot has still to answer, so that the last change is not known yet: then the step is put off.
    pub fn puts_off(&mut self, step: Step) -> bool {
        let waits = !self.asked.is_empty();
        if waits && self.put_off.len() < KEPT_MAX {
            self.put_off.push_back(step);
        }
        waits
    }

    /// The step that was put off first, if it can be taken now.
    pub fn take_put_off(&mut self) -> Option<Step> {
        self.asked.is_empty().then(|| self.put_off.pop_front()).flatten()
    }

    /// It could not be taken yet: the robot has not sent the present home yet.
    pub fn put_off_again(&mut self, step: Step) {
        self.put_off.push_front(step);
    }

    /// The robot will not answer any more: whether it has done what was asked is unknown.
    pub fn on_lost(&mut self) {
        self.asked.clear();
        self.put_off.clear();
    }

    /// Asks for a new edit.
    ///
    /// # Errors
    /// When there is nothing that it could change.
    pub fn begin(&mut self, edit: Edit, home: &HomeView) -> Result<Request, EditError> {
        let body = edit.request(home)?;
        Ok(self.ask(
            Asked {
                course: Course::Anew,
                edit,
            },
            body,
        ))
    }

    /// Something else was chosen: `before` in place of what is chosen now.
    pub fn on_chosen(&mut self, before: RoomChoice, now: RoomChoice) {
        self.remember(Change::Choice(Box::new([before, now])));
    }

    /// What was chosen has become a job: those changes are of no use any more.
    pub fn forget_choices(&mut self) {
        let is_of_home = |change: &Change| matches!(change, Change::Home(_));
        self.done.retain(is_of_home);
        self.undone.retain(is_of_home);
    }

    /// Takes the last change back if it was one of the choice: gives what was chosen before.
    pub fn undo_choice(&mut self) -> Option<RoomChoice> {
        let Some(Change::Choice(choices)) = self.done.pop_if(is_choice) else {
            return None;
        };
        let [before, _] = &*choices;
        let before = before.clone();
        self.undone.push(Change::Choice(choices));
        Some(before)
    }

    /// Does again what was taken back last if it was a change of the choice: gives what was chosen then.
    pub fn redo_choice(&mut self) -> Option<RoomChoice> {
        let Some(Change::Choice(choices)) = self.undone.pop_if(is_choice) else {
            return None;
        };
        let [_, after] = &*choices;
        let after = after.clone();
        self.done.push(Change::Choice(choices));
        Some(after)
    }

    /// A new change, after which nothing can be done again.
    fn remember(&mut self, change: Change) {
        self.undone.clear();
        self.done.push(change);
        self.forget_oldest();
    }

    fn forget_oldest(&mut self) {
        if self.done.len() > KEPT_MAX {
            self.done.remove(0);
        }
    }

    /// Asks to take the last edit of the map back; none when there is none, or when the last change was one of the choice.
    pub fn undo(&mut self, home: &HomeView) -> Option<Result<Request, EditError>> {
        let edit = pop_edit(&mut self.done)?;
        let request = edit.inverse().request(home);
        let asked = Asked {
            course: Course::Back,
            edit,
        };
        Some(self.go(asked, request, home.revision))
    }

    /// Asks to do again what was taken back last; none when that was no edit of the map.
    pub fn redo(&mut self, home: &HomeView) -> Option<Result<Request, EditError>> {
        let edit = pop_edit(&mut self.undone)?;
        let request = edit.request(home);
        let asked = Asked {
            course: Course::Again,
            edit,
        };
        Some(self.go(asked, request, home.revision))
    }

    fn go(
        &mut self,
        asked: Asked,
        body: Result<RequestBody, EditError>,
        revision: u32,
    ) -> Result<Request, EditError> {
        match body {
            Ok(body) => Ok(self.ask(asked, body)),
            Err(EditError::ChangedMeanwhile) if self.confirmed_at == Some(revision) => {
                self.put_back(asked);
                Err(EditError::NotReportedYet)
            }
            Err(error) => Err(error),
        }
    }

    fn ask(&mut self, asked: Asked, body: RequestBody) -> Request {
        let id = FIRST_ID + self.count % (LAST_ID - FIRST_ID + 1);
        self.count = self.count.wrapping_add(1);
        self.asked.push((id, asked));
        Request { id: Some(id), body }
    }

    fn take_asked(&mut self, id: u32) -> Option<Asked> {
        let place = self.asked.iter().position(|(number, _)| *number == id)?;
        let (_, asked) = self.asked.remove(place);
        Some(asked)
    }

    fn put_back(&mut self, Asked { course, edit }: Asked) {
        match course {
            Course::Anew => {}
            Course::Back => self.done.push(Change::Home(edit)),
            Course::Again => self.undone.push(Change::Home(edit)),
        }
    }

    /// The robot has done what was asked under this number; `revision` is that of the last received home.
    pub fn on_done(&mut self, id: u32, revision: u32) {
        let Some(Asked { course, edit }) = self.take_asked(id) else {
            return;
        };
        self.confirmed_at = Some(revision);
        match course {
            Course::Anew => self.remember(Change::Home(edit)),
            Course::Back => self.undone.push(Change::Home(edit)),
            Course::Again => self.done.push(Change::Home(edit)),
        }
        self.forget_oldest();
    }

    /// The robot has refused it, for this reason: nothing has changed. What does not exist any more never will again, and must not
    /// come before what can still be taken back.
    pub fn on_failed(&mut self, id: u32, reason: &str) {
        let Some(Asked { course, edit }) = self.take_asked(id) else {
            return;
        };
        // What was pressed meanwhile was meant for that edit.
        self.put_off.clear();
        if !reason.starts_with("no-such-") {
            self.put_back(Asked { course, edit });
        }
    }
}

fn is_choice(change: &mut Change) -> bool {
    matches!(change, Change::Choice(_))
}

fn pop_edit(changes: &mut Vec<Change>) -> Option<Edit> {
    match changes.pop()? {
        Change::Home(edit) => Some(edit),
        choice @ Change::Choice(_) => {
            changes.push(choice);
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Change, EditLog, Step};
    use crate::edits::{Edit, EditError, Forbidden, Kept};
    use crate::room_choice::RoomChoice;
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

    fn at(number: u16, x: f64) -> NoGoView {
        NoGoView {
            number,
            shape: wall(x),
            name: None,
        }
    }

    fn home(revision: u32, walls: &[NoGoView], name: Option<&str>) -> HomeView {
        HomeView {
            revision,
            no_go: walls.to_vec(),
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
    fn what_is_pressed_before_the_answer_is_taken_after_it() {
        let mut log = EditLog::default();
        assert!(!log.puts_off(Step::Undo), "nothing is on its way");
        let first = log.begin(forbid(1.0), &home(1, &[], None)).unwrap();
        log.on_done(number(&first), 1);
        let second = log.begin(forbid(2.0), &home(2, &[at(6, 1.0)], None)).unwrap();
        assert!(log.puts_off(Step::Undo), "the first wall is not meant");
        assert_eq!(log.take_put_off(), None);
        log.on_done(number(&second), 2);
        assert_eq!(log.take_put_off(), Some(Step::Undo));
        // The answer came before the news: that wall is not in the home yet.
        let asked = log.undo(&home(2, &[at(6, 1.0)], None)).unwrap();
        assert_eq!(asked, Err(EditError::NotReportedYet));
        log.put_off_again(Step::Undo);
        assert_eq!(log.take_put_off(), Some(Step::Undo));
        let asked = log
            .undo(&home(3, &[at(6, 1.0), at(7, 2.0)], None))
            .unwrap()
            .unwrap();
        assert_eq!(asked.body, RequestBody::RemoveNoGo { number: 7 });
        assert!(log.puts_off(Step::Undo));
        log.on_failed(503, "disk-busy");
        assert_eq!(log.take_put_off(), None, "it was meant for what was refused");
        log.begin(forbid(3.0), &home(3, &[at(6, 1.0), at(7, 2.0)], None))
            .unwrap();
        assert!(log.puts_off(Step::Redo));
        log.on_lost();
        assert_eq!(log.take_put_off(), None);
        assert!(!log.puts_off(Step::Redo), "nobody will answer any more");
    }

    #[test]
    fn a_wall_goes_and_comes_back_under_whatever_number_it_has() {
        let mut log = EditLog::default();
        let asked = log.begin(forbid(1.0), &home(1, &[], None)).unwrap();
        assert_eq!(log.last(), None, "nothing counts before it is confirmed");
        log.on_done(number(&asked), 1);
        let kept = home(2, &[at(6, 4.0), at(7, 1.001)], None);
        let asked = log.undo(&kept).unwrap().unwrap();
        assert_eq!(asked.body, RequestBody::RemoveNoGo { number: 7 });
        log.on_done(number(&asked), 2);
        let asked = log.redo(&home(3, &[at(6, 4.0)], None)).unwrap().unwrap();
        let again = RequestBody::AddNoGo {
            shape: wall(1.0),
            name: None,
        };
        assert_eq!(asked.body, again);
        log.on_done(number(&asked), 3);
        let asked = log
            .undo(&home(4, &[at(6, 4.0), at(8, 1.0)], None))
            .unwrap()
            .unwrap();
        assert_eq!(asked.body, RequestBody::RemoveNoGo { number: 8 });
    }

    #[test]
    fn a_name_of_forbidden_floor_goes_back_and_comes_with_what_is_brought_back() {
        let mut log = EditLog::default();
        let named = |revision, name: Option<&str>| {
            let mut home = home(revision, &[at(7, 1.0)], None);
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
        log.on_failed(number(&asked), "no-floor-there");
        assert!(log.undo(&empty).is_none());
        let asked = log.begin(forbid(2.0), &empty).unwrap();
        log.on_done(number(&asked), 1);
        let asked = log.undo(&home(2, &[at(1, 2.0)], None)).unwrap().unwrap();
        log.on_failed(number(&asked), "no-floor-there");
        assert_eq!(log.last(), Some(&Change::Home(forbid(2.0))));
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
            Some(Err(EditError::NotReportedYet)),
            "the robot has not told of the name"
        );
        let asked = log.undo(&home(2, &[], Some("Hall"))).unwrap().unwrap();
        log.on_done(number(&asked), 2);
        let changed = home(3, &[], Some("Den"));
        assert_eq!(log.redo(&changed), Some(Err(EditError::ChangedMeanwhile)));
        assert_eq!(log.redo(&changed), None, "it is dropped");
    }

    fn change(number: u16, rooms: [u16; 2], x: Option<f64>) -> RoomChangeView {
        RoomChangeView {
            number,
            rooms,
            line: x.map(|x| [[x, 0.0], [x, 3.0]]),
        }
    }

    fn home_with(revision: u32, changes: &[RoomChangeView]) -> HomeView {
        HomeView {
            room_changes: changes.to_vec(),
            ..home(revision, &[], None)
        }
    }

    #[test]
    fn a_split_and_a_join_go_and_come_back_under_whatever_number_they_have() {
        let mut log = EditLog::default();
        let line = [[1.0, 0.0], [1.0, 3.0]];
        let asked = log.begin(Edit::Split(line), &home_with(1, &[])).unwrap();
        log.on_done(number(&asked), 1);
        let cut = change(4, [3, 5], Some(1.001));
        let asked = log.begin(Edit::Join([5, 2]), &home_with(2, &[cut])).unwrap();
        assert_eq!(asked.body, RequestBody::JoinRooms { rooms: [5, 2] });
        log.on_done(number(&asked), 2);
        let both = home_with(3, &[change(2, [2, 5], Some(7.0)), cut, change(6, [2, 5], None)]);
        let asked = log.undo(&both).unwrap().unwrap();
        assert_eq!(asked.body, RequestBody::UndoRoomChange { number: 6 });
        log.on_done(number(&asked), 3);
        assert_eq!(
            log.undo(&home_with(4, &[change(2, [2, 5], Some(7.0))])),
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
    fn what_is_forbidden_and_kept_goes_back_to_its_shape_unless_somebody_has_changed_it() {
        let mut log = EditLog::default();
        let reshape = Edit::ReshapeForbidden {
            before: wall(1.0),
            after: wall(2.0),
        };
        let asked = log.begin(reshape, &home(1, &[at(7, 1.0)], None)).unwrap();
        let reshaped = |was, x| RequestBody::ReshapeNoGo {
            number: 7,
            shape: wall(x),
            was: Some(wall(was)),
        };
        assert_eq!(asked.body, reshaped(1.0, 2.0));
        log.on_done(number(&asked), 1);
        let asked = log.undo(&home(2, &[at(7, 2.001)], None)).unwrap().unwrap();
        assert_eq!(asked.body, reshaped(2.001, 1.0), "as the robot has it");
        log.on_done(number(&asked), 2);
        assert_eq!(
            log.redo(&home(3, &[at(7, 5.0)], None)),
            Some(Err(EditError::ChangedMeanwhile))
        );
        let spot = |y| PlaceShape::Spot([1.0, y]);
        let with = |revision, y| HomeView {
            places: vec![PlaceView {
                number: 4,
                name: "Bowl".to_owned(),
                shape: spot(y),
            }],
            ..home(revision, &[], None)
        };
        let moved = Edit::ReshapePlace {
            name: "Bowl".to_owned(),
            before: spot(2.0),
            after: spot(3.0),
        };
        let asked = log.begin(moved, &with(3, 2.0)).unwrap();
        let body = |was, y| RequestBody::ReshapePlace {
            number: 4,
            shape: spot(y),
            was: Some(spot(was)),
        };
        assert_eq!(asked.body, body(2.0, 3.0));
        log.on_done(number(&asked), 3);
        let asked = log.undo(&with(4, 3.0)).unwrap().unwrap();
        assert_eq!(asked.body, body(3.0, 2.0));
        log.on_done(number(&asked), 4);
        assert_eq!(
            log.redo(&with(5, 2.5)),
            Some(Err(EditError::ChangedMeanwhile)),
            "somebody else has moved it"
        );
    }

    #[test]
    fn an_older_map_is_given_back_and_a_version_that_is_gone_bars_nothing() {
        let mut log = EditLog::default();
        let none = home(1, &[], None);
        let asked = log.begin(forbid(1.0), &none).unwrap();
        log.on_done(number(&asked), 1);
        let take_up = Edit::TakeUp {
            floor: Some(2),
            before: 9,
            after: 4,
        };
        let restored = |number| RequestBody::RestoreMap {
            number,
            floor: Some(2),
        };
        let asked = log.begin(take_up, &none).unwrap();
        assert_eq!(asked.body, restored(4));
        log.on_done(number(&asked), 1);
        let asked = log.undo(&none).unwrap().unwrap();
        assert_eq!(asked.body, restored(9));
        log.on_done(number(&asked), 2);
        let asked = log.redo(&none).unwrap().unwrap();
        log.on_done(number(&asked), 2);
        let asked = log.undo(&none).unwrap().unwrap();
        log.on_failed(number(&asked), "no-such-map");
        assert_eq!(log.last(), Some(&Change::Home(forbid(1.0))));
    }

    #[test]
    fn changes_of_the_choice_stand_among_the_edits_and_end_with_the_job() {
        let mut log = EditLog::default();
        let none = home(1, &[], None);
        let chosen = |rooms: &[u16]| {
            let mut choice = RoomChoice::default();
            rooms.iter().for_each(|room| choice.toggle(*room));
            choice
        };
        log.on_chosen(chosen(&[]), chosen(&[3]));
        let asked = log.begin(forbid(1.0), &none).unwrap();
        log.on_done(number(&asked), 1);
        log.on_chosen(chosen(&[3]), chosen(&[3, 4]));
        assert!(
            log.undo(&none).is_none(),
            "the last change was not one of the map"
        );
        assert_eq!(log.undo_choice(), Some(chosen(&[3])));
        assert_eq!(log.undo_choice(), None, "now it is the wall's turn");
        assert!(log.redo(&none).is_none());
        assert_eq!(log.redo_choice(), Some(chosen(&[3, 4])));
        assert_eq!(log.undo_choice(), Some(chosen(&[3])));
        log.forget_choices();
        assert_eq!((log.last(), log.next()), (Some(&Change::Home(forbid(1.0))), None));
        let asked = log.undo(&home(2, &[at(1, 1.0)], None)).unwrap().unwrap();
        log.on_done(number(&asked), 2);
        assert_eq!(log.undo_choice(), None);
    }

    #[test]
    fn a_new_edit_ends_what_could_be_done_again() {
        let mut log = EditLog::default();
        let none = home(1, &[], None);
        let asked = log.begin(forbid(1.0), &none).unwrap();
        log.on_done(number(&asked), 1);
        let asked = log.undo(&home(2, &[at(1, 1.0)], None)).unwrap().unwrap();
        log.on_done(number(&asked), 2);
        let asked = log.begin(forbid(5.0), &none).unwrap();
        log.on_done(number(&asked), 3);
        assert_eq!(log.next(), None);
        log.clear();
        assert_eq!(log.last(), None);
    }
}
