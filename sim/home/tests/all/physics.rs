//! The robot moves, bumps, falls, wears its battery down and charges as a robot does.

use crate::scene::{at, drive, home, ideal, room, sr8730, steps};
use home::{Actuation, Bridge, DOCK_LEFT, DOCK_NEAR, DOCK_RIGHT, Noise, Pose, RobotModel, World, WorldSeeds};

const HALF_TURN: f64 = core::f64::consts::PI;

#[test]
fn straight_drive_covers_what_the_encoders_count() {
    let home = home(&room(6.0, 4.0));
    let mut world = ideal(&home, at(&home, 1.0, 2.0, 0.0));
    steps(&mut world, 5_000, drive(0.6, 0.6));
    steps(&mut world, 1_000, drive(0.0, 0.0));
    let (truth, sensors) = (world.truth(), world.sensors());
    let start = at(&home, 1.0, 2.0, 0.0);
    let distance_m = truth.pose.x_m - start.x_m;
    assert!(distance_m > 1.0 && distance_m < 2.0, "{distance_m}");
    assert!((truth.pose.y_m - start.y_m).abs() < 1e-9);
    assert!((f64::from(sensors.count_left) * 0.0005 - distance_m).abs() < 0.001);
    assert_eq!(sensors.count_left, sensors.count_right);
    assert!((truth.path_m - distance_m).abs() < 1e-6);
    assert_eq!(truth.speed_m_per_s, 0.0);
}

#[test]
fn speed_settles_below_the_free_speed_and_follows_the_battery() {
    let home = home(&room(20.0, 4.0));
    let mut world = ideal(&home, at(&home, 0.5, 2.0, 0.0));
    steps(&mut world, 1_000, drive(1.0, 1.0));
    let full = world.truth().speed_m_per_s;
    assert!(full > 0.45 && full < 0.65, "{full}");
    world.set_battery_charge(0.05);
    steps(&mut world, 1_000, drive(1.0, 1.0));
    let empty = world.truth().speed_m_per_s;
    assert!(empty < full - 0.05, "{empty} is not below {full}");
}

#[test]
fn turning_in_place_turns_by_the_ways_over_the_track() {
    let home = home(&room(4.0, 4.0));
    let mut world = ideal(&home, at(&home, 2.0, 2.0, 0.0));
    steps(&mut world, 3_000, drive(-0.5, 0.5));
    steps(&mut world, 500, drive(0.0, 0.0));
    let (truth, sensors) = (*world.truth(), *world.sensors());
    let by_counts = f64::from(sensors.count_right - sensors.count_left) * 0.0005 / 0.23;
    assert!((truth.pose.heading_rad - by_counts).abs() < 0.01);
    let gyro = sensors.gyro.unwrap().heading.as_rad();
    assert!((truth.pose.heading_rad - gyro).abs() < 0.001, "{gyro}");
    assert!(truth.pose.distance_m(at(&home, 2.0, 2.0, 0.0)) < 1e-6);
}

#[test]
fn coasting_needs_far_more_drive_than_braking() {
    let home = home(&room(6.0, 4.0));
    let mut world = ideal(&home, at(&home, 1.0, 2.0, 0.0));
    let coast = |pwm| Actuation {
        wheel_left: Bridge { pwm, brake: false },
        wheel_right: Bridge { pwm, brake: false },
        ..Actuation::default()
    };
    steps(&mut world, 1_000, coast(0.6));
    assert_eq!(world.truth().path_m, 0.0);
    steps(&mut world, 1_000, coast(0.9));
    assert!(world.truth().path_m > 0.1);
}

#[test]
fn nonsense_on_the_pins_is_bounded() {
    let home = home(&room(6.0, 4.0));
    let mut world = ideal(&home, at(&home, 1.0, 2.0, 0.0));
    steps(&mut world, 100, drive(f64::NAN, f64::INFINITY));
    steps(&mut world, 100, drive(-1e300, f64::NEG_INFINITY));
    let truth = world.truth();
    assert!(truth.pose.x_m.is_finite() && truth.path_m < 0.2);
}

