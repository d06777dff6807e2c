//! The worst depth of the stack: how deep each function gets, from the assembler's text, and who calls whom. All interrupts
//! have the same priority, so one of them comes on top of the deepest path of the main program.

use anyhow::{Context, bail};
use std::collections::{BTreeMap, BTreeSet};

/// Routines of SDCC's library have no text here; none of those in use is deeper, its return address not counted.
const LIBRARY_BYTES: u32 = 14;
/// A return address.
const ADDRESS_BYTES: u32 = 2;
/// Where the program begins.
const START: &str = "_main";

/// What a function does to the stack.
#[derive(Debug, Default)]
struct Routine {
    deepest: u32,
    /// Depth at each call.
    calls: BTreeMap<String, u32>,
    is_interrupt: bool,
    module: usize,
}

/// Bytes of stack in the worst case.
pub(super) fn worst(listings: &[String]) -> anyhow::Result<u32> {
    let mut functions = BTreeMap::new();
    for (module, listing) in listings.iter().enumerate() {
        let mut own = BTreeMap::new();
        read(listing, &mut own)?;
        // Routines of one module hide those of the same name in others.
        for function in own.values_mut() {
            function.module = module;
        }
        functions.extend(own.into_iter().map(|(name, function)| ((name, module), function)));
    }
    let functions = Routines(functions);
    let mut path = BTreeSet::new();
    // The start-up code calls main.
    let main = ADDRESS_BYTES + depth((START, 0), &functions, &mut path)?;
    let mut interrupt = 0;
    for ((name, module), function) in &functions.0 {
        // The table of vectors is no handler.
        if function.is_interrupt && !name.starts_with("__") {
            interrupt = interrupt.max(ADDRESS_BYTES + depth((name, *module), &functions, &mut path)?);
        }
    }
    Ok(main + interrupt)
}

/// All functions, by name and module.
struct Routines(BTreeMap<(String, usize), Routine>);

impl Routines {
    /// The function that a module means by a name.
    fn find(&self, name: &str, module: usize) -> Option<&Routine> {
        let own = self.0.get(&(name.to_owned(), module));
        own.or_else(|| {
            self.0
                .iter()
                .find(|((other, _), _)| other == name)
                .map(|(_, function)| function)
        })
    }
}

fn depth(
    (name, module): (&str, usize),
    functions: &Routines,
    path: &mut BTreeSet<(String, usize)>,
) -> anyhow::Result<u32> {
    let Some(function) = functions.find(name, module) else {
        return Ok(LIBRARY_BYTES);
    };
    let place = (name.to_owned(), function.module);
    if !path.insert(place.clone()) {
        bail!("{name} calls itself");
    }
    let mut deepest = function.deepest;
    for (called, at) in &function.calls {
        let below = depth((called, function.module), functions, path)?;
        deepest = deepest.max(at + ADDRESS_BYTES + below);
    }
    path.remove(&place);
    Ok(deepest)
}

/// One function while it is read.
#[derive(Default)]
struct Walk {
    now: u32,
    /// The frame pointer's depth.
    frame: u32,
    /// What is added to the stack pointer in the accumulator.
    added: Option<u32>,
    at_labels: BTreeMap<String, u32>,
}

fn read(listing: &str, functions: &mut BTreeMap<String, Routine>) -> anyhow::Result<()> {
    let mut current: Option<(String, Routine)> = None;
    let mut walk = Walk::default();
    for line in listing.lines() {
        let line = line.split(';').next().unwrap_or_default();
        if let Some(label) = line.strip_suffix(':') {
            if label.starts_with('_') {
                functions.extend(current.take());
                current = Some((label.to_owned(), Routine::default()));
                walk = Walk::default();
            } else if let Some(depth) = walk.at_labels.get(label) {
                walk.now = *depth;
            }
        } else if let Some((name, function)) = &mut current {
            walk.step(line.trim(), function)
                .with_context(|| format!("{name}: {line}"))?;
        }
    }
    functions.extend(current);
    Ok(())
}

impl Walk {
    fn step(&mut self, line: &str, function: &mut Routine) -> anyhow::Result<()> {
        let mut words = line.split_whitespace();
        let operation = words.next().unwrap_or_default();
        let operand: String = words.collect::<Vec<_>>().concat();
        match (operation, operand.as_str()) {
            ("push", _) | ("inc", "sp") => self.now += 1,
            ("pop", _) | ("dec", "sp") => self.now = self.now.checked_sub(1).context("below its frame")?,
            ("mov", "_bp,sp") => self.frame = self.now,
            ("mov", "sp,_bp") => self.now = self.frame,
            ("mov", "a,sp") => self.added = Some(0),
            ("mov", "_bp,a") if self.added == Some(0) => self.frame = self.now,
            ("mov", into) if into.starts_with("a,") => self.added = None,
            ("add", number) if self.added.is_some() && number.starts_with("a,#") => {
                self.added = Some(constant(&number[3..]).context("not a number")?);
            }
            ("mov", "sp,a") => {
                let by = self.added.take().context("where from?")? as u8 as i8;
                self.now = self
                    .now
                    .checked_add_signed(i32::from(by))
                    .context("below its frame")?;
            }
            // A jump to another function is a call whose return is that of this one.
            ("lcall" | "acall" | "ljmp" | "sjmp" | "ajmp", called) if !called.ends_with('$') => {
                let at = function.calls.entry(called.to_owned()).or_default();
                *at = (*at).max(self.now);
            }
            ("reti", _) => function.is_interrupt = true,
            _ => self.note_jump(operation, &operand),
        }
        function.deepest = function.deepest.max(self.now);
        Ok(())
    }

    /// The depth at a jump is that at its label.
    fn note_jump(&mut self, operation: &str, operand: &str) {
        let is_jump = matches!(
            operation,
            "ljmp" | "sjmp" | "ajmp" | "jz" | "jnz" | "jc" | "jnc" | "jb" | "jnb" | "jbc" | "cjne" | "djnz"
        );
        if is_jump && let Some(label) = operand.rsplit(',').next() {
            self.at_labels.entry(label.to_owned()).or_insert(self.now);
        }
    }
}

fn constant(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::worst;

    #[test]
    fn the_deepest_path_and_an_interrupt_add_up() {
        let text = "_main:\n\tlcall\t_deep\n\tret\n_deep:\n\tpush\t_bp\n\tmov\t_bp,sp\n\tmov\ta,sp\n\tadd\ta,#0x04\n\
                    \tmov\tsp,a\n\tlcall\t__mullong\n\tmov\tsp,_bp\n\tpop\t_bp\n\tret\n_tick:\n\tpush\tacc\n\tpop\tacc\n\treti\n";
        // main: 2; deep: 2 + 5; the library: 2 + 14; the interrupt: 2 + 1.
        assert_eq!(worst(&[text.to_owned()]).ok(), Some(2 + 2 + 5 + 2 + 14 + 3));
        assert!(worst(&["_main:\n\tlcall\t_main\n\tret\n".to_owned()]).is_err());
    }
}
