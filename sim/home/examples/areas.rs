//! Prints what the simulator derives from homes: `cargo run -p home --example areas -- FILE...`

use std::path::Path;

use home::{Home, RobotModel};

fn main() {
    let model = match RobotModel::by_name("sr8730") {
        Ok(model) => model,
        Err(error) => return eprintln!("{error}"),
    };
    for file in std::env::args().skip(1) {
        match Home::load(Path::new(&file), &model) {
            Ok(home) => println!(
                "{}: {} x {} cells of {} m, free {:.2} m2, reachable {:.2} m2, t0 {:.1} min, start {:?}, dock {:?}",
                home.name(),
                home.grid().width,
                home.grid().height,
                home.grid().cell_m,
                home.free_area_m2(),
                home.reachable_area_m2(),
                home.t0_s() / 60.0,
                home.start(),
                home.dock(),
            ),
            Err(error) => eprintln!("{error}"),
        }
    }
}
