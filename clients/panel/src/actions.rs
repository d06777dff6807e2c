//! The buttons that start and end jobs.

use leptos::prelude::*;
use panel_logic::{Offer, PauseKind, strategy_title};
use rvac_api::RequestBody;

use crate::icons::{Icon, icon};
use crate::language::words;
use crate::store::Store;

/// Style and label of a button.
#[derive(Clone, Copy, Debug)]
struct Face {
    id: &'static str,
    class: &'static str,
    label: &'static str,
    icon: Icon,
}

#[component]
pub(crate) fn Actions(store: Store) -> impl IntoView {
    // Empty as long as the robot chooses.
    let strategy = RwSignal::new(String::new());
    let chosen = move || {
        let strategies = store.strategies.get_untracked();
        let wanted = strategy.get_untracked();
        strategies.into_iter().find(|name| *name == wanted)
    };
    let face = |id, class, label, icon| Face {
        id,
        class,
        label,
        icon,
    };
    let resumes = Memo::new(move |_| store.offers().pause_kind == PauseKind::Resume);
    let pause = move || {
        if resumes.get() {
            RequestBody::Resume
        } else {
            RequestBody::Pause
        }
    };
    let clear = move || RequestBody::Clear {
        reason: store.status.with_untracked(|status| {
            status
                .as_ref()
                .map(|status| status.reason.clone())
                .unwrap_or_default()
        }),
    };
    let start = move || RequestBody::Start { strategy: chosen() };
    view! {
        <section class="actions" id="actions" tabindex="-1" aria-label=words().action.controls>
            {action(store, face("start", "primary", words().action.start, Icon::Play), move || store.offers().start, start)}
            {action(store, face("stop", "strong", words().action.stop, Icon::Stop), move || store.offers().stop, || RequestBody::Stop)}
            {move || {
                let pause_face = if resumes.get() {
                    face("pause", "plain", words().action.resume, Icon::Play)
                } else {
                    face("pause", "plain", words().action.pause, Icon::Pause)
                };
                action(store, pause_face, move || store.offers().pause, pause)
            }}
            {action(store, face("spot", "plain", words().action.spot, Icon::Spot), move || store.offers().spot, || RequestBody::Spot)}
            {action(store, face("dock", "plain", words().action.dock, Icon::Dock), move || store.offers().dock, || RequestBody::Dock)}
            {action(store, face("locate", "plain", words().action.find, Icon::Bell), move || store.offers().locate, || RequestBody::Locate)}
            {action(store, face("clear", "primary", words().action.clear, Icon::Warning), move || store.offers().clear, clear)}
            <Show when=move || store.strategies.with(|strategies| strategies.len() > 1)>
                <label class="field">
                    {words().action.cleaning_pattern}
                    <select id="strategy" on:change=move |event| strategy.set(event_target_value(&event))>
                        <option value="">{words().action.robot_chooses}</option>
                        <For each=move || store.strategies.get() key=String::clone let:name>
                            <option value=name.clone()>{strategy_title(words(), &name).to_owned()}</option>
                        </For>
                    </select>
                </label>
            </Show>
        </section>
    }
}

/// A button that is absent, waits with a reason, or asks. A waiting button stays focusable, so that its reason can be read.
fn action(
    store: Store,
    face: Face,
    offer: impl Fn() -> Offer + Copy + Send + Sync + 'static,
    request: impl Fn() -> RequestBody + Copy + Send + Sync + 'static,
) -> impl IntoView {
    let offer = Memo::new(move |_| offer());
    let waits = move || match offer.get() {
        Offer::NotNow(why) => Some(why.text(words())),
        Offer::Ready | Offer::Absent => None,
    };
    let press = move |_| match offer.get_untracked() {
        Offer::Ready => store.ask(request()),
        Offer::NotNow(why) => store.tell_why_not(why),
        Offer::Absent => {}
    };
    view! {
        <Show when=move || offer.get() != Offer::Absent>
            <button
                type="button"
                id=face.id
                class=format!("action {}", face.class)
                aria-disabled=move || if waits().is_some() { "true" } else { "false" }
                title=waits
                on:click=press
            >
                {icon(face.icon)}
                <span>{face.label}</span>
                <span class="visually-hidden">{move || waits().map(|why| words().frame.not_now.fill([&why]))}</span>
            </button>
        </Show>
    }
}
