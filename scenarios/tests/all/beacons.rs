//! Radio beacons on a virtual clock. A flat of two rooms is alike to a robot, turned by half a turn: what it sees cannot tell them
//! apart after somebody has carried it, and how strongly it receives beacons can. And a robot that has no gyro keeps its place by
//! how far beacons are.

use core::ops::RangeInclusive;
use std::sync::Arc;

use brain::command::StrategyName;
use brain::{KnownBeacon, PoseEstimate, StoredMap};
use home::{Beacons, Home, Noise, Pose, RobotModel};
use rvac_api::RequestBody;
use rvac_sim::run::{RunSettings, start_cleaning};
use rvac_sim::{Host, Household, Scene};
use scenarios::{Bounds, Draws, cleaning, free_place, household, relax, says, settings};

const MINUTE_MS: u64 = 60_000;
/// Beacons at the edges of the flat.
const BEACONS: usize = 4;
/// Two rooms of 3 m by 3.4 m with a door in the middle of the wall between them.
const TWINS: &str = "format = \"librervac-home\"\nversion = 1\nname = \"Twins\"\n\
    [[room]]\npolygon = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.4], [0.0, 3.4]]\n\
    [[room]]\npolygon = [[3.1, 0.0], [6.1, 0.0], [6.1, 3.4], [3.1, 3.4]]\n\
    [[wall]]\nfrom = [3.05, 0.0]\nto = [3.05, 3.4]\nthickness-m = 0.1\n\
    [[door]]\nfrom = [3.05, 1.25]\nto = [3.05, 2.15]\nstate = \"open\"\n";

fn twins() -> Scene {
    let model = RobotModel::by_name("sr8730").expect("the project's robot");
    let home = Home::from_floorplan("twins", TWINS, &model).expect("a plan");
    Scene::new(Arc::new(home), model, Noise::nominal())
}

/// A robot that knows the flat.
fn in_twins(scene: &Scene, seed: u64) -> Household {
    let settings = RunSettings {
        strategy: StrategyName::Systematic,
        ..settings(seed, 0)
    };
    household(scene, &settings).with_known_map()
}

/// It cleans in both rooms for so long.
const CLEANED_MS: u64 = 5 * MINUTE_MS;
/// A robot that was carried may look for its place for so long, seconds. Of twelve with beacons the slowest took 80 s, and of twelve without
/// the first one thought after 123 s that it knew.
const SOUGHT_S: u64 = 100;

/// Lets it clean, carries it to a place of the second room, and waits until it says that it knows its place; gives by how much that is wrong,
/// metres, or infinity when it does not know in time.
fn off_after_lifting_m(scene: &Scene, mut household: Household) -> f64 {
    start_cleaning(&mut household, StrategyName::Systematic);
    household.pass_ms(CLEANED_MS);
    household.robot_mut().world_mut().lift();
    household.pass_ms(3_000);
    household
        .robot_mut()
        .world_mut()
        .put_down_at(Pose::new(4.9, 0.8, 2.5));
    household.pass_ms(3_000);
    household.ask(RequestBody::Resume);
    household.pass_ms(1_000);
    let knows = household.pass_until(SOUGHT_S, |household| !estimate(household).lost);
    knows.map_or(f64::INFINITY, |_| off_m(scene, &household))
}

fn estimate(household: &Household) -> PoseEstimate {
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.estimate()
}

/// By how much the robot is wrong about its place, metres.
fn off_m(scene: &Scene, household: &Household) -> f64 {
    let truth = household.robot().world().truth().pose;
    let in_map = scene.home().start().inverse().then(truth);
    let pose = estimate(household).pose;
    Pose::new(pose.x_m, pose.y_m, pose.heading_rad).distance_m(in_map)
}

/// Nearer than this it knows its place, metres: between the rooms are three.
const NEAR_M: f64 = 0.25;
/// Robots that were carried, each by a seed of its own.
const CARRIED: RangeInclusive<u64> = 1..=6;

/// With strengths 24 of 24 knew their place; by sight alone one of 24 thought so in that time, and was wrong.
#[test]
fn strengths_of_beacons_tell_rooms_apart_that_look_the_same() {
    let scene = twins();
    let by_sight = Draws::of(CARRIED, |seed| {
        off_after_lifting_m(&scene, in_twins(&scene, seed))
    });
    let by_strength = Draws::of(CARRIED, |seed| {
        let beacons = scene.beacons(seed, BEACONS).by_strength();
        off_after_lifting_m(&scene, in_twins(&scene, seed).with_beacons(beacons))
    });
    assert!(
        by_sight.below(NEAR_M) <= 2,
        "they may not have known: {by_sight:?}"
    );
    assert!(by_strength.below(NEAR_M) >= 5, "{by_strength:?}");
}

