//! Switches of the mix.

use leptos::prelude::*;
use panel_logic::{Field, Group, SwitchPart};

use super::field_view::FieldView;
use super::group_parts::{GroupTools, group_list, switch_state};
use super::{Bench, group_problem};

use crate::language::words;

#[component]
pub(super) fn Switches(bench: Bench) -> impl IntoView {
    let count = Memo::new(move |_| bench.of_draft(|draft| draft.profile().switches.len()));
    let switch = move |switch| view! { <SwitchView bench switch /> }.into_any();
    let add = move || bench.rearrange(|draft| draft.add_switch(words()).unwrap_or_default());
    group_list(
        "switches",
        (count, switch),
        ("add-switch", words().mix.add_switch),
        add,
    )
}

#[component]
fn SwitchView(bench: Bench, switch: usize) -> impl IntoView {
    let group = Group::Switch(switch);
    let is_on = Memo::new(move |_| {
        let live = |mixed: &mixer::Mixed| mixed.switches.get(switch).copied();
        bench
            .live
            .with(|live_now| live_now.as_ref().and_then(live))
            .unwrap_or(false)
    });
    let parts = Memo::new(move |_| {
        bench.of_draft(|draft| {
            let found = draft.profile().switches.get(switch);
            found
                .map(|switch| SwitchPart::of(&switch.on).to_vec())
                .unwrap_or_default()
        })
    });
    view! {
        <li>
            {switch_state(is_on)}
            {group_problem(bench, group)}
            <div class="mix-fields">
                <For each=move || parts.get() key=|part| *part let:part>
                    <FieldView bench field=Field::Switch(switch, part) />
                </For>
            </div>
            <GroupTools bench group is_first=switch == 0 remove=words().mix.remove_switch />
        </li>
    }
}
