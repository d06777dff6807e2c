//! The one connection to the daemon: what it says goes to the site, what clients ask goes to it, and each gets its answer.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use bridge::{Daemon, News};
use rvac_api::{Failure, KeptMap, RequestBody, Topic, Update};
use tokio::sync::{mpsc, oneshot};
use tokio::time::{MissedTickBehavior, interval, timeout};

use crate::answer::Refusal;
use crate::site::{MAP_EVERY, Site};

const TOPICS: [Topic; 6] = [
    Topic::Status,
    Topic::Device,
    Topic::Pose,
    Topic::Map,
    Topic::Home,
    Topic::Runs,
];
/// Questions that wait to be sent, and answers that are waited for.
const QUESTIONS_MAX: usize = 32;
const WAITING_MAX: usize = 64;
/// A change of the home is answered when it is on the disk.
const PATIENCE: Duration = Duration::from_secs(10);
/// Pause between questions about wear.
const WEAR_EVERY: Duration = Duration::from_secs(15 * 60);

/// What the daemon has answered.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Asked {
    /// It is done.
    Done,
    /// The versions of the map that are kept.
    Maps(Vec<KeptMap>),
}

/// A question of a client.
#[derive(Debug)]
pub(crate) struct Question {
    body: RequestBody,
    answer: oneshot::Sender<Result<Asked, Refusal>>,
}

/// Where questions are handed in.
#[derive(Clone, Debug)]
pub(crate) struct Desk(mpsc::Sender<Question>);

/// A desk, and what is handed in there.
pub(crate) fn open() -> (Desk, mpsc::Receiver<Question>) {
    let (sender, receiver) = mpsc::channel(QUESTIONS_MAX);
    (Desk(sender), receiver)
}

impl Desk {
    pub(crate) async fn ask(&self, body: RequestBody) -> Result<Asked, Refusal> {
        let (answer, answered) = oneshot::channel();
        self.0
            .try_send(Question { body, answer })
            .map_err(|_| Refusal::Busy)?;
        match timeout(PATIENCE, answered).await {
            Ok(Ok(answer)) => answer,
            Ok(Err(_)) => Err(Refusal::Away),
            Err(_) => Err(Refusal::Late),
        }
    }
}

/// Answers that are waited for, by the numbers of their requests.
#[derive(Debug, Default)]
struct Waiting(BTreeMap<u32, Question>);

impl Waiting {
    fn add(&mut self, id: u32, question: Question) {
        // Whoever waited for too long has gone.
        self.0.retain(|_, question| !question.answer.is_closed());
        if self.0.len() >= WAITING_MAX {
            return answer(question, Err(Refusal::Busy));
        }
        self.0.insert(id, question);
    }

    fn take(&mut self, update: &Update) {
        match update {
            Update::Done { id } => self.end(*id, Ok(Asked::Done)),
            Update::Failed(failure) => self.refuse(failure),
            Update::Maps { maps, .. } => {
                let asked = self
                    .0
                    .iter()
                    .find(|(_, question)| matches!(question.body, RequestBody::Maps { .. }));
                if let Some((id, _)) = asked {
                    self.end(*id, Ok(Asked::Maps(maps.clone())));
                }
            }
            _ => {}
        }
    }

    fn refuse(&mut self, failure: &Failure) {
        if let Some(id) = failure.id {
            self.end(id, Err(Refusal::Daemon(failure.clone())));
        }
    }

    fn end(&mut self, id: u32, with: Result<Asked, Refusal>) {
        if let Some(question) = self.0.remove(&id) {
            answer(question, with);
        }
    }

    fn forget(&mut self) {
        for (_, question) in std::mem::take(&mut self.0) {
            answer(question, Err(Refusal::Away));
        }
    }
}

fn answer(question: Question, with: Result<Asked, Refusal>) {
    // A client that has gone needs no answer.
    question.answer.send(with).ok();
}

/// Follows the daemon for ever.
pub(crate) async fn follow(socket: PathBuf, site: Arc<Site>, mut questions: mpsc::Receiver<Question>) {
    let mut daemon = Daemon::new(socket, "rvac-dialect", &TOPICS);
    let mut waiting = Waiting::default();
    let mut maps = interval(MAP_EVERY);
    maps.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut wear = interval(WEAR_EVERY);
    wear.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        tokio::select! {
            news = daemon.next() => match news {
                News::Connected => {
                    wear.reset_immediately();
                    // A daemon that is away is asked when it comes; so are all that follow.
                    daemon.request(RequestBody::Statistics).await.ok();
                }
                News::Lost => {
                    waiting.forget();
                    site.daemon_went();
                }
                News::Update(update) => {
                    waiting.take(&update);
                    if let Some(next) = site.take(&update) {
                        daemon.request(next).await.ok();
                    }
                    let is_new = site.store().known.wants_hello();
                    if is_new {
                        daemon.hello().await.ok();
                    }
                }
            },
            Some(question) = questions.recv() => match daemon.request(question.body.clone()).await {
                Ok(id) => waiting.add(id, question),
                Err(_) => answer(question, Err(Refusal::Away)),
            },
            _ = maps.tick() => {
                if site.map_is_followed() {
                    site.say_map();
                }
            }
            _ = wear.tick() => {
                daemon.request(RequestBody::Health).await.ok();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{Failure, RequestBody, Update};
    use tokio::sync::oneshot;

    use super::{Asked, Question, WAITING_MAX, Waiting};
    use crate::answer::Refusal;

    type Answered = oneshot::Receiver<Result<Asked, Refusal>>;

    fn question(body: RequestBody) -> (Question, Answered) {
        let (answer, answered) = oneshot::channel();
        (Question { body, answer }, answered)
    }

    #[test]
    fn each_client_gets_the_answer_to_its_own_question() {
        let mut waiting = Waiting::default();
        let (stop, mut stopped) = question(RequestBody::Stop);
        let (maps, mut listed) = question(RequestBody::Maps { floor: None });
        let (dock, mut docked) = question(RequestBody::Dock);
        for (id, question) in [(1, stop), (2, maps), (3, dock)] {
            waiting.add(id, question);
        }
        let failure = Failure {
            id: Some(3),
            reason: "no-robot".to_owned(),
            text: "x".to_owned(),
        };
        waiting.take(&Update::Failed(failure.clone()));
        assert_eq!(docked.try_recv(), Ok(Err(Refusal::Daemon(failure))));
        assert!(stopped.try_recv().is_err());
        waiting.take(&Update::Maps {
            floor: None,
            maps: Vec::new(),
        });
        assert_eq!(listed.try_recv(), Ok(Ok(Asked::Maps(Vec::new()))));
        waiting.forget();
        assert_eq!(stopped.try_recv(), Ok(Err(Refusal::Away)));
    }

    #[test]
    fn a_daemon_that_does_not_answer_fills_no_memory() {
        let mut waiting = Waiting::default();
        let mut patient = Vec::new();
        for id in 0..1_000 {
            let (stop, stopped) = question(RequestBody::Stop);
            waiting.add(id, stop);
            patient.push(stopped);
        }
        assert_eq!(waiting.0.len(), WAITING_MAX);
        assert_eq!(patient[WAITING_MAX].try_recv(), Ok(Err(Refusal::Busy)));
        drop(patient);
        let (stop, _stopped) = question(RequestBody::Stop);
        waiting.add(5_000, stop);
        assert_eq!(waiting.0.len(), 1, "who has gone leaves room");
    }
}
