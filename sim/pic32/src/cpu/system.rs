//! Coprocessor 0: the registers that control the core.

use super::InterruptRequest;
use super::exception::InstructionFault;

// Status.
pub(super) const STATUS_IE: u32 = 1;
pub(super) const STATUS_EXL: u32 = 1 << 1;
pub(super) const STATUS_ERL: u32 = 1 << 2;
const STATUS_UM: u32 = 1 << 4;
const STATUS_IPL_SHIFT: u32 = 10;
const STATUS_NMI: u32 = 1 << 19;
const STATUS_SR: u32 = 1 << 20;
const STATUS_BEV: u32 = 1 << 22;
const STATUS_RE: u32 = 1 << 25;
const STATUS_RP: u32 = 1 << 27;
const STATUS_CU0: u32 = 1 << 28;
const STATUS_WRITABLE: u32 = STATUS_IE
    | STATUS_EXL
    | STATUS_ERL
    | STATUS_UM
    | 0x3F << STATUS_IPL_SHIFT
    | STATUS_BEV
    | STATUS_RE
    | STATUS_RP
    | STATUS_CU0;

// Cause. The software interrupt bits are those of the architecture.
const CAUSE_CODE_SHIFT: u32 = 2;
const CAUSE_SOFTWARE: u32 = 3 << 8;
const CAUSE_LEVEL_SHIFT: u32 = 10;
const CAUSE_IV: u32 = 1 << 23;
const CAUSE_DC: u32 = 1 << 27;
const CAUSE_UNIT_SHIFT: u32 = 28;
const CAUSE_TI: u32 = 1 << 30;
const CAUSE_BD: u32 = 1 << 31;
const CAUSE_WRITABLE: u32 = CAUSE_SOFTWARE | CAUSE_IV | CAUSE_DC;
/// Bits that the next exception writes.
const CAUSE_EXCEPTION: u32 = 0x1F << CAUSE_CODE_SHIFT | 3 << CAUSE_UNIT_SHIFT;

const INTCTL_SPACING: u32 = 0x1F << 5;
/// One register set beyond the first (HSS = 1).
const SRSCTL_HIGHEST: u32 = 1 << 26;
const SRSCTL_EXTERNAL_SHIFT: u32 = 18;
const SRSCTL_EXCEPTION_SHIFT: u32 = 12;
const SRSCTL_PREVIOUS_SHIFT: u32 = 6;
const SET: u32 = 0xF;
const EBASE_WRITABLE: u32 = 0x3FFF_F000;
const EBASE_FIXED: u32 = 0x8000_0000;

/// PRId as the QEMU model of an M4K has it; not read from a chip.
const PRID: u32 = 0x0001_8765;
/// Config without K0: little endian, release 2, fixed mapping, more registers follow. Composed from the architecture's
/// fields; not read from a chip.
const CONFIG: u32 = 0xA421_0580;
const CONFIG_CACHEABILITY: u32 = 7;
const CONFIG_UNCACHED: u32 = 2;
/// Config1: MIPS16e and debug support are there on the chip; Config2 follows.
const CONFIG1: u32 = 0x8000_0006;
/// Config2: Config3 follows.
const CONFIG2: u32 = 0x8000_0000;
/// Config3: vectored interrupts and an external interrupt controller.
const CONFIG3: u32 = 0x0000_0060;

const DEBUG_DM: u32 = 1 << 30;
const DEBUG_DBP: u32 = 1 << 1;
const DEBUG_DBD: u32 = 1 << 31;

/// Where exceptions go while Status.BEV is set.
const BOOT_VECTORS: u32 = 0xBFC0_0200;
const GENERAL_OFFSET: u32 = 0x180;
const INTERRUPT_OFFSET: u32 = 0x200;

/// A write to the system registers with effects elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coprocessor0Write {
    /// Nothing more to do.
    Plain,
    /// Count was set.
    Count(u32),
    /// Compare was set.
    Compare(u32),
    /// Cause.DC may have changed.
    Cause,
}

/// The registers of coprocessor 0, except Count and Compare.
#[derive(Clone, Debug)]
pub(super) struct Coprocessor0 {
    status: u32,
    cause: u32,
    epc: u32,
    error_epc: u32,
    bad_address: u32,
    exception_base: u32,
    interrupt_control: u32,
    shadow_control: u32,
    shadow_map: u32,
    cacheability: u32,
    hardware_enable: u32,
    debug: u32,
    debug_epc: u32,
    debug_save: u32,
}

impl Coprocessor0 {
    pub(super) const fn new() -> Self {
        Self {
            status: STATUS_BEV | STATUS_ERL,
            cause: 0,
            epc: 0,
            error_epc: 0,
            bad_address: 0,
            exception_base: EBASE_FIXED,
            interrupt_control: 0,
            shadow_control: SRSCTL_HIGHEST,
            shadow_map: 0,
            cacheability: CONFIG_UNCACHED,
            hardware_enable: 0,
            debug: 0,
            debug_epc: 0,
            debug_save: 0,
        }
    }

