//! The ADC: ten channels once a millisecond, and the infrared proximity sensors, whose multiplexers advance with each
//! scan.
//!
//! The interrupt at the end of a scan copies all results with the millisecond in which they were taken, so that their
//! age is known. It then selects the next proximity sensor, which has the rest of the millisecond to settle.

use core::sync::atomic::{AtomicU16, AtomicU32, Ordering};

use pic32mx3_hal::adc::{Adc, Channels, Results, Scanner, Timing};
use pic32mx3_hal::gpio::Port;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{cpu, interrupt};

use super::off::{mask, port};
use super::tick;
use crate::generated::pins::{self, Signal};
use crate::logic::proximity::{FRONT_CHANNEL, SENSORS, ScanTarget, Sweep};

/// Channels of the chip.
pub const CHANNELS: usize = 16;
/// AN0, 2, 3, 4, 8, 10, 11, 12, 13, 14: everything analog on the board.
const SCANNED: Channels = Channels::from_bits(pins::ANALOG as u16);
/// Number of channels in a scan.
const SCAN: usize = SCANNED.len() as usize;
/// Channels of a scan, in the order of its results.
const ORDER: [u8; SCAN] = {
    let mut order = [0; SCAN];
    let mut channel = 0;
    while channel < CHANNELS as u8 {
        if let Some(position) = SCANNED.position(channel) {
            order[position as usize] = channel;
        }
        channel += 1;
    }
    order
};
/// 400 ns clocks and the longest sampling, for the dividers of 10 kilo-ohm and more: ten channels last 172 µs.
const TIMING: Timing = Timing {
    clock_divider: 15,
    sample_clocks: 31,
};

static COUNTS: [AtomicU16; CHANNELS] = [const { AtomicU16::new(0) }; CHANNELS];
static SCANS: AtomicU32 = AtomicU32::new(0);
static SCANNED_AT: AtomicU32 = AtomicU32::new(0);
static DARK: [AtomicU16; SENSORS] = [const { AtomicU16::new(0) }; SENSORS];
static LIT: [AtomicU16; SENSORS] = [const { AtomicU16::new(0) }; SENSORS];
/// Who uses the emitters: see [`Emitter`].
static EMITTER: AtomicU32 = AtomicU32::new(Emitter::Sweeping as u32);
static HANDLER: HandlerCell<vector::ADC, Scanning> = HandlerCell::empty();

/// User of the infrared emitters. The sweep runs by itself. The code for the dock requests the front emitter; the next
/// scan lends it, with the emitter dark and the multiplexers set to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(super) enum Emitter {
    Sweeping = 0,
    Asked = 1,
    Lent = 2,
}

#[derive(Debug)]
struct Scanning {
    results: Results,
    sweep: Sweep,
}

