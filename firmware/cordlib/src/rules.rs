//! Figures of the safety rules. Made by cargo xtask codegen from protocol/rules.toml. Do not edit.

pub(crate) mod arming {
    /// S19. A robot that is told to leave may stand on the contacts for this long. After it was switched on, our host measures the drift of its gyro for up to 16 s before the first motion; driving off takes three.
    pub(crate) const LEAVING_MS: u32 = 20_000;
    /// S19. With the contacts open for this long the robot has left the dock; closing them again is a new arrival.
    pub(crate) const LEFT_MS: u32 = 1_000;
    /// arming. Without a session nobody gives signs of life but by motion commands. A person needs some seconds to type one.
    pub(crate) const QUIET_MS: u32 = 10_000;
}

pub(crate) mod battery {
    /// S16. Voltages are averages of 100 ms. A level is seen up to two averages late.
    pub(crate) const LOW_MS: u32 = 9_800;
    /// S16. As above.
    pub(crate) const WEAK_MS: u32 = 1_800;
    /// S16. As above.
    pub(crate) const EMPTY_MS: u32 = 300;
    /// S16. Of a cell.
    pub(crate) const LOW_MV: i32 = 1_100;
    /// S16. Of a cell.
    pub(crate) const WEAK_MV: i32 = 1_000;
    /// S16. Of a cell.
    pub(crate) const EMPTY_MV: i32 = 900;
    /// S16. On the dock a level ends this far above its threshold.
    pub(crate) const CHARGED_MV: i32 = 50;
    /// S16.
    pub(crate) const CHARGED_MS: u32 = 10_000;
    /// S16. Off the dock only an exchanged pack reaches this voltage.
    pub(crate) const EXCHANGED_MV: i32 = 1_250;
    /// S16.
    pub(crate) const EXCHANGED_MS: u32 = 60_000;
    /// S17. Temperatures are averages of 100 ms. Heat is seen up to two averages late.
    pub(crate) const HOT_MS: u32 = 800;
    /// S17. As above.
    pub(crate) const UNMEASURED_MS: u32 = 1_800;
    /// S17.
    pub(crate) const HOT_CC: i32 = 5_500;
    /// S17.
    pub(crate) const OVERHEATED_CC: i32 = 6_000;
    /// S17.
    pub(crate) const COOLED_CC: i32 = 5_000;
    /// S17.
    pub(crate) const COOLED_MS: u32 = 10_000;
}

pub(crate) mod brush {
    /// S11. A blocked main brush reverses for so long.
    pub(crate) const REVERSE_MS: u32 = 500;
    /// S11. Blocked again within this time it is switched off.
    pub(crate) const TRIED_MS: u32 = 10_000;
}

pub(crate) mod bumper {
    /// S6. A release must be stable this long; a press counts at once.
    pub(crate) const RELEASE_MS: u32 = 30;
    /// S7. Off the dock, which may press the bumper permanently.
    pub(crate) const STUCK_MS: u32 = 10_000;
    /// S7.
    pub(crate) const STUCK_BACKING_MS: u32 = 3_000;
    /// S7. As for a cliff (S8).
    pub(crate) const STUCK_BACKING_NM: i64 = 150_000_000;
}

pub(crate) mod button {
    /// S28. A press must be stable this long.
    pub(crate) const STABLE_MS: u32 = 10;
    /// S28. Debouncing reports a press late, later if the contact bounces. Motion may have ended in that time; the press still counts as one during motion.
    pub(crate) const PRESS_MS: u32 = 30;
}

