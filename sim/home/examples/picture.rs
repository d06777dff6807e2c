//! Writes a picture of a home: `cargo run -p home --example picture -- HOME OUT.png`, where HOME is a file or
//! `generated:NUMBER`. Floor is white where the robot can sweep and grey where it cannot; rugs are beige, drops red, the
//! dock is green, the start blue.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use home::generate::GeneratedHome;
use home::{Cell, Home, RobotModel};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(source), Some(out)) = (arguments.next(), arguments.next()) else {
        return Err("give a home and the name of a PNG".into());
    };
    let model = RobotModel::by_name("sr8730")?;
    let home = match source.strip_prefix("generated:") {
        Some(name) => GeneratedHome::parse(name)
            .ok_or("no such generated home")?
            .home(&model)?,
        None => Home::load(Path::new(&source), &model)?,
    };
    let grid = home.grid();
    let mut pixels = vec![0_u8; 3 * grid.cells.len()];
    for (index, pixel) in pixels.chunks_exact_mut(3).enumerate() {
        let (column, row) = (index % grid.width, grid.height - 1 - index / grid.width);
        pixel.copy_from_slice(&colour(&home, row * grid.width + column));
    }
    let file = BufWriter::new(File::create(&out)?);
    let mut encoder = png::Encoder::new(file, grid.width as u32, grid.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&pixels)?;
    println!(
        "{}: {:.1} m2, reachable {:.1} m2, connected {:.3}, T0 {:.1} min",
        home.name(),
        home.free_area_m2(),
        home.reachable_area_m2(),
        home.connected_share(),
        home.t0_s() / 60.0
    );
    Ok(())
}

fn colour(home: &Home, index: usize) -> [u8; 3] {
    let (x_m, y_m) = home.grid().centre(index);
    let near = |pose: home::Pose, m: f64| (pose.x_m - x_m).hypot(pose.y_m - y_m) < m;
    if home.dock().is_some_and(|dock| near(dock, 0.08)) {
        return [0, 150, 0];
    }
    if near(home.start(), 0.05) {
        return [0, 0, 255];
    }
    let reachable = home.reachable()[index];
    match home.grid().cells[index] {
        Cell::Outside => [40, 40, 40],
        Cell::Obstacle => [120, 70, 30],
        Cell::Cliff => [220, 40, 40],
        Cell::Floor if reachable => [255, 255, 255],
        Cell::Floor => [170, 170, 170],
        Cell::Rug if reachable => [240, 225, 180],
        Cell::Rug => [170, 150, 110],
    }
}
