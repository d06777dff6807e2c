//! Trims and flight modes of the mix.

use leptos::prelude::*;
use mixer::{FlightMode, Mixed, TrimValue};
use panel_logic::{Field, Group, MixDraft, ModePart, TrimPart, output_title};

use super::field_view::FieldView;
use super::group_parts::{GroupTools, group_list, switch_state};
use super::{Bench, group_problem};

use crate::language::words;

#[component]
pub(super) fn Trims(bench: Bench) -> impl IntoView {
    let count = Memo::new(move |_| bench.of_draft(|draft| draft.profile().trims.len()));
    let trim = move |trim| view! { <TrimView bench trim /> }.into_any();
    let add = move || bench.rearrange(MixDraft::add_trim);
    view! {
        <p class="hint">{words().mix.trims_hint}</p>
        {group_list("trims", (count, trim), ("add-trim", words().mix.add_trim), add)}
    }
}

#[component]
fn TrimView(bench: Bench, trim: usize) -> impl IntoView {
    let group = Group::Trim(trim);
    let now = move || {
        let value = bench.of_live(|mixed| mixed.trims.get(trim).copied());
        value.map(|TrimValue { output, value }| {
            let percent = words().unit.percent.fill([&words().number(100.0 * value, 1)]);
            words()
                .mix
                .trim_now
                .fill([&output_title(words(), output), &percent])
        })
    };
    view! {
        <li>
            <p class="switch-state">{now}</p>
            {group_problem(bench, group)}
            <div class="mix-fields">
                {TrimPart::ALL
                    .map(|part| view! { <FieldView bench field=Field::Trim(trim, part) /> })
                    .collect_view()}
            </div>
            <button type="button" class="small" on:click=move |_| bench.remove(group)>{words().mix.remove_trim}</button>
        </li>
    }
}

#[component]
pub(super) fn Modes(bench: Bench) -> impl IntoView {
    let count = Memo::new(move |_| bench.of_draft(|draft| draft.profile().modes.len()));
    let mode = move |mode| view! { <ModeView bench mode /> }.into_any();
    let add = move || bench.rearrange(|draft| draft.add_mode(words()).unwrap_or_default());
    view! {
        <p class="hint">{words().mix.modes_hint}</p>
        {group_list("modes", (count, mode), ("add-mode", words().mix.add_mode), add)}
    }
}

#[component]
fn ModeView(bench: Bench, mode: usize) -> impl IntoView {
    let group = Group::Mode(mode);
    let holds = Memo::new(move |_| bench.of_live(|mixed| mixed.mode) == Some(mode));
    view! {
        <li>
            {switch_state(holds)}
            {group_problem(bench, group)}
            <div class="mix-fields">
                {ModePart::ALL
                    .map(|part| view! { <FieldView bench field=Field::Mode(mode, part) /> })
                    .collect_view()}
            </div>
            <GroupTools bench group is_first=mode == 0 remove=words().mix.remove_mode />
        </li>
    }
}

/// Trims that are away from their middle, and the flight mode that holds, for who drives; nothing where there are none.
pub(crate) fn flight_text(mixed: &Mixed, modes: &[FlightMode]) -> Option<String> {
    let trims = mixed.trims.iter().filter(|trim| trim.value != 0.0);
    let trims = trims.map(|trim| {
        let percent = words()
            .unit
            .percent
            .fill([&words().number(100.0 * trim.value, 1)]);
        format!("{} {percent}", output_title(words(), trim.output))
    });
    let mode = mixed.mode.and_then(|place| modes.get(place));
    let texts: Vec<String> = mode
        .map(|mode| mode.name.to_string())
        .into_iter()
        .chain(trims)
        .collect();
    (!texts.is_empty()).then(|| texts.join(", "))
}
