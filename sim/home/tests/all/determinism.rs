//! The same calls give the same bits, and faults change what is read but not what is.

use std::sync::Arc;

use crate::scene::{drive, sr8730, steps};
use home::{Home, Noise, Pcg, SensorFault, SensorId, Sensors, World};

fn flat() -> Arc<Home> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../homes/two-room-flat.toml");
    Arc::new(Home::load(path.as_ref(), &sr8730()).expect("the flat loads"))
}

/// FNV-1a over everything that can be seen of a run with random drives.
fn fingerprint(home: &Arc<Home>, seed: u64, milliseconds: u32) -> u64 {
    let mut world = World::new(home.clone(), &sr8730(), &Noise::nominal(), seed, None);
    let mut random = Pcg::new(seed, 77);
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    let mut actuation = drive(0.0, 0.0);
    for step in 0..milliseconds {
        if step % 700 == 0 {
            actuation = drive(random.symmetric(), random.symmetric());
        }
        world.step(&actuation);
        if step % 50 == 0 {
            for byte in format!("{:?}{:?}", world.sensors(), world.truth()).bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    hash
}

#[test]
fn a_run_repeats_bit_for_bit_and_seeds_differ() {
    let home = flat();
    let first = fingerprint(&home, 5, 60_000);
    assert_eq!(first, fingerprint(&flat(), 5, 60_000));
    assert_ne!(first, fingerprint(&home, 6, 60_000));
}

#[test]
fn a_clone_goes_on_as_the_original() {
    let mut world = World::new(flat(), &sr8730(), &Noise::bad(), 3, None);
    steps(&mut world, 5_000, drive(-0.5, -0.45));
    let mut twin = world.clone();
    steps(&mut world, 5_000, drive(0.6, 0.5));
    steps(&mut twin, 5_000, drive(0.6, 0.5));
    assert_eq!(world.sensors(), twin.sensors());
    assert_eq!(world.truth(), twin.truth());
}

/// Runs with and without a fault; gives what both show at the end.
fn with_fault(sensor: SensorId, fault: SensorFault) -> (Sensors, Sensors) {
    let mut honest = World::new(flat(), &sr8730(), &Noise::nominal(), 3, None);
    steps(&mut honest, 500, drive(-0.5, -0.5));
    let mut lying = honest.clone();
    lying.set_fault(sensor, Some(fault));
    steps(&mut honest, 1_000, drive(-0.5, -0.4));
    steps(&mut lying, 1_000, drive(-0.5, -0.4));
    assert_eq!(honest.truth(), lying.truth(), "a lying sensor moves nothing");
    (*honest.sensors(), *lying.sensors())
}

#[test]
fn each_fault_changes_its_sensor_only() {
    let (mut honest, lying) = with_fault(SensorId::BumperLeft, SensorFault::StuckAt(1));
    assert!(!honest.bumper_left && lying.bumper_left);
    honest.bumper_left = true;
    assert_eq!(honest, lying);

    let (mut honest, lying) = with_fault(SensorId::Cliff(1), SensorFault::StuckAt(7));
    assert_eq!(lying.cliff_levels[1], 7);
    honest.cliff_levels[1] = 7;
    honest.cliff_dark[1] = 7;
    assert_eq!(honest, lying);

    let (honest, lying) = with_fault(SensorId::WheelDropRight, SensorFault::Inverted);
    assert_ne!(honest.wheel_drop_right, lying.wheel_drop_right);

    let (honest, lying) = with_fault(SensorId::BatteryVoltage, SensorFault::StuckAt(9_000));
    assert_ne!(honest.battery_voltage, lying.battery_voltage);
    assert_eq!(lying.battery_voltage.0, 9_000);
}

#[test]
fn encoder_faults_keep_or_turn_the_count_and_end_without_a_jump() {
    let mut world = World::new(flat(), &sr8730(), &Noise::ideal(), 3, None);
    steps(&mut world, 1_000, drive(-0.5, -0.5));
    let before = world.sensors().count_left;
    assert!(before < -50, "{before}");
    world.set_fault(SensorId::EncoderLeft, Some(SensorFault::StuckAt(0)));
    steps(&mut world, 1_000, drive(-0.5, -0.5));
    assert_eq!(world.sensors().count_left, before);
    world.set_fault(SensorId::EncoderLeft, None);
    assert_eq!(world.sensors().count_left, before);
    steps(&mut world, 500, drive(-0.5, -0.5));
    let after = world.sensors().count_left;
    assert!(after < before - 50, "{after}");
    world.set_fault(SensorId::EncoderLeft, Some(SensorFault::Inverted));
    steps(&mut world, 500, drive(-0.5, -0.5));
    assert!(world.sensors().count_left > after + 50);
}
