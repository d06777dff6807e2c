//! What a program's flow of control tells: how deep its stack gets, which panics it can reach, whether interrupts use
//! floating point.

use super::elf::Elf;
use super::graph::{Depth, Graph};
use super::instruction::{Effect, effect};
use anyhow::Context;
use std::collections::BTreeSet;

/// Levels on which handlers can interrupt each other. Level 7 is not used.
const LEVELS: usize = 6;
/// The function that the vectors jump to: it saves registers and calls the handler.
const ENTRY: &str = "__interrupt_entry";
/// Where the program begins.
const START: &str = "__start";
/// What runs when the program breaks, on a stack of its own.
const EXCEPTION: &str = "__exception";
/// What a vector without handler calls: it ends in a reset on a stack of its own.
const UNHANDLED: &str = "__unhandled_interrupt";
/// k0, in which a vector passes its handler's address.
const HANDLER_REGISTER: u8 = 26;

/// What was found.
#[derive(Debug)]
pub(super) struct Flow {
    /// Stack of the main program and of the deepest handlers on top of each other.
    pub(super) stack: StackBound,
    /// Functions that call into the panic machinery and can be reached.
    pub(super) panics: BTreeSet<String>,
    /// Functions of floating point that can be reached from anywhere.
    pub(super) floats: BTreeSet<String>,
    /// Those that can be reached from a handler.
    pub(super) floats_in_handlers: BTreeSet<String>,
}

/// A bound for the stack.
#[derive(Debug)]
pub(super) struct StackBound {
    /// The main program's deepest chain.
    pub(super) main: Depth,
    /// Each handler's chain with the entry's frame, deepest first.
    pub(super) handlers: Vec<Depth>,
    /// Functions that make the bound no bound: recursion, or frames of unknown size.
    pub(super) doubts: BTreeSet<String>,
}

impl StackBound {
    /// Bytes at worst: the main program, and on each level one handler, of all handlers the deepest.
    pub(super) fn worst_bytes(&self) -> u32 {
        let handlers = self.handlers.iter().take(LEVELS).map(|depth| depth.bytes);
        self.main.bytes.saturating_add(handlers.sum())
    }
}

/// Examines a program.
pub(super) fn examine(elf: &Elf) -> anyhow::Result<Flow> {
    let graph = Graph::of(elf);
    let handlers = handlers(elf);
    let start = elf
        .address_of(START)
        .with_context(|| format!("the program has no {START}"))?;
    let in_handlers = graph.reach(&handlers);
    let exception: Vec<u32> = elf.address_of(EXCEPTION).into_iter().collect();
    let everything = graph.reach(&[&[start], handlers.as_slice(), &exception].concat());
    let entry = elf.address_of(ENTRY).and_then(|entry| graph.function(entry));
    Ok(Flow {
        stack: stack(&graph, start, entry.map_or(0, |entry| entry.frame), &handlers),
        panics: callers_of_panics(&graph, &everything),
        floats: floats(&graph, &everything),
        floats_in_handlers: floats(&graph, &in_handlers),
    })
}

fn stack(graph: &Graph, start: u32, entry_frame: u32, handlers: &[u32]) -> StackBound {
    let mut deepest: Vec<Depth> = handlers
        .iter()
        .map(|handler| {
            let mut depth = graph.depth(*handler);
            depth.bytes = depth.bytes.saturating_add(entry_frame);
            depth
        })
        .collect();
    deepest.sort_by(|left, right| (right.bytes, &left.chain).cmp(&(left.bytes, &right.chain)));
    let main = graph.depth(start);
    let everything = graph.reach(&[&[start], handlers].concat());
    let mut doubts: BTreeSet<String> = graph.unknown_frames(&everything).into_iter().collect();
    doubts.extend(main.recursive.iter().cloned());
    doubts.extend(deepest.iter().flat_map(|depth| depth.recursive.iter().cloned()));
    StackBound {
        main,
        handlers: deepest,
        doubts,
    }
}

/// The handlers in the vector table: each slot loads one's address into k0 around a jump to the entry.
fn handlers(elf: &Elf) -> Vec<u32> {
    let entry = elf.address_of(ENTRY);
    let unhandled = elf.address_of(UNHANDLED);
    let mut found = BTreeSet::new();
    for section in elf.sections.iter().filter(|section| section.executable) {
        for address in (section.address..section.address.saturating_add(section.size)).step_by(4) {
            let at = |index: u32| {
                let address = address.wrapping_add(4 * index);
                elf.word(address)
                    .map_or(Effect::None, |word| effect(word, address))
            };
            let (
                Effect::Upper {
                    register: HANDLER_REGISTER,
                    value,
                },
                Effect::Jump(place),
            ) = (at(0), at(1))
            else {
                continue;
            };
            if let Effect::Lower {
                register: HANDLER_REGISTER,
                offset,
                ..
            } = at(2)
                && entry.is_some()
            {
                found.insert(value.wrapping_add_signed(i32::from(offset)));
                // A vector that is entered in a way of its own, before its handler or without it.
                found.extend((entry != Some(place)).then_some(place));
            }
        }
    }
    found
        .into_iter()
        .filter(|handler| unhandled != Some(*handler))
        .collect()
}

