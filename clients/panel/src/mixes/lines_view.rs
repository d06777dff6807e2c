//! Lines of an output.

use leptos::prelude::*;
use panel_logic::{Field, Group, LinePart};

use super::bars::Bar;
use super::curve_view::Curve;
use super::field_view::FieldView;
use super::group_parts::{GroupTools, Unfold};
use super::points_view::Points;
use super::{Bench, group_problem};

use crate::language::words;

#[component]
pub(super) fn Lines(bench: Bench, output: usize) -> impl IntoView {
    let count = Memo::new(move |_| {
        bench.of_draft(|draft| {
            let outputs = &draft.profile().outputs;
            outputs.get(output).map_or(0, |output| output.lines.len())
        })
    });
    let add = move |_| bench.rearrange(|draft| draft.add_line(words(), output).unwrap_or_default());
    view! {
        <ol class="lines">
            <For each=move || 0..count.get() key=|line| *line let:line>
                <LineView bench output line />
            </For>
        </ol>
        <button type="button" class="small" id=format!("add-line-{output}") on:click=add>{words().mix.add_line}</button>
    }
}

#[component]
fn LineView(bench: Bench, output: usize, line: usize) -> impl IntoView {
    let open = RwSignal::new(false);
    let text = move |part| {
        Memo::new(move |_| bench.of_draft(|draft| Field::Line(output, line, part).text(draft.profile())))
    };
    let (name, input) = (text(LinePart::Name), text(LinePart::Input));
    let group = Group::Line(output, line);
    let total = Signal::derive(move || bench.stages(output, line).map(|stages| stages.total));
    view! {
        <li>
            <Unfold open id=format!("line-{output}-{line}")>
                <span class="name">{name}</span>
                <span class="words">{input}</span>
            </Unfold>
            {group_problem(bench, group)}
            <Show when=move || open.get()>
                <Stages bench output line />
                <Bar label=words().mix.so_far value=total />
                <Curve bench output line />
                <Points bench output line />
                <div class="mix-fields">
                    {LinePart::ALL
                        .map(|part| view! { <FieldView bench field=Field::Line(output, line, part) /> })
                        .collect_view()}
                </div>
                <GroupTools bench group is_first=line == 0 remove=words().mix.remove_line />
            </Show>
        </li>
    }
}

/// What the line makes of its input, one stage after the other.
#[component]
fn Stages(bench: Bench, output: usize, line: usize) -> impl IntoView {
    let stages = move || bench.stages(output, line);
    view! {
        <Bar label=words().mix.input value=Signal::derive(move || stages().and_then(|stages| stages.input)) />
        <Bar label=words().mix.shaped value=Signal::derive(move || stages().map(|stages| stages.shaped)) />
        <Bar label=words().mix.weighted value=Signal::derive(move || stages().map(|stages| stages.weighted)) />
    }
}
