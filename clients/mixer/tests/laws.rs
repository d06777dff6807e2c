//! Laws that hold for every profile and whatever inputs do.

mod draw;

use draw::{profile, readings};
use mixer::{
    ClientInputs, GAP_MAX_US, Line, Mix, MixState, Mixed, Mixer, Name, Output, OutputKind, OutputName,
    PadReading, Profile, Readings, Source, VERSION, standard_profile,
};
use proptest::prelude::*;
use rvac_api::{ClientInput, INPUT_LEASE_MS_MAX};

const STEP_US: u64 = 20_000;

fn axis(axis: u8) -> Source {
    Source::PadAxis { pad: 0, axis }
}

fn name(text: &str) -> Name {
    Name::new(text).expect("a name")
}

/// A profile with one output.
fn single(lines: Vec<Line>) -> Profile {
    Profile {
        version: VERSION,
        name: name("single"),
        inputs: Vec::new(),
        switches: Vec::new(),
        trims: Vec::new(),
        modes: Vec::new(),
        outputs: vec![Output {
            lines,
            ..Output::new(OutputName::Forward)
        }],
    }
}

fn sticks(axes: &[f64]) -> Readings {
    let reading = PadReading {
        words: 0,
        axes: axes.to_vec(),
        buttons: vec![0.0; 17],
    };
    Readings {
        pads: [(0, reading)].into(),
        ..Readings::default()
    }
}

fn client_input(value: f64, left_ms: u16) -> ClientInput {
    ClientInput {
        name: "steer".to_owned(),
        value,
        left_ms,
    }
}

/// A mixer that is live.
fn live(profile: Profile) -> Mixer {
    let mut mixer = Mixer::new(profile).expect("a profile");
    for step in 0..3 {
        mixer.step(step * STEP_US, &sticks(&[0.0; 4]));
    }
    mixer
}

fn within_limits(profile: &Profile, mixed: &Mixed) {
    for (output, settings) in mixed.outputs.iter().zip(&profile.outputs) {
        assert!(output.value.is_finite(), "{output:?}");
        assert!(
            (settings.low..=settings.high).contains(&output.value),
            "{output:?}"
        );
        for line in &output.lines {
            for stage in [line.shaped, line.weighted, line.total] {
                assert!(stage.is_finite(), "{line:?}");
            }
        }
    }
    let wish = mixed.wish();
    for share in [wish.axes.forward, wish.axes.turn] {
        assert!((-1.0..=1.0).contains(&share), "{wish:?}");
    }
}

