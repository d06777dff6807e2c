//! What a run in a known home teaches: the merge of its evidence with what earlier runs left.
//!
//! Occupancy is a sum of log odds (Moravec and Elfes 1985), which takes every sighting as independent. The sightings of one run
//! are not: they share the errors of its pose. So a run counts as one observation, and changes a cell by a bounded amount in either
//! direction. What contradicts the home over several runs replaces what was known. Touches age in runs.

use super::Cell;
use super::cell_past::CellPast;
use super::kept_home::KeptHome;
use super::occupancy_grid::{Evidence, Flag, OccupancyGrid, is_seen_solid, is_touched};
use crate::model::gradual::StepBudget;

/// How far one run changes what is known.
pub(super) struct LearningParameters {
    /// Most by which a run changes occupancy.
    occupancy_step: i8,
    /// Most occupancy that is kept, in both directions. With the step it makes three runs until an obstacle on known floor counts, and
    /// three until the floor under a removed one does.
    occupancy_kept: i8,
    /// The body passed a touch when it was so near, cells: plans keep it at least a cell away.
    passed_cells: [i32; 4],
    /// What a run shows settles after this time, microseconds: a robot that drifts notices it later.
    pub(super) settling_us: u64,
    /// The grid is remembered so often, microseconds.
    pub(super) remembered_us: u64,
}

pub(super) const LEARNING: LearningParameters = LearningParameters {
    occupancy_step: 24,
    occupancy_kept: 60,
    passed_cells: [3, 6, 9, 12],
    settling_us: 60_000_000,
    remembered_us: 30_000_000,
};

/// Work of comparing a cell with what was known of it.
const CELL_WORK: usize = 6;

/// The home after a run that began with `kept` and gathered `run` on top of it.
pub(super) async fn merged(kept: &KeptHome, run: &OccupancyGrid, budget: &mut StepBudget) -> OccupancyGrid {
    let mut merged = run.clone();
    for (cell, evidence) in run.gathered() {
        let before = kept.at(cell);
        let is_passed = || evidence.past.runs_left > 0 && was_passed(run, cell);
        let after = merged_cell(before, evidence, is_passed());
        if after != evidence {
            merged.change(cell, |place| *place = after);
        }
        budget.spend(CELL_WORK).await;
    }
    merged
}

/// Whether the body came close to a cell in this run.
fn was_passed(run: &OccupancyGrid, cell: Cell) -> bool {
    let sides = [
        (1, 0),
        (1, 1),
        (0, 1),
        (-1, 1),
        (-1, 0),
        (-1, -1),
        (0, -1),
        (1, -1),
    ];
    sides.iter().any(|(x, y)| {
        LEARNING.passed_cells.iter().any(|distance| {
            let beside = Cell {
                x: cell.x.saturating_add(distance * x),
                y: cell.y.saturating_add(distance * y),
            };
            run.at(beside).has(Flag::Driven)
        })
    })
}

fn merged_cell(kept: Evidence, run: Evidence, is_passed: bool) -> Evidence {
    let mut merged = Evidence {
        occupancy: learnt_occupancy(kept.occupancy, run.occupancy),
        ..run
    };
    learn_touch(&mut merged, kept, is_passed);
    if is_seen_solid(merged) {
        // What stands there now came after the body.
        merged.clear(Flag::Body);
    }
    merged
}

fn learnt_occupancy(kept: i8, run: i8) -> i8 {
    if run == kept {
        return kept;
    }
    let (limit, step) = (LEARNING.occupancy_kept, LEARNING.occupancy_step);
    let change = i16::from(run) - i16::from(kept);
    let change = change.clamp(i16::from(-step), i16::from(step)) as i8;
    kept.clamp(-limit, limit)
        .saturating_add(change)
        .clamp(-limit, limit)
}

