//! Control mixes: kept, replaced, removed.

use mixer::{Name, Profile, standard_profile};
use rvac_api::{RequestBody, Update};

use crate::life::{Kept, replaced};
use crate::store::{Change, Desk, Store};

/// Profiles of which one is written at a time.
const PROFILES: u64 = 5;

pub(crate) struct Mixes;

impl Store for Mixes {
    fn name(&self) -> &'static str {
        "mixes"
    }

    fn read(&self, desk: &mut Desk) -> anyhow::Result<Kept> {
        desk.send(1, RequestBody::Mixes)?;
        let mixes = desk.wait("the mixes", |update| match update {
            Update::Mixes { mixes } => Some(mixes),
            _ => None,
        })?;
        let named = |text: String| Ok((Profile::parse(&text)?.name.to_string(), text));
        mixes.into_iter().map(named).collect()
    }

    fn change(&self, kept: &Kept, number: u64) -> Change {
        let name = format!("Person {}", number % PROFILES);
        if number.is_multiple_of(3) && kept.contains_key(&name) {
            return Change {
                after: replaced(kept, Some(&name), None),
                request: RequestBody::RemoveMix { name },
            };
        }
        let profile = profile(&name, number);
        Change {
            after: replaced(kept, Some(&name), Some(profile.clone())),
            request: RequestBody::SaveMix { profile, was: None },
        }
    }
}

/// The standard profile with a name of its own and a first line that tells one version from another.
fn profile(name: &str, number: u64) -> String {
    let mut profile = standard_profile();
    let line = profile
        .outputs
        .first_mut()
        .and_then(|output| output.lines.first_mut());
    if let (Ok(name), Ok(version), Some(line)) =
        (Name::new(name), Name::new(&format!("Version {number}")), line)
    {
        profile.name = name;
        line.name = version;
    }
    profile.to_json()
}
