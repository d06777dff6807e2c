//! The curve of a line, with a dot where its input is.

use leptos::prelude::*;
use mixer::Source;
use panel_logic::LineCurve;

use super::Bench;
use crate::language::words;

#[component]
pub(super) fn Curve(bench: Bench, output: usize, line: usize) -> impl IntoView {
    let curve = Memo::new(move |_| bench.of_draft(|draft| LineCurve::of(draft.profile(), output, line)));
    let input = Memo::new(move |_| {
        bench.of_draft(|draft| {
            let outputs = &draft.profile().outputs;
            outputs
                .get(output)
                .and_then(|output| output.lines.get(line))
                .map(|line| line.input.clone())
        })
    });
    view! {
        <Show when=move || curve.with(Option::is_some)>
            {move || curve.get().map(|curve| picture(curve, reading(bench, input)))}
        </Show>
    }
}

/// What the input of the line reads now.
fn reading(bench: Bench, input: Memo<Option<Source>>) -> Memo<Option<f64>> {
    Memo::new(move |_| {
        let input = input.get()?;
        bench.readings.with(|readings| readings.value(&input))
    })
}

fn picture(curve: LineCurve, reading: Memo<Option<f64>>) -> impl IntoView {
    let all = 1.0 / curve.reach();
    let (label, points) = (curve.text(words()), curve.polyline());
    let dot = Memo::new(move |_| reading.get().and_then(|reading| curve.dot(reading)));
    let place = move |axis: usize| dot.get().and_then(|dot| dot.get(axis).copied()).unwrap_or(0.0);
    view! {
        <svg class="mix-curve" role="img" aria-label=label viewBox="-1.08 -1.08 2.16 2.16">
            <path class="frame" d="M-1 -1H1V1H-1ZM-1 0H1M0 -1V1" />
            <path class="limits" d=format!("M-1 {all}H1M-1 -{all}H1") />
            <polyline points=points />
            <circle r="0.06" class:absent=move || dot.get().is_none() cx=move || place(0) cy=move || place(1) />
        </svg>
    }
}
