//! One child process: started, watched, stopped.

use anyhow::Context;
use rustix::process::{Pid, Signal, kill_process};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Last lines of a service that are shown when it ends by itself.
const LINES_KEPT: usize = 12;
/// How long a service may take to end after it was asked.
const GRACE: Duration = Duration::from_secs(4);
/// How often a service that was asked to end is looked at.
const LOOK: Duration = Duration::from_millis(20);

/// What happens while the stack runs: every cause the one loop reacts to.
#[derive(Debug)]
pub(crate) enum Event {
    /// A service is ready; the rest of its line.
    Ready(&'static str, String),
    /// A service closed its output: it has ended or is about to.
    Closed(&'static str),
    /// A person or the system asked us to end.
    Interrupted,
    /// A message of the daemon.
    Daemon(Instant, Box<rvac_api::Update>),
    /// A message of the simulator.
    Simulator(Instant, serde_json::Value),
}

/// A running child process.
#[derive(Debug)]
pub(crate) struct Service {
    name: &'static str,
    child: Child,
    lines: Arc<Mutex<VecDeque<String>>>,
    complaints: Option<JoinHandle<()>>,
}

impl Service {
    /// Starts `command`; what it says arrives as events.
    pub(crate) fn start(
        name: &'static str,
        command: &Command,
        events: &Sender<Event>,
    ) -> anyhow::Result<Self> {
        let mut command = with_parent_death_signal(command);
        // A process group of its own: Ctrl-C at the terminal reaches us alone, and we end the services in order.
        command
            .process_group(0)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().with_context(|| format!("cannot start {name}"))?;
        let lines = Arc::new(Mutex::new(VecDeque::new()));
        let complaints = child.stderr.take().map(|stream| {
            let lines = Arc::clone(&lines);
            std::thread::spawn(move || each_line(stream, |line| keep(&lines, line)))
        });
        if let Some(stream) = child.stdout.take() {
            let (lines, events) = (Arc::clone(&lines), events.clone());
            std::thread::spawn(move || watch(name, stream, &lines, &events));
        }
        Ok(Self {
            name,
            child,
            lines,
            complaints,
        })
    }

    /// Its name.
    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    /// Asks the process to end, waits, and ends it by force when it does not.
    pub(crate) fn stop(&mut self) -> std::io::Result<ExitStatus> {
        self.signal(Signal::TERM);
        let deadline = Instant::now() + GRACE;
        while Instant::now() < deadline {
            if let Some(status) = self.child.try_wait()? {
                return Ok(status);
            }
            std::thread::sleep(LOOK);
        }
        self.child.kill()?;
        self.child.wait()
    }

    /// What to tell when it ended by itself: how, and its last words.
    pub(crate) fn obituary(&mut self) -> String {
        let how = match self.stop() {
            Ok(status) => status.to_string(),
            Err(error) => error.to_string(),
        };
        // The process has ended, so its error stream ends too.
        if let Some(complaints) = self.complaints.take() {
            complaints.join().ok();
        }
        let lines = match self.lines.lock() {
            Ok(lines) => lines
                .iter()
                .map(|line| format!("\n    {line}"))
                .collect::<String>(),
            Err(_) => String::new(),
        };
        let words = if lines.is_empty() {
            " without a word".to_owned()
        } else {
            format!("; its last lines:{lines}")
        };
        format!("{} ended ({how}){words}", self.name)
    }

    fn signal(&self, signal: Signal) {
        if let Some(pid) = i32::try_from(self.child.id()).ok().and_then(Pid::from_raw) {
            // It may have ended in this very moment; waiting for it tells.
            kill_process(pid, signal).ok();
        }
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        if !matches!(self.child.try_wait(), Ok(Some(_))) {
            self.stop().ok();
        }
    }
}

/// The same command, ended by the kernel when we are killed without a chance to end it ourselves.
fn with_parent_death_signal(command: &Command) -> Command {
    let mut wrapped = match crate::system::find("setpriv") {
        Some(setpriv) => {
            let mut wrapped = Command::new(setpriv);
            wrapped
                .args(["--pdeathsig", "TERM", "--"])
                .arg(command.get_program());
            wrapped
        }
        None => Command::new(command.get_program()),
    };
    wrapped
        .args(command.get_args())
        .current_dir(crate::workspace::root());
    for (key, value) in command.get_envs() {
        if let Some(value) = value {
            wrapped.env(key, value);
        }
    }
    wrapped
}

fn watch(name: &'static str, stream: impl Read, lines: &Mutex<VecDeque<String>>, events: &Sender<Event>) {
    each_line(stream, |line| {
        // The receiver is gone only when we are ending.
        match line.strip_prefix("ready") {
            Some(rest) => events
                .send(Event::Ready(name, rest.trim().to_owned()))
                .unwrap_or(()),
            None => keep(lines, line),
        }
    });
    events.send(Event::Closed(name)).ok();
}

fn each_line(stream: impl Read, mut act: impl FnMut(&str)) {
    for line in BufReader::new(stream).split(b'\n') {
        match line {
            Ok(line) => act(&String::from_utf8_lossy(&line)),
            Err(_) => return,
        }
    }
}

fn keep(lines: &Mutex<VecDeque<String>>, line: &str) {
    if let Ok(mut lines) = lines.lock() {
        if lines.len() == LINES_KEPT {
            lines.pop_front();
        }
        lines.push_back(line.to_owned());
    }
}

#[cfg(test)]
mod tests {
    use super::{Event, Service};
    use std::process::Command;
    use std::sync::mpsc::{Receiver, channel};
    use std::time::Duration;

    const PATIENCE: Duration = Duration::from_secs(20);

    fn shell(script: &str) -> (Service, Receiver<Event>) {
        let (sender, events) = channel();
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        (
            Service::start("shell", &command, &sender).expect("sh starts"),
            events,
        )
    }

    #[test]
    fn readiness_is_heard_and_the_process_ends_when_asked() {
        let (mut service, events) =
            shell("trap 'exit 7' TERM; echo starting; echo ready http://x/; while :; do sleep 0.1; done");
        match events.recv_timeout(PATIENCE) {
            Ok(Event::Ready("shell", rest)) => assert_eq!(rest, "http://x/"),
            other => panic!("{other:?}"),
        }
        assert_eq!(service.stop().expect("it can be waited for").code(), Some(7));
    }

    #[test]
    fn a_process_that_ends_by_itself_is_reported_with_its_last_words() {
        let (mut service, events) = shell("echo 'cannot open the link' >&2; exit 3");
        assert!(matches!(
            events.recv_timeout(PATIENCE),
            Ok(Event::Closed("shell"))
        ));
        let words = service.obituary();
        assert!(
            words.contains("exit status: 3") && words.contains("cannot open the link"),
            "{words}"
        );
    }
}
