//! Lending the stick, the tilt and the gamepad of this device to whoever drives at another one.

use leptos::prelude::*;
use mixer::Name;
use panel_logic::{LENT_NAME_MAX, Lending, lending_text, lent_name};

use crate::access::Needs;
use crate::language::words;
use crate::store::Store;

/// Under this name the browser keeps the one of what is lent.
const KEY: &str = "lend-name";
/// What lending asks the robot for.
const LENDS: &str = "set-inputs";

fn remembered() -> String {
    let storage = window().local_storage().ok().flatten();
    let kept = storage.and_then(|storage| storage.get_item(KEY).ok().flatten());
    kept.unwrap_or_else(|| words().drive.lend_usual.to_owned())
}

fn remember(name: &Name) {
    if let Ok(Some(storage)) = window().local_storage() {
        storage.set_item(KEY, name.as_str()).ok(); // Without storage it lasts as long as the page.
    }
}

#[component]
pub(crate) fn LendView(store: Store) -> impl IntoView {
    let seat = store.seat;
    let text = RwSignal::new(remembered());
    let wrong = RwSignal::new(None::<String>);
    let press = move |_| {
        if seat.is_lent.get_untracked() {
            return store.take_back();
        }
        match lent_name(words(), &text.get_untracked()) {
            Ok(name) => {
                wrong.set(None);
                remember(&name);
                store.lend(name);
            }
            Err(told) => wrong.set(Some(told)),
        }
    };
    view! {
        <details class="folded lend" id="lending">
            <summary>{words().drive.lend_title}</summary>
            <p class="hint">{words().drive.lend_how}</p>
            <Needs store verb=LENDS>
                <div class="order-tools">
                    <label class="field grow">
                        {words().drive.lend_name}
                        <input
                            id="lend-name"
                            maxlength=LENT_NAME_MAX.to_string()
                            autocomplete="off"
                            disabled=move || seat.is_lent.get()
                            prop:value=move || text.get()
                            on:input=move |event| text.set(event_target_value(&event))
                        />
                    </label>
                    <button
                        type="button"
                        class="small"
                        class:strong=move || !seat.is_lent.get()
                        id="lend"
                        on:click=press
                    >
                        {move || if seat.is_lent.get() { words().drive.lend_end } else { words().drive.lend }}
                    </button>
                </div>
            </Needs>
            <p class="wrong" id="lend-wrong" role="status">{move || wrong.get()}</p>
        </details>
    }
}

/// That it is lent, as what, and who drives.
#[component]
pub(super) fn LentState(store: Store) -> impl IntoView {
    let seat = store.seat;
    let driver = Memo::new(move |_| {
        store
            .status
            .with(|status| status.as_ref().and_then(|status| status.driver.clone()))
    });
    let state = move || {
        let told = || lending_text(words(), &seat.passed_on.get(), driver.get().as_deref());
        seat.is_lent.get().then(told)
    };
    view! {
        <p class="remark" id="lend-state" role="status" hidden=move || !seat.is_lent.get()>{state}</p>
    }
}

impl Store {
    /// Lends what hands do here; this device lets go of the robot itself.
    fn lend(self, name: Name) {
        if self.admits(LENDS) {
            self.refusal.set(None);
            self.seat.lending.update_value(|lending| lending.begin(name));
            self.seat.is_lent.set(true);
        }
    }

    /// Lends nothing any more.
    fn take_back(self) {
        self.say_of_lent(Lending::end);
        self.seat.is_lent.set(false);
        self.seat.passed_on.set(Vec::new());
    }

    /// Reads all inputs, and sends their values to the robot.
    pub(super) fn lend_step(self) {
        let now_us = self.step_aside();
        let seat = self.seat;
        let said = seat.driver.with_value(|driver| {
            seat.lending
                .try_update_value(|lending| lending.step(now_us, driver.readings()))
        });
        self.say_lent(said.flatten());
    }

    /// The lent inputs have another use for the moment, or the page is not visible.
    pub(crate) fn pause_lending(self) {
        self.say_of_lent(Lending::pause);
    }

    /// The robot does not take what is lent.
    pub(crate) fn on_lending_refused(self) {
        self.take_back();
    }

    fn say_of_lent(self, change: impl FnOnce(&mut Lending) -> Option<rvac_api::RequestBody>) {
        let said = self.seat.lending.try_update_value(change);
        self.say_lent(said.flatten());
    }
}
