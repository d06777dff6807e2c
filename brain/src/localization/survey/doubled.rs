//! Walls that stand twice in the graph: the robot came to one again by another way, and was off by more than strokes are
//! looked for.
//!
//! Of two walls one close before the other, both facing the same way, the one behind cannot have been seen where the one
//! before stands now: the beams, or the robot itself, were in between. So they are one wall, or something was moved since. Which
//! of both is found out by taking them for one and fitting all anew ([`super::fit`]).

use super::graph::{Graph, Mark, Wall};
use super::tidy::{TORN_OFF_M, join, look_alike};
use std::collections::BTreeMap;

/// Walls are compared in pieces of this length along them, metres.
const PIECE_M: f64 = 0.1;
/// Most pieces of a stroke: a visit is shorter.
const LENGTH_MAX: i32 = 30;
/// So far before each other they are not one wall yet, metres; nearer ones are joined without this.
const BEFORE_M: f64 = 0.05;
/// Farther before each other they are two, metres: nothing is seen from farther away.
const BEFORE_MAX_M: f64 = 0.6;
/// The robot reaches at least this far beyond its middle, metres.
const BODY_M: f64 = 0.1;
/// Length over which a wall must stand where the robot was when it saw the other one, metres: a chair that was moved is shorter.
const ALONG_M: f64 = 0.55;

/// Of the marks of walls that are one so many lie on it in the end,
const HELD_SHARE: f64 = 0.7;
/// and the other marks that do not lie on their walls any more are fewer than this share of them.
const TORN_SHARE: f64 = 0.3;
/// What odometry may be wrong by for it, more than in the last fit, in squared deviations: 40 cm over 30 m of way. What was moved
/// tears shorter ways apart.
const STRAIN_MAX: f64 = 15.0;

/// That a wall seems to be another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Double {
    /// The one that was seen first.
    pub(super) wall: usize,
    /// The one that was seen later.
    pub(super) again: usize,
}

/// What a mark shows of a wall.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// How far before the wall it lies, metres.
    off_m: f64,
    /// How far before the wall the robot was.
    from_m: f64,
    /// Ends along the wall, in pieces.
    low: i32,
    high: i32,
}

/// Finds them: each wall at most once as the later one, and never one that is the earlier one of another pair.
pub(super) fn doubles(graph: &Graph) -> Vec<Double> {
    let marks = marks_of_walls(graph);
    let walls = || graph.walls.iter().zip(&marks).enumerate();
    let mut doubles: Vec<(i32, Double)> = Vec::new();
    for (back, (wall, marks)) in walls() {
        let seen = seen_from(graph, wall, marks);
        for (front, (other, marks)) in walls() {
            if front != back && is_close_before(other, wall) {
                let pieces = denied_pieces(graph, (wall, &seen), marks);
                if f64::from(pieces) * PIECE_M >= ALONG_M {
                    doubles.push((pieces, in_time(graph, (back, front))));
                }
            }
        }
    }
    doubles.sort_by_key(|(pieces, _)| core::cmp::Reverse(*pieces));
    let mut chosen: Vec<Double> = Vec::new();
    for (_, double) in doubles {
        let is_free = |wall: usize| chosen.iter().all(|other| other.again != wall);
        let is_kept = chosen.iter().any(|other| other.wall == double.again);
        if is_free(double.wall) && is_free(double.again) && !is_kept {
            chosen.push(double);
        }
    }
    chosen
}

fn marks_of_walls(graph: &Graph) -> Vec<Vec<&Mark>> {
    let mut marks = vec![Vec::new(); graph.walls.len()];
    for mark in &graph.marks {
        if let Some(of_wall) = marks.get_mut(mark.wall) {
            of_wall.push(mark);
        }
    }
    marks
}

/// Whether a look at the marks is worth it.
fn is_close_before(front: &Wall, back: &Wall) -> bool {
    if front.is_apart || back.is_apart || !look_alike(front, back) {
        return false;
    }
    let (low, high) = (
        back.place_of(front.at(front.low_m)),
        back.place_of(front.at(front.high_m)),
    );
    let is_before = low.0.max(high.0) > BEFORE_M && low.0.min(high.0) < BEFORE_MAX_M;
    is_before && low.1.max(high.1) > back.low_m && low.1.min(high.1) < back.high_m
}

/// From how far away each piece of a wall was seen, at most, metres.
fn seen_from(graph: &Graph, wall: &Wall, marks: &[&Mark]) -> BTreeMap<i32, f64> {
    let mut seen = BTreeMap::new();
    for piece in marks.iter().filter_map(|mark| Piece::of(graph, mark, wall)) {
        for place in piece.low..piece.high {
            let from_m: &mut f64 = seen.entry(place).or_insert(piece.from_m);
            *from_m = from_m.max(piece.from_m);
        }
    }
    seen
}

