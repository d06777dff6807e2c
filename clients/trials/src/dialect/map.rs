//! The map as a package of others draws it.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, ensure};
use serde_json::Value;

use super::rig::{DialectRig, peer};
use crate::Arguments;
use crate::program::{output, python_package};
use crate::verdict::Verdict;

/// The package's own colour of walls.
const WALL: [u8; 3] = [255, 255, 0];

/// Judged by the picture: colours of the rooms, the place of the robot and of its dock.
pub(super) fn drawn(rig: &DialectRig, arguments: &Arguments, verdict: &mut Verdict) {
    let Some(python) = &arguments.map_python else {
        return;
    };
    verdict.check(
        "valetudo-map-parser draws walls, rooms, robot and dock where they are",
        picture(rig, python),
    );
    if let Ok(version) = python_package(python, "valetudo-map-parser") {
        eprintln!("    valetudo-map-parser {version}");
    }
}

fn picture(rig: &DialectRig, python: &Path) -> anyhow::Result<()> {
    let file = rig.home.scratch.join("map.json");
    std::fs::write(&file, rig.read("robot/state/map")?.to_string())?;
    let view = rig.home_view()?;
    let frame = Frame::of(&view)?;
    let rooms = view["rooms"].as_array().context("no rooms")?;
    let middles: Vec<[f64; 2]> = rooms
        .iter()
        .map(|room| frame.place(room))
        .collect::<anyhow::Result<_>>()?;
    let dock = frame.place(&view["dock"])?;
    let cells = Cells::of(&view, &frame)?;
    let told = painted(rig, python, (&file, &middles, &cells))?;
    ensure!(
        cells.agree(&told["colours"]),
        "walls and floor are not where the robot knows them: {told}"
    );
    let colours: Vec<&Value> = middles
        .iter()
        .map(|middle| &told["colours"][words(*middle)])
        .collect();
    let [first, second] = colours.as_slice() else {
        anyhow::bail!("{told}");
    };
    ensure!(
        first.is_array() && second.is_array() && first != second,
        "rooms look alike: {told}"
    );
    ensure!(
        told["rooms"].as_object().map(serde_json::Map::len) == Some(2),
        "{told}"
    );
    let near = |x: &Value, y: &Value| {
        let apart = |told: &Value, right: f64| told.as_f64().is_some_and(|told| (told - right).abs() <= 4.0);
        apart(x, dock[0]) && apart(y, dock[1])
    };
    ensure!(
        near(&told["charger"]["x"], &told["charger"]["y"]),
        "the dock: {told}"
    );
    ensure!(near(&told["robot"][0], &told["robot"][1]), "the robot: {told}");
    Ok(())
}

fn words([x, y]: [f64; 2]) -> String {
    format!("{x:.0},{y:.0}")
}

/// What the package has drawn, and the colours at these places.
fn painted(
    rig: &DialectRig,
    python: &Path,
    (file, middles, cells): (&Path, &[[f64; 2]], &Cells),
) -> anyhow::Result<Value> {
    let mut command = Command::new(python);
    command.arg(peer("valetudo_map.py")).arg(file);
    command.arg(rig.home.scratch.join("map.png"));
    let places = middles.iter().chain(&cells.walls).chain(&cells.floor);
    command.args(places.map(|place| words(*place)));
    Ok(serde_json::from_str(&output(&mut command)?)?)
}

/// Some cells of which the daemon knows what they are, in their map.
struct Cells {
    walls: Vec<[f64; 2]>,
    floor: Vec<[f64; 2]>,
}

impl Cells {
    fn of(view: &Value, frame: &Frame) -> anyhow::Result<Self> {
        let number = |name: &str| view[name].as_u64().with_context(|| format!("no {name}"));
        let (width, height) = (number("width")?, number("height")?);
        let runs: Vec<u64> = view["cells"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_u64)
            .collect();
        let kinds: Vec<u64> = runs
            .chunks_exact(2)
            .flat_map(|run| std::iter::repeat_n(run[0], usize::try_from(run[1]).unwrap_or(0)))
            .collect();
        let kind = |x: u64, y: u64| {
            usize::try_from(y * width + x)
                .ok()
                .and_then(|at| kinds.get(at).copied())
        };
        let mut cells = Self {
            walls: Vec::new(),
            floor: Vec::new(),
        };
        // Steps that have nothing to do with the size of a pixel of theirs, which is two cells.
        let middles = (2..height.saturating_sub(2)).step_by(7);
        for (x, y) in middles.flat_map(|y| (2..width.saturating_sub(2)).step_by(11).map(move |x| (x, y))) {
            let around =
                |wanted: u64| (x - 2..=x + 2).all(|x| (y - 2..=y + 2).all(|y| kind(x, y) == Some(wanted)));
            let place = frame.middle(view, [x, y])?;
            match kind(x, y) {
                Some(1) if around(1) => cells.floor.push(place),
                Some(2) => cells.walls.push(place),
                _ => {}
            }
        }
        ensure!(
            cells.walls.len() > 20 && cells.floor.len() > 100,
            "the home is nearly empty"
        );
        Ok(cells)
    }

    /// The robot covers some floor.
    fn agree(&self, colours: &Value) -> bool {
        let is_wall = |place: &&[f64; 2]| colours[words(**place)] == serde_json::json!(WALL);
        let walls = self.walls.iter().filter(is_wall).count();
        let floor = self.floor.iter().filter(|place| !is_wall(place)).count();
        walls == self.walls.len() && floor * 100 >= self.floor.len() * 98
    }
}

/// Where our map lies in theirs: told from the daemon's own words alone.
pub(super) struct Frame {
    left_m: f64,
    top_m: f64,
}

impl Frame {
    pub(super) fn of(view: &Value) -> anyhow::Result<Self> {
        let number = |name: &str| view[name].as_f64().with_context(|| format!("no {name}"));
        let cell_m = number("cell_m")?;
        Ok(Self {
            left_m: number("x")? * cell_m,
            top_m: (number("y")? + number("height")?) * cell_m,
        })
    }

    /// The middle of a cell.
    fn middle(&self, view: &Value, [x, y]: [u64; 2]) -> anyhow::Result<[f64; 2]> {
        let number = |name: &str| view[name].as_f64().with_context(|| format!("no {name}"));
        let along = |name: &str, cell: u64| -> anyhow::Result<f64> {
            Ok((number(name)? + f64::from(u32::try_from(cell)?) + 0.5) * number("cell_m")?)
        };
        self.place(&serde_json::json!({"x": along("x", x)?, "y": along("y", y)?}))
    }

    /// Centimetres from the upper left corner.
    pub(super) fn place(&self, of: &Value) -> anyhow::Result<[f64; 2]> {
        let (x, y) = (
            of["x"].as_f64().context("no x")?,
            of["y"].as_f64().context("no y")?,
        );
        Ok([(x - self.left_m) * 100.0, (self.top_m - y) * 100.0])
    }
}
