//! Where the chip's time goes, by function: the program counter at random moments.

use std::collections::BTreeMap;

use pic32::board::CYCLES_PER_MS;
use pic32::image::{Image, Symbol, SymbolKind};
use pic32::machine::{Grounded, Machine};

/// Functions that are shown.
const SHOWN: usize = 40;

/// Name of the function that an instruction belongs to. Hand-written code has no length in the table: it goes up to the next
/// name.
fn home_of(address: u32, image: &Image) -> &str {
    let before = |symbol: &&Symbol| symbol.kind != SymbolKind::Object && symbol.address <= address;
    let symbols = image.symbols().iter().filter(before);
    let nearest = symbols.max_by_key(|symbol| (symbol.address, symbol.kind == SymbolKind::Function));
    nearest.map_or("?", |symbol| symbol.name.as_str())
}

/// Number of samples in each function.
#[derive(Debug, Default)]
pub(crate) struct Profile {
    samples: u32,
    asleep: u32,
    functions: BTreeMap<String, u32>,
    random: u64,
}

impl Profile {
    /// Samples where a copy of the chip is at a random moment of the next millisecond. The copy's surroundings are frozen for
    /// that long: no edge and no voltage changes, so what they would cause within the millisecond is not seen.
    pub(crate) fn sample(&mut self, machine: &Machine, image: &Image) {
        // A linear congruential generator, Knuth's constants: the moment must only not keep step with the program.
        self.random = self
            .random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let later = (self.random >> 33) % CYCLES_PER_MS;
        let mut copy = machine.clone();
        copy.run_until(machine.cycle() + later, &mut Grounded);
        self.samples += 1;
        if copy.cpu().is_waiting() {
            self.asleep += 1;
            return;
        }
        *self
            .functions
            .entry(home_of(copy.cpu().pc(), image).to_owned())
            .or_default() += 1;
    }

    /// The functions with the largest shares of the time, one a line.
    pub(crate) fn text(&self) -> String {
        let mut functions: Vec<(&String, &u32)> = self.functions.iter().collect();
        functions.sort_by(|left, right| right.1.cmp(left.1).then(left.0.cmp(right.0)));
        let share = |count: u32| f64::from(count) * 100.0 / f64::from(self.samples.max(1));
        let mut text = format!(
            "{:6.2} % asleep, of {} samples\n",
            share(self.asleep),
            self.samples
        );
        for (name, count) in functions.into_iter().take(SHOWN) {
            text.push_str(&format!("{:6.2} % {name}\n", share(*count)));
        }
        text
    }
}
