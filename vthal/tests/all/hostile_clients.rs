//! Clients that nobody would write, many at a time and of every kind, while an honest one presses Stop.

use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use rvac_api::{Update, VERBS};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, Daemon, LivingRobot, Scratch, SyntheticRobot, next_random, resident_max_mib};

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(20);
/// So often Stop is pressed meanwhile.
const STOPS: u32 = 100;
/// Those that wait, wait so long before they come again.
const LULL: Duration = Duration::from_millis(500);
/// Of each kind.
const OF_A_KIND: u64 = 4;
/// A board of a robot has 512 MiB for everything.
const RESIDENT_MIB_MAX: f64 = 256.0;
const ALL_TOPICS: &str = r#"{"c":"watch","topics":["status","pose","device","map","home","estimate","way","decisions","log","packets","schedules","runs","floors","standstills","buttons","inputs"]}"#;

/// What a client does until the siege is over.
type Deed = fn(&Path, u64, &AtomicBool);

const DEEDS: [Deed; 5] = [
    never_reads,
    asks_nonsense,
    comes_and_goes,
    stops_in_the_middle,
    never_ends_a_message,
];

/// Ends it when this goes, also when a check has failed.
struct UntilHere<'a>(&'a AtomicBool);

impl Drop for UntilHere<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

fn is_over(over: &AtomicBool) -> bool {
    over.load(Ordering::Relaxed)
}

/// Follows everything and takes nothing.
fn never_reads(socket: &Path, _: u64, over: &AtomicBool) {
    while !is_over(over) {
        let Ok(mut stream) = UnixStream::connect(socket) else {
            continue;
        };
        if stream.write_all(format!("{ALL_TOPICS}\u{1f}").as_bytes()).is_ok() {
            // The daemon may hang up before that, and is asked again.
            std::thread::sleep(LULL);
        }
    }
}

/// Real words with wrong, huge, missing and surplus arguments, as fast as they are taken.
fn asks_nonsense(socket: &Path, seed: u64, over: &AtomicBool) {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    while !is_over(over) {
        let Ok(mut stream) = UnixStream::connect(socket) else {
            continue;
        };
        stream.set_nonblocking(true).expect("a socket can be told");
        let mut answers = [0; 4096];
        while !is_over(over) {
            // Full is full: then the answers are read.
            let sent = stream.write(format!("{}\u{1f}", nonsense(&mut state)).as_bytes());
            let read = stream.read(&mut answers);
            let is_gone = |result: &std::io::Result<usize>| {
                result
                    .as_ref()
                    .is_err_and(|error| error.kind() != std::io::ErrorKind::WouldBlock)
            };
            if is_gone(&sent) || is_gone(&read) || matches!(read, Ok(0)) {
                break;
            }
        }
    }
}

fn comes_and_goes(socket: &Path, _: u64, over: &AtomicBool) {
    while !is_over(over) {
        // Nothing is wanted of it.
        drop(UnixStream::connect(socket));
    }
}

fn stops_in_the_middle(socket: &Path, _: u64, over: &AtomicBool) {
    while !is_over(over) {
        if let Ok(mut stream) = UnixStream::connect(socket) {
            // Refused or not, it waits.
            stream.write_all(br#"{"c":"dri"#).ok();
            std::thread::sleep(LULL);
        }
    }
}

fn never_ends_a_message(socket: &Path, _: u64, over: &AtomicBool) {
    while !is_over(over) {
        if let Ok(mut stream) = UnixStream::connect(socket) {
            // Until the daemon hangs up.
            while !is_over(over) && stream.write_all(&[b'['; 4096]).is_ok() {}
        }
    }
}

const FIELDS: [&str; 24] = [
    "id", "name", "topics", "strategy", "shape", "number", "room", "rooms", "settings", "v", "w", "ttl",
    "floor", "from", "size", "data", "profile", "zone", "quiet", "before", "count", "part", "values",
    "parts",
];

/// A request with a real word and up to four arguments that are seldom right. Never what makes the daemon leave its robot to another program.
fn nonsense(state: &mut u64) -> String {
    let (verb, _) = VERBS[index(state, VERBS.len())];
    let verb = if verb == "borrow-link" { "dock" } else { verb };
    let mut text = format!(r#"{{"c":"{verb}""#);
    for _ in 0..index(state, 5) {
        text.push_str(&format!(
            r#","{}":{}"#,
            FIELDS[index(state, FIELDS.len())],
            value(state)
        ));
    }
    text.push('}');
    text
}

fn index(state: &mut u64, count: usize) -> usize {
    (next_random(state) % count as u64) as usize
}

fn value(state: &mut u64) -> String {
    match index(state, 10) {
        0 => next_random(state).to_string(),
        1 => format!("-{}", index(state, 1000)),
        2 => "1e308".to_owned(),
        3 => "null".to_owned(),
        4 => format!("\"{}\"", "õ".repeat(index(state, 3000))),
        5 => format!("{}{}", "[".repeat(60), "]".repeat(60)),
        6 => r#"{"zone":[[0,0],[1e300,0],[0,-1e300]]}"#.to_owned(),
        7 => r#"["log","packets","log"]"#.to_owned(),
        8 => "0.1".to_owned(),
        _ => "true".to_owned(),
    }
}

/// Presses Stop again and again, each time when the last one is done.
fn press_stop(client: &mut Client) {
    for id in 1..=STOPS {
        let stop = format!(r#"{{"c":"stop","id":{id}}}"#);
        client.send(&stop).expect("the honest client is not hung up on");
        let is_done = |update: &Update| matches!(update, Update::Done { id: done } if *done == id);
        let done = client.wait_for(Instant::now() + PATIENCE, is_done);
        assert!(done.expect("reads").is_some(), "stop {id} is answered");
    }
}

#[test]
fn stop_is_answered_through_a_siege_and_memory_stays_small() {
    let scratch = Scratch::new().expect("creates");
    let robot =
        SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("opens a terminal");
    let _robot = LivingRobot::new(robot);
    let vthal = Path::new(env!("CARGO_BIN_EXE_vthal"));
    let mut daemon = Daemon::start(vthal, &scratch, &["--seed", "1"]).expect("gets ready");
    let socket: PathBuf = scratch.join("vthal.sock");
    let mut honest = Client::watching(&socket, r#"["status"]"#).expect("connects");
    let over = AtomicBool::new(false);
    let most_mib = std::thread::scope(|scope| {
        for (deed, number) in DEEDS
            .iter()
            .flat_map(|deed| (1..=OF_A_KIND).map(move |number| (deed, number)))
        {
            let (socket, over) = (&socket, &over);
            scope.spawn(move || deed(socket, number, over));
        }
        let _ended = UntilHere(&over);
        press_stop(&mut honest);
        resident_max_mib(daemon.id())
    });
    assert_eq!(daemon.ended().expect("asks"), None, "the daemon lives");
    let most_mib = most_mib.expect("the daemon lives");
    println!("memory at most: {most_mib:.1} MiB");
    assert!(most_mib < RESIDENT_MIB_MAX, "{most_mib} MiB");
    let mut late = Client::watching(&socket, r#"["status"]"#).expect("connects after it");
    let told = late.wait_for(Instant::now() + PATIENCE, |update| {
        matches!(update, Update::Status(_))
    });
    assert!(told.expect("reads").is_some(), "whoever comes later is served");
}
