//! What is done with whole mixes: choose, new, copy, delete, import, export, save, revert.

use leptos::prelude::*;
use mixer::{PROFILE_BYTES_MAX, Profile, ProfileError, standard_profile};
use panel_logic::{MixDraft, profile_problem_text};
use rvac_api::RequestBody;
use wasm_bindgen_futures::JsFuture;
use web_sys::File;

use super::Bench;
use crate::file_button::FileButton;
use crate::language::words;
use crate::store::Store;

#[component]
pub(super) fn Tools(store: Store) -> impl IntoView {
    let (bench, kept) = (store.bench, store.seat.kept);
    let is_changed = Memo::new(move |_| bench.of_draft(MixDraft::is_changed));
    let choose = move |event| {
        let wanted = event_target_value(&event);
        let found = kept.with_untracked(|kept| kept.iter().find(|mix| mix.name.as_str() == wanted).cloned());
        match found {
            Some(profile) => bench.load(MixDraft::of_kept(profile)),
            None => load_copy(store, &standard_profile()),
        }
    };
    let option = move |profile: Profile| {
        let name = profile.name.to_string();
        let own = name.clone();
        let is_edited =
            move || bench.of_draft(|draft| !draft.is_unsaved() && draft.profile().name.as_str() == own);
        view! { <option value=name.clone() selected=is_edited>{name.clone()}</option> }
    };
    let copy = move |_| {
        if let Some(profile) = bench
            .draft
            .with_untracked(|draft| draft.as_ref().map(|draft| draft.profile().clone()))
        {
            load_copy(store, &profile);
        }
    };
    let new = move |_| {
        if let Ok(draft) = MixDraft::empty(words(), &kept.get_untracked()) {
            bench.load(draft);
        }
    };
    view! {
        <label class="field">
            {words().mix.to_edit}
            <select id="mix-to-edit" disabled=move || is_changed.get() on:change=choose>
                <option value="">{words().mix.copy_of_standard}</option>
                {move || kept.get().into_iter().map(option).collect_view()}
            </select>
        </label>
        <Show when=move || is_changed.get()>
            <p class="hint">{words().mix.save_first}</p>
        </Show>
        <div class="mix-tools">
            <button type="button" class="small" id="mix-new" disabled=move || is_changed.get() on:click=new>{words().mix.new}</button>
            <button type="button" class="small" id="mix-copy" disabled=move || is_changed.get() on:click=copy>{words().mix.copy}</button>
            <DeleteButton store />
            <FileButton
                id="mix-import"
                file_id="mix-file"
                text=words().mix.import
                label=words().mix.file
                accept="application/json,.json"
                disabled=is_changed.into()
                on_file=move |file| leptos::task::spawn_local(import(bench, file))
            />
            <ExportLink bench />
        </div>
        <Show when=move || bench.remark.with(Option::is_some)>
            <p class="remark" id="mix-remark" role="status">{move || bench.remark.get()}</p>
        </Show>
    }
}

fn load_copy(store: Store, profile: &Profile) {
    if let Ok(draft) = MixDraft::copy_of(words(), profile, &store.seat.kept.get_untracked()) {
        store.bench.load(draft);
    }
}

/// Removes the mix from the robot; what is on the screen stays, so that it can be saved again.
#[component]
fn DeleteButton(store: Store) -> impl IntoView {
    let bench = store.bench;
    let name = Memo::new(move |_| bench.of_draft(|draft| draft.profile().name.to_string()));
    let is_kept = Memo::new(move |_| {
        let name = name.get();
        store
            .seat
            .kept
            .with(|kept| kept.iter().any(|mix| mix.name.as_str() == name))
    });
    let remove = move |_| {
        let name = name.get_untracked();
        bench.remark.set(Some(words().mix.removed.fill([&name])));
        store.ask(RequestBody::RemoveMix { name });
        store.ask_quietly(RequestBody::Mixes);
        bench.change(MixDraft::on_removed);
    };
    view! {
        <Show when=move || is_kept.get()>
            <button type="button" class="small" id="mix-delete" on:click=remove>{words().mix.delete}</button>
        </Show>
    }
}

async fn import(bench: Bench, file: File) {
    let outcome = match read_text(&file).await {
        Ok(text) => MixDraft::import(&text).map_err(|error| profile_problem_text(words(), &error)),
        Err(sentence) => Err(sentence),
    };
    match outcome {
        Ok(draft) => bench.load(draft),
        Err(sentence) => bench
            .remark
            .set(Some(words().mix.of_file.fill([&file.name(), &sentence]))),
    }
}

async fn read_text(file: &File) -> Result<String, String> {
    // What is far too large is not even read.
    let bytes = file.size() as usize;
    if bytes > 8 * PROFILE_BYTES_MAX {
        return Err(profile_problem_text(words(), &ProfileError::TooLarge { bytes }));
    }
    let text = JsFuture::from(file.text()).await;
    let text = text.ok().and_then(|text| text.as_string());
    text.ok_or_else(|| words().mix.unreadable.to_owned())
}

#[component]
fn ExportLink(bench: Bench) -> impl IntoView {
    let name = move || bench.of_draft(|draft| format!("{}.json", draft.profile().name));
    let address = move || {
        let text = bench.of_draft(|draft| draft.profile().to_pretty_json());
        let text: String = js_sys::encode_uri_component(&text).into();
        format!("data:application/json;charset=utf-8,{text}")
    };
    view! { <a class="small link" id="mix-export" download=name href=address>{words().mix.export}</a> }
}

#[component]
pub(super) fn SaveBar(store: Store) -> impl IntoView {
    let bench = store.bench;
    let problem = Memo::new(move |_| {
        bench
            .of_draft(MixDraft::problem)
            .map(|problem| problem.text(words()))
    });
    let can_save = Memo::new(move |_| problem.with(Option::is_none) && bench.of_draft(MixDraft::is_unsaved));
    let is_changed = Memo::new(move |_| bench.of_draft(MixDraft::is_changed));
    view! {
        <div class="save-bar">
            <p class="problem" id="mix-problem" role="status">{move || problem.get()}</p>
            <div class="mix-tools">
                <button
                    type="button"
                    class="small strong"
                    id="mix-save"
                    disabled=move || !can_save.get()
                    on:click=move |_| store.save_mix()
                >
                    {words().mix.save_to_robot}
                </button>
                <button
                    type="button"
                    class="small"
                    id="mix-revert"
                    disabled=move || !is_changed.get()
                    on:click=move |_| bench.rearrange(MixDraft::revert)
                >
                    {words().mix.revert}
                </button>
            </div>
        </div>
    }
}
