//! A16, A17: a second driver, and a driver who is lost, with the daemon and a robot in the simulator.

use std::time::{Duration, Instant};

use futures_util::{SinkExt as _, StreamExt as _};
use rvac_api::Update;
use tokio::net::TcpStream;
use tokio::time::timeout;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;

use crate::folder::Folder;
use crate::held;
use crate::report::Report;
use crate::rig::DEADLINE;
use crate::robot::Observer;
use crate::stack::Stack;

/// Of the drivers here, milliseconds: a lease is never longer than 400.
const LEASE_MS: u32 = 250;
pub(crate) const BETWEEN: Duration = Duration::from_millis(80);

/// What the table allows from the loss to the standstill. The robot is polled a hundred times a second, so that polling adds a
/// hundredth at most; how long it really takes is measured on a virtual clock (`scenarios/tests/all/lost_driver.rs`).
const STANDS_MS: u128 = 400;

/// The middle of so many trials counts: the machine may be busy with other things in one of them.
const TRIALS: usize = 3;

pub(crate) async fn try_all(report: &mut Report) {
    let page = Folder::new();
    std::fs::write(page.join("index.html"), "<!doctype html><title>x</title>").unwrap();
    let mut scene = Scene::new(page).await;
    scene.theft(report).await;
    scene.losses(report).await;
    held::try_all(&mut scene, report).await;
}

/// Held sticks alone, as often as somebody wants.
pub(crate) async fn try_held_only(report: &mut Report) {
    let page = Folder::new();
    std::fs::write(page.join("index.html"), "<!doctype html><title>x</title>").unwrap();
    let mut scene = Scene::new(page).await;
    held::try_all(&mut scene, report).await;
}

/// A robot with its daemon and its server.
pub(crate) struct Scene {
    pub(crate) stack: Stack,
    pub(crate) witness: Observer,
    pub(crate) page: Folder,
}

impl Scene {
    /// A robot in the middle of a room.
    async fn new(page: Folder) -> Self {
        let stack = Stack::start_with_page(&page);
        stack.hand(r#"{"c":"place","x":-3.4,"y":0,"heading":3.14}"#);
        let witness = Observer::watch_closely(&stack.simulator_socket());
        let scene = Self { stack, witness, page };
        let mut driver = scene.driver().await;
        let deadline = Instant::now() + DEADLINE;
        while driver.turns(0.0).await.is_some() {
            assert!(Instant::now() < deadline, "the robot cannot be driven");
            tokio::time::sleep(BETWEEN).await;
        }
        scene
    }

    pub(crate) async fn driver(&self) -> Driver {
        let host = self
            .stack
            .address
            .trim_start_matches("http://")
            .trim_end_matches('/');
        let mut request = format!("ws://{host}/api/ws").into_client_request().unwrap();
        let origin = format!("http://{host}").parse().unwrap();
        request.headers_mut().insert("origin", origin);
        let stream = TcpStream::connect(host).await.unwrap();
        let (socket, _) = tokio_tungstenite::client_async(request, stream).await.unwrap();
        Driver { socket, asked: 0 }
    }

    /// A driver who holds the stick, and the robot turns.
    async fn turning(&self) -> Driver {
        let mut driver = self.driver().await;
        let deadline = Instant::now() + DEADLINE;
        // The seat of the one before may not be free yet, and a stick begins in its middle.
        while driver.turns(0.0).await.is_some() {
            assert!(Instant::now() < deadline, "nobody may drive");
            tokio::time::sleep(BETWEEN).await;
        }
        for _ in 0..12 {
            driver.turns(0.8).await;
            tokio::time::sleep(BETWEEN).await;
        }
        driver
    }

    async fn theft(&self, report: &mut Report) {
        let (mut first, mut thief) = (self.turning().await, self.driver().await);
        let mut answers = Vec::new();
        for _ in 0..10 {
            let kept = first.turns(0.8).await;
            answers.push(kept.unwrap_or_else(|| "drives".to_owned()));
            let stolen = thief.turns(-0.8).await;
            answers.push(stolen.unwrap_or_else(|| "drives too".to_owned()));
            tokio::time::sleep(BETWEEN).await;
        }
        answers.sort();
        answers.dedup();
        report.row(
            (
                "A16",
                "a second driver takes the stick ten times while the first holds it",
            ),
            "driver-busy, drives",
            answers.join(", "),
        );
        first.turns(0.8).await;
        let started = thief.asks(r#"{"c":"start""#).await;
        report.row(
            ("A16", "and starts a job instead"),
            "driver-busy",
            started.unwrap_or_default(),
        );
        let stopped = thief.asks(r#"{"c":"stop""#).await;
        report.row(
            ("A16", "but anybody may stop"),
            "done",
            stopped.unwrap_or_else(|| "done".to_owned()),
        );
    }

    async fn losses(&self, report: &mut Report) {
        let [mut broken, mut silent] = [Vec::new(), Vec::new()];
        for _ in 0..TRIALS {
            let driver = self.turning().await;
            // Without a word: no close, no release.
            drop(driver);
            broken.push(self.stands_after_ms());
            let driver = self.turning().await;
            silent.push(self.stands_after_ms());
            drop(driver);
        }
        for (what, seen) in [
            (
                "the connection of a driver breaks in the middle of a turn: wheels at rest",
                broken,
            ),
            (
                "a driver falls silent and the connection stays: wheels at rest",
                silent,
            ),
        ] {
            report.row(("A17", what), "within 400 ms", in_words(seen));
        }
    }

    /// From now until the robot is seen at rest, milliseconds.
    fn stands_after_ms(&self) -> Option<u128> {
        let lost = Instant::now();
        let stood = self.witness.stands_within(Duration::from_secs(3))?;
        Some(stood.saturating_duration_since(lost).as_millis())
    }
}

fn in_words(mut seen: Vec<Option<u128>>) -> String {
    if seen.contains(&None) {
        return "drives on".to_owned();
    }
    seen.sort_unstable();
    match seen[seen.len() / 2].unwrap_or_default() {
        ms if ms <= STANDS_MS => "within 400 ms".to_owned(),
        ms => format!("{ms} ms"),
    }
}

/// Somebody at the panel.
pub(crate) struct Driver {
    socket: WebSocketStream<TcpStream>,
    asked: u32,
}

impl Driver {
    /// Asks to turn on the spot so fast, rad/s, and gives why not.
    pub(crate) async fn turns(&mut self, turn_rad_s: f64) -> Option<String> {
        self.asks(&format!(
            r#"{{"c":"drive","v":0,"w":{turn_rad_s},"ttl":{LEASE_MS}"#
        ))
        .await
    }

    /// Sends a request, of which the end is missing, and gives why it is refused.
    async fn asks(&mut self, request: &str) -> Option<String> {
        self.asked += 1;
        let number = self.asked;
        let text = format!(r#"{request},"id":{number}}}"#);
        self.socket.send(Message::text(text)).await.unwrap();
        loop {
            let message = timeout(DEADLINE, self.socket.next())
                .await
                .expect("an answer in time");
            let Message::Text(text) = message.unwrap().unwrap() else {
                continue;
            };
            match serde_json::from_str(&text) {
                Ok(Update::Done { id }) if id == number => return None,
                Ok(Update::Failed(failure)) if failure.id == Some(number) => return Some(failure.reason),
                _ => {}
            }
        }
    }
}
