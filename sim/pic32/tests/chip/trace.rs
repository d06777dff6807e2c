//! The value change dump, read back by a parser that knows the format and nothing of the writer.

use crate::program::{CLR, bare, oc, pin, run, timer};
use pic32::trace::Vcd;
use std::collections::BTreeMap;

/// Changes by name: (time in ps, value).
fn parse(text: &str) -> (BTreeMap<String, Vec<(u64, char)>>, u64) {
    let (head, body) = text.split_once("$enddefinitions $end").expect("a head");
    assert!(head.contains("$timescale 1ps $end"));
    let mut names = BTreeMap::new();
    for line in head.lines().filter(|line| line.starts_with("$var")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!((words[1], words[2], words[5]), ("wire", "1", "$end"));
        assert_eq!(
            names.insert(words[3].to_owned(), words[4].to_owned()),
            None,
            "identifiers are distinct"
        );
    }
    let (mut time, mut changes) = (0, BTreeMap::new());
    for line in body
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('$'))
    {
        if let Some(stamp) = line.strip_prefix('#') {
            let next: u64 = stamp.parse().expect("a time");
            assert!(next >= time, "time goes on");
            time = next;
        } else {
            let (value, identifier) = line.split_at(1);
            let name = names[identifier].clone();
            changes
                .entry(name)
                .or_insert_with(Vec::new)
                .push((time, value.chars().next().expect("a value")));
        }
    }
    (changes, time)
}

#[test]
fn pwm_and_a_switched_pin_as_a_viewer_reads_them() {
    let mut machine = bare();
    let pins = [pin("RE2"), pin("RD0"), pin("RE2")];
    let mut vcd = Vcd::begin(Vec::new(), &mut machine, &pins).expect("memory");
    for (address, value) in [
        (oc(1) + 0x20, 1_000),
        (oc(1), 0x800E),
        (timer(3) + 0x20, 3_999),
        (timer(3), 0x8000),
    ] {
        machine.write_register(address, value);
    }
    machine.write_register(0xBF88_6100 + CLR, 4);
    run(&mut machine, 4_500);
    vcd.record(&mut machine).expect("memory");
    machine.write_register(0xBF88_6120, 4);
    run(&mut machine, 9_000);
    let text = String::from_utf8(vcd.end(&mut machine).expect("memory")).expect("text");
    let (changes, end) = parse(&text);
    let cycles = |name: &str| {
        changes[name]
            .iter()
            .map(|&(time, value)| (time / 12_500, value))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        cycles("RD0"),
        [(0, '0'), (4_000, '1'), (5_000, '0'), (8_000, '1'), (9_000, '0')]
    );
    assert_eq!(cycles("RE2"), [(0, '0'), (4_500, '1')]);
    assert_eq!(end, 9_000 * 12_500);
}
