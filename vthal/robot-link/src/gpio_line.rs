//! A line of a GPIO chip, as one word names it.

use std::path::{Path, PathBuf};

/// A line of a GPIO chip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GpioLine {
    /// The chip, such as `/dev/gpiochip0`.
    pub chip: PathBuf,
    /// The line.
    pub line: u32,
}

impl GpioLine {
    /// `gpiochip0:24`: a chip by its path or its name in `/dev`, and the number of a line.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let (chip, line) = text.rsplit_once(':')?;
        let chip = match chip {
            "" => return None,
            path if path.starts_with('/') => PathBuf::from(path),
            name => Path::new("/dev").join(name),
        };
        let line = line.parse().ok()?;
        Some(Self { chip, line })
    }
}
