//! Kept files that a worn card, another program or a curious person has changed: the daemon starts and serves with whatever is left, in
//! little memory, and throws away nothing that it cannot read.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rvac_api::{Request, RequestBody, Update};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::nonsense::{change, index};
use vthal_bench::{
    Client, Daemon, LivingRobot, Scratch, SyntheticRobot, keep_home, next_random, resident_max_mib,
};

use crate::little_memory::{PATIENCE, press_stop, start_in_little_memory};

/// Starts with other damage each.
const STARTS: u64 = 100;
const LOOK_EVERY: Duration = Duration::from_millis(5);
/// What a daemon writes anew without being asked, and so keeps no damaged version of: its own notes of this start and the last.
const WRITTEN_ANYWAY: [&str; 4] = ["vthal.pid", "log", "checkpoint", "recordings"];

/// A kept file: its path in the folder, and its bytes.
type Kept = (PathBuf, Vec<u8>);

/// Ends it as the system does, and expects that it ends well.
fn end(mut daemon: Daemon) {
    daemon.terminate().expect("signals");
    let deadline = Instant::now() + PATIENCE;
    loop {
        if let Some(code) = daemon.ended().expect("asks") {
            assert_eq!(code, 0, "it ends well");
            return;
        }
        assert!(Instant::now() < deadline, "it ends");
        std::thread::sleep(LOOK_EVERY);
    }
}

fn ask(client: &mut Client, request: &str) {
    client.send(request).expect("sends");
    let is_answer = |update: &Update| match update {
        Update::Done { id } => *id == 9,
        Update::Failed(failure) => failure.id == Some(9),
        _ => false,
    };
    let answer = client.wait_for(Instant::now() + PATIENCE, is_answer);
    let answer = answer.expect("reads").expect("an answer");
    assert!(matches!(answer, Update::Done { .. }), "{request}: {answer:?}");
}

/// A folder in which each kind of file was kept by a daemon.
fn lived_in() -> Vec<Kept> {
    let scratch = Scratch::new().expect("creates");
    keep_home(&scratch).expect("writes");
    let mut robot =
        SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("opens a terminal");
    robot.dock();
    let _robot = LivingRobot::new(robot);
    let daemon = start_in_little_memory(&scratch);
    let mut client = Client::watching(&scratch.join("vthal.sock"), r#"["log","status"]"#).expect("connects");
    let takes_map =
        |update: &Update| matches!(update, Update::Log(entry) if entry.text.contains("takes up the map"));
    let taken = client.wait_for(Instant::now() + PATIENCE, takes_map);
    assert!(taken.expect("reads").is_some(), "the map is taken up");
    let save_mix = Request {
        id: Some(9),
        body: RequestBody::SaveMix {
            profile: mixer::standard_profile().to_json(),
            was: None,
        },
    };
    let save_mix = serde_json::to_string(&save_mix).expect("JSON");
    for request in [
        r#"{"c":"set-zone","zone":"Europe/Tallinn","id":9}"#,
        r#"{"c":"add-schedule","name":"Köök","job":{"start":{}},"when":{"weekly":{"days":["mo"],"at":"07:30"}},"id":9}"#,
        r#"{"c":"add-no-go","shape":{"wall":[[1.0,0.5],[1.0,1.5]]},"id":9}"#,
        &save_mix,
        r#"{"c":"start","id":9}"#,
    ] {
        ask(&mut client, request);
    }
    let cleans = |update: &Update| matches!(update, Update::Status(status) if status.state == "cleaning");
    let cleaning = client.wait_for(Instant::now() + PATIENCE, cleans);
    assert!(cleaning.expect("reads").is_some(), "it cleans");
    press_stop(&mut client, 9);
    end(daemon);
    files_below(&scratch.join("state"))
}

/// All files of a folder, in order.
fn files_below(folder: &Path) -> Vec<Kept> {
    let mut files = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below it").to_path_buf();
                files.push((name, fs::read(&path).expect("reads")));
            }
        }
    }
    files.sort();
    files
}

/// The bytes of a file as something has changed them.
fn damaged(bytes: &[u8], state: &mut u64) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if let (Ok(mut document), true) = (serde_json::from_slice(&bytes), index(state, 2) == 0) {
        change(&mut document, state);
        return document.to_string().into_bytes();
    }
    let at = index(state, bytes.len().max(1));
    match index(state, 6) {
        // A write that was cut off, and blocks that were never written.
        0 => bytes.truncate(at),
        1 => bytes.iter_mut().skip(at).for_each(|byte| *byte = 0),
        2 => bytes.fill(0),
        3 => bytes.extend((0..4096).map(|_| next_random(state) as u8)),
        4 => {
            bytes = (0..index(state, 100_000))
                .map(|_| next_random(state) as u8)
                .collect()
        }
        _ => bytes
            .iter_mut()
            .skip(at)
            .take(8)
            .for_each(|byte| *byte ^= 1 << index(state, 8)),
    }
    bytes
}

/// Writes the files with damage in up to three of them; gives those as they are now.
fn write_damaged(files: &[Kept], folder: &Path, state: &mut u64) -> Vec<Kept> {
    let mut files = files.to_vec();
    let mut changed = Vec::new();
    for _ in 0..=index(state, 3) {
        let which = index(state, files.len());
        files[which].1 = damaged(&files[which].1, state);
        changed.push(which);
    }
    for (name, bytes) in &files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("creates");
        fs::write(path, bytes).expect("writes");
    }
    changed.into_iter().map(|which| files[which].clone()).collect()
}

/// Whether the daemon still has these bytes, under whatever name.
fn is_still_there(folder: &Path, (name, bytes): &Kept) -> bool {
    let is_own_note = WRITTEN_ANYWAY
        .iter()
        .any(|written| name.to_string_lossy().starts_with(written));
    is_own_note || bytes.is_empty() || files_below(folder).iter().any(|(_, found)| found == bytes)
}

#[test]
fn whatever_happens_to_kept_files_the_daemon_serves_and_throws_nothing_away() {
    let files = lived_in();
    let names: Vec<_> = files.iter().map(|(name, _)| name).collect();
    println!("{names:?}");
    let mut most_mib = 0.0_f64;
    for seed in 1..=STARTS {
        let scratch = Scratch::new().expect("creates");
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let changed = write_damaged(&files, &scratch.join("state"), &mut state);
        let names: Vec<_> = changed.iter().map(|(name, _)| name).collect();
        let daemon = start_in_little_memory(&scratch);
        let mut client = Client::connect(&scratch.join("vthal.sock")).expect("connects");
        ask(&mut client, r#"{"c":"maps","id":9}"#);
        ask(&mut client, r#"{"c":"mixes","id":9}"#);
        ask(&mut client, r#"{"c":"runs","id":9}"#);
        most_mib = most_mib.max(resident_max_mib(daemon.id()).expect("it lives"));
        end(daemon);
        for kept in &changed {
            assert!(
                is_still_there(&scratch.join("state"), kept),
                "start {seed}: {} is lost ({names:?} were damaged)",
                kept.0.display()
            );
        }
    }
    println!("memory at most: {most_mib:.1} MiB");
}
