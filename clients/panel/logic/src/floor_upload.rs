//! The upload of a file with floors to the robot: piece by piece, each when the previous one has arrived.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rvac_api::{ARCHIVE_BYTES_MAX, ARCHIVE_UPLOAD_BYTES, RequestBody};

use crate::words::Words;

/// A file that is handed over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FloorUpload {
    bytes: Vec<u8>,
    sent: usize,
}

impl FloorUpload {
    /// Of the whole file.
    #[must_use]
    pub const fn new(bytes: Vec<u8>) -> Self {
        Self { bytes, sent: 0 }
    }

    /// The request with the next piece; none when all have gone.
    pub fn next_piece(&mut self) -> Option<RequestBody> {
        let rest = self.bytes.get(self.sent..)?;
        let piece = rest.chunks(ARCHIVE_UPLOAD_BYTES as usize).next()?;
        let request = RequestBody::ImportFloors {
            from: self.sent as u64,
            size: self.bytes.len() as u64,
            data: STANDARD.encode(piece),
        };
        self.sent += piece.len();
        Some(request)
    }

    /// Share of the file that has gone, 0..=1.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.sent as f64 / self.bytes.len().max(1) as f64
    }
}

/// What is wrong with a file of this size, before it is read.
#[must_use]
pub fn floor_file_problem(words: &Words, bytes: u64) -> Option<String> {
    let most_mb = words.number(ARCHIVE_BYTES_MAX as f64 / f64::from(1 << 20), 0);
    let is_one = (1..=ARCHIVE_BYTES_MAX).contains(&bytes);
    (!is_one).then(|| words.home.floors_file_size.fill([&most_mb]))
}

#[cfg(test)]
mod tests {
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;
    use rvac_api::{ARCHIVE_BYTES_MAX, ARCHIVE_UPLOAD_BYTES, RequestBody};

    use super::{FloorUpload, floor_file_problem};
    use crate::words::Language;

    #[test]
    fn a_file_goes_whole_in_pieces_that_the_robot_takes() {
        let file: Vec<u8> = (0..2 * ARCHIVE_UPLOAD_BYTES + 5).map(|byte| byte as u8).collect();
        let mut upload = FloorUpload::new(file.clone());
        let mut got = Vec::new();
        while let Some(request) = upload.next_piece() {
            let RequestBody::ImportFloors { from, size, data } = request else {
                panic!("another request")
            };
            assert_eq!((from, size), (got.len() as u64, file.len() as u64));
            let piece = STANDARD.decode(data).expect("base 64");
            assert!((1..=ARCHIVE_UPLOAD_BYTES).contains(&(piece.len() as u64)));
            got.extend(piece);
        }
        assert_eq!(got, file);
        assert!((upload.share() - 1.0).abs() < 1e-9);
        assert_eq!(FloorUpload::new(Vec::new()).next_piece(), None);
    }

    #[test]
    fn a_file_that_cannot_be_one_is_not_even_read() {
        let words = Language::English.words();
        for (bytes, is_wrong) in [
            (0, true),
            (1, false),
            (ARCHIVE_BYTES_MAX, false),
            (ARCHIVE_BYTES_MAX + 1, true),
        ] {
            assert_eq!(floor_file_problem(words, bytes).is_some(), is_wrong, "{bytes}");
        }
    }
}