#[test]
fn a_wall_stops_the_body_and_presses_both_halves() {
    let home = home(&room(3.0, 3.0));
    let mut world = ideal(&home, at(&home, 1.5, 1.5, 0.0));
    steps(&mut world, 8_000, drive(0.6, 0.6));
    let (truth, sensors) = (world.truth(), world.sensors());
    assert!(sensors.bumper_left && sensors.bumper_right);
    assert_eq!(truth.contacts, 1);
    assert!(truth.contact_rad.unwrap().abs() < 0.1);
    let rim = at(&home, 3.0, 0.0, 0.0).x_m - truth.pose.x_m;
    let travel = sr8730().bumper.travel_m;
    assert!((rim - (0.175 - travel)).abs() < 0.002, "{rim}");
    assert!(truth.rim_left_m_per_s > 0.01, "wheels slip at this drive");
    assert!(sensors.proximity[3] > 200, "{:?}", sensors.proximity);
}

#[test]
fn a_gentle_push_against_a_wall_stalls_the_wheels() {
    let home = home(&room(3.0, 3.0));
    let mut world = ideal(&home, at(&home, 2.7, 1.5, 0.0));
    steps(&mut world, 8_000, drive(0.3, 0.3));
    let before = world.sensors().count_left;
    steps(&mut world, 1_000, drive(0.3, 0.3));
    assert!(world.sensors().count_left - before <= 2);
    assert!(world.sensors().wheel_left_current.as_a() > 0.2);
}

#[test]
fn the_bumper_stays_pressed_while_the_robot_rests_and_opens_when_it_backs_off() {
    let home = home(&room(3.0, 3.0));
    let mut world = ideal(&home, at(&home, 2.6, 1.5, 0.0));
    steps(&mut world, 3_000, drive(0.6, 0.6));
    steps(&mut world, 3_000, drive(0.0, 0.0));
    assert!(world.sensors().bumper_left && world.sensors().bumper_right);
    steps(&mut world, 500, drive(-0.5, -0.5));
    assert_eq!(world.truth().contacts, 1, "it was one contact all the time");
    assert!(!world.sensors().bumper_left && !world.sensors().bumper_right);
    assert_eq!(world.truth().contact_rad, None);
}

/// Drives against a thin leg beside the middle of the robot's path.
fn halves_pressed_by_leg(aside_m: f64) -> (bool, bool) {
    let plan = format!(
        "{}[[furniture]]\nlegs = [[2.0, {}]]\nleg-diameter-m = 0.06\n",
        room(4.0, 4.0),
        2.0 + aside_m
    );
    let home = home(&plan);
    let mut world = ideal(&home, at(&home, 1.5, 2.0, 0.0));
    for _ in 0..5_000 {
        world.step(&drive(0.6, 0.6));
        if world.sensors().bumper_left || world.sensors().bumper_right {
            break;
        }
    }
    (world.sensors().bumper_left, world.sensors().bumper_right)
}

#[test]
fn a_leg_aside_presses_the_half_on_its_side() {
    assert_eq!(halves_pressed_by_leg(0.12), (true, false));
    assert_eq!(halves_pressed_by_leg(-0.12), (false, true));
    assert_eq!(halves_pressed_by_leg(0.0), (true, true));
    assert_eq!(halves_pressed_by_leg(0.4), (false, false));
}

#[test]
fn the_body_slides_along_a_wall_that_it_meets_at_an_angle() {
    let home = home(&room(8.0, 3.0));
    let mut world = ideal(&home, at(&home, 1.0, 0.4, -0.4));
    steps(&mut world, 6_000, drive(0.6, 0.6));
    let moved = world.truth().pose.x_m - at(&home, 1.0, 0.0, 0.0).x_m;
    assert!(moved > 0.8, "{moved}");
    assert!(home.clearance_m(world.truth().pose.x_m, world.truth().pose.y_m) > 0.165);
}

#[test]
fn a_corner_holds_the_body_inside_of_both_walls() {
    let home = home(&room(3.0, 3.0));
    let mut world = ideal(&home, at(&home, 2.0, 2.0, 0.7));
    steps(&mut world, 10_000, drive(0.7, 0.7));
    let corner = at(&home, 3.0, 3.0, 0.0);
    let pose = world.truth().pose;
    let travel = sr8730().bumper.travel_m;
    assert!(corner.x_m - pose.x_m > 0.175 - travel - 0.003, "{pose:?}");
    assert!(corner.y_m - pose.y_m > 0.175 - travel - 0.003, "{pose:?}");
    assert!(world.sensors().bumper_left && world.sensors().bumper_right);
}

