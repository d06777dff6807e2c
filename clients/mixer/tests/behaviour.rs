//! What single settings do, and what is said about profiles that are wrong.

use mixer::{
    Calibration, Condition, KeyCode, Line, Mix, MixState, Mixed, Mixer, Name, Output, OutputName, PadReading,
    Press, Profile, ProfileError, Readings, Source, Switch, VERSION, Wish, standard_profile,
};

const STEP_US: u64 = 20_000;

/// Forward by these lines alone.
fn forward_by(lines: &str) -> Profile {
    let text = format!(
        r#"{{"version":1,"name":"one","switches":[{{"name":"a","on":{{"above":{{"input":"pad-0-button-4","level":0.5}}}}}}],
        "outputs":[{{"output":"forward","low":-1,"high":1,"lines":[{lines}]}}]}}"#
    );
    Profile::parse(&text).expect("a profile")
}

#[test]
fn a_line_that_is_switched_off_is_off_at_once_and_one_at_rest_runs_down() {
    let line = r#"{"name":"slow","input":"pad-0-axis-0","when":"a","slow-down-per-s":0.5}"#;
    let mut hands = Hands::on(forward_by(line));
    hands.button(4, 1.0);
    assert_eq!(hands.axis(0, 1.0).outputs[0].value, 1.0);
    let down = hands.axis(0, 0.0);
    assert!(
        (down.outputs[0].value - 0.99).abs() < 1e-9 && down.held,
        "{down:?}"
    );
    assert_eq!(hands.axis(0, 1.0).outputs[0].value, 1.0);
    let off = hands.button(4, 0.0);
    assert!(off.outputs[0].value == 0.0 && !off.held, "{off:?}");
}

#[test]
fn what_a_replacing_line_leaves_behind_is_taken_up_slowly() {
    let lines = r#"{"name":"base","input":"pad-0-axis-0","slow-up-per-s":0.5},
        {"name":"creep","input":"pad-0-axis-1","mix":"replace","when":"a"}"#;
    let mut hands = Hands::on(forward_by(lines));
    hands.axis(1, 0.0);
    hands.axis(0, 0.9);
    for _ in 0..200 {
        hands.step();
    }
    hands.axis(1, 0.2);
    assert_eq!(hands.button(4, 1.0).outputs[0].value, 0.2);
    let mut before = 0.2;
    hands.button(4, 0.0);
    for _ in 0..100 {
        let value = hands.step().outputs[0].value;
        assert!(
            value - before <= 0.5 * 0.02 + 0.01 + 1e-9,
            "{before} to {value} at once"
        );
        before = value;
    }
    assert!((before - 0.9).abs() < 1e-9, "{before}");
}

#[test]
fn a_second_pad_stops_with_the_same_button() {
    let mut hands = Hands::on(standard_profile());
    let pad = |pressed: f64| PadReading {
        axes: vec![0.0; 4],
        buttons: [0.0, pressed].into_iter().chain([0.0; 15]).collect(),
        words: 0,
    };
    hands.readings.pads.insert(1, pad(1.0));
    assert_eq!(hands.step().fired, [], "it was down when it came");
    hands.readings.pads.insert(1, pad(0.0));
    hands.step();
    hands.readings.pads.insert(1, pad(1.0));
    assert_eq!(hands.step().fired, [OutputName::Stop]);
    assert_eq!(hands.step().fired, []);
}

#[test]
fn what_is_not_at_rest_is_named_with_its_reading() {
    let mut hands = Hands::on(standard_profile());
    hands.readings.pads.clear();
    hands.step();
    let mut pad = PadReading {
        axes: vec![0.0, 1.28],
        buttons: vec![0.0; 17],
        words: 0,
    };
    hands.readings.pads.insert(0, pad.clone());
    hands.step();
    let waits = hands.step();
    assert_eq!(waits.state, MixState::Failsafe);
    let named: Vec<(String, f64)> = waits
        .away
        .iter()
        .map(|away| (away.input.to_string(), away.reading))
        .collect();
    assert_eq!(named, [("pad-0-axis-1".to_owned(), 1.28)]);
    pad.axes[1] = 0.0;
    hands.readings.pads.insert(0, pad);
    let live = hands.step();
    assert!(live.state == MixState::Live && live.away.is_empty(), "{live:?}");
}

