//! The real-time clock and calendar, with its alarm. It runs from the 32.768 kHz oscillator, in Sleep too; a reset leaves it alone.
//!
//! Half seconds are counted; the registers hold decimal digits. Writing the time begins a second anew.

use super::rate::{CYCLES_PER_S, NEVER};

const ON: u32 = 1 << 15;
const RUNS: u32 = 1 << 6;
const WRITE_ENABLED: u32 = 1 << 3;
const NEAR_ROLLOVER: u32 = 1 << 2;
const SECOND_HALF: u32 = 1 << 1;
/// CAL, SIDL, RTSECSEL and RTCOE besides ON.
const CONTROL_KEPT: u32 = 0x03FF_A081;
const CALIBRATION_SHIFT: u32 = 16;

const ALARM_ON: u32 = 1 << 15;
const CHIME: u32 = 1 << 14;
const ALARM_SYNC: u32 = 1 << 12;
const MASK_SHIFT: u32 = 8;
const REPEATS: u32 = 0xFF;
const ALARM_KEPT: u32 = 0xEFFF;

const TIME_KEPT: u32 = 0x3F7F_7F00;
const DATE_KEPT: u32 = 0xFF1F_3F07;
const ALARM_DATE_KEPT: u32 = 0x001F_3F07;

const HALF_SECOND: u64 = CYCLES_PER_S / 2;
/// Clocks of the oscillator in a second; what RTCSYNC warns of comes within 32 of them.
const CLOCKS_PER_S: u64 = 32_768;
const SYNC_CYCLES: u64 = 32 * CYCLES_PER_S / CLOCKS_PER_S;

/// What a write was wrong about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CalendarWrite {
    Fine,
    /// It needs RTCWREN, or the lock to be open; it is lost.
    Locked,
}

/// The registers, and when the next half second begins.
#[derive(Clone, Debug)]
pub(crate) struct Calendar {
    control: u32,
    alarm: u32,
    time: u32,
    date: u32,
    alarm_time: u32,
    alarm_date: u32,
    write_enabled: bool,
    second_half: bool,
    has_clock: bool,
    due: u64,
}

impl Calendar {
    /// Digits are undefined after power-on; here they are those of a Saturday, 2000-01-01.
    pub(crate) fn new() -> Calendar {
        Calendar {
            control: 0,
            alarm: 0,
            time: 0,
            date: 0x0001_0106,
            alarm_time: 0,
            alarm_date: 0,
            write_enabled: false,
            second_half: false,
            has_clock: false,
            due: NEVER,
        }
    }

    /// A reset closes the lock and nothing else.
    pub(crate) fn reset(&mut self) {
        self.write_enabled = false;
    }

    fn runs(&self) -> bool {
        self.has_clock && self.control & ON != 0
    }

    /// Whether the oscillator swings from now on.
    pub(crate) fn set_clock(&mut self, has_clock: bool, cycle: u64) {
        if has_clock != self.has_clock {
            self.has_clock = has_clock;
            self.begin_second(cycle);
        }
    }

    fn begin_second(&mut self, cycle: u64) {
        self.second_half = false;
        self.due = if self.runs() { cycle + HALF_SECOND } else { NEVER };
    }

    pub(crate) fn next_event(&self) -> u64 {
        self.due
    }

    /// A half second is over; `true` when the alarm asks for an interrupt.
    pub(crate) fn tick(&mut self, cycle: u64) -> bool {
        self.second_half = !self.second_half;
        let mut length = HALF_SECOND;
        if !self.second_half {
            self.advance();
            if self.time >> 8 & 0xFF == 0 {
                length = self.calibrated(length);
            }
        }
        self.due = cycle + length;
        self.is_alarm_due() && self.ring()
    }

    /// Once a minute the wanted number of clocks is added, which ends a half second sooner, or later.
    fn calibrated(&self, length: u64) -> u64 {
        let field = self.control >> CALIBRATION_SHIFT & 0x3FF;
        let clocks = i64::from(field) - if field >= 0x200 { 0x400 } else { 0 };
        length.saturating_add_signed(-clocks * (CYCLES_PER_S as i64) / CLOCKS_PER_S as i64)
    }

    /// The next second, minute, hour, day, month and year, as far as each is over.
    fn advance(&mut self) {
        let (second, carry) = after(self.time >> 8, 0x59, 0);
        let (minute, carry) = if carry {
            after(self.time >> 16, 0x59, 0)
        } else {
            (self.time >> 16 & 0xFF, false)
        };
        let (hour, is_over) = if carry {
            after(self.time >> 24, 0x23, 0)
        } else {
            (self.time >> 24, false)
        };
        self.time = hour << 24 | minute << 16 | second << 8;
        if is_over {
            self.advance_day();
        }
    }

