//! What the monitor judges by. Made by cargo xtask codegen from protocol/rules.toml. Do not edit.

/// S6.stop.
pub(crate) const BUMPER_MS: u32 = 20;
/// S7.held.
pub(crate) const BUMPER_STUCK_MS: u32 = 10_000;
/// S7.backing.
pub(crate) const BUMPER_BACKING_MS: u32 = 3_000;
/// S8.stop.
pub(crate) const CLIFF_MS: u32 = 20;
/// S8.overshoot.
pub(crate) const CLIFF_HASTE_MS: u32 = 100;
/// S8.overshoot-speed.
pub(crate) const CLIFF_RIM_MM_PER_S: i32 = 125;
/// S8.distance, and slip and rounding between the rims and the body.
pub(crate) const CLIFF_REVERSE_UM: u32 = 165_000;
/// S10.off.
pub(crate) const WHEEL_DROP_MS: u32 = 50;
/// S10.grounded.
pub(crate) const GROUNDED_MS: u32 = 1_000;
/// S11.standstill.
pub(crate) const STALL_MS: u32 = 300;
/// S11.hard-drive.
pub(crate) const HARD_DRIVE: i32 = 300_000;
/// S13.found, and the monitor's own window.
pub(crate) const ENCODER_MS: u32 = 600;
/// S11.over-current, and the converter's filter and two control periods.
pub(crate) const TOO_MUCH_MS: u32 = 160;
/// S15.found, and of a motor whose limit nobody has measured: S11, S13 or S15 sees it, the last of them after this.
pub(crate) const NEARLY_HELD_MS: u32 = 2_100;
/// S12.found, and the ramp of the wheels.
pub(crate) const TOO_FAST_MS: u32 = 350;
/// S20.off.
pub(crate) const CLOCK_MS: u32 = 10;
/// S21.memory.
pub(crate) const MEMORY_MS: u32 = 60_000;
/// S21.register.
pub(crate) const PULSES_MS: u32 = 20;
/// Reports.told.
pub(crate) const TOLD_MS: u32 = 400;
/// Reports.untold.
pub(crate) const UNTOLD_MS: u32 = 200;
/// S16.empty.
pub(crate) const PACK_EMPTY_MS: u32 = 500;
/// S16.weak.
pub(crate) const PACK_WEAK_MS: u32 = 2_000;
/// S17.hot.
pub(crate) const PACK_HOT_MS: u32 = 1_000;
/// S19.stop.
pub(crate) const DOCKED_MS: u32 = 20;
/// S19.leaving.
pub(crate) const LEAVING_MS: u64 = 20_000;
/// S28.stop.
pub(crate) const BUTTON_MS: u64 = 50;
/// S18.warning.
pub(crate) const ESCAPE_WARNING_MS: u64 = 2_000;
/// S18.leak.
pub(crate) const LEAK_MA: i32 = 150;
/// S18.off-dock.
pub(crate) const OFF_DOCK_MS: u32 = 20_000;
/// S18.flow.
pub(crate) const CHARGE_TIME_MS: u32 = 12_960_000;
/// S18.over-current, and the monitor's mean of 20 ms, and the switch's own envelope.
pub(crate) const CHARGE_CURRENT_MS: u32 = 200;
/// S18.rest.
pub(crate) const REST_MS: u32 = 1_800_000;
/// S18.unsupplied.
pub(crate) const CHARGE_MS: u32 = 100;
/// arming.quiet.
pub(crate) const HAND_QUIET_MS: u64 = 10_000;
/// arming.hand-lease.
pub(crate) const HAND_LEASE_MS: u64 = 500;
/// arming.silence.
pub(crate) const SILENCE_MS: u64 = 2_000;
/// S3.fresh, and the length of a packet on the line.
pub(crate) const FRESH_MS: i32 = 420;
/// S4.window.
pub(crate) const RESET_WINDOW_MS: u64 = 60_000;