/// Drivings by chance, and how long each takes.
const DRIVINGS: RangeInclusive<u64> = 1..=8;
const DRIVEN_MS: u64 = 6 * MINUTE_MS;
/// How often its place is compared with the true one.
const LOOK_MS: u64 = 1_000;
/// Metres by which a place by beacons is off in the last minute: in 16 drivings (four seeds, four phases) 0.31 in
/// the middle and 1.24 at most.
const HEARD_M: Bounds = Bounds {
    median: 0.7,
    worst: 2.0,
};
/// In the middle it is off by no more than this share of what it is by wheels alone, which was 0.87 m in 16 drivings.
const HEARD_SHARE: f64 = 0.75;

/// By how much a Relax that bounces about is wrong about its place, metres: the median of the last minute.
fn off_in_the_last_minute_m(scene: &Scene, seed: u64, beacons: usize) -> f64 {
    let mut household = cleaning(scene, seed).with_beacons(scene.beacons(seed, beacons));
    household.pass_ms(DRIVEN_MS - MINUTE_MS);
    let mut all_off_m: Vec<f64> = (0..MINUTE_MS / LOOK_MS)
        .map(|_| {
            household.pass_ms(LOOK_MS);
            off_m(scene, &household)
        })
        .collect();
    all_off_m.sort_by(f64::total_cmp);
    all_off_m[all_off_m.len() / 2]
}

#[test]
fn a_relax_without_gyro_keeps_its_place_by_how_far_beacons_are() {
    let scene = relax("two-room-flat");
    let off = |beacons| Draws::of(DRIVINGS, |seed| off_in_the_last_minute_m(&scene, seed, beacons));
    let (heard, alone) = (off(BEACONS), off(0));
    heard.assert_within("metres off with beacons", HEARD_M);
    assert!(
        heard.median() < HEARD_SHARE * alone.median(),
        "{heard:?}, without beacons {alone:?}"
    );
}

/// So long a Relax bounces before its home is kept.
const LOCATED_MS: u64 = 5 * MINUTE_MS;
/// Distances between kept beacons are wrong by less than this, metres.
const APART_M: f64 = 0.8;
/// In the next run the heading is known after so long, seconds: announcement, and the first decimetres away from the dock.
const KNOWN_SOON_S: u64 = 12;

/// Seconds until the robot knows its heading, of so many at most.
fn heading_after_s(household: &mut Household) -> Option<u64> {
    household.pass_until(120, |household| {
        let brain = household.host().and_then(Host::brain);
        brain.is_some_and(|brain| brain.usual_strategy() != StrategyName::Statistical)
    })
}

#[test]
fn the_next_run_begins_with_the_beacons_of_the_home() {
    let scene = relax("two-room-flat");
    for seed in 1..=3 {
        let mut first = cleaning(&scene, seed).with_beacons(scene.beacons(seed, BEACONS));
        first.pass_ms(LOCATED_MS);
        let kept = first
            .host()
            .and_then(Host::brain)
            .map(|brain| brain.map().stored())
            .expect("a brain");
        let beacons = scene.beacons(seed, BEACONS);
        let (places, known) = (beacons.places(), kept.beacons());
        assert_eq!(known.len(), BEACONS, "seed {seed}");
        // The whole picture may lie askew, and the map with it.
        for pair in known.windows(2) {
            let [one, other] = [&pair[0], &pair[1]].map(|known| places[usize::from(known.number)]);
            let true_m = (one.0 - other.0).hypot(one.1 - other.1);
            let told_m = pair[0].place.distance_m(pair[1].place);
            assert!(
                (told_m - true_m).abs() < APART_M,
                "seed {seed}: {told_m:.2} m between {pair:?}, {true_m:.2} m"
            );
        }
        let run = RunSettings {
            strategy: StrategyName::Systematic,
            ..settings(seed, 0)
        };
        let next = |household: Household| {
            let mut household = household.with_beacons(scene.beacons(seed, BEACONS));
            household.pass_ms(5_000);
            start_cleaning(&mut household, StrategyName::Systematic);
            heading_after_s(&mut household)
        };
        let anew = next(household(&scene, &run));
        let soon = next(household(&scene, &run).with_map(kept));
        assert!(soon.is_some_and(|after_s| after_s <= KNOWN_SOON_S), "{soon:?}");
        assert!(anew.is_none_or(|after_s| after_s > 2 * KNOWN_SOON_S), "{anew:?}");
    }
}

/// What a Relax keeps of the flat after a run.
fn kept_home(scene: &Scene, seed: u64) -> StoredMap {
    let mut first = cleaning(scene, seed).with_beacons(scene.beacons(seed, BEACONS));
    first.pass_ms(LOCATED_MS);
    let brain = first.host().and_then(Host::brain).expect("a brain");
    brain.map().stored()
}

