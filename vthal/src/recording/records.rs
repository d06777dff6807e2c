//! The records of a recording, one after the other. The file is read piece by piece: it may be larger than the memory. No length in
//! it is believed beyond what the file has, and where something is damaged the reading goes on at the next whole chunk.

use std::io::{self, Read};
use std::ops::Range;

use mcap::parse_record;
use mcap::records::{Record, op};

/// No record of ours is longer.
const RECORD_BYTES_MAX: u64 = 64 << 20;
/// Opcode and length before a record.
const HEAD_BYTES: usize = 9;
/// What a chunk has before its records: two times, length, checksum, the name of the compression, which is empty in ours, length.
const CHUNK_HEAD_BYTES: usize = 8 + 8 + 8 + 4 + 4 + 8;
/// Read at once.
const PIECE_BYTES: usize = 64 << 10;

/// A recording while it is read.
pub(super) struct Records<R> {
    file: R,
    /// What was read and not used yet begins at `begin`.
    bytes: Vec<u8>,
    begin: usize,
    is_begun: bool,
    is_whole: bool,
    is_over: bool,
    after_damage: AfterDamage,
}

/// What is done where something is damaged.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum AfterDamage {
    /// The next whole chunk follows.
    GoOn,
    /// Nothing follows: what is lost matters to what comes after it.
    End,
}

/// The next record of the file itself.
enum TopRecord {
    /// It stands here, behind its head.
    Record(u8, Range<usize>),
    /// Its head is none, or it reaches beyond the file.
    Damaged,
    /// The file is over.
    Over,
}

impl<R: Read> Records<R> {
    pub(super) fn new(file: R, after_damage: AfterDamage) -> Self {
        Self {
            file,
            bytes: Vec::new(),
            begin: 0,
            is_begun: false,
            is_whole: true,
            is_over: false,
            after_damage,
        }
    }

    /// Shows the next record and gives what is made of it; `None` at the end.
    ///
    /// # Errors
    /// What the file system says.
    pub(super) fn next<T>(&mut self, take: impl FnOnce(&Record<'_>) -> T) -> io::Result<Option<T>> {
        self.check_magic()?;
        while !self.is_over {
            match self.top_record()? {
                TopRecord::Record(op::CHUNK, range) => self.open_chunk(range.end)?,
                TopRecord::Record(opcode, range) => {
                    self.begin = range.end;
                    if let Some(record) = parsed(opcode, self.bytes.get(range).unwrap_or_default()) {
                        self.is_over = opcode == op::FOOTER;
                        return Ok(Some(take(&record)));
                    }
                    self.is_whole = false;
                    self.is_over = self.after_damage == AfterDamage::End;
                }
                TopRecord::Damaged => self.find_chunk()?,
                TopRecord::Over => {
                    // A whole recording has a footer.
                    self.is_whole = false;
                    self.is_over = true;
                }
            }
        }
        Ok(None)
    }

    /// Whether nothing says so far that the file is damaged or breaks off.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole
    }

    fn check_magic(&mut self) -> io::Result<()> {
        if !self.is_begun {
            self.is_begun = true;
            self.fill(mcap::MAGIC.len())?;
            match self.unread().strip_prefix(mcap::MAGIC) {
                Some(_) => self.begin += mcap::MAGIC.len(),
                None => self.find_chunk()?,
            }
        }
        Ok(())
    }

    fn top_record(&mut self) -> io::Result<TopRecord> {
        self.fill(HEAD_BYTES)?;
        let Some((&opcode, rest)) = self.unread().split_first() else {
            return Ok(TopRecord::Over);
        };
        let Some(length) = u64_at(rest, 0).filter(|length| *length <= RECORD_BYTES_MAX) else {
            return Ok(TopRecord::Damaged);
        };
        let is_known = (op::HEADER..=op::DATA_END).contains(&opcode);
        let wanted = HEAD_BYTES + length as usize;
        self.fill(wanted)?;
        if !is_known || self.unread().len() < wanted {
            return Ok(TopRecord::Damaged);
        }
        Ok(TopRecord::Record(
            opcode,
            self.begin + HEAD_BYTES..self.begin + wanted,
        ))
    }

    /// Goes into a chunk that is whole: its records stand in it as those of the file do.
    fn open_chunk(&mut self, end: usize) -> io::Result<()> {
        if self.bytes.get(self.begin..end).is_some_and(holds_chunk) {
            self.begin += HEAD_BYTES + CHUNK_HEAD_BYTES;
            return Ok(());
        }
        // Its length may be what is damaged, so the next one may begin within it.
        self.find_chunk()
    }

