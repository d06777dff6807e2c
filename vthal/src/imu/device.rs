//! A gyro of the kernel's Industrial I/O: found, set up and read through its files.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::scan::{Layout, ScanType};
use super::{Axis, ImuSettings};

/// Samples that the kernel keeps while the thread is late.
const BUFFER_LENGTH: u32 = 128;
/// Longest wait for a sample before the sensor counts as dead.
const SILENCE: Duration = Duration::from_secs(1);
/// A sensor without trigger is asked this often.
const ASK_EVERY: Duration = Duration::from_millis(10);

/// Why there is no gyro.
#[derive(Debug, thiserror::Error)]
pub(super) enum ImuError {
    /// Nothing has this name.
    #[error(
        "no sensor of the kernel has the name {name:?} ({known}); check imu.device and that its driver is loaded"
    )]
    Unknown {
        /// As configured.
        name: String,
        /// What there is.
        known: String,
    },
    /// The sensor has no gyro on this axis.
    #[error("the sensor at {} has no gyro on this axis: it lacks {file}", .sensor.display())]
    NoGyro {
        /// Folder of the sensor.
        sensor: PathBuf,
        /// The missing file.
        file: String,
    },
    /// A file says something that cannot be understood.
    #[error("{} says {text:?}, which is not understood", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Its text.
        text: String,
    },
    /// The system refuses.
    #[error("{}: {error}", .path.display())]
    Refused {
        /// What was touched.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// No sample for a second.
    #[error("the sensor gives no samples")]
    Silent,
}

/// An open gyro.
#[derive(Debug)]
pub(super) struct Gyro {
    source: Source,
    /// rad/s per raw count, with the sign of the mounting.
    scale: f64,
    offset: f64,
}

#[derive(Debug)]
enum Source {
    /// The kernel collects samples at the sensor's own rate and times them.
    Buffer { device: File, layout: Layout },
    /// The sensor has no trigger, for example because its interrupt is not wired: it is asked for each sample.
    Asked { raw: File },
}

/// A sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Rate about the robot's vertical axis, counter-clockwise positive.
    pub rate_rad_per_s: f64,
    /// The kernel's time of it in nanoseconds; `None` = now.
    pub time_ns: Option<i64>,
}

impl Gyro {
    /// Finds the sensor and sets it up: by its buffer if it has a trigger, else by asking.
    pub(super) fn open(settings: &ImuSettings) -> Result<Self, ImuError> {
        let sensor = find(settings)?;
        let axis = settings.axis.letter();
        let scale: f64 = shared_figure(&sensor, axis, "scale")?.unwrap_or(1.0);
        let offset: f64 = shared_figure(&sensor, axis, "offset")?.unwrap_or(0.0);
        let source = match open_buffer(settings, &sensor)? {
            Some(source) => source,
            None => open_asked(&sensor, settings.axis)?,
        };
        Ok(Self {
            source,
            scale: scale * settings.axis.sign(),
            offset,
        })
    }

    /// How samples are come by, for the log.
    pub(super) const fn manner(&self) -> &'static str {
        match self.source {
            Source::Buffer { .. } => "by its buffer",
            Source::Asked { .. } => "asked 100 times a second, since it has no trigger",
        }
    }

    /// Waits for the next samples and hands each to `take`.
    pub(super) fn read(&mut self, mut take: impl FnMut(Sample)) -> Result<(), ImuError> {
        let (scale, offset) = (self.scale, self.offset);
        let sample = |raw: i64, time_ns| Sample {
            rate_rad_per_s: (raw as f64 + offset) * scale,
            time_ns,
        };
        match &mut self.source {
            Source::Buffer { device, layout } => {
                let mut bytes = [0; 4096];
                let whole = bytes.len() - bytes.len() % layout.record_bytes();
                let count = read_waiting(device, bytes.get_mut(..whole).unwrap_or_default())?;
                let records = bytes
                    .get(..count)
                    .unwrap_or_default()
                    .chunks_exact(layout.record_bytes());
                for (raw, time_ns) in records.filter_map(|record| layout.read(record)) {
                    take(sample(raw, time_ns));
                }
            }
            Source::Asked { raw } => {
                std::thread::sleep(ASK_EVERY);
                take(sample(ask(raw)?, None));
            }
        }
        Ok(())
    }
}

/// Reads at least one byte, and gives up after [`SILENCE`].
fn read_waiting(device: &mut File, bytes: &mut [u8]) -> Result<usize, ImuError> {
    let lost = |error| ImuError::Refused {
        path: PathBuf::from("the sensor"),
        error,
    };
    let patience = Timespec::try_from(SILENCE).map_err(|_| ImuError::Silent)?;
    let mut fds = [PollFd::new(device, PollFlags::IN)];
    let ready = poll(&mut fds, Some(&patience)).map_err(|error| lost(error.into()))?;
    if ready == 0 {
        return Err(ImuError::Silent);
    }
    match device.read(bytes) {
        Ok(0) => Err(lost(io::ErrorKind::UnexpectedEof.into())),
        Ok(count) => Ok(count),
        Err(error) => Err(lost(error)),
    }
}