/// Hands on a pad, a keyboard and a stick on the screen.
struct Hands {
    mixer: Mixer,
    now_us: u64,
    readings: Readings,
}

impl Hands {
    fn on(profile: Profile) -> Self {
        let pad = PadReading {
            words: 0,
            axes: vec![0.0; 4],
            buttons: vec![0.0; 17],
        };
        let readings = Readings {
            pads: [(0, pad)].into(),
            keys: Some([].into()),
            touch: Some([0.0, 0.0]),
            tilt: None,
            clients: [].into(),
        };
        let mixer = Mixer::new(profile).expect("a profile");
        let mut hands = Self {
            mixer,
            now_us: 0,
            readings,
        };
        assert_eq!(
            hands.step().state,
            MixState::Failsafe,
            "whoever appears must be seen at rest"
        );
        assert_eq!(hands.step().state, MixState::Live);
        hands
    }

    fn step(&mut self) -> Mixed {
        self.now_us += STEP_US;
        self.mixer.step(self.now_us, &self.readings)
    }

    fn axis(&mut self, axis: usize, value: f64) -> Mixed {
        self.readings.pads.get_mut(&0).expect("a pad").axes[axis] = value;
        self.step()
    }

    fn button(&mut self, button: usize, value: f64) -> Mixed {
        self.readings.pads.get_mut(&0).expect("a pad").buttons[button] = value;
        self.step()
    }
}

fn name(text: &str) -> Name {
    Name::new(text).expect("a name")
}

fn axis(axis: u8) -> Source {
    Source::PadAxis { pad: 0, axis }
}

fn button(button: u8) -> Source {
    Source::PadButton { pad: 0, button }
}

fn forward(lines: Vec<Line>, switches: Vec<Switch>) -> Profile {
    Profile {
        version: VERSION,
        name: name("test"),
        inputs: Vec::new(),
        switches,
        trims: Vec::new(),
        modes: Vec::new(),
        outputs: vec![Output {
            lines,
            ..Output::new(OutputName::Forward)
        }],
    }
}

fn pressed(name_of: &str, number: u8) -> Switch {
    Switch {
        name: name(name_of),
        on: Condition::Above {
            input: button(number),
            level: 0.5,
        },
    }
}

#[test]
fn the_standard_profile_is_right_and_leaves_room() {
    let profile = standard_profile();
    assert_eq!(Profile::parse(&profile.to_json()), Ok(profile.clone()));
    assert!(
        profile.to_json().len() < mixer::PROFILE_BYTES_MAX / 2,
        "{}",
        profile.to_json().len()
    );
}

#[test]
fn a_standard_pad_drives_at_once() {
    let mut hands = Hands::on(standard_profile());
    assert_eq!(hands.axis(1, 0.08).wish(), Wish::default(), "sticks wander");
    let ahead = hands.axis(1, -1.0).wish();
    assert!(ahead.drives && (ahead.axes.forward - 1.0).abs() < 1e-9 && ahead.axes.turn == 0.0);
    let back = hands.axis(1, 1.0).wish();
    assert!((back.axes.forward + 0.5).abs() < 1e-9, "backwards is slower");
    hands.axis(1, 0.0);
    let left = hands.axis(0, -1.0).wish();
    assert!((left.axes.turn - 1.0).abs() < 1e-9, "left is counter-clockwise");
    let slow = hands.button(4, 1.0).wish();
    assert!((slow.axes.turn - 0.4).abs() < 1e-9);
    hands.axis(0, 0.0);
    assert!(!hands.button(4, 0.0).wish().drives);
    let trigger = hands.button(7, 0.6).wish();
    assert!(trigger.drives && (trigger.cleaning.suction - 0.6).abs() < 1e-9 && trigger.axes.forward == 0.0);
    hands.button(7, 0.0);
    for (number, press) in [
        (9, Press::Start),
        (1, Press::Stop),
        (2, Press::Spot),
        (3, Press::Dock),
    ] {
        assert_eq!(hands.button(number, 1.0).wish().presses, [press]);
        assert_eq!(hands.step().wish().presses, []);
        hands.button(number, 0.0);
    }
}

