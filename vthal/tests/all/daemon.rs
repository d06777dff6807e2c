//! The real binary between a pseudo terminal and real sockets. Waits are for events, with a deadline.

use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::os::unix::net::{UnixDatagram, UnixListener, UnixStream};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use brain::{Cell, CellKnowledge, Raster, StoredMap};
use rvac_api::{LogEntry, Request, RequestBody, RunResult, Schedules, Update};
use rvac_protocol::crc::{Digest, Direction as CrcDirection};
use rvac_protocol::message::{self, BinaryKinds};

use rustix::process::{Pid, Signal, kill_process};
use vthal_bench::{Client, Daemon, LivingRobot, Scratch, SyntheticRobot, keep_home};
use vthal_core::stored_map;

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(20);

fn vthal() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_vthal"))
}

fn soon() -> Instant {
    Instant::now() + PATIENCE
}

fn start(scratch: &Scratch) -> Daemon {
    Daemon::start(vthal(), scratch, &["--seed", "1"]).expect("gets ready")
}

/// Follows the log and the status, the latter for waiting.
fn follow(scratch: &Scratch) -> Client {
    Client::watching(&scratch.join("vthal.sock"), r#"["status","log"]"#).expect("connects")
}

fn robot(scratch: &Scratch, boot_count: u32) -> SyntheticRobot {
    SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, boot_count).expect("opens a terminal")
}

/// Lets the robot live until the client has seen an update that fits.
fn wait_until(robot: &mut SyntheticRobot, client: &mut Client, mut fits: impl FnMut(&Update) -> bool) {
    let deadline = soon();
    let mut seen = Vec::new();
    while Instant::now() < deadline {
        robot
            .live_until(Instant::now() + Duration::from_millis(40), |_| false)
            .expect("lives");
        let found = client.wait_for(Instant::now() + Duration::from_millis(5), |update| {
            seen.push(format!("{update:?}"));
            fits(update)
        });
        if found.expect("reads").is_some() {
            return;
        }
    }
    panic!("only this came: {seen:#?}");
}

fn wait_for_state(robot: &mut SyntheticRobot, client: &mut Client, state: &str) {
    wait_until(
        robot,
        client,
        |update| matches!(update, Update::Status(status) if status.state == state),
    );
}

/// A robot that waits for orders, its daemon, and a client that follows both.
struct Desk {
    robot: SyntheticRobot,
    daemon: Daemon,
    client: Client,
    scratch: Scratch,
}

impl Desk {
    fn idle() -> Self {
        let scratch = Scratch::new().expect("creates");
        let robot = robot(&scratch, 1);
        let daemon = start(&scratch);
        let client = follow(&scratch);
        let mut desk = Self {
            robot,
            daemon,
            client,
            scratch,
        };
        wait_for_state(&mut desk.robot, &mut desk.client, "idle");
        desk
    }

