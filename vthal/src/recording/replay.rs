//! Runs a recording through the brain again and compares every answer; also one that was made of several.

use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use brain::{Brain, Command};
use mcap::records::Record;
use vthal_core::RunCause;

use super::false_refusals::{ReplayedStep, written};
use super::format::{FORMAT, FORMAT_WITH_FALSE_REFUSALS, Given, RunHeader, Seen};
use super::records::{AfterDamage, Records};
use super::{COMMANDS, DECISIONS, OBSERVATIONS, RUN};

/// Why a recording cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The file cannot be read.
    #[error("cannot read the recording {}: {error}; check the path", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// It is no recording of vthal.
    #[error("{} is not a recording of a run: {what}", .path.display())]
    NotARun {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
}

/// What a replay found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replay {
    /// Observations that the brain was shown.
    pub steps: u64,
    /// The file ends in the middle, as after a kill, or is damaged there; all records before that were used.
    pub truncated: bool,
    /// The first answer that was another one than in the recording.
    pub difference: Option<Difference>,
}

/// An answer that was another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Host time of the observation in microseconds.
    pub time_us: u64,
    /// Number of the observation, from 1.
    pub step: u64,
    /// What the recording has.
    pub recorded: String,
    /// What the brain says now.
    pub replayed: String,
}

/// Replays the recording at `path`.
///
/// # Errors
/// See [`ReplayError`].
pub fn replay(path: &Path) -> Result<Replay, ReplayError> {
    let unreadable = |error| ReplayError::Unreadable {
        path: path.to_owned(),
        error,
    };
    let not_a_run = |what: String| ReplayError::NotARun {
        path: path.to_owned(),
        what,
    };
    // What follows damage follows from observations that are not there.
    let file = File::open(path).map_err(unreadable)?;
    let mut records = Records::new(file, AfterDamage::End);
    let mut topics = BTreeMap::new();
    let mut player: Option<Player> = None;
    while let Some(shown) = records
        .next(|record| show(record, &mut topics, &mut player))
        .map_err(unreadable)?
    {
        shown.map_err(not_a_run)?;
        if player.as_ref().is_some_and(|player| player.difference.is_some()) {
            break;
        }
    }
    let truncated = !records.is_whole();
    let mut player = player.ok_or_else(|| not_a_run("it has no run in it".to_owned()))?;
    // The answer to the last observation may be what a kill cut off.
    if !truncated {
        player.settle();
    }
    Ok(Replay {
        steps: player.steps,
        truncated,
        difference: player.difference,
    })
}

/// Shows a record to the player; the first message of a run makes it.
fn show(
    record: &Record<'_>,
    topics: &mut BTreeMap<u16, String>,
    player: &mut Option<Player>,
) -> Result<(), String> {
    match record {
        Record::Channel(channel) => {
            topics.insert(channel.id, channel.topic.clone());
        }
        Record::Message { header, data } => {
            let topic = topics.get(&header.channel_id).map(String::as_str);
            match (player.as_mut(), topic.unwrap_or_default()) {
                (None, RUN) => *player = Some(Player::new(data)?),
                (None, _) => {}
                (Some(player), RUN) => player.begin_anew(data)?,
                (Some(player), topic) => player.take(topic, data)?,
            }
        }
        _ => {}
    }
    Ok(())
}

/// Cause of a run that continues the run of a killed daemon.
const AFTER_A_KILL: &str = RunCause::ResumedAfterRestart.name();

/// A step whose answer is not compared yet.
struct Open {
    time_us: u64,
    step: ReplayedStep,
    /// Its answer as recordings have it.
    answer: Vec<u8>,
}

struct Player {
    brain: Brain,
    commands: Vec<Command>,
    /// The recorded answer that is valid now.
    standing: Vec<u8>,
    /// The last step, not compared yet: a recorded answer may follow.
    open: Option<Open>,
    /// [`RunHeader::format`]
    format: u32,
    steps: u64,
    difference: Option<Difference>,
}

impl Player {
    fn new(data: &[u8]) -> Result<Self, String> {
        Self::of(&read(data)?)
    }

    /// The file is one of several recordings, and the next one begins, with a brain of its own.
    fn begin_anew(&mut self, data: &[u8]) -> Result<(), String> {
        let header: RunHeader = read(data)?;
        // The answer to the last observation may be what the kill cut off.
        if header.cause != AFTER_A_KILL {
            self.settle();
        }
        *self = Self {
            steps: self.steps,
            difference: self.difference.take(),
            ..Self::of(&header)?
        };
        Ok(())
    }

    fn of(header: &RunHeader) -> Result<Self, String> {
        if !(FORMAT_WITH_FALSE_REFUSALS..=FORMAT).contains(&header.format) {
            return Err(format!(
                "it has format {} and this vthal replays formats {FORMAT_WITH_FALSE_REFUSALS} to {FORMAT}: use vthal {}",
                header.format, header.vthal
            ));
        }
        let checkpoint = header
            .state
            .to_brain()
            .ok_or("it names a strategy that this vthal does not have".to_owned())?;
        let mut brain = Brain::new(header.config.to_brain(), header.seed);
        brain.restore(&checkpoint);
        Ok(Self {
            brain,
            commands: Vec::new(),
            standing: Vec::new(),
            open: None,
            format: header.format,
            steps: 0,
            difference: None,
        })
    }

    fn take(&mut self, topic: &str, data: &[u8]) -> Result<(), String> {
        match topic {
            COMMANDS => {
                self.settle();
                let given: Given = read(data)?;
                let command = given.command.to_brain();
                self.commands
                    .push(command.ok_or("it names a strategy that this vthal does not have".to_owned())?);
            }
            OBSERVATIONS => {
                self.settle();
                let seen: Seen = read(data)?;
                let observation = seen.to_brain();
                let actions = self.brain.step(&observation, &self.commands);
                let is_edit = |command: &&Command| matches!(command, Command::Edit(_));
                let edits = self.commands.iter().filter(is_edit).count();
                self.commands.clear();
                self.steps += 1;
                let answer = written(&actions).map_err(|error| error.to_string())?;
                self.open = Some(Open {
                    time_us: observation.time_us,
                    step: ReplayedStep { actions, edits },
                    answer,
                });
            }
            DECISIONS => {
                self.standing = data.to_vec();
                self.settle();
            }
            _ => {}
        }
        Ok(())
    }

    /// Compares the last answer with the recorded one that is valid now.
    fn settle(&mut self) {
        let Some(Open {
            time_us,
            step,
            answer,
        }) = self.open.take()
        else {
            return;
        };
        let has_false_refusals = self.format == FORMAT_WITH_FALSE_REFUSALS;
        if answer != self.standing
            && !(has_false_refusals && step.is_without_false_refusals(&self.standing))
            && self.difference.is_none()
        {
            self.difference = Some(Difference {
                time_us,
                step: self.steps,
                recorded: String::from_utf8_lossy(&self.standing).into_owned(),
                replayed: String::from_utf8_lossy(&answer).into_owned(),
            });
        }
    }
}

fn read<'a, T: serde::Deserialize<'a>>(data: &'a [u8]) -> Result<T, String> {
    serde_json::from_slice(data).map_err(|error| format!("a record cannot be read: {error}"))
}
