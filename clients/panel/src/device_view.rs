//! The device information table.

use leptos::prelude::*;
use panel_logic::{Row, Section, device_sections};

use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn DeviceView(store: Store) -> impl IntoView {
    let sections = move || {
        store.device.with(|table| {
            let robot = store.robot.get();
            table
                .as_ref()
                .map(|table| device_sections(words(), table, robot.as_ref()))
                .unwrap_or_default()
        })
    };
    let bars = move || {
        store.device.with(|table| {
            table
                .as_ref()
                // The robot counts from its right side.
                .map(|table| table.proximity.iter().rev().copied().collect::<Vec<f32>>())
                .unwrap_or_default()
        })
    };
    view! {
        <div class="device" id="device-table">
            <Show when=move || store.device.with(Option::is_none)>
                <p class="hint">{words().device.none}</p>
            </Show>
            {move || sections().into_iter().map(section).collect_view()}
            <Show when=move || !bars().is_empty()>
                <h3 id="proximity">{words().device.proximity}</h3>
                <ol class="bars" aria-labelledby="proximity">
                    {move || bars().into_iter().map(bar).collect_view()}
                </ol>
            </Show>
        </div>
    }
}

fn section(section: Section) -> impl IntoView {
    view! {
        <table>
            <caption>{section.title}</caption>
            <tbody>{section.rows.into_iter().map(row).collect_view()}</tbody>
        </table>
    }
}

fn row(row: Row) -> impl IntoView {
    view! {
        <tr class:alarming=row.alarming>
            <th scope="row">{row.label}</th>
            <td>{row.value}</td>
        </tr>
    }
}

fn bar(nearness: f32) -> impl IntoView {
    let percent = (nearness.clamp(0.0, 1.0) * 100.0).round();
    view! {
        <li>
            <span class="bar" style:height=format!("{percent}%")></span>
            <span class="visually-hidden">{words().unit.percent_said.fill([&percent])}</span>
        </li>
    }
}
