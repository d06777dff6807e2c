//! The device table as rows of text.

use rvac_api::{BatteryReading, DeviceTable, LinkReading, RobotDescription, Versions};

use crate::codes::reading_text;
use crate::percent_text;
use crate::words::{Template, Words};

/// A battery that feeds a robot gives more than this, amperes: less is what a meter in the charger's line reads then.
pub(crate) const UNMEASURED_A: f64 = 0.005;

/// One row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// What.
    pub label: String,
    /// How much, with its unit.
    pub value: String,
    /// Whether it needs attention.
    pub alarming: bool,
}

/// Rows under one title.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// Title.
    pub title: &'static str,
    /// Rows.
    pub rows: Vec<Row>,
}

fn row(label: impl Into<String>, value: impl Into<String>) -> Row {
    Row {
        label: label.into(),
        value: value.into(),
        alarming: false,
    }
}

fn alarm(label: &str, value: impl Into<String>, alarming: bool) -> Row {
    Row {
        alarming,
        ..row(label, value)
    }
}

/// The sections for what is measured. What the robot lacks has no row.
#[must_use]
pub fn device_sections(words: &Words, table: &DeviceTable, robot: Option<&RobotDescription>) -> Vec<Section> {
    let texts = &words.device;
    let mut sections = vec![
        Section {
            title: texts.battery,
            rows: battery(words, table),
        },
        Section {
            title: texts.link,
            rows: link(words, table),
        },
        Section {
            title: texts.motion,
            rows: motion(words, table, robot),
        },
        Section {
            title: texts.sensors,
            rows: sensors(words, table),
        },
        Section {
            title: texts.versions,
            rows: versions(words, &table.versions, robot),
        },
    ];
    sections.retain(|section| !section.rows.is_empty());
    sections
}

/// A number with its unit.
fn with_unit(words: &Words, unit: Template<1>, value: f64, decimals: usize) -> String {
    unit.fill([&words.number(value, decimals)])
}

fn battery(words: &Words, table: &DeviceTable) -> Vec<Row> {
    let texts = &words.device;
    let Some(battery) = &table.battery else {
        return Vec::new();
    };
    let state = match battery.state.as_str() {
        "discharging" => texts.discharging,
        "charging" => texts.charging,
        "full" => texts.full,
        "fault" => texts.fault,
        other => other,
    };
    let temperature = match battery.temperature_c {
        Some(celsius) => with_unit(words, texts.celsius, celsius, 1),
        None => texts.not_measured.to_owned(),
    };
    let mut rows = vec![
        alarm(
            texts.charge,
            percent_text(words, battery.charge),
            battery.charge < 0.15,
        ),
        alarm(texts.state, state, battery.state == "fault"),
        row(texts.voltage, with_unit(words, texts.volts, battery.voltage_v, 2)),
        row(texts.current, battery_current(words, battery)),
        alarm(texts.temperature, temperature, battery.temperature_c.is_none()),
    ];
    if let Some(charger) = &battery.charger {
        let code = |code: &str| reading_text(words, code).to_owned();
        rows.push(row(texts.charger, code(&charger.phase)));
        rows.extend(charger.end.iter().map(|end| row(texts.charge_end, code(end))));
        let faults = charger.fault.iter();
        rows.extend(faults.map(|fault| alarm(texts.charger_fault, code(fault), true)));
    }
    rows
}

/// What drains a battery is never nothing: a robot that reports no current then measures only that of its charger.
fn battery_current(words: &Words, battery: &BatteryReading) -> String {
    let texts = &words.device;
    if battery.state == "discharging" && battery.current_a.abs() < UNMEASURED_A {
        return texts.not_measured.to_owned();
    }
    with_unit(words, texts.amperes, battery.current_a, 2)
}

fn link(words: &Words, table: &DeviceTable) -> Vec<Row> {
    let texts = &words.device;
    let LinkReading {
        up,
        age_ms,
        bad_share,
        round_trip_ms,
        resets,
        reset_cause,
        reconnects,
        binary,
    } = &table.link;
    let bandwidth = |bytes_per_s: f64| with_unit(words, texts.kilobytes_per_s, bytes_per_s / 1000.0, 2);
    let mut rows = vec![alarm(
        texts.connection,
        if *up { texts.up } else { texts.lost },
        !up,
    )];
    if let Some(frequency) = table.main_loop_hz {
        rows.push(row(texts.main_loop, texts.hertz.fill([&frequency])));
    }
    rows.push(row(texts.to_robot, bandwidth(table.bytes_out_per_s)));
    rows.push(row(texts.from_robot, bandwidth(table.bytes_in_per_s)));
    rows.push(alarm(
        texts.bad_packets,
        with_unit(words, words.unit.percent, bad_share * 100.0, 2),
        *bad_share > 0.02,
    ));
    if let Some(round_trip) = round_trip_ms {
        rows.push(row(
            texts.round_trip,
            with_unit(words, texts.milliseconds, *round_trip, 1),
        ));
    }
    rows.push(row(texts.age, texts.milliseconds.fill([age_ms])));
    rows.push(row(
        texts.telemetry,
        if *binary { texts.binary } else { texts.text },
    ));
    let resets_text = match reset_cause {
        Some(cause) => texts.resets_last.fill([resets, &reading_text(words, cause)]),
        None => resets.to_string(),
    };
    rows.push(row(texts.resets, resets_text));
    rows.push(row(texts.reconnects, reconnects.to_string()));
    rows
}

