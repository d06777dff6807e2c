//! Which profile drives, and which robot is driven.

use anyhow::{Context as _, anyhow};
use mixer::{Profile, standard_profile};
use rvac_api::{RequestBody, RobotDescription, Update};

use crate::arguments::DriveOptions;
use crate::control;
use crate::socket::Connection;

/// The profile that was named, or the standard one.
pub(super) fn chosen(options: &DriveOptions, connection: &mut Connection) -> anyhow::Result<Profile> {
    if let Some(path) = &options.mix_file {
        return read(path);
    }
    let Some(name) = &options.mix else {
        return Ok(standard_profile());
    };
    named(name, connection)
}

/// The profile of this name that the daemon keeps.
pub(crate) fn named(name: &str, connection: &mut Connection) -> anyhow::Result<Profile> {
    kept(connection)?
        .into_iter()
        .find(|profile| profile.name.as_str() == name)
        .ok_or_else(|| anyhow!("the robot keeps no mix `{name}`: `rvac mix` lists them"))
}

/// A profile from a file.
pub(crate) fn read(path: &std::path::Path) -> anyhow::Result<Profile> {
    let place = || path.display().to_string();
    let text = kept_file::read_text(path).with_context(place)?;
    Profile::parse(&text).with_context(place)
}

/// The profiles that the daemon keeps.
pub(crate) fn kept(connection: &mut Connection) -> anyhow::Result<Vec<Profile>> {
    let request = RequestBody::Mixes;
    let mixes = control::answer(connection, request, control::ANSWER, |update, _| match update {
        Update::Mixes { mixes } => Some(mixes),
        _ => None,
    })?;
    mixes.iter().map(|text| Ok(Profile::parse(text)?)).collect()
}

/// The robot's description from the daemon; requested, because the greeting was not read.
pub(super) fn robot(connection: &mut Connection) -> anyhow::Result<RobotDescription> {
    let hello = RequestBody::Hello {
        name: "rvac drive".to_owned(),
    };
    let robot = control::answer(connection, hello, control::ANSWER, |update, _| match update {
        Update::Hello { robot, .. } => Some(robot),
        _ => None,
    })?;
    robot.ok_or_else(|| anyhow!("no robot is attached: check the serial cable and the robot's power"))
}