#[test]
fn keys_and_touch_drive_at_once() {
    let mut hands = Hands::on(standard_profile());
    hands.readings.keys = Some(
        ["KeyW", "ArrowLeft"]
            .iter()
            .filter_map(|code| KeyCode::new(code))
            .collect(),
    );
    let wish = hands.step().wish();
    assert!((wish.axes.forward - 0.7).abs() < 1e-9 && (wish.axes.turn - 0.7).abs() < 1e-9);
    hands.readings.keys = Some([].into());
    hands.readings.touch = Some([1.0, 0.0]);
    assert!(
        (hands.step().wish().axes.turn + 1.0).abs() < 1e-9,
        "right is clockwise"
    );
}

#[test]
fn after_a_loss_everything_must_be_let_go_once_and_stop_is_heard() {
    let mut hands = Hands::on(standard_profile());
    assert!(hands.axis(1, -1.0).wish().drives);
    let pads = std::mem::take(&mut hands.readings.pads);
    assert_eq!(hands.step().wish(), Wish::default());
    hands.readings.pads = pads;
    for _ in 0..3 {
        let mixed = hands.step();
        assert_eq!((mixed.state, mixed.wish().drives), (MixState::Failsafe, false));
    }
    hands.button(9, 0.0);
    assert_eq!(hands.button(9, 1.0).fired, [], "nothing starts");
    assert_eq!(hands.button(1, 1.0).fired, [OutputName::Stop]);
    hands.button(9, 0.0);
    hands.button(1, 0.0);
    assert_eq!(hands.axis(1, 0.0).state, MixState::Live);
    assert!(hands.axis(1, -1.0).wish().drives);
}

#[test]
fn a_cleaner_may_go_on_after_a_loss_and_the_wheels_never() {
    let mut profile = standard_profile();
    let suction = profile
        .outputs
        .iter_mut()
        .find(|output| output.output == OutputName::Suction);
    suction.expect("an output").failsafe = 0.5;
    let mut hands = Hands::on(profile);
    hands.axis(1, -1.0);
    hands.readings = Readings::default();
    let wish = hands.step().wish();
    assert!(wish.drives && wish.axes.forward == 0.0 && wish.cleaning.suction == 0.5);
}

#[test]
fn a_delay_waits_for_a_hold_and_never_for_a_release() {
    let line = Line {
        delay_ms: 50,
        ..Line::new(name("late"), axis(0))
    };
    let mut hands = Hands::on(forward(vec![line], Vec::new()));
    let values: Vec<f64> = [1.0, 1.0, 1.0, 1.0, 0.0]
        .map(|value| hands.axis(0, value).outputs[0].value)
        .into();
    assert_eq!(values, [0.0, 0.0, 0.0, 1.0, 0.0]);
}

#[test]
fn switches_join_toggle_stick_and_pulse() {
    let [a, b] = [name("a"), name("b")];
    let conditions = [
        ("both", Condition::All(vec![a.clone(), b.clone()])),
        ("either", Condition::Any(vec![a.clone(), b.clone()])),
        ("neither", Condition::Not(name("either"))),
        ("toggle", Condition::Toggle(a.clone())),
        (
            "sticky",
            Condition::Sticky {
                set: a.clone(),
                reset: b,
            },
        ),
        ("edge", Condition::Edge { of: a, hold_ms: 30 }),
    ];
    let further = conditions.map(|(label, on)| Switch {
        name: name(label),
        on,
    });
    let switches = [pressed("a", 0), pressed("b", 1)]
        .into_iter()
        .chain(further)
        .collect();
    let mut hands = Hands::on(forward(vec![Line::new(name("stick"), axis(0))], switches));
    let seen = |mixed: Mixed| -> String {
        mixed
            .switches
            .iter()
            .map(|on| if *on { '1' } else { '0' })
            .collect()
    };
    // a, b, both, either, neither, toggle, sticky, edge
    assert_eq!(seen(hands.step()), "00001000");
    assert_eq!(seen(hands.button(0, 1.0)), "10010111");
    assert_eq!(seen(hands.step()), "10010111");
    assert_eq!(seen(hands.step()), "10010110", "the pulse is over");
    assert_eq!(seen(hands.button(1, 1.0)), "11110100", "off wins");
    hands.button(0, 0.0);
    assert_eq!(seen(hands.button(1, 0.0)), "00001100", "toggled stays");
    assert_eq!(seen(hands.button(0, 1.0)), "10010011");
}

