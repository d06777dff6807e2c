//! Updates of the robot's software: takes the file from an administrator, lays it down for the program that installs it, and tells
//! how far that is.
//!
//! This server may change nothing but its own folder. A *receipt* is a file that comes, as `incoming`; a whole one gets the name
//! `offer.update`. systemd sees that name and starts `rvac update`, which takes the file away, verifies it before it touches anything, and notes
//! its progress in the folder of updates. What is told here is read from those files, so that it outlives this server.

use std::fs::{File, OpenOptions};
use std::io;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::body::Body;
use axum::http::{HeaderMap, Response, StatusCode, header};
use axum::response::IntoResponse as _;
use futures_util::StreamExt as _;
use rvac_api::{SoftwareUpdate, UPDATE_BYTES_MAX, UpdateEnd, UpdateStage};
use tokio::sync::watch;
use tokio::time::timeout;
use tracing::{info, warn};

use crate::api::{json, refused_as};

/// A sender from whom nothing comes for so long is gone.
const CHUNK_TIME_MAX: Duration = Duration::from_secs(20);
/// How often the files are looked at while an update goes on, and otherwise.
const LOOK_EVERY: Duration = Duration::from_millis(500);
const GLANCE_EVERY: Duration = Duration::from_secs(2);
/// Bytes that are written at once: few enough for the memory of a small board.
const CHUNK_BYTES: usize = 256 << 10;
/// Nobody who installs updates takes longer to take one.
const TAKEN_WITHIN: Duration = Duration::from_secs(60);
/// What stays free for maps and recordings.
const SPARE_BYTES: u64 = 16 << 20;

/// The names of a file that comes, and of one that came whole.
const INCOMING: &str = "incoming";
const OFFER: &str = "offer.update";
/// Of what `rvac update` writes.
const PROGRESS: &str = "progress.json";
const LOCK: &str = "lock";
/// Its progress is shorter.
const PROGRESS_BYTES_MAX: u64 = 64 << 10;

/// Bytes that fit on the disk of this folder still.
///
/// # Errors
/// What the file system says.
pub fn free_bytes(folder: &Path) -> io::Result<u64> {
    let about = rustix::fs::statvfs(folder)?;
    Ok(about.f_bavail.saturating_mul(about.f_frsize))
}

/// Why a file is not taken.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotTaken {
    /// It does not say how long it is.
    #[error("The request does not say how long the file is.")]
    LengthRequired,
    /// It is no update.
    #[error("A file of {0} bytes is no update: the longest has {max} MiB.", max = UPDATE_BYTES_MAX >> 20)]
    TooLong(u64),
    /// Another one comes or is installed.
    #[error("Another update is on its way: wait until it has ended.")]
    Busy,
    /// It does not fit.
    #[error("The robot's disk has {free} MiB left and the update needs {needed}: delete recordings.", free = free_bytes >> 20, needed = needed_bytes >> 20)]
    DiskFull {
        /// With room for what is unpacked.
        needed_bytes: u64,
        /// What is there.
        free_bytes: u64,
    },
    /// The disk filled up meanwhile.
    #[error("The robot's disk is full: delete recordings.")]
    DiskFilled,
    /// Its end did not come.
    #[error("Only {came} of {wanted} bytes came: send the file again.")]
    CutOff {
        /// What came.
        came: u64,
        /// What was announced.
        wanted: u64,
    },
    /// Our own folder.
    #[error("The file cannot be kept on the robot: {0}")]
    Disk(io::Error),
}

impl NotTaken {
    /// As a code.
    const fn reason(&self) -> &'static str {
        match self {
            Self::LengthRequired => "syntax",
            Self::TooLong(_) => "update-too-long",
            Self::Busy => "update-busy",
            Self::DiskFull { .. } | Self::DiskFilled => "update-disk-full",
            Self::CutOff { .. } => "update-cut-off",
            Self::Disk(_) => "update-file",
        }
    }

    const fn status(&self) -> StatusCode {
        match self {
            Self::LengthRequired => StatusCode::LENGTH_REQUIRED,
            Self::TooLong(_) => StatusCode::PAYLOAD_TOO_LARGE,
            Self::Busy => StatusCode::CONFLICT,
            Self::DiskFull { .. } | Self::DiskFilled => StatusCode::INSUFFICIENT_STORAGE,
            Self::CutOff { .. } => StatusCode::BAD_REQUEST,
            Self::Disk(_) => StatusCode::INTERNAL_SERVER_ERROR,
        }
    }

    fn of_disk(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::StorageFull => Self::DiskFilled,
            _ => Self::Disk(error),
        }
    }

    /// What the sender hears.
    pub(crate) fn answer(&self) -> Response<Body> {
        json(self.status(), &refused_as(self.reason(), &self.to_string()))
    }
}

/// Where the files are, and what is known of them.
#[derive(Debug)]
pub(crate) struct SoftwareDesk {
    /// Our own folder.
    folder: PathBuf,
    /// Where `rvac update` keeps its own files.
    updates: PathBuf,
    free_bytes: fn(&Path) -> io::Result<u64>,
    /// The file that comes now.
    receipt: Mutex<Option<SoftwareUpdate>>,
    told: watch::Sender<Option<SoftwareUpdate>>,
}

