//! A card on which nothing can be written any more, under the daemon's state folder: a file system in memory, in a namespace of its own,
//! so that no rights are needed beside those that `unshare` of util-linux gives everybody.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use rvac_api::{LogLevel, Update};
use vthal_bench::Client;

/// An answer that does not come by then is none.
const PATIENCE: Duration = Duration::from_secs(10);
/// Puts the card under the state folder ($1), spoils it as the second word says, and becomes the daemon.
const SCRIPT: &str = r#"
state=$1; spoil=$2; shift 2
mount -t tmpfs -o size=4m,nr_inodes=200 card /mnt && cp -r "$state/." /mnt || exit 1
case $spoil in
full) dd if=/dev/zero of=/mnt/ballast bs=4k 2>/dev/null ;;
no-inodes) n=0; while touch "/mnt/ballast-$n" 2>/dev/null; do n=$((n + 1)); done ;;
esac
mount --bind /mnt "$state" || exit 1
case $spoil in read-only) mount -o remount,ro,bind "$state" || exit 1 ;; esac
exec "$@"
"#;
/// A change of each kind of kept thing, and a job, whose recording and checkpoint are written beside it.
const CHANGES: [(&str, &str); 8] = [
    (
        "add-schedule",
        r#"{"c":"add-schedule","name":"x","enabled":false,"job":{"start":{}},"when":{"weekly":{"days":["mo"],"at":"07:30"}},"id":1}"#,
    ),
    ("set-zone", r#"{"c":"set-zone","zone":"Europe/Tallinn","id":1}"#),
    ("renew-part", r#"{"c":"renew-part","component":"filter","id":1}"#),
    (
        "add-no-go",
        r#"{"c":"add-no-go","shape":{"wall":[[1.0,0.5],[1.0,1.5]]},"id":1}"#,
    ),
    (
        "name-floor",
        r#"{"c":"name-floor","floor":1,"name":"Ground floor","id":1}"#,
    ),
    ("new-floor", r#"{"c":"new-floor","id":1}"#),
    ("save-mix", ""),
    ("start", r#"{"c":"start","id":1}"#),
];

/// A state of the card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CardState {
    /// No block is free.
    Full,
    /// No file can be made.
    NoInodes,
    /// As a worn card becomes.
    ReadOnly,
}

impl CardState {
    /// All of them.
    pub(crate) const ALL: [Self; 3] = [Self::Full, Self::NoInodes, Self::ReadOnly];

    /// For tables.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Full => "card-full",
            Self::NoInodes => "card-no-inodes",
            Self::ReadOnly => "card-read-only",
        }
    }

    const fn spoil(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::NoInodes => "no-inodes",
            Self::ReadOnly => "read-only",
        }
    }

    /// What becomes the daemon on such a card, with its arguments to come.
    pub(crate) fn command(self, state: &Path) -> Command {
        let mut command = Command::new("unshare");
        command.args(["--user", "--map-root-user", "--mount", "sh", "-c", SCRIPT, "sh"]);
        command.arg(state).arg(self.spoil());
        command
    }
}

/// What became of a change, and what people read of the card.
#[derive(Clone, Debug, Default)]
pub(crate) struct Passage {
    /// By change: `done`, the reason of the refusal, or `no-answer`.
    pub(crate) answers: Vec<(&'static str, String)>,
    /// Warnings and errors of the log.
    pub(crate) told: Vec<String>,
}

/// Asks for a change of each kind.
pub(crate) fn try_changes(socket: &Path) -> anyhow::Result<Passage> {
    let mut client = Client::watching(socket, r#"["log"]"#)?;
    let mut passage = Passage::default();
    for (name, request) in CHANGES {
        let request = match name {
            "save-mix" => serde_json::to_string(&rvac_api::Request {
                id: Some(1),
                body: rvac_api::RequestBody::SaveMix {
                    profile: mixer::standard_profile().to_json(),
                    was: None,
                },
            })?,
            _ => request.to_owned(),
        };
        client.send(&request)?;
        let mut answer = "no-answer".to_owned();
        client.wait_for(Instant::now() + PATIENCE, |update| {
            match update {
                Update::Done { id: 1 } => answer = "done".to_owned(),
                Update::Failed(failure) if failure.id == Some(1) => answer.clone_from(&failure.reason),
                Update::Log(entry) if matches!(entry.level, LogLevel::Warn | LogLevel::Error) => {
                    passage.told.push(entry.text.clone());
                }
                _ => {}
            }
            answer != "no-answer"
        })?;
        passage.answers.push((name, answer));
    }
    Ok(passage)
}
