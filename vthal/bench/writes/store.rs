//! One kind of what the daemon keeps, as it tells it, and changes of it.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use anyhow::bail;
use rvac_api::{LogEntry, LogLevel, Request, RequestBody, Topic, Update};

use vthal_bench::Client;

use crate::life::Kept;

/// A request, and the texts of what is kept when it is done.
#[derive(Debug)]
pub(crate) struct Change {
    pub(crate) request: RequestBody,
    pub(crate) after: Vec<String>,
}

/// One kind of what people entrust to the daemon.
pub(crate) trait Store {
    /// For people and figures.
    fn name(&self) -> &'static str;

    /// Waits until it can be changed.
    fn get_ready(&self, _desk: &mut Desk) -> anyhow::Result<()> {
        Ok(())
    }

    /// Asks the daemon.
    fn read(&self, desk: &mut Desk) -> anyhow::Result<Kept>;

    /// Makes up a change. `number` is never given twice, and grows.
    fn change(&self, kept: &Kept, number: u64) -> Change;
}

/// Lines of the log that a failure tells.
const LATELY_MAX: usize = 12;
/// Longest wait for any answer.
const ANSWERS_WITHIN: Duration = Duration::from_secs(20);

/// A client, and what it has heard of errors.
pub(crate) struct Desk {
    client: Client,
    /// Errors that the daemon told: damaged files are among them.
    pub(crate) errors: Vec<String>,
    /// The newest lines of its log.
    lately: VecDeque<String>,
}

impl Desk {
    pub(crate) fn new(client: Client) -> Self {
        Self {
            client,
            errors: Vec::new(),
            lately: VecDeque::new(),
        }
    }

    pub(crate) fn send(&mut self, id: u32, body: RequestBody) -> anyhow::Result<()> {
        let request = Request { id: Some(id), body };
        Ok(self.client.send(&serde_json::to_string(&request)?)?)
    }

    /// Asks for the present view of a topic.
    pub(crate) fn look_at(&mut self, topic: Topic) -> anyhow::Result<()> {
        for topics in [vec![Topic::Log], vec![Topic::Log, topic]] {
            self.send(1, RequestBody::Watch { topics })?;
        }
        Ok(())
    }

    /// Reads until something fits.
    pub(crate) fn wait<T>(&mut self, what: &str, fits: impl Fn(Update) -> Option<T>) -> anyhow::Result<T> {
        let deadline = Instant::now() + ANSWERS_WITHIN;
        while let Some(text) = self.client.next(deadline)? {
            let Ok(update) = serde_json::from_str::<Update>(&text) else {
                continue;
            };
            if let Update::Log(entry) = &update {
                self.note(entry);
            }
            if let Some(found) = fits(update) {
                return Ok(found);
            }
        }
        bail!(
            "the daemon did not tell {what}; lately: {}",
            Vec::from(self.lately.clone()).join("; ")
        )
    }

    fn note(&mut self, LogEntry { level, text, .. }: &LogEntry) {
        if *level == LogLevel::Error {
            self.errors.push(text.clone());
        }
        self.lately.push_back(text.clone());
        if self.lately.len() > LATELY_MAX {
            self.lately.pop_front();
        }
    }

    /// Waits until a request is answered; whether it was done.
    pub(crate) fn wait_for_answer(&mut self, id: u32) -> anyhow::Result<bool> {
        let answer = self.wait("whether a change was done", |update| answer_to(id, update))?;
        Ok(answer.is_ok())
    }

    /// Waits until a request is answered, which must not be a refusal.
    pub(crate) fn wait_for_acknowledgement(&mut self, id: u32) -> anyhow::Result<()> {
        let answer = self.wait("whether a change was done", |update| answer_to(id, update))?;
        answer.map_err(|text| anyhow::anyhow!("a change was refused: {text}"))
    }

    /// Whether the answer came before the daemon ended.
    pub(crate) fn was_acknowledged(&mut self, id: u32) -> anyhow::Result<bool> {
        let deadline = Instant::now() + ANSWERS_WITHIN;
        while let Some(text) = self.client.next(deadline)? {
            match serde_json::from_str(&text)
                .ok()
                .and_then(|update| answer_to(id, update))
            {
                Some(Ok(())) => return Ok(true),
                Some(Err(reason)) => bail!("a change was refused: {reason}"),
                None => {}
            }
        }
        Ok(false)
    }
}

fn answer_to(id: u32, update: Update) -> Option<Result<(), String>> {
    match update {
        Update::Done { id: done } if done == id => Some(Ok(())),
        Update::Failed(failure) if failure.id == Some(id) => Some(Err(failure.text)),
        _ => None,
    }
}
