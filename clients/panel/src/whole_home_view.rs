//! What cleaning the whole home takes, before the robot starts.

use leptos::prelude::*;
use panel_logic::RoomChoice;

use crate::store::Store;

/// Steps of the charge, in which the number of recharges is asked for anew.
const CHARGE_STEPS: f64 = 10.0;

#[component]
pub(crate) fn WholeHomeView(store: Store) -> impl IntoView {
    let orders = store.orders;
    let rests = Memo::new(move |_| store.rests());
    let charge = Memo::new(move |_| {
        store.device.with(|table| {
            let battery = table.as_ref().and_then(|table| table.battery.as_ref());
            battery.map(|battery| (CHARGE_STEPS * battery.charge).round() as i32)
        })
    });
    Effect::new(move |_| {
        charge.track();
        orders.no_go.track();
        let has_rooms = store.rooms.with(|rooms| !rooms.is_empty());
        if rests.get() && has_rooms {
            store.ask_whole_home();
        } else {
            orders.whole_home.set(None);
        }
    });
    let text = Memo::new(move |_| {
        let nothing_is_chosen = orders.choice.with(RoomChoice::is_empty);
        orders.whole_home.get().filter(|_| nothing_is_chosen)
    });
    view! {
        <Show when=move || text.get().is_some()>
            <p id="whole-home" class="hint">{move || text.get()}</p>
        </Show>
    }
}
