//! What instructions do to registers and external memory.

use super::register::{
    AUXR, IE, IP, IPH, ISP_CONTR, ISP_DATA, P0, P1, P2, P3, P4, PCON, RCAP2H, RCAP2L, SADDR, SADEN, SBUF,
    SCON, T2CON, T2MOD, TCON, TH0, TH1, TH2, TL0, TL1, TL2, TMOD, WDT_CONTR, XICON,
};
use super::timer2::T2OE;
use super::{Chip, Misuse, TRANSMIT_PIN, XRAM_BYTES};
use crate::cpu::{Bus, CoreFault, External};
use crate::peripheral::record::MisuseRecord;
use crate::peripheral::serial::{LineFrame, SentFrame};
use crate::pins::{Edge, Level, Levels, Pin};

/// AUXR: MOVX goes out of the chip.
const EXTRAM: u8 = 0x02;
/// AUXR: the bits that exist, EXTRAM and ALEOFF.
const AUXR_BITS: u8 = 0x03;
/// IE, IP: bits that exist.
const IE_BITS: u8 = 0xBF;
const IP_BITS: u8 = 0x3F;

/// The number of the port at an address.
const fn port_at(address: u8) -> Option<usize> {
    Some(match address {
        P0 => 0,
        P1 => 1,
        P2 => 2,
        P3 => 3,
        P4 => 4,
        _ => return None,
    })
}

impl Bus for Chip {
    #[inline]
    fn read(&mut self, address: u8, cycle: u64) -> u8 {
        self.settle(cycle);
        match port_at(address) {
            Some(port) => self.ports.level(port),
            None => self.read_register(address, cycle),
        }
    }

    #[inline]
    fn read_latch(&mut self, address: u8, cycle: u64) -> u8 {
        match port_at(address) {
            Some(port) => self.ports.latch(port),
            None => self.read(address, cycle),
        }
    }

    #[inline]
    fn write(&mut self, address: u8, value: u8, cycle: u64) {
        self.settle(cycle);
        match port_at(address) {
            Some(port) => self.write_port(port, value, cycle),
            None => self.write_register(address, value, cycle),
        }
    }

    #[inline]
    fn read_external(&mut self, place: External, cycle: u64) -> u8 {
        match self.on_chip(place) {
            Some(byte) => *byte,
            None => {
                self.misuse(Misuse::ExternalBus(place), cycle);
                0xFF
            }
        }
    }

    #[inline]
    fn write_external(&mut self, place: External, value: u8, cycle: u64) {
        match self.on_chip(place) {
            Some(byte) => *byte = value,
            None => self.misuse(Misuse::ExternalBus(place), cycle),
        }
    }

    fn end_interrupt(&mut self) {
        self.interrupts.end();
        self.returned = true;
        self.horizon = 0;
    }

    fn note(&mut self, fault: CoreFault, cycle: u64) {
        self.misuse(Misuse::Core(fault), cycle);
    }

    #[inline]
    fn horizon(&self) -> u64 {
        self.horizon
    }
}

impl Chip {
    /// The byte of memory on the chip. R0 and R1 reach its first 256 bytes, whatever P2 holds: so it is documented for the
    /// family this part descends from. uCsim takes the upper half of the address from P2.
    fn on_chip(&mut self, place: External) -> Option<&mut u8> {
        let address = match place {
            External::Long(address) => usize::from(address),
            External::Short(address) => usize::from(address),
        };
        if self.auxr & EXTRAM != 0 {
            return None;
        }
        self.xram.get_mut(address)
    }

    fn misuse(&mut self, misuse: Misuse, cycle: u64) {
        self.record.note(misuse, cycle);
        if self.record.is_unplaced() {
            self.horizon = 0;
        }
    }

    fn write_port(&mut self, port: usize, value: u8, cycle: u64) {
        let before = self.ports.levels();
        self.ports.write(port, value, cycle);
        // The wheels' and lamps' ports have no pin that a peripheral listens to.
        if before != self.ports.levels() {
            self.notice_levels(before, cycle);
            self.plan(cycle);
        }
    }

    fn read_register(&mut self, address: u8, cycle: u64) -> u8 {
        self.advance(cycle);
        let pcon = self.power.pcon();
        match address {
            TCON => self.timers.control() | self.externals[1].control() << 2 | self.externals[0].control(),
            TMOD => self.timers.modes(),
            TL0 => self.timers.timer(0).low,
            TL1 => self.timers.timer(1).low,
            TH0 => self.timers.timer(0).high,
            TH1 => self.timers.timer(1).high,
            T2CON => self.timer2.control(),
            T2MOD => self.timer2.mode(),
            RCAP2L => self.timer2.reload[0],
            RCAP2H => self.timer2.reload[1],
            TL2 => self.timer2.count[0],
            TH2 => self.timer2.count[1],
            SCON => self.serial.control(pcon),
            SBUF => self.serial.buffer(),
            SADDR => self.serial.address,
            SADEN => self.serial.address_mask,
            PCON => pcon,
            AUXR => self.auxr,
            IE => self.interrupts.enables,
            IP => self.interrupts.priority_low,
            IPH => self.interrupts.priority_high,
            XICON => {
                let inputs = self.externals[3].control() << 4 | self.externals[2].control();
                self.interrupts.extra() | inputs
            }
            WDT_CONTR => self.watchdog.control(),
            ISP_DATA..=ISP_CONTR => self.flash.read(address),
            _ => {
                self.misuse(Misuse::UnknownRegister(address), cycle);
                0
            }
        }
    }

