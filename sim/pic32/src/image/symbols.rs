//! The names that an ELF gives to addresses.

/// What a symbol names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SymbolKind {
    /// Instructions.
    Function,
    /// A variable or table.
    Object,
    /// An address without a kind, as linker scripts define them.
    Plain,
}

/// A function, a variable or a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// As the file spells it; compilers of Rust add to the names of the source.
    pub name: String,
    /// Virtual address.
    pub address: u32,
    /// Bytes, 0 when the file does not say.
    pub size: u32,
    /// What it names.
    pub kind: SymbolKind,
}
