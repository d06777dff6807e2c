//! Jobs for parts of a known home: rooms, zones, spots, passes, no-go zones, and what a job is expected to take.

use crate::plane::{Rectangle, Room, World, config, edit, run};
use brain::mapping::DockLocation;
use brain::{
    BehaviorState, Brain, BrainConfig, CELL_M, Cell, CellKnowledge, CleaningOrder, EditError, HomePart,
    Inhibit, JobCommand, JobEstimate, JobRefusal, MapEdit, NoGo, NoGoEdit, OrderRefusal, Point2, Pose2,
    Raster, Reason, RoomEdit, RoomName, RoomPower, RoomSettings, StoredMap, Zone,
};

/// Two rooms of 3 x 4 m, and a door of 0.9 m in the wall between them.
pub(crate) fn flat() -> Room {
    Room::empty((6.1, 4.0)).with(&[
        Rectangle::new((3.0, 0.0), (3.1, 1.5)),
        Rectangle::new((3.0, 2.4), (3.1, 4.0)),
    ])
}

pub(crate) const START: Pose2 = Pose2 {
    x_m: 1.0,
    y_m: 1.0,
    heading_rad: 0.0,
};

/// The flat in the frame of a robot that starts at `START`.
pub(crate) fn known(room: &Room) -> StoredMap {
    let (width, height) = (260, 180);
    let mut knowledge = Raster::filled(Cell { x: -50, y: -50 }, width, height, CellKnowledge::Occupied);
    for index in 0..width * height {
        let place = knowledge.cell(index).middle();
        let there = Point2 {
            x_m: START.x_m + place.x_m,
            y_m: START.y_m + place.y_m,
        };
        if room.clearance(there).0 > 0.0 {
            knowledge.values_mut()[index] = CellKnowledge::Free;
        }
    }
    StoredMap::from_raster(&knowledge, None)
}

/// A rectangle in the frame of the room, as a zone of the map.
pub(crate) fn zone(low: (f64, f64), high: (f64, f64)) -> Zone {
    let corners = [low, (high.0, low.1), high, (low.0, high.1)].map(|(x_m, y_m)| Point2 {
        x_m: x_m - START.x_m,
        y_m: y_m - START.y_m,
    });
    Zone::new(corners.to_vec()).expect("a rectangle")
}

pub(crate) struct Stage {
    pub(crate) brain: Brain,
    pub(crate) world: World,
}

impl Stage {
    pub(crate) fn new() -> Self {
        Self::with(config())
    }

    fn with(config: BrainConfig) -> Self {
        Self::in_home(config, &known(&flat()))
    }

    fn in_home(config: BrainConfig, home: &StoredMap) -> Self {
        let mut brain = Brain::with_map(config, 1, home);
        let mut world = World::new(flat(), START);
        run(&mut world, &mut brain, None, 1.0);
        Self { brain, world }
    }

    /// Gives an order and lets the robot work until it is idle; gives the seconds that took.
    fn clean(&mut self, order: &CleaningOrder) -> f64 {
        let command = JobCommand::CleanParts { order: order.clone() };
        assert_eq!(self.brain.admit(&command), Ok(()));
        run(&mut self.world, &mut self.brain, Some(command), 10.0);
        let mut seconds = 10.0;
        while self.brain.status().state != BehaviorState::Idle && seconds < 3_000.0 {
            run(&mut self.world, &mut self.brain, None, 1.0);
            seconds += 1.0;
        }
        assert_eq!(self.world.violations, Vec::<String>::new());
        seconds
    }

    /// Where the robot truly is, in the frame of its map.
    pub(crate) fn place(&self) -> Point2 {
        Point2 {
            x_m: self.world.pose.x_m - START.x_m,
            y_m: self.world.pose.y_m - START.y_m,
        }
    }

    /// Share of a rectangle of the room that was swept.
    fn swept(&self, low: (f64, f64), high: (f64, f64)) -> f64 {
        let places: Vec<Point2> = (0..20)
            .flat_map(|x| (0..20).map(move |y| (f64::from(x) + 0.5, f64::from(y) + 0.5)))
            .map(|(x, y)| Point2 {
                x_m: low.0 + x / 20.0 * (high.0 - low.0) - START.x_m,
                y_m: low.1 + y / 20.0 * (high.1 - low.1) - START.y_m,
            })
            .collect();
        let swept = places.iter().filter(|place| self.brain.map().is_swept(**place));
        swept.count() as f64 / places.len() as f64
    }
}

#[test]
fn a_zone_is_cleaned_and_little_else() {
    let mut stage = Stage::new();
    let order = CleaningOrder::new(vec![HomePart::Zone(zone((3.5, 0.5), (5.5, 2.5)))], 1).unwrap();
    stage.clean(&order);
    assert_eq!(stage.brain.status().reason, Reason::Finished);
    assert!(stage.swept((3.5, 0.5), (5.5, 2.5)) > 0.95);
    assert!(stage.swept((0.2, 2.5), (2.8, 3.8)) < 0.1, "nobody asked for this");
}

/// A place in the frame of the room, as a spot of the map.
fn spot(x_m: f64, y_m: f64) -> HomePart {
    HomePart::Spot(Point2 {
        x_m: x_m - START.x_m,
        y_m: y_m - START.y_m,
    })
}