fn on_scan(context: &mut Context<vector::ADC>) {
    Source::Adc.clear();
    let Some(scanning) = HANDLER.get(context) else {
        return;
    };
    for (position, channel) in (0_u8..).zip(ORDER) {
        if let Some(count) = COUNTS.get(usize::from(channel)) {
            count.store(scanning.results.get(position), Ordering::Relaxed);
        }
    }
    SCANNED_AT.store(tick::ticks(), Ordering::Relaxed);
    SCANS.store(SCANS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
    scanning.sweep = next_look(scanning.sweep);
}
interrupt!(ADC, on_scan);

/// Stores the reading of this scan and selects the target of the next one.
fn next_look(sweep: Sweep) -> Sweep {
    match EMITTER.load(Ordering::Relaxed) {
        LENT => Sweep::new(),
        ASKED => {
            select_channel(ScanTarget {
                channel: FRONT_CHANNEL,
                lit: false,
            });
            EMITTER.store(LENT, Ordering::Relaxed);
            Sweep::new()
        }
        _ => {
            let ScanTarget { channel, lit } = sweep.look();
            let seen = count(pins::PROXIMITY_RECEIVE);
            let readings = if lit { &LIT } else { &DARK };
            if let Some(reading) = readings.get(usize::from(channel)) {
                reading.store(seen, Ordering::Relaxed);
            }
            let next = sweep.next();
            select_channel(next.look());
            next
        }
    }
}

const ASKED: u32 = Emitter::Asked as u32;
const LENT: u32 = Emitter::Lent as u32;

/// Changes the select lines only while the emitter is dark. Writes latches through their set and clear registers, so
/// other pins of these ports do not change.
fn select_channel(look: ScanTarget) {
    write_pin(pins::PROXIMITY_EMIT, false);
    write_pin(pins::PROXIMITY_SELECT_A, look.channel & 1 != 0);
    write_pin(pins::PROXIMITY_SELECT_B, look.channel & 2 != 0);
    write_pin(pins::PROXIMITY_SELECT_C, look.channel & 4 != 0);
    write_pin(pins::PROXIMITY_EMIT, look.lit);
}

#[inline(always)]
pub(super) fn write_pin(signal: Signal, high: bool) {
    let port: Port = port(signal);
    if high {
        port.set(mask(signal));
    } else {
        port.clear(mask(signal));
    }
}

/// Starts the converter. The scanner goes to the tick.
#[must_use]
pub fn take(adc: Adc) -> (Scanner, Channels) {
    let (scanner, results) = adc.start(TIMING);
    let sweep = Sweep::new();
    select_channel(sweep.look());
    // Given once, because `Peripherals` gives the converter once.
    HANDLER.hand_over(Scanning { results, sweep }).ok();
    interrupt::set_priority(Vector::Adc, Priority::Level3, SubPriority::Sub0).ok();
    Source::Adc.enable();
    (scanner, SCANNED)
}

/// Newest count of an analog signal, 0..=1023.
#[must_use]
pub fn count(signal: Signal) -> u16 {
    let channel = usize::from(signal.analog.unwrap_or_default());
    COUNTS
        .get(channel)
        .map_or(0, |count| count.load(Ordering::Relaxed))
}

/// Newest counts of all channels; 0 for those that are not scanned.
#[must_use]
pub fn counts() -> [u16; CHANNELS] {
    whole(|| {
        core::array::from_fn(|channel| {
            COUNTS
                .get(channel)
                .map_or(0, |count| count.load(Ordering::Relaxed))
        })
    })
}

/// Runs a function between two scans, so that all its readings belong to the same scan.
pub fn whole<R>(function: impl FnOnce() -> R) -> R {
    cpu::with_level(Priority::Level3, function)
}

/// Number of scans since the start, wrapping.
#[must_use]
pub fn scans() -> u32 {
    SCANS.load(Ordering::Relaxed)
}

/// Milliseconds since the newest scan ended, or `None` before the first.
#[must_use]
pub fn age_ms() -> Option<u32> {
    (scans() != 0).then(|| tick::ticks().wrapping_sub(SCANNED_AT.load(Ordering::Relaxed)))
}

/// Newest pair of a proximity sensor: dark and lit.
#[must_use]
pub fn proximity(sensor: usize) -> (u16, u16) {
    let of = |readings: &[AtomicU16; SENSORS]| {
        readings
            .get(sensor)
            .map_or(0, |count| count.load(Ordering::Relaxed))
    };
    (of(&DARK), of(&LIT))
}

/// Requests the front emitter.
pub(super) fn ask_for_emitter() {
    EMITTER.store(ASKED, Ordering::Relaxed);
}

/// Whether the front emitter was lent.
pub(super) fn emitter_is_lent() -> bool {
    EMITTER.load(Ordering::Relaxed) == LENT
}

/// Returns the emitters to the sweep, dark.
pub(super) fn return_emitter() {
    write_pin(pins::PROXIMITY_EMIT, false);
    EMITTER.store(Emitter::Sweeping as u32, Ordering::Relaxed);
}
