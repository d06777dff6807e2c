//! Bytes as lower-case hexadecimal digits, in texts and in JSON.

use data_encoding::HEXLOWER;
use serde::{Deserialize as _, Deserializer, Serializer};

pub(crate) fn text(bytes: &[u8]) -> String {
    HEXLOWER.encode(bytes)
}

pub(crate) fn bytes<const N: usize>(text: &str) -> Option<[u8; N]> {
    HEXLOWER.decode(text.as_bytes()).ok()?.try_into().ok()
}

pub(crate) fn serialize<S: Serializer>(bytes: &[u8], to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&text(bytes))
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>, const N: usize>(from: D) -> Result<[u8; N], D::Error> {
    let text = String::deserialize(from)?;
    bytes(&text).ok_or_else(|| serde::de::Error::custom(format!("not {} hexadecimal digits", 2 * N)))
}
