//! Who calls whom in a linked program, what can be reached, and how deep the stack can get.
//!
//! Calls through pointers are taken to reach every function whose address the program holds anywhere: in its constants, or
//! made by a pair of instructions. So depths are upper bounds.

use super::elf::{Elf, Section, Symbol};
use super::instruction::{Effect, effect};
use std::collections::{BTreeMap, BTreeSet};

/// A function.
#[derive(Clone, Debug, Default)]
pub(super) struct Function {
    /// Its name.
    pub(super) name: String,
    /// Bytes of stack of its own.
    pub(super) frame: u32,
    /// Places of functions that it calls or jumps to.
    calls: BTreeSet<u32>,
    /// Whether it calls through a pointer.
    indirect: bool,
    /// Whether its frame cannot be read from the code.
    unknown_frame: bool,
}

/// The functions of a program by their first address.
#[derive(Debug, Default)]
pub(super) struct Graph {
    functions: BTreeMap<u32, Function>,
    /// Functions whose address is held somewhere.
    pointed_at: BTreeSet<u32>,
}

/// The deepest chain of calls from some function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Depth {
    /// Bytes.
    pub(super) bytes: u32,
    /// Names, from the first to the deepest.
    pub(super) chain: Vec<String>,
    /// Functions that can call themselves, so that no depth is a bound.
    pub(super) recursive: BTreeSet<String>,
}

/// Sections of the start-up code's own: addresses of functions in them are no pointers that the program could call. The
/// vectors pass those of handlers, and reset that of the program.
const START_UP: [&str; 2] = [".vectors", ".reset"];
/// Functions that go on with a stack of their own and do not come back.
const FRESH_STACK: [&str; 1] = ["__general_exception"];

impl Graph {
    /// Reads all functions of a program.
    pub(super) fn of(elf: &Elf) -> Self {
        let mut graph = Self::default();
        let code: Vec<&Section> = elf.sections.iter().filter(|section| section.executable).collect();
        for (start, end, name) in extents(&elf.symbols, &code) {
            graph.functions.insert(
                start,
                Function {
                    name,
                    ..Function::default()
                },
            );
            graph.scan(elf, start, end);
        }
        let fresh = FRESH_STACK.iter().filter_map(|name| elf.address_of(name));
        for start in fresh {
            graph.functions.entry(start).and_modify(|function| {
                *function = Function {
                    name: std::mem::take(&mut function.name),
                    ..Function::default()
                };
            });
        }
        for section in elf.sections.iter().filter(|section| !section.executable) {
            let words = section.bytes.iter().flat_map(|bytes| bytes.chunks_exact(4));
            let words = words.map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
            graph.pointed_at.extend(words);
        }
        let starts: BTreeSet<u32> = graph.functions.keys().copied().collect();
        graph.pointed_at.retain(|address| starts.contains(address));
        graph
    }

    fn scan(&mut self, elf: &Elf, start: u32, end: u32) {
        let mut uppers: BTreeMap<u8, u32> = BTreeMap::new();
        let section = elf
            .sections
            .iter()
            .find(|section| start.wrapping_sub(section.address) < section.size);
        let holds_pointers = !section.is_some_and(|section| START_UP.contains(&section.name.as_str()));
        let mut function = self.functions.remove(&start).unwrap_or_default();
        for address in (start..end).step_by(4) {
            let Some(word) = elf.word(address) else { break };
            match effect(word, address) {
                // A call into the middle of itself is a subroutine of hand-written code, with the frame that it is part of.
                Effect::Call(place) if place == start || !(start..end).contains(&place) => {
                    function.calls.insert(place);
                }
                Effect::Jump(place) if !(start..end).contains(&place) => {
                    function.calls.insert(place);
                }
                Effect::Indirect => function.indirect = true,
                Effect::Grow(bytes) => function.frame = function.frame.saturating_add(bytes),
                Effect::GrowUnknown => function.unknown_frame = true,
                Effect::Upper { register, value } => {
                    uppers.insert(register, value);
                }
                Effect::Lower {
                    register,
                    base,
                    offset,
                } => {
                    if let Some(upper) = uppers.get(&base).copied() {
                        let address = upper.wrapping_add_signed(i32::from(offset));
                        if holds_pointers {
                            self.pointed_at.insert(address);
                        }
                        uppers.insert(register, address);
                    }
                }
                Effect::Call(_) | Effect::Jump(_) | Effect::None => {}
            }
        }
        self.functions.insert(start, function);
    }

