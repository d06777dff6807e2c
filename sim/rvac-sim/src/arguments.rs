//! The command line.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use anyhow::bail;
use brain::command::StrategyName;
use clap::{Args, Parser, Subcommand};
use rvac_api::CleaningPattern;
use rvac_sim::baseline::{Origin, title};
use rvac_sim::faults::Calibration;
use rvac_sim::run::{RunEnd, RunSettings};
use rvac_sim::serve::{RadioSettings, ServeSettings};
use rvac_sim::{CalibrationChoice, GyroFitted, PoseSource, SceneSettings};

/// A simulated robot in a simulated home.
#[derive(Debug, Parser)]
#[command(version)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: SimCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum SimCommand {
    /// Puts a robot behind a pseudoterminal, at the pace of the wall clock.
    Serve(ServeArguments),
    /// Runs robot and brain in memory at full speed and reports how well they clean.
    Run(RunArguments),
    /// Injects random faults and lets the safety monitor judge every millisecond.
    Faults(FaultArguments),
    /// Writes the published set of generated homes as home .toml files.
    Homes(FolderArguments),
    /// Makes one HTML page of the runs that `run --keep DIR` kept in a folder, and of the days that `bench life --keep DIR` kept
    /// there: DIR/index.html.
    Report(ReportArguments),
}

#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// Home: a ROS map .yaml, a Valetudo map .json, a home .toml, generated:N, or trap:KIND/SEED.
    #[arg(long)]
    home: PathBuf,
    /// Robot by name.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Noise class: ideal, good, nominal or bad; parts of it can differ, as in `nominal,gyro=0,wheel-scale=2`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// Firmware image for the robot's chip (ELF or HEX), which is emulated then; without it the built-in firmware runs.
    #[arg(long)]
    firmware: Option<PathBuf>,
    /// The robot's flash holds no calibration record: an owner has just flashed it. Needs --firmware.
    #[arg(long, requires = "firmware")]
    uncalibrated: bool,
    /// The robot's flash holds the values of this file of `rvac calibrate` and no others. Needs --firmware.
    #[arg(long, value_name = "FILE", requires = "firmware", conflicts_with = "uncalibrated", value_parser = measured)]
    measured: Option<CalibrationChoice>,
    /// The gyro module of the emulated board: `placeholder` of robots/samsung-sr8730/gyro.md, `none`, or a number that makes
    /// up port, rate and frames at random. Without it the placeholder; 1 with --uncalibrated.
    #[arg(long, value_name = "WHICH", requires = "firmware", value_parser = gyro)]
    gyro: Option<GyroFitted>,
}

fn gyro(text: &str) -> Result<GyroFitted, String> {
    match text {
        "none" => Ok(GyroFitted::Absent),
        "placeholder" => Ok(GyroFitted::Placeholder),
        number => number
            .parse()
            .map(GyroFitted::Unknown)
            .map_err(|_| "a gyro is `none`, `placeholder` or a whole number".to_owned()),
    }
}

/// The values of a file that `rvac calibrate` wrote.
fn measured(path: &str) -> Result<CalibrationChoice, String> {
    #[derive(serde::Deserialize)]
    struct MeasuredFile {
        values: BTreeMap<String, i32>,
    }
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let file: MeasuredFile = toml::from_str(&text).map_err(|error| error.to_string())?;
    Ok(CalibrationChoice::Measured(file.values.into_iter().collect()))
}

