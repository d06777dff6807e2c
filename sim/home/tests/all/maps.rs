//! Real floor plans, if they lie beside the project.

use std::path::{Path, PathBuf};

use crate::scene::sr8730;
use home::Home;

fn maps() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/maps");
    if !folder.is_dir() {
        eprintln!("skipped: there are no maps in {}", folder.display());
        return None;
    }
    Some(folder)
}

fn check(folder: &Path, name: &str, free_m2: [f64; 2], reachable_m2: [f64; 2]) {
    let home = Home::load(&folder.join(name), &sr8730()).expect("the map loads");
    let (free, reachable) = (home.free_area_m2(), home.reachable_area_m2());
    assert!(free >= free_m2[0] && free <= free_m2[1], "{name}: {free} m2 free");
    assert!(
        reachable >= reachable_m2[0] && reachable <= reachable_m2[1],
        "{name}: {reachable} m2 reachable"
    );
    assert!(home.grid().cell_m <= 0.025);
    let start = home.start();
    assert!(home.clearance_m(start.x_m, start.y_m) > 0.15, "{name}: {start:?}");
}

#[test]
fn real_maps_have_their_areas() {
    let Some(folder) = maps() else {
        return;
    };
    check(
        &folder,
        "aws_small_house_bumper_02cm.yaml",
        [160.5, 160.9],
        [152.0, 156.0],
    );
    check(
        &folder,
        "aws_small_house_bumper_05cm.yaml",
        [157.0, 162.0],
        [148.0, 154.0],
    );
    check(&folder, "nav2/depot.yaml", [420.0, 460.0], [390.0, 440.0]);
    check(&folder, "nav2/tb3_house_map.yaml", [19.0, 20.5], [17.0, 20.0]);
    check(&folder, "nav2/tb3_sandbox.yaml", [19.0, 20.5], [17.0, 20.0]);
}

#[test]
fn every_valetudo_map_loads_and_most_of_its_floor_is_reachable() {
    let Some(folder) = maps() else {
        return;
    };
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder.join("valetudo"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    assert!(!files.is_empty());
    for path in files {
        let home = Home::load(&path, &sr8730()).unwrap();
        let share = home.reachable_area_m2() / home.free_area_m2();
        assert!(share > 0.4 && share <= 1.0, "{}: {share}", path.display());
        assert!(home.free_area_m2() > 5.0 && home.free_area_m2() < 200.0);
    }
}
