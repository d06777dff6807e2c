//! A robot that says what no robot says, rightly sealed or not at all, while an honest client starts and stops it.

use std::path::Path;
use std::time::{Duration, Instant};

use rvac_api::Update;
use rvac_protocol::message::BinaryKinds;
use serde_json::Value;
use vthal_bench::nonsense::{index, value};
use vthal_bench::{Client, LivingRobot, Scratch, SyntheticRobot, next_random, resident_max_mib};

use crate::little_memory::{PATIENCE, press_stop, start_in_little_memory};

/// After so many packets each the robot listens once.
const LISTENS_EVERY: usize = 10;
/// So long what it has said may be on its way at most.
const LISTENS_FOR: Duration = Duration::from_millis(1);
/// One packet of the protocol in so many is a greeting: after one the session begins anew, and little else is heard for a while.
const GREETINGS: usize = 200;

/// A value of a report that is in its range or just beyond it, or of another type.
fn hostile(state: &mut u64) -> Value {
    let number = match index(state, 12) {
        0 => 0.0,
        1 => -1.0,
        2 => 1e-6,
        3 => 2_147.483_647,
        4 => -2_147.483_648,
        5 => 2_147_483_647.0,
        6 => -2_147_483_648.0,
        7 => 4_294_967_295.0,
        8 => 65.535,
        9 => -32.767,
        10 => return serde_json::from_str(&value(state)).unwrap_or(Value::Null),
        _ => return Value::from(next_random(state) as u32),
    };
    Value::from(number)
}

/// A report of the protocol's golden vectors with up to three of its values, or of its keys, changed.
fn report(reports: &[Value], state: &mut u64) -> String {
    let mut report = reports[index(state, reports.len())].clone();
    if report["c"] == "hello" && index(state, GREETINGS) != 0 {
        report = reports[reports.len() - 1].clone();
    }
    let keys: Vec<String> = report.as_object().expect("an object").keys().cloned().collect();
    for _ in 0..index(state, 4) {
        let key = &keys[index(state, keys.len())];
        match index(state, 8) {
            0 => drop(report.as_object_mut().expect("an object").remove(key)),
            1 => report[format!("{key}{key}")] = hostile(state),
            _ if key == "c" => {}
            _ => report[key] = hostile(state),
        }
    }
    report.to_string()
}

/// What was told as golden vectors, without seals.
fn reports() -> Vec<Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocol/vectors/reports.json");
    let text = std::fs::read_to_string(path).expect("reads");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let vectors = file["vectors"].as_array().expect("a list");
    let lines = vectors.iter().filter_map(|vector| vector["line"].as_str());
    lines
        .flat_map(|line| line.split('\u{1f}'))
        .map(|packet| packet.rsplit_once('*').expect("a seal").0)
        .map(|text| serde_json::from_str(text).expect("JSON"))
        .collect()
}

/// Says so many packets of all that a damaged robot may say; it goes on as a sound one. Gives how many packets a daemon with an open
/// session got, too.
fn rave(mut robot: SyntheticRobot, packets: usize) -> (SyntheticRobot, usize) {
    let (reports, mut state, mut heard) = (reports(), 1, 0);
    for number in 0..packets {
        heard += usize::from(robot.is_sealed());
        match index(&mut state, 12) {
            0 => robot.report().map(drop),
            1 => robot.blurt(&next_random(&mut state).to_le_bytes()),
            2 => robot.blurt(report(&reports, &mut state).as_bytes()),
            _ => robot.say_text(&report(&reports, &mut state)),
        }
        .expect("says");
        if number % LISTENS_EVERY == 0 {
            robot.listen(Instant::now() + LISTENS_FOR).expect("listens");
        }
    }
    robot.blurt(b"\x1f").expect("ends what it has begun");
    (robot, heard)
}

#[test]
fn a_robot_that_raves_ends_nothing_and_serves_again_when_it_is_sound() {
    raves_for(10_000);
}

#[test]
#[ignore = "campaign: 100,000 packets; cargo xtask test --all"]
fn a_robot_that_raves_for_a_hundred_thousand_packets_ends_nothing() {
    raves_for(100_000);
}

fn raves_for(packets: usize) {
    let scratch = Scratch::new().expect("creates");
    let robot =
        SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("opens a terminal");
    let mut daemon = start_in_little_memory(&scratch);
    let mut honest = Client::watching(&scratch.join("vthal.sock"), r#"["status"]"#).expect("connects");
    let raving = std::thread::spawn(move || rave(robot, packets));
    let mut slowest = Duration::ZERO;
    for id in 1.. {
        honest.send(r#"{"c":"start"}"#).expect("sends");
        slowest = slowest.max(press_stop(&mut honest, id));
        if raving.is_finished() {
            break;
        }
    }
    assert_eq!(daemon.ended().expect("asks"), None, "the daemon lives");
    let most_mib = resident_max_mib(daemon.id()).expect("the daemon lives");
    println!(
        "slowest Stop: {} ms; memory at most: {most_mib:.1} MiB",
        slowest.as_millis()
    );
    let (robot, heard) = raving.join().expect("it said all");
    assert!(
        heard > packets / 2,
        "few packets had the seal of a session: {heard}"
    );
    let _robot = LivingRobot::new(robot);
    let deadline = Instant::now() + PATIENCE;
    let cleans = |update: &Update| matches!(update, Update::Status(status) if status.state == "cleaning");
    while honest
        .wait_for(Instant::now() + Duration::from_millis(500), cleans)
        .expect("reads")
        .is_none()
    {
        assert!(Instant::now() < deadline, "a sound robot cleans");
        honest.send(r#"{"c":"start"}"#).expect("sends");
    }
}
