//! What a robot has learnt of itself is told over the socket, and forgotten when somebody says so. The real binary, a
//! pseudo terminal and real sockets.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use rvac_api::{LearntView, Update};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, Daemon, LivingRobot, Scratch, SyntheticRobot};

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(20);

/// Of the robot of these tests, and of another one.
const KEPT: &str = r#"{"version":1,"devices":[
    {"device":"relax","energy":{"cleaning_per_s":0.0003,"driving_per_s":0.0001,"seen_s":600.0}},
    {"device":"synthetic","gyro":{"scale":0.012,"scale_sigma":0.001,"bias_rad_per_s":-0.002},
     "energy":{"cleaning_per_s":0.00025,"driving_per_s":0.0001,"seen_s":1200.0}}]}"#;

fn soon() -> Instant {
    Instant::now() + PATIENCE
}

/// A daemon, and a client that has seen the robot greet it.
fn start(scratch: &Scratch) -> (Daemon, Client) {
    let vthal = Path::new(env!("CARGO_BIN_EXE_vthal"));
    let daemon = Daemon::start(vthal, scratch, &["--seed", "1"]).expect("gets ready");
    let mut client = Client::watching(&scratch.join("vthal.sock"), r#"["status"]"#).expect("connects");
    wait_for_state(&mut client, "idle");
    (daemon, client)
}

fn wait_for_state(client: &mut Client, wanted: &str) {
    let is_there = |update: &Update| matches!(update, Update::Status(status) if status.state == wanted);
    let found = client.wait_for(soon(), is_there).expect("reads");
    assert!(found.is_some(), "never {wanted}");
}

fn learnt(client: &mut Client) -> Vec<LearntView> {
    client.send(r#"{"c":"learnt","id":3}"#).expect("sends");
    let is_told = |update: &Update| matches!(update, Update::Learnt { id: Some(3), .. });
    match client.wait_for(soon(), is_told).expect("reads") {
        Some(Update::Learnt { devices, .. }) => devices,
        other => panic!("it does not say: {other:?}"),
    }
}

/// The reason for which a request is refused; `None` = it is done.
fn asked(client: &mut Client, request: &str) -> Option<String> {
    client.send(request).expect("sends");
    let is_answer = |update: &Update| matches!(update, Update::Done { id: 7 } | Update::Failed(_));
    match client.wait_for(soon(), is_answer).expect("reads") {
        Some(Update::Failed(failure)) => Some(failure.reason),
        Some(_) => None,
        None => panic!("no answer to {request}"),
    }
}

fn robot(scratch: &Scratch) -> LivingRobot {
    let robot = SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1);
    LivingRobot::new(robot.expect("opens a terminal"))
}

fn scratch() -> (Scratch, std::path::PathBuf) {
    let scratch = Scratch::new().expect("creates");
    let file = scratch.join("state/learnt.json");
    fs::create_dir_all(scratch.join("state")).expect("creates");
    fs::write(&file, KEPT).expect("writes");
    (scratch, file)
}

#[test]
fn what_is_forgotten_is_gone_from_the_disk_and_from_the_robot() {
    let (scratch, file) = scratch();
    let _robot = robot(&scratch);
    let (mut daemon, mut client) = start(&scratch);
    let told = learnt(&mut client);
    let names: Vec<_> = told
        .iter()
        .map(|view| (view.device.as_str(), view.here))
        .collect();
    assert_eq!(names, [("relax", false), ("synthetic", true)]);
    assert_eq!(told[1].gyro.map(|gyro| gyro.scale), Some(0.012));
    let energy = told[1].energy.expect("is told");
    assert!((energy.cleaning_per_h - 0.9).abs() < 1e-9, "{energy:?}");

    let of_gyro = r#"{"c":"forget-learnt","device":"synthetic","part":"gyro","id":7}"#;
    assert_eq!(asked(&mut client, of_gyro), None);
    let text = fs::read_to_string(&file).expect("is there");
    assert!(!text.contains("gyro") && text.contains("synthetic"), "{text}");
    // It writes down what the robot knows when it ends: nothing of the gyro.
    daemon.terminate().expect("signals");
    while daemon.ended().expect("asks").is_none() {
        std::thread::sleep(Duration::from_millis(20));
    }
    let (_daemon, mut client) = start(&scratch);
    let told = learnt(&mut client);
    let here = told.iter().find(|view| view.here).expect("its pack is known");
    assert_eq!((here.gyro, here.energy.is_some()), (None, true));

    assert_eq!(
        asked(&mut client, r#"{"c":"forget-learnt","device":"relax","id":7}"#),
        None
    );
    assert_eq!(learnt(&mut client).len(), 1);
}

#[test]
fn nothing_is_forgotten_under_a_job_of_strangers_or_against_the_disk() {
    let (scratch, file) = scratch();
    let _robot = robot(&scratch);
    let (_daemon, mut client) = start(&scratch);
    let ghost = r#"{"c":"forget-learnt","device":"ghost","id":7}"#;
    assert_eq!(asked(&mut client, ghost).as_deref(), Some("nothing-learnt"));
    let own = r#"{"c":"forget-learnt","device":"synthetic","id":7}"#;
    client.send(r#"{"c":"start"}"#).expect("sends");
    wait_for_state(&mut client, "cleaning");
    assert_eq!(asked(&mut client, own).as_deref(), Some("job-runs"));
    let before = learnt(&mut client);
    // The file that is to take its place cannot be made.
    fs::create_dir_all(file.with_extension("json.new")).expect("creates");
    let of_other = r#"{"c":"forget-learnt","device":"relax","id":7}"#;
    assert_eq!(asked(&mut client, of_other).as_deref(), Some("learnt-unwritable"));
    let mut after = learnt(&mut client);
    after.sort_by(|one, other| one.device.cmp(&other.device));
    assert_eq!(after, before);
}
