//! `rvac mix`: the control mixes that the robot keeps.

use std::io::Write as _;
use std::process::ExitCode;

use mixer::standard_profile;
use rvac_api::RequestBody;

use crate::arguments::{MixJob, MixVerb};
use crate::control;
use crate::drive::{kept_profiles, named_profile, read_profile};
use crate::socket::Connection;

pub(crate) fn run(job: &MixJob) -> anyhow::Result<ExitCode> {
    match &job.verb {
        None => list(job),
        Some(MixVerb::Show { name }) => show(job, name.as_deref()),
        Some(MixVerb::Save { file }) => {
            let profile = read_profile(file)?.to_json();
            control::send(RequestBody::SaveMix { profile, was: None }, &job.daemon)
        }
        Some(MixVerb::Remove { name }) => {
            control::send(RequestBody::RemoveMix { name: name.clone() }, &job.daemon)
        }
    }
}

fn list(job: &MixJob) -> anyhow::Result<ExitCode> {
    let profiles = kept_profiles(&mut Connection::open(&job.daemon)?)?;
    let mut output = std::io::stdout().lock();
    if profiles.is_empty() {
        writeln!(output, "The robot keeps no mix: the standard one drives.")?;
    }
    for profile in profiles {
        let lines: usize = profile.outputs.iter().map(|output| output.lines.len()).sum();
        writeln!(
            output,
            "{}: {} outputs, {lines} lines",
            profile.name,
            profile.outputs.len()
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints a profile as a file that `save` takes; the standard one needs no robot.
fn show(job: &MixJob, name: Option<&str>) -> anyhow::Result<ExitCode> {
    let profile = match name {
        None => standard_profile(),
        Some(name) => named_profile(name, &mut Connection::open(&job.daemon)?)?,
    };
    writeln!(std::io::stdout(), "{}", profile.to_pretty_json())?;
    Ok(ExitCode::SUCCESS)
}
