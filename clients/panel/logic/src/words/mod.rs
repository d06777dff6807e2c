//! Everything that a person reads on the page, in every language that the page speaks.
//!
//! A *screen* is a plain structure of texts; the macro [`screen`] makes it from lines of a name, the English and the Estonian text, so
//! a text without its translation does not compile. A text that takes values is a [`Template`] with the number of its values in
//! its type; `{0}` is the place of the first one.

mod about;
mod access;
mod calibration;
mod device;
mod drive;
mod evidence;
mod frame;
mod health;
mod history;
mod home;
mod learnt;
mod map;
mod matter;
mod mix;
mod notice;
mod schedule;
mod software;
mod status;
mod system;
#[cfg(test)]
mod tests;

use std::fmt::Display;

pub use about::AboutWords;
pub use access::AccessWords;
pub use calibration::{CalibrationNames, CalibrationWords};
pub use device::DeviceWords;
pub use drive::DriveWords;
pub use evidence::EvidenceWords;
pub use frame::{ActionWords, FrameWords, LogWords, OfferWords, StateWords, UnitWords};
pub use health::HealthWords;
pub use history::HistoryWords;
pub use home::HomeWords;
pub use learnt::LearntWords;
pub use map::MapWords;
pub use matter::MatterWords;
pub use mix::MixWords;
pub use notice::NoticeWords;
pub use schedule::ScheduleWords;
pub use software::SoftwareWords;
pub use status::StatusWords;
pub use system::SystemWords;

/// A language that the page speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    English,
    Estonian,
}

impl Language {
    /// All, as they are offered.
    pub const ALL: [Self; 2] = [Self::English, Self::Estonian];

    /// As browsers and `<html lang>` write it.
    #[must_use]
    pub const fn tag(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::Estonian => "et",
        }
    }

    /// What it calls itself.
    #[must_use]
    pub const fn own_name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::Estonian => "Eesti",
        }
    }

    /// The language of a tag such as `et-EE`.
    #[must_use]
    pub fn of_tag(tag: &str) -> Option<Self> {
        let main = tag.split('-').next()?;
        Self::ALL
            .into_iter()
            .find(|language| language.tag().eq_ignore_ascii_case(main))
    }

    /// Everything that is said in it.
    #[must_use]
    pub const fn words(self) -> &'static Words {
        match self {
            Self::English => &ENGLISH,
            Self::Estonian => &ESTONIAN,
        }
    }
}

/// A text with places for `N` values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Template<const N: usize>(&'static str);

impl<const N: usize> Template<N> {
    /// The text with these values in it. A line does not break between a figure and its unit, nor between a name and its number.
    #[must_use]
    pub fn fill(self, values: [&dyn Display; N]) -> String {
        let mut text = String::new();
        let mut rest = self.0;
        while let Some((before, (place, behind))) = rest
            .split_once('{')
            .and_then(|(before, after)| Some((before, after.split_once('}')?)))
        {
            text.push_str(before);
            rest = behind;
            if let Some(value) = place.parse::<usize>().ok().and_then(|place| values.get(place)) {
                let value = value.to_string();
                if is_number_of_name(&value, rest) && text.ends_with(' ') {
                    text.pop();
                    text.push(NO_BREAK_SPACE);
                }
                text.push_str(&value);
                if let Some(unit) = unit_behind(&value, rest) {
                    text.push(NO_BREAK_SPACE);
                    rest = unit;
                }
            }
        }
        text.push_str(rest);
        text
    }
}

const NO_BREAK_SPACE: char = '\u{a0}';

/// Signs of units, as templates write them behind a figure and a space.
const UNITS: [&str; 21] = [
    "%", "km", "m", "cm", "m²", "m/s", "d", "p", "h", "min", "s", "ms", "A", "V", "Hz", "°C", "MB", "kB",
    "kB/s", "GiB", "MiB",
];

/// Whether a value at the end of a text is the number of what stands before it, as in "Room 1".
fn is_number_of_name(value: &str, behind: &str) -> bool {
    behind.is_empty() && !value.is_empty() && value.bytes().all(|byte| byte.is_ascii_digit())
}