#[test]
fn a_spot_in_the_other_room_is_cleaned_to_its_rim_and_little_else() {
    let mut stage = Stage::new();
    let order = CleaningOrder::new(vec![spot(4.6, 2.0)], 1).unwrap();
    let expected = stage.brain.estimate_order(&order).unwrap();
    assert!((expected.floor_m2 - 0.785).abs() < 0.05, "{expected:?}");
    stage.clean(&order);
    assert_eq!(stage.brain.status().reason, Reason::Finished);
    // The largest square in the disc.
    assert!(stage.swept((4.25, 1.65), (4.95, 2.35)) > 0.95);
    assert!(stage.swept((3.3, 2.9), (5.9, 3.8)) < 0.1, "nobody asked for this");
    assert!(stage.swept((0.2, 2.5), (2.8, 3.8)) < 0.1, "nor for this");
    for nowhere in [spot(20.0, 0.0), spot(f64::NAN, 1.0)] {
        let order = CleaningOrder::new(vec![nowhere], 1).unwrap();
        let refused = stage.brain.admit(&JobCommand::CleanParts { order });
        assert_eq!(refused, Err(EditError::NoFloorThere.into()));
    }
}

#[test]
fn the_room_that_it_is_in_is_reported() {
    let mut stage = Stage::new();
    let home = stage.brain.room();
    assert!(home.is_some());
    let order = CleaningOrder::new(vec![HomePart::Zone(zone((4.0, 0.5), (5.5, 2.0)))], 1).unwrap();
    run(
        &mut stage.world,
        &mut stage.brain,
        Some(JobCommand::CleanParts { order }),
        10.0,
    );
    let mut seconds = 0;
    while stage.brain.room() == home && seconds < 60 {
        run(&mut stage.world, &mut stage.brain, None, 1.0);
        seconds += 1;
    }
    let other = stage.brain.room();
    assert!(other.is_some() && other != home, "{other:?} after {seconds} s");
    assert!(stage.world.pose.x_m > 2.9, "it is in the other room");
}

#[test]
fn parts_are_cleaned_in_their_order() {
    let (first, second) = (zone((4.0, 2.6), (5.8, 3.8)), zone((0.3, 0.3), (2.0, 1.8)));
    let order = CleaningOrder::new(vec![HomePart::Zone(first), HomePart::Zone(second)], 1).unwrap();
    let mut stage = Stage::new();
    let command = JobCommand::CleanParts { order };
    run(&mut stage.world, &mut stage.brain, Some(command), 10.0);
    while stage.swept((4.0, 2.6), (5.8, 3.8)) < 0.9 {
        run(&mut stage.world, &mut stage.brain, None, 1.0);
        assert!(stage.brain.status().state != BehaviorState::Idle);
        assert!(
            stage.swept((0.3, 0.3), (2.0, 1.8)) < 0.5,
            "the second part comes second"
        );
    }
    while stage.brain.status().state != BehaviorState::Idle {
        run(&mut stage.world, &mut stage.brain, None, 1.0);
    }
    assert!(stage.swept((0.3, 0.3), (2.0, 1.8)) > 0.95);
}

#[test]
fn a_room_is_cleaned_by_its_identity_and_others_are_not_known() {
    let mut stage = Stage::new();
    let rooms = stage.brain.map().rooms().rooms().to_vec();
    assert_eq!(rooms.len(), 2, "{rooms:?}");
    let other = rooms.iter().find(|room| room.middle.x_m > 2.0).unwrap();
    let order = CleaningOrder::new(vec![HomePart::Room(other.id)], 1).unwrap();
    stage.clean(&order);
    assert!(stage.swept((3.4, 0.3), (5.9, 3.7)) > 0.93);
    assert!(stage.swept((0.2, 2.5), (2.0, 3.8)) < 0.1);
    let nowhere = CleaningOrder::new(vec![HomePart::Room(99)], 1).unwrap();
    let command = JobCommand::CleanParts { order: nowhere };
    assert_eq!(stage.brain.admit(&command), Err(EditError::NoSuchRoom.into()));
    let outside = CleaningOrder::new(vec![HomePart::Zone(zone((20.0, 0.0), (21.0, 1.0)))], 1).unwrap();
    let command = JobCommand::CleanParts { order: outside };
    assert_eq!(stage.brain.admit(&command), Err(EditError::NoFloorThere.into()));
}

#[test]
fn a_second_pass_takes_as_long_again_and_the_estimate_knows() {
    let part = || vec![HomePart::Zone(zone((0.2, 0.2), (2.8, 3.8)))];
    let once = CleaningOrder::new(part(), 1).unwrap();
    let twice = CleaningOrder::new(part(), 2).unwrap();
    let (mut one, mut two) = (Stage::new(), Stage::new());
    let expected = one.brain.estimate_order(&once).unwrap();
    assert!((expected.floor_m2 - 2.6 * 3.6).abs() < 0.5, "{expected:?}");
    let (once_s, twice_s) = (one.clean(&once), two.clean(&twice));
    assert!(
        (1.6..2.4).contains(&(twice_s / once_s)),
        "{once_s} s and {twice_s} s"
    );
    assert!(
        (0.6..1.5).contains(&(expected.time_s / once_s)),
        "{once_s} s instead of {expected:?}"
    );
    let doubled = two.brain.estimate_order(&twice).unwrap();
    assert!(doubled.time_s > 1.8 * expected.time_s);
}

