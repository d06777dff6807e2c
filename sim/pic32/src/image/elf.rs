//! ELF, as far as a program for this chip needs it: segments to program, and names.

use super::error::ElfPart;
use super::{Image, ImageError, PART, Symbol, SymbolKind, physical};
use crate::memory::{FLASH_START, RAM_BYTES};

const MAGIC: [u8; 4] = *b"\x7fELF";
const CLASS_32: u8 = 1;
const LITTLE_ENDIAN: u8 = 1;
const EXECUTABLE: u16 = 2;
const MIPS: u16 = 8;
const HEADER_BYTES: u32 = 52;
const PROGRAM_HEADER_BYTES: u16 = 32;
const SECTION_HEADER_BYTES: u16 = 40;
const SYMBOL_BYTES: usize = 16;
const LOAD: u32 = 1;
const SYMBOL_TABLE: u32 = 2;
const NO_BITS: u32 = 8;
/// The architecture in `e_flags`, and the two that this core executes.
const FLAGS_ARCHITECTURE: u32 = 0xF000_0000;
const MIPS32: u32 = 0x5000_0000;
const MIPS32_R2: u32 = 0x7000_0000;
/// Flags of MIPS16e and microMIPS code.
const FLAGS_COMPRESSED: u32 = 0x0600_0000;
/// What linker scripts call the first stack pointer: ours, and that of the maker's compiler.
const STACK_SYMBOLS: [&str; 2] = ["__stack_top", "_stack"];
const PART_SECTION: &[u8] = b".librervac.part";

/// Reads a whole file.
pub(super) fn read(bytes: &[u8]) -> Result<Image, ImageError> {
    let file = File { bytes };
    file.check_header()?;
    let sections = file.sections()?;
    if let Some(part) = file.part(&sections)?
        && part != PART
    {
        return Err(ImageError::WrongPart(part));
    }
    let mut image = Image::erased();
    let mut programmed = 0;
    for segment in file.segments()? {
        let contents = file.piece(
            ElfPart::Segment(segment.number),
            segment.offset,
            segment.file_size,
        )?;
        segment.check_place()?;
        image.write_segment(segment.physical, contents)?;
        programmed += contents.len();
    }
    if programmed == 0 {
        return Err(ImageError::Empty);
    }
    image.symbols = file.symbols(&sections)?;
    check_stack(&image.symbols)?;
    Ok(image)
}

/// A program for a part with more memory can be as small as one for this part; its stack tells.
fn check_stack(symbols: &[Symbol]) -> Result<(), ImageError> {
    let is_outside = |symbol: &&Symbol| {
        let top = physical(symbol.address);
        STACK_SYMBOLS.contains(&symbol.name.as_str()) && top.is_none_or(|top| top > RAM_BYTES as u32)
    };
    match symbols.iter().find(is_outside) {
        None => Ok(()),
        Some(symbol) => Err(ImageError::StackOutside {
            symbol: symbol.name.clone(),
            address: symbol.address,
        }),
    }
}

impl Image {
    fn write_segment(&mut self, address: u32, contents: &[u8]) -> Result<(), ImageError> {
        match contents.is_empty() {
            true => Ok(()),
            false => self.write(address, contents),
        }
    }
}

/// Bytes of a file, read with bounds.
#[derive(Clone, Copy, Debug)]
struct File<'a> {
    bytes: &'a [u8],
}

/// A segment that is loaded.
#[derive(Clone, Copy, Debug)]
struct Segment {
    number: u16,
    offset: u32,
    address: u32,
    physical: u32,
    file_size: u32,
    memory_size: u32,
}

#[derive(Clone, Copy, Debug)]
struct Section {
    number: u16,
    name: u32,
    kind: u32,
    offset: u32,
    size: u32,
    link: u32,
}

impl Segment {
    /// Variables must lie in RAM as big as the part's; what lies in flash is checked when it is written.
    fn check_place(&self) -> Result<(), ImageError> {
        let outside = ImageError::OutsideRam {
            address: self.address,
            length: self.memory_size,
        };
        let start = physical(self.address).ok_or_else(|| outside.clone())?;
        let end = u64::from(start) + u64::from(self.memory_size);
        let is_flash = start >= FLASH_START && self.memory_size == self.file_size;
        match is_flash || end <= RAM_BYTES as u64 {
            true => Ok(()),
            false => Err(outside),
        }
    }
}