/// Parts of the names of functions that end in a panic.
const PANICS: [&str; 7] = [
    "core::panicking",
    "core::option::unwrap_failed",
    "core::option::expect_failed",
    "core::result::unwrap_failed",
    "core::slice::index::slice_",
    "core::str::slice_error_fail",
    "core::cell::panic_",
];

fn is_panic(name: &str) -> bool {
    PANICS.iter().any(|panic| name.contains(panic)) || name.ends_with("rust_begin_unwind")
}

fn callers_of_panics(graph: &Graph, among: &BTreeSet<u32>) -> BTreeSet<String> {
    let calls_one = |start: &&u32| {
        graph
            .calls(**start)
            .iter()
            .any(|next| is_panic(&graph.name(*next)))
    };
    let callers = among.iter().filter(calls_one).map(|start| graph.name(*start));
    callers.filter(|name| !is_panic(name)).collect()
}

/// Operations of the compiler's support library on floating point, without the width at the end: `__adddf3`, `__addsf3`.
const FLOATS: [&str; 13] = [
    "__add", "__sub", "__mul", "__div", "__neg", "__cmp", "__unord", "__eq", "__ne", "__lt", "__le", "__gt",
    "__ge",
];

fn is_float(name: &str) -> bool {
    let name = name.rsplit("::").next().unwrap_or(name);
    let arithmetic = FLOATS.iter().any(|operation| {
        name.strip_prefix(operation)
            .is_some_and(|width| matches!(width, "sf3" | "df3" | "sf2" | "df2" | "sf2vfp" | "df2vfp"))
    });
    let conversion = ["__float", "__fix", "__extend", "__trunc", "__powi"];
    arithmetic
        || (conversion.iter().any(|kind| name.starts_with(kind))
            && (name.contains("sf") || name.contains("df")))
}

fn floats(graph: &Graph, among: &BTreeSet<u32>) -> BTreeSet<String> {
    let names = among
        .iter()
        .filter_map(|start| graph.function(*start))
        .map(|function| &function.name);
    names.filter(|name| is_float(name)).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::{examine, is_float, is_panic};
    use crate::firmware::sample::{BASE, linked};

    const fn grow(bytes: u32) -> u32 {
        0x27BD_0000 | (0x1_0000 - bytes)
    }

    const fn jump(word_index: u32) -> u32 {
        0x0800_0000 | (((BASE & 0x0FFF_FFFF) >> 2) + word_index)
    }

    const fn call(word_index: u32) -> u32 {
        jump(word_index) | 0x0400_0000
    }

    /// A slot of the vector table: the handler's address goes into k0, and the entry is at word 6.
    const fn slot(handler_word: u32) -> [u32; 3] {
        [0x3C1A_9D00, jump(6), 0x275A_0000 | (4 * handler_word)]
    }

    /// Two slots, one of them without handler; the entry with 112 bytes; the program; handlers.
    fn examined(handler: [u32; 2]) -> super::Flow {
        const INDIRECT: u32 = 0x0320_F809;
        let slots = [slot(12), slot(16)].concat();
        let vectors: [(&str, &[u32]); 2] = [("slots", &slots), ("__interrupt_entry", &[grow(112), INDIRECT])];
        let text: [(&str, &[u32]); 6] = [
            ("__start", &[call(10), 0]),
            ("__program", &[grow(24), 0]),
            ("ADC", &handler),
            ("leaf", &[grow(8), 0]),
            ("__unhandled_interrupt", &[jump(18), 0]),
            ("core::panicking::panic", &[grow(200), 0]),
        ];
        examine(&linked(&[(".vectors", &vectors), (".text", &text)], &[])).expect("it has a start")
    }

    #[test]
    fn handlers_are_read_from_the_vectors_and_stand_on_top_of_the_program() {
        let flow = examined([grow(16), call(14)]);
        assert_eq!(flow.stack.main.bytes, 24);
        let handlers: Vec<_> = flow
            .stack
            .handlers
            .iter()
            .map(|handler| handler.chain.join(" "))
            .collect();
        assert_eq!(handlers, ["ADC leaf"]);
        assert_eq!(flow.stack.worst_bytes(), 24 + 112 + 16 + 8);
        assert!(flow.panics.is_empty() && flow.stack.doubts.is_empty());
    }

    #[test]
    fn a_panic_in_a_handler_is_found_by_its_caller() {
        let flow = examined([grow(16), call(18)]);
        assert_eq!(flow.panics.into_iter().collect::<Vec<_>>(), ["ADC"]);
    }

    #[test]
    fn floating_point_is_told_from_whole_numbers() {
        for name in [
            "__adddf3",
            "__mulsf3",
            "__ltsf2",
            "__unorddf2",
            "__floatsidf",
            "__fixunsdfsi",
            "__extendsfdf2",
        ] {
            assert!(is_float(name), "{name}");
        }
        for name in [
            "__divdi3",
            "__udivdi3",
            "__muldi3",
            "__ashldi3",
            "sr8730::fix_df",
            "__start",
        ] {
            assert!(!is_float(name), "{name}");
        }
    }

    #[test]
    fn panics_are_known_by_name() {
        assert!(is_panic("core::panicking::panic_const::panic_const_div_by_zero"));
        assert!(is_panic("core::slice::index::slice_index_fail"));
        assert!(!is_panic("cordlib::panic_stop"));
    }
}
