//! The web page that shows and drives the robot. What can be decided without a browser is in `panel-logic`.
#![deny(unsafe_code)]

mod about_view;
mod access;
mod actions;
mod app;
mod bottom_sheet;
mod calibration_view;
mod changes;
mod device_sheet;
mod device_view;
mod dock_view;
mod drive;
mod evidence_view;
mod file_button;
mod floor_files;
mod floors_view;
mod focus;
mod header;
mod history;
mod home_view;
mod http;
mod icons;
mod job_settings_view;
mod language;
mod late;
mod learnt_view;
mod link;
mod log_view;
mod map;
mod mixes;
mod news;
mod notify;
mod parts_view;
mod places_view;
mod press;
mod refusals;
mod rename_form;
mod room_settings_view;
mod rooms_view;
mod row_menu;
mod row_tools;
mod schedules;
mod status_view;
mod store;
mod summary_view;
mod system_view;
mod tabs;
mod theme;
mod toasts;
mod wall_clock;
mod whole_home_view;
mod why_view;

fn main() {
    language::begin();
    leptos::mount::mount_to_body(app::App);
}
