//! The folder of recordings: names, and a bound on what it holds.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use crate::numbered::number;

/// Bounds of the folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LibraryLimits {
    /// Files kept.
    pub files_max: usize,
    /// Bytes kept.
    pub bytes_max: u64,
}

/// The folder of recordings.
#[derive(Clone, Debug)]
pub struct Library {
    folder: PathBuf,
    limits: LibraryLimits,
}

impl Library {
    /// Takes the folder, creating it when it is missing.
    ///
    /// # Errors
    /// What the file system says.
    pub fn open(folder: &Path, limits: LibraryLimits) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        Ok(Self {
            folder: folder.to_owned(),
            limits,
        })
    }

    /// Bounds.
    #[must_use]
    pub fn limits(&self) -> LibraryLimits {
        self.limits
    }

    /// A path for a new recording that begins when the clock says `now`. The number in it is one higher than all before and gives
    /// the order: a clock may go back, or begin in 1970. The date is for people, and keeps names apart from those of recordings
    /// that are gone.
    ///
    /// # Errors
    /// What the file system says.
    pub fn new_path(&self, now: SystemTime) -> io::Result<PathBuf> {
        let newest = self.recordings()?.pop().map_or(0, |(name, _)| name.number());
        let number = newest.saturating_add(1);
        let name = format!("{PREFIX}{number:06}-{}{ENDING}", date_and_time(now));
        Ok(self.folder.join(name))
    }

    /// Removes the oldest recordings until the bounds hold. The newest one always stays.
    ///
    /// # Errors
    /// What the file system says.
    pub fn tidy(&self) -> io::Result<()> {
        let files = self.recordings()?;
        let mut bytes: u64 = files.iter().map(|(_, size)| size).sum();
        let mut count = files.len();
        for (name, size) in files {
            let within = count <= self.limits.files_max && bytes <= self.limits.bytes_max;
            if within || count <= 1 {
                break;
            }
            fs::remove_file(self.folder.join(name.text()))?;
            bytes -= size;
            count -= 1;
        }
        Ok(())
    }

    /// The recordings with their bytes, the oldest first. What a person named otherwise is not ours.
    fn recordings(&self) -> io::Result<Vec<(Name, u64)>> {
        let mut found = Vec::new();
        for entry in fs::read_dir(&self.folder)? {
            let entry = entry?;
            if let Some(name) = entry.file_name().to_str().and_then(Name::read) {
                found.push((name, entry.metadata()?.len()));
            }
        }
        found.sort();
        Ok(found)
    }
}

/// Beginning and ending of names.
const PREFIX: &str = "recording-";
const ENDING: &str = ".mcap";

/// The name of a recording, in the order of their age.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Name {
    /// As earlier versions named them, by date.
    Dated(String),
    /// By number.
    Numbered(u64, String),
}

impl Name {
    fn read(text: &str) -> Option<Self> {
        if text.starts_with("run-") && text.ends_with(ENDING) {
            return Some(Self::Dated(text.to_owned()));
        }
        let (digits, _) = text.strip_prefix(PREFIX)?.split_once('-')?;
        let number = number(digits, "").filter(|_| text.ends_with(ENDING))?;
        Some(Self::Numbered(number, text.to_owned()))
    }

    fn number(&self) -> u64 {
        match self {
            Self::Dated(_) => 0,
            Self::Numbered(number, _) => *number,
        }
    }

    fn text(&self) -> &str {
        let (Self::Dated(text) | Self::Numbered(_, text)) = self;
        text
    }
}

/// `YYYYMMDD-HHMMSS` in UTC.
fn date_and_time(now: SystemTime) -> String {
    let seconds = now.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (year, month, day) = date(seconds / 86_400);
    let second_of_day = seconds % 86_400;
    let (hour, minute, second) = (second_of_day / 3600, second_of_day / 60 % 60, second_of_day % 60);
    format!("{year:04}{month:02}{day:02}-{hour:02}{minute:02}{second:02}")
}

/// Gregorian date of a day since 1970-01-01, counted in eras of 400 years that begin on the first of March.
fn date(days: u64) -> (u64, u64, u64) {
    const DAYS_PER_ERA: u64 = 146_097;
    /// From 0000-03-01 to 1970-01-01.
    const DAYS_BEFORE_1970: u64 = 719_468;
    let days = days + DAYS_BEFORE_1970;
    let (era, of_era) = (days / DAYS_PER_ERA, days % DAYS_PER_ERA);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let march_month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * march_month + 2) / 5 + 1;
    let month = if march_month < 10 {
        march_month + 3
    } else {
        march_month - 9
    };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    (year, month, day)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::time::{Duration, UNIX_EPOCH};

    use vthal_bench::Scratch;

    use super::{Library, LibraryLimits, date, date_and_time};

    #[test]
    fn dates_are_right_at_leap_days_and_ends_of_years() {
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(date(11_016), (2000, 2, 29));
        assert_eq!(date(20_453), (2025, 12, 31));
        assert_eq!(
            date_and_time(UNIX_EPOCH + Duration::from_secs(1_000_000_000)),
            "20010909-014640"
        );
    }

    fn library(scratch: &Scratch, files_max: usize, bytes_max: u64) -> Library {
        let limits = LibraryLimits { files_max, bytes_max };
        Library::open(&scratch.join("recordings"), limits).expect("opens")
    }

    fn left(scratch: &Scratch) -> Vec<String> {
        let entries = fs::read_dir(scratch.join("recordings")).expect("reads");
        let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("reads").file_name().into_string();
        let mut left: Vec<String> = entries.map(|entry| name(entry).expect("is text")).collect();
        left.sort();
        left
    }

    #[test]
    fn the_oldest_go_first_and_strangers_stay() {
        let scratch = Scratch::new().expect("creates");
        let library = library(&scratch, 3, 25);
        for name in [
            "run-20260101-000000.mcap",
            "run-20260102-000000.mcap",
            "recording-000001-20260103-000000.mcap",
            "recording-000002-19700101-000000.mcap",
            "notes.txt",
        ] {
            fs::write(scratch.join("recordings").join(name), [0; 10]).expect("writes");
        }
        library.tidy().expect("tidies");
        let kept = [
            "notes.txt",
            "recording-000001-20260103-000000.mcap",
            "recording-000002-19700101-000000.mcap",
        ];
        assert_eq!(left(&scratch), kept, "25 bytes hold two files");
    }

    /// A board without a clock begins in 1970, gets the time from the network, and begins in 1970 again.
    #[test]
    fn a_clock_that_goes_back_never_costs_the_newest() {
        let scratch = Scratch::new().expect("creates");
        let library = library(&scratch, 2, u64::MAX);
        for seconds in [1_000_000_000, 5, 1_000_000_001, 5] {
            let path = library.new_path(UNIX_EPOCH + Duration::from_secs(seconds));
            fs::write(path.expect("reads"), b"a run").expect("writes");
            library.tidy().expect("tidies");
        }
        let kept = [
            "recording-000003-20010909-014641.mcap",
            "recording-000004-19700101-000005.mcap",
        ];
        assert_eq!(left(&scratch), kept);
    }
}
