//! All recordings of a run as one that other programs read: one file, whose parts follow each other on one time line.
//!
//! It is made while it is read, record by record, so that neither the memory nor the disk holds a second copy. The same parts give
//! the same bytes. What the brain perceived and decided stays as it was written, in the time of the daemon that wrote it: a
//! replay rests on it. Moved is the time by which a file is sorted, and that of the forms that Foxglove draws.

use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::io::{self, Read, Write};
use std::rc::Rc;

use mcap::records::{MessageHeader, Metadata, Record};
use mcap::write::NoSeek;
use mcap::{Attachment, WriteOptions, Writer};

use super::foxglove;
use super::records::{AfterDamage, Records};

/// A part begins so much after the end of the one before at least: the checkpoint from which a daemon went on may be some seconds
/// older than the last words of the daemon before.
const APART_NS: u64 = 1_000_000;

/// A recording of the run.
#[derive(Debug)]
pub struct Part<R> {
    /// Name of its file.
    pub name: String,
    /// Time of its clock at which the run began, seconds.
    pub zero_s: f64,
    /// What is in it.
    pub file: R,
}

/// The bytes of one file with the content of all recordings. It consumes those that it reads.
pub struct Whole<R> {
    /// What is not begun yet.
    parts: VecDeque<Part<R>>,
    reading: Option<Records<R>>,
    /// Gone when the file is written to its end.
    joiner: Option<Joiner>,
    ready: Rc<RefCell<VecDeque<u8>>>,
    zero_s: f64,
}

impl<R> fmt::Debug for Whole<R> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Whole")
            .field("parts", &self.parts.len())
            .finish_non_exhaustive()
    }
}

impl<R: Read> Whole<R> {
    /// Of these parts in their order. The first one keeps its times.
    ///
    /// # Errors
    /// None that a memory with room for a header knows.
    pub fn new(parts: Vec<Part<R>>) -> io::Result<Self> {
        let ready = Rc::default();
        Ok(Self {
            zero_s: parts.first().map_or(0.0, |part| part.zero_s),
            parts: parts.into(),
            reading: None,
            joiner: Some(Joiner::new(Sink(Rc::clone(&ready))).map_err(io::Error::other)?),
            ready,
        })
    }

    /// Goes on by one record.
    fn step(&mut self) -> io::Result<()> {
        let Some(joiner) = &mut self.joiner else {
            return Ok(());
        };
        if let Some(records) = &mut self.reading {
            match records.next(|record| joiner.take(record))? {
                Some(taken) => return taken.map_err(io::Error::other),
                None => self.reading = None,
            }
        }
        match self.parts.pop_front() {
            Some(part) => {
                joiner.begin(&part.name, self.zero_s - part.zero_s);
                self.reading = Some(Records::new(part.file, AfterDamage::GoOn));
            }
            // It writes its end when it goes.
            None => self.joiner = None,
        }
        Ok(())
    }
}

impl<R: Read> Read for Whole<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.ready.borrow().is_empty() && self.joiner.is_some() {
            self.step()?;
        }
        self.ready.borrow_mut().read(into)
    }
}

/// Where the file is written until it is read.
struct Sink(Rc<RefCell<VecDeque<u8>>>);

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes the records of the parts.
struct Joiner {
    writer: Writer<NoSeek<Sink>>,
    /// Numbers of schemas in the part, and in the file.
    schemas: BTreeMap<u16, u16>,
    /// Numbers of channels in the part; number in the file, and topic.
    channels: BTreeMap<u16, (u16, String)>,
    name: String,
    shift: Shift,
    sequence: u32,
    /// The newest time so far.
    end_ns: u64,
}

/// By how much the times of a part are moved.
#[derive(Clone, Copy)]
enum Shift {
    /// By so much, unless the part before ends later.
    Wanted(i64),
    Is(i64),
}

impl Joiner {
    fn new(sink: Sink) -> Result<Self, mcap::McapError> {
        let options = WriteOptions::new()
            .compression(None)
            .disable_seeking(true)
            .library(concat!("vthal ", env!("CARGO_PKG_VERSION")));
        Ok(Self {
            writer: options.create(NoSeek::new(sink))?,
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            name: String::new(),
            shift: Shift::Is(0),
            sequence: 0,
            end_ns: 0,
        })
    }

    /// What comes is of another part.
    fn begin(&mut self, name: &str, shift_s: f64) {
        self.schemas.clear();
        self.channels.clear();
        name.clone_into(&mut self.name);
        self.shift = Shift::Wanted((1e9 * shift_s) as i64);
    }

    fn take(&mut self, record: &Record<'_>) -> Result<(), mcap::McapError> {
        match record {
            Record::Schema { header, data } => {
                let id = self.writer.add_schema(&header.name, &header.encoding, data)?;
                self.schemas.insert(header.id, id);
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).copied().unwrap_or(0);
                let (topic, encoding) = (&channel.topic, &channel.message_encoding);
                let id = self
                    .writer
                    .add_channel(schema, topic, encoding, &channel.metadata)?;
                self.channels.insert(channel.id, (id, topic.clone()));
            }
            Record::Message { header, data } => self.message(header, data)?,
            Record::Attachment { header, data, .. } => {
                let shift_ns = self.settled(header.log_time)?;
                self.writer.attach(&Attachment {
                    log_time: header.log_time.saturating_add_signed(shift_ns),
                    create_time: header.create_time,
                    name: header.name.clone(),
                    media_type: header.media_type.clone(),
                    data: data[..].into(),
                })?;
            }
            Record::Metadata(metadata) => self.writer.write_metadata(metadata)?,
            _ => {}
        }
        Ok(())
    }

    fn message(&mut self, header: &MessageHeader, data: &[u8]) -> Result<(), mcap::McapError> {
        let shift_ns = self.settled(header.log_time)?;
        let Some((channel_id, topic)) = self.channels.get(&header.channel_id) else {
            return Ok(());
        };
        let log_time = header.log_time.saturating_add_signed(shift_ns);
        let moved = MessageHeader {
            channel_id: *channel_id,
            sequence: self.sequence,
            log_time,
            publish_time: header.publish_time.saturating_add_signed(shift_ns),
        };
        self.sequence = self.sequence.wrapping_add(1);
        self.end_ns = self.end_ns.max(log_time);
        let stamped = match shift_ns {
            0 => None,
            _ => foxglove::moved(topic, data, shift_ns),
        };
        self.writer
            .write_to_known_channel(&moved, stamped.as_deref().unwrap_or(data))
    }

    /// The shift of this part's times, whose first one is `first_ns`. The file contains it.
    fn settled(&mut self, first_ns: u64) -> Result<i64, mcap::McapError> {
        let wanted_ns = match self.shift {
            Shift::Is(shift_ns) => return Ok(shift_ns),
            Shift::Wanted(wanted_ns) => wanted_ns,
        };
        let earliest_ns = match self.end_ns {
            0 => 0,
            end_ns => end_ns.saturating_add(APART_NS),
        };
        let begin_ns = first_ns.saturating_add_signed(wanted_ns).max(earliest_ns);
        let shift_ns = begin_ns.wrapping_sub(first_ns).cast_signed();
        self.shift = Shift::Is(shift_ns);
        let entries = [
            ("file", self.name.clone()),
            ("moved_ns", shift_ns.to_string()),
            ("begin_ns", begin_ns.to_string()),
        ];
        self.writer.write_metadata(&Metadata {
            name: "part".to_owned(),
            metadata: entries.map(|(key, value)| (key.to_owned(), value)).into(),
        })?;
        Ok(shift_ns)
    }
}
