//! Who may move the robot, and until when: the table of arming in SPEC.md, on the whole firmware.

use crate::power::{PACK, charging, feed};
use crate::rig;
use crate::rig::{Phases, Rig, drive, motor};
use cordlib::HandMode;
use cordlib::board::{ChargeDrive, ChargerReadings};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{ArmingState, Command, Inhibit, Motor, Refusal, Report};
use rvac_protocol::session::HostSession;
use rvac_protocol::text::write_command_with_crc;
use rvac_units::Tick;

/// Clocks at which a run begins, half of them shortly before the wrap.
fn starts(count: u32) -> impl Iterator<Item = (u32, Phases)> {
    (0..count).map(|run| {
        let mut phases = Phases(u64::from(run));
        let start = if run % 2 == 0 {
            u32::MAX - phases.below(12_000)
        } else {
            phases.below(u32::MAX)
        };
        (start, phases)
    })
}

/// A host that types: its packets have no CRC.
fn typist(start: u32) -> Rig {
    let mut rig = Rig::switched_on(start);
    rig.host_dead = true;
    rig.run(50);
    rig
}

fn logged(rig: &Rig, words: &str) -> bool {
    rig.reports
        .iter()
        .any(|report| matches!(report, Report::Log { text, .. } if text.contains(words)))
}

/// What ends a session, besides a new one.
fn end_by_hand(rig: &mut Rig) {
    let mut packet = PacketBuffer::new();
    write_command_with_crc(&Command::Hand, rig.host.session(), &mut packet).expect("it fits");
    rig.deliver(packet.as_bytes());
    rig.host_dead = true;
    rig.run(50);
}

