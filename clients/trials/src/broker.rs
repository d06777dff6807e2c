//! A real mosquitto, and a person at its command line.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};
use rcgen::{
    BasicConstraints, CertificateParams, CertifiedIssuer, DnType, ExtendedKeyUsagePurpose, IsCa, KeyPair,
};

use crate::program::{Program, free_port, output, server, wait_for};

/// How the bridge is let in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Door {
    /// Anybody, in the clear.
    Open,
    /// With user and password and a certificate of the broker's own authority, over TLS.
    Guarded,
}

/// The broker, which can be ended and started again at the same port.
#[derive(Debug)]
pub(crate) struct Broker {
    folder: PathBuf,
    door: Door,
    /// For everybody on this computer.
    pub(crate) port: u16,
    /// For the bridge.
    door_port: u16,
    program: Option<Program>,
}

impl Broker {
    pub(crate) fn start(folder: &Path, door: Door) -> anyhow::Result<Self> {
        let mut broker = Self {
            folder: folder.to_path_buf(),
            door,
            port: free_port()?,
            door_port: free_port()?,
            program: None,
        };
        let open = format!("listener {} 127.0.0.1\nallow_anonymous true\n", broker.port);
        let guarded = match door {
            Door::Open => String::new(),
            Door::Guarded => broker.guard()?,
        };
        let configuration =
            format!("per_listener_settings true\nuser root\npersistence false\n{open}{guarded}");
        std::fs::write(folder.join("mosquitto.conf"), configuration)?;
        broker.start_again()?;
        Ok(broker)
    }

    /// Certificates and a password; gives the part of the configuration.
    fn guard(&self) -> anyhow::Result<String> {
        let place = |name: &str| self.folder.join(name);
        write_certificates(&self.folder)?;
        let passwords = place("passwords");
        output(
            Command::new("mosquitto_passwd")
                .args(["-c", "-b"])
                .arg(&passwords)
                .args(["robo", "secret"]),
        )?;
        Ok(format!(
            "listener {} 127.0.0.1\nallow_anonymous false\npassword_file {}\ncafile {}\ncertfile {}\nkeyfile {}\n\
             require_certificate true\n",
            self.door_port,
            passwords.display(),
            place("ca.pem").display(),
            place("broker.pem").display(),
            place("broker.key").display(),
        ))
    }

    /// What the bridge's configuration says of it.
    pub(crate) fn for_bridge(&self) -> String {
        let place = |name: &str| self.folder.join(name).display().to_string();
        match self.door {
            Door::Open => format!("broker = \"mqtt://127.0.0.1:{}\"\n", self.port),
            Door::Guarded => format!(
                "broker = \"mqtts://localhost:{}\"\nuser = \"robo\"\npassword = \"secret\"\nca = {:?}\ncertificate = {:?}\nkey = {:?}\n",
                self.door_port,
                place("ca.pem"),
                place("robo.pem"),
                place("robo.key"),
            ),
        }
    }

    pub(crate) fn kill(&mut self) {
        self.program = None;
    }

    pub(crate) fn start_again(&mut self) -> anyhow::Result<()> {
        let mut command = Command::new(server("mosquitto"));
        command.arg("-c").arg(self.folder.join("mosquitto.conf"));
        self.program = Some(Program::start(command, self.folder.join("mosquitto.log"))?);
        wait_for("mosquitto listens", Duration::from_secs(5), || {
            Ok(std::net::TcpStream::connect(("127.0.0.1", self.port)).ok())
        })
        .map(drop)
    }

    /// Says something.
    pub(crate) fn publish(&self, topic: &str, payload: &str, more: &[&str]) -> anyhow::Result<()> {
        let mut command = Command::new("mosquitto_pub");
        command.args(["-h", "127.0.0.1", "-p"]).arg(self.port.to_string());
        command.args(["-t", topic, "-m", payload]).args(more);
        output(&mut command).map(drop)
    }

    /// Says the same many times over one connection, a line each.
    pub(crate) fn flood(&self, topic: &str, payload: &str, count: usize) -> anyhow::Result<()> {
        let mut command = Command::new("mosquitto_pub");
        command.args(["-h", "127.0.0.1", "-p"]).arg(self.port.to_string());
        let mut child = command.args(["-t", topic, "-l"]).stdin(Stdio::piped()).spawn()?;
        if let Some(input) = child.stdin.take() {
            let mut input = std::io::BufWriter::new(input);
            for _ in 0..count {
                writeln!(input, "{payload}")?;
            }
        }
        child.wait()?;
        Ok(())
    }

