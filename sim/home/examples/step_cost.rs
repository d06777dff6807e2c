//! Prints what one simulated millisecond costs: `cargo run --release -p home --example step_cost -- [HOME]`

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use home::{Actuation, Bridge, Home, Noise, Pcg, Pose, RobotModel, World};

const STEPS: u32 = 2_000_000;

fn drive(left: f64, right: f64) -> Actuation {
    let wheel = |pwm| Bridge { pwm, brake: true };
    Actuation {
        wheel_left: wheel(left),
        wheel_right: wheel(right),
        brush_main: 1.0,
        brush_sides: true,
        vacuum: true,
        cliff_emitter: true,
        dock_signal: false,
        charge_a: None,
    }
}

/// Nanoseconds that this process has spent on a processor, so that a busy machine does not spoil the figures; where the
/// system does not tell, those of the wall clock.
fn processor_ns(start: Instant) -> f64 {
    std::fs::read_to_string("/proc/self/schedstat")
        .ok()
        .and_then(|text| text.split_whitespace().next()?.parse().ok())
        .unwrap_or_else(|| start.elapsed().as_nanos() as f64)
}

fn measure(name: &str, world: &World, mut next: impl FnMut(&World) -> Actuation) {
    let mut world = world.clone();
    let clock = Instant::now();
    let before_ns = processor_ns(clock);
    for _ in 0..STEPS {
        let actuation = next(&world);
        world.step(&actuation);
    }
    let ns = (processor_ns(clock) - before_ns) / f64::from(STEPS);
    let truth = world.truth();
    println!(
        "{name:<12} {ns:6.1} ns per step ({:.0} x real time); path {:.1} m, {} contacts, swept {:.3}",
        1e6 / ns,
        truth.path_m,
        truth.contacts,
        truth.swept_share
    );
}

/// Straight until something is touched, then back and around by a random angle.
fn bounce() -> impl FnMut(&World) -> Actuation {
    let mut random = Pcg::new(1, 9);
    let (mut back, mut around, mut side) = (0, 0, 1.0);
    move |world| {
        let sensors = world.sensors();
        if (sensors.bumper_left || sensors.bumper_right) && back == 0 && around == 0 {
            back = 400;
            around = 300 + random.below(1500);
            side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        }
        if back > 0 {
            back -= 1;
            drive(-0.5, -0.5)
        } else if around > 0 {
            around -= 1;
            drive(-0.4 * side, 0.4 * side)
        } else {
            drive(0.6, 0.6)
        }
    }
}

fn main() {
    let file = std::env::args().nth(1).map_or_else(
        || {
            PathBuf::from(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/../../homes/two-room-flat.toml"
            ))
        },
        PathBuf::from,
    );
    let loaded = RobotModel::by_name("sr8730")
        .map_err(|error| error.to_string())
        .and_then(|model| {
            let home = Home::load(&file, &model).map_err(|error| error.to_string())?;
            Ok((model, Arc::new(home)))
        });
    let (model, home) = match loaded {
        Ok(loaded) => loaded,
        Err(error) => return eprintln!("{error}"),
    };
    let world = World::new(home.clone(), &model, &Noise::nominal(), 1, None);
    measure("idle", &world, |_| Actuation::default());
    measure("bounce", &world, bounce());
    measure("circle", &world, |_| drive(0.5, 0.6));
    let wall = home.dock().map_or(home.start(), |dock| {
        let (x_m, y_m) = dock.point(0.2, 0.0);
        Pose::new(x_m, y_m, dock.heading_rad + core::f64::consts::PI)
    });
    let at_wall = World::new(home, &model, &Noise::nominal(), 1, Some(wall));
    measure("at a wall", &at_wall, |_| drive(0.6, 0.6));
}
