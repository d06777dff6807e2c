//! The editor of control mixes: outputs with their lines, switches, calibrations, each with bars that follow the inputs.

mod bars;
mod bench;
mod curve_view;
mod field_view;
mod flight_view;
mod group_parts;
mod inputs_view;
mod lines_view;
mod outputs_view;
mod points_view;
mod switches_view;
mod tools;

use leptos::ev;
use leptos::prelude::*;
use mixer::MixState;
use panel_logic::{Field, Group, MixDraft};

use crate::access::{EDITS_MIXES, OnlyLooks};
use crate::language::words;
use crate::store::Store;
use field_view::FieldView;
use flight_view::{Modes, Trims};
use inputs_view::Inputs;
use outputs_view::Outputs;
use switches_view::Switches;
use tools::{SaveBar, Tools};

pub(crate) use bench::Bench;
pub(crate) use flight_view::flight_text;

#[component]
pub(crate) fn MixEditor(store: Store) -> impl IntoView {
    let bench = store.bench;
    listen_to_keys(bench);
    let state = move || match bench.live.with(|live| live.as_ref().map(|mixed| mixed.state)) {
        Some(MixState::Live) => "",
        Some(MixState::Failsafe) => words().mix.failsafe_state,
        None => words().mix.stands,
    };
    view! {
        <section class="mixes" id="mixes" aria-label=words().mix.editor>
            <OnlyLooks store verb=EDITS_MIXES />
            <Tools store />
            <FieldView bench field=Field::MixName />
            <p class="hint" role="status" id="mix-state">{state}</p>
            <h3>{words().mix.outputs}</h3>
            <Outputs store />
            <h3>{words().mix.switches}</h3>
            <Switches bench />
            <h3>{words().mix.trims}</h3>
            <Trims bench />
            <h3>{words().mix.modes}</h3>
            <Modes bench />
            <h3>{words().mix.inputs}</h3>
            <Inputs bench />
            <SaveBar store />
        </section>
    }
}

/// While a field waits for an input every key but Tab and Escape is one.
fn listen_to_keys(bench: Bench) {
    let down = window_event_listener(ev::keydown, move |event| match event.code().as_str() {
        "Tab" => {}
        "Escape" => bench.learning.set(None),
        code => {
            if bench.press_key(code) {
                event.prevent_default();
            }
        }
    });
    let up = window_event_listener(ev::keyup, move |event| {
        bench.lift_key(&event.code());
    });
    on_cleanup(move || {
        down.remove();
        up.remove();
    });
}

/// A page that is left, or reloaded in another language, has the browser ask first while a mix is not saved.
pub(crate) fn ask_before_leaving(bench: Bench) {
    let leaving = window_event_listener(ev::beforeunload, move |event| {
        if bench
            .draft
            .with_untracked(|draft| draft.as_ref().is_some_and(MixDraft::is_changed))
        {
            event.prevent_default();
        }
    });
    on_cleanup(move || leaving.remove());
}

/// What is wrong with a group as a whole.
fn group_problem(bench: Bench, group: Group) -> impl IntoView {
    let problem = Memo::new(move |_| {
        bench
            .of_draft(|draft| draft.problem_with(group))
            .map(|problem| problem.text(words()))
    });
    view! {
        <Show when=move || problem.with(Option::is_some)>
            <p class="problem" role="alert">{move || problem.get()}</p>
        </Show>
    }
}