#[test]
fn a_toggle_that_drives_ends_with_a_loss() {
    let cruise = Switch {
        name: name("cruise"),
        on: Condition::Toggle(name("a")),
    };
    let lines = vec![
        Line::new(name("stick"), axis(0)),
        Line {
            when: Some(name("cruise")),
            weight: 0.5,
            ..Line::new(name("cruise"), Source::Always)
        },
    ];
    let mut hands = Hands::on(forward(lines, vec![pressed("a", 0), cruise]));
    hands.button(0, 1.0);
    assert_eq!(hands.button(0, 0.0).wish().axes.forward, 0.5);
    let pads = std::mem::take(&mut hands.readings.pads);
    assert!(!hands.step().wish().drives);
    hands.readings.pads = pads;
    hands.step();
    assert_eq!(hands.step().wish(), Wish::default(), "the toggle is off");
}

#[test]
fn a_trim_works_only_while_something_is_held() {
    let mut profile = forward(vec![Line::new(name("stick"), axis(0))], Vec::new());
    profile.outputs[0].centre = 0.1;
    profile.outputs[0].reverse = true;
    let mut hands = Hands::on(profile);
    assert!(!hands.step().wish().drives);
    assert!(
        (hands.axis(0, -1.0).wish().axes.forward - 1.0).abs() < 1e-9,
        "reversed"
    );
    assert!(
        (hands.axis(0, 0.5).wish().axes.forward + 0.45).abs() < 1e-9,
        "from the centre to the end"
    );
}

#[test]
fn a_wheel_each_makes_speed_and_turn() {
    let mut profile = forward(Vec::new(), Vec::new());
    let wheel = |output, number| Output {
        lines: vec![Line::new(name("stick"), axis(number))],
        ..Output::new(output)
    };
    profile.outputs = vec![wheel(OutputName::LeftWheel, 1), wheel(OutputName::RightWheel, 3)];
    let mut hands = Hands::on(profile);
    hands.axis(1, 1.0);
    let axes = hands.axis(3, 1.0).wish().axes;
    assert_eq!((axes.forward, axes.turn), (1.0, 0.0));
    let axes = hands.axis(1, -1.0).wish().axes;
    assert_eq!((axes.forward, axes.turn), (0.0, 1.0));
}

#[test]
fn a_trigger_that_rests_at_its_end_is_calibrated() {
    let mut profile = forward(vec![Line::new(name("trigger"), axis(2))], Vec::new());
    profile.inputs = vec![Calibration {
        centre: -1.0,
        ..Calibration::new(axis(2), 0.0)
    }];
    let calibration = &profile.inputs[0];
    let read = [-1.2, -1.0, 0.0, 1.0].map(|raw| calibration.apply(raw));
    assert_eq!(read, [0.0, 0.0, 0.5, 1.0]);
    profile.check().expect("is right");
}

