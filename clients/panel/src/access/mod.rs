//! Who this device is to the robot, and which other devices there are.

mod allowed;
mod devices_view;
mod matter_view;
mod pair_view;
mod pairing_steps;
mod software_view;

use leptos::prelude::*;
use pairing::Role;
use pairing::wire::Session;
use rvac_api::role_for;

pub(crate) use allowed::{EDITS_HOME, EDITS_MIXES, EDITS_SCHEDULES, Needs, OnlyLooks};
pub(crate) use pair_view::PairView;

use devices_view::DevicesView;
use matter_view::MatterView;
use software_view::SoftwareView;

use crate::http::{self, Failed};
use crate::language::words;
use crate::store::Store;

/// What the server says of this device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Access {
    /// Nothing yet.
    Asked,
    /// The robot does not know it.
    Stranger,
    /// It is paired, or it is the robot's own computer.
    Known(Session),
}

impl Access {
    /// Whether its role is high enough for a request, by its name. As long as the role is unknown, the robot decides.
    pub(crate) fn may(&self, verb: &str) -> bool {
        match self {
            Self::Known(session) => session.role >= role_for(verb),
            Self::Asked | Self::Stranger => true,
        }
    }

    /// Whether it decides about other devices.
    pub(crate) fn manages(&self) -> bool {
        matches!(self, Self::Known(session) if session.client.is_some() && session.role == Role::Admin)
    }
}

/// A device that was let in while this page was open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Newcomer {
    pub(crate) name: String,
    pub(crate) role: String,
    pub(crate) from: String,
}

/// The rights of this page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entrance {
    /// This device.
    pub(crate) access: RwSignal<Access>,
    /// The newest other one, until it is dismissed.
    pub(crate) newcomer: RwSignal<Option<Newcomer>>,
}

impl Entrance {
    pub(crate) fn new() -> Self {
        Self {
            access: RwSignal::new(Access::Asked),
            newcomer: RwSignal::new(None),
        }
    }

    /// Another device was let in.
    pub(crate) fn meet(self, newcomer: Newcomer) {
        self.newcomer.set(Some(newcomer));
    }

    /// Asks the server who this device is. None when the server is not to be had.
    pub(crate) async fn ask(self) -> Option<Access> {
        let access = match http::get("/api/session").await {
            Ok(session) => Access::Known(session),
            Err(Failed::NotPaired) => Access::Stranger,
            Err(Failed::Refused(_) | Failed::Unreachable) => return None,
        };
        self.access.set(access.clone());
        Some(access)
    }
}

/// What only administrators see of the robot.
#[component]
pub(crate) fn AdministratorView(store: Store) -> impl IntoView {
    view! {
        <DevicesView entrance=store.entrance />
        <MatterView />
        <SoftwareView store />
    }
}

/// What a role may; one that this page does not know is shown as it is.
fn role_text(role: &str) -> String {
    role.parse()
        .map_or_else(|_| role.to_owned(), |role| devices_view::may(role).to_owned())
}

/// What is said when another device was let in.
#[component]
pub(crate) fn NewcomerView(entrance: Entrance) -> impl IntoView {
    let text = move || {
        let newcomer = entrance.newcomer.get()?;
        let Newcomer { name, role, from } = newcomer;
        Some(words().access.newcomer.fill([&name, &role_text(&role), &from]))
    };
    view! {
        <div role="status">
            <Show when=move || entrance.newcomer.with(Option::is_some)>
                <div class="alert calm" id="newcomer">
                    <p>{text}</p>
                    <button type="button" class="small" on:click=move |_| entrance.newcomer.set(None)>{words().frame.good}</button>
                </div>
            </Show>
        </div>
    }
}