fn motion(words: &Words, table: &DeviceTable, robot: Option<&RobotDescription>) -> Vec<Row> {
    let texts = &words.device;
    let has = |part: &str| robot.is_some_and(|robot| robot.parts.iter().any(|known| known == part));
    let unmeasured = robot.is_some_and(|robot| robot.unmeasured.iter().any(|motor| motor == "brush-main"));
    let measured = if unmeasured { 0..2 } else { 0..3 };
    let current = |index: usize| {
        let currents = table.currents_a.filter(|_| measured.contains(&index));
        currents.and_then(|currents| currents.get(index).copied())
    };
    let with_current = |text: String, index: usize| match current(index) {
        Some(current) => texts.with_current.fill([&text, &words.number(current.into(), 2)]),
        None => text,
    };
    let speed = |m_per_s: f64| with_unit(words, texts.metres_per_s, m_per_s, 2);
    let [main, sides, suction] = table
        .cleaners
        .map(|runs| if runs { texts.running } else { texts.off });
    let mut rows = vec![
        row(texts.left_wheel, with_current(speed(table.wheel_left_m_per_s), 0)),
        row(
            texts.right_wheel,
            with_current(speed(table.wheel_right_m_per_s), 1),
        ),
    ];
    if has("brush-main") {
        rows.push(row(texts.main_brush, with_current(main.to_owned(), 2)));
    }
    if has("brush-sides") {
        rows.push(row(texts.side_brushes, sides));
    }
    if has("vacuum") {
        rows.push(row(texts.suction, suction));
        rows.extend(table.dust_box.map(|is_in| {
            let seen = if is_in { texts.in_place } else { texts.missing };
            alarm(texts.dust_box, seen, !is_in)
        }));
    }
    rows.extend(robot.and_then(|robot| stall_detection(words, robot)));
    rows
}

/// The motors of which nothing notices that they are held fast. Wheels and main brush are guarded once they are calibrated.
fn stall_detection(words: &Words, robot: &RobotDescription) -> Option<Row> {
    let told = &words.device;
    let is_listed = |motor: &str| robot.unguarded.iter().any(|known| known == motor);
    let motors: Vec<&str> = [
        ("wheels", told.wheels),
        ("brush-main", told.main_brush),
        ("brush-sides", told.side_brushes),
        ("vacuum", told.suction),
    ]
    .into_iter()
    .filter_map(|(motor, name)| is_listed(motor).then_some(name))
    .collect();
    let is_missing = is_listed("wheels") || is_listed("brush-main");
    (!motors.is_empty()).then(|| alarm(told.no_stall_detection, motors.join(", "), is_missing))
}

fn sensors(words: &Words, table: &DeviceTable) -> Vec<Row> {
    let texts = &words.device;
    let list = |names: &[&str], states: &[bool], none: &str| {
        let active: Vec<&str> = names
            .iter()
            .zip(states)
            .filter(|(_, on)| **on)
            .map(|(name, _)| *name)
            .collect();
        if active.is_empty() {
            none.to_owned()
        } else {
            active.join(", ")
        }
    };
    let any = |states: &[bool]| states.contains(&true);
    let sides = [texts.left, texts.right];
    vec![
        alarm(
            texts.bumper,
            list(&sides, &table.bumpers, texts.free),
            any(&table.bumpers),
        ),
        alarm(
            texts.cliff_sensors,
            list(
                &[texts.left, texts.middle, texts.right],
                &table.cliffs,
                texts.no_cliff,
            ),
            any(&table.cliffs),
        ),
        alarm(
            texts.hanging,
            list(&sides, &table.wheel_drops, texts.none_hangs),
            any(&table.wheel_drops),
        ),
        row(texts.dock, if table.docked { texts.closed } else { texts.open }),
    ]
}

fn versions(words: &Words, versions: &Versions, robot: Option<&RobotDescription>) -> Vec<Row> {
    let texts = &words.device;
    let mut rows = Vec::new();
    if let Some(robot) = robot {
        rows.push(row(texts.robot, robot.device.clone()));
    }
    let optional = [
        (texts.firmware, &versions.firmware),
        ("cordlib", &versions.cordlib),
    ];
    for (label, version) in optional {
        if let Some(version) = version {
            rows.push(row(label, version.clone()));
        }
    }
    if let Some(protocol) = versions.protocol {
        rows.push(row(texts.protocol, protocol.to_string()));
    }
    rows.push(row("vthal", versions.vthal.clone()));
    rows.push(row(texts.brain, versions.brain.clone()));
    rows.push(row(texts.panel, env!("CARGO_PKG_VERSION")));
    rows
}

#[cfg(test)]
mod tests {
    use super::device_sections;
    use crate::words::{Language, Words};
    use rvac_api::{BatteryReading, DeviceTable, RobotDescription};

