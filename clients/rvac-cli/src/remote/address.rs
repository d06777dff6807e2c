//! How people write where a robot is.

use std::fmt;
use std::str::FromStr;

/// Port of HTTPS.
const PORT: u16 = 443;

/// `https://NAME[:PORT]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    /// A name, or an address; one of IPv6 in brackets.
    host: String,
    port: u16,
}

/// Not such an address.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("write it as https://rvac-7k2qm4xa.local or https://192.168.1.20:8443")]
pub(crate) struct AddressError;

impl Address {
    /// As certificates name it.
    pub(crate) fn name(&self) -> &str {
        self.host.trim_start_matches('[').trim_end_matches(']')
    }

    pub(crate) const fn port(&self) -> u16 {
        self.port
    }

    /// As in the header `Host`.
    pub(crate) fn authority(&self) -> String {
        match self.port {
            PORT => self.host.clone(),
            port => format!("{}:{port}", self.host),
        }
    }

    /// As in the header `Origin`.
    pub(crate) fn origin(&self) -> String {
        format!("https://{}", self.authority())
    }
}

impl fmt::Display for Address {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.origin())
    }
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let rest = text.strip_prefix("https://").ok_or(AddressError)?;
        let rest = rest.strip_suffix('/').unwrap_or(rest);
        let (host, port) = match rest.rsplit_once(':') {
            // The colons of an address of IPv6 are in its brackets.
            Some((host, port)) if !port.ends_with(']') => (host, port.parse().map_err(|_| AddressError)?),
            _ => (rest, PORT),
        };
        let (open, close) = (host.starts_with('['), host.ends_with(']'));
        let in_brackets = |c: char| c.is_ascii_hexdigit() || matches!(c, ':' | '.' | '[' | ']');
        let in_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '.');
        let is_host = !host.is_empty()
            && open == close
            && if open {
                host.chars().all(in_brackets)
            } else {
                host.chars().all(in_name)
            };
        is_host
            .then(|| Self {
                host: host.to_ascii_lowercase(),
                port,
            })
            .ok_or(AddressError)
    }
}

#[cfg(test)]
mod tests {
    use super::{Address, AddressError};

    #[test]
    fn what_people_write_is_read() {
        for (text, name, authority) in [
            ("https://Robot.local", "robot.local", "robot.local"),
            ("https://robot.local:443/", "robot.local", "robot.local"),
            ("https://192.168.1.20:8443", "192.168.1.20", "192.168.1.20:8443"),
            ("https://[fd00::1]:8443", "fd00::1", "[fd00::1]:8443"),
            ("https://[fd00::1]", "fd00::1", "[fd00::1]"),
        ] {
            let address: Address = text.parse().unwrap();
            assert_eq!(
                (address.name(), address.authority().as_str()),
                (name, authority),
                "{text}"
            );
        }
        for wrong in [
            "",
            "robot.local",
            "http://robot.local",
            "https://",
            "https://robot.local/x",
            "https://a b",
            "https://robot.local:x",
            "https://[fd00::1",
            "https://a\r\nX: y",
        ] {
            assert_eq!(wrong.parse::<Address>(), Err(AddressError), "{wrong}");
        }
    }
}
