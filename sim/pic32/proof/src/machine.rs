//! A small interpreter: jump tables, indirect calls, recursion.

use crate::{Numbers, mix};

type Handler = fn(u32, u32) -> u32;

const HANDLERS: [Handler; 4] = [
    |left, right| left.wrapping_sub(right),
    |left, right| left ^ right >> 3,
    |left, right| left.wrapping_mul(right | 1),
    |left, right| left.max(right),
];

/// Runs a random program, then walks a tree of calls.
pub(crate) fn interpret(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut stack = [seed; 8];
    for _ in 0..300 {
        let code = numbers.next();
        let place = (code >> 8) as usize % stack.len();
        let other = stack[(code >> 16) as usize % stack.len()];
        stack[place] = match code % 13 {
            0 => stack[place].wrapping_add(other),
            1 => stack[place].rotate_left(other),
            2 => stack[place] / (other | 1),
            3 => stack[place].reverse_bits(),
            4 => stack[place].swap_bytes(),
            5 => u32::from((stack[place] as i32) < other as i32),
            6 => stack[place].leading_zeros(),
            7 => stack[place] & !other,
            8 => code,
            kind => HANDLERS[kind as usize % HANDLERS.len()](stack[place], other),
        };
    }
    stack
        .iter()
        .fold(walk(9, seed), |result, word| mix(result, *word))
}

#[inline(never)]
fn walk(depth: u32, value: u32) -> u32 {
    match depth {
        0 => value,
        _ => {
            let left = walk(depth - 1, mix(value, depth));
            let right = if left & 1 == 0 {
                walk(depth / 2, left)
            } else {
                left
            };
            mix(left, right)
        }
    }
}