const STAIRS: &str = "[[cliff]]\npolygon = [[4.0, 0.0], [6.0, 0.0], [6.0, 3.0], [4.0, 3.0]]\n";

#[test]
fn cliff_sensors_see_the_edge_before_the_wheels_reach_it() {
    let home = home(&format!("{}{STAIRS}", room(4.0, 3.0)));
    let mut world = ideal(&home, at(&home, 3.0, 1.5, 0.0));
    assert!(world.sensors().cliff_levels[..3].iter().all(|level| *level > 100));
    while world.sensors().cliff_levels[1] > 100 {
        world.step(&drive(0.6, 0.6));
        assert!(world.truth().time_ms < 10_000);
    }
    let lead = at(&home, 4.0, 0.0, 0.0).x_m - world.truth().pose.x_m;
    assert!((lead - 0.155).abs() < 0.01, "{lead}");
    assert!(!world.truth().hanging());
    steps(&mut world, 1, Actuation::default());
    assert!(
        world.sensors().cliff_levels[0] < 30,
        "emitter off reads the room's light"
    );
}

#[test]
fn a_robot_that_drives_on_falls_down_the_stairs() {
    let home = home(&format!("{}{STAIRS}", room(4.0, 3.0)));
    let mut world = ideal(&home, at(&home, 3.0, 1.5, 0.0));
    steps(&mut world, 8_000, drive(0.6, 0.6));
    assert!(world.truth().fallen && world.truth().hanging());
    assert!(world.sensors().wheel_drop_left && world.sensors().wheel_drop_right);
    let lies = world.truth().pose;
    steps(&mut world, 1_000, drive(0.6, 0.6));
    assert_eq!(world.truth().pose, lies);
    world.put_down();
    assert!(!world.truth().hanging());
    assert_eq!(world.truth().pose, home.start());
}

#[test]
fn one_wheel_over_the_edge_hangs() {
    let home = home(&format!("{}{STAIRS}", room(4.0, 3.0)));
    let world = ideal(&home, at(&home, 3.95, 1.5, HALF_TURN / 2.0));
    assert!(world.truth().right_over_cliff && !world.truth().left_over_cliff);
    assert!(world.sensors().wheel_drop_right && !world.sensors().wheel_drop_left);
}

#[test]
fn a_lifted_robot_does_not_move() {
    let home = home(&room(4.0, 3.0));
    let mut world = ideal(&home, at(&home, 1.0, 1.5, 0.0));
    world.lift();
    steps(&mut world, 2_000, drive(0.6, 0.6));
    assert!(world.sensors().wheel_drop_left && world.sensors().wheel_drop_right);
    assert!(world.sensors().cliff_levels[..3].iter().all(|level| *level < 30));
    assert!(world.sensors().count_left > 100, "the wheels turn in the air");
    assert_eq!(world.truth().path_m, 0.0);
    world.put_down();
    assert!(!world.sensors().wheel_drop_left);
    steps(&mut world, 500, drive(0.6, 0.6));
    assert!(world.truth().path_m > 0.05);
}

#[test]
fn proximity_grows_when_a_wall_comes_near() {
    let home = home(&room(4.0, 3.0));
    let levels = |gap_m: f64| {
        let mut world = ideal(&home, at(&home, 4.0 - 0.175 - gap_m, 1.5, 0.0));
        steps(&mut world, 50, drive(0.0, 0.0));
        world.sensors().proximity
    };
    let (near, middle, far) = (levels(0.02), levels(0.1), levels(0.4));
    assert!(near[3] > 2 * middle[3], "{near:?} {middle:?}");
    assert!(middle[3] > 20);
    assert_eq!(far, [0; 8]);
    assert_eq!(near[0], 0, "nothing stands on the right side");
}

