//! One drive: readings come in, requests go out under a lease.

use std::io::Write as _;
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use anyhow::bail;
use mixer::{Axes, Cleaning, Helm, MixState, Mixed, Mixer, Order, Press, Profile, Readings};
use rvac_api::{CleaningPower, Request, RequestBody, RobotDescription, Update};

use super::Event;
use crate::socket::Connection;

/// The mixer looks at the inputs so often.
const TICK: Duration = Duration::from_millis(20);
/// What does not change is said again so often: two renewals of the lease may be lost.
const RENEW: Duration = Duration::from_millis(80);
/// The lease of each request.
const LEASE_MS: u16 = 250;
/// Number of the drive requests, so that a refusal of one is known as such.
const DRIVE_ID: u32 = 1;
/// Number of all other requests.
const PRESS_ID: u32 = 2;

/// A person who drives.
pub(super) struct Session {
    connection: Connection,
    robot: RobotDescription,
    mixer: Mixer,
    helm: Helm,
    readings: Readings,
    start: Instant,
    sent: Option<(Instant, Order)>,
    /// What was told to the person last.
    told: Option<MixState>,
}

/// Hears the daemon on a thread of its own.
pub(super) fn hear(mut connection: Connection, events: Sender<Event>) {
    std::thread::spawn(move || {
        loop {
            let event = match connection.receive() {
                Ok(message) => message.update.map(|update| Event::Daemon(Box::new(update))),
                Err(error) => Some(Event::Lost(error)),
            };
            let is_over = matches!(event, Some(Event::Lost(_)));
            if event.is_some_and(|event| events.send(event).is_err()) || is_over {
                return;
            }
        }
    });
}

impl Session {
    pub(super) fn new(
        connection: Connection,
        profile: Profile,
        robot: RobotDescription,
    ) -> anyhow::Result<Self> {
        Ok(Self {
            connection,
            robot,
            mixer: Mixer::new(profile)?,
            helm: Helm::default(),
            readings: Readings::default(),
            start: Instant::now(),
            sent: None,
            told: None,
        })
    }

    /// Drives until the inputs end or the daemon goes.
    pub(super) fn run(&mut self, inbox: &Receiver<Event>) -> anyhow::Result<ExitCode> {
        remark(&format!("drives by the mix {}", self.mixer.profile().name))?;
        let mut tick = Instant::now();
        loop {
            let left = tick.saturating_duration_since(Instant::now());
            // First of all: however much comes in, the lease is renewed.
            if left.is_zero() {
                self.step()?;
                tick = Instant::now() + TICK;
            }
            match inbox.recv_timeout(left) {
                Ok(event) => {
                    if self.take(event)? {
                        self.readings = Readings::default();
                        self.step()?;
                        return Ok(ExitCode::SUCCESS);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => bail!("all inputs have ended"),
            }
        }
    }

    /// Whether it is over.
    fn take(&mut self, event: Event) -> anyhow::Result<bool> {
        match event {
            Event::Moved(source, value) => {
                self.readings.set(&source, value);
            }
            Event::Gone(device) => {
                self.readings.remove(device);
                remark(&format!("{device} is gone: the wheels stand"))?;
            }
            Event::Remark(text) if text.is_empty() => {}
            Event::Remark(text) => remark(&text)?,
            Event::Ended => return Ok(true),
            Event::Wrong(error) => return Err(error.into()),
            Event::Daemon(update) => self.hear(*update)?,
            Event::Lost(error) => return Err(error),
        }
        Ok(false)
    }

    fn hear(&mut self, update: Update) -> anyhow::Result<()> {
        match update {
            Update::Failed(failure) => {
                if failure.id == Some(DRIVE_ID) {
                    self.helm.refuse();
                }
                remark(&format!("refused ({}): {}", failure.reason, failure.text))?;
            }
            Update::Hello {
                robot: Some(robot), ..
            } => self.robot = robot,
            _ => {}
        }
        Ok(())
    }

    fn step(&mut self) -> anyhow::Result<()> {
        let now_us = u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX);
        let mixed = self.mixer.step(now_us, &self.readings);
        self.tell(&mixed)?;
        let wish = mixed.wish();
        for press in &wish.presses {
            self.press(*press)?;
        }
        let order = self.helm.order(&wish);
        let is_due = self
            .sent
            .is_none_or(|(when, last)| last != order || when.elapsed() >= RENEW);
        let body = match order {
            Order::Nothing => None,
            Order::Release => Some(RequestBody::Release),
            Order::Drive { axes, cleaning } => is_due.then(|| self.drive(axes, cleaning)),
        };
        let Some(body) = body else { return Ok(()) };
        self.sent = Some((Instant::now(), order));
        self.connection.send(&Request {
            id: Some(DRIVE_ID),
            body,
        })
    }

    fn drive(&self, axes: Axes, cleaning: Cleaning) -> RequestBody {
        let power = CleaningPower {
            suction: cleaning.suction,
            main_brush: cleaning.main_brush,
            side_brushes: cleaning.side_brushes,
        };
        RequestBody::Drive {
            v: axes.forward * self.robot.speed_max_m_per_s,
            w: axes.turn * self.robot.turn_max_rad_per_s,
            ttl: LEASE_MS,
            clean: false,
            power: Some(power),
        }
    }

    fn press(&mut self, press: Press) -> anyhow::Result<()> {
        let body = match press {
            Press::Start => RequestBody::Start { strategy: None },
            Press::Stop => RequestBody::Stop,
            Press::Spot => RequestBody::Spot,
            Press::Dock => RequestBody::Dock,
        };
        self.connection.send(&Request {
            id: Some(PRESS_ID),
            body,
        })
    }

    /// Tells the person when the inputs begin or cease to count.
    fn tell(&mut self, mixed: &Mixed) -> anyhow::Result<()> {
        if self.told.replace(mixed.state) == Some(mixed.state) {
            return Ok(());
        }
        match mixed.state {
            MixState::Live => remark("ready"),
            MixState::Failsafe => remark("waits until every input is at rest"),
        }
    }
}

/// Prints a line for the person. The terminal may be raw, where a line needs its carriage return.
fn remark(text: &str) -> anyhow::Result<()> {
    let mut output = std::io::stdout().lock();
    write!(output, "{text}\r\n")?;
    Ok(output.flush()?)
}
