//! The interrupt controller: flags, enables, priorities, and the request that the core sees.
//!
//! A *line* is a level-type source: as long as it is asserted its flag cannot be cleared.

use crate::cpu::InterruptRequest;

/// An interrupt source by its IRQ number, which is also its bit in IFS and IEC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Irq(u8);

impl Irq {
    pub(crate) const CORE_TIMER: Irq = Irq(0);
    pub(crate) const CHANGE_NOTICE: Irq = Irq(32);
    pub(crate) const ANALOG: Irq = Irq(33);
    pub(crate) const CLOCK_MONITOR: Irq = Irq(46);
    pub(crate) const CALENDAR: Irq = Irq(47);
    pub(crate) const PARALLEL_PORT: Irq = Irq(34);
    pub(crate) const FLASH: Irq = Irq(56);

    /// DMA channel 0 to 3.
    pub(crate) const fn dma(number: u8) -> Irq {
        Irq(48 + number)
    }

    /// Core software interrupt 0 or 1.
    pub(crate) const fn software(number: u8) -> Irq {
        Irq(1 + number)
    }

    /// External interrupt 0 to 4.
    pub(crate) const fn external(number: u8) -> Irq {
        Irq(3 + 4 * number)
    }

    /// Timer 1 to 5 (0 to 4).
    pub(crate) const fn timer(number: u8) -> Irq {
        Irq(4 + 4 * number)
    }

    /// Input capture 1 to 5 (0 to 4).
    pub(crate) const fn capture(number: u8) -> Irq {
        Irq(5 + 4 * number)
    }

    /// Output compare 1 to 5 (0 to 4).
    pub(crate) const fn compare(number: u8) -> Irq {
        Irq(6 + 4 * number)
    }

    /// Errors of UART 1 or 2 (0 or 1).
    pub(crate) const fn serial_error(number: u8) -> Irq {
        Irq(26 + 14 * number)
    }

    /// Reception of UART 1 or 2 (0 or 1).
    pub(crate) const fn serial_receive(number: u8) -> Irq {
        Irq(27 + 14 * number)
    }

    /// Transmission of UART 1 or 2 (0 or 1).
    pub(crate) const fn serial_transmit(number: u8) -> Irq {
        Irq(28 + 14 * number)
    }

    /// Comparator 1 or 2 (0 or 1).
    pub(crate) const fn comparator(number: u8) -> Irq {
        Irq(35 + number)
    }

    /// Overrun of SPI 1 or 2 (0 or 1).
    pub(crate) const fn spi_fault(number: u8) -> Irq {
        Irq(23 + 14 * number)
    }

    /// Room for a word in SPI 1 or 2 (0 or 1).
    pub(crate) const fn spi_transmit(number: u8) -> Irq {
        Irq(24 + 14 * number)
    }

    /// A word from SPI 1 or 2 (0 or 1).
    pub(crate) const fn spi_receive(number: u8) -> Irq {
        Irq(25 + 14 * number)
    }

    /// Bus collision of I2C 1 or 2 (0 or 1).
    pub(crate) const fn i2c_collision(number: u8) -> Irq {
        Irq(29 + 14 * number)
    }

    /// A byte for or from the slave of I2C 1 or 2 (0 or 1).
    pub(crate) const fn i2c_slave(number: u8) -> Irq {
        Irq(30 + 14 * number)
    }

    /// The end of a step of the master of I2C 1 or 2 (0 or 1).
    pub(crate) const fn i2c_master(number: u8) -> Irq {
        Irq(31 + 14 * number)
    }

    const fn mask(self) -> u64 {
        1 << self.0
    }
}

/// IRQs of this part: 0 to 51 and 56.
const PRESENT: u64 = ((1 << 52) - 1) | (1 << 56);
/// Vectors 40 to 43 do not exist, nor does IPC10.
pub(crate) const VECTORS: usize = 45;

/// Vector of an IRQ, from the table of the MX3xx/4xx parts.
const fn vector_of(irq: u8) -> u8 {
    match irq {
        0..=22 => irq,
        23..=25 => 23,
        26..=28 => 24,
        29..=31 => 25,
        32..=36 => irq - 6,
        37..=39 => 31,
        40..=42 => 32,
        43..=45 => 33,
        46..=51 => irq - 12,
        _ => 44,
    }
}

/// IRQs of each vector.
const SOURCES: [u64; VECTORS] = {
    let mut sources = [0; VECTORS];
    let mut irq = 0;
    while irq < 64 {
        if PRESENT >> irq & 1 != 0 {
            sources[vector_of(irq) as usize] |= 1 << irq;
        }
        irq += 1;
    }
    sources
};

