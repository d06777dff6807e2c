//! Moving the corners of what was drawn: of what is forbidden, of kept places, and of what is chosen for a job.
//!
//! The *outline* is what is reshaped, without what it is for. Its *handles* are the places by which it is moved: each corner,
//! and the middle, which moves all of it.

use rvac_api::{HomeView, NoGoShape, PlaceShape};

use crate::edits::Edit;
use crate::room_choice::{RoomChoice, middle_of};
use crate::sketch::{APART_MIN_M, extent, no_go_rows, spot_border, wall_length_m};
use crate::words::Words;

/// A press of an arrow key moves a handle so far, metres: two cells of the map.
pub const HANDLE_STEP_M: f64 = 0.05;
/// The same with Shift, for what must fit exactly.
pub const HANDLE_FINE_STEP_M: f64 = 0.01;
/// Corners that differ by less along an axis are one edge along the other axis, metres: the robot rounds to micrometres.
const ALONG_M: f64 = 1e-4;

/// What can be reshaped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A no-go zone or virtual wall, by its number.
    NoGo(u16),
    /// A kept place, by its number.
    Place(u16),
    /// A zone or spot of the choice that is not kept, by its place in the order from 1.
    Part(usize),
    /// Where the job keeps out, by its place in that list from 1.
    Avoided(usize),
}

impl Target {
    /// Name of the button that begins it, unique on the page.
    #[must_use]
    pub fn button_id(self) -> String {
        match self {
            Self::NoGo(number) => format!("reshape-no-go-{number}"),
            Self::Place(number) => format!("reshape-place-{number}"),
            Self::Part(place) => format!("reshape-part-{place}"),
            Self::Avoided(place) => format!("reshape-avoided-{place}"),
        }
    }

    /// Whether it stays in the map, and is not only for one job.
    #[must_use]
    pub const fn changes_home(self) -> bool {
        matches!(self, Self::NoGo(_) | Self::Place(_))
    }
}

/// Where something is.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// Between two ends.
    Line([[f64; 2]; 2]),
    /// Between corners.
    Zone(Vec<[f64; 2]>),
    /// Around a middle.
    Spot([f64; 2]),
}

/// A place by which an outline is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handle {
    /// A corner or an end, from 0.
    Corner(usize),
    /// All of it.
    Middle,
}

impl From<NoGoShape> for Outline {
    fn from(shape: NoGoShape) -> Self {
        match shape {
            NoGoShape::Wall(ends) => Self::Line(ends),
            NoGoShape::Zone(corners) => Self::Zone(corners),
        }
    }
}

impl From<PlaceShape> for Outline {
    fn from(shape: PlaceShape) -> Self {
        match shape {
            PlaceShape::Zone(corners) => Self::Zone(corners),
            PlaceShape::Spot(middle) => Self::Spot(middle),
        }
    }
}

impl Outline {
    /// As something forbidden; none of a spot.
    fn no_go(self) -> Option<NoGoShape> {
        match self {
            Self::Line(ends) => Some(NoGoShape::Wall(ends)),
            Self::Zone(corners) => Some(NoGoShape::Zone(corners)),
            Self::Spot(_) => None,
        }
    }

    /// As something to be cleaned; none of a line.
    fn place(self) -> Option<PlaceShape> {
        match self {
            Self::Line(_) => None,
            Self::Zone(corners) => Some(PlaceShape::Zone(corners)),
            Self::Spot(middle) => Some(PlaceShape::Spot(middle)),
        }
    }

    fn corners(&self) -> &[[f64; 2]] {
        match self {
            Self::Line(ends) => ends,
            Self::Zone(corners) => corners,
            Self::Spot(_) => &[],
        }
    }

    /// All handles: corners in their order, then the middle.
    #[must_use]
    pub fn handles(&self) -> Vec<Handle> {
        let corners = (0..self.corners().len()).map(Handle::Corner);
        corners.chain([Handle::Middle]).collect()
    }

