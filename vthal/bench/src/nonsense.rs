//! Requests and documents that nobody would write: sound ones with something wrong in them, and words thrown together.

use rvac_api::{VERBS, example_of};
use serde_json::Value;

use crate::next_random;

const FIELDS: [&str; 24] = [
    "id", "name", "topics", "strategy", "shape", "number", "room", "rooms", "settings", "v", "w", "ttl",
    "floor", "from", "size", "data", "profile", "zone", "quiet", "before", "count", "part", "values",
    "parts",
];

/// A request that is sound but for up to three of its values or keys, or one of words thrown together. Never what makes the daemon leave
/// its robot to another program.
pub fn request(state: &mut u64) -> String {
    let (verb, _) = pick(state, &VERBS);
    let verb = if verb == "borrow-link" { "dock" } else { verb };
    match example_of(verb) {
        Some(example) if index(state, 3) > 0 => nearly_sound(example, state),
        _ => thrown_together(verb, state),
    }
}

fn nearly_sound(example: &str, state: &mut u64) -> String {
    let mut request: Value = serde_json::from_str(example).unwrap_or_default();
    for _ in 0..index(state, 4) {
        let Some(fields) = request.as_object_mut() else {
            break;
        };
        let keys: Vec<String> = fields.keys().filter(|key| *key != "c").cloned().collect();
        let surplus = pick(state, &FIELDS).to_owned();
        let key = keys
            .get(index(state, keys.len().max(1)))
            .unwrap_or(&surplus)
            .clone();
        match index(state, 8) {
            0 => drop(fields.remove(&key)),
            1 => drop(fields.insert(surplus, any_value(state))),
            _ => change(fields.entry(key).or_insert(Value::Null), state),
        }
    }
    request.to_string()
}

fn thrown_together(verb: &str, state: &mut u64) -> String {
    let mut text = format!(r#"{{"c":"{verb}""#);
    for _ in 0..index(state, 5) {
        text.push_str(&format!(r#","{}":{}"#, pick(state, &FIELDS), value(state)));
    }
    text.push('}');
    text
}

/// Replaces one value anywhere in a document: a number mostly by another number, the rest by anything.
pub fn change(document: &mut Value, state: &mut u64) {
    let is_number = document.is_number();
    let count = match &*document {
        Value::Array(items) => items.len(),
        Value::Object(members) => members.len(),
        _ => 0,
    };
    let chosen = if count == 0 || index(state, 5) == 0 {
        None
    } else {
        match document {
            Value::Array(items) => items.get_mut(index(state, count)),
            Value::Object(members) => members.values_mut().nth(index(state, count)),
            _ => None,
        }
    };
    match chosen {
        Some(inner) => change(inner, state),
        None if is_number && index(state, 4) > 0 => *document = number(state),
        None => *document = any_value(state),
    }
}

/// A number at the ends of what programs count with, or a small one.
fn number(state: &mut u64) -> Value {
    match index(state, 10) {
        0 => Value::from(u64::MAX),
        1 => Value::from(i64::MIN),
        2 => Value::from(u32::MAX),
        3 => Value::from(i32::MIN),
        4 => Value::from(65_536),
        5 => Value::from(1e300),
        6 => Value::from(-1e-300),
        7 => Value::from(-1),
        8 => Value::from(0),
        _ => Value::from(index(state, 20)),
    }
}

fn any_value(state: &mut u64) -> Value {
    serde_json::from_str(&value(state)).unwrap_or(Value::Null)
}

fn pick<T: Copy>(state: &mut u64, all: &[T]) -> T {
    all[index(state, all.len())]
}

/// One of so many.
pub fn index(state: &mut u64, count: usize) -> usize {
    (next_random(state) % count as u64) as usize
}

/// A value in JSON that little code expects.
pub fn value(state: &mut u64) -> String {
    match index(state, 10) {
        0 => next_random(state).to_string(),
        1 => format!("-{}", index(state, 1000)),
        2 => "1e308".to_owned(),
        3 => "null".to_owned(),
        4 => format!("\"{}\"", "õ".repeat(index(state, 3000))),
        5 => format!("{}{}", "[".repeat(60), "]".repeat(60)),
        6 => r#"{"zone":[[0,0],[1e300,0],[0,-1e300]]}"#.to_owned(),
        7 => r#"["log","packets","log"]"#.to_owned(),
        8 => "0.1".to_owned(),
        _ => "true".to_owned(),
    }
}
