//! MIPS32 instructions as far as control flow and stack frames need them.
//!
//! Functions end by `jr $ra`; a tail call through a pointer uses `$t9`; other register jumps are tables of a `match`.

/// What an instruction does to the flow or to the stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effect {
    /// Calls a known place.
    Call(u32),
    /// Jumps to a known place, which may be another function.
    Jump(u32),
    /// Calls or jumps to a function through a pointer.
    Indirect,
    /// Takes so many bytes of stack.
    Grow(u32),
    /// Takes an amount of stack that cannot be read from the code.
    GrowUnknown,
    /// Register = upper half of an address.
    Upper { register: u8, value: u32 },
    /// Register = other register plus an offset: the lower half of an address.
    Lower { register: u8, base: u8, offset: i16 },
    /// Nothing of these.
    None,
}

const STACK: u8 = 29;
const RETURN: u8 = 31;
/// `$t9`, which holds the address of a function that is called through a pointer.
const POINTER: u8 = 25;

/// Reads one instruction at `address`.
pub(super) fn effect(word: u32, address: u32) -> Effect {
    let field = |shift: u32| ((word >> shift) & 0x1F) as u8;
    let (source, target, destination) = (field(21), field(16), field(11));
    let offset = word as u16 as i16;
    // Jumps name a place in the 256 MiB around the instruction that follows.
    let place = (address.wrapping_add(4) & 0xF000_0000) | ((word & 0x03FF_FFFF) << 2);
    let branch = address
        .wrapping_add(4)
        .wrapping_add((i32::from(offset) << 2) as u32);
    match word >> 26 {
        0 => match word & 0x3F {
            8 if source == RETURN => Effect::None,
            8 if source == POINTER => Effect::Indirect,
            9 => Effect::Indirect,
            // addu and subu of two registers: only a frame of unknown size is made like this.
            0x21 | 0x23 if destination == STACK && source == STACK => Effect::GrowUnknown,
            _ => Effect::None,
        },
        1 if matches!(target, 0x10 | 0x11) => Effect::Call(branch),
        2 => Effect::Jump(place),
        3 => Effect::Call(place),
        9 if target == STACK && source == STACK => match offset {
            ..0 => Effect::Grow(u32::from(offset.unsigned_abs())),
            _ => Effect::None,
        },
        9 => Effect::Lower {
            register: target,
            base: source,
            offset,
        },
        0xF => Effect::Upper {
            register: target,
            value: word << 16,
        },
        _ => Effect::None,
    }
}

#[cfg(test)]
mod tests {
    use super::{Effect, effect};

    #[test]
    fn instructions_are_told_apart() {
        let at = 0x9D00_1000;
        let table = [
            (0x0F40_0400, Effect::Call(0x9D00_1000)),
            (0x0B40_0404, Effect::Jump(0x9D00_1010)),
            (0x0411_0003, Effect::Call(at + 16)),
            (0x0320_F809, Effect::Indirect),
            (0x0320_0008, Effect::Indirect),
            (0x03E0_0008, Effect::None),
            (0x0040_0008, Effect::None),
            (0x27BD_FFE0, Effect::Grow(32)),
            (0x27BD_0020, Effect::None),
            (0x03A1_E823, Effect::GrowUnknown),
            (
                0x3C02_9D01,
                Effect::Upper {
                    register: 2,
                    value: 0x9D01_0000,
                },
            ),
            (
                0x2442_8000,
                Effect::Lower {
                    register: 2,
                    base: 2,
                    offset: -32_768,
                },
            ),
            (0x0000_0000, Effect::None),
        ];
        for (word, wanted) in table {
            assert_eq!(effect(word, at), wanted, "{word:08x}");
        }
    }
}