#[test]
fn the_estimate_tells_charge_and_share() {
    let stage = Stage::new();
    let part = || vec![HomePart::Zone(zone((0.2, 0.2), (2.8, 3.8)))];
    let estimates: Vec<_> = [1, 3]
        .map(|passes| CleaningOrder::new(part(), passes).unwrap())
        .iter()
        .map(|order| stage.brain.estimate_order(order).unwrap())
        .collect();
    for estimate in &estimates {
        assert!(estimate.charge > 0.0 && estimate.charge < 1.0, "{estimate:?}");
        assert!(
            estimate.share_low <= estimate.share && estimate.share <= 1.0,
            "{estimate:?}"
        );
        assert!(estimate.share_low > 0.8, "{estimate:?}");
    }
    assert!(estimates[1].charge > 2.0 * estimates[0].charge);
    assert!(estimates[1].share_low > estimates[0].share_low);
}

#[test]
fn an_estimate_in_steps_is_the_same_and_whoever_asks_for_it_can_serve_others_in_between() {
    let stage = Stage::new();
    let parts = (0..16)
        .map(|_| HomePart::Zone(zone((0.2, 0.2), (2.8, 3.8))))
        .collect();
    let order = CleaningOrder::new(parts, 3).unwrap();
    let mut work = stage.brain.begin_estimate(&order);
    let (mut steps, mut made) = (0, None);
    while made.is_none() {
        steps += 1;
        made = work.go_on();
    }
    assert_eq!(made, Some(stage.brain.estimate_order(&order)));
    assert!(steps > 16, "at least one for each part: {steps}");
}

/// The flat with a dock at the left wall.
fn known_with_dock() -> StoredMap {
    let dock = Pose2 {
        x_m: 0.2 - START.x_m,
        y_m: 2.0 - START.y_m,
        heading_rad: core::f64::consts::PI,
    };
    known(&flat()).with_dock_location(DockLocation::converged(dock))
}

/// Steps of an estimate and what it says.
fn steps_of(brain: &Brain, order: &CleaningOrder) -> (u32, Result<JobEstimate, OrderRefusal>) {
    let mut work = brain.begin_estimate(order);
    for steps in 1.. {
        if let Some(made) = work.go_on() {
            return (steps, made);
        }
    }
    unreachable!("there are more steps than it takes")
}

#[test]
fn whether_an_order_can_be_carried_out_is_found_in_steps_as_well() {
    let mut stage = Stage::in_home(config(), &known_with_dock());
    let order = CleaningOrder::new(vec![HomePart::Zone(zone((3.5, 0.5), (5.5, 3.5)))], 1).unwrap();
    let avoid: Vec<NoGo> = (0..16)
        .map(|place| wall((0.4, 3.0), (0.5 + 0.05 * f64::from(place), 3.4)))
        .collect();
    let (plain, _) = steps_of(&stage.brain, &order);
    let (careful, made) = steps_of(&stage.brain, &order.clone().avoiding(avoid).unwrap());
    assert!(made.is_ok(), "{made:?}");
    assert!(
        careful >= plain + 2,
        "what is left without the places to avoid is found in steps of its own: {plain}, {careful}"
    );
    forbid(&mut stage, in_doorway());
    let (refused, made) = steps_of(&stage.brain, &order);
    assert_eq!(
        made.map_err(|refusal| refusal.reason),
        Err(JobRefusal::NoGoInTheWay)
    );
    assert!(
        refused > 4,
        "each barrier is tried in a step of its own: {refused}"
    );
}

#[test]
fn the_estimate_counts_recharges_from_what_the_pack_holds() {
    let mut stage = Stage::new();
    let order = CleaningOrder::new(vec![HomePart::Zone(zone((0.2, 0.2), (2.8, 3.8)))], 3).unwrap();
    let mut recharges_with = |charge| {
        stage.world.observation.battery_charge = charge;
        run(&mut stage.world, &mut stage.brain, None, 0.1);
        stage.brain.estimate_order(&order).unwrap().recharges
    };
    assert_eq!(
        recharges_with(None),
        0,
        "a pack that tells nothing is taken to be charged"
    );
    assert_eq!(recharges_with(Some(1.0)), 0);
    assert_eq!(recharges_with(Some(0.2)), 1);
}

pub(crate) fn forbid(stage: &mut Stage, no_go: NoGo) {
    let adding = MapEdit::NoGo(NoGoEdit::Add(no_go));
    assert_eq!(stage.brain.map().admit(&adding), Ok(()));
    edit(&mut stage.world, &mut stage.brain, adding);
}

