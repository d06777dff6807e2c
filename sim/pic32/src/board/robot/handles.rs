//! Interface of an emulated robot to the world around it.

use home::{RobotModel, World};
use monitor::Monitor;
use rvac_channel::FaultRates;
use rvac_protocol::message::ResetCause;

use super::EmulatedRobot;
use crate::board::CYCLES_PER_MS;
use crate::board::contacts::{Contact, Hold};
use crate::board::motors::{DriveInterval, MotorOutput};
use crate::board::wiring::Wiring;
use crate::machine::{Machine, ResetSource};
use crate::memory::OutsideMemory;

/// The host and the cable.
impl EmulatedRobot {
    /// Hands bytes to the host's serial driver and returns how many it took.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        self.to_robot.send(bytes)
    }

    /// Bytes that [`Self::send`] would take now.
    #[must_use]
    pub fn line_room(&self) -> usize {
        self.to_robot.room()
    }

    /// A bus has carried these bytes of the link's stream to the chip and from it, in the order of the wire: for the judge.
    pub fn carried_by_bus(
        &mut self,
        heard: impl IntoIterator<Item = u8>,
        said: impl IntoIterator<Item = u8>,
    ) {
        for byte in heard {
            self.monitor.heard(self.now_ms, Some(byte));
            self.digest.byte(byte);
        }
        for byte in said {
            self.monitor.said(self.now_ms, byte);
            self.digest.byte(byte);
        }
    }

    /// Sets how often what goes wrong on the line, both ways.
    pub fn set_line_rates(&mut self, rates: FaultRates) {
        self.to_robot.set_rates(rates);
        self.to_host.set_rates(rates);
    }

    /// Both ways of the line wait for `ms`.
    pub fn hold_line(&mut self, ms: u32) {
        let until = self.cycle() + u64::from(ms) * CYCLES_PER_MS;
        self.to_robot.hold_until(until);
        self.to_host.hold_until(until);
    }

    /// The cable is out for `ms`.
    pub fn cut_line(&mut self, ms: u32) {
        let until = self.cycle() + u64::from(ms) * CYCLES_PER_MS;
        self.to_robot.cut_until(until);
        self.to_host.cut_until(until);
    }

    /// Another sender of this rate takes the wire to the robot for `ms` from this cycle on.
    pub fn flood_line(&mut self, baud: u32, cycle: u64, ms: u32) {
        let until = cycle + u64::from(ms) * CYCLES_PER_MS;
        self.to_robot.flood(baud, (cycle, until));
    }

    /// The host died: what its driver still held is gone.
    pub fn host_died(&mut self) {
        self.to_robot.flush();
    }
}

/// What people and accidents do to the robot.
impl EmulatedRobot {
    /// Resets the microcontroller.
    pub fn reset(&mut self, cause: ResetCause) {
        self.machine.reset(source_of(cause));
        self.notice_resets();
    }

    /// The home around the robot, to lift it, press buttons and break sensors: they act from the next tick on.
    pub const fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The caller instead of the home sets the state of a switch, from this cycle on (one of the past counts as the
    /// next tick's first).
    pub fn hold_contact(&mut self, contact: Contact, hold: Hold, cycle: u64) {
        self.contacts.plan(contact, hold, cycle);
    }

    /// An analog input (0 to 15) reads so many counts from `from` up to but without `until`, whatever its circuit says:
    /// a broken wire, a sensor that sticks, or a drop at a known moment.
    pub fn hold_analog(&mut self, channel: u8, counts: u16, (from, until): (u64, u64)) {
        self.circuit.hold(channel, counts, (from, until));
    }

    /// The transistor of the charging switch conducts for good.
    pub const fn short_charging_switch(&mut self) {
        self.charge_switch_shorted = true;
    }

    /// The crystal stops; the judge knows.
    pub fn stop_crystal(&mut self) {
        self.machine.fail_oscillator();
        self.broken.clock_fails = true;
    }

    /// A bit of the program at this physical address flips; the judge knows.
    ///
    /// # Errors
    /// When the address is not in flash.
    pub fn damage_image(&mut self, address: u32, bit: u8) -> Result<(), OutsideMemory> {
        self.machine.flip_flash_bit(address, bit)?;
        self.broken.image_damaged = true;
        Ok(())
    }

    /// These bits of a register behind the motors' pulses flip; the judge knows.
    pub fn damage_pulses(&mut self, register: u32, mask: u32) {
        let value = self.machine.peek_register(register).unwrap_or_default();
        self.machine.write_register(register, value ^ mask);
        self.broken.pulses_damaged = true;
    }

    /// The chip, to break it and to look into it.
    pub const fn machine_mut(&mut self) -> &mut Machine {
        &mut self.machine
    }

    /// From now on [`Self::drives`] returns to the cycle when each motor was driven.
    pub fn watch_motors(&mut self) {
        self.motors.watch(&mut self.machine);
    }
}

/// What there is to see.
impl EmulatedRobot {
    /// The home around the robot.
    #[must_use]
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }

