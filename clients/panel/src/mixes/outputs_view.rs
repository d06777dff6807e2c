//! Outputs of the mix.

use leptos::prelude::*;
use mixer::OutputName;
use panel_logic::{Field, Group, OutputPart, output_title, robot_has};

use super::bars::Bar;
use super::field_view::FieldView;
use super::group_parts::Unfold;
use super::group_problem;
use super::lines_view::Lines;
use crate::language::words;
use crate::store::Store;

#[component]
pub(super) fn Outputs(store: Store) -> impl IntoView {
    let bench = store.bench;
    let count = Memo::new(move |_| bench.of_draft(|draft| draft.profile().outputs.len()));
    let free = Memo::new(move |_| {
        store
            .robot
            .with(|robot| bench.of_draft(|draft| draft.free_outputs(robot.as_ref())))
    });
    let add = move |event| {
        let wanted = event_target_value(&event);
        let name = OutputName::ALL.into_iter().find(|name| name.name() == wanted);
        if let Some(name) = name {
            bench.rearrange(|draft| draft.add_output(name));
        }
    };
    let option =
        |name: OutputName| view! { <option value=name.name()>{output_title(words(), name)}</option> };
    view! {
        <ol class="outputs">
            <For each=move || 0..count.get() key=|output| *output let:output>
                <OutputView store output />
            </For>
        </ol>
        <Show when=move || !free.with(Vec::is_empty)>
            <label class="field">
                {words().mix.add_output}
                <select id="add-output" on:change=add>
                    <option value="">{words().mix.which}</option>
                    {move || free.get().into_iter().map(option).collect_view()}
                </select>
            </label>
        </Show>
    }
}

#[component]
fn OutputView(store: Store, output: usize) -> impl IntoView {
    let bench = store.bench;
    let open = RwSignal::new(false);
    let name = Memo::new(move |_| {
        bench.of_draft(|draft| {
            let outputs = &draft.profile().outputs;
            outputs.get(output).map(|output| output.output)
        })
    });
    let value = Signal::derive(move || bench.mixed_output(output, |output| Some(output.value)));
    let is_absent = Memo::new(move |_| {
        name.get()
            .is_some_and(|name| store.robot.with(|robot| !robot_has(name, robot.as_ref())))
    });
    let group = Group::Output(output);
    view! {
        <li class="output" data-output=move || name.get().map(OutputName::name)>
            <Unfold open>
                <span class="name">{move || name.get().map(|name| output_title(words(), name))}</span>
            </Unfold>
            <Bar label=words().mix.output value />
            <Show when=move || is_absent.get()>
                <p class="hint absent">{words().mix.not_on_robot}</p>
            </Show>
            {group_problem(bench, group)}
            <Show when=move || open.get()>
                <Lines bench output />
                <div class="mix-fields">
                    {OutputPart::ALL
                        .map(|part| view! { <FieldView bench field=Field::Output(output, part) /> })
                        .collect_view()}
                </div>
                <button type="button" class="small" on:click=move |_| bench.remove(group)>{words().mix.remove_output}</button>
            </Show>
        </li>
    }
}