    fn advance_day(&mut self) {
        let (year, month) = (self.date >> 24, self.date >> 16 & 0xFF);
        let weekday = (self.date & 7) % 7;
        let (day, is_over) = after(self.date >> 8, last_day(month, year), 1);
        let (month, is_over) = if is_over {
            after(month, 0x12, 1)
        } else {
            (month, false)
        };
        let (year, _) = if is_over {
            after(year, 0x99, 0)
        } else {
            (year, false)
        };
        self.date = year << 24 | month << 16 | day << 8 | ((weekday + 1) % 7);
    }

    fn is_alarm_due(&self) -> bool {
        if self.alarm & ALARM_ON == 0 {
            return false;
        }
        let mask = self.alarm >> MASK_SHIFT & 15;
        // From the half second on, each mask compares more digits.
        let time = match mask {
            0 | 1 => 0,
            2 => 0x0000_0F00,
            3 => 0x0000_7F00,
            4 => 0x000F_7F00,
            5 => 0x007F_7F00,
            _ => 0x3F7F_7F00,
        };
        let date = match mask {
            ..=6 => 0,
            7 => 0x0000_0007,
            8 => 0x0000_3F00,
            _ => 0x001F_3F00,
        };
        (mask == 0 || !self.second_half)
            && mask < 10
            && (self.time ^ self.alarm_time) & time == 0
            && (self.date ^ self.alarm_date) & date == 0
    }

    /// The alarm goes off, and is over after its repeats.
    fn ring(&mut self) -> bool {
        let repeats = self.alarm & REPEATS;
        if repeats == 0 && self.alarm & CHIME == 0 {
            self.alarm &= !ALARM_ON;
        }
        self.alarm = self.alarm & !REPEATS | repeats.wrapping_sub(1) & REPEATS;
        if self.alarm & ALARM_ON == 0 {
            self.alarm &= !REPEATS;
        }
        true
    }

    pub(crate) fn read(&self, word: u8, cycle: u64) -> Option<u32> {
        let flag = |set: bool, mask: u32| if set { mask } else { 0 };
        let near = self.second_half && self.due.saturating_sub(cycle) <= SYNC_CYCLES;
        match word {
            0 => Some(
                self.control
                    | flag(self.runs(), RUNS)
                    | flag(self.write_enabled, WRITE_ENABLED)
                    | flag(near, NEAR_ROLLOVER)
                    | flag(self.second_half, SECOND_HALF),
            ),
            1 => Some(self.alarm | flag(near, ALARM_SYNC)),
            2 => Some(self.time),
            3 => Some(self.date),
            4 => Some(self.alarm_time),
            5 => Some(self.alarm_date),
            _ => None,
        }
    }

    /// Writes a register; the system's lock is open or not.
    pub(crate) fn write(&mut self, word: u8, value: u32, (is_open, cycle): (bool, u64)) -> CalendarWrite {
        match word {
            0 => return self.write_control(value, is_open, cycle),
            1 => self.alarm = value & ALARM_KEPT,
            2 | 3 if !self.write_enabled => return CalendarWrite::Locked,
            2 => {
                self.time = value & TIME_KEPT;
                self.begin_second(cycle);
            }
            3 => self.date = value & DATE_KEPT,
            4 => self.alarm_time = value & TIME_KEPT,
            5 => self.alarm_date = value & ALARM_DATE_KEPT,
            _ => {}
        }
        CalendarWrite::Fine
    }

    fn write_control(&mut self, value: u32, is_open: bool, cycle: u64) -> CalendarWrite {
        let wants = value & WRITE_ENABLED != 0;
        if wants && !self.write_enabled && !is_open {
            return CalendarWrite::Locked;
        }
        let guarded = ON | 0x3FF << CALIBRATION_SHIFT;
        let changed = (self.control ^ value) & guarded;
        let may = self.write_enabled || wants;
        self.write_enabled = wants;
        if changed != 0 && !may {
            return CalendarWrite::Locked;
        }
        self.control = value & CONTROL_KEPT;
        if changed & ON != 0 {
            self.begin_second(cycle);
        }
        CalendarWrite::Fine
    }
}

/// The two decimal digits after these, which lie in the lowest byte, and whether they began anew.
fn after(digits: u32, last: u32, first: u32) -> (u32, bool) {
    let digits = digits & 0xFF;
    match digits {
        _ if digits >= last => (first, true),
        _ if digits & 15 >= 9 => ((digits & 0xF0) + 0x10, false),
        _ => (digits + 1, false),
    }
}

/// The last day of a month, in decimal digits. Each fourth year of this century is a leap year.
fn last_day(month: u32, year: u32) -> u32 {
    let year = 10 * (year >> 4) + (year & 15);
    match month {
        0x02 if year.is_multiple_of(4) => 0x29,
        0x02 => 0x28,
        0x04 | 0x06 | 0x09 | 0x11 => 0x30,
        _ => 0x31,
    }
}