pub(crate) mod charge_fault {
    /// S18.
    pub(crate) const TOO_HOT_CC: i32 = 5_500;
    /// S18. A pack that was too hot must have cooled to this before the fault can be cleared.
    pub(crate) const COOLED_CC: i32 = 4_500;
    /// S18. Over-current must last for four envelopes of 20 ms; the fifth reports it.
    pub(crate) const OVER_MS: u32 = 80;
    /// S18. Current through a switch that is off.
    pub(crate) const LEAK_MA: i32 = 150;
    /// S18. Time to settle after switching off.
    pub(crate) const SETTLE_MS: u32 = 200;
    /// S18. How long a leak lasts until it is one, after it has settled.
    pub(crate) const LEAK_MS: u32 = 900;
    /// S18. Current at rest, too small for a shorted switch: the sensor's offset is wrong. Without dither the converter may be off by a whole count of 108 mA.
    pub(crate) const OFFSET_FAULT_MA: i32 = 120;
    /// S18. Less than this is no current.
    pub(crate) const NO_CURRENT_MA: i32 = 50;
    /// S18.
    pub(crate) const NO_CURRENT_MS: u32 = 5_000;
    /// S18.
    pub(crate) const NO_CURRENT_TRIES: u8 = 3;
    /// S18.
    pub(crate) const NO_CURRENT_PAUSE_MS: u32 = 300_000;
    /// S18.
    pub(crate) const ADAPTER_MAX_MV: i32 = 30_000;
    /// S18.
    pub(crate) const THERMISTOR_MS: u32 = 1_000;
    /// S18. Without a battery the voltage shoots up in the first half minute.
    pub(crate) const ABSENT_MS: u32 = 30_000;
    /// S18. Interruptions by the contacts.
    pub(crate) const INTERRUPTIONS_MAX: u8 = 10;
    /// S18. One of them is forgiven in this time.
    pub(crate) const FORGIVE_MS: u32 = 60_000;
}

pub(crate) mod charge_frozen {
    /// S18. A reading that has not changed at all for this long is frozen, noisy or not.
    pub(crate) const CONSTANT_MS: u32 = 2_700_000;
    /// S18. A noisy reading that has not changed for this long is frozen.
    pub(crate) const NOISY_CONSTANT_MS: u32 = 120_000;
    /// S18. Longest pause of a noisy reading. The fastest warming that does not end the charge changes a count of a 10-bit converter less often than this.
    pub(crate) const PAUSE_MS: u32 = 5_000;
    /// S18. Range of several counts.
    pub(crate) const SPAN_CC: i32 = 150;
}

pub(crate) mod charge_guard {
    /// S18. Readings older than this are no readings.
    pub(crate) const AGE_MAX_MS: u32 = 200;
    /// S18. No current flows beyond these temperatures: frost as for the controller, heat 1 °C above its limit.
    pub(crate) const COLDEST_CC: i32 = 0;
    /// S18. As above.
    pub(crate) const HOTTEST_CC: i32 = 5_100;
    /// S18. Longest time of current without a rest.
    pub(crate) const FLOW_MAX_MS: u32 = 12_900_000;
    /// S18. A rest that resets this time.
    pub(crate) const REST_MS: u32 = 1_860_000;
}

pub(crate) mod charge_history {
    /// S18. Faults within a day after which `clear` is refused.
    pub(crate) const FAULTS: usize = 3;
    /// S18.
    pub(crate) const DAY_MS: u32 = 86_400_000;
    /// S18. NiMH packs age by current when they are full: at most 20 hours of maintenance a week.
    pub(crate) const MAINTAIN_MAX_MS: u32 = 72_000_000;
}

pub(crate) mod charge_phase {
    /// S18. The contacts must be closed this long before a charge begins.
    pub(crate) const DOCKED_MS: u32 = 1_000;
    /// S18. Contacts that are open for this long end the rest after a charge.
    pub(crate) const UNDOCKED_MS: u32 = 1_000;
    /// S18. The supply must be there this long before current flows.
    pub(crate) const SUPPLIED_MS: u32 = 1_000;
    /// S18. A pack that may be colder gets no current.
    pub(crate) const COLDEST_CC: i32 = 0;
    /// S18. A pack that may be colder gets slow current only.
    pub(crate) const COOL_CC: i32 = 500;
    /// S18. No charge begins in a pack that may be warmer.
    pub(crate) const WARMEST_CC: i32 = 4_000;
    /// S18. A pack that was too cold for a current must be this much warmer before it gets it again.
    pub(crate) const HYSTERESIS_CC: i32 = 100;
    /// S18.
    pub(crate) const PRECHARGE_MS: u32 = 3_600_000;
    /// S18.
    pub(crate) const TOP_OFF_MS: u32 = 1_800_000;
    /// S18. Temperature at which a full pack gets no more current.
    pub(crate) const TOP_OFF_MAX_CC: i32 = 4_500;
    /// S18. Rest after a charge that ran out of time.
    pub(crate) const LONG_REST_MS: u32 = 3_600_000;
}

