//! Requests to a daemon, and what `rvac` makes of its answers.

use crate::folder::Folder;
use crate::program;
use std::ffi::OsStr;
use std::io::{Read as _, Write as _};
use std::os::unix::net::{UnixListener, UnixStream};
use std::process::Output;
use std::thread::JoinHandle;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rvac_api::{
    ARCHIVE_PIECE_BYTES, CleaningPattern, CleaningPower, Decision, DeviceTable, Estimate, Failure, FloorView,
    FloorsView, GyroLearnt, HomeView, InQuiet, JobEstimate, JobOrder, JobPart, KeptMap, LearntPart,
    LearntView, LinkReading, LogEntry, LogLevel, NoGoShape, PlaceShape, Pose, QuietHours, RUN_PIECE_BYTES,
    Request, RequestBody, RoomNaming, RoomSettings, RoomSplitting, RoomView, SEPARATOR, ScheduleEntry,
    ScheduleTime, ScheduleView, ScheduledJob, Schedules, Status, Topic, Update, Weekday,
};

/// A daemon that answers one client by a function until that client leaves, and returns what it was asked.
struct Daemon {
    folder: Folder,
    thread: JoinHandle<Vec<Request>>,
}

impl Daemon {
    fn start(answer: fn(&Request) -> Vec<Update>) -> Self {
        let folder = Folder::new();
        let listener = UnixListener::bind(folder.join("vthal.sock")).expect("a socket");
        let thread = std::thread::spawn(move || {
            let (stream, _) = listener.accept().expect("a client");
            serve(stream, answer)
        });
        Self { folder, thread }
    }

    /// Runs `rvac` with the arguments and gives its output and what the daemon was asked.
    fn rvac(self, arguments: &[&str], typed: &str) -> (Output, Vec<Request>) {
        let socket = self.folder.join("vthal.sock");
        let socket = [OsStr::new("--socket"), socket.as_os_str()];
        let arguments = arguments.iter().map(OsStr::new).chain(socket);
        let output = program::rvac(arguments, typed.as_bytes());
        let asked = self.thread.join().expect("the daemon lives");
        (output, asked)
    }
}

fn serve(mut stream: UnixStream, answer: fn(&Request) -> Vec<Update>) -> Vec<Request> {
    let (mut received, mut asked) = (Vec::new(), Vec::new());
    let mut chunk = [0; 1024];
    while let Ok(count) = stream.read(&mut chunk) {
        if count == 0 {
            break;
        }
        received.extend_from_slice(&chunk[..count]);
        while let Some(end) = received.iter().position(|byte| *byte == SEPARATOR) {
            let message: Vec<u8> = received.drain(..=end).collect();
            let request: Request = serde_json::from_slice(&message[..end]).expect("a request");
            for update in answer(&request) {
                let mut bytes = serde_json::to_vec(&update).expect("JSON");
                bytes.push(SEPARATOR);
                // A client that has received enough is gone.
                stream.write_all(&bytes).ok();
            }
            asked.push(request);
        }
    }
    asked
}

fn obedient(request: &Request) -> Vec<Update> {
    request.id.map(|id| Update::Done { id }).into_iter().collect()
}

fn busy(request: &Request) -> Vec<Update> {
    let failure = |id| Failure {
        id: Some(id),
        reason: "wheel-drop".to_owned(),
        text: "Put the robot down.".to_owned(),
    };
    request
        .id
        .map(|id| Update::Failed(failure(id)))
        .into_iter()
        .collect()
}

