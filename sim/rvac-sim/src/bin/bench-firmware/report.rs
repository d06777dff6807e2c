//! The figures.

use std::io::{self, Write};

use serde::Serialize;

/// Everything that was measured, as one JSON object.
#[derive(Debug, Default, Serialize)]
pub(crate) struct FirmwareReport {
    /// Passes of a main loop that does not sleep in a second, standing.
    pub(crate) main_loop_idle_hz: u32,
    /// The same while driving, with 50 reports a second at 230,400 baud.
    pub(crate) main_loop_driving_hz: u32,
    /// Bytes lost or damaged at full load in both directions at 230,400 baud.
    pub(crate) uart_bytes_lost: u64,
    /// Bytes that went over the line meanwhile.
    pub(crate) uart_bytes_checked: u64,
    /// Simulated time of that.
    pub(crate) uart_flood_seconds: f64,
    /// Longest time from an interrupt's flag to its handler, over all vectors, at full load of the line.
    pub(crate) isr_latency_max_us: f64,
    /// Share of the time that the chip sleeps while driving.
    pub(crate) idle_share: f64,
    /// Deepest stack while driving.
    pub(crate) stack_deepest_bytes: u32,
    /// Simulated seconds in a second on the wall, while driving.
    pub(crate) emulator_real_time: f64,
    /// The same for the logic built for this machine.
    pub(crate) host_built_real_time: f64,
    /// Accesses to registers that the chip does not have.
    pub(crate) unknown_accesses: usize,
    /// Uses of the chip against its rules.
    pub(crate) misuses: usize,
    /// Resets at full load.
    pub(crate) resets: u32,
    /// Breaches of safety rules at full load.
    pub(crate) violations: u32,
    /// Interrupts while driving.
    pub(crate) vectors: Vec<Vector>,
    /// The serial line by software.
    pub(crate) uart: Vec<MeasuredLineRate>,
}

/// One interrupt vector.
#[derive(Debug, Serialize)]
pub(crate) struct Vector {
    /// Its number.
    pub(crate) number: u8,
    /// Entries a second.
    pub(crate) per_second: f64,
    /// Share of all cycles.
    pub(crate) share: f64,
    /// Longest stay.
    pub(crate) longest_us: f64,
    /// Longest time from its flag to its handler.
    pub(crate) latency_us: f64,
}

/// One rate of the serial line.
#[derive(Debug, Serialize)]
pub(crate) struct MeasuredLineRate {
    /// Bits a second.
    pub(crate) baud: u32,
    /// How full the line to the robot was.
    pub(crate) receive_load: f64,
    /// How full the line from the robot was.
    pub(crate) transmit_load: f64,
    /// Share of all cycles in the interrupts of receiving.
    pub(crate) receive_share: f64,
    /// Share of all cycles in the interrupts of sending.
    pub(crate) transmit_share: f64,
    /// Share of all cycles in which the chip did not sleep.
    pub(crate) busy_share: f64,
}

/// What the software of 2016 reached while standing.
const IDLE_2016_HZ: u32 = 60_000;

impl FirmwareReport {
    /// What may not be.
    pub(crate) fn faults(&self) -> Vec<String> {
        let table = [
            (self.uart_bytes_lost, "bytes were lost on the serial line"),
            (u64::from(self.resets), "resets at full load of the line"),
            (u64::from(self.violations), "breaches of safety rules"),
            (
                self.unknown_accesses as u64,
                "accesses to registers that the chip does not have",
            ),
            (self.misuses as u64, "uses of the chip against its rules"),
        ];
        let found = table.into_iter().filter(|(count, _)| *count > 0);
        found.map(|(count, what)| format!("{count} {what}")).collect()
    }

    /// Prints it.
    pub(crate) fn print(&self, as_json: bool) -> anyhow::Result<()> {
        let text = if as_json {
            serde_json::to_string(self)? + "\n"
        } else {
            self.text()
        };
        io::stdout().lock().write_all(text.as_bytes())?;
        Ok(())
    }

    fn text(&self) -> String {
        let mut text = format!(
            "main loop, standing                {:9} passes/s (2016: {IDLE_2016_HZ})\n\
             main loop, driving, 50 reports/s   {:9} passes/s\n\
             chip asleep while driving          {:9.1} %\n\
             deepest stack while driving        {:9} bytes\n\
             emulator, driving                  {:9.2} times real time\n\
             the same logic built for this host {:9.0} times real time\n\
             latency of interrupts, full load   {:9.2} us at most\n\
             bytes lost, full load both ways    {:9} of {} in {:.0} simulated seconds\n",
            self.main_loop_idle_hz,
            self.main_loop_driving_hz,
            self.idle_share * 100.0,
            self.stack_deepest_bytes,
            self.emulator_real_time,
            self.host_built_real_time,
            self.isr_latency_max_us,
            self.uart_bytes_lost,
            self.uart_bytes_checked,
            self.uart_flood_seconds,
        );
        text.push_str("\nvector                  per s   share  longest  latest (driving)\n");
        for vector in &self.vectors {
            text.push_str(&format!(
                "{:2} {:18} {:8.0} {:6.2} % {:5.2} us {:6.2} us\n",
                vector.number,
                name(vector.number),
                vector.per_second,
                vector.share * 100.0,
                vector.longest_us,
                vector.latency_us,
            ));
        }
        text.push_str("\n  baud   line in  line out  interrupts in  interrupts out  chip busy\n");
        for line in &self.uart {
            text.push_str(&format!(
                "{:6} {:7.0} % {:7.0} % {:12.2} % {:13.2} % {:8.1} %\n",
                line.baud,
                line.receive_load * 100.0,
                line.transmit_load * 100.0,
                line.receive_share * 100.0,
                line.transmit_share * 100.0,
                line.busy_share * 100.0,
            ));
        }
        text
    }
}

/// What the firmware uses a vector for.
const fn name(number: u8) -> &'static str {
    match number {
        0 => "core timer",
        3 | 7 | 15 | 19 => "infrared receiver",
        4 => "dock code",
        5 | 9 | 13 | 17 => "wheel encoder",
        11 => "button",
        12 => "charger's gate",
        16 => "serial line out",
        20 => "serial line sampled",
        24 | 32 => "gyro's UART",
        26 => "serial line in",
        27 => "converter",
        34 => "clock monitor",
        _ => "",
    }
}