    /// Where a handle is; none if the outline has no such one.
    #[must_use]
    pub fn at(&self, handle: Handle) -> Option<[f64; 2]> {
        match (handle, self) {
            (Handle::Middle, Self::Spot(middle)) => Some(*middle),
            (Handle::Middle, _) => Some(middle_of(self.corners())),
            (Handle::Corner(corner), _) => self.corners().get(corner).copied(),
        }
    }

    /// What is drawn of it, the first place again at its end.
    #[must_use]
    pub fn border(&self) -> Vec<[f64; 2]> {
        let border = match self {
            Self::Line(ends) => return ends.to_vec(),
            Self::Zone(corners) => corners.clone(),
            Self::Spot(middle) => spot_border(*middle),
        };
        let again = border.first().copied();
        border.into_iter().chain(again).collect()
    }

    /// The outline with a handle elsewhere; none when it would be too small to be meant, or has no such handle. A rectangle along
    /// the axes of the map stays one.
    #[must_use]
    pub fn moved(&self, handle: Handle, to: [f64; 2]) -> Option<Self> {
        let from = self.at(handle)?;
        let by = [to[0] - from[0], to[1] - from[1]];
        let shifted = |[x, y]: [f64; 2]| [x + by[0], y + by[1]];
        let moved = match (handle, self) {
            (Handle::Middle, Self::Line(ends)) => Self::Line(ends.map(shifted)),
            (Handle::Middle, Self::Zone(corners)) => {
                Self::Zone(corners.iter().copied().map(shifted).collect())
            }
            (Handle::Middle, Self::Spot(middle)) => Self::Spot(shifted(*middle)),
            (Handle::Corner(corner), Self::Line(ends)) => {
                let mut ends = *ends;
                *ends.get_mut(corner)? = to;
                Self::Line(ends)
            }
            (Handle::Corner(corner), Self::Zone(corners)) => Self::Zone(with_corner(corners, corner, to)),
            (Handle::Corner(_), Self::Spot(_)) => return None,
        };
        moved.is_large_enough().then_some(moved)
    }

    fn is_large_enough(&self) -> bool {
        match self {
            Self::Line(ends) => wall_length_m(ends) >= APART_MIN_M,
            Self::Zone(corners) => {
                let span = |axis: fn(&[f64; 2]) -> f64| {
                    let low = corners.iter().map(axis).fold(f64::INFINITY, f64::min);
                    let high = corners.iter().map(axis).fold(f64::NEG_INFINITY, f64::max);
                    high - low
                };
                span(|corner| corner[0]).min(span(|corner| corner[1])) >= APART_MIN_M
            }
            Self::Spot(_) => true,
        }
    }

    /// `1.5 x 0.8 m`, `1.2 m`; where it is for a spot, whose size is always the same.
    #[must_use]
    pub fn text(&self, words: &Words) -> String {
        let metres = |length_m: f64, digits: usize| words.number(length_m, digits);
        match self {
            Self::Line(ends) => words.unit.metres.fill([&metres(wall_length_m(ends), 2)]),
            Self::Zone(corners) => extent(words, corners),
            Self::Spot([x, y]) => words.map.spot_at.fill([&metres(*x, 2), &metres(*y, 2)]),
        }
    }
}

fn is_along(one: f64, other: f64) -> bool {
    (one - other).abs() < ALONG_M
}

