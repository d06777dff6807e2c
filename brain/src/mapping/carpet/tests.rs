//! Loads on different floors and obstacles, and the surfaces detected from them.

use super::{CarpetDetector, SurfaceKind, SurfaceObservation};
use crate::model::inhibit::{Inhibit, Inhibits};
use crate::model::observation::{Contacts, MotorCurrents, Observation};

/// Loads on hard floor, on a flat mat and on a deep pile, amperes: one wheel and the brush.
const HARD: [f32; 2] = [0.06, 0.5];
const MAT: [f32; 2] = [0.087, 0.675];
const PILE: [f32; 2] = [0.18, 1.0];
/// Relative scatter of readings.
const SCATTER: f32 = 0.1;
const CRUISE_M_PER_S: f64 = 0.25;
const STEP_US: u64 = 50_000;
/// Delay of the measured current, seconds.
const DELAY_S: f64 = 0.06;

/// A robot that drives straight ahead.
struct Drive {
    detector: CarpetDetector,
    view: Observation,
    percent: u8,
    noise: u32,
}

/// Number of observations by reported surface.
#[derive(Debug, Default, PartialEq, Eq)]
struct Reports {
    carpet: u32,
    hard: u32,
    nothing: u32,
}

impl Drive {
    fn new() -> Self {
        Self {
            detector: CarpetDetector::default(),
            view: Observation::default(),
            percent: 100,
            noise: 1,
        }
    }

    /// A drive that has seen both surfaces.
    fn experienced() -> Self {
        let mut drive = Self::new();
        drive.on(40.0, HARD);
        drive.on(4.0, PILE);
        drive.on(4.0, HARD);
        drive
    }

    fn scattered(&mut self, load_a: f32) -> f32 {
        self.noise = self.noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let share = (self.noise >> 8) as f32 / (1 << 24) as f32;
        load_a * (1.0 + SCATTER * (2.0 * share - 1.0))
    }

    fn step(
        &mut self,
        [left_m_per_s, right_m_per_s]: [f64; 2],
        [wheel_a, brush_a]: [f32; 2],
    ) -> Option<SurfaceObservation> {
        self.view.time_us += STEP_US;
        self.view.travel_left_m += 1e-6 * STEP_US as f64 * left_m_per_s;
        self.view.travel_right_m += 1e-6 * STEP_US as f64 * right_m_per_s;
        self.view.currents = Some(MotorCurrents {
            wheel_left_a: self.scattered(wheel_a),
            wheel_right_a: self.scattered(wheel_a),
            brush_main_a: Some(self.scattered(brush_a)),
        });
        self.detector.update(&self.view, Some(self.percent))
    }

    /// Straight ahead for some seconds.
    fn on(&mut self, time_s: f64, load_a: [f32; 2]) -> Reports {
        self.at(time_s, [CRUISE_M_PER_S; 2], |_| load_a)
    }

    /// With these wheel speeds; the load depends on the time since the start.
    fn at(&mut self, time_s: f64, wheels: [f64; 2], load_a: impl Fn(f64) -> [f32; 2]) -> Reports {
        let mut reports = Reports::default();
        let steps = (time_s * 1e6) as u64 / STEP_US;
        for step in 0..steps {
            let since_s = 1e-6 * (step * STEP_US) as f64;
            match self.step(wheels, load_a(since_s)).map(|observed| observed.kind) {
                Some(SurfaceKind::Carpet) => reports.carpet += 1,
                Some(SurfaceKind::Hard) => reports.hard += 1,
                None => reports.nothing += 1,
            }
        }
        reports
    }
}

#[test]
fn mats_and_piles_are_detected_and_the_floor_between_them_is_not() {
    let mut drive = Drive::experienced();
    for rug in [MAT, PILE, MAT] {
        let found = drive.on(3.0, rug);
        assert!(found.carpet >= 45 && found.nothing == 0, "{rug:?}: {found:?}");
        let after = drive.on(3.0, HARD);
        assert!(after.hard >= 45 && after.nothing == 0, "after {rug:?}: {after:?}");
    }
}

#[test]
fn the_edge_of_a_carpet_is_located() {
    let mut drive = Drive::experienced();
    // Measurements are late.
    let edge_m = drive.view.travel_left_m - DELAY_S * CRUISE_M_PER_S;
    let observed = loop {
        let observed = drive.step([CRUISE_M_PER_S; 2], PILE);
        if let Some(observed) = observed.filter(|observed| observed.kind == SurfaceKind::Carpet) {
            break observed;
        }
    };
    let place_m = drive.view.travel_left_m - 0.001 * f64::from(observed.behind_mm);
    assert!(
        (place_m - edge_m).abs() < 0.025,
        "{:.3} m beyond its edge",
        place_m - edge_m
    );
}

#[test]
fn a_home_with_a_single_surface_reports_nothing() {
    for floor in [HARD, PILE] {
        let reports = Drive::new().on(600.0, floor);
        assert_eq!((reports.carpet, reports.hard), (0, 0), "{floor:?}");
    }
}

