//! Bounce, spot and docking in a paper world.

use crate::plane::{BODY, Rectangle, Room, SPEEDS, World, config, run};
use brain::{BehaviorState, Brain, CELL_M, JobCommand, Pose2, StrategyName};

const CLEAN: JobCommand = JobCommand::Clean {
    strategy: StrategyName::Bounce,
};

fn middle_of(room: &Room) -> Pose2 {
    Pose2 {
        x_m: 0.5 * room.size_m.0,
        y_m: 0.5 * room.size_m.1,
        heading_rad: 0.3,
    }
}

fn furnished() -> Room {
    let leg = |x: f64, y: f64| Rectangle::new((x, y), (x + 0.05, y + 0.05));
    Room::empty((4.0, 5.0)).with(&[
        Rectangle::new((0.0, 3.6), (1.8, 5.0)),
        Rectangle::new((3.4, 0.5), (4.0, 2.0)),
        leg(1.2, 1.2),
        leg(2.2, 1.2),
        leg(1.2, 2.0),
        leg(2.2, 2.0),
        leg(2.7, 3.4),
        leg(3.1, 3.4),
        leg(2.7, 3.8),
        leg(3.1, 3.8),
    ])
}

/// Coverage at multiples of T0, and the state at the end.
fn coverage(room: fn() -> Room, seed: u64, multiples: &[f64]) -> Vec<f64> {
    let start = room();
    let pose = middle_of(&start);
    let area_m2 = start.size_m.0 * start.size_m.1;
    let t0_s = area_m2 / (BODY.swath_m * SPEEDS.cruise_m_per_s);
    let mut world = World::new(start, pose);
    let mut brain = Brain::new(config(), seed);
    let mut before = 0.0;
    let mut covered = Vec::new();
    for (index, multiple) in multiples.iter().enumerate() {
        run(
            &mut world,
            &mut brain,
            (index == 0).then_some(CLEAN),
            (multiple - before) * t0_s,
        );
        before = *multiple;
        covered.push(world.covered());
    }
    assert_eq!(world.violations, Vec::<String>::new());
    assert_eq!(
        brain.status().state,
        BehaviorState::Cleaning,
        "seed {seed}: {:?}",
        brain.status()
    );
    covered
}

fn median_coverage(room: fn() -> Room, multiples: &[f64]) -> Vec<f64> {
    let runs: Vec<Vec<f64>> = (1..=9).map(|seed| coverage(room, seed, multiples)).collect();
    (0..multiples.len())
        .map(|column| {
            let mut values: Vec<f64> = runs.iter().map(|run| run[column]).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        })
        .collect()
}

/// Reference medians of random bounce in such a room: 0.55 / 0.79 / 0.97 at 1 / 2 / 5 x T0.
#[test]
#[ignore = "campaign: medians of many runs; cargo xtask test --all"]
fn bounce_covers_an_empty_room_as_random_bounce_does() {
    let covered = median_coverage(|| Room::empty((4.0, 5.0)), &[1.0, 2.0, 5.0]);
    println!("empty room: {covered:.2?}");
    for (covered, least) in covered.iter().zip([0.48, 0.72, 0.93]) {
        assert!(*covered >= least, "{covered} is below {least}");
    }
}

/// Reference medians in a furnished room: 0.44 / 0.61 / 0.88 at 1 / 2 / 5 x T0.
#[test]
#[ignore = "campaign: medians of many runs; cargo xtask test --all"]
fn bounce_covers_a_furnished_room_as_random_bounce_does() {
    let covered = median_coverage(furnished, &[1.0, 2.0, 5.0]);
    println!("furnished room: {covered:.2?}");
    for (covered, least) in covered.iter().zip([0.40, 0.58, 0.84]) {
        assert!(*covered >= least, "{covered} is below {least}");
    }
}

/// The disc is one metre across and swept without holes.
#[test]
fn spot_sweeps_a_disc_of_a_metre() {
    let room = Room::empty((4.0, 4.0));
    let pose = middle_of(&room);
    let mut world = World::new(room, pose);
    let mut brain = Brain::new(config(), 1);
    run(&mut world, &mut brain, Some(JobCommand::Spot), 60.0);
    assert_eq!(brain.status().state, BehaviorState::Idle, "{:?}", brain.status());
    let swept: Vec<(f64, f64)> = brain
        .map()
        .snapshot()
        .swept
        .iter()
        .map(|cell| {
            (
                (f64::from(cell.x) + 0.5) * CELL_M,
                (f64::from(cell.y) + 0.5) * CELL_M,
            )
        })
        .collect();
    let count = swept.len() as f64;
    let (sum_x, sum_y) = swept
        .iter()
        .fold((0.0, 0.0), |sum, cell| (sum.0 + cell.0, sum.1 + cell.1));
    let radius = |cell: &(f64, f64)| (cell.0 - sum_x / count).hypot(cell.1 - sum_y / count);
    let farthest_m = swept.iter().map(radius).fold(0.0, f64::max);
    assert!((0.48..0.56).contains(&farthest_m), "reaches {farthest_m} m");
    let inside = swept.iter().filter(|cell| radius(cell) < 0.47).count() as f64;
    let share = inside * CELL_M * CELL_M / (core::f64::consts::PI * 0.47 * 0.47);
    assert!(share > 0.97, "only {share} of the inner disc");
}

/// A pocket a little wider than the robot lets it out again.
#[test]
fn a_narrow_pocket_is_left() {
    for seed in 1..=20 {
        let room = Room::empty((4.0, 4.0)).with(&[
            Rectangle::new((0.0, 0.0), (1.0, 0.8)),
            Rectangle::new((1.42, 0.0), (2.4, 0.8)),
        ]);
        let pose = Pose2 {
            x_m: 1.21,
            y_m: 0.3,
            heading_rad: -1.5,
        };
        let mut world = World::new(room, pose);
        let mut brain = Brain::new(config(), seed);
        run(&mut world, &mut brain, Some(CLEAN), 180.0);
        assert_eq!(world.violations, Vec::<String>::new());
        assert!(
            world.covered() > 0.15,
            "seed {seed}: {} {:?}",
            world.covered(),
            brain.status()
        );
    }
}

/// Stairs: it turns away every time and never drives on.
#[test]
fn stairs_are_left_alone() {
    for seed in 1..=10 {
        let mut room = Room::empty((3.0, 3.0));
        room.holes.push(Rectangle::new((2.0, 0.0), (3.0, 3.0)));
        let mut world = World::new(
            room,
            Pose2 {
                x_m: 1.0,
                y_m: 1.5,
                heading_rad: 0.0,
            },
        );
        let mut brain = Brain::new(config(), seed);
        run(&mut world, &mut brain, Some(CLEAN), 300.0);
        assert_eq!(world.violations, Vec::<String>::new());
        assert!(world.pose.x_m < 2.0, "seed {seed} fell");
        assert_eq!(
            brain.status().state,
            BehaviorState::Cleaning,
            "seed {seed}: {:?}",
            brain.status()
        );
        assert!(
            brain
                .map()
                .snapshot()
                .hazards
                .iter()
                .any(|mark| mark.kind == brain::HazardKind::Cliff)
        );
    }
}
