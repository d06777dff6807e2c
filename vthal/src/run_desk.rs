//! What clients ask of runs that are over: lists, records, tracks, and pieces of recordings.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rvac_api::{RUN_PIECE_BYTES, RunTrack, Update};
use vthal_core::RunTask;

use crate::lifetime_file::LifetimeFile;
use crate::recording::{self, Whole};
use crate::run_folder::{RunError, RunFolder};

/// Files that are made of several recordings and read at the same time. Whoever comes back to one that is not among them waits until
/// it is built again up to there.
const READ_AT_ONCE: usize = 4;

/// Where questions are answered.
#[derive(Debug)]
pub(crate) struct RunDesk {
    folder: RunFolder,
    lifetime: LifetimeFile,
    /// The one that was read last comes first.
    open: VecDeque<OpenFile>,
}

/// Several recordings as one file, of which a client has read the beginning.
#[derive(Debug)]
struct OpenFile {
    number: u64,
    name: String,
    /// Bytes that were read.
    read: u64,
    whole: Whole<File>,
}

impl RunDesk {
    /// For the runs that these sums are of.
    pub(crate) fn new(lifetime: LifetimeFile) -> Self {
        Self {
            folder: lifetime.runs().clone(),
            lifetime,
            open: VecDeque::new(),
        }
    }

    /// What a client asked for.
    ///
    /// # Errors
    /// See [`RunError`].
    pub(crate) fn answer(&mut self, task: RunTask) -> Result<Update, RunError> {
        match task {
            RunTask::List { before, count } => Ok(self.folder.list(before, usize::from(count))),
            RunTask::Statistics => {
                let lifetime = self.lifetime.up_to_date();
                Ok(Update::Statistics(Box::new(lifetime.statistics().clone())))
            }
            RunTask::Show(number) => Ok(Update::Run(Box::new(self.folder.show(number)?))),
            RunTask::Track { number, recording } => self.track(number, recording),
            RunTask::File {
                number,
                recording: Some(index),
                from,
            } => self.folder.piece(number, index as usize, from),
            RunTask::File {
                number,
                recording: None,
                from,
            } => self.piece(number, from),
        }
    }

    fn track(&self, number: u64, index: Option<u32>) -> Result<Update, RunError> {
        let parts = match index {
            Some(index) => vec![self.folder.open(number, index as usize)?],
            None => self.folder.open_all(number)?,
        };
        Ok(Update::RunTrack(Box::new(RunTrack {
            number,
            recording: index,
            ..recording::track(parts)?
        })))
    }

    /// A piece of all recordings as one file. One that was cut short is read again for this, too: without the index at its end
    /// other programs refuse it.
    fn piece(&mut self, number: u64, from: u64) -> Result<Update, RunError> {
        let is_it = |file: &OpenFile| (file.number, file.read) == (number, from);
        let place = self.open.iter().position(is_it);
        if place.is_none() && self.folder.has_one_with_its_end(number)? {
            return self.folder.piece(number, 0, from);
        }
        let mut file = match place.and_then(|place| self.open.remove(place)) {
            Some(file) => file,
            None => self.open_at(number, from)?,
        };
        let mut bytes = Vec::new();
        (&mut file.whole).take(RUN_PIECE_BYTES).read_to_end(&mut bytes)?;
        let piece = Update::RunFile {
            number,
            name: file.name.clone(),
            from: file.read,
            size: None,
            data: STANDARD.encode(&bytes),
        };
        file.read += bytes.len() as u64;
        if !bytes.is_empty() {
            self.open.push_front(file);
            self.open.truncate(READ_AT_ONCE);
        }
        Ok(piece)
    }

    /// Makes the file up to a byte.
    fn open_at(&self, number: u64, from: u64) -> Result<OpenFile, RunError> {
        let parts = self.folder.open_all(number)?;
        let first = parts.first().map_or("", |part| part.name.as_str());
        let name = format!("{}-whole.mcap", first.trim_end_matches(".mcap"));
        let mut whole = Whole::new(parts)?;
        let read = io::copy(&mut (&mut whole).take(from), &mut io::sink())?;
        Ok(OpenFile {
            number,
            name,
            read,
            whole,
        })
    }
}
