//! The published set of generated homes.

use home::generate::{GeneratedHome, PUBLISHED, People};
use home::{Cell, Fnv1a, Home, RobotModel};

fn sr8730() -> RobotModel {
    RobotModel::by_name("sr8730").unwrap()
}

/// Figures of benches are of these homes: a change of the generator changes the hash, and then all figures must be taken
/// again.
#[test]
#[ignore = "campaign: fifty homes; cargo xtask test --all"]
fn every_published_home_has_a_dock_and_hangs_together() {
    let model = sr8730();
    let mut digest = Fnv1a::default();
    let mut areas_m2 = Vec::new();
    for number in PUBLISHED {
        let text = GeneratedHome::number(number).floorplan(&model).unwrap();
        let home = Home::from_floorplan("generated", &text, &model).unwrap();
        assert!(home.dock().is_some(), "{number}");
        assert!(home.connected_share() >= 0.95, "{number}");
        let share = home.reachable_area_m2() / home.free_area_m2();
        assert!(share > 0.8, "{number}: {share}");
        areas_m2.push(home.free_area_m2());
        text.bytes().for_each(|byte| digest.byte(byte));
    }
    areas_m2.sort_by(f64::total_cmp);
    assert!(areas_m2[0] > 15.0 && areas_m2[49] < 200.0, "{areas_m2:?}");
    assert!(
        areas_m2[5] < 40.0 && areas_m2[30] > 80.0,
        "small and large: {areas_m2:?}"
    );
    assert_eq!(format!("{:016x}", digest.value()), "fa83fb485a1b3a41");
}

/// What makes homes difficult, by its keyword in a plan.
const TRAPS: [&str; 6] = [
    "[[cliff]]",
    "[[mirror]]",
    "black = true",
    "# a cable",
    "[[threshold]]",
    "legs = ",
];

#[test]
fn each_half_of_the_set_holds_what_makes_homes_difficult() {
    let model = sr8730();
    let mut found = [[0; TRAPS.len()]; 2];
    for number in PUBLISHED {
        let text = GeneratedHome::number(number).floorplan(&model).unwrap();
        for (trap, count) in TRAPS.iter().zip(&mut found[number as usize % 2]) {
            *count += u32::from(text.contains(trap));
        }
    }
    assert!(found.as_flattened().iter().all(|count| *count >= 1), "{found:?}");
}

#[test]
fn another_day_moves_chairs_but_not_walls() {
    let model = sr8730();
    let monday = GeneratedHome::number(5).floorplan(&model).unwrap();
    let tuesday = GeneratedHome::parse("5/1").unwrap().floorplan(&model).unwrap();
    let walls = |text: &str| -> Vec<String> {
        let tables = text.split("\n\n");
        let fixed = ["[[room]]", "[[door]]", "[dock]"];
        tables
            .filter(|table| fixed.iter().any(|head| table.starts_with(head)))
            .map(str::to_owned)
            .collect()
    };
    assert_eq!(walls(&monday), walls(&tuesday));
    assert_ne!(monday, tuesday);
}

#[test]
fn people_stand_in_the_way_and_leave() {
    let model = sr8730();
    let home = GeneratedHome::parse("5+people").unwrap();
    assert_eq!(home.people, People::In);
    let text = home.floorplan(&model).unwrap();
    assert_eq!(text.matches("[[visitor]]").count(), 8);
    assert_eq!(text.matches("[[walker]]").count(), 3);
    let empty = GeneratedHome::number(5).home(&model).unwrap();
    let peopled = home.home(&model).unwrap();
    let free = |home: &Home| {
        home.grid()
            .cells
            .iter()
            .filter(|cell| **cell != Cell::Obstacle)
            .count()
    };
    assert_eq!(free(&empty), free(&peopled), "nobody is there at the start");
}

#[test]
fn names_are_read_exactly() {
    assert_eq!(GeneratedHome::parse("7"), Some(GeneratedHome::number(7)));
    let name = "12/3+people";
    assert_eq!(GeneratedHome::parse(name).unwrap().to_string(), name);
    for wrong in ["", "0", "-1", "1..50", "5/", "5/x", "5+cats", "x"] {
        assert_eq!(GeneratedHome::parse(wrong), None, "{wrong}");
    }
}
