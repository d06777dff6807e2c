//! The controller of a home: matter.js as a process that takes orders.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

use anyhow::{Context as _, bail, ensure};
use serde_json::{Value, json};

use super::link::Link;

const SCRIPT: &str = "peers/matter/controller.mjs";

#[derive(Debug)]
pub(crate) struct Controller {
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Controller {
    /// `packages` is the folder in which npm has put matter.js; `keys` keeps what the home knows.
    pub(crate) fn start(link: &Link, packages: &Path, keys: &Path) -> anyhow::Result<Self> {
        // A module looks for others beside itself.
        let script: PathBuf = packages.join("controller.mjs");
        std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join(SCRIPT), &script)?;
        let mut command = link.at_home(Path::new("node"));
        let mut child = command
            .arg(script)
            .arg(keys)
            .env("MATTER_MDNS_NETWORKINTERFACE", "wlan0")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("cannot start node")?;
        let orders = child.stdin.take().context("no input")?;
        let answers = BufReader::new(child.stdout.take().context("no output")?);
        Ok(Self {
            child,
            orders,
            answers,
        })
    }

    /// Lets the controller do something; what it cannot do is an error.
    pub(crate) fn order(&mut self, name: &str, more: &Value) -> anyhow::Result<Value> {
        let mut order = json!({"do": name});
        if let (Value::Object(order), Value::Object(more)) = (&mut order, more) {
            order.extend(more.clone());
        }
        writeln!(self.orders, "{order}")?;
        let mut answer = String::new();
        ensure!(
            self.answers.read_line(&mut answer)? > 0,
            "the controller has ended"
        );
        let answer: Value = serde_json::from_str(&answer).with_context(|| answer.clone())?;
        match answer.get("error") {
            Some(error) => bail!("{name}: {error}"),
            None => Ok(answer["ok"].clone()),
        }
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        // It may have ended already, which is what was wanted.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}
