//! What can be said of schedules.

use std::str::FromStr;

use clap::{Args, ValueEnum};
use rvac_api::{InQuiet, Weekday};

use super::{Daemon, OrderParts};

#[derive(Debug, Args)]
pub(crate) struct ScheduleJob {
    #[command(subcommand)]
    pub(crate) verb: Option<ScheduleVerb>,
    #[command(flatten)]
    pub(crate) daemon: Daemon,
    /// Print the daemon's own JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Subcommand)]
pub(crate) enum ScheduleVerb {
    /// The next ten runs, and what would prevent them.
    Next,
    /// Results of the last runs, newest last.
    Past,
    /// Add a schedule: a name, a time, and days or a date; without rooms, zones and spots it cleans the whole home.
    Add {
        /// Its name.
        name: String,
        #[command(flatten)]
        options: ScheduleOptions,
    },
    /// Change a schedule; what is not given stays.
    Change {
        /// Its number.
        number: u32,
        /// Another name.
        #[arg(long)]
        name: Option<String>,
        #[command(flatten)]
        options: ScheduleOptions,
    },
    /// Remove a schedule.
    Remove {
        /// Its number.
        number: u32,
    },
    /// Enable a schedule.
    Enable {
        /// Its number.
        number: u32,
    },
    /// Disable a schedule.
    Disable {
        /// Its number.
        number: u32,
    },
    /// Skip the next run of a schedule.
    SkipNext {
        /// Its number.
        number: u32,
        /// Undo the skipping.
        #[arg(long)]
        undo: bool,
    },
    /// Start the job of a schedule now.
    RunNow {
        /// Its number.
        number: u32,
    },
    /// Hours in which nothing starts by itself.
    Quiet {
        /// When they begin, as 22:00; `off` for none.
        from: String,
        /// When they end.
        to: Option<String>,
    },
    /// Set the time zone of all times.
    Zone {
        /// Name of the zone, for example Europe/Tallinn; `system` for that of the robot's board.
        name: String,
    },
}

#[derive(Debug, Args)]
pub(crate) struct ScheduleOptions {
    /// Days of the week: mo,tu,we,th,fr,sa,su, or daily, weekdays, weekend.
    #[arg(long, value_name = "DAYS", conflicts_with = "date")]
    pub(crate) days: Option<DayNames>,
    /// A single day instead, as 2026-11-23.
    #[arg(long, value_name = "DATE")]
    pub(crate) date: Option<String>,
    /// Time of day, as 07:30.
    #[arg(long, value_name = "TIME")]
    pub(crate) at: Option<String>,
    #[command(flatten)]
    pub(crate) parts: OrderParts,
    /// Clean the whole home, by this strategy.
    #[arg(long, conflicts_with_all = ["room", "zone", "spot", "place", "avoid", "power", "pattern"])]
    pub(crate) strategy: Option<String>,
    /// Clean the whole home instead of what was chosen before.
    #[arg(long, conflicts_with_all = ["room", "zone", "spot", "place", "avoid"])]
    pub(crate) all: bool,
    /// Start on this floor only: its number or name; rooms and kept places of a floor where the robot is not are named by their numbers.
    #[arg(long, value_name = "FLOOR")]
    pub(crate) floor: Option<String>,
    /// Start on any floor, and clean all of it.
    #[arg(long, conflicts_with_all = ["floor", "room", "zone", "spot", "place", "avoid"])]
    pub(crate) any_floor: bool,
    /// Start up to so many minutes late, if the daemon was off or had no robot at the time.
    #[arg(long, value_name = "MINUTES")]
    pub(crate) late: Option<u16>,
    /// What happens in the quiet hours.
    #[arg(long, value_enum)]
    pub(crate) in_quiet: Option<QuietChoice>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum QuietChoice {
    /// It does not start.
    Refuse,
    /// It starts when they end.
    Wait,
}

impl From<QuietChoice> for InQuiet {
    fn from(choice: QuietChoice) -> Self {
        match choice {
            QuietChoice::Refuse => Self::Refuse,
            QuietChoice::Wait => Self::Wait,
        }
    }
}

/// Days of the week, as they are typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DayNames(pub(crate) Vec<Weekday>);

/// Text that names no days.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoDays;

impl core::fmt::Display for NoDays {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.write_str(
            "days are mo, tu, we, th, fr, sa, su with commas between them, or daily, weekdays, weekend",
        )
    }
}

impl core::error::Error for NoDays {}

impl FromStr for DayNames {
    type Err = NoDays;

    fn from_str(text: &str) -> Result<Self, NoDays> {
        let [.., saturday, sunday] = Weekday::ALL;
        match text {
            "daily" => return Ok(Self(Weekday::ALL.to_vec())),
            "weekdays" => return Ok(Self(Weekday::ALL.into_iter().take(5).collect())),
            "weekend" => return Ok(Self(vec![saturday, sunday])),
            _ => {}
        }
        let day = |text: &str| Weekday::ALL.into_iter().find(|day| day_name(*day) == text.trim());
        let days: Option<Vec<Weekday>> = text.split(',').map(day).collect();
        days.map(Self).ok_or(NoDays)
    }
}

/// The name of a day as it is typed.
pub(crate) const fn day_name(day: Weekday) -> &'static str {
    match day {
        Weekday::Mo => "mo",
        Weekday::Tu => "tu",
        Weekday::We => "we",
        Weekday::Th => "th",
        Weekday::Fr => "fr",
        Weekday::Sa => "sa",
        Weekday::Su => "su",
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::Weekday;

    use super::{DayNames, NoDays};

    #[test]
    fn days_have_names() {
        assert_eq!("mo,fr".parse(), Ok(DayNames(vec![Weekday::Mo, Weekday::Fr])));
        assert_eq!("weekend".parse(), Ok(DayNames(vec![Weekday::Sa, Weekday::Su])));
        assert_eq!("weekdays".parse::<DayNames>().map(|days| days.0.len()), Ok(5));
        for wrong in ["", "mo,", "Monday", "mo fr"] {
            assert_eq!(wrong.parse::<DayNames>(), Err(NoDays), "{wrong}");
        }
    }
}
