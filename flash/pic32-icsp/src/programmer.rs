//! The whole: connect, read, write, verify, with repetition of what the line spoiled.

use crate::entry::Allowed;
use crate::error::IcspError;
use crate::image::{
    BOOT_BYTES, BOOT_START, CONFIGURATION_BYTES, FlashImage, PAGE_BYTES, PROGRAM_BYTES, ROW_BYTES, word_of,
};
use crate::pins::IcspPins;
use crate::stub::StubFault;
use crate::test_port::TestPort;

/// How often a page is tried, each time from a new entry.
const ATTEMPTS: u32 = 8;
/// From physical addresses to those without a cache.
const KSEG1: u32 = 0xA000_0000;
/// The page with the configuration words, and where they begin.
const CONFIGURATION_PAGE: u32 = BOOT_START + 0x2000;
const CONFIGURATION_START: u32 = BOOT_START + (BOOT_BYTES - CONFIGURATION_BYTES) as u32;
const TOTAL_BYTES: usize = PROGRAM_BYTES + BOOT_BYTES;

/// What is going on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Reading.
    Read,
    /// Erasing and writing.
    Write,
    /// Comparing.
    Verify,
}

/// How far it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is going on.
    pub task: Task,
    /// Bytes that are done.
    pub done_bytes: usize,
    /// Of how many.
    pub total_bytes: usize,
}

/// What to erase before writing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErasedFirst {
    /// Page by page, each before it is written.
    Pages,
    /// The whole chip: the only way into one that is protected.
    Chip,
}

/// A programmer with its lines.
pub struct Programmer<'a, P> {
    pins: &'a mut P,
    progress: &'a mut dyn FnMut(Progress),
    is_connected: bool,
}

impl<P> std::fmt::Debug for Programmer<'_, P> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let connected = self.is_connected;
        formatter
            .debug_struct("Programmer")
            .field("is_connected", &connected)
            .finish_non_exhaustive()
    }
}

impl<'a, P: IcspPins> Programmer<'a, P> {
    /// A programmer that has not touched its lines yet.
    pub fn new(pins: &'a mut P, progress: &'a mut dyn FnMut(Progress)) -> Self {
        Self {
            pins,
            progress,
            is_connected: false,
        }
    }