proptest! {
    #[test]
    fn outputs_are_finite_and_within_limits(
        profile in profile(),
        story in prop::collection::vec((readings(), 0_u64..300_000), 1..30),
    ) {
        let mut mixer = Mixer::new(profile.clone()).expect("drawn profiles are right");
        let mut now_us = 0;
        for (readings, pause_us) in story {
            now_us += pause_us;
            within_limits(&profile, &mixer.step(now_us, &readings));
        }
    }

    #[test]
    fn a_lost_input_gives_the_failsafe_of_everything(
        profile in profile(),
        story in prop::collection::vec(readings(), 1..20),
        by_gap in any::<bool>(),
    ) {
        let mut mixer = Mixer::new(profile.clone()).expect("drawn profiles are right");
        let mut now_us = 0;
        for readings in &story {
            now_us += STEP_US;
            mixer.step(now_us, readings);
        }
        let needs_something = profile.outputs.iter().flat_map(|output| &output.lines).any(|line| line.input.device().is_some());
        prop_assume!(needs_something);
        let full = draw::everything_pushed();
        mixer.step(now_us + STEP_US, &full);
        let (later_us, readings) = if by_gap {
            (now_us + STEP_US + GAP_MAX_US + 1, full)
        } else {
            (now_us + 2 * STEP_US, Readings::default())
        };
        let mixed = mixer.step(later_us, &readings);
        prop_assert_eq!(mixed.state, MixState::Failsafe);
        for (output, settings) in mixed.outputs.iter().zip(&profile.outputs) {
            prop_assert_eq!(output.value, settings.failsafe);
            if settings.output.kind() != OutputKind::Cleaner {
                prop_assert_eq!(output.value, 0.0);
            }
        }
        prop_assert_eq!(mixed.wish().axes, mixer::Axes::default());
    }

    /// Whatever a client sends and whenever it falls silent, nothing moves after the longest lease.
    #[test]
    fn a_client_that_falls_silent_drives_no_longer_than_a_lease(
        words in prop::collection::vec((-1.0_f64..=1.0, 1_u16..=500, 1_u64..300_000), 1..20),
    ) {
        let steer = Source::Client(name("steer"));
        let mut mixer = Mixer::new(single(vec![Line::new(name("line"), steer)])).expect("a profile");
        let mut inputs = ClientInputs::default();
        let mut now_us = 0;
        let mut step = |now_us: u64, inputs: &mut ClientInputs| {
            let readings = Readings { clients: inputs.at(now_us), ..Readings::default() };
            mixer.step(now_us, &readings)
        };
        for value in [0.0, 0.0, 1.0] {
            now_us += STEP_US;
            inputs.replace(now_us, &[client_input(value, 400)]);
            let mixed = step(now_us, &mut inputs);
            prop_assert_eq!(mixed.outputs[0].value, value, "at rest first, then it drives");
        }
        for (value, left_ms, pause_us) in words {
            now_us += pause_us;
            inputs.replace(now_us, &[client_input(value, left_ms)]);
            step(now_us, &mut inputs);
        }
        let over_us = now_us + u64::from(INPUT_LEASE_MS_MAX) * 1000;
        while now_us < over_us {
            now_us += STEP_US;
            step(now_us, &mut inputs);
        }
        let mixed = step(now_us, &mut inputs);
        prop_assert_eq!(mixed.outputs[0].value, 0.0);
        prop_assert!(!mixed.wish().drives);
        inputs.replace(now_us, &[client_input(1.0, 400)]);
        for _ in 0..3 {
            now_us += STEP_US;
            prop_assert_eq!(step(now_us, &mut inputs).outputs[0].value, 0.0, "it comes back held");
        }
    }

    #[test]
    fn slow_never_exceeds_its_rate(
        (up, down) in (0.5_f64..20.0, 0.5_f64..20.0),
        story in prop::collection::vec((-1.0_f64..=1.0, 1_000_u64..100_000), 1..40),
    ) {
        let line = Line { slow_up_per_s: up, slow_down_per_s: down, weight: 2.0, ..Line::new(name("slow"), axis(0)) };
        let mut mixer = live(single(vec![line]));
        let (mut now_us, mut before) = (2 * STEP_US, 0.0);
        for (value, pause_us) in story {
            now_us += pause_us;
            let mixed = mixer.step(now_us, &sticks(&[value]));
            let after = mixed.outputs[0].value;
            let span_s = pause_us as f64 * 1e-6;
            prop_assert!(after - before <= up * span_s + 1e-9 && before - after <= down * span_s + 1e-9);
            before = after;
        }
    }

    #[test]
    fn lines_add_multiply_and_replace(values in prop::array::uniform4(-1.0_f64..=1.0)) {
        let [first, second, third, fourth] = values;
        let lines = [Mix::Add, Mix::Multiply, Mix::Add, Mix::Replace];
        let lines = (0..4).zip(lines).map(|(number, mix)| Line { mix, ..Line::new(name("line"), axis(number)) });
        let mut mixer = live(single(lines.collect()));
        let mixed = mixer.step(3 * STEP_US, &sticks(&values));
        let totals: Vec<f64> = mixed.outputs[0].lines.iter().map(|line| line.total).collect();
        prop_assert_eq!(totals, vec![first, first * second, first * second + third, fourth]);
        prop_assert_eq!(mixed.outputs[0].value, fourth);
    }

    #[test]
    fn profiles_come_back_from_their_text(profile in profile()) {
        for text in [profile.to_json(), profile.to_pretty_json()] {
            prop_assert_eq!(Profile::parse(&text), Ok(profile.clone()));
        }
    }

    #[test]
    fn no_text_is_too_strange(mut text in Just(standard_profile().to_json()), at in 0_usize..4000, letter in any::<char>()) {
        let at = (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
        text.insert(at, letter);
        if let Err(error) = Profile::parse(&text) {
            prop_assert!(error.to_string().contains(':'), "what and where: what to do; {error}");
        }
    }

    #[test]
    fn a_button_fires_once_for_each_press(presses in prop::collection::vec(any::<bool>(), 1..40)) {
        let mut mixer = live(standard_profile());
        let mut before = false;
        for (step, pressed) in (3..).zip(presses) {
            let mut readings = sticks(&[0.0; 4]);
            if let Some(pad) = readings.pads.get_mut(&0) {
                pad.buttons[9] = f64::from(u8::from(pressed));
            }
            let fired = mixer.step(step * STEP_US, &readings).fired;
            let expected = if pressed && !before { vec![OutputName::Start] } else { Vec::new() };
            prop_assert_eq!(fired, expected);
            before = pressed;
        }
    }
}
