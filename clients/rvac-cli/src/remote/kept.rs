//! What this computer keeps of a robot that it is paired with: the robot's authority, and the token that it shows.

use std::fs::{self, DirBuilder};
use std::io::ErrorKind;
use std::os::unix::fs::DirBuilderExt as _;
use std::path::PathBuf;

use anyhow::{Context as _, bail};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rustls::pki_types::CertificateDer;
use serde::{Deserialize, Serialize};

use super::Address;

/// One robot.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Kept {
    /// The certificate of its authority, DER in base 64.
    authority: String,
    /// As `Authorization: Bearer` has it.
    pub(super) token: String,
}

impl Kept {
    pub(super) fn new(authority: &CertificateDer<'_>, token: String) -> Self {
        Self {
            authority: STANDARD.encode(authority),
            token,
        }
    }

    /// What is kept of the robot at `address`.
    pub(super) fn of(address: &Address) -> anyhow::Result<Self> {
        let path = path_of(address)?;
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                bail!("this computer is not paired with {address}: `rvac pair --robot {address}` does that")
            }
            Err(error) => return Err(error).with_context(|| format!("cannot read {}", path.display())),
        };
        serde_json::from_str(&text).with_context(|| {
            format!(
                "{} is damaged: remove it, and pair with `rvac pair --robot {address}`",
                path.display()
            )
        })
    }

    pub(super) fn authority(&self) -> anyhow::Result<CertificateDer<'static>> {
        let der = STANDARD.decode(&self.authority);
        Ok(der
            .context("the robot's certificate that is kept is damaged: pair anew")?
            .into())
    }

    /// Keeps it, for this user alone; gives the file.
    pub(super) fn keep(&self, address: &Address) -> anyhow::Result<PathBuf> {
        let path = path_of(address)?;
        if let Some(folder) = path.parent() {
            let made = DirBuilder::new().recursive(true).mode(0o700).create(folder);
            made.with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        let text = serde_json::to_vec_pretty(self)?;
        kept_file::replace_secret(&path, &text)
            .with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
    }
}

fn path_of(address: &Address) -> anyhow::Result<PathBuf> {
    let configuration = match std::env::var_os("XDG_CONFIG_HOME").filter(|path| !path.is_empty()) {
        Some(path) => PathBuf::from(path),
        None => {
            let home = std::env::var_os("HOME");
            PathBuf::from(home.context("HOME is not set, so there is no place for what is kept of robots")?)
                .join(".config")
        }
    };
    let name = format!("{}-{}.json", address.name().replace(':', "_"), address.port());
    Ok(configuration.join("rvac/robots").join(name))
}
