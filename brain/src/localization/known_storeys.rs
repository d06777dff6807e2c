//! Tests with the robot of [`super::known_home`] and maps of several storeys.

use super::known_home::{START, SimulatedRobot, config, flat};
use super::{StoreyFinder, StoreyFinding};
use crate::mapping::StoredMap;
use crate::model::geometry::Point2;

/// The mirror image of the flat: walls and furniture of the same sizes.
fn mirrored(home: &StoredMap) -> StoredMap {
    let knowledge = home.knowledge();
    let mut mirrored = knowledge.clone();
    for (place, row) in mirrored
        .values_mut()
        .chunks_exact_mut(knowledge.width())
        .zip(knowledge.values().chunks_exact(knowledge.width()))
    {
        place.copy_from_slice(row);
        place.reverse();
    }
    StoredMap::from_raster(&mirrored, None)
}

/// The result for a robot that drives in the flat for so many minutes.
fn sought(floors: &[StoredMap], minutes: u32) -> (StoreyFinding, Point2) {
    let home = flat();
    let mut truth = SimulatedRobot::new(&home, START);
    let mut finder = StoreyFinder::new(&config(), 5, (1..).zip(floors));
    let mut finding = StoreyFinding::Open;
    for _ in 0..60 * 50 * minutes {
        finding = finder.follow(truth.step());
        if matches!(finding, StoreyFinding::Found(_)) {
            break;
        }
    }
    (finding, truth.pose.position())
}

#[test]
fn a_flat_is_told_from_its_mirror_image() {
    let own = flat().stored();
    let (finding, there) = sought(&[mirrored(&own), own], 6);
    let StoreyFinding::Found(place) = finding else {
        panic!("{finding:?}");
    };
    assert_eq!(place.floor, 2);
    let off_m = place.pose.position().distance_m(there);
    assert!(off_m < 0.15, "{off_m} m");
}

#[test]
fn storeys_that_are_alike_or_of_another_home_are_not_found() {
    let own = flat().stored();
    assert_eq!(sought(&[own.clone(), own.clone()], 6).0, StoreyFinding::Unclear);
    assert_eq!(sought(&[mirrored(&own)], 6).0, StoreyFinding::Unclear);
}