/// Files of the kernel give the current value when they are read from the start.
fn ask(raw: &mut File) -> Result<i64, ImuError> {
    let path = || PathBuf::from("the sensor");
    let refused = |error| ImuError::Refused { path: path(), error };
    let mut text = String::new();
    raw.seek(SeekFrom::Start(0)).map_err(refused)?;
    raw.read_to_string(&mut text).map_err(refused)?;
    text.trim()
        .parse()
        .map_err(|_| ImuError::Unreadable { path: path(), text })
}

/// The folder of the sensor with the configured name, or with the configured number (`iio:device0`).
fn find(settings: &ImuSettings) -> Result<PathBuf, ImuError> {
    let folder = settings.roots.devices();
    let mut known = Vec::new();
    for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let number = entry.file_name().to_string_lossy().into_owned();
        let Ok(name) = fs::read_to_string(path.join("name")) else {
            continue;
        };
        let name = name.trim();
        if number.starts_with("iio:device") {
            if name == settings.device || number == settings.device {
                return Ok(path);
            }
            known.push(name.to_owned());
        }
    }
    known.sort();
    let known = if known.is_empty() {
        "there are none".to_owned()
    } else {
        format!("there are: {}", known.join(", "))
    };
    Err(ImuError::Unknown {
        name: settings.device.clone(),
        known,
    })
}

/// A figure of this axis, or the one that all axes share.
fn shared_figure(sensor: &Path, axis: char, what: &str) -> Result<Option<f64>, ImuError> {
    for file in [format!("in_anglvel_{axis}_{what}"), format!("in_anglvel_{what}")] {
        let path = sensor.join(file);
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        return match text.trim().parse() {
            Ok(figure) => Ok(Some(figure)),
            Err(_) => Err(ImuError::Unreadable { path, text }),
        };
    }
    Ok(None)
}

fn open_asked(sensor: &Path, axis: Axis) -> Result<Source, ImuError> {
    let file = format!("in_anglvel_{}_raw", axis.letter());
    let raw = File::open(sensor.join(&file)).map_err(|_| ImuError::NoGyro {
        sensor: sensor.to_owned(),
        file,
    })?;
    Ok(Source::Asked { raw })
}

/// Enables the buffer with this axis and the time; `None` when the sensor has no buffer or no trigger.
fn open_buffer(settings: &ImuSettings, sensor: &Path) -> Result<Option<Source>, ImuError> {
    let elements = sensor.join("scan_elements");
    let rate = format!("in_anglvel_{}", settings.axis.letter());
    if !elements.join(format!("{rate}_en")).exists() || !has_trigger(sensor) {
        return Ok(None);
    }
    write(&sensor.join("buffer/enable"), "0")?;
    for entry in fs::read_dir(&elements).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().ends_with("_en") {
            write(&entry.path(), "0")?;
        }
    }
    write(&elements.join(format!("{rate}_en")), "1")?;
    let kind = scan_type(&elements.join(format!("{rate}_type")))?;
    let time = elements.join("in_timestamp_en");
    let time = if time.exists() {
        // Real time jumps when the clock is set; not every kernel lets it be chosen.
        write(&sensor.join("current_timestamp_clock"), "monotonic").ok();
        write(&time, "1")?;
        Some(scan_type(&elements.join("in_timestamp_type"))?)
    } else {
        None
    };
    write(&sensor.join("buffer/length"), &BUFFER_LENGTH.to_string())?;
    let number = sensor.file_name().unwrap_or_default();
    let path = settings.roots.dev().join(number);
    let device = File::open(&path).map_err(|error| ImuError::Refused { path, error })?;
    write(&sensor.join("buffer/enable"), "1")?;
    Ok(Some(Source::Buffer {
        device,
        layout: Layout::new(kind, time),
    }))
}

/// Whether something starts each conversion: the driver's own trigger, or one that the owner has chosen. Sensors that fill
/// a hardware queue have no `trigger` folder and need none.
fn has_trigger(sensor: &Path) -> bool {
    match fs::read_to_string(sensor.join("trigger/current_trigger")) {
        Ok(name) => !name.trim().is_empty(),
        Err(_) => sensor.join("buffer/enable").exists(),
    }
}

fn scan_type(path: &Path) -> Result<ScanType, ImuError> {
    let text = fs::read_to_string(path).map_err(|error| ImuError::Refused {
        path: path.to_owned(),
        error,
    })?;
    ScanType::parse(&text).ok_or_else(|| ImuError::Unreadable {
        path: path.to_owned(),
        text,
    })
}

fn write(path: &Path, text: &str) -> Result<(), ImuError> {
    fs::write(path, text).map_err(|error| ImuError::Refused {
        path: path.to_owned(),
        error,
    })
}
