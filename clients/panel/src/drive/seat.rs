//! Who drives: what hands do now, the mix that they go through, and the mixes that there are.

use std::collections::BTreeSet;

use leptos::prelude::*;
use mixer::{BumpWatch, MixState, Name, Profile, Steered, TopSpeeds, standard_profile};
use panel_logic::{Driver, LatencyMeter, Lending, PadEvent, away_text, silent_text, top_speeds};
use rvac_api::{ClientInput, Pose, Status};

use super::choice;
use super::gamepads::{self, Plugged};

use crate::changes::set_if_changed;
use crate::language::words;
use crate::mixes::flight_text;
use crate::news::now_ms;

/// An input that is older than this is not what begins to drive now: a slow or a delay of the mix does.
const FRESH_MS: f64 = 100.0;

/// All of it, as handles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seat {
    /// What is held, and the mix.
    pub(crate) driver: StoredValue<Driver>,
    /// Where the knob is: right and down.
    pub(crate) knob: RwSignal<[f64; 2]>,
    /// Mixes that the robot keeps.
    pub(crate) kept: RwSignal<Vec<Profile>>,
    /// The one that a person chose; none for the standard one.
    pub(crate) chosen: RwSignal<Option<Name>>,
    /// Gamepads that are seen, for people.
    pub(crate) pads: RwSignal<Vec<String>>,
    /// Whether the inputs count.
    pub(crate) is_live: RwSignal<bool>,
    /// How fast the robot follows, for people.
    pub(crate) latency: RwSignal<Option<String>>,
    /// What is lent to whoever drives elsewhere.
    pub(super) lending: StoredValue<Lending>,
    /// Whether anything is lent.
    pub(crate) is_lent: RwSignal<bool>,
    /// What of it the robot passes on, as mixes call it.
    pub(super) passed_on: RwSignal<Vec<String>>,
    /// Why inputs do not drive, for people: gamepads that are pushed and say nothing more, or what is not at rest.
    pub(crate) why_not: RwSignal<Option<String>>,
    /// The flight mode that holds, and the trims, for people.
    pub(crate) flight: RwSignal<Option<String>>,
    pub(super) plugged: Plugged,
    meter: StoredValue<LatencyMeter>,
    /// When the newest input came.
    input_ms: StoredValue<f64>,
    bumps: StoredValue<BumpWatch>,
}

impl Seat {
    pub(crate) fn new() -> Self {
        Self {
            driver: StoredValue::new(Driver::default()),
            knob: RwSignal::new([0.0, 0.0]),
            kept: RwSignal::new(Vec::new()),
            chosen: RwSignal::new(choice::remembered()),
            pads: RwSignal::new(Vec::new()),
            is_live: RwSignal::new(true),
            latency: RwSignal::new(None),
            lending: StoredValue::new(Lending::default()),
            is_lent: RwSignal::new(false),
            passed_on: RwSignal::new(Vec::new()),
            why_not: RwSignal::new(None),
            flight: RwSignal::new(None),
            plugged: StoredValue::new(BTreeSet::new()),
            meter: StoredValue::new(LatencyMeter::default()),
            input_ms: StoredValue::new(0.0),
            bumps: StoredValue::new(BumpWatch::default()),
        }
    }

    /// Notes the browser's time of an input.
    pub(crate) fn note_input(self, time_ms: f64) {
        self.input_ms.set_value(time_ms);
    }

    /// Hands do something at the pad on the screen: the knob follows.
    pub(crate) fn touch(self, event: PadEvent) {
        let place = self.driver.try_update_value(|driver| driver.touch(event));
        if let Some(place) = place.flatten() {
            self.knob.set(place);
        }
    }

    /// Hands are off the pad and off the keys.
    pub(crate) fn hands_off(self) {
        self.knob.set([0.0, 0.0]);
        self.driver.update_value(Driver::let_go);
    }

