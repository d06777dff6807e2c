//! One recording while it is written.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, WriteOptions, Writer};
use serde::Serialize;
use vthal_core::{Record, RunStart};

use super::format::{Answered, Given, GivenCommand, RunHeader, Seen, SentPacket};
use super::foxglove;
use super::{COMMANDS, DECISIONS, DEVICE, LOG, OBSERVATIONS, PACKETS, POSE, ROBOT, RUN, STATUS, TRANSFORM};

/// Why a record was not written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file system refuses.
    #[error("cannot write the recording {}: {}", .path.display(), why(.error))]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: mcap::McapError,
    },
    /// The file system refuses to create the file.
    #[error("cannot create the recording {}: {error}", .path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// The folder of recordings cannot be read, so that the next name is not known.
    #[error("cannot read the folder of recordings: {0}")]
    Folder(#[source] io::Error),
    /// The record cannot be spelled.
    #[error("a record cannot be spelled as JSON: {0}")]
    Spell(#[from] serde_json::Error),
}

/// Why the library of recordings failed: where the system refused a write, in the system's words. Its own would tell of compression, which
/// nobody asked for, when the disk is full.
fn why(error: &mcap::McapError) -> String {
    match error {
        mcap::McapError::Io(error) => error.to_string(),
        other => other.to_string(),
    }
}

/// A recording while it is written. What was flushed survives a kill at any later moment.
pub struct RunFile {
    path: PathBuf,
    writer: Writer<BufWriter<File>>,
    channels: BTreeMap<&'static str, u16>,
    sequence: u32,
    bytes: u64,
    last_answer: Vec<u8>,
}

impl fmt::Debug for RunFile {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("RunFile")
            .field("path", &self.path)
            .field("bytes", &self.bytes)
            .finish_non_exhaustive()
    }
}

impl RunFile {
    /// Creates the file of a run. `settings` goes into the metadata.
    ///
    /// # Errors
    /// See [`RecordError`].
    pub fn create(path: &Path, start: &RunStart, settings: &str) -> Result<Self, RecordError> {
        let file = File::create_new(path).map_err(|error| RecordError::Create {
            path: path.to_owned(),
            error,
        })?;
        let failed = |error| RecordError::Write {
            path: path.to_owned(),
            error,
        };
        // Without seeking a chunk stays in memory until it is whole, so that a kill never leaves half of one as the
        // newest.
        let library = concat!("vthal ", env!("CARGO_PKG_VERSION"));
        let options = WriteOptions::new()
            .compression(None)
            .disable_seeking(true)
            .library(library);
        let mut writer = options.create(BufWriter::new(file)).map_err(failed)?;
        let mut channels = BTreeMap::new();
        for channel in super::schemas::channels() {
            let schema = serde_json::to_vec(&channel.schema)?;
            let schema = writer
                .add_schema(channel.name, "jsonschema", &schema)
                .map_err(failed)?;
            let number = writer
                .add_channel(schema, channel.topic, "json", &BTreeMap::new())
                .map_err(failed)?;
            channels.insert(channel.topic, number);
        }
        writer
            .write_metadata(&metadata(start, settings))
            .map_err(failed)?;
        let mut run = Self {
            path: path.to_owned(),
            writer,
            channels,
            sequence: 0,
            bytes: 0,
            last_answer: Vec::new(),
        };
        run.write_json(RUN, start.time_us, &RunHeader::new(start))?;
        run.write_json(
            ROBOT,
            start.time_us,
            &foxglove::robot(start.time_us, start.brain.body.radius_m),
        )?;
        run.attach("robot.json", start.time_us, &start.robot)?;
        run.flush()?;
        Ok(run)
    }

