//! The computer that this runs on, for the panel's sheet of it. What cannot be found out is absent.

use std::fs;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use rustix::fs::{StatVfsMountFlags, statvfs};
use rvac_api::{DiskSpace, NetworkAddress, SystemReport};

/// Where the daemon keeps maps and recordings, or what holds that folder.
const STATES: [&str; 3] = ["var/lib/vthal", "var/lib", ""];

/// What is to be seen now, of the system whose files lie below `root`, which browsers reach at `urls`.
pub(crate) fn report(root: &Path, urls: Vec<String>) -> SystemReport {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let known = |name: &str| root.join("usr/share/zoneinfo").join(name).is_file();
    let about = rustix::system::sysinfo();
    let memory = text(root, "proc/meminfo");
    let of_memory = |name| memory.as_deref().and_then(|memory| bytes_of(memory, name));
    SystemReport {
        urls,
        networks: networks(),
        clock_s: since.map_or(0, |since| since.as_secs().cast_signed()),
        zone: system_zone::find(root, None, known).name.ok(),
        disk: disk(root),
        // A service may be kept from the first, and then knows at least the sum.
        memory_bytes: of_memory("MemTotal")
            .or_else(|| Some(wide(about.totalram).saturating_mul(u64::from(about.mem_unit)))),
        memory_available_bytes: of_memory("MemAvailable"),
        processor_c: text(root, "sys/class/thermal/thermal_zone0/temp")
            .and_then(|text| text.parse::<f64>().ok())
            .map(|milli_c| milli_c / 1e3),
        up_s: u64::try_from(about.uptime).ok(),
        board: text(root, "sys/firmware/devicetree/base/model")
            .or_else(|| text(root, "sys/class/dmi/id/product_name")),
        server: env!("CARGO_PKG_VERSION").to_owned(),
    }
}

/// A number of the kernel, which is as wide as the computer's words.
fn wide(number: impl TryInto<u64>) -> u64 {
    number.try_into().unwrap_or(0)
}

/// A small text of the kernel, which ends those of the device tree with a zero.
fn text(root: &Path, inside: &str) -> Option<String> {
    let bytes = fs::read(root.join(inside)).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let text = text.trim_matches(['\0', '\n', ' ']);
    (!text.is_empty()).then(|| text.to_owned())
}

/// A line of `/proc/meminfo`, which counts in KiB.
fn bytes_of(memory: &str, name: &str) -> Option<u64> {
    let line = memory
        .lines()
        .find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))?;
    let kib: u64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(kib << 10)
}

fn disk(root: &Path) -> Option<DiskSpace> {
    let folder = STATES
        .map(|inside| root.join(inside))
        .into_iter()
        .find(|path| path.is_dir())?;
    let space = statvfs(&folder).ok()?;
    Some(DiskSpace {
        total_bytes: space.f_blocks * space.f_frsize,
        free_bytes: space.f_bavail * space.f_frsize,
        // To a service of systemd nearly all folders are read-only, whatever they are to the daemon.
        read_only: space.f_flag.contains(StatVfsMountFlags::RDONLY) && !is_service(),
    })
}

fn is_service() -> bool {
    std::env::var_os("INVOCATION_ID").is_some()
}

fn networks() -> Vec<NetworkAddress> {
    let interfaces = if_addrs::get_if_addrs().unwrap_or_default();
    let mut networks: Vec<NetworkAddress> = interfaces
        .iter()
        .filter(|interface| !interface.is_loopback())
        .map(|interface| NetworkAddress {
            interface: interface.name.clone(),
            address: interface.ip().to_string(),
        })
        .collect();
    networks.sort_by(|one, other| (&one.interface, &one.address).cmp(&(&other.interface, &other.address)));
    networks
}

#[cfg(test)]
mod tests {
    use super::report;
    use std::fs;

    #[test]
    fn what_the_files_of_a_board_say_is_told_and_the_rest_is_absent() {
        let root = std::env::temp_dir().join(format!("panel-server-system-{}", std::process::id()));
        fs::create_dir_all(&root).unwrap();
        let bare = report(&root, Vec::new());
        assert_eq!((bare.processor_c, bare.zone, bare.board), (None, None, None));
        assert!(bare.memory_bytes.is_some() && bare.memory_available_bytes.is_none());
        for (path, text) in [
            (
                "proc/meminfo",
                "MemTotal:         436620 kB\nMemAvailable:     212000 kB\n",
            ),
            ("sys/class/thermal/thermal_zone0/temp", "48312\n"),
            (
                "sys/firmware/devicetree/base/model",
                "Raspberry Pi Zero 2 W Rev 1.0\0",
            ),
            ("usr/share/zoneinfo/Europe/Tallinn", ""),
            ("etc/timezone", "Europe/Tallinn\n"),
        ] {
            let path = root.join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let told = report(&root, vec!["https://robot.local/".to_owned()]);
        assert_eq!(told.processor_c, Some(48.312));
        assert_eq!(told.memory_bytes, Some(436_620 << 10));
        assert_eq!(told.memory_available_bytes, Some(212_000 << 10));
        assert_eq!(told.board.as_deref(), Some("Raspberry Pi Zero 2 W Rev 1.0"));
        assert_eq!(told.zone.as_deref(), Some("Europe/Tallinn"));
        assert!(told.disk.is_some_and(|disk| disk.free_bytes <= disk.total_bytes));
        fs::remove_dir_all(&root).unwrap();
    }
}
