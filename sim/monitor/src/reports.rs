//! Checks what a robot tells against what its sensors show: a report that names the wrong switch, or a value that the robot
//! cannot know, misleads whoever reads it, and no motor need run for that.

use super::causes::Pins;
use super::limits::{TOLD_MS, UNTOLD_MS};
use super::told::{Declared, Told, ToldPack, ToldState};
use super::verdict::Rule;

/// Totals and currents are compared over this time.
const WINDOW_MS: u64 = 500;
/// A packet is older than the pins by the time on the line: at full speed the wheels count so much meanwhile.
const COUNTS_SLACK: i32 = 40;
const COUNTS_SHARE: i32 = 10;
/// No wheel turns by more in a millisecond: somebody exchanged the encoder.
const COUNTS_STEP_MOST: i32 = 20;
/// Gain and offset of a current line that nobody has calibrated.
const CURRENT_SLACK_MA: i64 = 250;
const CURRENT_SHARE_PERCENT: i64 = 40;
/// A divider of 1 %, the converter's gain and offset, and the filter.
const PACK_SHARE: i32 = 33;
const PACK_SLACK_MV: i32 = 200;
/// A temperature that is not known to 3 degrees is not told; a degree is for the filter.
const WARMTH_SLACK_DC: i32 = 40;
/// Windows and reports in a row that must be wrong: one may lie across a change.
const WRONG_IN_A_ROW: u8 = 2;
const WRONG_PACKS: u8 = 3;
/// After a reset debouncing starts anew.
const SETTLE_MS: u64 = 1_000;

/// Bumper halves, wheels that hang, and three buttons, each with its memory.
const SIDES: usize = 7;
/// Something that is surely at a proximity sensor, and what is then told at least; nothing, and what is told at most: a receiver
/// that nobody has calibrated shows half as much again or a third less.
const NEAR: u8 = 200;
const NEAR_TOLD: u8 = 40;
const FAR: u8 = 20;
const FAR_TOLD: u8 = 120;
/// A sensor's turn in the multiplexer, its filter and the report.
const NEAR_MS: u64 = 500;
const FAR_MS: u64 = 1_000;

/// For how long each switch has been as it is.
#[derive(Clone, Copy, Debug, Default)]
struct Shown {
    on_ms: u64,
    off_ms: u64,
}

impl Shown {
    fn update(&mut self, now_ms: u64, on: bool) {
        if on {
            self.on_ms = now_ms;
        } else {
            self.off_ms = now_ms;
        }
    }

    /// It was on at some time that a report may still tell of.
    fn was_on(self, now_ms: u64) -> bool {
        self.on_ms > 0 && now_ms - self.on_ms <= u64::from(TOLD_MS)
    }

    /// It has been on for so long that every report tells it.
    fn is_surely_on(self, now_ms: u64) -> bool {
        self.on_ms == now_ms && now_ms - self.off_ms > u64::from(UNTOLD_MS)
    }
}

/// When something was last at a proximity sensor, and when nothing.
#[derive(Clone, Copy, Debug, Default)]
struct NearTimes {
    not_near_ms: u64,
    not_far_ms: u64,
}

impl NearTimes {
    fn update(&mut self, now_ms: u64, closeness: u8) {
        if closeness < NEAR {
            self.not_near_ms = now_ms;
        }
        if closeness > FAR {
            self.not_far_ms = now_ms;
        }
    }

    fn denies(self, now_ms: u64, told: u8) -> bool {
        (now_ms - self.not_near_ms > NEAR_MS && told < NEAR_TOLD)
            || (now_ms - self.not_far_ms > FAR_MS && told > FAR_TOLD)
    }
}

/// Least and most of a value in the last one to two periods.
#[derive(Clone, Copy, Debug)]
struct Extent {
    before: [i32; 2],
    now: [i32; 2],
}

impl Default for Extent {
    fn default() -> Self {
        let empty = [i32::MAX, i32::MIN];
        Self {
            before: empty,
            now: empty,
        }
    }
}

impl Extent {
    fn update(&mut self, now_ms: u64, value: i32) {
        const PERIOD_MS: u64 = 1_500;
        if now_ms.is_multiple_of(PERIOD_MS) {
            self.before = self.now;
            self.now = [i32::MAX, i32::MIN];
        }
        self.now = [self.now[0].min(value), self.now[1].max(value)];
    }

    /// Whether a value with this error may come from it.
    fn explains(&self, told: i32, slack: i32) -> bool {
        let least = self.before[0].min(self.now[0]).saturating_sub(slack);
        let most = self.before[1].max(self.now[1]).saturating_add(slack);
        (least..=most).contains(&told)
    }
}

/// What passed in the present window, and how many in a row were wrong.
#[derive(Clone, Copy, Debug, Default)]
struct Window {
    begin_ms: u64,
    told_counts: [i32; 2],
    counts: [i32; 2],
    told_ma: [i64; 2],
    told: i64,
    shown_ma: [i64; 2],
    shown: i64,
    wrong_counts: u8,
    wrong_currents: u8,
}