    /// Bytes of messages written so far.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Adds a record. Borders of runs are not this file's business.
    ///
    /// # Errors
    /// See [`RecordError`].
    pub fn write(&mut self, record: &Record) -> Result<(), RecordError> {
        match record {
            Record::RunStarted(_) | Record::RunEnded { .. } => Ok(()),
            Record::Command { time_us, command } => {
                let given = Given {
                    time_us: *time_us,
                    command: GivenCommand::from(command),
                };
                self.write_json(COMMANDS, *time_us, &given)
            }
            Record::Observation(observation) => {
                self.write_json(OBSERVATIONS, observation.time_us, &Seen::from(observation))
            }
            Record::Actions { time_us, actions } => {
                let answer = serde_json::to_vec(&Answered::from(actions))?;
                if answer == self.last_answer {
                    return Ok(());
                }
                self.write_bytes(DECISIONS, *time_us, &answer)?;
                self.last_answer = answer;
                Ok(())
            }
            Record::Packet {
                time_us,
                direction,
                text,
            } => self.write_json(PACKETS, *time_us, &SentPacket::new(*direction, text)),
            Record::Status { time_us, status } => self.write_json(STATUS, *time_us, status),
            Record::Pose(pose) => {
                let time_us = foxglove::time_us(pose.t);
                self.write_json(POSE, time_us, &foxglove::pose_in_frame(*pose))?;
                self.write_json(TRANSFORM, time_us, &foxglove::frame_transform(*pose))
            }
            Record::Device { time_us, table } => self.write_json(DEVICE, *time_us, table),
            Record::RunSummary { time_us, run } => self.attach("run.json", *time_us, run),
            Record::Log(entry) => self.write_json(LOG, foxglove::time_us(entry.t), &foxglove::log(entry)),
        }
    }

    /// Puts what was written so far into the file, as a chunk of its own.
    ///
    /// # Errors
    /// See [`RecordError`].
    pub fn flush(&mut self) -> Result<(), RecordError> {
        self.writer.flush().map_err(|error| RecordError::Write {
            path: self.path.clone(),
            error,
        })
    }

    /// Ends the file with its index.
    ///
    /// # Errors
    /// See [`RecordError`].
    pub fn finish(mut self) -> Result<(), RecordError> {
        self.writer.finish().map_err(|error| RecordError::Write {
            path: self.path.clone(),
            error,
        })?;
        Ok(())
    }

    /// Adds what is no message: of the same name the last one counts.
    fn attach(&mut self, name: &str, time_us: u64, value: &impl Serialize) -> Result<(), RecordError> {
        let data = serde_json::to_vec(value)?;
        let time_ns = time_us.saturating_mul(1000);
        let attachment = Attachment {
            log_time: time_ns,
            create_time: 0,
            name: name.to_owned(),
            media_type: "application/json".to_owned(),
            data: data.into(),
        };
        self.writer
            .attach(&attachment)
            .map_err(|error| RecordError::Write {
                path: self.path.clone(),
                error,
            })
    }

    fn write_json(
        &mut self,
        topic: &'static str,
        time_us: u64,
        value: &impl Serialize,
    ) -> Result<(), RecordError> {
        self.write_bytes(topic, time_us, &serde_json::to_vec(value)?)
    }

    fn write_bytes(&mut self, topic: &'static str, time_us: u64, data: &[u8]) -> Result<(), RecordError> {
        let time_ns = time_us.saturating_mul(1000);
        let header = MessageHeader {
            channel_id: self.channels.get(topic).copied().unwrap_or_default(),
            sequence: self.sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        self.sequence = self.sequence.wrapping_add(1);
        self.bytes += data.len() as u64;
        self.writer
            .write_to_known_channel(&header, data)
            .map_err(|error| RecordError::Write {
                path: self.path.clone(),
                error,
            })
    }
}

fn metadata(start: &RunStart, settings: &str) -> Metadata {
    let entries = [
        ("vthal", env!("CARGO_PKG_VERSION").to_owned()),
        ("device", start.device.clone()),
        ("firmware", start.firmware.clone()),
        ("seed", start.seed.to_string()),
        ("cause", start.cause.name().to_owned()),
        ("config", settings.to_owned()),
    ];
    Metadata {
        name: "vthal".to_owned(),
        metadata: entries
            .into_iter()
            .map(|(key, value)| (key.to_owned(), value))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::RecordError;

    #[test]
    fn a_full_disk_is_called_a_full_disk() {
        let full = io::Error::from_raw_os_error(rustix::io::Errno::NOSPC.raw_os_error());
        let error = RecordError::Write {
            path: "recordings/000001.mcap".into(),
            error: mcap::McapError::Io(full),
        };
        assert_eq!(
            error.to_string(),
            "cannot write the recording recordings/000001.mcap: No space left on device (os error 28)"
        );
    }
}
