//! Recordings and files that an earlier version of the daemon has written (`tests/kept/`): they are read, mean what they meant, and
//! the same observations lead to the same decisions.
//!
//! A recording is kept as its messages, one a line: its topic and what it says, compressed. One is kept as the file that it was.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use brain::{Brain, Command, StoredMap};
use content_hash::ContentHash;
use flate2::read::GzDecoder;
use mcap::records::MessageHeader;
use mcap::{MessageStream, WriteOptions};
use vthal::checkpoint_file::{self, BootTime};
use vthal::recording::format::{Given, RunHeader, Seen};
use vthal::recording::replay::{Replay, replay};
use vthal_bench::Scratch;

/// Recordings that are kept as lines.
const LINES: [&str; 2] = ["first-run", "restart"];
/// The one of them whose job is one of rooms, recorded when brushes still turned on the way to them. It also drew into the kept map, so
/// that the plan differs a little later on.
const BRUSHED_ON_THE_WAY: &str = "restart";
/// The one whose robot was lifted half a minute after it had left its dock. It searched for its place in the square metre that it had seen,
/// recorded before such a map was begun anew.
const CARRIED_EARLY: &str = "first-run";
/// The one that is kept as a file.
const FILE: &str = "relax";

fn unpacked(name: &str) -> Vec<u8> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/kept/{name}"));
    let packed = fs::File::open(path).expect("the file is there");
    let mut bytes = Vec::new();
    GzDecoder::new(packed)
        .read_to_end(&mut bytes)
        .expect("it can be unpacked");
    bytes
}

/// The messages of a recording in their order: topic and what it says.
fn messages(name: &str) -> Vec<(String, Vec<u8>)> {
    if name == FILE {
        let bytes = unpacked(&format!("{name}.mcap.gz"));
        let stream = MessageStream::new(&bytes).expect("is MCAP");
        let messages = stream.map(|message| {
            let message = message.expect("is whole");
            (message.channel.topic.clone(), message.data.to_vec())
        });
        return messages.collect();
    }
    let text = String::from_utf8(unpacked(&format!("{name}.lines.gz"))).expect("is text");
    let line = |line: &str| {
        let (topic, said) = line.split_once(' ').expect("a topic");
        (topic.to_owned(), said.as_bytes().to_vec())
    };
    text.lines().map(line).collect()
}

/// Writes the messages of a recording as a file that can be replayed.
fn write(messages: &[(String, Vec<u8>)], path: &Path) {
    let file = fs::File::create(path).expect("the file can be made");
    let mut writer = WriteOptions::new()
        .compression(None)
        .create(file)
        .expect("begins");
    let none = BTreeMap::new();
    for (number, (topic, said)) in (0..).zip(messages) {
        let channel_id = writer.add_channel(0, topic, "json", &none).expect("a channel");
        let header = MessageHeader {
            channel_id,
            sequence: number,
            log_time: number.into(),
            publish_time: number.into(),
        };
        writer.write_to_known_channel(&header, said).expect("a message");
    }
    writer.finish().expect("ends");
}

fn replayed(name: &str) -> Replay {
    let folder = Scratch::new().expect("creates");
    let path = folder.join("kept.mcap");
    if name == FILE {
        fs::write(&path, unpacked(&format!("{name}.mcap.gz"))).expect("the file can be written");
    } else {
        write(&messages(name), &path);
    }
    replay(&path).expect("it can be replayed")
}

