//! What is said over the page, wherever it is scrolled to: refusals with their remedy, and what became of a press.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::failure_text;
use rvac_api::RequestBody;

use crate::evidence_view::RecentEvidenceView;
use crate::icons::{Icon, icon};
use crate::language::words;
use crate::store::Store;

/// What needs no answer goes by itself after this.
const NOTE_LASTS: Duration = Duration::from_secs(6);

#[component]
pub(crate) fn Toasts(store: Store) -> impl IntoView {
    view! {
        <div class="toasts">
            <RefusalView store />
            <NoteView store />
            <UndoView store />
        </div>
    }
}

/// A removal that can be taken back.
#[derive(Clone, Debug)]
pub(crate) struct Undo {
    /// What was removed, as a sentence.
    pub(crate) what: String,
    /// What brings it back.
    pub(crate) body: RequestBody,
}

/// Something was removed; here it comes back.
#[component]
fn UndoView(store: Store) -> impl IntoView {
    let take_back = move |_| {
        if let Some(undo) = store.undo.get_untracked() {
            store.ask(undo.body);
        }
        store.undo.set(None);
    };
    view! {
        <div role="status">
            <Show when=move || store.undo.with(Option::is_some)>
                <div class="alert calm" id="undo-toast">
                    <p>{move || store.undo.get().map(|undo| undo.what)}</p>
                    <button type="button" class="small strong" id="undo-removal" on:click=take_back>{words().home.take_back}</button>
                    <button type="button" class="round" aria-label=words().frame.dismiss on:click=move |_| store.undo.set(None)>
                        {icon(Icon::Close)}
                    </button>
                </div>
            </Show>
        </div>
    }
}

/// What became of a press that is not seen otherwise.
#[component]
fn NoteView(store: Store) -> impl IntoView {
    Effect::new(move |_| {
        if store.note.get().is_some() {
            set_timeout(move || store.note.set(None), NOTE_LASTS);
        }
    });
    view! {
        <div role="status">
            <Show when=move || store.note.get().is_some()>
                <div class="alert calm" id="note">
                    {icon(Icon::Bell)}
                    <p>{move || store.note.get()}</p>
                </div>
            </Show>
        </div>
    }
}

/// The last refusal, in words.
#[component]
fn RefusalView(store: Store) -> impl IntoView {
    let text = move || {
        store
            .refusal
            .with(|refusal| refusal.as_ref().map(|refusal| failure_text(words(), refusal)))
    };
    Effect::new(move |_| {
        store.refusal.track();
        store.evidence.set(None);
    });
    view! {
        <div role="alert" class="refusals">
            <Show when=move || text().is_some()>
                <div class="alert" id="refusal">
                    {icon(Icon::Warning)}
                    <div>
                        <p>{text}</p>
                        <Show when=move || store.robot_refused()>
                            <RecentEvidenceView store />
                        </Show>
                    </div>
                    <button type="button" class="round" aria-label=words().frame.dismiss on:click=move |_| store.refusal.set(None)>
                        {icon(Icon::Close)}
                    </button>
                </div>
            </Show>
        </div>
    }
}
