//! What became of the last job, while the robot rests.

use leptos::prelude::*;
use panel_logic::run_summary;
use rvac_api::RequestBody;

use crate::history::date_text;
use crate::language::words;
use crate::store::Store;

impl Store {
    /// Asks for the newest run: whoever opens the page wants to know what became of it.
    pub(crate) fn ask_for_last_run(self) {
        self.ask_quietly(RequestBody::Runs {
            before: None,
            count: Some(1),
        });
    }
}

#[component]
pub(crate) fn SummaryView(store: Store) -> impl IntoView {
    let summary = Memo::new(move |_| {
        let run = store.history.newest()?;
        let summary = run_summary(words(), &run)?;
        Some((run.end_s.map(|end_s| date_text(Some(end_s))), summary))
    });
    view! {
        <Show when=move || store.rests() && summary.get().is_some()>
            <p class="summary" id="summary">
                <strong>{words().status.last_job}</strong>
                " "
                {move || summary.get().and_then(|(ended, _)| ended).map(|ended| view! { <span class="when">{ended}</span> " " })}
                {move || summary.get().map(|(_, text)| text)}
            </p>
        </Show>
    }
}
