//! Notifications of the system: asked for by a press, never by the page itself, and shown only while nobody looks at the page.

use leptos::prelude::*;
use panel_logic::{Notice, NoticeWatch, run_notice};
use rvac_api::{Run, Status};
use wasm_bindgen::JsCast as _;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{Notification, NotificationOptions, NotificationPermission, ServiceWorkerRegistration};

use crate::language::words;
use crate::store::Store;

/// Under this name the browser keeps the choice.
const KEY: &str = "notify";
/// A newer notice takes the place of the one before.
const TAG: &str = "librervac";

/// Whether this device can be notified.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ability {
    /// The page came over an open network.
    Insecure,
    /// The browser has no such thing.
    Unsupported,
    /// A person has forbidden it in the browser.
    Denied,
    /// It can be asked for, or was.
    Able,
}

impl Ability {
    fn now() -> Self {
        if !window().is_secure_context() {
            return Self::Insecure;
        }
        let has = js_sys::Reflect::has(&window(), &"Notification".into());
        if !has.unwrap_or(false) {
            return Self::Unsupported;
        }
        match Notification::permission() {
            NotificationPermission::Denied => Self::Denied,
            _ => Self::Able,
        }
    }

    /// Why not.
    fn obstacle(self) -> Option<&'static str> {
        let texts = &words().notice;
        match self {
            Self::Insecure => Some(texts.no_secure),
            Self::Unsupported => Some(texts.no_support),
            Self::Denied => Some(texts.denied),
            Self::Able => None,
        }
    }
}

/// The choice of this device, and what it was told of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Notifier {
    is_on: RwSignal<bool>,
    ability: RwSignal<Ability>,
    watch: StoredValue<NoticeWatch>,
}

impl Notifier {
    pub(crate) fn new() -> Self {
        let storage = window().local_storage().ok().flatten();
        let kept = storage.and_then(|storage| storage.get_item(KEY).ok().flatten());
        let ability = Ability::now();
        let is_granted =
            ability == Ability::Able && Notification::permission() == NotificationPermission::Granted;
        Self {
            is_on: RwSignal::new(is_granted && kept.is_some()),
            ability: RwSignal::new(ability),
            watch: StoredValue::new(NoticeWatch::default()),
        }
    }

    pub(crate) fn on_status(self, status: &Status) {
        let notice = self
            .watch
            .try_update_value(|watch| watch.on_status(words(), status));
        self.show(notice.flatten());
    }

    pub(crate) fn on_run(self, run: &Run) {
        self.show(run_notice(words(), run));
    }

    fn show(self, notice: Option<Notice>) {
        let is_looked_at = !document().hidden() && document().has_focus().unwrap_or(true);
        if let Some(notice) = notice
            && self.is_on.get_untracked()
            && !is_looked_at
        {
            spawn_local(show(notice));
        }
    }

    /// A person pressed.
    fn ask(self) {
        spawn_local(async move {
            if let Ok(asked) = Notification::request_permission() {
                JsFuture::from(asked).await.ok(); // The permission itself says what came of it.
            }
            self.ability.set(Ability::now());
            if Notification::permission() == NotificationPermission::Granted {
                self.choose(true);
            }
        });
    }

    fn choose(self, is_on: bool) {
        self.is_on.set(is_on);
        if let Ok(Some(storage)) = window().local_storage() {
            let kept = if is_on {
                storage.set_item(KEY, "yes")
            } else {
                storage.remove_item(KEY)
            };
            kept.ok(); // Without storage the choice lasts as long as the page.
        }
    }
}

/// Through the service worker where there is one: browsers of phones know no other way.
async fn show(notice: Notice) {
    let options = NotificationOptions::new();
    options.set_body(&notice.text);
    options.set_tag(TAG);
    if let Some(icon) = icon() {
        options.set_icon(&icon);
    }
    match registration().await {
        Some(registration) => {
            registration
                .show_notification_with_options(&notice.title, &options)
                .ok(); // It was forbidden meanwhile.
        }
        None => {
            Notification::new_with_options(&notice.title, &options).ok();
        }
    }
}

/// Where the picture of the page is.
fn icon() -> Option<String> {
    let link = document().query_selector("link[rel=apple-touch-icon]");
    link.ok().flatten()?.get_attribute("href")
}

async fn registration() -> Option<ServiceWorkerRegistration> {
    let found = JsFuture::from(window().navigator().service_worker().get_registration())
        .await
        .ok()?;
    found.dyn_into().ok()
}

/// The switch, or why there is none.
#[component]
pub(crate) fn NotifySection(store: Store) -> impl IntoView {
    let notifier = store.notifier;
    let texts = &words().notice;
    let obstacle = move || notifier.ability.get().obstacle();
    let is_on = notifier.is_on;
    view! {
        <section class="about" id="notify" aria-labelledby="notify-title">
            <h3 id="notify-title">{texts.title}</h3>
            <p>{texts.what}</p>
            <div role="status">
                <Show when=move || obstacle().is_some()><p class="hint">{obstacle}</p></Show>
                <Show when=move || is_on.get()><p>{texts.is_on}</p></Show>
            </div>
            <Show when=move || obstacle().is_none() && !is_on.get()>
                <div><button type="button" class="small" id="notify-on" on:click=move |_| notifier.ask()>{texts.on}</button></div>
            </Show>
            <Show when=move || is_on.get()>
                <div><button type="button" class="small" id="notify-off" on:click=move |_| notifier.choose(false)>{texts.off}</button></div>
            </Show>
            <p class="hint">{texts.elsewhere}</p>
        </section>
    }
}
