//! How well ranges to beacons of unknown places tell where a real robot was: a recording of the MRPT project in its own
//! format, and the true poses beside it.
//!
//!     zcat uwb_ro-localization_demo.rawlog > uwb.rawlog
//!     cargo run --release -p brain --example beacons -- uwb.rawlog uwb_ro-localization_demo_GT.txt
//!
//! The odometry of the recording stands for that of wheels alone; what it says of its own errors is not used, and neither
//! is the laser scanner. Both ways begin where the true one does.

mod rawlog;

use std::env;
use std::fs;

use brain::localization::Localization;
use brain::observation::{BeaconRange, BeaconSignal};
use brain::{Observation, Point2, Pose2};
use rawlog::{Entry, Rawlog};

/// Any track serves: the recording has no wheels, so what they would have counted is made from its odometry.
const TRACK_M: f64 = 0.4;
/// Steps of the recording are taken to be a second apart; they have no other use than to bound jumps.
const STEP_US: u64 = 1_000_000;
const RIM_MAX_M_PER_S: f64 = 2.0;
/// Deviation of one range in sight, metres: what modules of this make have.
const RANGE_SIGMA_M: f64 = 0.1;

/// Poses that were found, and the true ones.
#[derive(Default)]
struct Errors {
    pairs: Vec<(Pose2, Pose2)>,
}

impl Errors {
    fn add(&mut self, found: Pose2, truth: Pose2) {
        self.pairs.push((found, truth));
    }

    fn report(&self, name: &str, from: usize) {
        let pairs = self.pairs.get(from..).unwrap_or_default();
        let rmse = |of: &dyn Fn(&(Pose2, Pose2)) -> f64| {
            let sum: f64 = pairs.iter().map(|pair| of(pair) * of(pair)).sum();
            (sum / pairs.len().max(1) as f64).sqrt()
        };
        let off_m = |pair: &(Pose2, Pose2)| pair.0.position().distance_m(pair.1.position());
        let fit = alignment(pairs);
        let aligned_m = |pair: &(Pose2, Pose2)| off_m(&(fit * pair.0, pair.1));
        let off_rad = |pair: &(Pose2, Pose2)| {
            let off_rad = pair.0.heading_rad - pair.1.heading_rad;
            off_rad.sin().atan2(off_rad.cos())
        };
        println!(
            "{name:<14} {:.3} m, worst {:.3} m, heading {:.1} deg; after rigid alignment {:.3} m",
            rmse(&off_m),
            pairs.iter().map(off_m).fold(0.0, f64::max),
            rmse(&off_rad).to_degrees(),
            rmse(&aligned_m)
        );
    }
}

/// The rigid motion that brings the places that were found nearest to the true ones.
fn alignment(pairs: &[(Pose2, Pose2)]) -> Pose2 {
    let count = pairs.len().max(1) as f64;
    let mean = |of: &dyn Fn(&(Pose2, Pose2)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (fx, fy) = (mean(&|pair| pair.0.x_m), mean(&|pair| pair.0.y_m));
    let (tx, ty) = (mean(&|pair| pair.1.x_m), mean(&|pair| pair.1.y_m));
    let along = mean(&|pair| (pair.0.x_m - fx) * (pair.1.x_m - tx) + (pair.0.y_m - fy) * (pair.1.y_m - ty));
    let across = mean(&|pair| (pair.0.x_m - fx) * (pair.1.y_m - ty) - (pair.0.y_m - fy) * (pair.1.x_m - tx));
    let turn = Pose2 {
        heading_rad: across.atan2(along),
        ..Pose2::IDENTITY
    };
    let turned = turn.transform(Point2 { x_m: fx, y_m: fy });
    Pose2 {
        x_m: tx - turned.x_m,
        y_m: ty - turned.y_m,
        ..turn
    }
}

fn main() -> Result<(), String> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [log, truth] = arguments.as_slice() else {
        return Err("usage: beacons LOG TRUTH (see the head of brain/examples/beacons/main.rs)".to_owned());
    };
    let bytes = fs::read(log).map_err(|error| format!("cannot read {log}: {error}"))?;
    let log = Rawlog::new(&bytes)?;
    let truth = true_poses(truth)?;
    let mut localization = Localization::new(TRACK_M, RIM_MAX_M_PER_S);
    let mut odometry = Localization::new(TRACK_M, RIM_MAX_M_PER_S);
    let (mut by_beacons, mut by_odometry) = (Errors::default(), Errors::default());
    let mut view = Observation::default();
    let mut known_at = None;
    let mut way_m = 0.0;
    let mut poses = truth.iter();
    // The recording begins with what was heard at the start.
    let mut now = Some(&Pose2::IDENTITY);
    for entry in log.entries() {
        match entry {
            Entry::Ranges(ranges) => {
                view.beacons.extend(ranges.into_iter().map(|(beacon, range_m)| {
                    BeaconSignal::Range(BeaconRange {
                        beacon,
                        range_m,
                        sigma_m: RANGE_SIGMA_M,
                    })
                }));
            }
            Entry::Moved(step) => {
                let Some(truth) = now else { break };
                let advance = odometry.update(&view);
                localization.update(&view);
                localization.refine(&view, advance);
                view.beacons.clear();
                by_beacons.add(localization.pose(), *truth);
                by_odometry.add(odometry.pose(), *truth);
                if known_at.is_none() && localization.knows_heading(view.time_us) {
                    known_at = Some((by_beacons.pairs.len(), way_m));
                }
                roll(&mut view, step);
                now = poses.next();
                way_m += step.position().distance_m(Point2::ORIGIN);
            }
        }
    }
    println!("{} steps, {way_m:.1} m", by_beacons.pairs.len());
    by_odometry.report("odometry", 0);
    let Some((step, after_m)) = known_at else {
        println!("the beacons were never known well enough");
        return Ok(());
    };
    by_beacons.report("with beacons", 0);
    println!("the beacons were known at step {step}, after {after_m:.1} m; from there on:");
    by_odometry.report("odometry", step);
    by_beacons.report("with beacons", step);
    Ok(())
}

/// What wheels would have counted on this step.
fn roll(view: &mut Observation, step: Pose2) {
    let way_m = step.x_m.hypot(step.y_m).copysign(step.x_m);
    let rim_m = 0.5 * TRACK_M * step.heading_rad;
    view.time_us += STEP_US;
    view.travel_left_m += way_m - rim_m;
    view.travel_right_m += way_m + rim_m;
}

/// Lines of number, x, y and heading.
fn true_poses(path: &str) -> Result<Vec<Pose2>, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("cannot read {path}: {error}"))?;
    text.lines()
        .map(|line| {
            let numbers: Vec<f64> = line
                .split_whitespace()
                .filter_map(|word| word.parse().ok())
                .collect();
            match numbers.as_slice() {
                [_, x_m, y_m, heading_rad] => Ok(Pose2 {
                    x_m: *x_m,
                    y_m: *y_m,
                    heading_rad: *heading_rad,
                }),
                _ => Err(format!("{path}: `{line}` is not number, x, y and heading")),
            }
        })
        .collect()
}
