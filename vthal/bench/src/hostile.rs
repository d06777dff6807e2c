//! Clients of the daemon's socket that nobody would write, one kind for each way in which some were seen to take a daemon from the others.

use std::io::{ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::nonsense;

/// Those that wait, wait so long before they come again.
const LULL: Duration = Duration::from_millis(500);
/// Between two estimates of those who ask at a pace.
const ESTIMATE_EVERY: Duration = Duration::from_millis(33);
/// Between two looks at a socket that takes and gives nothing.
const LOOK_EVERY: Duration = Duration::from_millis(1);
/// So many parts has the job that they ask about.
const PARTS: usize = 16;
/// Tenths of a metre of the hall of [`crate::keep_home`] in which zones to be estimated begin.
const HALL: [usize; 2] = [30, 20];
/// So many estimates are asked for in one write.
const PIPELINED: usize = 150;
const ALL_TOPICS: &str = r#"{"c":"watch","topics":["status","pose","device","map","home","estimate","way","decisions","log","packets","schedules","runs","floors","standstills","buttons","inputs"]}"#;

/// What all who take part in a siege know of it.
#[derive(Debug, Default)]
pub struct Siege {
    is_over: AtomicBool,
    nonsense: AtomicU64,
}

/// Ends the siege when this goes, also when a check has failed.
#[derive(Debug)]
pub struct SiegeEnd<'a>(&'a Siege);

impl Drop for SiegeEnd<'_> {
    fn drop(&mut self) {
        self.0.is_over.store(true, Ordering::Relaxed);
    }
}

impl Siege {
    /// What ends it when it goes.
    pub fn end(&self) -> SiegeEnd<'_> {
        SiegeEnd(self)
    }

    /// Requests of [`HostileKind::AsksNonsense`] that were sent.
    pub fn nonsense(&self) -> u64 {
        self.nonsense.load(Ordering::Relaxed)
    }

    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}

/// A kind of hostile client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HostileKind {
    /// Follows everything and takes nothing.
    NeverReads,
    /// Requests with wrong, huge, missing and surplus arguments, as fast as they are taken.
    AsksNonsense,
    /// Connects and hangs up.
    ComesAndGoes,
    /// Ends in the middle of a message, and waits.
    StopsInTheMiddle,
    /// Sends a message without an end.
    NeverEndsAMessage,
    /// Estimates of a job of sixteen parts, thirty a second.
    Estimates,
    /// A hundred and fifty of them in each write.
    PipelinesEstimates,
    /// Stop as fast as it is taken: thousands a second.
    Stops,
    /// Stop and Start in one write.
    StopsAndStarts,
    /// Changes to what is kept, as fast as they are taken.
    Forgets,
    /// Schedules that come and go, as fast as they are taken.
    Schedules,
    /// The drawing and the file of a run.
    AsksForRuns,
}

