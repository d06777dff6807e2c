//! What robots have learnt of themselves, as rows.

use rvac_api::{EnergyLearnt, GyroLearnt, LearntPart, LearntView};

use crate::words::Words;

/// A robot of which something is kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LearntRobot {
    /// As the robot is named.
    pub device: String,
    /// It is the one that is attached.
    pub is_here: bool,
    /// When it learnt last, seconds since 1970.
    pub learnt_s: Option<i64>,
    /// What is known.
    pub rows: Vec<LearntRow>,
}

/// A part of its calibration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LearntRow {
    /// As the robot names it.
    pub part: LearntPart,
    /// As people do.
    pub name: &'static str,
    /// What is known, and how surely.
    pub words: String,
    /// What forgetting means, said before it is done.
    pub question: &'static str,
}

/// The robots, the attached one first, then the one that learnt last.
#[must_use]
pub fn learnt_robots(words: &Words, devices: &[LearntView]) -> Vec<LearntRobot> {
    let mut robots: Vec<LearntRobot> = devices.iter().rev().map(|view| robot(words, view)).collect();
    robots.sort_by_key(|robot| !robot.is_here);
    robots
}

fn robot(words: &Words, view: &LearntView) -> LearntRobot {
    let texts = &words.learnt;
    let gyro = view.gyro.as_ref().map(|gyro| LearntRow {
        part: LearntPart::Gyro,
        name: texts.gyro,
        words: gyro_text(words, gyro),
        question: texts.ask_gyro,
    });
    let pack = view.energy.as_ref().map(|energy| LearntRow {
        part: LearntPart::Energy,
        name: texts.pack,
        words: energy_text(words, energy),
        question: texts.ask_pack,
    });
    LearntRobot {
        device: view.device.clone(),
        is_here: view.here,
        learnt_s: view.learnt_s,
        rows: gyro.into_iter().chain(pack).collect(),
    }
}

fn gyro_text(words: &Words, gyro: &GyroLearnt) -> String {
    let texts = &words.learnt;
    let scale = if gyro.scale < 0.0 {
        texts.too_much
    } else {
        texts.too_little
    };
    let percent = |share: f64| words.number(100.0 * share.abs(), 2);
    let scale = scale.fill([&percent(gyro.scale), &percent(gyro.scale_sigma)]);
    let bias_deg_per_min = 60.0 * gyro.bias_rad_per_s.to_degrees();
    let bias = texts.bias.fill([&words.number(bias_deg_per_min, 1)]);
    format!("{scale}; {bias}")
}

fn energy_text(words: &Words, energy: &EnergyLearnt) -> String {
    let percent = |share: f64| words.number(100.0 * share, 0);
    words.learnt.energy.fill([
        &percent(energy.cleaning_per_h),
        &percent(energy.driving_per_h),
        &words.number(energy.seen_s / 60.0, 0),
    ])
}

#[cfg(test)]
mod tests {
    use super::learnt_robots;
    use crate::words::Language;
    use rvac_api::{EnergyLearnt, GyroLearnt, LearntPart, LearntView};

    fn views() -> [LearntView; 2] {
        [
            LearntView {
                device: "sr8730".to_owned(),
                here: true,
                gyro: Some(GyroLearnt {
                    scale: -0.012,
                    scale_sigma: 0.001,
                    bias_rad_per_s: -0.0001,
                }),
                learnt_s: Some(1_800_000_000),
                ..LearntView::default()
            },
            LearntView {
                device: "relax".to_owned(),
                energy: Some(EnergyLearnt {
                    cleaning_per_h: 0.9,
                    driving_per_h: 0.3,
                    seen_s: 600.0,
                }),
                ..LearntView::default()
            },
        ]
    }

    #[test]
    fn the_attached_robot_comes_first_and_each_part_says_how_surely_it_is_known() {
        let robots = learnt_robots(Language::English.words(), &views());
        let names: Vec<&str> = robots.iter().map(|robot| robot.device.as_str()).collect();
        assert_eq!(names, ["sr8730", "relax"]);
        assert!(robots[0].is_here && !robots[1].is_here);
        let [gyro] = robots[0].rows.as_slice() else {
            panic!("{robots:?}");
        };
        assert_eq!(
            (gyro.part, gyro.words.as_str()),
            (
                LearntPart::Gyro,
                "counts 1.20\u{a0}% too much, ± 0.10\u{a0}%; turns -0.3° a minute at rest"
            )
        );
        let [pack] = robots[1].rows.as_slice() else {
            panic!("{robots:?}");
        };
        assert!(pack.words.contains("90\u{a0}%") && pack.words.contains("10\u{a0}min"));
        assert!(pack.question.contains("battery"));
    }

    #[test]
    fn what_counts_too_little_says_so_in_every_language() {
        let [mut robot, _] = views();
        robot.gyro.as_mut().expect("has one").scale = 0.012;
        for (language, words) in [
            (Language::English, "counts 1.20\u{a0}% too little"),
            (Language::Estonian, "loeb 1,20\u{a0}% liiga vähe"),
        ] {
            let robots = learnt_robots(language.words(), &[robot.clone()]);
            let told = &robots[0].rows[0].words;
            assert!(told.starts_with(words), "{told}");
        }
    }
}
