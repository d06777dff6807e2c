//! Parameters of carpet detection. They are tuned to the simulator's own model of a pile: no current of a real robot on carpet is at
//! hand. `docs/book/src/measurements/carpet.md` shows what they find together; no record compares values of a single one.

/// When the floor counts as carpet. Excess is the load above that of hard floor, relative.
pub(super) struct CarpetParameters {
    /// Least excess at which carpet begins: half of what the flattest mats add, and four times the scatter.
    pub(super) excess_on: f32,
    /// Least excess at which carpet goes on.
    pub(super) excess_off: f32,
    /// Interval of baseline samples, microseconds.
    pub(super) sample_interval_us: u64,
    /// Carpet samples after which the robot knows both surfaces and may report hard floor: half a metre of travel.
    pub(super) contrast_samples: u32,
    /// Most driving modes with a baseline: brush powers and speeds.
    pub(super) modes_max: usize,
}

pub(super) const CARPET: CarpetParameters = CarpetParameters {
    excess_on: 0.20,
    excess_off: 0.12,
    sample_interval_us: 500_000,
    contrast_samples: 4,
    modes_max: 6,
};

/// How the load of hard floor is learnt.
pub(super) struct BaselineParameters {
    /// Most samples: two and a half minutes of steady driving.
    pub(super) samples_max: usize,
    /// Least samples for a baseline: a quarter of a minute.
    pub(super) samples_min: usize,
    /// Share of the samples below the baseline.
    pub(super) quantile: f32,
    /// A motor's load below this is noise of the converter, amperes.
    pub(super) load_min_a: f32,
}

pub(super) const BASELINE: BaselineParameters = BaselineParameters {
    samples_max: 300,
    samples_min: 30,
    quantile: 0.2,
    load_min_a: 0.02,
};

/// When the robot drives steadily, so that its loads can be compared.
pub(super) struct SteadyParameters {
    /// Window of the median load, microseconds: it rejects anything shorter than 3 cm.
    pub(super) load_window_us: u64,
    /// Window of the speed, microseconds.
    pub(super) speed_window_us: u64,
    /// Steady driving persists this long before its loads count, microseconds: transients have decayed.
    pub(super) settle_us: u64,
    /// A brush runs evenly this long after a change of its power, microseconds.
    pub(super) spin_up_us: u64,
    /// Least speed of steady driving. Slower driving is backing off, turning or probing.
    pub(super) speed_min_m_per_s: f64,
    /// Steps of speed: loads are comparable within one.
    pub(super) speed_step_m_per_s: f64,
    /// Least relative difference of the wheels in a curve.
    pub(super) curve_min: f64,
    /// Least relative change of speed in an acceleration.
    pub(super) change_min: f64,
    /// Delay of the measured current, seconds: the motor's lag and half a report.
    pub(super) lag_s: f64,
}

pub(super) const STEADY: SteadyParameters = SteadyParameters {
    load_window_us: 250_000,
    speed_window_us: 120_000,
    settle_us: 80_000,
    spin_up_us: 600_000,
    speed_min_m_per_s: 0.1,
    speed_step_m_per_s: 0.05,
    curve_min: 0.3,
    change_min: 0.2,
    lag_s: 0.06,
};
