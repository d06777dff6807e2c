//! Record of a run, for pictures: samples of each second, bumps, the plan and the robot's map at the end.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use brain::mapping::{CELL_M, CellKnowledge, SurfaceKind};
use home::{Cell, Home, Pose, Truth};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::baseline::Origin;
use crate::figures::Belief;
use crate::{Host, RunReport};

/// The path of a run. All positions are in the plan frame.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Trace {
    /// Moments, one a second.
    pub samples: Vec<Sample>,
    /// Places of contacts.
    pub bumps: Vec<[f64; 2]>,
    #[serde(skip)]
    contacts: u32,
}

/// One moment.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Sample {
    /// Simulated seconds, without those on the charger in the middle of the job.
    pub t_s: f64,
    /// Share of the reachable floor that was swept.
    pub share: f64,
    /// True place, metres.
    pub place: [f64; 2],
    /// Distance between believed and true place, metres.
    pub error_m: f64,
    /// The robot cleans.
    pub cleans: bool,
}

/// A run as it is kept in a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct KeptRun {
    /// What it is called: strategy, noise, seed and what else was asked.
    pub title: String,
    /// In what it was made; `None` = in an emulated chip, or by a version that did not keep it.
    #[serde(default)]
    pub origin: Option<Origin>,
    /// The figures.
    pub report: serde_json::Value,
    /// The plan of the home.
    pub plan: Drawing,
    /// The dock's place in the plan.
    pub dock: Option<[f64; 2]>,
    /// The robot's map at the end, if it made one, in the plan frame.
    pub map: Option<Drawing>,
    /// What happened.
    pub trace: Trace,
}

/// Cells of a plan or a map.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Drawing {
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// Cells of a row.
    pub width: usize,
    /// Frame of the cells in the plan: x, y in metres and direction in radians.
    pub origin: [f64; 3],
    /// Pairs of kind and length, row after row.
    pub runs: Vec<u32>,
}

/// Nothing is known, or nothing is there.
pub(crate) const NOTHING: u32 = 0;
/// Free floor.
pub(crate) const FLOOR: u32 = 1;
/// Something solid.
pub(crate) const SOLID: u32 = 2;
/// A drop.
pub(crate) const DROP: u32 = 3;
/// A rug.
pub(crate) const RUG: u32 = 4;
/// Floor that the swath cannot reach.
pub(crate) const OUT_OF_REACH: u32 = 5;

impl Trace {
    pub(crate) fn sample(&mut self, (time_ms, truth): (u64, &Truth), error_m: f64, belief: &Belief) {
        let place = [truth.pose.x_m, truth.pose.y_m];
        if truth.contacts > self.contacts {
            self.contacts = truth.contacts;
            self.bumps.push(place);
        }
        let is_new = self
            .samples
            .last()
            .is_none_or(|last| time_ms > (1000.0 * last.t_s) as u64);
        if truth.time_ms.is_multiple_of(1000) && is_new {
            self.samples.push(Sample {
                t_s: time_ms as f64 / 1000.0,
                share: truth.swept_share,
                place,
                error_m,
                cleans: belief.state == Some(brain::BehaviorState::Cleaning),
            });
        }
    }
}

impl Drawing {
    /// The plan of a home.
    #[must_use]
    pub fn of_home(home: &Home) -> Self {
        let grid = home.grid();
        let kinds = grid
            .cells
            .iter()
            .zip(home.reachable())
            .map(|(cell, reachable)| match cell {
                Cell::Outside => NOTHING,
                Cell::Obstacle => SOLID,
                Cell::Cliff => DROP,
                Cell::Floor | Cell::Rug if !reachable => OUT_OF_REACH,
                Cell::Floor => FLOOR,
                Cell::Rug => RUG,
            });
        Self {
            cell_m: grid.cell_m,
            width: grid.width,
            origin: [0.0; 3],
            runs: crate::plan::run_lengths(kinds),
        }
    }

