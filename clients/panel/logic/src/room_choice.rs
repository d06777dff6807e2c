//! Which rooms, zones and spots a person has chosen, in which order, and what cleaning them takes.

use rvac_api::{HomeView, JobEstimate, JobOrder, JobPart, NoGoShape, PlaceShape, PlaceView, SPOT_RADIUS_M};

use crate::figures::{area_text, percent_text};
use crate::home::RoomRow;
use crate::job_settings::JobSettings;
use crate::kept_places::shape_text;
use crate::point::MapPoint;
use crate::reshape::Outline;
use crate::sketch::{extent, spot_border};
use crate::words::Words;

/// Most passes over a room.
pub const PASSES_MAX: u8 = 3;

/// Rooms, zones and spots in the order in which they were chosen, how often each is cleaned, and where the robot keeps out meanwhile.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomChoice {
    parts: Vec<JobPart>,
    avoid: Vec<NoGoShape>,
    passes: u8,
    settings: JobSettings,
    /// Zones and spots that the robot keeps.
    places: Vec<PlaceView>,
}

impl Default for RoomChoice {
    fn default() -> Self {
        Self {
            parts: Vec::new(),
            avoid: Vec::new(),
            passes: 1,
            settings: JobSettings::default(),
            places: Vec::new(),
        }
    }
}

/// A zone or spot of the choice, which is no room that can be pressed again to take it out.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPart {
    /// Its place in the order, from 1.
    pub place: usize,
    /// What it is, for people.
    pub name: String,
    /// Its middle.
    pub middle: [f64; 2],
}

impl RoomChoice {
    /// Chooses a room as the last one, or takes it out.
    pub fn toggle(&mut self, room: u16) {
        self.toggle_part(JobPart::Room(room));
    }

    /// Chooses a kept place as the last part, or takes it out.
    pub fn toggle_place(&mut self, number: u16) {
        self.toggle_part(JobPart::Place(number));
    }

    fn toggle_part(&mut self, part: JobPart) {
        if self.parts.contains(&part) {
            self.parts.retain(|chosen| *chosen != part);
        } else {
            self.parts.push(part);
        }
    }

    /// Chooses a zone as the last part.
    pub fn add_zone(&mut self, corners: Vec<[f64; 2]>) {
        self.parts.push(JobPart::Zone(corners));
    }

    /// Chooses a spot as the last part.
    pub fn add_spot(&mut self, middle: [f64; 2]) {
        self.parts.push(JobPart::Spot(middle));
    }

    /// Takes out the part at a place in the order, from 1.
    pub fn take_out(&mut self, place: usize) {
        if (1..=self.parts.len()).contains(&place) {
            self.parts.remove(place - 1);
        }
    }

    /// Takes out the spot that was chosen last of those that cover a place of the map. `false` when none does.
    pub fn take_spot_out_at(&mut self, place: MapPoint) -> bool {
        let is_under = |part: &JobPart| matches!(part, JobPart::Spot(at) if (at[0] - place.x).hypot(at[1] - place.y) <= SPOT_RADIUS_M);
        let found = self.parts.iter().rposition(is_under);
        if let Some(index) = found {
            self.parts.remove(index);
        }
        found.is_some()
    }

    /// Where a part is that was drawn and is not kept, by its place in the order from 1.
    #[must_use]
    pub fn part_outline(&self, place: usize) -> Option<Outline> {
        match self.parts.get(place.checked_sub(1)?)? {
            JobPart::Zone(corners) => Some(Outline::Zone(corners.clone())),
            JobPart::Spot(middle) => Some(Outline::Spot(*middle)),
            JobPart::Room(_) | JobPart::Place(_) => None,
        }
    }

    /// Lets such a part be elsewhere, at its place in the order.
    pub fn reshape_part(&mut self, place: usize, shape: PlaceShape) {
        let part = place.checked_sub(1).and_then(|index| self.parts.get_mut(index));
        if let Some(part @ (JobPart::Zone(_) | JobPart::Spot(_))) = part {
            *part = match shape {
                PlaceShape::Zone(corners) => JobPart::Zone(corners),
                PlaceShape::Spot(middle) => JobPart::Spot(middle),
            };
        }
    }

    /// Where the job keeps out, by its place in that list from 1.
    #[must_use]
    pub fn avoided_outline(&self, place: usize) -> Option<Outline> {
        let shape = self.avoid.get(place.checked_sub(1)?)?;
        Some(shape.clone().into())
    }

