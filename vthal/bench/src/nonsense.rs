//! Requests that nobody would write, a daemon with little memory that gets them, and an honest client beside those who write them.

use std::path::Path;
use std::time::{Duration, Instant};

use rvac_api::{Update, VERBS};
use vthal_bench::{Client, Daemon, Scratch, next_random};

/// Generous: the machine may be busy with other tests.
pub(crate) const PATIENCE: Duration = Duration::from_secs(20);
/// All the memory that the daemon can ask for in a siege, what its program takes included. A board of a robot has 512 MiB for everything.
const ADDRESS_SPACE_BYTES: u64 = 256 << 20;

const FIELDS: [&str; 24] = [
    "id", "name", "topics", "strategy", "shape", "number", "room", "rooms", "settings", "v", "w", "ttl",
    "floor", "from", "size", "data", "profile", "zone", "quiet", "before", "count", "part", "values",
    "parts",
];

/// Starts the daemon in so much memory.
pub(crate) fn start_in_little_memory(scratch: &Scratch) -> Daemon {
    let vthal = Path::new(env!("CARGO_BIN_EXE_vthal"));
    Daemon::start_within(ADDRESS_SPACE_BYTES, vthal, scratch, &["--seed", "1"]).expect("gets ready")
}

/// A request with a real word and up to four arguments that are seldom right. Never what makes the daemon leave its robot to another program.
pub(crate) fn request(state: &mut u64) -> String {
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

/// One of so many.
pub(crate) fn index(state: &mut u64, count: usize) -> usize {
    (next_random(state) % count as u64) as usize
}

/// A value in JSON that little code expects.
pub(crate) fn value(state: &mut u64) -> String {
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

/// Presses Stop, and gives after what time that is done.
pub(crate) fn press_stop(client: &mut Client, id: u32) -> Duration {
    let pressed = Instant::now();
    let stop = format!(r#"{{"c":"stop","id":{id}}}"#);
    client.send(&stop).expect("the honest client is not hung up on");
    let is_done = |update: &Update| matches!(update, Update::Done { id: done } if *done == id);
    let done = client.wait_for(pressed + PATIENCE, is_done);
    assert!(done.expect("reads").is_some(), "stop {id} is answered");
    pressed.elapsed()
}