/// Memory of what the sensors showed, and what was told falsely.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ReportWatch {
    now_ms: u64,
    /// Nothing is judged before.
    from_ms: u64,
    declared: Option<Declared>,
    pins: Pins,
    sides: [Shown; SIDES],
    cliffs: [Shown; 3],
    near: [NearTimes; 8],
    pack_mv: Extent,
    warmth_dc: Extent,
    window: Window,
    wrong_packs: u8,
    false_state: u64,
    false_window: u64,
    false_pack: u64,
}

impl ReportWatch {
    /// A firmware that restarts counts and debounces anew.
    pub(crate) fn reset(&mut self, now_ms: u64) {
        *self = Self {
            now_ms,
            from_ms: now_ms + SETTLE_MS,
            pins: self.pins,
            sides: self.sides,
            cliffs: self.cliffs,
            ..Self::default()
        };
    }

    /// Takes the pins of a millisecond.
    pub(crate) fn look(&mut self, now_ms: u64, pins: &Pins) {
        self.now_ms = now_ms;
        let leaps = (0..2).any(|side| {
            let step = pins.counts[side].wrapping_sub(self.pins.counts[side]);
            step.saturating_abs() > COUNTS_STEP_MOST
        });
        if leaps {
            self.window = Window::default();
        }
        self.pins = *pins;
        if let Some(sides) = pins.sides {
            let [left, right] = sides.bumpers;
            let [left_drop, right_drop] = sides.wheel_drops;
            let [first, second, third] = buttons(sides.buttons);
            let switches = [left, right, left_drop, right_drop, first, second, third];
            for (shown, on) in self.sides.iter_mut().zip(switches) {
                shown.update(now_ms, on);
            }
            for (shown, on) in self.cliffs.iter_mut().zip(sides.cliffs) {
                shown.update(now_ms, on);
            }
        }
        if let Some(proximity) = pins.sensed.proximity {
            for (near, closeness) in self.near.iter_mut().zip(proximity) {
                near.update(now_ms, closeness);
            }
        }
        if let Some(pack_mv) = pins.sensed.pack_mv {
            self.pack_mv.update(now_ms, pack_mv);
        }
        if let Some(temperature_dc) = pins.sensed.temperature_dc {
            self.warmth_dc.update(now_ms, temperature_dc);
        }
        if let Some(currents_ma) = pins.sensed.currents_ma {
            self.window.shown += 1;
            for (sum, current_ma) in self.window.shown_ma.iter_mut().zip(currents_ma) {
                *sum += i64::from(current_ma);
            }
        }
    }

    /// Takes a report.
    pub(crate) fn take(&mut self, told: &Told) {
        match told {
            Told::Parts(parts) => self.declared = Some(*parts),
            Told::State(state) => self.judge_state(state),
            Told::Pack(pack) => self.judge_pack(pack),
        }
    }

    /// Rules that the newest reports break, bit by rule.
    pub(crate) const fn broken(&self) -> u64 {
        self.false_state | self.false_window | self.false_pack
    }

    fn judge_state(&mut self, state: &ToldState) {
        let Some(parts) = self.declared.filter(|_| self.now_ms >= self.from_ms) else {
            return;
        };
        self.false_state = bit(Rule::ReportsSide, self.names_wrong_side(state, parts))
            | bit(Rule::ReportsNear, self.tells_wrong_closeness(state, parts))
            | bit(Rule::ReportsAbsent, tells_absent(state, parts));
        if let Some(currents_ma) = state.currents_ma {
            self.window.told += 1;
            for (sum, current_ma) in self.window.told_ma.iter_mut().zip(currents_ma) {
                *sum += i64::from(current_ma);
            }
        }
        if self.window.begin_ms == 0 {
            self.begin_window(state);
        } else if self.now_ms >= self.window.begin_ms + WINDOW_MS {
            self.judge_window(state, parts);
            self.begin_window(state);
        }
    }

    fn names_wrong_side(&self, state: &ToldState, parts: Declared) -> bool {
        if self.pins.sides.is_none() {
            return false;
        }
        let now_ms = self.now_ms;
        let [bumper_left, bumper_right] = state.bumpers;
        let [drop_left, drop_right] = state.wheel_drops;
        let [first, second, third] = buttons(state.buttons);
        let told = [
            bumper_left,
            bumper_right,
            drop_left,
            drop_right,
            first,
            second,
            third,
        ];
        let (touches, hangs) = (parts.bumpers == 2, parts.wheel_drops == 2);
        // A ladder shows one button of several.
        let one_button = parts.buttons >= 3
            && self
                .pins
                .sides
                .is_some_and(|sides| sides.buttons.count_ones() < 2);
        let fitted = [touches, touches, hangs, hangs, one_button, one_button, one_button];
        let wrong_switch = self
            .sides
            .iter()
            .zip(told)
            .zip(fitted)
            .any(|((shown, told), is_fitted)| {
                is_fitted
                    && if told {
                        !shown.was_on(now_ms)
                    } else {
                        shown.is_surely_on(now_ms)
                    }
            });
        // A blind receiver is told as a cliff, too (S9): only one that is told in place of another is false.
        let seen = |told: bool, shown: &Shown| told && shown.was_on(now_ms);
        let any_told = state.cliffs.contains(&true);
        let any_sure = self.cliffs.iter().any(|shown| shown.is_surely_on(now_ms));
        let any_right = state
            .cliffs
            .iter()
            .zip(&self.cliffs)
            .any(|(told, shown)| seen(*told, shown));
        wrong_switch || (parts.cliffs == 3 && any_told && any_sure && !any_right)
    }