#[test]
fn no_way_leads_into_a_forbidden_zone_until_it_is_allowed_again() {
    let mut stage = Stage::new();
    let rooms = stage.brain.map().rooms().clone();
    forbid(&mut stage, NoGo::zone(&zone((1.5, 2.0), (2.5, 3.0))).unwrap());
    let wall = NoGo::wall(Point2 { x_m: 2.05, y_m: 0.2 }, Point2 { x_m: 2.05, y_m: 1.7 }).unwrap();
    forbid(&mut stage, wall);
    stage.clean(&CleaningOrder::default());
    assert!(stage.swept((1.5, 2.0), (2.5, 3.0)) < 0.05);
    assert!(
        stage.swept((3.3, 0.3), (5.9, 3.7)) < 0.05,
        "a wall stands in the door"
    );
    assert!(stage.swept((0.2, 0.2), (1.3, 3.8)) > 0.9);
    let removal = MapEdit::NoGo(NoGoEdit::Remove { number: 2 });
    assert_eq!(stage.brain.map().admit(&removal), Ok(()));
    edit(&mut stage.world, &mut stage.brain, removal.clone());
    assert_eq!(stage.brain.map().admit(&removal), Err(EditError::NoSuchNoGo));
    stage.clean(&CleaningOrder::default());
    assert!(stage.swept((3.4, 0.3), (5.9, 3.7)) > 0.9);
    let cells = (0..40).map(|step| {
        Cell::under(Point2 {
            x_m: 0.5 + f64::from(step) * CELL_M,
            y_m: 1.5,
        })
    });
    for cell in cells {
        assert_eq!(
            stage.brain.map().knowledge().get(cell),
            Some(&CellKnowledge::NoGo)
        );
    }
    assert_eq!(stage.brain.map().rooms().rooms().len(), rooms.rooms().len());
}

#[test]
fn what_people_say_of_a_home_is_stored_with_it_and_goes_on_in_the_next_run() {
    let mut stage = Stage::new();
    let room = stage.brain.map().rooms().rooms()[0].id;
    let third = 1.0 / 3.0;
    let wall = NoGo::wall(Point2 { x_m: third, y_m: 0.5 }, Point2 { x_m: 1.0, y_m: 0.5 }).unwrap();
    forbid(&mut stage, wall.clone());
    forbid(&mut stage, NoGo::zone(&zone((1.5, 2.0), (2.5, 3.0))).unwrap());
    let name = RoomName::new("Köök").unwrap();
    let naming = MapEdit::Room(RoomEdit::Name {
        room,
        name: Some(name.clone()),
    });
    edit(&mut stage.world, &mut stage.brain, naming);
    let removal = MapEdit::NoGo(NoGoEdit::Remove { number: 2 });
    edit(&mut stage.world, &mut stage.brain, removal);

    let stored = stage.brain.map().stored();
    let back = StoredMap::from_parts(stored.parts()).unwrap();
    assert_eq!(back, stored, "equal bit for bit, or a replay would differ");
    let mut again = Brain::with_map(config(), 1, &back);
    let words = again.map().annotations();
    assert_eq!(words.no_go().collect::<Vec<_>>(), [(1, &wall)]);
    assert_eq!(words.name(room), Some(&name));
    let beside = CleaningOrder::new(vec![HomePart::Room(room)], 1).unwrap();
    assert!(again.estimate_order(&beside).is_ok());
    let mut world = World::new(flat(), START);
    forbid_again(&mut again, &mut world, &wall);
}

#[test]
fn an_edit_is_answered_once() {
    let mut stage = Stage::new();
    let wall = NoGo::wall(Point2 { x_m: 0.3, y_m: 0.5 }, Point2 { x_m: 1.0, y_m: 0.5 }).unwrap();
    let named = wall.with_name(RoomName::new("Vase").ok());
    let removal = || MapEdit::NoGo(NoGoEdit::Remove { number: 1 });
    for (asked, decisions, answer) in [
        (MapEdit::NoGo(NoGoEdit::Add(named)), vec![], Ok(())),
        (removal(), vec![], Ok(())),
        (
            removal(),
            vec![("edit-refused", "no-such-no-go")],
            Err(EditError::NoSuchNoGo),
        ),
    ] {
        let actions = stage.brain.step(&stage.world.observation, &[asked.into()]);
        let made: Vec<_> = actions
            .decisions
            .iter()
            .map(|made| (made.kind.name(), made.cause.name()))
            .collect();
        assert_eq!(made, decisions);
        assert_eq!(actions.edits, [answer]);
    }
}

/// A number is not given a second time.
fn forbid_again(brain: &mut Brain, world: &mut World, wall: &NoGo) {
    edit(world, brain, MapEdit::NoGo(NoGoEdit::Add(wall.clone())));
    let numbers: Vec<u16> = brain
        .map()
        .annotations()
        .no_go()
        .map(|(number, _)| number)
        .collect();
    assert_eq!(numbers, [1, 3]);
}

#[test]
fn a_room_that_is_set_so_is_cleaned_twice_when_a_job_names_it() {
    let mut once = Stage::new();
    let rooms = once.brain.map().rooms().rooms();
    let small = rooms
        .iter()
        .min_by(|one, other| one.area_m2.total_cmp(&other.area_m2));
    let room = small.expect("two rooms").id;
    let order = CleaningOrder::new(vec![HomePart::Room(room)], 1).unwrap();
    let once_s = once.clean(&order);
    let mut twice = Stage::new();
    let settings = RoomSettings::new(2, RoomPower::FULL).ok();
    let set = |room| MapEdit::Room(RoomEdit::Set { room, settings });
    edit(&mut twice.world, &mut twice.brain, set(room));
    let stored = twice.brain.map().stored();
    assert_eq!(stored.annotations().settings(room).copied(), settings);
    let twice_s = twice.clean(&order);
    assert!(twice_s > 1.6 * once_s, "{twice_s} s and {once_s} s");
    assert_eq!(twice.brain.map().admit(&set(99)), Err(EditError::NoSuchRoom));
}

