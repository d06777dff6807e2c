//! Paired phones that want nothing but to stop the robot and to see it.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use panel_bench::{Caller, Door, Stream};
use rvac_api::Update;
use tungstenite::{Message, WebSocket};

/// Between two presses of Stop.
const PRESS_EVERY: Duration = Duration::from_millis(50);
/// A press that is not answered by then ends the measurement.
const PRESS_PATIENCE: Duration = Duration::from_secs(20);
/// Between two phones that come anew.
const COMES_EVERY: Duration = Duration::from_secs(1);
/// One that has not stopped the robot by then has not.
pub(crate) const NEWCOMER_PATIENCE: Duration = Duration::from_secs(2);
/// Between two looks whether it is over.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// A phone with a WebSocket.
pub(crate) struct Phone {
    socket: WebSocket<Box<dyn Stream>>,
    line: TcpStream,
    pressed: u32,
}

impl Phone {
    /// One that comes anew, as a page does: TLS for its WebSocket, and once more to ask for what opens it.
    pub(crate) fn come(door: &Door, caller: &Caller, patience: Duration) -> anyhow::Result<Self> {
        let (socket, line) = door.open_socket(caller, patience)?;
        Ok(Self {
            socket,
            line,
            pressed: 0,
        })
    }

    pub(crate) fn say(&mut self, text: &str) -> anyhow::Result<()> {
        Ok(self.socket.send(Message::text(text))?)
    }

    /// The next text; none when nothing comes in so much time.
    fn hear(&mut self, patience: Duration) -> anyhow::Result<Option<String>> {
        self.line
            .set_read_timeout(Some(patience.max(Duration::from_millis(1))))?;
        match self.socket.read() {
            Ok(Message::Text(text)) => Ok(Some(text.as_str().to_owned())),
            Ok(_) => Ok(None),
            Err(tungstenite::Error::Io(error))
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
            {
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Presses Stop; gives after what time that was answered.
    pub(crate) fn stop(&mut self, patience: Duration) -> anyhow::Result<Duration> {
        self.pressed += 1;
        let pressed = Instant::now();
        self.say(&format!(r#"{{"c":"stop","id":{}}}"#, self.pressed))?;
        while pressed.elapsed() < patience {
            let heard = self.hear(patience.saturating_sub(pressed.elapsed()))?;
            match heard.as_deref().map(serde_json::from_str::<Update>) {
                Some(Ok(Update::Done { id })) if id == self.pressed => return Ok(pressed.elapsed()),
                Some(Ok(Update::Failed(failure))) if failure.id == Some(self.pressed) => {
                    bail!("Stop was refused: {}", failure.text)
                }
                _ => {}
            }
        }
        bail!("Stop was not answered")
    }
}

/// Presses Stop all the time; gives after what times that was answered, in milliseconds.
pub(crate) fn press(mut phone: Phone, time: Duration) -> anyhow::Result<Vec<f64>> {
    let mut delays_ms = Vec::new();
    let began = Instant::now();
    let mut next = began;
    while began.elapsed() < time {
        let answered = phone
            .stop(PRESS_PATIENCE)
            .with_context(|| format!("press {} of Stop", phone.pressed))?;
        delays_ms.push(answered.as_secs_f64() * 1e3);
        next += PRESS_EVERY;
        thread::sleep(next.saturating_duration_since(Instant::now()));
    }
    Ok(delays_ms)
}

/// When the follower of telemetry counts what it hears.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    pub(crate) counts: AtomicBool,
    pub(crate) is_over: AtomicBool,
}

/// Follows packets; gives how old the robot's reports were, in milliseconds.
pub(crate) fn follow(mut phone: Phone, clock_began: Instant, watch: &Watch) -> anyhow::Result<Vec<f64>> {
    let mut delays_ms = Vec::new();
    while !watch.is_over.load(Ordering::Relaxed) {
        let Some(text) = phone.hear(LOOK_EVERY)? else {
            continue;
        };
        if !watch.counts.load(Ordering::Relaxed) {
            continue;
        }
        let Ok(Update::Packet {
            direction: '<', text, ..
        }) = serde_json::from_str(&text)
        else {
            continue;
        };
        if let Some(clock) = clock_of(&text) {
            delays_ms.push((clock_began + clock).elapsed().as_secs_f64() * 1e3);
        }
    }
    Ok(delays_ms)
}

/// What the robot's clock showed in a report of its state.
fn clock_of(packet: &str) -> Option<Duration> {
    let clock = packet.strip_prefix(r#"{"c":"state","t":"#)?;
    let (clock_ms, _) = clock.split_once(',')?;
    clock_ms.parse().ok().map(Duration::from_millis)
}

/// A phone comes anew each second, presses Stop and leaves. Gives how long each took in milliseconds, or why it did not get through.
pub(crate) fn come_and_stop(
    door: &Door,
    caller: &Caller,
    time: Duration,
) -> anyhow::Result<Vec<anyhow::Result<f64>>> {
    thread::scope(|scope| {
        let began = Instant::now();
        let mut comers = Vec::new();
        while began.elapsed() < time {
            comers.push(scope.spawn(|| {
                let came = Instant::now();
                let mut phone = Phone::come(door, caller, NEWCOMER_PATIENCE)?;
                phone.stop(NEWCOMER_PATIENCE)?;
                anyhow::ensure!(came.elapsed() < NEWCOMER_PATIENCE, "it took too long");
                Ok(came.elapsed().as_secs_f64() * 1e3)
            }));
            let next = COMES_EVERY * comers.len() as u32;
            thread::sleep(next.saturating_sub(began.elapsed()));
        }
        let all = comers.into_iter().map(|comer| comer.join().ok());
        all.map(|ended| ended.context("a phone's thread panicked"))
            .collect()
    })
}