#[test]
fn a_robot_that_starts_on_a_rug_learns_the_hard_floor() {
    let mut drive = Drive::new();
    drive.on(30.0, PILE);
    assert_eq!(drive.on(60.0, HARD).carpet, 0);
    assert!(drive.on(5.0, PILE).carpet > 80);
}

#[test]
fn a_large_carpet_does_not_become_the_baseline() {
    let mut drive = Drive::experienced();
    drive.on(1_500.0, MAT);
    let late = drive.on(10.0, MAT);
    assert_eq!(late.carpet, 200, "{late:?}");
    assert!(drive.on(5.0, HARD).hard > 80);
}

#[test]
fn pushing_and_climbing_are_not_carpet() {
    let mut drive = Drive::experienced();
    drive.view.contacts = Contacts {
        left: true,
        right: true,
    };
    assert_eq!(drive.on(2.0, PILE).nothing, 40, "a bumper is pressed");
    drive.view.contacts = Contacts::default();
    drive.view.inhibits.insert(Inhibit::Bumper);
    assert_eq!(drive.on(2.0, PILE).nothing, 40, "and holds the wheels");
    drive.view.inhibits = Inhibits::NONE;
    let chair_or_slope = [PILE[0], HARD[1]];
    assert_eq!(drive.on(5.0, chair_or_slope).carpet, 0);
    let threshold = |since_s: f64| if since_s < 0.08 { [0.5, 1.5] } else { HARD };
    assert_eq!(drive.at(2.0, [CRUISE_M_PER_S; 2], threshold).carpet, 0);
}

#[test]
fn curves_and_changes_of_speed_report_nothing() {
    let mut drive = Drive::experienced();
    let turning = drive.at(3.0, [0.2, 0.3], |_| PILE);
    assert!(turning.carpet == 0 && turning.hard <= 2, "{turning:?}");
    let backing = drive.at(3.0, [-0.25, -0.25], |_| PILE);
    assert_eq!(backing.nothing, 60);
    for step in 0..20 {
        let speed_m_per_s = 0.12 + 0.01 * f64::from(step);
        assert_eq!(
            drive.step([speed_m_per_s; 2], PILE),
            None,
            "at {speed_m_per_s} m/s"
        );
    }
}

#[test]
fn the_baseline_follows_hair_and_an_emptying_pack_and_rugs_are_still_detected() {
    for end in [1.6, 0.8] {
        let mut drive = Drive::experienced();
        let [wheel_a, brush_a] = HARD;
        // An emptying pack lowers both currents, hair loads the brush.
        let wheels_end = f64::min(end, 1.0);
        let at = |since_s: f64| {
            let share = since_s / 3_000.0;
            [
                wheel_a * (1.0 + share * (wheels_end - 1.0)) as f32,
                brush_a * (1.0 + share * (end - 1.0)) as f32,
            ]
        };
        let reports = drive.at(3_000.0, [CRUISE_M_PER_S; 2], at);
        assert_eq!(reports.carpet, 0, "times {end}");
        let [wheel_a, brush_a] = MAT;
        let rug = [wheel_a * wheels_end as f32, brush_a * end as f32];
        let found = drive.on(3.0, rug);
        assert!(found.carpet >= 45, "times {end}: {found:?}");
    }
}

#[test]
fn only_loads_of_the_same_power_and_speed_are_compared() {
    let mut drive = Drive::new();
    drive.percent = 40;
    drive.on(60.0, [HARD[0], 0.4 * HARD[1]]);
    drive.percent = 100;
    assert_eq!(drive.on(60.0, HARD).carpet, 0, "a brush that is asked for more");
    assert_eq!(drive.at(60.0, [0.15; 2], |_| [0.04, 0.5]).carpet, 0);
    let faster = drive.at(60.0, [0.3; 2], |_| [0.09, 0.7]);
    assert_eq!(faster.carpet, 0);
    drive.percent = 40;
    let known = drive.on(5.0, [PILE[0], 0.4 * PILE[1]]);
    assert!(known.carpet > 60, "what was learnt at that power: {known:?}");
}

#[test]
fn missing_measurements_report_nothing() {
    let mut drive = Drive::experienced();
    drive.view.currents = None;
    drive.view.time_us += STEP_US;
    assert_eq!(drive.detector.update(&drive.view, Some(100)), None);
    assert_eq!(drive.on(2.0, [f32::NAN, 0.5]).nothing, 40);
    assert_eq!(drive.on(2.0, [0.0, f32::INFINITY]).nothing, 40);
    assert!(drive.on(5.0, HARD).hard > 60, "and is forgotten");
    drive.percent = 0;
    assert_eq!(drive.on(2.0, PILE).nothing, 40, "a brush that rests");
    let mut idle = Drive::new();
    let reports = idle.on(60.0, [0.001, 0.001]);
    let more = idle.on(60.0, [0.01, 0.01]);
    assert_eq!(
        (reports.carpet, more.carpet),
        (0, 0),
        "less than the converter can tell"
    );
}
