//! The two test access ports that share the wires: the chip's own, and that of the core's probe.

use super::catch_up;
use super::fault::{PortFaults, PortViolation};
use super::tap_state::TapState;
use crate::cpu::ProbeAccess;
use crate::machine::Machine;

/// How long the erasure of the whole chip takes here; 80 to 400 ms are said to be usual.
pub const CHIP_ERASE_MS: u64 = 200;
const CYCLES_PER_MS: u64 = 80_000;
/// The window through which words go fast.
const FAST_WINDOW: std::ops::Range<u32> = 0xFF20_0000..0xFF20_0010;

// Instructions, five bits.
const IDCODE: u8 = 0x01;
const IMPCODE: u8 = 0x03;
const SWITCH_TO_CHIP: u8 = 0x04;
const SWITCH_TO_PROBE: u8 = 0x05;
const COMMAND: u8 = 0x07;
const ADDRESS: u8 = 0x08;
const DATA: u8 = 0x09;
const CONTROL: u8 = 0x0A;
const PROBE_BOOT: u8 = 0x0C;
const NORMAL_BOOT: u8 = 0x0D;
const FAST_DATA: u8 = 0x0E;

// CONTROL.
const RESET_OCCURRED: u32 = 1 << 31;
const IS_STORE: u32 = 1 << 19;
const IS_PENDING: u32 = 1 << 18;
const PROBE_ENABLED: u32 = 1 << 15;
const PROBE_TRAP: u32 = 1 << 14;
const DEBUG_MODE: u32 = 1 << 3;
/// What the core implements: 32 bits, debug mode of release 2.5, no memory access past the core. Not read from a chip.
const IMPLEMENTATION: u32 = 0x20C0_4000;

/// Which port the wires reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Selected {
    Chip,
    Probe,
}

/// Both ports.
#[derive(Clone, Debug)]
pub(super) struct TestPorts {
    faults: PortFaults,
    state: TapState,
    selected: Selected,
    instruction: u8,
    /// The register that is shifted, and its length.
    shift: (u64, u32),
    is_held: bool,
    is_flash_enabled: bool,
    erases_until: u64,
    is_protected: bool,
    boots_to_probe: bool,
    control: u32,
    data: u32,
    fast_was_pending: bool,
    polls_left: u32,
    violation: Option<PortViolation>,
}

impl TestPorts {
    pub(super) fn new(faults: PortFaults) -> Self {
        Self {
            faults,
            state: TapState::TestLogicReset,
            selected: Selected::Chip,
            instruction: IDCODE,
            shift: (0, 32),
            is_held: true,
            is_flash_enabled: false,
            erases_until: 0,
            is_protected: false,
            boots_to_probe: false,
            control: 0,
            data: 0,
            fast_was_pending: false,
            polls_left: faults.late_polls,
            violation: None,
        }
    }

    /// Programming mode begins: the core is held in reset.
    pub(super) fn enter(&mut self, machine: &mut Machine) {
        *self = Self {
            is_protected: machine.is_code_protected() || self.faults.is_protected,
            erases_until: self.erases_until,
            ..Self::new(self.faults)
        };
        machine.hold_in_reset();
    }

    /// The supply fails: an erasure that lasts leaves anything.
    pub(super) fn cut(&mut self, machine: &mut Machine, cycle: u64, seed: u64) {
        if self.erases_until > cycle {
            let mut random = home::Pcg::new(seed, 0xE5A5);
            let pages = [0x1D00_0000_u32, 0x1FC0_0000, 0x1FC0_2000];
            for page in pages {
                let bytes: Vec<u8> = (0..4096).map(|_| random.next_u32() as u8).collect();
                let written = machine.memory_mut().write(page, &bytes);
                debug_assert!(written.is_ok(), "these are pages of flash");
            }
        }
        self.erases_until = 0;
    }

    pub(super) fn take_violation(&mut self) -> Option<PortViolation> {
        self.violation.take()
    }

    /// One cycle of TCK; gives TDO after it.
    pub(super) fn step(&mut self, (tdi, tms): (bool, bool), cycle: u64, machine: &mut Machine) -> bool {
        match self.state {
            TapState::CaptureData => {
                catch_up(machine, cycle);
                self.capture(cycle, machine);
            }
            // The last two bits of what an instruction scan gives are 01.
            TapState::CaptureInstruction => self.shift = (1, 5),
            TapState::ShiftData | TapState::ShiftInstruction => {
                let (bits, length) = self.shift;
                self.shift.0 = bits >> 1 | u64::from(tdi) << (length - 1);
            }
            _ => {}
        }
        self.state = self.state.next(tms);
        match self.state {
            TapState::TestLogicReset => self.instruction = IDCODE,
            TapState::UpdateInstruction => self.take_instruction(self.shift.0 as u8 & 0x1F),
            TapState::UpdateData => {
                catch_up(machine, cycle);
                self.update(cycle, machine);
            }
            _ => {}
        }
        self.shift.0 & 1 != 0
    }

    fn take_instruction(&mut self, instruction: u8) {
        match instruction {
            SWITCH_TO_CHIP => self.selected = Selected::Chip,
            SWITCH_TO_PROBE => self.selected = Selected::Probe,
            PROBE_BOOT if self.selected == Selected::Probe => self.boots_to_probe = true,
            NORMAL_BOOT if self.selected == Selected::Probe => self.boots_to_probe = false,
            _ => {}
        }
        self.instruction = instruction;
    }

