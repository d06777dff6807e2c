//! The gyro on the Linux board: whether the kernel has the one that is configured, and whether it answers.

use std::fs;
use std::io;

use rustix::io::Errno;

use super::{Board, Finding};

const CHECK: &str = "gyro";
/// Sensors of the kernel's Industrial I/O.
const DEVICES: &str = "sys/bus/iio/devices";

/// What is to be said of the gyro that the configuration names; nothing if it names none.
pub(super) fn gyro(board: &Board, configuration: &toml::Table) -> Option<Finding> {
    let imu = configuration.get("imu")?;
    let device = imu.get("device")?.as_str()?;
    let up = imu.get("up").and_then(toml::Value::as_str).unwrap_or("z");
    let Some(sensor) = sensor(board, device) else {
        return Some(Finding::fault(
            CHECK,
            format!("the kernel has no sensor {device} ({})", known(board)),
            "check its wires and that its driver is loaded, or correct imu.device in /etc/vthal.toml",
        ));
    };
    let axis = up.trim_start_matches('-');
    let file = format!("{DEVICES}/{sensor}/in_anglvel_{axis}_raw");
    Some(match fs::read_to_string(board.path(&file)) {
        Ok(text) if text.trim().parse::<i64>().is_ok() => Finding::good(CHECK, format!("{device} answers")),
        Ok(text) => silent(device, &format!("it says {:?}", text.trim())),
        // Whoever reads its samples from the buffer keeps all others from asking it.
        Err(error) if Errno::from_io_error(&error) == Some(Errno::BUSY) => {
            Finding::good(CHECK, format!("{device} is being read"))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Finding::fault(
            CHECK,
            format!("{device} has no gyro on the axis {axis}"),
            "correct imu.device or imu.up in /etc/vthal.toml",
        ),
        Err(error) => silent(device, &error.to_string()),
    })
}

fn silent(device: &str, why: &str) -> Finding {
    Finding::fault(
        CHECK,
        format!("{device} does not answer: {why}"),
        "check its wires and its supply, then start the board again",
    )
}

/// The folders of sensors; triggers have others.
fn folders(board: &Board) -> impl Iterator<Item = String> {
    let names = board.names(DEVICES).into_iter();
    names.filter(|name| name.starts_with("iio:device"))
}

/// The folder of the sensor with this name or number.
fn sensor(board: &Board, device: &str) -> Option<String> {
    folders(board).find(|folder| folder == device || name(board, folder).as_deref() == Some(device))
}

fn name(board: &Board, folder: &str) -> Option<String> {
    board.text(&format!("{DEVICES}/{folder}/name"))
}

fn known(board: &Board) -> String {
    let names: Vec<String> = folders(board).filter_map(|folder| name(board, &folder)).collect();
    if names.is_empty() {
        return "it has none".to_owned();
    }
    format!("it has {}", names.join(", "))
}