    /// Lets the job keep out of another place instead.
    pub fn reshape_avoided(&mut self, place: usize, shape: NoGoShape) {
        let avoided = place.checked_sub(1).and_then(|index| self.avoid.get_mut(index));
        if let Some(avoided) = avoided {
            *avoided = shape;
        }
    }

    /// Keeps out of a place no longer.
    pub fn allow_again(&mut self, place: usize) {
        if (1..=self.avoid.len()).contains(&place) {
            self.avoid.remove(place - 1);
        }
    }

    /// Chooses what was chosen before, as far as the home still has it.
    pub fn bring_back(&mut self, earlier: &Self, home: &HomeView) {
        self.clone_from(earlier);
        self.retain_known(home);
    }

    /// Keeps the robot out of a place, for this job.
    pub fn keep_out_of(&mut self, shape: NoGoShape) {
        self.avoid.push(shape);
    }

    /// Place of a room in the order, from 1; none if it is not chosen.
    #[must_use]
    pub fn place(&self, room: u16) -> Option<usize> {
        self.order_of(&JobPart::Room(room))
    }

    /// The same of a kept place.
    #[must_use]
    pub fn place_of_kept(&self, number: u16) -> Option<usize> {
        self.order_of(&JobPart::Place(number))
    }

    fn order_of(&self, wanted: &JobPart) -> Option<usize> {
        Some(self.parts.iter().position(|part| part == wanted)? + 1)
    }

    /// Where a part is that is not a room.
    fn shape_of(&self, part: &JobPart) -> Option<PlaceShape> {
        match part {
            JobPart::Room(_) => None,
            JobPart::Zone(corners) => Some(PlaceShape::Zone(corners.clone())),
            JobPart::Spot(middle) => Some(PlaceShape::Spot(*middle)),
            JobPart::Place(number) => self.kept(*number).map(|place| place.shape.clone()),
        }
    }

    fn kept(&self, number: u16) -> Option<&PlaceView> {
        self.places.iter().find(|place| place.number == number)
    }

    /// Zones and spots that were drawn and are not kept: their places in the order, what they are, and where.
    #[must_use]
    pub fn not_kept(&self, words: &Words) -> Vec<(usize, String, PlaceShape)> {
        let part = |(index, part): (usize, &JobPart)| {
            let shape = match part {
                JobPart::Room(_) | JobPart::Place(_) => return None,
                JobPart::Zone(_) | JobPart::Spot(_) => self.shape_of(part)?,
            };
            Some((index + 1, shape_text(words, &shape), shape))
        };
        self.parts.iter().enumerate().filter_map(part).collect()
    }

    /// The chosen rooms in their order.
    #[must_use]
    pub fn rooms(&self) -> Vec<u16> {
        let room = |part: &JobPart| match part {
            JobPart::Room(room) => Some(*room),
            JobPart::Zone(_) | JobPart::Spot(_) | JobPart::Place(_) => None,
        };
        self.parts.iter().filter_map(room).collect()
    }