/// The plan's frame in that of the kept beacons, which lies a little askew: the transform that fits best.
fn kept_from_plan(kept: &StoredMap, places: &[(f64, f64)]) -> Pose {
    let known = kept.beacons();
    let true_places: Vec<(f64, f64)> = known
        .iter()
        .map(|known| places[usize::from(known.number)])
        .collect();
    let kept_places: Vec<(f64, f64)> = known
        .iter()
        .map(|known| (known.place.x_m, known.place.y_m))
        .collect();
    let middle = |places: &[(f64, f64)]| {
        let each = 1.0 / places.len() as f64;
        places.iter().fold((0.0, 0.0), |sum, (x_m, y_m)| {
            (sum.0 + each * x_m, sum.1 + each * y_m)
        })
    };
    let (plan, told) = (middle(&true_places), middle(&kept_places));
    let (mut cross, mut dot) = (0.0, 0.0);
    for (place, known) in true_places.iter().zip(&kept_places) {
        let (px, py) = (place.0 - plan.0, place.1 - plan.1);
        let (kx, ky) = (known.0 - told.0, known.1 - told.1);
        cross += px * ky - py * kx;
        dot += px * kx + py * ky;
    }
    let turn = Pose::new(0.0, 0.0, cross.atan2(dot));
    let turned = turn.then(Pose::new(plan.0, plan.1, 0.0));
    Pose::new(told.0 - turned.x_m, told.1 - turned.y_m, turn.heading_rad)
}

/// The next run of a Relax that keeps this, between these beacons.
fn next_run(scene: &Scene, seed: u64, kept: &StoredMap, beacons: Beacons) -> Household {
    let mut household = household(scene, &settings(seed, 0))
        .with_map(kept.clone())
        .with_beacons(beacons);
    if let Some(host) = household.host_mut() {
        host.keep_log();
    }
    household
}

/// What is kept now.
fn kept_now(household: &Household) -> StoredMap {
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.map().stored()
}

/// By how much a kept beacon is elsewhere than it was before, metres; infinity if it is not kept any more.
fn shift_m(old: &KnownBeacon, now: &StoredMap) -> f64 {
    let new = now.beacons().iter().find(|new| new.number == old.number);
    new.map_or(f64::INFINITY, |new| new.place.distance_m(old.place))
}

/// By how much the robot is wrong about its place in the frame of the kept beacons, metres.
fn off_in_kept_m(household: &Household, kept_from_plan: Pose) -> f64 {
    let truth = kept_from_plan.then(household.robot().world().truth().pose);
    let pose = estimate(household).pose;
    Pose::new(pose.x_m, pose.y_m, pose.heading_rad).distance_m(truth)
}

/// Numbers of the beacons that it has told to be moved, in this order.
fn told_moved(household: &Household) -> Vec<u16> {
    let log = household.host().map_or(&[][..], Host::log);
    log.iter()
        .filter_map(|entry| entry.text.strip_prefix("forget-beacons (beacon-moved)"))
        // A value of 0 is not written.
        .map(|value| value.trim().parse::<f64>().unwrap_or(0.0) as u16)
        .collect()
}

/// Of a robot that was put elsewhere between two runs.
#[derive(Clone, Debug)]
struct PutElsewhere {
    /// Seconds from the command to drive until it knew its place.
    found_s: Option<u64>,
    /// By how much it is wrong then, and a minute later, metres.
    off_m: [f64; 2],
    has_searched: bool,
    told_moved: Vec<u16>,
    /// Farthest that a kept beacon is from where it was kept, metres.
    shifted_m: f64,
}

fn put_elsewhere(scene: &Scene, seed: u64) -> PutElsewhere {
    let kept = kept_home(scene, seed);
    let beacons = scene.beacons(seed, BEACONS);
    let kept_from_plan = kept_from_plan(&kept, beacons.places());
    let mut household = next_run(scene, seed, &kept, beacons);
    let world = household.robot_mut().world_mut();
    world.lift();
    world.put_down_at(free_place(scene.home(), seed));
    household.pass_ms(5_000);
    start_cleaning(&mut household, StrategyName::Bounce);
    let found_s = household.pass_until(120, |household| says(household, "place-found (beacons-agree)"));
    let at_once_m = off_in_kept_m(&household, kept_from_plan);
    household.pass_ms(MINUTE_MS);
    let now = kept_now(&household);
    let told = PutElsewhere {
        found_s,
        off_m: [at_once_m, off_in_kept_m(&household, kept_from_plan)],
        has_searched: says(&household, "search-place (place-contradicted)"),
        told_moved: told_moved(&household),
        shifted_m: kept
            .beacons()
            .iter()
            .map(|old| shift_m(old, &now))
            .fold(0.0, f64::max),
    };
    println!("seed {seed}: {told:?}");
    told
}