    /// Goes to the next chunk behind the place that cannot be read.
    fn find_chunk(&mut self) -> io::Result<()> {
        self.is_whole = false;
        if self.after_damage == AfterDamage::End {
            self.is_over = true;
            return Ok(());
        }
        self.begin = (self.begin + 1).min(self.bytes.len());
        loop {
            self.fill(PIECE_BYTES)?;
            let unread = self.unread();
            let head = HEAD_BYTES + CHUNK_HEAD_BYTES;
            if let Some(place) = unread.windows(head).position(begins_chunk) {
                self.begin += place;
                return Ok(());
            }
            let is_last = unread.len() < PIECE_BYTES;
            // The rest may be the begin of one.
            self.begin += unread.len().saturating_sub(head - 1);
            if is_last {
                self.is_over = true;
                return Ok(());
            }
        }
    }

    fn unread(&self) -> &[u8] {
        self.bytes.get(self.begin..).unwrap_or_default()
    }

    /// Reads until so many bytes wait, or the file is over.
    fn fill(&mut self, wanted: usize) -> io::Result<()> {
        if self.unread().len() >= wanted {
            return Ok(());
        }
        self.bytes.drain(..self.begin.min(self.bytes.len()));
        self.begin = 0;
        let missing = (wanted - self.bytes.len()).max(PIECE_BYTES) as u64;
        self.file.by_ref().take(missing).read_to_end(&mut self.bytes)?;
        Ok(())
    }
}

fn u64_at(bytes: &[u8], place: usize) -> Option<u64> {
    let bytes = bytes.get(place..place + 8)?;
    Some(u64::from_le_bytes(bytes.try_into().ok()?))
}

/// Whether the head of a record and of a chunk as ours agree with each other. Hardly anything else does.
fn begins_chunk(head: &[u8]) -> bool {
    // Behind the opcode: the record's length, two times, bytes unpacked; behind checksum and empty name: bytes packed.
    let [
        Some(length),
        Some(from),
        Some(until),
        Some(unpacked),
        Some(packed),
    ] = [1, 9, 17, 25, 41].map(|place| u64_at(head, place))
    else {
        return false;
    };
    head.first() == Some(&op::CHUNK)
        && length <= RECORD_BYTES_MAX
        && unpacked == packed
        && packed.checked_add(CHUNK_HEAD_BYTES as u64) == Some(length)
        && from <= until
}

/// A record whose parts fit into it.
fn parsed(opcode: u8, body: &[u8]) -> Option<Record<'_>> {
    if opcode == op::ATTACHMENT && !holds_attachment(body) {
        return None;
    }
    parse_record(opcode, body).ok()
}

/// Whether an attachment has its two times, two texts, length and checksum. The library counts on them.
fn holds_attachment(body: &[u8]) -> bool {
    let text = |place: usize| {
        let length = body.get(place..place + 4)?.try_into().ok()?;
        place.checked_add(4 + u32::from_le_bytes(length) as usize)
    };
    let end = text(16).and_then(text).and_then(|data| data.checked_add(8 + 4));
    end.is_some_and(|end| end <= body.len())
}

/// Whether these are the bytes of a chunk as ours, and the checksum of its records is right.
fn holds_chunk(chunk: &[u8]) -> bool {
    let Some((head, records)) = chunk.split_at_checked(HEAD_BYTES + CHUNK_HEAD_BYTES) else {
        return false;
    };
    let crc = head.get(33..37).map(<[u8; 4]>::try_from);
    let Some(Ok(crc)) = crc else { return false };
    let crc = u32::from_le_bytes(crc);
    begins_chunk(head) && (crc == 0 || crc == crc32fast::hash(records))
}

#[cfg(test)]
mod tests {
    use std::io::{self, Cursor, Read};

    use mcap::records::{MessageHeader, Record};
    use mcap::{WriteOptions, Writer};

    use super::{AfterDamage, PIECE_BYTES, Records};

    /// Messages 0 to 999 in chunks of fifty.
    fn recording() -> Vec<u8> {
        let options = WriteOptions::new().compression(None);
        let mut writer = options.create(Cursor::new(Vec::new())).expect("begins");
        let id = writer
            .add_channel(0, "topic", "json", &[].into())
            .expect("is added");
        for sequence in 0..1_000 {
            write(&mut writer, id, sequence);
            if sequence % 50 == 49 {
                writer.flush().expect("flushes");
            }
        }
        writer.finish().expect("ends");
        writer.into_inner().into_inner()
    }

