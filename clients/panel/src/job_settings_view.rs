//! Power and pattern of a job, as two fields of a form.

use leptos::prelude::*;
use panel_logic::{JobSettings, SettingChoice};

use crate::language::words;

/// `place` begins the identities of the fields.
#[component]
pub(crate) fn JobSettingsFields(
    place: &'static str,
    #[prop(into)] settings: Signal<JobSettings>,
    change: Callback<JobSettings>,
) -> impl IntoView {
    let choose_power = move |event| {
        let mut settings = settings.get_untracked();
        settings.choose_power(&event_target_value(&event));
        change.run(settings);
    };
    let choose_pattern = move |event| {
        let mut settings = settings.get_untracked();
        settings.choose_pattern(&event_target_value(&event));
        change.run(settings);
    };
    view! {
        <label class="field">
            {words().home.job_power}
            <select id=format!("{place}-power") on:change=choose_power>
                {move || options(settings.with(|settings| settings.powers(words())))}
            </select>
        </label>
        <label class="field">
            {words().home.set_pattern}
            <select id=format!("{place}-pattern") on:change=choose_pattern>
                {move || options(settings.with(|settings| settings.patterns(words())))}
            </select>
        </label>
    }
}

fn options(choices: Vec<SettingChoice>) -> impl IntoView {
    choices
        .into_iter()
        .map(|choice| view! { <option value=choice.code selected=choice.is_chosen>{choice.text}</option> })
        .collect_view()
}
