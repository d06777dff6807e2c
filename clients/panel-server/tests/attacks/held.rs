//! A17: a stick that is held on while its connection breaks, somebody else lets go, or a process starts anew, over both sockets.

use std::time::{Duration, Instant};

use crate::drivers::{BETWEEN, Driver, Scene};
use crate::report::Report;
use crate::rig::DEADLINE;
use crate::rival::Rival;

/// How often a connection breaks under a held stick, at each socket, and how often each process starts anew, without a wish.
const USUAL: Moments = Moments {
    breaks: 12,
    restarts: 2,
};
/// Shortest and longest time without a connection.
const AWAY_MS: [u64; 2] = [50, 2_000];
/// Longest time for which a stick that drives is held before something happens to it.
const HELD_MS: u64 = 700;
/// By then the wheels of whoever was lost stand.
const STANDS: Duration = Duration::from_millis(600);
/// So long the stick is held on after that.
const HELD_ON: Duration = Duration::from_millis(500);
const TURN_RAD_S: f64 = 0.8;
/// What no answer to a held stick may be.
const DRIVES: &str = "drives";

/// Moments at which something happens to a held stick.
#[derive(Clone, Copy, Debug)]
struct Moments {
    /// Connections, which break at each of the two sockets.
    breaks: u32,
    /// Restarts of the daemon under a stick at each socket, and of the panel's server.
    restarts: u32,
}

/// `RVAC_HELD_MOMENTS` of them in all: half of them connections, the rest processes.
fn moments() -> Moments {
    let Some(wished) = std::env::var("RVAC_HELD_MOMENTS").ok() else {
        return USUAL;
    };
    let all: u32 = wished.parse().expect("RVAC_HELD_MOMENTS is a number");
    Moments {
        breaks: (all / 4).max(2),
        restarts: all.div_ceil(6),
    }
}

/// Somewhere between nothing and `most`, other for each number, and the same in each run.
fn spread_ms(number: u32, most: u64) -> u64 {
    u64::from(number.wrapping_mul(2_654_435_761) >> 8) % (most + 1)
}

/// Where the stick is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Door {
    /// The daemon's Unix socket.
    Daemon,
    /// The WebSocket of the panel.
    Panel,
}

/// A client that holds a stick.
enum Stick {
    AtDaemon(Rival),
    AtPanel(Box<Driver>),
}

impl Stick {
    async fn at(scene: &Scene, door: Door) -> Self {
        match door {
            Door::Daemon => Self::AtDaemon(Rival::at(&scene.stack.daemon_socket())),
            Door::Panel => Self::AtPanel(Box::new(scene.driver().await)),
        }
    }

    /// Why the robot does not turn so.
    async fn turns(&mut self, turn_rad_s: f64) -> Option<String> {
        match self {
            Self::AtDaemon(rival) => rival.ask(turn_rad_s),
            Self::AtPanel(driver) => driver.turns(turn_rad_s).await,
        }
    }

    /// Turns the robot from the stick's centre on. One that has just started anew is armed first.
    async fn begin(&mut self, scene: &Scene) {
        let deadline = Instant::now() + DEADLINE;
        while scene.witness.stands_within(STANDS).is_none() {
            assert!(Instant::now() < deadline, "the robot does not rest");
        }
        loop {
            let from_rest = self.turns(0.0).await;
            for _ in 0..6 {
                let held = self.turns(TURN_RAD_S).await;
                tokio::time::sleep(BETWEEN).await;
                if from_rest.is_none() && held.is_none() && scene.witness.moves_within(BETWEEN) {
                    return;
                }
            }
            assert!(Instant::now() < deadline, "a stick from its centre drives");
        }
    }

    /// Goes on turning the robot for a while that differs from trial to trial.
    async fn drive_on(&mut self, trial: u32) {
        let until = Instant::now() + Duration::from_millis(spread_ms(trial, HELD_MS));
        while Instant::now() < until {
            // Whether it is granted is not asked here: a machine that is busy may be late once.
            self.turns(TURN_RAD_S).await;
            tokio::time::sleep(BETWEEN).await;
        }
    }

