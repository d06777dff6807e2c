//! What is latched stays: while its cause stands no `clear` takes it away, and a reset never does.

use crate::rig;
use crate::rig::{Rig, clear, drive, motor};
use cordlib::board::{ChargerReadings, HardwareFault, KEPT_WORDS, TemperatureRange, ThermistorFault};
use rvac_protocol::message::{Bumpers, Cliffs, Inhibit, Motor, Refusal, ResetCause};
use rvac_units::{Current, Temperature};

const PACK: ChargerReadings = ChargerReadings {
    pack_mv: 15_000,
    input_mv: 15_000,
    current_ma: 0,
    temperature: Ok(TemperatureRange::exact(Temperature(250))),
    age_ms: 0,
    adapter: false,
};
const RESETS: [ResetCause; 4] = [
    ResetCause::Watchdog,
    ResetCause::Software,
    ResetCause::External,
    ResetCause::BrownOut,
];

/// How an inhibit gets latched, and how its cause goes away.
struct Latch {
    /// A robot that has it latched, with the cause present.
    latched: fn() -> Rig,
    /// Takes the cause away.
    heal: fn(&mut Rig),
    /// A robot at rest can tell that the cause is present.
    shows_at_rest: bool,
}

const fn latch(latched: fn() -> Rig, heal: fn(&mut Rig)) -> Option<Latch> {
    Some(Latch {
        latched,
        heal,
        shows_at_rest: true,
    })
}

fn show(rig: &mut Rig, readings: ChargerReadings) {
    rig.cord.board_mut().charger.readings = Some(readings);
}

fn faulty(fault: HardwareFault) -> Rig {
    let mut rig = Rig::connected(0);
    rig.cord.board_mut().checks.0.push(fault);
    rig.run(2);
    rig
}

fn sound(rig: &mut Rig) {
    rig.cord.board_mut().checks.0.clear();
    rig.run(2);
}

fn warm_to(rig: &mut Rig, tenths: i16) {
    let temperature = Ok(TemperatureRange::exact(Temperature(tenths)));
    show(rig, ChargerReadings { temperature, ..PACK });
    rig.run(2_000);
}

/// On the dock with these readings for so long.
fn docked(readings: ChargerReadings, milliseconds: u32) -> Rig {
    let mut rig = Rig::connected(0);
    show(&mut rig, PACK);
    rig.run(500);
    rig.cord.board_mut().dock_contacts.0 = true;
    show(
        &mut rig,
        ChargerReadings {
            adapter: true,
            ..readings
        },
    );
    rig.run(milliseconds);
    rig
}

fn docked_well(rig: &mut Rig) {
    show(
        rig,
        ChargerReadings {
            adapter: true,
            ..PACK
        },
    );
    rig.run(500);
}

fn on_a_strong_supply() -> Rig {
    let strong = ChargerReadings {
        input_mv: 30_500,
        ..PACK
    };
    docked(strong, 500)
}

fn on_a_shorted_switch() -> Rig {
    let shorted = ChargerReadings {
        current_ma: 1_400,
        ..PACK
    };
    docked(shorted, 1_600)
}

fn reset_again_and_again() -> Rig {
    let mut rig = Rig::switched_on_with(0, |board| board.reset.recent = 3);
    rig.connect();
    rig
}

fn stuck() -> Rig {
    let mut rig = Rig::armed(0);
    rig.cord.board_mut().bumpers.0.left = true;
    rig.run(10_100);
    rig
}

fn trapped() -> Rig {
    let mut rig = Rig::armed(0);
    rig.cord.board_mut().cliffs.missing.middle = true;
    rig.run(100);
    rig.repeated = vec![drive(-0.09, 0.0)];
    rig.run(3_000);
    rig
}

fn wheel_stalled() -> Rig {
    let mut rig = Rig::driving(0);
    rig.cord.board_mut().currents.0.wheel_left = Current(3_000);
    rig.run(300);
    rig
}

fn brush_stalled() -> Rig {
    let mut rig = Rig::armed(0);
    rig.repeated = vec![motor(Motor::BrushMain, 1.0)];
    rig.run(500);
    rig.cord.board_mut().currents.0.brush_main = Current(3_000);
    rig.run(3_000);
    rig
}

fn run_away() -> Rig {
    let mut rig = Rig::armed(0);
    rig.mechanics.stuck_duty = Some(700_000);
    rig.run(500);
    rig
}

fn swapped() -> Rig {
    let mut rig = Rig::driving(0);
    rig.mechanics.swapped = true;
    rig.run(1_000);
    rig
}

fn overheated() -> Rig {
    let mut rig = Rig::connected(0);
    for tenths in [530, 570, 605] {
        warm_to(&mut rig, tenths);
    }
    rig
}

