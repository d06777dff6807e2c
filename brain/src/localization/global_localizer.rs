//! Global localization: finds all poses in the map that match the last metres, in every direction, and refines the best poses.
//!
//! Branch and bound, as Hess et al. (2016, "Real-time loop closure in 2D LIDAR SLAM") search for a scan in a submap. A distance field
//! changes by at most a metre for each metre of way, so the clearances at the middle of a block of positions bound the score of all of them:
//! no pyramid of grids is needed. Blocks that cannot reach the required score are dropped, and the positions of the others are tried, the
//! most promising block first. What is found is what trying every position finds. The work is done in many steps, and needs no
//! randomness.

mod probe;
mod refinement;

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use super::floor_blocks::FloorBlocks;
use super::particles::Surroundings;
use super::rssi_fingerprint::FingerprintMatcher;
use super::scan_history::ScanHistory;
use crate::model::advance::Advance;
use crate::model::geometry::{Pose2, normalize_rad};
use probe::{Probes, Tolerance};
use refinement::{distinct, refined, thinned};

/// Parameters of the coarse search. They are chosen by hand in simulated homes; `docs/book/src/measurements/relocalization.md` shows what
/// they achieve together, and no record compares values of a single one.
struct GlobalSearchParameters {
    /// Blocks or poses that are tried in one step: a millisecond on a desktop core.
    tries_per_step: usize,
    /// Directions that are tried.
    directions: u32,
    /// Fewest points on obstacles for a search.
    solid_min: f64,
    /// Tolerance of the coarse search.
    coarse: Tolerance,
    /// A coarse candidate must reach this share of the highest possible score.
    coarse_share_min: f64,
    /// It must also reach this share of the best score so far.
    coarse_of_best_min: f64,
    /// Tolerance of the refinement.
    fine: Tolerance,
}

const PARAMETERS: GlobalSearchParameters = GlobalSearchParameters {
    tries_per_step: 300,
    directions: 72,
    solid_min: 12.0,
    coarse: Tolerance {
        floor_m: 0.14,
        per_m: 0.05,
    },
    coarse_share_min: 0.45,
    coarse_of_best_min: 0.75,
    fine: Tolerance {
        floor_m: 0.05,
        per_m: 0.02,
    },
};

/// A pose that matches the history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PoseCandidate {
    pub(super) pose: Pose2,
    /// Share of the solid points that match, less the contradictions, at most 1.
    pub(super) score: f64,
}

/// A search in progress. The robot drives on meanwhile.
#[derive(Clone, Debug)]
pub(super) struct GlobalLocalizer {
    coarse: Probes,
    fine: Probes,
    floor: FloorBlocks,
    /// Blocks whose positions are worth trying.
    promising: BinaryHeap<PromisingBlock>,
    stage: SearchStage,
    /// Least score of a coarse candidate, in solid points.
    least: f64,
    found: Vec<PoseCandidate>,
    /// Signal strengths along the history.
    rssi: Option<FingerprintMatcher>,
    /// Motion since the search began.
    moved: Pose2,
}

/// A block in a direction.
#[derive(Clone, Copy, Debug)]
struct PromisingBlock {
    /// No position of it has a higher score, in solid points.
    at_most: f64,
    direction: u32,
    block: usize,
}

impl Ord for PromisingBlock {
    /// The one with the higher bound is greater, or the one that was found first.
    fn cmp(&self, other: &Self) -> Ordering {
        let order = self.at_most.total_cmp(&other.at_most);
        order.then_with(|| (other.direction, other.block).cmp(&(self.direction, self.block)))
    }
}

impl PartialOrd for PromisingBlock {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for PromisingBlock {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for PromisingBlock {}

/// The next work.
#[derive(Clone, Copy, Debug)]
enum SearchStage {
    /// Judges the blocks in a direction, from this block on.
    Bound {
        direction: u32,
        block: usize,
    },
    /// Tries the positions of promising blocks.
    Try,
    /// Refines the candidates from this one on.
    Refine {
        next: usize,
    },
    Done,
}

impl GlobalLocalizer {
    /// For a robot of this radius; `None` when the history has too few points.
    pub(super) fn of(map: &impl Surroundings, history: &ScanHistory, radius_m: f64) -> Option<Self> {
        let coarse = Probes::of(history, PARAMETERS.coarse, radius_m);
        (coarse.solid() >= PARAMETERS.solid_min).then(|| {
            let fine = Probes::of(history, PARAMETERS.fine, radius_m);
            Self::among(map.floor_blocks(), coarse, fine)
        })
    }

