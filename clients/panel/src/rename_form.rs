//! The line in which a person says what something is called.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;
use panel_logic::name_problem_text;

use crate::focus::focus_on;
use crate::language::words;

/// `on_save` gets the name; none when the line was emptied.
#[component]
pub(crate) fn RenameForm(
    label: String,
    field_id: &'static str,
    button_id: &'static str,
    name: String,
    /// The button that has opened it, which gets the focus back.
    opener: String,
    on_save: impl Fn(Option<String>) + 'static,
) -> impl IntoView {
    let text = RwSignal::new(name);
    let problem = move || name_problem_text(words(), &text.get());
    let save = move |event: SubmitEvent| {
        event.prevent_default();
        if name_problem_text(words(), &text.get_untracked()).is_some() {
            focus_on(field_id);
            return;
        }
        focus_on(&opener);
        on_save(Some(text.get_untracked()).filter(|name| !name.trim().is_empty()));
    };
    view! {
        <li>
            <form class="rename" on:submit=save>
                <label class="field grow">
                    {label}
                    <input
                        id=field_id
                        autocomplete="off"
                        aria-describedby=format!("{field_id}-wrong")
                        prop:value=move || text.get()
                        on:input=move |event| text.set(event_target_value(&event))
                    />
                </label>
                <button type="submit" class="small" id=button_id>{words().frame.save}</button>
            </form>
            <p class="wrong" role="alert" id=format!("{field_id}-wrong")>{problem}</p>
        </li>
    }
}
