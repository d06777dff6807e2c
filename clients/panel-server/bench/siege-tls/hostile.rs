//! Peers at the TLS port that nobody would want, one kind for each way in which they could take the server from the others.
//!
//! They run at the lowest priority: theirs are other computers, and those do not take the processor from the robot.

use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use panel_bench::{Caller, Door, Tls};
use tungstenite::Message;
use vthal_bench::{estimate, next_random, nonsense};

use crate::honest::Phone;

/// Name of a file as large as the largest of the panel.
pub(crate) const LARGE_FILE: &str = "large.wasm";
/// Its bytes.
pub(crate) const LARGE_FILE_BYTES: usize = 3 << 20;

/// Tenths of a metre of the large home in which zones to be estimated begin.
const LARGE_HOME: [usize; 2] = [150, 150];
/// Peers that do not read are four with 32 connections each.
const SEATS_OF_ONE: u64 = 32;
/// Connections that a peer of other kinds keeps: ten peers have nearly all seats.
const HELD: usize = 12;
/// A connection that does nothing is kept so long.
const HELD_FOR: Duration = Duration::from_secs(4);
/// Between two bytes of a slow request.
const BYTE_EVERY: Duration = Duration::from_secs(1);
/// Between two reads of a slow reader, each of so many bytes.
const READ_EVERY: Duration = Duration::from_millis(50);
const READ_BYTES: usize = 8 << 10;
/// Between two estimates.
const ESTIMATE_EVERY: Duration = Duration::from_millis(33);
/// A peer that is not let in waits so long.
const AFTER_REFUSAL: Duration = Duration::from_millis(1);
/// For one answer.
const PATIENCE: Duration = Duration::from_secs(2);
const ALL_TOPICS: &str = r#"{"c":"watch","topics":["status","pose","device","map","home","estimate","way","decisions","log","packets","schedules","runs","floors","standstills","buttons","inputs"]}"#;
const FETCHED: [&str; 2] = ["/api/runs/1/recording", "/api/floors/archive"];

/// What all who take part in a siege know of it.
#[derive(Debug, Default)]
pub(crate) struct Siege {
    is_over: AtomicBool,
    begun: AtomicU64,
    refused: AtomicU64,
    done: AtomicU64,
}

impl Siege {
    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    pub(crate) fn end(&self) {
        self.is_over.store(true, Ordering::Relaxed);
    }

    /// Connections that were asked for.
    pub(crate) fn begun(&self) -> u64 {
        self.begun.load(Ordering::Relaxed)
    }

    /// Those of them that the server ended before they had what they came for.
    pub(crate) fn refused(&self) -> u64 {
        self.refused.load(Ordering::Relaxed)
    }

    /// Requests that were sent.
    pub(crate) fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// Sleeps unless it is over.
    fn wait(&self, time: Duration) {
        let until = Instant::now() + time;
        while !self.is_over() && Instant::now() < until {
            thread::sleep(time.min(Duration::from_millis(50)));
        }
    }
}

/// A kind of hostile peer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Nobody.
    Nothing,
    /// Strangers that ask for a large file twice and take nothing.
    NeverRead,
    /// Strangers that fetch a large file again and again, as fast as it comes.
    Downloads,
    /// Connections that come as fast as they can, and stay until the peer has its share.
    Crowd,
    /// Handshakes that are begun and not finished.
    HalfHandshakes,
    /// Handshakes one after another.
    Handshakes,
    /// Connections that hang up at once.
    ComeAndGo,
    /// Heads of which a byte a second comes.
    SlowHeads,
    /// Bodies of which a byte a second comes.
    SlowBodies,
    /// Guesses of the code of an open window.
    GuessCodes,
    /// Guesses of a token.
    GuessTokens,
    /// Paired viewers that follow everything and take nothing.
    ViewersNeverRead,
    /// Paired viewers that ask for thirty estimates a second.
    Estimates,
    /// Paired viewers that ask nonsense.
    Nonsense,
    /// Paired viewers that press Stop without end.
    Stops,
    /// Paired viewers that fetch a run's recording and the archive of floors, and read slowly.
    FetchSlowly,
}

impl Kind {
    /// All of them.
    pub(crate) const ALL: [Self; 16] = [
        Self::Nothing,
        Self::NeverRead,
        Self::Downloads,
        Self::Crowd,
        Self::HalfHandshakes,
        Self::Handshakes,
        Self::ComeAndGo,
        Self::SlowHeads,
        Self::SlowBodies,
        Self::GuessCodes,
        Self::GuessTokens,
        Self::ViewersNeverRead,
        Self::Estimates,
        Self::Nonsense,
        Self::Stops,
        Self::FetchSlowly,
    ];