/// A receipt, as long as this lives: however it ends, the desk is free then.
struct Receiving {
    desk: Arc<SoftwareDesk>,
    total: u64,
}

impl Drop for Receiving {
    fn drop(&mut self) {
        *self.desk.receipt.lock().unwrap_or_else(PoisonError::into_inner) = None;
        self.desk.look();
    }
}

impl SoftwareDesk {
    /// The desk of a server whose folder this is.
    pub(crate) fn new(
        state: &Path,
        updates: PathBuf,
        free_bytes: fn(&Path) -> io::Result<u64>,
    ) -> io::Result<Self> {
        let folder = state.join("update");
        std::fs::create_dir_all(&folder)?;
        let desk = Self {
            folder,
            updates,
            free_bytes,
            receipt: Mutex::new(None),
            told: watch::Sender::new(None),
        };
        // What came halfway before this server started comes no further.
        std::fs::remove_file(desk.incoming()).ok();
        desk.look();
        Ok(desk)
    }

    fn incoming(&self) -> PathBuf {
        self.folder.join(INCOMING)
    }

    fn offer(&self) -> PathBuf {
        self.folder.join(OFFER)
    }

    /// The last update or the one that goes on, now and whenever that changes.
    pub(crate) fn watch(&self) -> watch::Receiver<Option<SoftwareUpdate>> {
        self.told.subscribe()
    }

    /// Looks at the files for ever.
    pub(crate) async fn keep_looking(&self) {
        loop {
            self.look();
            let goes_on = self.told.borrow().as_ref().is_some_and(|told| told.end.is_none());
            tokio::time::sleep(if goes_on { LOOK_EVERY } else { GLANCE_EVERY }).await;
        }
    }

    fn look(&self) {
        let seen = self.seen();
        self.told.send_if_modified(|told| {
            let is_news = *told != seen;
            *told = seen;
            is_news
        });
    }

    fn seen(&self) -> Option<SoftwareUpdate> {
        let receipt = self.receipt.lock().unwrap_or_else(PoisonError::into_inner);
        if receipt.is_some() {
            return receipt.clone();
        }
        if let Ok(about) = std::fs::symlink_metadata(self.offer()) {
            let waits = SoftwareUpdate::at(UpdateStage::HandOver);
            let age = about.modified().ok().and_then(|since| since.elapsed().ok());
            return Some(match age {
                Some(age) if age > TAKEN_WITHIN => waits.ended(
                    UpdateEnd::Refused,
                    "update-not-taken",
                    "Nothing on the robot takes updates: rvac-update.path is not active.",
                ),
                _ => waits,
            });
        }
        let told = self.progress()?;
        if told.end.is_none() && !self.is_being_installed() {
            let text = "The program that installed it has ended in the midst.";
            return Some(told.ended(UpdateEnd::CutOff, "update-interrupted", text));
        }
        Some(told)
    }

    fn progress(&self) -> Option<SoftwareUpdate> {
        use std::io::Read as _;
        let file = File::open(self.updates.join(PROGRESS)).ok()?;
        let mut bytes = Vec::new();
        file.take(PROGRESS_BYTES_MAX).read_to_end(&mut bytes).ok()?;
        serde_json::from_slice(&bytes).ok()
    }

    /// Whoever installs an update holds this lock.
    fn is_being_installed(&self) -> bool {
        let Ok(file) = File::open(self.updates.join(LOCK)) else {
            return false;
        };
        matches!(file.try_lock_shared(), Err(std::fs::TryLockError::WouldBlock))
    }

    /// Takes a file that an administrator sends, piece by piece to the disk.
    pub(crate) async fn take(
        desk: &Arc<Self>,
        headers: &HeaderMap,
        body: Body,
    ) -> Result<Response<Body>, NotTaken> {
        let receiving = desk.begin(length_of(headers)?)?;
        let outcome = receiving.fill(body).await;
        if let Err(error) = &outcome {
            warn!(%error, "an update did not come");
            std::fs::remove_file(desk.incoming()).ok();
        }
        outcome?;
        info!(bytes = receiving.total, "an update came");
        Ok(StatusCode::ACCEPTED.into_response())
    }

    /// One at a time, and only if it fits.
    fn begin(self: &Arc<Self>, total: u64) -> Result<Receiving, NotTaken> {
        if total == 0 || total > UPDATE_BYTES_MAX {
            return Err(NotTaken::TooLong(total));
        }
        // What nobody took may be replaced.
        if self.seen().is_some_and(|seen| seen.end.is_none()) {
            return Err(NotTaken::Busy);
        }
        std::fs::remove_file(self.offer()).ok();
        let free_bytes = (self.free_bytes)(&self.folder).map_err(NotTaken::Disk)?;
        let needed_bytes = 2 * total + SPARE_BYTES;
        if free_bytes < needed_bytes {
            return Err(NotTaken::DiskFull {
                needed_bytes,
                free_bytes,
            });
        }
        let mut receipt = self.receipt.lock().unwrap_or_else(PoisonError::into_inner);
        if receipt.is_some() {
            return Err(NotTaken::Busy);
        }
        *receipt = Some(received(0, total));
        Ok(Receiving {
            desk: Arc::clone(self),
            total,
        })
    }
}

