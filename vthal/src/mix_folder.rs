//! Control mixes on disk: the folder `mixes` in the state folder, with one file for each profile. What comes from clients is
//! read with the crate that runs it, so nothing is kept that a client could not use.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::PathBuf;

use kept_file::newest;
use mixer::{Name, PROFILE_BYTES_MAX, Profile, ProfileError};

/// Profiles kept: some for each person of a household.
const PROFILES_MAX: usize = 8;
/// Ending of the files.
const ENDING: &str = ".json";

/// The folder.
#[derive(Clone, Debug)]
pub(crate) struct MixFolder {
    path: PathBuf,
}

/// Why a profile is not kept or not removed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MixError {
    /// What came is no profile.
    #[error("The profile is not kept: {0}.")]
    Wrong(#[from] ProfileError),
    /// There are as many as may be.
    #[error("As many profiles are kept as may be, {PROFILES_MAX}: remove one first.")]
    Full,
    /// There is none with this name.
    #[error("No profile has the name `{0}`: ask which are kept.")]
    Absent(String),
    /// Another client has changed it meanwhile.
    #[error("The profile `{0}` was changed meanwhile: look at what is kept, and save again.")]
    ChangedMeanwhile(Name),
    /// The disk refuses.
    #[error("The profile cannot be written: {0}. Check the disk and the state folder.")]
    Unwritable(#[from] io::Error),
}

impl MixError {
    /// The reason's name for clients.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Wrong(_) => "mix-wrong",
            Self::Full => "too-many-mixes",
            Self::Absent(_) => "no-such-mix",
            Self::ChangedMeanwhile(_) => "changed-meanwhile",
            Self::Unwritable(_) => "mix-unwritable",
        }
    }
}

impl MixFolder {
    /// The folder at `path`, made with the first profile.
    pub(crate) fn new(path: PathBuf) -> Self {
        Self { path }
    }

    /// The profiles that are whole, by their names, each as one line of JSON.
    pub(crate) fn list(&self) -> Vec<String> {
        let profiles = self.names().into_iter().filter_map(|name| self.load(&name));
        profiles.map(|profile| profile.to_json()).collect()
    }

    /// Puts aside what cannot be read, and says what that was.
    pub(crate) fn put_damaged_aside(&self) -> Vec<String> {
        let complaints = |name: &Name| {
            let what = format!("the control mix {name}");
            newest(&self.file(name), &what, |text| parse(text, name)).complaints
        };
        self.names().iter().flat_map(complaints).collect()
    }

    /// Keeps a profile in place of the one with the same name, if that is what the client has seen before; empty = none was there.
    ///
    /// # Errors
    /// See [`MixError`]; then nothing is changed.
    pub(crate) fn save(&self, text: &str, was: Option<&str>) -> Result<(), MixError> {
        let profile = Profile::parse(text)?;
        if let Some(was) = was {
            let seen = Profile::parse(was).ok();
            if seen != self.load(&profile.name) {
                return Err(MixError::ChangedMeanwhile(profile.name));
            }
        }
        let names = self.names();
        if !names.contains(&profile.name) && names.len() >= PROFILES_MAX {
            return Err(MixError::Full);
        }
        fs::create_dir_all(&self.path)?;
        kept_file::replace(&self.file(&profile.name), profile.to_json().as_bytes())?;
        Ok(())
    }

    /// Removes the profile with this name.
    ///
    /// # Errors
    /// See [`MixError`].
    pub(crate) fn remove(&self, name: &str) -> Result<(), MixError> {
        let known = Name::new(name).ok().filter(|name| self.names().contains(name));
        let known = known.ok_or_else(|| MixError::Absent(name.to_owned()))?;
        // The predecessor goes first: otherwise it would replace the removed file, if the power failed in between.
        for version in kept_file::versions(&self.file(&known)).iter().rev() {
            if version.exists() {
                fs::remove_file(version)?;
            }
        }
        Ok(())
    }

    /// Names of the files, or of their predecessors where a crash has left only those. What a person named otherwise is not
    /// ours.
    fn names(&self) -> BTreeSet<Name> {
        let Ok(entries) = fs::read_dir(&self.path) else {
            return BTreeSet::new();
        };
        let name = |file: &str| {
            let file = file.strip_suffix(".old").unwrap_or(file);
            Name::new(file.strip_suffix(ENDING)?).ok()
        };
        entries
            .flatten()
            .filter_map(|entry| name(entry.file_name().to_str()?))
            .collect()
    }

    fn file(&self, name: &Name) -> PathBuf {
        self.path.join(format!("{name}{ENDING}"))
    }

    fn load(&self, name: &Name) -> Option<Profile> {
        let versions = kept_file::versions(&self.file(name));
        versions
            .iter()
            .find_map(|path| parse(&kept_file::read_text(path).ok()?, name).ok())
    }
}

