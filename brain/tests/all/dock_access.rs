//! Walls and zones before docks, by chance: another program, which knows the plan and no raster of cells, judges each answer.
//!
//! The judge measures distances to rectangles and polygons and floods a lattice of its own. It judges with a body that is somewhat too
//! small and one that is somewhat too large; where they differ, rounding decides, and any answer is right.

use crate::forbidden::Draw;
use crate::orders::{START, known, zone};
use crate::plane::{BODY, Rectangle, Room, config};
use brain::mapping::DockLocation;
use brain::{Brain, EditError, MapEdit, NoGo, NoGoEdit, Point2, Pose2};

/// Edge of the judge's lattice, metres.
const LATTICE_M: f64 = 0.05;
/// Distance between the places at which it looks for floor under a drawing, metres.
const FINE_M: f64 = 0.02;
/// How much the bodies of the judge differ from the robot's, metres: more than the edge of a cell.
const SLACK_M: f64 = 0.04;
/// The strip before a dock that stays open, metres (book, no-go zones).
const STRIP_M: f64 = 0.8;
/// Less than this share of the floor must not be left, and how near to it rounding decides.
const LEFT_SHARE: f64 = 0.4;
const SHARE_SLACK: f64 = 0.05;
/// Size of the home, metres.
const SIZE_M: (f64, f64) = (6.1, 4.0);
/// Radii of a slim and a stout body, metres.
const RADII_M: [f64; 2] = [BODY.radius_m - SLACK_M, BODY.radius_m + SLACK_M];

/// Drawings in each home.
const DRAWINGS: u32 = 10;

/// A home with two rooms, a door somewhere and a dock somewhere at its outer wall, in its own frame, and what the judge needs of it.
#[derive(Debug)]
struct Plan {
    walls: [Rectangle; 2],
    dock: Pose2,
    /// Free space around each point of the lattice, metres.
    free_m: Vec<f64>,
    /// Points that a slim and a stout body reach while nothing is forbidden.
    reached: [Option<usize>; 2],
}

/// Something that a person draws, as corners in the frame of the home.
struct Drawing<'plan> {
    plan: &'plan Plan,
    corners: Vec<(f64, f64)>,
}

fn between(draw: &mut Draw, least: f64, most: f64) -> f64 {
    least + (most - least) * f64::from(draw.below(10_000)) / 10_000.0
}

/// A pose on the dock at one of the outer walls: the robot drove in forward, so it looks at the wall.
fn drawn_dock(draw: &mut Draw) -> Pose2 {
    use core::f64::consts::{FRAC_PI_2, PI};
    let depth_m = BODY.radius_m + 0.05;
    let (x_m, y_m, heading_rad) = match draw.below(4) {
        0 => (depth_m, between(draw, 0.5, SIZE_M.1 - 0.5), PI),
        1 => (SIZE_M.0 - depth_m, between(draw, 0.5, SIZE_M.1 - 0.5), 0.0),
        2 => (between(draw, 0.5, SIZE_M.0 - 0.5), depth_m, -FRAC_PI_2),
        _ => (between(draw, 0.5, SIZE_M.0 - 0.5), SIZE_M.1 - depth_m, FRAC_PI_2),
    };
    Pose2 {
        x_m,
        y_m,
        heading_rad,
    }
}

/// A virtual wall between two places of the home.
fn wall_between(from: (f64, f64), to: (f64, f64)) -> Option<NoGo> {
    let [from, to] = [from, to].map(|(x_m, y_m)| Point2 {
        x_m: x_m - START.x_m,
        y_m: y_m - START.y_m,
    });
    NoGo::wall(from, to).ok()
}

/// A rectangle or a virtual wall: anywhere, across the whole home, or not far before the dock.
fn drawn_no_go(draw: &mut Draw, dock: Pose2) -> Option<NoGo> {
    let anywhere = |draw: &mut Draw| (between(draw, 0.0, SIZE_M.0), between(draw, 0.0, SIZE_M.1));
    match draw.below(4) {
        0 => {
            let low = anywhere(draw);
            let high = (low.0 + between(draw, 0.1, 2.0), low.1 + between(draw, 0.1, 2.0));
            NoGo::zone(&zone(low, high)).ok()
        }
        1 => wall_between(anywhere(draw), anywhere(draw)),
        2 => {
            let (across_m, begins_m) = (between(draw, 0.3, SIZE_M.0 - 0.3), between(draw, -0.5, 1.0));
            let leans_m = between(draw, -0.5, 0.5);
            wall_between((across_m, begins_m), (across_m + leans_m, SIZE_M.1 + 0.1))
        }
        _ => {
            let (sin, cos) = dock.heading_rad.sin_cos();
            let (far_m, aside_m) = (between(draw, 0.4, 2.0), between(draw, -0.6, 0.6));
            let middle = (
                dock.x_m - far_m * cos - aside_m * sin,
                dock.y_m - far_m * sin + aside_m * cos,
            );
            let half = (between(draw, 0.05, 0.6), between(draw, 0.05, 0.6));
            let low = (middle.0 - half.0, middle.1 - half.1);
            NoGo::zone(&zone(low, (middle.0 + half.0, middle.1 + half.1))).ok()
        }
    }
}