    /// Follows all topics below these.
    pub(crate) fn listen(&self, topics: &[&str]) -> anyhow::Result<Listener> {
        let mut command = Command::new("mosquitto_sub");
        command.args(["-h", "127.0.0.1", "-p"]).arg(self.port.to_string());
        command.args(["-q", "1", "-F", "%r %q %t %x"]);
        for topic in topics {
            command.args(["-t", topic]);
        }
        let mut child = command
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("cannot start mosquitto_sub")?;
        let stdout = child.stdout.take().context("mosquitto_sub says nothing")?;
        let (sender, heard) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
        Ok(Listener { child, heard })
    }
}

/// Somebody who follows topics.
#[derive(Debug)]
pub(crate) struct Listener {
    child: Child,
    heard: Receiver<String>,
}

/// A message that was heard.
#[derive(Clone, Debug)]
pub(crate) struct Heard {
    pub(crate) retained: bool,
    pub(crate) quality: u8,
    pub(crate) topic: String,
    pub(crate) payload: Vec<u8>,
}

impl Heard {
    fn read(line: &str) -> Option<Self> {
        let mut words = line.split(' ');
        let retained = words.next()? == "1";
        let quality = words.next()?.parse().ok()?;
        let topic = words.next()?.to_owned();
        let digits = words.next().unwrap_or_default().as_bytes();
        let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
        let payload: Option<Vec<u8>> = digits.chunks(2).map(byte).collect();
        Some(Self {
            retained,
            quality,
            topic,
            payload: payload?,
        })
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.payload).into_owned()
    }
}

impl Listener {
    /// The next message that fits.
    pub(crate) fn wait_for(
        &self,
        what: &str,
        patience: Duration,
        fits: impl Fn(&Heard) -> bool,
    ) -> anyhow::Result<Heard> {
        let end = Instant::now() + patience;
        loop {
            match self
                .heard
                .recv_timeout(end.saturating_duration_since(Instant::now()))
            {
                Ok(line) => {
                    if let Some(heard) = Heard::read(&line).filter(|heard| fits(heard)) {
                        return Ok(heard);
                    }
                }
                Err(RecvTimeoutError::Timeout) => bail!("{what}: not within {patience:?}"),
                Err(RecvTimeoutError::Disconnected) => bail!("{what}: mosquitto_sub has ended"),
            }
        }
    }

    /// All that is heard within a time.
    pub(crate) fn all_within(&self, time: Duration) -> Vec<Heard> {
        let end = Instant::now() + time;
        let mut all = Vec::new();
        while let Ok(line) = self
            .heard
            .recv_timeout(end.saturating_duration_since(Instant::now()))
        {
            all.extend(Heard::read(&line));
        }
        all
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// An authority, a broker that it vouches for under `localhost`, and the bridge as a client.
fn write_certificates(folder: &Path) -> anyhow::Result<()> {
    let mut authority = CertificateParams::new(Vec::new())?;
    authority.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
    authority
        .distinguished_name
        .push(DnType::CommonName, "authority of a home");
    let issuer = CertifiedIssuer::self_signed(authority, KeyPair::generate()?)?;
    std::fs::write(folder.join("ca.pem"), issuer.pem())?;
    let ends = [
        ("broker", "localhost", ExtendedKeyUsagePurpose::ServerAuth),
        ("robo", "robo", ExtendedKeyUsagePurpose::ClientAuth),
    ];
    for (file, name, usage) in ends {
        let mut leaf = CertificateParams::new(vec![name.to_owned()])?;
        leaf.distinguished_name.push(DnType::CommonName, name);
        leaf.extended_key_usages.push(usage);
        let key = KeyPair::generate()?;
        let certificate = leaf.signed_by(&key, &issuer)?;
        std::fs::write(folder.join(format!("{file}.pem")), certificate.pem())?;
        std::fs::write(folder.join(format!("{file}.key")), key.serialize_pem())?;
    }
    Ok(())
}
