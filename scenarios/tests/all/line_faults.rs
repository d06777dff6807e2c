//! A line that damages, repeats, delays and invents: the robot cleans on through what is mild, stands under a name through the
//! rest, and goes on by itself.

use rvac_sim::line_faults::{FaultPassage, HostClock, LineFault, passages};
use scenarios::scene;

const SEED: u64 = 1;
/// A mild fault costs less than half of the way of a minute, because the robot drives at half speed at least,
const MILD_SHARE_MIN: f64 = 0.4;
/// and it stands for hardly longer than without: it turns and rests in any job.
const MILD_STANDING_MAX_S: f64 = 6.0;
/// After a fault that lasted a new announcement comes (S24), and after one that came back the robot waits for longer.
const GOES_ON_MAX_S: f64 = 25.0;
/// The log of a minute names each fault when it begins and when it is over, and what the robot decided.
const LOG_MAX: usize = 60;

fn passage(fault: LineFault) -> FaultPassage {
    let scene = scene("two-room-flat", "nominal");
    let all = passages(&scene, SEED, &[fault]);
    all.into_iter().next().expect("one fault, one passage")
}

#[test]
fn the_robot_cleans_on_through_mild_faults() {
    let scene = scene("two-room-flat", "nominal");
    let mild: Vec<LineFault> = LineFault::ALL
        .into_iter()
        .filter(|fault| fault.is_mild())
        .collect();
    let all = passages(&scene, SEED, &mild);
    let without_m = all[0].way_m;
    assert!(without_m > 5.0, "{without_m} m without a fault");
    for row in &all {
        assert!(row.way_m > MILD_SHARE_MIN * without_m, "{row:?}");
        assert!(row.standing_s < MILD_STANDING_MAX_S, "{row:?}");
        assert!(row.named.is_empty(), "{row:?}");
        assert!(row.log_lines <= LOG_MAX, "{row:?}");
        assert_eq!((row.state.as_str(), row.violations), ("cleaning", 0), "{row:?}");
    }
}

#[test]
fn each_hard_fault_has_a_name_and_sound_reports_heal_it() {
    let cases = [
        (LineFault::OpenGarbage { per_s: 200 }, "link-corrupted"),
        (LineFault::WrongSeal { every: 1 }, "link-corrupted"),
        (LineFault::EverySecondSecond, "link-corrupted"),
        (LineFault::WrongCommandSeal { every: 1 }, "link-lost"),
        (LineFault::FrozenTick { for_ms: 60_000 }, "clock-frozen"),
        (LineFault::FrozenTick { for_ms: 2_000 }, "clock-frozen"),
        (
            LineFault::ClockJump {
                by_ms: 60_000,
                times: 1,
            },
            "clock-jumped",
        ),
        (
            LineFault::ClockJump {
                by_ms: 60_000,
                times: 2,
            },
            "clock-jumped",
        ),
        (
            LineFault::ClockJump {
                by_ms: -60_000,
                times: 1,
            },
            "clock-jumped",
        ),
        (LineFault::ShiftedTicks { by_ms: 60_000 }, "commands-stale"),
        (LineFault::Delayed { ms: 600 }, "commands-stale"),
        (LineFault::Thinned { keep_every: 25 }, "link-late"),
        (LineFault::CutOut { for_ms: 2_000 }, "link-lost"),
    ];
    let scene = scene("two-room-flat", "nominal");
    let faults = cases.map(|(fault, _)| fault);
    for (row, (_, name)) in passages(&scene, SEED, &faults).iter().zip(cases) {
        assert!(row.named.contains(name), "{name}: {row:?}");
        assert!(row.healed_s.is_some_and(|s| s < GOES_ON_MAX_S), "{row:?}");
        assert!(row.log_lines <= LOG_MAX, "{row:?}");
        assert!(!row.named.contains("not-moving"), "{row:?}");
        assert_eq!(row.violations, 0, "{row:?}");
    }
}

#[test]
fn a_stray_tick_changes_nothing() {
    let without = passage(LineFault::None);
    for by_ms in [60_000, -60_000] {
        let row = passage(LineFault::StrayTick { by_ms });
        assert_eq!(row.named, without.named, "{row:?}");
        assert!((row.way_m - without.way_m).abs() < 0.5 * without.way_m, "{row:?}");
    }
}

#[test]
fn a_host_that_slept_goes_on_whatever_its_clock_did() {
    for clock in [HostClock::Stands, HostClock::Runs] {
        let row = passage(LineFault::HostSuspended(clock));
        assert!(row.way_m < 0.1, "the robot stood without its host: {row:?}");
        assert!(row.healed_s.is_some_and(|s| s < GOES_ON_MAX_S), "{row:?}");
        assert_eq!(row.violations, 0, "{row:?}");
    }
}

#[test]
fn wheels_whose_counts_stand_are_not_a_fault_of_the_line() {
    let row = passage(LineFault::FrozenCounts);
    assert!(row.named.contains("not-moving"), "{row:?}");
    assert_eq!(row.violations, 0, "{row:?}");
}
