//! Which role each request needs.

use crate::Role;

/// The least role that may ask each request over the network, by its word in `c`. On the robot's own socket all may.
#[rustfmt::skip]
pub const VERBS: [(&str, Role); 70] = [
    ("hello",           Role::View),
    ("watch",           Role::View),
    ("estimate",        Role::View),
    ("evidence",        Role::View),
    ("health",          Role::View),
    ("learnt",          Role::View),
    ("calibration",     Role::View),
    ("maps",            Role::View),
    ("mixes",           Role::View),
    ("runs",            Role::View),
    ("statistics",      Role::View),
    ("run",             Role::View),
    ("run-track",       Role::View),
    ("run-file",        Role::View),
    ("export-floors",   Role::View),
    ("stop",            Role::View),
    ("start",           Role::Drive),
    ("clean",           Role::Drive),
    ("spot",            Role::Drive),
    ("go-to",           Role::Drive),
    ("pause",           Role::Drive),
    ("resume",          Role::Drive),
    ("dock",            Role::Drive),
    ("drive",           Role::Drive),
    ("release",         Role::Drive),
    ("set-inputs",      Role::Drive),
    ("locate",          Role::Drive),
    ("clear",           Role::Drive),
    ("run-schedule",    Role::Drive),
    ("skip-next",       Role::Drive),
    ("choose-floor",    Role::Drive),
    ("add-no-go",       Role::Admin),
    ("remove-no-go",    Role::Admin),
    ("name-no-go",      Role::Admin),
    ("reshape-no-go",   Role::Admin),
    ("keep-place",      Role::Admin),
    ("name-place",      Role::Admin),
    ("reshape-place",   Role::Admin),
    ("forget-place",    Role::Admin),
    ("name-room",       Role::Admin),
    ("set-room",        Role::Admin),
    ("split-room",      Role::Admin),
    ("join-rooms",      Role::Admin),
    ("undo-room-change", Role::Admin),
    ("move-dock",       Role::Admin),
    ("reset-health",    Role::Admin),
    ("renew-part",      Role::Admin),
    ("undo-renew-part", Role::Admin),
    ("forget-learnt",   Role::Admin),
    ("restore-map",     Role::Admin),
    ("new-floor",       Role::Admin),
    ("name-floor",      Role::Admin),
    ("remove-floor",    Role::Admin),
    ("restore-floor",   Role::Admin),
    ("import-floors",   Role::Admin),
    ("save-mix",        Role::Admin),
    ("remove-mix",      Role::Admin),
    ("add-schedule",    Role::Admin),
    ("change-schedule", Role::Admin),
    ("remove-schedule", Role::Admin),
    ("enable-schedule", Role::Admin),
    ("set-quiet",       Role::Admin),
    ("set-zone",        Role::Admin),
    ("claim-buttons",   Role::Admin),
    ("borrow-link",     Role::Admin),
    ("begin-calibration", Role::Admin),
    ("answer-calibration", Role::Admin),
    ("hold-calibration", Role::Admin),
    ("end-calibration", Role::Admin),
    ("raw",             Role::Admin),
];

/// The role that a request needs, by its word in `c`; one that is not in the table needs the highest.
#[must_use]
pub fn role_for(verb: &str) -> Role {
    let row = VERBS.iter().find(|(known, _)| *known == verb);
    row.map_or(Role::Admin, |(_, role)| *role)
}

#[cfg(test)]
mod tests {
    use alloc::borrow::ToOwned;
    use alloc::string::{String, ToString};
    use alloc::vec::Vec;

    use super::VERBS;
    use crate::Request;

    /// The words of all requests, as the interface itself tells them.
    fn words_of_the_interface() -> Vec<String> {
        let error = serde_json::from_str::<Request>(r#"{"c":"no-such-word"}"#).unwrap_err();
        let text = error.to_string();
        let listed = text.split("expected one of ").nth(1).unwrap();
        listed.split('`').skip(1).step_by(2).map(str::to_owned).collect()
    }

    #[test]
    fn every_request_stands_in_the_table_once() {
        let mut listed: Vec<&str> = VERBS.iter().map(|(verb, _)| *verb).collect();
        let mut words = words_of_the_interface();
        listed.sort_unstable();
        words.sort_unstable();
        assert_eq!(listed, words, "give each request a role in VERBS");
    }
}
