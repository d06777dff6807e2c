//! A button that asks a person for a file.

use leptos::prelude::*;
use wasm_bindgen::JsCast;
use web_sys::{File, HtmlInputElement};

/// The button `id`, and behind it the field `file_id`, which browsers show as something of their own.
#[component]
pub(crate) fn FileButton(
    id: &'static str,
    file_id: &'static str,
    /// On the button.
    text: &'static str,
    /// What the file is, for those who do not see it.
    label: &'static str,
    /// Which files are offered.
    accept: &'static str,
    disabled: Signal<bool>,
    on_file: impl Fn(File) + 'static,
) -> impl IntoView {
    let field = NodeRef::<leptos::html::Input>::new();
    let open = move |_| {
        if let Some(field) = field.get_untracked() {
            field.click();
        }
    };
    let read = move |event: leptos::ev::Event| {
        let field = event
            .target()
            .and_then(|target| target.dyn_into::<HtmlInputElement>().ok());
        let Some(field) = field else { return };
        if let Some(file) = field.files().and_then(|files| files.get(0)) {
            on_file(file);
        }
        // The same file can be chosen again after it was corrected.
        field.set_value("");
    };
    view! {
        <button type="button" class="small" id=id disabled=move || disabled.get() on:click=open>{text}</button>
        <input
            node_ref=field
            type="file"
            id=file_id
            accept=accept
            class="visually-hidden"
            tabindex="-1"
            aria-label=label
            on:change=read
        />
    }
}
