//! The gyro module on one of the chip's UARTs.

use home::GyroReading;

use super::CYCLES_PER_MS;
use super::calibration::Particulars;
use super::gyro_frame::{GyroFitted, GyroLayout, placeholder};
use super::serial::{HostRate, Sender};
use super::wiring::{DigitalLine, Wiring};
use crate::machine::Machine;
use crate::pins::{Level, Pin};

/// Milliseconds from power to the first frame, and from one frame of the placeholder to the next.
const FIRST_MS: u64 = 100;
const PERIOD_MS: u64 = 10;

/// The module.
#[derive(Clone, Debug)]
pub(super) struct EmulatedGyro {
    power: DigitalLine,
    receive: Pin,
    sender: Sender,
    fitted: GyroFitted,
    /// Of an unknown module.
    layout: Option<GyroLayout>,
    period_ms: u64,
    count: u8,
    powered_ms: Option<u64>,
    heading_then: i32,
    edges: Vec<(u64, Level)>,
}

impl EmulatedGyro {
    pub(super) fn new(wiring: &Wiring, (particulars, fitted): (&Particulars, GyroFitted), seed: u64) -> Self {
        let layout = match fitted {
            GyroFitted::Unknown(number) => Some(GyroLayout::unknown(number)),
            GyroFitted::Absent | GyroFitted::Placeholder => None,
        };
        let known = (particulars.gyro_uart, particulars.gyro_baud);
        let (uart, baud) = layout.map_or(known, |layout| (layout.uart, layout.baud));
        Self {
            power: wiring.gyro_power,
            receive: wiring.uart_receive[usize::from(uart.clamp(1, 2)) - 1],
            sender: Sender::new(HostRate::exact(baud), seed),
            fitted,
            layout,
            period_ms: layout.map_or(PERIOD_MS, |layout| layout.period_ms),
            count: 0,
            powered_ms: None,
            heading_then: 0,
            edges: Vec::new(),
        }
    }

    /// The millisecond that begins at `from`.
    pub(super) fn pass_ms(&mut self, from: u64, reading: Option<GyroReading>, machine: &mut Machine) {
        let now_ms = from / CYCLES_PER_MS;
        let powered = self.power.is_on(machine.output(self.power.pin));
        let Some(reading) = reading.filter(|_| powered && self.fitted != GyroFitted::Absent) else {
            self.powered_ms = None;
            self.sender.flush();
            return;
        };
        let since_ms = *self.powered_ms.get_or_insert_with(|| {
            self.heading_then = reading.heading.0;
            now_ms
        });
        let on_ms = now_ms - since_ms;
        if on_ms >= FIRST_MS && (on_ms - FIRST_MS).is_multiple_of(self.period_ms) {
            let frame = self.frame(reading);
            self.sender.send(&frame);
        }
        self.edges.clear();
        self.sender.pass_ms(from, &mut self.edges);
        for (cycle, level) in &self.edges {
            machine.schedule_input(*cycle, self.receive, *level);
        }
    }

    fn frame(&mut self, reading: GyroReading) -> Vec<u8> {
        let turned_urad = f64::from(reading.heading.0.wrapping_sub(self.heading_then));
        let heading = (turned_urad * 1e-6).to_degrees();
        let rate = (f64::from(reading.rate.0) * 1e-6).to_degrees();
        self.count = self.count.wrapping_add(1);
        match &self.layout {
            Some(layout) => layout.frame((heading, rate), self.count),
            None => placeholder((heading, rate)),
        }
    }
}
