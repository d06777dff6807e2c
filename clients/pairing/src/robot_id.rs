//! The name of a robot that nobody else can take: it is derived from the robot's own key.

use data_encoding::BASE32_NOPAD;
use sha2::{Digest as _, Sha256};

/// Characters that people read and compare.
const SHORT: usize = 8;

/// Base32 of the SHA-256 of the public key of the robot's certificate authority.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotId(String);

/// The hash of a certificate, by which people compare it.
#[must_use]
pub fn sha256(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}

impl RobotId {
    /// From the public key as certificates contain it (SubjectPublicKeyInfo, DER).
    #[must_use]
    pub fn of_public_key(spki_der: &[u8]) -> Self {
        Self(BASE32_NOPAD.encode(&sha256(spki_der)).to_ascii_lowercase())
    }

    /// All of it, 52 characters.
    #[must_use]
    pub fn full(&self) -> &str {
        &self.0
    }

    /// The host name `rvac-` and eight characters, by which the robot goes on the home network.
    #[must_use]
    pub fn host_name(&self) -> String {
        format!("rvac-{}.local", self.0.get(..SHORT).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::RobotId;

    #[test]
    fn it_names_a_host() {
        let id = RobotId::of_public_key(b"a key");
        assert_eq!(id.full().len(), 52);
        let name = id.host_name();
        assert!(
            name.starts_with("rvac-") && name.ends_with(".local") && name.len() == 19,
            "{name}"
        );
        assert!(
            name.bytes()
                .all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b"-.".contains(&byte))
        );
        assert_ne!(id, RobotId::of_public_key(b"another key"));
    }
}