#[test]
fn edits_that_make_no_sense_are_refused_by_name() {
    let mut stage = Stage::new();
    let ids: Vec<u16> = stage
        .brain
        .map()
        .rooms()
        .rooms()
        .iter()
        .map(|room| room.id)
        .collect();
    let outside = NoGo::zone(&zone((20.0, 0.0), (21.0, 1.0))).unwrap();
    let name = |room, text: &str| {
        MapEdit::Room(RoomEdit::Name {
            room,
            name: Some(RoomName::new(text).unwrap()),
        })
    };
    edit(&mut stage.world, &mut stage.brain, name(ids[0], "Hall"));
    for (refused, error) in [
        (MapEdit::NoGo(NoGoEdit::Add(outside)), EditError::NoFloorThere),
        (
            MapEdit::NoGo(NoGoEdit::Remove { number: 1 }),
            EditError::NoSuchNoGo,
        ),
        (name(99, "Attic"), EditError::NoSuchRoom),
        (name(ids[1], "hall"), EditError::NameTaken),
    ] {
        assert_eq!(stage.brain.map().admit(&refused), Err(error), "{refused:?}");
        // One that is sent all the same changes nothing.
        let before = stage.brain.map().annotations().clone();
        edit(&mut stage.world, &mut stage.brain, refused);
        assert_eq!(stage.brain.map().annotations(), &before);
    }
    let dock = stage
        .brain
        .map()
        .stored()
        .with_dock_location(DockLocation::converged(Pose2::IDENTITY));
    let brain = Brain::with_map(config(), 1, &dock);
    let around = NoGo::zone(&zone((0.9, 0.9), (1.1, 1.1))).unwrap();
    assert_eq!(
        brain.map().admit(&MapEdit::NoGo(NoGoEdit::Add(around))),
        Err(EditError::DockInside)
    );
}

#[test]
fn a_job_keeps_out_of_what_it_was_told_to_avoid_and_the_next_one_does_not() {
    let (low, high) = ((4.2, 1.0), (5.2, 3.0));
    let avoid = NoGo::zone(&zone(low, high)).expect("a rectangle");
    let whole = CleaningOrder::default();
    let order = whole.clone().avoiding(vec![avoid]).expect("one place");
    let mut stage = Stage::new();
    let floor_m2 = |stage: &Stage, order| stage.brain.estimate_order(order).expect("a plan").floor_m2;
    assert!(floor_m2(&stage, &order) < floor_m2(&stage, &whole) - 2.0);
    stage.clean(&order);
    assert_eq!(stage.brain.status().reason, Reason::Finished);
    assert!(stage.swept(low, high) < 0.3, "{}", stage.swept(low, high));
    assert!(stage.swept((0.3, 0.3), (2.7, 3.7)) > 0.95, "the rest is cleaned");
    let rooms = stage.brain.map().rooms().rooms().len();
    assert_eq!(rooms, 2, "what a job avoids divides no room");
    stage.clean(&whole);
    assert!(stage.swept(low, high) > 0.9, "{}", stage.swept(low, high));
}

#[test]
fn a_job_that_is_taken_up_again_still_avoids() {
    let mut stage = Stage::new();
    let avoid = NoGo::zone(&zone((4.2, 1.0), (5.2, 3.0))).expect("a rectangle");
    let order = CleaningOrder::default().avoiding(vec![avoid]).expect("one place");
    run(
        &mut stage.world,
        &mut stage.brain,
        Some(JobCommand::CleanParts { order }),
        20.0,
    );
    let mut successor = Brain::new(config(), 7);
    successor.restore(&stage.brain.checkpoint());
    stage.brain = successor;
    let mut seconds = 0.0;
    while stage.brain.status().state != BehaviorState::Idle && seconds < 3_000.0 {
        run(&mut stage.world, &mut stage.brain, None, 1.0);
        seconds += 1.0;
    }
    assert!(stage.swept((4.2, 1.0), (5.2, 3.0)) < 0.3);
    assert!(stage.swept((0.3, 0.3), (2.7, 3.7)) > 0.9);
}

/// A virtual wall between two places of the room.
fn wall(from: (f64, f64), to: (f64, f64)) -> NoGo {
    let [from, to] = [from, to].map(|(x_m, y_m)| Point2 {
        x_m: x_m - START.x_m,
        y_m: y_m - START.y_m,
    });
    NoGo::wall(from, to).expect("two places")
}

/// What estimate and admission say of a zone, which must be the same.
fn judged(brain: &Brain, order: CleaningOrder) -> Result<(), JobRefusal> {
    let estimated = brain.estimate_order(&order).map(|_| ());
    let estimated = estimated.map_err(|refusal| refusal.reason);
    let admitted = brain.admit(&JobCommand::CleanParts { order });
    assert_eq!(estimated, admitted);
    admitted
}

