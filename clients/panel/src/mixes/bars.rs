//! Bars that follow what inputs read and what the mix makes of it.

use leptos::prelude::*;

use crate::language::words;

/// A bar from -1 to 1 with its middle in the middle.
#[component]
pub(super) fn Bar(label: &'static str, value: Signal<Option<f64>>) -> impl IntoView {
    let shown = Memo::new(move |_| value.get().map(|value| (value.clamp(-1.0, 1.0) * 100.0).round()));
    let left = move || format!("{}%", 50.0 + shown.get().unwrap_or(0.0).min(0.0) / 2.0);
    let width = move || format!("{}%", shown.get().unwrap_or(0.0).abs() / 2.0);
    let text = move || {
        shown.get().map_or_else(
            || words().mix.none.to_owned(),
            |percent| words().unit.percent.fill([&words().number(percent, 0)]),
        )
    };
    view! {
        <div
            class="meter"
            role="meter"
            aria-label=label
            aria-valuemin="-100"
            aria-valuemax="100"
            aria-valuenow=move || shown.get().unwrap_or(0.0).to_string()
            aria-valuetext=text
        >
            <span class="meter-name" aria-hidden="true">{label}</span>
            <span class="meter-track" aria-hidden="true">
                <span class="meter-fill" style:left=left style:width=width></span>
            </span>
            <span class="meter-value" aria-hidden="true">{text}</span>
        </div>
    }
}
