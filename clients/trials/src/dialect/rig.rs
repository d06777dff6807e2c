//! The server with a robot behind it, and the client before it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use serde_json::{Value, json};

use crate::Arguments;
use crate::home::Home;
use crate::process::{Server, beside};
use crate::program::{output, wait_for};

pub(super) const SOON: Duration = Duration::from_secs(20);
pub(super) const PASSWORD: &str = "long enough";
pub(super) const STATE: &str = "robot/state/attributes";

/// A robot at home, the server before it, and the client.
pub(super) struct DialectRig {
    pub(super) home: Home,
    pub(super) server: Server,
    pub(super) port: u16,
    pub(super) python: PathBuf,
}

impl DialectRig {
    pub(super) fn start(arguments: &Arguments) -> anyhow::Result<Self> {
        let home = Home::start()?;
        let file = home.scratch.join("rvac-dialect.toml");
        let socket = home.socket().display().to_string();
        let text = format!("vthal = {socket:?}\nport = 0\npassword = {PASSWORD:?}\n");
        std::fs::write(&file, text)?;
        let mut command = Command::new(beside("rvac-dialect")?);
        command.arg("--config").arg(&file);
        let server = Server::start(command)?;
        Ok(Self {
            home,
            port: server.port()?,
            server,
            python: arguments.python.clone().unwrap_or_else(|| "python3".into()),
        })
    }

    pub(super) fn client(&self, password: &str, words: &[&str]) -> Command {
        let mut command = Command::new(&self.python);
        command.arg(peer("dialect.py"));
        command.arg(format!("http://127.0.0.1:{}/api/v2", self.port));
        command.args(["robo", password]).args(words);
        command
    }

    pub(super) fn told(&self, words: &[&str]) -> anyhow::Result<Value> {
        Ok(serde_json::from_str(&output(&mut self.client(PASSWORD, words))?)?)
    }

    pub(super) fn read(&self, path: &str) -> anyhow::Result<Value> {
        Ok(self.told(&["read", path])?[path].take())
    }

    pub(super) fn put(&self, capability: &str, body: &Value) -> anyhow::Result<Value> {
        self.told(&["put", capability, &body.to_string()])
    }

    /// A command that is done.
    pub(super) fn order(&self, capability: &str, body: &Value) -> anyhow::Result<()> {
        let told = self.put(capability, body)?;
        ensure!(
            told == json!({"code": 200, "text": "OK"}),
            "{capability} {body}: {told}"
        );
        Ok(())
    }

    pub(super) fn action(&self, action: &str) -> anyhow::Result<()> {
        self.order("BasicControlCapability", &json!({"action": action}))
    }

    pub(super) fn wait_for_state(&self, values: &[&str]) -> anyhow::Result<()> {
        let mut last = Value::Null;
        let reached = wait_for(&format!("{values:?}"), SOON, || {
            last = self.read(STATE)?[0].take();
            Ok(values.iter().any(|value| last["value"] == *value).then_some(()))
        });
        reached.with_context(|| format!("it is {last}"))
    }

    /// What the daemon itself says of the home.
    pub(super) fn home_view(&self) -> anyhow::Result<Value> {
        Ok(serde_json::from_str(&self.home.told("home")?)?)
    }
}

pub(super) fn peer(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("peers").join(name)
}
