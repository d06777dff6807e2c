//! The folder of recordings: names, and a bound on what it holds.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

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

    /// A path for a new recording that begins at `now`: names sort by time.
    #[must_use]
    pub fn new_path(&self, now: SystemTime) -> PathBuf {
        let stem = format!("run-{}", date_and_time(now));
        (0..u32::MAX)
            .map(|number| match number {
                0 => self.folder.join(format!("{stem}.mcap")),
                _ => self.folder.join(format!("{stem}-{number:03}.mcap")),
            })
            .find(|path| !path.exists())
            .unwrap_or_else(|| self.folder.join(stem))
    }

    /// Removes the oldest recordings until the bounds hold. The newest one always stays.
    ///
    /// # Errors
    /// What the file system says.
    pub fn tidy(&self) -> io::Result<()> {
        let mut files: Vec<(PathBuf, u64)> = Vec::new();
        for entry in fs::read_dir(&self.folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let is_ours = name
                .to_str()
                .is_some_and(|name| name.starts_with("run-") && name.ends_with(".mcap"));
            if is_ours {
                files.push((entry.path(), entry.metadata()?.len()));
            }
        }
        files.sort();
        let mut bytes: u64 = files.iter().map(|(_, size)| size).sum();
        let mut count = files.len();
        for (path, size) in files {
            let within = count <= self.limits.files_max && bytes <= self.limits.bytes_max;
            if within || count <= 1 {
                break;
            }
            fs::remove_file(path)?;
            bytes -= size;
            count -= 1;
        }
        Ok(())
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

    #[test]
    fn the_oldest_go_first_and_strangers_stay() {
        let scratch = Scratch::new().expect("creates");
        let folder = scratch.join("recordings");
        let library = Library::open(
            &folder,
            LibraryLimits {
                files_max: 3,
                bytes_max: 25,
            },
        )
        .expect("opens");
        for name in [
            "run-1.mcap",
            "run-2.mcap",
            "run-3.mcap",
            "run-4.mcap",
            "notes.txt",
        ] {
            fs::write(folder.join(name), [0; 10]).expect("writes");
        }
        library.tidy().expect("tidies");
        let mut left: Vec<_> = fs::read_dir(&folder)
            .expect("reads")
            .map(|entry| entry.expect("reads").file_name())
            .collect();
        left.sort();
        assert_eq!(
            left,
            ["notes.txt", "run-3.mcap", "run-4.mcap"],
            "25 bytes hold two files"
        );
    }
}