const INTCON_WRITABLE: u32 = 0x0001_571F;
const MULTI_VECTOR: u32 = 1 << 12;
const SHADOW_FOR_SINGLE: u32 = 1 << 16;
/// Priority and sub-priority of four vectors.
const PRIORITY_WRITABLE: u32 = 0x1F1F_1F1F;

/// The registers and what follows from them.
#[derive(Clone, Debug)]
pub(crate) struct Interrupts {
    control: u32,
    flags: u64,
    enables: u64,
    lines: u64,
    priorities: [u32; 12],
    at_level: [u64; 8],
    at_sub_level: [u64; 4],
    raised_at: [u64; 64],
    /// When each line was asserted or released last.
    asserted_at: [u64; 64],
    proximity: u32,
    best: Option<Pending>,
    /// The sources that DMA listens to, and those of them that were raised.
    listening: u64,
    heard: u64,
    /// Whether a line that rises counts as raised.
    pulses_lines: bool,
}

/// The request that wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Pending {
    level: u8,
    vector: u8,
}

impl Interrupts {
    pub(crate) fn new() -> Interrupts {
        let mut new = Interrupts {
            control: 0,
            flags: 0,
            enables: 0,
            lines: 0,
            priorities: [0; 12],
            at_level: [0; 8],
            at_sub_level: [0; 4],
            raised_at: [0; 64],
            asserted_at: [0; 64],
            proximity: 0,
            best: None,
            listening: 0,
            heard: 0,
            pulses_lines: false,
        };
        new.sort_by_priority();
        new
    }

    /// As after a reset.
    pub(crate) fn reset(&self) -> Interrupts {
        Interrupts {
            pulses_lines: self.pulses_lines,
            ..Interrupts::new()
        }
    }

    /// Sets a flag: something happened.
    pub(crate) fn raise(&mut self, irq: Irq, cycle: u64) {
        self.heard |= irq.mask() & self.listening;
        self.set_flags(self.flags | irq.mask(), cycle);
    }

    /// DMA listens to these sources from now on.
    pub(crate) fn listen(&mut self, sources: u64) {
        self.listening = sources;
        self.heard &= sources;
    }

    /// Whether DMA listens to anything.
    pub(crate) fn has_listener(&self) -> bool {
        self.listening != 0
    }

    /// What was raised since the last call, of what DMA listens to.
    pub(crate) fn take_heard(&mut self) -> u64 {
        std::mem::take(&mut self.heard)
    }

    /// The lines that are asserted.
    pub(crate) fn lines(&self) -> u64 {
        self.lines
    }

    /// Whether DMA takes a line that rises for a request.
    pub(crate) fn pulse_lines(&mut self, wanted: bool) {
        self.pulses_lines = wanted;
    }

    /// Something happened behind a line, whether or not it was asserted before.
    pub(crate) fn note_event(&mut self, irq: Irq) {
        if self.pulses_lines {
            self.heard |= irq.mask() & self.listening;
        }
    }

    /// Asserts or releases the line of a level-type source.
    pub(crate) fn set_line(&mut self, irq: Irq, asserted: bool, cycle: u64) {
        let lines = if asserted {
            self.lines | irq.mask()
        } else {
            self.lines & !irq.mask()
        };
        if lines != self.lines {
            self.lines = lines;
            if asserted {
                self.note_event(irq);
            }
            self.asserted_at[irq.0 as usize] = cycle;
            self.set_flags(self.flags, cycle);
        }
    }

    fn set_flags(&mut self, flags: u64, cycle: u64) {
        let after = (flags | self.lines) & PRESENT;
        let new = after & !self.flags;
        // Cleared, but asserted again while the flag was still set: that is what the next handler is late for.
        let held = self.flags & !flags & self.lines;
        self.flags = after;
        for irq in numbers(new) {
            self.raised_at[irq] = cycle;
        }
        for irq in numbers(held) {
            self.raised_at[irq] = self.asserted_at[irq];
        }
        self.choose();
    }

    /// A source that was off is late from now on only, however old its flag is.
    fn set_enables(&mut self, enables: u64, cycle: u64) {
        for irq in numbers(enables & !self.enables & self.flags) {
            self.raised_at[irq] = cycle;
        }
        self.enables = enables & PRESENT;
    }

    fn choose(&mut self) {
        let pending = self.flags & self.enables;
        if pending == 0 {
            self.best = None;
            return;
        }
        let level = (1..8u8)
            .rev()
            .find(|&level| pending & self.at_level[usize::from(level)] != 0);
        self.best = level.map(|level| {
            let there = pending & self.at_level[usize::from(level)];
            let first = self
                .at_sub_level
                .iter()
                .rev()
                .map(|mask| there & mask)
                .find(|&mask| mask != 0);
            // The natural order decides last: the lower IRQ first.
            let irq = first.unwrap_or(there).trailing_zeros();
            Pending {
                level,
                vector: vector_of(u8::try_from(irq).unwrap_or(0)),
            }
        });
    }

