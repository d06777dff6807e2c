//! Calibrated inputs of the mix.

use leptos::prelude::*;
use panel_logic::{Field, Group, InputPart};

use super::bars::Bar;
use super::field_view::FieldView;
use super::group_parts::{Unfold, group_list};
use super::{Bench, group_problem};

use crate::language::words;

#[component]
pub(super) fn Inputs(bench: Bench) -> impl IntoView {
    let count = Memo::new(move |_| bench.of_draft(|draft| draft.profile().inputs.len()));
    let input = move |input| view! { <InputView bench input /> }.into_any();
    let add = move || bench.rearrange(panel_logic::MixDraft::add_input);
    group_list(
        "inputs",
        (count, input),
        ("add-input", words().mix.add_input),
        add,
    )
}

#[component]
fn InputView(bench: Bench, input: usize) -> impl IntoView {
    let open = RwSignal::new(false);
    let group = Group::Input(input);
    let source = Memo::new(move |_| {
        bench.of_draft(|draft| {
            draft
                .profile()
                .inputs
                .get(input)
                .map(|calibration| calibration.input.clone())
        })
    });
    let name = move || source.get().map(|source| source.to_string());
    let value = Signal::derive(move || {
        let source = source.get()?;
        bench.readings.with(|readings| readings.value(&source))
    });
    view! {
        <li>
            <Unfold open>
                <span class="name">{name}</span>
            </Unfold>
            {group_problem(bench, group)}
            <Show when=move || open.get()>
                <Bar label=words().mix.reading value />
                <CalibrateButton bench input />
                <div class="mix-fields">
                    {InputPart::ALL
                        .map(|part| view! { <FieldView bench field=Field::Input(input, part) /> })
                        .collect_view()}
                </div>
                <button type="button" class="small" on:click=move |_| bench.remove(group)>
                    {words().mix.read_as_is}
                </button>
            </Show>
        </li>
    }
}

#[component]
fn CalibrateButton(bench: Bench, input: usize) -> impl IntoView {
    let own = move || {
        bench.run.with(|run| {
            run.as_ref()
                .filter(|run| run.place == input)
                .map(|run| run.text(words()))
        })
    };
    view! {
        <div class="mix-tools">
            <button
                type="button"
                class="small"
                id=format!("calibrate-{input}")
                on:click=move |_| bench.toggle_calibration(input)
            >
                {move || if own().is_some() { words().mix.take_ends } else { words().mix.calibrate }}
            </button>
        </div>
        <p class="hint" role="status">{own}</p>
    }
}