    /// The chip.
    #[must_use]
    pub const fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Which pin is what.
    #[must_use]
    pub const fn wiring(&self) -> &Wiring {
        &self.wiring
    }

    /// The judge.
    #[must_use]
    pub const fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Simulated milliseconds, the one that has begun included.
    #[must_use]
    pub const fn now_ms(&self) -> u64 {
        self.now_ms
    }

    /// Cycles of the chip since power-on, at the end of the last tick, or of the one that has begun.
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.now_ms * CYCLES_PER_MS
    }

    /// Resets since the robot was switched on.
    #[must_use]
    pub const fn resets(&self) -> u32 {
        self.resets
    }

    /// Whether a wheel was driven in the last millisecond.
    #[must_use]
    pub fn wheels_driven(&self) -> bool {
        [MotorOutput::WheelLeft, MotorOutput::WheelRight]
            .into_iter()
            .any(|motor| self.duty(motor) != 0.0)
    }

    /// Mean duty of a motor in the last millisecond, -1..=1, forward positive.
    #[must_use]
    pub fn duty(&self, motor: MotorOutput) -> f64 {
        self.motors.duty(motor, &self.machine)
    }

    /// When the motor was driven, to the cycle, since [`Self::watch_motors`].
    #[must_use]
    pub fn drives(&self, motor: MotorOutput) -> &[DriveInterval] {
        self.motors.drives(motor)
    }

    /// For how many cycles each light was lit, by supply (main, battery, unknown) and line (0 to 4).
    #[must_use]
    pub fn lit_cycles(&self) -> [[u64; 5]; 3] {
        self.lights.lit_cycles()
    }

    /// For how many cycles each segment of a display was lit, or would have been if one is not fitted: by digit from the left
    /// and segment (a to g).
    #[must_use]
    pub fn digit_cycles(&self) -> [[u64; 7]; 4] {
        self.lights.digit_cycles()
    }

    /// What the speaker sounds, Hz; `None` while it is silent.
    #[must_use]
    pub fn pitch_hz(&self) -> Option<f64> {
        self.sound.pitch_hz(&self.machine)
    }

    /// Times the dock has understood the robot's code.
    #[must_use]
    pub const fn dock_codes(&self) -> u32 {
        self.ear.codes()
    }

    /// A hash of everything that happened: every byte on the wire and the true pose ten times a second.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        self.digest.value()
    }
}

/// The chip distinguishes fewer causes than the wire.
const fn source_of(cause: ResetCause) -> ResetSource {
    match cause {
        ResetCause::PowerOn => ResetSource::PowerOn,
        ResetCause::BrownOut => ResetSource::BrownOut,
        ResetCause::Watchdog => ResetSource::Watchdog,
        ResetCause::Software => ResetSource::Software,
        ResetCause::External | ResetCause::Unknown => ResetSource::MasterClear,
    }
}

pub(super) const fn cause_of(source: ResetSource) -> ResetCause {
    match source {
        ResetSource::PowerOn => ResetCause::PowerOn,
        ResetSource::BrownOut => ResetCause::BrownOut,
        ResetSource::Watchdog => ResetCause::Watchdog,
        ResetSource::Software => ResetCause::Software,
        ResetSource::MasterClear => ResetCause::External,
    }
}
