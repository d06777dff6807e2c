//! Levels of chosen pins as a value change dump (VCD, IEEE 1364), which GTKWave and most other viewers read.

use crate::machine::Machine;
use crate::peripheral::CYCLES_PER_S;
use crate::pins::{Level, Pin};
use std::io::{self, Write};

/// The unit of time in the file: a cycle is 12.5 ns, so that picoseconds keep it exact.
const PS_PER_CYCLE: u64 = 1_000_000_000_000 / CYCLES_PER_S;

/// A dump that is being written.
#[derive(Debug)]
pub struct Vcd<W> {
    file: W,
    pins: Vec<Pin>,
    /// The cycle of the last change that was written.
    written: Option<u64>,
}

impl<W: Write> Vcd<W> {
    /// Begins a dump of these pins (each once) with their levels now; the machine watches them from now on.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(file: W, machine: &mut Machine, pins: &[Pin]) -> io::Result<Vcd<W>> {
        let mut kept: Vec<Pin> = pins.to_vec();
        kept.sort_unstable();
        kept.dedup();
        for &pin in &kept {
            machine.watch(pin);
            machine.take_edges(pin);
        }
        let mut vcd = Vcd {
            file,
            pins: kept,
            written: None,
        };
        vcd.head()?;
        writeln!(vcd.file, "#{}\n$dumpvars", machine.cycle() * PS_PER_CYCLE)?;
        for (place, pin) in vcd.pins.clone().into_iter().enumerate() {
            vcd.value(place, machine.level(pin))?;
        }
        writeln!(vcd.file, "$end")?;
        vcd.written = Some(machine.cycle());
        Ok(vcd)
    }

    fn head(&mut self) -> io::Result<()> {
        writeln!(self.file, "$timescale 1ps $end\n$scope module pic32 $end")?;
        for (place, pin) in self.pins.iter().enumerate() {
            writeln!(self.file, "$var wire 1 {} {pin} $end", identifier(place))?;
        }
        writeln!(self.file, "$upscope $end\n$enddefinitions $end")
    }

    fn value(&mut self, place: usize, level: Level) -> io::Result<()> {
        writeln!(self.file, "{}{}", u8::from(level.is_high()), identifier(place))
    }

    /// Writes what happened on the pins since the last call.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn record(&mut self, machine: &mut Machine) -> io::Result<()> {
        let mut changes: Vec<(u64, usize, Level)> = Vec::new();
        for (place, &pin) in self.pins.iter().enumerate() {
            let edges = machine.take_edges(pin);
            changes.extend(edges.into_iter().map(|(cycle, level)| (cycle, place, level)));
        }
        changes.sort_by_key(|&(cycle, place, _)| (cycle, place));
        for (cycle, place, level) in changes {
            self.time(cycle)?;
            self.value(place, level)?;
        }
        Ok(())
    }

    fn time(&mut self, cycle: u64) -> io::Result<()> {
        if self.written != Some(cycle) {
            writeln!(self.file, "#{}", cycle * PS_PER_CYCLE)?;
            self.written = Some(cycle);
        }
        Ok(())
    }

    /// Writes what is left and the end of time, and gives the file back.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn end(mut self, machine: &mut Machine) -> io::Result<W> {
        self.record(machine)?;
        self.time(machine.cycle())?;
        self.file.flush()?;
        Ok(self.file)
    }
}

/// A short printable name: base 94 from '!' on.
fn identifier(place: usize) -> String {
    let mut name = String::new();
    let mut rest = place;
    loop {
        name.push(char::from(b'!' + u8::try_from(rest % 94).unwrap_or(0)));
        rest /= 94;
        if rest == 0 {
            return name;
        }
    }
}
