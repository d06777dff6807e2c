//! What a job says of itself: power and pattern, which override the settings of the rooms.

use rvac_api::{CleaningPattern, CleaningPower, JobOrder};

use crate::figures::percent_text;
use crate::room_settings::pattern_text;
use crate::words::Words;

/// What a job says of itself; what is absent is as set for the rooms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobSettings {
    power: Option<CleaningPower>,
    pattern: Option<CleaningPattern>,
}

/// A choice that a person is offered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SettingChoice {
    /// By which it is chosen.
    pub code: &'static str,
    /// For people.
    pub text: String,
    /// It is the present one.
    pub is_chosen: bool,
}

/// As is set for the rooms.
const AS_ROOMS: &str = "";
/// A power that none of the levels is: another client has said it.
const OTHER: &str = "other";

/// Levels of power by their codes.
const LEVELS: [(&str, CleaningPower); 3] = [
    ("quiet", CleaningPower::QUIET),
    ("normal", CleaningPower::NORMAL),
    ("full", CleaningPower::FULL),
];

impl JobSettings {
    /// Those of an order.
    #[must_use]
    pub const fn of(order: &JobOrder) -> Self {
        Self {
            power: order.power,
            pattern: order.pattern,
        }
    }

    /// The order with these.
    #[must_use]
    pub fn said_by(self, order: JobOrder) -> JobOrder {
        JobOrder {
            power: self.power,
            pattern: self.pattern,
            ..order
        }
    }

    /// The levels of power; another value is listed among them.
    #[must_use]
    pub fn powers(&self, words: &Words) -> Vec<SettingChoice> {
        let known = LEVELS.iter().any(|(_, power)| Some(*power) == self.power);
        let choice = |code, text: &str, is_chosen| SettingChoice {
            code,
            text: text.to_owned(),
            is_chosen,
        };
        let mut choices = vec![choice(AS_ROOMS, words.home.as_rooms, self.power.is_none())];
        for (code, power) in LEVELS {
            choices.push(choice(code, level_text(words, code), self.power == Some(power)));
        }
        if let Some(power) = self.power.filter(|_| !known) {
            choices.push(choice(OTHER, &other_text(words, &power), true));
        }
        choices
    }

    /// Takes a level by its code.
    pub fn choose_power(&mut self, code: &str) {
        match code {
            AS_ROOMS => self.power = None,
            // It stays what it is.
            OTHER => {}
            _ => {
                let level = LEVELS.into_iter().find(|(known, _)| *known == code);
                self.power = level.map(|(_, power)| power);
            }
        }
    }

    /// The patterns.
    #[must_use]
    pub fn patterns(&self, words: &Words) -> Vec<SettingChoice> {
        let as_rooms = SettingChoice {
            code: AS_ROOMS,
            text: words.home.as_rooms.to_owned(),
            is_chosen: self.pattern.is_none(),
        };
        let pattern = |pattern: CleaningPattern| SettingChoice {
            code: pattern.name(),
            text: pattern_text(words, pattern).to_owned(),
            is_chosen: self.pattern == Some(pattern),
        };
        core::iter::once(as_rooms)
            .chain(CleaningPattern::ALL.map(pattern))
            .collect()
    }

    /// Takes a pattern by its code.
    pub fn choose_pattern(&mut self, code: &str) {
        self.pattern = CleaningPattern::from_name(code);
    }

    /// What it says, in few words each.
    #[must_use]
    pub fn texts(&self, words: &Words) -> Vec<String> {
        let told = |choice: SettingChoice| {
            let is_said = choice.is_chosen && choice.code != AS_ROOMS;
            is_said.then(|| choice.text.to_lowercase())
        };
        let choices = self.powers(words).into_iter().chain(self.patterns(words));
        choices.filter_map(told).collect()
    }
}

fn level_text(words: &Words, code: &str) -> &'static str {
    match code {
        "quiet" => words.home.level_quiet,
        "normal" => words.home.level_normal,
        _ => words.home.level_full,
    }
}

fn other_text(words: &Words, power: &CleaningPower) -> String {
    let percent = |share| percent_text(words, share);
    words.home.level_other.fill([
        &percent(power.suction),
        &percent(power.main_brush),
        &percent(power.side_brushes),
    ])
}

#[cfg(test)]
mod tests {
    use super::JobSettings;
    use crate::words::{Language, Words};
    use rvac_api::{CleaningPattern, CleaningPower, JobOrder};

    const ENGLISH: &Words = Language::English.words();

    #[test]
    fn what_is_chosen_stands_in_the_order_and_is_shown() {
        let mut settings = JobSettings::default();
        assert_eq!(settings.said_by(JobOrder::default()), JobOrder::default());
        assert!(settings.texts(ENGLISH).is_empty());
        settings.choose_power("quiet");
        settings.choose_pattern("contour");
        let order = settings.said_by(JobOrder::default());
        assert_eq!(
            (order.power, order.pattern),
            (Some(CleaningPower::QUIET), Some(CleaningPattern::Contour))
        );
        assert_eq!(settings.texts(ENGLISH), ["quiet", "along the walls"]);
        assert_eq!(JobSettings::of(&order), settings);
        settings.choose_power("");
        settings.choose_pattern("");
        assert_eq!(settings, JobSettings::default());
    }

    #[test]
    fn a_power_that_is_no_level_is_shown_and_stays() {
        let power = CleaningPower {
            suction: 0.3,
            ..CleaningPower::FULL
        };
        let mut settings = JobSettings::of(&JobOrder {
            power: Some(power),
            ..JobOrder::default()
        });
        let chosen = settings
            .powers(ENGLISH)
            .into_iter()
            .find(|choice| choice.is_chosen);
        let chosen = chosen.expect("one is chosen");
        assert!(chosen.text.contains("30"), "{chosen:?}");
        settings.choose_power(chosen.code);
        assert_eq!(settings.said_by(JobOrder::default()).power, Some(power));
    }
}
