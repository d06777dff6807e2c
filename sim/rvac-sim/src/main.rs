//! `rvac-sim`: a simulated robot in a simulated home.
#![forbid(unsafe_code)]

mod arguments;
mod progress;

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, bail};
use arguments::{Arguments, FaultArguments, ReportArguments, RunArguments, ServeArguments, SimCommand};
use brain::StoredMap;
use clap::Parser;
use home::RobotModel;
use home::generate::{GeneratedHome, PUBLISHED};
use progress::Progress;
use rvac_sim::baseline::add_missing;
use rvac_sim::days::KeptDays;
use rvac_sim::faults::{FaultCampaign, Summary, trials};
use rvac_sim::line_faults::{LineFault, LineFaultTable, passages};
use rvac_sim::page;
use rvac_sim::run::{household, run_until};
use rvac_sim::serve::serve;
use rvac_sim::trace::KeptRun;
use rvac_sim::{
    CalibrationChoice, Firmware, GyroFitted, Host, Household, RunReport, Scene, SceneError, SceneSettings,
    explain,
};
use vthal_core::stored_map;

/// Bad input; nothing was done.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        SimCommand::Serve(arguments) => serve_robot(&arguments),
        SimCommand::Run(arguments) => run_household(&arguments),
        SimCommand::Faults(arguments) if arguments.line => run_line_trials(&arguments),
        SimCommand::Faults(arguments) => run_trials(&arguments),
        SimCommand::Homes(arguments) => write_homes(&arguments.folder),
        SimCommand::Report(arguments) => write_page(&arguments),
    };
    outcome.unwrap_or_else(|error| {
        // If standard error is closed, the message is lost.
        writeln!(io::stderr(), "rvac-sim: {error:#}").ok();
        ExitCode::from(BAD_INPUT)
    })
}

/// The scene, and what its home's file may mean otherwise than its maker thinks: told before the robot drives.
fn told_scene(settings: &SceneSettings) -> anyhow::Result<Scene> {
    let scene = Scene::load(settings)?;
    for notice in scene.home().notices() {
        // If standard error is closed, the notice is lost.
        writeln!(io::stderr(), "rvac-sim: {notice}").ok();
    }
    Ok(scene)
}

fn serve_robot(arguments: &ServeArguments) -> anyhow::Result<ExitCode> {
    let scene = told_scene(&arguments.scene.settings())?;
    serve(&scene, &arguments.settings())?;
    Ok(ExitCode::SUCCESS)
}

fn run_household(arguments: &RunArguments) -> anyhow::Result<ExitCode> {
    let scene = told_scene(&arguments.scene.settings())?;
    let settings = arguments.settings()?;
    let started = Instant::now();
    let progress = Progress::new("simulating");
    let mut household = household(&scene, &settings).with_pose_source(arguments.pose_source());
    if arguments.keep.is_some() {
        household = household.with_trace();
    }
    if arguments.board_gyro {
        household = household.with_board_gyro(scene.board_gyro(settings.seed));
    }
    if arguments.beacons > 0 {
        let beacons = scene.beacons(settings.seed, arguments.beacons.into());
        household = household.with_beacons(if arguments.by_strength {
            beacons.by_strength()
        } else {
            beacons
        });
    }
    if arguments.known_map {
        household = household.with_known_map();
    }
    if let Some(source) = &arguments.map_of {
        household = household.with_map_of(&scene.other_home(source)?);
    }
    if let Some(path) = &arguments.map {
        household = household.with_map(read_map(path)?);
    }
    if let Some(host) = household.host_mut().filter(|_| arguments.host_cost) {
        host.measure_cost();
    }
    if let Some(host) = household.host_mut().filter(|_| arguments.explain) {
        host.keep_log();
    }
    let report = run_until(&mut household, (&settings, arguments.end()), |share| {
        progress.show(share);
    });
    progress.clear();
    let report = report?;
    let report = RunReport {
        wall_seconds: started.elapsed().as_secs_f64(),
        host_cost: household.host().and_then(Host::cost),
        ..report
    };
    explain(household.host().map_or(&[], Host::log), &mut io::stderr().lock())?;
    if let Some(folder) = &arguments.keep {
        let kept = KeptRun {
            origin: arguments.origin(),
            ..household.kept_run(arguments.title())?
        };
        kept.keep(folder)?;
    }
    if let Some(path) = &arguments.save_map {
        save_map(path, &household)?;
    }
    if arguments.json {
        print(&serde_json::to_string(&report)?)?;
    } else {
        print(&report.to_string())?;
    }
    for violation in household.robot().monitor().violations() {
        writeln!(io::stderr(), "violation: {violation}")?;
    }
    Ok(verdict(u64::from(report.monitor_violations)))
}

fn read_map(path: &Path) -> anyhow::Result<StoredMap> {
    let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    stored_map::decode(&bytes).with_context(|| format!("{} is no map that can be used", path.display()))
}