fn talkative(request: &Request) -> Vec<Update> {
    match &request.body {
        RequestBody::Watch { .. } => vec![
            Update::Pose(Pose {
                x: 1.5,
                y: -0.25,
                heading: 0.0,
                t: 1.0,
            }),
            Update::Log(LogEntry {
                number: 1,
                t: 2.0,
                level: LogLevel::Warn,
                part: "link".to_owned(),
                text: "two bad packets".to_owned(),
            }),
            Update::Status(Status {
                state: "cleaning".to_owned(),
                reason: "command".to_owned(),
                strategy: Some("bounce".to_owned()),
                job_s: 90.0,
                swept_m2: 4.2,
                ..Status::default()
            }),
            Update::Estimate(Estimate {
                sigma_m: 0.05,
                sigma_rad: 0.0175,
                agreement: Some(0.875),
                covered: Some(0.5),
                covered_low: Some(0.4375),
                ..Estimate::default()
            }),
            Update::Device(DeviceTable {
                link: LinkReading {
                    up: true,
                    ..LinkReading::default()
                },
                docked: true,
                ..DeviceTable::default()
            }),
        ],
        RequestBody::Raw { packet } => {
            vec![
                Update::Packet {
                    t: 3.25,
                    direction: '>',
                    text: packet.clone(),
                },
                Update::Done { id: 1 },
            ]
        }
        _ => Vec::new(),
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn every_request_goes_out_under_its_name_and_done_is_success() {
    let cases: [(&str, &[&str], RequestBody); 8] = [
        ("start", &["start"], RequestBody::Start { strategy: None }),
        (
            "bounce",
            &["start", "--strategy", "bounce"],
            RequestBody::Start {
                strategy: Some("bounce".to_owned()),
            },
        ),
        ("stop", &["stop"], RequestBody::Stop),
        ("pause", &["pause"], RequestBody::Pause),
        ("resume", &["resume"], RequestBody::Resume),
        ("dock", &["dock"], RequestBody::Dock),
        ("spot", &["spot"], RequestBody::Spot),
        ("locate", &["locate"], RequestBody::Locate),
    ];
    for (name, arguments, body) in cases {
        let (output, asked) = Daemon::start(obedient).rvac(arguments, "");
        assert!(output.status.success(), "{name}: {output:?}");
        assert_eq!(
            asked[0].body,
            RequestBody::Hello {
                name: "rvac".to_owned()
            }
        );
        assert_eq!(asked[1], Request { id: Some(1), body }, "{name}");
    }
}

#[test]
fn a_refusal_is_shown_with_its_reason_and_fails() {
    let (output, _) = Daemon::start(busy).rvac(&["start"], "");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(
        text(&output.stderr),
        "rvac: refused (wheel-drop): Put the robot down.\n"
    );
}

#[test]
fn status_is_shown_in_words_or_as_json() {
    let (output, _) = Daemon::start(talkative).rvac(&["status"], "");
    let words = text(&output.stdout);
    assert!(
        words.contains("cleaning (command), pattern bounce, 1.5 min, 4.2 m2 cleaned"),
        "{words}"
    );
    assert!(
        words.contains(
            "position known to 0.05 m, heading to 1 deg, sensors match the map: 88 %, \
             estimated coverage 50 % of the known floor (at least 44 %)"
        ),
        "{words}"
    );
    assert!(
        words.contains("link up") && words.contains("on the dock"),
        "{words}"
    );
    let (output, _) = Daemon::start(talkative).rvac(&["status", "--json"], "");
    let lines = text(&output.stdout);
    assert!(
        lines
            .lines()
            .all(|line| serde_json::from_str::<Update>(line).is_ok()),
        "{lines}"
    );
}

#[test]
fn watch_tells_what_happens_line_by_line() {
    let (output, _) = Daemon::start(talkative).rvac(&["watch", "--lines", "4"], "");
    let lines = text(&output.stdout);
    assert!(
        lines.contains("x 1.50 m, y -0.25 m") && lines.contains("Warn link: two bad packets"),
        "{lines}"
    );
    assert_eq!(lines.lines().count(), 4);
}

/// A daemon with a home of one room, two decisions and two kept maps.
fn at_home(request: &Request) -> Vec<Update> {
    let decision = |number: u32, text: &str| {
        Update::Decision(Decision {
            number: number.into(),
            t: f64::from(number),
            what: "back-off".to_owned(),
            reason: "bump-left".to_owned(),
            value: 0.0,
            text: text.to_owned(),
        })
    };
    let kept = |number: u32| KeptMap {
        number: number.into(),
        kept_s: 0,
        area_m2: f64::from(number),
        rooms: number,
        doubted: number == 12,
        last_good: number == 11,
    };
    match &request.body {
        RequestBody::Watch { .. } => vec![
            Update::Home(HomeView {
                cell_m: 1.0,
                width: 3,
                height: 2,
                cells: vec![2, 1, 1, 2, 2, 1, 1, 2],
                rooms: vec![RoomView {
                    id: 1,
                    area_m2: 4.0,
                    x: 1.5,
                    y: 1.5,
                    name: Some("Hall".to_owned()),
                    settings: None,
                }],
                ..HomeView::default()
            }),
            decision(
                1,
                "Backed off and turned away: its bumper touched something on the left.",
            ),
            decision(
                2,
                "Stood still for a moment: its gyro must be measured at rest now and then.",
            ),
            Update::Pose(Pose {
                x: 2.5,
                y: 0.5,
                heading: 0.0,
                t: 5.0,
            }),
            Update::Status(Status::default()),
        ],
        RequestBody::Maps { .. } => vec![Update::Maps {
            floor: Some(1),
            maps: vec![kept(12), kept(11)],
        }],
        RequestBody::Estimate(_) => vec![Update::JobEstimate(JobEstimate {
            id: request.id,
            floor_m2: 4.0,
            time_s: 300.0,
            charge: 0.25,
            recharges: 0,
            share: 0.98,
            share_low: 0.9,
        })],
        _ => obedient(request),
    }
}

#[test]
fn orders_for_rooms_and_zones_go_out_under_their_names() {
    let job = |parts, passes| JobOrder {
        parts,
        passes,
        ..JobOrder::default()
    };
    let rectangle = || vec![[-1.0, 0.0], [2.0, 0.0], [2.0, 1.5], [-1.0, 1.5]];
    let naming = |name: Option<&str>| {
        RequestBody::NameRoom(RoomNaming {
            room: 1,
            name: name.map(str::to_owned),
        })
    };
    let add = |shape| RequestBody::AddNoGo { shape, name: None };
    let cases: [(&[&str], RequestBody); 9] = [
        (&["clean"], RequestBody::Clean(job(vec![], 1))),
        (
            &[
                "clean", "--spot", "-0.5,2", "--room", "hall", "--zone", "-1,0", "2,1.5", "--passes", "2",
            ],
            RequestBody::Clean(job(
                vec![
                    JobPart::Room(1),
                    JobPart::Zone(rectangle()),
                    JobPart::Spot([-0.5, 2.0]),
                ],
                2,
            )),
        ),
        (&["rooms", "name", "1", "Entrance"], naming(Some("Entrance"))),
        (&["rooms", "unname", "Hall"], naming(None)),
        (
            &["zone", "add", "-1,0", "2,1.5"],
            add(NoGoShape::Zone(rectangle())),
        ),
        (
            &["zone", "add", "0,0", "1,0", "--corner", "0,-1"],
            add(NoGoShape::Zone(vec![[0.0, 0.0], [1.0, 0.0], [0.0, -1.0]])),
        ),
        (
            &["zone", "wall", "-1,0", "2,1.5"],
            add(NoGoShape::Wall([[-1.0, 0.0], [2.0, 1.5]])),
        ),
        (
            &["zone", "name", "4", "Cats"],
            RequestBody::NameNoGo {
                number: 4,
                name: Some("Cats".to_owned()),
            },
        ),
        (&["zone", "remove", "4"], RequestBody::RemoveNoGo { number: 4 }),
    ];
    go_out(cases);
}

#[test]
fn kept_places_go_out_under_their_numbers() {
    let job = |parts| JobOrder {
        parts,
        ..JobOrder::default()
    };
    let rectangle = || vec![[-1.0, 0.0], [2.0, 0.0], [2.0, 1.5], [-1.0, 1.5]];
    let cases: [(&[&str], RequestBody); 4] = [
        (
            &["clean", "--place", "4", "--room", "hall"],
            RequestBody::Clean(job(vec![JobPart::Room(1), JobPart::Place(4)])),
        ),
        (
            &["places", "keep", "Table", "--zone", "-1,0", "2,1.5"],
            RequestBody::KeepPlace {
                name: "Table".to_owned(),
                shape: PlaceShape::Zone(rectangle()),
                number: None,
            },
        ),
        (
            &["places", "keep", "Bowl", "--spot", "-0.5,2"],
            RequestBody::KeepPlace {
                name: "Bowl".to_owned(),
                shape: PlaceShape::Spot([-0.5, 2.0]),
                number: None,
            },
        ),
        (&["places", "forget", "4"], RequestBody::ForgetPlace { number: 4 }),
    ];
    go_out(cases);
}

/// Each command ends well, and its request is the last that the daemon receives.
fn go_out<'a>(cases: impl IntoIterator<Item = (&'a [&'a str], RequestBody)>) {
    for (arguments, body) in cases {
        let (output, asked) = Daemon::start(at_home).rvac(arguments, "");
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        let last = asked.last().expect("asks");
        assert_eq!(last, &Request { id: Some(1), body }, "{arguments:?}");
    }
}

#[test]
fn changes_of_rooms_go_out_under_their_names() {
    let cases: [(&[&str], RequestBody); 7] = [
        (
            &["room", "split", "Hall", "-1,0", "2,1.5"],
            RequestBody::SplitRoom(RoomSplitting {
                room: Some(1),
                line: [[-1.0, 0.0], [2.0, 1.5]],
            }),
        ),
        (
            &["room", "set", "Hall", "--passes", "2", "--suction", "40"],
            RequestBody::SetRoom {
                room: 1,
                settings: Some(RoomSettings {
                    passes: 2,
                    power: CleaningPower {
                        suction: 0.4,
                        ..CleaningPower::FULL
                    },
                    pattern: CleaningPattern::Lines,
                }),
                was: None,
            },
        ),
        (
            &["rooms", "set", "Hall", "--pattern", "contour"],
            RequestBody::SetRoom {
                room: 1,
                settings: Some(RoomSettings {
                    pattern: CleaningPattern::Contour,
                    ..RoomSettings::default()
                }),
                was: None,
            },
        ),
        (
            &[
                "clean",
                "--room",
                "Hall",
                "--power",
                "quiet",
                "--pattern",
                "contour",
            ],
            RequestBody::Clean(JobOrder {
                parts: vec![JobPart::Room(1)],
                power: Some(CleaningPower::QUIET),
                pattern: Some(CleaningPattern::Contour),
                ..JobOrder::default()
            }),
        ),
        (
            &["rooms", "unset", "1"],
            RequestBody::SetRoom {
                room: 1,
                settings: None,
                was: None,
            },
        ),
        (
            &["room", "join", "Hall", "4"],
            RequestBody::JoinRooms { rooms: [1, 4] },
        ),
        (&["rooms", "undo", "3"], RequestBody::UndoRoomChange { number: 3 }),
    ];
    go_out(cases);
}

/// A daemon with an archive of 50,000 bytes, that takes only archives which begin with an S.
fn with_archive(request: &Request) -> Vec<Update> {
    let id = request.id.unwrap_or_default();
    match &request.body {
        RequestBody::ExportFloors { from, .. } => {
            let rest = 50_000 - from.min(&50_000);
            vec![
                Update::FloorArchive {
                    from: *from,
                    size: 50_000,
                    check: 7,
                    data: STANDARD.encode(vec![b'S'; rest.min(ARCHIVE_PIECE_BYTES) as usize]),
                },
                Update::Done { id },
            ]
        }
        RequestBody::ImportFloors { data, .. } if !data.starts_with('U') => {
            vec![Update::Failed(Failure {
                id: request.id,
                reason: "no-archive".to_owned(),
                text: "The file is no archive.".to_owned(),
            })]
        }
        RequestBody::Watch { topics } if !topics.is_empty() => {
            let view = Update::Floors(FloorsView::default());
            core::iter::once(view).chain(obedient(request)).collect()
        }
        _ => obedient(request),
    }
}

#[test]
fn floors_are_written_into_a_file_and_read_from_one() {
    let folder = Folder::new();
    let file = folder.join("floors");
    let path = file.to_str().expect("plain");
    let ask = |verb: &str| {
        let (output, asked) = Daemon::start(with_archive).rvac(&["floor", verb, path], "");
        (output.status.success(), text(&output.stderr), asked)
    };
    let (is_good, told, _) = ask("import");
    assert!(!is_good && told.contains("cannot read"), "{told}");
    assert!(ask("export").0);
    assert_eq!(std::fs::read(&file).expect("is there"), vec![b'S'; 50_000]);
    let (is_good, told, _) = ask("export");
    assert!(!is_good && told.contains("is it there already"), "{told}");
    let (is_good, told, asked) = ask("import");
    assert!(is_good, "{told}");
    let handed: Vec<u8> = asked
        .iter()
        .filter_map(|request| match &request.body {
            RequestBody::ImportFloors { data, .. } => Some(STANDARD.decode(data).expect("base 64")),
            _ => None,
        })
        .flatten()
        .collect();
    assert_eq!(handed, vec![b'S'; 50_000]);
    std::fs::write(&file, "garbage").expect("writes");
    let (is_good, told, _) = ask("import");
    assert!(!is_good && told.contains("no-archive"), "{told}");
    std::fs::write(&file, "").expect("writes");
    let (is_good, told, _) = ask("import");
    assert!(!is_good && told.contains("it has 0 bytes"), "{told}");
}

/// A daemon that keeps one run with two recordings, of which the second has 50,000 bytes, and both together 70,000.
fn with_history(request: &Request) -> Vec<Update> {
    let id = request.id.unwrap_or_default();
    let RequestBody::RunFile {
        number,
        recording,
        from,
    } = request.body
    else {
        return Vec::new();
    };
    let (all, size) = match recording {
        None => (70_000, None),
        Some(_) => (50_000, Some(50_000)),
    };
    if number != 7 || recording.is_some_and(|index| index != 1) {
        return vec![Update::Failed(Failure {
            id: request.id,
            reason: "no-such-run".to_owned(),
            text: "No run 8 is kept.".to_owned(),
        })];
    }
    let rest = all - from.min(all);
    let data = STANDARD.encode(vec![7; rest.min(RUN_PIECE_BYTES) as usize]);
    let piece = Update::RunFile {
        number,
        name: "run-a.mcap".to_owned(),
        from,
        size,
        data,
    };
    vec![piece, Update::Done { id }]
}

#[test]
fn a_recording_is_saved_whole_and_over_nothing() {
    let folder = Folder::new();
    let file = folder.join("saved.mcap");
    let path = file.to_str().expect("plain");
    let save = |said: &[&str]| {
        let words = [&["history", "save"], said, &[path]].concat();
        let (output, _) = Daemon::start(with_history).rvac(&words, "");
        output
    };
    for said in [&["8"][..], &["7", "--recording", "1"]] {
        let missing = save(said);
        assert!(!missing.status.success() && !file.exists(), "{missing:?}");
    }
    let part = save(&["7", "--recording", "2"]);
    assert!(part.status.success(), "{part:?}");
    assert_eq!(std::fs::read(&file).expect("is there"), vec![7; 50_000]);
    std::fs::remove_file(&file).expect("cleans up");
    let saved = save(&["7"]);
    assert!(saved.status.success(), "{saved:?}");
    assert_eq!(std::fs::read(&file).expect("is there"), vec![7; 70_000]);
    let again = save(&["7"]);
    let told = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(
        !again.status.success() && told.contains("is it there already"),
        "{told}"
    );
}

/// A daemon in that home with one schedule.
fn punctual(request: &Request) -> Vec<Update> {
    let told = Update::Schedules(Schedules {
        zone: "UTC".to_owned(),
        entries: vec![ScheduleView {
            number: 3,
            entry: hall_at("07:30"),
            skip_next: false,
            next: vec![],
            refused_now: None,
        }],
        ..Schedules::default()
    });
    match &request.body {
        RequestBody::Watch { topics } if topics.contains(&Topic::Schedules) => vec![told],
        _ => at_home(request),
    }
}

fn hall_at(at: &str) -> ScheduleEntry {
    ScheduleEntry {
        name: "Hall".to_owned(),
        enabled: true,
        job: ScheduledJob::Clean(JobOrder {
            parts: vec![JobPart::Room(1)],
            passes: 2,
            ..JobOrder::default()
        }),
        when: ScheduleTime::Weekly {
            days: vec![Weekday::Sa, Weekday::Su],
            at: at.to_owned(),
        },
        late_min: 0,
        in_quiet: InQuiet::Refuse,
        floor: None,
    }
}

#[test]
fn schedules_are_asked_for_under_their_names() {
    let add = [
        "schedule", "add", "Hall", "--days", "weekend", "--at", "07:30", "--room", "hall", "--passes", "2",
    ];
    let quiet = QuietHours {
        from: "22:00".to_owned(),
        to: "07:00".to_owned(),
    };
    let cases: [(&[&str], RequestBody); 7] = [
        (&add, RequestBody::AddSchedule(hall_at("07:30"))),
        (
            &["schedule", "change", "3", "--at", "08:00"],
            RequestBody::ChangeSchedule {
                number: 3,
                entry: hall_at("08:00"),
                was: None,
            },
        ),
        (
            &["schedule", "remove", "3"],
            RequestBody::RemoveSchedule { number: 3 },
        ),
        (
            &["schedule", "skip-next", "3", "--undo"],
            RequestBody::SkipNext {
                number: 3,
                skip: false,
            },
        ),
        (
            &["schedule", "run-now", "3"],
            RequestBody::RunSchedule { number: 3 },
        ),
        (
            &["schedule", "quiet", "22:00", "07:00"],
            RequestBody::SetQuiet { quiet: Some(quiet) },
        ),
        (
            &["schedule", "zone", "system"],
            RequestBody::SetZone { zone: None },
        ),
    ];
    for (arguments, body) in cases {
        let (output, asked) = Daemon::start(punctual).rvac(arguments, "");
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        let wanted = Request { id: Some(1), body };
        assert!(asked.contains(&wanted), "{arguments:?}: {asked:?}");
    }
    let wrong: [(&[&str], &str); 3] = [
        (&["schedule", "add", "Hall", "--at", "07:30"], "when? give --at"),
        (
            &["schedule", "change", "4", "--at", "07:30"],
            "there is no schedule 4",
        ),
        (&["schedule", "quiet", "22:00"], "have a beginning and an end"),
    ];
    for (arguments, sentence) in wrong {
        let (output, asked) = Daemon::start(punctual).rvac(arguments, "");
        assert_eq!(output.status.code(), Some(1));
        assert!(text(&output.stderr).contains(sentence), "{output:?}");
        assert!(asked.iter().all(|request| request.id.is_none()), "{asked:?}");
    }
}

#[test]
fn a_schedule_takes_how_its_runs_clean_and_keeps_what_they_clean() {
    let job = |parts, passes| JobOrder {
        parts,
        passes,
        power: Some(CleaningPower::QUIET),
        ..JobOrder::default()
    };
    let room = || vec![JobPart::Room(1)];
    let contour = JobOrder {
        pattern: Some(CleaningPattern::Contour),
        ..job(room(), 3)
    };
    let cases: [(&[&str], JobOrder); 3] = [
        (&["--power", "quiet"], job(room(), 2)),
        (
            &["--power", "quiet", "--pattern", "contour", "--passes", "3"],
            contour,
        ),
        (&["--all", "--power", "quiet"], job(vec![], 1)),
    ];
    for (options, order) in cases {
        let arguments = [&["schedule", "change", "3"], options].concat();
        let (output, asked) = Daemon::start(punctual).rvac(&arguments, "");
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        let entry = ScheduleEntry {
            job: ScheduledJob::Clean(order),
            ..hall_at("07:30")
        };
        let body = RequestBody::ChangeSchedule {
            number: 3,
            entry,
            was: None,
        };
        assert!(asked.contains(&Request { id: Some(1), body }), "{asked:?}");
    }
}

/// A daemon with two floors, whose robot is on the first one.
fn on_the_ground(request: &Request) -> Vec<Update> {
    let floor = |number, name: &str| FloorView {
        number,
        name: Some(name.to_owned()),
        area_m2: 4.0,
        rooms: 1,
        has_dock: true,
        removed: false,
    };
    let told = Update::Floors(FloorsView {
        floors: vec![floor(1, "Ground"), floor(2, "Attic")],
        here: Some(1),
        ..FloorsView::default()
    });
    match &request.body {
        RequestBody::Watch { topics } if topics.contains(&Topic::Floors) => vec![told],
        _ => punctual(request),
    }
}

#[test]
fn a_schedule_is_for_the_floor_that_is_named() {
    let of_room = |room, floor| ScheduleEntry {
        floor,
        job: ScheduledJob::Clean(JobOrder {
            parts: vec![JobPart::Room(room)],
            passes: 2,
            ..JobOrder::default()
        }),
        ..hall_at("07:30")
    };
    let all = |floor| ScheduleEntry {
        floor,
        job: ScheduledJob::Start { strategy: None },
        ..hall_at("07:30")
    };
    let cases: [(&[&str], ScheduleEntry); 5] = [
        (&["--floor", "attic"], of_room(1, Some(2))),
        (
            &["--floor", "Ground", "--room", "Hall", "--passes", "2"],
            of_room(1, Some(1)),
        ),
        (
            &["--floor", "2", "--room", "7", "--passes", "2"],
            of_room(7, Some(2)),
        ),
        (&["--floor", "Attic", "--all"], all(Some(2))),
        (&["--any-floor", "--all"], all(None)),
    ];
    for (options, entry) in cases {
        let arguments = [&["schedule", "change", "3"], options].concat();
        let (output, asked) = Daemon::start(on_the_ground).rvac(&arguments, "");
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        let body = RequestBody::ChangeSchedule {
            number: 3,
            entry,
            was: None,
        };
        assert!(
            asked.contains(&Request { id: Some(1), body }),
            "{arguments:?}: {asked:?}"
        );
    }
    let wrong: [(&[&str], &str); 3] = [
        (
            &["--floor", "Cellar"],
            "no floor is called \"Cellar\": there are 1 (Ground), 2 (Attic)",
        ),
        (
            &["--floor", "Attic", "--room", "Hall"],
            "the robot tells names only of the floor",
        ),
        (&["--any-floor"], "give --all besides"),
    ];
    for (options, sentence) in wrong {
        let arguments = [&["schedule", "change", "3"], options].concat();
        let (output, asked) = Daemon::start(on_the_ground).rvac(&arguments, "");
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(text(&output.stderr).contains(sentence), "{output:?}");
        assert!(asked.iter().all(|request| request.id.is_none()), "{asked:?}");
    }
}

/// A daemon that has kept something of one robot.
fn learned(request: &Request) -> Vec<Update> {
    let view = LearntView {
        device: "sr8730".to_owned(),
        here: true,
        gyro: Some(GyroLearnt {
            scale: 0.01,
            scale_sigma: 0.001,
            bias_rad_per_s: 0.0,
        }),
        energy: None,
        learnt_s: Some(1_800_000_000),
    };
    match &request.body {
        RequestBody::Learnt => vec![Update::Learnt {
            id: request.id,
            devices: vec![view],
        }],
        _ => obedient(request),
    }
}

#[test]
fn what_was_learnt_is_shown_and_forgotten_in_parts() {
    let (output, _) = Daemon::start(learned).rvac(&["learnt"], "");
    let words = text(&output.stdout);
    assert!(
        words.starts_with("sr8730, attached, last calibrated 2027-01-1"),
        "{words}"
    );
    assert!(words.contains("\n  gyro    counts +1.00 %"), "{words}");
    for (options, part) in [
        (&[][..], None),
        (&["--part", "gyro"], Some(LearntPart::Gyro)),
        (&["--part", "energy"], Some(LearntPart::Energy)),
    ] {
        let arguments = [&["learnt", "forget", "sr8730"], options].concat();
        let (output, asked) = Daemon::start(learned).rvac(&arguments, "");
        assert!(output.status.success(), "{output:?}");
        let device = "sr8730".to_owned();
        let body = RequestBody::ForgetLearnt { device, part };
        assert!(asked.contains(&Request { id: Some(1), body }), "{asked:?}");
    }
}

#[test]
fn an_estimate_is_shown_and_an_unknown_room_is_named() {
    let (output, _) = Daemon::start(at_home).rvac(&["estimate", "--room", "Hall"], "");
    let words = text(&output.stdout);
    assert!(
        words.contains("4.0 m2") && words.contains("about 5 min"),
        "{words}"
    );
    let (output, asked) = Daemon::start(at_home).rvac(&["clean", "--room", "Attic"], "");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("no room is called \"Attic\": the map has 1 (Hall)"));
    assert!(
        !asked
            .iter()
            .any(|request| matches!(request.body, RequestBody::Clean(_)))
    );
}

#[test]
fn the_home_is_shown_with_its_rooms_and_a_picture() {
    let (output, _) = Daemon::start(at_home).rvac(&["map"], "");
    let words = text(&output.stdout);
    assert!(
        words.contains("4.0 m2 of free floor, 1 room, 0 doors, 0 walls"),
        "{words}"
    );
    assert!(
        words.contains("room 1    4.0 m2, Hall\n") && words.ends_with("#1>\n"),
        "{words}"
    );
}

#[test]
fn kept_maps_are_listed_and_one_is_asked_back() {
    let (output, _) = Daemon::start(at_home).rvac(&["map", "list"], "");
    let words = text(&output.stdout);
    let row = words.lines().nth(1).expect("a row");
    assert!(
        row.starts_with("12 ") && row.ends_with("12  newest  doubted"),
        "{words}"
    );
    let row = words.lines().nth(2).expect("a second row");
    assert!(
        row.starts_with("11 ") && row.ends_with("11  last good"),
        "{words}"
    );
    let (output, asked) = Daemon::start(at_home).rvac(&["map", "restore", "11"], "");
    assert!(output.status.success(), "{output:?}");
    assert_eq!(
        asked[1].body,
        RequestBody::RestoreMap {
            number: 11,
            floor: None
        }
    );
}

#[test]
fn a_dock_that_was_moved_is_shown_by_where_the_robot_stands_and_looks() {
    let moved = RequestBody::MoveDock {
        x: -1.0,
        y: 0.5,
        heading: std::f64::consts::PI,
    };
    let arguments: &[&str] = &["map", "dock", "-1,0.5", "-3,0.5"];
    let (output, asked) = Daemon::start(at_home).rvac(arguments, "");
    assert!(output.status.success(), "{output:?}");
    assert_eq!(asked.last().map(|request| &request.body), Some(&moved));
    let (output, _) = Daemon::start(at_home).rvac(&["map", "dock", "1,1", "1,1"], "");
    assert!(
        text(&output.stderr).contains("both places are the same"),
        "{output:?}"
    );
}

#[test]
fn why_tells_the_newest_decisions_last() {
    let (output, _) = Daemon::start(at_home).rvac(&["why", "--lines", "1"], "");
    let words = text(&output.stdout);
    assert_eq!(
        words.trim(),
        "3 s ago  Stood still for a moment: its gyro must be measured at rest now and then."
    );
}

#[test]
fn a_terminal_through_the_daemon_relays_packets_and_refusals() {
    let typed = "{\"c\":\"info\"}\n";
    let (output, asked) = Daemon::start(talkative).rvac(&["term", "--linger", "200"], typed);
    assert!(output.status.success(), "{output:?}");
    assert!(asked.iter().any(|request| request.body
        == RequestBody::Raw {
            packet: "{\"c\":\"info\"}".to_owned()
        }));
    assert!(
        text(&output.stdout).contains("3.250 > {\"c\":\"info\"}"),
        "{}",
        text(&output.stdout)
    );
    let (output, _) = Daemon::start(busy).rvac(&["term", "--linger", "200"], typed);
    assert!(
        text(&output.stdout).contains("# vthal refuses (wheel-drop)"),
        "{}",
        text(&output.stdout)
    );
    assert_eq!(output.status.code(), Some(1));
}
