//! What a device sees that the robot does not know.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;

use super::pairing_steps::pair;
use crate::language::words;
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
                <h2 id="pair-title">{words().access.title}</h2>
                <p class="hint">
                    {words().access.how_before} <code>"rvac pair"</code> {words().access.how_after}
                </p>
                <label class="field">
                    {words().access.device_name}
                    <input
                        id="pair-name"
                        autocomplete="off"
                        maxlength="40"
                        placeholder=words().access.example_name
                        prop:value=move || name.get()
                        on:input=move |event| name.set(event_target_value(&event))
                    />
                </label>
                <label class="field">
                    {words().access.code}
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
                    {move || if works.get() { words().access.pairing } else { words().access.pair }}
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
