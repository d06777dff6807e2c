//! The global property, under a storm: whatever the host sends and the sensors show, in whatever order, a motor turns only
//! when armed, fresh and not inhibited. Not cordlib's own word counts: the monitor of the simulations reads the bytes, the pins
//! and the motors in every pass of many random lives.

use crate::rig;
use crate::rig::{Phases, Rig, arm, clear, drive, motor, movement};
use rvac_protocol::message::{Bumpers, Cliffs, Command, Currents, Inhibit, Motor, WheelDrops};
use rvac_units::Current;

/// A robot that is not flooded answers within this.
const ANSWER_MS: u32 = 300;

fn signed(phases: &mut Phases, limit: f64) -> f64 {
    (f64::from(phases.below(2_001)) / 1_000.0 - 1.0) * limit
}

fn random_command(phases: &mut Phases) -> Command {
    match phases.below(12) {
        0..=3 => drive(signed(phases, 0.35), signed(phases, 1.5)),
        4 => movement(signed(phases, 0.5), None),
        5 => movement(signed(phases, 3.0), Some(0.0)),
        6 => movement(signed(phases, 0.5), Some(signed(phases, 1.0))),
        7 | 8 => motor(Motor::ALL[phases.below(7) as usize], signed(phases, 1.0)),
        9 => arm(phases.below(3) == 0),
        10 => clear(Inhibit::ALL[phases.below(18) as usize]),
        _ => Command::Stop,
    }
}

fn disturb(rig: &mut Rig, phases: &mut Phases) {
    let mut coin = |one_in: u32| phases.below(one_in) == 0;
    let board = rig.cord.board_mut();
    match coin(2) {
        true => {
            board.bumpers.0 = Bumpers {
                left: coin(6),
                right: coin(6),
            };
            board.cliffs.missing = Cliffs {
                left: coin(10),
                middle: coin(10),
                right: coin(10),
            };
        }
        false => {
            board.wheel_drops.0 = WheelDrops {
                left: coin(12),
                right: coin(12),
            };
            board.dock_contacts.0 = coin(12);
            board.buttons.down = u8::from(coin(12));
            board.currents.0.wheel_left = Current(if coin(20) { 3_000 } else { 100 });
        }
    }
    rig.mechanics.blocked = [coin(20), coin(20)];
    rig.mechanics.swapped = coin(40);
    rig.mechanics.stuck_duty = coin(40).then_some(700_000);
    rig.host_dead = coin(10);
}

fn live(seed: u64) -> u32 {
    let mut phases = Phases(seed);
    let mut rig = Rig::judged(u32::MAX - phases.below(20_000));
    let mut moving_passes = 0;
    for _ in 0..300 {
        if rig.host.is_open() {
            if !rig.cord.is_armed() || phases.below(4) == 0 {
                moving_passes += ask_to_arm(&mut rig, phases.below(2) == 0);
            }
            for inhibit in rig.cord.inhibits().iter().filter(|inhibit| inhibit.is_latched()) {
                send_if_room(&mut rig, clear(inhibit));
            }
            send_if_room(&mut rig, random_command(&mut phases));
        }
        if phases.below(3) == 0 {
            disturb(&mut rig, &mut phases);
        } else if phases.below(2) == 0 {
            calm(&mut rig);
        }
        for _ in 0..phases.below(120) {
            rig.run(1);
            moving_passes += u32::from(!rig.wheels_off());
        }
    }
    rig.acquit();
    moving_passes
}

fn send_if_room(rig: &mut Rig, command: Command) {
    let mut packet = rvac_protocol::PacketBuffer::new();
    let now = rig.host_now();
    // A full row of unanswered commands is no news to this test.
    if rig.host.send(command, now, &mut packet).is_ok() {
        rig.deliver(packet.as_bytes());
    }
}

/// Arms as our host does: the next `arm` follows the answer to this one. Returns the passes in which something moved.
fn ask_to_arm(rig: &mut Rig, undock: bool) -> u32 {
    let answers = |rig: &Rig| rig.answered + rig.refusals.len();
    let before = answers(rig);
    send_if_room(rig, arm(undock));
    let mut moving_passes = 0;
    for _ in 0..ANSWER_MS {
        if answers(rig) > before || rig.host_dead {
            break;
        }
        rig.run(1);
        moving_passes += u32::from(!rig.wheels_off());
    }
    moving_passes
}

fn calm(rig: &mut Rig) {
    let board = rig.cord.board_mut();
    board.bumpers.0 = Bumpers::default();
    board.cliffs.missing = Cliffs::default();
    board.wheel_drops.0 = WheelDrops::default();
    board.dock_contacts.0 = false;
    board.buttons.down = 0;
    board.currents.0 = Currents::default();
    rig.mechanics = rig::Mechanics::default();
    rig.host_dead = false;
}

#[test]
fn nothing_turns_unless_armed_fresh_and_free() {
    let moving: u32 = (0..60).map(live).sum();
    assert!(
        moving > 20_000,
        "a storm in which hardly anything moves proves nothing: {moving} passes"
    );
}
