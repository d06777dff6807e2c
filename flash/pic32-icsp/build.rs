//! Assembles the two programs that the programmer puts into the chip's RAM, so that what runs there is in the repository as source.
//!
//! It knows the instructions that they use, in the notation of GNU as with `.set noreorder`: labels, decimal and hexadecimal
//! numbers, comments from `#` on. Whatever it does not know fails the build with its line.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

const SOURCES: [(&str, &str); 2] = [("LOADER", "stub/loader.s"), ("STUB", "stub/stub.s")];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let mut text = String::new();
    for (name, path) in SOURCES {
        println!("cargo:rerun-if-changed={path}");
        let source = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let words = assemble(&source).unwrap_or_else(|error| panic!("{path}:{error}"));
        writeln!(
            text,
            "/// `{path}`, assembled.\npub(crate) const {name}: [u32; {}] = [",
            words.len()
        )
        .expect("a string");
        for word in words {
            writeln!(text, "    {word:#010x},").expect("a string");
        }
        text.push_str("];\n");
    }
    let folder = std::env::var_os("OUT_DIR").expect("cargo names it");
    std::fs::write(Path::new(&folder).join("stub_words.rs"), text).expect("cargo's own folder");
}

/// A line's label and statement, without its comment.
fn parts(line: &str) -> (Option<&str>, &str) {
    let code = line.split('#').next().unwrap_or_default();
    match code.split_once(':') {
        Some((label, rest)) => (Some(label.trim()), rest.trim()),
        None => (None, code.trim()),
    }
}

fn assemble(source: &str) -> Result<Vec<u32>, String> {
    let mut labels = BTreeMap::new();
    let mut statements = Vec::new();
    for (index, line) in source.lines().enumerate() {
        let (label, statement) = parts(line);
        if let Some(label) = label
            && labels.insert(label, statements.len()).is_some()
        {
            return Err(format!("{}: the label {label} is here twice", index + 1));
        }
        if !statement.is_empty() {
            statements.push((index + 1, statement));
        }
    }
    let encoded = statements.iter().enumerate().map(|(at, (line, statement))| {
        let here = Place { labels: &labels, at };
        encode(statement, &here).ok_or_else(|| format!("{line}: not understood: {statement}"))
    });
    encoded.collect()
}

struct Place<'a> {
    labels: &'a BTreeMap<&'a str, usize>,
    at: usize,
}

impl Place<'_> {
    /// Distance to a label in words, from the instruction after this one.
    fn distance(&self, label: &str) -> Option<u32> {
        let target = i32::try_from(*self.labels.get(label)?).ok()?;
        let distance = target - i32::try_from(self.at).ok()? - 1;
        Some(u32::from(i16::try_from(distance).ok()?.cast_unsigned()))
    }
}

fn encode(statement: &str, here: &Place<'_>) -> Option<u32> {
    let (name, rest) = statement
        .split_once(char::is_whitespace)
        .unwrap_or((statement, ""));
    let operands: Vec<&str> = rest
        .split(',')
        .map(str::trim)
        .filter(|text| !text.is_empty())
        .collect();
    let word = match (name, operands.as_slice()) {
        ("nop", []) => 0,
        ("jr", [rs]) => register(rs)? << 21 | 0x08,
        ("lui", [rt, value]) => 0x0F << 26 | register(rt)? << 16 | unsigned(value)?,
        ("addu" | "xor" | "nor", [rd, rs, rt]) => {
            let function = match name {
                "addu" => 0x21,
                "xor" => 0x26,
                _ => 0x27,
            };
            register(rs)? << 21 | register(rt)? << 16 | register(rd)? << 11 | function
        }
        ("addiu", [rt, rs, value]) => immediate(0x09, (rt, rs), signed(value)?)?,
        ("andi", [rt, rs, value]) => immediate(0x0C, (rt, rs), unsigned(value)?)?,
        ("ori", [rt, rs, value]) => immediate(0x0D, (rt, rs), unsigned(value)?)?,
        ("xori", [rt, rs, value]) => immediate(0x0E, (rt, rs), unsigned(value)?)?,
        ("beq", [rs, rt, label]) => immediate(0x04, (rt, rs), here.distance(label)?)?,
        ("bne", [rs, rt, label]) => immediate(0x05, (rt, rs), here.distance(label)?)?,
        ("lw" | "sw", [rt, place]) => {
            let (offset, base) = place.strip_suffix(')')?.split_once('(')?;
            let operation = if name == "lw" { 0x23 } else { 0x2B };
            immediate(operation, (rt, base), signed(offset)?)?
        }
        _ => return None,
    };
    Some(word)
}

fn immediate(operation: u32, (rt, rs): (&str, &str), value: u32) -> Option<u32> {
    Some(operation << 26 | register(rs)? << 21 | register(rt)? << 16 | value)
}

fn register(name: &str) -> Option<u32> {
    const NAMES: [&str; 32] = [
        "zero", "at", "v0", "v1", "a0", "a1", "a2", "a3", "t0", "t1", "t2", "t3", "t4", "t5", "t6", "t7",
        "s0", "s1", "s2", "s3", "s4", "s5", "s6", "s7", "t8", "t9", "k0", "k1", "gp", "sp", "fp", "ra",
    ];
    NAMES
        .iter()
        .position(|known| *known == name)
        .map(|number| number as u32)
}

fn number(text: &str) -> Option<i32> {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(digits) => (-1, digits),
        None => (1, text),
    };
    let value = match digits.strip_prefix("0x") {
        Some(digits) => i32::from_str_radix(digits, 16).ok()?,
        None => digits.parse().ok()?,
    };
    Some(sign * value)
}

fn signed(text: &str) -> Option<u32> {
    Some(u32::from(i16::try_from(number(text)?).ok()?.cast_unsigned()))
}

fn unsigned(text: &str) -> Option<u32> {
    Some(u32::from(u16::try_from(number(text)?).ok()?))
}
