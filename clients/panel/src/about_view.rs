//! What this is, under which licence, and where its source and its guide are.

use leptos::prelude::*;

use crate::language::words;
use crate::store::Store;

/// Where the source of this page is, as the AGPL asks for.
const SOURCE: &str = env!("CARGO_PKG_REPOSITORY");

#[component]
pub(crate) fn AboutView(store: Store) -> impl IntoView {
    let texts = &words().about;
    let brain = move || {
        store.device.with(|table| {
            table
                .as_ref()
                .map(|table| texts.daemon.fill([&table.versions.vthal, &table.versions.brain]))
        })
    };
    view! {
        <section class="about" id="about" aria-labelledby="about-title">
            <h3 id="about-title">{texts.title}</h3>
            <p>{texts.what}</p>
            <p>{texts.page.fill([&env!("CARGO_PKG_VERSION")])} " " {brain}</p>
            <p>{texts.licence}</p>
            <p>
                <a href=SOURCE target="_blank" rel="noreferrer">{texts.source}</a>
            </p>
            <p class="hint">{texts.help} " " {texts.doctor} " " <code>"rvac doctor"</code> "."</p>
        </section>
    }
}
