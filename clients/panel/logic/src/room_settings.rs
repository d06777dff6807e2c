//! How a room is cleaned, as a person edits it.

use rvac_api::{CleaningPattern, CleaningPower, RobotDescription, RoomSettings};

use crate::figures::percent_text;
use crate::words::Words;

/// A part of the robot whose power a room can set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PowerPart {
    /// Suction.
    Suction,
    /// The main brush.
    MainBrush,
    /// The side brushes.
    SideBrushes,
}

impl PowerPart {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Suction, Self::MainBrush, Self::SideBrushes];

    /// Those that a robot has; all while that is unknown.
    #[must_use]
    pub fn of(robot: Option<&RobotDescription>) -> Vec<Self> {
        let has =
            |part: &Self| robot.is_none_or(|robot| robot.parts.iter().any(|known| known == part.code()));
        Self::ALL.into_iter().filter(has).collect()
    }

    /// As the robot's description names it.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::Suction => "vacuum",
            Self::MainBrush => "brush-main",
            Self::SideBrushes => "brush-sides",
        }
    }

    /// For people.
    #[must_use]
    pub const fn name(self, words: &Words) -> &'static str {
        match self {
            Self::Suction => words.home.set_suction,
            Self::MainBrush => words.home.set_main_brush,
            Self::SideBrushes => words.home.set_side_brushes,
        }
    }

    /// Its share, 0..=1.
    #[must_use]
    pub const fn share(self, power: &CleaningPower) -> f64 {
        match self {
            Self::Suction => power.suction,
            Self::MainBrush => power.main_brush,
            Self::SideBrushes => power.side_brushes,
        }
    }

    /// Sets its share in whole percent.
    pub fn set(self, power: &mut CleaningPower, percent: u8) {
        let share = f64::from(percent.min(100)) / 100.0;
        match self {
            Self::Suction => power.suction = share,
            Self::MainBrush => power.main_brush = share,
            Self::SideBrushes => power.side_brushes = share,
        }
    }
}

/// `, 2 times, suction 50 %, along the walls`: what is not as usual.
#[must_use]
pub fn room_settings_text(words: &Words, settings: &RoomSettings) -> String {
    let passes = if settings.passes > 1 {
        words.home.with_passes.fill([&settings.passes])
    } else {
        String::new()
    };
    let power = |part: PowerPart| {
        let share = part.share(&settings.power);
        let is_usual = share >= 1.0;
        let name = part.name(words).to_lowercase();
        (!is_usual).then(|| format!(", {name} {}", percent_text(words, share)))
    };
    let shares: String = PowerPart::ALL.into_iter().filter_map(power).collect();
    let pattern = match settings.pattern {
        CleaningPattern::Lines => String::new(),
        CleaningPattern::Contour => format!(", {}", pattern_text(words, settings.pattern).to_lowercase()),
    };
    passes + &shares + &pattern
}

/// A pattern for people.
#[must_use]
pub const fn pattern_text(words: &Words, pattern: CleaningPattern) -> &'static str {
    match pattern {
        CleaningPattern::Lines => words.home.pattern_lines,
        CleaningPattern::Contour => words.home.pattern_contour,
    }
}

#[cfg(test)]
mod tests {
    use super::{PowerPart, room_settings_text};
    use crate::words::Language;
    use rvac_api::{CleaningPattern, RobotDescription, RoomSettings};

    #[test]
    fn what_is_not_as_usual_is_shown() {
        let words = Language::English.words();
        let mut settings = RoomSettings::default();
        assert_eq!(room_settings_text(words, &settings), "");
        settings.passes = 2;
        PowerPart::Suction.set(&mut settings.power, 50);
        PowerPart::SideBrushes.set(&mut settings.power, 0);
        let text = room_settings_text(words, &settings);
        assert!(
            text.starts_with(", 2 times, suction 50") && text.contains("side brushes 0"),
            "{text}"
        );
        settings.pattern = CleaningPattern::Contour;
        assert!(room_settings_text(words, &settings).ends_with(", along the walls"));
        PowerPart::MainBrush.set(&mut settings.power, 200);
        assert!(
            (settings.power.main_brush - 1.0).abs() < 1e-12,
            "no more than all"
        );
    }

    #[test]
    fn a_robot_without_a_part_is_not_offered_its_power() {
        let robot = RobotDescription {
            device: "sr8730".to_owned(),
            radius_m: 0.175,
            swath_m: 0.3,
            speed_max_m_per_s: 0.3,
            turn_max_rad_per_s: 2.0,
            proximity: 7,
            parts: vec!["gyro".to_owned(), "vacuum".to_owned()],
            unguarded: Vec::new(),
            unmeasured: Vec::new(),
            lacking: Vec::new(),
        };
        assert_eq!(PowerPart::of(Some(&robot)), [PowerPart::Suction]);
        assert_eq!(PowerPart::of(None), PowerPart::ALL);
    }
}
