//! One pass of the charger: measure, detect faults, advance the state machine, regulate, apply the guard.

use rvac_protocol::message::{ChargeEnd, ChargeFault, ChargePhase, ChargerStatus};
use rvac_units::{Ratio, Tick};

use crate::board::{ChargeDrive, ChargerReadings, DockRequest};
use crate::parameters::PackParameters;
use crate::rules::charge_guard::AGE_MAX_MS;
use crate::rules::charge_phase::SUPPLIED_MS;

use super::current_offset::CurrentOffset;
use super::faults::FaultWatch;
use super::gauge::{Gauge, PackLoad};
use super::guard::{ChargeConditions, Guard};
use super::history::History;
use super::meter::{Averages, AveragingWindow, CompletedWindows, Meter};
use super::phases::{ChargeRecord, MaintenancePulse, Rest};
use super::regulate::Regulator;
use super::scale::PackLimits;
use super::stops::{AllStops, Detectors, Stops};
use super::thermometer::Thermometer;
use crate::rules::charge_fault::NO_CURRENT_MA;

/// The dock is asked this long before current flows, so that it has received the request.
const ASKED_MS: u32 = 2_000;

/// Who controls the charger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChargeControl {
    /// This firmware.
    Ours,
    /// Something else: the pack is only observed.
    Foreign,
}

/// Whether anything on the robot turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotorActivity {
    /// No motor is driven and no wheel turns.
    Idle,
    /// Something is driven or turns.
    Running,
}

/// A pack that is only observed may be read as slowly as its temperature (S17).
const OBSERVED_AGE_MAX_MS: u32 = 2_000;
/// A temperature that may be wrong by more than this is not told: 3 degrees, in hundredths.
const DOUBT_CC: i32 = 300;

/// How the robot stands to the dock. The contacts are debounced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Docking {
    /// The contacts are open.
    Away,
    /// The contacts are closed, and the robot is about to leave.
    Leaving,
    /// The contacts are closed, and the robot stays.
    Docked,
}

/// What the charger must know of the rest of the firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChargeContext {
    /// How the robot stands to the dock.
    pub docking: Docking,
    /// Whether anything turns.
    pub motors: MotorActivity,
    /// Estimated load of the parts that are switched on, in mA.
    pub load_ma: i32,
}

impl ChargeContext {
    /// Whether the pack may be charged, as far as the dock is concerned.
    pub(super) fn is_docked(&self) -> bool {
        self.docking == Docking::Docked
    }
}

/// What the board has to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChargeOutput {
    /// The switch.
    pub drive: ChargeDrive,
    /// The dock.
    pub request: DockRequest,
}

/// The charger.
#[derive(Clone, Debug)]
pub struct ChargeController<S = AllStops> {
    control: ChargeControl,
    pub(super) pack: PackParameters,
    pub(super) scale: PackLimits,
    pub(super) stops: S,
    pub(super) phase: ChargePhase,
    pub(super) fault: Option<ChargeFault>,
    pub(super) end: Option<ChargeEnd>,
    /// The last charge filled the pack, and the robot has not left the dock since.
    pub(super) full: bool,
    pub(super) meter: Meter,
    pub(super) thermometer: Thermometer,
    pub(super) current_offset: CurrentOffset,
    pub(super) watch: FaultWatch,
    pub(super) detectors: Detectors,
    pub(super) charge: ChargeRecord,
    pub(super) pulse: MaintenancePulse,
    pub(super) rest: Rest,
    pub(super) regulator: Regulator,
    pub(super) history: History,
    pub(super) gauge: Gauge,
    /// Newest averages of 100 ms, current offset subtracted.
    pub(super) tenth: Option<Averages>,
    pub(super) docked_ms: u32,
    pub(super) undocked_ms: u32,
    pub(super) supplied_ms: u32,
    pub(super) off_ms: u32,
    asked_ms: u32,
    pub(super) guard: Guard,
    output: ChargeOutput,
    last: Option<Tick>,
}

impl ChargeController {
    /// A charger after a reset. It knows of no earlier charge and checks everything before it begins one.
    #[must_use]
    pub fn new(pack: PackParameters) -> Self {
        Self::with_stops(pack, AllStops)
    }

    /// For a board that measures its pack and does not control its charger.
    #[must_use]
    pub fn observing(pack: PackParameters) -> Self {
        Self {
            control: ChargeControl::Foreign,
            ..Self::new(pack)
        }
    }
}