    /// For tables.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::NeverRead => "never-read",
            Self::Downloads => "downloads",
            Self::Crowd => "crowd",
            Self::HalfHandshakes => "half-handshakes",
            Self::Handshakes => "handshakes",
            Self::ComeAndGo => "come-and-go",
            Self::SlowHeads => "slow-heads",
            Self::SlowBodies => "slow-bodies",
            Self::GuessCodes => "guess-codes",
            Self::GuessTokens => "guess-tokens",
            Self::ViewersNeverRead => "viewers-never-read",
            Self::Estimates => "estimates",
            Self::Nonsense => "nonsense",
            Self::Stops => "stops",
            Self::FetchSlowly => "fetch-slowly",
        }
    }

    /// How many of them come when ten of a kind are wished.
    pub(crate) const fn count(self, of_a_kind: u64) -> u64 {
        match self {
            Self::Nothing => 0,
            Self::NeverRead => 4 * SEATS_OF_ONE,
            _ => of_a_kind,
        }
    }

    /// The address of one of them.
    pub(crate) fn address(self, number: u64) -> Ipv4Addr {
        let place = match self {
            Self::NeverRead => number / SEATS_OF_ONE,
            _ => number,
        };
        Ipv4Addr::new(127, 0, 0, 2 + (place % 200) as u8)
    }

    /// Whether they are paired devices.
    pub(crate) const fn is_paired(self) -> bool {
        matches!(
            self,
            Self::ViewersNeverRead | Self::Estimates | Self::Nonsense | Self::Stops | Self::FetchSlowly
        )
    }
}

/// One hostile peer.
pub(crate) struct Besieger<'a> {
    pub(crate) kind: Kind,
    pub(crate) door: &'a Door,
    pub(crate) siege: &'a Siege,
    pub(crate) caller: Caller,
    /// For what it draws; not 0.
    pub(crate) random: u64,
}