/// Pieces of a wall that was seen although what these marks show is before it.
fn denied_pieces(graph: &Graph, (wall, seen): (&Wall, &BTreeMap<i32, f64>), marks: &[&Mark]) -> i32 {
    let mut denied: Vec<i32> = Vec::new();
    for piece in marks.iter().filter_map(|mark| Piece::of(graph, mark, wall)) {
        let is_between = |from_m: f64| piece.off_m > BEFORE_M && piece.off_m < from_m + BODY_M;
        denied
            .extend((piece.low..piece.high).filter(|place| seen.get(place).copied().is_some_and(is_between)));
    }
    denied.sort_unstable();
    denied.dedup();
    i32::try_from(denied.len()).unwrap_or(i32::MAX)
}

impl Piece {
    fn of(graph: &Graph, mark: &Mark, wall: &Wall) -> Option<Self> {
        let pose = graph.nodes.get(mark.node)?.pose;
        let (off_m, along_m) = wall.place_of(pose.transform(mark.stroke.middle));
        let low = libm::round((along_m - mark.stroke.half_m) / PIECE_M) as i32;
        let length = libm::round(2.0 * mark.stroke.half_m / PIECE_M) as i32;
        Some(Self {
            off_m,
            from_m: wall.place_of(pose.position()).0,
            low,
            high: low.saturating_add(length.min(LENGTH_MAX)),
        })
    }
}

fn in_time(graph: &Graph, (one, other): (usize, usize)) -> Double {
    let first = |wall: usize| graph.walls.get(wall).map_or(usize::MAX, |wall| wall.first);
    if first(one) <= first(other) {
        Double {
            wall: one,
            again: other,
        }
    } else {
        Double {
            wall: other,
            again: one,
        }
    }
}

/// Walls are taken for one, and a fit shows whether they are.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    /// All as it was before.
    graph: Graph,
    became: Vec<Option<usize>>,
    doubles: Vec<Double>,
}

impl Trial {
    /// Before these are joined.
    pub(super) fn new(graph: &Graph, became: &[Option<usize>], doubles: Vec<Double>) -> Self {
        Self {
            graph: graph.clone(),
            became: became.to_vec(),
            doubles,
        }
    }

    /// Joins them. Gives for each wall where it is then.
    pub(super) fn join(&self, graph: &mut Graph) -> Vec<Option<usize>> {
        let mut joined: Vec<usize> = (0..graph.walls.len()).collect();
        for double in &self.doubles {
            if let Some(place) = joined.get_mut(double.again) {
                *place = double.wall;
            }
        }
        join(graph, &joined)
    }

    /// The graph as it was, with those apart that are not one.
    pub(super) fn taken_back(mut self, refuted: &[Double]) -> (Graph, Vec<Option<usize>>) {
        for double in refuted {
            if let Some(wall) = self.graph.walls.get_mut(double.again) {
                wall.is_apart = true;
            }
        }
        (self.graph, self.became)
    }

    /// Those that are not one, after a fit: all of them when nothing fits with them as one. No mark comes or goes while a graph is
    /// fitted, so that both graphs have the same.
    pub(super) fn refuted(&self, fitted: Option<&Graph>) -> Vec<Double> {
        let Some(fitted) = fitted else {
            return self.doubles.clone();
        };
        let is_again = |mark: &Mark| self.doubles.iter().any(|double| double.again == mark.wall);
        let (mut joined, mut torn) = (0_u32, 0_u32);
        for (was, is) in self.graph.marks.iter().zip(&fitted.marks) {
            joined += u32::from(is_again(was));
            torn += u32::from(!is_again(was) && fitted.off_m(is).abs() > TORN_OFF_M);
        }
        let is_refuted = |double: &&Double| self.held_share(double, fitted) < HELD_SHARE;
        let refuted: Vec<Double> = self.doubles.iter().filter(is_refuted).copied().collect();
        let is_bent = fitted.strain() > self.graph.fitted_strain + STRAIN_MAX
            || f64::from(torn) > TORN_SHARE * f64::from(joined);
        if refuted.is_empty() && is_bent {
            // One of them must be wrong: the one that the least speaks for.
            return self.doubles.last().copied().into_iter().collect();
        }
        refuted
    }

