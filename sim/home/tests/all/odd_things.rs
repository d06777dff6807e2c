//! Mirrors, black carpets, people in the robot's path, and a start pose of the file.

use std::sync::Arc;

use home::{Actuation, Home, Noise, Pose, RobotModel, Sensors, World};

const HEAD: &str =
    "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0, 0], [4, 0], [4, 3], [0, 3]]\n";

fn home(things: &str) -> Home {
    let model = RobotModel::by_name("sr8730").unwrap();
    Home::from_floorplan("odd", &format!("{HEAD}{things}"), &model).unwrap()
}

/// A robot that rests here for so long.
fn standing(home: Home, pose: Option<Pose>, ms: u64) -> World {
    let model = RobotModel::by_name("sr8730").unwrap();
    let mut world = World::new(Arc::new(home), &model, &Noise::ideal(), 1, pose);
    let lit = Actuation {
        cliff_emitter: true,
        ..Actuation::default()
    };
    for _ in 0..ms {
        world.step(&lit);
    }
    world
}

fn strongest(sensors: &Sensors) -> u8 {
    sensors.proximity.iter().copied().max().unwrap_or(0)
}

#[test]
fn a_mirror_answers_only_at_a_right_angle() {
    let mirror = "[[mirror]]\nfrom = [4, 0]\nto = [4, 3]\n";
    // The front sensor faces the wall, or all sensors are turned away from its normal by 15 degrees.
    let at_wall = |things: &str, degrees: f64| {
        let pose = Pose::new(3.83, 1.5, degrees.to_radians());
        strongest(standing(home(things), Some(pose), 100).sensors())
    };
    assert!(
        at_wall("", 0.0) > 50 && at_wall("", 15.0) > 50,
        "a wall is seen from both"
    );
    assert!(at_wall(mirror, 0.0) > 50);
    assert_eq!(at_wall(mirror, 15.0), 0);
}

#[test]
fn cliff_sensors_see_no_floor_on_a_black_rug_and_its_area_does_not_count() {
    let rug = |black: &str| format!("[[rug]]\npolygon = [[1.5, 1], [2.5, 1], [2.5, 2], [1.5, 2]]\n{black}\n");
    let pose = Pose::new(2.0, 1.5, 0.0);
    let levels = |black: &str| {
        standing(home(&rug(black)), Some(pose), 100)
            .sensors()
            .cliff_levels
    };
    assert!(levels("").iter().take(3).all(|level| *level > 100));
    assert!(levels("black = true").iter().take(3).all(|level| *level < 40));
    let lost_m2 = home(&rug("")).reachable_area_m2() - home(&rug("black = true")).reachable_area_m2();
    assert!((0.9..1.3).contains(&lost_m2), "{lost_m2}");
}

#[test]
fn a_visitor_comes_waits_for_the_robot_and_leaves() {
    let visitor = "[[visitor]]\nposition = [2.0, 1.5]\ndiameter-m = 0.3\nfrom-s = 1.0\nuntil-s = 3.0\n";
    let clearance_m = |pose: Pose, ms: u64| {
        standing(home(visitor), Some(pose), ms)
            .home()
            .clearance_m(2.0, 1.5)
    };
    let away = Pose::new(0.5, 0.5, 0.0);
    assert!(clearance_m(away, 500) > 1.0, "nobody yet");
    assert!(clearance_m(away, 2_000) < 0.0, "somebody stands there");
    assert!(clearance_m(away, 4_000) > 1.0, "and has left");
    assert!(
        clearance_m(Pose::new(2.1, 1.5, 0.0), 2_000) > 1.0,
        "not onto the robot"
    );
}

const WALKER: &str =
    "[[walker]]\nkind = \"person\"\ngoals = [[0.5, 2.0], [3.5, 2.0]]\nrest-s = 1\nfrom-s = 1\nuntil-s = 60\n";

/// A robot with this duty of its wheels, and a walker.
fn among_walkers(walker: &str, pose: Pose, duty: f64, ms: u64) -> World {
    let mut world = standing(home(walker), Some(pose), 0);
    let wheel = home::Bridge {
        pwm: duty,
        brake: true,
    };
    let drive = Actuation {
        wheel_left: wheel,
        wheel_right: wheel,
        ..Actuation::default()
    };
    for _ in 0..ms {
        world.step(&drive);
    }
    world
}

#[test]
fn nobody_steps_onto_a_robot_that_stands_in_the_way() {
    for x_m in [1.0, 1.5, 2.1, 2.2, 2.3] {
        let world = among_walkers(WALKER, Pose::new(x_m, 2.06, 0.0), 0.0, 60_000);
        assert_eq!(world.truth().foot_contacts, 0, "{x_m}");
        assert_eq!(world.truth().contacts, 0, "{x_m}");
    }
}

#[test]
fn a_robot_without_reflexes_runs_into_feet() {
    // Along the path, so that sooner or later a foot is ahead.
    let world = among_walkers(WALKER, Pose::new(0.6, 2.06, 0.0), 0.25, 30_000);
    assert!(world.truth().foot_contacts > 0 && world.truth().foot_pushed_max_ms > 0);
}

#[test]
fn infrared_sees_feet_only_while_they_are_there() {
    let mut seen = [false; 70];
    for x_m in [1.6, 1.7, 1.8, 1.9, 2.0, 2.1, 2.2, 2.3] {
        // Beside the path, so that no walker waits for the robot.
        let pose = Pose::new(x_m, 1.62, core::f64::consts::FRAC_PI_2);
        let mut world = standing(home(WALKER), Some(pose), 0);
        for second in &mut seen {
            for _ in 0..1_000 {
                world.step(&Actuation::default());
                *second |= strongest(world.sensors()) > 30;
            }
        }
    }
    assert!(!seen[0], "nobody yet");
    let during = &seen[1..60];
    assert!(during.iter().any(|seen| *seen) && !during.iter().all(|seen| *seen));
    assert!(!seen[61..].iter().any(|seen| *seen), "all have left");
}

#[test]
fn a_home_may_say_where_the_robot_starts() {
    let home = home("[start]\nposition = [1.0, 2.0]\nheading-deg = 90\n");
    let offset = home.file_from_plan();
    let start = home.start();
    assert!((start.x_m + offset.x_m - 1.0).abs() < 1e-9 && (start.y_m + offset.y_m - 2.0).abs() < 1e-9);
}

#[test]
fn senseless_things_are_refused() {
    let model = RobotModel::by_name("sr8730").unwrap();
    for (things, named) in [
        (
            "[[visitor]]\nposition = [1, 1]\ndiameter-m = 0.3\nfrom-s = 5\nuntil-s = 5\n",
            "visitor",
        ),
        (
            "[[visitor]]\nposition = [1, 1]\ndiameter-m = 9\nfrom-s = 1\nuntil-s = 5\n",
            "visitor",
        ),
        ("[[mirror]]\nfrom = [0, 0]\nto = [nan, 0]\n", "mirror"),
        ("[start]\nposition = [1, 1]\nheading-deg = 999\n", "start"),
        (
            "[[walker]]\nkind = \"pet\"\ngoals = [[1, 1]]\nfrom-s = 1\nuntil-s = 5\n",
            "walker",
        ),
        (
            "[[walker]]\nkind = \"pet\"\ngoals = [[1, 1], [2, 2]]\nfrom-s = 5\nuntil-s = 5\n",
            "walker",
        ),
    ] {
        let error = Home::from_floorplan("odd", &format!("{HEAD}{things}"), &model).unwrap_err();
        assert!(error.to_string().contains(named), "{error}");
    }
}
