//! The computer in the robot, and one file with everything that a report of a bug needs.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{Row, system_rows};
use rvac_api::{LogEntry, SystemReport};
use serde_json::{Value, json};
use wasm_bindgen::JsCast as _;
use wasm_bindgen_futures::spawn_local;
use web_sys::{Blob, HtmlAnchorElement, Url};

use crate::http;
use crate::language::words;
use crate::store::Store;

const ADDRESS: &str = "/api/system";
/// Heat and memory change slowly.
const RENEW_EVERY: Duration = Duration::from_secs(15);

#[component]
pub(crate) fn SystemSection(store: Store) -> impl IntoView {
    let told = RwSignal::new(None::<SystemReport>);
    let ask = move || {
        spawn_local(async move {
            // While the server is away the page says so elsewhere.
            if let Ok(report) = http::get::<SystemReport>(ADDRESS).await {
                told.try_set(Some(report));
            }
        });
    };
    ask();
    if let Ok(renewal) = set_interval_with_handle(ask, RENEW_EVERY) {
        on_cleanup(move || renewal.clear());
    }
    let texts = &words().system;
    let rows = Memo::new(move |_| {
        let now_s = (js_sys::Date::now() / 1000.0) as i64;
        told.with(|told| told.as_ref().map(|told| system_rows(words(), told, now_s)))
            .unwrap_or_default()
    });
    let save = move |_| save(store, told.get_untracked().as_ref());
    view! {
        <section class="about" id="system" aria-labelledby="system-title">
            <h3 id="system-title">{texts.title}</h3>
            <div class="device">
                <table aria-labelledby="system-title">
                    <tbody>{move || rows.get().into_iter().map(row).collect_view()}</tbody>
                </table>
            </div>
            <p class="hint">{texts.doctor} " " <code>"rvac doctor"</code> "."</p>
            <div><button type="button" class="small" id="save-report" aria-describedby="report-what" on:click=save>{texts.report}</button></div>
            <p class="hint" id="report-what">{texts.report_what}</p>
        </section>
    }
}

fn row(row: Row) -> impl IntoView {
    view! {
        <tr class:alarming=row.alarming>
            <th scope="row">{row.label}</th>
            <td>{row.value}</td>
        </tr>
    }
}

/// Hands the file to the browser.
fn save(store: Store, system: Option<&SystemReport>) {
    let text = serde_json::to_string_pretty(&report(store, system)).unwrap_or_default();
    let date = String::from(js_sys::Date::new_0().to_iso_string());
    let day = date.get(..10).unwrap_or_default();
    let parts = js_sys::Array::of1(&text.into());
    let Ok(blob) = Blob::new_with_str_sequence(&parts) else {
        return;
    };
    let Ok(address) = Url::create_object_url_with_blob(&blob) else {
        return;
    };
    if let Ok(link) = document().create_element("a")
        && let Ok(link) = link.dyn_into::<HtmlAnchorElement>()
    {
        link.set_href(&address);
        link.set_download(&format!("rvac-report-{day}.json"));
        link.click();
    }
    Url::revoke_object_url(&address).ok(); // It was made just above.
}

/// What this page knows. Nothing in it lets anybody in.
fn report(store: Store, system: Option<&SystemReport>) -> Value {
    let log: Vec<LogEntry> = store.log.with_untracked(|log| log.entries().cloned().collect());
    let decisions: Vec<_> = store
        .decisions
        .with_untracked(|book| book.newest_first().cloned().collect());
    json!({
        "page": env!("CARGO_PKG_VERSION"),
        "made": String::from(js_sys::Date::new_0().to_iso_string()),
        "browser": window().navigator().user_agent().unwrap_or_default(),
        "system": system,
        "robot": store.robot.get_untracked(),
        "device": store.device.get_untracked(),
        "status": store.status.get_untracked(),
        "estimate": store.estimate.get_untracked(),
        "standstill": store.standstill.get_untracked(),
        "floors": store.floors.get_untracked(),
        "health": store.health.get_untracked(),
        "learnt": store.learnt.get_untracked(),
        "statistics": store.history.statistics(),
        "runs": store.history.known_runs(),
        "refusal": store.refusal.get_untracked(),
        "decisions": decisions,
        "log": log,
    })
}
