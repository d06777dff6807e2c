//! Driving by hand: from what hands do to drive requests under a lease, by the mix that a person has chosen.
//!
//! Whatever happens to the page - hidden, closed, asleep, without network - no further request is sent and the robot stops when
//! the lease ends. A page that can still speak lets go at once.

use mixer::{
    Cleaning, ClientInputs, Device, KeyCode, Mixed, Mixer, PadReading, Pilot, Profile, ProfileError,
    Readings, Source, Steered, TopSpeeds,
};
use rvac_api::{CleaningPower, ClientInput, RequestBody, RobotDescription};
use std::collections::{BTreeMap, BTreeSet};

use crate::codes::explain;
use crate::grip::{Grip, PadEvent};
use crate::words::Words;

/// What the robot can do; before it said so, what every robot can.
#[must_use]
pub fn top_speeds(robot: Option<&RobotDescription>) -> TopSpeeds {
    robot.map_or(
        TopSpeeds {
            forward_m_per_s: 0.15,
            turn_rad_per_s: 0.8,
        },
        |robot| TopSpeeds {
            forward_m_per_s: robot.speed_max_m_per_s,
            turn_rad_per_s: robot.turn_max_rad_per_s,
        },
    )
}

/// Where the knob of a round pad is for a hand that is `right` and `down` of its middle, in units of its radius: right and
/// down, within the disc.
#[must_use]
pub fn knob_place(right: f64, down: f64) -> [f64; 2] {
    let length = right.hypot(down);
    if !length.is_finite() {
        return [0.0, 0.0];
    }
    let limit = length.max(1.0);
    [right / limit, down / limit]
}

/// Keys that the profile names, so that all others are left to the page.
#[must_use]
pub fn keys_of(profile: &Profile) -> BTreeSet<KeyCode> {
    profile
        .sources()
        .filter_map(|source| match source {
            Source::Key(code) => Some(code.clone()),
            _ => None,
        })
        .collect()
}

/// Name of the reason why a pushed pad that says nothing stops the wheels.
const PAD_SILENT: &str = "pad-silent";
/// A device in a hand is never so still that its browser reports nothing for so long (Chromium reports every change of a tenth of a
/// degree): it lies somewhere, or its sensor is gone.
const TILT_SILENT_US: u64 = 1_000_000;

/// Which gamepads are pushed and say nothing more, for people; none when all that are pushed are heard.
#[must_use]
pub fn silent_text(words: &Words, pads: &BTreeSet<u8>) -> Option<String> {
    let pad = pads.first()?;
    let told = explain(words, PAD_SILENT)?;
    Some(format!("pad-{pad}: {} {}", told.cause, told.remedy))
}

/// Which input is not at rest and what it reads, for people; none when all are.
#[must_use]
pub fn away_text(words: &Words, mixed: &Mixed) -> Option<String> {
    let away = mixed.away.first()?;
    let reading = words.number(away.reading, 1);
    Some(
        words
            .drive
            .away_from_rest
            .fill([&away.input.to_string(), &reading]),
    )
}

/// What is held, the mix that it goes through, and the seat.
#[derive(Debug)]
pub struct Driver {
    pilot: Pilot,
    keys: BTreeSet<KeyCode>,
    readings: Readings,
    /// Which pointer holds the knob on the screen.
    grip: Grip,
    /// Inputs of other clients.
    client_inputs: ClientInputs,
    /// When the tilt was last reported.
    tilted_us: u64,
    cleaners: bool,
}

impl Default for Driver {
    /// Drives by the standard mix, with a keyboard and the stick on the screen.
    fn default() -> Self {
        let pilot = Pilot::new(Mixer::standard());
        Self {
            keys: keys_of(pilot.profile()),
            pilot,
            readings: at_rest(),
            grip: Grip::default(),
            client_inputs: ClientInputs::default(),
            tilted_us: 0,
            cleaners: false,
        }
    }
}

impl Driver {
    /// Drives by another mix from now on and releases all held inputs.
    ///
    /// # Errors
    /// What is wrong with the mix; then the one before goes on.
    pub fn take_mix(&mut self, profile: Profile) -> Result<(), ProfileError> {
        let keys = keys_of(&profile);
        self.pilot.take(Mixer::new(profile)?);
        self.keys = keys;
        Ok(())
    }

