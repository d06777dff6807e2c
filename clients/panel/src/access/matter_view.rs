//! The code by which a home lets the robot in by Matter, for administrators, while `rvac-matter` runs.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{MatterSight, QrPicture, matter_sight};
use rvac_api::MatterInvitation;
use wasm_bindgen_futures::spawn_local;

use crate::http;
use crate::language::words;

const ADDRESS: &str = "/api/matter";
/// A home that has joined is seen within this time.
const RENEW_EVERY: Duration = Duration::from_secs(15);

#[component]
pub(crate) fn MatterView() -> impl IntoView {
    let sight = RwSignal::new(None::<MatterSight>);
    let ask = move || {
        spawn_local(async move {
            // Without an answer rvac-matter does not run: then there is nothing to show.
            let told = http::get::<MatterInvitation>(ADDRESS).await.ok();
            let shown = told.map(|told| matter_sight(words(), &told));
            sight.try_set(shown);
        });
    };
    ask();
    if let Ok(renewal) = set_interval_with_handle(ask, RENEW_EVERY) {
        on_cleanup(move || renewal.clear());
    }
    // Only what differs is drawn anew, so that a camera that looks at the code keeps it.
    let sight = Memo::new(move |_| sight.get());
    move || sight.get().map(section)
}

fn section(sight: MatterSight) -> impl IntoView {
    let texts = &words().matter;
    let MatterSight {
        text,
        picture,
        digits,
    } = sight;
    let code = picture.map(|QrPicture { size, path }| {
        view! {
            <figure class="qr" id="matter-qr">
                <svg role="img" aria-label=texts.code viewBox=format!("0 0 {size} {size}")>
                    <path d=path />
                </svg>
                <figcaption class="remark">
                    {texts.digits} " " <strong id="matter-digits">{digits}</strong>
                </figcaption>
            </figure>
        }
    });
    view! {
        <section class="devices" id="matter" aria-labelledby="matter-title">
            <h3 id="matter-title">{texts.title}</h3>
            <p>{text}</p>
            {code}
            <p class="hint">{texts.uncertified}</p>
        </section>
    }
}
