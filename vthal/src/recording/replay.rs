//! Runs a recording through the brain again and compares every answer; also one that was made of several.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use brain::{Brain, Command};
use mcap::MessageStream;
use mcap::read::Options;
use vthal_core::RunCause;

use super::false_refusals::{ReplayedStep, written};
use super::format::{FORMAT, FORMAT_WITH_FALSE_REFUSALS, Given, RunHeader, Seen};
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
    /// The file ends in the middle, as after a kill; all whole records were used.
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
    let bytes = fs::read(path).map_err(|error| ReplayError::Unreadable {
        path: path.to_owned(),
        error,
    })?;
    let not_a_run = |what: String| ReplayError::NotARun {
        path: path.to_owned(),
        what,
    };
    let stream = MessageStream::new_with_options(&bytes, Options::IgnoreEndMagic.into())
        .map_err(|error| not_a_run(error.to_string()))?;
    let mut player: Option<Player> = None;
    let truncated = !bytes.ends_with(mcap::MAGIC);
    for message in stream {
        let message = match message {
            Ok(message) => message,
            Err(_) if truncated => break,
            Err(error) => return Err(not_a_run(error.to_string())),
        };
        let topic = message.channel.topic.as_str();
        match (&mut player, topic) {
            (None, RUN) => player = Some(Player::new(&message.data).map_err(not_a_run)?),
            (None, _) => {}
            (Some(player), RUN) => player.begin_anew(&message.data).map_err(not_a_run)?,
            (Some(player), _) => player.take(topic, &message.data).map_err(not_a_run)?,
        }
        if player.as_ref().is_some_and(|player| player.difference.is_some()) {
            break;
        }
    }
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