/// What follows the space between a figure and its unit.
fn unit_behind<'a>(value: &str, behind: &'a str) -> Option<&'a str> {
    let unit = behind.strip_prefix(' ')?;
    let ends =
        |rest: &str| !rest.starts_with(|next: char| next.is_alphanumeric() || next == '/' || next == '-');
    let is_unit = UNITS.iter().any(|sign| unit.strip_prefix(sign).is_some_and(ends));
    (is_unit && value.ends_with(|last: char| last.is_ascii_digit())).then_some(unit)
}

/// Makes a screen: its structure and its texts in every language.
macro_rules! screen {
    ($(#[$doc:meta])* $name:ident { $($key:ident $([$count:literal])? : $english:literal, $estonian:literal;)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name { $(pub $key: $crate::words::screen!(@kind $([$count])?),)* }

        impl $name {
            pub(super) const ENGLISH: Self = Self { $($key: $crate::words::screen!(@text $([$count])? $english),)* };
            pub(super) const ESTONIAN: Self = Self { $($key: $crate::words::screen!(@text $([$count])? $estonian),)* };
            /// Name, number of values, and the text in every language.
            #[cfg(test)]
            pub(super) const ALL: &'static [(&'static str, usize, [&'static str; 2])] =
                &[$((stringify!($key), 0 $(+ $count)?, [$english, $estonian]),)*];
        }
    };
    (@kind) => { &'static str };
    (@kind [$count:literal]) => { $crate::words::Template<$count> };
    (@text $text:literal) => { $text };
    (@text [$count:literal] $text:literal) => { $crate::words::Template::<$count>($text) };
}
pub(crate) use screen;

/// All screens.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// The language that they are in.
    pub language: Language,
    pub about: AboutWords,
    pub access: AccessWords,
    pub action: ActionWords,
    pub calibration: CalibrationWords,
    pub calibration_names: CalibrationNames,
    pub device: DeviceWords,
    pub drive: DriveWords,
    pub evidence: EvidenceWords,
    pub frame: FrameWords,
    pub health: HealthWords,
    pub history: HistoryWords,
    pub home: HomeWords,
    pub learnt: LearntWords,
    pub log: LogWords,
    pub map: MapWords,
    pub matter: MatterWords,
    pub mix: MixWords,
    pub notice: NoticeWords,
    pub offer: OfferWords,
    pub schedule: ScheduleWords,
    pub software: SoftwareWords,
    pub state: StateWords,
    pub status: StatusWords,
    pub system: SystemWords,
    pub unit: UnitWords,
}

impl Words {
    /// A number with so many decimals, as the language writes it.
    #[must_use]
    pub fn number(&self, value: f64, decimals: usize) -> String {
        let text = format!("{value:.decimals$}");
        match self.language {
            Language::English => text,
            Language::Estonian => text.replace('.', ","),
        }
    }
}

macro_rules! all_screens {
    ($language:ident, $which:ident) => {
        Words {
            language: Language::$language,
            about: AboutWords::$which,
            access: AccessWords::$which,
            action: ActionWords::$which,
            calibration: CalibrationWords::$which,
            calibration_names: CalibrationNames::$which,
            device: DeviceWords::$which,
            drive: DriveWords::$which,
            evidence: EvidenceWords::$which,
            frame: FrameWords::$which,
            health: HealthWords::$which,
            history: HistoryWords::$which,
            home: HomeWords::$which,
            learnt: LearntWords::$which,
            log: LogWords::$which,
            map: MapWords::$which,
            matter: MatterWords::$which,
            mix: MixWords::$which,
            notice: NoticeWords::$which,
            offer: OfferWords::$which,
            schedule: ScheduleWords::$which,
            software: SoftwareWords::$which,
            state: StateWords::$which,
            status: StatusWords::$which,
            system: SystemWords::$which,
            unit: UnitWords::$which,
        }
    };
}

static ENGLISH: Words = all_screens!(English, ENGLISH);
static ESTONIAN: Words = all_screens!(Estonian, ESTONIAN);
