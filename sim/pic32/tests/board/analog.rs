//! What the converter reads, at the moment at which it samples.

use home::{SensorFault, SensorId};
use pic32::board::EmulatedRobot;

use crate::program::{CLR, NOP, SET, T0, T1, T2, addiu, branch, li, lw, store, sw};
use crate::rig::{AD1PCFG, LAT, TRISB, TRISD, TRISG, pass_ms, robot, robot_with, stores, world};

const AD1CON1: u32 = 0xBF80_9000;
const AD1CON3: u32 = 0xBF80_9020;
const AD1CHS: u32 = 0xBF80_9040;
const ADC1BUF0: u32 = 0xBF80_9070;
const FRONT: u32 = 3;

/// Waits for about so many microseconds.
fn wait_us(us: u16) -> Vec<u32> {
    // Two instructions of a few cycles each a turn; at least as long as wanted.
    let bne = |register: u32, by: i16| 0x1400_0000 | register << 21 | by as u16 as u32;
    [
        li(T2, u32::from(us) * 40).as_slice(),
        &[addiu(T2, T2, -1), bne(T2, -2), NOP],
    ]
    .concat()
}

/// Converts one channel: TAD 400 ns, sampled for 31 TAD; stores the reading as a word at `result`.
fn convert(channel: u32, result: u32) -> Vec<u32> {
    let mut code = stores(&[(AD1CHS, channel << 16), (AD1CON1 + SET, 1 << 1)]);
    code.extend(wait_us(20));
    code.extend(li(T0, ADC1BUF0));
    code.push(lw(T1, 0, T0));
    code.extend(li(T0, 0xA000_0000 + result));
    code.push(sw(T1, 0, T0));
    code
}

/// Converter on, all of port B analog except the third select line.
fn set_up() -> Vec<u32> {
    stores(&[(AD1PCFG, 1 << 15), (AD1CON3, 31 << 8 | 15), (AD1CON1, 0x80E0)])
}

/// Converts these channels over and over, each reading at 4 x its number.
fn scanning(channels: &[u32], before: &[u32]) -> Vec<u32> {
    let mut code = [set_up(), before.to_vec()].concat();
    let start = code.len();
    for channel in channels {
        code.extend(convert(*channel, 4 * channel));
    }
    let back = start as i32 - code.len() as i32 - 1;
    code.extend([branch(back as i16), NOP]);
    code
}

fn reading(robot: &EmulatedRobot, channel: u32) -> i32 {
    crate::program::word(robot.machine(), 4 * channel) as i32
}

#[track_caller]
fn assert_near(reading: i32, wanted: i32) {
    assert!((reading - wanted).abs() <= 4, "{reading} instead of {wanted}");
}

#[test]
fn buttons_battery_thermistor_and_currents_have_their_readings() {
    let mut robot = robot(&scanning(&[0, 2, 3, 4, 13, 14], &[]));
    pass_ms(&mut robot, 20);
    let pack = f64::from(robot.world().sensors().battery_voltage.0) / 32.549;
    assert_near(reading(&robot, 0), 0);
    assert_near(reading(&robot, 3), pack as i32);
    assert_near(reading(&robot, 2), pack as i32);
    // 22 degrees by the data sheet of a 10 k thermistor with B = 3,435 K.
    assert_near(reading(&robot, 4), 798);
    // Zero of the left and right current, from the calibration.
    assert_near(reading(&robot, 14), 8);
    assert_near(reading(&robot, 13), 11);
    for (button, counts) in [(0, 250), (1, 500), (2, 750)] {
        robot.world_mut().press_button(button);
        pass_ms(&mut robot, 3);
        assert_near(reading(&robot, 0), counts);
        robot.world_mut().release_button(button);
    }
    robot.hold_analog(4, 1023, (robot.cycle(), u64::MAX));
    pass_ms(&mut robot, 3);
    assert_eq!(reading(&robot, 4), 1023, "a broken wire");
}

