//! The boot loader in the chip, as a peer at the other end of the serial line.
//!
//! It is not executed code, because nobody can read that, but what two programmers and a recorded conversation say of it. It hears
//! bytes at rates: what comes at another rate than it listens to is garbage to it, and the same holds for what it says.
//!
//! Where the sources differ it is lenient in what it takes: any pause after a new rate, and any number of pings. An erasure of N
//! blocks erases N times 256 bytes, as stcgal asks for it; the maker's own tool sends N = 1 for a whole program, so N = 1 erases all.

mod fault;
mod frames;

pub use fault::LoaderFaults;

use crate::image::Image;
use crate::machine::{ClockMode, Options};
use frames::Incoming;
use home::Pcg;

/// Rate at which it is called.
const HANDSHAKE_BAUD: u32 = 2_400;
/// How long it listens before it starts the program.
const LISTEN_MS: u64 = 250;
/// Pulses that it wants to hear.
const PULSES: u32 = 3;
/// After a new rate is ordered, it answers this late: hosts take 100 ms to change theirs.
const SWITCH_MS: u64 = 150;
/// An erased block takes so long.
const BLOCK_ERASE_MS: u64 = 2;
/// A block that is written.
const BLOCK_WRITE_MS: u64 = 3;
/// Rates that differ by less are the same, in parts per thousand.
const RATE_PERMILLE: u64 = 45;

/// A byte on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoaderByte {
    /// What.
    pub byte: u8,
    /// At which rate, bits per second.
    pub baud: u32,
}

/// What it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LoaderState {
    /// No supply.
    Off,
    /// Counts pulses until then.
    Listens { until_ms: u64, pulses: u32 },
    /// Obeys.
    Serves,
    /// The program runs.
    Program,
}

/// The chip's loader with the flash that it writes.
#[derive(Clone, Debug)]
pub struct BootLoader {
    state: LoaderState,
    options: Options,
    option_byte: u8,
    flash: Vec<u8>,
    /// Erased up to here since power came on.
    erased: usize,
    incoming: Incoming,
    baud: u32,
    /// What it says, and when.
    outgoing: Vec<(u64, Vec<u8>, u32)>,
    faults: LoaderFaults,
    random: Pcg,
    said_garbage: bool,
    starts: u32,
}

impl BootLoader {
    /// A chip with a program, switched off.
    #[must_use]
    pub fn new(image: &Image, options: Options, faults: LoaderFaults) -> Self {
        let six = options.clock_mode == ClockMode::Six;
        let watchdog = if options.watchdog_at_power_up { 0 } else { 0x80 };
        Self {
            state: LoaderState::Off,
            options,
            option_byte: watchdog | 0x7C | u8::from(!six),
            flash: image.flash().to_vec(),
            erased: 0,
            incoming: Incoming::default(),
            baud: HANDSHAKE_BAUD,
            outgoing: Vec::new(),
            faults,
            random: Pcg::new(faults.seed, 0x57C9),
            said_garbage: false,
            starts: 0,
        }
    }

    /// The supply comes on: the loader listens, then starts the program. A program that writes ISP_CONTR = 0x60 comes here, too.
    pub fn power_on(&mut self, now_ms: u64) {
        self.starts += 1;
        self.erased = 0;
        self.incoming = Incoming::default();
        self.baud = HANDSHAKE_BAUD;
        self.outgoing.clear();
        // With this option at 0 it listens only while P1.0 and P1.1 are low, and on the robot they are not.
        let is_closed = self.option_byte & 1 << 2 == 0;
        self.state = match is_closed {
            true => LoaderState::Program,
            false => LoaderState::Listens {
                until_ms: now_ms + LISTEN_MS,
                pulses: 0,
            },
        };
    }

    /// The supply goes off, in the midst of anything: a block that was being written is half there.
    pub fn power_off(&mut self) {
        self.state = LoaderState::Off;
        self.outgoing.clear();
    }

    /// Program flash as it is.
    #[must_use]
    pub fn flash(&self) -> &[u8] {
        &self.flash
    }

    /// The option byte as it is.
    #[must_use]
    pub fn option_byte(&self) -> u8 {
        self.option_byte
    }

    /// Whether the program runs.
    #[must_use]
    pub fn runs_program(&self) -> bool {
        self.state == LoaderState::Program
    }

    /// How often power came on.
    #[must_use]
    pub fn starts(&self) -> u32 {
        self.starts
    }

    /// The program that it starts, for a [`crate::machine::Machine`].
    #[must_use]
    pub fn image(&self) -> Image {
        let mut image = Image::erased();
        let fits = image.write(0, &self.flash);
        debug_assert!(fits, "flash has the size of flash");
        image
    }

    /// A byte comes along the line.
    pub fn hear(&mut self, heard: LoaderByte, now_ms: u64) {
        self.start_when_late(now_ms);
        if !is_same(heard.baud, self.baud) || self.is_dropped() {
            return;
        }
        match self.state {
            LoaderState::Off | LoaderState::Program => {}
            LoaderState::Listens { until_ms, pulses } if heard.byte == 0x7F => {
                let pulses = pulses + 1;
                self.state = LoaderState::Listens { until_ms, pulses };
                if pulses == PULSES {
                    self.state = LoaderState::Serves;
                    self.tell_status(now_ms);
                }
            }
            LoaderState::Listens { .. } => {}
            LoaderState::Serves => {
                if let Some(payload) = self.incoming.push(heard.byte) {
                    self.obey(&payload, now_ms);
                }
            }
        }
    }

    fn start_when_late(&mut self, now_ms: u64) {
        if let LoaderState::Listens { until_ms, .. } = self.state
            && now_ms >= until_ms
        {
            self.state = LoaderState::Program;
        }
    }