    /// The host's map of the home; `None` = none.
    #[must_use]
    pub fn of_map(host: &Host, plan_from_map: Pose) -> Option<Self> {
        let map = host.brain()?.map();
        let knowledge = map.knowledge();
        if knowledge.values().is_empty() {
            return None;
        }
        let carpet = |index| map.surface_kind(knowledge.cell(index)) == Some(SurfaceKind::Carpet);
        let kinds = knowledge
            .values()
            .iter()
            .enumerate()
            .map(|(index, kind)| match kind {
                CellKnowledge::Unknown => NOTHING,
                CellKnowledge::Free if carpet(index) => RUG,
                CellKnowledge::Free => FLOOR,
                CellKnowledge::Occupied => SOLID,
                CellKnowledge::Cliff | CellKnowledge::NoGo => DROP,
            });
        let corner = knowledge.origin();
        let (x_m, y_m) = plan_from_map.point(f64::from(corner.x) * CELL_M, f64::from(corner.y) * CELL_M);
        Some(Self {
            cell_m: CELL_M,
            width: knowledge.width(),
            origin: [x_m, y_m, plan_from_map.heading_rad],
            runs: crate::plan::run_lengths(kinds),
        })
    }
}

/// Ending of the files that hold runs.
const ENDING: &str = ".run.json";

impl KeptRun {
    /// A run that is over.
    ///
    /// # Errors
    /// When the report cannot be written as JSON.
    pub fn new(title: String, report: &RunReport, home: &Home) -> anyhow::Result<Self> {
        Ok(Self {
            title,
            origin: None,
            report: serde_json::to_value(report)?,
            plan: Drawing::of_home(home),
            dock: home.dock().map(|dock| [dock.x_m, dock.y_m]),
            map: None,
            trace: Trace::default(),
        })
    }

    /// Writes it into a folder, which is made if need be; a run of the same name is written over.
    ///
    /// # Errors
    /// When the folder or the file cannot be written.
    pub fn keep(&self, folder: &Path) -> anyhow::Result<PathBuf> {
        let home = self.report["home"].as_str().unwrap_or("home");
        keep_as(folder, (&format!("{home} {}", self.title), ENDING), self)
    }

    /// As [`Self::all`], also of a folder without any.
    ///
    /// # Errors
    /// When the folder cannot be read, or a file is not what it seems.
    pub fn all_or_none(folder: &Path) -> anyhow::Result<Vec<Self>> {
        kept_in(folder, ENDING)
    }

    /// All runs of a folder, by name.
    ///
    /// # Errors
    /// When the folder cannot be read, holds no run, or a file is not what it seems.
    pub fn all(folder: &Path) -> anyhow::Result<Vec<Self>> {
        let runs = Self::all_or_none(folder)?;
        anyhow::ensure!(
            !runs.is_empty(),
            "{} holds no runs; make some with: rvac-sim run --keep {0} --home ...",
            folder.display()
        );
        Ok(runs)
    }
}

/// Writes something into a folder, which is made if need be.
pub(crate) fn keep_as(
    folder: &Path,
    (name, ending): (&str, &str),
    kept: &impl Serialize,
) -> anyhow::Result<PathBuf> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let name: String = name
        .chars()
        .map(|letter| {
            if letter.is_ascii_alphanumeric() {
                letter.to_ascii_lowercase()
            } else {
                '-'
            }
        })
        .collect();
    let path = folder.join(format!("{name}{ending}"));
    let text = serde_json::to_string(kept)?;
    fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// Everything in a folder whose name ends so, by name.
pub(crate) fn kept_in<Kept: DeserializeOwned>(folder: &Path, ending: &str) -> anyhow::Result<Vec<Kept>> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.to_string_lossy().ends_with(ending))
        .collect();
    paths.sort();
    paths.iter().map(|path| read(path)).collect()
}

fn read<Kept: DeserializeOwned>(path: &Path) -> anyhow::Result<Kept> {
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{} is not what it seems", path.display()))
}
