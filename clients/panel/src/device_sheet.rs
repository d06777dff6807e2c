//! What the robot and its computer measure, keep and are, one under the other.

use leptos::prelude::*;

use crate::about_view::AboutView;
use crate::access::{Access, AdministratorView};
use crate::calibration_view::CalibrationSection;
use crate::device_view::DeviceView;
use crate::learnt_view::LearntSection;
use crate::notify::NotifySection;
use crate::parts_view::PartsView;
use crate::store::Store;
use crate::system_view::SystemSection;

#[component]
pub(crate) fn DeviceSheet(store: Store) -> impl IntoView {
    let manages = Memo::new(move |_| store.entrance.access.with(Access::manages));
    view! {
        <DeviceView store />
        <PartsView store />
        <LearntSection store />
        <CalibrationSection store />
        <Show when=move || manages.get()><AdministratorView store /></Show>
        <NotifySection store />
        <SystemSection store />
        <AboutView store />
    }
}