    /// Reads all inputs, and drives by them.
    pub(crate) fn step(self, top: TopSpeeds) -> Steered {
        let now = self.look();
        let stepped = self
            .driver
            .try_update_value(|driver| driver.step(micros(now), top));
        let steered = stepped.unwrap_or_else(|| Driver::default().step(0, top_speeds(None)));
        let input_ms = self.input_ms.get_value();
        let began_ms = if now - input_ms < FRESH_MS { input_ms } else { now };
        self.meter
            .update_value(|meter| meter.on_mixed(&steered.mixed, began_ms));
        let is_live = steered.mixed.state == MixState::Live;
        set_if_changed(self.is_live, is_live);
        let silent = silent_text(words(), &steered.silent_pads);
        let why_not = silent.or_else(|| away_text(words(), &steered.mixed));
        set_if_changed(self.why_not, why_not);
        let flight = self
            .driver
            .with_value(|driver| flight_text(&steered.mixed, &driver.profile().modes));
        set_if_changed(self.flight, flight);
        steered
    }

    /// Reads all inputs for a mix that is edited: nothing drives by them.
    pub(crate) fn step_aside(self) -> (Steered, u64) {
        let now_us = micros(self.look());
        let stepped = self.driver.try_update_value(|driver| driver.stand_by(now_us));
        (stepped.unwrap_or_else(|| Driver::default().stand_by(0)), now_us)
    }

    /// Reads the gamepads; the time of it.
    fn look(self) -> f64 {
        let now = now_ms();
        let pads = gamepads::read(self.plugged);
        set_if_changed(self.pads, pads.names);
        self.driver.update_value(|driver| {
            if driver.readings().pads != pads.readings {
                self.note_input(pads.time_ms.unwrap_or(now));
            }
            driver.set_pads(pads.readings);
        });
        now
    }

    /// Everything is let go, and must come to rest before it counts again.
    pub(crate) fn lose(self) -> Steered {
        self.knob.set([0.0, 0.0]);
        let lost = self
            .driver
            .try_update_value(|driver| driver.lose(micros(now_ms())));
        lost.unwrap_or_else(|| Driver::default().lose(0))
    }

    /// Takes the mix of this name, or the standard one.
    pub(crate) fn choose(self, name: Option<Name>) {
        choice::remember(name.as_ref());
        self.chosen.set(name);
        self.apply();
    }

    /// Takes the list of mixes that the robot stores.
    pub(crate) fn on_mixes(self, texts: &[String]) {
        let profiles = texts.iter().filter_map(|text| {
            Profile::parse(text)
                .inspect_err(|error| leptos::logging::warn!("a mix could not be read: {error}"))
                .ok()
        });
        self.kept.set(profiles.collect());
        self.apply();
    }

    /// The robot is somewhere.
    pub(crate) fn on_pose(self, pose: Pose) {
        self.meter.update_value(|meter| meter.on_pose(now_ms(), pose));
        let text = self.meter.with_value(|meter| meter.text(words()));
        set_if_changed(self.latency, text);
    }

    /// The device in the hand is tilted so, forward and left.
    pub(crate) fn tilt(self, reading: [f64; 2]) {
        let now_us = micros(now_ms());
        self.driver
            .update_value(|driver| driver.set_tilt(now_us, reading));
    }

    /// Inputs of other clients.
    pub(crate) fn on_inputs(self, inputs: &[ClientInput]) {
        let now_us = micros(now_ms());
        self.driver
            .update_value(|driver| driver.hear_inputs(now_us, inputs));
        let passed_on = self.lending.with_value(|lending| lending.passed_on(inputs));
        set_if_changed(self.passed_on, passed_on);
    }

    /// Takes the robot's state; gamepads rumble at a bump.
    pub(crate) fn on_status(self, status: &Status) {
        let is_felt = self.bumps.try_update_value(|bumps| bumps.look(status));
        if is_felt == Some(true) {
            gamepads::rumble();
        }
    }

    /// The mix that shall drive, as the robot keeps it now.
    pub(crate) fn shall_drive(self) -> Profile {
        let chosen = self.chosen.get_untracked();
        let found = self.kept.with_untracked(|kept| {
            kept.iter()
                .find(|profile| Some(&profile.name) == chosen.as_ref())
                .cloned()
        });
        found.unwrap_or_else(standard_profile)
    }

    /// Drives by the mix that shall drive.
    pub(crate) fn apply(self) {
        let profile = self.shall_drive();
        self.driver.update_value(|driver| {
            driver.take_keys_of(&profile);
            if *driver.profile() != profile
                && let Err(error) = driver.take_mix(profile)
            {
                leptos::logging::warn!("a mix cannot drive: {error}");
            }
        });
    }
}

fn micros(time_ms: f64) -> u64 {
    (time_ms * 1000.0) as u64
}
