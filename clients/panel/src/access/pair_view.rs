//! What a device sees that the robot does not know.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;

use super::pairing_steps::pair;
use crate::store::Store;

#[component]
pub(crate) fn PairView(store: Store) -> impl IntoView {
    let (name, code) = (RwSignal::new(String::new()), RwSignal::new(String::new()));
    let (wrong, works) = (RwSignal::new(String::new()), RwSignal::new(false));
    let submit = move |event: SubmitEvent| {
        event.prevent_default();
        if works.get_untracked() {
            return;
        }
        works.set(true);
        wrong.set(String::new());
        leptos::task::spawn_local(async move {
            match pair(&name.get_untracked(), &code.get_untracked()).await {
                Ok(()) => store.connect(),
                Err(text) => wrong.set(text),
            }
            works.set(false);
        });
    };
    view! {
        <main class="pair-page">
            <form class="card pair" id="pair" aria-labelledby="pair-title" on:submit=submit>
                <h2 id="pair-title">"Pair this device with the robot"</h2>
                <p class="hint">
                    "Run "<code>"rvac pair"</code>" on the robot, or choose “Add a device” on a device that is its administrator. "
                    "The robot beeps and a code of eight digits is shown, which holds for two minutes."
                </p>
                <label class="field">
                    "Name of this device"
                    <input
                        id="pair-name"
                        autocomplete="off"
                        maxlength="40"
                        placeholder="Mari's phone"
                        prop:value=move || name.get()
                        on:input=move |event| name.set(event_target_value(&event))
                    />
                </label>
                <label class="field">
                    "Code"
                    <input
                        id="pair-code"
                        inputmode="numeric"
                        autocomplete="one-time-code"
                        maxlength="12"
                        placeholder="1234 5678"
                        prop:value=move || code.get()
                        on:input=move |event| code.set(event_target_value(&event))
                    />
                </label>
                <p class="wrong" id="pair-wrong" role="alert">{move || wrong.get()}</p>
                <button type="submit" class="small strong" id="pair-now" aria-disabled=move || works.get().to_string()>
                    {move || if works.get() { "Pairing …" } else { "Pair" }}
                </button>
                <p class="hint">
                    "No warning from the browser next time: install the "
                    <a href="/robot.crt" download="robot.crt">"robot's certificate"</a>" ("
                    <a href="/robot.mobileconfig">"profile for iPhones"</a>
                    ") after comparing its fingerprint with what "<code>"rvac trust"</code>" shows on the robot."
                </p>
            </form>
        </main>
    }
}
