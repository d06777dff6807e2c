//! Plans that sweep in rings: floors of several shapes, and any floor at all.

use crate::passed::passed;
use crate::plane::{BODY, SPEEDS};
use brain::coverage::plan::{CoveragePlan, Departure, PlanSettings, plan_pattern};
use brain::{Cell, Pattern, Pose2, Raster};
use proptest::prelude::*;

const SETTINGS: PlanSettings = PlanSettings {
    swath_m: BODY.swath_m,
    sigma_m: 0.01,
    cruise_m_per_s: SPEEDS.cruise_m_per_s,
    turn_rad_per_s: SPEEDS.turn_max_rad_per_s,
    takes_along: true,
};

const START: Pose2 = Pose2 {
    x_m: 0.3,
    y_m: 0.2,
    heading_rad: 1.0,
};

fn from(start: Pose2) -> Departure {
    Departure {
        start,
        settings: SETTINGS,
    }
}

/// Ground of so many cells without some rectangles: column, row, width and height of each.
fn ground((width, height): (i32, i32), furniture: &[[i32; 4]]) -> Raster<bool> {
    let mut ground = Raster::filled(Cell::default(), width as usize, height as usize, true);
    for [x, y, wide, high] in furniture {
        for (x, y) in (*x..x + wide).flat_map(|x| (*y..y + high).map(move |y| (x, y))) {
            if let Some(cell) = ground.get_mut(Cell { x, y }) {
                *cell = false;
            }
        }
    }
    ground
}

fn plan(ground: &Raster<bool>, pattern: Pattern) -> CoveragePlan {
    plan_pattern(ground, pattern, |_| false, from(START))
}

fn turned_deg(plan: &CoveragePlan) -> f64 {
    plan.segments
        .iter()
        .map(|segment| segment.turn_rad.abs().to_degrees())
        .sum()
}

fn length_m(plan: &CoveragePlan) -> f64 {
    plan.segments.iter().map(|segment| segment.length_m).sum()
}

#[test]
fn rings_sweep_nearly_as_much_as_lanes_in_no_more_time() {
    for (name, size, furniture) in [
        ("rectangle", (160, 120), vec![]),
        ("an L", (160, 120), vec![[80, 60, 80, 60]]),
        ("an island", (160, 120), vec![[60, 50, 30, 20]]),
        ("two rooms", (200, 120), vec![[96, 0, 16, 90]]),
    ] {
        let ground = ground(size, &furniture);
        let (rings, lanes) = (plan(&ground, Pattern::Contour), plan(&ground, Pattern::Lines));
        let shares = (passed(&rings, &ground), passed(&lanes, &ground));
        assert!(
            shares.0 > 0.98 && shares.0 > shares.1 - 0.02,
            "{name}: {shares:?}"
        );
        let (time_s, lanes_s) = (rings.time_s, lanes.time_s);
        assert!(
            time_s < 1.05 * lanes_s,
            "{name}: {time_s} s instead of {lanes_s} s"
        );
        let turned = (turned_deg(&rings), turned_deg(&lanes));
        assert!(turned.0 < 1.3 * turned.1, "{name}: {turned:?}");
    }
}

#[test]
fn a_corridor_narrower_than_a_swath_is_driven_once() {
    let ground = ground((200, 1), &[]);
    let start = Pose2 { x_m: 0.05, ..START };
    let plan = plan_pattern(&ground, Pattern::Contour, |_| false, from(start));
    assert!(passed(&plan, &ground) > 0.99);
    // It is 5 m long.
    assert!(length_m(&plan) < 6.0, "{} m", length_m(&plan));
}

#[test]
fn what_is_swept_is_not_driven_again() {
    let ground = ground((160, 120), &[]);
    let left_half = |cell: Cell| cell.x < 80;
    let rest = plan_pattern(&ground, Pattern::Contour, left_half, from(START));
    let whole = plan(&ground, Pattern::Contour);
    assert!(
        rest.time_s < 0.65 * whole.time_s,
        "{} of {} s",
        rest.time_s,
        whole.time_s
    );
    let nothing = plan_pattern(&ground, Pattern::Contour, |_| true, from(START));
    assert_eq!((nothing.lanes, nothing.open_m2), (0, 0.0));
}

/// Ground of any shape, and a place from which a plan begins.
fn any_ground() -> impl Strategy<Value = (Raster<bool>, Pose2)> {
    let furniture = prop::collection::vec([0..90, 0..90, 1..40, 1..40], 0..12);
    let start = (-1.0..3.0_f64, -1.0..3.0_f64, -3.0..3.0_f64);
    ((1..90, 1..90), furniture, start).prop_map(|(size, furniture, (x_m, y_m, heading_rad))| {
        let start = Pose2 {
            x_m,
            y_m,
            heading_rad,
        };
        (ground(size, &furniture), start)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    /// A plan for any ground and anything that is swept already turns on ground that the body can take, and leaves little.
    #[test]
    fn any_ground_is_swept_on_ground((ground, start) in any_ground(), swept in [0..90, 0..90, 0..60, 0..60]) {
        let [x, y, wide, high] = swept;
        let is_swept = |cell: Cell| (x..x + wide).contains(&cell.x) && (y..y + high).contains(&cell.y);
        let plan = plan_pattern(&ground, Pattern::Contour, is_swept, from(start));
        for corner in &plan.corners {
            prop_assert_eq!(ground.get(Cell::under(*corner)), Some(&true));
        }
        prop_assert!(plan.left_m2 <= plan.open_m2);
        let lanes = plan_pattern(&ground, Pattern::Lines, is_swept, from(start));
        prop_assert!(plan.left_m2 <= lanes.left_m2 + 0.15, "{} and {} m2", plan.left_m2, lanes.left_m2);
    }
}
