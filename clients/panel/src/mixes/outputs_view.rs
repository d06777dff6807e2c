//! Outputs of the mix.

use leptos::prelude::*;
use mixer::OutputName;
use panel_logic::{Field, Group, OutputPart};

use super::bars::Bar;
use super::field_view::FieldView;
use super::group_parts::Unfold;
use super::lines_view::Lines;
use super::{Bench, group_problem};

#[component]
pub(super) fn Outputs(bench: Bench) -> impl IntoView {
    let count = Memo::new(move |_| bench.of_draft(|draft| draft.profile().outputs.len()));
    let free = Memo::new(move |_| bench.of_draft(panel_logic::MixDraft::free_outputs));
    let add = move |event| {
        let wanted = event_target_value(&event);
        let name = OutputName::ALL.into_iter().find(|name| name.name() == wanted);
        if let Some(name) = name {
            bench.rearrange(|draft| draft.add_output(name));
        }
    };
    let option = |name: OutputName| view! { <option value=name.name()>{words(name.name())}</option> };
    view! {
        <ol class="outputs">
            <For each=move || 0..count.get() key=|output| *output let:output>
                <OutputView bench output />
            </For>
        </ol>
        <Show when=move || !free.with(Vec::is_empty)>
            <label class="field">
                "Add an output"
                <select id="add-output" on:change=add>
                    <option value="">"Which?"</option>
                    {move || free.get().into_iter().map(option).collect_view()}
                </select>
            </label>
        </Show>
    }
}

/// The name of an output as people write it.
fn words(name: &'static str) -> String {
    name.replace('-', " ")
}

#[component]
fn OutputView(bench: Bench, output: usize) -> impl IntoView {
    let open = RwSignal::new(false);
    let name = Memo::new(move |_| {
        bench.of_draft(|draft| {
            let outputs = &draft.profile().outputs;
            outputs.get(output).map(|output| output.output.name())
        })
    });
    let value = Signal::derive(move || bench.mixed_output(output, |output| Some(output.value)));
    let group = Group::Output(output);
    view! {
        <li class="output" data-output=move || name.get().unwrap_or_default()>
            <Unfold open>
                <span class="name">{move || name.get().map(words)}</span>
            </Unfold>
            <Bar label="Output" value />
            {group_problem(bench, group)}
            <Show when=move || open.get()>
                <Lines bench output />
                <div class="mix-fields">
                    {OutputPart::ALL
                        .map(|part| view! { <FieldView bench field=Field::Output(output, part) /> })
                        .collect_view()}
                </div>
                <button type="button" class="small" on:click=move |_| bench.remove(group)>"Remove this output"</button>
            </Show>
        </li>
    }
}