fn parse(text: &str, name: &Name) -> Result<Profile, String> {
    if text.len() > PROFILE_BYTES_MAX {
        return Err(format!("it is longer than {PROFILE_BYTES_MAX} bytes"));
    }
    let profile = Profile::parse(text).map_err(|error| error.to_string())?;
    if profile.name == *name {
        Ok(profile)
    } else {
        Err(format!("it is that of {}", profile.name))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use mixer::{Name, Profile, standard_profile};

    use super::{MixFolder, PROFILES_MAX};

    struct Scratch(MixFolder);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("vthal-mixes-{name}-{}", std::process::id()));
            fs::remove_dir_all(&path).ok();
            Self(MixFolder::new(path))
        }

        fn names(&self) -> Vec<String> {
            let profiles = self.0.list();
            let name = |text: &String| Profile::parse(text).expect("is whole").name.to_string();
            profiles.iter().map(name).collect()
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.0.path).ok();
        }
    }

    fn profile(name: &str) -> Profile {
        Profile {
            name: Name::new(name).expect("a name"),
            ..standard_profile()
        }
    }

    #[test]
    fn profiles_are_kept_replaced_and_removed_by_their_names() {
        let scratch = Scratch::new("kept");
        assert!(scratch.names().is_empty());
        for name in ["Köök", "Anna", "Anna"] {
            scratch
                .0
                .save(&profile(name).to_pretty_json(), None)
                .expect("saves");
        }
        assert_eq!(scratch.names(), ["Anna", "Köök"]);
        let mut changed = profile("Anna");
        changed.outputs.clear();
        scratch.0.save(&changed.to_json(), None).expect("saves");
        assert_eq!(scratch.0.list()[0], changed.to_json());
        scratch.0.remove("Anna").expect("removes");
        assert_eq!(scratch.names(), ["Köök"], "its predecessor is gone too");
        for name in ["Anna", "../Köök", ""] {
            assert_eq!(
                scratch.0.remove(name).expect_err("is absent").name(),
                "no-such-mix"
            );
        }
    }

    #[test]
    fn a_stale_copy_replaces_nothing() {
        let scratch = Scratch::new("stale");
        let (first, mut second, mut third) = (profile("Anna"), profile("Anna"), profile("Anna"));
        second.outputs.truncate(2);
        third.outputs.truncate(1);
        let save = |profile: &Profile, was: Option<&str>| {
            let saved = scratch.0.save(&profile.to_json(), was);
            saved.map_err(|error| error.name())
        };
        assert_eq!(save(&first, Some("")), Ok(()), "there was none");
        assert_eq!(
            save(&second, Some("")),
            Err("changed-meanwhile"),
            "now there is one"
        );
        assert_eq!(save(&second, Some(&first.to_pretty_json())), Ok(()));
        assert_eq!(save(&third, Some(&first.to_json())), Err("changed-meanwhile"));
        assert_eq!(scratch.0.list(), [second.to_json()]);
        assert_eq!(save(&third, None), Ok(()), "whatever it is");
    }

    #[test]
    fn what_is_wrong_is_refused_and_what_is_broken_not_offered() {
        let scratch = Scratch::new("broken");
        let error = scratch
            .0
            .save(r#"{"version":1,"name":"a/b","outputs":[]}"#, None)
            .expect_err("no name");
        assert_eq!(error.name(), "mix-wrong");
        assert!(error.to_string().contains("`a/b` is no name: take"), "{error}");
        assert!(!scratch.0.path.exists(), "nothing was written");
        let (first, mut second) = (profile("Anna"), profile("Anna"));
        second.outputs.clear();
        for version in [&first, &second] {
            scratch.0.save(&version.to_json(), None).expect("saves");
        }
        fs::write(scratch.0.path.join("Anna.json"), "{").expect("writes");
        assert_eq!(scratch.0.list(), [first.to_json()], "the predecessor stands in");
        fs::write(scratch.0.path.join("Bert.json"), first.to_json()).expect("writes");
        fs::write(scratch.0.path.join("notes.txt"), "mine").expect("writes");
        assert_eq!(
            scratch.names(),
            ["Anna"],
            "a file under another name is not that profile"
        );
        let complaints = scratch.0.put_damaged_aside();
        assert_eq!(complaints.len(), 2, "{complaints:?}");
        assert!(
            complaints[0].contains("the control mix Anna in"),
            "{complaints:?}"
        );
        assert!(scratch.0.path.join("Anna.json.damaged-1").exists());
        assert_eq!(scratch.names(), ["Anna"]);
        assert!(scratch.0.put_damaged_aside().is_empty(), "told once");
    }

    #[test]
    fn there_is_a_largest_number() {
        let scratch = Scratch::new("many");
        for number in 0..PROFILES_MAX {
            scratch
                .0
                .save(&profile(&format!("p{number}")).to_json(), None)
                .expect("saves");
        }
        assert_eq!(
            scratch
                .0
                .save(&profile("one more").to_json(), None)
                .expect_err("full")
                .name(),
            "too-many-mixes"
        );
        scratch
            .0
            .save(&profile("p0").to_json(), None)
            .expect("one that is there may change");
    }
}
