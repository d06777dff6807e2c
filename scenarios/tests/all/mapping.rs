//! The map that a robot makes while it cleans, beside the true plan of the home. The pose is the true one, so that the map
//! alone is judged.

use brain::{CELL_M, CellKnowledge};
use rvac_sim::run::start_cleaning;
use rvac_sim::{Household, PoseSource};
use scenarios::{household, scene, settings};

const MINUTES: u64 = 25;

/// Free floor: what is known and right, over what is known and what the body could reach but does not know; and the mean
/// distance of known obstacle cells beside free ones from the true surface, in metres.
struct Agreement {
    iou: f64,
    wall_error_m: f64,
    cliffs: usize,
    cliffs_on_floor: usize,
}

fn cleaned(home: &str) -> Household {
    let scene = scene(home, "nominal");
    let mut household = household(&scene, &settings(3, 0)).with_pose_source(PoseSource::Truth);
    assert!(start_cleaning(&mut household, brain::StrategyName::Bounce));
    household.pass_ms(MINUTES * 60_000);
    household
}

fn agreement(household: &Household, start: home::Pose) -> Agreement {
    let home = household.robot().world().home();
    let map = household
        .host()
        .and_then(rvac_sim::Host::brain)
        .expect("a brain")
        .map();
    let (knowledge, grid) = (map.knowledge(), home.grid());
    let (mut known, mut right, mut found) = (0.0, 0.0, 0.0);
    let (mut off_m, mut surfaces, mut cliffs, mut cliffs_on_floor) = (0.0, 0.0, 0, 0);
    for (index, kind) in knowledge.values().iter().enumerate() {
        let cell = knowledge.cell(index);
        let (x_m, y_m) = start.point(
            (f64::from(cell.x) + 0.5) * CELL_M,
            (f64::from(cell.y) + 0.5) * CELL_M,
        );
        match kind {
            CellKnowledge::Free => {
                known += 1.0;
                right += f64::from(u8::from(grid.at(x_m, y_m).is_floor()));
                let place = grid.index(x_m, y_m).and_then(|place| home.reachable().get(place));
                found += f64::from(u8::from(place == Some(&true)));
            }
            CellKnowledge::Occupied => {
                let beside = [1, knowledge.width()].iter().any(|step| {
                    [index.checked_sub(*step), index.checked_add(*step)]
                        .iter()
                        .flatten()
                        .any(|place| knowledge.values().get(*place) == Some(&CellKnowledge::Free))
                });
                if beside {
                    surfaces += 1.0;
                    off_m += home.clearance_m(x_m, y_m).abs();
                }
            }
            CellKnowledge::Cliff => {
                cliffs += 1;
                // An edge is seen by a beam of some width, from a sensor that moves on while it is read.
                let around = [(-0.05, 0.0), (0.05, 0.0), (0.0, -0.05), (0.0, 0.05), (0.0, 0.0)];
                let is_edge = around.iter().any(|(x, y)| !grid.at(x_m + x, y_m + y).is_floor());
                cliffs_on_floor += usize::from(!is_edge);
            }
            _ => {}
        }
    }
    let reachable = home.reachable_area_m2() / (CELL_M * CELL_M);
    Agreement {
        iou: right / (known + (reachable - found).max(0.0)),
        wall_error_m: off_m / surfaces,
        cliffs,
        cliffs_on_floor,
    }
}

#[test]
fn a_furnished_room_is_mapped_while_it_is_cleaned() {
    let start = scene("furnished-room", "nominal")
        .robot(3, &Default::default())
        .world()
        .truth()
        .pose;
    let household = cleaned("furnished-room");
    let found = agreement(&household, start);
    println!("IoU {:.3}, walls {:.3} m", found.iou, found.wall_error_m);
    assert!(found.iou > 0.9, "free floor agrees by {:.3} only", found.iou);
    assert!(
        found.wall_error_m < 0.03,
        "walls are {:.3} m off",
        found.wall_error_m
    );
    assert_eq!(found.cliffs, 0, "a floor without edges");
}

#[test]
fn stairs_are_edges_and_nothing_else_is() {
    let start = scene("stairs", "nominal")
        .robot(3, &Default::default())
        .world()
        .truth()
        .pose;
    let household = cleaned("stairs");
    let found = agreement(&household, start);
    println!(
        "IoU {:.3}, walls {:.3} m, {} cells of cliff",
        found.iou, found.wall_error_m, found.cliffs
    );
    assert!(found.cliffs > 10, "{} cells of cliff only", found.cliffs);
    assert_eq!(found.cliffs_on_floor, 0);
}