#[test]
fn s2_no_typed_packet_moves_what_a_host_has_armed() {
    for (start, mut phases) in starts(40) {
        let mut rig = Rig::driving(start);
        if phases.below(2) == 0 {
            end_by_hand(&mut rig);
        } else {
            rig.host_dead = true;
            rig.run(2_000 + phases.below(1_000));
        }
        assert_eq!(rig.cord.arming(), ArmingState::Locked);
        for _ in 0..20 {
            rig.type_in(r#"{"c":"drive","v":0.1,"w":0,"ttl":500}"#);
            rig.type_in(r#"{"c":"motor","motor":"wheel left","throttle":0.25,"ttl":500}"#);
            rig.type_in(r#"{"c":"motor","motor":"vacuum","throttle":1,"ttl":500}"#);
            assert!(rig.wheels_off() && rig.cleaners_off(), "{:?}", rig.names());
        }
        rig.type_in(r#"{"c":"arm"}"#);
        rig.type_in(r#"{"c":"drive","v":0.1,"w":0,"ttl":500}"#);
        rig.run(300);
        assert!(!rig.wheels_off(), "the person has armed it: {:?}", rig.names());
    }
}

#[test]
fn s2_a_new_session_inherits_no_permission() {
    let mut rig = Rig::driving(0);
    rig.repeated.clear();
    rig.host = HostSession::new(Default::default(), Tick(0));
    rig.run_until(500, |rig| rig.wheels_off());
    rig.connect();
    rig.run(50);
    assert_eq!(rig.cord.arming(), ArmingState::Locked);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
    rig.arm();
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Ok(()));
}

#[test]
fn s2_a_session_ends_what_a_person_has_armed_by_hand() {
    let mut rig = typist(0);
    rig.type_in(r#"{"c":"arm"}"#);
    assert_eq!(rig.cord.arming(), ArmingState::Hand);
    rig.host_dead = false;
    rig.connect();
    assert_eq!(rig.cord.arming(), ArmingState::Locked);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
}

#[test]
fn hand_mode_ends_ten_seconds_after_the_last_typed_motion_and_is_told() {
    for (start, mut phases) in starts(40) {
        let mut rig = typist(start);
        rig.type_in(r#"{"c":"arm"}"#);
        for _ in 0..3 {
            rig.run(phases.below(9_900));
            rig.type_in(r#"{"c":"drive","v":0.3,"w":0,"ttl":1000}"#);
            assert_eq!(rig.cord.arming(), ArmingState::Hand);
        }
        rig.run(1_000);
        assert!(rig.wheels_off());
        // What moves nothing keeps nobody armed.
        rig.type_in(r#"{"c":"info"}"#);
        rig.run(8_000);
        assert!(told(&rig, ArmingState::Hand) && logged(&rig, "armed by hand"));
        let rest_ms = rig.run_until(1_000, |rig| !rig.cord.is_armed());
        assert!((930..=970).contains(&rest_ms), "{rest_ms}");
        rig.run(1_200);
        assert!(told(&rig, ArmingState::Locked) && logged(&rig, "no motion command for 10 s"));
        rig.type_in(r#"{"c":"drive","v":0.1,"w":0}"#);
        assert!(rig.wheels_off() && rig.has(Inhibit::NotArmed));
    }
}

fn told(rig: &Rig, state: ArmingState) -> bool {
    let newest = rig.reports.iter().rev().find_map(|report| match report {
        Report::Info(info) => Some(info.arming),
        _ => None,
    });
    newest == Some(Some(state))
}

#[test]
fn a_board_may_forbid_hand_mode() {
    let mut rig = Rig::switched_on_as(0, |parameters| parameters.hand_mode = HandMode::Forbidden);
    rig.host_dead = true;
    for packet in [r#"{"c":"arm"}"#, r#"{"c":"arm","undock":true}"#] {
        rig.type_in(packet);
        assert_eq!(rig.cord.arming(), ArmingState::Locked);
    }
    rig.type_in(r#"{"c":"drive","v":0.1,"w":0}"#);
    rig.run(200);
    assert!(rig.wheels_off());
    assert!(logged(&rig, "this board forbids hand mode"));
    rig.host_dead = false;
    rig.connect();
    rig.arm();
    assert_eq!(
        rig.try_motion(drive(0.1, 0.0)),
        Ok(()),
        "a session is no hand mode"
    );
}

#[test]
fn a_board_that_arms_for_itself_is_quiet_after_ten_seconds_too() {
    let mut rig = typist(0);
    assert_eq!(rig.cord.request(&drive(0.1, 0.0)), Err(Refusal::Inhibited));
    assert_eq!(rig.cord.request(&rig::arm(false)), Ok(()));
    assert_eq!(rig.cord.request(&drive(0.1, 0.0)), Ok(()));
    rig.type_in(r#"{"c":"drive","v":-0.1,"w":0}"#);
    assert!(rig.duties().0 > 0, "the permission is the board's");
    rig.run(10_100);
    assert_eq!(rig.cord.arming(), ArmingState::Locked);
}

#[test]
fn s12_a_bridge_that_goes_on_after_a_stop_is_latched_and_a_push_by_hand_is_not() {
    let mut rig = Rig::driving(0);
    rig.mechanics.stuck_duty = Some(600_000);
    rig.repeated.clear();
    rig.send(Command::Stop);
    rig.run(500);
    assert!(rig.has(Inhibit::Runaway), "{:?}", rig.names());
    let mut rig = Rig::driving(0);
    rig.repeated.clear();
    rig.send(Command::Stop);
    rig.run(1_000);
    rig.mechanics.stuck_duty = Some(600_000);
    rig.run(1_000);
    assert!(!rig.has(Inhibit::Runaway), "{:?}", rig.names());
}

/// On the dock, charging, and told to leave by a host.
fn leaving(start: u32) -> Rig {
    let mut rig = charging(start);
    rig.ask(rig::arm(true)).expect("leaving is allowed");
    assert_eq!(rig.cord.arming(), ArmingState::LeavingDock);
    assert_eq!(rig.cord.charge_drive(), ChargeDrive::Off);
    rig
}

/// Milliseconds until the pack is charged again.
fn recharged_ms(rig: &mut Rig, limit_ms: u32) -> u32 {
    (0..limit_ms)
        .find(|_| {
            feed(rig, 1);
            rig.cord.charge_drive() != ChargeDrive::Off
        })
        .expect("the pack is charged again")
}

#[test]
fn s19_a_pack_is_charged_again_whose_host_dies_or_does_nothing_on_the_way_out() {
    let (mut dead_ms, mut idle_ms) = (0, 0);
    for (start, mut phases) in starts(20) {
        let mut rig = leaving(start);
        feed(&mut rig, phases.below(1_500));
        rig.host_dead = true;
        dead_ms = dead_ms.max(recharged_ms(&mut rig, 10_000));
        let mut rig = leaving(start);
        feed(&mut rig, phases.below(1_500));
        rig.repeated = vec![drive(0.0, 0.0)];
        idle_ms = idle_ms.max(recharged_ms(&mut rig, 30_000));
        assert!(logged(&rig, "still on the dock"));
        assert_eq!(rig.try_motion(drive(-0.1, 0.0)), Err(Refusal::Inhibited));
    }
    rig::keep(rig::limits::S19_CHARGED_AGAIN, dead_ms);
    rig::keep(rig::limits::S19_CHARGED_AGAIN_IDLE, idle_ms);
}

#[test]
fn s19_a_robot_that_has_left_stays_armed_as_long_as_its_host_lives() {
    let mut rig = leaving(0);
    rig.repeated = vec![drive(-0.1, 0.0)];
    feed(&mut rig, 500);
    rig.cord.board_mut().dock_contacts.0 = false;
    rig.cord.board_mut().charger.readings = Some(PACK);
    rig.run(1_000);
    assert_eq!(rig.cord.arming(), ArmingState::LeavingDock);
    rig.run(500);
    assert_eq!(rig.cord.arming(), ArmingState::Armed);
    rig.repeated = vec![drive(0.0, 0.1)];
    rig.run(60_000);
    assert!(!rig.wheels_off() && rig.cord.arming() == ArmingState::Armed);
}

/// A supply that charges whatever the switch does.
fn leak(rig: &mut Rig, milliseconds: u32) {
    for _ in 0..milliseconds {
        let board = rig.cord.board_mut();
        board.charger.readings = Some(ChargerReadings {
            current_ma: if board.dock_contacts.0 { 1_500 } else { 0 },
            adapter: board.dock_contacts.0,
            ..PACK
        });
        rig.run(1);
    }
}

/// Milliseconds of a shorted switch until both wheels push backward.
fn escape_ms(rig: &mut Rig) -> u32 {
    (0..6_000)
        .find(|_| {
            leak(rig, 1);
            let (left, right) = rig.duties();
            assert!(left <= 0 && right <= 0, "never forward on the dock");
            left < 0 && right < 0 && rig.cord.arming() == ArmingState::DockEscape
        })
        .unwrap_or_else(|| panic!("it stays: {:?} {:?}", rig.cord.arming(), rig.names()))
}

#[test]
fn s18_a_shorted_switch_drives_the_robot_off_whatever_its_host_does() {
    let mut worst_ms = 0;
    for (start, mut phases) in starts(16) {
        for host in 0..5 {
            let mut rig = charging(start);
            feed(&mut rig, phases.below(1_000));
            match host {
                // A host that lives and does nothing.
                0 => {}
                // One that has armed, and one that does so all the time; one that has armed and died.
                1 => rig.ask(rig::arm(true)).expect("leaving is allowed"),
                2 => rig.repeated = vec![rig::arm(true)],
                3 => {
                    rig.ask(rig::arm(true)).expect("leaving is allowed");
                    rig.host_dead = true;
                }
                // One that said `stop` before.
                _ => rig.send(Command::Stop),
            }
            feed(&mut rig, phases.below(1_000));
            worst_ms = worst_ms.max(escape_ms(&mut rig));
        }
    }
    rig::keep(rig::limits::S18_ESCAPE, worst_ms);
}

#[test]
fn s18_nobody_else_moves_the_robot_while_it_escapes_and_afterwards_it_is_locked() {
    let mut rig = charging(0);
    escape_ms(&mut rig);
    assert_eq!(rig.ask(rig::arm(true)), Err(Refusal::Inhibited));
    rig.send(drive(0.2, 0.0));
    rig.send(motor(Motor::Vacuum, 1.0));
    leak(&mut rig, 100);
    assert!(rig.duties().0 < 0 && rig.cleaners_off());
    assert_eq!(rig.cord.arming(), ArmingState::DockEscape);
    rig.cord.board_mut().dock_contacts.0 = false;
    leak(&mut rig, 600);
    assert_eq!(rig.cord.arming(), ArmingState::Locked);
    assert!(rig.wheels_off() && rig.has(Inhibit::ChargerShorted));
}

#[test]
fn s18_stop_and_a_button_end_a_try_and_three_tries_are_all() {
    let mut rig = charging(0);
    for tries in 1..=3 {
        escape_ms(&mut rig);
        if tries == 1 {
            rig.send(Command::Stop);
        } else {
            rig.cord.board_mut().buttons.down = 1;
        }
        leak(&mut rig, 50);
        assert!(
            rig.wheels_off() && rig.cord.arming() == ArmingState::Locked,
            "{tries}"
        );
        leak(&mut rig, 3_000);
        assert!(rig.wheels_off(), "a new try has a new warning");
        rig.cord.board_mut().buttons.down = 0;
    }
    for _ in 0..30_000 {
        leak(&mut rig, 1);
        assert!(rig.wheels_off());
    }
}

#[test]
fn s18_a_fault_without_current_drives_no_robot_off_its_dock() {
    let mut rig = charging(0);
    escape_ms(&mut rig);
    rig.cord.board_mut().dock_contacts.0 = false;
    leak(&mut rig, 3_000);
    // A person has put it back, and the switch has come free.
    rig.cord.board_mut().dock_contacts.0 = true;
    for _ in 0..20_000 {
        feed(&mut rig, 1);
        assert!(rig.wheels_off());
    }
    assert!(rig.has(Inhibit::ChargerShorted), "it stays latched");
}
