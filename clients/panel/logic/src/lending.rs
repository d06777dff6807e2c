//! Lending what hands do at this device to whoever drives: as inputs of control mixes, which the robot passes on under a lease.
//!
//! Lent are the stick on the screen, the tilt, and the first gamepad: inputs that are absent or have vanished are not sent, and
//! the robot driven by them stops.

use std::collections::BTreeMap;

use mixer::{Name, PadReading, PadWatch, Readings};
use rvac_api::{ClientInput, RequestBody};

use crate::words::Words;

/// Longest name of what is lent: with `-button-7` behind it still a name of an input, which has 32 characters at most.
pub const LENT_NAME_MAX: usize = 20;
/// Axes and buttons of a gamepad that are lent: with stick and tilt they are the 16 inputs that a client may send.
const AXES: usize = 4;
const BUTTONS: usize = 8;
/// What does not change is said again so often: two renewals of the lease may be lost.
const RENEW_US: u64 = 80_000;
/// Worn sticks at rest read up to this much. What pushes a lent pad is known only where it drives.
const AT_REST: f64 = 0.15;
/// The lease of the lent inputs.
const LEASE_MS: u16 = 250;

/// What is lent, and the values sent last.
#[derive(Clone, Debug, Default)]
pub struct Lending {
    name: Option<Name>,
    told: Option<(u64, BTreeMap<String, f64>)>,
    pads: PadWatch,
}

impl Lending {
    /// Lends from now on under this name.
    pub fn begin(&mut self, name: Name) {
        self.name = Some(name);
    }

    /// Lends no more; what to say about it.
    pub fn end(&mut self) -> Option<RequestBody> {
        self.name = None;
        self.pause()
    }

    /// The page is not visible, or needs its inputs itself; returns what to send. The next step lends again.
    pub fn pause(&mut self) -> Option<RequestBody> {
        self.told.take().map(|_| tell(BTreeMap::new()))
    }

    /// Looks at the inputs, and gives what to say about them.
    pub fn step(&mut self, now_us: u64, readings: &Readings) -> Option<RequestBody> {
        let name = self.name.as_ref()?;
        let is_pushed = |pad| readings.pads.get(&pad).is_some_and(is_away_from_rest);
        let silent = self.pads.look(now_us, &readings.pads, is_pushed);
        let pad = readings.pads.iter().find(|(number, _)| !silent.contains(number));
        let values = inputs(name, (readings, pad.map(|(_, pad)| pad)));
        let is_due = self
            .told
            .as_ref()
            .is_none_or(|(told_us, told)| *told != values || now_us.saturating_sub(*told_us) >= RENEW_US);
        is_due.then(|| {
            self.told = Some((now_us, values.clone()));
            tell(values)
        })
    }

    /// Which of the inputs that the robot passes on are those of this device, as mixes call them.
    #[must_use]
    pub fn passed_on(&self, inputs: &[ClientInput]) -> Vec<String> {
        let Some((_, told)) = &self.told else {
            return Vec::new();
        };
        let own = inputs.iter().filter(|input| told.contains_key(&input.name));
        own.map(|input| format!("client-{}", input.name)).collect()
    }
}

fn tell(values: BTreeMap<String, f64>) -> RequestBody {
    RequestBody::SetInputs {
        values,
        ttl: LEASE_MS,
    }
}

fn is_away_from_rest(pad: &PadReading) -> bool {
    pad.axes
        .iter()
        .chain(&pad.buttons)
        .any(|value| value.abs() > AT_REST)
}

fn inputs(name: &Name, (readings, pad): (&Readings, Option<&PadReading>)) -> BTreeMap<String, f64> {
    let touch = readings.touch.map(|[right, up]| [("right", right), ("up", up)]);
    let tilt = readings
        .tilt
        .map(|[forward, left]| [("forward", forward), ("left", left)]);
    let sticks = touch.into_iter().chain(tilt).flatten();
    let sticks = sticks.map(|(what, value)| (format!("{name}-{what}"), value));
    let numbered = |what: &'static str, values: &[f64], count: usize| {
        let values = values.iter().copied().take(count).enumerate();
        let named = values.map(|(number, value)| (format!("{name}-{what}-{number}"), value));
        named.collect::<Vec<_>>()
    };
    let pad = pad.map(|pad| {
        let axes = numbered("axis", &pad.axes, AXES);
        [axes, numbered("button", &pad.buttons, BUTTONS)]
    });
    sticks
        .chain(pad.into_iter().flatten().flatten())
        .filter(|(_, value)| value.is_finite())
        .map(|(name, value)| (name, value.clamp(-1.0, 1.0)))
        .collect()
}

/// What a person called it, as a name for mixes.
///
/// # Errors
/// What is wrong with it, for people.
pub fn lent_name(words: &Words, text: &str) -> Result<Name, String> {
    let text = text.trim();
    Name::new(text)
        .ok()
        .filter(|_| text.chars().count() <= LENT_NAME_MAX)
        .ok_or_else(|| words.drive.lend_name_wrong.fill([&LENT_NAME_MAX]))
}