    fn sort_by_priority(&mut self) {
        self.at_level = [0; 8];
        self.at_sub_level = [0; 4];
        for irq in (0..64).filter(|irq| PRESENT & (1 << irq) != 0) {
            let vector = vector_of(irq);
            let field = self.priorities[usize::from(vector / 4)] >> (8 * (vector % 4));
            self.at_level[(field >> 2 & 7) as usize] |= 1 << irq;
            self.at_sub_level[(field & 3) as usize] |= 1 << irq;
        }
    }

    /// What the core is to be shown.
    pub(crate) fn request(&self) -> Option<InterruptRequest> {
        self.best.map(|Pending { level, vector }| {
            let many = self.control & MULTI_VECTOR != 0;
            // Level 7 has the shadow set on this family; with a single vector INTCON.SS0 decides.
            let shadow = if many {
                level == 7
            } else {
                self.control & SHADOW_FOR_SINGLE != 0
            };
            InterruptRequest {
                level,
                vector: if many { vector } else { 0 },
                shadow_set: u8::from(shadow),
            }
        })
    }

    /// The vector of what is requested, also while all sources share one.
    pub(crate) fn requested_vector(&self) -> Option<u8> {
        self.best.map(|best| best.vector)
    }

    /// Whether somebody wants to know when this source is raised: the core, or DMA.
    pub(crate) fn is_wanted(&self, irq: Irq) -> bool {
        (self.enables | self.listening) & irq.mask() != 0
    }

    /// Whether the external interrupt 0 to 4 triggers on rising edges.
    pub(crate) fn is_rising(&self, external: u8) -> bool {
        self.control >> external & 1 != 0
    }

    /// When the oldest pending and enabled source of this vector raised its flag.
    pub(crate) fn raised_at(&self, vector: u8) -> Option<u64> {
        let sources = SOURCES.get(usize::from(vector)).copied().unwrap_or(0);
        numbers(self.flags & self.enables & sources)
            .map(|irq| self.raised_at[irq])
            .min()
    }

    /// Reads the register `word` of the block (its address / 16).
    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control,
            1 => self
                .best
                .map_or(0, |best| u32::from(best.vector) | u32::from(best.level) << 8),
            2 => self.proximity,
            3 => low_half(self.flags),
            4 => high_half(self.flags),
            6 => low_half(self.enables),
            7 => high_half(self.enables),
            9..=18 | 20 => self.priorities[usize::from(word - 9)],
            _ => return None,
        })
    }

    /// Writes the register `word` of the block; `false` when there is none.
    pub(crate) fn write(&mut self, word: u8, value: u32, cycle: u64) -> bool {
        match word {
            0 => self.control = value & INTCON_WRITABLE,
            1 => {}
            2 => self.proximity = value,
            3 => self.set_flags(with_low_half(self.flags, value), cycle),
            4 => self.set_flags(with_high_half(self.flags, value), cycle),
            6 => self.set_enables(with_low_half(self.enables, value), cycle),
            7 => self.set_enables(with_high_half(self.enables, value), cycle),
            9..=18 | 20 => {
                self.priorities[usize::from(word - 9)] = value & PRIORITY_WRITABLE;
                self.sort_by_priority();
            }
            _ => return false,
        }
        self.choose();
        true
    }
}

/// The numbers of the set bits, ascending.
fn numbers(mask: u64) -> impl Iterator<Item = usize> {
    let mut rest = mask;
    std::iter::from_fn(move || {
        let number = rest.trailing_zeros() as usize;
        (rest != 0).then(|| {
            rest &= rest - 1;
            number
        })
    })
}

#[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
const fn low_half(mask: u64) -> u32 {
    mask as u32
}

const fn high_half(mask: u64) -> u32 {
    low_half(mask >> 32)
}

const fn with_low_half(mask: u64, half: u32) -> u64 {
    mask & !0xFFFF_FFFF | half as u64
}