    /// Borders of the chosen zones and spots in their order.
    pub fn borders(&self) -> impl Iterator<Item = Vec<[f64; 2]>> + '_ {
        self.parts.iter().filter_map(|part| match self.shape_of(part)? {
            PlaceShape::Zone(corners) => Some(corners),
            PlaceShape::Spot(middle) => Some(spot_border(middle)),
        })
    }

    /// The chosen zones and spots in their order.
    #[must_use]
    pub fn drawn(&self, words: &Words) -> Vec<DrawnPart> {
        let drawn = |(index, part): (usize, &JobPart)| {
            let shape = self.shape_of(part)?;
            let name = match part {
                JobPart::Place(number) => self.kept(*number)?.name.clone(),
                _ => shape_text(words, &shape),
            };
            let middle = match shape {
                PlaceShape::Zone(corners) => middle_of(&corners),
                PlaceShape::Spot(middle) => middle,
            };
            Some(DrawnPart {
                place: index + 1,
                name,
                middle,
            })
        };
        self.parts.iter().enumerate().filter_map(drawn).collect()
    }

    /// Where the robot keeps out.
    #[must_use]
    pub fn avoid(&self) -> &[NoGoShape] {
        &self.avoid
    }

    /// Nothing is chosen.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty() && self.avoid.is_empty()
    }

    /// `Kitchen, zone of 1.5 x 0.8 m, 2 spots, with 2 no-go areas`
    #[must_use]
    pub fn text(&self, words: &Words, rows: &[RoomRow]) -> String {
        let texts = &words.map;
        let word = |part: &JobPart| match part {
            JobPart::Room(id) => rows.iter().find(|row| row.id == *id).map(|row| row.name.clone()),
            JobPart::Zone(corners) => Some(texts.zone_of.fill([&extent(words, corners)])),
            JobPart::Place(number) => self.kept(*number).map(|place| place.name.clone()),
            JobPart::Spot(_) => None,
        };
        let is_spot = |part: &&JobPart| matches!(part, JobPart::Spot(_));
        let spots = match self.parts.iter().filter(is_spot).count() {
            0 => None,
            1 => Some(texts.spot.to_owned()),
            count => Some(texts.spots.fill([&count])),
        };
        let parts: Vec<String> = self.parts.iter().filter_map(word).chain(spots).collect();
        let parts = if self.parts.is_empty() {
            texts.whole_home.to_owned()
        } else {
            parts.join(", ")
        };
        match self.avoid.len() {
            0 => parts,
            1 => texts.out_of_one.fill([&parts]),
            count => texts.out_of_many.fill([&parts, &count]),
        }
    }

    /// Takes the places that are kept, and drops rooms and places that the home does not have any more. `true` when that changes
    /// anything.
    pub fn retain_known(&mut self, home: &HomeView) -> bool {
        let before = self.parts.len();
        let is_told = self.places == home.places;
        self.places.clone_from(&home.places);
        self.parts.retain(|part| match part {
            JobPart::Room(chosen) => home.rooms.iter().any(|room| room.id == *chosen),
            JobPart::Place(chosen) => home.places.iter().any(|place| place.number == *chosen),
            JobPart::Zone(_) | JobPart::Spot(_) => true,
        });
        self.parts.len() != before || !is_told
    }

    /// Chooses nothing.
    pub fn clear(&mut self) {
        self.parts.clear();
        self.avoid.clear();
        self.settings = JobSettings::default();
    }

    /// How often each part is cleaned.
    #[must_use]
    pub fn passes(&self) -> u8 {
        self.passes
    }

    /// How often and how each part is cleaned: `2x, quiet, along the walls`.
    #[must_use]
    pub fn manner_text(&self, words: &Words) -> String {
        let settings = self.settings.texts(words);
        let manner = if settings.is_empty() {
            words.home.as_rooms.to_lowercase()
        } else {
            settings.join(", ")
        };
        format!("{}, {manner}", words.map.times.fill([&self.passes]))
    }

    /// Cleans each part so often, within what a robot takes.
    pub fn set_passes(&mut self, passes: u8) {
        self.passes = passes.clamp(1, PASSES_MAX);
    }

    /// The job; none while nothing is chosen.
    #[must_use]
    pub fn order(&self) -> Option<JobOrder> {
        (!self.is_empty()).then(|| {
            self.settings.said_by(JobOrder {
                parts: self.parts.clone(),
                passes: self.passes,
                avoid: self.avoid.clone(),
                ..JobOrder::default()
            })
        })
    }

    /// Power and pattern of the job.
    #[must_use]
    pub const fn settings(&self) -> JobSettings {
        self.settings
    }

    /// Cleans so, until the choice is cleared.
    pub fn set_settings(&mut self, settings: JobSettings) {
        self.settings = settings;
    }
}

pub(crate) fn middle_of(corners: &[[f64; 2]]) -> [f64; 2] {
    let share = 1.0 / corners.len().max(1) as f64;
    corners.iter().fold([0.0, 0.0], |[x, y], corner| {
        [x + share * corner[0], y + share * corner[1]]
    })
}

/// `18.2 m², about 25 min, 41 % of a full battery; 97 % of the floor will be swept, 91 % if the robot is less sure of its
/// place than it believes`
#[must_use]
pub fn job_estimate_text(words: &Words, estimate: &JobEstimate) -> String {
    let [floor, minutes, charge, recharges] = job_takes(words, estimate);
    words.map.prospect.fill([
        &floor,
        &minutes,
        &charge,
        &recharges,
        &percent_text(words, estimate.share),
        &percent_text(words, estimate.share_low),
    ])
}

