//! A field for a time of day on 24 hours, as all times of the page are. The browser's own asks for AM or PM where it was made for that.

use leptos::prelude::*;
use panel_logic::time_of_day;

#[component]
pub(super) fn ClockField(
    id: &'static str,
    label: &'static str,
    #[prop(into)] at: Signal<String>,
    #[prop(into)] change: Callback<String>,
) -> impl IntoView {
    let complete = move |event| {
        if let Some(at) = time_of_day(&event_target_value(&event)) {
            change.run(at);
        }
    };
    view! {
        <label class="field">
            {label}
            <input
                id=id
                inputmode="numeric"
                autocomplete="off"
                maxlength="5"
                placeholder="00:00"
                prop:value=move || at.get()
                on:input=move |event| change.run(event_target_value(&event))
                on:change=complete
            />
        </label>
    }
}