impl Besieger<'_> {
    /// Does what its kind does until the siege is over.
    pub(crate) fn besiege(mut self) {
        rustix::process::nice(19).ok(); // It only competes more without.
        while !self.siege.is_over() {
            self.siege.begun.fetch_add(1, Ordering::Relaxed);
            // Whatever goes wrong, it comes again.
            if self.come_once().is_err() && !self.siege.is_over() {
                self.siege.refused.fetch_add(1, Ordering::Relaxed);
                thread::sleep(AFTER_REFUSAL);
            }
        }
    }

    fn come_once(&mut self) -> anyhow::Result<()> {
        match self.kind {
            Kind::Nothing => self.siege.wait(HELD_FOR),
            Kind::NeverRead => self.ask_and_not_read()?,
            Kind::Downloads => self.download()?,
            Kind::Crowd => self.crowd()?,
            Kind::HalfHandshakes => self.begin_handshakes()?,
            Kind::Handshakes => drop(self.door.shake_hands(&self.caller, PATIENCE)?),
            Kind::ComeAndGo => drop(self.door.dial(&self.caller, PATIENCE)?),
            Kind::SlowHeads | Kind::SlowBodies => self.ask_slowly()?,
            Kind::GuessCodes | Kind::GuessTokens => self.guess()?,
            Kind::ViewersNeverRead => {
                let mut phone = Phone::come(self.door, &self.caller, PATIENCE)?;
                phone.say(ALL_TOPICS)?;
                self.siege.wait(HELD_FOR);
            }
            Kind::Estimates | Kind::Nonsense | Kind::Stops => self.flood()?,
            Kind::FetchSlowly => self.fetch()?,
        }
        Ok(())
    }

    fn ask_and_not_read(&mut self) -> anyhow::Result<()> {
        let mut stream = self.door.shake_hands(&self.caller, PATIENCE)?;
        let request = format!(
            "GET /{LARGE_FILE} HTTP/1.1\r\n{}\r\n",
            self.door.headers(&self.caller)
        );
        stream.write_all(request.repeat(2).as_bytes())?;
        stream.flush()?;
        self.siege.wait(HELD_FOR);
        Ok(())
    }

    fn download(&self) -> anyhow::Result<()> {
        let mut stream = self.door.shake_hands(&self.caller, PATIENCE)?;
        let request = format!(
            "GET /{LARGE_FILE} HTTP/1.1\r\n{}\r\n",
            self.door.headers(&self.caller)
        );
        let mut part = vec![0; LARGE_FILE_BYTES];
        while !self.siege.is_over() {
            stream.write_all(request.as_bytes())?;
            stream.flush()?;
            stream.read_exact(&mut part)?;
            self.siege.done.fetch_add(1, Ordering::Relaxed);
        }
        Ok(())
    }

    /// Connections that come as fast as they can and say nothing, each in place of an older one.
    fn crowd(&self) -> anyhow::Result<()> {
        let mut held = std::collections::VecDeque::new();
        while !self.siege.is_over() {
            held.push_back(self.door.dial(&self.caller, PATIENCE)?);
            self.siege.begun.fetch_add(1, Ordering::Relaxed);
            if held.len() > SEATS_OF_ONE as usize {
                held.pop_front();
            }
        }
        Ok(())
    }

    /// The server has made its keys and its signature, and waits for what does not come.
    fn begin_handshakes(&self) -> anyhow::Result<()> {
        let mut held: Vec<TcpStream> = Vec::new();
        for _ in 0..HELD {
            let mut stream = self.door.dial(&self.caller, PATIENCE)?;
            stream.write_all(&self.door.client_hello()?)?;
            held.push(stream);
        }
        self.siege.begun.fetch_add(HELD as u64 - 1, Ordering::Relaxed);
        self.siege.wait(HELD_FOR / 4);
        let lost = held.iter().filter(|stream| is_ended(stream)).count();
        self.siege.refused.fetch_add(lost as u64, Ordering::Relaxed);
        Ok(())
    }

    fn ask_slowly(&self) -> anyhow::Result<()> {
        let request = match self.kind {
            Kind::SlowHeads => format!("GET / HTTP/1.1\r\n{}\r\n", self.door.headers(&self.caller)),
            _ => self.door.post("/api/pairing/begin", &"x".repeat(1_000)),
        };
        let begun = match self.kind {
            Kind::SlowHeads => 0,
            _ => request.find("\r\n\r\n").map_or(0, |end| end + 4),
        };
        let mut held: Vec<Tls> = Vec::new();
        for _ in 0..HELD {
            let mut stream = self.door.shake_hands(&self.caller, PATIENCE)?;
            stream.write_all(request.get(..begun).unwrap_or_default().as_bytes())?;
            held.push(stream);
        }
        self.siege.begun.fetch_add(HELD as u64 - 1, Ordering::Relaxed);
        for byte in request.as_bytes().iter().skip(begun) {
            if self.siege.is_over() {
                return Ok(());
            }
            for stream in &mut held {
                stream.write_all(&[*byte])?;
                stream.flush()?;
            }
            self.siege.wait(BYTE_EVERY);
        }
        Ok(())
    }

    fn guess(&mut self) -> anyhow::Result<()> {
        let mut stream = self.door.shake_hands(&self.caller, PATIENCE)?;
        while !self.siege.is_over() {
            let mut random = [0; 64];
            random.fill_with(|| next_random(&mut self.random) as u8);
            let request = match self.kind {
                Kind::GuessCodes => self.door.guess(random)?,
                _ => {
                    let digits: String = random.iter().map(|byte| format!("{byte:02x}")).collect();
                    let token = format!("rvac_{digits}");
                    let caller = Caller {
                        token: Some(token),
                        ..self.caller.clone()
                    };
                    format!("GET /api/session HTTP/1.1\r\n{}\r\n", self.door.headers(&caller))
                }
            };
            stream.write_all(request.as_bytes())?;
            stream.flush()?;
            self.siege.done.fetch_add(1, Ordering::Relaxed);
            // An answer is short, and one read takes it.
            anyhow::ensure!(stream.read(&mut [0; READ_BYTES])? > 0, "the server hung up");
        }
        Ok(())
    }

    /// Requests as fast as they are taken, or at a pace; answers are read and forgotten.
    fn flood(&mut self) -> anyhow::Result<()> {
        let (mut socket, line) = self.door.open_socket(&self.caller, PATIENCE)?;
        line.set_nonblocking(true)?;
        let mut next = Instant::now();
        while !self.siege.is_over() {
            if Instant::now() >= next {
                let request = match self.kind {
                    Kind::Estimates => estimate(&mut self.random, LARGE_HOME),
                    Kind::Nonsense => nonsense::request(&mut self.random),
                    _ => r#"{"c":"stop","id":1}"#.to_owned(),
                };
                unless_full(socket.send(Message::text(request)))?;
                self.siege.done.fetch_add(1, Ordering::Relaxed);
                if self.kind == Kind::Estimates {
                    next += ESTIMATE_EVERY;
                }
            }
            while unless_full(socket.read().map(drop))? {}
            if !unless_full(socket.flush())? || self.kind == Kind::Estimates {
                thread::sleep(AFTER_REFUSAL);
            }
        }
        Ok(())
    }

    fn fetch(&mut self) -> anyhow::Result<()> {
        let path = FETCHED[nonsense::index(&mut self.random, FETCHED.len())];
        let mut stream = self.door.shake_hands(&self.caller, PATIENCE)?;
        let head = format!(
            "GET {path} HTTP/1.1\r\nConnection: close\r\n{}\r\n",
            self.door.headers(&self.caller)
        );
        stream.write_all(head.as_bytes())?;
        stream.flush()?;
        self.siege.done.fetch_add(1, Ordering::Relaxed);
        while !self.siege.is_over() && stream.read(&mut [0; READ_BYTES])? > 0 {
            self.siege.wait(READ_EVERY);
        }
        Ok(())
    }
}

fn is_ended(mut stream: &TcpStream) -> bool {
    if stream.set_nonblocking(true).is_err() {
        return true;
    }
    loop {
        match stream.read(&mut [0; READ_BYTES]) {
            Ok(0) => return true,
            Ok(_) => {}
            Err(error) => return error.kind() != ErrorKind::WouldBlock,
        }
    }
}

/// Whether it was done; not when the socket takes or gives nothing just now.
fn unless_full(outcome: tungstenite::Result<()>) -> tungstenite::Result<bool> {
    match outcome {
        Ok(()) => Ok(true),
        Err(tungstenite::Error::Io(error)) if error.kind() == ErrorKind::WouldBlock => Ok(false),
        Err(tungstenite::Error::WriteBufferFull(_)) => Ok(false),
        Err(error) => Err(error),
    }
}