#[test]
fn a_rug_slows_the_robot_and_bends_its_way() {
    let rug = "[[rug]]\npolygon = [[0.0, 0.0], [8.0, 0.0], [8.0, 4.0], [0.0, 4.0]]\ndrag-n = 3.0\nslip = 0.1\nbias-deg-per-m = 5.0\n";
    let path = |plan: &str| {
        let home = home(plan);
        let mut world = ideal(&home, at(&home, 1.0, 2.0, 0.0));
        steps(&mut world, 5_000, drive(0.6, 0.6));
        (world.truth().path_m, world.truth().pose.heading_rad)
    };
    let (bare_m, bare_rad) = path(&room(8.0, 4.0));
    let (rug_m, rug_rad) = path(&format!("{}{rug}", room(8.0, 4.0)));
    assert!(rug_m < 0.8 * bare_m, "{rug_m} {bare_m}");
    assert!(bare_rad.abs() < 1e-9 && rug_rad > 0.05);
}

#[test]
fn the_battery_empties_under_load_and_charges_on_the_dock() {
    let home = home(&format!(
        "{}[dock]\nposition = [0.0, 2.0]\nheading-deg = 0.0\n",
        room(4.0, 4.0)
    ));
    let mut world = ideal(&home, at(&home, 2.0, 2.0, 0.0));
    let cleaning = Actuation {
        brush_main: 1.0,
        brush_sides: true,
        vacuum: true,
        ..drive(0.0, 0.0)
    };
    let full_v = world.sensors().battery_voltage.as_v();
    steps(&mut world, 600_000, cleaning);
    let truth = *world.truth();
    // 1.7 A for ten minutes out of 2 Ah.
    assert!(
        (truth.battery_charge - (1.0 - 1.7 / 12.0)).abs() < 0.005,
        "{}",
        truth.battery_charge
    );
    assert!(world.sensors().battery_current.as_a() < -1.6);
    assert!(world.sensors().battery_voltage.as_v() < full_v - 0.5);

    world.put_down_at(home.start());
    assert!(world.sensors().dock_contacts && world.truth().docked);
    let charging = Actuation {
        dock_signal: true,
        ..drive(0.0, 0.0)
    };
    steps(&mut world, 600_000, charging);
    assert!(world.sensors().battery_current.as_a() > 0.8);
    assert!(world.truth().battery_charge > truth.battery_charge + 0.06);
    steps(&mut world, 3_000_000, charging);
    assert!(world.truth().battery_charge > 0.99);
    assert!(
        world.sensors().battery_temperature.as_celsius() > 25.0,
        "overcharge turns into heat"
    );
}

#[test]
fn a_silent_robot_gets_next_to_nothing_from_the_dock() {
    let home = home(&format!(
        "{}[dock]\nposition = [0.0, 2.0]\nheading-deg = 0.0\n",
        room(4.0, 4.0)
    ));
    let mut world = ideal(&home, home.start());
    steps(&mut world, 1_000, drive(0.0, 0.0));
    assert!(world.truth().docked);
    assert!(world.sensors().battery_current.as_a() < 0.0);
}

#[test]
fn the_dock_beams_tell_the_side_and_end_behind_furniture() {
    let sofa = "[[furniture]]\npolygon = [[1.0, 2.6], [1.4, 2.6], [1.4, 3.2], [1.0, 3.2]]\n";
    let dock = "[dock]\nposition = [0.0, 2.0]\nheading-deg = 0.0\n";
    let home = home(&format!("{}{sofa}{dock}", room(6.0, 4.0)));
    let heard = |x_m: f64, y_m: f64, heading_rad: f64| {
        let mut world = ideal(&home, at(&home, x_m, y_m, heading_rad));
        steps(&mut world, 50, drive(0.0, 0.0));
        world.sensors().dock_receivers
    };
    let facing = HALF_TURN;
    assert_eq!(heard(1.5, 1.5, facing)[..2], [DOCK_LEFT; 2]);
    assert_eq!(heard(0.9, 2.4, facing)[..2], [DOCK_RIGHT; 2]);
    assert_eq!(heard(1.5, 2.0, facing)[..2], [DOCK_LEFT | DOCK_RIGHT; 2]);
    assert_eq!(
        heard(1.5, 2.0, 0.0)[2..],
        [DOCK_LEFT | DOCK_RIGHT; 2],
        "the rear receivers hear it"
    );
    assert_eq!(heard(1.9, 3.1, facing), [0; 4], "the sofa stands between");
    assert_eq!(heard(5.0, 2.0, facing), [0; 4], "too far");
    assert_eq!(heard(0.4, 2.1, facing)[0] & DOCK_NEAR, DOCK_NEAR);
}