impl<'a> File<'a> {
    /// A number of bytes at an offset, or which part of the file is missing.
    fn piece(self, part: ElfPart, offset: u32, size: u32) -> Result<&'a [u8], ImageError> {
        let needed = u64::from(offset) + u64::from(size);
        let missing = ImageError::Truncated {
            part,
            needed,
            length: self.bytes.len(),
        };
        let end = usize::try_from(needed).map_err(|_| missing.clone())?;
        self.bytes.get(offset as usize..end).ok_or(missing)
    }

    fn header(self) -> Result<ElfFields<'a>, ImageError> {
        self.piece(ElfPart::Header, 0, HEADER_BYTES).map(ElfFields)
    }

    fn check_header(self) -> Result<(), ImageError> {
        if self.bytes.get(..MAGIC.len()) != Some(&MAGIC) {
            return Err(ImageError::NotElf);
        }
        let header = self.header()?;
        match header.byte(4) {
            CLASS_32 => {}
            class => return Err(ImageError::WrongClass(class)),
        }
        match header.byte(5) {
            LITTLE_ENDIAN => {}
            encoding => return Err(ImageError::WrongEndianness(encoding)),
        }
        match header.half(18) {
            MIPS => {}
            machine => return Err(ImageError::WrongMachine(machine)),
        }
        match header.half(16) {
            EXECUTABLE => {}
            kind => return Err(ImageError::NotLinked(kind)),
        }
        let flags = header.word(36);
        let is_known = matches!(flags & FLAGS_ARCHITECTURE, MIPS32 | MIPS32_R2);
        match is_known && flags & FLAGS_COMPRESSED == 0 {
            true => Ok(()),
            false => Err(ImageError::WrongArchitecture { flags }),
        }
    }

    /// The entries of a table whose offset, entry size and length stand at these places of the header.
    fn table(
        self,
        part: ElfPart,
        places: (usize, usize),
        wanted: u16,
    ) -> Result<Vec<ElfFields<'a>>, ImageError> {
        let header = self.header()?;
        let (offset, found) = (header.word(places.0), header.half(places.1));
        let count = header.half(places.1 + 2);
        if count == 0 {
            return Ok(Vec::new());
        }
        if found != wanted {
            return Err(ImageError::EntrySize { part, found, wanted });
        }
        let table = self.piece(part, offset, u32::from(count) * u32::from(wanted))?;
        Ok(table.chunks_exact(usize::from(wanted)).map(ElfFields).collect())
    }

    fn segments(self) -> Result<Vec<Segment>, ImageError> {
        let entries = self.table(ElfPart::ProgramHeaders, (28, 42), PROGRAM_HEADER_BYTES)?;
        let segments = (0..)
            .zip(entries)
            .map(|(number, entry)| (entry.word(0), number, entry));
        let loaded = segments
            .filter(|(kind, ..)| *kind == LOAD)
            .map(|(_, number, entry)| Segment {
                number,
                offset: entry.word(4),
                address: entry.word(8),
                physical: entry.word(12),
                file_size: entry.word(16),
                memory_size: entry.word(20),
            });
        Ok(loaded.filter(|segment| segment.memory_size > 0).collect())
    }

    fn sections(self) -> Result<Vec<Section>, ImageError> {
        let entries = self.table(ElfPart::SectionHeaders, (32, 46), SECTION_HEADER_BYTES)?;
        let sections = (0..).zip(entries).map(|(number, entry)| Section {
            number,
            name: entry.word(0),
            kind: entry.word(4),
            offset: entry.word(16),
            size: entry.word(20),
            link: entry.word(24),
        });
        Ok(sections.collect())
    }

    fn contents(self, section: Section) -> Result<&'a [u8], ImageError> {
        match section.kind {
            NO_BITS => Ok(&[]),
            _ => self.piece(ElfPart::Section(section.number), section.offset, section.size),
        }
    }

    /// The part that the program names.
    fn part(self, sections: &[Section]) -> Result<Option<String>, ImageError> {
        let Some(names) = sections.get(usize::from(self.header()?.half(50))) else {
            return Ok(None);
        };
        let names = self.contents(*names)?;
        let found = sections
            .iter()
            .find(|section| text(names, section.name) == PART_SECTION);
        let Some(section) = found else { return Ok(None) };
        let contents = self.contents(*section)?;
        Ok(Some(String::from_utf8_lossy(text(contents, 0)).into_owned()))
    }

    fn symbols(self, sections: &[Section]) -> Result<Vec<Symbol>, ImageError> {
        let mut found = Vec::new();
        for table in sections.iter().filter(|section| section.kind == SYMBOL_TABLE) {
            let Some(names) = sections.get(table.link as usize) else {
                continue;
            };
            let names = self.contents(*names)?;
            let entries = self.contents(*table)?.chunks_exact(SYMBOL_BYTES).map(ElfFields);
            found.extend(entries.filter_map(|entry| entry.symbol(names)));
        }
        found.sort_by(|left, right| (left.address, &left.name).cmp(&(right.address, &right.name)));
        Ok(found)
    }
}