/// The corners of what is drawn, in the frame of the home.
fn corners_of(no_go: &NoGo) -> Vec<(f64, f64)> {
    let corners = no_go.area().corners().iter();
    corners
        .map(|corner| (corner.x_m + START.x_m, corner.y_m + START.y_m))
        .collect()
}

fn drawn_walls(draw: &mut Draw) -> [Rectangle; 2] {
    let wall_m = between(draw, 1.5, 4.5);
    let (door_m, width_m) = (between(draw, 0.3, 2.5), between(draw, 0.6, 1.2));
    [
        Rectangle::new((wall_m, 0.0), (wall_m + 0.1, door_m)),
        Rectangle::new((wall_m, door_m + width_m), (wall_m + 0.1, SIZE_M.1)),
    ]
}

fn to_segment_m(at: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let along = (to.0 - from.0, to.1 - from.1);
    let off = (at.0 - from.0, at.1 - from.1);
    let squared = along.0 * along.0 + along.1 * along.1;
    let share = ((off.0 * along.0 + off.1 * along.1) / squared).clamp(0.0, 1.0);
    (off.0 - share * along.0).hypot(off.1 - share * along.1)
}

/// Distance to a convex polygon; 0 inside.
fn to_polygon_m(at: (f64, f64), corners: &[(f64, f64)]) -> f64 {
    let edges = || corners.iter().zip(corners.iter().skip(1).chain(corners.first()));
    let turns: Vec<bool> = edges()
        .map(|(from, to)| (to.0 - from.0) * (at.1 - from.1) - (to.1 - from.1) * (at.0 - from.0) > 0.0)
        .collect();
    if turns.iter().all(|left| *left) || turns.iter().all(|left| !*left) {
        return 0.0;
    }
    edges().fold(f64::INFINITY, |least, (from, to)| {
        least.min(to_segment_m(at, *from, *to))
    })
}

/// Points of the lattice in both directions.
const COLUMNS: i32 = (SIZE_M.0 / LATTICE_M) as i32 + 1;
const ROWS: i32 = (SIZE_M.1 / LATTICE_M) as i32 + 1;

fn place(column: i32, row: i32) -> (f64, f64) {
    (f64::from(column) * LATTICE_M, f64::from(row) * LATTICE_M)
}

/// How many points of the lattice hang together with the one at a place, if it fits there.
fn flood(from: (f64, f64), fits: impl Fn(i32, i32) -> bool) -> Option<usize> {
    let index = |column: i32, row: i32| (row * COLUMNS + column) as usize;
    let mut seen = vec![false; (COLUMNS * ROWS) as usize];
    let start = [from.0, from.1].map(|at_m| (at_m / LATTICE_M).round() as i32);
    let is_inside = |column: i32, row: i32| (0..COLUMNS).contains(&column) && (0..ROWS).contains(&row);
    let mut open = Vec::new();
    if is_inside(start[0], start[1]) && fits(start[0], start[1]) {
        seen[index(start[0], start[1])] = true;
        open.push((start[0], start[1]));
    }
    let mut count = 0;
    while let Some((column, row)) = open.pop() {
        count += 1;
        let around = (-1..=1).flat_map(|up| (-1..=1).map(move |right| (column + right, row + up)));
        for (column, row) in around {
            if is_inside(column, row) && !seen[index(column, row)] {
                seen[index(column, row)] = true;
                if fits(column, row) {
                    open.push((column, row));
                }
            }
        }
    }
    (count > 0).then_some(count)
}

impl Plan {
    fn drawn(draw: &mut Draw) -> Self {
        let mut plan = Self {
            walls: drawn_walls(draw),
            dock: drawn_dock(draw),
            free_m: Vec::new(),
            reached: [None; 2],
        };
        let places = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| place(column, row)));
        plan.free_m = places.map(|at| plan.by_plan_m(at)).collect();
        plan.reached = RADII_M.map(|radius_m| {
            flood(plan.before_dock(STRIP_M), |column, row| {
                plan.on_lattice_m(column, row) >= radius_m
            })
        });
        plan
    }

    /// Free space around a place.
    fn by_plan_m(&self, at: (f64, f64)) -> f64 {
        let outer_m = at.0.min(SIZE_M.0 - at.0).min(at.1).min(SIZE_M.1 - at.1);
        self.walls.iter().fold(outer_m, |least, wall| {
            let ((low_x, low_y), (high_x, high_y)) = (wall.low, wall.high);
            let corners = [(low_x, low_y), (high_x, low_y), (high_x, high_y), (low_x, high_y)];
            least.min(to_polygon_m(at, &corners))
        })
    }

    fn on_lattice_m(&self, column: i32, row: i32) -> f64 {
        self.free_m[(row * COLUMNS + column) as usize]
    }

    fn before_dock(&self, front_m: f64) -> (f64, f64) {
        let (sin, cos) = self.dock.heading_rad.sin_cos();
        (self.dock.x_m - front_m * cos, self.dock.y_m - front_m * sin)
    }

    /// A robot that knows this home.
    fn brain(&self) -> Brain {
        let dock = Pose2 {
            x_m: self.dock.x_m - START.x_m,
            y_m: self.dock.y_m - START.y_m,
            ..self.dock
        };
        let room = Room::empty(SIZE_M).with(&self.walls);
        let map = known(&room).with_dock_location(DockLocation::converged(dock));
        Brain::with_map(config(), 1, &map)
    }
}

