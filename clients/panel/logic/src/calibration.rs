//! The pages of a calibration in words.

use rvac_api::{CalibrationAsk, CalibrationPage, CalibrationValue, Lacking};

use crate::words::Words;

/// A value as people call it; one that a newer robot has keeps its own name.
#[must_use]
pub fn calibration_name(words: &Words, name: &str) -> String {
    let names = &words.calibration_names;
    match name {
        "wheel-distance-per-count" => names.wheel_distance_per_count,
        "wheel-track" => names.wheel_track,
        "wheel-left-order" => names.wheel_left_order,
        "wheel-right-order" => names.wheel_right_order,
        "wheel-dead-band" => names.wheel_dead_band,
        "wheel-free-speed" => names.wheel_free_speed,
        "wheel-left-current-zero" => names.wheel_left_current_zero,
        "wheel-right-current-zero" => names.wheel_right_current_zero,
        "wheel-current-scale" => names.wheel_current_scale,
        "wheel-stall-current" => names.wheel_stall_current,
        "brush-main-pulse-rate" => names.brush_main_pulse_rate,
        "brush-main-dead-band" => names.brush_main_dead_band,
        "button-ladder-1" => names.button_ladder_1,
        "button-ladder-2" => names.button_ladder_2,
        "button-ladder-3" => names.button_ladder_3,
        "cliff-emitter-line" => names.cliff_emitter_line,
        "cliff-floor-level" => names.cliff_floor_level,
        "cliff-drop-level" => names.cliff_drop_level,
        "proximity-none" => names.proximity_none,
        "proximity-touching" => names.proximity_touching,
        "battery-scale" => names.battery_scale,
        "charge-current-zero" => names.charge_current_zero,
        "battery-capacity" => names.battery_capacity,
        "charge-stage-checked" => names.charge_stage_checked,
        "dock-code-ones" => names.dock_code_ones,
        "dock-beam-left" => names.dock_beam_left,
        "dock-beam-right" => names.dock_beam_right,
        "dock-beam-near" => names.dock_beam_near,
        "dock-beam-short" => names.dock_beam_short,
        "gyro-uart" => names.gyro_uart,
        "gyro-rate" => names.gyro_rate,
        "gyro-frame" => names.gyro_frame,
        "thermistor-ice" => names.thermistor_ice,
        "thermistor-warm" => names.thermistor_warm,
        "thermistor-warm-temperature" => names.thermistor_warm_temperature,
        "thermistor-checked" => names.thermistor_checked,
        other => other,
    }
    .to_owned()
}

/// A value as people read it, with its unit; a plain number has none. Firmware keeps whole numbers, and people have measures in
/// millimetres.
#[must_use]
pub fn measured_text(words: &Words, value: i64, unit: &str) -> String {
    let scaled = |parts: f64, decimals| words.number(value as f64 / parts, decimals);
    let (number, unit) = match unit {
        "1" => return value.to_string(),
        "nm" => (scaled(1e6, 4), "mm"),
        "um" => (scaled(1e3, 1), "mm"),
        "permille" => (scaled(10.0, 1), "%"),
        "uA/count" => (scaled(1e3, 3), "mA"),
        "uV/count" => (scaled(1e3, 3), "mV"),
        "count/10" => (scaled(10.0, 1), ""),
        "count/100" => (scaled(100.0, 2), ""),
        "degree/10" => (scaled(10.0, 1), "°C"),
        "us" => (value.to_string(), "µs"),
        "count" => (value.to_string(), ""),
        unit => (value.to_string(), unit),
    };
    format!("{number}\u{a0}{unit}").trim_end().to_owned()
}

/// What is known of a value.
#[must_use]
pub fn value_state(words: &Words, known: &CalibrationValue) -> String {
    let texts = &words.calibration;
    match (known.value, known.assumed) {
        (Some(value), _) => measured_text(words, value, &known.unit),
        (None, Some(assumed)) => texts.assumed.fill([&measured_text(words, assumed, &known.unit)]),
        (None, None) => texts.not_measured.to_owned(),
    }
}

/// What the robot lacks, in one list.
#[must_use]
pub fn lacking_text(words: &Words, lacking: &[Lacking]) -> Option<String> {
    let texts = &words.calibration;
    let named: Vec<&str> = lacking
        .iter()
        .map(|one| match one.ability.as_str() {
            "drive" => texts.drive,
            "cliffs" => texts.cliffs,
            "proximity" => texts.proximity,
            "gyro" => texts.gyro,
            "wheel-currents" => texts.wheel_currents,
            "charging" => texts.charging,
            "dock-beams" => texts.dock_beams,
            other => other,
        })
        .collect();
    (!named.is_empty()).then(|| texts.lacks.fill([&named.join(", ")]))
}

