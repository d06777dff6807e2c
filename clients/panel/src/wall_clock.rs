//! The time of day of what the robot says by the clock of its daemon.

use leptos::prelude::*;
use panel_logic::clock_text;
use wasm_bindgen::JsValue;

use crate::store::Store;

impl Store {
    /// A message of this moment, with the daemon's time: from now on its other times can be told by the clock on the wall.
    pub(crate) fn set_wall_clock(self, daemon_s: f64) {
        self.daemon_began_s
            .set_value(Some(js_sys::Date::now() / 1000.0 - daemon_s));
    }

    /// Hours, minutes and seconds of the day; the time since the daemon's start as long as no more is known.
    pub(crate) fn wall_text(self, daemon_s: f64) -> String {
        let Some(began_s) = self.daemon_began_s.get_value() else {
            return clock_text(daemon_s);
        };
        let date = js_sys::Date::new(&JsValue::from_f64(1000.0 * (began_s + daemon_s)));
        let (hours, minutes, seconds) = (date.get_hours(), date.get_minutes(), date.get_seconds());
        format!("{hours:02}:{minutes:02}:{seconds:02}")
    }
}
