//! What the owner says: `/etc/rvac-mqtt.toml`.

use std::path::PathBuf;

use bridge::dial::{Dial, TlsFiles, host_and_port};
use bridge::service::ConfigurationError;
use serde::Deserialize;

use crate::wire::Version;

/// The file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Configuration {
    /// `mqtt://HOST[:PORT]`, or `mqtts://HOST[:PORT]` for TLS.
    pub(crate) broker: String,
    /// 3.1.1 or 5.
    #[serde(default = "usual_version")]
    pub(crate) version: Version,
    /// Unix socket of the daemon.
    #[serde(default = "usual_vthal")]
    pub(crate) vthal: PathBuf,
    /// Who the broker knows this client as.
    #[serde(default)]
    pub(crate) user: Option<String>,
    /// Its password.
    #[serde(default)]
    pub(crate) password: Option<String>,
    /// PEM file of the authorities that may vouch for the broker; absent = those of the system.
    #[serde(default)]
    pub(crate) ca: Option<PathBuf>,
    /// PEM file of this client's certificate, if the broker wants one.
    #[serde(default)]
    pub(crate) certificate: Option<PathBuf>,
    /// PEM file of its key.
    #[serde(default)]
    pub(crate) key: Option<PathBuf>,
    /// Whether the robot obeys what comes over the broker; absent = only where the broker asks who this client is. On a broker that
    /// lets everybody in everybody could drive the robot.
    #[serde(default)]
    pub(crate) commands: Option<bool>,
    /// First level of all topics.
    #[serde(default = "usual_prefix")]
    pub(crate) prefix: String,
    /// Second level of all topics, and what Home Assistant knows the robot by: it must stay the same.
    pub(crate) id: String,
    /// What people call the robot.
    #[serde(default)]
    pub(crate) name: Option<String>,
    /// First level of Home Assistant's topics; empty for none.
    #[serde(default = "usual_discovery")]
    pub(crate) discovery: String,
    /// First level of topics in the dialect of Valetudo's clients; empty for none.
    #[serde(default)]
    pub(crate) dialect_prefix: String,
    /// Least seconds between two pictures of the map; 0 for none.
    #[serde(default = "usual_map_every_s")]
    pub(crate) map_every_s: u16,
}

fn usual_version() -> Version {
    Version::V5
}

fn usual_vthal() -> PathBuf {
    "/run/vthal/vthal.sock".into()
}

fn usual_prefix() -> String {
    "librervac".to_owned()
}

fn usual_discovery() -> String {
    "homeassistant".to_owned()
}

fn usual_map_every_s() -> u16 {
    10
}

/// Where the broker is.
#[derive(Clone, Debug, PartialEq, Eq)]
struct BrokerPlace {
    host: String,
    port: u16,
    is_tls: bool,
}

impl Configuration {
    /// See [`Self::commands`].
    pub(crate) fn takes_commands(&self) -> bool {
        let is_known = self.user.is_some() || self.certificate.is_some();
        self.commands.unwrap_or(is_known)
    }

    /// Checks what a file of the right form may still say wrong; gives the way to the broker.
    pub(crate) fn check(&self) -> Result<Dial, ConfigurationError> {
        let unfit = |text: &str| Err(ConfigurationError::Unfit(text.to_owned()));
        let is_word = |word: &str| {
            (1..=64).contains(&word.len())
                && word
                    .bytes()
                    .all(|byte| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-')
        };
        if !is_word(&self.id) {
            return unfit("id must be 1 to 64 letters, digits, - and _");
        }
        if !self.prefix.split('/').all(is_word) || self.prefix.len() > 128 {
            return unfit("prefix must be levels of letters, digits, - and _ with / between them");
        }
        if !(self.discovery.is_empty() || is_word(&self.discovery)) {
            return unfit("discovery must be 1 to 64 letters, digits, - and _, or empty");
        }
        if !self.dialect_prefix.is_empty() && !is_word(&self.dialect_prefix) {
            return unfit("dialect_prefix must be 1 to 64 letters, digits, - and _, or empty");
        }
        // A robot that says it were another project's misleads people who look for help.
        if self.dialect_prefix.eq_ignore_ascii_case("valetudo") || self.dialect_prefix == self.prefix {
            return unfit("dialect_prefix must be a word of its own, and not another project's name");
        }
        if self.certificate.is_some() != self.key.is_some() {
            return unfit("certificate and key belong together: name both");
        }
        if self.password.is_some() && self.user.is_none() {
            return unfit("a password needs a user");
        }
        let place = broker_place(&self.broker);
        let Some(place) = place else {
            return unfit("broker must be mqtt://HOST[:PORT] or mqtts://HOST[:PORT]");
        };
        if !place.is_tls && (self.ca.is_some() || self.certificate.is_some()) {
            return unfit("ca and certificate are for mqtts://");
        }
        if !place.is_tls {
            return Ok(Dial::plain(&place.host, place.port));
        }
        let files = TlsFiles {
            ca: self.ca.clone(),
            own: self.certificate.clone().zip(self.key.clone()),
        };
        Dial::secured(&place.host, place.port, &files)
    }
}

fn broker_place(text: &str) -> Option<BrokerPlace> {
    let (scheme, rest) = text.split_once("://")?;
    let (is_tls, usual_port) = match scheme {
        "mqtt" => (false, 1883),
        "mqtts" => (true, 8883),
        _ => return None,
    };
    let (host, port) = host_and_port(rest.trim_end_matches('/'), usual_port)?;
    Some(BrokerPlace { host, port, is_tls })
}

#[cfg(test)]
mod tests {
    use super::{BrokerPlace, broker_place};

    #[test]
    fn a_broker_is_named_by_scheme_host_and_port() {
        let place = |host: &str, port, is_tls| {
            Some(BrokerPlace {
                host: host.to_owned(),
                port,
                is_tls,
            })
        };
        assert_eq!(
            broker_place("mqtt://homeassistant.local"),
            place("homeassistant.local", 1883, false)
        );
        assert_eq!(broker_place("mqtts://10.0.0.2:99/"), place("10.0.0.2", 99, true));
        assert_eq!(broker_place("mqtt://[::1]:2"), place("::1", 2, false));
        for wrong in [
            "homeassistant.local",
            "http://a",
            "mqtt://",
            "mqtt://a:b",
            "mqtt://u@a",
            "mqtt://a:70000",
        ] {
            assert_eq!(broker_place(wrong), None, "{wrong}");
        }
    }
}
