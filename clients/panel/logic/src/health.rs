//! How worn or dirty parts are, as rows.

use rvac_api::ComponentHealth;

use crate::words::Words;

/// A part whose load is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartRow {
    /// As the robot names it.
    pub component: String,
    /// As people do.
    pub name: String,
    /// What its load says.
    pub state: String,
    /// What to do about it; empty when there is nothing to do.
    pub remedy: &'static str,
}

/// The rows, in the order in which the robot lists the parts.
#[must_use]
pub fn part_rows(words: &Words, parts: &[ComponentHealth]) -> Vec<PartRow> {
    parts.iter().map(|part| row(words, part)).collect()
}

fn row(words: &Words, part: &ComponentHealth) -> PartRow {
    let (texts, device) = (&words.health, &words.device);
    let name = match part.component.as_str() {
        "brush-main" => device.main_brush,
        "wheel-left" => device.left_wheel,
        "wheel-right" => device.right_wheel,
        // A part of a newer robot.
        other => other,
    };
    let is_brush = part.component.starts_with("brush");
    let percent = words.number(part.share.unwrap_or(1.0) * 100.0, 0);
    let (state, remedy) = match part.verdict.as_str() {
        "fine" => (texts.fine.fill([&percent]), ""),
        "hard" if is_brush => (texts.hard.fill([&percent]), texts.brush_hard),
        "hard" => (texts.hard.fill([&percent]), texts.wheel_hard),
        "light" if is_brush => (texts.light.fill([&percent]), texts.brush_light),
        "light" => (texts.light.fill([&percent]), texts.wheel_light),
        _ => (texts.learning.fill([&part.minutes]), ""),
    };
    PartRow {
        component: part.component.clone(),
        name: name.to_owned(),
        state,
        remedy,
    }
}

#[cfg(test)]
mod tests {
    use super::part_rows;
    use crate::words::Language;
    use rvac_api::ComponentHealth;

    fn part(component: &str, verdict: &str, share: Option<f64>) -> ComponentHealth {
        ComponentHealth {
            component: component.to_owned(),
            verdict: verdict.to_owned(),
            minutes: 4,
            share,
            ..ComponentHealth::default()
        }
    }

    #[test]
    fn each_verdict_has_its_words_and_only_bad_ones_a_remedy() {
        let parts = [
            part("brush-main", "hard", Some(1.62)),
            part("wheel-left", "light", Some(0.5)),
            part("wheel-right", "learning", None),
        ];
        let rows = part_rows(Language::English.words(), &parts);
        assert_eq!(rows[0].state, "runs hard: 162\u{a0}%");
        assert!(rows[0].remedy.contains("hair"));
        assert!(rows[1].remedy.contains("tyre"));
        assert!(rows[2].state.contains("4 of 10") && rows[2].remedy.is_empty());
        let fine = part_rows(
            Language::Estonian.words(),
            &[part("brush-main", "fine", Some(1.0))],
        );
        assert_eq!((fine[0].name.as_str(), fine[0].remedy), ("Põhihari", ""));
    }
}
