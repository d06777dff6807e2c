//! A recording as Foxglove meets it: an indexed file whose messages keep to the schemas that it brings along.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read as _;

use brain::action::{Arm, Tone};
use brain::observation::{BeaconRange, BeaconSignal, BeaconStrength, ChargeFlow, MotorCurrents};
use brain::{
    Actions, Body, BrainConfig, Command, Decision, DecisionCause, DecisionKind, Inhibits, JobCommand, Motion,
    Observation, Reason, Speeds, StrategyName,
};
use mcap::{MessageStream, Summary};
use rvac_api::{
    BatteryReading, ChargerReading, DaemonLoad, DeviceTable, LogEntry, LogLevel, Pose, RobotDescription,
    RoomHere, RunRecord, Status, TrackPose,
};
use serde_json::{Value, json};
use vthal::recording::{Library, LibraryLimits, Part, RunFile, Whole, track};
use vthal_bench::Scratch;
use vthal_core::{Direction, Record, RunCause, RunEnd, RunStart};

/// Host time of the run's begin.
const BEGIN_US: u64 = 8_008_291;

fn start() -> RunStart {
    RunStart {
        time_us: BEGIN_US,
        run: 1,
        cause: RunCause::Job,
        seed: u64::MAX,
        brain: config(),
        checkpoint: brain::Checkpoint::default(),
        device: "sr8730".to_owned(),
        firmware: "0.1.0".to_owned(),
        robot: RobotDescription {
            device: "sr8730".to_owned(),
            radius_m: 0.175,
            swath_m: 0.3,
            speed_max_m_per_s: 0.35,
            turn_max_rad_per_s: 1.5,
            proximity: 5,
            parts: vec!["gyro".to_owned()],
            unguarded: Vec::new(),
            unmeasured: Vec::new(),
            lacking: Vec::new(),
        },
    }
}

fn config() -> BrainConfig {
    let body = Body {
        radius_m: 0.175,
        swath_m: 0.3,
        track_m: 0.23,
    };
    let speeds = Speeds {
        cruise_m_per_s: 0.25,
        max_m_per_s: 0.35,
        turn_max_rad_per_s: 1.5,
    };
    BrainConfig::new(body, speeds)
}

fn answers() -> [Actions; 2] {
    let quiet = Actions {
        motion: Motion::Rest,
        cleaners: false,
        arm: None,
        tones: Vec::new(),
        decisions: Vec::new(),
        edits: Vec::new(),
    };
    let busy = Actions {
        motion: Motion::Drive {
            speed_m_per_s: 0.25,
            turn_rad_per_s: 0.0,
        },
        cleaners: true,
        arm: Some(Arm { undock: true }),
        tones: vec![Tone {
            pitch_hz: 880,
            duration_ms: 200,
        }],
        decisions: vec![Decision {
            kind: DecisionKind::Turn,
            cause: DecisionCause::Reason(Reason::BumpLeft),
            value: 1.5,
        }],
        edits: Vec::new(),
    };
    [busy, quiet]
}

const CLEAN: Command = Command::Job(JobCommand::Clean {
    strategy: StrategyName::Bounce,
});

/// Of a robot whose wheels' currents are measured and whose brush's is not.
fn without_brush_current() -> Observation {
    Observation {
        currents: Some(MotorCurrents {
            wheel_left_a: 0.15,
            wheel_right_a: 0.125,
            brush_main_a: None,
        }),
        ..Observation::default()
    }
}

/// One record of every kind, some with every optional part and some with none.
fn records() -> Vec<Record> {
    let status = Status {
        state: "cleaning".to_owned(),
        inhibits: vec!["bumper".to_owned()],
        ..Status::default()
    };
    let named = Status {
        strategy: Some("bounce".to_owned()),
        driver: Some("panel".to_owned()),
        room: Some(kitchen()),
        ..status.clone()
    };
    let full = Observation {
        time_us: BEGIN_US + 1,
        gyro_heading_rad: Some(-15.7),
        proximity: vec![0.5; 8],
        dock_beams: vec![0, 3],
        battery_charge: Some(0.94),
        charge_flow: Some(ChargeFlow::Flowing),
        currents: Some(MotorCurrents {
            wheel_left_a: 0.15,
            wheel_right_a: 0.125,
            brush_main_a: Some(0.5),
        }),
        beacons: vec![
            BeaconSignal::Range(BeaconRange {
                beacon: 2,
                range_m: 3.5,
                sigma_m: 0.2,
            }),
            BeaconSignal::Strength(BeaconStrength {
                beacon: 4,
                dbm: -71.0,
            }),
        ],
        beacons_in_range: 3,
        inhibits: Inhibits::from_names(["wheel-drop"]),
        ..Observation::default()
    };
    let mut records = vec![
        Record::Command {
            time_us: BEGIN_US,
            command: CLEAN,
        },
        Record::Observation(full),
        Record::Observation(without_brush_current()),
    ];
    records.extend(answers().into_iter().map(|actions| Record::Actions {
        time_us: BEGIN_US + 1,
        actions,
    }));
    records.extend(
        [Direction::ToRobot, Direction::FromRobot].map(|direction| Record::Packet {
            time_us: BEGIN_US + 2,
            direction,
            text: r#"{"c":"stop"}"#.to_owned(),
        }),
    );
    records.extend([status, named].map(|status| Record::Status {
        time_us: BEGIN_US + 3,
        status,
    }));
    records.push(measured());
    records.push(told());
    records.push(Record::Pose(POSE));
    records.extend([LogLevel::Debug, LogLevel::Info, LogLevel::Warn, LogLevel::Error].map(line));
    records
}

