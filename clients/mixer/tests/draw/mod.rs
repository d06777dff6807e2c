//! Profiles and readings drawn from numbers.

use mixer::{
    Calibration, Condition, FlightMode, KeyCode, Line, Mix, Name, Output, OutputKind, OutputName, PadReading,
    Profile, Readings, Source, Switch, TRIM_MAX, Trim, TrimValue, VERSION,
};
use proptest::prelude::*;

fn key() -> KeyCode {
    KeyCode::new("KeyW").expect("a key")
}

fn source(switches: usize) -> impl Strategy<Value = Source> {
    prop_oneof![
        Just(Source::Always),
        (0_u8..2, 0_u8..4).prop_map(|(pad, axis)| Source::PadAxis { pad, axis }),
        (0_u8..2, 0_u8..4).prop_map(|(pad, button)| Source::PadButton { pad, button }),
        Just(Source::Key(key())),
        Just(Source::TouchRight),
        Just(Source::TouchUp),
        Just(Source::TiltForward),
        Just(Source::TiltLeft),
        Just(Source::Client(client_name())),
        (0..switches.max(1)).prop_map(move |place| if switches == 0 {
            Source::Always
        } else {
            Source::Switch(switch_name(place))
        }),
    ]
}

fn client_name() -> Name {
    Name::new("steer").expect("a name")
}

fn switch_name(place: usize) -> Name {
    Name::new(&format!("switch {place}")).expect("a name")
}

/// A switch that may refer to those before it.
fn switch(place: usize) -> BoxedStrategy<Switch> {
    let of_input = (source(place), -1.0..=1.0).prop_map(|(input, level)| Condition::Above { input, level });
    let below = (source(place), -1.0..=1.0).prop_map(|(input, level)| Condition::Below { input, level });
    let simple = prop_oneof![of_input, below].boxed();
    let on = if place == 0 {
        simple
    } else {
        let other = || (0..place).prop_map(switch_name);
        prop_oneof![
            simple,
            prop::collection::vec(other(), 1..4).prop_map(Condition::All),
            prop::collection::vec(other(), 1..4).prop_map(Condition::Any),
            other().prop_map(Condition::Not),
            other().prop_map(Condition::Toggle),
            (other(), other()).prop_map(|(set, reset)| Condition::Sticky { set, reset }),
            (other(), 0_u16..=5000).prop_map(|(of, hold_ms)| Condition::Edge { of, hold_ms }),
        ]
        .boxed()
    };
    on.prop_map(move |on| Switch {
        name: switch_name(place),
        on,
    })
    .boxed()
}

fn slow() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.5_f64..100.0]
}

fn curve() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let ends = prop::array::uniform3(-1.0_f64..=1.0);
    prop_oneof![
        Just(Vec::new()),
        (ends, -0.9_f64..0.9).prop_map(|([low, middle, high], at)| vec![
            [-1.0, low],
            [at, middle],
            [1.0, high]
        ]),
    ]
}

fn line(switches: usize) -> impl Strategy<Value = Line> {
    let when = prop::option::of((0..switches.max(1)).prop_map(switch_name));
    let when = when.prop_map(move |when| when.filter(|_| switches > 0));
    let numbers = (-1.0_f64..=1.0, -2.0_f64..=2.0, -1.0_f64..=1.0, 0_u16..=5000);
    let mix = prop_oneof![Just(Mix::Add), Just(Mix::Multiply), Just(Mix::Replace)];
    (
        source(switches),
        any::<bool>(),
        numbers,
        curve(),
        (slow(), slow()),
        (mix, when),
    )
        .prop_map(
            |(input, invert, (expo, weight, offset, delay_ms), curve, (up, down), (mix, when))| Line {
                name: Name::new("line").expect("a name"),
                input,
                invert,
                expo,
                curve,
                weight,
                offset,
                mix,
                when,
                modes: Vec::new(),
                delay_ms,
                slow_up_per_s: up,
                slow_down_per_s: down,
            },
        )
}

fn output(output: OutputName, switches: usize) -> impl Strategy<Value = Output> {
    let kind = output.kind();
    let numbers = prop::array::uniform3(0.0_f64..=1.0);
    let lines = prop::collection::vec(line(switches), 0..4);
    (numbers, any::<bool>(), 0.0_f64..=1.0, lines).prop_map(move |(mut numbers, reverse, share, lines)| {
        numbers.sort_by(f64::total_cmp);
        let [centre, high, _] = numbers;
        let low = if kind == OutputKind::Motion { -high } else { 0.0 };
        let high = high.max(0.01);
        Output {
            output,
            low,
            centre,
            high,
            reverse,
            failsafe: if kind == OutputKind::Cleaner {
                share * high
            } else {
                0.0
            },
            lines,
        }
    })
}