const fn with_high_half(mask: u64, half: u32) -> u64 {
    mask & 0xFFFF_FFFF | (half as u64) << 32
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTCON: u8 = 0;
    const IFS0: u8 = 3;
    const IFS1: u8 = 4;
    const IEC0: u8 = 6;
    const IEC1: u8 = 7;
    const IPC0: u8 = 9;

    fn request(interrupts: &Interrupts) -> Option<(u8, u8)> {
        interrupts
            .request()
            .map(|request| (request.level, request.vector))
    }

    fn all_enabled() -> Interrupts {
        let mut interrupts = Interrupts::new();
        interrupts.write(INTCON, MULTI_VECTOR, 0);
        interrupts.write(IEC0, u32::MAX, 0);
        interrupts.write(IEC1, u32::MAX, 0);
        interrupts
    }

    #[test]
    fn vectors_are_those_of_the_reference() {
        let of = |irq| vector_of(irq);
        let table = [
            (22, 22),
            (24, 23),
            (28, 24),
            (31, 25),
            (32, 26),
            (33, 27),
            (36, 30),
            (39, 31),
            (40, 32),
        ];
        let more = [(45, 33), (46, 34), (47, 35), (48, 36), (51, 39), (56, 44)];
        for (irq, vector) in table.into_iter().chain(more) {
            assert_eq!(of(irq), vector, "IRQ {irq}");
        }
        assert_eq!(Irq::serial_error(1), Irq(40));
        assert_eq!(Irq::compare(4), Irq(22));
        assert_eq!(Irq::external(4), Irq(19));
    }

    #[test]
    fn priority_then_sub_priority_then_the_lower_number() {
        let mut interrupts = all_enabled();
        interrupts.raise(Irq::timer(0), 5);
        interrupts.raise(Irq::CHANGE_NOTICE, 6);
        assert_eq!(request(&interrupts), None, "priority 0 is off");
        interrupts.write(IPC0 + 1, 0x0000_000C, 7); // vector 4: priority 3, sub-priority 0
        interrupts.write(IPC0 + 6, 0x000D_0000, 7); // vector 26: priority 3, sub-priority 1
        assert_eq!(request(&interrupts), Some((3, 26)));
        interrupts.write(IPC0 + 6, 0x000C_0000, 8);
        assert_eq!(request(&interrupts), Some((3, 4)));
        interrupts.write(IPC0 + 6, 0x0018_0000, 9);
        assert_eq!(request(&interrupts), Some((6, 26)));
        assert_eq!(
            (interrupts.raised_at(26), interrupts.raised_at(4)),
            (Some(6), Some(5))
        );
        assert_eq!(interrupts.read(1), Some(26 | 6 << 8));
    }

    #[test]
    fn a_line_holds_its_flag() {
        let mut interrupts = all_enabled();
        interrupts.set_line(Irq::CHANGE_NOTICE, true, 1);
        interrupts.write(IFS1, 0, 2);
        assert_eq!(interrupts.read(IFS1), Some(1));
        interrupts.set_line(Irq::CHANGE_NOTICE, false, 3);
        assert_eq!(interrupts.read(IFS1), Some(1));
        interrupts.write(IFS1, 0, 4);
        assert_eq!(interrupts.read(IFS1), Some(0));
    }

    #[test]
    fn lateness_counts_from_the_newest_cause() {
        let mut interrupts = all_enabled();
        interrupts.write(IPC0 + 6, 6 << 18, 0);
        interrupts.set_line(Irq::CHANGE_NOTICE, true, 100);
        // The handler reads the port, then the pin changes again, then the handler clears the flag.
        interrupts.set_line(Irq::CHANGE_NOTICE, false, 110);
        interrupts.set_line(Irq::CHANGE_NOTICE, true, 115);
        assert_eq!(interrupts.raised_at(26), Some(100));
        interrupts.write(IFS1, 0, 120);
        assert_eq!(interrupts.raised_at(26), Some(115));
        // A flag that was old when its source was switched on.
        interrupts.raise(Irq::timer(1), 200);
        interrupts.write(IEC0, 0, 300);
        interrupts.write(IEC0, 1 << 8, 400);
        assert_eq!(interrupts.raised_at(8), Some(400));
    }

    #[test]
    fn level_7_and_the_single_vector() {
        let mut interrupts = all_enabled();
        interrupts.write(IPC0 + 1, 7 << 2, 0);
        interrupts.write(IFS0, 1 << 4, 0);
        let seven = InterruptRequest {
            level: 7,
            vector: 4,
            shadow_set: 1,
        };
        assert_eq!(interrupts.request(), Some(seven));
        interrupts.write(INTCON, 0, 0);
        assert_eq!(
            interrupts.request(),
            Some(InterruptRequest {
                vector: 0,
                shadow_set: 0,
                ..seven
            })
        );
        interrupts.write(INTCON, SHADOW_FOR_SINGLE, 0);
        assert_eq!(
            interrupts.request(),
            Some(InterruptRequest {
                vector: 0,
                shadow_set: 1,
                ..seven
            })
        );
    }

    #[test]
    fn what_the_part_lacks_stays_zero() {
        let mut interrupts = all_enabled();
        interrupts.write(IFS1, u32::MAX, 0);
        assert_eq!(interrupts.read(IFS1), Some(0x010F_FFFF));
        assert_eq!(interrupts.read(IPC0 + 10), None, "IPC10");
    }
}