#[test]
fn estimate_and_admission_are_one_judgement_that_names_what_shuts_floor_off() {
    let other_room = |avoid: Vec<NoGo>| {
        let part = HomePart::Zone(zone((3.5, 0.5), (5.5, 3.5)));
        CleaningOrder::new(vec![part], 1)
            .unwrap()
            .avoiding(avoid)
            .unwrap()
    };
    let stage = Stage::new();
    assert_eq!(judged(&stage.brain, other_room(Vec::new())), Ok(()));
    // Across the door, and so that a crumb beside the door is left.
    let across = [
        (wall((3.05, 1.3), (3.05, 2.6)), JobRefusal::VirtualWallInTheWay),
        (wall((3.55, 0.0), (3.55, 4.0)), JobRefusal::VirtualWallInTheWay),
        (in_doorway(), JobRefusal::NoGoInTheWay),
        (over_wall_and_door(), JobRefusal::NoGoInTheWay),
    ];
    for (no_go, refusal) in across {
        let mut stage = Stage::new();
        forbid(&mut stage, wall((0.3, 3.2), (0.8, 3.2)));
        forbid(&mut stage, no_go.clone());
        for place in 1..6 {
            let x_m = 0.4 * f64::from(place);
            forbid(&mut stage, wall((x_m, 3.2), (x_m + 0.2, 3.3)));
        }
        let order = other_room(Vec::new());
        let told = stage.brain.estimate_order(&order).expect_err("shut off");
        assert_eq!(told.in_the_way, [2]);
        assert_eq!(told, stage.brain.order_refusal(refusal, &order));
        assert_eq!(judged(&stage.brain, order), Err(refusal), "{no_go:?}");
        let stage = Stage::new();
        assert_eq!(judged(&stage.brain, other_room(vec![no_go])), Err(refusal));
    }
    let shut = Room::empty((6.1, 4.0)).with(&[Rectangle::new((3.0, 0.0), (3.1, 4.0))]);
    let mut brain = Brain::with_map(config(), 1, &known(&shut));
    run(&mut World::new(shut, START), &mut brain, None, 1.0);
    assert_eq!(
        judged(&brain, other_room(Vec::new())),
        Err(JobRefusal::RestOutOfReach)
    );
}

fn in_doorway() -> NoGo {
    NoGo::zone(&zone((2.9, 1.3), (3.3, 2.6))).expect("a zone")
}

/// What lies under it is a wall, or floor in a door: without the zone only the door would be open.
fn over_wall_and_door() -> NoGo {
    NoGo::zone(&zone((2.8, 0.2), (3.4, 3.8))).expect("a zone")
}

/// A zone over a wall shuts off nothing that would be open without it.
#[test]
fn a_zone_over_a_wall_is_not_what_is_in_the_way() {
    let shut = Room::empty((6.1, 4.0)).with(&[Rectangle::new((3.0, 0.0), (3.1, 4.0))]);
    let mut brain = Brain::with_map(config(), 1, &known(&shut));
    let mut world = World::new(shut, START);
    run(&mut world, &mut brain, None, 1.0);
    edit(
        &mut world,
        &mut brain,
        MapEdit::NoGo(NoGoEdit::Add(over_wall_and_door())),
    );
    let part = HomePart::Zone(zone((4.0, 0.5), (5.5, 3.5)));
    let order = CleaningOrder::new(vec![part], 1).unwrap();
    let asked = brain.order_refusal(JobRefusal::NoGoInTheWay, &order);
    assert_eq!(asked.in_the_way, []);
    assert_eq!(judged(&brain, order), Err(JobRefusal::RestOutOfReach));
}

/// How a job for the far end of the other room ends in a home in which this stands since the map was made.
fn end_with(standing: Rectangle) -> Reason {
    let now = flat().with(&[standing]);
    let mut stage = Stage {
        world: World::new(now, START),
        brain: Brain::with_map(config(), 1, &known(&flat())),
    };
    run(&mut stage.world, &mut stage.brain, None, 1.0);
    let part = HomePart::Zone(zone((4.5, 0.5), (5.8, 3.5)));
    stage.clean(&CleaningOrder::new(vec![part], 1).expect("a lawful zone"));
    stage.brain.status().reason
}

#[test]
fn a_shut_door_and_a_thing_that_is_new_are_told_apart() {
    let door = Rectangle::new((3.0, 1.5), (3.1, 2.4));
    assert_eq!(end_with(door), Reason::DoorShut);
    let shelf = Rectangle::new((4.0, 0.0), (4.1, 4.0));
    assert_eq!(end_with(shelf), Reason::NewObstacleInTheWay);
}

/// The whole home is asked for, and most of it is behind a wall that somebody drew.
#[test]
fn a_job_for_the_whole_home_that_swept_less_than_half_is_not_finished() {
    let mut stage = Stage::new();
    forbid(&mut stage, wall((2.3, 0.0), (2.3, 4.0)));
    stage.clean(&CleaningOrder::default());
    assert!(stage.swept((0.2, 0.2), (2.1, 3.8)) > 0.9);
    assert_eq!(stage.brain.status().reason, Reason::VirtualWallInTheWay);
}

