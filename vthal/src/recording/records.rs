//! The records of a recording, one after the other. The file is read piece by piece: it may be larger than the memory.

use std::io::{self, Read};

use mcap::parse_record;
use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// No record of ours is longer.
const RECORD_BYTES_MAX: usize = 64 << 20;

/// A recording while it is read.
pub(super) struct Records<R> {
    file: R,
    reader: LinearReader,
    is_whole: bool,
}

impl<R: Read> Records<R> {
    pub(super) fn new(file: R) -> Self {
        let options = LinearReaderOptions::default().with_record_length_limit(RECORD_BYTES_MAX);
        Self {
            file,
            reader: LinearReader::new_with_options(options),
            is_whole: true,
        }
    }

    /// Shows the next record and gives what is made of it; `None` at the end, or where the file breaks off.
    ///
    /// # Errors
    /// What the file system says.
    pub(super) fn next<T>(&mut self, take: impl FnOnce(&Record<'_>) -> T) -> io::Result<Option<T>> {
        while self.is_whole
            && let Some(event) = self.reader.next_event()
        {
            match event {
                Ok(LinearReadEvent::ReadRequest(wanted)) => {
                    let read = self.file.read(self.reader.insert(wanted))?;
                    self.reader.notify_read(read);
                }
                Ok(LinearReadEvent::Record { data, opcode }) => {
                    if let Ok(record) = parse_record(opcode, data) {
                        return Ok(Some(take(&record)));
                    }
                }
                Err(_) => self.is_whole = false,
            }
        }
        Ok(None)
    }

    /// Whether nothing says so far that the file breaks off.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole
    }
}
