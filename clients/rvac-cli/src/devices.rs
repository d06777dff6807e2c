//! Who may use the robot from the network: windows, devices and the robot's certificate. It asks panel-server.

use std::fs;
use std::io::{BufRead as _, BufReader, IsTerminal as _, Write as _};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::Duration;

use anyhow::{Context as _, bail};
use pairing::console::{Order, Reply, Trust};
use pairing::{Code, DeviceName};

use crate::arguments::{ClientsJob, ClientsVerb, Console, PairOptions, TrustOptions};
use crate::qr;
use crate::remote::{self, Address};

/// A server that takes longer has hung.
const PATIENCE: Duration = Duration::from_secs(10);

/// Opens a window and shows its code, or pairs this computer with a robot elsewhere.
pub(crate) fn pair(options: &PairOptions) -> anyhow::Result<ExitCode> {
    if let Some(robot) = &options.robot {
        return join(robot, options.name.as_ref());
    }
    let Reply::Opened(invitation) = ask(&options.console, &Order::Pair { role: options.role })? else {
        bail!("panel-server gave another answer: both must be of one version");
    };
    let mut out = std::io::stdout().lock();
    writeln!(out, "Code: {}", invitation.opened.code)?;
    writeln!(
        out,
        "Open the panel on the new device within {} s and type the code. The device gets the role {}.",
        invitation.opened.seconds, options.role
    )?;
    for address in &invitation.addresses {
        writeln!(out, "  {address}")?;
    }
    if out.is_terminal() {
        for line in invitation.to_scan().map_or_else(Vec::new, qr::lines) {
            writeln!(out, "{line}")?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn join(robot: &Address, name: Option<&DeviceName>) -> anyhow::Result<ExitCode> {
    let name = match name {
        Some(name) => name.clone(),
        None => {
            let own = rustix::system::uname().nodename().to_string_lossy().into_owned();
            DeviceName::new(&own).context("this computer has no name that fits: give one with --name")?
        }
    };
    let joined = remote::join(robot, &name, || {
        let mut out = std::io::stderr();
        write!(out, "Code: ")?;
        out.flush()?;
        let mut line = String::new();
        std::io::stdin().read_line(&mut line)?;
        Ok(Code::parse(line.trim())?)
    })?;
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "{} knows this computer as {name}, with the role {}.",
        joined.robot.host_name(),
        joined.role
    )?;
    writeln!(out, "Its token is kept in {}.", joined.kept_in.display())?;
    Ok(ExitCode::SUCCESS)
}

/// Lists devices or changes one.
pub(crate) fn clients(job: &ClientsJob) -> anyhow::Result<ExitCode> {
    let order = match &job.verb {
        None => Order::Clients,
        Some(ClientsVerb::Revoke { id }) => Order::Revoke { id: *id },
        Some(ClientsVerb::Vouch { id }) => Order::Vouch { id: *id },
        Some(ClientsVerb::ForgetAll { identity }) => Order::ForgetAll { identity: *identity },
        Some(ClientsVerb::Role { id, role }) => Order::SetRole { id: *id, role: *role },
        Some(ClientsVerb::Add { name, role }) => Order::Add {
            name: name.clone(),
            role: *role,
        },
    };
    let mut out = std::io::stdout().lock();
    match ask(&job.console, &order)? {
        Reply::Clients { clients } if clients.is_empty() => {
            writeln!(out, "No device is paired: rvac pair lets one in.")?;
        }
        Reply::Clients { clients } => {
            for client in clients {
                let (id, role) = (client.id.to_string(), client.role.name());
                writeln!(out, "{id}  {role:5}  {}", client.name)?;
            }
        }
        Reply::Added { token } => writeln!(out, "{token}")?,
        Reply::Trust(trust) => {
            writeln!(out, "The robot is {} from now on.", trust.host_name)?;
            writeln!(out, "Fingerprint: {}", trust.fingerprint)?;
        }
        _ => {}
    }
    Ok(ExitCode::SUCCESS)
}

/// Shows the robot's certificate, writes or installs it.
pub(crate) fn trust(options: &TrustOptions) -> anyhow::Result<ExitCode> {
    let Reply::Trust(trust) = ask(&options.console, &Order::Trust)? else {
        bail!("panel-server gave another answer: both must be of one version");
    };
    let mut out = std::io::stdout().lock();
    writeln!(out, "Robot:       {}", trust.host_name)?;
    writeln!(out, "Fingerprint: {}", trust.fingerprint)?;
    if let Some(folder) = &options.save {
        for path in save(&trust, folder)? {
            writeln!(out, "wrote {path}")?;
        }
    }
    if options.install {
        install(&trust)?;
        writeln!(
            out,
            "Chromium on this computer trusts the robot from its next start."
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

fn save(trust: &Trust, folder: &Path) -> anyhow::Result<Vec<String>> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let name = trust.host_name.trim_end_matches(".local");
    let der = trust.der().context("panel-server sent no certificate")?;
    let profile = trust
        .mobile_profile()
        .context("panel-server sent no certificate")?;
    let files: [(&str, &[u8]); 3] = [
        ("pem", trust.pem.as_bytes()),
        ("crt", &der),
        ("mobileconfig", profile.as_bytes()),
    ];
    let mut written = Vec::new();
    for (ending, bytes) in files {
        let path = folder.join(format!("{name}.{ending}"));
        fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        written.push(path.display().to_string());
    }
    Ok(written)
}

/// Into the user's NSS store, with the program that people use for it by hand.
fn install(trust: &Trust) -> anyhow::Result<()> {
    let home = std::env::var_os("HOME").context("HOME is not set, so there is no store of certificates")?;
    let store = Path::new(&home).join(".pki/nssdb");
    if !store.is_dir() {
        bail!(
            "{} does not exist: start Chromium once, then try again",
            store.display()
        );
    }
    let mut child = Command::new("certutil")
        .arg("-d")
        .arg(format!("sql:{}", store.display()))
        .args(["-A", "-t", "C,,", "-n", &trust.host_name])
        .stdin(Stdio::piped())
        .spawn()
        .context("cannot start certutil: install it (libnss3-tools), or import the file that --save writes by hand")?;
    if let Some(mut input) = child.stdin.take() {
        input.write_all(trust.pem.as_bytes())?;
    }
    let status = child.wait()?;
    if !status.success() {
        bail!("certutil ended with {status}");
    }
    Ok(())
}

/// One order, one reply; a refusal is an error.
fn ask(console: &Console, order: &Order) -> anyhow::Result<Reply> {
    let path = &console.console;
    let stream = UnixStream::connect(path).with_context(|| {
        format!(
            "cannot reach panel-server at {}: does it run with --state, and are you its user or root? (--console names another place)",
            path.display()
        )
    })?;
    stream.set_read_timeout(Some(PATIENCE))?;
    let mut line = serde_json::to_vec(order)?;
    line.push(b'\n');
    (&stream)
        .write_all(&line)
        .context("panel-server has closed the connection")?;
    let mut answer = String::new();
    BufReader::new(&stream)
        .read_line(&mut answer)
        .context("panel-server gave no answer")?;
    match serde_json::from_str(&answer)
        .context("panel-server gave another answer: both must be of one version")?
    {
        Reply::Refused(refused) => bail!("{}", refused.text),
        reply => Ok(reply),
    }
}