/// Whether it is lent, and to whom.
#[must_use]
pub fn lending_text(words: &Words, passed_on: &[String], driver: Option<&str>) -> String {
    let texts = &words.drive;
    if passed_on.is_empty() {
        return texts.lend_waits.to_owned();
    }
    let inputs = passed_on.join(", ");
    match driver {
        Some(driver) => texts.lent_to.fill([&driver, &inputs]),
        None => texts.lent_to_nobody.fill([&inputs]),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{LENT_NAME_MAX, Lending, lending_text, lent_name};
    use crate::words::{Language, Words};
    use mixer::{PAD_SILENT_US, PadReading, Readings};
    use rvac_api::{ClientInput, INPUTS_PER_CLIENT_MAX, RequestBody, is_mix_name};

    const ENGLISH: &Words = Language::English.words();

    fn lending() -> Lending {
        let mut lending = Lending::default();
        lending.begin(lent_name(ENGLISH, "phone").expect("a name"));
        lending
    }

    fn touched(right: f64) -> Readings {
        Readings {
            touch: Some([right, 0.0]),
            ..Readings::default()
        }
    }

    #[track_caller]
    fn values(request: Option<RequestBody>) -> BTreeMap<String, f64> {
        match request {
            Some(RequestBody::SetInputs { values, ttl: 250 }) => values,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_changes_is_sent_at_once_and_the_rest_before_the_lease_ends() {
        let mut lending = lending();
        assert_eq!(Lending::default().step(0, &touched(1.0)), None, "nothing is lent");
        assert_eq!(values(lending.step(0, &touched(0.0))).len(), 2);
        assert_eq!(lending.step(20_000, &touched(0.0)), None);
        assert_eq!(values(lending.step(40_000, &touched(0.5)))["phone-right"], 0.5);
        assert_eq!(lending.step(119_999, &touched(0.5)), None);
        assert_eq!(values(lending.step(120_000, &touched(0.5)))["phone-right"], 0.5);
    }

    #[test]
    fn a_page_that_is_away_says_so_once_and_lends_again_when_it_is_back() {
        let mut lending = lending();
        assert_eq!(lending.pause(), None, "nothing was told yet");
        lending.step(0, &touched(1.0));
        assert!(values(lending.pause()).is_empty());
        assert_eq!(lending.pause(), None);
        assert_eq!(values(lending.step(20_000, &touched(0.0))).len(), 2);
        assert!(values(lending.end()).is_empty());
        assert_eq!(lending.step(40_000, &touched(1.0)), None);
    }

    #[test]
    fn a_lost_pad_is_sent_no_more_and_the_stick_is() {
        let mut lending = lending();
        let pad = PadReading {
            axes: vec![0.25, -2.0, f64::NAN, 0.0, 0.0],
            buttons: vec![1.0; 17],
            words: 0,
        };
        let mut readings = touched(0.0);
        readings.pads.insert(1, pad);
        readings.tilt = Some([0.1, 0.2]);
        let told = values(lending.step(0, &readings));
        assert_eq!((told["phone-axis-0"], told["phone-axis-1"]), (0.25, -1.0));
        assert!(!told.contains_key("phone-axis-2"), "nonsense is not told");
        assert_eq!(told.len(), INPUTS_PER_CLIENT_MAX - 1);
        readings.pads.clear();
        readings.tilt = None;
        let told = values(lending.step(20_000, &readings));
        let names: Vec<&str> = told.keys().map(String::as_str).collect();
        assert_eq!(names, ["phone-right", "phone-up"]);
    }

    #[test]
    fn a_pushed_pad_that_says_nothing_more_is_lent_no_more() {
        let mut lending = lending();
        let mut readings = touched(0.0);
        let pad = PadReading {
            axes: vec![-1.0],
            ..PadReading::default()
        };
        readings.pads.insert(0, pad);
        let lends = |lending: &mut Lending, now_us, readings: &Readings| {
            values(lending.step(now_us, readings)).contains_key("phone-axis-0")
        };
        assert!(lends(&mut lending, 0, &readings));
        assert!(lends(&mut lending, PAD_SILENT_US - 1, &readings));
        assert!(!lends(&mut lending, PAD_SILENT_US, &readings));
        readings.pads.insert(0, PadReading::default());
        lending.step(PAD_SILENT_US + 1, &readings);
        readings.pads.entry(0).or_default().axes = vec![0.05];
        assert!(lends(&mut lending, PAD_SILENT_US + 2, &readings));
        assert!(lends(&mut lending, 9 * PAD_SILENT_US, &readings), "it rests");
    }

    #[test]
    fn the_longest_name_makes_names_of_inputs() {
        let long = "x".repeat(LENT_NAME_MAX);
        assert!(is_mix_name(&format!("{long}-button-7")));
        assert!(lent_name(ENGLISH, &format!(" {long} ")).is_ok());
        for wrong in ["", "a/b", &format!("{long}y")] {
            let told = lent_name(ENGLISH, wrong).expect_err("no name");
            assert!(told.contains("20"), "{told}");
        }
    }

    #[test]
    fn it_is_shown_to_whom_it_is_lent() {
        let mut lending = lending();
        let input = |name: &str| ClientInput {
            name: name.to_owned(),
            value: 0.0,
            left_ms: 200,
        };
        let heard = [input("other"), input("phone-right")];
        assert!(lending.passed_on(&heard).is_empty(), "told by somebody else");
        lending.step(0, &touched(0.0));
        let passed_on = lending.passed_on(&heard);
        assert_eq!(passed_on, ["client-phone-right"]);
        let text = |passed_on: &[String], driver| lending_text(ENGLISH, passed_on, driver);
        assert!(text(&[], None).contains("not taken it yet"));
        assert!(text(&passed_on, None).contains("nobody drives"));
        let told = text(&passed_on, Some("Mari"));
        assert!(
            told.contains("Mari") && told.contains("client-phone-right"),
            "{told}"
        );
    }
}
