//! Searches in a flat, beside ones that try every position.

use super::probe::Probes;
use super::{GlobalLocalizer, PARAMETERS, SearchStage, direction_rad};
use crate::localization::floor_blocks::FloorBlocks;
use crate::localization::known_home::flat;
use crate::localization::particles::Surroundings;
use crate::localization::reference_map::ReferenceMap;
use crate::model::geometry::{Point2, Pose2};
use crate::model::random::Random;

/// A place on the floor of the flat.
fn drawn_pose(map: &ReferenceMap, random: &mut Random) -> Pose2 {
    loop {
        let pose = Pose2 {
            x_m: random.between(0.0, 6.2),
            y_m: random.between(0.0, 3.7),
            heading_rad: random.between(-3.0, 3.0),
        };
        if map.clearance_m(pose.position()) > 0.2 {
            return pose;
        }
    }
}

/// The pose of a position in a direction.
fn facing(at: &Point2, direction: u32) -> Pose2 {
    Pose2 {
        x_m: at.x_m,
        y_m: at.y_m,
        heading_rad: direction_rad(direction),
    }
}

fn blocks(floor: &FloorBlocks) -> impl Iterator<Item = usize> {
    (0..).take_while(|number| floor.block(*number).is_some())
}

#[test]
fn no_position_of_a_block_scores_more_than_its_bound() {
    let map = ReferenceMap::of(&flat());
    let floor = map.floor_blocks();
    let mut random = Random::new(3);
    let (mut dropped, mut judged) = (0, 0);
    for _ in 0..6 {
        let probes = Probes::around(&map, drawn_pose(&map, &mut random), &mut random);
        let least = PARAMETERS.coarse_share_min * probes.solid();
        for direction in (0..PARAMETERS.directions).step_by(5) {
            for block in blocks(&floor).filter_map(|number| floor.block(number)) {
                let at_most = probes.score_at_most(&map, (block, direction_rad(direction)), least);
                judged += 1;
                dropped += u32::from(at_most.is_none());
                for at in floor.positions(block) {
                    let Some(score) = probes.score(&map, facing(at, direction), least) else {
                        continue;
                    };
                    assert!(
                        at_most.is_some_and(|at_most| score <= at_most + 1e-9),
                        "{at:?} scores {score}, its block {at_most:?} at most"
                    );
                }
            }
        }
    }
    assert!(
        3 * dropped > judged,
        "only {dropped} of {judged} blocks are dropped"
    );
}

#[test]
fn a_search_finds_the_best_of_all_positions() {
    let map = ReferenceMap::of(&flat());
    let mut random = Random::new(9);
    for _ in 0..4 {
        let truth = drawn_pose(&map, &mut random);
        let probes = Probes::around(&map, truth, &mut random);
        let mut best = 0.0_f64;
        let floor = map.floor_blocks();
        for direction in 0..PARAMETERS.directions {
            for block in blocks(&floor).filter_map(|number| floor.block(number)) {
                for at in floor.positions(block) {
                    let score = probes.score(&map, facing(at, direction), f64::NEG_INFINITY);
                    best = best.max(score.unwrap_or_default());
                }
            }
        }
        let mut search = GlobalLocalizer::among(floor, probes.clone(), probes);
        while !matches!(search.stage, SearchStage::Refine { .. }) {
            search.go_on(&map);
        }
        let coarse = search
            .found
            .first()
            .map(|found| found.score * search.coarse.solid());
        assert!(
            coarse.is_some_and(|coarse| (coarse - best).abs() < 1e-9),
            "it found {coarse:?}, the best is {best}"
        );
        while search.candidates().is_none() {
            search.go_on(&map);
        }
        let found = search.candidates().unwrap_or_default();
        assert!(
            found
                .iter()
                .any(|found| found.pose.position().distance_m(truth.position()) < 0.1),
            "{truth:?} is none of {found:?}"
        );
    }
}
