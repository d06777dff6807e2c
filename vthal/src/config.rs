//! The configuration: a TOML file, and flags that override it.

mod link_section;

use std::path::{Path, PathBuf};

use brain::StrategyName;
use robot_link::LinkAddress;
use serde::Deserialize;
use toml::Spanned;

use link_section::LinkSection;

use crate::board::{BUTTONS_MAX, BoardSettings, LightLines, PressedLevel};
use crate::imu::{Axis, ImuSettings, Roots};
use crate::radio::{BEACONS_MAX, BeaconName, RadioForm, RadioSettings};

/// A valid configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Link to the robot.
    pub link: LinkAddress,
    /// Path of the Unix socket.
    pub socket: PathBuf,
    /// Clients at the same time.
    pub clients_max: usize,
    /// Whether clients may send raw packets.
    pub expert: bool,
    /// Folder for checkpoints, logs and recordings.
    pub state: PathBuf,
    /// Description of the robot, for the places of its sensors.
    pub description: Option<PathBuf>,
    /// Strategy when a request names none; `None` = what suits the robot.
    pub strategy: Option<StrategyName>,
    /// Longest job in minutes.
    pub task_budget_min: u32,
    /// Seed of the brain; from the clock when absent.
    pub seed: Option<u64>,
    /// Gyro on the Linux board, if there is one.
    pub imu: Option<ImuSettings>,
    /// Buttons and lights on the Linux board, if there are any.
    pub board: Option<BoardSettings>,
    /// Radio on the Linux board that measures distances to beacons, if there is one.
    pub radio: Option<RadioSettings>,
    /// Log.
    pub log: LogConfig,
    /// Recordings.
    pub recording: RecordingConfig,
}

/// Settings of the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogConfig {
    /// Least grave level that is written.
    pub level: tracing::level_filters::LevelFilter,
    /// Size in MiB at which a new file is begun.
    pub size_mib: u32,
    /// Files kept.
    pub files: u32,
}

/// Settings of recordings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordingConfig {
    /// Whether runs are recorded.
    pub enabled: bool,
    /// Files kept.
    pub files: u32,
    /// MiB kept.
    pub total_mib: u32,
}

/// What is wrong with a configuration: file, line, key, what, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("cannot read the configuration {}: {error}; check the path, or leave --config out", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// The file is not what it should be.
    #[error("{}:{line}: {key}: {what}", .path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Key with its table, for example `link.baud`.
        key: String,
        /// What is wrong and what to write instead.
        what: String,
    },
    /// A rate was given for a link that has none.
    #[error("--baud is for a serial device with a rate, and the link is another: leave it out")]
    NoRate,
    /// Something that has no default was given nowhere.
    #[error("no {what} is configured: give {flag}, or set {key} in the configuration")]
    Missing {
        /// What.
        what: &'static str,
        /// Flag that sets it.
        flag: &'static str,
        /// Key that sets it.
        key: &'static str,
    },
}

