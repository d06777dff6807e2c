//! What goes to the host.

use super::{FLUSH_AFTER_MS, Reply, RobotCore};
use crate::binary;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::frame::{PACKET_BYTES_MAX, SEPARATOR};
use crate::message::{CommandNames, DescribeRow, Parameter, ProtocolVersion, Report, RobotHello, RowContent};
use crate::text::write_report_with_crc;

/// Rows of the description before the parameters.
const FIRST_ROWS: u8 = 3;
/// Rows of the description.
pub(super) const ROWS: u8 = MOTORS_ROW + 1;
/// It came last, so that the others keep their numbers.
const MOTORS_ROW: u8 = FIRST_ROWS + Parameter::ALL.len() as u8;

impl RobotCore {
    /// The next report that the session itself has to send.
    pub(super) fn next_report(&mut self) -> Option<Report> {
        match self.replies.pop_front() {
            Some(Reply::Hello) => Some(Report::Hello(self.hello())),
            Some(Reply::Row(row)) => Some(Report::Describe(self.row(row))),
            Some(Reply::Answer(answer)) => Some(Report::Acknowledgement(answer)),
            None => self.events.take_due(self.mode, self.now).map(Report::Event),
        }
    }

    pub(super) fn write(&mut self, report: &Report, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
        let silent = self
            .sent
            .is_none_or(|sent| self.now.since(sent) >= FLUSH_AFTER_MS);
        if silent {
            buffer.push(SEPARATOR)?;
        }
        self.sent = Some(self.now);
        match report {
            Report::State(state) if self.binary.state && !self.binary_left => {
                binary::write_state_with_crc(state, self.session, buffer)
            }
            // The host must be able to read it in any session state.
            Report::Hello(_) => write_report_with_crc(report, 0, buffer),
            _ => write_report_with_crc(report, self.session, buffer),
        }
    }

    fn hello(&self) -> RobotHello {
        RobotHello {
            version_min: ProtocolVersion::MIN,
            version_max: ProtocolVersion::CURRENT,
            device: self.identity.device.clone(),
            firmware: self.identity.firmware.clone(),
            session: self.session,
            packet_max: PACKET_BYTES_MAX as u16,
            boot_count: self.identity.boot_count,
            reset_cause: self.identity.reset_cause,
            binary: self.binary,
            tick: self.now,
        }
    }

    fn row(&self, row: u8) -> DescribeRow {
        let description = &self.identity.description;
        let content = match row {
            0 => RowContent::Limits(description.limits),
            1 => RowContent::Capabilities(description.capabilities),
            2 => RowContent::Commands(CommandNames::ALL),
            MOTORS_ROW => RowContent::Motors(description.motors),
            _ => parameter_row(row - FIRST_ROWS),
        };
        DescribeRow {
            row,
            rows: ROWS,
            content,
        }
    }
}

fn parameter_row(index: u8) -> RowContent {
    match Parameter::ALL.get(usize::from(index)) {
        Some(parameter) => {
            let (min, max) = parameter.range();
            RowContent::Parameter {
                parameter: *parameter,
                min,
                max,
            }
        }
        None => RowContent::Unknown,
    }
}
