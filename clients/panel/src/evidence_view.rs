//! Why the robot stands still: sensor readings in the seconds before, and what it tried.

use leptos::prelude::*;
use panel_logic::{EvidenceRow, MapPoint, decision_text, evidence_rows};
use rvac_api::{Evidence, Standstill, Status};

use crate::language::words;
use crate::store::Store;

/// Of the present standstill, folded; nothing while the robot works or was ordered to stop.
#[component]
pub(crate) fn StandstillView(store: Store) -> impl IntoView {
    let told = Memo::new(move |_| going_on(store));
    let place = Memo::new(move |_| {
        let told = told.get().filter(|told| !told.lost);
        told.map(|told| MapPoint::new(told.place.x, told.place.y))
    });
    Effect::new(move |_| {
        let place = place.get();
        store.map.with_value(|map| map.mark_stop(place));
    });
    let evidence = Memo::new(move |_| {
        told.get()
            .map(|told| told.evidence)
            .filter(|felt| !felt.is_empty())
    });
    move || evidence.get().map(|evidence| view! { <EvidenceView evidence /> })
}

/// The last reported standstill, if it still lasts.
fn going_on(store: Store) -> Option<Standstill> {
    let told = store.standstill.get()?;
    let is_now = store.status.with(|status| {
        let fits = |status: &Status| status.state == told.state && status.reason == told.reason;
        status.as_ref().is_some_and(fits)
    });
    is_now.then_some(told)
}

/// Of a refusal: asked for when it is unfolded, because most are clear without.
#[component]
pub(crate) fn RecentEvidenceView(store: Store) -> impl IntoView {
    let ask = move |_| {
        if store.evidence.with_untracked(Option::is_none) {
            store.ask_for_evidence();
        }
    };
    view! {
        <details class="evidence" on:toggle=ask>
            <summary>{words().evidence.title}</summary>
            {move || store.evidence.get().map(|evidence| view! { <EvidenceTables evidence /> })}
        </details>
    }
}

/// As a part of the page that unfolds.
#[component]
pub(crate) fn EvidenceView(evidence: Evidence) -> impl IntoView {
    view! {
        <details class="evidence">
            <summary>{words().evidence.title}</summary>
            <EvidenceTables evidence />
        </details>
    }
}

#[component]
fn EvidenceTables(evidence: Evidence) -> impl IntoView {
    let texts = &words().evidence;
    let rows = evidence_rows(words(), &evidence);
    let tried: Vec<String> = evidence
        .tried
        .iter()
        .map(|entry| decision_text(words(), entry))
        .collect();
    let has_tried = !tried.is_empty();
    view! {
        <table>
            <caption>{texts.felt}</caption>
            <thead>
                <tr>
                    <th scope="col">{texts.when}</th>
                    <th scope="col">{texts.motion}</th>
                    <th scope="col">{texts.signs}</th>
                    <th scope="col">{texts.echo}</th>
                </tr>
            </thead>
            <tbody>{rows.into_iter().map(row).collect_view()}</tbody>
        </table>
        <Show when=move || has_tried>
            <p class="tried">{texts.tried}</p>
        </Show>
        <ol class="sentences">{tried.into_iter().map(|text| view! { <li>{text}</li> }).collect_view()}</ol>
    }
}

fn row(
    EvidenceRow {
        when,
        motion,
        echo,
        signs,
    }: EvidenceRow,
) -> impl IntoView {
    view! {
        <tr>
            <td>{when}</td>
            <td>{motion}</td>
            <td>{signs}</td>
            <td>{echo}</td>
        </tr>
    }
}
