//! The device table as rows of text.

use rvac_api::{DeviceTable, LinkReading, RobotDescription, Versions};

use crate::percent_text;

/// One row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// What.
    pub label: String,
    /// How much, with its unit.
    pub value: String,
    /// Whether it wants attention.
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
pub fn device_sections(table: &DeviceTable, robot: Option<&RobotDescription>) -> Vec<Section> {
    let mut sections = vec![
        Section {
            title: "Battery",
            rows: battery(table),
        },
        Section {
            title: "Link to the robot",
            rows: link(table),
        },
        Section {
            title: "Wheels and brushes",
            rows: motion(table, robot),
        },
        Section {
            title: "Sensors",
            rows: sensors(table),
        },
        Section {
            title: "Versions",
            rows: versions(&table.versions, robot),
        },
    ];
    sections.retain(|section| !section.rows.is_empty());
    sections
}

fn battery(table: &DeviceTable) -> Vec<Row> {
    let Some(battery) = &table.battery else {
        return Vec::new();
    };
    let state = match battery.state.as_str() {
        "discharging" => "In use",
        "charging" => "Charging",
        "full" => "Full",
        "fault" => "Charging fault",
        other => other,
    };
    let temperature = match battery.temperature_c {
        Some(celsius) => format!("{celsius:.1} °C"),
        None => "not measured".to_owned(),
    };
    let mut rows = vec![
        alarm("Charge", percent_text(battery.charge), battery.charge < 0.15),
        alarm("State", state, battery.state == "fault"),
        row("Voltage", format!("{:.2} V", battery.voltage_v)),
        row("Current", format!("{:.2} A", battery.current_a)),
        alarm("Temperature", temperature, battery.temperature_c.is_none()),
    ];
    if let Some(charger) = &battery.charger {
        rows.push(row("Charger", charger.phase.as_str()));
        rows.extend(
            charger
                .end
                .iter()
                .map(|end| row("Last charge ended by", end.as_str())),
        );
        rows.extend(
            charger
                .fault
                .iter()
                .map(|fault| alarm("Charger fault", fault.as_str(), true)),
        );
    }
    rows
}

fn link(table: &DeviceTable) -> Vec<Row> {
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
    let mut rows = vec![alarm("Connection", if *up { "Up" } else { "Lost" }, !up)];
    if let Some(frequency) = table.main_loop_hz {
        rows.push(row("Main loop", format!("{frequency} Hz")));
    }
    rows.push(row("To the robot", bandwidth(table.bytes_out_per_s)));
    rows.push(row("From the robot", bandwidth(table.bytes_in_per_s)));
    rows.push(alarm(
        "Bad packets, last 5 s",
        format!("{:.2} %", bad_share * 100.0),
        *bad_share > 0.02,
    ));
    if let Some(round_trip) = round_trip_ms {
        rows.push(row("Round trip", format!("{round_trip:.1} ms")));
    }
    rows.push(row("Age of the newest reading", format!("{age_ms} ms")));
    rows.push(row("Telemetry", if *binary { "Binary" } else { "Text" }));
    let resets_text = match reset_cause {
        Some(cause) => format!("{resets}, last: {cause}"),
        None => resets.to_string(),
    };
    rows.push(row("Resets of the robot", resets_text));
    rows.push(row("Reconnects", reconnects.to_string()));
    rows
}

fn bandwidth(bytes_per_s: f64) -> String {
    format!("{:.2} kB/s", bytes_per_s / 1000.0)
}

fn motion(table: &DeviceTable, robot: Option<&RobotDescription>) -> Vec<Row> {
    let has = |part: &str| robot.is_some_and(|robot| robot.parts.iter().any(|known| known == part));
    let current = |index: usize| table.currents_a.and_then(|currents| currents.get(index).copied());
    let with_current = |text: String, index: usize| match current(index) {
        Some(current) => format!("{text}, {current:.2} A"),
        None => text,
    };
    let [main, sides, suction] = table.cleaners.map(|runs| if runs { "Running" } else { "Off" });
    let mut rows = vec![
        row(
            "Left wheel",
            with_current(format!("{:.2} m/s", table.wheel_left_m_per_s), 0),
        ),
        row(
            "Right wheel",
            with_current(format!("{:.2} m/s", table.wheel_right_m_per_s), 1),
        ),
    ];
    if has("brush-main") {
        rows.push(row("Main brush", with_current(main.to_owned(), 2)));
    }
    if has("brush-sides") {
        rows.push(row("Side brushes", sides));
    }
    if has("vacuum") {
        rows.push(row("Suction", suction));
        rows.push(alarm(
            "Dust box",
            if table.dust_box { "In place" } else { "Missing" },
            !table.dust_box,
        ));
    }
    rows
}

fn sensors(table: &DeviceTable) -> Vec<Row> {
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
    vec![
        alarm(
            "Bumper",
            list(&["left", "right"], &table.bumpers, "Free"),
            any(&table.bumpers),
        ),
        alarm(
            "No floor",
            list(&["left", "middle", "right"], &table.cliffs, "Nowhere"),
            any(&table.cliffs),
        ),
        alarm(
            "Hanging wheel",
            list(&["left", "right"], &table.wheel_drops, "None"),
            any(&table.wheel_drops),
        ),
        row("Dock contacts", if table.docked { "Closed" } else { "Open" }),
    ]
}

fn versions(versions: &Versions, robot: Option<&RobotDescription>) -> Vec<Row> {
    let mut rows = Vec::new();
    if let Some(robot) = robot {
        rows.push(row("Robot", robot.device.clone()));
    }
    let optional = [("Firmware", &versions.firmware), ("cordlib", &versions.cordlib)];
    for (label, version) in optional {
        if let Some(version) = version {
            rows.push(row(label, version.clone()));
        }
    }
    if let Some(protocol) = versions.protocol {
        rows.push(row("Wire protocol", protocol.to_string()));
    }
    rows.push(row("vthal", versions.vthal.clone()));
    rows.push(row("Brain", versions.brain.clone()));
    rows.push(row("Panel", env!("CARGO_PKG_VERSION")));
    rows
}

#[cfg(test)]
mod tests {
    use super::device_sections;
    use rvac_api::{BatteryReading, DeviceTable, RobotDescription};

    fn labels(table: &DeviceTable, robot: Option<&RobotDescription>) -> Vec<String> {
        device_sections(table, robot)
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
        let rows: Vec<_> = device_sections(&table, None)
            .into_iter()
            .flat_map(|section| section.rows)
            .collect();
        for (label, value) in [
            ("Charge", "39 %"),
            ("Voltage", "15.98 V"),
            ("Current", "0.00 A"),
            ("Temperature", "32.2 °C"),
            ("Main loop", "77762 Hz"),
            ("To the robot", "0.00 kB/s"),
            ("From the robot", "0.92 kB/s"),
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
    fn alarms_stand_out() {
        let table = DeviceTable {
            bumpers: [false, true],
            ..DeviceTable::default()
        };
        let rows: Vec<_> = device_sections(&table, None)
            .into_iter()
            .flat_map(|section| section.rows)
            .collect();
        assert!(
            rows.iter()
                .any(|row| row.label == "Bumper" && row.value == "right" && row.alarming)
        );
        assert!(rows.iter().any(|row| row.label == "Connection" && row.alarming));
        assert!(rows.iter().any(|row| row.label == "No floor" && !row.alarming));
    }
}
