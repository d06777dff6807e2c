//! Whoever listens: the clients with their topics, and the log with what was refused to them.

use rvac_api::{Failure, LogEntry, LogLevel, Topic, Update};

use super::clients::Clients;
use super::journal::{Journal, LogSource};
use super::refusal_log::RefusalLog;
use super::reply::Reply;
use crate::brain_session::{BrainSession, Recorder};
use crate::outputs::{Delivery, Recipients};
use crate::refusal::Refusal;
use crate::{ClientId, Outputs, Record, Recording};

/// Who asks, and the number of the request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Asker {
    pub(crate) client: ClientId,
    pub(crate) id: Option<u32>,
}

/// A request, and who asks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Asking<R> {
    pub(crate) asker: Asker,
    pub(crate) request: R,
}

/// The present moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now {
    /// Host time in microseconds.
    pub(crate) time_us: u64,
    /// Whether runs are recorded.
    pub(crate) recording: Recording,
    /// Whether a run goes on.
    pub(crate) is_run: bool,
}

/// All who listen.
#[derive(Debug, Default)]
pub(crate) struct Audience {
    pub(crate) clients: Clients,
    journal: Journal,
    refusals: RefusalLog,
}

impl Audience {
    /// The lines of the log that are kept, oldest first.
    pub(crate) fn log_lines(&self) -> impl Iterator<Item = &LogEntry> {
        self.journal.entries()
    }

    /// Writes a line of before anybody could listen.
    pub(crate) fn note_before_start(&mut self, level: LogLevel, text: String) {
        self.journal.write(0, level, (LogSource::Vthal, text));
    }

    /// The teller for a desk, now.
    pub(crate) fn teller<'a>(&'a mut self, now: Now, outputs: &'a mut Outputs) -> Teller<'a> {
        Teller {
            now_us: now.time_us,
            outputs,
            clients: &self.clients,
            journal: &mut self.journal,
            recording: now.recording,
            is_run: now.is_run,
        }
    }

    /// Logs the refusals among the deliveries from `first` on, in the words that the client reads.
    pub(crate) fn log_refusals(&mut self, now: Now, first: usize, outputs: &mut Outputs) {
        let mut lines = Vec::new();
        for delivery in outputs.deliveries.iter().skip(first) {
            if let (Recipients::One(client), Update::Failed(failure)) = (delivery.to, &delivery.update)
                && self.refusals.is_news(now.time_us, client, failure)
            {
                let Failure { reason, text, .. } = failure;
                let name = self.clients.name(client);
                lines.push(format!("{name} is refused ({reason}): {text}"));
            }
        }
        let mut teller = self.teller(now, outputs);
        for text in lines {
            teller.log(LogLevel::Info, LogSource::Client, text);
        }
    }
}

/// Carries what a desk reports: to clients, to the log, and to the shell, which performs the outputs.
pub(crate) struct Teller<'a> {
    /// Host time in microseconds.
    pub(crate) now_us: u64,
    pub(crate) outputs: &'a mut Outputs,
    clients: &'a Clients,
    journal: &'a mut Journal,
    recording: Recording,
    is_run: bool,
}

impl Teller<'_> {
    /// Writes a line of the log, for all who read it.
    pub(crate) fn log(&mut self, level: LogLevel, part: LogSource, text: String) {
        for entry in self.journal.write(self.now_us, level, (part, text)) {
            self.spread(&entry);
            self.outputs.log.push(entry);
        }
    }

    /// Writes a line that stands in the shell's own log already, for clients.
    pub(crate) fn log_of_shell(&mut self, level: LogLevel, text: String) {
        for entry in self.journal.write(self.now_us, level, (LogSource::Vthal, text)) {
            self.spread(&entry);
        }
    }

    fn spread(&mut self, entry: &LogEntry) {
        if self.clients.any(Topic::Log) {
            self.tell(Topic::Log, Update::Log(entry.clone()));
        }
        self.record(|| Record::Log(entry.clone()));
    }

    /// Writes into the recording of the run that goes on, if one is recorded.
    pub(crate) fn record(&mut self, record: impl FnOnce() -> Record) {
        if self.records_run() {
            self.outputs.records.push(record());
        }
    }

    /// Whether a run goes on that is recorded.
    pub(crate) fn records_run(&self) -> bool {
        self.recording == Recording::On && self.is_run
    }

    /// For what begins and ends runs.
    pub(crate) fn recorder(&mut self) -> Recorder<'_> {
        Recorder::new(self.recording, self.outputs)
    }

    /// The brain session may have begun or ended a run.
    pub(crate) fn follow_run(&mut self, brain_session: &BrainSession) {
        self.is_run = brain_session.is_recorded();
    }

    /// Whether anybody follows `topic`.
    pub(crate) fn has_followers(&self, topic: Topic) -> bool {
        self.clients.any(topic)
    }

    /// Whether anybody follows anything.
    pub(crate) fn has_any_follower(&self) -> bool {
        self.clients.any_topic()
    }

    /// Tells all who follow `topic`.
    pub(crate) fn tell(&mut self, topic: Topic, update: Update) {
        self.outputs.deliveries.push(Delivery {
            to: Recipients::Followers(topic),
            update,
        });
    }

    /// Tells one client.
    pub(crate) fn tell_one(&mut self, client: ClientId, update: Update) {
        self.outputs.deliveries.push(Delivery {
            to: Recipients::One(client),
            update,
        });
    }

    /// Answers a request with its result. A refusal also goes to clients that gave no number.
    pub(crate) fn answer(&mut self, asker: Asker, answer: Result<Reply, Refusal>) {
        let update = match (answer, asker.id) {
            (Ok(Reply::Done), Some(id)) => Update::Done { id },
            (Ok(Reply::Update(update)), _) => *update,
            (Ok(Reply::Done), None)
            | (Ok(Reply::ByShell | Reply::InTurn | Reply::WhenKept | Reply::AfterStep), _) => return,
            (Err(refusal), id) => Update::Failed(Failure {
                id,
                reason: refusal.reason.to_owned(),
                text: refusal.text,
            }),
        };
        self.tell_one(asker.client, update);
    }

    /// The shell refuses what only it can do.
    pub(crate) fn refuse(&mut self, client: ClientId, failure: Failure) {
        self.tell_one(client, Update::Failed(failure));
    }

    /// The name of a client for people.
    pub(crate) fn name(&self, client: ClientId) -> String {
        self.clients.name(client)
    }
}
