//! How worn or dirty parts are, as rows.

use rvac_api::{ComponentHealth, PartCare, PartHours};

use crate::words::Words;

/// A part whose load is measured, or whose hours are counted.
#[derive(Clone, Debug, PartialEq)]
pub struct PartRow {
    /// As the robot names it.
    pub component: String,
    /// As people do.
    pub name: String,
    /// What its load says; `None` where none is measured.
    pub load: Option<String>,
    /// Its hours.
    pub hours: Option<HoursRow>,
    /// What to do about it; empty when there is nothing to do.
    pub remedy: &'static str,
}

/// The hours of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct HoursRow {
    /// Worked, of how many.
    pub words: String,
    /// The same as a share, 0..=1.
    pub share: f64,
    /// It has worked for as long as such parts usually do.
    pub is_due: bool,
    /// What a person says when it is done.
    pub done: &'static str,
    /// The same with the name of the part, for those who only hear it.
    pub done_named: String,
    /// What is said then, with a way back.
    pub was_done: String,
    /// When it was done last, seconds since 1970.
    pub since_s: Option<i64>,
}

/// The rows, in the order in which the robot lists the parts. On a robot that measures no currents, only those with hours.
#[must_use]
pub fn part_rows(words: &Words, parts: &[ComponentHealth], measures: bool) -> Vec<PartRow> {
    let shown = parts.iter().filter(|part| measures || part.hours.is_some());
    shown.map(|part| row(words, part, measures)).collect()
}

fn row(words: &Words, part: &ComponentHealth, measures: bool) -> PartRow {
    let (texts, device) = (&words.health, &words.device);
    let name = match part.component.as_str() {
        "brush-main" => device.main_brush,
        "brush-sides" => device.side_brushes,
        "filter" => texts.filter,
        "sensors" => device.sensors,
        "wheel-left" => device.left_wheel,
        "wheel-right" => device.right_wheel,
        // A part of a newer robot.
        other => other,
    };
    let (load, load_remedy) = load(words, part);
    let is_due = part.hours.is_some_and(|hours| hours.is_due());
    let remedy = match part.component.as_str() {
        _ if !load_remedy.is_empty() => load_remedy,
        "brush-main" if is_due => texts.brush_due,
        "brush-sides" if is_due => texts.sides_due,
        "filter" if is_due => texts.filter_due,
        "sensors" if is_due => texts.sensors_due,
        _ => "",
    };
    PartRow {
        component: part.component.clone(),
        name: name.to_owned(),
        load: load.filter(|_| measures),
        hours: part.hours.map(|hours| hours_row(words, name, hours)),
        remedy,
    }
}

fn load(words: &Words, part: &ComponentHealth) -> (Option<String>, &'static str) {
    let texts = &words.health;
    let is_brush = part.component.starts_with("brush");
    let percent = words.number(part.share.unwrap_or(1.0) * 100.0, 0);
    let (state, remedy) = match part.verdict.as_str() {
        "unmeasured" => return (None, ""),
        "fine" => (texts.fine.fill([&percent]), ""),
        "hard" if is_brush => (texts.hard.fill([&percent]), texts.brush_hard),
        "hard" => (texts.hard.fill([&percent]), texts.wheel_hard),
        "light" if is_brush => (texts.light.fill([&percent]), texts.brush_light),
        "light" => (texts.light.fill([&percent]), texts.wheel_light),
        _ => (texts.learning.fill([&part.minutes]), ""),
    };
    (Some(state), remedy)
}

fn hours_row(words: &Words, name: &str, hours: PartHours) -> HoursRow {
    let texts = &words.health;
    let (done, done_named, was_done) = match hours.care {
        PartCare::Replace => (texts.replaced, texts.replaced_named, texts.was_replaced),
        PartCare::Clean => (texts.cleaned, texts.cleaned_named, texts.was_cleaned),
    };
    let decimals = usize::from((0.05..10.0).contains(&hours.worked_h));
    let worked = words.number(hours.worked_h, decimals);
    HoursRow {
        words: texts.hours.fill([&worked, &words.number(hours.usual_h, 0)]),
        share: (hours.worked_h / hours.usual_h.max(1.0)).clamp(0.0, 1.0),
        is_due: hours.is_due(),
        done,
        done_named: done_named.fill([&name]),
        was_done: was_done.fill([&name]),
        since_s: hours.since_s,
    }
}

#[cfg(test)]
mod tests {
    use super::part_rows;
    use crate::words::Language;
    use rvac_api::{ComponentHealth, PartCare, PartHours};

    fn part(component: &str, verdict: &str, share: Option<f64>) -> ComponentHealth {
        ComponentHealth {
            component: component.to_owned(),
            verdict: verdict.to_owned(),
            minutes: 4,
            share,
            ..ComponentHealth::default()
        }
    }

    fn hourly(component: &str, worked_h: f64, care: PartCare) -> ComponentHealth {
        ComponentHealth {
            hours: Some(PartHours {
                worked_h,
                usual_h: 30.0,
                care,
                ..PartHours::default()
            }),
            ..part(component, "unmeasured", None)
        }
    }

    #[test]
    fn each_verdict_has_its_words_and_only_bad_ones_a_remedy() {
        let parts = [
            part("brush-main", "hard", Some(1.62)),
            part("wheel-left", "light", Some(0.5)),
            part("wheel-right", "learning", None),
        ];
        let rows = part_rows(Language::English.words(), &parts, true);
        assert_eq!(rows[0].load.as_deref(), Some("runs hard: 162\u{a0}%"));
        assert!(rows[0].remedy.contains("hair"));
        assert!(rows[1].remedy.contains("tyre"));
        assert!(rows[2].load.as_ref().unwrap().contains("4 of 10") && rows[2].remedy.is_empty());
        let fine = part_rows(
            Language::Estonian.words(),
            &[part("brush-main", "fine", Some(1.0))],
            true,
        );
        assert_eq!((fine[0].name.as_str(), fine[0].remedy), ("Põhihari", ""));
    }

    #[test]
    fn what_only_has_hours_is_due_after_them_and_stands_alone_without_measured_loads() {
        let parts = [
            part("wheel-left", "learning", None),
            hourly("filter", 4.25, PartCare::Replace),
            hourly("sensors", 30.0, PartCare::Clean),
        ];
        let rows = part_rows(Language::English.words(), &parts, false);
        assert_eq!(rows.len(), 2, "a wheel without a load has nothing to say");
        let filter = rows[0].hours.as_ref().unwrap();
        assert_eq!(filter.words, "4.2 of about 30 hours of work");
        assert!(!filter.is_due && rows[0].remedy.is_empty() && rows[0].load.is_none());
        assert_eq!(filter.done, "Mark as replaced");
        let sensors = rows[1].hours.as_ref().unwrap();
        assert!(sensors.is_due && rows[1].remedy.contains("dry cloth"));
        assert_eq!((sensors.done, sensors.share), ("Mark as cleaned", 1.0));
        let estonian = part_rows(Language::Estonian.words(), &parts, true);
        assert_eq!(
            estonian[1].hours.as_ref().unwrap().words,
            "töötanud 4,2 tundi umbes 30-st"
        );
    }
}
