//! Words as registers hold them.

/// A word that a data register takes and gives: `u8`, `u16` or `u32`.
#[doc(hidden)]
pub trait RegisterWord: sealed::Sealed + Copy + Default + 'static {
    /// As the register has it.
    fn to_register(self) -> u32;
    /// From what the register has.
    fn from_register(value: u32) -> Self;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! words {
    ($($word:ty)*) => {
        $(impl sealed::Sealed for $word {}
        impl RegisterWord for $word {
            fn to_register(self) -> u32 {
                u32::from(self)
            }
            fn from_register(value: u32) -> Self {
                value as Self
            }
        })*
    };
}

words! { u8 u16 u32 }
