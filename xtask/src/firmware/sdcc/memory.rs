//! Bytes of code and variables, from the linker's words and from the image.

use super::build::Built;
use anyhow::{Context, bail};

/// What is kept over a reset lies apart, at the end of the memory, and the linker does not count it.
const KEPT_BYTES: u32 = 9;

/// Bytes in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MemoryUse {
    /// Code and constants.
    pub(super) code: u32,
    /// External memory on the chip.
    pub(super) xdata: u32,
    /// Internal memory below the stack: registers and variables.
    pub(super) idata: u32,
}

impl MemoryUse {
    pub(super) fn read(built: &Built) -> anyhow::Result<Self> {
        let memory = built.memory()?;
        Ok(Self {
            code: bytes_of(&built.program()?)?,
            xdata: used(&memory, "EXTERNAL RAM").context("no line for external memory")? + KEPT_BYTES,
            idata: stack_start(&memory).context("no line for the stack")?,
        })
    }
}

/// The fourth column of the linker's table.
fn used(memory: &str, name: &str) -> Option<u32> {
    let line = memory.lines().find(|line| line.trim_start().starts_with(name))?;
    line.split_whitespace().nth_back(1)?.parse().ok()
}

fn stack_start(memory: &str) -> Option<u32> {
    let line = memory
        .lines()
        .find_map(|line| line.strip_prefix("Stack starts at: 0x"))?;
    u32::from_str_radix(line.get(..2)?, 16).ok()
}

/// Bytes of data in Intel HEX.
fn bytes_of(hex: &str) -> anyhow::Result<u32> {
    let mut total = 0;
    for line in hex.lines() {
        let count = line
            .get(1..3)
            .and_then(|digits| u32::from_str_radix(digits, 16).ok());
        match (count, line.get(7..9)) {
            (Some(count), Some("00")) => total += count,
            (Some(_), Some(_)) => {}
            _ => bail!("no Intel HEX: {line}"),
        }
    }
    Ok(total)
}

#[cfg(test)]
mod tests {
    use super::{bytes_of, stack_start, used};

    #[test]
    fn the_linkers_words_are_read() {
        let memory = "Stack starts at: 0x72 (sp set to 0x71) with 142 bytes available.\n\
                      \u{20}  EXTERNAL RAM     0x0001   0x02b1     689     1024   \n";
        assert_eq!(used(memory, "EXTERNAL RAM"), Some(689));
        assert_eq!(stack_start(memory), Some(0x72));
        assert_eq!(
            bytes_of(":080000007590EF75A07D80FEF4\n:00000001FF\n").ok(),
            Some(8)
        );
        assert!(bytes_of("x").is_err());
    }
}