/// Values of flags, which override the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// `--link`
    pub link: Option<LinkAddress>,
    /// `--serial`
    pub serial: Option<PathBuf>,
    /// `--baud`
    pub baud: Option<u32>,
    /// `--socket`
    pub socket: Option<PathBuf>,
    /// `--state`
    pub state: Option<PathBuf>,
    /// `--seed`
    pub seed: Option<u64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ConfigFile {
    link: Option<Spanned<LinkSection>>,
    socket: Socket,
    robot: Robot,
    imu: Imu,
    board: Board,
    radio: Radio,
    state: StateSection,
    log: LogSection,
    recording: Recording,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Socket {
    path: Option<PathBuf>,
    clients_max: Option<Spanned<u32>>,
    expert: Option<bool>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Robot {
    description: Option<PathBuf>,
    strategy: Option<Spanned<String>>,
    task_budget_min: Option<Spanned<u32>>,
    seed: Option<u64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Imu {
    device: Option<Spanned<String>>,
    up: Option<Spanned<String>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Board {
    chip: Option<PathBuf>,
    buttons: Option<Spanned<Vec<u32>>>,
    pressed: Option<Spanned<String>>,
    ready: Option<Spanned<u32>>,
    working: Option<Spanned<u32>>,
    attention: Option<Spanned<u32>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Radio {
    device: Option<PathBuf>,
    form: Option<Spanned<String>>,
    baud: Option<Spanned<u32>>,
    beacons: Option<Spanned<Vec<BeaconName>>>,
    sigma_m: Option<Spanned<f64>>,
    height_m: Option<Spanned<f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct StateSection {
    dir: Option<PathBuf>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct LogSection {
    level: Option<Spanned<String>>,
    size_mib: Option<Spanned<u32>>,
    files: Option<Spanned<u32>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Recording {
    enabled: Option<bool>,
    files: Option<Spanned<u32>>,
    total_mib: Option<Spanned<u32>>,
}

/// Reads the configuration: `path` if given, then `overrides`, then defaults.
///
/// # Errors
/// See [`ConfigError`]. Nothing is written or opened besides the file.
pub fn load(path: Option<&Path>, overrides: Overrides) -> Result<Config, ConfigError> {
    let Some(path) = path else {
        return validate(
            ConfigFile::default(),
            overrides,
            &ConfigText {
                path: Path::new(""),
                text: "",
            },
        );
    };
    let text = kept_file::read_text(path).map_err(|error| ConfigError::Unreadable {
        path: path.to_owned(),
        error,
    })?;
    let source = ConfigText { path, text: &text };
    let file = toml::from_str(&text).map_err(|error: toml::de::Error| {
        let offset = error.span().map_or(0, |span| span.start);
        source.invalid(
            offset,
            format!("{}; vthal/example.toml shows every key", error.message()),
        )
    })?;
    validate(file, overrides, &source)
}

/// The file, to say where in it something is wrong.
struct ConfigText<'a> {
    path: &'a Path,
    text: &'a str,
}

impl ConfigText<'_> {
    fn invalid(&self, offset: usize, what: String) -> ConfigError {
        let before = self.text.get(..offset).unwrap_or(self.text);
        let line = before.matches('\n').count() + 1;
        ConfigError::Invalid {
            path: self.path.to_owned(),
            line,
            key: self.key_at(line),
            what,
        }
    }

    /// Table and key of a line, as a person would name them.
    fn key_at(&self, line: usize) -> String {
        let up_to: Vec<&str> = self.text.lines().take(line).collect();
        let table = up_to
            .iter()
            .rev()
            .find_map(|line| line.trim().strip_prefix('[')?.strip_suffix(']'));
        let key = up_to
            .last()
            .and_then(|line| line.split_once('='))
            .map(|(key, _)| key.trim());
        match (table, key) {
            (Some(table), Some(key)) => format!("{table}.{key}"),
            (Some(table), None) => table.to_owned(),
            (None, key) => key.unwrap_or("syntax").to_owned(),
        }
    }

    fn in_range<T: PartialOrd + std::fmt::Debug>(
        &self,
        value: Option<Spanned<T>>,
        default: T,
        range: std::ops::RangeInclusive<T>,
    ) -> Result<T, ConfigError> {
        let Some(value) = value else { return Ok(default) };
        if range.contains(value.get_ref()) {
            return Ok(value.into_inner());
        }
        let what = format!(
            "{:?} is out of range: write {:?} to {:?}",
            value.get_ref(),
            range.start(),
            range.end()
        );
        Err(self.invalid(value.span().start, what))
    }
}

fn validate(file: ConfigFile, flags: Overrides, source: &ConfigText<'_>) -> Result<Config, ConfigError> {
    let missing = |what, flag, key| ConfigError::Missing { what, flag, key };
    let socket = flags.socket.or(file.socket.path);
    let state = flags.state.or(file.state.dir);
    Ok(Config {
        link: link_section::link(file.link, (flags.link, flags.serial, flags.baud), source)?,
        socket: socket.ok_or(missing("socket path", "--socket PATH", "socket.path"))?,
        clients_max: source.in_range(file.socket.clients_max, 128, 1..=1024)? as usize,
        expert: file.socket.expert.unwrap_or(false),
        state: state.ok_or(missing("state folder", "--state DIR", "state.dir"))?,
        strategy: match &file.robot.strategy {
            Some(name) => Some(strategy(name, source)?),
            None => None,
        },
        description: file.robot.description,
        task_budget_min: source.in_range(file.robot.task_budget_min, 120, 1..=1_440)?,
        seed: flags.seed.or(file.robot.seed),
        imu: imu(file.imu, source)?,
        board: board(file.board, source)?,
        radio: radio(file.radio, source)?,
        log: LogConfig {
            level: level(file.log.level, source)?,
            size_mib: source.in_range(file.log.size_mib, 4, 1..=1_024)?,
            files: source.in_range(file.log.files, 5, 1..=100)?,
        },
        recording: RecordingConfig {
            enabled: file.recording.enabled.unwrap_or(true),
            files: source.in_range(file.recording.files, 50, 1..=100_000)?,
            total_mib: source.in_range(file.recording.total_mib, 512, 1..=1_000_000)?,
        },
    })
}

fn imu(imu: Imu, source: &ConfigText<'_>) -> Result<Option<ImuSettings>, ConfigError> {
    let axis = match imu.up {
        None => Axis::from_name("z"),
        Some(name) => Some(Axis::from_name(name.get_ref()).ok_or_else(|| {
            let what = format!(
                "{:?} is no axis: write x, y or z, with a minus sign if it points down",
                name.get_ref()
            );
            source.invalid(name.span().start, what)
        })?),
    };
    Ok(imu.device.zip(axis).map(|(device, axis)| ImuSettings {
        device: device.into_inner(),
        axis,
        roots: Roots::default(),
    }))
}

fn board(board: Board, source: &ConfigText<'_>) -> Result<Option<BoardSettings>, ConfigError> {
    let pressed = match &board.pressed {
        None => PressedLevel::Low,
        Some(level) => match level.get_ref().as_str() {
            "low" => PressedLevel::Low,
            "high" => PressedLevel::High,
            other => {
                let what = format!("{other:?} is no level: write low or high");
                return Err(source.invalid(level.span().start, what));
            }
        },
    };
    // Each line with the place where it is named, to say which one is named twice.
    let mut lines: Vec<(u32, usize)> = Vec::new();
    if let Some(buttons) = &board.buttons {
        if buttons.get_ref().len() > BUTTONS_MAX {
            let what = format!("these are too many: write at most {BUTTONS_MAX}");
            return Err(source.invalid(buttons.span().start, what));
        }
        lines.extend(buttons.get_ref().iter().map(|line| (*line, buttons.span().start)));
    }
    let lights = [&board.ready, &board.working, &board.attention];
    lines.extend(
        lights
            .into_iter()
            .flatten()
            .map(|line| (*line.get_ref(), line.span().start)),
    );
    for (index, (line, offset)) in lines.iter().enumerate() {
        if lines.iter().take(index).any(|(other, _)| other == line) {
            let what = format!("line {line} is used twice: give each button and light a line of its own");
            return Err(source.invalid(*offset, what));
        }
    }
    Ok(board.chip.map(|chip| BoardSettings {
        chip,
        buttons: board.buttons.map(Spanned::into_inner).unwrap_or_default(),
        pressed,
        lights: LightLines {
            ready: board.ready.map(Spanned::into_inner),
            working: board.working.map(Spanned::into_inner),
            attention: board.attention.map(Spanned::into_inner),
        },
    }))
}

fn radio(radio: Radio, source: &ConfigText<'_>) -> Result<Option<RadioSettings>, ConfigError> {
    let usual = RadioSettings::new(radio.device.clone().unwrap_or_default());
    let form = match &radio.form {
        None => usual.form,
        Some(name) => RadioForm::from_name(name.get_ref()).ok_or_else(|| {
            let what = format!("{:?} is no form: write lines or dwm1001", name.get_ref());
            source.invalid(name.span().start, what)
        })?,
    };
    let beacons = match radio.beacons {
        Some(beacons) if beacons.get_ref().len() > BEACONS_MAX => {
            let what = format!("these are too many: write at most {BEACONS_MAX}");
            return Err(source.invalid(beacons.span().start, what));
        }
        beacons => beacons.map(Spanned::into_inner).unwrap_or_default(),
    };
    let settings = RadioSettings {
        form,
        beacons,
        baud: source.in_range(radio.baud, usual.baud, 1_200..=4_000_000)?,
        sigma_m: source.in_range(radio.sigma_m, usual.sigma_m, 0.01..=10.0)?,
        height_m: source.in_range(radio.height_m, usual.height_m, 0.0..=10.0)?,
        ..usual
    };
    Ok(radio.device.map(|_| settings))
}

fn strategy(name: &Spanned<String>, source: &ConfigText<'_>) -> Result<StrategyName, ConfigError> {
    StrategyName::from_name(name.get_ref()).ok_or_else(|| {
        let known: Vec<&str> = StrategyName::ALL.iter().map(|strategy| strategy.name()).collect();
        let what = format!(
            "no strategy has the name {:?}: write one of {}",
            name.get_ref(),
            known.join(", ")
        );
        source.invalid(name.span().start, what)
    })
}

fn level(
    name: Option<Spanned<String>>,
    source: &ConfigText<'_>,
) -> Result<tracing::level_filters::LevelFilter, ConfigError> {
    use tracing::level_filters::LevelFilter;
    let Some(name) = name else {
        return Ok(LevelFilter::INFO);
    };
    match name.get_ref().as_str() {
        "error" => Ok(LevelFilter::ERROR),
        "warn" => Ok(LevelFilter::WARN),
        "info" => Ok(LevelFilter::INFO),
        "debug" => Ok(LevelFilter::DEBUG),
        other => {
            let what = format!("no level has the name {other:?}: write error, warn, info or debug");
            Err(source.invalid(name.span().start, what))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use brain::StrategyName;

    use super::{ConfigError, ConfigText, Overrides, load, validate};

    fn parse(text: &str) -> Result<super::Config, ConfigError> {
        let source = ConfigText {
            path: Path::new("vthal.toml"),
            text,
        };
        let file = toml::from_str(text).map_err(|error: toml::de::Error| {
            source.invalid(
                error.span().map_or(0, |span| span.start),
                error.message().to_owned(),
            )
        })?;
        let flags = Overrides {
            serial: Some(PathBuf::from("/dev/null")),
            socket: Some(PathBuf::from("s")),
            state: Some(PathBuf::from("d")),
            ..Overrides::default()
        };
        validate(file, flags, &source)
    }

    #[test]
    fn the_example_is_the_default_and_shows_every_key() {
        let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("example.toml");
        let text = std::fs::read_to_string(&example).expect("readable");
        let written_out: String = text
            .lines()
            .map(|line| line.strip_prefix("#! ").unwrap_or(line))
            .fold(String::new(), |all, line| all + line + "\n");
        let config = parse(&written_out).expect("valid");
        let mut defaults = parse("").expect("valid");
        defaults.link = "uart:/dev/null?baud=230400".parse().expect("a link");
        defaults.seed = Some(1);
        defaults.description = Some("/usr/share/librervac/robots/samsung-sr8730/robot.toml".into());
        assert_eq!(defaults.strategy, None, "what suits the robot");
        defaults.strategy = Some(StrategyName::Systematic);
        defaults.imu = parse("[imu]\ndevice = \"mpu6050\"").expect("valid").imu;
        let board = "[board]\nchip = \"/dev/gpiochip0\"\nbuttons = [4, 17, 27]\nready = 5\nworking = 22\nattention = 23";
        defaults.board = parse(board).expect("valid").board;
        assert!(defaults.board.is_some());
        defaults.radio = parse("[radio]\ndevice = \"/dev/ttyACM0\"").expect("valid").radio;
        assert_eq!(config, defaults);
        load(Some(&example), Overrides::default()).expect("valid as it stands");
        let fields = [
            "serial",
            "baud",
            "path",
            "clients_max",
            "expert",
            "dir",
            "description",
            "strategy",
            "task_budget_min",
            "seed",
            "device",
            "up",
            "chip",
            "buttons",
            "pressed",
            "ready",
            "working",
            "attention",
            "form",
            "beacons",
            "sigma_m",
            "height_m",
            "level",
            "size_mib",
            "files",
            "enabled",
            "total_mib",
        ];
        for field in fields {
            assert!(
                written_out.contains(&format!("\n{field} = ")),
                "{field} is not in the example"
            );
        }
    }

    #[test]
    fn errors_name_file_line_key_and_remedy() {
        for (text, message) in [
            (
                "[link]\nbaud = 7\n",
                "vthal.toml:2: link.baud: 7 is out of range: write 1200 to 4000000",
            ),
            (
                "\n[log]\n\nlevel = \"loud\"",
                "vthal.toml:4: log.level: no level has the name \"loud\": write error, warn, info or debug",
            ),
            (
                "[imu]\nup = \"w\"",
                "vthal.toml:2: imu.up: \"w\" is no axis: write x, y or z, with a minus sign if it points down",
            ),
            (
                "[board]\npressed = \"down\"",
                "vthal.toml:2: board.pressed: \"down\" is no level: write low or high",
            ),
            (
                "[board]\nbuttons = [4, 17]\nready = 17",
                "vthal.toml:3: board.ready: line 17 is used twice: give each button and light a line of its own",
            ),
            (
                "[board]\nbuttons = [1, 2, 3, 4, 5, 6, 7, 8, 9]",
                "vthal.toml:2: board.buttons: these are too many: write at most 8",
            ),
            (
                "[radio]\nform = \"ble\"",
                "vthal.toml:2: radio.form: \"ble\" is no form: write lines or dwm1001",
            ),
            (
                "[radio]\nsigma_m = 0.0",
                "vthal.toml:2: radio.sigma_m: 0.0 is out of range: write 0.01 to 10.0",
            ),
            (
                "[robot]\nstrategy = \"b\"",
                "vthal.toml:2: robot.strategy: no strategy has the name \"b\": write one of bounce, statistical, systematic, wall-bounce",
            ),
        ] {
            assert_eq!(parse(text).expect_err("invalid").to_string(), message);
        }
        for (text, place) in [
            (
                "[link]\nbuad = 9600",
                "vthal.toml:2: link.buad: unknown field `buad`",
            ),
            (
                "[socket]\nexpert = 1",
                "vthal.toml:2: socket.expert: invalid type",
            ),
            ("[link", "vthal.toml:1: syntax: "),
            ("link = 7", "vthal.toml:1: link: invalid type"),
            (
                "\nlink = \"usb:/dev/ttyACM0\"",
                "vthal.toml:2: link: \"/dev/ttyACM0\" may be another device after the next start",
            ),
            (
                "[radio]\nbeacons = [\"hall\", \"the kitchen\"]",
                "vthal.toml:2: radio.beacons: a beacon's name has 1 to 32 printable letters",
            ),
            (
                "[radio]\nheight_m = nan",
                "vthal.toml:2: radio.height_m: NaN is out of range",
            ),
        ] {
            let message = parse(text).expect_err("invalid").to_string();
            assert!(message.starts_with(place), "{message}");
        }
    }

    #[test]
    fn one_line_names_a_link_and_flags_stand_above_it() {
        let line = "link = \"tcp:robot.local:4000\"";
        let source = ConfigText {
            path: Path::new("vthal.toml"),
            text: line,
        };
        let file = || toml::from_str(line).expect("TOML");
        let flags = |baud, serial: Option<&str>| Overrides {
            baud,
            serial: serial.map(PathBuf::from),
            socket: Some(PathBuf::from("s")),
            state: Some(PathBuf::from("d")),
            ..Overrides::default()
        };
        let config = validate(file(), flags(None, None), &source).expect("valid");
        assert_eq!(config.link, "tcp:robot.local:4000".parse().expect("a link"));
        let config = validate(file(), flags(Some(9_600), Some("/dev/a")), &source).expect("valid");
        assert_eq!(config.link, "uart:/dev/a?baud=9600".parse().expect("a link"));
        let error = validate(file(), flags(Some(9_600), None), &source).expect_err("no rate");
        assert!(matches!(error, ConfigError::NoRate));
    }

    #[test]
    fn what_has_no_default_is_asked_for() {
        let message = load(None, Overrides::default())
            .expect_err("nothing given")
            .to_string();
        assert_eq!(
            message,
            "no link to the robot is configured: give --link LINK or --serial PATH, or set link in the configuration"
        );
        let message =
            load(Some(Path::new("/does/not/exist.toml")), Overrides::default()).expect_err("absent");
        assert!(
            message
                .to_string()
                .starts_with("cannot read the configuration /does/not/exist.toml: ")
        );
    }
}