    /// Holds on; gives what went wrong, or the last answer. What has started anew is waited for.
    async fn hold_on(&mut self, scene: &Scene) -> String {
        let began = Instant::now();
        let mut last = self.hold_for(STANDS).await;
        while last != "centre-first" && last != DRIVES && began.elapsed() < DEADLINE {
            last = self.hold_for(BETWEEN).await;
        }
        if scene.witness.stands_within(STANDS).is_none() {
            return "moves on".to_owned();
        }
        let last = self.hold_for(HELD_ON).await;
        // What the witness has seen meanwhile.
        if scene.witness.moves_within(BETWEEN) {
            return "moves again".to_owned();
        }
        last
    }

    /// Says again and again that it is pushed. Gives the last answer, or that one was granted.
    async fn hold_for(&mut self, span: Duration) -> String {
        let began = Instant::now();
        loop {
            let Some(reason) = self.turns(TURN_RAD_S).await else {
                return DRIVES.to_owned();
            };
            if began.elapsed() >= span {
                return reason;
            }
            tokio::time::sleep(BETWEEN).await;
        }
    }
}

pub(crate) async fn try_all(scene: &mut Scene, report: &mut Report) {
    let Moments { breaks, restarts } = moments();
    for (door, words) in [
        (Door::Daemon, "the daemon's socket"),
        (Door::Panel, "the panel's"),
    ] {
        let mut seen = Vec::new();
        for trial in 0..breaks {
            seen.push(broken(scene, door, trial).await);
        }
        row(
            report,
            &format!("{breaks} connections break under a held stick at {words}"),
            seen,
        );
        let seen = vec![taken_over(scene, door).await];
        row(
            report,
            &format!("a stick is held while another driver lets go, at {words}"),
            seen,
        );
        let mut seen = Vec::new();
        for trial in 0..restarts {
            seen.push(restarted_daemon(scene, door, trial).await);
        }
        row(
            report,
            &format!("the daemon starts anew {restarts} times under a stick at {words}"),
            seen,
        );
    }
    let mut seen = Vec::new();
    for trial in 0..restarts {
        seen.push(restarted_server(scene, trial).await);
    }
    row(
        report,
        &format!("the panel's server starts anew {restarts} times under a stick"),
        seen,
    );
}

fn row(report: &mut Report, what: &str, mut seen: Vec<String>) {
    seen.sort();
    seen.dedup();
    report.row(
        ("A17", format!("{what}: it is held on")),
        "centre-first",
        seen.join(", "),
    );
}

async fn broken(scene: &Scene, door: Door, trial: u32) -> String {
    let mut stick = Stick::at(scene, door).await;
    stick.begin(scene).await;
    stick.drive_on(trial).await;
    drop(stick);
    let [shortest, longest] = AWAY_MS;
    let away_ms = shortest + spread_ms(trial, longest - shortest);
    tokio::time::sleep(Duration::from_millis(away_ms)).await;
    Stick::at(scene, door).await.hold_on(scene).await
}

async fn taken_over(scene: &Scene, door: Door) -> String {
    let mut first = Stick::at(scene, door).await;
    first.begin(scene).await;
    let mut second = Stick::at(scene, door).await;
    let busy = second.turns(TURN_RAD_S).await;
    if busy.as_deref() != Some("driver-busy") {
        return format!("{busy:?}");
    }
    drop(first);
    second.hold_on(scene).await
}

/// Who holds the stick at the panel's socket keeps that connection: the server finds the new daemon.
async fn restarted_daemon(scene: &mut Scene, door: Door, trial: u32) -> String {
    let mut stick = Stick::at(scene, door).await;
    stick.begin(scene).await;
    stick.drive_on(trial).await;
    scene.stack.kill_vthal();
    scene.stack.start_vthal();
    if door == Door::Daemon {
        stick = Stick::at(scene, door).await;
    }
    stick.hold_on(scene).await
}

async fn restarted_server(scene: &mut Scene, trial: u32) -> String {
    let mut stick = Stick::at(scene, Door::Panel).await;
    stick.begin(scene).await;
    stick.drive_on(trial).await;
    scene.stack.stop_server();
    scene.stack.serve_again(&scene.page);
    Stick::at(scene, Door::Panel).await.hold_on(scene).await
}
