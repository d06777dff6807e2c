//! The thread that writes recordings, so that a slow disk never delays a wheel.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

use vthal_core::Record;

use super::{Library, RecordError, RunFile};

/// Records that may wait for the disk: some ten seconds of a run.
const WAITING_MAX: usize = 4096;
/// Beginnings of runs among them: each has a whole home with it.
const BEGINNINGS_MAX: usize = 2;
/// What was recorded longer ago than this is in the file.
const FLUSH_AFTER: Duration = Duration::from_secs(1);

/// Sends records to the thread.
#[derive(Debug)]
pub struct RecorderHandle {
    records: Option<SyncSender<Record>>,
    thread: Option<JoinHandle<()>>,
    /// Beginnings of runs that wait.
    beginnings: Arc<AtomicUsize>,
    /// The beginning of the run that goes on was lost, and so is the rest of it.
    skips: bool,
    lost: u64,
}

/// Starts the thread. `settings` goes into the metadata of each file; `opened` is called with the number of each run that is recorded
/// and the name of its file.
///
/// # Errors
/// When the system gives no thread.
pub fn start(
    library: Library,
    settings: String,
    opened: impl Fn(u32, String) + Send + 'static,
) -> io::Result<RecorderHandle> {
    let (records, queue) = sync_channel(WAITING_MAX);
    let beginnings = Arc::new(AtomicUsize::new(0));
    let waiting = Arc::clone(&beginnings);
    let thread = std::thread::Builder::new()
        .name("recorder".to_owned())
        .spawn(move || {
            Recorder {
                library,
                settings,
                opened: Box::new(opened),
                beginnings: waiting,
                run: None,
                flushed: Instant::now(),
            }
            .serve(&queue)
        })?;
    Ok(RecorderHandle {
        records: Some(records),
        thread: Some(thread),
        beginnings,
        skips: false,
        lost: 0,
    })
}

impl RecorderHandle {
    /// Hands a record over. When the disk is too slow for the queue the record is lost, and the first loss is logged.
    pub fn send(&mut self, record: Record) {
        let Some(records) = &self.records else { return };
        let is_beginning = matches!(record, Record::RunStarted(_));
        if is_beginning {
            self.skips = self.beginnings.load(Ordering::Relaxed) >= BEGINNINGS_MAX;
        }
        if self.skips {
            return self.lose();
        }
        if is_beginning {
            self.beginnings.fetch_add(1, Ordering::Relaxed);
        }
        if let Err(TrySendError::Full(_)) = records.try_send(record) {
            if is_beginning {
                self.beginnings.fetch_sub(1, Ordering::Relaxed);
                self.skips = true;
            }
            self.lose();
        }
    }

    fn lose(&mut self) {
        if self.lost == 0 {
            tracing::warn!("the disk is too slow for the recording: records are lost");
        }
        self.lost += 1;
    }

    /// Waits until everything is in the file.
    pub fn finish(mut self) {
        self.records = None;
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the recorder has failed");
        }
    }
}

struct Recorder {
    library: Library,
    settings: String,
    opened: Box<dyn Fn(u32, String)>,
    beginnings: Arc<AtomicUsize>,
    run: Option<RunFile>,
    flushed: Instant,
}

impl Recorder {
    fn serve(mut self, queue: &Receiver<Record>) {
        loop {
            let result = match queue.recv_timeout(FLUSH_AFTER) {
                Ok(record) => {
                    let result = self.take(&record).and_then(|()| self.flush_when_due());
                    if matches!(record, Record::RunStarted(_)) {
                        self.beginnings.fetch_sub(1, Ordering::Relaxed);
                    }
                    result
                }
                Err(RecvTimeoutError::Timeout) => self.flush(),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            if let Err(error) = result {
                tracing::error!("{error}; this run is not recorded further");
                self.run = None;
            }
        }
        if let Err(error) = self.end_run() {
            tracing::error!("{error}");
        }
    }

    fn take(&mut self, record: &Record) -> Result<(), RecordError> {
        match record {
            Record::RunStarted(start) => {
                self.end_run()?;
                let path = self.library.new_path(SystemTime::now());
                let path = path.map_err(RecordError::Folder)?;
                self.run = Some(RunFile::create(&path, start, &self.settings)?);
                tracing::info!("records to {}", path.display());
                if let Some(name) = path.file_name().and_then(|name| name.to_str()) {
                    (self.opened)(start.run, name.to_owned());
                }
                self.tidy();
                Ok(())
            }
            Record::RunEnded { .. } => self.end_run(),
            _ => self.add(record),
        }
    }

    fn add(&mut self, record: &Record) -> Result<(), RecordError> {
        let Some(run) = &mut self.run else { return Ok(()) };
        run.write(record)?;
        if run.bytes() > self.library.limits().bytes_max {
            tracing::warn!(
                "{} is as large as all recordings may be: it ends here",
                run.path().display()
            );
            self.end_run()?;
        }
        Ok(())
    }

    fn flush_when_due(&mut self) -> Result<(), RecordError> {
        if self.flushed.elapsed() >= FLUSH_AFTER {
            self.flush()
        } else {
            Ok(())
        }
    }

    fn flush(&mut self) -> Result<(), RecordError> {
        self.flushed = Instant::now();
        self.run.as_mut().map_or(Ok(()), RunFile::flush)
    }

    fn end_run(&mut self) -> Result<(), RecordError> {
        let Some(run) = self.run.take() else { return Ok(()) };
        run.finish()?;
        self.tidy();
        Ok(())
    }

    fn tidy(&self) {
        if let Err(error) = self.library.tidy() {
            tracing::warn!("old recordings cannot be removed: {error}");
        }
    }
}
