//! All paired devices, for administrators.

use leptos::prelude::*;
use pairing::Role;
use pairing::wire::{ClientRow, OpenWindow, OpenedHere, Revoke, SetRole};
use panel_logic::QrPicture;

use super::{Access, Entrance};
use crate::http::{self, Failed};

use crate::language::words;

/// What the section shows.
#[derive(Clone, Copy)]
struct Devices {
    rows: RwSignal<Vec<ClientRow>>,
    wrong: RwSignal<String>,
    opened: RwSignal<Option<OpenedHere>>,
}

impl Devices {
    fn new() -> Self {
        Self {
            rows: RwSignal::new(Vec::new()),
            wrong: RwSignal::new(String::new()),
            opened: RwSignal::new(None),
        }
    }

    fn renew(self) {
        leptos::task::spawn_local(async move {
            match http::get("/api/clients").await {
                Ok(rows) => self.rows.set(rows),
                Err(failed) => self.tell(&failed),
            }
        });
    }

    /// Changes something and reloads the list.
    fn change(self, path: &'static str, body: impl serde::Serialize + 'static) {
        self.wrong.set(String::new());
        leptos::task::spawn_local(async move {
            if let Err(failed) = http::send(path, &body).await {
                self.tell(&failed);
            }
            self.renew();
        });
    }

    fn open(self, role: Role) {
        self.wrong.set(String::new());
        leptos::task::spawn_local(async move {
            match http::post("/api/pairing/open", &OpenWindow { role }).await {
                Ok(opened) => self.opened.set(Some(opened)),
                Err(failed) => self.tell(&failed),
            }
        });
    }

    fn tell(self, failed: &Failed) {
        self.wrong.set(failed.text());
    }
}

#[component]
pub(crate) fn DevicesView(entrance: Entrance) -> impl IntoView {
    let devices = Devices::new();
    let role = RwSignal::new(Role::Drive);
    // A device that was paired is in the list at once, and its code is used up.
    Effect::new(move |_| {
        entrance.newcomer.track();
        devices.opened.set(None);
        devices.renew();
    });
    let choose = move |event| {
        if let Ok(chosen) = event_target_value(&event).parse() {
            role.set(chosen);
        }
    };
    let code = move || {
        devices
            .opened
            .get()
            .map(|OpenedHere { opened, .. }| words().access.type_code.fill([&opened.code, &opened.seconds]))
    };
    view! {
        <section class="devices" aria-labelledby="devices-title">
            <h3 id="devices-title">{words().access.devices}</h3>
            <ul id="devices" class="rows">
                {move || devices.rows.get().into_iter().map(|row| line(entrance, devices, row)).collect_view()}
            </ul>
            <p class="wrong" role="alert">{move || devices.wrong.get()}</p>
            <div class="order-tools">
                <label class="field grow">
                    {words().access.new_may}
                    <select id="new-role" prop:value=move || role.get().name() on:change=choose>
                        {Role::ALL.map(|role| view! { <option value=role.name()>{may(role)}</option> }).collect_view()}
                    </select>
                </label>
                <button type="button" class="small strong" id="add-device" on:click=move |_| devices.open(role.get_untracked())>
                    {words().access.add}
                </button>
            </div>
            <p id="pairing-code" role="status" class="remark" hidden=move || code().is_none()>{code}</p>
            {move || devices.opened.with(|opened| opened.as_ref().and_then(to_scan))}
        </section>
    }
}

/// The address for the camera of the new device.
fn to_scan(invitation: &OpenedHere) -> Option<impl IntoView + use<>> {
    let address = invitation.to_scan()?;
    let QrPicture { size, path } = QrPicture::of(address)?;
    let texts = words().access.scan.fill([&address]);
    Some(view! {
        <figure class="qr" id="pairing-qr">
            <svg role="img" aria-label=words().access.qr_code viewBox=format!("0 0 {size} {size}")>
                <path d=path />
            </svg>
            <figcaption class="remark">{texts}</figcaption>
        </figure>
    })
}

fn line(entrance: Entrance, devices: Devices, row: ClientRow) -> impl IntoView {
    let (id, name) = (row.id, row.name.to_string());
    let own = entrance
        .access
        .with_untracked(|access| matches!(access, Access::Known(session) if session.client == Some(id)));
    let set_role = move |event| {
        if let Ok(role) = event_target_value(&event).parse() {
            devices.change("/api/clients/role", SetRole { id, role });
        }
    };
    let label = words().access.may_named.fill([&name]);
    let shut_out = words().access.remove_named.fill([&name]);
    view! {
        <li>
            <span class="name">{name}</span>
            <span class="words">{if own { words().access.this_device } else { "" }}</span>
            <select class="role" aria-label=label prop:value=row.role.name() on:change=set_role>
                {Role::ALL
                    .map(|role| view! { <option value=role.name() selected=role == row.role>{may(role)}</option> })
                    .collect_view()}
            </select>
            <button
                type="button"
                class="small"
                aria-label=shut_out
                on:click=move |_| devices.change("/api/clients/revoke", Revoke { id })
            >
                {words().access.remove}
            </button>
        </li>
    }
}

/// What a role may, in few words.
pub(super) fn may(role: Role) -> &'static str {
    let texts = &words().access;
    match role {
        Role::View => texts.may_view,
        Role::Drive => texts.may_drive,
        Role::Admin => texts.may_admin,
    }
}
