//! The buttons that start and end jobs. One of them goes on with whatever is next, Stop stands beside it, and neither ever moves.

use leptos::prelude::*;
use panel_logic::{Offer, Primary, RoomChoice, Tool, Wishes, strategy_title};
use rvac_api::RequestBody;

use crate::icons::{Icon, icon};
use crate::language::words;
use crate::store::Store;

/// Style and label of a button, and the word of its request.
#[derive(Clone, Copy, Debug)]
struct Face {
    id: &'static str,
    class: &'static str,
    label: &'static str,
    icon: Icon,
}

#[component]
pub(crate) fn Actions(store: Store) -> impl IntoView {
    let face = |id, class, label, icon| Face {
        id,
        class,
        label,
        icon,
    };
    let clear = move || RequestBody::Clear {
        reason: store.status.with_untracked(|status| {
            status
                .as_ref()
                .map(|status| status.reason.clone())
                .unwrap_or_default()
        }),
    };
    view! {
        <section class="actions" id="actions" tabindex="-1" aria-label=words().action.controls>
            <PrimaryButton store />
            {action(store, face("stop", "strong", words().action.stop, Icon::Stop), move || store.offer_of_stop(), || RequestBody::Stop)}
            {action(store, face("spot", "plain", words().action.spot, Icon::Spot), move || store.offers().spot, || RequestBody::Spot)}
            {action(store, face("dock", "plain", words().action.dock, Icon::Dock), move || store.offers().dock, || RequestBody::Dock)}
            {action(store, face("locate", "plain", words().action.find, Icon::Bell), move || store.offers().locate, || RequestBody::Locate)}
            {action(store, face("clear", "primary", words().action.clear, Icon::Warning), move || store.offers().clear, clear)}
        </section>
    }
}

impl Store {
    /// Stop ends a calibration, too, during which the robot counts as disconnected.
    fn offer_of_stop(self) -> Offer {
        if self.calibration.is_running() {
            Offer::Ready
        } else {
            self.offers().stop
        }
    }

    /// What is chosen or drawn; a view that asks follows it.
    fn wishes(self) -> Wishes {
        Wishes {
            chosen: self.orders.choice.with(|choice| !choice.is_empty()),
            drawing: self.orders.sketch.with(|sketch| sketch.tool() != Tool::Choose),
        }
    }

    /// Does what the one button says.
    fn go_on(self, primary: Primary) {
        let body = match primary {
            Primary::Start => RequestBody::Start {
                strategy: self.chosen_strategy(),
            },
            Primary::CleanSelected => {
                let Some(order) = self.orders.choice.with_untracked(RoomChoice::order) else {
                    return;
                };
                RequestBody::Clean(order)
            }
            Primary::Pause => RequestBody::Pause,
            Primary::Resume => RequestBody::Resume,
        };
        self.press(primary.verb(), primary.label(words()), body);
    }

    fn chosen_strategy(self) -> Option<String> {
        let wanted = self.strategy.get_untracked();
        let strategies = self.strategies.get_untracked();
        strategies.into_iter().find(|name| *name == wanted)
    }
}

/// The button that goes on: the same element in all states, so that it keeps the focus and its place.
#[component]
fn PrimaryButton(store: Store) -> impl IntoView {
    let primary = Memo::new(move |_| {
        let wishes = store.wishes();
        store.status.with(|status| Primary::of(status.as_ref(), wishes))
    });
    let offer = Memo::new(move |_| primary.get().offer(&store.offers(), store.wishes()));
    let waits = move || reason_of(offer.get());
    let press = move |_| match offer.get_untracked() {
        Offer::Ready => store.go_on(primary.get_untracked()),
        Offer::NotNow(why) => store.tell_why_not(why),
        Offer::Absent => {}
    };
    let picture = move || match primary.get() {
        Primary::Pause => Icon::Pause,
        Primary::Start | Primary::CleanSelected | Primary::Resume => Icon::Play,
    };
    let pending = move || store.is_pending(primary.get().verb());
    view! {
        <button
            type="button"
            id=move || primary.get().id()
            class="action primary"
            aria-disabled=move || if waits().is_some() { "true" } else { "false" }
            aria-busy=move || if pending() { "true" } else { "false" }
            title=waits
            on:click=press
        >
            {move || icon(picture())}
            <span class="label">{move || primary.get().label(words())}</span>
            <Notes waits=Signal::derive(waits) pending=Signal::derive(pending) />
        </button>
    }
}

/// Why a button waits, or that its press is on the way, for who does not see it.
#[component]
fn Notes(waits: Signal<Option<&'static str>>, pending: Signal<bool>) -> impl IntoView {
    view! {
        <span class="visually-hidden">{move || waits.get().map(|why| words().frame.not_now.fill([&why]))}</span>
        <span class="visually-hidden">{move || pending.get().then_some(words().action.pending)}</span>
    }
}

fn reason_of(offer: Offer) -> Option<&'static str> {
    match offer {
        Offer::NotNow(why) => Some(why.text(words())),
        Offer::Ready | Offer::Absent => None,
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
    let waits = move || reason_of(offer.get());
    let press = move |_| match offer.get_untracked() {
        Offer::Ready => store.press(face.id, face.label, request()),
        Offer::NotNow(why) => store.tell_why_not(why),
        Offer::Absent => {}
    };
    let pending = move || store.is_pending(face.id);
    view! {
        <Show when=move || offer.get() != Offer::Absent>
            <button
                type="button"
                id=face.id
                class=format!("action {}", face.class)
                aria-disabled=move || if waits().is_some() { "true" } else { "false" }
                aria-busy=move || if pending() { "true" } else { "false" }
                title=waits
                on:click=press
            >
                {icon(face.icon)}
                <span class="label">{face.label}</span>
                <Notes waits=Signal::derive(waits) pending=Signal::derive(pending) />
            </button>
        </Show>
    }
}

/// By which pattern a job of the whole home goes.
#[component]
pub(crate) fn PatternChoice(store: Store) -> impl IntoView {
    view! {
        <Show when=move || store.strategies.with(|strategies| strategies.len() > 1)>
            <label class="field">
                {words().action.cleaning_pattern}
                <select id="strategy" on:change=move |event| store.strategy.set(event_target_value(&event))>
                    <option value="">{words().action.robot_chooses}</option>
                    <For each=move || store.strategies.get() key=String::clone let:name>
                        <option value=name.clone()>{strategy_title(words(), &name).to_owned()}</option>
                    </For>
                </select>
            </label>
        </Show>
    }
}