#[test]
fn a_job_that_finds_its_floor_shut_off_is_not_finished() {
    let mut stage = Stage::new();
    let part = HomePart::Zone(zone((3.5, 0.5), (5.5, 3.5)));
    let order = CleaningOrder::new(vec![part], 1).unwrap();
    let command = JobCommand::CleanParts { order };
    run(&mut stage.world, &mut stage.brain, Some(command), 4.0);
    forbid(&mut stage, wall((3.05, 1.3), (3.05, 2.6)));
    let mut seconds = 0;
    while stage.brain.status().state != BehaviorState::Idle && seconds < 600 {
        run(&mut stage.world, &mut stage.brain, None, 1.0);
        seconds += 1;
    }
    assert_eq!(stage.brain.status().reason, Reason::VirtualWallInTheWay);
}

/// A robot that has cleaned its home for half a minute.
fn half_a_minute_at_work() -> Stage {
    let mut stage = Stage::new();
    let order = CleaningOrder::default();
    run(
        &mut stage.world,
        &mut stage.brain,
        Some(JobCommand::CleanParts { order }),
        30.0,
    );
    stage
}

/// A zone around the working robot: out of it on the shortest way, then on with the job.
#[test]
fn a_zone_drawn_around_the_robot_leads_it_out_first() {
    let mut stage = half_a_minute_at_work();
    let here = (stage.world.pose.x_m, stage.world.pose.y_m);
    // The nearest edge lies 0.6 m to the right; elsewhere it is farther.
    let (low, high) = ((here.0 - 0.9, here.1 - 0.9), (here.0 + 0.6, here.1 + 0.9));
    let low = (low.0.max(0.0), low.1.max(0.0));
    let area = zone(low, high);
    forbid(&mut stage, NoGo::zone(&area).unwrap());
    let inside_m = inside_m_until_idle(&mut stage, &area);
    assert_eq!(stage.brain.status().reason, Reason::Finished);
    assert!(inside_m < 1.2, "{inside_m} m inside; 0.6 m would lead out");
    assert!(
        stage.swept((3.4, 0.3), (5.9, 3.7)) > 0.9,
        "the other room is swept"
    );
}

/// Lets the robot work until it is idle; gives the metres that it drove within an area.
fn inside_m_until_idle(stage: &mut Stage, area: &Zone) -> f64 {
    let mut inside_m = 0.0;
    let mut before = stage.place();
    let mut tenths = 0;
    while stage.brain.status().state != BehaviorState::Idle && tenths < 30_000 {
        run(&mut stage.world, &mut stage.brain, None, 0.1);
        let now = stage.place();
        if area.contains(now) {
            inside_m += now.distance_m(before);
        }
        before = now;
        tenths += 1;
    }
    inside_m
}

/// A map comes back in which the robot stands on forbidden floor: no job was running when that was drawn.
#[test]
fn a_robot_that_wakes_in_a_forbidden_zone_leaves_it_and_cleans_the_rest() {
    let area = zone((0.4, 0.4), (1.6, 1.6));
    let mut drawn = Stage::new();
    forbid(&mut drawn, NoGo::zone(&area).unwrap());
    let mut stage = Stage::new();
    stage.brain = Brain::with_map(config(), 1, &drawn.brain.map().stored());
    run(&mut stage.world, &mut stage.brain, None, 1.0);
    assert!(area.contains(stage.place()));
    let command = JobCommand::CleanParts {
        order: CleaningOrder::default(),
    };
    assert_eq!(stage.brain.admit(&command), Ok(()));
    run(&mut stage.world, &mut stage.brain, Some(command), 5.0);
    let inside_m = inside_m_until_idle(&mut stage, &area);
    assert_eq!(stage.brain.status().reason, Reason::Finished);
    assert!(inside_m < 1.2, "{inside_m} m inside; 0.6 m leads out");
    assert!(stage.swept((3.4, 0.3), (5.9, 3.7)) > 0.9);
}

/// A virtual wall is drawn through the working robot: it has a side of it afterwards, and goes on there.
#[test]
fn a_virtual_wall_drawn_through_the_robot_does_not_end_its_job() {
    let mut stage = half_a_minute_at_work();
    let (x_m, y_m) = (stage.world.pose.x_m, stage.world.pose.y_m);
    forbid(&mut stage, wall((x_m - 0.5, y_m), (x_m + 0.5, y_m)));
    inside_m_until_idle(&mut stage, &zone((0.0, 0.0), (6.1, 4.0)));
    assert_eq!(stage.brain.status().reason, Reason::Finished);
    assert!(
        stage.swept((3.4, 0.3), (5.9, 3.7)) > 0.9,
        "the other room is swept"
    );
}

#[test]
fn the_way_to_the_dock_stays_open() {
    let brain = Brain::with_map(config(), 1, &known_with_dock());
    let admit = |no_go: NoGo| brain.map().admit(&MapEdit::NoGo(NoGoEdit::Add(no_go)));
    let box_before =
        |near_m: f64, far_m: f64| NoGo::zone(&zone((0.2 + near_m, 1.6), (0.2 + far_m, 2.4))).unwrap();
    assert_eq!(admit(box_before(0.25, 0.8)), Err(EditError::DockInside));
    assert_eq!(admit(box_before(0.6, 0.9)), Err(EditError::DockInside));
    assert_eq!(admit(wall((1.5, 0.0), (1.5, 4.0))), Err(EditError::DockShutOff));
    assert_eq!(
        admit(wall((3.05, 1.3), (3.05, 2.6))),
        Ok(()),
        "it keeps half of the floor"
    );
    assert_eq!(admit(box_before(1.3, 1.8)), Ok(()));
}