#[test]
fn what_is_wrong_is_told_with_its_place_and_a_remedy() {
    let right = || forward(vec![Line::new(name("stick"), axis(0))], Vec::new());
    let spoilt = |spoil: fn(&mut Profile)| {
        let mut profile = right();
        spoil(&mut profile);
        profile.check().expect_err("is wrong").to_string()
    };
    let cases: [(String, &str); 9] = [
        (
            spoilt(|profile| profile.outputs[0].lines[0].weight = f64::NAN),
            "output forward, line 1 (stick), weight is NaN: write a number from -2 to 2",
        ),
        (
            spoilt(|profile| profile.outputs[0].failsafe = 0.2),
            "output forward, failsafe is 0.2: it must be 0, so that the robot stands when an input is lost",
        ),
        (
            spoilt(|profile| profile.outputs[0].lines[0].slow_up_per_s = 0.1),
            "output forward, line 1 (stick), slow-up-per-s is 0.1: write 0 for at once, or 0.5 to 100 a second",
        ),
        (
            spoilt(|profile| profile.outputs[0].lines[0].curve = vec![[-1.0, 0.0]]),
            "output forward, line 1 (stick), curve: give 2 to 17 points that rise from -1 to 1 in their first numbers, or none",
        ),
        (
            spoilt(|profile| profile.outputs[0].lines[0].when = Name::new("x").ok()),
            "output forward, line 1 (stick): no switch before it has the name `x`: add one, or take another",
        ),
        (
            spoilt(|profile| profile.outputs.push(Output::new(OutputName::Forward))),
            "output forward is there twice: remove one",
        ),
        (
            spoilt(|profile| profile.outputs[0].centre = -2.0),
            "output forward, centre is -2: write a number from -1 to 1",
        ),
        (
            spoilt(|profile| profile.outputs[0].high = -1.0),
            "output forward: low, centre and high must rise, and low must be below high",
        ),
        (
            spoilt(|profile| profile.version = 7),
            "the profile has version 7, this program reads 1: export it again with a program that fits",
        ),
    ];
    for (said, expected) in cases {
        assert_eq!(said, expected);
    }
    let text = right().to_pretty_json().replace("\"lines\"", "\"rows\"");
    let error = Profile::parse(&text).expect_err("has a strange key");
    assert!(
        matches!(&error, ProfileError::Syntax { line, what, .. } if *line > 5 && what.contains("`rows`")),
        "{error}"
    );
    assert!(Profile::parse(&right().to_json().replace("pad-0-axis-0", "pad-9-axis-0")).is_err());
}

#[test]
fn a_profile_has_a_largest_size() {
    let mut profile = standard_profile();
    for output in &mut profile.outputs {
        let line = Line {
            name: name("a line with a rather long name"),
            curve: (-8..=8)
                .map(|step| [f64::from(step) / 8.0, f64::from(step) / 8.0])
                .collect(),
            mix: Mix::Replace,
            ..Line::new(name("x"), axis(0))
        };
        output.lines = vec![line; 10];
    }
    assert!(matches!(profile.check(), Err(ProfileError::TooLarge { .. })));
}

/// Forward and turn by the two axes of a stick, with a trim of the turn by buttons 0 and 1, and a mode on button 4.
fn trimmed(more: &str) -> Profile {
    let text = format!(
        r#"{{"version":1,"name":"one","switches":[{{"name":"a","on":{{"above":{{"input":"pad-0-button-4","level":0.5}}}}}}],
        "trims":[{{"output":"turn","up":"pad-0-button-0","down":"pad-0-button-1","step":0.05}}],
        "modes":[{{"name":"indoors","when":"a"{more}}}],
        "outputs":[
        {{"output":"forward","low":-1,"high":1,"lines":[{{"name":"usual","input":"pad-0-axis-0"}},
        {{"name":"slow","input":"always","weight":0.5,"mix":"multiply","modes":["indoors"]}}]}},
        {{"output":"turn","low":-1,"high":1,"lines":[{{"name":"usual","input":"pad-0-axis-1"}}]}}]}}"#
    );
    Profile::parse(&text).expect("a profile")
}

/// Value of the turn while the robot drives straight ahead.
fn turn_ahead(mixed: &Mixed) -> f64 {
    mixed.wish().axes.turn
}

