//! Every message as the socket carries it.
//!
//! A red test here means that clients in the field would misread the daemon: take the change back, or raise `API_VERSION` and keep
//! the old form readable. New messages and new optional keys get new lines.

#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

use rvac_api::{
    BatteryReading, BumpMark, CalibrationAnswer, CalibrationAsk, CalibrationPage, CalibrationValue,
    CarpetView, CleaningPattern, CleaningPower, ClientInput, ComponentHealth, DaemonLoad, Decision,
    DeviceTable, DoorView, EnergyLearnt, Estimate, Evidence, EvidenceSample, Failure, FloorQuestion,
    FloorView, FloorsView, Gesture, GyroLearnt, HomeView, InQuiet, JobEstimate, JobOrder, JobPart, KeptMap,
    LearntPart, LearntView, LinkReading, LogEntry, LogLevel, MapDelta, MapDoubt, MapSnapshot, NoGoShape,
    NoGoView, PartCare, PartHours, PlaceShape, PlaceView, PlannedPath, PlannedRun, Pose, QuietHours, Request,
    RequestBody, RobotDescription, RoomChangeView, RoomHere, RoomNaming, RoomSettings, RoomSplitting,
    RoomView, Run, RunAsker, RunJob, RunPicture, RunRecord, RunRecording, RunResult, RunStop, RunTrack,
    ScheduleDecision, ScheduleEntry, ScheduleTime, ScheduleView, ScheduledJob, Schedules, SimulatedPlan,
    SimulatedTruth, SoftwareUpdate, Standstill, Statistics, Status, SurenessView, Topic, TrackPose,
    TrackReading, Update, UpdateEnd, UpdateStage, Versions, WallView, Weekday, is_mix_name,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;

#[track_caller]
fn check<T: Serialize + DeserializeOwned + PartialEq + Debug>(message: &T, golden: &str) {
    assert_eq!(serde_json::to_string(message).unwrap(), golden);
    assert_eq!(&serde_json::from_str::<T>(golden).unwrap(), message);
}

#[track_caller]
fn request(body: RequestBody, golden: &str) {
    check(&Request { id: None, body }, golden);
}

#[test]
fn requests_about_buttons() {
    request(
        RequestBody::ClaimButtons { ms: 120_000 },
        r#"{"c":"claim-buttons","ms":120000}"#,
    );
}

#[test]
fn a_request_for_the_line() {
    request(
        RequestBody::BorrowLink { silent: true },
        r#"{"c":"borrow-link","silent":true}"#,
    );
}

#[test]
fn inputs_of_clients() {
    request(
        RequestBody::SetInputs {
            values: [("steer".to_owned(), 0.5), ("go".to_owned(), -1.0)].into(),
            ttl: 300,
        },
        r#"{"c":"set-inputs","values":{"go":-1.0,"steer":0.5},"ttl":300}"#,
    );
    check(
        &Update::Inputs {
            inputs: vec![ClientInput {
                name: "steer".to_owned(),
                value: 0.5,
                left_ms: 300,
            }],
        },
        r#"{"e":"inputs","inputs":[{"name":"steer","value":0.5,"left_ms":300}]}"#,
    );
}

#[test]
fn names_in_mixes_are_safe_as_file_names() {
    let longest = "x".repeat(32);
    for good in ["a", "Köök 2", "left-hand_1", longest.as_str()] {
        assert!(is_mix_name(good), "{good}");
    }
    let long = "x".repeat(33);
    for bad in ["", " a", "a ", "a/b", "..", "a.json", "a\n", "\"", long.as_str()] {
        assert!(!is_mix_name(bad), "{bad}");
    }
}

#[test]
fn topics() {
    let topics = vec![
        Topic::Status,
        Topic::Pose,
        Topic::Device,
        Topic::Map,
        Topic::Home,
        Topic::Estimate,
        Topic::PlannedPath,
        Topic::Decisions,
        Topic::Log,
        Topic::Packets,
        Topic::Schedules,
        Topic::Runs,
        Topic::Floors,
        Topic::Standstills,
        Topic::Buttons,
        Topic::Inputs,
    ];
    request(
        RequestBody::Watch { topics },
        r#"{"c":"watch","topics":["status","pose","device","map","home","estimate","way","decisions","log","packets","schedules","runs","floors","standstills","buttons","inputs"]}"#,
    );
}

#[test]
fn requests() {
    request(
        RequestBody::Hello {
            name: "panel".to_owned(),
        },
        r#"{"c":"hello","name":"panel"}"#,
    );
    request(RequestBody::Start { strategy: None }, r#"{"c":"start"}"#);
    request(
        RequestBody::Start {
            strategy: Some("bounce".to_owned()),
        },
        r#"{"c":"start","strategy":"bounce"}"#,
    );
    request(RequestBody::Maps { floor: None }, r#"{"c":"maps"}"#);
    request(
        RequestBody::RestoreMap {
            number: 12,
            floor: None,
        },
        r#"{"c":"restore-map","number":12}"#,
    );
    request(RequestBody::Spot, r#"{"c":"spot"}"#);
    request(RequestBody::Pause, r#"{"c":"pause"}"#);
    request(RequestBody::Resume, r#"{"c":"resume"}"#);
    request(RequestBody::Stop, r#"{"c":"stop"}"#);
    request(RequestBody::Dock, r#"{"c":"dock"}"#);
    request(RequestBody::Release, r#"{"c":"release"}"#);
    request(RequestBody::Locate, r#"{"c":"locate"}"#);
    request(
        RequestBody::Clear {
            reason: "wheel-stall".to_owned(),
        },
        r#"{"c":"clear","reason":"wheel-stall"}"#,
    );
    request(
        RequestBody::Raw {
            packet: "{}".to_owned(),
        },
        r#"{"c":"raw","packet":"{}"}"#,
    );
    check(
        &Request {
            id: Some(7),
            body: RequestBody::Stop,
        },
        r#"{"id":7,"c":"stop"}"#,
    );
}

#[test]
fn requests_of_floors() {
    request(RequestBody::Maps { floor: Some(2) }, r#"{"c":"maps","floor":2}"#);
    request(
        RequestBody::RestoreMap {
            number: 12,
            floor: Some(2),
        },
        r#"{"c":"restore-map","number":12,"floor":2}"#,
    );
    request(
        RequestBody::ChooseFloor { floor: 2 },
        r#"{"c":"choose-floor","floor":2}"#,
    );
    request(RequestBody::NewFloor { name: None }, r#"{"c":"new-floor"}"#);
    request(
        RequestBody::NewFloor {
            name: Some("Attic".to_owned()),
        },
        r#"{"c":"new-floor","name":"Attic"}"#,
    );
    request(
        RequestBody::NameFloor {
            floor: 2,
            name: Some("Attic".to_owned()),
        },
        r#"{"c":"name-floor","floor":2,"name":"Attic"}"#,
    );
    request(
        RequestBody::RemoveFloor { floor: 2 },
        r#"{"c":"remove-floor","floor":2}"#,
    );
    request(
        RequestBody::RestoreFloor { floor: 2 },
        r#"{"c":"restore-floor","floor":2}"#,
    );
    request(
        RequestBody::ExportFloors { floor: None, from: 0 },
        r#"{"c":"export-floors","from":0}"#,
    );
    request(
        RequestBody::ExportFloors {
            floor: Some(2),
            from: 49_152,
        },
        r#"{"c":"export-floors","floor":2,"from":49152}"#,
    );
    request(
        RequestBody::ImportFloors {
            from: 0,
            size: 3,
            data: "AAEC".to_owned(),
        },
        r#"{"c":"import-floors","from":0,"size":3,"data":"AAEC"}"#,
    );
}

#[test]
fn floors() {
    let floors = FloorsView {
        floors: vec![
            FloorView {
                number: 1,
                name: Some("Ground".to_owned()),
                area_m2: 41.5,
                rooms: 3,
                has_dock: true,
                removed: false,
            },
            FloorView {
                number: 2,
                removed: true,
                ..FloorView::default()
            },
        ],
        here: Some(1),
        sought: false,
        question: None,
    };
    check(
        &Update::Floors(floors),
        r#"{"e":"floors","floors":[{"number":1,"name":"Ground","area_m2":41.5,"rooms":3,"has_dock":true},{"number":2,"area_m2":0.0,"rooms":0,"has_dock":false,"removed":true}],"here":1,"sought":false}"#,
    );
    let asks = FloorsView {
        sought: true,
        question: Some(FloorQuestion {
            reason: "which-dock".to_owned(),
            text: "Choose.".to_owned(),
        }),
        ..FloorsView::default()
    };
    check(
        &Update::Floors(asks),
        r#"{"e":"floors","floors":[],"sought":true,"question":{"reason":"which-dock","text":"Choose."}}"#,
    );
    let piece = Update::FloorArchive {
        from: 0,
        size: 3,
        check: 7,
        data: "AAEC".to_owned(),
    };
    check(
        &piece,
        r#"{"e":"floor-archive","from":0,"size":3,"check":7,"data":"AAEC"}"#,
    );
}

#[test]
fn requests_to_drive_and_of_mixes() {
    let drive = RequestBody::Drive {
        v: 0.1,
        w: -0.5,
        ttl: 250,
        clean: true,
        power: None,
    };
    request(drive, r#"{"c":"drive","v":0.1,"w":-0.5,"ttl":250,"clean":true}"#);
    request(
        RequestBody::Drive {
            v: 0.0,
            w: 0.0,
            ttl: 250,
            clean: false,
            power: Some(CleaningPower {
                suction: 0.5,
                main_brush: 0.0,
                side_brushes: 1.0,
            }),
        },
        r#"{"c":"drive","v":0.0,"w":0.0,"ttl":250,"clean":false,"power":{"suction":0.5,"main_brush":0.0,"side_brushes":1.0}}"#,
    );
    request(RequestBody::Mixes, r#"{"c":"mixes"}"#);
    request(
        RequestBody::SaveMix {
            profile: r#"{"version":1}"#.to_owned(),
            was: None,
        },
        r#"{"c":"save-mix","profile":"{\"version\":1}"}"#,
    );
    request(
        RequestBody::RemoveMix {
            name: "Anna".to_owned(),
        },
        r#"{"c":"remove-mix","name":"Anna"}"#,
    );
}

#[test]
fn what_may_be_left_out_and_what_may_not() {
    let read = |text: &str| serde_json::from_str::<Request>(text);
    let drive = RequestBody::Drive {
        v: 0.0,
        w: 0.0,
        ttl: 100,
        clean: false,
        power: None,
    };
    assert_eq!(
        read(r#"{"c":"drive","v":0,"w":0,"ttl":100}"#).unwrap().body,
        drive
    );
    assert_eq!(
        read(r#"{"c":"stop","since":"tomorrow"}"#).unwrap().body,
        RequestBody::Stop
    );
    for text in [
        "",
        "{}",
        "7",
        r#"{"c":"fly"}"#,
        r#"{"c":"drive","v":0,"w":0}"#,
        r#"{"c":"drive","v":0,"w":0,"ttl":70000}"#,
    ] {
        assert!(read(text).is_err(), "{text}");
    }
}

fn versions() -> Versions {
    Versions {
        vthal: "0.1.0".to_owned(),
        brain: "0.2.0".to_owned(),
        firmware: Some("0.3.0".to_owned()),
        cordlib: Some("0.4.0".to_owned()),
        protocol: Some(1),
    }
}

const VERSIONS: &str =
    r#"{"vthal":"0.1.0","brain":"0.2.0","firmware":"0.3.0","cordlib":"0.4.0","protocol":1}"#;

#[test]
fn introductions_and_answers() {
    let robot = RobotDescription {
        device: "sr8730".to_owned(),
        radius_m: 0.175,
        swath_m: 0.3,
        speed_max_m_per_s: 0.35,
        turn_max_rad_per_s: 1.5,
        proximity: 7,
        parts: vec!["gyro".to_owned(), "dock".to_owned()],
        unguarded: Vec::new(),
        unmeasured: Vec::new(),
        lacking: Vec::new(),
    };
    let hello = Update::Hello {
        api: 1,
        versions: versions(),
        robot: Some(robot),
        strategies: vec!["bounce".to_owned()],
        expert: false,
    };
    let golden = format!(
        r#"{{"e":"hello","api":1,"versions":{VERSIONS},"robot":{{"device":"sr8730","radius_m":0.175,"swath_m":0.3,"speed_max_m_per_s":0.35,"turn_max_rad_per_s":1.5,"proximity":7,"parts":["gyro","dock"]}},"strategies":["bounce"],"expert":false}}"#
    );
    check(&hello, &golden);
    check(&Update::Done { id: 3 }, r#"{"e":"done","id":3}"#);
    let failure = Failure {
        id: Some(3),
        reason: "no-robot".to_owned(),
        text: "No robot.".to_owned(),
    };
    check(
        &Update::Failed(failure.clone()),
        r#"{"e":"failed","id":3,"reason":"no-robot","text":"No robot."}"#,
    );
    check(
        &Update::Failed(Failure { id: None, ..failure }),
        r#"{"e":"failed","reason":"no-robot","text":"No robot."}"#,
    );
    let packet = Update::Packet {
        t: 1.5,
        direction: '>',
        text: "{}".to_owned(),
    };
    check(&packet, r#"{"e":"packet","t":1.5,"direction":">","text":"{}"}"#);
}

#[test]
fn what_the_robot_does() {
    let status = Status {
        state: "cleaning".to_owned(),
        reason: "command".to_owned(),
        strategy: Some("bounce".to_owned()),
        inhibits: vec!["bumper".to_owned()],
        job_s: 12.5,
        swept_m2: 3.25,
        path_m: 4.5,
        bumps: 2,
        driver: None,
        room: None,
    };
    let named = Status {
        room: Some(RoomHere {
            id: 2,
            name: Some("Kitchen".to_owned()),
        }),
        ..status.clone()
    };
    check(
        &Update::Status(named),
        r#"{"e":"status","state":"cleaning","reason":"command","strategy":"bounce","inhibits":["bumper"],"job_s":12.5,"swept_m2":3.25,"path_m":4.5,"bumps":2,"driver":null,"room":{"id":2,"name":"Kitchen"}}"#,
    );
    check(
        &Update::Status(status),
        r#"{"e":"status","state":"cleaning","reason":"command","strategy":"bounce","inhibits":["bumper"],"job_s":12.5,"swept_m2":3.25,"path_m":4.5,"bumps":2,"driver":null}"#,
    );
    let pose = Pose {
        x: 0.5,
        y: -1.25,
        heading: 3.0,
        t: 7.5,
    };
    check(
        &Update::Pose(pose),
        r#"{"e":"pose","x":0.5,"y":-1.25,"heading":3.0,"t":7.5}"#,
    );
    let entry = LogEntry {
        number: 9,
        t: 1.5,
        level: LogLevel::Warn,
        part: "link".to_owned(),
        text: "<b>".to_owned(),
    };
    check(
        &Update::Log(entry),
        r#"{"e":"log","number":9,"t":1.5,"level":"warn","part":"link","text":"<b>"}"#,
    );
}

#[test]
fn the_map() {
    let bumps = vec![BumpMark {
        x: 1.5,
        y: 2.0,
        contact: true,
    }];
    let snapshot = MapSnapshot {
        map: 2,
        cell_m: 0.05,
        swept: vec![0, -1],
        swept_sigma: vec![1, 12],
        path_mm: vec![10, 20],
        bumps: bumps.clone(),
    };
    check(
        &Update::Map(snapshot),
        r#"{"e":"map","map":2,"cell_m":0.05,"swept":[0,-1],"swept_sigma":[1,12],"path_mm":[10,20],"bumps":[{"x":1.5,"y":2.0,"contact":true}]}"#,
    );
    let delta = MapDelta {
        map: 2,
        swept: vec![1, 1],
        swept_sigma: vec![],
        path_mm: vec![],
        bumps,
    };
    check(
        &Update::MapDelta(delta),
        r#"{"e":"map-delta","map":2,"swept":[1,1],"path_mm":[],"bumps":[{"x":1.5,"y":2.0,"contact":true}]}"#,
    );
}

fn changes_of_two_rooms() -> Vec<RoomChangeView> {
    vec![
        RoomChangeView {
            number: 1,
            rooms: [1, 5],
            line: Some([[0.0, 1.0], [2.5, 1.0]]),
        },
        RoomChangeView {
            number: 3,
            rooms: [1, 4],
            line: None,
        },
    ]
}

#[test]
fn the_home() {
    let home = HomeView {
        revision: 7,
        cell_m: 0.5,
        x: -2,
        y: 3,
        width: 2,
        height: 1,
        cells: vec![1, 1, 2, 1],
        room_cells: vec![1, 1, 0, 1],
        rooms: vec![RoomView {
            id: 1,
            area_m2: 12.5,
            x: 1.0,
            y: 2.0,
            name: None,
            settings: None,
        }],
        doors: vec![DoorView {
            rooms: [1, 2],
            x: 3.0,
            y: 4.0,
            width_m: 0.75,
        }],
        walls: vec![WallView {
            from: [0.0, 1.0],
            to: [2.0, 1.0],
            sigma_m: 0.25,
        }],
        dock: None,
        dock_reported: false,
        no_go: vec![],
        places: vec![],
        room_changes: vec![],
        sureness: vec![],
        carpet: None,
    };
    check(
        &Update::Home(home.clone()),
        r#"{"e":"home","revision":7,"cell_m":0.5,"x":-2,"y":3,"width":2,"height":1,"cells":[1,1,2,1],"room_cells":[1,1,0,1],"rooms":[{"id":1,"area_m2":12.5,"x":1.0,"y":2.0}],"doors":[{"rooms":[1,2],"x":3.0,"y":4.0,"width_m":0.75}],"walls":[{"from":[0.0,1.0],"to":[2.0,1.0],"sigma_m":0.25}]}"#,
    );
    what_people_say_of_it(home);
}

fn what_people_say_of_it(home: HomeView) {
    let told = HomeView {
        rooms: vec![RoomView {
            name: Some("Kitchen".to_owned()),
            ..home.rooms[0].clone()
        }],
        doors: vec![],
        walls: vec![],
        no_go: vec![
            NoGoView {
                number: 2,
                shape: NoGoShape::Wall([[0.0, 0.5], [1.0, 0.5]]),
                name: None,
            },
            NoGoView {
                number: 4,
                shape: NoGoShape::Zone(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]),
                name: Some("Cats".to_owned()),
            },
        ],
        places: vec![PlaceView {
            number: 3,
            name: "Bowl".to_owned(),
            shape: PlaceShape::Spot([2.5, -0.5]),
        }],
        room_changes: changes_of_two_rooms(),
        sureness: vec![
            SurenessView {
                room: None,
                sigma_m: 0.25,
                driven: 0.5,
                touched: 0.75,
            },
            SurenessView {
                room: Some(1),
                ..SurenessView::default()
            },
        ],
        carpet: Some(CarpetView {
            area_m2: 0.25,
            hard_m2: 0.5,
            cells: vec![2, 1, 0, 1],
        }),
        ..home
    };
    check(
        &Update::Home(told),
        r#"{"e":"home","revision":7,"cell_m":0.5,"x":-2,"y":3,"width":2,"height":1,"cells":[1,1,2,1],"room_cells":[1,1,0,1],"rooms":[{"id":1,"area_m2":12.5,"x":1.0,"y":2.0,"name":"Kitchen"}],"doors":[],"walls":[],"no_go":[{"number":2,"shape":{"wall":[[0.0,0.5],[1.0,0.5]]}},{"number":4,"shape":{"zone":[[0.0,0.0],[1.0,0.0],[1.0,1.0]]},"name":"Cats"}],"places":[{"number":3,"name":"Bowl","shape":{"spot":[2.5,-0.5]}}],"room_changes":[{"number":1,"rooms":[1,5],"line":[[0.0,1.0],[2.5,1.0]]},{"number":3,"rooms":[1,4]}],"sureness":[{"sigma_m":0.25,"driven":0.5,"touched":0.75},{"room":1,"sigma_m":0.0,"driven":0.0,"touched":0.0}],"carpet":{"area_m2":0.25,"hard_m2":0.5,"cells":[2,1,0,1]}}"#,
    );
}

#[test]
fn settings_of_rooms() {
    let set = |settings| RequestBody::SetRoom {
        room: 3,
        settings,
        was: None,
    };
    let settings = RoomSettings {
        passes: 2,
        power: CleaningPower {
            suction: 0.5,
            main_brush: 1.0,
            side_brushes: 0.0,
        },
        pattern: CleaningPattern::Lines,
    };
    let contour = RoomSettings {
        pattern: CleaningPattern::Contour,
        ..settings
    };
    request(
        set(Some(contour)),
        r#"{"c":"set-room","room":3,"settings":{"passes":2,"power":{"suction":0.5,"main_brush":1.0,"side_brushes":0.0},"pattern":"contour"}}"#,
    );
    request(
        set(Some(settings)),
        r#"{"c":"set-room","room":3,"settings":{"passes":2,"power":{"suction":0.5,"main_brush":1.0,"side_brushes":0.0}}}"#,
    );
    request(set(None), r#"{"c":"set-room","room":3}"#);
    let short: Request =
        serde_json::from_str(r#"{"c":"set-room","room":3,"settings":{"passes":3}}"#).unwrap();
    let passes = |passes| RoomSettings {
        passes,
        ..RoomSettings::default()
    };
    assert_eq!(short.body, set(Some(passes(3))));
    let view = RoomView {
        id: 3,
        area_m2: 1.5,
        x: 0.5,
        y: 2.0,
        name: None,
        settings: Some(passes(1)),
    };
    assert_eq!(
        serde_json::to_string(&view).unwrap(),
        r#"{"id":3,"area_m2":1.5,"x":0.5,"y":2.0,"settings":{"passes":1,"power":{"suction":1.0,"main_brush":1.0,"side_brushes":1.0}}}"#
    );
}

#[test]
fn changes_of_rooms() {
    let splitting = |room| {
        RequestBody::SplitRoom(RoomSplitting {
            room,
            line: [[0.0, 0.5], [1.0, 0.5]],
        })
    };
    request(
        splitting(Some(3)),
        r#"{"c":"split-room","room":3,"line":[[0.0,0.5],[1.0,0.5]]}"#,
    );
    request(
        splitting(None),
        r#"{"c":"split-room","line":[[0.0,0.5],[1.0,0.5]]}"#,
    );
    request(
        RequestBody::JoinRooms { rooms: [3, 1] },
        r#"{"c":"join-rooms","rooms":[3,1]}"#,
    );
    request(
        RequestBody::UndoRoomChange { number: 2 },
        r#"{"c":"undo-room-change","number":2}"#,
    );
    request(
        RequestBody::MoveDock {
            x: 1.5,
            y: -0.25,
            heading: 1.0,
        },
        r#"{"c":"move-dock","x":1.5,"y":-0.25,"heading":1.0}"#,
    );
}

#[test]
fn orders_with_settings() {
    let quiet = JobOrder {
        power: Some(CleaningPower::QUIET),
        pattern: Some(CleaningPattern::Contour),
        ..JobOrder::default()
    };
    request(
        RequestBody::Clean(quiet),
        r#"{"c":"clean","parts":[],"passes":1,"power":{"suction":0.4,"main_brush":0.6,"side_brushes":0.6},"pattern":"contour"}"#,
    );
}

#[test]
fn orders() {
    let order = JobOrder {
        parts: vec![
            JobPart::Room(3),
            JobPart::Zone(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.5]]),
            JobPart::Spot([2.5, -0.5]),
        ],
        passes: 2,
        ..JobOrder::default()
    };
    let avoiding = JobOrder {
        avoid: vec![NoGoShape::Wall([[0.0, 0.5], [1.0, 0.5]])],
        ..order.clone()
    };
    request(
        RequestBody::Clean(avoiding),
        r#"{"c":"clean","parts":[{"room":3},{"zone":[[0.0,0.0],[1.0,0.0],[1.0,1.5]]},{"spot":[2.5,-0.5]}],"passes":2,"avoid":[{"wall":[[0.0,0.5],[1.0,0.5]]}]}"#,
    );
    request(
        RequestBody::Clean(order.clone()),
        r#"{"c":"clean","parts":[{"room":3},{"zone":[[0.0,0.0],[1.0,0.0],[1.0,1.5]]},{"spot":[2.5,-0.5]}],"passes":2}"#,
    );
    request(
        RequestBody::Estimate(order),
        r#"{"c":"estimate","parts":[{"room":3},{"zone":[[0.0,0.0],[1.0,0.0],[1.0,1.5]]},{"spot":[2.5,-0.5]}],"passes":2}"#,
    );
    let short: Request = serde_json::from_str(r#"{"c":"clean","later":1,"id":4}"#).unwrap();
    assert_eq!(short.body, RequestBody::Clean(JobOrder::default()));
    request(
        RequestBody::AddNoGo {
            shape: NoGoShape::Wall([[0.0, 0.5], [1.0, 0.5]]),
            name: None,
        },
        r#"{"c":"add-no-go","shape":{"wall":[[0.0,0.5],[1.0,0.5]]}}"#,
    );
    request(
        RequestBody::RemoveNoGo { number: 2 },
        r#"{"c":"remove-no-go","number":2}"#,
    );
    let naming = |name: Option<&str>| {
        RequestBody::NameRoom(RoomNaming {
            room: 3,
            name: name.map(str::to_owned),
        })
    };
    request(
        naming(Some("Kitchen")),
        r#"{"c":"name-room","room":3,"name":"Kitchen"}"#,
    );
    request(naming(None), r#"{"c":"name-room","room":3}"#);
    let estimate = JobEstimate {
        id: Some(4),
        floor_m2: 12.5,
        time_s: 900.0,
        charge: 0.25,
        recharges: 2,
        share: 0.975,
        share_low: 0.875,
    };
    check(
        &Update::JobEstimate(estimate),
        r#"{"e":"job-estimate","id":4,"floor_m2":12.5,"time_s":900.0,"charge":0.25,"recharges":2,"share":0.975,"share_low":0.875}"#,
    );
}

fn kept_maps() {
    let maps = vec![KeptMap {
        number: 2,
        kept_s: 1_700_000_000,
        area_m2: 12.5,
        rooms: 3,
        doubted: false,
        last_good: false,
    }];
    let marked = KeptMap {
        doubted: true,
        last_good: true,
        ..maps[0]
    };
    check(
        &Update::Maps { floor: Some(2), maps },
        r#"{"e":"maps","floor":2,"maps":[{"number":2,"kept_s":1700000000,"area_m2":12.5,"rooms":3}]}"#,
    );
    check(
        &Update::Maps {
            floor: None,
            maps: vec![marked],
        },
        r#"{"e":"maps","maps":[{"number":2,"kept_s":1700000000,"area_m2":12.5,"rooms":3,"doubted":true,"last_good":true}]}"#,
    );
}

#[test]
fn what_the_robot_thinks() {
    let estimate = Estimate {
        sigma_m: 0.5,
        sigma_rad: 0.25,
        lost: false,
        agreement: None,
        covered: Some(0.75),
        covered_low: Some(0.625),
        map_doubt: None,
    };
    check(
        &Update::Estimate(estimate),
        r#"{"e":"estimate","sigma_m":0.5,"sigma_rad":0.25,"lost":false,"covered":0.75,"covered_low":0.625}"#,
    );
    let doubting = Estimate {
        covered: None,
        covered_low: None,
        map_doubt: Some(MapDoubt::MappedNotMet),
        ..estimate
    };
    check(
        &Update::Estimate(doubting),
        r#"{"e":"estimate","sigma_m":0.5,"sigma_rad":0.25,"lost":false,"map_doubt":"mapped-not-met"}"#,
    );
    let way = PlannedPath {
        points_mm: vec![0, -100, 2500, 40],
        beyond_mm: 0,
    };
    let cut = PlannedPath {
        points_mm: vec![0, 0, 1200, 0],
        beyond_mm: 34_500,
    };
    check(
        &Update::PlannedPath(cut),
        r#"{"e":"way","points_mm":[0,0,1200,0],"beyond_mm":34500}"#,
    );
    check(
        &Update::PlannedPath(way),
        r#"{"e":"way","points_mm":[0,-100,2500,40]}"#,
    );
    let decision = Decision {
        number: 3,
        t: 1.5,
        what: "back-off".to_owned(),
        reason: "bump-left".to_owned(),
        value: 0.0,
        text: "Backed off.".to_owned(),
    };
    check(
        &Update::Decision(decision),
        r#"{"e":"decision","number":3,"t":1.5,"what":"back-off","reason":"bump-left","value":0.0,"text":"Backed off."}"#,
    );
    standstill();
    kept_maps();
    check(
        &Update::Mixes {
            mixes: vec!["{}".to_owned()],
        },
        r#"{"e":"mixes","mixes":["{}"]}"#,
    );
}

#[test]
fn the_device_table() {
    let battery = BatteryReading {
        charge: 0.5,
        voltage_v: 15.5,
        current_a: -1.5,
        temperature_c: Some(25.0),
        state: "discharging".to_owned(),
        charger: None,
    };
    let link = LinkReading {
        up: true,
        age_ms: 12,
        bad_share: 0.25,
        round_trip_ms: Some(2.5),
        resets: 1,
        reset_cause: Some("power-on".to_owned()),
        reconnects: 0,
        binary: true,
    };
    let table = DeviceTable {
        versions: versions(),
        battery: Some(battery),
        main_loop_hz: Some(1000),
        bytes_out_per_s: 100.0,
        bytes_in_per_s: 200.0,
        link,
        wheel_left_m_per_s: 0.25,
        wheel_right_m_per_s: 0.5,
        bumpers: [true, false],
        cliffs: [false, true, false],
        wheel_drops: [false, false],
        proximity: vec![0.5],
        currents_a: Some([0.25, 0.5, 0.75]),
        cleaners: [true, true, false],
        dust_box: Some(true),
        docked: false,
        daemon: Some(DaemonLoad {
            memory_bytes: Some(20_000_000),
            busy_s: 12.5,
            longest_turn_ms: 1.5,
        }),
    };
    let golden = format!(
        r#"{{"e":"device","versions":{VERSIONS},"battery":{{"charge":0.5,"voltage_v":15.5,"current_a":-1.5,"temperature_c":25.0,"state":"discharging"}},"main_loop_hz":1000,"bytes_out_per_s":100.0,"bytes_in_per_s":200.0,"link":{{"up":true,"age_ms":12,"bad_share":0.25,"round_trip_ms":2.5,"resets":1,"reset_cause":"power-on","reconnects":0,"binary":true}},"wheel_left_m_per_s":0.25,"wheel_right_m_per_s":0.5,"bumpers":[true,false],"cliffs":[false,true,false],"wheel_drops":[false,false],"proximity":[0.5],"currents_a":[0.25,0.5,0.75],"cleaners":[true,true,false],"dust_box":true,"docked":false,"daemon":{{"memory_bytes":20000000,"busy_s":12.5,"longest_turn_ms":1.5}}}}"#
    );
    check(&Update::Device(table), &golden);
}

#[test]
fn the_simulator() {
    let origin = Pose {
        x: -1.0,
        y: -2.0,
        heading: 0.0,
        t: 0.0,
    };
    let plan = SimulatedPlan {
        name: "Flat".to_owned(),
        cell_m: 0.05,
        width: 2,
        height: 1,
        origin,
        cells: vec![1, 2],
        dock: Some(origin),
    };
    check(
        &Update::SimulatedPlan(plan),
        r#"{"e":"simulated-plan","name":"Flat","cell_m":0.05,"width":2,"height":1,"origin":{"x":-1.0,"y":-2.0,"heading":0.0,"t":0.0},"cells":[1,2],"dock":{"x":-1.0,"y":-2.0,"heading":0.0,"t":0.0}}"#,
    );
    let truth = SimulatedTruth {
        pose: origin,
        covered: 0.5,
        violations: 0,
        sim_s: 9.5,
    };
    check(
        &Update::SimulatedTruth(truth),
        r#"{"e":"simulated-truth","pose":{"x":-1.0,"y":-2.0,"heading":0.0,"t":0.0},"covered":0.5,"violations":0,"sim_s":9.5}"#,
    );
}

#[test]
fn names_of_places() {
    request(
        RequestBody::NameNoGo {
            number: 2,
            name: Some("Cats".to_owned()),
        },
        r#"{"c":"name-no-go","number":2,"name":"Cats"}"#,
    );
    request(
        RequestBody::KeepPlace {
            name: "Table".to_owned(),
            shape: PlaceShape::Zone(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.5]]),
            number: None,
        },
        r#"{"c":"keep-place","name":"Table","shape":{"zone":[[0.0,0.0],[1.0,0.0],[1.0,1.5]]}}"#,
    );
    request(
        RequestBody::KeepPlace {
            name: "Bowl".to_owned(),
            shape: PlaceShape::Spot([2.5, -0.5]),
            number: Some(3),
        },
        r#"{"c":"keep-place","name":"Bowl","shape":{"spot":[2.5,-0.5]},"number":3}"#,
    );
    request(
        RequestBody::NamePlace {
            number: 3,
            name: "Dish".to_owned(),
        },
        r#"{"c":"name-place","number":3,"name":"Dish"}"#,
    );
    request(
        RequestBody::ReshapePlace {
            number: 3,
            shape: PlaceShape::Spot([2.0, -0.5]),
            was: None,
        },
        r#"{"c":"reshape-place","number":3,"shape":{"spot":[2.0,-0.5]}}"#,
    );
    request(
        RequestBody::ReshapeNoGo {
            number: 2,
            shape: NoGoShape::Wall([[0.0, 0.0], [1.5, 0.0]]),
            was: None,
        },
        r#"{"c":"reshape-no-go","number":2,"shape":{"wall":[[0.0,0.0],[1.5,0.0]]}}"#,
    );
    request(
        RequestBody::ForgetPlace { number: 3 },
        r#"{"c":"forget-place","number":3}"#,
    );
    let at_place = JobOrder {
        parts: vec![JobPart::Place(3)],
        ..JobOrder::default()
    };
    request(
        RequestBody::Clean(at_place),
        r#"{"c":"clean","parts":[{"place":3}],"passes":1}"#,
    );
}

fn weekday_entry() -> ScheduleEntry {
    ScheduleEntry {
        name: "Köök".to_owned(),
        enabled: true,
        job: ScheduledJob::Clean(JobOrder {
            parts: vec![JobPart::Room(4)],
            passes: 2,
            ..JobOrder::default()
        }),
        when: ScheduleTime::Weekly {
            days: vec![Weekday::Mo, Weekday::Su],
            at: "07:30".to_owned(),
        },
        late_min: 15,
        in_quiet: InQuiet::Wait,
        floor: None,
    }
}

#[test]
fn a_schedule_of_one_floor() {
    let upstairs = ScheduleEntry {
        floor: Some(2),
        ..weekday_entry()
    };
    request(
        RequestBody::AddSchedule(upstairs),
        r#"{"c":"add-schedule","name":"Köök","enabled":true,"job":{"clean":{"parts":[{"room":4}],"passes":2}},"when":{"weekly":{"days":["mo","su"],"at":"07:30"}},"late_min":15,"in_quiet":"wait","floor":2}"#,
    );
}

fn once_entry() -> ScheduleEntry {
    ScheduleEntry {
        name: "All".to_owned(),
        job: ScheduledJob::Start { strategy: None },
        when: ScheduleTime::Once {
            date: "2026-11-23".to_owned(),
            at: "09:00".to_owned(),
        },
        late_min: 0,
        in_quiet: InQuiet::Refuse,
        ..weekday_entry()
    }
}

#[test]
fn a_change_of_a_schedule_that_says_what_it_was() {
    let once = once_entry();
    request(
        RequestBody::ChangeSchedule {
            number: 3,
            entry: once.clone(),
            was: Some(Box::new(once.clone())),
        },
        r#"{"c":"change-schedule","number":3,"name":"All","enabled":true,"job":{"start":{}},"when":{"once":{"date":"2026-11-23","at":"09:00"}},"late_min":0,"in_quiet":"refuse","was":{"name":"All","enabled":true,"job":{"start":{}},"when":{"once":{"date":"2026-11-23","at":"09:00"}},"late_min":0,"in_quiet":"refuse"}}"#,
    );
}

#[test]
fn requests_of_schedules() {
    request(
        RequestBody::AddSchedule(weekday_entry()),
        r#"{"c":"add-schedule","name":"Köök","enabled":true,"job":{"clean":{"parts":[{"room":4}],"passes":2}},"when":{"weekly":{"days":["mo","su"],"at":"07:30"}},"late_min":15,"in_quiet":"wait"}"#,
    );
    let once = once_entry();
    request(
        RequestBody::ChangeSchedule {
            number: 3,
            entry: once.clone(),
            was: None,
        },
        r#"{"c":"change-schedule","number":3,"name":"All","enabled":true,"job":{"start":{}},"when":{"once":{"date":"2026-11-23","at":"09:00"}},"late_min":0,"in_quiet":"refuse"}"#,
    );
    let short = r#"{"c":"add-schedule","name":"All","job":{"start":{}},"when":{"once":{"date":"2026-11-23","at":"09:00"}}}"#;
    let read: Request = serde_json::from_str(short).unwrap();
    assert_eq!(read.body, RequestBody::AddSchedule(once));
    request(
        RequestBody::RemoveSchedule { number: 3 },
        r#"{"c":"remove-schedule","number":3}"#,
    );
    request(
        RequestBody::EnableSchedule {
            number: 3,
            enabled: false,
        },
        r#"{"c":"enable-schedule","number":3,"enabled":false}"#,
    );
    request(
        RequestBody::SkipNext {
            number: 3,
            skip: true,
        },
        r#"{"c":"skip-next","number":3,"skip":true}"#,
    );
    request(
        RequestBody::RunSchedule { number: 3 },
        r#"{"c":"run-schedule","number":3}"#,
    );
    let quiet = Some(QuietHours {
        from: "22:00".to_owned(),
        to: "07:00".to_owned(),
    });
    request(
        RequestBody::SetQuiet { quiet },
        r#"{"c":"set-quiet","quiet":{"from":"22:00","to":"07:00"}}"#,
    );
    request(RequestBody::SetQuiet { quiet: None }, r#"{"c":"set-quiet"}"#);
    request(
        RequestBody::SetZone {
            zone: Some("Europe/Tallinn".to_owned()),
        },
        r#"{"c":"set-zone","zone":"Europe/Tallinn"}"#,
    );
    request(RequestBody::SetZone { zone: None }, r#"{"c":"set-zone"}"#);
}

#[test]
fn all_schedules() {
    let run = PlannedRun {
        entry: 3,
        at: "2026-11-23T07:30:00+02:00".to_owned(),
        kept_by: Some("skipped".to_owned()),
        held_by: None,
    };
    let schedules = Schedules {
        zone: "Europe/Tallinn".to_owned(),
        zone_is_set: true,
        clock: Some("2026-11-22T16:30".to_owned()),
        quiet: None,
        entries: vec![ScheduleView {
            number: 3,
            entry: weekday_entry(),
            skip_next: true,
            next: vec![run.clone()],
            refused_now: Some("wheel-drop".to_owned()),
        }],
        next: vec![run],
        decisions: vec![ScheduleDecision {
            entry: 3,
            name: "Köök".to_owned(),
            date: "2026-11-22".to_owned(),
            at: "2026-11-22T07:30:00+02:00".to_owned(),
            outcome: "refused".to_owned(),
            reason: Some("job-runs".to_owned()),
        }],
    };
    check(
        &Update::Schedules(schedules),
        r#"{"e":"schedules","zone":"Europe/Tallinn","zone_is_set":true,"clock":"2026-11-22T16:30","entries":[{"number":3,"name":"Köök","enabled":true,"job":{"clean":{"parts":[{"room":4}],"passes":2}},"when":{"weekly":{"days":["mo","su"],"at":"07:30"}},"late_min":15,"in_quiet":"wait","skip_next":true,"next":[{"entry":3,"at":"2026-11-23T07:30:00+02:00","kept_by":"skipped"}],"refused_now":"wheel-drop"}],"next":[{"entry":3,"at":"2026-11-23T07:30:00+02:00","kept_by":"skipped"}],"decisions":[{"entry":3,"name":"Köök","date":"2026-11-22","at":"2026-11-22T07:30:00+02:00","outcome":"refused","reason":"job-runs"}]}"#,
    );
}

fn run() -> Run {
    Run {
        number: 7,
        job: RunJob::Clean {
            strategy: "systematic".to_owned(),
            rooms: vec![RoomHere { id: 2, name: None }],
            zones: 1,
            spots: 0,
            passes: 2,
        },
        by: RunAsker::Schedule {
            number: 3,
            name: "Morning".to_owned(),
        },
        start_s: Some(1_795_392_000),
        end_s: None,
        clock_set_s: None,
        duration_s: 3905.5,
        moving_s: 1800.0,
        swept_m2: 12.5,
        share: Some(0.75),
        path_m: 150.5,
        bumps: 12,
        charge_start: Some(0.875),
        charge_end: Some(0.5),
        result: RunResult::GaveUp,
        reason: "slip".to_owned(),
        text: "Gave up: its wheels slip.".to_owned(),
        stop_count: 1,
        floor: Some(2),
        map: Some(12),
        recordings: vec![RunRecording {
            name: "run-a.mcap".to_owned(),
            zero_s: -1.5,
            bytes: Some(9),
        }],
    }
}

const RUN: &str = r#""number":7,"job":{"clean":{"strategy":"systematic","rooms":[{"id":2}],"zones":1,"passes":2}},"by":{"schedule":{"number":3,"name":"Morning"}},"start_s":1795392000,"duration_s":3905.5,"moving_s":1800.0,"swept_m2":12.5,"share":0.75,"path_m":150.5,"bumps":12,"charge_start":0.875,"charge_end":0.5,"result":"gave-up","reason":"slip","text":"Gave up: its wheels slip.","stop_count":1,"floor":2,"map":12,"recordings":[{"name":"run-a.mcap","zero_s":-1.5,"bytes":9}]"#;

#[test]
fn runs() {
    request(
        RequestBody::Runs {
            before: None,
            count: None,
        },
        r#"{"c":"runs"}"#,
    );
    request(
        RequestBody::Runs {
            before: Some(7),
            count: Some(50),
        },
        r#"{"c":"runs","before":7,"count":50}"#,
    );
    request(RequestBody::Run { number: 7 }, r#"{"c":"run","number":7}"#);
    request(
        RequestBody::RunTrack {
            number: 7,
            recording: Some(0),
        },
        r#"{"c":"run-track","number":7,"recording":0}"#,
    );
    request(
        RequestBody::RunTrack {
            number: 7,
            recording: None,
        },
        r#"{"c":"run-track","number":7}"#,
    );
    request(
        RequestBody::RunFile {
            number: 7,
            recording: Some(1),
            from: 49_152,
        },
        r#"{"c":"run-file","number":7,"recording":1,"from":49152}"#,
    );
    request(
        RequestBody::RunFile {
            number: 7,
            recording: None,
            from: 0,
        },
        r#"{"c":"run-file","number":7,"from":0}"#,
    );
    check(
        &Update::Runs {
            runs: vec![run()],
            more: true,
        },
        &format!(r#"{{"e":"runs","runs":[{{{RUN}}}],"more":true}}"#),
    );
    check(
        &Update::RunKept(Box::new(run())),
        &format!(r#"{{"e":"run-kept",{RUN}}}"#),
    );
}

#[test]
fn the_track_of_a_run() {
    let track = RunTrack {
        number: 7,
        recording: None,
        begins_s: vec![0.0, 0.75],
        poses: vec![TrackPose(0.5, 1.0, -2.0, 0.25)],
        readings: vec![TrackReading {
            t: 1.0,
            charge: Some(0.5),
            battery_a: None,
            motors_a: Some([0.5, 0.25, 1.0]),
            bad_share: 0.0,
        }],
        truncated: true,
    };
    check(
        &Update::RunTrack(Box::new(track)),
        r#"{"e":"run-track","number":7,"begins_s":[0.0,0.75],"poses":[[0.5,1.0,-2.0,0.25]],"readings":[{"t":1.0,"charge":0.5,"motors_a":[0.5,0.25,1.0],"bad_share":0.0}],"truncated":true}"#,
    );
}

#[test]
fn a_run_in_full() {
    let stop = RunStop {
        at_s: 61.0,
        lasted_s: None,
        state: "paused".to_owned(),
        reason: "command".to_owned(),
        text: "Paused: it was requested.".to_owned(),
        remedy: String::new(),
        by: Some("panel".to_owned()),
        asker: Some(RunAsker::Client("panel".to_owned())),
        place: Pose {
            x: 1.0,
            y: -2.5,
            heading: 0.5,
            t: 64.0,
        },
        evidence: Evidence::default(),
    };
    let record = RunRecord {
        run: run(),
        stops: vec![stop],
        picture: Some(RunPicture {
            cell_m: 0.025,
            swept_rows: vec![0, -1, 6],
            path_mm: vec![0, 0, 100, 0],
            bumps: vec![],
            home: None,
        }),
    };
    check(
        &Update::Run(Box::new(record)),
        &format!(
            r#"{{"e":"run","run":{{{RUN}}},"stops":[{{"at_s":61.0,"state":"paused","reason":"command","text":"Paused: it was requested.","by":"panel","asker":{{"client":"panel"}},"place":{{"x":1.0,"y":-2.5,"heading":0.5,"t":64.0}}}}],"picture":{{"cell_m":0.025,"swept_rows":[0,-1,6],"path_mm":[0,0,100,0],"bumps":[]}}}}"#
        ),
    );
    check(
        &Update::RunFile {
            number: 7,
            name: "run-a.mcap".to_owned(),
            from: 0,
            size: Some(3),
            data: "AAEC".to_owned(),
        },
        r#"{"e":"run-file","number":7,"name":"run-a.mcap","from":0,"size":3,"data":"AAEC"}"#,
    );
    check(
        &Update::RunFile {
            number: 7,
            name: "run-a-whole.mcap".to_owned(),
            from: 3,
            size: None,
            data: String::new(),
        },
        r#"{"e":"run-file","number":7,"name":"run-a-whole.mcap","from":3,"data":""}"#,
    );
    check(&RunJob::Spot, r#""spot""#);
    check(&RunAsker::Button, r#""button""#);
    check(&RunAsker::Client("Anna".to_owned()), r#"{"client":"Anna"}"#);
    for (result, name) in [
        (RunResult::Finished, "finished"),
        (RunResult::Stopped, "stopped"),
        (RunResult::DaemonEnded, "daemon-ended"),
        (RunResult::CutShort, "cut-short"),
        (RunResult::OtherRobot, "other-robot"),
    ] {
        check(&result, &format!("\"{name}\""));
    }
}

#[test]
fn a_new_device() {
    for (gesture, word) in [
        (Gesture::Press, "press"),
        (Gesture::PairingHold, "pairing-hold"),
        (Gesture::RecoveryHold, "recovery-hold"),
    ] {
        check(
            &Update::Button {
                gesture,
                button: 0,
                t: 93.2,
            },
            &format!(r#"{{"e":"button","gesture":"{word}","button":0,"t":93.2}}"#),
        );
    }
    check(
        &Update::NewDevice {
            name: "Mari's phone".to_owned(),
            role: "drive".to_owned(),
            from: "192.168.1.7".to_owned(),
        },
        r#"{"e":"new-device","name":"Mari's phone","role":"drive","from":"192.168.1.7"}"#,
    );
}

#[test]
fn updates_of_the_software() {
    let receives = SoftwareUpdate {
        bytes: Some(512),
        total: Some(2048),
        ..SoftwareUpdate::at(UpdateStage::Receive)
    };
    let undone = SoftwareUpdate {
        epoch: Some(7),
        version: Some("0.7.0".to_owned()),
        flashes: Some(true),
        ..SoftwareUpdate::at(UpdateStage::TryFirmware)
    };
    let undone = undone.ended(
        UpdateEnd::WentBack,
        "update-silent-robot",
        "the robot does not answer",
    );
    let told = [
        (
            receives,
            r#"{"e":"software-update","stage":"receive","bytes":512,"total":2048}"#,
        ),
        (
            undone,
            r#"{"e":"software-update","stage":"try-firmware","epoch":7,"version":"0.7.0","flashes":true,"end":"went-back","failed":"try-firmware","reason":"update-silent-robot","text":"the robot does not answer"}"#,
        ),
    ];
    for (update, golden) in told {
        check(&Update::SoftwareUpdate(Box::new(update)), golden);
    }
}

#[test]
fn what_the_server_of_the_panel_adds_for_pages() {
    let beats = [
        (Some(40), r#"{"e":"heartbeat","silent_ms":40}"#),
        (None, r#"{"e":"heartbeat"}"#),
    ];
    for (silent_ms, text) in beats {
        check(&Update::Heartbeat { silent_ms }, text);
    }
    check(
        &Update::Piece {
            lane: 1,
            last: true,
            text: "0]}".to_owned(),
        },
        r#"{"e":"piece","lane":1,"last":true,"text":"0]}"}"#,
    );
}

fn standstill() {
    let felt = EvidenceSample {
        at_s: -0.2,
        v: 0.25,
        w: -0.1,
        signs: vec!["bumper-left".to_owned(), "not-moving".to_owned()],
        echo: Some(0.5),
        currents_a: Some([0.5, 0.25, 0.0]),
    };
    let evidence = Evidence {
        samples: vec![felt, EvidenceSample::default()],
        tried: Vec::new(),
    };
    check(
        &Update::Evidence {
            id: Some(4),
            evidence: evidence.clone(),
        },
        r#"{"e":"evidence","id":4,"felt":[{"at_s":-0.2,"v":0.25,"w":-0.1,"signs":["bumper-left","not-moving"],"echo":0.5,"currents_a":[0.5,0.25,0.0]},{"at_s":0.0,"v":0.0,"w":0.0}]}"#,
    );
    request(RequestBody::Evidence, r#"{"c":"evidence"}"#);
    let told = Standstill {
        number: 2,
        t: 61.5,
        state: "stuck".to_owned(),
        reason: "boxed-in".to_owned(),
        text: "Gave up.".to_owned(),
        remedy: "Move it.".to_owned(),
        place: Pose {
            t: 61.5,
            x: 1.0,
            y: 2.0,
            heading: 0.5,
        },
        lost: false,
        evidence: Evidence::default(),
    };
    check(
        &Update::Standstill(Box::new(told)),
        r#"{"e":"standstill","number":2,"t":61.5,"state":"stuck","reason":"boxed-in","text":"Gave up.","remedy":"Move it.","place":{"x":1.0,"y":2.0,"heading":0.5,"t":61.5}}"#,
    );
}

#[test]
fn a_calibration_by_steps() {
    request(RequestBody::Calibration, r#"{"c":"calibration"}"#);
    request(
        RequestBody::BeginCalibration {
            names: vec!["wheel-track".to_owned()],
        },
        r#"{"c":"begin-calibration","names":["wheel-track"]}"#,
    );
    for (answer, text) in [
        (
            CalibrationAnswer::Go,
            r#"{"c":"answer-calibration","page":3,"answer":"go"}"#,
        ),
        (
            CalibrationAnswer::Number(1900),
            r#"{"c":"answer-calibration","page":3,"answer":{"number":1900}}"#,
        ),
    ] {
        request(RequestBody::AnswerCalibration { page: 3, answer }, text);
    }
    request(
        RequestBody::HoldCalibration { held: true },
        r#"{"c":"hold-calibration","held":true}"#,
    );
    request(RequestBody::EndCalibration, r#"{"c":"end-calibration"}"#);
    check(
        &Update::Calibration {
            device: "sr8730".to_owned(),
            values: vec![CalibrationValue {
                name: "wheel-track".to_owned(),
                unit: "um".to_owned(),
                value: Some(230_000),
                assumed: None,
            }],
            file: String::new(),
        },
        r#"{"e":"calibration","device":"sr8730","values":[{"name":"wheel-track","unit":"um","value":230000}],"file":""}"#,
    );
    check(
        &Update::CalibrationPage(Box::new(CalibrationPage {
            page: 3,
            asks: Some(CalibrationAsk::Done),
            value: "wheel-track".to_owned(),
            unit: "um".to_owned(),
            number: 2,
            of: 6,
            task: Some("spin".to_owned()),
            counts: Some([812, -805]),
            ..CalibrationPage::default()
        })),
        r#"{"e":"calibration-page","page":3,"asks":"done","value":"wheel-track","unit":"um","number":2,"of":6,"task":"spin","counts":[812,-805],"over":false}"#,
    );
}

#[test]
fn what_robots_have_learnt() {
    let learnt = LearntView {
        device: "sr8730".to_owned(),
        here: true,
        gyro: Some(GyroLearnt {
            scale: 0.0125,
            scale_sigma: 0.001,
            bias_rad_per_s: -0.002,
        }),
        energy: Some(EnergyLearnt {
            cleaning_per_h: 0.875,
            driving_per_h: 0.25,
            seen_s: 1200.0,
        }),
        learnt_s: Some(1_800_000_000),
    };
    check(
        &Update::Learnt {
            id: Some(5),
            devices: vec![learnt],
        },
        r#"{"e":"learnt","id":5,"devices":[{"device":"sr8730","here":true,"gyro":{"scale":0.0125,"scale_sigma":0.001,"bias_rad_per_s":-0.002},"energy":{"cleaning_per_h":0.875,"driving_per_h":0.25,"seen_s":1200.0},"learnt_s":1800000000}]}"#,
    );
    request(RequestBody::Learnt, r#"{"c":"learnt"}"#);
    for (part, text) in [
        (None, r#"{"c":"forget-learnt","device":"sr8730"}"#),
        (
            Some(LearntPart::Gyro),
            r#"{"c":"forget-learnt","device":"sr8730","part":"gyro"}"#,
        ),
    ] {
        let device = "sr8730".to_owned();
        request(RequestBody::ForgetLearnt { device, part }, text);
    }
}

#[test]
fn wear_and_hours() {
    check(
        &Update::Health {
            id: Some(5),
            components: vec![ComponentHealth {
                component: "brush-main".to_owned(),
                verdict: "hard".to_owned(),
                minutes: 40,
                load_a: Some(0.625),
                usual_a: Some(0.5),
                share: Some(1.25),
                hours: Some(PartHours {
                    worked_h: 12.5,
                    usual_h: 300.0,
                    care: PartCare::Replace,
                    since_s: Some(1_800_000_000),
                    before_h: Some(310.0),
                }),
                text: "Clean it.".to_owned(),
            }],
        },
        r#"{"e":"health","id":5,"components":[{"component":"brush-main","verdict":"hard","minutes":40,"load_a":0.625,"usual_a":0.5,"share":1.25,"hours":{"worked_h":12.5,"usual_h":300.0,"care":"replace","since_s":1800000000,"before_h":310.0},"text":"Clean it."}]}"#,
    );
    request(RequestBody::Health, r#"{"c":"health"}"#);
    request(
        RequestBody::RenewPart {
            component: "filter".to_owned(),
        },
        r#"{"c":"renew-part","component":"filter"}"#,
    );
    request(
        RequestBody::UndoRenewPart {
            component: "filter".to_owned(),
        },
        r#"{"c":"undo-renew-part","component":"filter"}"#,
    );
    request(
        RequestBody::ResetHealth {
            component: "wheel-left".to_owned(),
        },
        r#"{"c":"reset-health","component":"wheel-left"}"#,
    );
}

#[test]
fn all_runs_together() {
    request(RequestBody::Statistics, r#"{"c":"statistics"}"#);
    let one = |name: &str| [(name.to_owned(), 1)].into();
    check(
        &Update::Statistics(Box::new(Statistics {
            since_s: Some(1_800_000_000),
            runs: one("clean"),
            results: one("finished"),
            stops: one("wheel-drop"),
            duration_h: 1.5,
            moving_h: 1.25,
            swept_m2: 30.5,
            path_km: 0.75,
            bumps: 12,
        })),
        r#"{"e":"statistics","since_s":1800000000,"runs":{"clean":1},"results":{"finished":1},"stops":{"wheel-drop":1},"duration_h":1.5,"moving_h":1.25,"swept_m2":30.5,"path_km":0.75,"bumps":12}"#,
    );
}
