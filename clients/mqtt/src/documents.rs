//! What is said about the robot, as JSON. What is not known is `null`, which Home Assistant shows as unknown.

use bridge::{FanSpeed, Knowledge};
use rvac_api::{Activity, ComponentHealth, HomeView, Run, RunResult, Trouble, explain};
use serde_json::{Map, Value, json};

/// The state of a vacuum as Home Assistant reads it. Rooms appear when they are known, all at once.
pub(crate) fn state(known: &Knowledge, speed: FanSpeed) -> Value {
    let status = known.status.as_ref();
    let activity = status.and_then(|status| Activity::from_name(&status.state));
    let mut state = Map::new();
    let word = activity.map(|activity| activity.words().home_assistant);
    state.insert("state".to_owned(), word.into());
    state.insert("fan_speed".to_owned(), speed.name().into());
    if let Some(rooms) = known.home.as_ref().and_then(rooms) {
        state.insert("segments".to_owned(), rooms);
    }
    Value::Object(state)
}

/// Names of the rooms by their identities; `None` while there are none.
fn rooms(home: &HomeView) -> Option<Value> {
    let title = |room: &rvac_api::RoomView| room.name.clone().unwrap_or_else(|| format!("room {}", room.id));
    let rooms: Map<String, Value> = home
        .rooms
        .iter()
        .map(|room| (room.id.to_string(), title(room).into()))
        .collect();
    (!rooms.is_empty()).then_some(Value::Object(rooms))
}

/// All readings. The first of the pair changes when something happens, the second by and by, too.
pub(crate) fn readings(known: &Knowledge) -> (Value, Value) {
    let status = known.status.as_ref();
    let device = known.device.as_ref();
    let battery = device.and_then(|device| device.battery.as_ref());
    let trouble = status.and_then(Trouble::of_status);
    let told = trouble.and_then(|(code, _)| explain(code));
    let room = status.and_then(|status| status.room.as_ref());
    let floor = known.floors.as_ref().and_then(|floors| {
        let here = floors
            .floors
            .iter()
            .find(|floor| Some(floor.number) == floors.here)?;
        Some(here.title())
    });
    let next = known
        .schedules
        .as_ref()
        .and_then(|schedules| schedules.next.first());
    let events = json!({
        "activity": status.map(|status| status.state.as_str()),
        "reason": status.map(|status| status.reason.as_str()),
        "trouble": status.map(|_| trouble.map_or("none", |(_, trouble)| trouble.words().name)),
        "code": trouble.map(|(code, _)| code),
        "text": trouble.map(|(code, _)| told.map_or(code, |told| told.cause)),
        "remedy": told.map(|told| told.remedy),
        "charging": battery.map(|battery| matches!(battery.state.as_str(), "charging" | "full")),
        "docked": device.map(|device| device.docked),
        "dust_box": device.and_then(|device| device.dust_box),
        "room": room.map(rvac_api::RoomHere::title),
        "room_id": room.map(|room| room.id),
        "floor": floor,
        "strategy": status.and_then(|status| status.strategy.as_deref()),
        "driver": status.and_then(|status| status.driver.as_deref()),
        "next_run": next.map(|run| run.at.as_str()),
    });
    let mut all = events.clone();
    let slow = json!({
        "battery": battery.map(|battery| (battery.charge * 100.0).round()),
        "voltage_v": battery.map(|battery| tenths(battery.voltage_v)),
        "pack_c": battery.and_then(|battery| battery.temperature_c).map(f64::round),
        "area_m2": status.map(|status| tenths(status.swept_m2)),
        "job_min": status.map(|status| (status.job_s / 60.0).floor()),
        "path_m": status.map(|status| status.path_m.round()),
        "bumps": status.map(|status| status.bumps),
        "link_bad_percent": device.map(|device| tenths(device.link.bad_share * 100.0)),
    });
    if let (Value::Object(all), Value::Object(slow)) = (&mut all, slow) {
        all.extend(slow);
    }
    (events, all)
}

fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// How worn parts are.
pub(crate) fn wear(parts: &[ComponentHealth]) -> Value {
    let part = |part: &ComponentHealth| {
        let told = json!({
            "verdict": part.verdict,
            "minutes": part.minutes,
            "share": part.share,
            "text": part.text,
            "worked_h": part.hours.map(|hours| tenths(hours.worked_h)),
            "usual_h": part.hours.map(|hours| hours.usual_h),
            "due": part.hours.map(|hours| hours.is_due()),
        });
        (part.component.clone(), told)
    };
    Value::Object(parts.iter().map(part).collect())
}

/// The kinds of ends of runs, as events.
pub(crate) fn run_event(result: RunResult) -> &'static str {
    match result {
        RunResult::Finished => "finished",
        RunResult::Stopped => "stopped",
        RunResult::GaveUp => "gave_up",
        RunResult::DaemonEnded => "daemon_ended",
        RunResult::CutShort => "cut_short",
        RunResult::OtherRobot => "other_robot",
    }
}

/// A run that is over.
pub(crate) fn run(run: &Run) -> Value {
    json!({
        "event_type": run_event(run.result),
        "number": run.number,
        "text": run.text,
        "reason": run.reason,
        "start_s": run.start_s,
        "duration_min": (run.duration_s / 60.0).round(),
        "area_m2": tenths(run.swept_m2),
        "share_percent": run.share.map(|share| (share * 100.0).round()),
        "path_m": run.path_m.round(),
        "bumps": run.bumps,
        "stops": run.stop_count,
    })
}

#[cfg(test)]
mod tests {
    use bridge::{FanSpeed, Knowledge};
    use rvac_api::{HomeView, RoomView, Status};

    use super::{readings, state};

    #[test]
    fn what_is_not_known_is_null_and_rooms_come_all_at_once_or_not() {
        let mut known = Knowledge::default();
        let nothing = state(&known, FanSpeed::Rooms);
        assert!(
            nothing["state"].is_null() && nothing.get("segments").is_none(),
            "{nothing}"
        );
        let (_, all) = readings(&known);
        assert!(all["battery"].is_null() && all["trouble"].is_null());
        known.status = Some(Status {
            state: "stuck".to_owned(),
            reason: "slip".to_owned(),
            ..Status::default()
        });
        let room = |id, name: Option<&str>| RoomView {
            id,
            area_m2: 4.0,
            x: 0.0,
            y: 0.0,
            name: name.map(str::to_owned),
            settings: None,
        };
        known.home = Some(HomeView {
            rooms: vec![room(1, Some("Kitchen")), room(7, None)],
            ..HomeView::default()
        });
        let told = state(&known, FanSpeed::Quiet);
        assert_eq!(
            told.to_string(),
            r#"{"fan_speed":"quiet","segments":{"1":"Kitchen","7":"room 7"},"state":"error"}"#
        );
        let (events, _) = readings(&known);
        assert_eq!(
            (events["trouble"].as_str(), events["code"].as_str()),
            (Some("held"), Some("slip"))
        );
        assert_eq!(events["text"], "Its wheels slip.");
    }
}