fn kitchen() -> RoomHere {
    RoomHere {
        id: 3,
        name: Some("Kitchen".to_owned()),
    }
}

/// The device table with every part.
fn measured() -> Record {
    let table = DeviceTable {
        battery: Some(BatteryReading {
            charge: 0.5,
            voltage_v: 15.0,
            current_a: -1.0,
            temperature_c: Some(25.0),
            state: "charging".to_owned(),
            charger: Some(ChargerReading {
                phase: "fast".to_owned(),
                end: Some("slope".to_owned()),
                fault: None,
            }),
        }),
        currents_a: Some([0.1, 0.2, 0.5]),
        daemon: Some(DaemonLoad {
            memory_bytes: Some(20_000_000),
            busy_s: 12.5,
            longest_turn_ms: 1.5,
        }),
        ..DeviceTable::default()
    };
    Record::Device {
        time_us: BEGIN_US + 3,
        table: Box::new(table),
    }
}

/// What people are told of the run.
fn told() -> Record {
    let text = r#"{"run":{"number":4,"job":"spot","by":"button","duration_s":60.0,"moving_s":50.0,"swept_m2":1.0,
        "path_m":9.0,"bumps":0,"result":"finished","reason":"finished","text":"Finished.","stop_count":0},"stops":[]}"#;
    Record::RunSummary {
        time_us: BEGIN_US + 4,
        run: serde_json::from_str(text).expect("a record"),
    }
}

/// A radian to the left, at a time that a float cannot say exactly.
const POSE: Pose = Pose {
    x: 1.25,
    y: -0.333_333_333,
    heading: 1.0,
    t: 259.975_123,
};

fn line(level: LogLevel) -> Record {
    Record::Log(LogEntry {
        number: 1,
        t: 9.5,
        level,
        part: "brain".to_owned(),
        text: "turns: bump-left".to_owned(),
    })
}

/// Writes a run and gives the bytes of its file.
fn recording() -> Vec<u8> {
    let folder = Scratch::new().expect("creates");
    let path = folder.join("recording.mcap");
    let mut run = RunFile::create(&path, &start(), "settings").expect("creates");
    for record in records() {
        run.write(&record).expect("writes");
    }
    run.finish().expect("finishes");
    fs::read(&path).expect("reads")
}

/// All messages by topic, each with its time in nanoseconds.
fn messages(bytes: &[u8]) -> BTreeMap<String, Vec<(u64, Value)>> {
    let mut all: BTreeMap<String, Vec<(u64, Value)>> = BTreeMap::new();
    for message in MessageStream::new(bytes).expect("is MCAP") {
        let message = message.expect("is whole");
        let value = serde_json::from_slice(&message.data).expect("is JSON");
        all.entry(message.channel.topic.clone())
            .or_default()
            .push((message.log_time, value));
    }
    all
}

#[test]
fn the_index_names_every_channel_and_all_messages() {
    let bytes = recording();
    let summary = Summary::read(&bytes).expect("reads").expect("has a summary");
    let stats = summary.stats.as_ref().expect("has statistics");
    let found = messages(&bytes);
    assert_eq!(
        stats.message_count as usize,
        found.values().map(Vec::len).sum::<usize>()
    );
    assert!(!summary.chunk_indexes.is_empty(), "a reader can jump in it");
    let mut schemas = BTreeMap::new();
    for channel in summary.channels.values() {
        let schema = channel.schema.as_ref().expect("each channel has a schema");
        assert_eq!(
            (channel.message_encoding.as_str(), schema.encoding.as_str()),
            ("json", "jsonschema")
        );
        assert!(
            found.contains_key(&channel.topic),
            "{} has messages",
            channel.topic
        );
        schemas.insert(channel.topic.as_str(), schema.name.as_str());
    }
    let drawn = ["/pose", "/tf", "/robot", "/log"].map(|topic| schemas[topic]);
    // Foxglove knows forms by these names.
    let names = ["PoseInFrame", "FrameTransform", "SceneUpdate", "Log"];
    assert_eq!(drawn, names.map(|name| format!("foxglove.{name}")));
}