fn cool_down(rig: &mut Rig) {
    for tenths in (470..=580).rev().step_by(20) {
        warm_to(rig, tenths);
    }
    rig.run(11_000);
}

fn without_thermistor() -> Rig {
    let mut rig = Rig::connected(0);
    let temperature = Err(ThermistorFault::Open);
    show(&mut rig, ChargerReadings { temperature, ..PACK });
    rig.run(2_500);
    rig
}

/// Every latch has its line: a new one does not compile without.
fn latch_of(inhibit: Inhibit) -> Option<Latch> {
    match inhibit {
        Inhibit::ResetLoop => latch(reset_again_and_again, |rig| rig.run(61_000)),
        Inhibit::BumperStuck => latch(stuck, |rig| {
            rig.cord.board_mut().bumpers.0 = Bumpers::default();
            rig.run(50);
        }),
        Inhibit::CliffTrapped => latch(trapped, |rig| {
            rig.cord.board_mut().cliffs.missing = Cliffs::default();
            rig.run(1_200);
        }),
        Inhibit::WheelStall => latch(wheel_stalled, |rig| {
            rig.cord.board_mut().currents.0.wheel_left = Current(0);
            rig.run(20);
        }),
        Inhibit::BrushStall => latch(brush_stalled, |rig| {
            rig.cord.board_mut().currents.0.brush_main = Current(0);
            rig.run(20);
        }),
        Inhibit::Runaway => latch(run_away, |rig| {
            rig.mechanics.stuck_duty = None;
            rig.run(1_000);
        }),
        Inhibit::EncoderFault => Some(Latch {
            latched: swapped,
            heal: |rig| rig.mechanics.swapped = false,
            shows_at_rest: false,
        }),
        Inhibit::InternalFault => latch(|| faulty(HardwareFault::Internal), sound),
        Inhibit::Clock => latch(|| faulty(HardwareFault::Clock), sound),
        Inhibit::Memory => latch(|| faulty(HardwareFault::Memory), sound),
        Inhibit::BatteryOverheated => latch(overheated, cool_down),
        Inhibit::Thermistor => latch(without_thermistor, |rig| {
            show(rig, PACK);
            rig.run(500);
        }),
        Inhibit::ChargerFault => latch(on_a_strong_supply, docked_well),
        Inhibit::ChargerShorted => latch(on_a_shorted_switch, docked_well),
        Inhibit::NotArmed
        | Inhibit::LinkLost
        | Inhibit::Bumper
        | Inhibit::Cliff
        | Inhibit::CliffSensorFault
        | Inhibit::WheelDrop
        | Inhibit::NotMoving
        | Inhibit::Docked
        | Inhibit::ButtonStop
        | Inhibit::Stopped
        | Inhibit::BatteryLow
        | Inhibit::BatteryWeak
        | Inhibit::BatteryEmpty
        | Inhibit::BatteryHot => None,
    }
}

/// All latched inhibits with their line in the table.
fn latches() -> impl Iterator<Item = (Inhibit, Latch)> {
    Inhibit::ALL.into_iter().filter_map(|inhibit| {
        let latch = latch_of(inhibit);
        assert_eq!(latch.is_some(), inhibit.is_latched(), "{}", inhibit.name());
        latch.map(|latch| (inhibit, latch))
    })
}

/// The robot has it latched, does not let go while the cause shows, and lets go once it is gone.
fn insist_and_clear(rig: &mut Rig, inhibit: Inhibit, latch: &Latch) {
    let name = inhibit.name();
    assert!(rig.has(inhibit), "{name}: {:?}", rig.names());
    rig.repeated.clear();
    if latch.shows_at_rest {
        for _ in 0..3 {
            assert_eq!(rig.ask(clear(inhibit)), Err(Refusal::CauseRemains), "{name}");
            assert!(rig.has(inhibit), "{name}");
            rig.run(100);
        }
    }
    (latch.heal)(rig);
    assert!(rig.has(inhibit), "{name} goes by itself");
    assert_eq!(rig.ask(clear(inhibit)), Ok(()), "{name}");
    rig.run(100);
    assert!(!rig.has(inhibit), "{name}: {:?}", rig.names());
}

#[test]
fn no_latch_is_cleared_while_its_cause_stands() {
    for (inhibit, latch) in latches() {
        insist_and_clear(&mut (latch.latched)(), inhibit, &latch);
    }
}

#[test]
fn a_hardware_fault_that_comes_again_latches_again() {
    for fault in HardwareFault::ALL {
        let mut rig = faulty(fault);
        for _ in 0..3 {
            sound(&mut rig);
            assert_eq!(rig.ask(clear(fault.inhibit())), Ok(()));
            rig.run(100);
            assert!(!rig.has(fault.inhibit()));
            rig.cord.board_mut().checks.0.push(fault);
            rig.run(2);
            assert!(rig.has(fault.inhibit()));
        }
    }
}