/// Robots that were put elsewhere, each by a seed of its own. Two of the eight stand where they need no search to know it.
const PUT_ELSEWHERE: RangeInclusive<u64> = 1..=8;
/// A robot that has searched drives for so long at most until it knows its place, seconds; the announcement takes five of them. Of eight the
/// slowest took 13 s.
const FOUND_S: u64 = 40;
/// A minute later its place is wrong by less than this in the frame of the kept beacons, metres; the worst of eight was 0.42 m off.
const FOUND_OFF_M: f64 = 0.8;

#[test]
fn a_robot_that_was_put_elsewhere_between_two_runs_finds_its_place_by_its_beacons() {
    let scene = relax("two-room-flat");
    let all = Draws::of(PUT_ELSEWHERE, |seed| put_elsewhere(&scene, seed));
    let is_found =
        |one: &PutElsewhere| !one.has_searched || one.found_s.is_some_and(|found_s| found_s <= FOUND_S);
    assert_eq!(
        all.map(|one| f64::from(u8::from(is_found(one)))).below(0.5),
        0,
        "{all:?}"
    );
    assert_eq!(
        all.map(|one| one.shifted_m).below(f64::MIN_POSITIVE),
        8,
        "they keep all: {all:?}"
    );
    all.map(|one| one.off_m[1]).assert_within(
        "metres off",
        Bounds {
            median: 0.4,
            worst: FOUND_OFF_M,
        },
    );
    assert!(
        all.map(|one| one.told_moved.len() as f64).below(0.5) >= 7,
        "{all:?}"
    );
    let searched = all.map(|one| f64::from(u8::from(one.has_searched)));
    assert!(searched.below(0.5) <= 3, "hardly any place is alike: {all:?}");
}

/// Of a beacon that was moved between two runs.
#[derive(Clone, Debug)]
struct MovedBeacon {
    number: u16,
    told_moved: Vec<u16>,
    /// By how much the robot is wrong in the end, metres.
    off_m: f64,
    /// By how much the beacon is wrong that was moved, metres,
    located_off_m: f64,
    /// and farthest that another one is from where it was kept.
    others_shifted_m: f64,
}

fn move_beacon(scene: &Scene, seed: u64, by_m: f64) -> MovedBeacon {
    let kept = kept_home(scene, seed);
    let number = (seed % BEACONS as u64) as u16;
    let (sin, cos) = f64::sin_cos(2.4 * seed as f64);
    let beacons = scene.beacons(seed, BEACONS);
    let kept_from_plan = kept_from_plan(&kept, beacons.places());
    let beacons = beacons.with_moved(usize::from(number), (by_m * cos, by_m * sin));
    let (x_m, y_m) = beacons.places()[usize::from(number)];
    let mut household = next_run(scene, seed, &kept, beacons);
    household.pass_ms(5_000);
    start_cleaning(&mut household, StrategyName::Bounce);
    household.pass_until(300, |household| !told_moved(household).is_empty());
    household.pass_ms(3 * MINUTE_MS);
    let now = kept_now(&household);
    let moved = kept_from_plan.then(Pose::new(x_m, y_m, 0.0));
    let found = now.beacons().iter().find(|known| known.number == number);
    let others = kept.beacons().iter().filter(|known| known.number != number);
    let told = MovedBeacon {
        number,
        told_moved: told_moved(&household),
        off_m: off_in_kept_m(&household, kept_from_plan),
        located_off_m: found.map_or(f64::INFINITY, |found| {
            Pose::new(found.place.x_m, found.place.y_m, 0.0).distance_m(moved)
        }),
        others_shifted_m: others.map(|old| shift_m(old, &now)).fold(0.0, f64::max),
    };
    println!("by {by_m} m, seed {seed}: {told:?}");
    told
}

/// Metres by which a beacon was moved, one for each seed.
const MOVED_M: [f64; 4] = [1.0, 0.5, 2.0, 3.0];

#[test]
fn a_beacon_that_was_moved_between_two_runs_is_told_and_located_anew() {
    let scene = relax("two-room-flat");
    let all = Draws::of(1..=4, |seed| {
        move_beacon(&scene, seed, MOVED_M[seed as usize - 1])
    });
    let right = all.map(|one| f64::from(u8::from(one.told_moved.first() == Some(&one.number))));
    assert!(right.below(0.5) <= 1, "{all:?}");
    let others_shifted = all.map(|one| one.others_shifted_m);
    assert!(others_shifted.below(f64::MIN_POSITIVE) >= 3, "{all:?}");
    let located = all.map(|one| one.located_off_m);
    assert!(located.below(0.8) >= 3, "{all:?}");
    all.map(|one| one.off_m).assert_within(
        "metres off",
        Bounds {
            median: 0.5,
            worst: 1.5,
        },
    );
}
