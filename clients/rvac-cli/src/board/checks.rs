//! The checks: each looks at one thing that has kept somebody's robot from working.

use std::path::Path;

use robot_link::{AddressError, LinkAddress};

use super::gyro::gyro;
use super::serial_devices::kernel_name;
use super::{Board, Finding};

/// Where the daemon's configuration is.
const CONFIGURATION: &str = "etc/vthal.toml";
/// Where the daemon keeps maps and recordings.
const STATE: &str = "var/lib/vthal";
/// The daemon's user.
const USER: &str = "vthal";
/// Seconds since 1970 at which this software cannot have been installed yet: 2026-01-01.
const CLOCK_MIN_S: u64 = 1_767_225_600;
/// Recordings of a few runs.
const FREE_MIB_MIN: u64 = 200;
/// Degrees Celsius from which a Raspberry Pi slows down.
const HOT_C: f64 = 80.0;

/// All of them, in the order in which they matter. `now_s` is the clock's time, seconds since 1970.
pub(crate) fn all(board: &Board, now_s: u64) -> Vec<Finding> {
    let configured = configured_device(board);
    let mut findings = vec![model(board), configuration(board)];
    findings.extend(configured.as_deref().map(|path| serial(board, path)));
    if let Some(name) = configured.as_deref().and_then(|path| name_of(board, path)) {
        findings.push(console(board, &name));
        findings.push(bluetooth(board, &name));
    }
    let table = board.text(CONFIGURATION).and_then(|text| text.parse().ok());
    findings.extend(table.and_then(|table| gyro(board, &table)));
    findings.extend([
        groups(board),
        clock(now_s),
        zone(board),
        disk(board),
        supply(board),
        heat(board),
    ]);
    findings
}

/// The device of the link in the configuration, if the link has one; the pins of the board while there is no configuration.
fn configured_device(board: &Board) -> Option<String> {
    let Some(text) = board.text(CONFIGURATION) else {
        return board
            .path("dev/serial0")
            .symlink_metadata()
            .is_ok()
            .then(|| "/dev/serial0".to_owned());
    };
    let table: toml::Table = text.parse().ok()?;
    match table.get("link")? {
        toml::Value::String(line) => {
            let address: LinkAddress = line.parse().ok()?;
            Some(address.device()?.to_str()?.to_owned())
        }
        link => Some(link.get("serial")?.as_str()?.to_owned()),
    }
}

fn name_of(board: &Board, device: &str) -> Option<String> {
    let inside = Path::new(device).strip_prefix("/dev").ok()?;
    Some(kernel_name(board, inside.to_str()?))
}

fn model(board: &Board) -> Finding {
    let name = board
        .text("proc/device-tree/model")
        .or_else(|| board.text("sys/class/dmi/id/product_name"));
    Finding::good("board", name.unwrap_or_else(|| "of unknown model".to_owned()))
}

fn configuration(board: &Board) -> Finding {
    const CHECK: &str = "configuration";
    match board.text(CONFIGURATION) {
        None => Finding::fault(CHECK, "there is no /etc/vthal.toml", "run rvac setup"),
        Some(text) => match text.parse::<toml::Table>() {
            Ok(table) => match wrong_link(&table) {
                None => Finding::good(CHECK, "/etc/vthal.toml"),
                Some(error) => Finding::fault(
                    CHECK,
                    format!("/etc/vthal.toml, link: {error}"),
                    "correct that line, or run rvac setup --anew",
                ),
            },
            Err(error) => {
                let line = error.span().map_or(1, |span| {
                    1 + text[..span.start.min(text.len())].matches('\n').count()
                });
                Finding::fault(
                    CHECK,
                    format!("/etc/vthal.toml, line {line}: {}", error.message()),
                    "correct that line, or run rvac setup --anew",
                )
            }
        },
    }
}

/// Why the line of the link names none, if it does not.
fn wrong_link(table: &toml::Table) -> Option<AddressError> {
    table.get("link")?.as_str()?.parse::<LinkAddress>().err()
}