#[test]
fn every_message_keeps_to_its_schema() {
    let bytes = recording();
    let mut keys_met: BTreeSet<(String, String)> = BTreeSet::new();
    for message in MessageStream::new(&bytes).expect("is MCAP") {
        let message = message.expect("is whole");
        let schema = message.channel.schema.as_ref().expect("has a schema");
        let schema: Value = serde_json::from_slice(&schema.data).expect("schemas are JSON");
        let value: Value = serde_json::from_slice(&message.data).expect("is JSON");
        let topic = &message.channel.topic;
        if let Err(wrong) = check(&schema, &value) {
            panic!("{topic}: {wrong} in {value}");
        }
        let keys = value.as_object().expect("is an object").keys();
        keys_met.extend(keys.map(|key| (topic.clone(), key.clone())));
    }
    for (topic, schema) in schemas(&bytes) {
        let properties = schema["properties"].as_object().expect("has properties");
        for key in properties.keys() {
            assert!(
                keys_met.contains(&(topic.clone(), key.clone())),
                "{topic} never has {key}"
            );
        }
    }
}

/// Plots and tables that people have made in Foxglove go by these names.
#[test]
fn fields_have_the_names_that_they_always_had() {
    let names = [
        (
            "/run",
            "format vthal time_us run cause seed device firmware config state",
        ),
        (
            "/observations",
            "time_us left_m right_m gyro_rad contacts cliffs wheel_drop proximity dock_beams docked battery charge_flow \
             currents_a inhibits link_up speed_share beacons strengths beacons_in_range",
        ),
        ("/commands", "time_us command"),
        ("/decisions", "motion cleaners arm tones decisions"),
        ("/packets", "direction text"),
        (
            "/status",
            "state reason strategy inhibits job_s swept_m2 path_m bumps driver",
        ),
        (
            "/device",
            "versions battery main_loop_hz bytes_out_per_s bytes_in_per_s link wheel_left_m_per_s wheel_right_m_per_s bumpers \
             cliffs wheel_drops proximity currents_a cleaners dust_box docked",
        ),
    ];
    let schemas = schemas(&recording());
    for (topic, names) in names {
        for name in names.split_whitespace() {
            let field = &schemas[topic]["properties"][name];
            assert!(!field.is_null(), "{topic} has no {name}");
        }
    }
}

fn schemas(bytes: &[u8]) -> BTreeMap<String, Value> {
    let summary = Summary::read(bytes).expect("reads").expect("has a summary");
    let channels = summary.channels.values();
    channels
        .map(|channel| {
            let schema = channel.schema.as_ref().expect("has a schema");
            let schema = serde_json::from_slice(&schema.data).expect("schemas are JSON");
            (channel.topic.clone(), schema)
        })
        .collect()
}

/// As much of JSON Schema as ours use. Stricter in one point: a key that the schema does not name is wrong, and less
/// strict in another: `null` stands for what is not there.
fn check(schema: &Value, value: &Value) -> Result<(), String> {
    if value.is_null() {
        return Ok(());
    }
    if let Some(choices) = schema["oneOf"].as_array() {
        let fits = choices.iter().any(|choice| choice["const"] == *value);
        return fits
            .then_some(())
            .ok_or(format!("{value} is none of the choices"));
    }
    let fits = match schema["type"].as_str() {
        None => true,
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("boolean") => value.is_boolean(),
        Some("integer") => value.is_i64() || value.is_u64(),
        Some("number") => value.is_number(),
        Some(other) => return Err(format!("the schema says {other}")),
    };
    if !fits {
        return Err(format!("{value} is no {}", schema["type"]));
    }
    if let (Some(properties), Some(members)) = (schema["properties"].as_object(), value.as_object()) {
        for (key, member) in members {
            let schema = properties.get(key).ok_or(format!("no schema for {key}"))?;
            check(schema, member).map_err(|wrong| format!("{key}: {wrong}"))?;
        }
    }
    if let (Some(items), Some(members)) = (schema.get("items"), value.as_array()) {
        members.iter().try_for_each(|member| check(items, member))?;
    }
    Ok(())
}

