//! Who may sign an update.

use minisign_verify::{Error, PublicKey, Signature};

use crate::error::BundleError;

/// The present key, and the next one, which lies offline until the present one is lost.
const KEYS_MAX: usize = 2;

/// Keys that are accepted.
#[derive(Debug)]
pub struct PublicKeys(Vec<PublicKey>);

/// Why keys cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum KeyError {
    /// There is none.
    #[error("no key is given, so nobody's update can be accepted")]
    None,
    /// There are too many.
    #[error("{0} keys are given; the present one and the next are enough")]
    TooMany(usize),
    /// One is none.
    #[error("key {0} is no public key of minisign")]
    Format(usize),
}

impl PublicKeys {
    /// Keys as minisign writes them into `.pub` files.
    ///
    /// # Errors
    /// When there is none, more than two, or one that is not understood.
    pub fn parse(texts: &[String]) -> Result<Self, KeyError> {
        match texts.len() {
            0 => return Err(KeyError::None),
            1..=KEYS_MAX => {}
            more => return Err(KeyError::TooMany(more)),
        }
        let keys = texts.iter().enumerate().map(|(index, text)| {
            PublicKey::decode(text.trim_end())
                .or_else(|_| PublicKey::from_base64(text.trim()))
                .map_err(|_| KeyError::Format(index + 1))
        });
        Ok(Self(keys.collect::<Result<_, _>>()?))
    }

    /// Whether one of the keys has signed these bytes.
    pub(crate) fn check(&self, bytes: &[u8], signature: &str) -> Result<(), BundleError> {
        let signature = Signature::decode(signature).map_err(|_| BundleError::SignatureFormat)?;
        for key in &self.0 {
            match key.verify(bytes, &signature, false) {
                Ok(()) => return Ok(()),
                Err(Error::UnexpectedKeyId) => {}
                Err(_) => return Err(BundleError::WrongSignature),
            }
        }
        Err(BundleError::UnknownKey)
    }
}