fn serial(board: &Board, device: &str) -> Finding {
    const CHECK: &str = "serial";
    if std::fs::metadata(board.path(device)).is_err() {
        return Finding::fault(
            CHECK,
            format!("{device} is not there"),
            "plug the adapter in, or switch the serial port on (on a Raspberry Pi enable_uart=1 in config.txt), and start again",
        );
    }
    match name_of(board, device).filter(|name| !device.ends_with(name.as_str())) {
        Some(name) => Finding::good(CHECK, format!("{device}, which is {name}")),
        None => Finding::good(CHECK, device),
    }
}

/// A login console on the robot's line answers every packet with text, and locks the device.
fn console(board: &Board, name: &str) -> Finding {
    const CHECK: &str = "console";
    let of_kernel = board.text("proc/cmdline").is_some_and(|line| {
        line.split_whitespace()
            .filter_map(|word| word.strip_prefix("console="))
            .map(|console| console.split(',').next().unwrap_or_default())
            .any(|console| kernel_name(board, console) == name)
    });
    if of_kernel {
        return Finding::fault(
            CHECK,
            format!("the kernel writes its messages to {name}, where the robot is"),
            "take console=... of that device out of cmdline.txt (raspi-config: no login shell over serial), and start again",
        );
    }
    let login = format!("serial-getty@{name}.service");
    let wanted = board
        .names("etc/systemd/system/getty.target.wants")
        .iter()
        .any(|unit| kernel_name_of_getty(board, unit) == Some(name.to_owned()));
    if wanted || has_login(board, name) {
        return Finding::fault(
            CHECK,
            format!("a login console sits on {name}, where the robot is"),
            format!("systemctl disable --now {login}; systemctl mask {login}"),
        );
    }
    Finding::good(CHECK, format!("none on {name}"))
}

fn kernel_name_of_getty(board: &Board, unit: &str) -> Option<String> {
    let name = unit.strip_prefix("serial-getty@")?.strip_suffix(".service")?;
    Some(kernel_name(board, name))
}

/// Whether a getty was started on the device.
fn has_login(board: &Board, name: &str) -> bool {
    board
        .names("proc")
        .iter()
        .filter(|process| process.starts_with(|letter: char| letter.is_ascii_digit()))
        .filter_map(|process| board.text(&format!("proc/{process}/cmdline")))
        .any(|line| {
            let mut words = line.split('\0');
            words.next().is_some_and(|program| program.ends_with("getty")) && words.any(|word| word == name)
        })
}

/// On a Raspberry Pi with Bluetooth the good serial port belongs to the radio, and the pins get one whose rate follows the processor's clock.
fn bluetooth(board: &Board, name: &str) -> Finding {
    const CHECK: &str = "bluetooth";
    let is_raspberry = board
        .text("proc/device-tree/model")
        .is_some_and(|model| model.starts_with("Raspberry Pi"));
    if is_raspberry && name == "ttyS0" {
        return Finding::warning(
            CHECK,
            "has the better serial port, and the robot's is one whose rate follows the processor's clock",
            "write dtoverlay=disable-bt into config.txt, systemctl disable hciuart, and start again",
        );
    }
    Finding::good(CHECK, "does not use the robot's serial port")
}

fn groups(board: &Board) -> Finding {
    const CHECK: &str = "groups";
    let users = board.text("etc/passwd").unwrap_or_default();
    if !users.lines().any(|line| line.starts_with("vthal:")) {
        return Finding::warning(
            CHECK,
            "there is no user vthal",
            "install the package, or start vthal as a user of the group dialout",
        );
    }
    let groups = board.text("etc/group").unwrap_or_default();
    let is_in_dialout = groups
        .lines()
        .filter(|line| line.starts_with("dialout:"))
        .filter_map(|line| line.rsplit(':').next())
        .any(|members| members.split(',').any(|member| member == USER));
    if is_in_dialout {
        Finding::good(CHECK, "vthal may use serial devices")
    } else {
        Finding::fault(
            CHECK,
            "vthal may not use serial devices",
            "usermod --append --groups dialout vthal, and restart vthal",
        )
    }
}

