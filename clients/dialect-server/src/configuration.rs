//! What the owner says: `/etc/rvac-dialect.toml`.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use bridge::service::ConfigurationError;
use serde::Deserialize;

/// A shorter password is guessed.
const PASSWORD_BYTES_MIN: usize = 8;

/// The file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Configuration {
    /// Unix socket of the daemon.
    #[serde(default = "usual_vthal")]
    pub(crate) vthal: PathBuf,
    /// Address to listen on.
    #[serde(default = "loopback")]
    pub(crate) bind: IpAddr,
    /// Port to listen on; 0 takes any free one.
    #[serde(default = "usual_port")]
    pub(crate) port: u16,
    /// Names by which clients call this computer, beside its addresses.
    #[serde(default)]
    pub(crate) hosts: Vec<String>,
    /// What clients know the robot by.
    #[serde(default = "usual_id")]
    pub(crate) id: String,
    /// Who may come in.
    #[serde(default = "usual_user")]
    pub(crate) user: String,
    /// By which password; absent = everybody who reaches the address.
    #[serde(default)]
    pub(crate) password: Option<String>,
    /// Whether the robot obeys; absent = only where a password says who asks.
    #[serde(default)]
    pub(crate) commands: Option<bool>,
}

fn usual_vthal() -> PathBuf {
    "/run/vthal/vthal.sock".into()
}

const fn loopback() -> IpAddr {
    IpAddr::V4(Ipv4Addr::LOCALHOST)
}

const fn usual_port() -> u16 {
    9781
}

fn usual_id() -> String {
    "librervac".to_owned()
}

fn usual_user() -> String {
    "robo".to_owned()
}

impl Configuration {
    /// See [`Self::commands`].
    pub(crate) fn takes_commands(&self) -> bool {
        self.commands.unwrap_or(self.password.is_some())
    }

    /// Checks what a file of the right form may still say wrong.
    pub(crate) fn check(&self) -> Result<(), ConfigurationError> {
        let unfit = |text: &str| Err(ConfigurationError::Unfit(text.to_owned()));
        let is_word = |text: &str, more: &str| {
            (1..=253).contains(&text.len())
                && text
                    .chars()
                    .all(|letter| letter.is_ascii_alphanumeric() || more.contains(letter))
        };
        if !is_word(&self.id, "-_") || self.id.eq_ignore_ascii_case("valetudo") {
            return unfit("id must be letters, digits, - and _, and not another project's name");
        }
        if self.user.is_empty() || self.user.contains(':') || self.user.chars().any(char::is_control) {
            return unfit("user must be one line without a colon");
        }
        if let Some(name) = self.hosts.iter().find(|name| !is_word(name, "-.")) {
            return unfit(&format!(
                "hosts: {name:?} is no name of a computer; write it without port and http://"
            ));
        }
        match &self.password {
            Some(password) if password.len() < PASSWORD_BYTES_MIN => {
                unfit("password must have eight characters at least")
            }
            // The map of a home, and when nobody is there, is for nobody in the street.
            None if !self.bind.to_canonical().is_loopback() => {
                unfit("bind lets other computers in: give a password, or leave bind away")
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::Configuration;

    fn read(text: &str) -> Configuration {
        serde_json::from_str(text).expect("a configuration")
    }

    #[test]
    fn the_example_is_a_configuration() {
        let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/example.toml"));
        let example: Configuration = bridge::service::read(file).expect("it can be read");
        assert!(example.check().is_ok());
    }

    #[test]
    fn without_a_password_it_is_for_this_computer_and_obeys_nobody() {
        let usual = read("{}");
        assert!(usual.check().is_ok() && usual.bind.is_loopback() && !usual.takes_commands());
        assert!(read(r#"{"commands": true}"#).takes_commands());
        let open = r#""bind": "0.0.0.0""#;
        assert!(read(&format!("{{{open}}}")).check().is_err());
        assert!(
            read(&format!(r#"{{{open}, "password": "short"}}"#))
                .check()
                .is_err()
        );
        let closed = read(&format!(r#"{{{open}, "password": "long enough"}}"#));
        assert!(closed.check().is_ok() && closed.takes_commands());
        for wrong in [
            r#"{"id": "Valetudo"}"#,
            r#"{"id": "a b"}"#,
            r#"{"user": "a:b"}"#,
            r#"{"hosts": ["http://robo"]}"#,
        ] {
            assert!(read(wrong).check().is_err(), "{wrong}");
        }
    }
}
