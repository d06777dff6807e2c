//! Forbidden floor by chance: outlines and walls are drawn, and another program judges what became of them.

use crate::orders::{START, Stage, forbid, zone};
use crate::plane::{edit, run};
use brain::{
    BehaviorState, Cell, CellKnowledge, CleaningOrder, EditError, JobCommand, MapEdit, NoGo, NoGoEdit,
    Point2, StrategyName, Zone,
};
use std::collections::BTreeMap;

/// Outlines that are drawn.
const OUTLINES: u32 = 10_000;
/// Edge of the lattice on which corners lie, metres. On it, two features that do not touch are farther apart than any tolerance.
const LATTICE_M: f64 = 0.25;

/// A generator of numbers of its own: xorshift.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    pub(crate) fn below(&mut self, limit: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 33) % u64::from(limit)) as u32
    }

    fn corner(&mut self, side: u32) -> Corner {
        (i64::from(self.below(side)), i64::from(self.below(side)))
    }
}

/// A corner on the lattice.
type Corner = (i64, i64);

fn turn(a: Corner, b: Corner, c: Corner) -> i64 {
    ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).signum()
}

fn lies_on(point: Corner, a: Corner, b: Corner) -> bool {
    turn(a, b, point) == 0
        && (a.0.min(b.0)..=a.0.max(b.0)).contains(&point.0)
        && (a.1.min(b.1)..=a.1.max(b.1)).contains(&point.1)
}

/// Whether two closed edges share a point, in whole numbers.
fn share_a_point((a, b): (Corner, Corner), (c, d): (Corner, Corner)) -> bool {
    lies_on(c, a, b)
        || lies_on(d, a, b)
        || lies_on(a, c, d)
        || lies_on(b, c, d)
        || turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0
}

