//! As much of a 32-bit little-endian ELF file as a firmware's measurement needs.

use anyhow::{Context, bail};

/// A linked program.
#[derive(Debug, Default)]
pub(crate) struct Elf {
    /// Parts that are loaded: where to (physical) and what; only those with bytes in the file.
    pub(crate) segments: Vec<Segment>,
    /// Sections that take memory.
    pub(crate) sections: Vec<Section>,
    /// Functions and objects, sorted by address.
    pub(crate) symbols: Vec<Symbol>,
}

/// Bytes that are loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Segment {
    /// Physical address.
    pub(crate) physical: u32,
    /// Where the bytes stand in the file; 0 for bytes that do not come from one.
    pub(crate) offset: usize,
    /// The bytes.
    pub(crate) bytes: Vec<u8>,
}

/// A section that takes memory.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    /// Its name.
    pub(crate) name: String,
    /// Virtual address.
    pub(crate) address: u32,
    /// Length in bytes.
    pub(crate) size: u32,
    /// Whether it holds instructions.
    pub(crate) executable: bool,
    /// Its bytes; `None` when it starts as zeros.
    pub(crate) bytes: Option<Vec<u8>>,
}

/// A name in the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Symbol {
    /// Its name, demangled.
    pub(crate) name: String,
    /// Virtual address.
    pub(crate) address: u32,
    /// Length in bytes, 0 when the assembler did not say.
    pub(crate) size: u32,
    /// Whether it is a function, or code without a type.
    pub(crate) code: bool,
    /// Whether it has the type of a function, which other names of the same place do not always have.
    pub(crate) function: bool,
}

/// The physical address behind a virtual one: both windows on it lie above.
pub(super) const fn physical(address: u32) -> u32 {
    address & 0x1FFF_FFFF
}

const MACHINE_MIPS: u16 = 8;
const MACHINE_ARM: u16 = 40;
const KIND_SYMBOLS: u32 = 2;
const KIND_ZEROED: u32 = 8;
const FLAG_ALLOCATED: u32 = 2;
const FLAG_EXECUTABLE: u32 = 4;
const SEGMENT_LOAD: u32 = 1;

impl Elf {
    /// Reads a file; names what is wrong with another one.
    pub(crate) fn read(bytes: &[u8]) -> anyhow::Result<Self> {
        if bytes.get(..4) != Some(b"\x7FELF") {
            bail!("this is no ELF file");
        }
        if bytes.get(4..6) != Some(&[1, 1]) {
            bail!("this ELF file is not of a 32-bit little-endian machine");
        }
        let file = ElfBytes { bytes };
        if ![MACHINE_MIPS, MACHINE_ARM].contains(&file.half(18)?) {
            bail!(
                "this ELF file is for machine {}, neither MIPS nor ARM",
                file.half(18)?
            );
        }
        let headers = file.headers()?;
        let mut elf = Self {
            segments: file.segments()?,
            ..Self::default()
        };
        let names = headers
            .get(usize::from(file.half(50)?))
            .context("the ELF file has no section names")?;
        for header in headers.iter().filter(|header| header.flags & FLAG_ALLOCATED != 0) {
            elf.sections.push(file.section(header, names)?);
        }
        if let Some(table) = headers.iter().find(|header| header.kind == KIND_SYMBOLS) {
            let names = headers
                .get(table.link as usize)
                .context("symbols without names")?;
            elf.symbols = file.symbols(table, names, &headers)?;
        }
        elf.sections.sort_by_key(|section| section.address);
        elf.symbols
            .sort_by(|left, right| (left.address, &left.name).cmp(&(right.address, &right.name)));
        Ok(elf)
    }

    /// Address of a symbol, whichever other names that place has.
    pub(super) fn address_of(&self, name: &str) -> Option<u32> {
        self.symbols
            .iter()
            .find(|symbol| symbol.name == name)
            .map(|symbol| symbol.address)
    }

    /// Word at a virtual address, if the program brings one.
    pub(crate) fn word(&self, address: u32) -> Option<u32> {
        let section = self
            .sections
            .iter()
            .find(|section| address.wrapping_sub(section.address) < section.size)?;
        let at = (address - section.address) as usize;
        let bytes = section.bytes.as_ref()?.get(at..at + 4)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    }
}

