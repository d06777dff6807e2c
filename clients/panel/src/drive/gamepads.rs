//! Gamepads of the browser. A browser shows one only after a button of it was pressed.

use std::collections::{BTreeMap, BTreeSet};

use js_sys::{Array, Function, Object, Reflect};
use leptos::ev;
use leptos::prelude::*;
use mixer::PadReading;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Gamepad, GamepadButton};

use crate::language::words;

/// As many pads as a profile can name.
const PADS: u32 = 4;
/// Length of the rumble at a bump.
const RUMBLE_MS: f64 = 250.0;

/// What all pads read.
#[derive(Debug, Default)]
pub(super) struct Pads {
    /// By their numbers.
    pub(super) readings: BTreeMap<u8, PadReading>,
    /// For people.
    pub(super) names: Vec<String>,
    /// The browser's time of the newest reading.
    pub(super) time_ms: Option<f64>,
}

/// Pads that were plugged in since the last reading, by their numbers. Another one may have the number of one that is gone.
pub(super) type Plugged = StoredValue<BTreeSet<u8>>;

/// Notes which pads are plugged in, until the view is gone.
pub(super) fn watch(plugged: Plugged) {
    let listener = window_event_listener(ev::gamepadconnected, move |event| {
        let number = event.gamepad().and_then(|pad| u8::try_from(pad.index()).ok());
        plugged.update_value(|plugged| plugged.extend(number));
    });
    on_cleanup(move || listener.remove());
}

/// Reads all pads; none where the browser gives none to this page. A pad that was just plugged in is left out once, so that
/// whoever mixes sees that it is not the one before.
pub(super) fn read(plugged: Plugged) -> Pads {
    let new = plugged.try_update_value(std::mem::take).unwrap_or_default();
    let mut pads = Pads::default();
    for (number, pad) in newest(connected().collect()) {
        let is_new = u8::try_from(pad.index()).is_ok_and(|index| new.contains(&index));
        let Some(number) = u8::try_from(number).ok().filter(|_| !is_new) else {
            continue;
        };
        let reading = PadReading {
            axes: pad.axes().iter().filter_map(|axis| axis.as_f64()).collect(),
            buttons: pad.buttons().iter().map(pressed).collect(),
            // Browsers give the time of the newest word of the pad.
            words: pad.timestamp().to_bits(),
        };
        pads.readings.insert(number, reading);
        pads.names.push(words().drive.gamepad.fill([&number, &pad.id()]));
        let time_ms = pad.timestamp();
        if time_ms > pads.time_ms.unwrap_or(0.0) {
            pads.time_ms = Some(time_ms);
        }
    }
    pads
}

/// Shakes all pads that can.
pub(super) fn rumble() {
    for pad in connected() {
        shake(&pad).ok(); // A pad that cannot is as good as before.
    }
}

fn shake(pad: &Gamepad) -> Result<(), JsValue> {
    let actuator = Reflect::get(pad, &"vibrationActuator".into())?;
    let play: Function = Reflect::get(&actuator, &"playEffect".into())?.dyn_into()?;
    let effect = Object::new();
    for (name, value) in [
        ("duration", RUMBLE_MS),
        ("strongMagnitude", 1.0),
        ("weakMagnitude", 0.6),
    ] {
        Reflect::set(&effect, &name.into(), &value.into())?;
    }
    play.call2(&actuator, &"dual-rumble".into(), &effect)?;
    Ok(())
}

fn connected() -> impl Iterator<Item = Gamepad> {
    let all = window()
        .navigator()
        .get_gamepads()
        .unwrap_or_else(|_| Array::new());
    let pads: Vec<Gamepad> = all
        .iter()
        .filter(JsValue::is_object)
        .map(JsCast::unchecked_into::<Gamepad>)
        .filter(|pad| pad.connected() && pad.index() < PADS)
        .collect();
    pads.into_iter()
}

/// One pad of each name, under the lowest number of that name: a pad that lost its connection and came back has a second number,
/// while the browser still shows how the first one was. The one that spoke last has the say.
fn newest(pads: Vec<Gamepad>) -> BTreeMap<u32, Gamepad> {
    let mut numbers: BTreeMap<String, u32> = BTreeMap::new();
    let mut newest: BTreeMap<u32, Gamepad> = BTreeMap::new();
    for pad in pads {
        let number = *numbers.entry(pad.id()).or_insert_with(|| pad.index());
        let is_newer = newest
            .get(&number)
            .is_none_or(|before| pad.timestamp() > before.timestamp());
        if is_newer {
            newest.insert(number, pad);
        }
    }
    newest
}

fn pressed(button: JsValue) -> f64 {
    button.unchecked_into::<GamepadButton>().value()
}