#[test]
fn the_robot_stands_where_the_pose_says() {
    let found = messages(&recording());
    let timestamp = json!({"sec": 259, "nsec": 975_123_000});
    let place = json!({"x": 1.25, "y": -0.333333, "z": 0.0});
    let turn = json!({"x": 0.0, "y": 0.0, "z": 0.479426, "w": 0.877583});
    let pose = json!({
        "timestamp": timestamp, "frame_id": "map", "pose": {"position": place, "orientation": turn},
    });
    assert_eq!(found["/pose"], [(259_975_123_000, pose)]);
    let transform = json!({
        "timestamp": timestamp, "parent_frame_id": "map", "child_frame_id": "robot",
        "translation": place, "rotation": turn,
    });
    assert_eq!(found["/tf"], [(259_975_123_000, transform)]);
    let [(time_ns, scene)] = found["/robot"].as_slice() else {
        panic!("once: {:?}", found["/robot"])
    };
    assert_eq!(*time_ns, BEGIN_US * 1000);
    let entity = &scene["entities"][0];
    assert_eq!(entity["frame_id"], "robot", "it moves with the transform");
    assert_eq!(entity["cylinders"][0]["size"]["x"], 2.0 * config().body.radius_m);
    let levels: Vec<&Value> = found["/log"].iter().map(|(_, line)| &line["level"]).collect();
    assert_eq!(levels, [1, 2, 3, 4], "DEBUG to ERROR in Foxglove's numbers");
}

#[test]
fn one_file_says_which_robot_it_was_and_what_came_of_the_run() {
    let bytes = recording();
    let summary = Summary::read(&bytes).expect("reads").expect("has a summary");
    let attached = |name: &str| {
        let mut indexes = summary.attachment_indexes.iter();
        let index = indexes.find(|index| index.name == name).expect("is attached");
        let attachment = mcap::read::attachment(&bytes, index).expect("is whole");
        assert_eq!(attachment.media_type, "application/json");
        attachment.data.into_owned()
    };
    let robot: RobotDescription = serde_json::from_slice(&attached("robot.json")).expect("a robot");
    assert_eq!(robot, start().robot);
    let run: RunRecord = serde_json::from_slice(&attached("run.json")).expect("a run");
    assert_eq!((run.run.number, run.run.text.as_str()), (4, "Finished."));
}

#[test]
fn a_track_has_places_and_readings_in_the_times_of_the_run_also_of_a_file_that_was_cut() {
    let bytes = recording();
    let whole = track([part(8.0, &bytes)]).expect("reads");
    assert!(!whole.truncated);
    let [TrackPose(t, x, y, heading)] = whole.poses[..] else {
        panic!("one pose: {:?}", whole.poses)
    };
    assert_eq!((t, x, y, heading), (251.975, 1.25, -0.333, 1.0));
    let reading = whole.readings[0];
    assert_eq!(
        (reading.t, reading.charge, reading.battery_a),
        (0.008, Some(0.5), Some(-1.0))
    );
    assert_eq!(reading.motors_a, Some([0.1, 0.2, 0.5]));
    let cut = track([part(8.0, &bytes[..bytes.len() - 100])]).expect("reads");
    assert!(cut.truncated);
    assert_eq!(cut.poses, whole.poses);
}

fn part(zero_s: f64, file: &[u8]) -> Part<&[u8]> {
    let name = format!("run-{zero_s}.mcap");
    Part { name, zero_s, file }
}

/// The run began eight seconds after the first daemon. The second one went on from 260 s later; the first one lived on for a bit.
const ZERO_S: [f64; 2] = [8.0, -252.0];

#[test]
fn one_track_tells_of_two_recordings_what_the_run_knows() {
    let (first, second) = (recording(), recording());
    let both = track([part(ZERO_S[0], &first), part(ZERO_S[1], &second)]).expect("reads");
    assert_eq!(both.begins_s, [0.008, 260.008]);
    let times: Vec<f32> = both.poses.iter().map(|pose| pose.0).collect();
    assert_eq!(times, [251.975, 511.975]);
    let times: Vec<f32> = both.readings.iter().map(|reading| reading.t).collect();
    assert_eq!(times, [0.008, 260.008]);
    // A daemon that went on from before that pose knows nothing of it.
    let late = track([part(8.0, &first), part(-200.0, &second)]).expect("reads");
    assert_eq!(late.begins_s, [0.008, 208.008]);
    assert_eq!(late.poses.len(), 1, "{:?}", late.poses);
    assert_eq!(late.poses[0].0, 459.975);
}

/// Both recordings as one file.
fn whole(first: &[u8], second: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let parts = vec![part(ZERO_S[0], first), part(ZERO_S[1], second)];
    let mut whole = Whole::new(parts).expect("begins");
    whole.read_to_end(&mut bytes).expect("reads");
    bytes
}

