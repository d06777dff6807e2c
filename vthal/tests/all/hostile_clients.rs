//! Clients that nobody would write, many at a time and of every kind, while an honest one presses Stop.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rvac_api::{Schedules, Update};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{
    Client, HostileKind, LivingRobot, Scratch, Siege, SyntheticRobot, keep_home, resident_max_mib,
};

use crate::little_memory::{PATIENCE, press_stop, start_in_little_memory};

/// So often Stop is pressed meanwhile.
const STOPS: u32 = 100;
/// Those who take part, and so many of each; `cargo xtask bench siege` measures all kinds.
const BESIEGERS: [HostileKind; 5] = [
    HostileKind::NeverReads,
    HostileKind::AsksNonsense,
    HostileKind::ComesAndGoes,
    HostileKind::StopsInTheMiddle,
    HostileKind::NeverEndsAMessage,
];
const OF_A_KIND: u64 = 4;
/// What is kept on the disk and told to whoever asks.
const KEPT_TOPICS: &str = r#"{"c":"watch","topics":["schedules","floors"]}"#;
const KINDS: usize = 6;
const KEPT: [&str; 4] = [
    r#"{"c":"mixes","id":1}"#,
    r#"{"c":"maps","id":2}"#,
    r#"{"c":"learnt","id":3}"#,
    r#"{"c":"runs","id":4}"#,
];

/// All that is kept, as a client is told it, by kind. What is read from the disk may come after what was asked later.
fn kept(socket: &Path) -> BTreeMap<&'static str, String> {
    let mut client = Client::connect(socket).expect("connects");
    client.send(KEPT_TOPICS).expect("sends");
    for question in KEPT {
        client.send(question).expect("sends");
    }
    let mut told = BTreeMap::new();
    let last = client.wait_for(Instant::now() + PATIENCE, |update| {
        let (kind, says) = match update {
            // On which of them the robot stands it finds out anew.
            Update::Floors(view) => ("floors", format!("{:?}", view.floors)),
            Update::Maps { maps, .. } => ("maps", format!("{maps:?}")),
            Update::Schedules(schedules) => ("schedules", what_is_kept_of_schedules(schedules)),
            Update::Mixes { mixes } => ("mixes", format!("{mixes:?}")),
            Update::Learnt { devices, .. } => ("learnt", format!("{devices:?}")),
            Update::Runs { runs, .. } => ("runs", format!("{runs:?}")),
            _ => return false,
        };
        told.insert(kind, says);
        told.len() == KINDS
    });
    assert!(last.expect("reads").is_some(), "all was told: {told:#?}");
    told
}

/// Without what the clock says.
fn what_is_kept_of_schedules(schedules: &Schedules) -> String {
    let entries: Vec<_> = schedules
        .entries
        .iter()
        .map(|view| (view.number, &view.entry))
        .collect();
    format!("{entries:?}, {:?}, {:?}", schedules.quiet, schedules.zone)
}

/// Stop is pressed by an honest client while all kinds of others do their deeds, until so many requests of nonsense were sent; gives the
/// times until it was done, in order.
fn besiege(socket: &Path, requests: u64) -> Vec<Duration> {
    let mut honest = Client::watching(socket, r#"["status"]"#).expect("connects");
    let siege = Siege::default();
    std::thread::scope(|scope| {
        for (kind, number) in BESIEGERS
            .iter()
            .flat_map(|kind| (1..=OF_A_KIND).map(move |number| (kind, number)))
        {
            let siege = &siege;
            scope.spawn(move || kind.besiege(socket, number, siege));
        }
        let _ended = siege.end();
        let mut times = Vec::new();
        for id in 1.. {
            times.push(press_stop(&mut honest, id));
            if id >= STOPS && siege.nonsense() >= requests {
                break;
            }
        }
        times.sort_unstable();
        times
    })
}

#[test]
fn stop_is_answered_through_a_siege_with_little_memory_and_what_is_kept_is_what_was_answered() {
    siege_with(20_000);
}

#[test]
#[ignore = "campaign: 100,000 requests; cargo xtask test --all"]
fn stop_is_answered_through_a_siege_of_a_hundred_thousand_requests() {
    siege_with(100_000);
}

fn siege_with(requests: u64) {
    let scratch = Scratch::new().expect("creates");
    keep_home(&scratch).expect("writes");
    let mut robot =
        SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("opens a terminal");
    robot.dock();
    let _robot = LivingRobot::new(robot);
    let mut daemon = start_in_little_memory(&scratch);
    let socket: PathBuf = scratch.join("vthal.sock");
    let times = besiege(&socket, requests);
    println!(
        "Stop {} times: half within {} ms, 99 of 100 within {} ms",
        times.len(),
        times[times.len() / 2].as_millis(),
        times[times.len() * 99 / 100].as_millis()
    );
    assert_eq!(daemon.ended().expect("asks"), None, "the daemon lives");
    let most_mib = resident_max_mib(daemon.id()).expect("the daemon lives");
    println!("memory at most: {most_mib:.1} MiB");
    // What was started after the last Stop ends here.
    press_stop(&mut Client::connect(&socket).expect("connects"), 1);
    let told = kept(&socket);
    // Without a warning: what was told is on the disk.
    daemon.kill().expect("kills");
    let _daemon = start_in_little_memory(&scratch);
    assert_eq!(told, kept(&socket));
}