impl HostileKind {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::NeverReads,
        Self::AsksNonsense,
        Self::ComesAndGoes,
        Self::StopsInTheMiddle,
        Self::NeverEndsAMessage,
        Self::Estimates,
        Self::PipelinesEstimates,
        Self::Stops,
        Self::StopsAndStarts,
        Self::Forgets,
        Self::Schedules,
        Self::AsksForRuns,
    ];

    /// For tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NeverReads => "never-reads",
            Self::AsksNonsense => "asks-nonsense",
            Self::ComesAndGoes => "comes-and-goes",
            Self::StopsInTheMiddle => "stops-in-the-middle",
            Self::NeverEndsAMessage => "never-ends-a-message",
            Self::Estimates => "estimates",
            Self::PipelinesEstimates => "pipelines-estimates",
            Self::Stops => "stops",
            Self::StopsAndStarts => "stops-and-starts",
            Self::Forgets => "forgets",
            Self::Schedules => "schedules",
            Self::AsksForRuns => "asks-for-runs",
        }
    }

    /// Does what its kind does until the siege is over.
    pub fn besiege(self, socket: &Path, seed: u64, siege: &Siege) {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        while !siege.is_over() {
            let Ok(mut stream) = UnixStream::connect(socket) else {
                // The daemon's door is full for a moment.
                std::thread::sleep(LOOK_EVERY);
                continue;
            };
            match self {
                Self::ComesAndGoes => drop(stream),
                // The daemon may hang up before that, and is asked again.
                Self::NeverReads if send(&mut stream, ALL_TOPICS) => std::thread::sleep(LULL),
                Self::NeverReads => {}
                Self::StopsInTheMiddle => {
                    // Refused or not, it waits.
                    stream.write_all(br#"{"c":"dri"#).ok();
                    std::thread::sleep(LULL);
                }
                // Until the daemon hangs up.
                Self::NeverEndsAMessage => {
                    while !siege.is_over() && stream.write_all(&[b'['; 4096]).is_ok() {}
                }
                _ => self.ask(&mut stream, &mut state, siege),
            }
        }
    }

    /// Asks on this connection until the daemon hangs up; answers are read and forgotten.
    fn ask(self, stream: &mut UnixStream, state: &mut u64, siege: &Siege) {
        if stream.set_nonblocking(true).is_err() {
            return;
        }
        let pace = (self == Self::Estimates).then_some(ESTIMATE_EVERY);
        let mut rest: Vec<u8> = Vec::new();
        let mut next = Instant::now();
        while !siege.is_over() {
            if rest.is_empty() && Instant::now() >= next {
                let requests = self.requests(state);
                if self == Self::AsksNonsense {
                    siege.nonsense.fetch_add(requests.len() as u64, Ordering::Relaxed);
                }
                rest = requests
                    .into_iter()
                    .flat_map(|request| [request.as_bytes(), &[rvac_api::SEPARATOR]].concat())
                    .collect();
                next += pace.unwrap_or_default();
            }
            let Ok(sent) = unless_full(stream.write(&rest)) else {
                return;
            };
            rest.drain(..sent.unwrap_or_default());
            match unless_full(stream.read(&mut [0; 16 << 10])) {
                Err(_) | Ok(Some(0)) => return,
                Ok(None) if sent.is_none() || rest.is_empty() && Instant::now() < next => {
                    std::thread::sleep(LOOK_EVERY)
                }
                Ok(_) => {}
            }
        }
    }

    /// What it asks next, in one write.
    fn requests(self, state: &mut u64) -> Vec<String> {
        let all: &[&str] = match self {
            Self::Estimates => return vec![estimate(state, HALL)],
            Self::PipelinesEstimates => return (0..PIPELINED).map(|_| estimate(state, HALL)).collect(),
            Self::Stops => &[r#"{"c":"stop","id":1}"#],
            Self::StopsAndStarts => &[r#"{"c":"stop","id":1}"#, r#"{"c":"start","id":2}"#],
            Self::Forgets => &[
                r#"{"c":"reset-health","component":"brush-main","id":1}"#,
                r#"{"c":"forget-learnt","device":"synthetic","id":2}"#,
            ],
            Self::Schedules => &[
                r#"{"c":"add-schedule","name":"x","enabled":false,"job":{"start":{}},"when":{"weekly":{"days":["mo"],"at":"07:30"}},"id":1}"#,
                r#"{"c":"remove-schedule","number":1,"id":2}"#,
            ],
            Self::AsksForRuns => &[
                r#"{"c":"runs","count":200,"id":1}"#,
                r#"{"c":"run-track","number":1,"id":2}"#,
                r#"{"c":"run-file","number":1,"from":0,"id":3}"#,
                r#"{"c":"export-floors","from":0,"id":4}"#,
            ],
            _ => return vec![nonsense::request(state)],
        };
        all.iter().map(|request| (*request).to_owned()).collect()
    }
}

/// An estimate of zones whose lower left corners lie within so many tenths of a metre of the map's origin.
pub fn estimate(state: &mut u64, [wide, high]: [usize; 2]) -> String {
    let parts: Vec<String> = (0..PARTS)
        .map(|_| {
            let x_m = nonsense::index(state, wide) as f64 / 10.0;
            let y_m = nonsense::index(state, high) as f64 / 10.0;
            let (right_m, top_m) = (x_m + 2.5, y_m + 1.5);
            format!(r#"{{"zone":[[{x_m},{y_m}],[{right_m},{y_m}],[{right_m},{top_m}],[{x_m},{top_m}]]}}"#)
        })
        .collect();
    format!(
        r#"{{"c":"estimate","parts":[{}],"passes":3,"id":1}}"#,
        parts.join(",")
    )
}

fn send(stream: &mut UnixStream, message: &str) -> bool {
    stream
        .write_all(&[message.as_bytes(), &[rvac_api::SEPARATOR]].concat())
        .is_ok()
}

/// Nothing where a socket takes or gives nothing just now.
fn unless_full(result: std::io::Result<usize>) -> std::io::Result<Option<usize>> {
    match result {
        Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(None),
        other => other.map(Some),
    }
}