    fn write(writer: &mut Writer<Cursor<Vec<u8>>>, channel_id: u16, sequence: u32) {
        let time = u64::from(sequence);
        let header = MessageHeader {
            channel_id,
            sequence,
            log_time: time,
            publish_time: time,
        };
        let data = [u8::try_from(sequence % 251).expect("is small"); 100];
        writer.write_to_known_channel(&header, &data).expect("writes");
    }

    /// The numbers of messages that are read, and whether the file is whole.
    fn read(bytes: &[u8]) -> (Vec<u32>, bool) {
        let mut records = Records::new(bytes, AfterDamage::GoOn);
        let mut found = Vec::new();
        while let Some(number) = records.next(number).expect("is in memory") {
            found.extend(number);
        }
        (found, records.is_whole())
    }

    fn number(record: &Record<'_>) -> Option<u32> {
        match record {
            Record::Message { header, .. } => Some(header.sequence),
            _ => None,
        }
    }

    #[test]
    fn a_whole_recording_is_read_to_its_end() {
        assert_eq!(read(&recording()), ((0..1_000).collect(), true));
    }

    /// Each bit of the heads in the middle, and some of all others, flipped: a second or two of a run are lost, never the rest.
    #[test]
    fn one_flipped_bit_costs_the_chunk_that_it_is_in() {
        let whole = recording();
        let middle = whole.len() / 2;
        for place in (middle..middle + 8_000).step_by(7) {
            let mut damaged = whole.clone();
            damaged[place] ^= 1 << (place % 8);
            let (found, is_whole) = read(&damaged);
            assert!(!is_whole || found.len() == 1_000, "{place}");
            assert!(found.len() >= 900, "{place}: {}", found.len());
            assert!(found.is_sorted() && found.last() == Some(&999), "{place}");
        }
    }

    #[test]
    fn who_cannot_do_without_what_is_lost_is_given_what_comes_before_it() {
        let mut damaged = recording();
        let middle = damaged.len() / 2;
        damaged[middle] ^= 1;
        let mut records = Records::new(damaged.as_slice(), AfterDamage::End);
        let mut count = 0;
        while let Some(number) = records.next(number).expect("is in memory") {
            assert!(number.is_none_or(|number| number == count), "{number:?}");
            count += u32::from(number.is_some());
        }
        assert!((450..=500).contains(&count) && !records.is_whole(), "{count}");
    }

    #[test]
    fn a_file_that_ends_anywhere_gives_what_is_whole() {
        let whole = recording();
        for length in (0..whole.len() - 10).step_by(997) {
            let (found, is_whole) = read(&whole[..length]);
            assert!(!is_whole);
            assert_eq!(found, (0..found.len() as u32).collect::<Vec<_>>());
            assert!(
                found.len() + 100 >= 900 * length / whole.len(),
                "{length}: {}",
                found.len()
            );
        }
    }

    /// Never more than what was asked for at once.
    struct Watched<'a> {
        bytes: &'a [u8],
        most: usize,
    }

    impl Read for Watched<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            self.most = self.most.max(into.len());
            self.bytes.read(into)
        }
    }

    #[test]
    fn a_length_is_not_believed_beyond_what_the_file_has() {
        for length in [u64::MAX, 1 << 40, super::RECORD_BYTES_MAX] {
            let mut bytes = mcap::MAGIC.to_vec();
            bytes.push(mcap::records::op::MESSAGE);
            bytes.extend(length.to_le_bytes());
            bytes.extend([7; 1_000]);
            let mut records = Records::new(
                Watched {
                    bytes: &bytes,
                    most: 0,
                },
                AfterDamage::GoOn,
            );
            assert!(records.next(|_| ()).expect("is in memory").is_none());
            assert!(!records.is_whole());
            assert!(records.file.most <= 16 * PIECE_BYTES, "{}", records.file.most);
        }
    }

    #[test]
    fn nothing_that_is_damaged_at_random_is_a_panic() {
        let whole = recording();
        let mut random = 1_u64;
        let mut next = |below: usize| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (random >> 33) as usize % below
        };
        for _ in 0..300 {
            let mut damaged = whole.clone();
            for _ in 0..8 {
                damaged[next(whole.len())] = next(256) as u8;
            }
            let (found, _) = read(&damaged);
            assert!(found.len() >= 400, "{}", found.len());
        }
    }
}
