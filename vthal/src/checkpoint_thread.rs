//! The thread that writes checkpoints, so that flushing a slow disk never delays a wheel.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use vthal_core::Checkpoint;

use crate::checkpoint_file::{self, BootTime};

/// Sends checkpoints to the thread.
#[derive(Debug)]
pub(crate) struct CheckpointHandle {
    checkpoints: Option<SyncSender<Checkpoint>>,
    thread: Option<JoinHandle<()>>,
}

/// Starts the thread.
///
/// # Errors
/// When the system gives no thread.
pub(crate) fn start(path: PathBuf) -> io::Result<CheckpointHandle> {
    let (checkpoints, queue) = sync_channel(8);
    let thread = std::thread::Builder::new()
        .name("checkpoint".to_owned())
        .spawn(move || serve(&path, &queue))?;
    Ok(CheckpointHandle {
        checkpoints: Some(checkpoints),
        thread: Some(thread),
    })
}

impl CheckpointHandle {
    /// Hands a checkpoint over. While the disk is slow some are left out: the next one says the same and more.
    pub(crate) fn send(&self, checkpoint: Checkpoint) {
        if let Some(checkpoints) = &self.checkpoints {
            checkpoints.try_send(checkpoint).ok();
        }
    }

    /// Waits until the newest one is on disk.
    pub(crate) fn finish(mut self) {
        self.checkpoints = None;
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the writer of checkpoints has failed");
        }
    }
}

fn serve(path: &Path, queue: &Receiver<Checkpoint>) {
    let mut healthy = true;
    while let Ok(first) = queue.recv() {
        let newest = queue.try_iter().last().unwrap_or(first);
        let result = BootTime::now().and_then(|now| checkpoint_file::save(path, &newest, now));
        if let Err(error) = &result
            && healthy
        {
            tracing::error!(
                "cannot write the checkpoint {}: {error}; a crash would end the job",
                path.display()
            );
        }
        healthy = result.is_ok();
    }
}
