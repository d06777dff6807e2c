//! The computer in the robot, as the panel's server sees it.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// What cannot be found out is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SystemReport {
    /// Addresses for the address bar of a browser.
    pub urls: Vec<String>,
    /// Network interfaces that are up, except the computer's own loop.
    pub networks: Vec<NetworkAddress>,
    /// What its clock shows, seconds since 1970.
    pub clock_s: i64,
    /// Its time zone, a name of the IANA database.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zone: Option<String>,
    /// Where maps and recordings lie.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disk: Option<DiskSpace>,
    /// Bytes of memory.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_bytes: Option<u64>,
    /// Of these what programs can still have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_available_bytes: Option<u64>,
    /// Temperature of the processor, degrees Celsius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub processor_c: Option<f64>,
    /// Seconds since the computer was switched on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up_s: Option<u64>,
    /// Its model, for example `Raspberry Pi Zero 2 W Rev 1.0`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub board: Option<String>,
    /// Version of the panel's server.
    pub server: String,
}

/// An address of a network interface.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct NetworkAddress {
    /// Name of the interface, for example `wlan0`.
    pub interface: String,
    /// The address.
    pub address: String,
}

/// A file system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiskSpace {
    /// Bytes in all.
    pub total_bytes: u64,
    /// Bytes that can still be written.
    pub free_bytes: u64,
    /// Nothing can be written to it.
    pub read_only: bool,
}