/// What a right answer to an outline is: `None` = accepted.
fn judge(drawn: &[Corner]) -> Option<EditError> {
    let mut corners = drawn.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let count = corners.len();
    if count < 3 {
        return Some(EditError::ZoneTooThin);
    }
    let edge = |index: usize| (corners[index % count], corners[(index + 1) % count]);
    for one in 0..count {
        for other in one + 1..count {
            let is_next = other == one + 1 || one == 0 && other == count - 1;
            let (first, second) = if one == 0 && other == count - 1 && count > 2 && other != 1 {
                (edge(other), edge(one))
            } else {
                (edge(one), edge(other))
            };
            let folds = lies_on(second.1, first.0, first.1) || lies_on(first.0, second.0, second.1);
            if is_next && folds || !is_next && share_a_point(first, second) {
                return Some(EditError::ZoneCrosses);
            }
        }
    }
    // Twice the area by triangles from the first corner, and the outline.
    let doubled: i64 = (1..count - 1)
        .map(|index| {
            let (a, b, c) = (corners[0], corners[index], corners[index + 1]);
            (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
        })
        .sum();
    let length: f64 = (0..count)
        .map(|index| {
            let (a, b) = edge(index);
            ((a.0 - b.0) as f64).hypot((a.1 - b.1) as f64)
        })
        .sum();
    let half_width_m = doubled.abs() as f64 * LATTICE_M / length;
    (half_width_m < 0.01).then_some(EditError::ZoneTooThin)
}

/// Whether an outline goes round a point, by the sum of the angles under which its edges are seen.
fn goes_round(corners: &[Corner], at: (f64, f64)) -> bool {
    let seen = |corner: &Corner| (corner.1 as f64 - at.1).atan2(corner.0 as f64 - at.0);
    let ends = corners.iter().skip(1).chain(corners.first());
    let sum: f64 = corners
        .iter()
        .zip(ends)
        .map(|(from, to)| {
            let angle = seen(to) - seen(from);
            angle - (angle / std::f64::consts::TAU).round() * std::f64::consts::TAU
        })
        .sum();
    sum.abs() > std::f64::consts::PI
}

/// Whether a point lies so near to an edge that rounding decides on which side.
fn is_on_edge(corners: &[Corner], at: (f64, f64)) -> bool {
    let ends = corners.iter().skip(1).chain(corners.first());
    corners.iter().zip(ends).any(|(from, to)| {
        let along = ((to.0 - from.0) as f64, (to.1 - from.1) as f64);
        let off = (at.0 - from.0 as f64, at.1 - from.1 as f64);
        (along.0 * off.1 - along.1 * off.0).abs() / along.0.hypot(along.1) < 1e-5
    })
}

fn in_metres(corner: Corner) -> Point2 {
    Point2 {
        x_m: corner.0 as f64 * LATTICE_M,
        y_m: corner.1 as f64 * LATTICE_M,
    }
}

#[test]
fn each_drawn_outline_is_accepted_without_a_hole_or_refused_rightly() {
    let mut draw = Draw(38);
    let (mut accepted, mut refused) = (0, BTreeMap::new());
    for number in 0..OUTLINES {
        let count = 3 + draw.below(6) as usize;
        // Few corners make most outlines simple; a small lattice makes some touch, repeat and fold.
        let side = 3 + draw.below(10);
        let corners: Vec<Corner> = (0..count).map(|_| draw.corner(side)).collect();
        let answer = Zone::new(corners.iter().copied().map(in_metres).collect());
        assert_eq!(
            answer.as_ref().err().copied(),
            judge(&corners),
            "{number}: {corners:?}"
        );
        let Ok(area) = answer else {
            *refused.entry(format!("{:?}", judge(&corners))).or_insert(0) += 1;
            continue;
        };
        accepted += 1;
        for _ in 0..40 {
            // Between the lattice lines, so that no point lies on an edge of small slope by chance of rounding.
            let at = (
                f64::from(draw.below(1_000)) / 1_000.0 * f64::from(side) + 0.000_31,
                f64::from(draw.below(1_000)) / 1_000.0 * f64::from(side) + 0.000_47,
            );
            let place = Point2 {
                x_m: at.0 * LATTICE_M,
                y_m: at.1 * LATTICE_M,
            };
            assert_eq!(
                area.contains(place),
                goes_round(&corners, at),
                "{number}: {corners:?} {at:?}"
            );
        }
    }
    assert!(
        accepted > 1_000 && refused.len() == 2,
        "{accepted} accepted, {refused:?}"
    );
}

#[test]
fn nothing_inside_of_an_accepted_outline_is_open_on_the_map() {
    let mut draw = Draw(7);
    let mut painted = 0;
    while painted < 40 {
        let corners: Vec<Corner> = (0..5).map(|_| draw.corner(13)).collect();
        let Ok(area) = Zone::new(corners.iter().copied().map(in_metres).collect()) else {
            continue;
        };
        let mut stage = Stage::new();
        let adding = MapEdit::NoGo(NoGoEdit::Add(NoGo::zone(&area).unwrap()));
        if stage.brain.map().admit(&adding).is_err() {
            continue;
        }
        edit(&mut stage.world, &mut stage.brain, adding);
        run(&mut stage.world, &mut stage.brain, None, 1.0);
        let knowledge = stage.brain.map().knowledge();
        for (index, kind) in knowledge.values().iter().enumerate() {
            let middle = knowledge.cell(index).middle();
            let at = (middle.x_m / LATTICE_M, middle.y_m / LATTICE_M);
            if is_on_edge(&corners, at) {
                continue;
            }
            assert_eq!(
                *kind == CellKnowledge::NoGo,
                goes_round(&corners, at),
                "{corners:?} {middle:?}"
            );
        }
        painted += 1;
    }
}

/// A rectangle of the flat that does not contain the robot's start.
fn drawn_rectangle(draw: &mut Draw) -> Zone {
    loop {
        let low = (f64::from(draw.below(50)) / 10.0, f64::from(draw.below(30)) / 10.0);
        let high = (
            low.0 + 0.2 + f64::from(draw.below(15)) / 10.0,
            low.1 + 0.2 + f64::from(draw.below(15)) / 10.0,
        );
        let area = zone(low, high);
        if !area.contains(Point2::default()) {
            return area;
        }
    }
}

/// The robot's centre is on forbidden floor only while it leaves it.
#[test]
fn a_job_among_drawn_zones_and_walls_keeps_off_forbidden_floor() {
    let mut draw = Draw(1_938);
    for home in 0..6 {
        let mut stage = Stage::new();
        let mut areas = Vec::new();
        for _ in 0..=draw.below(3) {
            let area = drawn_rectangle(&mut draw);
            let adding = MapEdit::NoGo(NoGoEdit::Add(NoGo::zone(&area).unwrap()));
            if stage.brain.map().admit(&adding).is_ok() {
                edit(&mut stage.world, &mut stage.brain, adding);
                areas.push(area);
            }
        }
        let order = CleaningOrder::default();
        run(
            &mut stage.world,
            &mut stage.brain,
            Some(JobCommand::CleanParts { order }),
            3.0,
        );
        let (mut steps, mut inside) = (0, 0);
        while stage.brain.status().state != BehaviorState::Idle && steps < 12_000 {
            run(&mut stage.world, &mut stage.brain, None, 0.1);
            let place = stage.place();
            inside += u32::from(areas.iter().any(|area| area.contains(place)));
            steps += 1;
        }
        assert!(steps < 12_000, "home {home} does not end");
        assert_eq!(inside, 0, "home {home}: steps on forbidden floor");
    }
}

/// Steps in which the robot's centre is on this floor while it does this, for as long as it does it, at most so many tenths of a second.
fn steps_on(area: &Zone, no_go: NoGo, (command, tenths): (JobCommand, u32)) -> (u32, f64) {
    let mut stage = Stage::new();
    forbid(&mut stage, no_go);
    run(&mut stage.world, &mut stage.brain, Some(command), 3.0);
    let (mut inside, mut driven_m) = (0, 0.0);
    let mut before = stage.place();
    for _ in 0..tenths {
        run(&mut stage.world, &mut stage.brain, None, 0.1);
        let now = stage.place();
        inside += u32::from(area.contains(now));
        driven_m += now.distance_m(before);
        before = now;
    }
    (inside, driven_m)
}

/// A spot and a bounce plan no path, and turn before forbidden floor all the same.
#[test]
fn a_spot_and_a_bounce_turn_before_forbidden_floor() {
    let strategy = StrategyName::Bounce;
    for (command, tenths, least_m) in [
        (JobCommand::Spot, 900, 0.3),
        (JobCommand::Clean { strategy }, 6_000, 20.0),
    ] {
        let area = zone((1.3, 0.4), (2.6, 3.0));
        let asked = (command.clone(), tenths);
        let (inside, driven_m) = steps_on(&area, NoGo::zone(&area).unwrap(), asked);
        assert_eq!(inside, 0, "{command:?}");
        assert!(driven_m > least_m, "{command:?}: {driven_m} m");
        let ends = [(1.3, -0.1), (1.3, 4.1)].map(|(x_m, y_m)| Point2 {
            x_m: x_m - START.x_m,
            y_m: y_m - START.y_m,
        });
        let beyond = zone((1.33, 0.0), (6.1, 4.0));
        let wall = NoGo::wall(ends[0], ends[1]).unwrap();
        let (inside, driven_m) = steps_on(&beyond, wall, (command.clone(), tenths));
        assert_eq!(inside, 0, "{command:?} over a wall");
        assert!(driven_m > least_m, "{command:?}: {driven_m} m");
    }
}

/// The search for the dock stays on its side of a virtual wall.
#[test]
fn the_search_for_the_dock_does_not_cross_a_virtual_wall() {
    let mut stage = Stage::new();
    let ends = [(3.05, 1.3), (3.05, 2.6)].map(|(x_m, y_m)| Point2 {
        x_m: x_m - START.x_m,
        y_m: y_m - START.y_m,
    });
    forbid(&mut stage, NoGo::wall(ends[0], ends[1]).unwrap());
    run(&mut stage.world, &mut stage.brain, Some(JobCommand::Dock), 3.0);
    let mut driven_m = 0.0;
    let mut before = stage.world.pose.position();
    for _ in 0..3_000 {
        run(&mut stage.world, &mut stage.brain, None, 0.1);
        let now = stage.world.pose.position();
        driven_m += now.distance_m(before);
        before = now;
        assert!(now.x_m < 3.0, "it has crossed the wall after {driven_m} m");
    }
    assert!(driven_m > 20.0, "it searches: {driven_m} m");
}

/// An outline as another program or an unsteady finger draws it, in the frame of the map, and what is said.
type OddOutline = (&'static str, Vec<(f64, f64)>, Result<(), EditError>);

const SQUARE: [(f64, f64); 4] = [(0.5, 1.0), (1.5, 1.0), (1.5, 2.0), (0.5, 2.0)];

fn ring(count: u32) -> Vec<(f64, f64)> {
    let angle = |number: u32| f64::from(number) / f64::from(count) * std::f64::consts::TAU;
    let corner = |number| (1.0 + angle(number).cos() / 2.0, 1.5 + angle(number).sin() / 2.0);
    (0..count).map(corner).collect()
}

/// What is one piece of floor, however its corners come.
fn whole_outlines() -> Vec<OddOutline> {
    let on_edges = (0..60).map(|number| match (number / 15, f64::from(number % 15) / 15.0) {
        (0, along) => (0.5 + along, 1.0),
        (1, along) => (1.5, 1.0 + along),
        (2, along) => (1.5 - along, 2.0),
        (_, along) => (0.5, 2.0 - along),
    });
    let over_edge = vec![(0.5, 1.0), (1.5, 1.0), (1.5, 400.0), (0.5, 400.0)];
    vec![
        ("a square", SQUARE.to_vec(), Ok(())),
        ("clockwise", SQUARE.iter().rev().copied().collect(), Ok(())),
        (
            "its first corner twice",
            [&SQUARE[..], &SQUARE[..1]].concat(),
            Ok(()),
        ),
        ("corners along its edges", on_edges.collect(), Ok(())),
        ("as many corners as may be", ring(64), Ok(())),
        ("over the edge of the map", over_edge, Ok(())),
    ]
}

fn refused_outlines() -> Vec<OddOutline> {
    // An outer square, a slit, and a hole that goes round the same way or the other.
    let inner = [(0.8, 1.3), (1.2, 1.3), (1.2, 1.7), (0.8, 1.7), (0.8, 1.3)];
    let slit = |inner: &[(f64, f64)]| [&SQUARE[..], &SQUARE[..1], inner].concat();
    let turned: Vec<(f64, f64)> = inner.iter().rev().copied().collect();
    let lower = [(0.5, 1.0), (1.0, 1.0), (1.0, 1.5)];
    let upper = [(1.5, 1.5), (1.5, 2.0), (1.0, 2.0), (1.0, 1.5), (0.5, 1.5)];
    let huge = vec![(0.0, 0.0), (1e300, 0.0), (1e300, 1e300)];
    let no_numbers = vec![(0.0, 0.0), (f64::NAN, 0.0), (1.0, f64::INFINITY)];
    let outside = vec![(20.0, 20.0), (21.0, 20.0), (21.0, 21.0)];
    vec![
        ("one corner more", ring(65), Err(EditError::BadZone)),
        ("ten thousand corners", ring(10_000), Err(EditError::BadZone)),
        ("a hole", slit(&inner), Err(EditError::ZoneCrosses)),
        (
            "a hole the other way round",
            slit(&turned),
            Err(EditError::ZoneCrosses),
        ),
        (
            "two squares that touch",
            [&lower[..], &upper[..]].concat(),
            Err(EditError::ZoneCrosses),
        ),
        ("huge", huge, Err(EditError::BadZone)),
        ("no numbers", no_numbers, Err(EditError::BadZone)),
        ("wholly outside", outside, Err(EditError::NoFloorThere)),
    ]
}

/// Whether the cell at a point of the map is forbidden; `None` = outside of the map.
fn is_forbidden(stage: &Stage, at: Point2) -> Option<bool> {
    let known = stage.brain.map().knowledge().get(Cell::under(at));
    known.map(|kind| *kind == CellKnowledge::NoGo)
}

#[test]
fn odd_outlines_are_taken_whole_or_refused_by_name() {
    for (what, corners, expected) in whole_outlines().into_iter().chain(refused_outlines()) {
        let mut stage = Stage::new();
        let corners = corners.into_iter().map(|(x_m, y_m)| Point2 { x_m, y_m });
        let answer = Zone::new(corners.collect()).and_then(|area| {
            let adding = MapEdit::NoGo(NoGoEdit::Add(NoGo::zone(&area)?));
            stage.brain.map().admit(&adding)?;
            edit(&mut stage.world, &mut stage.brain, adding);
            run(&mut stage.world, &mut stage.brain, None, 1.0);
            Ok(area)
        });
        let said = answer.as_ref().map(|_| ()).map_err(|error| *error);
        assert_eq!(said, expected, "{what}");
        let Ok(area) = answer else { continue };
        for (x_m, y_m) in [(1.0, 1.5), (1.3, 1.8), (0.0, 0.0), (2.5, 0.0)] {
            let at = Point2 { x_m, y_m };
            assert_eq!(is_forbidden(&stage, at), Some(area.contains(at)), "{what} {at:?}");
        }
    }
}

/// One of two zones that overlap is taken away: the other one still forbids all of its floor.
#[test]
fn zones_that_overlap_forbid_for_themselves() {
    let mut stage = Stage::new();
    for (low, high) in [((1.6, 2.2), (2.4, 3.2)), ((2.0, 2.2), (2.8, 3.2))] {
        forbid(&mut stage, NoGo::zone(&zone(low, high)).unwrap());
    }
    run(&mut stage.world, &mut stage.brain, None, 1.0);
    let forbidden = |stage: &Stage, x_m: f64| {
        let at = Point2 {
            x_m: x_m - START.x_m,
            y_m: 2.7 - START.y_m,
        };
        is_forbidden(stage, at).expect("a cell")
    };
    let seen = |stage: &Stage| [1.8, 2.2, 2.6].map(|x_m| forbidden(stage, x_m));
    assert_eq!(seen(&stage), [true; 3]);
    let removing = MapEdit::NoGo(NoGoEdit::Remove { number: 1 });
    edit(&mut stage.world, &mut stage.brain, removing);
    run(&mut stage.world, &mut stage.brain, None, 1.0);
    assert_eq!(seen(&stage), [false, true, true]);
    let at = Point2 { x_m: 1.0, y_m: 1.0 };
    assert_eq!(NoGo::wall(at, at), Err(EditError::BadZone), "a wall of no length");
}
