//! Golden packets as inputs to begin with: for the fuzz targets' corpora and for the mutations in `cargo test`.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// Characters of a CRC in text, its `*` included.
const TEXT_CRC: usize = 9;
/// Bytes of a CRC in a binary packet.
const BINARY_CRC: usize = 4;

/// Pieces of golden packets: texts, and bodies of binary packets.
pub(crate) fn pieces() -> Vec<Vec<u8>> {
    let mut pieces = Vec::new();
    for file in ["commands", "reports", "refused", "tolerated", "framing"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../vectors");
        let text = fs::read_to_string(folder.join(file).with_extension("json"))
            .expect("the vectors are beside the crate");
        let file: Value = serde_json::from_str(&text).expect("vectors are JSON");
        for vector in file["vectors"].as_array().expect("a file of vectors") {
            if let Some(line) = vector["line"].as_str() {
                pieces.extend(
                    line.split('\x1f')
                        .map(|packet| packet.as_bytes()[..packet.len() - TEXT_CRC].to_vec()),
                );
            }
            if let Some(text) = vector["text"].as_str() {
                pieces.push(text.as_bytes().to_vec());
            }
            for key in ["binary_line_hex", "stream_hex"] {
                if let Some(digits) = vector[key].as_str() {
                    let packet = from_hex(digits);
                    if packet.len() > BINARY_CRC {
                        pieces.push(packet[1..packet.len() - BINARY_CRC].to_vec());
                    }
                    pieces.push(packet);
                }
            }
        }
    }
    pieces
}

fn from_hex(digits: &str) -> Vec<u8> {
    (0..digits.len())
        .step_by(2)
        .map(|at| u8::from_str_radix(&digits[at..at + 2], 16).expect("hexadecimal digits"))
        .collect()
}
