//! What people see, hear and press; the gyro module.

use pic32::board::serial::{BitReceiver, HostRate};
use rvac_channel::ReceivedByte;

use crate::program::{CLR, FOREVER, SET, oc, timer};
use crate::rig::{DDPCON, LAT, TRISA, TRISC, TRISD, TRISE, TRISF, pass_ms, robot, stores};

#[test]
fn a_light_is_lit_while_supply_and_line_are_on() {
    let code = [
        stores(&[
            (TRISA + LAT + SET, 1 << 6),
            (TRISE + LAT + SET, 1 << 3),
            (TRISA + CLR, 1 << 6),
            (TRISE + CLR, 0x7C),
        ]),
        FOREVER.to_vec(),
    ]
    .concat();
    let mut robot = robot(&code);
    pass_ms(&mut robot, 10);
    let before = robot.lit_cycles();
    pass_ms(&mut robot, 10);
    let mut wanted = before;
    wanted[0][1] += 800_000;
    assert_eq!(robot.lit_cycles(), wanted, "line 1 of the main group alone");
}

/// 1 kHz on OC5 by Timer2 with prescaler 8, routed to this channel of the multiplexer.
fn tone(channel: u32) -> Vec<u32> {
    let level = |bit: u32| if channel & bit != 0 { SET } else { CLR };
    [
        stores(&[
            (DDPCON + CLR, 1 << 3),
            (TRISA + LAT + level(1), 1 << 1),
            (TRISF + LAT + level(2), 1 << 13),
            (TRISC + LAT + level(4), 1 << 4),
            (TRISD + LAT + SET, 1 << 13),
            (TRISA + CLR, 1 << 1),
            (TRISF + CLR, 1 << 13),
            (TRISC + CLR, 1 << 4),
            (TRISD + CLR, 1 << 13 | 1 << 4),
            (timer(2) + 32, 9_999),
            (oc(5) + 32, 5_000),
            (oc(5), 0x8006),
            (timer(2), 0x8030),
        ]),
        FOREVER.to_vec(),
    ]
    .concat()
}

#[test]
fn a_tone_is_heard_if_it_is_routed_to_the_speaker() {
    let mut loud = robot(&tone(7));
    assert_eq!(loud.pitch_hz(), None);
    pass_ms(&mut loud, 20);
    let pitch_hz = loud.pitch_hz().expect("it sounds");
    assert!((pitch_hz - 1000.0).abs() < 0.01, "{pitch_hz} Hz");
    let mut elsewhere = robot(&tone(5));
    pass_ms(&mut elsewhere, 20);
    assert_eq!(elsewhere.pitch_hz(), None);
}

#[test]
fn buttons_and_the_dust_box_are_levels_on_their_pins() {
    let mut robot = robot(&FOREVER);
    let (any, dust) = (robot.wiring().button_any, robot.wiring().dust_box);
    pass_ms(&mut robot, 2);
    let on = |robot: &pic32::board::EmulatedRobot, line: pic32::board::wiring::DigitalLine| {
        robot.machine().level(line.pin) == line.active
    };
    assert!(!on(&robot, any) && on(&robot, dust));
    robot.world_mut().press_button(2);
    robot.world_mut().remove_dust_box();
    pass_ms(&mut robot, 2);
    assert!(on(&robot, any) && !on(&robot, dust));
}

#[test]
fn the_gyro_module_speaks_while_it_has_power() {
    // gyro-power low = on.
    let code = [
        stores(&[(TRISF + LAT + CLR, 1 << 7), (TRISF + CLR, 1 << 7)]),
        FOREVER.to_vec(),
    ]
    .concat();
    let mut robot = robot(&code);
    let pin = robot.wiring().uart_receive[0];
    robot.machine_mut().watch(pin);
    pass_ms(&mut robot, 300);
    let mut receiver = BitReceiver::new(HostRate::exact(115_200).bit_cycles());
    let mut arrivals = Vec::new();
    for (cycle, level) in robot.machine_mut().take_edges(pin) {
        receiver.edge(cycle, level, &mut arrivals);
    }
    receiver.advance(robot.cycle(), &mut arrivals);
    let bytes: Vec<u8> = arrivals
        .into_iter()
        .map(|(_, received)| match received {
            ReceivedByte::Byte(byte) => byte,
            wrong => panic!("{wrong:?}"),
        })
        .collect();
    let frames = bytes.chunks_exact(9);
    assert!(
        (18..=20).contains(&frames.len()),
        "{} frames in 200 ms",
        frames.len()
    );
    for frame in frames {
        assert_eq!(frame[..2], [0xAA, 0x55]);
        let sum = frame[2..8].iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        assert_eq!(frame[8], sum);
    }
}