impl Drawing<'_> {
    /// Nearest that the drawing comes to the strip before the dock, metres.
    fn off_strip_m(&self) -> f64 {
        (0..=80).fold(f64::INFINITY, |least, step| {
            let at = self.plan.before_dock(STRIP_M * f64::from(step) / 80.0);
            least.min(to_polygon_m(at, &self.corners))
        })
    }

    /// Points that a body reaches from the end of the strip beside the drawing.
    fn reached(&self, radius_m: f64) -> usize {
        let fits = |column: i32, row: i32| {
            self.plan.on_lattice_m(column, row) >= radius_m
                && to_polygon_m(place(column, row), &self.corners) >= radius_m
        };
        flood(self.plan.before_dock(STRIP_M), fits).unwrap_or(0)
    }

    /// Whether floor lies inside of the drawing for sure.
    fn covers_floor(&self) -> bool {
        let reach = |of: fn(&(f64, f64)) -> f64, size_m: f64| {
            let least = self.corners.iter().map(of).fold(f64::INFINITY, f64::min);
            let most = self.corners.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
            let steps = |at_m: f64| (at_m.clamp(0.0, size_m) / FINE_M) as u32;
            steps(least)..=steps(most)
        };
        let rows = reach(|corner| corner.1, SIZE_M.1);
        reach(|corner| corner.0, SIZE_M.0).any(|column| {
            rows.clone().any(|row| {
                let at = (f64::from(column) * FINE_M, f64::from(row) * FINE_M);
                to_polygon_m(at, &self.corners) == 0.0 && self.plan.by_plan_m(at) > SLACK_M
            })
        })
    }

    /// What a right answer is; `None` = rounding decides.
    fn judge(&self) -> Option<Result<(), EditError>> {
        let off_m = self.off_strip_m();
        if !self.covers_floor() || (off_m - BODY.radius_m).abs() < SLACK_M {
            return None;
        }
        if off_m < BODY.radius_m {
            return Some(Err(EditError::DockInside));
        }
        let [Some(slim), Some(stout)] = self.plan.reached else {
            return None;
        };
        let share = |radius_m: f64, before: usize| self.reached(radius_m) as f64 / before as f64;
        let (slim, stout) = (share(RADII_M[0], slim), share(RADII_M[1], stout));
        if slim.min(stout) > LEFT_SHARE + SHARE_SLACK {
            Some(Ok(()))
        } else if slim.max(stout) < LEFT_SHARE - SHARE_SLACK {
            Some(Err(EditError::DockShutOff))
        } else {
            None
        }
    }
}

/// Judged answers by kind.
#[derive(Debug, Default)]
struct Judged {
    accepted: u32,
    inside: u32,
    shut_off: u32,
    open: u32,
}

/// Judges what is drawn in so many homes.
fn judge_homes(seed: u64, homes: u32) -> Judged {
    let mut draw = Draw(seed);
    let mut judged = Judged::default();
    for number in 0..homes {
        let plan = Plan::drawn(&mut draw);
        let brain = plan.brain();
        for _ in 0..DRAWINGS {
            let Some(no_go) = drawn_no_go(&mut draw, plan.dock) else {
                continue;
            };
            let drawing = Drawing {
                plan: &plan,
                corners: corners_of(&no_go),
            };
            let Some(right) = drawing.judge() else {
                judged.open += 1;
                continue;
            };
            let answer = brain.map().admit(&MapEdit::NoGo(NoGoEdit::Add(no_go)));
            let (corners, off_m) = (&drawing.corners, drawing.off_strip_m());
            assert_eq!(
                answer, right,
                "seed {seed}, home {number}: {:?}, {:?}, drawn {corners:?}, {off_m:.3} m off the strip",
                plan.walls, plan.dock
            );
            match right {
                Ok(()) => judged.accepted += 1,
                Err(EditError::DockInside) => judged.inside += 1,
                Err(_) => judged.shut_off += 1,
            }
        }
    }
    judged
}

#[test]
fn what_is_drawn_before_a_dock_is_accepted_or_refused_as_another_program_judges() {
    let judged = judge_homes(38, 40);
    assert!(
        judged.accepted > 200 && judged.inside > 20 && judged.shut_off > 3,
        "{judged:?}"
    );
}

#[test]
#[ignore = "campaign: 10,000 walls and zones in 1,000 homes; cargo xtask test --long"]
fn ten_thousand_walls_doors_and_docks_are_judged_alike() {
    let halves = std::thread::scope(|scope| {
        let halves = [1_938, 2_038].map(|seed| scope.spawn(move || judge_homes(seed, 500)));
        halves.map(|half| half.join().expect("no answer differs"))
    });
    let open: u32 = halves.iter().map(|judged| judged.open).sum();
    assert!(open < 4_000, "{halves:?}");
}