#[test]
fn no_reset_takes_a_latch_away_and_a_person_does() {
    for (number, (inhibit, latch)) in latches().enumerate() {
        let cause = RESETS[number % RESETS.len()];
        let mut rig = (latch.latched)();
        for _ in 0..2 {
            rig.reset(cause);
            assert!(rig.has(inhibit), "{}, {cause:?}", inhibit.name());
            rig.run(50);
        }
        rig.connect();
        rig.run(100);
        assert!(
            rig.log()
                .iter()
                .any(|line| line.starts_with("kept over the reset:")),
            "{}: {:?}",
            inhibit.name(),
            rig.log()
        );
        insist_and_clear(&mut rig, inhibit, &latch);
        rig.reset(cause);
        rig.connect();
        assert!(!rig.has(inhibit), "{} comes back", inhibit.name());
    }
}

#[test]
fn power_takes_latches_away_and_the_log_says_so() {
    for (inhibit, latch) in latches() {
        let mut rig = (latch.latched)();
        rig.repeated.clear();
        (latch.heal)(&mut rig);
        rig.reset(ResetCause::PowerOn);
        rig.connect();
        rig.run(200);
        assert!(!rig.has(inhibit), "{}", inhibit.name());
        assert!(
            rig.log().iter().any(|line| line.starts_with("power was off:")),
            "{:?}",
            rig.log()
        );
    }
}

#[test]
fn an_empty_and_a_hot_pack_are_so_after_a_reset() {
    let mut rig = Rig::connected(0);
    show(
        &mut rig,
        ChargerReadings {
            pack_mv: 10_500,
            ..PACK
        },
    );
    rig.run(11_000);
    // Without load the pack recovers.
    show(
        &mut rig,
        ChargerReadings {
            pack_mv: 13_600,
            ..PACK
        },
    );
    let levels = [Inhibit::BatteryLow, Inhibit::BatteryWeak, Inhibit::BatteryEmpty];
    for _ in 0..3 {
        assert!(
            levels.into_iter().all(|level| rig.has(level)),
            "{:?}",
            rig.names()
        );
        rig.reset(ResetCause::Watchdog);
        rig.connect();
        rig.run(500);
    }
    let mut rig = Rig::connected(0);
    warm_to(&mut rig, 530);
    warm_to(&mut rig, 560);
    warm_to(&mut rig, 530);
    rig.reset(ResetCause::Watchdog);
    rig.run(1_000);
    assert!(rig.has(Inhibit::BatteryHot), "{:?}", rig.names());
}

#[test]
fn what_another_firmware_stored_is_nothing() {
    let mut rig = stuck();
    let kept = &mut rig.cord.board_mut().kept;
    kept.words = kept.words.map(|mut words| {
        words[0] = words[0] & !0xFF | 0xEE;
        words
    });
    rig.cord.board_mut().bumpers.0 = Bumpers::default();
    rig.reset(ResetCause::Software);
    rig.connect();
    rig.run(100);
    assert!(!rig.has(Inhibit::BumperStuck));
    assert!(
        rig.log()
            .iter()
            .any(|line| line.starts_with("lost in the reset:")),
        "{:?}",
        rig.log()
    );
}

/// The board's seal finds damage; whatever passes it must still not break the firmware.
#[test]
fn no_stored_words_harm_the_start() {
    let mut phases = rig::Phases(0x4B45_5054);
    for _ in 0..2_000 {
        let mut words = [0_u32; KEPT_WORDS];
        for word in &mut words {
            *word = phases.below(u32::MAX) ^ phases.below(u32::MAX) << 16;
        }
        words[0] = words[0] & !0xFF | 1;
        let mut rig = Rig::switched_on_with(0, |board| board.kept.words = Some(words));
        rig.run(30);
        assert!(rig.wheels_off());
    }
}

#[test]
fn the_cause_of_the_last_stop_is_told_after_a_reset() {
    let mut rig = Rig::driving(0);
    rig.cord.board_mut().buttons.down = 1;
    rig.run(100);
    rig.reset(ResetCause::Watchdog);
    rig.connect();
    rig.run(100);
    let told = "last stop before the reset: button-stop";
    assert!(rig.log().contains(&told), "{:?}", rig.log());
}

#[test]
fn the_record_is_stored_when_a_latch_changes_and_every_ten_seconds() {
    let mut rig = Rig::connected(0);
    let before = rig.cord.board().kept.stores;
    rig.run(60_000);
    assert_eq!(rig.cord.board().kept.stores - before, 6);
    let before = rig.cord.board().kept.stores;
    rig.cord.board_mut().checks.0.push(HardwareFault::Clock);
    rig.run(1);
    assert_eq!(rig.cord.board().kept.stores - before, 1, "in the same pass");
}
