//! The computer in the robot as rows of text.

use rvac_api::SystemReport;

use crate::device_rows::Row;
use crate::figures::clock_text;
use crate::words::Words;

/// Nothing of this software is older, seconds since 1970: 2026-01-01.
const CLOCK_MIN_S: i64 = 1_767_225_600;
/// A clock that differs by less does not make a schedule late, seconds.
const CLOCK_OFF_S: i64 = 90;
/// Recordings of a few runs.
const FREE_BYTES_MIN: u64 = 200 << 20;
/// Degrees Celsius from which a Raspberry Pi slows down.
const HOT_C: f64 = 80.0;
const DAY_S: u64 = 86_400;

/// What is known of it. `now_s` is the clock of the device that shows it, seconds since 1970.
#[must_use]
pub fn system_rows(words: &Words, told: &SystemReport, now_s: i64) -> Vec<Row> {
    let texts = &words.system;
    let mut rows = Vec::new();
    rows.extend(told.board.iter().map(|board| row(texts.board, board.clone())));
    rows.extend(told.urls.iter().map(|url| row(texts.reached_at, url.clone())));
    let networks = told.networks.iter();
    rows.extend(networks.map(|network| {
        let label = texts.network.fill([&network.interface]);
        row(&label, network.address.clone())
    }));
    rows.push(clock(words, told.clock_s, now_s));
    rows.push(match &told.zone {
        Some(zone) => row(texts.zone, zone.clone()),
        None => alarm(texts.zone, texts.zone_unknown.to_owned()),
    });
    rows.extend(disk(words, told));
    rows.extend(memory(words, told));
    rows.extend(told.processor_c.map(|processor_c| Row {
        alarming: processor_c > HOT_C,
        ..row(
            texts.heat,
            words.device.celsius.fill([&words.number(processor_c, 0)]),
        )
    }));
    rows.extend(told.up_s.map(|up_s| row(texts.up, span(words, up_s))));
    rows.push(row(texts.server, told.server.clone()));
    rows
}

fn row(label: &str, value: String) -> Row {
    Row {
        label: label.to_owned(),
        value,
        alarming: false,
    }
}

fn alarm(label: &str, value: String) -> Row {
    Row {
        alarming: true,
        ..row(label, value)
    }
}

fn clock(words: &Words, clock_s: i64, now_s: i64) -> Row {
    let texts = &words.system;
    let off_s = clock_s.abs_diff(now_s);
    if clock_s < CLOCK_MIN_S {
        alarm(texts.clock, texts.clock_unset.to_owned())
    } else if off_s > CLOCK_OFF_S.unsigned_abs() {
        alarm(texts.clock, texts.clock_off.fill([&span(words, off_s)]))
    } else {
        row(texts.clock, texts.clock_fine.to_owned())
    }
}

fn disk(words: &Words, told: &SystemReport) -> Option<Row> {
    let (texts, disk) = (&words.system, told.disk?);
    if disk.read_only {
        return Some(alarm(texts.disk, texts.disk_read_only.to_owned()));
    }
    let sizes = [size(words, disk.free_bytes), size(words, disk.total_bytes)];
    Some(Row {
        alarming: disk.free_bytes < FREE_BYTES_MIN,
        ..row(texts.disk, texts.disk_free.fill([&sizes[0], &sizes[1]]))
    })
}

fn memory(words: &Words, told: &SystemReport) -> Option<Row> {
    let texts = &words.system;
    let total = size(words, told.memory_bytes?);
    let said = match told.memory_available_bytes {
        Some(available) => texts.memory_free.fill([&size(words, available), &total]),
        None => total,
    };
    Some(row(texts.memory, said))
}

fn size(words: &Words, bytes: u64) -> String {
    let mebibytes = bytes as f64 / f64::from(1 << 20);
    if mebibytes < 1024.0 {
        words.system.mebibytes.fill([&words.number(mebibytes, 0)])
    } else {
        words
            .system
            .gibibytes
            .fill([&words.number(mebibytes / 1024.0, 1)])
    }
}

fn span(words: &Words, seconds: u64) -> String {
    let rest = clock_text((seconds % DAY_S) as f64);
    match seconds / DAY_S {
        0 => rest,
        days => words.system.days.fill([&days, &rest]),
    }
}

#[cfg(test)]
mod tests {
    use super::system_rows;
    use crate::words::Language;
    use rvac_api::{DiskSpace, NetworkAddress, SystemReport};

    const NOW_S: i64 = 1_800_000_000;

    fn rows(told: &SystemReport) -> Vec<(String, String, bool)> {
        let rows = system_rows(Language::English.words(), told, NOW_S);
        rows.into_iter()
            .map(|row| (row.label, row.value, row.alarming))
            .collect()
    }

    #[test]
    fn a_healthy_board_alarms_nobody() {
        let told = SystemReport {
            urls: vec!["https://robot.local/".to_owned()],
            networks: vec![NetworkAddress {
                interface: "wlan0".to_owned(),
                address: "192.168.1.7".to_owned(),
            }],
            clock_s: NOW_S - 20,
            zone: Some("Europe/Tallinn".to_owned()),
            disk: Some(DiskSpace {
                total_bytes: 15 << 30,
                free_bytes: 3 << 29,
                read_only: false,
            }),
            memory_bytes: Some(426 << 20),
            memory_available_bytes: Some(207 << 20),
            processor_c: Some(48.3),
            up_s: Some(200_000),
            server: "0.1.0".to_owned(),
            ..SystemReport::default()
        };
        let rows = rows(&told);
        let says = |label: &str| rows.iter().find(|row| row.0 == label).map(|row| row.1.as_str());
        assert!(rows.iter().all(|row| !row.2), "{rows:?}");
        assert_eq!(says("Network wlan0"), Some("192.168.1.7"));
        assert_eq!(says("Disk"), Some("1.5\u{a0}GiB free of 15.0\u{a0}GiB"));
        assert_eq!(says("Memory"), Some("207\u{a0}MiB available of 426\u{a0}MiB"));
        assert_eq!(says("Clock"), Some("as on this device"));
        assert_eq!(says("Switched on for"), Some("2\u{a0}d 7:33:20"));
    }

    #[test]
    fn what_makes_schedules_and_maps_fail_is_alarming_and_the_unknown_is_absent() {
        let told = SystemReport {
            clock_s: 1_000,
            disk: Some(DiskSpace {
                total_bytes: 1 << 30,
                free_bytes: 100 << 20,
                read_only: false,
            }),
            ..SystemReport::default()
        };
        let alarming: Vec<String> = rows(&told)
            .into_iter()
            .filter(|row| row.2)
            .map(|row| row.0)
            .collect();
        assert_eq!(alarming, ["Clock", "Time zone", "Disk"]);
        assert!(
            !rows(&told)
                .iter()
                .any(|row| row.0 == "Memory" || row.0 == "Processor")
        );
        let late = SystemReport {
            clock_s: NOW_S - 3_700,
            ..SystemReport::default()
        };
        assert!(
            rows(&late)
                .iter()
                .any(|row| row.1 == "1:01:40 apart from this device")
        );
    }
}