    /// Share of the later wall's marks that lie on the earlier one.
    fn held_share(&self, double: &Double, fitted: &Graph) -> f64 {
        let (mut all, mut held) = (0_u32, 0_u32);
        for (was, is) in self.graph.marks.iter().zip(&fitted.marks) {
            if was.wall == double.again {
                all += 1;
                held += u32::from(fitted.off_m(is).abs() <= TORN_OFF_M);
            }
        }
        f64::from(held) / f64::from(all.max(1))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::graph::tests::{laps, rmse_m};
    use super::super::kalman::StepVariance;
    use super::super::optimization::optimized;
    use super::{Double, Graph, Mark, doubles};
    use crate::localization::survey::fit::tests::fitted;
    use crate::model::geometry::{Point2, Pose2};

    /// Nodes of the first lap, and walls of the room.
    const LAP: usize = 32;
    const WALLS: usize = 4;

    /// Two laps through a room, fitted.
    fn room(seed: u64) -> (Graph, Vec<Pose2>) {
        let (mut graph, truth) = laps(0.0, seed);
        assert!(optimized(&mut graph));
        graph.fitted_strain = graph.strain();
        (graph, truth)
    }

    /// Two laps through a room between which the robot was elsewhere: it believes to be off by `drift` in the second one, of which
    /// it has walls of its own. Gives where it was, too.
    pub(in crate::localization::survey) fn seen_twice(
        drift: Point2,
        sigma_m: f64,
        seed: u64,
    ) -> (Graph, Vec<Pose2>) {
        let (mut graph, truth) = room(seed);
        for wall in 0..WALLS {
            let mut again = graph.walls[wall];
            again.anchor.x_m += drift.x_m;
            again.anchor.y_m += drift.y_m;
            graph.walls.push(again);
        }
        for mark in graph.marks.iter_mut().filter(|mark| mark.node >= LAP) {
            mark.wall += WALLS;
        }
        for node in &mut graph.nodes[LAP..] {
            node.pose.x_m += drift.x_m;
            node.pose.y_m += drift.y_m;
        }
        graph.nodes[LAP].step = graph.nodes[LAP - 1].pose.inverse() * graph.nodes[LAP].pose;
        graph.nodes[LAP].variance = StepVariance {
            along_m2: sigma_m * sigma_m,
            across_m2: sigma_m * sigma_m,
            turn_rad2: 1e-4,
        };
        (graph, truth)
    }

    /// These marks are of something that stands so far before the first wall, along which the robot drives with that to its right.
    fn see_before(graph: &mut Graph, off_m: f64, is_of_it: impl Fn(&Mark) -> bool) {
        let mut before = graph.walls[0];
        before.anchor.y_m += off_m;
        graph.walls.push(before);
        for mark in graph.marks.iter_mut().filter(|mark| is_of_it(mark)) {
            mark.wall = WALLS;
            mark.stroke.middle.y_m += off_m;
        }
    }

    fn drift(x_m: f64, y_m: f64) -> Point2 {
        Point2 { x_m, y_m }
    }

    #[test]
    fn a_room_that_was_entered_a_second_time_with_an_error_becomes_one() {
        for seed in 1..20 {
            for drift in [drift(0.25, -0.2), drift(-0.35, 0.38)] {
                let (since, truth) = seen_twice(drift, 0.25, seed);
                let before_m = rmse_m(&since, &truth);
                let fitted = fitted(&since).0;
                assert!(fitted.is_mended, "seed {seed}, {drift:?}");
                let graph = fitted.with_news_of(&since);
                assert_eq!(graph.walls.len(), WALLS, "seed {seed}, {drift:?}");
                let after_m = rmse_m(&graph, &truth);
                assert!(
                    after_m < 0.5 * before_m,
                    "{before_m} and {after_m} m, seed {seed}, {drift:?}"
                );
            }
        }
    }

    #[test]
    fn what_was_moved_is_not_taken_for_the_drift_of_the_robot() {
        for seed in 1..20 {
            let (mut since, truth) = room(seed);
            let before_m = rmse_m(&since, &truth);
            // A sofa of two metres along the first wall was pulled out by 25 cm before the second lap.
            see_before(&mut since, 0.25, |mark| (LAP + 3..LAP + 7).contains(&mark.node));
            assert_eq!(
                doubles(&since),
                [Double {
                    wall: 0,
                    again: WALLS
                }],
                "seed {seed}"
            );
            let fitted = fitted(&since).0;
            assert!(!fitted.is_mended, "seed {seed}");
            let graph = fitted.with_news_of(&since);
            assert!(
                graph.walls.len() == WALLS + 1 && graph.walls[WALLS].is_apart,
                "seed {seed}"
            );
            assert_eq!(doubles(&graph), [], "it is not tried again");
            assert!(rmse_m(&graph, &truth) < before_m + 0.02, "seed {seed}");
        }
    }

    #[test]
    fn walls_one_before_the_other_are_two_when_the_robot_passed_between_or_beside() {
        let (mut since, _) = room(1);
        // The robot was 30 cm before the first wall: half a metre before it there may be a screen.
        see_before(&mut since, 0.5, |mark| mark.node >= LAP && mark.wall == 0);
        assert_eq!(doubles(&since), []);
        let (mut since, _) = room(1);
        // A cupboard along its second half, which hides the wall behind.
        see_before(&mut since, 0.3, |mark| mark.wall == 0 && mark.node % LAP >= 5);
        assert_eq!(doubles(&since), []);
    }
}
