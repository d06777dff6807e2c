//! The page for a device that is not paired.

use std::time::Duration;

use leptos::ev::SubmitEvent;
use leptos::prelude::*;
use pairing::wire::{Forgotten, Joined};

use super::pairing_steps::{invitation, join, pair, wait_for_presses};
use crate::language::words;
use crate::store::Store;

/// The robot is asked this often whether START was held.
const LOOK_EVERY: Duration = Duration::from_secs(2);

/// What is typed, and how far it went.
#[derive(Clone, Copy)]
struct PairForm {
    name: RwSignal<String>,
    code: RwSignal<String>,
    wrong: RwSignal<String>,
    works: RwSignal<bool>,
    /// START was held: presses count, and no code.
    by_presses: RwSignal<bool>,
    /// Why the robot has no paired devices any more.
    forgotten: RwSignal<Option<Forgotten>>,
    /// What to press.
    joined: RwSignal<Option<Joined>>,
}

impl PairForm {
    fn new() -> Self {
        Self {
            name: RwSignal::new(String::new()),
            code: RwSignal::new(String::new()),
            wrong: RwSignal::new(String::new()),
            works: RwSignal::new(false),
            by_presses: RwSignal::new(false),
            forgotten: RwSignal::new(None),
            joined: RwSignal::new(None),
        }
    }

    /// Looks whether START was held, unless the person is in the middle of something.
    fn look(self) {
        leptos::task::spawn_local(async move {
            let Some(invitation) = invitation().await else {
                return;
            };
            if self.works.try_get_untracked() == Some(false) {
                self.by_presses.try_set(invitation.open && invitation.presses);
                self.forgotten.try_set(invitation.forgotten);
            }
        });
    }

    async fn enter(self) -> Result<(), String> {
        if !self.by_presses.get_untracked() {
            return pair(&self.name.get_untracked(), &self.code.get_untracked()).await;
        }
        let joined = join(&self.name.get_untracked()).await?;
        self.joined.set(Some(joined.clone()));
        let outcome = wait_for_presses(&joined).await;
        self.joined.set(None);
        outcome
    }

    fn submit(self, store: Store) {
        if self.works.get_untracked() {
            return;
        }
        self.works.set(true);
        self.wrong.set(String::new());
        leptos::task::spawn_local(async move {
            match self.enter().await {
                Ok(()) => store.connect(),
                Err(text) => self.wrong.set(text),
            }
            self.works.set(false);
        });
    }

    fn button_text(self) -> &'static str {
        let texts = &words().access;
        match (self.by_presses.get(), self.works.get()) {
            (true, true) => texts.waiting,
            (true, false) => texts.show_presses,
            (false, true) => texts.pairing,
            (false, false) => texts.pair,
        }
    }
}

#[component]
pub(crate) fn PairView(store: Store) -> impl IntoView {
    let form = PairForm::new();
    form.look();
    if let Ok(timer) = set_interval_with_handle(move || form.look(), LOOK_EVERY) {
        on_cleanup(move || timer.clear());
    }
    let submit = move |event: SubmitEvent| {
        event.prevent_default();
        form.submit(store);
    };
    view! {
        <main class="pair-page">
            <form class="card pair" id="pair" aria-labelledby="pair-title" on:submit=submit>
                <h2 id="pair-title">{words().access.title}</h2>
                <p class="wrong" role="status" id="pair-forgotten">
                    {move || form.forgotten.get().map(forgotten_text)}
                </p>
                <p class="hint" hidden=move || form.by_presses.get()>
                    {words().access.how_before} <code>"rvac pair"</code> {words().access.how_after}
                </p>
                <p class="hint" role="status" id="pair-by-presses">
                    {move || form.by_presses.get().then_some(words().access.how_presses)}
                </p>
                <label class="field">
                    {words().access.device_name}
                    <input
                        id="pair-name"
                        autocomplete="off"
                        maxlength="40"
                        placeholder=words().access.example_name
                        prop:value=move || form.name.get()
                        on:input=move |event| form.name.set(event_target_value(&event))
                    />
                </label>
                <label class="field" hidden=move || form.by_presses.get()>
                    {words().access.code}
                    <input
                        id="pair-code"
                        inputmode="numeric"
                        autocomplete="one-time-code"
                        maxlength="12"
                        placeholder="1234 5678"
                        prop:value=move || form.code.get()
                        on:input=move |event| form.code.set(event_target_value(&event))
                    />
                </label>
                <PressesView joined=form.joined/>
                <p class="wrong" id="pair-wrong" role="alert">{move || form.wrong.get()}</p>
                <button type="submit" class="small strong" id="pair-now" aria-disabled=move || form.works.get().to_string()>
                    {move || form.button_text()}
                </button>
                <p class="hint">
                    {words().access.trust_before}
                    <a href="/robot.crt" download="robot.crt">{words().access.certificate}</a>
                    {words().access.trust_between} <a href="/robot.mobileconfig">{words().access.profile}</a>
                    {words().access.trust_after} <code>"rvac trust"</code> {words().access.trust_end}
                </p>
            </form>
        </main>
    }
}

fn forgotten_text(why: Forgotten) -> &'static str {
    let texts = &words().access;
    match why {
        Forgotten::Buttons => texts.forgotten_buttons,
        Forgotten::File => texts.forgotten_file,
        Forgotten::Console => texts.forgotten_console,
    }
}

/// What to press, as a sentence and as dots.
#[component]
fn PressesView(joined: RwSignal<Option<Joined>>) -> impl IntoView {
    let told = move || {
        let [first, second] = joined.get()?.presses;
        Some(words().access.presses.fill([&first, &second]))
    };
    let dots = move || {
        let [first, second] = joined.get()?.presses.map(|count| "●".repeat(usize::from(count)));
        Some(format!("{first}   {second}"))
    };
    view! {
        <div role="status" id="pair-presses" class="presses">
            <p>{told}</p>
            <p class="dots" aria-hidden="true">{dots}</p>
        </div>
    }
}