/// The bytes up to a zero or the end.
fn text(bytes: &[u8], start: u32) -> &[u8] {
    let rest = bytes.get(start as usize..).unwrap_or_default();
    rest.split(|byte| *byte == 0).next().unwrap_or_default()
}

/// A record of fixed size; what lies beyond its end reads as zero.
#[derive(Clone, Copy, Debug)]
struct ElfFields<'a>(&'a [u8]);

impl ElfFields<'_> {
    fn bytes<const N: usize>(self, offset: usize) -> [u8; N] {
        let found = self.0.get(offset..).and_then(|rest| rest.first_chunk());
        found.copied().unwrap_or([0; N])
    }

    fn byte(self, offset: usize) -> u8 {
        u8::from_le_bytes(self.bytes(offset))
    }

    fn half(self, offset: usize) -> u16 {
        u16::from_le_bytes(self.bytes(offset))
    }

    fn word(self, offset: usize) -> u32 {
        u32::from_le_bytes(self.bytes(offset))
    }

    /// A symbol that names an address; files and sections are left out.
    fn symbol(self, names: &[u8]) -> Option<Symbol> {
        let kind = match self.byte(12) & 0xF {
            0 => SymbolKind::Plain,
            1 => SymbolKind::Object,
            2 => SymbolKind::Function,
            _ => return None,
        };
        let name = text(names, self.word(0));
        let is_defined = self.half(14) != 0;
        (is_defined && !name.is_empty()).then(|| Symbol {
            name: String::from_utf8_lossy(name).into_owned(),
            address: self.word(4),
            size: self.word(8),
            kind,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{ElfPart, Image, ImageError, SymbolKind};

    /// Code in flash, variables with initial values in RAM that are loaded from flash, and variables without.
    const SEGMENTS: [[u32; 4]; 3] = [
        [0x9D00_0000, 0x1D00_0000, 8, 8],
        [0x8000_0000, 0x1D00_0100, 4, 4],
        [0x8000_0004, 0x8000_0004, 0, 0x100],
    ];

    /// A small program: header, segments, contents, names, symbols, sections.
    fn program(segments: &[[u32; 4]], part: &str) -> Vec<u8> {
        with_stack(segments, part, 0x8000_8000)
    }

    fn with_stack(segments: &[[u32; 4]], part: &str, stack: u32) -> Vec<u8> {
        let names = b"\0.librervac.part\0main\0level\0_stack\0";
        let part = [part.as_bytes(), &[0]].concat();
        let table = 52;
        let contents = table + 32 * segments.len();
        let sections = contents + 16 + names.len() + part.len() + 64;
        let mut file = vec![0x7F, b'E', b'L', b'F', 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        halves(&mut file, &[2, 8]);
        words(
            &mut file,
            &[1, 0xBFC0_0000, table as u32, sections as u32, 0x7000_1001],
        );
        halves(&mut file, &[52, 32, segments.len() as u16, 40, 4, 1]);
        for [address, physical, in_file, in_memory] in segments {
            words(
                &mut file,
                &[
                    1,
                    contents as u32,
                    *address,
                    *physical,
                    *in_file,
                    *in_memory,
                    5,
                    4,
                ],
            );
        }
        file.extend(1..=16);
        file.extend_from_slice(names);
        file.extend_from_slice(&part);
        let (name_start, part_start) = (contents as u32 + 16, contents as u32 + 16 + names.len() as u32);
        words(&mut file, &[0, 0, 0, 0]);
        words(&mut file, &[17, 0x9D00_0000, 8, 2 | 5 << 16]);
        words(&mut file, &[22, 0x8000_0000, 4, 1 | 5 << 16]);
        words(&mut file, &[28, stack, 0, 5 << 16]);
        words(&mut file, &[0; 10]);
        words(
            &mut file,
            &[0, 3, 0, 0, name_start, names.len() as u32, 0, 0, 1, 0],
        );
        words(
            &mut file,
            &[1, 1, 0, 0, part_start, part.len() as u32, 0, 0, 1, 0],
        );
        words(
            &mut file,
            &[0, 2, 0, 0, part_start + part.len() as u32, 64, 1, 0, 4, 16],
        );
        file
    }

    fn halves(file: &mut Vec<u8>, values: &[u16]) {
        file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    }

    fn words(file: &mut Vec<u8>, values: &[u32]) {
        file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    }

    fn changed(place: usize, value: u8) -> Result<Image, ImageError> {
        let mut file = program(&SEGMENTS, super::PART);
        file[place] = value;
        Image::from_elf(&file)
    }

    #[test]
    fn segments_are_programmed_where_they_are_loaded_from() {
        let image = Image::from_elf(&program(&SEGMENTS, super::PART)).unwrap();
        assert_eq!(image.flash()[..9], [1, 2, 3, 4, 5, 6, 7, 8, 0xFF]);
        assert_eq!(image.flash()[0xFF..0x105], [0xFF, 1, 2, 3, 4, 0xFF]);
    }

    #[test]
    fn names_are_found() {
        let image = Image::from_elf(&program(&SEGMENTS, super::PART)).unwrap();
        let level = image.symbol("level").unwrap();
        assert_eq!(
            (level.address, level.size, level.kind),
            (0x8000_0000, 4, SymbolKind::Object)
        );
        let name = |address| image.function_at(address).map(|symbol| symbol.name.as_str());
        assert_eq!(name(0x9D00_0007), Some("main"));
        assert_eq!(name(0x9D00_0008), None);
        assert_eq!(name(0x8000_0000), None);
    }

    #[test]
    fn a_program_for_something_else_is_reported_as_such() {
        assert_eq!(changed(0, b'#'), Err(ImageError::NotElf));
        assert_eq!(changed(4, 2), Err(ImageError::WrongClass(2)));
        assert_eq!(changed(5, 2), Err(ImageError::WrongEndianness(2)));
        assert_eq!(changed(16, 1), Err(ImageError::NotLinked(1)));
        assert_eq!(changed(18, 62), Err(ImageError::WrongMachine(62)));
        let flags = 0x8000_1001;
        assert_eq!(changed(39, 0x80), Err(ImageError::WrongArchitecture { flags }));
        let (part, found, wanted) = (ElfPart::ProgramHeaders, 33, 32);
        assert_eq!(
            changed(42, 33),
            Err(ImageError::EntrySize { part, found, wanted })
        );
        let other = "PIC32MX460F512L";
        let refused = Image::from_elf(&program(&SEGMENTS, other));
        assert_eq!(refused, Err(ImageError::WrongPart(other.to_owned())));
    }

    #[test]
    fn a_stack_beyond_ram_is_another_parts() {
        let with = |stack| Image::from_elf(&with_stack(&SEGMENTS, super::PART, stack));
        assert!(
            [0x8000_8000, 0xA000_7FF8]
                .into_iter()
                .all(|stack| with(stack).is_ok())
        );
        for address in [0x8000_8004, 0x8002_0000, 0xA001_0000, 0x7FFF_F000] {
            let symbol = "_stack".to_owned();
            assert_eq!(with(address), Err(ImageError::StackOutside { symbol, address }));
        }
    }

    #[test]
    fn segments_must_fit_the_part() {
        let outside_flash = |address, length| Err(ImageError::OutsideFlash { address, length });
        let outside_ram = |address, length| Err(ImageError::OutsideRam { address, length });
        let cases = [
            ([0x9D03_FFFC, 0x1D03_FFFC, 8, 8], outside_flash(0x1D03_FFFC, 8)),
            ([0x8000_0000, 0x8000_0000, 8, 8], outside_flash(0x8000_0000, 8)),
            ([0x0040_0000, 0x0040_0000, 8, 8], outside_ram(0x0040_0000, 8)),
            ([0x8000_7FFC, 0x1D00_0000, 4, 8], outside_ram(0x8000_7FFC, 8)),
            (
                [0xA000_0000, 0x1D00_0000, 4, 0x8001],
                outside_ram(0xA000_0000, 0x8001),
            ),
            ([0x8000_0000, 0x8000_0000, 0, 64], Err(ImageError::Empty)),
        ];
        for (segment, expected) in cases {
            let found = Image::from_elf(&program(&[segment], super::PART));
            assert_eq!(found, expected, "{segment:x?}");
        }
    }

    #[test]
    fn a_cut_file_is_reported_as_truncated() {
        let file = program(&SEGMENTS, super::PART);
        for length in 4..file.len() {
            let Err(ImageError::Truncated {
                needed,
                length: stated,
                ..
            }) = Image::from_elf(&file[..length])
            else {
                panic!("{length} of {} bytes were not told as truncated", file.len());
            };
            assert!(needed > length as u64 && stated == length);
        }
        assert_eq!(Image::from_elf(&file[..3]), Err(ImageError::NotElf));
    }

    #[test]
    fn no_changed_byte_ends_in_a_panic() {
        let file = program(&SEGMENTS, super::PART);
        let mut outcomes = [0, 0];
        for place in 0..file.len() {
            for value in [0, 1, 0x7F, 0x80, 0xFF] {
                let mut changed = file.clone();
                changed[place] = value;
                outcomes[usize::from(Image::from_elf(&changed).is_ok())] += 1;
            }
        }
        assert!(outcomes.iter().all(|count| *count > 100), "{outcomes:?}");
    }
}