    fn is_dropped(&mut self) -> bool {
        let one_in = self.faults.drop_one_in;
        one_in != 0 && self.state == LoaderState::Serves && self.random.below(one_in) == 0
    }

    /// What has left by now, each byte with its rate.
    pub fn say(&mut self, now_ms: u64) -> Vec<LoaderByte> {
        self.start_when_late(now_ms);
        let (due, later) = self.outgoing.drain(..).partition(|(at_ms, ..)| *at_ms <= now_ms);
        self.outgoing = later;
        let due: Vec<(u64, Vec<u8>, u32)> = due;
        due.into_iter()
            .flat_map(|(_, bytes, baud)| bytes.into_iter().map(move |byte| LoaderByte { byte, baud }))
            .collect()
    }

    /// When it says something next.
    #[must_use]
    pub fn says_at_ms(&self) -> Option<u64> {
        self.outgoing.iter().map(|(at_ms, ..)| *at_ms).min()
    }

    fn reply(&mut self, payload: &[u8], (at_ms, baud): (u64, u32)) {
        let mut bytes = frames::from_chip(payload);
        if self.faults.spoil_one_in != 0 && self.random.below(self.faults.spoil_one_in) == 0 {
            let place = self.random.below(bytes.len() as u32) as usize;
            bytes[place] ^= 0x10;
        }
        self.outgoing.push((at_ms, bytes, baud));
    }

    /// The first frame has no start bytes on this family.
    fn tell_status(&mut self, now_ms: u64) {
        let clocks = self.options.clock_mode.clocks();
        let counter = u64::from(self.options.crystal_hz) * 7 / u64::from(HANDSHAKE_BAUD * clocks);
        let [high, low] = (counter as u16).to_be_bytes();
        let mut payload = vec![0x00];
        payload.extend([high, low].repeat(8));
        let [model_high, model_low] = self.faults.model.unwrap_or(0xF128).to_be_bytes();
        payload.extend([0x43, b'C', self.option_byte, model_high, model_low]);
        payload.resize(54, 0x00);
        let frame = frames::from_chip(&payload);
        let mut bytes = frame[2..].to_vec();
        if self.faults.garbage_first && !self.said_garbage {
            self.said_garbage = true;
            bytes.splice(..0, [0x68, 0x00, 0x68, 0xF0, 0x46]);
        }
        self.outgoing.push((now_ms + 20, bytes, HANDSHAKE_BAUD));
    }

    fn obey(&mut self, payload: &[u8], now_ms: u64) {
        match payload {
            [0x8F, high, low, check, double, _, _] | [0x8E, high, low, check, double, _] => {
                self.change_rate(payload, [*high, *low, *check, *double], now_ms);
            }
            [0x80, 0x00, 0x00, 0x36, 0x01, high, low] => {
                let id = self.faults.model.unwrap_or(0xF128);
                if u16::from_be_bytes([*high, *low]) == id {
                    self.reply(&[0x80], (now_ms + 1, self.baud));
                }
            }
            [0x84, blocks, 0x33, ..] => self.erase(*blocks, now_ms),
            [0x00, 0x00, 0x00, high, low, 0x00, 0x80, data @ ..] if data.len() == 128 => {
                self.write(u16::from_be_bytes([*high, *low]), data, now_ms);
            }
            [0x8D, options, 0xFF, 0xFF, 0xFF] => {
                self.option_byte = *options;
                self.reply(payload, (now_ms + 5, self.baud));
            }
            [0x82] => {
                self.reply(&[0x80], (now_ms + 1, self.baud));
                self.state = LoaderState::Program;
            }
            // What it does not understand it does not answer.
            _ => {}
        }
    }

    fn change_rate(&mut self, payload: &[u8], [high, low, check, double]: [u8; 4], now_ms: u64) {
        let reload = u64::from(u16::from_be_bytes([high, low]));
        let is_whole = check == 0xFF - high && double == 0_u8.wrapping_sub(low).wrapping_mul(2);
        let divider = u64::from(self.options.clock_mode.clocks()) / 6 * 16;
        let baud = (u64::from(self.options.crystal_hz) / (divider * (0x1_0000 - reload))) as u32;
        if !is_whole || self.faults.deaf_above_baud.is_some_and(|most| baud > most) {
            return;
        }
        self.reply(payload, (now_ms + SWITCH_MS, baud));
        // The trial ends with its answer; the setting stays.
        if payload.first() == Some(&0x8E) {
            self.baud = baud;
        }
    }

    fn erase(&mut self, blocks: u8, now_ms: u64) {
        let bytes = match blocks {
            1 => self.flash.len(),
            _ => usize::from(blocks) * 256,
        };
        let end = bytes.min(self.flash.len());
        self.flash[..end].fill(0xFF);
        self.erased = self.erased.max(end);
        let lasts_ms = end as u64 / 256 * BLOCK_ERASE_MS;
        self.reply(&[0x80], (now_ms + lasts_ms, self.baud));
    }

    fn write(&mut self, address: u16, data: &[u8], now_ms: u64) {
        let start = usize::from(address);
        if start + data.len() > self.erased {
            return;
        }
        let Some(place) = self.flash.get_mut(start..start + data.len()) else {
            return;
        };
        place.copy_from_slice(data);
        if self.faults.weak_cell == Some(address) {
            place[0] ^= 1;
        }
        let sum = place.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        self.reply(&[0x80, sum], (now_ms + BLOCK_WRITE_MS, self.baud));
    }
}

/// Whether a receiver at one rate understands the other.
fn is_same(heard: u32, own: u32) -> bool {
    u64::from(heard.abs_diff(own)) * 1_000 <= u64::from(own) * RATE_PERMILLE
}
