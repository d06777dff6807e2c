//! What a client shows with each request.

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::fmt;
use std::str::FromStr;
use subtle::ConstantTimeEq as _;

use crate::hex;

/// Names a client; no secret.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct TokenId(#[serde(with = "hex")] [u8; 8]);

impl fmt::Display for TokenId {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&hex::text(&self.0))
    }
}

impl FromStr for TokenId {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        hex::bytes(text).map(Self).ok_or_else(|| {
            format!("{text:?} is not the number of a client: it has 16 digits, see rvac clients")
        })
    }
}

/// A client's secret with the name of its owner.
#[derive(Clone)]
pub struct Token {
    id: TokenId,
    secret: [u8; 32],
}

impl fmt::Debug for Token {
    /// Without the secret, which belongs into no log.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "Token({})", self.id)
    }
}

impl Token {
    /// A fresh token from random bytes.
    #[must_use]
    pub fn from_random(random: &[u8; 40]) -> Self {
        let mut token = Self {
            id: TokenId([0; 8]),
            secret: [0; 32],
        };
        let (id, secret) = random.split_at(8);
        token.id.0.copy_from_slice(id);
        token.secret.copy_from_slice(secret);
        token
    }

    /// Reads `id.secret`.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let (id, secret) = text.split_once('.')?;
        Some(Self {
            id: TokenId(hex::bytes(id)?),
            secret: hex::bytes(secret)?,
        })
    }

    /// As it is shown with requests: `id.secret`.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{}.{}", self.id, hex::text(&self.secret))
    }

    /// Whose it is.
    #[must_use]
    pub const fn id(&self) -> TokenId {
        self.id
    }

    /// What is kept of it.
    pub(crate) fn digest(&self) -> TokenDigest {
        TokenDigest(Sha256::digest(self.secret).into())
    }
}

/// The hash of a secret, from which nobody gets the secret back: it has 256 random bits.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct TokenDigest(#[serde(with = "hex")] [u8; 32]);

impl TokenDigest {
    /// Compares in constant time, so that the duration does not reveal where the difference is.
    pub(crate) fn matches(&self, other: &Self) -> bool {
        self.0.ct_eq(&other.0).into()
    }
}

#[cfg(test)]
mod tests {
    use super::Token;

    #[test]
    fn a_token_is_read_back_and_nothing_else_is() {
        let token = Token::from_random(&core::array::from_fn(|index| index as u8));
        let text = token.text();
        let again = Token::parse(&text).unwrap();
        assert_eq!(again.id(), token.id());
        assert!(again.digest().matches(&token.digest()));
        assert!(
            !format!("{token:?}").contains("0a0b0c"),
            "the secret is not shown"
        );
        let id = token.id().to_string();
        for wrong in [
            "",
            ".",
            id.as_str(),
            &text.to_ascii_uppercase(),
            &text[1..],
            &format!("{text}0"),
        ] {
            assert!(Token::parse(wrong).is_none(), "{wrong}");
        }
    }
}