    fn tells_wrong_closeness(&self, state: &ToldState, parts: Declared) -> bool {
        let is_judged = self.pins.sensed.proximity.is_some() && parts.proximity > 0;
        let fitted = usize::try_from(parts.proximity).unwrap_or(usize::MAX);
        let sensors = self.near.iter().zip(state.near).take(fitted);
        is_judged
            && sensors
                .into_iter()
                .any(|(near, told)| near.denies(self.now_ms, told))
    }

    fn begin_window(&mut self, state: &ToldState) {
        self.window = Window {
            begin_ms: self.now_ms,
            told_counts: state.counts,
            counts: self.pins.counts,
            wrong_counts: self.window.wrong_counts,
            wrong_currents: self.window.wrong_currents,
            ..Window::default()
        };
    }

    fn judge_window(&mut self, state: &ToldState, parts: Declared) {
        let window = &mut self.window;
        let counts = (0..2).any(|side| {
            let told = state.counts[side].wrapping_sub(window.told_counts[side]);
            let shown = self.pins.counts[side].wrapping_sub(window.counts[side]);
            let slack = COUNTS_SLACK + shown.saturating_abs() / COUNTS_SHARE;
            told.wrapping_sub(shown).saturating_abs() > slack
        });
        let currents = (0..2).any(|side| {
            let told_ma = window.told_ma[side] / window.told.max(1);
            let shown_ma = window.shown_ma[side] / window.shown.max(1);
            let slack_ma = CURRENT_SLACK_MA + shown_ma.abs() * CURRENT_SHARE_PERCENT / 100;
            (told_ma - shown_ma).abs() > slack_ma
        });
        let is_measured = parts.currents && window.shown > 0 && window.told > 0;
        in_a_row(&mut window.wrong_counts, parts.encoders && counts);
        in_a_row(&mut window.wrong_currents, is_measured && currents);
        self.false_window = bit(Rule::ReportsCount, window.wrong_counts >= WRONG_IN_A_ROW)
            | bit(Rule::ReportsCurrent, window.wrong_currents >= WRONG_IN_A_ROW);
    }

    fn judge_pack(&mut self, pack: &ToldPack) {
        let Some(parts) = self.declared.filter(|_| self.now_ms >= self.from_ms) else {
            return;
        };
        let slack_mv = PACK_SLACK_MV + pack.pack_mv.saturating_abs() / PACK_SHARE;
        let voltage = self.pins.sensed.pack_mv.is_some() && !self.pack_mv.explains(pack.pack_mv, slack_mv);
        let warmth = self.pins.sensed.temperature_dc.is_some()
            && pack
                .temperature_dc
                .is_some_and(|told_dc| !self.warmth_dc.explains(told_dc, WARMTH_SLACK_DC));
        in_a_row(&mut self.wrong_packs, voltage || warmth);
        self.false_pack = bit(Rule::ReportsPack, self.wrong_packs >= WRONG_PACKS)
            | bit(Rule::ReportsAbsent, !parts.battery);
    }
}

/// Whether the robot tells a value of a part that it says it does not have.
fn tells_absent(state: &ToldState, parts: Declared) -> bool {
    (state.has_gyro && !parts.gyro)
        || (state.counts != [0; 2] && !parts.encoders)
        || (state.currents_ma.is_some_and(|all| all != [0; 2]) && !parts.currents)
        || (state.near != [0; 8] && parts.proximity == 0)
        || (state.buttons != 0 && parts.buttons == 0)
        || (state.has_beams && parts.dock_receivers == 0)
        || (state.bumpers != [false; 2] && parts.bumpers == 0)
        || (state.cliffs != [false; 3] && parts.cliffs == 0)
        || (state.wheel_drops != [false; 2] && parts.wheel_drops == 0)
}

fn buttons(bits: u8) -> [bool; 3] {
    [bits & 1 != 0, bits & 2 != 0, bits & 4 != 0]
}

fn in_a_row(count: &mut u8, is_wrong: bool) {
    *count = if is_wrong { count.saturating_add(1) } else { 0 };
}

const fn bit(rule: Rule, is_broken: bool) -> u64 {
    (is_broken as u64) << rule as u32
}
