//! Numbers of rooms, zones and places by chance: edits, restores, imports and jobs are drawn, and no number ever means two things.

use crate::forbidden::Draw;
use crate::orders::{START, flat, known, zone};
use crate::plane::{World, config, edit, run};
use brain::{
    BehaviorState, Brain, Cell, CleaningOrder, CutLine, EditError, HomePart, JobCommand, KeptPlace, MapEdit,
    NextNumbers, NoGo, NoGoEdit, PlaceEdit, PlaceShape, Point2, RoomEdit, RoomName, StoredMap,
};
use std::collections::{BTreeMap, BTreeSet};

/// Every how many cells of a room one is looked at, in each direction.
const STRIDE: i32 = 4;

/// What a number was given for, over all edits and restores.
#[derive(Default)]
struct Identities {
    no_go: BTreeMap<u16, Point2>,
    places: BTreeMap<u16, RoomName>,
    rooms: BTreeMap<u16, BTreeSet<Cell>>,
    given: u32,
}

/// Some cells of each room.
fn rooms_of(brain: &Brain) -> BTreeMap<u16, BTreeSet<Cell>> {
    let labels = brain.map().rooms().labels();
    let mut rooms: BTreeMap<u16, BTreeSet<Cell>> = BTreeMap::new();
    for (index, room) in labels.values().iter().enumerate() {
        let cell = labels.cell(index);
        if *room > 0 && cell.x % STRIDE == 0 && cell.y % STRIDE == 0 {
            rooms.entry(*room).or_default().insert(cell);
        }
    }
    rooms
}

impl Identities {
    /// Every number means what it meant when it was given.
    fn check(&mut self, brain: &Brain) {
        for (number, no_go) in brain.map().annotations().no_go() {
            let first = no_go.area().corners()[0];
            let meant = self.no_go.entry(number).or_insert_with(|| {
                self.given += 1;
                first
            });
            assert_eq!(*meant, first, "no-go {number} means two things");
        }
        for (number, place) in brain.map().annotations().places() {
            let meant = self.places.entry(number).or_insert_with(|| {
                self.given += 1;
                place.name().clone()
            });
            assert_eq!(meant, place.name(), "place {number} means two things");
        }
    }

    /// A room may lose floor to a part that is cut off, and gain that of a room with which it is joined; it never lies where it has never
    /// been. A number that was not seen before is higher than all others.
    fn check_rooms(&mut self, brain: &Brain) {
        for (number, cells) in rooms_of(brain) {
            let highest = self.rooms.keys().copied().max().unwrap_or(0);
            let Some(meant) = self.rooms.get_mut(&number) else {
                assert!(number > highest, "room {number} is new after {highest}");
                self.given += 1;
                self.rooms.insert(number, cells);
                continue;
            };
            assert!(
                meant.intersection(&cells).next().is_some(),
                "room {number} is somewhere else"
            );
            meant.extend(cells);
        }
    }
}

/// A drawn change of rooms. Lines run through one of the two rooms, along or across.
fn drawn_room_edit(draw: &mut Draw, brain: &Brain) -> MapEdit {
    let ids: Vec<u16> = brain.map().rooms().rooms().iter().map(|room| room.id).collect();
    let room = |draw: &mut Draw| ids[draw.below(ids.len() as u32) as usize];
    let at = |x_m: f64, y_m: f64| Point2 {
        x_m: x_m - START.x_m,
        y_m: y_m - START.y_m,
    };
    MapEdit::Room(match draw.below(4) {
        0 | 1 => {
            let share = 0.3 + f64::from(draw.below(40)) / 100.0;
            let left_m = if draw.below(2) == 0 { 0.0 } else { 3.1 };
            let ends = if draw.below(2) == 0 {
                (at(left_m - 0.1, 4.0 * share), at(left_m + 3.1, 4.0 * share))
            } else {
                (at(left_m + 3.0 * share, -0.1), at(left_m + 3.0 * share, 4.1))
            };
            RoomEdit::Split {
                room: None,
                line: CutLine::new(ends.0, ends.1).expect("a line"),
            }
        }
        2 => RoomEdit::Join {
            rooms: [room(draw), room(draw)],
        },
        _ => RoomEdit::Undo {
            number: 1 + draw.below(30) as u16,
        },
    })
}

/// One drawn edit; names and corners are never the same twice.
fn drawn_edit(draw: &mut Draw, brain: &Brain, serial: u32) -> MapEdit {
    let number = 1 + draw.below(40) as u16;
    let shift = f64::from(serial % 5_000) * 1e-4;
    let area = zone((1.5 + shift, 2.0), (2.5, 3.0));
    let place = |name: &str| {
        let shape = PlaceShape::Zone(zone((0.5 + shift, 0.5), (1.5, 1.5)));
        KeptPlace::new(RoomName::new(name).expect("a name"), &shape).expect("a shape")
    };
    match draw.below(9) {
        0 | 1 => MapEdit::NoGo(NoGoEdit::Add(NoGo::zone(&area).expect("an area"))),
        2 | 3 => MapEdit::NoGo(NoGoEdit::Remove { number }),
        4 | 5 => MapEdit::Place(PlaceEdit::Keep {
            place: place(&format!("Place {serial}")),
            number: None,
        }),
        6 | 7 => MapEdit::Place(PlaceEdit::Forget { number }),
        _ => drawn_room_edit(draw, brain),
    }
}