/// What a page asks a person to do, or to read off.
#[must_use]
pub fn task_text(words: &Words, page: &CalibrationPage) -> Option<String> {
    let texts = &words.calibration;
    let text = match page.task.as_deref() {
        Some("push") => texts.push,
        Some("spin") => texts.spin,
        Some("roll-left") => texts.roll_left,
        Some("roll-right") => texts.roll_right,
        Some("light-floor") => texts.light_floor,
        Some("dark-floor") => texts.dark_floor,
        Some("drop") => texts.drop,
        Some("free-front") => texts.free_front,
        Some("paper") => return Some(texts.paper.fill([&page.sensor.unwrap_or(1)])),
        Some("hold-wheel-read") => texts.hold_wheel_read,
        Some("hold-wheel") => texts.hold_wheel,
        Some("distance-mm") => texts.distance_mm,
        Some("at-rest-ma") => texts.at_rest_ma,
        Some("pulled-ma") => texts.pulled_ma,
        Some("pack-mv") => texts.pack_mv,
        Some("room-dc") => texts.room_dc,
        Some("value") => return Some(texts.value.fill([&page.unit])),
        _ if page.asks == Some(CalibrationAsk::Ready) => preparation(words, &page.value)?,
        _ => return None,
    };
    Some(text.to_owned())
}

/// What is to be prepared for a value that is read without any further word.
fn preparation(words: &Words, value: &str) -> Option<&'static str> {
    let texts = &words.calibration;
    match value {
        "button-ladder-1" | "button-ladder-2" | "button-ladder-3" => Some(texts.button),
        "wheel-left-current-zero" | "wheel-right-current-zero" | "charge-current-zero" => Some(texts.still),
        "thermistor-ice" => Some(texts.ice),
        "thermistor-warm" => Some(texts.warm),
        _ => None,
    }
}

/// What a person must know beforehand, if something moves by itself.
#[must_use]
pub fn danger_text(words: &Words, page: &CalibrationPage) -> Option<&'static str> {
    let texts = &words.calibration;
    match page.danger.as_deref()? {
        "moves" => Some(texts.moves),
        "pulls" => Some(texts.pulls),
        _ => Some(texts.brush),
    }
}

/// What is read at the moment.
#[must_use]
pub fn live_text(words: &Words, page: &CalibrationPage) -> Option<String> {
    let texts = &words.calibration;
    if let Some([left, right]) = page.counts {
        return Some(texts.counts.fill([&left, &right]));
    }
    if let Some(permille) = page.permille {
        return Some(texts.duty.fill([&permille]));
    }
    page.reading.map(|reading| texts.reading.fill([&reading]))
}

/// Whether the motors run or are about to: the button that is held is shown.
#[must_use]
pub fn is_held(page: &CalibrationPage) -> bool {
    page.asks == Some(CalibrationAsk::Hold) || page.permille.is_some()
}

#[cfg(test)]
mod tests {
    use super::{calibration_name, is_held, lacking_text, live_text, measured_text, task_text, value_state};
    use crate::words::Language;
    use rvac_api::{CalibrationAsk, CalibrationPage, CalibrationValue, Lacking};

    #[test]
    fn a_page_says_what_to_do_in_the_language_of_the_page() {
        let page = CalibrationPage {
            asks: Some(CalibrationAsk::Done),
            task: Some("paper".to_owned()),
            sensor: Some(3),
            ..CalibrationPage::default()
        };
        let text = task_text(Language::Estonian.words(), &page).expect("a task");
        assert!(text.contains("3. andurit"), "{text}");
        let held = CalibrationPage {
            value: "button-ladder-2".to_owned(),
            asks: Some(CalibrationAsk::Ready),
            ..CalibrationPage::default()
        };
        let text = task_text(Language::English.words(), &held).expect("to be prepared");
        assert!(text.starts_with("Hold this button"), "{text}");
    }

    #[test]
    fn values_say_whether_they_were_measured() {
        let words = Language::English.words();
        let mut known = CalibrationValue {
            unit: "uV/count".to_owned(),
            assumed: Some(32_549),
            ..CalibrationValue::default()
        };
        assert_eq!(
            value_state(words, &known),
            "not measured, taken as 32.549\u{a0}mV"
        );
        known.value = Some(32_600);
        assert_eq!(value_state(words, &known), "32.600\u{a0}mV");
        for (value, unit, english, estonian) in [
            (497_252, "nm", "0.4973\u{a0}mm", "0,4973\u{a0}mm"),
            (229_940, "um", "229.9\u{a0}mm", "229,9\u{a0}mm"),
            (125, "permille", "12.5\u{a0}%", "12,5\u{a0}%"),
            (8_517, "count/10", "851.7", "851,7"),
            (6, "1", "6", "6"),
            (480, "mm/s", "480\u{a0}mm/s", "480\u{a0}mm/s"),
        ] {
            assert_eq!(measured_text(words, value, unit), english);
            assert_eq!(measured_text(Language::Estonian.words(), value, unit), estonian);
        }
        assert_eq!(calibration_name(words, "of-a-newer-robot"), "of-a-newer-robot");
    }

    #[test]
    fn what_is_lacking_is_one_sentence() {
        let words = Language::English.words();
        assert_eq!(lacking_text(words, &[]), None);
        let lacking = ["drive", "cliffs"].map(|ability| Lacking {
            ability: ability.to_owned(),
            values: Vec::new(),
        });
        let text = lacking_text(words, &lacking);
        assert_eq!(
            text.as_deref(),
            Some("Missing until they are measured: driving, seeing stairs.")
        );
    }

    #[test]
    fn the_button_stays_while_motors_are_tried() {
        let duty = CalibrationPage {
            permille: Some(150),
            ..CalibrationPage::default()
        };
        assert!(is_held(&duty));
        assert_eq!(
            live_text(Language::English.words(), &duty).as_deref(),
            Some("Power 150 per mille")
        );
        assert!(!is_held(&CalibrationPage::default()));
    }
}
