//! The text form: one JSON object per packet.
//!
//! Reading takes the text without its CRC and returns a closed type or a [`Refusal`](crate::message::Refusal); writing
//! appends the text without a CRC. The session adds CRCs and separators; tools and tests use
//! [`write_command_with_crc`] and [`write_report_with_crc`].

mod command_read;
mod command_write;
mod decimal;
mod fields;
mod report_event;
mod report_info;
mod report_probe;
mod report_read;
mod report_robot;
mod report_state;
mod report_write;
mod scan;
mod write;

pub use command_read::{Form, RefusedCommand, is_stop, read_command};
pub use command_write::{write_command, write_command_with_crc};
pub use report_info::{FirmwareInfo, InfoPart};
pub use report_read::{ReportPacket, read_report};
pub use report_write::{write_report, write_report_with_crc};