/// The corners with one elsewhere. Those beside it in a rectangle along the axes go along, so that it stays one.
fn with_corner(corners: &[[f64; 2]], moved: usize, to: [f64; 2]) -> Vec<[f64; 2]> {
    let mut after = corners.to_vec();
    let count = corners.len();
    let edge = |from: usize| (corners[from % count], corners[(from + 1) % count]);
    let is_upright = |from: usize| is_along(edge(from).0[0], edge(from).1[0]);
    let is_level = |from: usize| is_along(edge(from).0[1], edge(from).1[1]);
    let is_rectangle = count == 4
        && ((0..4).all(|from| {
            if from % 2 == 0 {
                is_level(from)
            } else {
                is_upright(from)
            }
        }) || (0..4).all(|from| {
            if from % 2 == 0 {
                is_upright(from)
            } else {
                is_level(from)
            }
        }));
    if is_rectangle {
        for beside in [(moved + 1) % count, (moved + count - 1) % count] {
            let axis = usize::from(!is_along(corners[beside][0], corners[moved][0]));
            after[beside][axis] = to[axis];
        }
    }
    after[moved] = to;
    after
}

/// An outline in hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Reshape {
    target: Target,
    name: String,
    before: Outline,
    outline: Outline,
    /// The last movement would have made it too small.
    is_too_small: bool,
}

/// What comes of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Reshaped {
    /// An edit of the map.
    Home(Edit),
    /// Another choice.
    Choice(RoomChoice),
}

impl Reshape {
    /// Takes it in hand; none if it is not there.
    #[must_use]
    pub fn begin(target: Target, home: &HomeView, choice: &RoomChoice, words: &Words) -> Option<Self> {
        let (name, before) = found(target, home, choice, words)?;
        Some(Self {
            target,
            name,
            outline: before.clone(),
            before,
            is_too_small: false,
        })
    }

    /// What is reshaped.
    #[must_use]
    pub const fn target(&self) -> Target {
        self.target
    }

    /// What people call it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// `No-go zone 3: 1.5 x 0.8 m`
    #[must_use]
    pub fn text(&self, words: &Words) -> String {
        format!("{}: {}", self.name, self.outline.text(words))
    }

    /// As it would be.
    #[must_use]
    pub const fn outline(&self) -> &Outline {
        &self.outline
    }

    /// Moves a handle; what cannot be stays as it is.
    pub fn move_to(&mut self, handle: Handle, to: [f64; 2]) {
        let moved = self.outline.moved(handle, to);
        self.is_too_small = moved.is_none();
        if let Some(moved) = moved {
            self.outline = moved;
        }
    }

    /// What was wrong with the last movement, for people.
    #[must_use]
    pub fn problem(&self, words: &Words) -> Option<&'static str> {
        self.is_too_small.then_some(words.map.too_small)
    }

    /// Whether the reshaped part of the choice has changed: it was taken out, or another one took its place.
    #[must_use]
    pub fn is_orphaned(&self, choice: &RoomChoice) -> bool {
        let now = match self.target {
            Target::NoGo(_) | Target::Place(_) => return false,
            Target::Part(place) => choice.part_outline(place),
            Target::Avoided(place) => choice.avoided_outline(place),
        };
        now.as_ref() != Some(&self.before)
    }

    /// What is to be done; none when nothing was moved.
    #[must_use]
    pub fn finish(self, choice: &RoomChoice) -> Option<Reshaped> {
        if self.outline == self.before {
            return None;
        }
        let (before, after) = (self.before, self.outline);
        let mut chosen = choice.clone();
        match self.target {
            Target::NoGo(_) => Some(Reshaped::Home(Edit::ReshapeForbidden {
                before: before.no_go()?,
                after: after.no_go()?,
            })),
            Target::Place(_) => Some(Reshaped::Home(Edit::ReshapePlace {
                name: self.name,
                before: before.place()?,
                after: after.place()?,
            })),
            Target::Part(place) => {
                chosen.reshape_part(place, after.place()?);
                Some(Reshaped::Choice(chosen))
            }
            Target::Avoided(place) => {
                chosen.reshape_avoided(place, after.no_go()?);
                Some(Reshaped::Choice(chosen))
            }
        }
    }
}

