//! Drawn traps.

use home::traps::{Trap, TrapKind};
use home::{Home, Pose, RobotModel};

const RADIUS_M: f64 = 0.175;

fn drawn() -> impl Iterator<Item = Trap> {
    let kinds = TrapKind::ALL.iter().copied();
    kinds.flat_map(|kind| (1..=20).map(move |seed| Trap { kind, seed }))
}

fn home_of(trap: Trap) -> Home {
    let model = RobotModel::by_name("sr8730").unwrap();
    trap.home(&model)
        .unwrap_or_else(|error| panic!("{trap}: {error}"))
}

#[test]
fn the_robot_stands_free_inside_and_has_a_way_out_where_one_is_promised() {
    for trap in drawn() {
        let home = home_of(trap);
        let start = home.start();
        let in_file = Pose::new(
            start.x_m + home.file_from_plan().x_m,
            start.y_m + home.file_from_plan().y_m,
            0.0,
        );
        assert!(trap.bounds().contains(in_file), "{trap} begins outside");
        let clearance_m = home.clearance_m(start.x_m, start.y_m);
        assert!(clearance_m > RADIUS_M - 0.012, "{trap}: {clearance_m} m");
        assert_eq!(home.can_leave(), trap.kind.can_be_left(), "{trap}");
    }
}

#[test]
fn seeds_differ_and_repeat() {
    for kind in TrapKind::ALL {
        let trap = |seed| Trap { kind: *kind, seed }.floorplan();
        assert_ne!(trap(1), trap(2), "{}", kind.name());
        assert_eq!(trap(1), trap(1));
    }
}

#[test]
fn names_are_read_exactly() {
    let trap = Trap::parse("black-rug/7").unwrap();
    assert_eq!(
        (trap.kind, trap.seed, trap.to_string()),
        (TrapKind::BlackRug, 7, "black-rug/7".to_owned())
    );
    assert_eq!(Trap::parse("sofa").unwrap().seed, 1);
    for wrong in ["", "sofa/", "sofa/x", "sofas", "sofa/1/2", "sofa/-1"] {
        assert_eq!(Trap::parse(wrong), None, "{wrong}");
    }
}
