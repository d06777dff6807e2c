//! One field of the form, with what is wrong with it beside.

use leptos::prelude::*;
use panel_logic::{Field, FieldKind};

use super::Bench;

use crate::language::words;

#[component]
pub(super) fn FieldView(bench: Bench, field: Field) -> impl IntoView {
    let kind = Memo::new(move |_| {
        bench
            .draft
            .with(|draft| draft.as_ref().map(|draft| field.kind(words(), draft.profile())))
    });
    let problem = Memo::new(move |_| {
        bench
            .of_draft(|draft| draft.problem_of(field))
            .map(|problem| problem.text(words()))
    });
    let problem_id = format!("{}-problem", field.id());
    let control = move || match kind.get() {
        None => ().into_any(),
        Some(FieldKind::Check) => view! { <Check bench field /> }.into_any(),
        Some(FieldKind::Choice(choices)) => view! { <Choice bench field choices /> }.into_any(),
        Some(FieldKind::Text) => view! { <Written bench field mode="text" problem /> }.into_any(),
        Some(FieldKind::Number) => view! { <Written bench field mode="decimal" problem /> }.into_any(),
        Some(FieldKind::Source) => view! {
            <span class="with-set">
                <Written bench field mode="text" problem />
                <SetButton bench field />
            </span>
        }
        .into_any(),
    };
    view! {
        <div class="mix-field" class:wrong=move || problem.with(Option::is_some)>
            <label for=field.id()>{field.label(words())}</label>
            {control}
            <p class="problem" id=problem_id role="alert">{move || problem.get()}</p>
        </div>
    }
}

fn text_of(bench: Bench, field: Field) -> Memo<String> {
    Memo::new(move |_| bench.of_draft(|draft| field.text(draft.profile())))
}

/// A text that is typed. What is typed stays as it is until the field is left and nothing is wrong with it.
#[component]
fn Written(bench: Bench, field: Field, mode: &'static str, problem: Memo<Option<String>>) -> impl IntoView {
    let text = text_of(bench, field);
    let typed = RwSignal::new(None::<(u32, String)>);
    let shown = move || {
        let edition = bench.edition.get();
        typed
            .get()
            .filter(|(when, _)| *when == edition)
            .map_or_else(|| text.get(), |(_, typed)| typed)
    };
    let on_input = move |event| {
        let value = event_target_value(&event);
        typed.set(Some((bench.edition.get_untracked(), value.clone())));
        bench.change(|draft| draft.set(field, &value));
    };
    let on_leave = move |_| {
        if problem.with_untracked(Option::is_none) {
            typed.set(None);
        }
    };
    view! {
        <input
            id=field.id()
            autocomplete="off"
            spellcheck="false"
            inputmode=mode
            aria-invalid=move || if problem.with(Option::is_some) { "true" } else { "false" }
            aria-describedby=format!("{}-problem", field.id())
            prop:value=shown
            on:input=on_input
            on:blur=on_leave
        />
    }
}

#[component]
fn Check(bench: Bench, field: Field) -> impl IntoView {
    let text = text_of(bench, field);
    let choose = move |event| {
        let value = event_target_checked(&event).to_string();
        bench.change(|draft| draft.set(field, &value));
    };
    view! {
        <input type="checkbox" id=field.id() prop:checked=move || text.get() == "true" on:change=choose />
    }
}

#[component]
fn Choice(bench: Bench, field: Field, choices: Vec<(String, String)>) -> impl IntoView {
    let text = text_of(bench, field);
    let choose = move |event| {
        let value = event_target_value(&event);
        bench.change(|draft| draft.set(field, &value));
    };
    let option = move |(value, words): (String, String)| {
        let own = value.clone();
        view! { <option value=value selected=move || text.get() == own>{words}</option> }
    };
    view! {
        <select id=field.id() on:change=choose>
            {choices.into_iter().map(option).collect_view()}
        </select>
    }
}

/// Takes the input that is moved next.
#[component]
fn SetButton(bench: Bench, field: Field) -> impl IntoView {
    let waits = move || bench.waits(field);
    view! {
        <button
            type="button"
            class="small"
            id=format!("{}-set", field.id())
            aria-label=words().mix.set_long
            aria-pressed=move || if waits() { "true" } else { "false" }
            on:click=move |_| bench.toggle_learning(field)
        >
            {move || if waits() { words().mix.move_it } else { words().mix.set }}
        </button>
    }
}