/// What is reshaped: its name and where it is.
fn found(target: Target, home: &HomeView, choice: &RoomChoice, words: &Words) -> Option<(String, Outline)> {
    match target {
        Target::NoGo(number) => {
            let row = no_go_rows(words, home)
                .into_iter()
                .find(|row| row.number == number)?;
            let view = home.no_go.iter().find(|view| view.number == number)?;
            Some((row.name, view.shape.clone().into()))
        }
        Target::Place(number) => {
            let place = home.places.iter().find(|place| place.number == number)?;
            Some((place.name.clone(), place.shape.clone().into()))
        }
        Target::Part(place) => {
            let outline = choice.part_outline(place)?;
            let name = match outline {
                Outline::Spot(_) => words.map.spot,
                Outline::Line(_) | Outline::Zone(_) => words.map.zone_alone,
            };
            Some((format!("{place}. {name}"), outline))
        }
        Target::Avoided(place) => {
            let outline = choice.avoided_outline(place)?;
            Some((words.map.avoided.fill([&place]), outline))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Handle, Outline, Reshape, Reshaped, Target};
    use crate::edits::Edit;
    use crate::room_choice::RoomChoice;
    use crate::words::{Language, Words};
    use rvac_api::{HomeView, JobPart, NoGoShape, NoGoView, PlaceShape, PlaceView};

    const ENGLISH: &Words = Language::English.words();

    fn square() -> Vec<[f64; 2]> {
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]
    }

    #[test]
    fn a_rectangle_stays_one_whichever_corner_is_moved() {
        let zone = Outline::Zone(square());
        let corner = |corner, to| zone.moved(Handle::Corner(corner), to);
        for (number, to, corners) in [
            (0, [0.5, 0.25], [[0.5, 0.25], [2.0, 0.25], [2.0, 1.0], [0.5, 1.0]]),
            (1, [3.0, -1.0], [[0.0, -1.0], [3.0, -1.0], [3.0, 1.0], [0.0, 1.0]]),
            (2, [1.0, 2.0], [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]]),
            (3, [-1.0, 0.5], [[-1.0, 0.0], [2.0, 0.0], [2.0, 0.5], [-1.0, 0.5]]),
        ] {
            assert_eq!(
                corner(number, to),
                Some(Outline::Zone(corners.to_vec())),
                "{number}"
            );
        }
        assert_eq!(corner(0, [1.98, 0.0]), None, "too thin to be meant");
        assert_eq!(corner(4, [1.0, 1.0]), None);
    }

    #[test]
    fn a_rectangle_that_was_begun_upwards_stays_one() {
        let mut corners = square();
        corners.rotate_left(1);
        let moved = Outline::Zone(corners).moved(Handle::Corner(1), [3.0, 2.0]);
        let expected = vec![[3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0]];
        assert_eq!(moved, Some(Outline::Zone(expected)));
    }

    #[test]
    fn a_corner_of_another_shape_moves_alone_and_the_middle_moves_all() {
        let triangle = Outline::Zone(vec![[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]]);
        let moved = triangle.moved(Handle::Corner(2), [1.0, 2.0]);
        assert_eq!(
            moved,
            Some(Outline::Zone(vec![[0.0, 0.0], [3.0, 0.0], [1.0, 2.0]]))
        );
        assert_eq!(triangle.handles().len(), 4);
        let moved = triangle.moved(Handle::Middle, [2.0, 1.0]);
        assert_eq!(
            moved,
            Some(Outline::Zone(vec![[1.0, 0.0], [4.0, 0.0], [1.0, 3.0]]))
        );
        let wall = Outline::Line([[0.0, 0.0], [1.0, 0.0]]);
        assert_eq!(
            wall.moved(Handle::Corner(1), [0.01, 0.0]),
            None,
            "no wall any more"
        );
        let moved = wall.moved(Handle::Middle, [0.5, 1.0]);
        assert_eq!(moved, Some(Outline::Line([[0.0, 1.0], [1.0, 1.0]])));
        let spot = Outline::Spot([1.0, 1.0]);
        assert_eq!(spot.handles(), [Handle::Middle]);
        assert_eq!(
            spot.moved(Handle::Middle, [2.0, 2.0]),
            Some(Outline::Spot([2.0, 2.0]))
        );
    }

    fn home() -> HomeView {
        HomeView {
            no_go: vec![NoGoView {
                number: 4,
                shape: NoGoShape::Zone(square()),
                name: None,
            }],
            places: vec![PlaceView {
                number: 2,
                name: "Bowl".to_owned(),
                shape: PlaceShape::Spot([1.0, 1.0]),
            }],
            ..HomeView::default()
        }
    }

    #[test]
    fn what_is_in_the_map_becomes_an_edit() {
        let (home, choice) = (home(), RoomChoice::default());
        let begin = |target| Reshape::begin(target, &home, &choice, ENGLISH);
        let mut zone = begin(Target::NoGo(4)).expect("is there");
        assert_eq!(
            (zone.name(), zone.clone().finish(&choice)),
            ("No-go zone\u{a0}4", None)
        );
        zone.move_to(Handle::Corner(2), [0.02, 1.0]);
        assert!(zone.problem(ENGLISH).is_some_and(|told| told.contains("5 cm")));
        assert_eq!(zone.text(ENGLISH), "No-go zone\u{a0}4: 2.0 x 1.0\u{a0}m");
        zone.move_to(Handle::Corner(2), [3.0, 1.0]);
        assert_eq!(zone.problem(ENGLISH), None);
        assert_eq!(zone.text(ENGLISH), "No-go zone\u{a0}4: 3.0 x 1.0\u{a0}m");
        let wider = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]];
        assert_eq!(
            zone.finish(&choice),
            Some(Reshaped::Home(Edit::ReshapeForbidden {
                before: NoGoShape::Zone(square()),
                after: NoGoShape::Zone(wider),
            }))
        );
        let mut bowl = begin(Target::Place(2)).expect("is there");
        bowl.move_to(Handle::Middle, [2.0, 1.0]);
        assert!(!bowl.is_orphaned(&choice));
        assert!(matches!(
            bowl.finish(&choice),
            Some(Reshaped::Home(Edit::ReshapePlace { name, .. })) if name == "Bowl"
        ));
        assert_eq!(begin(Target::NoGo(2)), None);
        assert_eq!(begin(Target::Place(4)), None);
    }

    #[test]
    fn what_is_chosen_becomes_another_choice() {
        let home = home();
        let mut choice = RoomChoice::default();
        choice.toggle(3);
        choice.add_zone(square());
        choice.keep_out_of(NoGoShape::Wall([[0.0, 0.0], [1.0, 0.0]]));
        let begin = |target| Reshape::begin(target, &home, &choice, ENGLISH);
        assert_eq!(begin(Target::Part(1)), None, "a room has its own shape");
        let mut zone = begin(Target::Part(2)).expect("is there");
        zone.move_to(Handle::Middle, [5.0, 0.5]);
        let Some(Reshaped::Choice(other)) = zone.clone().finish(&choice) else {
            panic!("{zone:?}");
        };
        let moved = vec![[4.0, 0.0], [6.0, 0.0], [6.0, 1.0], [4.0, 1.0]];
        assert_eq!(other.order().expect("a job").parts[1], JobPart::Zone(moved));
        let mut wall = begin(Target::Avoided(1)).expect("is there");
        wall.move_to(Handle::Corner(1), [2.0, 0.0]);
        let Some(Reshaped::Choice(other)) = wall.clone().finish(&choice) else {
            panic!("{wall:?}");
        };
        assert_eq!(other.avoid(), [NoGoShape::Wall([[0.0, 0.0], [2.0, 0.0]])]);
        choice.take_out(1);
        assert!(zone.is_orphaned(&choice), "it is another part now");
        assert!(!wall.is_orphaned(&choice));
    }
}