#[test]
fn driving_straight_into_the_dock_closes_its_contacts() {
    let home = home(&format!(
        "{}[dock]\nposition = [0.0, 2.0]\nheading-deg = 0.0\n",
        room(4.0, 4.0)
    ));
    let mut world = ideal(&home, at(&home, 0.8, 2.0, HALF_TURN));
    for _ in 0..20_000 {
        world.step(&drive(0.3, 0.3));
        if world.sensors().dock_contacts {
            break;
        }
    }
    assert!(world.truth().docked);
    let gap = world.truth().pose.distance_m(home.start());
    assert!(gap < 0.02, "{gap}");
}

#[test]
fn brush_and_suction_take_dirt_but_wheels_alone_do_not() {
    let home = home(&room(3.0, 3.0));
    let run = |cleaning: bool| {
        // In the middle of a row of cells, so that whole rows make up the swath.
        let mut world = ideal(&home, at(&home, 0.5, 1.51, 0.0));
        let actuation = Actuation {
            brush_main: if cleaning { 1.0 } else { 0.0 },
            vacuum: cleaning,
            ..drive(0.5, 0.5)
        };
        steps(&mut world, 5_000, actuation);
        *world.truth()
    };
    let (dry, wet) = (run(false), run(true));
    assert_eq!(dry.dirt_share, 0.0);
    assert!(wet.dirt_share > 0.5 * wet.swept_share, "{wet:?}");
    let expected_m2 = 0.3 * dry.path_m + HALF_TURN * 0.15 * 0.15;
    assert!(
        (dry.swept_m2 - expected_m2).abs() < 0.03 * expected_m2,
        "{} {expected_m2}",
        dry.swept_m2
    );
}

#[test]
fn a_scheduled_door_closes_and_waits_for_the_robot_in_it() {
    let plan = format!(
        "{}[[wall]]\nfrom = [2.0, 0.0]\nto = [2.0, 3.0]\n[[door]]\nfrom = [2.0, 1.0]\nto = [2.0, 2.0]\nstate = \"open\"\nschedule = [{{ at-s = 2.0, state = \"closed\" }}]\n",
        room(4.0, 3.0)
    );
    let home = home(&plan);
    let leaf = at(&home, 2.0, 1.5, 0.0);
    let mut away = ideal(&home, at(&home, 1.0, 1.5, 0.0));
    steps(&mut away, 3_000, drive(0.0, 0.0));
    assert!(away.home().clearance_m(leaf.x_m, leaf.y_m) < 0.0, "closed");
    let mut inside = ideal(&home, leaf);
    steps(&mut inside, 3_000, drive(0.0, 0.0));
    assert!(inside.home().clearance_m(leaf.x_m, leaf.y_m) > 0.3, "it waits");
}

#[test]
fn one_encoder_line_counts_both_directions_up() {
    let relax = RobotModel::by_name("relax").unwrap();
    let home = home(&room(4.0, 3.0));
    let start = at(&home, 2.0, 1.5, 0.0);
    let mut world = World::new(home, &relax, &Noise::ideal(), 1, Some(start));
    steps(&mut world, 1_000, drive(-0.6, -0.6));
    assert!(world.truth().pose.x_m < start.x_m);
    assert!(world.sensors().count_left > 10);
    assert_eq!(world.sensors().gyro, None);
}