    /// A reset at the instruction `address`; `is_nmi` when it is a non-maskable interrupt.
    pub(super) fn reset(&mut self, address: u32, is_nmi: bool) {
        let before = self.clone();
        if !is_nmi {
            *self = Self::new();
        }
        self.status = (self.status | STATUS_BEV | STATUS_ERL) & !(STATUS_SR | STATUS_NMI);
        if is_nmi {
            self.status |= STATUS_NMI;
        }
        self.error_epc = address;
        // A reset leaves these as they were.
        self.epc = before.epc;
        self.bad_address = before.bad_address;
    }

    pub(super) fn read(&self, register: u8, select: u8) -> u32 {
        match (register, select) {
            (7, 0) => self.hardware_enable,
            (8, 0) => self.bad_address,
            (12, 0) => self.status,
            (12, 1) => self.interrupt_control,
            (12, 2) => self.shadow_control,
            (12, 3) => self.shadow_map,
            (13, 0) => self.cause,
            (14, 0) => self.epc,
            (15, 0) => PRID,
            (15, 1) => self.exception_base,
            (16, 0) => CONFIG | self.cacheability,
            (16, 1) => CONFIG1,
            (16, 2) => CONFIG2,
            (16, 3) => CONFIG3,
            (23, 0) => self.debug,
            (24, 0) => self.debug_epc,
            (30, 0) => self.error_epc,
            (31, 0) => self.debug_save,
            _ => 0,
        }
    }

    pub(super) fn write(&mut self, register: u8, select: u8, value: u32) -> Coprocessor0Write {
        match (register, select) {
            (7, 0) => self.hardware_enable = value & 0xF,
            (9, 0) => return Coprocessor0Write::Count(value),
            (11, 0) => {
                self.cause &= !CAUSE_TI;
                return Coprocessor0Write::Compare(value);
            }
            (12, 0) => self.write_status(value),
            (12, 1) => self.interrupt_control = value & INTCTL_SPACING,
            (12, 2) => self.write_shadow_control(value),
            (12, 3) => self.shadow_map = value,
            (13, 0) => {
                self.cause = self.cause & !CAUSE_WRITABLE | value & CAUSE_WRITABLE;
                return Coprocessor0Write::Cause;
            }
            (14, 0) => self.epc = value,
            (15, 1) => self.exception_base = EBASE_FIXED | value & EBASE_WRITABLE,
            (16, 0) => self.cacheability = value & CONFIG_CACHEABILITY,
            (24, 0) => self.debug_epc = value,
            (30, 0) => self.error_epc = value,
            (31, 0) => self.debug_save = value,
            _ => {}
        }
        Coprocessor0Write::Plain
    }

    fn write_status(&mut self, value: u32) {
        // Software can clear NMI and SR but not set them.
        let sticky = self.status & value & (STATUS_NMI | STATUS_SR);
        self.status = value & STATUS_WRITABLE | sticky;
    }

    fn write_shadow_control(&mut self, value: u32) {
        let writable = SET << SRSCTL_EXCEPTION_SHIFT | SET << SRSCTL_PREVIOUS_SHIFT;
        // A set that does not exist cannot be named.
        let value = value & (1 << SRSCTL_EXCEPTION_SHIFT | 1 << SRSCTL_PREVIOUS_SHIFT);
        self.shadow_control = self.shadow_control & !writable | value;
    }

    /// Sets or clears Status.IE (`di`, `ei`) and gives Status as it was before.
    pub(super) fn set_interrupts(&mut self, enabled: bool) -> u32 {
        let before = self.status;
        self.status = if enabled {
            before | STATUS_IE
        } else {
            before & !STATUS_IE
        };
        before
    }

    /// Whether Status.ERL is set: the lower half of the address space is then physical memory.
    pub(super) const fn is_error_level(&self) -> bool {
        self.status & STATUS_ERL != 0
    }

    /// Whether the core is in user mode.
    pub(super) const fn is_user(&self) -> bool {
        self.status & (STATUS_UM | STATUS_EXL | STATUS_ERL) == STATUS_UM && self.debug & DEBUG_DM == 0
    }

    /// Whether Count stands still.
    pub(super) const fn is_count_stopped(&self) -> bool {
        self.cause & CAUSE_DC != 0
    }

    /// Count has become equal to Compare.
    pub(super) fn set_timer_pending(&mut self) {
        self.cause |= CAUSE_TI;
    }

    pub(super) const fn is_timer_pending(&self) -> bool {
        self.cause & CAUSE_TI != 0
    }

    /// Cause.IP1 and IP0, which go to the interrupt controller as core software interrupts 1 and 0.
    pub(super) const fn software_requests(&self) -> u8 {
        (self.cause >> 8 & 3) as u8
    }