fn save_map(path: &Path, household: &Household) -> anyhow::Result<()> {
    let brain = household.host().and_then(Host::brain);
    let brain = brain.context("the host never knew its robot, so there is no map to save")?;
    fs::write(path, stored_map::encode(&brain.map().stored()))
        .with_context(|| format!("cannot write {}", path.display()))
}

fn write_homes(folder: &Path) -> anyhow::Result<ExitCode> {
    let model = RobotModel::by_name("sr8730")?;
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let progress = Progress::new("homes");
    let count = PUBLISHED.count() as f64;
    for number in PUBLISHED {
        let text = GeneratedHome::number(number).floorplan(&model)?;
        let path = folder.join(format!("generated-{number:02}.toml"));
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
        progress.show(f64::from(number) / count);
    }
    progress.clear();
    print(&format!("{count} homes in {}", folder.display()))?;
    Ok(ExitCode::SUCCESS)
}

fn write_page(arguments: &ReportArguments) -> anyhow::Result<ExitCode> {
    let folder = &arguments.folder;
    let days = KeptDays::all(folder)?;
    let mut runs = if days.is_empty() || arguments.with_bounce {
        KeptRun::all(folder)?
    } else {
        KeptRun::all_or_none(folder)?
    };
    if arguments.with_bounce {
        let progress = Progress::new("bounce");
        let added = add_missing(folder, &runs, |share| progress.show(share));
        progress.clear();
        added?;
        runs = KeptRun::all(folder)?;
    }
    if arguments.pictures {
        for picture in page::pictures(&runs) {
            let path = folder.join(picture.name);
            fs::write(&path, picture.svg).with_context(|| format!("cannot write {}", path.display()))?;
        }
    }
    let page = page::write(&runs, &days);
    let path = folder.join("index.html");
    fs::write(&path, page).with_context(|| format!("cannot write {}", path.display()))?;
    print(&path.display().to_string())?;
    Ok(ExitCode::SUCCESS)
}

fn run_trials(arguments: &FaultArguments) -> anyhow::Result<ExitCode> {
    let model = RobotModel::by_name(&arguments.robot)?;
    let firmware = Firmware::load(
        &model.name,
        arguments.firmware.as_deref(),
        &CalibrationChoice::Complete,
    )?;
    if !firmware.suits(&model.name) {
        bail!(SceneError::NoBoard(model.name));
    }
    let campaign = FaultCampaign::load(model, firmware)?.with_calibration(arguments.calibration());
    let seeds = arguments.seeds.clone();
    let count = seeds.end - seeds.start;
    let duration_ms = arguments.duration_ms();
    let started = Instant::now();
    let progress = Progress::new("trials");
    let outcomes = trials(&campaign, (seeds, duration_ms), &|done| {
        progress.show(done as f64 / count as f64);
    });
    progress.clear();
    let summary = Summary::of(&outcomes, duration_ms, started.elapsed().as_secs_f64());
    if arguments.json {
        print(&summary.to_json().to_string())?;
    } else {
        print(&summary.to_string())?;
    }
    for outcome in outcomes.iter().filter(|outcome| outcome.violation_count > 0) {
        let seed = outcome.seed;
        let minutes = arguments.minutes;
        let flag = if arguments.miscalibrated {
            " --miscalibrated"
        } else {
            ""
        };
        writeln!(
            io::stderr(),
            "seed {seed} violated {} rules; replay it with: rvac-sim faults --seeds {seed}..{} --minutes {minutes}{flag}",
            outcome.violation_count,
            seed + 1,
        )?;
    }
    Ok(verdict(summary.violations()))
}

/// The home in which the faults of the line are measured.
const LINE_HOME: &str = "generated:1";

fn run_line_trials(arguments: &FaultArguments) -> anyhow::Result<ExitCode> {
    let scene = Scene::load(&SceneSettings {
        home: LINE_HOME.into(),
        robot: arguments.robot.clone(),
        noise: "nominal".to_owned(),
        firmware: arguments.firmware.clone(),
        record: CalibrationChoice::Complete,
        gyro: GyroFitted::default(),
    })?;
    let progress = Progress::new("faults of the line");
    let seeds = arguments.seeds.clone();
    let count = seeds.end - seeds.start;
    let mut all = Vec::new();
    for seed in seeds {
        all.push(passages(&scene, seed, &LineFault::ALL));
        progress.show(all.len() as f64 / count as f64);
    }
    progress.clear();
    let table = LineFaultTable::of(&all);
    if arguments.json {
        print(&serde_json::to_string(&table)?)?;
    } else {
        print(&table.to_string())?;
    }
    Ok(verdict(table.violations()))
}

fn verdict(violations: u64) -> ExitCode {
    if violations == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn print(text: &str) -> anyhow::Result<()> {
    writeln!(io::stdout(), "{text}").context("cannot write to standard output")
}