fn received(bytes: u64, total: u64) -> SoftwareUpdate {
    SoftwareUpdate {
        bytes: Some(bytes),
        total: Some(total),
        ..SoftwareUpdate::at(UpdateStage::Receive)
    }
}

fn length_of(headers: &HeaderMap) -> Result<u64, NotTaken> {
    let length = headers.get(header::CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse().ok());
    length.ok_or(NotTaken::LengthRequired)
}

impl Receiving {
    async fn fill(&self, body: Body) -> Result<(), NotTaken> {
        let path = self.desk.incoming();
        // Others on this board need not read it, and what lies there is none of ours.
        std::fs::remove_file(&path).ok();
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .mode(0o600)
            .open(&path)
            .map_err(NotTaken::Disk)?;
        let (file, came) = self.copy(body, file).await?;
        if came != self.total {
            return Err(NotTaken::CutOff {
                came,
                wanted: self.total,
            });
        }
        let offer = self.desk.offer();
        beside(move || {
            file.sync_all()?;
            std::fs::rename(path, offer)
        })
        .await
    }

    /// Each part is on the disk before the next is asked for, so that no more than one is in memory.
    async fn copy<W: io::Write + Send + 'static>(
        &self,
        body: Body,
        mut file: W,
    ) -> Result<(W, u64), NotTaken> {
        let mut pieces = body.into_data_stream();
        let (mut came, mut part) = (0, Vec::with_capacity(CHUNK_BYTES));
        loop {
            let piece = match timeout(CHUNK_TIME_MAX, pieces.next()).await {
                Ok(None) => None,
                Ok(Some(Ok(piece))) => Some(piece),
                Ok(Some(Err(_))) | Err(_) => {
                    return Err(NotTaken::CutOff {
                        came,
                        wanted: self.total,
                    });
                }
            };
            let is_last = piece.is_none();
            if let Some(piece) = piece {
                came += piece.len() as u64;
                part.extend_from_slice(&piece);
            }
            if is_last || part.len() >= CHUNK_BYTES {
                (file, part) = beside(move || {
                    file.write_all(&part)?;
                    part.clear();
                    Ok((file, part))
                })
                .await?;
                self.tell(came);
            }
            if is_last {
                return Ok((file, came));
            }
        }
    }

    fn tell(&self, came: u64) {
        *self.desk.receipt.lock().unwrap_or_else(PoisonError::into_inner) = Some(received(came, self.total));
    }
}

/// Does what may take a slow card seconds, while the server goes on to pass Stop.
async fn beside<T: Send + 'static>(
    job: impl FnOnce() -> io::Result<T> + Send + 'static,
) -> Result<T, NotTaken> {
    match tokio::task::spawn_blocking(job).await {
        Ok(outcome) => outcome.map_err(NotTaken::of_disk),
        Err(ended) => Err(NotTaken::Disk(io::Error::other(ended))),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use axum::body::Body;
    use rvac_api::{SoftwareUpdate, UpdateEnd, UpdateStage};

    use super::{NotTaken, SoftwareDesk};
    use crate::folder::Folder;

    fn desk(folder: &Path) -> Arc<SoftwareDesk> {
        let updates = folder.join("updates");
        std::fs::create_dir_all(&updates).unwrap();
        Arc::new(SoftwareDesk::new(folder, updates, |_| Ok(1 << 30)).unwrap())
    }

    #[tokio::test]
    async fn a_disk_that_fills_up_on_the_way_is_named_so() {
        let folder = Folder::new();
        let desk = desk(&folder);
        let receiving = desk.begin(5).unwrap();
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let refused = receiving.copy(Body::from("bytes"), full).await;
        assert!(matches!(refused, Err(NotTaken::DiskFilled)), "{refused:?}");
        let another = desk.begin(5);
        assert!(matches!(another, Err(NotTaken::Busy)));
        drop(receiving);
        assert!(desk.begin(5).is_ok(), "the desk is free again");
    }

    #[test]
    fn progress_without_anybody_who_installs_was_cut_off() {
        let folder = Folder::new();
        let desk = desk(&folder);
        assert_eq!(desk.seen(), None);
        let told = SoftwareUpdate::at(UpdateStage::Unpack);
        let text = serde_json::to_vec(&told).unwrap();
        std::fs::write(folder.join("updates/progress.json"), text).unwrap();
        let lock = std::fs::File::create(folder.join("updates/lock")).unwrap();
        lock.lock().unwrap();
        assert_eq!(desk.seen(), Some(told));
        drop(lock);
        let seen = desk.seen().unwrap();
        assert_eq!(seen.end, Some(UpdateEnd::CutOff));
        assert_eq!(seen.failed, Some(UpdateStage::Unpack));
    }
}