/// A home at work: its brain, and the maps of it that somebody kept.
struct Life {
    brain: Brain,
    world: World,
    kept: Vec<StoredMap>,
    /// Jobs that were accepted, and those of them that began.
    accepted: u32,
    begun: u32,
}

impl Life {
    fn new() -> Self {
        let brain = Brain::with_map(config(), 1, &known(&flat()));
        let mut life = Self {
            kept: vec![brain.map().stored()],
            brain,
            world: World::new(flat(), START),
            accepted: 0,
            begun: 0,
        };
        life.pass(1.0);
        life
    }

    fn pass(&mut self, seconds: f64) {
        run(&mut self.world, &mut self.brain, None, seconds);
    }

    /// A map from before comes back, as itself or through a file.
    fn take_up(&mut self, draw: &mut Draw) {
        let now = self.brain.map().stored();
        let back = self.kept[draw.below(self.kept.len() as u32) as usize].clone();
        let back = match draw.below(2) {
            0 => back,
            _ => StoredMap::from_parts(back.parts()).expect("what was written is read"),
        };
        self.brain = Brain::with_map(config(), 1, &back.numbered_after(now.next_numbers()));
        self.world = World::new(flat(), START);
        self.pass(0.2);
        if self.kept.len() < 60 {
            self.kept.push(now);
        }
    }

    /// A job for a room by its number: what is accepted begins, and what is refused is so by its name.
    fn order(&mut self, draw: &mut Draw, given: u16) {
        let room = 1 + draw.below(u32::from(given)) as u16;
        let order = CleaningOrder::new(vec![HomePart::Room(room)], 1).expect("an order");
        let command = JobCommand::CleanParts { order };
        let is_there = self
            .brain
            .map()
            .rooms()
            .rooms()
            .iter()
            .any(|there| there.id == room);
        let answer = self.brain.admit(&command);
        if !is_there {
            assert_eq!(answer, Err(EditError::NoSuchRoom.into()), "room {room}");
            return;
        }
        if answer.is_err() {
            return;
        }
        self.accepted += 1;
        run(&mut self.world, &mut self.brain, Some(command), 5.0);
        let works = matches!(
            self.brain.status().state,
            BehaviorState::Starting | BehaviorState::Cleaning
        );
        self.begun += u32::from(works);
        run(&mut self.world, &mut self.brain, Some(JobCommand::Stop), 0.5);
        self.world = World::new(flat(), START);
        self.brain = Brain::with_map(config(), 1, &self.brain.map().stored());
        self.pass(0.2);
    }
}

/// Edits, restores, imports and jobs by number, by chance.
fn live(seed: u64, steps: u32) {
    let mut draw = Draw(seed);
    let mut life = Life::new();
    let mut identities = Identities::default();
    let mut refused = BTreeSet::new();
    for serial in 0..steps {
        match draw.below(120) {
            0 | 1 => life.take_up(&mut draw),
            2 => {
                let given = identities.rooms.keys().copied().max().unwrap_or(0) + 3;
                life.order(&mut draw, given);
            }
            _ => {
                let made = drawn_edit(&mut draw, &life.brain, serial);
                match life.brain.map().admit(&made) {
                    Ok(()) => edit(&mut life.world, &mut life.brain, made),
                    Err(error) => {
                        refused.insert(error.name());
                    }
                }
            }
        }
        identities.check(&life.brain);
        identities.check_rooms(&life.brain);
    }
    assert!(identities.given > steps / 8, "{} numbers given", identities.given);
    assert!(identities.rooms.len() > 4, "{:?}", identities.rooms.keys());
    assert!(
        refused.contains("no-such-no-go") && refused.contains("no-such-place"),
        "{refused:?}"
    );
    assert!(
        life.accepted > 0 && life.begun == life.accepted,
        "{} of {}",
        life.begun,
        life.accepted
    );
}

/// Of a floor whose maps cannot be read any more people keep numbers still.
#[test]
fn a_brain_without_a_map_goes_on_with_the_numbers_of_its_floor() {
    let next = NextNumbers {
        room: 5,
        no_go: 3,
        place: 4,
        room_change: 2,
    };
    let mut brain = Brain::new(config(), 1);
    brain.number_after(next);
    let stored = brain.map().stored();
    assert!(stored.is_empty());
    assert_eq!(stored.next_numbers(), next, "also in what is kept of it");
    let known = known(&flat()).numbered_after(stored.next_numbers());
    let mut brain = Brain::with_map(config(), 1, &known);
    run(&mut World::new(flat(), START), &mut brain, None, 1.0);
    let rooms: Vec<u16> = rooms_of(&brain).into_keys().collect();
    assert_eq!(rooms, [5, 6]);
}

#[test]
fn no_number_means_two_things_over_edits_restores_and_jobs() {
    live(10_000, 1_500);
}

#[test]
#[ignore = "campaign: 10,000 edits, restores, imports and jobs; cargo xtask test --long"]
fn ten_thousand_edits_restores_imports_and_jobs_keep_every_number() {
    live(38, 10_000);
}