#[test]
fn cliff_sensors_see_the_floor_while_their_emitters_are_lit() {
    for (lit, floor) in [(true, 720), (false, 40)] {
        let switch = if lit { SET } else { CLR };
        let emitters = stores(&[(TRISG + LAT + switch, 1), (TRISG + CLR, 1)]);
        let mut robot = robot(&scanning(&[8, 10, 11], &emitters));
        pass_ms(&mut robot, 10);
        for channel in [8, 10, 11] {
            assert_near(reading(&robot, channel), floor);
        }
        robot
            .world_mut()
            .set_fault(SensorId::Cliff(0), Some(SensorFault::StuckAt(100)));
        pass_ms(&mut robot, 3);
        assert_near(reading(&robot, 11), 400);
        robot.world_mut().set_fault(SensorId::Cliff(0), None);
        robot.world_mut().lift();
        pass_ms(&mut robot, 10);
        assert_near(reading(&robot, 10), 40);
    }
}

/// Selects a sensor and its emitter, waits, converts into `result`.
fn look(channel: u32, lit: bool, (wait, result): (u16, u32)) -> Vec<u32> {
    let level = |on: bool| if on { SET } else { CLR };
    let mut code = stores(&[
        (TRISD + LAT + CLR, 1 << 12),
        (TRISD + LAT + level(channel & 1 != 0), 1 << 15),
        (TRISD + LAT + level(channel & 2 != 0), 1 << 14),
        (TRISB + LAT + level(channel & 4 != 0), 1 << 15),
    ]);
    code.extend(wait_us(200));
    code.extend(stores(&[(TRISD + LAT + level(lit), 1 << 12)]));
    code.extend(wait_us(wait));
    code.extend(convert(12, result));
    code
}

fn looking() -> Vec<u32> {
    let mut code = set_up();
    code.extend(stores(&[
        (TRISD + CLR, 1 << 12 | 1 << 14 | 1 << 15),
        (TRISB + CLR, 1 << 15),
    ]));
    let start = code.len();
    for channel in 0..8 {
        code.extend(look(channel, false, (400, 8 * channel)));
        code.extend(look(channel, true, (400, 8 * channel + 4)));
    }
    // Too early: the sample ends 12.4 µs after the emitter was lit.
    code.extend(look(FRONT, true, (1, 64)));
    let back = start as i32 - code.len() as i32 - 1;
    code.extend([branch(back as i16), NOP]);
    code
}

#[test]
fn each_proximity_sensor_is_behind_its_channel_and_needs_light_and_time() {
    // Facing a wall 2 cm away from the bumper.
    let start = (4.0 - 0.195, 1.5, 0.0);
    let mut robot = robot_with(&looking(), world(Some(start)), &Default::default());
    pass_ms(&mut robot, 400);
    let word = |address: u32| crate::program::word(robot.machine(), address) as i32;
    let difference = |channel: u32| word(8 * channel + 4) - word(8 * channel);
    assert_near(word(0), 60);
    let level = i32::from(robot.world().sensors().proximity[FRONT as usize]);
    assert!(level > 150, "{level}");
    assert!(
        (difference(FRONT) - (6 + 694 * level / 255)).abs() <= 6,
        "{}",
        difference(FRONT)
    );
    assert!(difference(0) <= 10, "nothing on the right: {}", difference(0));
    assert!(
        difference(2) > 20 && difference(4) > 20,
        "the wall on both sides of the front: {:?}",
        robot.world().sensors().proximity
    );
    assert!((word(7 * 8 + 4)).abs() <= 3, "channel 7 is grounded");
    let early = word(64) - word(8 * FRONT);
    assert!(
        early < difference(FRONT) * 3 / 4 && early > 0,
        "{early} of {}",
        difference(FRONT)
    );
}

#[test]
fn readings_have_noise_of_a_seed() {
    let mut robot = robot(&scanning(&[3], &store(0xA000_0100, 1)));
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..50 {
        pass_ms(&mut robot, 1);
        seen.insert(reading(&robot, 3));
    }
    assert!((2..=6).contains(&seen.len()), "{seen:?}");
}
