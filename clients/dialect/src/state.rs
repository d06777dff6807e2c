//! What the robot does and how it is, in the words of the dialect.

use bridge::{FanSpeed, Knowledge};
use rvac_api::{Activity, BatteryReading, Status, Trouble, explain};
use serde_json::{Value, json};

use crate::preset;

/// What is said while the daemon is away.
const NO_DAEMON: &str = "no-daemon";

/// What the robot does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatusWords {
    /// `value` of the attribute; absent where the daemon says a state that is newer than this program.
    pub value: Option<&'static str>,
    /// Its `flag`.
    pub flag: &'static str,
    /// What is the matter, if a person must help.
    pub fault: Option<Fault>,
}

/// What is the matter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    code: String,
    trouble: Trouble,
}

impl Fault {
    /// For people.
    #[must_use]
    pub fn text(&self) -> &str {
        explain(&self.code).map_or(&self.code, |told| told.cause)
    }

    /// As an `error` of the dialect.
    #[must_use]
    pub fn json(&self) -> Value {
        let words = self.trouble.words();
        json!({
            "severity": {"kind": "unknown", "level": words.gravity.level()},
            "subsystem": words.subsystem,
            "message": self.text(),
            "vendorErrorCode": self.code,
        })
    }
}

/// What the running or last job has done, in steps that are worth saying: a tenth of a square metre and ten seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Square centimetres.
    pub area_cm2: f64,
    /// Seconds.
    pub time_s: f64,
}

/// What the robot does.
#[must_use]
pub fn status(status: &Status) -> StatusWords {
    let activity = Activity::from_name(&status.state);
    let fault = Trouble::of_status(status)
        .filter(|_| activity.is_some_and(Activity::needs_help))
        .map(|(code, trouble)| Fault {
            code: code.to_owned(),
            trouble,
        });
    let words = activity.map(Activity::words);
    StatusWords {
        value: words.map(|words| words.status_value),
        flag: words.map_or("none", |words| words.status_flag),
        fault,
    }
}

/// Level in percent, and flag.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it is held within a range before, and NaN becomes 0"
)]
pub fn battery(battery: &BatteryReading) -> (u8, &'static str) {
    let flag = match battery.state.as_str() {
        "charging" => "charging",
        "full" => "charged",
        "discharging" => "discharging",
        _ => "none",
    };
    ((battery.charge * 100.0).round().clamp(0.0, 100.0) as u8, flag)
}

/// What the running or last job has done.
#[must_use]
pub fn progress(status: &Status) -> Progress {
    Progress {
        area_cm2: (status.swept_m2 * 10.0).floor() * 1_000.0,
        time_s: (status.job_s / 10.0).floor() * 10.0,
    }
}

/// All attributes of the robot's state, as a list.
#[must_use]
pub fn attributes(known: &Knowledge, speed: FanSpeed) -> Value {
    let words = match &known.status {
        Some(now) => status(now),
        None => StatusWords {
            value: Some("error"),
            flag: "none",
            fault: Some(Fault {
                code: NO_DAEMON.to_owned(),
                trouble: Trouble::Link,
            }),
        },
    };
    let mut first = json!({
        "__class": "StatusStateAttribute",
        "metaData": {},
        "value": words.value.unwrap_or("idle"),
        "flag": words.flag,
    });
    if let (Some(fault), Value::Object(first)) = (words.fault, &mut first) {
        first.insert("error".to_owned(), fault.json());
    }
    let mut all = vec![first];
    let device = known.device.as_ref();
    if let Some(reading) = device.and_then(|device| device.battery.as_ref()) {
        let (level, flag) = battery(reading);
        all.push(json!({"__class": "BatteryStateAttribute", "metaData": {}, "level": level, "flag": flag}));
    }
    if known.robot.as_ref().is_some_and(FanSpeed::is_had_by) {
        all.push(json!({
            "__class": "PresetSelectionStateAttribute",
            "metaData": {},
            "type": "fan_speed",
            "value": preset(speed),
        }));
    }
    if let Some(is_in) = device.and_then(|device| device.dust_box) {
        all.push(json!({
            "__class": "AttachmentStateAttribute",
            "metaData": {},
            "type": "dustbin",
            "attached": is_in,
        }));
    }
    Value::Array(all)
}

#[cfg(test)]
mod tests {
    use bridge::{FanSpeed, Knowledge};
    use rvac_api::{BatteryReading, DeviceTable, Status, Update};

    use super::attributes;

    #[test]
    fn a_robot_that_waits_for_help_says_what_is_the_matter() {
        let mut known = Knowledge::default();
        let away = attributes(&known, FanSpeed::Rooms);
        assert_eq!(away[0]["value"], "error");
        assert_eq!(away[0]["error"]["vendorErrorCode"], "no-daemon");
        known.take(&Update::Status(Status {
            state: "stuck".to_owned(),
            reason: "slip".to_owned(),
            ..Status::default()
        }));
        let stuck = attributes(&known, FanSpeed::Rooms);
        assert_eq!(stuck[0]["value"], "error");
        assert_eq!(stuck[0]["error"]["subsystem"], "navigation");
        assert_eq!(stuck[0]["error"]["severity"]["level"], "error");
        known.take(&Update::Status(Status {
            state: "paused".to_owned(),
            ..Status::default()
        }));
        known.take(&Update::Device(DeviceTable {
            battery: Some(BatteryReading {
                charge: 0.456,
                voltage_v: 14.0,
                current_a: 1.0,
                temperature_c: None,
                state: "charging".to_owned(),
                charger: None,
            }),
            dust_box: Some(true),
            ..DeviceTable::default()
        }));
        let told = attributes(&known, FanSpeed::Rooms);
        assert_eq!(told[0]["flag"], "resumable");
        assert!(told[0].get("error").is_none(), "{told}");
        assert_eq!(
            (&told[1]["level"], &told[1]["flag"]),
            (&46.into(), &"charging".into())
        );
        assert_eq!(told[2]["attached"], true);
    }
}
