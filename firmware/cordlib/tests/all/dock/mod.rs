//! A charger on a dock whose every quantity the test sets: voltage and temperature are what they are, the current follows
//! the duty of the switch.
#![allow(
    unreachable_pub,
    reason = "shared by the files of one program, public to none"
)]

use cordlib::PackParameters;
use cordlib::board::{ChargeDrive, ChargerReadings, DockRequest, TemperatureRange, ThermistorFault};
use cordlib::charge::{ChargeContext, ChargeController, ChargeMemory, ChargeOutput, Docking, MotorActivity};
use rvac_protocol::message::{ChargeEnd, ChargeFault, ChargePhase};
use rvac_units::{Temperature, Tick};

/// The clocks of a charge are stored at this period.
const STORED_MS: u32 = 10_000;

pub struct Dock {
    pub charger: ChargeController,
    pub pack_mv: i32,
    /// Shown instead of what flows.
    pub shown_ma: Option<i32>,
    pub input_mv: Option<i32>,
    /// Tenths of a degree.
    pub temperature: Result<i16, ThermistorFault>,
    /// The reading may be wrong by so many tenths of a degree.
    pub doubt: i16,
    /// Current at full duty.
    pub full_ma: i32,
    /// Current that flows whatever the switch does.
    pub leak_ma: i32,
    pub age_ms: u32,
    pub adapter: bool,
    pub docked: bool,
    pub motors: MotorActivity,
    pub output: ChargeOutput,
    pub step_ms: u32,
    /// A count of noise, as converters have; without it nothing ever changes.
    pub dither: bool,
    /// What the firmware stored last, as it does it: when current begins or ends, and every ten seconds.
    stored: ChargeMemory,
    stored_off: bool,
    now: Tick,
    steps: u32,
    milliseconds: u64,
}

impl Dock {
    /// Docked with a pack at this voltage, at 25 degrees, when the clock shows `start`.
    pub fn at(pack_mv: i32, start: u32) -> Self {
        let charger = ChargeController::new(PackParameters::NIMH_12);
        Self {
            stored: charger.memory(),
            stored_off: true,
            charger,
            pack_mv,
            shown_ma: None,
            input_mv: None,
            temperature: Ok(250),
            doubt: 0,
            full_ma: 1_500,
            leak_ma: 0,
            age_ms: 0,
            adapter: true,
            docked: true,
            motors: MotorActivity::Idle,
            output: ChargeOutput::default(),
            step_ms: 20,
            dither: true,
            now: Tick(start),
            steps: 0,
            milliseconds: 0,
        }
    }

    /// Docked half empty, and charging with full current for ten seconds at least.
    pub fn charging(start: u32) -> Self {
        let mut dock = Self::at(15_000, start);
        dock.run_s(40.0);
        assert_eq!(dock.phase(), ChargePhase::Fast);
        assert!(
            (900..=1_000).contains(&dock.current_ma()),
            "{}",
            dock.current_ma()
        );
        dock
    }

    pub fn current_ma(&self) -> i32 {
        let driven_ma = match self.output.drive {
            ChargeDrive::Off => 0,
            ChargeDrive::Duty(duty) => (f64::from(self.full_ma) * duty.as_f64()) as i32,
        };
        let flows = self.adapter && self.docked;
        if flows { driven_ma.max(self.leak_ma) } else { 0 }
    }

    pub fn step(&mut self) {
        self.steps = self.steps.wrapping_add(1);
        self.milliseconds += u64::from(self.step_ms);
        self.now = self.now.after(self.step_ms);
        let noise = if self.dither {
            (self.steps % 3) as i32 - 1
        } else {
            0
        };
        let readings = ChargerReadings {
            pack_mv: self.pack_mv + 5 * noise,
            input_mv: self.input_mv.unwrap_or(self.pack_mv + self.current_ma() * 3 / 10),
            current_ma: self.shown_ma.unwrap_or(self.current_ma() + 10 * noise),
            temperature: self.temperature.map(|tenths| TemperatureRange {
                coldest: Temperature(tenths + noise as i16 - self.doubt),
                warmest: Temperature(tenths + noise as i16 + self.doubt),
            }),
            age_ms: self.age_ms,
            adapter: self.adapter,
        };
        let context = ChargeContext {
            docking: if self.docked {
                Docking::Docked
            } else {
                Docking::Away
            },
            motors: self.motors,
            load_ma: 15,
        };
        self.output = self.charger.step(Some(readings), context, self.now);
        if self.age_ms > 0 {
            self.age_ms += self.step_ms;
        }
        if self.stored_off != self.is_off() || self.milliseconds.is_multiple_of(u64::from(STORED_MS)) {
            self.stored_off = self.is_off();
            self.stored = self.charger.memory();
        }
    }

    /// The firmware stores what has changed, and the chip starts again.
    pub fn reset_well(&mut self) {
        self.stored = self.charger.memory();
        self.reset();
    }

    /// The chip starts again from what was stored.
    pub fn reset(&mut self) {
        self.charger = ChargeController::new(PackParameters::NIMH_12).taking_up(&self.stored, STORED_MS);
        self.output = ChargeOutput::default();
    }

    pub fn run_s(&mut self, seconds: f64) {
        for _ in 0..(seconds * 1_000.0 / f64::from(self.step_ms)) as u64 {
            self.step();
        }
    }

    /// Brings the pack to this temperature by two degrees a second, in tenths.
    pub fn warm_to(&mut self, tenths: i16) {
        while let Ok(now) = self.temperature
            && now != tenths
        {
            self.temperature = Ok(now + (tenths - now).clamp(-20, 20));
            self.run_s(1.0);
        }
    }

    /// Brings the pack to this voltage by half a volt a second.
    pub fn lift_to(&mut self, pack_mv: i32) {
        while self.pack_mv != pack_mv {
            self.pack_mv += (pack_mv - self.pack_mv).clamp(-500, 500);
            self.run_s(1.0);
        }
    }

    /// Runs while each second `change` has its way with the dock, until the condition holds; seconds it took.
    pub fn run_until(
        &mut self,
        limit_s: u32,
        mut change: impl FnMut(&mut Self, u32),
        condition: impl Fn(&Self) -> bool,
    ) -> u32 {
        for second in 0..limit_s {
            change(self, second);
            self.run_s(1.0);
            if condition(self) {
                return second + 1;
            }
        }
        panic!("not within {limit_s} s: {:?}", self.charger.status());
    }

    /// Seconds since it was made.
    pub fn seconds(&self) -> u32 {
        (self.milliseconds / 1_000) as u32
    }

    pub fn phase(&self) -> ChargePhase {
        self.charger.status().phase
    }

    pub fn end(&self) -> Option<ChargeEnd> {
        self.charger.status().end
    }

    pub fn fault(&self) -> Option<ChargeFault> {
        self.charger.status().fault
    }

    pub fn is_off(&self) -> bool {
        self.output.drive == ChargeDrive::Off
    }

    pub fn asks(&self) -> bool {
        self.output.request == DockRequest::Current
    }
}