    /// Takes the keys of a mix that is edited, so that its bars follow them.
    pub fn take_keys_of(&mut self, profile: &Profile) {
        self.keys = keys_of(profile);
    }

    /// The mix that drives.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        self.pilot.profile()
    }

    /// The mix that drives, with its trims as they were set since.
    #[must_use]
    pub fn trimmed(&self) -> Profile {
        self.pilot.trimmed()
    }

    /// What the inputs read.
    #[must_use]
    pub const fn readings(&self) -> &Readings {
        &self.readings
    }

    /// Hands do something at the pad on the screen. Gives where the knob goes by that, right and down; none where it stays.
    pub fn touch(&mut self, event: PadEvent) -> Option<[f64; 2]> {
        let [right, down] = self.grip.hear(event)?;
        self.readings.touch = Some([right, -down]);
        Some([right, down])
    }

    /// Whether a pointer holds the knob.
    #[must_use]
    pub const fn is_touched(&self) -> bool {
        self.grip.is_held()
    }

    /// The key of this code, if the mix has a use for it.
    #[must_use]
    pub fn key(&self, code: &str) -> Option<KeyCode> {
        KeyCode::new(code).filter(|code| self.keys.contains(code))
    }

    /// A key went down.
    pub fn press(&mut self, code: KeyCode) {
        self.readings.set(&Source::Key(code), 1.0);
    }

    /// The key of this code went up, whether the mix has a use for it or had one when it went down.
    pub fn lift(&mut self, code: &str) {
        if let Some(code) = KeyCode::new(code) {
            self.readings.set(&Source::Key(code), 0.0);
        }
    }

    /// The gamepads that there are now, by their numbers.
    pub fn set_pads(&mut self, pads: BTreeMap<u8, PadReading>) {
        self.readings.pads = pads;
    }

    /// The device in the hand is tilted so, forward and left.
    pub fn set_tilt(&mut self, now_us: u64, tilt: [f64; 2]) {
        self.tilted_us = now_us;
        self.readings.tilt = Some(tilt);
    }

    /// The tilt is not followed any more.
    pub fn forget_tilt(&mut self) {
        self.readings.remove(&Device::Tilt);
    }

    /// Takes the inputs of other clients, which the robot passes on.
    pub fn hear_inputs(&mut self, now_us: u64, inputs: &[ClientInput]) {
        self.client_inputs.replace(now_us, inputs);
    }

    /// The connection to the robot is gone.
    pub fn forget_inputs(&mut self) {
        self.client_inputs.forget();
    }

    /// Hands are off keys and pad; other inputs stay held.
    pub fn let_go(&mut self) {
        self.grip = Grip::default();
        let tilt = self.readings.tilt;
        let pads = std::mem::take(&mut self.readings.pads);
        self.readings = Readings {
            pads,
            tilt,
            ..at_rest()
        };
    }

    /// Brushes and suction run while driving, from now on.
    pub fn clean_while_driving(&mut self) {
        self.cleaners = true;
    }

    /// Brushes and suction do what the mix says while driving, from now on.
    pub fn drive_only(&mut self) {
        self.cleaners = false;
    }

    /// The robot refused to be driven: nothing more is asked until everything was let go once.
    pub fn on_refused(&mut self) {
        self.pilot.refuse();
    }

    /// Looks at the inputs.
    pub fn step(&mut self, now_us: u64, top: TopSpeeds) -> Steered {
        self.forget_the_silent(now_us);
        let steered = self.pilot.step(now_us, &self.readings, top);
        Steered {
            seat: steered.seat.map(|body| self.with_cleaners(body)),
            ..steered
        }
    }

    /// Every input is lost at this moment: the page is away, or the robot.
    pub fn lose(&mut self, now_us: u64) -> Steered {
        self.let_go();
        self.stand_by(now_us)
    }

    /// Nothing drives at this moment, regardless of the inputs.
    pub fn stand_by(&mut self, now_us: u64) -> Steered {
        self.forget_the_silent(now_us);
        let nothing = Readings::default();
        // Nothing is driven, so no speed is asked for.
        self.pilot.step(now_us, &nothing, top_speeds(None))
    }

    /// Inputs that arrive as events end when no event follows.
    fn forget_the_silent(&mut self, now_us: u64) {
        self.readings.clients = self.client_inputs.at(now_us);
        if now_us.saturating_sub(self.tilted_us) >= TILT_SILENT_US {
            self.forget_tilt();
        }
    }

    fn with_cleaners(&self, body: RequestBody) -> RequestBody {
        match body {
            RequestBody::Drive { v, w, ttl, clean, .. } if self.cleaners => RequestBody::Drive {
                v,
                w,
                ttl,
                clean,
                power: Some(FULL),
            },
            other => other,
        }
    }
}