    fn capture(&mut self, cycle: u64, machine: &mut Machine) {
        let word = |value: u32| (u64::from(value), 32);
        self.shift = match (self.selected, self.instruction) {
            (_, IDCODE) => word(self.identity(machine)),
            (Selected::Chip, COMMAND) => (u64::from(self.status(cycle)), 8),
            (Selected::Probe, IMPCODE) => word(IMPLEMENTATION),
            (Selected::Probe, ADDRESS) => word(match machine.probe_access() {
                Some(ProbeAccess::Read { address } | ProbeAccess::Write { address, .. }) => address,
                None => 0,
            }),
            (Selected::Probe, DATA) => word(match machine.probe_access() {
                Some(ProbeAccess::Write { value, .. }) => value,
                _ => self.data,
            }),
            (Selected::Probe, CONTROL) => word(self.control_now(machine)),
            (Selected::Probe, FAST_DATA) => self.capture_fast(machine),
            _ => (0, 1),
        };
    }

    fn identity(&self, machine: &mut Machine) -> u32 {
        let own = machine.peek_register(0x1F80_F220).unwrap_or_default();
        self.faults.device_id.unwrap_or(own)
    }

    fn status(&self, cycle: u64) -> u8 {
        let is_busy = cycle < self.erases_until;
        u8::from(!self.is_protected) << 7
            | u8::from(!is_busy) << 3
            | u8::from(is_busy) << 2
            | u8::from(self.is_flash_enabled) << 1
            | u8::from(self.is_held)
    }

    /// Whether a core whose reset ends begins in debug mode. One that is in it stays there, whatever the probe asks for the next reset.
    fn starts_debugging(&self) -> bool {
        self.boots_to_probe && !self.is_protected
    }

    /// The access that the probe may see: it shows late when that fault is on.
    fn visible_access(&mut self, machine: &Machine) -> Option<ProbeAccess> {
        let access = machine.probe_access()?;
        if self.polls_left > 0 {
            self.polls_left -= 1;
            return None;
        }
        Some(access)
    }

    fn control_now(&mut self, machine: &Machine) -> u32 {
        let pending = match self.visible_access(machine) {
            None => 0,
            Some(ProbeAccess::Read { .. }) => IS_PENDING,
            Some(ProbeAccess::Write { .. }) => IS_PENDING | IS_STORE,
        };
        let is_debugging = !self.is_held && machine.is_debugging();
        let mode = if is_debugging { DEBUG_MODE } else { 0 };
        self.control | pending | mode
    }

    fn capture_fast(&mut self, machine: &Machine) -> (u64, u32) {
        let access = self.visible_access(machine).filter(|access| {
            let (ProbeAccess::Read { address } | ProbeAccess::Write { address, .. }) = access;
            FAST_WINDOW.contains(address)
        });
        self.fast_was_pending = access.is_some();
        let value = match access {
            Some(ProbeAccess::Write { value, .. }) => value,
            _ => 0,
        };
        (u64::from(value) << 1 | u64::from(access.is_some()), 33)
    }

    fn update(&mut self, cycle: u64, machine: &mut Machine) {
        let value = self.shift.0;
        match (self.selected, self.instruction) {
            (Selected::Chip, COMMAND) => self.command(value as u8, cycle, machine),
            (Selected::Probe, DATA) => self.data = value as u32,
            (Selected::Probe, CONTROL) => self.write_control(value as u32, machine),
            (Selected::Probe, FAST_DATA) if value & 1 == 0 && self.fast_was_pending => {
                self.complete((value >> 1) as u32, machine);
            }
            _ => {}
        }
        if !matches!((self.selected, self.instruction), (Selected::Probe, FAST_DATA)) {
            self.fast_was_pending = false;
        }
    }

    fn write_control(&mut self, value: u32, machine: &mut Machine) {
        let enabled = value & (PROBE_ENABLED | PROBE_TRAP);
        self.control = self.control & value & RESET_OCCURRED | enabled;
        if value & IS_PENDING == 0 {
            if machine.probe_access().is_some() && self.polls_left == 0 {
                self.complete(self.data, machine);
            } else {
                self.violation = Some(PortViolation::NothingPending);
            }
        }
    }

    fn complete(&mut self, word: u32, machine: &mut Machine) {
        if !self.is_flash_enabled {
            self.violation = Some(PortViolation::FlashNotEnabled);
        }
        self.polls_left = self.faults.late_polls;
        machine.complete_probe_access(word);
    }

    fn command(&mut self, command: u8, cycle: u64, machine: &mut Machine) {
        match command {
            // The status, and reading the configuration again.
            0x00 | 0xFF => {}
            0xD1 => {
                self.is_held = true;
                machine.hold_in_reset();
            }
            0xD0 if self.is_held => {
                self.is_held = false;
                self.control |= RESET_OCCURRED;
                match self.starts_debugging() {
                    true => machine.release_to_probe(),
                    false => machine.release_reset(),
                }
            }
            0xD0 => {}
            0xFC => {
                machine.erase_chip();
                machine.hold_in_reset();
                self.is_held = true;
                self.is_protected = self.faults.is_protected;
                self.erases_until = cycle + CHIP_ERASE_MS * CYCLES_PER_MS;
            }
            0xFE => self.is_flash_enabled = true,
            0xFD => self.is_flash_enabled = false,
            other => self.violation = Some(PortViolation::UnknownCommand(other)),
        }
    }
}
