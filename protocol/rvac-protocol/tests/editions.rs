//! Hosts and robots of different age: packets of earlier editions of the wire, kept in `protocol/vectors/editions`, against today's.
//!
//! An *edition* is a state of the golden vectors within one version. Version 1 is the only one so far; its last three editions are kept,
//! of which the third are today's files. What is golden today is read and written by every implementation (`vectors.rs`, the tests of the
//! C cord, the emulated robots). So an old peer is understood when its packets are still golden, and it understands when what is sent
//! today has all that it asks for. A red test means: revert the change.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

const EDITIONS: [&str; 2] = ["1.1", "1.2"];
/// What is sent and understood. What is refused may become less.
const FILES: [&str; 3] = ["commands", "reports", "tolerated"];

fn vectors(path: &str) -> Vec<Value> {
    let path = format!("{}/../vectors/{path}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let mut file: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"));
    match file["vectors"].take() {
        Value::Array(vectors) if !vectors.is_empty() => vectors,
        _ => panic!("{path}: no vectors"),
    }
}

/// An old sender and a reader of today, in both directions: each packet is there with its session, spelling and meaning.
#[test]
fn every_packet_of_an_earlier_edition_is_golden_today() {
    let mut checked = 0;
    for file in FILES {
        let today = vectors(file);
        for edition in EDITIONS {
            for old in vectors(&format!("editions/{edition}/{file}")) {
                assert!(today.contains(&old), "edition {edition}, {file}: {old}");
                checked += 1;
            }
        }
    }
    assert!(checked > 250, "{checked}");
}

/// The packets of a vector as their kind and their keys.
fn packets(vector: &Value) -> Vec<(String, BTreeSet<String>)> {
    let lines = match (&vector["line"], &vector["lines"]) {
        (Value::String(line), _) => vec![line.as_str()],
        (_, Value::Array(lines)) => lines.iter().filter_map(Value::as_str).collect(),
        _ => panic!("no line in {vector}"),
    };
    let texts = lines.into_iter().flat_map(|line| line.split('\u{1f}'));
    texts
        .filter_map(|text| text.rsplit_once('*'))
        .map(|(text, _)| {
            let packet: BTreeMap<String, Value> =
                serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"));
            let kind = packet.get("c").or(packet.get("r")).or(packet.get("e"));
            let kind = kind.and_then(Value::as_str).unwrap_or("?").to_owned();
            (kind, packet.into_keys().collect())
        })
        .collect()
}

/// The keys that all packets of a kind have in common.
fn required(vectors: &[Value]) -> BTreeMap<String, BTreeSet<String>> {
    let mut kinds: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (kind, keys) in vectors.iter().flat_map(packets) {
        kinds
            .entry(kind)
            .and_modify(|common| common.retain(|key| keys.contains(key)))
            .or_insert(keys);
    }
    kinds
}

/// A sender of today and an old reader: it may meet kinds and keys that it does not know, but misses none that it always got.
#[test]
fn what_is_sent_today_has_all_keys_that_an_earlier_edition_always_got() {
    let mut kinds = 0;
    for file in ["commands", "reports"] {
        let today = required(&vectors(file));
        for edition in EDITIONS {
            for (kind, keys) in required(&vectors(&format!("editions/{edition}/{file}"))) {
                let now = today
                    .get(&kind)
                    .unwrap_or_else(|| panic!("edition {edition}: no {kind} any more"));
                // Keys that only some packets had were optional then.
                let missed: Vec<&String> = keys.difference(now).collect();
                assert!(missed.is_empty(), "edition {edition}, {kind}: {missed:?}");
                kinds += 1;
            }
        }
    }
    assert!(kinds > 30, "{kinds}");
}
