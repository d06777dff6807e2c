//! A robot on the network, over TLS under its own authority, as one of its paired devices.
//!
//! What the rest of the program sees is a socket like that of the daemon: a thread carries the messages to and fro.

mod address;
mod bridge;
mod https;
mod join;
mod kept;

use std::os::unix::net::UnixStream;

use anyhow::{Context as _, bail};
use pairing::wire::Session;

pub(crate) use address::Address;
pub(crate) use join::join;

use https::Line;
use kept::Kept;

/// A connection to the daemon of the robot at `address`.
pub(crate) fn connect(address: &Address) -> anyhow::Result<UnixStream> {
    let kept = Kept::of(address)?;
    let answer =
        Line::trusting(address, &kept.authority()?)?.get(address, "/api/session", Some(&kept.token))?;
    if answer.status == 401 {
        bail!("{address} does not know this computer any more: pair it with `rvac pair --robot {address}`");
    }
    let session: Session = answer.read()?;
    let nonce = session
        .nonce
        .context("the robot gave no word for the connection")?;
    let line = Line::trusting(address, &kept.authority()?)?;
    bridge::build(line, address, &kept.token, &nonce)
}