const FULL: CleaningPower = CleaningPower {
    suction: Cleaning::FULL.suction,
    main_brush: Cleaning::FULL.main_brush,
    side_brushes: Cleaning::FULL.side_brushes,
};

/// The page's own inputs at rest.
fn at_rest() -> Readings {
    Readings {
        keys: Some(BTreeSet::new()),
        touch: Some([0.0, 0.0]),
        ..Readings::default()
    }
}

#[cfg(test)]
mod tests {
    use super::{Driver, FULL, away_text, knob_place, silent_text, top_speeds};
    use crate::grip::{PadEvent, Pointer, PointerKind};
    use crate::words::Language;
    use mixer::{MixState, PAD_SILENT_US, PadReading, Profile, STEP_EVERY_US, Steered, standard_profile};
    use rvac_api::{ClientInput, RequestBody};

    struct Page {
        driver: Driver,
        now_us: u64,
    }

    impl Page {
        fn new() -> Self {
            let mut page = Self {
                driver: Driver::default(),
                now_us: 0,
            };
            assert_eq!(page.step().mixed.state, MixState::Failsafe);
            assert_eq!(page.step().mixed.state, MixState::Live);
            page
        }

        fn step(&mut self) -> Steered {
            self.now_us += STEP_EVERY_US;
            self.driver.step(self.now_us, top_speeds(None))
        }