    /// First address of the function that holds an address.
    fn home(&self, address: u32) -> Option<u32> {
        self.functions
            .range(..=address)
            .next_back()
            .map(|(start, _)| *start)
    }

    /// The function at this address.
    pub(super) fn function(&self, start: u32) -> Option<&Function> {
        self.functions.get(&start)
    }

    /// First addresses of what a function calls or jumps to, through pointers as well.
    pub(super) fn calls(&self, start: u32) -> BTreeSet<u32> {
        let Some(function) = self.functions.get(&start) else {
            return BTreeSet::new();
        };
        let mut next: BTreeSet<u32> = function
            .calls
            .iter()
            .filter_map(|place| self.home(*place))
            .collect();
        if function.indirect {
            next.extend(&self.pointed_at);
        }
        next
    }

    /// All functions that can be reached from some.
    pub(super) fn reach(&self, from: &[u32]) -> BTreeSet<u32> {
        let mut seen: BTreeSet<u32> = BTreeSet::new();
        let mut open: Vec<u32> = from.to_vec();
        while let Some(start) = open.pop() {
            if seen.insert(start) {
                open.extend(self.calls(start));
            }
        }
        seen
    }

    /// The deepest stack below a function, itself included.
    pub(super) fn depth(&self, from: u32) -> Depth {
        let mut descent = Descent {
            graph: self,
            way: Vec::new(),
            known: BTreeMap::new(),
            recursive: BTreeSet::new(),
        };
        let bytes = descent.below(from);
        let mut chain = Vec::new();
        let mut at = Some(from);
        while let Some(start) = at {
            chain.push(self.name(start));
            at = descent.known.get(&start).and_then(|(_, deepest)| *deepest);
        }
        Depth {
            bytes,
            chain,
            recursive: descent.recursive,
        }
    }

    /// Name of the function at this address.
    pub(super) fn name(&self, start: u32) -> String {
        self.functions
            .get(&start)
            .map(|function| function.name.clone())
            .unwrap_or_default()
    }

    /// Functions among these whose frame cannot be read from the code.
    pub(super) fn unknown_frames(&self, among: &BTreeSet<u32>) -> Vec<String> {
        let found = among.iter().filter_map(|start| self.functions.get(start));
        found
            .filter(|function| function.unknown_frame)
            .map(|function| function.name.clone())
            .collect()
    }
}

/// A walk down all chains of calls.
struct Descent<'a> {
    graph: &'a Graph,
    way: Vec<u32>,
    /// Depth and deepest callee of the functions that were seen.
    known: BTreeMap<u32, (u32, Option<u32>)>,
    recursive: BTreeSet<String>,
}

impl Descent<'_> {
    /// The deepest stack below a function, itself included.
    fn below(&mut self, start: u32) -> u32 {
        if let Some((bytes, _)) = self.known.get(&start) {
            return *bytes;
        }
        self.way.push(start);
        let mut deepest = (0, None);
        for next in self.graph.calls(start) {
            if self.way.contains(&next) {
                self.recursive.insert(self.graph.name(next));
                continue;
            }
            let bytes = self.below(next);
            if bytes > deepest.0 || deepest.1.is_none() {
                deepest = (bytes, Some(next));
            }
        }
        self.way.pop();
        let own = self.graph.function(start).map_or(0, |function| function.frame);
        let bytes = own.saturating_add(deepest.0);
        self.known.insert(start, (bytes, deepest.1));
        bytes
    }
}