pub(crate) mod charge_stop {
    /// S18. dT/dt: temperature rise over 3 minutes that ends a charge at full current, 0.8 °C/min. That is the lower end of what makers advise, because C/2 heats a pack slowly. A weaker supply heats it less, so the limit falls with the current.
    pub(crate) const TEMPERATURE_SLOPE_CC: i32 = 240;
    /// S18. The least of it, 0.5 °C/min.
    pub(crate) const TEMPERATURE_SLOPE_LEAST_CC: i32 = 150;
    /// S18. Windows of 10 s in three minutes.
    pub(crate) const TEMPERATURE_SLOPE_WINDOWS: usize = 18;
    /// S18. dT/dt is meaningless in the first minutes.
    pub(crate) const TEMPERATURE_SLOPE_HOLD_OFF_MS: u32 = 180_000;
    /// S18. After storage or deep discharge the voltage of an empty pack may fall at first.
    pub(crate) const NEGATIVE_DELTA_V_HOLD_OFF_MS: u32 = 600_000;
    /// S18. -dV must last for this many windows of 10 s.
    pub(crate) const NEGATIVE_DELTA_V_WINDOWS: u8 = 6;
    /// S18. Voltages are comparable only if the current has changed by less than this, because of the pack's resistance.
    pub(crate) const SAME_CURRENT_MA: i32 = 80;
    /// S18. Windows of 10 s in twenty minutes.
    pub(crate) const ZERO_DELTA_V_WINDOWS: u16 = 120;
    /// S18.
    pub(crate) const ZERO_DELTA_V_HOLD_OFF_MS: u32 = 5_400_000;
    /// S18.
    pub(crate) const TEMPERATURE_RISE_CC: i32 = 1_500;
    /// S18. A charge ends at this temperature.
    pub(crate) const HOT_CC: i32 = 5_000;
    /// S18. Longest charge, precharge and top-off included.
    pub(crate) const TIME_MS: u32 = 12_600_000;
}

pub(crate) mod cliff {
    /// S8. A single dark sample is noise. Three in a row stay far below the reaction time.
    pub(crate) const SET_MS: u32 = 2;
    /// S8.
    pub(crate) const CLEAR_MS: u32 = 50;
    /// S8.
    pub(crate) const REVERSE_MAX_NM: i64 = 150_000_000;
    /// S8.
    pub(crate) const ONSETS_MAX: u8 = 3;
    /// S8.
    pub(crate) const ONSETS_WINDOW_MS: u32 = 5_000;
    /// S8. Floor that is seen for a moment while the robot brakes along an edge or backs off does not make it a second cliff.
    pub(crate) const SAME_CLIFF_MS: u32 = 300;
    /// S8. Speed limit of a rim while a cliff is seen.
    pub(crate) const SPEED_MAX_UM_PER_S: i32 = 100_000;
    /// S8. A rim that is measured this much faster is braked. The measurement ripples, and a wheel that settles overshoots.
    pub(crate) const SPEED_RIPPLE_UM_PER_S: i32 = 15_000;
}

pub(crate) mod cliff_test {
    /// S9. Pause between two self-tests; the test itself and the reaction to a cliff follow it.
    pub(crate) const TEST_PERIOD_MS: u32 = 900;
    /// S9. Time for a receiver to settle after the emitter has changed.
    pub(crate) const SETTLE_MS: u32 = 2;
}

pub(crate) mod dock {
    /// S19. One sample is noise.
    pub(crate) const SET_MS: u32 = 10;
    /// S19. While bouncing contacts open for a moment the robot counts as docked.
    pub(crate) const CLEAR_MS: u32 = 300;
}

