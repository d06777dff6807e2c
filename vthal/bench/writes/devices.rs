//! Paired devices, which the panel's server keeps: let in, given another role, shut out.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, bail};
use pairing::console::{Order, Reply};
use pairing::wire::ClientRow;
use pairing::{DeviceName, Role};
use vthal_bench::{Daemon, Scratch};

use crate::life::{Keeper, Kept, Life, replaced};

/// Devices at a time.
const DEVICES_MAX: usize = 5;
/// Longest wait for an answer.
const ANSWERS_WITHIN: Duration = Duration::from_secs(20);

/// The server as their keeper.
pub(crate) struct AtServer {
    server: PathBuf,
    scratch: Scratch,
}

impl AtServer {
    /// On a folder of its own, with a page of its own.
    pub(crate) fn new(server: PathBuf) -> anyhow::Result<Self> {
        let scratch = Scratch::new()?;
        let assets = scratch.join("assets");
        fs::create_dir(&assets)?;
        fs::write(assets.join("index.html"), "<!doctype html><title>none</title>")?;
        Ok(Self { server, scratch })
    }
}

impl Keeper for AtServer {
    fn name(&self) -> &'static str {
        "devices"
    }

    fn start(&self) -> anyhow::Result<Box<dyn Life + '_>> {
        let state = self.scratch.join("panel");
        let mut command = Command::new(&self.server);
        command
            .arg("--vthal")
            .arg(self.scratch.join("vthal.sock"))
            .arg("--assets")
            .arg(self.scratch.join("assets"))
            .arg("--state")
            .arg(&state)
            .args(["--port", "0"]);
        Ok(Box::new(OfServer {
            server: Daemon::start_command(command)?,
            console: state.join("console.sock"),
            rows: Vec::new(),
            asked: None,
        }))
    }
}

struct OfServer {
    server: Daemon,
    console: PathBuf,
    /// As it told them last, oldest first.
    rows: Vec<ClientRow>,
    /// Where the answer to a change comes.
    asked: Option<UnixStream>,
}

impl OfServer {
    fn ask(&self, order: &Order) -> anyhow::Result<UnixStream> {
        let mut stream = UnixStream::connect(&self.console)?;
        stream.set_read_timeout(Some(ANSWERS_WITHIN))?;
        let mut line = serde_json::to_vec(order)?;
        line.push(b'\n');
        stream.write_all(&line)?;
        Ok(stream)
    }

    /// An order, and the texts of what is kept when it is done.
    fn change(&self, kept: &Kept, number: u64) -> anyhow::Result<(Order, Vec<String>)> {
        let role = match number % 3 {
            0 => Role::View,
            1 => Role::Drive,
            _ => Role::Admin,
        };
        match self.rows.first() {
            Some(oldest) if self.rows.len() >= DEVICES_MAX || number.is_multiple_of(5) => {
                let after = replaced(kept, Some(&oldest.id.to_string()), None);
                Ok((Order::Revoke { id: oldest.id }, after))
            }
            Some(oldest) if number.is_multiple_of(2) => {
                let fresh = text(&oldest.name, role);
                let after = replaced(kept, Some(&oldest.id.to_string()), Some(fresh));
                Ok((Order::SetRole { id: oldest.id, role }, after))
            }
            _ => {
                let name = DeviceName::new(&format!("Device {number}"))?;
                let after = replaced(kept, None, Some(text(&name, role)));
                Ok((Order::Add { name, role }, after))
            }
        }
    }
}

fn text(name: &DeviceName, role: Role) -> String {
    format!("{name} may {role}")
}

/// The whole answer; none when the server ended before.
fn answer(stream: UnixStream) -> anyhow::Result<Option<Reply>> {
    let mut line = String::new();
    match BufReader::new(stream).read_line(&mut line) {
        Ok(_) if line.ends_with('\n') => Ok(Some(serde_json::from_str(&line)?)),
        Ok(_) => Ok(None),
        Err(error) if error.kind() == std::io::ErrorKind::ConnectionReset => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Whether a change is acknowledged by this answer.
fn is_done(answer: Option<Reply>) -> anyhow::Result<bool> {
    match answer {
        Some(Reply::Done | Reply::Added { .. }) => Ok(true),
        Some(Reply::Refused(refused)) => bail!("a change was refused: {}", refused.text),
        Some(other) => bail!("a change was answered by {other:?}"),
        None => Ok(false),
    }
}

impl Life for OfServer {
    fn read(&mut self) -> anyhow::Result<Kept> {
        let reply = answer(self.ask(&Order::Clients)?)?;
        let Some(Reply::Clients { clients }) = reply else {
            bail!("the server did not tell the devices but {reply:?}");
        };
        self.rows = clients;
        let keyed = |row: &ClientRow| (row.id.to_string(), text(&row.name, row.role));
        Ok(self.rows.iter().map(keyed).collect())
    }

    fn begin_change(&mut self, kept: &Kept, number: u64) -> anyhow::Result<Vec<String>> {
        let (order, after) = self.change(kept, number)?;
        self.asked = Some(self.ask(&order)?);
        Ok(after)
    }

    fn finish_change(&mut self) -> anyhow::Result<()> {
        let asked = self.asked.take().context("nothing was asked")?;
        if !is_done(answer(asked)?)? {
            bail!("the server ended");
        }
        Ok(())
    }

    fn kill(self: Box<Self>) -> anyhow::Result<bool> {
        self.server.kill()?;
        self.asked.map_or(Ok(false), |asked| is_done(answer(asked)?))
    }
}
