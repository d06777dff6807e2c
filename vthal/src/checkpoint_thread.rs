//! The thread that writes checkpoints and maps, so that flushing a slow disk never delays a wheel.

use std::io;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use brain::StoredMap;
use vthal_core::Checkpoint;

use crate::checkpoint_file::{self, BootTime};
use crate::home_file;

/// Where to write.
pub(crate) struct KeptPaths {
    /// The checkpoint.
    pub(crate) checkpoint: PathBuf,
    /// The map of the home.
    pub(crate) home: PathBuf,
}

/// Something to be kept.
enum Kept {
    Checkpoint(Box<Checkpoint>),
    Home(Box<StoredMap>),
}

/// Sends checkpoints and maps to the thread.
#[derive(Debug)]
pub(crate) struct CheckpointHandle {
    queue: Option<SyncSender<Kept>>,
    thread: Option<JoinHandle<()>>,
}

/// Starts the thread.
///
/// # Errors
/// When the system gives no thread.
pub(crate) fn start(paths: KeptPaths) -> io::Result<CheckpointHandle> {
    let (sender, queue) = sync_channel(8);
    let thread = std::thread::Builder::new()
        .name("checkpoint".to_owned())
        .spawn(move || serve(&paths, &queue))?;
    Ok(CheckpointHandle {
        queue: Some(sender),
        thread: Some(thread),
    })
}

impl CheckpointHandle {
    /// Hands a checkpoint over. While the disk is slow some are left out: the next one says the same and more.
    pub(crate) fn send(&self, checkpoint: Checkpoint) {
        self.try_send(Kept::Checkpoint(Box::new(checkpoint)));
    }

    /// Hands a map over. If the disk is so slow that it is left out, the one after the next run says more.
    pub(crate) fn send_home(&self, home: StoredMap) {
        self.try_send(Kept::Home(Box::new(home)));
    }

    fn try_send(&self, kept: Kept) {
        if let Some(queue) = &self.queue {
            queue.try_send(kept).ok();
        }
    }

    /// Waits until the newest ones are on disk.
    pub(crate) fn finish(mut self) {
        self.queue = None;
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the writer of checkpoints has failed");
        }
    }
}

fn serve(paths: &KeptPaths, queue: &Receiver<Kept>) {
    let mut healthy = true;
    while let Ok(first) = queue.recv() {
        let (mut checkpoint, mut home) = (None, None);
        for kept in core::iter::once(first).chain(queue.try_iter()) {
            match kept {
                Kept::Checkpoint(newer) => checkpoint = Some(newer),
                Kept::Home(newer) => home = Some(newer),
            }
        }
        if let Some(checkpoint) = checkpoint {
            let result =
                BootTime::now().and_then(|now| checkpoint_file::save(&paths.checkpoint, &checkpoint, now));
            if let Err(error) = &result
                && healthy
            {
                tracing::error!(
                    "cannot write the checkpoint {}: {error}; a crash would end the job",
                    paths.checkpoint.display()
                );
            }
            healthy = result.is_ok();
        }
        if let Some(home) = home
            && let Err(error) = home_file::save(&paths.home, &home)
        {
            tracing::error!(
                "cannot write the map {}: {error}; the robot will have to make it again",
                paths.home.display()
            );
        }
    }
}