/// First and last address and name of each function. One without a size ends where the next begins.
fn extents(symbols: &[Symbol], code: &[&Section]) -> Vec<(u32, u32, String)> {
    let mut starts: BTreeMap<u32, (u32, String)> = BTreeMap::new();
    let mut code_symbols: Vec<&Symbol> = symbols.iter().filter(|symbol| symbol.code).collect();
    // Of several names of a place the last one stays: a function's own, with its size.
    code_symbols.sort_by_key(|symbol| (symbol.address, symbol.function, symbol.size));
    for symbol in code_symbols {
        starts.insert(symbol.address, (symbol.size, symbol.name.clone()));
    }
    let mut found = Vec::new();
    for (start, (size, name)) in &starts {
        let section = code
            .iter()
            .find(|section| start.wrapping_sub(section.address) < section.size);
        let Some(section) = section else { continue };
        let section_end = section.address.saturating_add(section.size);
        let next = starts
            .range(start + 1..)
            .next()
            .map_or(section_end, |(next, _)| *next);
        let end = if *size > 0 {
            start.saturating_add(*size)
        } else {
            next.min(section_end)
        };
        found.push((*start, end, name.clone()));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::Graph;
    use crate::firmware::sample::{BASE, linked};

    fn program(functions: &[(&str, &[u32])], constants: &[u32]) -> Graph {
        Graph::of(&linked(&[(".text", functions)], constants))
    }

    const fn call(word_index: u32) -> u32 {
        0x0C00_0000 | (((BASE & 0x0FFF_FFFF) >> 2) + word_index)
    }

    const fn grow(bytes: u32) -> u32 {
        0x27BD_0000 | (0x1_0000 - bytes)
    }

    const INDIRECT: u32 = 0x0320_F809;

    #[test]
    fn depth_follows_the_deepest_calls() {
        let graph = program(
            &[
                ("main", &[grow(8), call(4), 0, call(6)]),
                ("shallow", &[grow(16), 0]),
                ("deep", &[grow(24), call(8)]),
                ("leaf", &[grow(40), 0]),
                ("apart", &[grow(999), 0]),
            ],
            &[],
        );
        let depth = graph.depth(BASE);
        assert_eq!(depth.bytes, 8 + 24 + 40);
        assert_eq!(depth.chain, ["main", "deep", "leaf"]);
        assert!(depth.recursive.is_empty());
        let reached = graph.reach(&[BASE]);
        assert!(reached.len() == 4 && reached.iter().all(|start| graph.functions[start].name != "apart"));
    }

    #[test]
    fn a_call_through_a_pointer_reaches_all_whose_address_is_held() {
        // The second is held in a constant, the third by a pair of instructions, the fourth by nobody.
        let functions: [(&str, &[u32]); 4] = [
            ("main", &[0x3C02_9D00, 0x2442_0018, INDIRECT, 0]),
            ("in-a-table", &[grow(16), 0]),
            ("by-a-pair", &[grow(32), 0]),
            ("by-nobody", &[grow(64), 0]),
        ];
        let graph = program(&functions, &[7, BASE + 16]);
        assert_eq!(graph.reach(&[BASE]).len(), 3);
        assert_eq!(graph.depth(BASE).bytes, 32);
    }

    #[test]
    fn recursion_is_named() {
        let graph = program(&[("main", &[call(2), 0]), ("again", &[grow(8), call(2)])], &[]);
        assert!(graph.depth(BASE).recursive.contains("again"));
        let with_subroutine = program(&[("main", &[grow(8), call(3), 0, grow(16)])], &[]);
        let depth = with_subroutine.depth(BASE);
        assert!(depth.recursive.is_empty() && depth.bytes == 24);
    }
}