#[test]
fn a_trim_counts_while_something_is_held_and_each_press_once() {
    let mut hands = Hands::on(trimmed(""));
    hands.axis(0, 0.0);
    for _ in 0..3 {
        hands.button(0, 1.0);
        hands.step();
        hands.button(0, 0.0);
    }
    let free = hands.step();
    assert!(!free.held && free.state == MixState::Live, "{free:?}");
    assert_eq!(free.wish().axes.turn, 0.0, "a trim does not drive");
    assert!((free.trims[0].value - 0.15).abs() < 1e-9, "{:?}", free.trims);
    let ahead = hands.axis(0, 1.0);
    assert!((turn_ahead(&ahead) - 0.15).abs() < 1e-9, "{ahead:?}");
    for _ in 0..20 {
        hands.button(1, 1.0);
        hands.button(1, 0.0);
    }
    assert_eq!(hands.step().trims[0].value, -mixer::TRIM_MAX);
}

#[test]
fn a_mode_has_lines_and_trims_of_its_own() {
    let mut hands = Hands::on(trimmed(r#","trims":[{"output":"turn","value":0.1}]"#));
    hands.axis(1, 0.0);
    assert_eq!(hands.axis(0, 0.8).outputs[0].value, 0.8);
    let indoors = hands.button(4, 1.0);
    assert_eq!((indoors.mode, indoors.outputs[0].value), (Some(0), 0.4));
    assert!((turn_ahead(&indoors) - 0.1).abs() < 1e-9);
    hands.button(0, 1.0);
    let outdoors = hands.button(4, 0.0);
    assert_eq!((outdoors.mode, outdoors.outputs[0].value), (None, 0.8));
    assert_eq!(outdoors.trims[0].value, 0.0, "the press was for the mode");
    assert!((hands.button(4, 1.0).trims[0].value - 0.15).abs() < 1e-9);
}

#[test]
fn a_mode_goes_over_gradually_and_not_for_who_lets_go() {
    let mut hands = Hands::on(trimmed(r#","fade-ms":1000"#));
    hands.axis(1, 0.0);
    hands.axis(0, 0.8);
    let mut before = hands.button(4, 1.0).outputs[0].value;
    assert!(before > 0.75, "{before}");
    for _ in 0..60 {
        let value = hands.step().outputs[0].value;
        assert!(
            before - value < 0.02 && value <= before + 1e-9,
            "{before} to {value}"
        );
        before = value;
    }
    assert!((before - 0.4).abs() < 1e-9, "{before}");
    hands.button(4, 0.0);
    let free = hands.axis(0, 0.0);
    assert_eq!(free.outputs[0].value, 0.0);
    assert!(!free.held);
}

#[test]
fn what_is_wrong_with_a_trim_or_a_mode_is_said_at_its_place() {
    let told = |text: &str| Profile::parse(text).expect_err("it is wrong").to_string();
    let with = |more: &str| format!(r#"{{"version":1,"name":"one",{more},"outputs":[]}}"#);
    let trim = r#"{"output":"turn","up":"key-KeyE","down":"key-KeyQ"}"#;
    for (more, message) in [
        (
            r#""trims":[{"output":"suction","up":"key-KeyE","down":"key-KeyQ"}]"#.to_owned(),
            "trim suction: only forward, turn, left-wheel and right-wheel can be trimmed: remove it",
        ),
        (
            format!(r#""trims":[{trim},{trim}]"#),
            "trim turn is there twice: remove one",
        ),
        (
            r#""trims":[{"output":"turn","up":"key-KeyE","down":"key-KeyQ","value":0.5}]"#.to_owned(),
            "trim turn, value is 0.5: write a number from -0.25 to 0.25",
        ),
        (
            r#""modes":[{"name":"indoors","when":"a"}]"#.to_owned(),
            "mode indoors: no switch before it has the name `a`: add one, or take another",
        ),
    ] {
        assert_eq!(told(&with(&more)), message);
    }
    let no_mode = forward_by(r#"{"name":"one","input":"pad-0-axis-0"}"#);
    let text = no_mode.to_json().replace(
        r#""input":"pad-0-axis-0""#,
        r#""input":"pad-0-axis-0","modes":["b"]"#,
    );
    assert_eq!(
        told(&text),
        "output forward, line 1 (one): no mode has the name `b`: add one, or take another"
    );
}