#[test]
fn a_map_that_comes_back_gives_no_number_again() {
    let plain = known(&flat());
    let mut later = plain.parts();
    (later.next_room, later.no_go.next, later.places.next) = (9, 5, 7);
    later.room_changes.next = 3;
    let later = StoredMap::from_parts(later).expect("a map");
    let back = plain.numbered_after(later.next_numbers()).parts();
    assert_eq!(
        (
            back.next_room,
            back.no_go.next,
            back.places.next,
            back.room_changes.next
        ),
        (9, 5, 7, 3)
    );
    let kept = later
        .clone()
        .numbered_after(known(&flat()).next_numbers())
        .parts();
    assert_eq!(kept.next_room, 9);
}

#[test]
fn brushes_rest_on_the_way_through_a_room_that_nobody_chose() {
    let mut stage = Stage::new();
    let part = HomePart::Zone(zone((4.0, 0.5), (5.5, 2.0)));
    let order = CleaningOrder::new(vec![part], 1).unwrap();
    stage.clean(&order);
    assert!(stage.swept((4.0, 0.5), (5.5, 2.0)) > 0.9);
    assert_eq!(stage.swept((0.2, 0.2), (2.8, 3.8)), 0.0, "nobody asked for this");
}

impl Stage {
    /// Square metres of a rectangle of the room over which brushes truly ran.
    fn brushed_m2(&self, low: (f64, f64), high: (f64, f64)) -> f64 {
        let columns = (self.world.room.size_m.0 / CELL_M) as usize;
        let is_inside = |index: usize| {
            let x_m = (index % columns) as f64 * CELL_M;
            let y_m = (index / columns) as f64 * CELL_M;
            (low.0..high.0).contains(&x_m) && (low.1..high.1).contains(&y_m)
        };
        let swept = self.world.swept.iter().enumerate();
        let count = swept
            .filter(|(index, swept)| **swept && is_inside(*index))
            .count();
        count as f64 * CELL_M * CELL_M
    }

    fn until(&mut self, longest_s: u32, is_so: impl Fn(&Self) -> bool) -> bool {
        (0..longest_s * 5).any(|_| {
            run(&mut self.world, &mut self.brain, None, 0.2);
            is_so(self)
        })
    }
}

/// Whatever happens on the way through a room that nobody chose, and on the way back to the room that somebody did.
#[test]
fn brushes_rest_in_a_room_that_nobody_chose_whatever_happens_on_the_way() {
    let (left, right) = (((0.0, 0.0), (2.7, 4.0)), ((3.3, 0.4), (5.8, 2.4)));
    let order = CleaningOrder::new(vec![HomePart::Zone(zone(right.0, right.1))], 1).unwrap();
    let told = |stage: &mut Stage, command: JobCommand| {
        assert_eq!(stage.brain.admit(&command), Ok(()), "{command:?}");
        run(&mut stage.world, &mut stage.brain, Some(command), 0.5);
    };
    let lifted = |stage: &mut Stage| {
        for _ in 0..100 {
            stage.world.observation.time_us += 20_000;
            stage.world.observation.inhibits.insert(Inhibit::WheelDrop);
            stage.brain.step(&stage.world.observation, &[]);
        }
        run(&mut stage.world, &mut stage.brain, None, 3.0);
    };
    let steered = |stage: &mut Stage| {
        let command = JobCommand::Manual {
            speed_m_per_s: 0.1,
            turn_rad_per_s: 0.0,
            valid_until_us: stage.world.observation.time_us + 400_000,
            cleaners: false,
        };
        told(stage, command);
        run(&mut stage.world, &mut stage.brain, None, 1.0);
        told(stage, JobCommand::ManualEnd);
    };
    type Event<'a> = (&'a str, &'a dyn Fn(&mut Stage));
    let events: [Event<'_>; 3] = [
        ("paused", &|stage| told(stage, JobCommand::Pause)),
        ("steered", &|stage| steered(stage)),
        ("lifted", &|stage| lifted(stage)),
    ];
    for at_part in [false, true] {
        for (what, event) in &events {
            let mut stage = Stage::new();
            told(&mut stage, JobCommand::CleanParts { order: order.clone() });
            let is_there = |stage: &Stage| match at_part {
                true => stage.brushed_m2(right.0, right.1) > 1.0,
                false => stage.brain.status().state == BehaviorState::Cleaning,
            };
            assert!(stage.until(200, is_there), "{what} {at_part}");
            event(&mut stage);
            if stage.brain.admit(&JobCommand::Resume).is_ok() {
                told(&mut stage, JobCommand::Resume);
            }
            stage.until(120, |stage| stage.brain.status().state == BehaviorState::Idle);
            assert_eq!(stage.brushed_m2(left.0, left.1), 0.0, "{what} {at_part}");
        }
    }
}

#[test]
fn a_job_gets_the_time_that_the_floor_of_its_home_takes() {
    let mut stage = Stage::with(BrainConfig {
        task_budget_s: 20.0,
        ..config()
    });
    let seconds = stage.clean(&CleaningOrder::default());
    assert!(seconds > 60.0, "{seconds} s");
    assert_ne!(stage.brain.status().reason.name(), "task-budget");
}