#[test]
fn recordings_of_earlier_versions_give_the_decisions_that_were_recorded() {
    for name in LINES.into_iter().chain([FILE]) {
        let found = replayed(name);
        match found.difference {
            Some(ref first) if name == BRUSHED_ON_THE_WAY => {
                let resting = first
                    .recorded
                    .replace(r#""cleaners":true"#, r#""cleaners":false"#);
                assert_eq!(first.replayed, resting, "nothing but the brushes differs first");
            }
            Some(ref first) if name == CARRIED_EARLY => {
                assert!(first.recorded.contains("follow-wall"), "{first:?}");
                assert!(first.replayed.contains("begin-map-anew"), "{first:?}");
            }
            ref difference => assert_eq!(*difference, None, "{name}"),
        }
        assert!(found.steps > 300 && !found.truncated, "{name}: {found:?}");
    }
}

/// What a brain answers that is shown a recording, as numbers.
#[derive(Default)]
struct Answers {
    runs: u32,
    commands: u32,
    steps: u64,
    decisions: u64,
    answers: ContentHash,
    brain: Option<Brain>,
    given: Vec<Command>,
}

impl Answers {
    fn of(name: &str) -> Self {
        let mut all = Self::default();
        for (topic, said) in messages(name) {
            all.take(&topic, &said);
        }
        all
    }

    fn take(&mut self, topic: &str, said: &[u8]) {
        match topic {
            "/run" => {
                let header: RunHeader = serde_json::from_slice(said).expect("a run");
                let state = header.state.to_brain().expect("a state");
                let mut brain = Brain::new(header.config.to_brain(), header.seed);
                brain.restore(&state);
                self.brain = Some(brain);
                self.runs += 1;
            }
            "/commands" => {
                let given: Given = serde_json::from_slice(said).expect("a command");
                self.given.push(given.command.to_brain().expect("a command"));
                self.commands += 1;
            }
            "/observations" => {
                let seen: Seen = serde_json::from_slice(said).expect("an observation");
                let seen = seen.to_brain();
                let brain = self.brain.as_mut().expect("a run began");
                let actions = brain.step(&seen, &self.given);
                self.given.clear();
                self.steps += 1;
                self.decisions += actions.decisions.len() as u64;
                self.answers.add_actions(seen.time_us, &actions);
            }
            _ => {}
        }
    }

    fn row(&self) -> String {
        let brain = self.brain.as_ref().expect("a run began");
        let mut pose = ContentHash::default();
        pose.add_pose(brain.pose());
        format!(
            "{:>4} {:>8} {:>7} {:>9}  {:016x} {:016x} {:016x}",
            self.runs,
            self.commands,
            self.steps,
            self.decisions,
            self.answers.value(),
            pose.value(),
            ContentHash::of_map(brain.map()).value()
        )
    }
}

/// Compares a table with the one in `tests/expected/`; `UPDATE_EXPECTED=1` writes the new one.
fn compare(name: &str, table: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/expected/{name}.txt"));
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        fs::write(&path, table).expect("the table can be written");
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(table, expected, "\nthe table differs; it is now:\n{table}");
}

#[test]
fn what_a_brain_answers_to_kept_recordings() {
    let mut table = "recording  runs commands   steps decisions: answers, last pose, map\n\n".to_owned();
    for name in LINES.into_iter().chain([FILE]) {
        table += &format!("{name:<10} {}\n", Answers::of(name).row());
    }
    compare("replays", &table);
}

#[test]
fn a_kept_checkpoint_says_what_it_said() {
    let boot = BootTime {
        boot: "boot".to_owned(),
        uptime_s: 101.0,
    };
    let folder = Scratch::new().expect("creates");
    let path = folder.join("checkpoint");
    fs::write(&path, unpacked("checkpoint.gz")).expect("the file can be written");
    let found = checkpoint_file::load(&path, &boot).expect("it can be read");
    fs::remove_file(&path).expect("cleans up");
    checkpoint_file::save(&path, &found, boot.clone()).expect("it can be written");
    assert_eq!(checkpoint_file::load(&path, &boot).as_ref(), Some(&found));

    let brain = &found.brain;
    let home = brain.home.as_ref().map(ContentHash::of_stored_map);
    let job = brain.job.as_ref().expect("it had a job");
    let run = found.run.as_ref().expect("it had a run");
    let table = format!(
        "device {}, floor {:?}, run {}, {:.1} s, {:.2} m2, {} bumps, {} parts\nbrain {:016x}, home {:016x}\n",
        found.device,
        found.floor,
        run.run.number,
        job.figures.time_s,
        job.figures.swept_m2,
        job.figures.bumps,
        job.order.parts().len(),
        ContentHash::of_checkpoint(brain).value(),
        home.unwrap_or_default().value()
    );
    compare("checkpoint", &table);
}

#[test]
fn the_map_in_a_kept_recording_says_what_it_said() {
    let (_, said) = &messages("restart")[0];
    let header: RunHeader = serde_json::from_slice(said).expect("a run");
    let home: StoredMap = header
        .state
        .to_brain()
        .and_then(|state| state.home)
        .expect("it began with a map");
    let hash = ContentHash::of_stored_map(&home);
    compare(
        "map-in-recording",
        &format!("{} rooms {:016x}\n", home.room_count(), hash.value()),
    );
}