#[test]
fn two_recordings_become_one_file_with_one_time_line() {
    let (first, second) = (recording(), recording());
    let bytes = whole(&first, &second);
    assert_eq!(bytes, whole(&first, &second), "the same bytes again");
    let (found, parts) = (messages(&bytes), messages(&first));
    for (topic, alone) in &parts {
        let (one, other) = found[topic].split_at(alone.len());
        assert_eq!(one, alone, "{topic} of the first part is as it was");
        let moved_ns = 260_000_000_000;
        let times: Vec<u64> = alone.iter().map(|(time_ns, _)| time_ns + moved_ns).collect();
        let told: Vec<u64> = other.iter().map(|(time_ns, _)| *time_ns).collect();
        assert_eq!(told, times, "{topic} of the second part comes later");
    }
    let (_, pose) = &found["/pose"][1];
    assert_eq!(
        pose["timestamp"],
        json!({"sec": 519, "nsec": 975_123_000}),
        "what Foxglove draws comes later, too"
    );
    assert_eq!(pose["pose"], found["/pose"][0].1["pose"]);
    let (_, scene) = &found["/robot"][1];
    assert_eq!(
        scene["entities"][0]["timestamp"],
        json!({"sec": 268, "nsec": 8_291_000})
    );
    assert_eq!(
        found["/observations"][0].1, found["/observations"][2].1,
        "what the brain saw stays as it was"
    );
}

#[test]
fn the_index_of_one_file_knows_both_parts() {
    let bytes = whole(&recording(), &recording());
    let summary = Summary::read(&bytes).expect("reads").expect("has a summary");
    let count = summary.stats.as_ref().expect("has statistics").message_count;
    let all: usize = messages(&bytes).values().map(Vec::len).sum();
    assert_eq!(count as usize, all);
    let told = ["robot.json", "run.json"].map(|name| {
        let indexes = summary.attachment_indexes.iter();
        indexes.filter(|index| index.name == name).count()
    });
    assert_eq!(told, [2, 2]);
    let mut indexes = summary.metadata_indexes.iter();
    let index = indexes.rfind(|index| index.name == "part").expect("is told");
    let part = mcap::read::metadata(&bytes, index).expect("is whole").metadata;
    assert_eq!(part["file"], "run--252.mcap");
    assert_eq!(part["moved_ns"], "260000000000");
}

#[test]
fn a_part_that_was_cut_keeps_what_it_has_and_the_next_one_comes_after_it() {
    let (first, second) = (recording(), recording());
    let cut = &first[..first.len() - 100];
    let mut bytes = Vec::new();
    // The second daemon went on from the begin.
    let parts = vec![part(8.0, cut), part(8.0, &second), part(0.0, b"damaged")];
    let mut joined = Whole::new(parts).expect("begins");
    joined.read_to_end(&mut bytes).expect("reads");
    let found = messages(&bytes);
    let count: usize = messages(&second).values().map(Vec::len).sum();
    assert_eq!(found.values().map(Vec::len).sum::<usize>(), 2 * count);
    let newest = found.values().map(|all| all[all.len() / 2 - 1].0).max();
    assert_eq!(found["/run"][1].0, newest.expect("has messages") + 1_000_000);
}

/// Each beginning has a whole home with it: whoever starts and stops without end must not fill the memory while the disk is slow.
#[test]
fn runs_that_begin_faster_than_the_disk_takes_them_are_not_recorded() {
    let scratch = Scratch::new().expect("creates");
    let limits = LibraryLimits {
        files_max: 50,
        bytes_max: 1 << 20,
    };
    let library = Library::open(&scratch.join("runs"), limits).expect("opens");
    let (opened, names) = std::sync::mpsc::channel();
    let (go_on, may_go_on) = std::sync::mpsc::channel::<()>();
    let tell = move |run, _name| {
        opened.send(run).expect("the test listens");
        // The first time it waits until all are sent; later nobody sends any more.
        may_go_on.recv().ok();
    };
    let mut recorder = vthal::recording::start(library, String::new(), tell).expect("starts");
    for run in 1..=100 {
        recorder.send(Record::RunStarted(Box::new(RunStart { run, ..start() })));
        recorder.send(Record::RunEnded {
            time_us: BEGIN_US,
            end: RunEnd::Finished,
        });
        if run == 1 {
            assert_eq!(names.recv(), Ok(1));
        }
    }
    drop(go_on);
    recorder.finish();
    assert_eq!(names.try_iter().collect::<Vec<u32>>(), [2]);
}