impl<S: Stops> ChargeController<S> {
    /// As [`ChargeController::new`] with a choice of stops, for campaigns that test each stop alone.
    #[must_use]
    pub fn with_stops(pack: PackParameters, stops: S) -> Self {
        Self {
            control: ChargeControl::Ours,
            pack,
            scale: PackLimits::of(&pack),
            stops,
            phase: ChargePhase::Idle,
            fault: None,
            end: None,
            full: false,
            meter: Meter::new(),
            thermometer: Thermometer::default(),
            current_offset: CurrentOffset::default(),
            watch: FaultWatch::default(),
            detectors: Detectors::default(),
            charge: ChargeRecord::default(),
            pulse: MaintenancePulse::default(),
            rest: Rest::default(),
            regulator: Regulator::default(),
            history: History::new(),
            gauge: Gauge::default(),
            tenth: None,
            docked_ms: 0,
            undocked_ms: 0,
            supplied_ms: 0,
            off_ms: 0,
            asked_ms: 0,
            guard: Guard::default(),
            output: ChargeOutput::default(),
            last: None,
        }
    }

    /// One pass. Call it in every pass of the main loop, at least every 50 ms.
    pub fn step(
        &mut self,
        readings: Option<ChargerReadings>,
        context: ChargeContext,
        now: Tick,
    ) -> ChargeOutput {
        let elapsed_ms = self.last.map_or(0, |last| now.since(last));
        self.last = Some(now);
        let windows = self.meter.take(readings, elapsed_ms, now);
        self.pass_time(context, elapsed_ms);
        self.measure(&windows, context);
        if self.control == ChargeControl::Foreign {
            return ChargeOutput::default();
        }
        if let Some(fault) = self.find_fault(&windows, context) {
            self.fail(fault);
        }
        self.advance(&windows, context);
        self.regulate(&windows, context, elapsed_ms)
    }

    fn pass_time(&mut self, context: ChargeContext, elapsed_ms: u32) {
        let supplied = context.is_docked() && self.meter.adapter();
        let add = |condition: bool, span_ms: u32| {
            if condition {
                span_ms.saturating_add(elapsed_ms)
            } else {
                0
            }
        };
        self.docked_ms = add(context.is_docked(), self.docked_ms);
        self.undocked_ms = add(!context.is_docked(), self.undocked_ms);
        self.supplied_ms = add(supplied, self.supplied_ms);
        self.off_ms = add(self.output.drive == ChargeDrive::Off, self.off_ms);
        self.asked_ms = add(self.output.request == DockRequest::Current, self.asked_ms);
        if self.meter.has_measured() {
            self.thermometer.pass(elapsed_ms);
        }
        self.history.pass(elapsed_ms);
        self.watch.pass(supplied, elapsed_ms);
        self.rest.pass(elapsed_ms);
        self.charge.pass(self.is_charging(), elapsed_ms);
    }

    fn measure(&mut self, windows: &CompletedWindows, context: ChargeContext) {
        if let Some(averages) = windows.of(AveragingWindow::Tenth) {
            self.thermometer.each_tenth(&averages);
            self.tenth = Some(self.current_offset.correct(averages));
        }
        if let Some(averages) = windows.of(AveragingWindow::Second) {
            self.thermometer.each_second(&averages);
            let no_supply = !self.meter.adapter() && context.docking == Docking::Away;
            let ours = self.control == ChargeControl::Ours;
            if ours && no_supply && self.off_ms >= averages.elapsed_ms {
                self.current_offset.learn(&averages);
            }
            let averages = self.current_offset.correct(averages);
            let load = PackLoad {
                load_ma: context.load_ma,
                charging: self.is_charging() || self.takes_foreign_current(averages.current_ma),
            };
            self.gauge.each_second(&averages, load, &self.pack);
            if self.is_charging() || self.phase == ChargePhase::Maintain {
                self.charge.gather(&averages);
            }
        }
    }