fn clock(now_s: u64) -> Finding {
    const CHECK: &str = "clock";
    if now_s < CLOCK_MIN_S {
        Finding::warning(
            CHECK,
            "the clock is not set, so schedules start nothing",
            "connect the board to the network once, or set it: date --set",
        )
    } else {
        Finding::good(CHECK, "is set")
    }
}

fn zone(board: &Board) -> Finding {
    const CHECK: &str = "zone";
    const REMEDY: &str =
        "timedatectl set-timezone Europe/Tallinn, or whichever is yours: vthal takes it up within a minute";
    // The daemon's `TZ` is not that of this shell: what the files say counts.
    let is_known = |name: &str| jiff::tz::TimeZone::get(name).is_ok();
    let found = system_zone::find(&board.path(""), None, is_known);
    match found.name {
        Err(why) => Finding::warning(
            CHECK,
            format!(
                "this board's time zone is not known: {why}; schedules are in UTC, or in the zone from before"
            ),
            REMEDY,
        ),
        Ok(name) if name.ends_with("UTC") => Finding::warning(CHECK, "schedules are in UTC", REMEDY),
        Ok(name) => Finding::good(CHECK, name),
    }
}

fn disk(board: &Board) -> Finding {
    const CHECK: &str = "disk";
    let folder = [STATE, "var/lib", ""]
        .map(|inside| board.path(inside))
        .into_iter()
        .find(|path| path.is_dir());
    let Some(space) = folder.and_then(|path| rustix::fs::statvfs(&path).ok()) else {
        return Finding::warning(CHECK, "its free space cannot be read", "look at it with df -h");
    };
    if space.f_flag.contains(rustix::fs::StatVfsMountFlags::RDONLY) {
        return Finding::fault(
            CHECK,
            "is mounted read-only, so no map and no schedule is kept",
            "check the card and mount it for writing",
        );
    }
    let free_mib = (space.f_bavail * space.f_frsize) >> 20;
    if free_mib < FREE_MIB_MIN {
        Finding::warning(
            CHECK,
            format!("{free_mib} MiB are free"),
            format!("make room: {FREE_MIB_MIN} MiB hold a few recorded runs; or set recording.total_mib"),
        )
    } else {
        Finding::good(CHECK, format!("{free_mib} MiB are free"))
    }
}

/// The kernel's word about the supply of a Raspberry Pi: bit 0 now, bit 16 since the start.
fn supply(board: &Board) -> Finding {
    const CHECK: &str = "supply";
    const REMEDY: &str =
        "feed the board with 5 V that stay above 4.65 V under load: a converter for 1 A or more, short wires";
    let text = board.text("sys/devices/platform/soc/soc:firmware/get_throttled");
    let bits = text.and_then(|text| u32::from_str_radix(text.trim_start_matches("0x"), 16).ok());
    match bits {
        None => Finding::good(CHECK, "is not watched on this board"),
        Some(bits) if bits & 1 != 0 => Finding::fault(CHECK, "the voltage is too low now", REMEDY),
        Some(bits) if bits & 0x1_0000 != 0 => {
            Finding::warning(CHECK, "the voltage was too low since the start", REMEDY)
        }
        Some(_) => Finding::good(CHECK, "was never too low"),
    }
}

fn heat(board: &Board) -> Finding {
    const CHECK: &str = "heat";
    let text = board.text("sys/class/thermal/thermal_zone0/temp");
    match text.and_then(|text| text.trim().parse::<f64>().ok()) {
        None => Finding::good(CHECK, "is not measured on this board"),
        Some(milli_c) if milli_c > HOT_C * 1e3 => Finding::warning(
            CHECK,
            format!("the processor has {:.0} degrees", milli_c / 1e3),
            "give the board air, away from the motors",
        ),
        Some(milli_c) => Finding::good(CHECK, format!("the processor has {:.0} degrees", milli_c / 1e3)),
    }
}
