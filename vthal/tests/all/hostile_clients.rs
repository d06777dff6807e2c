//! Clients that nobody would write, many at a time and of every kind, while an honest one presses Stop.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use rvac_api::Update;
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, LivingRobot, Scratch, SyntheticRobot, resident_max_mib};

use crate::nonsense::{PATIENCE, press_stop, request, start_in_little_memory};

/// So often Stop is pressed meanwhile, and until so much nonsense was sent.
const STOPS: u32 = 100;
const REQUESTS: u64 = 100_000;
/// Those that wait, wait so long before they come again.
const LULL: Duration = Duration::from_millis(500);
/// Of each kind.
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
const ALL_TOPICS: &str = r#"{"c":"watch","topics":["status","pose","device","map","home","estimate","way","decisions","log","packets","schedules","runs","floors","standstills","buttons","inputs"]}"#;

/// What all who take part know of it.
#[derive(Default)]
struct Siege {
    is_over: AtomicBool,
    /// Requests of nonsense that were taken.
    requests: AtomicU64,
}

/// What a client does until the siege is over.
type Deed = fn(&Path, u64, &Siege);

const DEEDS: [Deed; 5] = [
    never_reads,
    asks_nonsense,
    comes_and_goes,
    stops_in_the_middle,
    never_ends_a_message,
];

/// Ends it when this goes, also when a check has failed.
struct UntilHere<'a>(&'a Siege);

impl Drop for UntilHere<'_> {
    fn drop(&mut self) {
        self.0.is_over.store(true, Ordering::Relaxed);
    }
}

impl Siege {
    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}

/// Follows everything and takes nothing.
fn never_reads(socket: &Path, _: u64, siege: &Siege) {
    while !siege.is_over() {
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
fn asks_nonsense(socket: &Path, seed: u64, siege: &Siege) {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    while !siege.is_over() {
        let Ok(mut stream) = UnixStream::connect(socket) else {
            continue;
        };
        stream.set_nonblocking(true).expect("a socket can be told");
        let mut answers = [0; 4096];
        while !siege.is_over() {
            // Full is full: then the answers are read.
            let sent = stream.write(format!("{}\u{1f}", request(&mut state)).as_bytes());
            siege
                .requests
                .fetch_add(u64::from(sent.is_ok()), Ordering::Relaxed);
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

fn comes_and_goes(socket: &Path, _: u64, siege: &Siege) {
    while !siege.is_over() {
        // Nothing is wanted of it.
        drop(UnixStream::connect(socket));
    }
}

fn stops_in_the_middle(socket: &Path, _: u64, siege: &Siege) {
    while !siege.is_over() {
        if let Ok(mut stream) = UnixStream::connect(socket) {
            // Refused or not, it waits.
            stream.write_all(br#"{"c":"dri"#).ok();
            std::thread::sleep(LULL);
        }
    }
}

fn never_ends_a_message(socket: &Path, _: u64, siege: &Siege) {
    while !siege.is_over() {
        if let Ok(mut stream) = UnixStream::connect(socket) {
            // Until the daemon hangs up.
            while !siege.is_over() && stream.write_all(&[b'['; 4096]).is_ok() {}
        }
    }
}

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
            Update::Schedules(schedules) => ("schedules", format!("{schedules:?}")),
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

/// Stop is pressed by an honest client while all kinds of others do their deeds; gives the times until it was done, in order.
fn besiege(socket: &Path) -> Vec<Duration> {
    let mut honest = Client::watching(socket, r#"["status"]"#).expect("connects");
    let siege = Siege::default();
    std::thread::scope(|scope| {
        for (deed, number) in DEEDS
            .iter()
            .flat_map(|deed| (1..=OF_A_KIND).map(move |number| (deed, number)))
        {
            let siege = &siege;
            scope.spawn(move || deed(socket, number, siege));
        }
        let _ended = UntilHere(&siege);
        let mut times = Vec::new();
        for id in 1.. {
            times.push(press_stop(&mut honest, id));
            if id >= STOPS && siege.requests.load(Ordering::Relaxed) >= REQUESTS {
                break;
            }
        }
        times.sort_unstable();
        times
    })
}

#[test]
fn stop_is_answered_through_a_siege_with_little_memory_and_what_is_kept_is_what_was_answered() {
    let scratch = Scratch::new().expect("creates");
    let robot =
        SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("opens a terminal");
    let robot = LivingRobot::new(robot);
    let mut daemon = start_in_little_memory(&scratch);
    let socket: PathBuf = scratch.join("vthal.sock");
    let times = besiege(&socket);
    println!(
        "Stop {} times: half within {} ms, 99 of 100 within {} ms",
        times.len(),
        times[times.len() / 2].as_millis(),
        times[times.len() * 99 / 100].as_millis()
    );
    assert_eq!(daemon.ended().expect("asks"), None, "the daemon lives");
    let most_mib = resident_max_mib(daemon.id()).expect("the daemon lives");
    println!("memory at most: {most_mib:.1} MiB");
    let told = kept(&socket);
    // Without a warning: what was told is on the disk.
    daemon.kill().expect("kills");
    drop(robot);
    let _daemon = start_in_little_memory(&scratch);
    assert_eq!(told, kept(&socket));
}