    /// A desk at which somebody has pressed start.
    fn started() -> Self {
        let mut desk = Self::idle();
        desk.client.send(r#"{"c":"start"}"#).expect("sends");
        desk
    }
}

fn has_text(update: &Update, wanted: &str) -> bool {
    matches!(update, Update::Log(LogEntry { text, .. }) if text.contains(wanted))
}

/// As on a card that went read-only: the robot is served, and each thing that is not kept is said.
#[test]
fn a_daemon_that_can_write_nothing_serves_and_says_what_it_cannot_keep() {
    let scratch = Scratch::new().expect("creates");
    let state = scratch.join("state");
    fs::create_dir_all(state.join("vthal.pid")).expect("creates");
    for name in ["log", "runs"] {
        fs::write(state.join(name), "where a folder belongs").expect("writes");
    }
    let _daemon = start(&scratch);
    let mut client = follow(&scratch);
    for complaint in [
        "state folder",
        "cannot write the log in the state folder",
        "runs are not recorded",
    ] {
        let told = client.wait_for(soon(), |update| has_text(update, complaint));
        assert!(told.expect("reads").is_some(), "{complaint}");
    }
    let mut robot = robot(&scratch, 1);
    wait_for_state(&mut robot, &mut client, "idle");
    client.send(r#"{"c":"start","id":7}"#).expect("sends");
    wait_until(&mut robot, &mut client, |update| {
        matches!(update, Update::Done { .. })
    });
}

#[test]
fn a_robot_may_come_late_go_and_come_back_as_another_one() {
    let scratch = Scratch::new().expect("creates");
    let _daemon = start(&scratch);
    let mut client = follow(&scratch);
    client.send(r#"{"c":"start","id":1}"#).expect("sends");
    let answer = client
        .wait_for(soon(), |update| matches!(update, Update::Failed(_)))
        .expect("reads");
    let Some(Update::Failed(failure)) = answer else {
        panic!("no answer")
    };
    assert_eq!((failure.id, failure.reason.as_str()), (Some(1), "no-robot"));
    let mut first = robot(&scratch, 1);
    wait_for_state(&mut first, &mut client, "idle");
    drop(first);
    let lost = client
        .wait_for(soon(), |update| has_text(update, "link lost"))
        .expect("reads");
    assert!(lost.is_some(), "the loss is told");
    let mut second = robot(&scratch, 2);
    wait_until(&mut second, &mut client, |update| {
        has_text(update, "has described itself")
    });
    second
        .live_until(Instant::now() + Duration::from_millis(300), |_| false)
        .expect("lives");
    client.send(r#"{"c":"start"}"#).expect("sends");
    assert!(
        second.live_until(soon(), SyntheticRobot::moves).expect("lives"),
        "the new one drives"
    );
}

/// Whether somebody else could take the device now: the daemon locks it while it has it open.
fn is_free(scratch: &Scratch) -> bool {
    let device = fs::File::open(scratch.join("tty")).expect("the terminal is there");
    rustix::fs::flock(&device, rustix::fs::FlockOperation::NonBlockingLockExclusive).is_ok()
}

fn borrow(desk: &Desk) -> Client {
    let mut flasher = Client::connect(&desk.scratch.join("vthal.sock")).expect("connects");
    flasher
        .send(r#"{"c":"borrow-link","silent":false,"id":7}"#)
        .expect("sends");
    flasher
}

#[test]
fn the_line_is_lent_to_one_client_and_taken_again_when_it_is_gone() {
    let mut desk = Desk::idle();
    // Some reports, which say that it stands.
    let reported = Instant::now() + Duration::from_millis(500);
    desk.robot.live_until(reported, |_| false).expect("lives");
    let mut early = borrow(&desk);
    let refused = early.wait_for(soon(), |update| matches!(update, Update::Failed(_)));
    let Some(Update::Failed(failure)) = refused.expect("reads") else {
        panic!("a robot off its dock keeps its daemon");
    };
    assert_eq!((failure.id, failure.reason.as_str()), (Some(7), "not-docked"));
    assert!(!is_free(&desk.scratch));
    desk.robot.dock();
    // Some reports, which say so.
    let reported = Instant::now() + Duration::from_millis(500);
    desk.robot.live_until(reported, |_| false).expect("lives");
    let mut flasher = borrow(&desk);
    wait_until(&mut desk.robot, &mut desk.client, |update| {
        has_text(update, "link lent")
    });
    let done = flasher.wait_for(soon(), |update| matches!(update, Update::Done { id: 7 }));
    assert!(done.expect("reads").is_some());
    assert!(is_free(&desk.scratch), "the flasher can take the device");
    let mut other = borrow(&desk);
    let refused = other.wait_for(soon(), |update| matches!(update, Update::Failed(_)));
    let Some(Update::Failed(failure)) = refused.expect("reads") else {
        panic!("one line for two");
    };
    assert_eq!(failure.reason, "link-lent");
    // However the flasher ends, its connection does.
    drop(flasher);
    wait_until(&mut desk.robot, &mut desk.client, |update| {
        has_text(update, "link open")
    });
    assert!(!is_free(&desk.scratch));
}

#[test]
fn sigterm_stops_the_wheels_before_it_ends() {
    let Desk {
        mut robot,
        mut daemon,
        client: _client,
        scratch,
    } = Desk::started();
    assert!(
        robot.live_until(soon(), SyntheticRobot::moves).expect("lives"),
        "it drives"
    );
    daemon.terminate().expect("signals");
    let mut code = None;
    let ended = robot.live_until(soon(), |_| {
        code = daemon.ended().expect("asks");
        code.is_some()
    });
    assert!(ended.expect("lives") && code == Some(0), "it ends well: {code:?}");
    let after_stop = robot
        .commands
        .iter()
        .rev()
        .take_while(|command| **command != message::Command::Stop);
    let drives = after_stop
        .filter(|command| matches!(command, message::Command::Drive(_)))
        .count();
    assert!(
        robot.commands.contains(&message::Command::Stop),
        "`stop` was sent"
    );
    assert_eq!(drives, 0, "nothing moves the wheels after `stop`");
    assert!(!scratch.join("vthal.sock").exists(), "the socket is gone");
}

#[test]
fn a_killed_daemon_goes_on_with_its_job_ten_times() {
    let Desk {
        mut robot,
        mut daemon,
        client: _client,
        scratch,
    } = Desk::started();
    let checkpoint = scratch.join("state/checkpoint");
    let written = |path: &Path| fs::read_to_string(path).is_ok_and(|text| text.contains(r#""running":true"#));
    for kill in 0..10 {
        assert!(
            robot.live_until(soon(), SyntheticRobot::moves).expect("lives"),
            "it drives before kill {kill}"
        );
        assert!(
            robot.live_until(soon(), |_| written(&checkpoint)).expect("lives"),
            "a checkpoint is written"
        );
        let phase = Instant::now() + Duration::from_millis(7 * kill);
        robot.live_until(phase, |_| false).expect("lives");
        daemon.kill().expect("kills");
        let stands = Instant::now() + Duration::from_millis(300);
        assert!(
            robot.live_until(stands, |robot| !robot.moves()).expect("lives"),
            "the lease ends"
        );
        daemon = start(&scratch);
    }
    assert!(
        robot.live_until(soon(), SyntheticRobot::moves).expect("lives"),
        "it drives again"
    );
    let mut again = follow(&scratch);
    let told = again
        .wait_for(soon(), |update| has_text(update, "resumed-after-restart"))
        .expect("reads");
    assert!(told.is_some(), "it says so");
}

#[test]
fn recordings_replay_identically_and_a_changed_one_does_not() {
    let Desk {
        mut robot,
        daemon,
        mut client,
        scratch,
    } = Desk::started();
    wait_for_state(&mut robot, &mut client, "cleaning");
    robot
        .live_until(Instant::now() + Duration::from_millis(2500), |_| false)
        .expect("lives");
    daemon.kill().expect("kills");
    let runs = scratch.join("state/runs");
    let file = fs::read_dir(&runs)
        .expect("exists")
        .next()
        .expect("one run")
        .expect("reads")
        .path();
    let output = replay(&file);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success() && text.starts_with("identical: "),
        "{text}"
    );
    let mut bytes = fs::read(&file).expect("reads");
    let wanted = br#""speed_share":1.0"#;
    let places: Vec<usize> = (0..bytes.len() - wanted.len())
        .filter(|start| bytes[*start..].starts_with(wanted))
        .collect();
    for place in places {
        bytes[place..place + wanted.len()].copy_from_slice(br#""speed_share":0.5"#);
    }
    let changed = runs.join("changed.mcap");
    fs::write(&changed, without_checksums(bytes)).expect("writes");
    let output = replay(&changed);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(
        output.status.code(),
        Some(1),
        "{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(text.starts_with("first difference at step "), "{text}");
}

/// Sets the checksum of each chunk to 0, which means that there is none. A chunk is: opcode 6, length, first and last
/// time, size, checksum.
fn without_checksums(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut at = 8;
    while let Some(head) = bytes.get(at..at + 9) {
        let length = u64::from_le_bytes(head[1..9].try_into().expect("eight bytes")) as usize;
        if length > bytes.len() - at - 9 {
            break;
        }
        if head[0] == 6 {
            bytes[at + 9 + 24..at + 9 + 28].fill(0);
        }
        at += 9 + length;
    }
    bytes
}

/// Packets that are sent before everybody may catch up.
const BURST: usize = 50;

/// A client that reads everything.
struct Listener {
    stream: UnixStream,
    messages: usize,
}

impl Listener {
    fn connect(socket: &Path) -> Self {
        let client = Client::watching(socket, r#"["packets"]"#).expect("connects");
        client.stream.set_nonblocking(true).expect("sets");
        Self {
            stream: client.stream,
            messages: 0,
        }
    }

    fn read(&mut self) {
        let mut buffer = [0; 64 << 10];
        while let Ok(count) = self.stream.read(&mut buffer) {
            assert_ne!(count, 0, "a client that reads stays connected");
            let ends = buffer[..count]
                .iter()
                .filter(|byte| **byte == rvac_api::SEPARATOR);
            self.messages += ends.count();
        }
    }
}

#[test]
fn a_stalled_client_hurts_nobody_and_is_shown_the_door() {
    let Desk {
        mut robot,
        daemon: _daemon,
        client: _watcher,
        scratch,
    } = Desk::idle();
    let socket = scratch.join("vthal.sock");
    let stalled = Client::watching(&socket, r#"["packets","log","status"]"#).expect("connects");
    let mut crowd: Vec<Listener> = (0..99).map(|_| Listener::connect(&socket)).collect();
    // Enough that what the kernel holds for the stalled client and its outbox overflow.
    for sent in (0..6_000).step_by(BURST) {
        for _ in 0..BURST {
            robot.report().expect("writes");
        }
        robot.listen(Instant::now()).expect("lives");
        // However busy the machine is: nobody but the stalled one falls behind.
        let deadline = soon();
        while crowd.iter().any(|listener| listener.messages < sent) {
            assert!(Instant::now() < deadline, "everybody else is served");
            crowd.iter_mut().for_each(Listener::read);
        }
    }
    let deadline = soon();
    while !has_hung_up(&stalled.stream) {
        assert!(Instant::now() < deadline, "the stalled client is disconnected");
        robot
            .listen(Instant::now() + Duration::from_millis(20))
            .expect("lives");
        crowd.iter_mut().for_each(Listener::read);
    }
    let mut client = follow(&scratch);
    wait_for_state(&mut robot, &mut client, "idle");
}

/// Whether the other end is closed, without reading anything.
fn has_hung_up(stream: &UnixStream) -> bool {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let mut polled = [PollFd::new(stream, PollFlags::empty())];
    let now = Timespec::default();
    poll(&mut polled, Some(&now)).expect("asks");
    polled[0].revents().contains(PollFlags::HUP)
}

#[test]
fn garbage_is_answered_and_endless_garbage_ends_the_connection() {
    let scratch = Scratch::new().expect("creates");
    let _daemon = start(&scratch);
    let mut client = Client::connect(&scratch.join("vthal.sock")).expect("connects");
    for (packet, reason) in [
        ("\u{0}\u{1}garbage", "syntax"),
        ("[1,2]", "syntax"),
        (r#"{"c":"explode","id":4}"#, "unknown"),
        (r#"{"c":"drive","v":1,"id":5}"#, "arguments"),
        (r#"{"c":"start","strategy":"none","id":6}"#, "unknown-strategy"),
        (r#"{"c":"raw","packet":"{}","id":7}"#, "expert-off"),
    ] {
        client.send(packet).expect("sends");
        let answer = client
            .wait_for(soon(), |update| matches!(update, Update::Failed(_)))
            .expect("reads");
        let Some(Update::Failed(failure)) = answer else {
            panic!("no answer to {packet}")
        };
        assert_eq!(failure.reason, reason, "{packet}");
        assert!(failure.text.ends_with('.'), "a sentence: {}", failure.text);
    }
    client.stream.write_all(&[b'x'; 20 << 10]).expect("sends");
    let mut rest = Vec::new();
    client.stream.set_read_timeout(Some(PATIENCE)).expect("sets");
    // What the daemon did not read any more turns the end into a reset; the answer comes before either.
    let end = client.stream.read_to_end(&mut rest);
    assert!(
        end.is_ok() || end.is_err_and(|error| error.kind() == ErrorKind::ConnectionReset),
        "it ends"
    );
    assert!(String::from_utf8_lossy(&rest).contains("too-long"));
    let mut other = Client::connect(&scratch.join("vthal.sock")).expect("connects");
    other
        .send(r#"{"c":"hello","name":"other","id":1}"#)
        .expect("sends");
    let done = other
        .wait_for(soon(), |update| matches!(update, Update::Done { id: 1 }))
        .expect("reads");
    assert!(done.is_some(), "the daemon lives on");
}

fn kept_numbers(desk: &mut Desk) -> Vec<u64> {
    desk.client.send(r#"{"c":"maps","id":9}"#).expect("sends");
    let is_list = |update: &Update| matches!(update, Update::Maps { .. });
    match desk.client.wait_for(soon(), is_list).expect("reads") {
        Some(Update::Maps { maps, .. }) => maps.iter().map(|map| map.number).collect(),
        other => panic!("no list: {other:?}"),
    }
}

/// The answer to request 9: the reason of a refusal, if it is one.
fn refused(desk: &mut Desk) -> Option<String> {
    let fits = |update: &Update| match update {
        Update::Done { id } => *id == 9,
        Update::Failed(failure) => failure.id == Some(9),
        _ => false,
    };
    match desk.client.wait_for(soon(), fits).expect("reads") {
        Some(Update::Done { .. }) => None,
        Some(Update::Failed(failure)) => Some(failure.reason),
        other => panic!("no answer: {other:?}"),
    }
}

fn map_of(width: usize) -> Vec<u8> {
    let floor = Raster::filled(Cell { x: 0, y: 0 }, width, 8, CellKnowledge::Free);
    stored_map::encode(&StoredMap::from_raster(&floor, None))
}

#[test]
fn a_kept_map_is_listed_and_taken_up_again_over_the_socket() {
    let mut desk = Desk::idle();
    assert!(kept_numbers(&mut desk).is_empty(), "nothing was kept yet");
    assert_eq!(refused(&mut desk), None);
    let maps = desk.scratch.join("state/maps");
    fs::create_dir_all(&maps).expect("creates");
    fs::write(maps.join("000003.map"), map_of(8)).expect("writes");
    fs::write(maps.join("000004.map"), map_of(16)).expect("writes");
    fs::write(maps.join("000005.map"), b"garbage").expect("writes");
    assert_eq!(
        kept_numbers(&mut desk),
        [4, 3],
        "what is not whole is not offered"
    );
    assert_eq!(refused(&mut desk), None);
    for (number, reason) in [(3, None), (5, Some("map-unreadable")), (77, Some("no-such-map"))] {
        let request = format!(r#"{{"c":"restore-map","number":{number},"id":9}}"#);
        desk.client.send(&request).expect("sends");
        assert_eq!(refused(&mut desk).as_deref(), reason, "{number}");
    }
    assert_eq!(kept_numbers(&mut desk), [6, 4, 3], "the spoilt one is not lost");
    assert_eq!(fs::read(maps.join("000006.map")).expect("reads"), map_of(8));
}

fn kept_mixes(desk: &mut Desk) -> Vec<String> {
    desk.client.send(r#"{"c":"mixes","id":9}"#).expect("sends");
    let is_list = |update: &Update| matches!(update, Update::Mixes { .. });
    match desk.client.wait_for(soon(), is_list).expect("reads") {
        Some(Update::Mixes { mixes }) => mixes,
        other => panic!("no list: {other:?}"),
    }
}

#[test]
fn control_mixes_are_kept_checked_and_removed_over_the_socket() {
    let mut desk = Desk::idle();
    assert!(kept_mixes(&mut desk).is_empty());
    assert_eq!(refused(&mut desk), None);
    let profile = mixer::standard_profile().to_json();
    let save = |profile: String| {
        let body = RequestBody::SaveMix { profile, was: None };
        serde_json::to_string(&Request { id: Some(9), body }).expect("JSON")
    };
    let socket = desk.scratch.join("vthal.sock");
    let mut other_page = Client::watching(&socket, r#"["inputs"]"#).expect("connects");
    desk.client.send(&save(profile.clone())).expect("sends");
    assert_eq!(refused(&mut desk), None);
    let saved = |update: &Update| matches!(update, Update::Mixes { mixes } if *mixes == [profile.clone()]);
    let heard = other_page.wait_for(soon(), saved).expect("reads");
    assert!(heard.is_some(), "whoever edits elsewhere hears of it");
    desk.client
        .send(&save(profile.replace("pad-0", "pad-9")))
        .expect("sends");
    assert_eq!(refused(&mut desk).as_deref(), Some("mix-wrong"));
    assert_eq!(kept_mixes(&mut desk), [profile.as_str()]);
    assert_eq!(refused(&mut desk), None);
    let file = desk.scratch.join("state/mixes/Standard.json");
    assert_eq!(fs::read_to_string(file).expect("reads"), profile);
    for reason in [None, Some("no-such-mix")] {
        desk.client
            .send(r#"{"c":"remove-mix","name":"Standard","id":9}"#)
            .expect("sends");
        assert_eq!(refused(&mut desk).as_deref(), reason);
    }
    assert!(kept_mixes(&mut desk).is_empty());
}

#[test]
fn what_people_say_of_the_home_is_on_the_disk_when_it_is_acknowledged() {
    let scratch = Scratch::new().expect("creates");
    let maps = keep_home(&scratch).expect("writes");
    let mut robot = robot(&scratch, 1);
    robot.dock();
    let daemon = start(&scratch);
    let mut client = follow(&scratch);
    wait_until(&mut robot, &mut client, |update| {
        has_text(update, "takes up the map of the home that was kept")
    });
    client
        .send(r#"{"c":"add-no-go","shape":{"wall":[[1.0,0.5],[1.0,1.5]]},"id":9}"#)
        .expect("sends");
    wait_until(&mut robot, &mut client, |update| {
        matches!(update, Update::Done { id: 9 })
    });
    // No warning and no time to write: what is there is what the next daemon finds.
    drop(daemon);
    let newest = stored_map::decode(&fs::read(maps.join("000002.map")).expect("reads")).expect("is whole");
    assert_eq!(newest.annotations().no_go().count(), 1);
    assert_eq!(newest.dock().map(|dock| dock.x_m), Some(0.0));
}

#[test]
fn a_client_that_ended_its_side_gets_its_answers_and_leaves_the_seat() {
    let mut desk = Desk::idle();
    let mut script = Client::connect(&desk.scratch.join("vthal.sock")).expect("connects");
    for request in [
        r#"{"c":"drive","v":0,"w":0,"ttl":400}"#,
        r#"{"c":"set-zone","zone":"Europe/Tallinn","id":7}"#,
    ] {
        script.send(request).expect("sends");
    }
    script
        .stream
        .shutdown(std::net::Shutdown::Write)
        .expect("ends its side");
    // The schedules are on the disk first, so this answer comes after the daemon has seen the end.
    let answered = script.wait_for(soon(), |update| matches!(update, Update::Done { id: 7 }));
    assert!(answered.expect("reads").is_some());
    // Who is lost is braked for, and until the robot has heard that, nobody drives.
    let deadline = soon();
    let why_not = loop {
        desk.robot
            .live_until(Instant::now() + Duration::from_millis(40), |_| false)
            .expect("lives");
        desk.client
            .send(r#"{"c":"drive","v":0,"w":0,"ttl":400,"id":9}"#)
            .expect("sends");
        match refused(&mut desk) {
            Some(reason) if reason == "stopped" && Instant::now() < deadline => {}
            why_not => break why_not,
        }
    };
    assert_eq!(why_not, None, "the seat is free");
}

#[test]
fn damaged_files_are_told_to_clients_and_kept() {
    // What is put aside has another name; what has versions stays.
    let kept = [
        ("schedules.json", "schedules.json.damaged-1"),
        ("health.json", "health.json.damaged-1"),
        ("learnt.json", "learnt.json.damaged-1"),
        ("statistics.json", "statistics.json.damaged-1"),
        ("maps/floors.json", "maps/floors.json.damaged-1"),
        ("maps/numbers.json", "maps/numbers.json.damaged-1"),
        ("mixes/Sofa.json", "mixes/Sofa.json.damaged-1"),
        ("maps/000001.map", "maps/000001.map"),
        ("checkpoint", "checkpoint"),
    ];
    let scratch = Scratch::new().expect("creates");
    for folder in ["state/maps", "state/mixes"] {
        fs::create_dir_all(scratch.join(folder)).expect("creates");
    }
    for (file, _) in kept {
        fs::write(scratch.join("state").join(file), "{").expect("writes");
    }
    let _daemon = start(&scratch);
    let mut client = follow(&scratch);
    let mut untold: Vec<&str> = kept.iter().map(|(file, _)| *file).collect();
    let all_told = client.wait_for(soon(), |update| {
        untold.retain(|file| !has_text(update, file));
        untold.is_empty()
    });
    assert!(all_told.expect("reads").is_some(), "{untold:?} are not told");
    for (_, file) in kept.iter().filter(|(file, _)| *file != "checkpoint") {
        assert_eq!(fs::read(scratch.join("state").join(file)).expect(file), b"{");
    }
}

fn kept_schedules(client: &mut Client) -> Schedules {
    for topics in ["[]", r#"["schedules","log","status"]"#] {
        let request = format!(r#"{{"c":"watch","topics":{topics}}}"#);
        client.send(&request).expect("sends");
    }
    let is_told = |update: &Update| matches!(update, Update::Schedules(_));
    match client.wait_for(soon(), is_told).expect("reads") {
        Some(Update::Schedules(schedules)) => schedules,
        other => panic!("no schedules: {other:?}"),
    }
}

#[test]
fn schedules_are_on_the_disk_when_they_are_acknowledged() {
    let mut desk = Desk::idle();
    assert!(kept_schedules(&mut desk.client).entries.is_empty());
    let add = r#"{"c":"add-schedule","name":"Köök","job":{"start":{}},"when":{"weekly":{"days":["mo"],"at":"07:30"}},"id":9}"#;
    for (request, reason) in [
        (
            r#"{"c":"set-zone","zone":"Mars/Base","id":9}"#,
            Some("no-such-zone"),
        ),
        (r#"{"c":"set-zone","zone":"Europe/Tallinn","id":9}"#, None),
        (add, None),
        (&add.replace("07:30", "7:30"), Some("schedule-wrong")),
        (
            &add.replace("{}", r#"{"strategy":"fly"}"#),
            Some("unknown-strategy"),
        ),
        (r#"{"c":"skip-next","number":1,"skip":true,"id":9}"#, None),
        (
            r#"{"c":"remove-schedule","number":2,"id":9}"#,
            Some("no-such-schedule"),
        ),
    ] {
        desk.client.send(request).expect("sends");
        assert_eq!(refused(&mut desk).as_deref(), reason, "{request}");
    }
    let before = kept_schedules(&mut desk.client);
    assert_eq!((before.entries.len(), before.next.len()), (1, 10));
    // No warning and no time to write: what is there is what the next daemon finds.
    let Desk {
        robot,
        daemon,
        client,
        scratch,
    } = desk;
    drop((daemon, client));
    let mut desk = Desk {
        daemon: start(&scratch),
        client: follow(&scratch),
        robot,
        scratch,
    };
    let after = kept_schedules(&mut desk.client);
    assert_eq!(
        (&after.zone, after.zone_is_set),
        (&"Europe/Tallinn".to_owned(), true)
    );
    assert_eq!(
        (after.entries[0].skip_next, &after.entries[0].entry),
        (true, &before.entries[0].entry)
    );
    assert_eq!(after.next, before.next);
}

#[test]
fn a_schedule_starts_the_robot_when_its_minute_comes() {
    let scratch = Scratch::new().expect("creates");
    let _robot = LivingRobot::new(robot(&scratch, 1));
    // Four times as fast: the next minute is at most fifteen seconds away, and what the robot says comes often enough still.
    let _daemon = Daemon::start(vthal(), &scratch, &["--seed", "1", "--speed", "4"]).expect("gets ready");
    let mut client = follow(&scratch);
    let clock = kept_schedules(&mut client)
        .clock
        .expect("the test machine knows the time");
    for shift in 1..=3 {
        let at = minutes_later(&clock, shift).expect("is a clock");
        let when = format!(r#"{{"weekly":{{"days":["mo","tu","we","th","fr","sa","su"],"at":"{at}"}}}}"#);
        let add = format!(r#"{{"c":"add-schedule","name":"Soon","job":{{"start":{{}}}},"when":{when}}}"#);
        client.send(&add).expect("sends");
    }
    let within = Instant::now() + 3 * PATIENCE;
    let fired = client.wait_for(within, |update| has_text(update, ": fired"));
    assert!(fired.expect("reads").is_some());
}

/// The time of day of `2026-11-23T07:30` and so many minutes.
fn minutes_later(clock: &str, shift: u32) -> Option<String> {
    let (_, at) = clock.split_once('T')?;
    let (hour, minute) = at.split_once(':')?;
    let minutes = 60 * hour.parse::<u32>().ok()? + minute.parse::<u32>().ok()? + shift;
    Some(format!("{:02}:{:02}", minutes / 60 % 24, minutes % 60))
}

#[test]
fn a_second_daemon_is_refused_and_a_dead_ones_socket_is_replaced() {
    let scratch = Scratch::new().expect("creates");
    let socket = scratch.join("vthal.sock");
    drop(UnixListener::bind(&socket).expect("binds"));
    let _daemon = start(&scratch);
    let found = fs::symlink_metadata(&socket).expect("exists");
    assert!(found.file_type().is_socket());
    assert_eq!(found.permissions().mode() & 0o777, 0o660);
    let refused = |state: &str| {
        let output = Command::new(vthal())
            .args(["--serial", "/dev/null", "--socket"])
            .arg(&socket)
            .arg("--state")
            .arg(scratch.join(state))
            .output()
            .expect("runs");
        assert_eq!(output.status.code(), Some(1));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let same_folder = refused("state");
    assert!(
        same_folder.starts_with("vthal: another vthal (process "),
        "{same_folder}"
    );
    let same_socket = refused("other");
    assert!(
        same_socket.starts_with("vthal: another vthal listens on "),
        "{same_socket}"
    );
}

#[test]
fn a_broken_configuration_is_one_sentence_and_nothing_is_written() {
    let scratch = Scratch::new().expect("creates");
    let file = scratch.join("vthal.toml");
    let state = scratch.join("state");
    let text = format!(
        "[state]\ndir = {:?}\n[link]\nserial = \"/dev/null\"\nbaud = 1\n",
        state.display()
    );
    fs::write(&file, text).expect("writes");
    let output = Command::new(vthal())
        .arg("--config")
        .arg(&file)
        .output()
        .expect("runs");
    assert_eq!(
        output.status.code(),
        Some(2),
        "another start would change nothing"
    );
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    let place = format!("vthal: {}:5: link.baud: ", file.display());
    assert!(
        message.starts_with(&place) && message.lines().count() == 1,
        "{message}"
    );
    assert!(!state.exists(), "nothing was written");
}

/// What the daemon answers to a question about runs.
fn asked_of_runs(client: &mut Client, request: &str) -> Update {
    client.send(request).expect("sends");
    let is_answer = |update: &Update| {
        matches!(
            update,
            Update::Runs { .. }
                | Update::Run(_)
                | Update::RunFile { .. }
                | Update::RunTrack(_)
                | Update::Failed(_)
        )
    };
    let answer = client.wait_for(soon(), is_answer).expect("reads");
    answer.expect("an answer")
}

#[test]
fn starts_without_a_job_take_no_place_among_the_recordings() {
    let scratch = Scratch::new().expect("creates");
    let mut robot = robot(&scratch, 1);
    for _ in 0..3 {
        let daemon = start(&scratch);
        let mut client = follow(&scratch);
        wait_for_state(&mut robot, &mut client, "idle");
        daemon.kill().expect("kills");
    }
    let recordings = fs::read_dir(scratch.join("state/runs")).expect("a folder");
    assert_eq!(recordings.count(), 0);
}

#[test]
fn a_run_is_kept_with_its_recording_before_it_is_reported() {
    let mut desk = Desk::started();
    wait_for_state(&mut desk.robot, &mut desk.client, "cleaning");
    let mut person = Client::watching(&desk.scratch.join("vthal.sock"), r#"["runs"]"#).expect("connects");
    person.send(r#"{"c":"hello","name":"Anna"}"#).expect("sends");
    desk.robot
        .live_until(Instant::now() + Duration::from_millis(1500), |_| false)
        .expect("lives");
    person.send(r#"{"c":"stop"}"#).expect("sends");
    let mut kept = None;
    wait_until(&mut desk.robot, &mut person, |update| {
        if let Update::RunKept(run) = update {
            kept = Some(run.clone());
        }
        kept.is_some()
    });
    let run = kept.expect("is kept");
    assert_eq!((run.number, run.result), (1, RunResult::Stopped));
    assert_eq!(run.text, "Stopped by Anna.");
    assert!(
        run.recordings[0].bytes.is_some(),
        "its recording is there: {run:?}"
    );
    let file = desk.scratch.join("state/history/000001.json");
    assert!(file.exists(), "what is told is on the disk");
    assert!(run.start_s.is_some() && run.end_s >= run.start_s, "{run:?}");
    let Update::Runs { runs, more } = asked_of_runs(&mut person, r#"{"c":"runs"}"#) else {
        panic!("no list")
    };
    assert_eq!((runs.len(), more, runs[0].number), (1, false, 1));
    assert!(
        runs[0].recordings[0].bytes.is_some_and(|bytes| bytes > 1000),
        "{runs:?}"
    );
    let Update::Run(record) = asked_of_runs(&mut person, r#"{"c":"run","number":1}"#) else {
        panic!("no run")
    };
    assert!(record.picture.is_some_and(|picture| picture.cell_m > 0.0));
    let Update::RunFile { data, name, .. } =
        asked_of_runs(&mut person, r#"{"c":"run-file","number":1,"from":0}"#)
    else {
        panic!("no piece")
    };
    assert_eq!(name, runs[0].recordings[0].name);
    // The magic of MCAP in base 64.
    assert!(data.starts_with("iU1DQVAwDQo"), "{}", &data[..20]);
    let Update::Failed(failure) = asked_of_runs(&mut person, r#"{"c":"run","number":2}"#) else {
        panic!("there is no run 2")
    };
    assert_eq!(failure.reason, "no-such-run");
}

#[test]
fn a_run_that_nobody_goes_on_with_is_found_and_kept_as_cut_short() {
    let Desk {
        mut robot,
        daemon,
        client: _client,
        scratch,
    } = Desk::started();
    let checkpoint = scratch.join("state/checkpoint");
    let written = |path: &Path| fs::read_to_string(path).is_ok_and(|text| text.contains(r#""running":true"#));
    assert!(
        robot.live_until(soon(), |_| written(&checkpoint)).expect("lives"),
        "a checkpoint is written"
    );
    daemon.kill().expect("kills");
    age_checkpoint(&checkpoint);
    let daemon = start(&scratch);
    let mut person = Client::connect(&scratch.join("vthal.sock")).expect("connects");
    let Update::Run(record) = asked_of_runs(&mut person, r#"{"c":"run","number":1}"#) else {
        panic!("no run")
    };
    assert_eq!(record.run.result, RunResult::CutShort);
    assert_eq!(record.run.end_s, None);
    assert!(record.run.start_s.is_some(), "{:?}", record.run);
    // It is found once, whatever happens then.
    daemon.kill().expect("kills");
    let _daemon = start(&scratch);
    let mut person = Client::connect(&scratch.join("vthal.sock")).expect("connects");
    let Update::Runs { runs, .. } = asked_of_runs(&mut person, r#"{"c":"runs"}"#) else {
        panic!("no list")
    };
    assert_eq!(runs.len(), 1, "{runs:?}");
}

/// Makes a checkpoint look as after a power cut: of another boot of the system.
fn age_checkpoint(path: &Path) {
    let text = fs::read_to_string(path).expect("reads");
    let (_, body) = text.split_once('\n').expect("has a header");
    let at = body.find(r#""boot":""#).expect("names its boot") + 8;
    let mut body = body.as_bytes().to_vec();
    body[at] = if body[at] == b'0' { b'1' } else { b'0' };
    let mut digest = Digest::start(CrcDirection::HostToRobot, 0);
    digest.extend(&body);
    let mut whole = format!("vthal-checkpoint-1 {} {:08X}\n", body.len(), digest.crc()).into_bytes();
    whole.extend(body);
    fs::write(path, whole).expect("writes");
    fs::remove_file(path.with_extension("old")).ok();
}

#[test]
fn a_run_during_which_the_daemon_was_killed_is_one_file_and_one_time_line() {
    let Desk {
        mut robot,
        daemon,
        mut client,
        scratch,
    } = Desk::started();
    wait_for_state(&mut robot, &mut client, "cleaning");
    let checkpoint = scratch.join("state/checkpoint");
    let written = |path: &Path| fs::read_to_string(path).is_ok_and(|text| text.contains(r#""running":true"#));
    assert!(robot.live_until(soon(), |_| written(&checkpoint)).expect("lives"));
    let lives_for = |robot: &mut SyntheticRobot| {
        let until = Instant::now() + Duration::from_millis(1500);
        robot.live_until(until, |_| false).expect("lives");
    };
    lives_for(&mut robot);
    daemon.kill().expect("kills");
    assert!(
        robot.live_until(soon(), |robot| !robot.moves()).expect("lives"),
        "the lease ends"
    );
    let _daemon = start(&scratch);
    let mut person = Client::watching(&scratch.join("vthal.sock"), r#"["runs"]"#).expect("connects");
    assert!(robot.live_until(soon(), SyntheticRobot::moves).expect("lives"));
    lives_for(&mut robot);
    person.send(r#"{"c":"stop"}"#).expect("sends");
    wait_until(&mut robot, &mut person, |update| {
        matches!(update, Update::RunKept(_))
    });

    let Update::RunTrack(track) = asked_of_runs(&mut person, r#"{"c":"run-track","number":1}"#) else {
        panic!("no track")
    };
    let [first_s, second_s] = track.begins_s[..] else {
        panic!("two parts: {:?}", track.begins_s)
    };
    assert!(first_s < second_s, "{:?}", track.begins_s);
    assert!(track.poses.is_sorted_by(|one, next| one.0 < next.0), "{track:?}");
    assert!(track.poses.iter().any(|pose| pose.0 >= second_s), "{track:?}");

    let bytes = whole_file(&mut person);
    let file = scratch.join("whole.mcap");
    fs::write(&file, &bytes).expect("writes");
    let Update::Run(record) = asked_of_runs(&mut person, r#"{"c":"run","number":1}"#) else {
        panic!("no run")
    };
    let recordings = record.run.recordings.iter();
    let paths: Vec<_> = recordings
        .map(|known| scratch.join("state/runs").join(&known.name))
        .collect();
    assert_eq!(paths.len(), 2);
    let alone = paths.iter().map(|path| steps_that_replay(path));
    assert_eq!(steps_that_replay(&file), alone.sum::<u64>());
}

/// All recordings of the first run as one file, of which a piece in the middle comes also alone.
fn whole_file(person: &mut Client) -> Vec<u8> {
    let mut piece = |from: usize| {
        let request = format!(r#"{{"c":"run-file","number":1,"from":{from}}}"#);
        match asked_of_runs(person, &request) {
            Update::RunFile { data, size, .. } => {
                assert_eq!(size, None);
                STANDARD.decode(data).expect("base 64")
            }
            other => panic!("no piece: {other:?}"),
        }
    };
    let mut bytes = Vec::new();
    loop {
        let next = piece(bytes.len());
        if next.is_empty() {
            break;
        }
        bytes.extend(next);
    }
    let middle = bytes.len() / 2;
    let again = piece(middle);
    assert!(!again.is_empty() && bytes[middle..].starts_with(&again));
    bytes
}

fn replay(path: &Path) -> std::process::Output {
    let mut command = Command::new(vthal());
    command.arg("replay").arg(path).output().expect("runs")
}

/// How many steps of a recording the brain decides in the same way again.
fn steps_that_replay(path: &Path) -> u64 {
    let text = String::from_utf8_lossy(&replay(path).stdout).into_owned();
    let steps = text
        .strip_prefix("identical: ")
        .and_then(|rest| rest.split(' ').next());
    steps
        .and_then(|steps| steps.parse().ok())
        .unwrap_or_else(|| panic!("{text}"))
}

#[test]
fn systemd_hears_when_it_is_ready_that_its_loop_turns_and_when_it_ends() {
    let scratch = Scratch::new().expect("creates");
    let notify = UnixDatagram::bind(scratch.join("notify.sock")).expect("binds");
    notify
        .set_read_timeout(Some(Duration::from_secs(10)))
        .expect("a timeout");
    let mut daemon = Command::new(vthal())
        .args(["--serial", "/dev/null", "--socket"])
        .arg(scratch.join("vthal.sock"))
        .arg("--state")
        .arg(scratch.join("state"))
        .env("NOTIFY_SOCKET", scratch.join("notify.sock"))
        .env("WATCHDOG_USEC", "200000")
        .stdout(Stdio::null())
        .spawn()
        .expect("starts");
    let hear = || {
        let mut bytes = [0; 256];
        let count = notify.recv(&mut bytes).expect("a word in time");
        String::from_utf8_lossy(&bytes[..count]).trim_end().to_owned()
    };
    let words: Vec<String> = (0..4).map(|_| hear()).collect();
    assert_eq!(words, ["READY=1", "WATCHDOG=1", "WATCHDOG=1", "WATCHDOG=1"]);
    kill_process(Pid::from_child(&daemon), Signal::TERM).expect("signals");
    while hear() != "STOPPING=1" {}
    assert!(daemon.wait().expect("ends").success());
}
