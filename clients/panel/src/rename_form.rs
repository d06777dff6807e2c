//! The line in which a person says what something is called.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;

use crate::focus::focus_on;
use crate::language::words;

/// Longest name, in characters; the robot refuses longer ones.
const NAME_MAX: &str = "40";

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
    let save = move |event: SubmitEvent| {
        event.prevent_default();
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
                        maxlength=NAME_MAX
                        autocomplete="off"
                        prop:value=move || text.get()
                        on:input=move |event| text.set(event_target_value(&event))
                    />
                </label>
                <button type="submit" class="small" id=button_id>{words().frame.save}</button>
            </form>
        </li>
    }
}
