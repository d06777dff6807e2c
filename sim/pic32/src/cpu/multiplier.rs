//! The multiply and divide unit: HI, LO, and the time that results take.

use super::operation::Multiply;

/// HI in the upper half, LO in the lower.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Multiplier {
    value: u64,
    /// Cycle from which HI and LO can be read and the next operation can begin.
    ready: u64,
}

// Cycles until the result is there, general knowledge of the M4K's fast unit, not confirmed by a source: one or two for a
// multiplication by the width of the second factor; a division needs one cycle for each bit of the dividend's used bytes,
// and some more. `mul` holds the pipeline for as long as its result takes.
const LATENCY_SHORT: u64 = 1;
const LATENCY_LONG: u64 = 2;
const DIVIDE_LATENCY: [u64; 4] = [12, 19, 26, 33];

impl Multiplier {
    pub(crate) const fn value(&self) -> u64 {
        self.value
    }

    pub(crate) fn set_value(&mut self, value: u64) {
        self.value = value;
    }

    #[inline(always)]
    pub(crate) const fn high(&self) -> u32 {
        (self.value >> 32) as u32
    }

    #[inline(always)]
    pub(crate) const fn low(&self) -> u32 {
        self.value as u32
    }

    /// Cycles that an instruction which would end at `end` has to wait for the unit.
    #[inline(always)]
    pub(crate) const fn wait(&self, end: u64) -> u64 {
        self.ready.saturating_sub(end)
    }

    #[inline(always)]
    pub(crate) fn set_high(&mut self, value: u32) {
        self.value = u64::from(value) << 32 | self.value & 0xFFFF_FFFF;
    }

    #[inline(always)]
    pub(crate) fn set_low(&mut self, value: u32) {
        self.value = self.value >> 32 << 32 | u64::from(value);
    }

    /// Does a multiplication that ends at `end` when the unit is free; gives the cycles for which it has to wait.
    #[inline(always)]
    pub(crate) fn multiply(&mut self, kind: Multiply, (left, right): (u32, u32), end: u64) -> u64 {
        let signed = || (widened(left) * widened(right)).cast_unsigned();
        let unsigned = || u64::from(left) * u64::from(right);
        self.value = match kind {
            Multiply::Mult => signed(),
            Multiply::Multu => unsigned(),
            Multiply::Madd => self.value.wrapping_add(signed()),
            Multiply::Maddu => self.value.wrapping_add(unsigned()),
            Multiply::Msub => self.value.wrapping_sub(signed()),
            Multiply::Msubu => self.value.wrapping_sub(unsigned()),
        };
        self.begin(end, latency(right))
    }

    /// Divides signed numbers. What a division by zero leaves is not defined by the architecture; here it is as if one had
    /// divided by one, and the compiler traps before.
    pub(crate) fn divide(&mut self, (left, right): (u32, u32), end: u64) -> u64 {
        let (dividend, divisor) = (left.cast_signed(), right.cast_signed());
        let divisor = if divisor == 0 { 1 } else { divisor };
        let quotient = dividend.wrapping_div(divisor).cast_unsigned();
        let remainder = dividend.wrapping_rem(divisor).cast_unsigned();
        self.divided(quotient, remainder);
        self.begin(end, divide_latency(dividend.unsigned_abs()))
    }

    /// Divides unsigned numbers, by zero like [`Self::divide`].
    pub(crate) fn divide_unsigned(&mut self, (left, right): (u32, u32), end: u64) -> u64 {
        let divisor = right.max(1);
        self.divided(left / divisor, left % divisor);
        self.begin(end, divide_latency(left))
    }

    fn divided(&mut self, quotient: u32, remainder: u32) {
        self.value = u64::from(remainder) << 32 | u64::from(quotient);
    }

    /// An operation that would end at `end`, whose result takes `latency` cycles; gives the cycles for which it has to wait.
    #[inline(always)]
    fn begin(&mut self, end: u64, latency: u64) -> u64 {
        let wait = self.wait(end);
        self.ready = end + wait + latency;
        wait
    }
}

fn divide_latency(dividend: u32) -> u64 {
    let bytes = (dividend | 1).ilog2() / 8;
    DIVIDE_LATENCY[bytes as usize % DIVIDE_LATENCY.len()]
}

/// The product for a general register, and the cycles that `mul` takes beyond its one.
#[inline(always)]
pub(crate) fn product(left: u32, right: u32) -> (u32, u64) {
    (left.wrapping_mul(right), latency(right))
}

fn latency(factor: u32) -> u64 {
    if i32::from(factor as i16) == factor.cast_signed() {
        LATENCY_SHORT
    } else {
        LATENCY_LONG
    }
}

fn widened(value: u32) -> i64 {
    i64::from(value.cast_signed())
}
