//! The mix that is edited, with everything that follows the inputs.

use leptos::prelude::*;
use mixer::{KeyCode, LineStages, Mixed, MixedOutput, Mixer, Name, Profile, Readings, Source};
use panel_logic::{CalibrationRun, Driver, Field, Group, Learning, MixDraft};

use crate::changes::set_if_changed;
use crate::drive::Seat;
use crate::language::words;

/// Bars are redrawn at every third reading of the inputs.
const LOOKS_PER_DRAWING: u32 = 3;

/// All of it, as handles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bench {
    open: RwSignal<bool>,
    /// The mix; none before the editor was opened first.
    pub(super) draft: RwSignal<Option<MixDraft>>,
    /// Counts what is more than a change of one field: texts that were typed before do not count any more.
    pub(super) edition: RwSignal<u32>,
    /// What the mix makes of the inputs; none while something is wrong with it.
    pub(super) live: RwSignal<Option<Mixed>>,
    /// What the inputs read.
    pub(super) readings: RwSignal<Readings>,
    /// The field that waits for an input.
    pub(super) learning: RwSignal<Option<Learning>>,
    /// The axis that is moved to its ends.
    pub(super) run: RwSignal<Option<CalibrationRun>>,
    /// A message.
    pub(super) remark: RwSignal<Option<String>>,
    mixer: StoredValue<Option<Mixer>>,
    looks: StoredValue<u32>,
    /// What was sent to be kept.
    sent: StoredValue<Option<Profile>>,
    seat: StoredValue<Option<Seat>>,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self {
            open: RwSignal::new(false),
            draft: RwSignal::new(None),
            edition: RwSignal::new(0),
            live: RwSignal::new(None),
            readings: RwSignal::new(Readings::default()),
            learning: RwSignal::new(None),
            run: RwSignal::new(None),
            remark: RwSignal::new(None),
            mixer: StoredValue::new(None),
            looks: StoredValue::new(0),
            sent: StoredValue::new(None),
            seat: StoredValue::new(None),
        }
    }

    /// Whether a mix is edited.
    pub(crate) fn is_open(self) -> bool {
        self.open.get_untracked()
    }

    /// The same for views that follow it.
    pub(crate) fn is_open_now(self) -> bool {
        self.open.get()
    }

    /// Opens the editor with the mix that drives, or closes it. What is not saved waits for the next time.
    pub(crate) fn toggle(self, seat: Seat) {
        self.seat.set_value(Some(seat));
        self.learning.set(None);
        self.run.set(None);
        self.open.update(|open| *open = !*open);
        if !self.is_open() {
            seat.apply();
            return;
        }
        let is_unsaved = |draft: &Option<MixDraft>| draft.as_ref().is_some_and(MixDraft::is_changed);
        if self.draft.with_untracked(is_unsaved) {
            self.follow();
            return;
        }
        let profile = seat.shall_drive();
        let kept = seat.kept.get_untracked();
        if kept.contains(&profile) {
            self.load(MixDraft::of_kept(profile));
            let flown = seat.driver.with_value(Driver::trimmed);
            self.change(|draft| draft.take_trims(&flown));
        } else if let Ok(copy) = MixDraft::copy_of(words(), &profile, &kept) {
            self.load(copy);
        }
    }

    /// Edits this mix from now on.
    pub(super) fn load(self, draft: MixDraft) {
        self.remark.set(None);
        self.draft.set(Some(draft));
        self.renew();
        self.follow();
    }

    /// Changes the mix.
    pub(super) fn change(self, apply: impl FnOnce(&mut MixDraft)) {
        self.draft.update(|draft| {
            if let Some(draft) = draft {
                apply(draft);
            }
        });
        self.follow();
    }

    /// Changes more than one field.
    pub(super) fn rearrange(self, apply: impl FnOnce(&mut MixDraft)) {
        self.learning.set(None);
        self.run.set(None);
        self.change(apply);
        self.renew();
    }

    fn renew(self) {
        self.edition.update(|edition| *edition = edition.wrapping_add(1));
    }

    /// The bars follow what the mix has become.
    fn follow(self) {
        let Some(profile) = self.profile() else { return };
        if let Some(seat) = self.seat.get_value() {
            seat.driver.update_value(|driver| driver.take_keys_of(&profile));
        }
        let mixer = Mixer::new(profile).ok();
        if mixer.is_none() {
            self.live.set(None);
        }
        self.mixer.set_value(mixer);
    }

    fn profile(self) -> Option<Profile> {
        self.draft
            .with_untracked(|draft| draft.as_ref().map(|draft| draft.profile().clone()))
    }

    /// What the draft says; a view that asks follows it.
    pub(super) fn of_draft<T: Default>(self, ask: impl FnOnce(&MixDraft) -> T) -> T {
        self.draft
            .with(|draft| draft.as_ref().map(ask).unwrap_or_default())
    }

    /// What of the inputs the mix makes now.
    pub(super) fn of_live<T>(self, ask: impl FnOnce(&Mixed) -> Option<T>) -> Option<T> {
        self.live.with(|live| live.as_ref().and_then(ask))
    }

    /// What of a line the bars show.
    pub(super) fn stages(self, output: usize, line: usize) -> Option<LineStages> {
        self.mixed_output(output, |output| output.lines.get(line).copied())
    }

    /// What of an output the bars show.
    pub(super) fn mixed_output<T>(
        self,
        output: usize,
        ask: impl FnOnce(&MixedOutput) -> Option<T>,
    ) -> Option<T> {
        self.live.with(|live| {
            live.as_ref()
                .and_then(|mixed| mixed.outputs.get(output))
                .and_then(ask)
        })
    }

    /// Looks at the inputs.
    pub(crate) fn step(self, now_us: u64, readings: &Readings) {
        self.learn(readings);
        if self.run.with_untracked(Option::is_some) {
            self.run.update(|run| {
                if let Some(run) = run {
                    run.look(readings);
                }
            });
        }
        let mixed = self
            .mixer
            .try_update_value(|mixer| mixer.as_mut().map(|mixer| mixer.step(now_us, readings)));
        let looks = self.looks.get_value().wrapping_add(1);
        self.looks.set_value(looks);
        if !looks.is_multiple_of(LOOKS_PER_DRAWING) {
            return;
        }
        let mixed = mixed.flatten();
        set_if_changed(self.live, mixed);
        if self.readings.with_untracked(|shown| shown != readings) {
            self.readings.set(readings.clone());
        }
    }

    fn learn(self, readings: &Readings) {
        if self.learning.with_untracked(Option::is_none) {
            return;
        }
        let found = self.learning.try_update_untracked(|learning| {
            let learning = learning.as_mut()?;
            Some((learning.field, learning.look(readings)?))
        });
        if let Some((field, source)) = found.flatten() {
            self.learning.set(None);
            self.change(|draft| draft.set(field, &source.to_string()));
            self.renew();
        }
    }

    /// Waits for an input for this field, or not any more.
    pub(super) fn toggle_learning(self, field: Field) {
        let waits = self.waits(field);
        self.renew();
        self.learning
            .set((!waits).then(|| Learning::begin(field, &self.readings.get_untracked())));
    }

    /// Whether this field waits for an input.
    pub(super) fn waits(self, field: Field) -> bool {
        self.learning
            .with(|learning| learning.as_ref().is_some_and(|learning| learning.field == field))
    }

    /// A key went down: for the field that waits, if there is one.
    pub(super) fn press_key(self, code: &str) -> bool {
        let key = KeyCode::new(code).filter(|_| self.learning.with_untracked(Option::is_some));
        let (Some(key), Some(seat)) = (key, self.seat.get_value()) else {
            return false;
        };
        seat.driver.update_value(|driver| driver.press(key));
        true
    }

    /// A key went up.
    pub(super) fn lift_key(self, code: &str) {
        if let Some(seat) = self.seat.get_value() {
            seat.driver.update_value(|driver| driver.lift(code));
        }
    }

    /// Begins to calibrate an input that is at rest, or takes what was seen.
    pub(super) fn toggle_calibration(self, place: usize) {
        self.remark.set(None);
        if let Some(run) = self.run.get_untracked().filter(|run| run.place == place) {
            let mut outcome = Ok(());
            self.rearrange(|draft| outcome = draft.calibrate(words(), &run));
            self.remark
                .set(outcome.err().map(|sentence| format!("{sentence}.")));
            return;
        }
        let input = self.draft.with_untracked(|draft| {
            let inputs = &draft.as_ref()?.profile().inputs;
            inputs.get(place).map(|calibration| calibration.input.clone())
        });
        let Some(input) = input else { return };
        let run = self
            .readings
            .with_untracked(|readings| CalibrationRun::begin(place, &input, readings));
        if run.is_none() {
            self.remark.set(Some(absent(&input)));
        }
        self.run.set(run);
    }

    /// The mix as it shall be kept, if nothing is wrong with it, and what the robot kept when the change began.
    pub(crate) fn profile_to_save(self) -> Option<(String, Option<String>)> {
        let is_right = self
            .draft
            .with_untracked(|draft| draft.as_ref().is_some_and(|draft| draft.problem().is_none()));
        let profile = self.profile().filter(|_| is_right)?;
        let text = profile.to_json();
        self.sent.set_value(Some(profile));
        let was = self
            .draft
            .with_untracked(|draft| draft.as_ref().and_then(MixDraft::was));
        Some((text, was))
    }

    /// Somebody else has saved a mix of this name meanwhile: it is told, and another press of Save replaces that.
    pub(crate) fn on_changed_meanwhile(self) {
        self.change(MixDraft::replace_whatever_is_kept);
    }

    /// The robot keeps what was sent; its name.
    pub(crate) fn on_kept(self) -> Option<Name> {
        let sent = self.sent.try_update_value(Option::take).flatten()?;
        let name = sent.name.clone();
        self.remark.set(Some(words().mix.kept.fill([&name])));
        self.change(|draft| draft.on_kept(sent));
        Some(name)
    }

    /// Removes a part of the mix.
    pub(super) fn remove(self, group: Group) {
        self.rearrange(|draft| draft.remove(group));
    }
}

fn absent(input: &Source) -> String {
    words().mix.absent.fill([input])
}