impl SceneArguments {
    pub(crate) fn settings(&self) -> SceneSettings {
        SceneSettings {
            home: self.home.clone(),
            robot: self.robot.clone(),
            noise: self.noise.clone(),
            firmware: self.firmware.clone(),
            record: match &self.measured {
                Some(measured) => measured.clone(),
                None if self.uncalibrated => CalibrationChoice::Absent,
                None => CalibrationChoice::Complete,
            },
            gyro: self.gyro.unwrap_or(if self.uncalibrated {
                GyroFitted::Unknown(1)
            } else {
                GyroFitted::Placeholder
            }),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct ServeArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many times as fast as the wall clock.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    speed: u32,
    /// Bits per second of the serial line.
    #[arg(long, default_value_t = 230_400, value_parser = clap::value_parser!(u32).range(1_200..=4_000_000))]
    baud: u32,
    /// Where to put the symbolic link to the terminal.
    #[arg(long)]
    link: PathBuf,
    /// Where to put the Unix socket.
    #[arg(long)]
    socket: PathBuf,
    /// Where to put the symbolic link to a second terminal, behind which a DWM1001 module on the Linux board hears --beacons.
    #[arg(long, value_name = "LINK", requires = "beacons")]
    radio: Option<PathBuf>,
    /// Radio beacons at the edges of the home, of which the daemon knows no place.
    #[arg(long, value_name = "COUNT", requires = "radio", value_parser = clap::value_parser!(u8).range(1..=4))]
    beacons: Option<u8>,
}

impl ServeArguments {
    pub(crate) fn settings(&self) -> ServeSettings {
        ServeSettings {
            seed: self.seed,
            speed: self.speed,
            baud: self.baud,
            link: self.link.clone(),
            socket: self.socket.clone(),
            radio: self
                .radio
                .clone()
                .zip(self.beacons)
                .map(|(link, beacons)| RadioSettings {
                    link,
                    beacons: usize::from(beacons),
                }),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Cleaning strategy by name.
    #[arg(long, default_value = "bounce")]
    strategy: String,
    /// In which way floor is swept: lines or contour. Needs the strategy systematic.
    #[arg(long, value_name = "PATTERN", value_parser = pattern)]
    pattern: Option<CleaningPattern>,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Simulated minutes; those on the charger in the middle of a job do not count.
    #[arg(long, default_value_t = 10.0, value_parser = minutes)]
    minutes: f64,
    /// End when the robot says that its job is over and has docked or given up; --minutes is the longest then.
    #[arg(long)]
    until_done: bool,
    /// Keep what happened in this folder, for `rvac-sim report`.
    #[arg(long, value_name = "DIR")]
    pub(crate) keep: Option<PathBuf>,
    /// Tell what the host took of this machine's processor, too; it differs from run to run.
    #[arg(long)]
    pub(crate) host_cost: bool,
    /// Tell on standard error what the robot decided and why, with the seconds since its start.
    #[arg(long)]
    pub(crate) explain: bool,
    /// Give the host a perfect map of the home at the start.
    #[arg(long)]
    pub(crate) known_map: bool,
    /// Give the host a perfect map of this home at the start: the same walls another day, before things were moved.
    #[arg(long, value_name = "HOME", conflicts_with_all = ["known_map", "map"])]
    pub(crate) map_of: Option<PathBuf>,
    /// Give the host this map at the start, which an earlier run in the same home saved, from the same starting place.
    #[arg(long, value_name = "FILE", conflicts_with = "known_map")]
    pub(crate) map: Option<PathBuf>,
    /// Save the map that the host has in the end, for --map.
    #[arg(long, value_name = "FILE")]
    pub(crate) save_map: Option<PathBuf>,
    /// A gyro on the Linux board, for a robot whose own board has none.
    #[arg(long)]
    pub(crate) board_gyro: bool,
    /// Radio beacons at the edges of the home, of which the host knows no place.
    #[arg(long, value_name = "COUNT", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=8))]
    pub(crate) beacons: u8,
    /// The radio knows only how strongly it receives --beacons, not how far they are.
    #[arg(long, requires = "beacons")]
    pub(crate) by_strength: bool,
    /// Tell the host its true pose: shows a planner without the errors of localization.
    #[arg(long)]
    perfect_pose: bool,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}

fn pattern(text: &str) -> Result<CleaningPattern, String> {
    CleaningPattern::from_name(text).ok_or_else(|| "a pattern is `lines` or `contour`".to_owned())
}

impl RunArguments {
    pub(crate) fn settings(&self) -> anyhow::Result<RunSettings> {
        let Some(strategy) = StrategyName::from_name(&self.strategy) else {
            let known: Vec<_> = StrategyName::ALL.iter().map(|strategy| strategy.name()).collect();
            bail!(
                "there is no strategy `{}`; known are {}",
                self.strategy,
                known.join(", ")
            );
        };
        if self.pattern.is_some() && strategy != StrategyName::Systematic {
            bail!(
                "--pattern is for the strategy systematic, and {} was asked for",
                strategy.name()
            );
        }
        Ok(RunSettings {
            strategy,
            pattern: self.pattern,
            seed: self.seed,
            duration_ms: (self.minutes * 60_000.0) as u64,
        })
    }

    /// What the run is called in a page of several.
    pub(crate) fn title(&self) -> String {
        let mut title = title(&self.strategy, &self.scene.noise, self.seed);
        if let Some(pattern) = self.pattern {
            title.push_str(", ");
            title.push_str(pattern.name());
        }
        if self.known_map {
            title.push_str(", known map");
        }
        if let Some(home) = &self.map_of {
            title.push_str(", map of ");
            title.push_str(&home.display().to_string());
        }
        if self.map.is_some() {
            title.push_str(", learnt map");
        }
        if self.board_gyro {
            title.push_str(", gyro on the Linux board");
        }
        if self.beacons > 0 {
            title.push_str(&format!(", {} beacons", self.beacons));
        }
        if self.by_strength {
            title.push_str(" by strength");
        }
        if self.perfect_pose {
            title.push_str(", perfect pose");
        }
        title
    }

    /// In what the run is made, if others can be made in the same without its firmware's image.
    pub(crate) fn origin(&self) -> Option<Origin> {
        self.scene.firmware.is_none().then(|| Origin {
            home: self.scene.home.clone(),
            robot: self.scene.robot.clone(),
            noise: self.scene.noise.clone(),
            seed: self.seed,
        })
    }

    pub(crate) const fn pose_source(&self) -> PoseSource {
        if self.perfect_pose {
            PoseSource::Truth
        } else {
            PoseSource::Own
        }
    }

    pub(crate) const fn end(&self) -> RunEnd {
        if self.until_done {
            RunEnd::JobOver
        } else {
            RunEnd::Time
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct FolderArguments {
    /// The folder.
    pub(crate) folder: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// The folder.
    pub(crate) folder: PathBuf,
    /// Run bounce first for each home, noise class and seed of which the folder holds no such run, and keep that there, too.
    #[arg(long)]
    pub(crate) with_bounce: bool,
    /// Write the pictures of the first home into files in the folder, too.
    #[arg(long)]
    pub(crate) pictures: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FaultArguments {
    /// Seeds: `A..B` without B, or one number.
    #[arg(long, default_value = "0..1000", default_value_if("line", "true", "1..4"), value_parser = seeds)]
    pub(crate) seeds: Range<u64>,
    /// Simulated minutes of each seed.
    #[arg(long, default_value_t = 10.0, value_parser = minutes)]
    pub(crate) minutes: f64,
    /// Robot by name.
    #[arg(long, default_value = "sr8730")]
    pub(crate) robot: String,
    /// Firmware image for the robot's chip (ELF or HEX), which is emulated then; without it the built-in firmware runs.
    #[arg(long)]
    pub(crate) firmware: Option<PathBuf>,
    /// Instead of random faults, those of the line one by one: how far the robot cleans through each in a minute, what it
    /// says, and how soon it goes on. With 3 seeds unless --seeds names others.
    #[arg(long, conflicts_with = "minutes")]
    pub(crate) line: bool,
    /// Each seed has a robot of its own: other wheels, motors, pack and sensors than firmware and host believe.
    #[arg(long)]
    pub(crate) miscalibrated: bool,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}

impl FaultArguments {
    pub(crate) const fn calibration(&self) -> Calibration {
        if self.miscalibrated {
            Calibration::Wrong
        } else {
            Calibration::True
        }
    }

    pub(crate) fn duration_ms(&self) -> u64 {
        (self.minutes * 60_000.0) as u64
    }
}

/// A day is more than any battery lasts.
const MINUTES_MAX: f64 = 1_440.0;

fn minutes(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(minutes) if minutes > 0.0 && minutes <= MINUTES_MAX => Ok(minutes),
        _ => Err(format!(
            "give a number of minutes above 0 and up to {MINUTES_MAX}"
        )),
    }
}

fn seeds(text: &str) -> Result<Range<u64>, String> {
    let wanted = "give seeds as A..B, for example 0..1000, or one number";
    let number = |text: &str| text.parse::<u64>().map_err(|_| wanted.to_owned());
    let range = match text.split_once("..") {
        Some((first, end)) => number(first)?..number(end)?,
        None => {
            let only = number(text)?;
            only..only.checked_add(1).ok_or(wanted)?
        }
    };
    if range.is_empty() {
        return Err(format!("{text} holds no seed; {wanted}"));
    }
    Ok(range)
}

#[cfg(test)]
mod tests {
    use super::{minutes, seeds};

    #[test]
    fn ranges_of_seeds() {
        assert_eq!(seeds("3..9"), Ok(3..9));
        assert_eq!(seeds("7"), Ok(7..8));
        for wrong in ["", "9..3", "3..3", "a..b", "1..", "-1..4", "18446744073709551615"] {
            assert!(seeds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn minutes_are_positive_and_finite() {
        assert_eq!(minutes("0.5"), Ok(0.5));
        for wrong in ["0", "-1", "nan", "inf", "1e9", "x"] {
            assert!(minutes(wrong).is_err(), "{wrong}");
        }
    }
}