struct Header {
    name: u32,
    kind: u32,
    flags: u32,
    address: u32,
    offset: usize,
    size: u32,
    link: u32,
}

struct ElfBytes<'a> {
    bytes: &'a [u8],
}

impl ElfBytes<'_> {
    fn slice(&self, offset: usize, length: usize) -> anyhow::Result<&[u8]> {
        self.bytes
            .get(offset..offset.saturating_add(length))
            .with_context(|| format!("the ELF file is truncated: it has no {length} bytes at {offset}"))
    }

    fn word(&self, offset: usize) -> anyhow::Result<u32> {
        let bytes = self.slice(offset, 4)?;
        Ok(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    fn half(&self, offset: usize) -> anyhow::Result<u16> {
        let bytes = self.slice(offset, 2)?;
        Ok(u16::from_le_bytes([bytes[0], bytes[1]]))
    }

    fn text(&self, offset: usize) -> anyhow::Result<String> {
        let rest = self.bytes.get(offset..).unwrap_or_default();
        let length = rest.iter().position(|byte| *byte == 0).unwrap_or(rest.len());
        Ok(String::from_utf8_lossy(self.slice(offset, length)?).into_owned())
    }

    fn headers(&self) -> anyhow::Result<Vec<Header>> {
        let table = self.word(32)? as usize;
        let (size, count) = (usize::from(self.half(46)?), usize::from(self.half(48)?));
        let header = |index: usize| {
            let at = table.saturating_add(index * size);
            Ok(Header {
                name: self.word(at)?,
                kind: self.word(at + 4)?,
                flags: self.word(at + 8)?,
                address: self.word(at + 12)?,
                offset: self.word(at + 16)? as usize,
                size: self.word(at + 20)?,
                link: self.word(at + 24)?,
            })
        };
        (0..count).map(header).collect()
    }

    fn segments(&self) -> anyhow::Result<Vec<Segment>> {
        let table = self.word(28)? as usize;
        let (size, count) = (usize::from(self.half(42)?), usize::from(self.half(44)?));
        let mut segments = Vec::new();
        for at in (0..count).map(|index| table.saturating_add(index * size)) {
            let length = self.word(at + 16)? as usize;
            if self.word(at)? == SEGMENT_LOAD && length > 0 {
                segments.push(Segment {
                    physical: physical(self.word(at + 12)?),
                    offset: self.word(at + 4)? as usize,
                    bytes: self.slice(self.word(at + 4)? as usize, length)?.to_vec(),
                });
            }
        }
        segments.sort_by_key(|segment| segment.physical);
        Ok(segments)
    }

    fn section(&self, header: &Header, names: &Header) -> anyhow::Result<Section> {
        let bytes = match header.kind {
            KIND_ZEROED => None,
            _ => Some(self.slice(header.offset, header.size as usize)?.to_vec()),
        };
        Ok(Section {
            name: self.text(names.offset.saturating_add(header.name as usize))?,
            address: header.address,
            size: header.size,
            executable: header.flags & FLAG_EXECUTABLE != 0,
            bytes,
        })
    }

    fn symbols(&self, table: &Header, names: &Header, headers: &[Header]) -> anyhow::Result<Vec<Symbol>> {
        let mut symbols = Vec::new();
        for index in 0..table.size as usize / 16 {
            let at = table.offset.saturating_add(index * 16);
            let kind = self.slice(at + 12, 1)?.first().copied().unwrap_or(0) & 0xF;
            let home = headers.get(usize::from(self.half(at + 14)?));
            let in_code = home.is_some_and(|header| header.flags & FLAG_EXECUTABLE != 0);
            let name = self.text(names.offset.saturating_add(self.word(at)? as usize))?;
            // 0 = no type, 1 = object, 2 = function; the rest are files and sections.
            if kind > 2 || name.is_empty() || name.starts_with('$') || home.is_none() {
                continue;
            }
            symbols.push(Symbol {
                name: super::symbol_name::readable(&name),
                address: self.word(at + 4)?,
                size: self.word(at + 8)?,
                code: in_code && kind != 1,
                function: kind == 2,
            });
        }
        Ok(symbols)
    }
}