    fn write_register(&mut self, address: u8, value: u8, cycle: u64) {
        self.advance(cycle);
        match address {
            TCON | TMOD | TL0 | TL1 | TH0 | TH1 => self.write_timers(address, value),
            T2CON | T2MOD | RCAP2L | RCAP2H | TL2 | TH2 => self.write_timer2(address, value, cycle),
            SCON | SBUF | SADDR | SADEN => self.write_serial(address, value, cycle),
            PCON => self.write_power(value, cycle),
            AUXR => self.auxr = value & AUXR_BITS,
            IE | IP | IPH | XICON => self.write_interrupts(address, value),
            WDT_CONTR => self.watchdog.set_control(value, cycle),
            ISP_DATA..=ISP_CONTR => {
                let order = self.flash.write(address, value);
                self.obey(order, cycle);
            }
            _ => self.misuse(Misuse::UnknownRegister(address), cycle),
        }
        self.clock_serial(cycle);
        self.plan(cycle);
    }

    fn write_timers(&mut self, address: u8, value: u8) {
        match address {
            TCON => {
                self.timers.set_control(value);
                self.externals[0].set_control(value);
                self.externals[1].set_control(value >> 2);
            }
            TMOD => self.timers.set_modes(value),
            TL0 => self.timers.timer_mut(0).low = value,
            TL1 => self.timers.timer_mut(1).low = value,
            TH0 => self.timers.timer_mut(0).high = value,
            _ => self.timers.timer_mut(1).high = value,
        }
    }

    fn write_timer2(&mut self, address: u8, value: u8, cycle: u64) {
        match address {
            T2CON => self.timer2.set_control(value),
            T2MOD => {
                self.timer2.set_mode(value);
                if value & T2OE != 0 {
                    self.misuse(Misuse::ClockOutput, cycle);
                }
            }
            RCAP2L => self.timer2.reload[0] = value,
            RCAP2H => self.timer2.reload[1] = value,
            TL2 => self.timer2.count[0] = value,
            _ => self.timer2.count[1] = value,
        }
    }

    fn write_serial(&mut self, address: u8, value: u8, cycle: u64) {
        match address {
            SCON => self.serial.set_control(value, self.power.pcon(), cycle),
            SBUF => {
                let line_is_free = self.ports.latches().level(TRANSMIT_PIN).is_high();
                if self.serial.send(value, line_is_free, cycle) {
                    self.misuse(Misuse::SentTooEarly, cycle);
                }
            }
            SADDR => self.serial.address = value,
            _ => self.serial.address_mask = value,
        }
    }

    fn write_power(&mut self, value: u8, cycle: u64) {
        self.power.set_pcon(value);
        if self.power.is_down() {
            self.watchdog.stop(cycle);
            self.serial.reset_line();
        } else if self.power.is_asleep() {
            self.watchdog.idle(cycle);
        }
    }

    fn write_interrupts(&mut self, address: u8, value: u8) {
        match address {
            IE => self.interrupts.enables = value & IE_BITS,
            IP => self.interrupts.priority_low = value & IP_BITS,
            IPH => self.interrupts.priority_high = value,
            _ => {
                self.interrupts.set_extra(value);
                self.externals[2].set_control(value);
                self.externals[3].set_control(value >> 4);
            }
        }
        self.interrupts.hold();
    }

    /// What a register holds, without recording anything.
    pub(crate) fn peek(&self, address: u8, cycle: u64) -> u8 {
        let mut chip = self.clone();
        chip.settle(cycle);
        chip.read_latch(address, cycle)
    }

    /// External memory on the chip.
    pub(crate) fn xram(&self) -> &[u8] {
        &self.xram
    }

    /// The same, to begin with contents of one's own; it stays as long as it is.
    pub(crate) fn xram_mut(&mut self) -> &mut [u8] {
        debug_assert_eq!(self.xram.len(), XRAM_BYTES, "nothing resizes it");
        &mut self.xram
    }

    /// Data flash.
    pub(crate) fn data_flash(&self) -> &[u8] {
        self.flash.bytes()
    }

    /// What the chip does to its pins.
    pub(crate) fn latches(&self) -> Levels {
        self.ports.latches()
    }

    /// What a voltmeter would see.
    pub(crate) fn levels(&self) -> Levels {
        self.ports.levels()
    }

    /// The level of a pin.
    pub(crate) fn level(&self, pin: Pin) -> Level {
        self.ports.levels().level(pin)
    }

    /// Edges of a latch are kept from now on.
    pub(crate) fn watch(&mut self, pin: Pin) {
        self.ports.watch(pin);
    }

    /// Edges since the last call.
    pub(crate) fn take_edges(&mut self) -> Vec<Edge> {
        self.ports.take_edges()
    }

    /// A frame comes along the line.
    pub(crate) fn hear(&mut self, frame: LineFrame) {
        self.serial.hear(frame);
        let next = self.serial.next();
        self.next = self.next.min(next);
        self.horizon = self.horizon.min(next);
    }

    /// What was sent since the last call.
    pub(crate) fn take_sent(&mut self) -> Vec<SentFrame> {
        self.serial.take_sent()
    }

    /// Ticks of a bit as the receiver counts them.
    pub(crate) fn receive_bit(&self) -> Option<u64> {
        self.serial.receive_bit()
    }

    /// Bytes lost because RI was still set, and frames lost because nothing listened.
    pub(crate) fn lost(&self) -> [u64; 2] {
        [self.serial.overruns(), self.serial.unheard()]
    }

    /// Misuse so far.
    pub(crate) fn misuses(&self) -> &[MisuseRecord] {
        self.record.all()
    }
}