    fn among(floor: FloorBlocks, coarse: Probes, fine: Probes) -> Self {
        Self {
            least: PARAMETERS.coarse_share_min * coarse.solid(),
            coarse,
            fine,
            floor,
            promising: BinaryHeap::new(),
            stage: SearchStage::Bound {
                direction: 0,
                block: 0,
            },
            found: Vec::new(),
            rssi: None,
            moved: Pose2::IDENTITY,
        }
    }

    /// The same search with signal strengths.
    pub(super) fn with_rssi(self, rssi: Option<FingerprintMatcher>) -> Self {
        Self { rssi, ..self }
    }

    /// Cost of a pose that does not explain the signal strengths, as a share of the solid points.
    fn rssi_cost(&self, pose: Pose2) -> f64 {
        self.rssi.as_ref().map_or(0.0, |rssi| rssi.cost(pose))
    }

    /// The robot has moved on.
    pub(super) fn follow(&mut self, advance: Advance) {
        self.moved = self.moved.after_arc(advance.distance_m, advance.turn_rad);
    }

    /// Does a step.
    pub(super) fn go_on(&mut self, map: &impl Surroundings) {
        self.stage = match self.stage {
            SearchStage::Bound { direction, block } => self.judge_blocks(map, direction, block),
            SearchStage::Try => self.try_promising(map),
            SearchStage::Refine { next } => self.refine(map, next),
            SearchStage::Done => SearchStage::Done,
        };
    }

    /// All candidate poses of the robot now, the best one first; `None` while the search goes on.
    pub(super) fn candidates(&self) -> Option<Vec<PoseCandidate>> {
        let moved = |candidate: &PoseCandidate| PoseCandidate {
            pose: candidate.pose * self.moved,
            ..*candidate
        };
        matches!(self.stage, SearchStage::Done).then(|| self.found.iter().map(moved).collect())
    }

    /// Judges some blocks, from this block in this direction on.
    fn judge_blocks(&mut self, map: &impl Surroundings, mut direction: u32, mut block: usize) -> SearchStage {
        for _ in 0..PARAMETERS.tries_per_step {
            let Some(judged) = self.floor.block(block) else {
                (direction, block) = (direction + 1, 0);
                if direction >= PARAMETERS.directions {
                    return SearchStage::Try;
                }
                continue;
            };
            let judged = (judged, direction_rad(direction));
            if let Some(at_most) = self.coarse.score_at_most(map, judged, self.least) {
                self.promising.push(PromisingBlock {
                    at_most,
                    direction,
                    block,
                });
            }
            block += 1;
        }
        SearchStage::Bound { direction, block }
    }

    /// Tries the positions of some blocks, the most promising first.
    fn try_promising(&mut self, map: &impl Surroundings) -> SearchStage {
        let mut tried = 0;
        while tried < PARAMETERS.tries_per_step {
            let next = self.promising.pop().filter(|next| next.at_most >= self.least);
            let Some(next) = next else {
                self.promising = BinaryHeap::new();
                self.found = thinned(core::mem::take(&mut self.found));
                return SearchStage::Refine { next: 0 };
            };
            tried += self.try_block(map, next);
        }
        SearchStage::Try
    }

    /// Tries the positions of a block, and returns how many.
    fn try_block(&mut self, map: &impl Surroundings, tried: PromisingBlock) -> usize {
        let Some(block) = self.floor.block(tried.block) else {
            return 0;
        };
        let positions = self.floor.positions(block);
        for at in positions {
            let pose = Pose2 {
                x_m: at.x_m,
                y_m: at.y_m,
                heading_rad: direction_rad(tried.direction),
            };
            let Some(points) = self.coarse.score(map, pose, self.least) else {
                continue;
            };
            let score = points / self.coarse.solid() - self.rssi_cost(pose);
            let points = score * self.coarse.solid();
            if points >= self.least {
                self.least = self.least.max(PARAMETERS.coarse_of_best_min * points);
                self.found.push(PoseCandidate { pose, score });
            }
        }
        positions.len()
    }

    fn refine(&mut self, map: &impl Surroundings, next: usize) -> SearchStage {
        let Some(start) = self.found.get(next).map(|candidate| candidate.pose) else {
            self.found = distinct(core::mem::take(&mut self.found));
            return SearchStage::Done;
        };
        let mut best = refined(map, &self.fine, start);
        best.score -= self.rssi_cost(best.pose);
        if let Some(candidate) = self.found.get_mut(next) {
            *candidate = best;
        }
        SearchStage::Refine { next: next + 1 }
    }
}

fn direction_rad(direction: u32) -> f64 {
    normalize_rad(core::f64::consts::TAU * f64::from(direction) / f64::from(PARAMETERS.directions))
}

#[cfg(test)]
mod tests;