        /// Drives by a mix in which this input alone turns the robot.
        fn turn_by(&mut self, input: &str) {
            let text = format!(
                r#"{{"version":1,"name":"turn","outputs":[{{"output":"turn","low":-1,"high":1,
                "lines":[{{"name":"turn","input":"{input}"}}]}}]}}"#
            );
            let mix = Profile::parse(&text).expect("a mix");
            self.driver.take_mix(mix).expect("a mix");
        }

        fn press(&mut self, code: &str) {
            let key = self.driver.key(code).expect("a key of the mix");
            self.driver.press(key);
        }

        /// Speeds of the second request of a hold.
        #[track_caller]
        fn speeds(&mut self) -> (f64, f64) {
            self.step();
            match self.step().seat {
                Some(RequestBody::Drive { v, w, .. }) => (v, w),
                other => panic!("{other:?}"),
            }
        }
    }

    fn pressed_at(place: [f64; 2]) -> Pointer {
        Pointer {
            number: 1,
            kind: PointerKind::Other,
            buttons: 1,
            place,
        }
    }

    fn pad(across: f64) -> PadReading {
        PadReading {
            axes: vec![across, 0.0, 0.0, 0.0],
            buttons: vec![0.0; 17],
            words: 0,
        }
    }

    #[test]
    fn what_is_not_at_rest_is_told_by_name() {
        let mut page = Page::new();
        page.driver.set_pads([(0, pad(1.28))].into());
        page.step();
        let mixed = page.step().mixed;
        let said = away_text(Language::English.words(), &mixed).expect("it is told");
        assert!(said.contains("pad-0-axis-0 reads 1.3"), "{said}");
        page.driver.set_pads([(0, pad(0.0))].into());
        assert_eq!(away_text(Language::English.words(), &page.step().mixed), None);
    }

    #[test]
    fn keys_drive_and_others_are_left_to_the_page() {
        let mut page = Page::new();
        page.press("KeyW");
        page.press("KeyA");
        let (v, w) = page.speeds();
        assert!((v - 0.7 * 0.15).abs() < 1e-9 && (w - 0.7 * 0.8).abs() < 1e-9);
        for code in ["Tab", "Enter", "KeyQ", ""] {
            assert_eq!(page.driver.key(code), None, "{code}");
        }
        page.driver.let_go();
        assert_eq!(page.step().seat, Some(RequestBody::Release));
        assert_eq!(page.step().seat, None);
    }

    #[test]
    fn the_knob_drives_within_its_disc() {
        for (right, down) in [(1.0, 1.0), (-9.0, 4.0), (0.0, -1.0)] {
            let [x, y] = knob_place(right, down);
            assert!(x.hypot(y) <= 1.0 + 1e-9 && x * right >= 0.0 && y * down >= 0.0);
        }
        assert_eq!(knob_place(f64::NAN, 0.0), [0.0, 0.0]);
        let mut page = Page::new();
        page.driver
            .touch(PadEvent::Pressed(pressed_at(knob_place(0.0, 3.0))));
        let (v, _) = page.speeds();
        assert!((v + 0.075).abs() < 1e-9, "backwards it sees nothing: {v}");
    }

    /// The browser goes on to tell of a pointer that was captured before the page was hidden.
    #[test]
    fn a_pointer_that_was_pressed_before_the_page_was_away_drives_no_more() {
        let mut page = Page::new();
        let pointer = pressed_at([0.0, -1.0]);
        page.driver.touch(PadEvent::Pressed(pointer));
        page.speeds();
        page.now_us += STEP_EVERY_US;
        page.driver.lose(page.now_us);
        for _ in 0..10 {
            assert_eq!(page.driver.touch(PadEvent::Moved(pointer)), None);
            assert_eq!(page.step().seat, None);
        }
        page.driver.touch(PadEvent::Pressed(pointer));
        assert!(page.speeds().0 > 0.0, "a new press drives");
    }

    /// With Ctrl held, or another mix chosen meanwhile, a browser still tells that a key went up.
    #[test]
    fn a_key_that_goes_up_is_let_go_whatever_it_means_now() {
        let mut page = Page::new();
        page.press("KeyW");
        page.speeds();
        page.turn_by("key-KeyQ");
        page.driver.lift("KeyW");
        page.driver.take_mix(standard_profile()).expect("a mix");
        for _ in 0..5 {
            assert!(!matches!(page.step().seat, Some(RequestBody::Drive { .. })));
        }
        page.press("KeyW");
        assert!(page.speeds().0 > 0.0);
    }

    #[test]
    fn a_page_that_is_away_lets_go_and_everything_must_come_to_rest() {
        let mut page = Page::new();
        page.press("KeyW");
        page.speeds();
        page.now_us += STEP_EVERY_US;
        let lost = page.driver.lose(page.now_us);
        assert_eq!(lost.seat, Some(RequestBody::Release));
        page.driver.set_pads([(0, pad(1.0))].into());
        for _ in 0..3 {
            assert_eq!(page.step().seat, None, "the stick was held while nobody looked");
        }
        page.driver.set_pads([(0, pad(0.0))].into());
        page.step();
        page.driver.set_pads([(0, pad(1.0))].into());
        assert!(page.speeds().1 < 0.0, "right is clockwise");
    }

    #[test]
    fn a_lost_pad_releases_in_the_same_step() {
        let mut page = Page::new();
        page.driver.set_pads([(0, pad(0.0))].into());
        page.step();
        page.step();
        page.driver.set_pads([(0, pad(-1.0))].into());
        page.speeds();
        page.driver.set_pads([].into());
        assert_eq!(page.step().seat, Some(RequestBody::Release));
    }

    #[test]
    fn a_pad_without_power_stops_the_wheels_and_is_told_by_name() {
        let mut page = Page::new();
        for across in [0.0, 0.0, -1.0] {
            page.driver.set_pads([(0, pad(across))].into());
            page.step();
        }
        let silent_from_us = page.now_us;
        let steered = loop {
            let steered = page.step();
            if steered.seat == Some(RequestBody::Release) {
                break steered;
            }
        };
        assert_eq!(page.now_us, silent_from_us + PAD_SILENT_US);
        let told = |pads| silent_text(Language::English.words(), pads);
        let said = told(&steered.silent_pads).expect("it is told");
        assert!(
            said.starts_with("pad-0: ") && said.contains("says nothing any more"),
            "{said}"
        );
        assert_eq!(told(&[].into()), None);
    }

    /// Another pad of the same name takes the place of one that is gone, and is pushed.
    #[test]
    fn another_pad_does_not_go_on_where_the_first_one_was() {
        let mut page = Page::new();
        for across in [0.0, 0.0, -1.0] {
            page.driver.set_pads([(0, pad(across))].into());
            page.step();
        }
        page.driver.set_pads([(0, pad(-1.0)), (1, pad(-1.0))].into());
        page.step();
        page.driver.set_pads([(0, pad(-1.0))].into());
        assert!(
            matches!(page.step().seat, Some(RequestBody::Drive { .. }) | None),
            "the mix reads the first one only"
        );
        page.driver.set_pads([].into());
        assert_eq!(page.step().seat, Some(RequestBody::Release));
        page.driver.set_pads([(0, pad(-1.0))].into());
        for _ in 0..5 {
            assert_eq!(page.step().seat, None);
        }
    }

    #[test]
    fn another_client_drives_by_the_mix_until_its_lease_ends() {
        let mut page = Page::new();
        page.turn_by("client-steer");
        let told = |value, left_ms| ClientInput {
            name: "steer".to_owned(),
            value,
            left_ms,
        };
        page.driver.hear_inputs(page.now_us, &[told(0.0, 400)]);
        page.step();
        page.step();
        page.driver.hear_inputs(page.now_us, &[told(0.5, 100)]);
        assert!((page.speeds().1 - 0.4).abs() < 1e-9);
        page.step();
        page.step();
        assert_eq!(page.step().seat, Some(RequestBody::Release), "100 ms are over");
        page.driver.hear_inputs(page.now_us, &[told(1.0, 400)]);
        page.step();
        assert_eq!(page.step().seat, None, "what comes back held does not drive");
        page.driver.hear_inputs(page.now_us, &[told(0.0, 400)]);
        page.step();
        page.driver.hear_inputs(page.now_us, &[told(1.0, 400)]);
        page.speeds();
        page.driver.forget_inputs();
        assert_eq!(
            page.step().seat,
            Some(RequestBody::Release),
            "the connection is gone"
        );
    }

    #[test]
    fn a_tilt_of_which_nothing_more_is_reported_stops_the_wheels() {
        let mut page = Page::new();
        page.turn_by("tilt-left");
        page.driver.set_tilt(page.now_us, [0.0, 0.0]);
        page.step();
        page.step();
        let reported_us = page.now_us;
        page.driver.set_tilt(reported_us, [0.0, 0.5]);
        assert!((page.speeds().1 - 0.4).abs() < 1e-9);
        while page.now_us + STEP_EVERY_US < reported_us + super::TILT_SILENT_US {
            assert_ne!(page.step().seat, Some(RequestBody::Release));
        }
        assert_eq!(page.step().seat, Some(RequestBody::Release));
        page.driver.set_tilt(page.now_us, [0.0, 0.5]);
        page.step();
        assert_eq!(page.step().seat, None, "it must be held level first");
    }

    #[test]
    fn a_mix_that_is_edited_sees_what_clients_tell_and_drives_nothing() {
        let mut page = Page::new();
        let steer = "client-steer".parse().expect("an input");
        let input = ClientInput {
            name: "steer".to_owned(),
            value: 1.0,
            left_ms: 300,
        };
        page.driver.hear_inputs(page.now_us, &[input]);
        assert_eq!(page.driver.stand_by(page.now_us).seat, None);
        assert_eq!(page.driver.readings().value(&steer), Some(1.0));
        page.driver.stand_by(page.now_us + 300_000);
        assert_eq!(page.driver.readings().value(&steer), None);
    }

    #[test]
    fn cleaners_run_when_they_are_told_to() {
        let mut page = Page::new();
        page.driver.clean_while_driving();
        page.press("KeyW");
        let Some(RequestBody::Drive { power, .. }) = page.step().seat else {
            panic!("it drives");
        };
        assert_eq!(power, Some(FULL));
    }

    #[test]
    fn another_mix_brings_its_own_keys() {
        let mut page = Page::new();
        page.turn_by("key-KeyQ");
        page.step();
        page.step();
        assert_eq!(page.driver.key("KeyW"), None);
        page.press("KeyQ");
        assert!((page.speeds().1 - 0.8).abs() < 1e-9);
        let mut broken = standard_profile();
        broken.outputs[0].low = -2.0;
        assert!(page.driver.take_mix(broken).is_err());
        assert_eq!(
            page.driver.profile().name.as_str(),
            "turn",
            "the one before goes on"
        );
    }
}
