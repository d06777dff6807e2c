//! Which profile drives, and which robot is driven.

use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow, bail};
use mixer::{Profile, standard_profile};
use rvac_api::{Request, RequestBody, RobotDescription, Update};

use crate::arguments::DriveOptions;
use crate::socket::Connection;

/// The daemon answers at once; this covers a machine under load.
const ANSWER: Duration = Duration::from_secs(10);

/// The profile that was named, or the standard one.
pub(super) fn chosen(options: &DriveOptions, connection: &mut Connection) -> anyhow::Result<Profile> {
    if let Some(path) = &options.mix_file {
        return read(path);
    }
    let Some(name) = &options.mix else {
        return Ok(standard_profile());
    };
    kept(connection)?
        .into_iter()
        .find(|profile| profile.name.as_str() == name)
        .ok_or_else(|| anyhow!("the robot keeps no mix `{name}`: `rvac mix` lists them"))
}

/// A profile from a file.
pub(crate) fn read(path: &std::path::Path) -> anyhow::Result<Profile> {
    let place = || path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(place)?;
    Profile::parse(&text).with_context(place)
}

/// The profiles that the daemon keeps.
pub(crate) fn kept(connection: &mut Connection) -> anyhow::Result<Vec<Profile>> {
    connection.send(&Request {
        id: None,
        body: RequestBody::Mixes,
    })?;
    let mixes = wait(connection, |update| match update {
        Update::Mixes { mixes } => Some(mixes),
        _ => None,
    })?;
    mixes.iter().map(|text| Ok(Profile::parse(text)?)).collect()
}

/// What the daemon says of the robot; asked anew, because nobody has read the greeting before.
pub(super) fn robot(connection: &mut Connection) -> anyhow::Result<RobotDescription> {
    connection.send(&Request {
        id: None,
        body: RequestBody::Hello {
            name: "rvac drive".to_owned(),
        },
    })?;
    let robot = wait(connection, |update| match update {
        Update::Hello { robot, .. } => Some(robot),
        _ => None,
    })?;
    robot.ok_or_else(|| anyhow!("no robot is attached: check the serial cable and the robot's power"))
}

fn wait<Found>(
    connection: &mut Connection,
    found: impl Fn(Update) -> Option<Found>,
) -> anyhow::Result<Found> {
    let deadline = Instant::now() + ANSWER;
    while let Some(message) = connection.receive_until(deadline)? {
        if let Some(found) = message.update.and_then(&found) {
            return Ok(found);
        }
    }
    bail!("vthal did not answer within {} s", ANSWER.as_secs())
}