pub(crate) mod dock_escape {
    /// S18.
    pub(crate) const TRIES_MAX: u8 = 3;
    /// S18.
    pub(crate) const WARNING_MS: u32 = 2_000;
    /// S18. A try lasts no longer: 0.2 m. The same time passes before the next one.
    pub(crate) const TRY_MS: u32 = 2_000;
    /// S18.
    pub(crate) const SPEED_UM_PER_S: i32 = -100_000;
    /// S18. Without encoders the speed is not known: a duty that moves any robot, not fast.
    pub(crate) const BLIND_DUTY: i32 = -450_000;
    /// S18. The motion is renewed at this period, and its lease is a little longer.
    pub(crate) const RENEW_MS: u32 = 100;
    /// S18.
    pub(crate) const LEASE_MS: u16 = 150;
    /// S18. The contacts must have been open for this long: the robot is then some centimetres away.
    pub(crate) const OPEN_MS: u32 = 400;
}

pub(crate) mod encoder {
    /// S13. The filtered speed takes 80 ms to fall.
    pub(crate) const DISAGREEMENT_MS: u32 = 410;
    /// S13. Below this set point the encoder's resolution is too coarse for the check.
    pub(crate) const SET_POINT_MIN_UM_PER_S: i32 = 50_000;
}

pub(crate) mod lift {
    /// S10. On a door threshold a wheel hangs for a moment. This is well below the reaction time.
    pub(crate) const SET_MS: u32 = 15;
    /// S10.
    pub(crate) const CLEAR_MS: u32 = 50;
    /// S10.
    pub(crate) const GROUNDED_MS: u32 = 1_000;
}

pub(crate) mod progress {
    /// S15. The rule runs every 10 ms.
    pub(crate) const WINDOW_MS: u32 = 1_980;
    /// S15.
    pub(crate) const PROGRESS_MIN_NM: i64 = 20_000_000;
    /// S15. A turn of the wheels that the gyro must confirm.
    pub(crate) const TURN_CHECK_URAD: i64 = 1_000_000;
    /// S15. After this the next command may try again.
    pub(crate) const REST_MS: u32 = 1_000;
}

pub(crate) mod reset {
    /// S4.
    pub(crate) const RESETS_MAX: u8 = 3;
    /// S4. Firmware that has run for so long is sound: the count starts again.
    pub(crate) const SOUND_MS: u32 = 60_000;
}

pub(crate) mod runaway {
    /// S12. Checked every 10 ms; the rest is the filter of the speed measurement.
    pub(crate) const RUNAWAY_MS: u32 = 190;
    /// S12. Speed that a stopped wheel may have, for example from a push.
    pub(crate) const SLACK_UM_PER_S: i32 = 60_000;
}

pub(crate) mod session {
    /// S1. A `move` under a session ends when no packet has come for this long.
    pub(crate) const MOVE_SILENCE_MS: u32 = 1_000;
}

pub(crate) mod stall {
    /// S11. The rule runs every 10 ms and sees an overcurrent up to one period late.
    pub(crate) const OVER_CURRENT_MS: u32 = 80;
    /// S11. Seen up to two periods late, because the first period without a count may have begun with one.
    pub(crate) const STANDSTILL_MS: u32 = 270;
    /// S11. Duty above which a motor that does not turn is stalled, in millionths.
    pub(crate) const STALL_DUTY: i32 = 300_000;
}

pub(crate) mod thermometer {
    /// S17. Plausible range of a pack in a home.
    pub(crate) const LEAST_CC: i32 = -2_000;
    /// S17. As above.
    pub(crate) const MOST_CC: i32 = 8_000;
    /// S17. Most that a pack can change in a second.
    pub(crate) const JUMP_CC: i32 = 500;
    /// S17. How long a jump is remembered.
    pub(crate) const JUMP_MS: u32 = 10_000;
}

pub(crate) mod latch {
    use rvac_protocol::message::Inhibit;

    /// Latches that forbid motion and charging.
    pub(crate) const FORBID_ALL: [Inhibit; 3] = [Inhibit::Clock, Inhibit::Memory, Inhibit::InternalFault];
}