    fn regulate(
        &mut self,
        windows: &CompletedWindows,
        context: ChargeContext,
        elapsed_ms: u32,
    ) -> ChargeOutput {
        let target_ma = self.target_ma();
        let wanted = target_ma > 0;
        let ready = wanted
            && self.supplied_ms >= SUPPLIED_MS
            && self.asked_ms >= ASKED_MS
            && context.motors == MotorActivity::Idle;
        if !ready {
            self.regulator.restart();
        } else {
            self.charge.want(self.phase, elapsed_ms);
            if let Some(averages) = windows.of(AveragingWindow::Envelope) {
                let current_ma = self.current_offset.correct(averages).current_ma;
                self.regulator
                    .fold_back(current_ma, self.scale.fold_back_ma(), target_ma);
            }
            if let (Some(_), Some(averages)) = (windows.of(AveragingWindow::Tenth), self.tenth) {
                self.regulator.control(averages.current_ma, target_ma);
            }
        }
        let view = self.view(context);
        let drive = self.guard.permit(self.regulator.drive(), &view, elapsed_ms);
        if drive == ChargeDrive::Off {
            self.charge.pause();
            self.watch.interrupt();
            if self.regulator.drive() != ChargeDrive::Off {
                self.regulator.restart();
            }
        } else {
            self.charge.flow();
        }
        let request = if wanted && context.is_docked() {
            DockRequest::Current
        } else {
            DockRequest::Silent
        };
        self.output = ChargeOutput { drive, request };
        self.output
    }

    fn view(&self, context: ChargeContext) -> ChargeConditions {
        ChargeConditions {
            supplied: context.is_docked() && self.meter.adapter(),
            motors_idle: context.motors == MotorActivity::Idle,
            age_ms: self.meter.age_ms(),
            temperature: self.thermometer.temperature(),
            pack_mv: self.tenth.map(|averages| averages.pack_mv),
            pack_range_mv: (
                self.scale.deep_mv(),
                self.scale.voltage_max_mv().saturating_add(200),
            ),
        }
    }

    /// Switches off at once, because a motor is about to run or everything stops. The charge resumes by itself when it is
    /// allowed again.
    pub fn cut(&mut self) -> ChargeOutput {
        self.regulator.restart();
        self.output = ChargeOutput::default();
        self.output
    }

    /// The last output to the board.
    #[must_use]
    pub const fn output(&self) -> ChargeOutput {
        self.output
    }

    /// Phase, last end and fault, for telemetry.
    #[must_use]
    pub const fn status(&self) -> ChargerStatus {
        ChargerStatus {
            phase: self.phase,
            end: self.end,
            fault: self.fault,
        }
    }

    /// Whether the pack is known to be full.
    #[must_use]
    pub const fn is_full(&self) -> bool {
        self.full
    }

    /// Charge that is left, 0 to 1; `None` before the first second is over.
    #[must_use]
    pub fn charge_left(&self) -> Option<Ratio> {
        self.gauge.charge()
    }

    /// Whether something else charges the pack.
    fn takes_foreign_current(&self, current_ma: i32) -> bool {
        self.control == ChargeControl::Foreign && current_ma >= NO_CURRENT_MA
    }

    /// Whether current flows into the pack, as far as that is measured.
    #[must_use]
    pub fn charges(&self) -> bool {
        let current_ma = self.pack().map_or(0, |(_, current_ma)| current_ma);
        self.is_charging() || self.takes_foreign_current(current_ma)
    }

    /// Voltage of the pack in mV and current into it in mA, averaged over 100 ms; `None` without readings for longer
    /// than 200 ms, or 2 s where they serve no charger.
    #[must_use]
    pub fn pack(&self) -> Option<(i32, i32)> {
        let age_max_ms = match self.control {
            ChargeControl::Ours => AGE_MAX_MS,
            ChargeControl::Foreign => OBSERVED_AGE_MAX_MS,
        };
        let fresh = self.meter.age_ms() <= age_max_ms;
        self.tenth
            .filter(|_| fresh)
            .map(|averages| (averages.pack_mv, averages.current_ma))
    }

    /// Temperature of the pack in hundredths of a degree, averaged over 100 ms; `None` without a plausible reading, and where
    /// it is not known to 3 degrees.
    #[must_use]
    pub fn temperature_cc(&self) -> Option<i32> {
        let range = self.thermometer.temperature()?;
        let width_cc = range.warmest_cc.saturating_sub(range.coldest_cc);
        (width_cc <= 2 * DOUBT_CC).then(|| range.coldest_cc.saturating_add(width_cc / 2))
    }

    pub(crate) const fn thermometer(&self) -> &Thermometer {
        &self.thermometer
    }

    /// Whether the phase charges the pack.
    pub(super) const fn is_charging(&self) -> bool {
        matches!(
            self.phase,
            ChargePhase::Precharge | ChargePhase::Fast | ChargePhase::TopOff
        )
    }
}
