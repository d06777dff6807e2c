//! The time zone in which schedules are shown and stored.

use js_sys::{Array, Function, Intl, Object, Reflect};
use leptos::ev::SubmitEvent;
use leptos::prelude::*;
use rvac_api::RequestBody;
use wasm_bindgen::{JsCast, JsValue};

use crate::language::words;
use crate::store::Store;

/// Longest name of a zone that is asked for, in characters.
const NAME_MAX: &str = "64";

#[component]
pub(super) fn ZoneView(store: Store) -> impl IntoView {
    let desk = store.schedules;
    let known = Memo::new(move |_| desk.with(|known| known.zone.clone()));
    let is_set = Memo::new(move |_| desk.with(|known| known.zone_is_set));
    let name = RwSignal::new(String::new());
    Effect::new(move |_| name.set(known.get()));
    let of_device = StoredValue::new(zone_of_device());
    let differs = move || of_device.with_value(|zone| zone.as_ref().is_some_and(|zone| *zone != known.get()));
    let set = move |event: SubmitEvent| {
        event.prevent_default();
        let zone = Some(name.get_untracked().trim().to_owned());
        store.ask(RequestBody::SetZone { zone });
    };
    let take_own = move |_| {
        let zone = of_device.get_value();
        store.ask(RequestBody::SetZone { zone });
    };
    view! {
        <h3 id="zone-title">{words().schedule.zone_title}</h3>
        <form class="order-tools quiet" aria-labelledby="zone-title" on:submit=set>
            <label class="field grow">
                {words().schedule.zone_name}
                <input
                    id="zone"
                    list="zones"
                    autocomplete="off"
                    maxlength=NAME_MAX
                    prop:value=move || name.get()
                    on:input=move |event| name.set(event_target_value(&event))
                />
            </label>
            <datalist id="zones">
                {all_zones().into_iter().map(|zone| view! { <option value=zone></option> }).collect_view()}
            </datalist>
            <button type="submit" class="small" id="set-zone">{words().schedule.set}</button>
        </form>
        <div class="draw-tools">
            <Show when=differs>
                <button type="button" class="small" id="device-zone" on:click=take_own>
                    {words().schedule.device_zone.fill([&of_device.get_value().unwrap_or_default()])}
                </button>
            </Show>
            <Show when=move || is_set.get()>
                <button
                    type="button"
                    class="small"
                    id="system-zone"
                    on:click=move |_| store.ask(RequestBody::SetZone { zone: None })
                >
                    {words().schedule.system_zone}
                </button>
            </Show>
        </div>
    }
}

/// The zone of the phone or computer that shows the page.
fn zone_of_device() -> Option<String> {
    let options: JsValue = Intl::DateTimeFormat::new(&Array::new(), &Object::new())
        .resolved_options()
        .into();
    Reflect::get(&options, &"timeZone".into()).ok()?.as_string()
}

/// All zones that the browser lists, as suggestions; none in one that does not list them.
fn all_zones() -> Vec<String> {
    let told = || {
        let intl = Reflect::get(&js_sys::global(), &"Intl".into()).ok()?;
        let list = Reflect::get(&intl, &"supportedValuesOf".into()).ok()?;
        let zones = list
            .dyn_into::<Function>()
            .ok()?
            .call1(&intl, &"timeZone".into())
            .ok()?;
        Some(
            Array::from(&zones)
                .iter()
                .filter_map(|zone| zone.as_string())
                .collect(),
        )
    };
    told().unwrap_or_default()
}
