//! Pairing this computer with a robot, by a code.
//!
//! The robot's identity is not known yet, so the certificate comes from whichever host answers. From then on only the holder of that certificate is accepted,
//! and the proof of the code holds only for the robot that has it: an attacker in between has another one, and learns nothing about the code.

use std::path::PathBuf;

use anyhow::{Context as _, bail};
use pairing::wire::{Begin, Begun, Finish, Finished, Invitation};
use pairing::{Code, DeviceName, Ends, Guest, RobotId, Role};
use rustls::pki_types::CertificateDer;
use rustls::server::ParsedCertificate;

use super::Address;
use super::https::Line;
use super::kept::Kept;

/// What came of it.
#[derive(Debug)]
pub(crate) struct Joined {
    pub(crate) robot: RobotId,
    pub(crate) role: Role,
    /// Where the token is kept.
    pub(crate) kept_in: PathBuf,
}

/// Proves the code to the robot at `address` and keeps the token.
pub(crate) fn join(
    address: &Address,
    name: &DeviceName,
    code: impl FnOnce() -> anyhow::Result<Code>,
) -> anyhow::Result<Joined> {
    let certificate = Line::to_anybody(address)?.get(address, "/robot.crt", None)?;
    if certificate.status != 200 {
        bail!("{address} has no certificate of a robot: is that panel-server, and does it run with --state?");
    }
    let authority = CertificateDer::from(certificate.body);
    let key = ParsedCertificate::try_from(&authority).context("the robot's certificate cannot be read")?;
    let robot = RobotId::of_public_key(&key.subject_public_key_info());
    let line = || Line::trusting(address, &authority);
    let invitation: Invitation = line()?.get(address, "/api/pairing", None)?.read()?;
    if invitation.presses {
        bail!(
            "START was held, and in this window no code is taken: wait two minutes, then open another with `rvac pair` on the robot"
        );
    }
    if !invitation.open {
        bail!(
            "nobody can be let in now: run `rvac pair` on the robot, or choose Add a device on one that is its administrator"
        );
    }
    let code = code()?;
    let mut random = [0; 64];
    getrandom::fill(&mut random).context("the system gives no random numbers")?;
    let robot_id = robot.full();
    let (guest, message) = Guest::begin(
        &code,
        Ends {
            guest: name,
            robot: robot_id,
        },
        random,
    );
    let begin = Begin {
        name: name.clone(),
        message,
    };
    let begun: Begun = line()?.post(address, "/api/pairing/begin", &begin)?.read()?;
    let (waiting, proof) = guest.hear(&begun.message)?;
    let attempt = begun.attempt;
    let answer = line()?.post(address, "/api/pairing/finish", &Finish { attempt, proof })?;
    let finished: Finished = answer.read()?;
    if !waiting.is_proven(&finished.proof) {
        bail!(
            "the answer is not that of the robot whose code this is: somebody may stand between. Do not go on"
        );
    }
    let token = answer.token.context("the robot gave no token")?;
    let kept_in = Kept::new(&authority, token).keep(address)?;
    Ok(Joined {
        robot,
        role: finished.role,
        kept_in,
    })
}