#[test]
fn a_lidar_measures_the_walls() {
    let text = include_str!("../../../../robots/samsung-sr8730/robot.toml");
    let figure = |value: f64, unit: &str| {
        format!("{{ value = {value}, unit = \"{unit}\", confidence = \"placeholder\", source = \"test\" }}")
    };
    let lidar = format!(
        "[lidar]\nrange = {}\nbeams = {}\nturns = {}\nnoise = {}\n",
        figure(6.0, "m"),
        figure(360.0, "1"),
        figure(5.0, "Hz"),
        figure(0.0, "1")
    );
    let model = RobotModel::parse(&format!("{text}\n{lidar}"), "test").unwrap();
    let home = home(&room(4.0, 3.0));
    let start = at(&home, 1.0, 1.0, 0.0);
    let mut world = World::new(home, &model, &Noise::ideal(), 1, Some(start));
    steps(&mut world, 450, drive(0.0, 0.0));
    let scan = world.lidar().unwrap();
    assert_eq!(scan.turn, 2);
    for (beam, wall_m) in [(0, 3.0), (90, 2.0), (180, 1.0), (270, 1.0)] {
        let range = f64::from(scan.ranges_m[beam]);
        assert!((range - wall_m).abs() < 0.02, "beam {beam}: {range} {wall_m}");
    }
}

#[test]
fn nominal_noise_is_of_the_documented_size() {
    let home = home(&room(40.0, 40.0));
    let start = at(&home, 20.0, 20.0, 0.0);
    let mut errors_m = Vec::new();
    for seed in 0..20 {
        let mut world = World::new(home.clone(), &sr8730(), &Noise::nominal(), seed, Some(start));
        steps(&mut world, 10_000, drive(0.6, 0.6));
        let counted_m = f64::from(world.sensors().count_left + world.sensors().count_right) * 0.00025;
        errors_m.push((world.truth().path_m - counted_m) / counted_m);
        let gyro = world.sensors().gyro.unwrap().heading.as_rad();
        assert!(
            (gyro - world.truth().pose.heading_rad).abs() < 0.05,
            "seed {seed}: {gyro}"
        );
    }
    let spread = (errors_m.iter().map(|error| error * error).sum::<f64>() / 20.0).sqrt();
    assert!(spread > 0.005 && spread < 0.025, "{spread}");
}

#[test]
fn a_start_elsewhere_is_taken() {
    let home = home(&room(4.0, 3.0));
    let pose = Pose::new(1.2, 0.9, 2.0);
    assert_eq!(ideal(&home, pose).truth().pose, pose);
}

#[test]
fn floor_counts_as_swept_twice_when_the_swath_comes_back_after_ten_seconds() {
    let home = home(&room(6.0, 4.0));
    let mut world = ideal(&home, at(&home, 1.0, 2.0, 0.0));
    steps(&mut world, 4_000, drive(0.6, 0.6));
    steps(&mut world, 3_000, drive(0.0, 0.0));
    let there = *world.truth();
    assert_eq!(there.swept_twice_m2, 0.0, "it has rested on what it swept");
    steps(&mut world, 2_000, drive(-0.6, -0.6));
    assert!(
        world.truth().swept_twice_m2 < 0.1 * there.swept_m2,
        "it left that a moment ago: {:?}",
        world.truth()
    );
    steps(&mut world, 12_000, drive(0.0, 0.0));
    steps(&mut world, 2_000, drive(0.6, 0.6));
    let again = world.truth();
    assert!(again.swept_twice_m2 > 0.2 * there.swept_m2, "{again:?}");
    assert!(again.swept_twice_m2 < again.swept_m2, "{again:?}");
}

#[test]
fn a_robot_keeps_its_wheels_and_its_gyro_from_run_to_run_and_not_its_noise() {
    let home = home(&room(6.0, 4.0));
    let start = at(&home, 1.0, 2.0, 0.0);
    let world = |build, run| {
        let seeds = WorldSeeds { build, run };
        World::new(home.clone(), &sr8730(), &Noise::nominal(), seeds, Some(start))
    };
    let driven = |build, run| {
        let mut world = world(build, run);
        steps(&mut world, 5_000, drive(0.6, 0.6));
        world.truth().pose
    };
    assert!(world(1, 1).gyro_scale_error().is_some());
    assert_eq!(world(1, 1).gyro_scale_error(), world(1, 2).gyro_scale_error());
    assert_ne!(world(1, 1).gyro_scale_error(), world(2, 1).gyro_scale_error());
    assert_ne!(driven(1, 1), driven(1, 2));
    let both = World::new(home.clone(), &sr8730(), &Noise::nominal(), 3, Some(start));
    assert_eq!(both.gyro_scale_error(), world(3, 3).gyro_scale_error());
    assert_eq!(driven(3, 3), driven(3, 3));
}