    /// Whether a request is above the current priority level.
    pub(super) fn is_above_level(&self, request: InterruptRequest) -> bool {
        u32::from(request.level) > self.status >> STATUS_IPL_SHIFT & 0x3F
    }

    /// Whether interrupts are taken at all.
    pub(super) const fn accepts_interrupts(&self) -> bool {
        self.status & (STATUS_IE | STATUS_EXL | STATUS_ERL) == STATUS_IE && self.debug & DEBUG_DM == 0
    }

    /// The register set in use, 0 or 1.
    pub(super) const fn current_set(&self) -> u32 {
        self.shadow_control & SET
    }

    /// The set that was in use before the last exception, which `rdpgpr` and `wrpgpr` reach.
    pub(super) const fn previous_set(&self) -> u32 {
        self.shadow_control >> SRSCTL_PREVIOUS_SHIFT & SET
    }

    /// The address that a failed access named.
    pub(super) fn set_bad_address(&mut self, address: u32) {
        self.bad_address = address;
    }

    /// Enters an exception at the instruction `address` and gives the vector's address.
    pub(super) fn enter(&mut self, fault: InstructionFault, address: u32, in_slot: bool) -> u32 {
        let set = self.shadow_control >> SRSCTL_EXCEPTION_SHIFT & SET;
        self.enter_level(address, in_slot, set);
        self.set_cause(fault.code as u32, u32::from(fault.unit));
        self.vector_base() + GENERAL_OFFSET
    }

    /// Enters an interrupt before the instruction `address` and gives the vector's address.
    pub(super) fn enter_interrupt(&mut self, request: InterruptRequest, address: u32, in_slot: bool) -> u32 {
        let set = u32::from(request.shadow_set) & 1;
        self.shadow_control =
            self.shadow_control & !(SET << SRSCTL_EXTERNAL_SHIFT) | set << SRSCTL_EXTERNAL_SHIFT;
        self.enter_level(address, in_slot, set);
        self.set_cause(0, 0);
        let level = u32::from(request.level) << CAUSE_LEVEL_SHIFT;
        self.cause = self.cause & !(0x3F << CAUSE_LEVEL_SHIFT) | level;
        if self.cause & CAUSE_IV == 0 {
            return self.vector_base() + GENERAL_OFFSET;
        }
        let vector = match self.status & STATUS_BEV {
            0 => u32::from(request.vector),
            _ => 0,
        };
        // Spacing counts in units of 32 bytes and stands at bit 5.
        self.vector_base() + INTERRUPT_OFFSET + vector * self.interrupt_control
    }

    fn enter_level(&mut self, address: u32, in_slot: bool, set: u32) {
        if self.status & STATUS_EXL != 0 {
            return;
        }
        self.status |= STATUS_EXL;
        self.cause &= !CAUSE_BD;
        self.epc = address;
        if in_slot {
            self.cause |= CAUSE_BD;
            self.epc = address.wrapping_sub(4);
        }
        if self.status & STATUS_BEV == 0 {
            let current = self.current_set();
            let others = self.shadow_control & !(SET << SRSCTL_PREVIOUS_SHIFT | SET);
            self.shadow_control = others | current << SRSCTL_PREVIOUS_SHIFT | set;
        }
    }

    fn set_cause(&mut self, code: u32, unit: u32) {
        let fields = code << CAUSE_CODE_SHIFT | unit << CAUSE_UNIT_SHIFT;
        self.cause = self.cause & !CAUSE_EXCEPTION | fields;
    }

    fn vector_base(&self) -> u32 {
        match self.status & STATUS_BEV {
            0 => self.exception_base,
            _ => BOOT_VECTORS,
        }
    }

    /// Leaves an exception or an error level; gives the address to go on at.
    pub(super) fn leave(&mut self) -> u32 {
        if self.is_error_level() {
            self.status &= !STATUS_ERL;
            return self.error_epc;
        }
        self.status &= !STATUS_EXL;
        if self.status & STATUS_BEV == 0 {
            self.shadow_control = self.shadow_control & !SET | self.previous_set();
        }
        self.epc
    }

    /// Enters debug mode for `sdbbp` and gives the vector's address.
    pub(super) fn enter_debug(&mut self, address: u32, in_slot: bool) -> u32 {
        self.debug = DEBUG_DM | DEBUG_DBP;
        self.debug_epc = address;
        if in_slot {
            self.debug |= DEBUG_DBD;
            self.debug_epc = address.wrapping_sub(4);
        }
        BOOT_VECTORS + 0x280
    }

    /// Whether the core is in debug mode.
    pub(super) fn is_debugging(&self) -> bool {
        self.debug & DEBUG_DM != 0
    }

    /// Leaves debug mode; gives the address to go on at, or nothing outside of debug mode.
    pub(super) fn leave_debug(&mut self) -> Option<u32> {
        if !self.is_debugging() {
            return None;
        }
        self.debug = 0;
        Some(self.debug_epc)
    }
}