    fn port(&mut self) -> TestPort<'_, P> {
        TestPort::new(self.pins)
    }

    /// The chip's identity with its revision. Nothing is changed, but the program is stopped until [`Self::release`].
    ///
    /// # Errors
    /// No chip, another part, or one that is protected.
    pub fn probe(&mut self) -> Result<u32, IcspError<P::Error>> {
        self.identify(Allowed::OnlyUnprotected)
    }

    fn identify(&mut self, allowed: Allowed) -> Result<u32, IcspError<P::Error>> {
        self.is_connected = false;
        let mut last = None;
        for _ in 0..ATTEMPTS {
            let mut port = self.port();
            port.enter()?;
            match port.check(allowed) {
                Ok(id) => return Ok(id),
                Err(error @ IcspError::Pins(_)) => return Err(error),
                // One wrong bit gives another part: what is found twice is believed.
                Err(error) if last.as_ref() == Some(&error_kind(&error)) => return Err(error),
                Err(error) => last = Some(error_kind(&error)),
            }
        }
        Err(IcspError::LineFaulty {
            address: 0,
            attempts: ATTEMPTS,
        })
    }

    /// Lets the chip run its program, whatever was done before.
    ///
    /// # Errors
    /// When a line cannot be set.
    pub fn release(&mut self) -> Result<(), IcspError<P::Error>> {
        self.is_connected = false;
        self.port().leave()
    }

    /// Enters, checks, and starts the stub.
    fn connect(&mut self) -> Result<(), StubFault<P::Error>> {
        if self.is_connected {
            return Ok(());
        }
        self.identify(Allowed::OnlyUnprotected)?;
        let mut port = self.port();
        port.start_core()?;
        port.start_stub()?;
        self.is_connected = true;
        Ok(())
    }

    /// Does something with the stub; enters again and repeats it when the line lost or changed a word.
    fn repeat<T>(
        &mut self,
        address: u32,
        mut attempt: impl FnMut(&mut TestPort<'_, P>) -> Result<T, StubFault<P::Error>>,
    ) -> Result<T, IcspError<P::Error>> {
        for _ in 0..ATTEMPTS {
            let outcome = match self.connect() {
                Ok(()) => attempt(&mut self.port()),
                Err(fault) => Err(fault),
            };
            match outcome {
                Ok(value) => return Ok(value),
                Err(StubFault::Lost) => {}
                Err(StubFault::Flash(control)) => {
                    self.is_connected = false;
                    return Err(IcspError::FlashRefused { address, control });
                }
                // The core did not come up: a line that lost a word looks alike.
                Err(StubFault::Icsp(
                    IcspError::CoreSilent | IcspError::NotReady(_) | IcspError::Unsteady { .. },
                )) => {}
                Err(StubFault::Icsp(error)) => {
                    self.is_connected = false;
                    return Err(error);
                }
            }
            self.is_connected = false;
        }
        Err(IcspError::LineFaulty {
            address,
            attempts: ATTEMPTS,
        })
    }

    fn report(&mut self, task: Task, done_bytes: usize) {
        (self.progress)(Progress {
            task,
            done_bytes,
            total_bytes: TOTAL_BYTES,
        });
    }

    /// Reads the whole chip.
    ///
    /// # Errors
    /// See [`IcspError`]; nothing was changed.
    pub fn read(&mut self) -> Result<FlashImage, IcspError<P::Error>> {
        let mut image = FlashImage::erased();
        let pages: Vec<u32> = image.pages().map(|(address, _)| address).collect();
        for (done, address) in pages.into_iter().enumerate() {
            self.report(Task::Read, done * PAGE_BYTES);
            let mut page = [0; PAGE_BYTES];
            self.repeat(address, |port| port.read_by_stub(KSEG1 | address, &mut page))?;
            if let Some(place) = image.page_mut(address) {
                place.copy_from_slice(&page);
            }
        }
        self.report(Task::Read, TOTAL_BYTES);
        Ok(image)
    }

    /// Reads one page, from a physical address that is a multiple of [`PAGE_BYTES`].
    ///
    /// # Errors
    /// See [`IcspError`]; nothing was changed.
    pub fn read_page(&mut self, address: u32) -> Result<[u8; PAGE_BYTES], IcspError<P::Error>> {
        let mut page = [0; PAGE_BYTES];
        self.repeat(address, |port| port.read_by_stub(KSEG1 | address, &mut page))?;
        Ok(page)
    }

    /// Compares the whole chip with an image.
    ///
    /// # Errors
    /// The first word that differs, or see [`IcspError`].
    pub fn verify(&mut self, image: &FlashImage) -> Result<(), IcspError<P::Error>> {
        for (done, (address, wanted)) in image.pages().enumerate() {
            self.report(Task::Verify, done * PAGE_BYTES);
            let mut page = [0; PAGE_BYTES];
            self.repeat(address, |port| port.read_by_stub(KSEG1 | address, &mut page))?;
            compare((address, wanted), &page)?;
        }
        self.report(Task::Verify, TOTAL_BYTES);
        Ok(())
    }

    /// Writes an image: program flash, then boot flash, then the configuration words, DEVCFG0 last of all. Until boot flash is
    /// written, the chip starts nothing. It is not verified yet.
    ///
    /// # Errors
    /// See [`IcspError`]. What was written so far stays; writing again begins from anew.
    pub fn write(&mut self, image: &FlashImage, erased: ErasedFirst) -> Result<(), IcspError<P::Error>> {
        if erased == ErasedFirst::Chip {
            self.erase_chip()?;
        }
        // Without its first page the chip starts nothing: half a program must not drive motors if writing is cut off.
        self.repeat(BOOT_START, |port| {
            port.begin_erasure(BOOT_START)?;
            port.finish_flash()
        })?;
        for (done, (address, page)) in image.pages().enumerate() {
            self.report(Task::Write, done * PAGE_BYTES);
            let mut page = page.to_vec();
            if address == CONFIGURATION_PAGE {
                page[PAGE_BYTES - CONFIGURATION_BYTES..].fill(0xFF);
            }
            let last = address == CONFIGURATION_PAGE;
            // The first page of boot flash was erased at the beginning; each further try begins with an erasure.
            let mut is_erased = address == BOOT_START;
            self.repeat(address, |port| {
                if !std::mem::take(&mut is_erased) {
                    port.begin_erasure(address)?;
                }
                for (index, row) in page.chunks(ROW_BYTES).enumerate() {
                    if row.iter().any(|byte| *byte != 0xFF) {
                        port.begin_row(address + (index * ROW_BYTES) as u32, row)?;
                    }
                }
                // What a page leaves unfinished is judged by the next; after the last there is none.
                if last { port.finish_flash() } else { Ok(()) }
            })?;
        }
        self.write_configuration(image.configuration())?;
        self.report(Task::Write, TOTAL_BYTES);
        Ok(())
    }

    /// Erases and writes one page, and reads it back; all others stay. The address is physical and a multiple of [`PAGE_BYTES`].
    ///
    /// # Errors
    /// The first word that differs, or see [`IcspError`].
    pub fn write_page(&mut self, address: u32, page: &[u8; PAGE_BYTES]) -> Result<(), IcspError<P::Error>> {
        self.repeat(address, |port| {
            port.begin_erasure(address)?;
            for (index, row) in page.chunks(ROW_BYTES).enumerate() {
                if row.iter().any(|byte| *byte != 0xFF) {
                    port.begin_row(address + (index * ROW_BYTES) as u32, row)?;
                }
            }
            port.finish_flash()
        })?;
        let found = self.read_page(address)?;
        compare((address, page), &found)
    }

    /// Erases everything, a chip that is protected included.
    ///
    /// # Errors
    /// No chip, another part, or one that does not get ready.
    pub fn erase_chip(&mut self) -> Result<(), IcspError<P::Error>> {
        self.identify(Allowed::Protected)?;
        self.port().erase_all()
    }

    /// Programs the four words into their erased places, by instructions over the wires.
    fn write_configuration(&mut self, words: [u32; 4]) -> Result<(), IcspError<P::Error>> {
        for attempt in 0..ATTEMPTS {
            self.is_connected = false;
            self.identify(Allowed::OnlyUnprotected)?;
            match self.program_words(words) {
                Ok(true) => return Ok(()),
                Err(error @ IcspError::Pins(_)) => return Err(error),
                // The stub, which sends sums along, tells what is there.
                Ok(false) | Err(_) => {}
            }
            let mut found = [0; CONFIGURATION_BYTES];
            self.repeat(CONFIGURATION_START, |port| {
                port.read_by_stub(KSEG1 | CONFIGURATION_START, &mut found)
            })?;
            let differing = found
                .chunks(4)
                .map(word_of)
                .zip(words)
                .enumerate()
                .find(|(_, (found, wanted))| found != wanted);
            match differing {
                None => return Ok(()),
                // A bit that is cleared cannot be set without an erasure: writing again from the start does it.
                Some((index, (found, wanted))) if found & wanted != wanted || attempt + 1 == ATTEMPTS => {
                    return Err(IcspError::Differs {
                        address: CONFIGURATION_START + 4 * index as u32,
                        wanted,
                        found,
                    });
                }
                Some(_) => {}
            }
        }
        Ok(())
    }

    /// Programs them and looks whether they are there.
    fn program_words(&mut self, words: [u32; 4]) -> Result<bool, IcspError<P::Error>> {
        const NVMCON: u32 = 0xBF80_F400;
        const NVMCON_CLEAR: u32 = 0xBF80_F404;
        const NVMCON_SET: u32 = 0xBF80_F408;
        const NVMKEY: u32 = 0xBF80_F410;
        const NVMADDR: u32 = 0xBF80_F420;
        const NVMDATA: u32 = 0xBF80_F430;
        let mut port = self.port();
        port.start_core()?;
        for (index, word) in words.into_iter().enumerate() {
            if word == u32::MAX {
                continue;
            }
            port.store(NVMADDR, CONFIGURATION_START + 4 * index as u32)?;
            port.store(NVMDATA, word)?;
            // WREN, program word; the detector of low voltage has its 6 us until the next instruction has come over the wires.
            port.store(NVMCON, 0x4001)?;
            port.store(NVMKEY, 0xAA99_6655)?;
            port.store(NVMKEY, 0x5566_99AA)?;
            port.store(NVMCON_SET, 0x8000)?;
            port.pins.pause_us(200);
            port.store(NVMCON_CLEAR, 0x4000)?;
        }
        for (index, word) in words.into_iter().enumerate() {
            let found = port.load_word(KSEG1 | (CONFIGURATION_START + 4 * index as u32))?;
            if found != Some(word) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// What two errors have in common that say the same.
fn error_kind<E>(error: &IcspError<E>) -> (std::mem::Discriminant<IcspError<E>>, u32) {
    let detail = match error {
        IcspError::WrongPart(id) => *id,
        _ => 0,
    };
    (std::mem::discriminant(error), detail)
}

/// Whether a page holds what it should; the first word that differs otherwise.
fn compare<E>((address, wanted): (u32, &[u8]), found: &[u8]) -> Result<(), IcspError<E>> {
    let words = found.chunks(4).zip(wanted.chunks(4)).enumerate();
    for (index, (found, wanted)) in words {
        if found != wanted {
            return Err(IcspError::Differs {
                address: address + 4 * index as u32,
                wanted: word_of(wanted),
                found: word_of(found),
            });
        }
    }
    Ok(())
}