/// Trims, and flight modes on the switches that there are.
fn flight(switches: usize) -> impl Strategy<Value = (Vec<Trim>, Vec<FlightMode>)> {
    let value = || -TRIM_MAX..=TRIM_MAX;
    let trim = (source(switches), source(switches), 0.001..=0.1, value());
    let trim = trim.prop_map(|(up, down, step, value)| Trim {
        output: OutputName::Turn,
        up,
        down,
        step,
        value,
    });
    let mode = (0..switches.max(1), 0_u16..=5000, prop::option::of(value()));
    let modes = prop::option::of(mode);
    (prop::option::of(trim), modes).prop_map(move |(trim, mode)| {
        let mode = mode.filter(|_| switches > 0);
        let has_trim = trim.is_some();
        let mode = mode.map(|(switch, fade_ms, own)| FlightMode {
            name: mode_name(),
            when: switch_name(switch),
            fade_ms,
            trims: own
                .filter(|_| has_trim)
                .map(|value| TrimValue {
                    output: OutputName::Turn,
                    value,
                })
                .into_iter()
                .collect(),
        });
        (trim.into_iter().collect(), mode.into_iter().collect())
    })
}

/// Every second line counts in the flight mode alone, if there is one.
fn in_modes(mut outputs: Vec<Output>, modes: &[FlightMode]) -> Vec<Output> {
    for output in &mut outputs {
        for line in output.lines.iter_mut().skip(1).step_by(2) {
            line.modes = modes.iter().map(|mode| mode.name.clone()).collect();
        }
    }
    outputs
}

fn mode_name() -> Name {
    Name::new("mode").expect("a name")
}

/// Profiles that are right.
pub(crate) fn profile() -> impl Strategy<Value = Profile> {
    (0_usize..4).prop_flat_map(|switches| {
        let drawn_switches: Vec<_> = (0..switches).map(switch).collect();
        let names = prop::sample::subsequence(OutputName::ALL.to_vec(), 1..6);
        let outputs = names.prop_flat_map(move |names| {
            let drawn: Vec<_> = names.into_iter().map(|name| output(name, switches)).collect();
            drawn
        });
        let calibration = (-1.0_f64..0.0, 0.0_f64..=0.9).prop_map(|(low, dead_band)| Calibration {
            low,
            ..Calibration::new(Source::PadAxis { pad: 0, axis: 0 }, dead_band)
        });
        (
            drawn_switches,
            outputs,
            prop::option::of(calibration),
            flight(switches),
        )
            .prop_map(|(switches, outputs, calibration, (trims, modes))| Profile {
                version: VERSION,
                name: Name::new("drawn").expect("a name"),
                inputs: calibration.into_iter().collect(),
                switches,
                outputs: in_modes(outputs, &modes),
                trims,
                modes,
            })
    })
}

fn reading() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0_f64..=1.0,
        1 => Just(0.0),
        1 => prop::num::f64::ANY,
    ]
}

/// What devices may say, nonsense included.
pub(crate) fn readings() -> impl Strategy<Value = Readings> {
    let pad = (
        prop::collection::vec(reading(), 0..5),
        prop::collection::vec(reading(), 0..5),
    )
        .prop_map(|(axes, buttons)| PadReading {
            words: 0,
            axes,
            buttons,
        });
    let pads = prop::collection::btree_map(0_u8..2, pad, 0..3);
    let pair = || prop::option::of(prop::array::uniform2(reading()));
    let keys = prop::option::of(any::<bool>());
    let client = prop::option::of(reading());
    (pads, keys, pair(), pair(), client).prop_map(|(pads, keys, touch, tilt, client)| Readings {
        pads,
        keys: keys.map(|held| held.then(key).into_iter().collect()),
        touch,
        tilt,
        clients: client.map(|value| (client_name(), value)).into_iter().collect(),
    })
}

/// All devices there, and everything pushed to its end.
pub(crate) fn everything_pushed() -> Readings {
    let pad = PadReading {
        words: 0,
        axes: vec![1.0; 4],
        buttons: vec![1.0; 4],
    };
    Readings {
        pads: [(0, pad.clone()), (1, pad)].into(),
        keys: Some([key()].into()),
        touch: Some([1.0, 1.0]),
        tilt: Some([1.0, 1.0]),
        clients: [(client_name(), 1.0)].into(),
    }
}