    const ENGLISH: &Words = Language::English.words();

    fn labels(table: &DeviceTable, robot: Option<&RobotDescription>) -> Vec<String> {
        device_sections(ENGLISH, table, robot)
            .into_iter()
            .flat_map(|section| section.rows)
            .map(|row| row.label)
            .collect()
    }

    #[test]
    fn what_is_not_there_has_no_row() {
        let labels = labels(&DeviceTable::default(), None);
        for absent in [
            "Charge",
            "Main brush",
            "Suction",
            "Main loop",
            "Firmware",
            "Round trip",
        ] {
            assert!(!labels.iter().any(|label| label == absent), "{absent}");
        }
    }

    #[test]
    fn the_table_of_2016_is_complete() {
        let battery = BatteryReading {
            charge: 0.3944,
            voltage_v: 15.98,
            current_a: 0.0,
            temperature_c: Some(32.16),
            state: "x".to_owned(),
            charger: None,
        };
        let mut table = DeviceTable {
            battery: Some(battery),
            main_loop_hz: Some(77762),
            ..DeviceTable::default()
        };
        table.bytes_in_per_s = 920.0;
        table.versions.firmware = Some("0.0.1".to_owned());
        table.versions.cordlib = Some("0.0.1".to_owned());
        let rows: Vec<_> = device_sections(ENGLISH, &table, None)
            .into_iter()
            .flat_map(|section| section.rows)
            .collect();
        for (label, value) in [
            ("Charge", "39\u{a0}%"),
            ("Voltage", "15.98\u{a0}V"),
            ("Current", "0.00\u{a0}A"),
            ("Temperature", "32.2\u{a0}°C"),
            ("Main loop", "77762\u{a0}Hz"),
            ("To the robot", "0.00\u{a0}kB/s"),
            ("From the robot", "0.92\u{a0}kB/s"),
            ("Firmware", "0.0.1"),
            ("cordlib", "0.0.1"),
        ] {
            assert!(
                rows.iter().any(|row| row.label == label && row.value == value),
                "{label} {value}"
            );
        }
    }

    #[test]
    fn a_current_that_no_meter_reads_is_not_shown_as_none() {
        let shown = |state: &str, current_a: f64| {
            let battery = BatteryReading {
                charge: 0.5,
                voltage_v: 16.0,
                current_a,
                temperature_c: None,
                state: state.to_owned(),
                charger: None,
            };
            super::battery_current(ENGLISH, &battery)
        };
        assert_eq!(shown("discharging", 0.0), "not measured");
        assert_eq!(shown("discharging", -0.43), "-0.43\u{a0}A");
        assert_eq!(shown("charging", 0.0), "0.00\u{a0}A");
        assert_eq!(shown("full", 0.0), "0.00\u{a0}A");
    }

    #[test]
    fn what_the_robot_does_not_know_of_its_motors_is_told() {
        let table = DeviceTable {
            currents_a: Some([0.25, 0.5, 0.0]),
            ..DeviceTable::default()
        };
        let mut robot = RobotDescription {
            device: "sr8730".to_owned(),
            radius_m: 0.175,
            swath_m: 0.3,
            speed_max_m_per_s: 0.35,
            turn_max_rad_per_s: 1.5,
            proximity: 7,
            parts: vec!["brush-main".to_owned(), "currents".to_owned()],
            unguarded: Vec::new(),
            unmeasured: Vec::new(),
            lacking: Vec::new(),
        };
        let value = |robot: &RobotDescription, label: &str| {
            let mut rows = device_sections(ENGLISH, &table, Some(robot))
                .into_iter()
                .flat_map(|section| section.rows);
            rows.find(|row| row.label == label)
                .map(|row| (row.value, row.alarming))
        };
        assert_eq!(
            value(&robot, "Main brush"),
            Some(("Off, 0.00\u{a0}A".to_owned(), false))
        );
        assert_eq!(value(&robot, "No stall detection"), None);
        robot.unmeasured = vec!["brush-main".to_owned()];
        robot.unguarded = vec!["brush-sides".to_owned(), "vacuum".to_owned()];
        assert_eq!(value(&robot, "Main brush"), Some(("Off".to_owned(), false)));
        let told = ("Side brushes, Suction".to_owned(), false);
        assert_eq!(value(&robot, "No stall detection"), Some(told));
        robot.unguarded.insert(0, "brush-main".to_owned());
        let told = ("Main brush, Side brushes, Suction".to_owned(), true);
        assert_eq!(value(&robot, "No stall detection"), Some(told));
    }

    #[test]
    fn alarms_stand_out() {
        let table = DeviceTable {
            bumpers: [false, true],
            ..DeviceTable::default()
        };
        let rows: Vec<_> = device_sections(ENGLISH, &table, None)
            .into_iter()
            .flat_map(|section| section.rows)
            .collect();
        assert!(
            rows.iter()
                .any(|row| row.label == "Bumper" && row.value == "right" && row.alarming)
        );
        assert!(rows.iter().any(|row| row.label == "Connection" && row.alarming));
        assert!(
            rows.iter()
                .any(|row| row.label == "Cliff sensors" && !row.alarming)
        );
    }
}
