//! The thread that reads what is kept of runs for clients: recordings are large, and writers must not wait for them.

use std::io;
use std::sync::mpsc::{SyncSender, sync_channel};

use rvac_api::Update;
use tokio::sync::mpsc::Sender;
use vthal_core::{ClientId, RunQuery};

use crate::event::Event;
use crate::lifetime_file::LifetimeFile;
use crate::run_desk::RunDesk;
use crate::run_folder::RunError;

/// Questions that may wait.
const WAITING_MAX: usize = 16;

/// What a client gets.
#[derive(Debug)]
pub(crate) struct RunAnswer {
    /// Who asked.
    pub(crate) client: ClientId,
    /// Number of the request.
    pub(crate) id: Option<u32>,
    /// What came of it.
    pub(crate) outcome: Result<Box<Update>, RunError>,
}

/// Hands questions to the thread. It ends with this.
#[derive(Debug)]
pub(crate) struct RunHandle(SyncSender<RunQuery>);

/// Starts the thread. Answers become events.
///
/// # Errors
/// When the system gives no thread.
pub(crate) fn start(lifetime: LifetimeFile, events: Sender<Event>) -> io::Result<RunHandle> {
    let (sender, queue) = sync_channel::<RunQuery>(WAITING_MAX);
    std::thread::Builder::new()
        .name("history".to_owned())
        .spawn(move || {
            let mut desk = RunDesk::new(lifetime);
            for RunQuery { client, id, task } in queue {
                let outcome = desk.answer(task).map(Box::new);
                let answer = RunAnswer { client, id, outcome };
                if events.blocking_send(Event::Runs(answer)).is_err() {
                    return;
                }
            }
        })?;
    Ok(RunHandle(sender))
}

impl RunHandle {
    /// Hands a question over; `false` when too many wait.
    #[must_use]
    pub(crate) fn ask(&self, query: RunQuery) -> bool {
        self.0.try_send(query).is_ok()
    }
}
