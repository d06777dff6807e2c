//! As much of a 32-bit little-endian ELF file as the measurement needs.

/// What a linked image takes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Image {
    /// Code, constants and initial values, in bytes.
    pub(crate) flash: u32,
    /// Variables, in bytes.
    pub(crate) static_memory: u32,
    /// Value of the probe's `CORD_BYTES`.
    pub(crate) cord: u32,
    /// Functions of the panic machinery that are linked.
    pub(crate) panic_paths: usize,
}

struct Section {
    kind: u32,
    flags: u32,
    address: u32,
    offset: usize,
    size: u32,
    link: u32,
}

const KIND_PROGRAM: u32 = 1;
const KIND_SYMBOLS: u32 = 2;
const KIND_ZEROED: u32 = 8;
const FLAG_WRITE: u32 = 1;
const FLAG_ALLOCATED: u32 = 2;

impl Image {
    /// Reads an image; `None` if it is not such a file.
    pub(crate) fn read(bytes: &[u8]) -> Option<Self> {
        if bytes.get(..6)? != b"\x7FELF\x01\x01" {
            return None;
        }
        let sections = sections(bytes)?;
        let mut image = Self::default();
        for section in sections
            .iter()
            .filter(|section| section.flags & FLAG_ALLOCATED != 0)
        {
            match section.kind {
                KIND_ZEROED => image.static_memory += section.size,
                KIND_PROGRAM => {
                    image.flash += section.size;
                    let writable = section.flags & FLAG_WRITE != 0;
                    image.static_memory += if writable { section.size } else { 0 };
                }
                _ => {}
            }
        }
        let symbols = sections.iter().find(|section| section.kind == KIND_SYMBOLS)?;
        let names = sections.get(symbols.link as usize)?;
        for entry in bytes
            .get(symbols.offset..)?
            .chunks_exact(16)
            .take(symbols.size as usize / 16)
        {
            let name = name(bytes, names.offset + word(entry, 0)? as usize)?;
            if name == b"CORD_BYTES" {
                image.cord = value_at(bytes, &sections, word(entry, 4)?)?;
            }
            image.panic_paths += usize::from(name.windows(9).any(|part| part == b"panicking"));
        }
        Some(image)
    }
}

fn sections(bytes: &[u8]) -> Option<Vec<Section>> {
    let table = word(bytes, 32)? as usize;
    let (size, count) = (half(bytes, 46)?, half(bytes, 48)?);
    (0..count)
        .map(|index| {
            let header = bytes.get(table + index * size..)?;
            Some(Section {
                kind: word(header, 4)?,
                flags: word(header, 8)?,
                address: word(header, 12)?,
                offset: word(header, 16)? as usize,
                size: word(header, 20)?,
                link: word(header, 24)?,
            })
        })
        .collect()
}

fn value_at(bytes: &[u8], sections: &[Section], address: u32) -> Option<u32> {
    let holder = sections.iter().find(|section| {
        section.kind == KIND_PROGRAM && address.wrapping_sub(section.address) < section.size
    })?;
    word(bytes, holder.offset + (address - holder.address) as usize)
}

fn name(bytes: &[u8], offset: usize) -> Option<&[u8]> {
    bytes.get(offset..)?.split(|byte| *byte == 0).next()
}

fn word(bytes: &[u8], offset: usize) -> Option<u32> {
    Some(u32::from_le_bytes(
        bytes.get(offset..offset + 4)?.try_into().ok()?,
    ))
}

fn half(bytes: &[u8], offset: usize) -> Option<usize> {
    Some(usize::from(u16::from_le_bytes(
        bytes.get(offset..offset + 2)?.try_into().ok()?,
    )))
}