/// Touches of a run that began with `kept`.
fn learn_touch(merged: &mut Evidence, kept: Evidence, is_passed: bool) {
    if is_touched(*merged) && merged.contact > kept.contact {
        merged.past = kept.past.after_touch();
        let is_proven = merged.past.touched_runs > 1 || !kept.has(Flag::Body);
        if !is_proven {
            merged.contact = 0;
        }
    } else if merged.has(Flag::Driven) && !is_touched(*merged) {
        merged.past = CellPast::default();
        merged.contact = 0;
    } else if is_passed {
        merged.past = kept.past.after_passing();
        if merged.past.runs_left == 0 {
            merged.contact = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LEARNING, merged_cell};
    use crate::mapping::occupancy_grid::{CellKnowledge, Evidence, Flag};

    const FLOOR: Evidence = Evidence {
        occupancy: -84,
        ..EMPTY
    };
    const WALL: Evidence = Evidence {
        occupancy: 84,
        ..EMPTY
    };
    const EMPTY: Evidence = Evidence {
        occupancy: 0,
        contact: 0,
        cliff: 0,
        sigma_cm: 0,
        flags: 0,
        carpet: 0,
        past: crate::mapping::cell_past::CellPast {
            touched_runs: 0,
            runs_left: 0,
        },
    };

    /// Runs after which a cell is known as `wanted`, when each of them ends with this evidence.
    fn runs_until(wanted: CellKnowledge, begun: Evidence, run: Evidence) -> u32 {
        let mut kept = begun;
        for runs in 1..=20 {
            kept = merged_cell(kept, run, true);
            if kept.knowledge() == wanted {
                return runs;
            }
        }
        u32::MAX
    }

    #[test]
    fn what_stands_elsewhere_now_is_learnt_in_three_runs_and_not_in_one() {
        assert_eq!(runs_until(CellKnowledge::Occupied, FLOOR, WALL), 3);
        assert_eq!(runs_until(CellKnowledge::Free, WALL, FLOOR), 3);
        assert_eq!(runs_until(CellKnowledge::Occupied, EMPTY, WALL), 1, "new floor");
    }

    #[test]
    fn evidence_is_bounded_and_what_a_run_did_not_see_stays() {
        let mut run = WALL;
        run.occupancy = 100;
        let kept = merged_cell(WALL, run, false);
        assert_eq!(kept.occupancy, LEARNING.occupancy_kept);
        assert_eq!(merged_cell(kept, kept, false), kept);
        assert_eq!(merged_cell(WALL, WALL, false), WALL);
    }

    fn touched(begun: Evidence) -> Evidence {
        let mut run = begun;
        run.contact += 4;
        run
    }

    #[test]
    fn a_touch_expires_after_two_runs_that_pass_it_and_later_each_time_it_is_met_again() {
        let mut kept = merged_cell(EMPTY, touched(EMPTY), true);
        for lasts in [2, 4, 8, 8] {
            for _ in 0..lasts {
                assert_eq!(kept.knowledge(), CellKnowledge::Occupied);
                kept = merged_cell(kept, kept, true);
            }
            assert_eq!(kept.knowledge(), CellKnowledge::Unknown, "after {lasts} runs");
            kept = merged_cell(kept, touched(kept), true);
        }
        assert_eq!(
            merged_cell(kept, kept, false),
            kept,
            "runs elsewhere do not count"
        );
    }

    #[test]
    fn a_touch_that_the_body_drove_over_is_gone() {
        let kept = merged_cell(EMPTY, touched(EMPTY), true);
        let mut run = kept;
        run.contact = 0;
        run.occupancy = -100;
        run.set(Flag::Body);
        run.set(Flag::Driven);
        let kept = merged_cell(kept, run, true);
        assert_eq!(kept.knowledge(), CellKnowledge::Free);
        assert_eq!(kept.past, EMPTY.past);
    }

    #[test]
    fn floor_that_was_driven_is_floor_until_two_runs_touched_something_there() {
        let mut driven = FLOOR;
        driven.set(Flag::Body);
        let once = merged_cell(driven, touched(driven), true);
        assert_eq!(once.knowledge(), CellKnowledge::Free);
        let twice = merged_cell(once, touched(once), true);
        assert_eq!(twice.knowledge(), CellKnowledge::Occupied);
        let passed = merged_cell(merged_cell(once, once, true), once, true);
        assert_eq!(passed.knowledge(), CellKnowledge::Free);
    }

    #[test]
    fn what_stands_on_driven_floor_came_after_the_body() {
        let mut driven = FLOOR;
        driven.set(Flag::Body);
        let mut run = WALL;
        run.set(Flag::Body);
        let mut kept = driven;
        for _ in 0..3 {
            kept = merged_cell(kept, run, true);
        }
        assert!(!kept.has(Flag::Body) && kept.knowledge() == CellKnowledge::Occupied);
    }
}
