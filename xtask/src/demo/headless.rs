//! The demo without a browser: cleans for some simulated minutes as a client of the daemon's socket, then reports.

use super::DemoArguments;
use super::report::DemoReport;
use super::service::Event;
use super::socket::Socket;
use super::stack::Stack;
use super::state::State;
use super::trace::Trace;
use crate::process;
use anyhow::{Context, bail};
use rvac_api::{Request, RequestBody, SimulatedTruth, Status, Topic, Update};
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// How long the daemon may take to find the robot, to answer a request, or the simulator to say anything.
const PATIENCE: Duration = Duration::from_secs(20);
/// Simulated seconds between two lines of progress.
const PROGRESS_S: f64 = 60.0;

/// Runs, prints the report as the last line, and fails unless the robot moved and violated nothing.
pub(crate) fn run(arguments: &DemoArguments, firmware: Option<&Path>) -> anyhow::Result<()> {
    let begun = Instant::now();
    let mut stack = Stack::new(State::create(arguments.state.as_deref())?)?;
    let outcome = stack
        .start_robot(arguments, firmware)
        .and_then(|()| clean(arguments, &mut stack));
    stack.stop();
    let mut report = outcome?;
    report.wall_seconds = begun.elapsed().as_secs_f64();
    process::print(&serde_json::to_string(&report)?);
    match report.failure() {
        Some(reason) => bail!("{reason}"),
        None => Ok(()),
    }
}

fn clean(arguments: &DemoArguments, stack: &mut Stack) -> anyhow::Result<DemoReport> {
    let mut run = Run::connect(stack)?;
    run.until("the daemon finds the robot", |event| {
        found_robot(event).then_some(())
    })?;
    process::say(&format!(
        "clean for {} simulated minutes at {} times real time",
        arguments.minutes,
        arguments.speed()
    ));
    run.request(1, RequestBody::Start { strategy: None })?;
    run.clean(arguments.minutes * 60.0)?;
    run.request(2, RequestBody::Stop)?;
    run.simulator.send(&json!({"c": "report"}))?;
    let mut report = run.until("the simulator reports", |event| match event {
        Event::Simulator(_, message) if message["e"] == "report" => Some(message.clone()),
        _ => None,
    })?;
    report["pose_rmse_m"] = json!(
        run.trace
            .rmse_m()
            .context("no pose of the daemon met a pose of the simulator")?
    );
    report["wall_seconds"] = json!(0.0);
    Ok(serde_json::from_value(report)?)
}

fn found_robot(event: &Event) -> bool {
    matches!(event, Event::Daemon(_, update) if matches!(&**update, Update::Status(Status { state, .. }) if state != "disconnected"))
}

/// Both connections and what was heard on them.
struct Run<'stack> {
    stack: &'stack mut Stack,
    daemon: Socket,
    simulator: Socket,
    trace: Trace,
    truth: Option<SimulatedTruth>,
}

impl<'stack> Run<'stack> {
    fn connect(stack: &'stack mut Stack) -> anyhow::Result<Self> {
        let to = stack.sender();
        let mut daemon = Socket::open(&stack.daemon_socket(), move |message| {
            // What a newer daemon says besides is not for us; the receiver is gone only when we are ending.
            if let Ok(update) = serde_json::from_value(message) {
                to.send(Event::Daemon(Instant::now(), Box::new(update))).ok();
            }
        })?;
        let to = stack.sender();
        let simulator = Socket::open(&stack.simulator_socket(), move |message: Value| {
            to.send(Event::Simulator(Instant::now(), message)).ok();
        })?;
        let hello = RequestBody::Hello {
            name: "cargo xtask demo".to_owned(),
        };
        daemon.ask(&Request {
            id: None,
            body: hello,
        })?;
        let watch = RequestBody::Watch {
            topics: vec![Topic::Status, Topic::Pose],
        };
        daemon.ask(&Request {
            id: None,
            body: watch,
        })?;
        Ok(Self {
            stack,
            daemon,
            simulator,
            trace: Trace::default(),
            truth: None,
        })
    }

    /// Handles events until `done` finds what it looks for.
    fn until<T>(&mut self, what: &str, done: impl Fn(&Event) -> Option<T>) -> anyhow::Result<T> {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let event = self.stack.next(deadline)?;
            let Some(event) = event else {
                bail!("waited {} s in vain until {what}", PATIENCE.as_secs())
            };
            self.hear(&event)?;
            if let Some(found) = done(&event) {
                return Ok(found);
            }
        }
    }

    fn hear(&mut self, event: &Event) -> anyhow::Result<()> {
        match event {
            Event::Interrupted => bail!("interrupted"),
            Event::Daemon(at, update) => {
                if let Update::Pose(pose) = &**update {
                    self.trace.believe(*at, pose);
                }
            }
            Event::Simulator(at, message) => {
                if let Ok(Update::SimulatedTruth(truth)) = serde_json::from_value(message.clone()) {
                    self.trace.reveal(*at, &truth.pose);
                    self.truth = Some(truth);
                }
            }
            Event::Ready(..) | Event::Closed(_) => {}
        }
        Ok(())
    }

    /// Asks the daemon for something and waits until it is done.
    fn request(&mut self, id: u32, body: RequestBody) -> anyhow::Result<()> {
        self.daemon.ask(&Request {
            id: Some(id),
            body: body.clone(),
        })?;
        let answer = self.until(&format!("the daemon answers {body:?}"), |event| match event {
            Event::Daemon(_, update) => match &**update {
                Update::Done { id: done } if *done == id => Some(Ok(())),
                Update::Failed(failure) if failure.id == Some(id) => Some(Err(failure.clone())),
                _ => None,
            },
            _ => None,
        })?;
        answer.map_err(|failure| {
            anyhow::anyhow!(
                "the daemon refused {body:?}: {} ({})",
                failure.text,
                failure.reason
            )
        })
    }

    /// Watches the robot for so many simulated seconds.
    fn clean(&mut self, seconds: f64) -> anyhow::Result<()> {
        let begun = self.truth()?.sim_s;
        let mut next = begun + PROGRESS_S;
        loop {
            let truth = self.truth()?;
            if truth.sim_s - begun >= seconds {
                return Ok(());
            }
            if truth.sim_s >= next {
                next += PROGRESS_S;
                let minutes = (truth.sim_s - begun) / 60.0;
                process::say(&format!(
                    "{minutes:.0} min: {:.1} % covered",
                    truth.covered * 100.0
                ));
            }
        }
    }

    fn truth(&mut self) -> anyhow::Result<SimulatedTruth> {
        self.truth = None;
        self.until("the simulator shows where the robot is", |event| {
            matches!(event, Event::Simulator(_, message) if message["e"] == "simulated-truth").then_some(())
        })?;
        self.truth
            .context("the simulator's message about the true pose could not be read")
    }
}