/// `The whole home: 52.4 m², about 74 min, 118 % of a full battery, with one pause to charge.`
#[must_use]
pub fn whole_home_text(words: &Words, estimate: &JobEstimate) -> String {
    let [floor, minutes, charge, recharges] = job_takes(words, estimate);
    words
        .status
        .whole_home
        .fill([&floor, &minutes, &charge, &recharges])
}

/// Floor, minutes, charge and recharges of a job.
fn job_takes(words: &Words, estimate: &JobEstimate) -> [String; 4] {
    let charge = words.number(100.0 * estimate.charge.max(0.0), 0);
    let recharges = match estimate.recharges {
        0 => String::new(),
        1 => words.map.one_recharge.to_owned(),
        times => words.map.recharges.fill([&times]),
    };
    [
        area_text(words, estimate.floor_m2),
        words.number((estimate.time_s / 60.0).ceil(), 0),
        words.unit.percent.fill([&charge]),
        recharges,
    ]
}

/// The room under a place of the map.
#[must_use]
pub fn room_at(home: &HomeView, place: MapPoint) -> Option<u16> {
    let cell = |metres: f64, origin: i32| (metres / home.cell_m).floor() - f64::from(origin);
    let (column, row) = (cell(place.x, home.x), cell(place.y, home.y));
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
    use super::{JobSettings, RoomChoice, job_estimate_text, room_at, whole_home_text};
    use crate::MapPoint;
    use crate::words::{Language, Words};
    use rvac_api::{CleaningPower, HomeView, JobEstimate, JobPart, NoGoShape, PlaceShape, PlaceView};

    const ENGLISH: &Words = Language::English.words();

    #[test]
    fn how_it_is_cleaned_stands_in_a_line() {
        let mut choice = RoomChoice::default();
        choice.toggle(3);
        assert_eq!(choice.manner_text(ENGLISH), "1x, as set for the rooms");
        choice.set_passes(2);
        let mut settings = choice.settings();
        settings.choose_power("quiet");
        settings.choose_pattern("contour");
        choice.set_settings(settings);
        assert_eq!(choice.manner_text(ENGLISH), "2x, quiet, along the walls");
    }

    #[test]
    fn zones_stand_among_the_rooms_and_the_job_keeps_out_of_places() {
        let mut choice = RoomChoice::default();
        choice.keep_out_of(NoGoShape::Wall([[0.0, 0.0], [1.0, 0.0]]));
        assert_eq!(choice.text(ENGLISH, &[]), "The whole home, with 1 no-go area");
        let corners = vec![[0.0, 0.0], [1.5, 0.0], [1.5, 0.8], [0.0, 0.8]];
        choice.toggle(3);
        choice.add_zone(corners.clone());
        choice.toggle(4);
        let order = choice.order().expect("something is chosen");
        assert_eq!(
            order.parts,
            [JobPart::Room(3), JobPart::Zone(corners), JobPart::Room(4)]
        );
        assert_eq!(order.avoid.len(), 1);
        assert_eq!(
            (choice.rooms(), choice.borders().count(), choice.place(4)),
            (vec![3, 4], 1, Some(3))
        );
        assert!(choice.text(ENGLISH, &[]).starts_with("zone of 1.5 x 0.8\u{a0}m"));
        choice.retain_known(&HomeView::default());
        assert_eq!((choice.rooms().len(), choice.borders().count()), (0, 1));
        let mut settings = choice.settings();
        settings.choose_power("quiet");
        choice.set_settings(settings);
        let power = choice.order().and_then(|order| order.power);
        assert_eq!(power, Some(CleaningPower::QUIET));
        choice.clear();
        assert!(choice.is_empty() && choice.order().is_none());
        assert_eq!(choice.settings(), JobSettings::default());
    }

    #[test]
    fn a_spot_has_its_place_in_the_order_and_is_taken_out_again() {
        let mut choice = RoomChoice::default();
        choice.toggle(3);
        choice.add_spot([1.0, 2.0]);
        choice.add_zone(vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]);
        choice.add_spot([1.3, 2.0]);
        let places: Vec<(usize, [f64; 2])> = choice
            .drawn(ENGLISH)
            .iter()
            .map(|part| (part.place, part.middle))
            .collect();
        assert_eq!(places, [(2, [1.0, 2.0]), (3, [1.0, 0.5]), (4, [1.3, 2.0])]);
        assert!(choice.text(ENGLISH, &[]).ends_with(", 2 spots"));
        assert!(!choice.take_spot_out_at(MapPoint::new(0.2, 2.0)));
        assert!(
            choice.take_spot_out_at(MapPoint::new(1.1, 2.1)),
            "the one that lies above"
        );
        choice.take_out(3);
        choice.take_out(9);
        choice.take_out(0);
        let order = choice.order().expect("something is chosen");
        assert_eq!(order.parts, [JobPart::Room(3), JobPart::Spot([1.0, 2.0])]);
    }

    #[test]
    fn an_earlier_choice_comes_back_as_far_as_the_home_still_has_it() {
        let mut choice = RoomChoice::default();
        choice.toggle(3);
        choice.add_spot([1.0, 2.0]);
        choice.keep_out_of(NoGoShape::Wall([[0.0, 0.0], [1.0, 0.0]]));
        choice.set_passes(2);
        let earlier = choice.clone();
        choice.allow_again(2);
        assert_eq!(choice.avoid().len(), 1);
        choice.allow_again(1);
        choice.clear();
        assert!(choice.is_empty());
        choice.bring_back(&earlier, &HomeView::default());
        let order = choice.order().expect("something is chosen");
        assert_eq!(order.parts, [JobPart::Spot([1.0, 2.0])], "the room is gone");
        assert_eq!((order.avoid.len(), order.passes), (1, 2));
    }

    #[test]
    fn a_kept_place_is_a_part_by_its_number_and_goes_when_it_is_forgotten() {
        let mut choice = RoomChoice::default();
        let home = HomeView {
            places: vec![PlaceView {
                number: 3,
                name: "Bowl".to_owned(),
                shape: PlaceShape::Spot([1.0, 2.0]),
            }],
            ..HomeView::default()
        };
        assert!(choice.retain_known(&home) && !choice.retain_known(&home));
        choice.add_spot([5.0, 5.0]);
        choice.toggle_place(3);
        assert_eq!(choice.place_of_kept(3), Some(2));
        assert_eq!(choice.text(ENGLISH, &[]), "Bowl, spot");
        assert_eq!(choice.borders().count(), 2);
        assert_eq!(choice.drawn(ENGLISH)[1].middle, [1.0, 2.0]);
        assert_eq!(choice.not_kept(ENGLISH).len(), 1, "what is drawn can be kept");
        let order = choice.order().expect("something is chosen");
        assert_eq!(order.parts, [JobPart::Spot([5.0, 5.0]), JobPart::Place(3)]);
        assert!(choice.retain_known(&HomeView::default()));
        assert_eq!(choice.place_of_kept(3), None);
    }

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
        for ((x, y), room) in [
            ((-0.9, 2.1), Some(1)),
            ((-0.1, 2.1), Some(1)),
            ((0.1, 2.4), None),
            ((0.1, 2.6), Some(2)),
            ((-1.1, 2.1), None),
            ((0.6, 2.1), None),
            ((f64::NAN, 2.1), None),
        ] {
            assert_eq!(room_at(&home, MapPoint::new(x, y)), room, "{x} {y}");
        }
        assert_eq!(room_at(&HomeView::default(), MapPoint::default()), None);
    }

    #[test]
    fn the_whole_home_is_told_before_the_start() {
        let estimate = |recharges| JobEstimate {
            floor_m2: 52.4,
            time_s: 4_401.0,
            charge: 1.18,
            recharges,
            ..JobEstimate::default()
        };
        assert_eq!(
            whole_home_text(ENGLISH, &estimate(1)),
            "The whole home: 52.4\u{a0}m², about 74\u{a0}min, 118\u{a0}% of a full battery, with one pause to charge."
        );
        assert!(whole_home_text(ENGLISH, &estimate(0)).ends_with("of a full battery."));
    }

    #[test]
    fn an_estimate_is_one_line() {
        let estimate = JobEstimate {
            floor_m2: 18.2,
            time_s: 1450.0,
            charge: 1.2,
            recharges: 2,
            share: 0.974,
            share_low: 0.91,
            ..JobEstimate::default()
        };
        let text = job_estimate_text(ENGLISH, &estimate);
        assert!(
            text.starts_with("18.2\u{a0}m², about 25\u{a0}min, 120\u{a0}% of a full battery, with 2 pauses to charge; expected coverage 97\u{a0}%"),
            "{text}"
        );
    }
}
