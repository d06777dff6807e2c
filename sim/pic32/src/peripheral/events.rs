//! What happens at its time: timer periods, compare events, samples, bits on serial lines, clock and watchdog.

use super::analog::{AdcDue, Trigger};
use super::clock::Change;
use super::comparators;
use super::compare;
use super::counter::Counter;
use super::rate::NEVER;
use super::schedule::Slot;
use super::serial;
use super::{Chip, Irq, Misuse, Order, Unmodelled};
use crate::machine::{Outputs, Surroundings};
use crate::pins::{Level, Pin, Port};

/// The numbers of timers and of compares and captures.
const ALL: std::ops::Range<u8> = 0..5;
/// Timer 3, which the analog converter listens to.
const TIMER_3: u8 = 2;

impl Chip {
    /// Lets happen what is due at `cycle` or before.
    pub(crate) fn serve(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) {
        while let Some((slot, due)) = self.schedule.take_due(cycle) {
            self.record.place.cycle = due;
            match slot {
                Slot::Input => self.serve_inputs(due),
                Slot::Timer(number) => self.serve_timer(number, due),
                Slot::Compare(number) => self.serve_compare(number, due),
                Slot::Analog => self.serve_analog(due, surroundings),
                Slot::Transmitter(number) => {
                    self.serials[usize::from(number)].transmit(self.now(due));
                    self.settle_transmitter(number, due);
                }
                Slot::Receiver(number) => {
                    self.serials[usize::from(number)].receive();
                    self.settle_serial(number);
                }
                Slot::Calendar => self.serve_calendar(due),
                Slot::Comparators => self.serve_comparators(due, surroundings),
                Slot::Spi(number) => self.serve_spi(number, due),
                Slot::I2c(number) => self.serve_i2c(number, due),
                Slot::Flash => {
                    self.nvm.finish();
                    self.interrupts.raise(Irq::FLASH, due);
                }
                Slot::Clock => self.serve_clock(due),
                Slot::Wake => self.serve_wake(due),
                Slot::Parallel => self.serve_parallel(due),
                Slot::Watchdog => self.order(Order::Bark),
                Slot::Dma => {
                    // The machine moves it before anything later happens.
                    self.serve_dma(due);
                    break;
                }
            }
        }
        self.settle_request();
    }

    fn serve_timer(&mut self, number: u8, cycle: u64) {
        self.advance_timer(number, cycle);
        self.schedule_timer(number);
    }

    /// Takes the matches of a timer up to `cycle`.
    fn advance_timer(&mut self, number: u8, cycle: u64) {
        if let Some(first) = self.timers.take_match(number, cycle) {
            self.timer_flag(self.timers.interrupt_of(number), first);
        }
    }

    fn timer_flag(&mut self, number: u8, cycle: u64) {
        self.interrupts.raise(Irq::timer(number), cycle);
        if number == TIMER_3 {
            self.trigger_analog(Trigger::Timer3, cycle);
        }
    }

    /// Brings flags of timers and outputs of compares up to `cycle`: before anything that they depend on changes.
    pub(super) fn advance_timers(&mut self, cycle: u64) {
        self.advance_flags(cycle);
        self.advance_outputs(cycle);
    }

    /// Brings flags of timers up to `cycle`.
    pub(super) fn advance_flags(&mut self, cycle: u64) {
        for number in ALL {
            self.advance_timer(number, cycle);
        }
    }

    /// After anything that timers depend on has changed.
    pub(super) fn settle_timers(&mut self, cycle: u64) {
        self.schedule_timers();
        for number in ALL {
            self.schedule_compare(number, cycle);
        }
    }

    /// Matches are events only for those who listen; flags are otherwise worked out when they are read.
    pub(super) fn schedule_timers(&mut self) {
        for number in ALL {
            self.schedule_timer(number);
        }
    }

    fn schedule_timer(&mut self, number: u8) {
        let flagged = self.timers.interrupt_of(number);
        let heard = self.interrupts.is_wanted(Irq::timer(flagged))
            || flagged == TIMER_3 && self.analog.trigger_source() == Trigger::Timer3;
        let due = if heard {
            self.timers.next_match(number)
        } else {
            NEVER
        };
        self.schedule.set(Slot::Timer(number), due);
    }

    /// Which counters run, for [`Chip::begin_pulses`].
    pub(super) fn running_counters(&self) -> [bool; 5] {
        std::array::from_fn(|number| {
            ALL.contains(&(number as u8)) && self.timers.counter(number as u8).is_running()
        })
    }

    /// A timer that starts at 0 begins a period of the pulses that it times.
    pub(super) fn begin_pulses(&mut self, were_running: [bool; 5], cycle: u64) {
        for number in ALL {
            let timer = self.compares[usize::from(number)].timer();
            let counter = *self.timers.counter(timer);
            let starts =
                counter.is_running() && !were_running[usize::from(timer)] && counter.count_at(cycle) == 0;
            let Some(pulse) = self.compares[usize::from(number)]
                .pulse
                .as_mut()
                .filter(|_| starts)
            else {
                continue;
            };
            let before = pulse.level();
            pulse.begin();
            if pulse.level() != before {
                self.ports
                    .note_edge(compare::PINS[usize::from(number)], pulse.level(), cycle);
            }
        }
    }

    fn counter_of(&self, compare: u8) -> &Counter {
        self.timers.counter(self.compares[usize::from(compare)].timer())
    }

    /// Works out a modulated pin up to `cycle`.
    pub(super) fn advance_output(&mut self, number: u8, cycle: u64) {
        let counter = *self.counter_of(number);
        let pin = compare::PINS[usize::from(number)];
        let Some(pulse) = &mut self.compares[usize::from(number)].pulse else {
            return;
        };
        pulse.advance(&counter, cycle, self.ports.edges_of(pin));
    }

    pub(super) fn advance_outputs(&mut self, cycle: u64) {
        for number in ALL {
            self.advance_output(number, cycle);
        }
    }

    /// Before modulation ends: the port goes on with the level that the pin has.
    pub(super) fn release_modulated_pins(&mut self, cycle: u64) {
        for number in ALL {
            self.release_modulated_pin(number, cycle);
        }
    }

    fn release_modulated_pin(&mut self, number: u8, cycle: u64) {
        if let Some(pulse) = &self.compares[usize::from(number)].pulse {
            self.ports
                .take_over(compare::PINS[usize::from(number)], pulse.level(), cycle);
        }
    }

    pub(super) fn write_compare(&mut self, (number, word): (u8, u8), value: u32, cycle: u64) {
        self.advance_output(number, cycle);
        let place = usize::from(number);
        let was_modulated = self.compares[place].pulse;
        self.compares[place].write(word, value, cycle);
        if word == 0 {
            if self.compares[place].mode() == compare::CompareMode::ModulateWithFault {
                self.record.misuse(Misuse::NotModelled(Unmodelled::CompareFault));
            }
            let still = self.compares[place].pulse == was_modulated && was_modulated.is_some();
            if !still {
                if let Some(pulse) = was_modulated {
                    self.ports.take_over(compare::PINS[place], pulse.level(), cycle);
                }
                self.drive_compare_pin(number, cycle);
            }
        }
        self.schedule_compare(number, cycle);
    }

    fn drive_compare_pin(&mut self, number: u8, cycle: u64) {
        let level = self.compares[usize::from(number)].fixed_level();
        self.own(compare::PINS[usize::from(number)], level, cycle);
    }

    fn schedule_compare(&mut self, number: u8, cycle: u64) {
        let due = self.compares[usize::from(number)].next_event(self.counter_of(number), cycle);
        self.schedule.set(Slot::Compare(number), due);
    }

    fn serve_compare(&mut self, number: u8, cycle: u64) {
        let event = self.compares[usize::from(number)].happen();
        self.own(compare::PINS[usize::from(number)], Some(event.level), cycle);
        if event.interrupt {
            self.interrupts.raise(Irq::compare(number), cycle);
        }
        self.schedule_compare(number, cycle);
    }

    /// The level of a pin that PWM drives, if it is one.
    pub(super) fn modulated_level(&self, pin: Pin, cycle: u64) -> Option<Level> {
        let number = compare::PINS.iter().position(|&known| known == pin)?;
        let compare = &self.compares[number];
        compare.pulse.map(|pulse| {
            pulse
                .advanced(self.timers.counter(compare.timer()), cycle)
                .level()
        })
    }

    /// For how many cycles PWM has driven a pin high.
    pub(super) fn modulated_high_cycles(&self, pin: Pin, cycle: u64) -> u64 {
        compare::PINS
            .iter()
            .position(|&known| known == pin)
            .map_or(0, |number| {
                let compare = &self.compares[number];
                compare.high_cycles_at(self.timers.counter(compare.timer()), cycle)
            })
    }

    pub(super) fn trigger_analog(&mut self, trigger: Trigger, cycle: u64) {
        self.analog.trigger(trigger, self.now(cycle));
        self.schedule.set(Slot::Analog, self.analog.next_event());
    }

    fn serve_analog(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) {
        match self.analog.due(cycle) {
            AdcDue::Nothing => {}
            AdcDue::Hold(channel) => {
                let value = self.sample(channel, cycle, surroundings);
                self.analog.hold(value, self.now(cycle));
            }
            AdcDue::Result => {
                if self.analog.finish(self.now(cycle)) {
                    self.interrupts.raise(Irq::ANALOG, cycle);
                }
            }
        }
        self.schedule.set(Slot::Analog, self.analog.next_event());
    }

    fn serve_calendar(&mut self, cycle: u64) {
        if self.calendar.tick(cycle) {
            self.interrupts.raise(Irq::CALENDAR, cycle);
        }
        self.schedule.set(Slot::Calendar, self.calendar.next_event());
    }

    /// After anything that its oscillator depends on.
    pub(super) fn settle_calendar(&mut self, cycle: u64) {
        self.calendar.set_clock(self.clock.secondary_runs(), cycle);
        self.schedule.set(Slot::Calendar, self.calendar.next_event());
    }

    /// The board gets a crystal of 32.768 kHz on RC13 and RC14.
    pub(crate) fn fit_watch_crystal(&mut self, cycle: u64) {
        self.clock.has_watch_crystal = true;
        self.settle_calendar(cycle);
    }

    fn serve_comparators(&mut self, cycle: u64, surroundings: &mut dyn Surroundings) {
        for number in 0..2 {
            let Some((plus, minus)) = self.comparators.inputs(number) else {
                continue;
            };
            let plus = plus.parts(|channel| self.sample(channel, cycle, surroundings));
            let minus = minus.parts(|channel| self.sample(channel, cycle, surroundings));
            if self.comparators.follow(number, plus > minus) {
                self.interrupts.raise(Irq::comparator(number), cycle);
            }
        }
        self.comparators.next_look(cycle);
        self.settle_comparators(cycle);
    }

    /// What the comparators do to their pins, and when they look again.
    pub(super) fn settle_comparators(&mut self, cycle: u64) {
        for (number, pin) in (0..).zip(comparators::OUTPUT_PINS) {
            let level = self.comparators.output(number);
            self.own(pin, level, cycle);
        }
        self.schedule
            .set(Slot::Comparators, self.comparators.next_event());
    }

    fn sample(&mut self, channel: u8, cycle: u64, surroundings: &mut dyn Surroundings) -> u16 {
        let Some(pin) = Pin::new(Port::B, channel) else {
            return 0;
        };
        if self.analog.analog_pins() & pin.mask() == 0 {
            self.record.misuse(Misuse::AnalogPinIsDigital(pin));
            return 0;
        }
        if let Some(level) = self.output(pin, cycle).level() {
            self.record.misuse(Misuse::AnalogPinIsOutput(pin));
            return if level.is_high() { 1023 } else { 0 };
        }
        surroundings.analog(channel, cycle, &Outputs::new(self, cycle))
    }

    pub(super) fn write_serial(&mut self, (number, word): (u8, u8), value: u32, cycle: u64) {
        let now = self.now(cycle);
        let serial = &mut self.serials[usize::from(number)];
        if !serial.write(word, value, now) {
            self.record.misuse(Misuse::TransmitQueueFull(number + 1));
        }
        if serial.has_options() {
            self.record.misuse(Misuse::NotModelled(Unmodelled::SerialOption));
        }
        if word < 2 {
            self.settle_held_pins(cycle);
        }
        self.settle_transmitter(number, cycle);
    }

    /// What the transmitter does to its pin, and what follows from its queue.
    fn settle_transmitter(&mut self, number: u8, cycle: u64) {
        let serial = &self.serials[usize::from(number)];
        let (level, loops_back) = (serial.transmit_level(), serial.loops_back());
        self.own(serial::TRANSMIT_PINS[usize::from(number)], level, cycle);
        if let Some(level) = level.filter(|_| loops_back) {
            self.serials[usize::from(number)].edge(level, self.now(cycle));
        }
        self.settle_serial(number);
    }

    /// Interrupt lines and events of a UART.
    pub(super) fn settle_serial(&mut self, number: u8) {
        let cycle = self.record.place.cycle;
        let serial = &mut self.serials[usize::from(number)];
        let events = std::mem::take(&mut serial.events);
        let lines = serial.lines();
        self.schedule
            .set(Slot::Transmitter(number), serial.next_transmit_event());
        self.schedule
            .set(Slot::Receiver(number), serial.next_receive_event());
        self.interrupts
            .set_line(Irq::serial_error(number), lines.error, cycle);
        self.interrupts
            .set_line(Irq::serial_receive(number), lines.receive, cycle);
        self.interrupts
            .set_line(Irq::serial_transmit(number), lines.transmit, cycle);
        let irqs = (Irq::serial_transmit(number), Irq::serial_receive(number));
        self.note_bus_events(events, irqs);
    }

    fn serve_clock(&mut self, cycle: u64) {
        self.advance_timers(cycle);
        if self.clock.happen() {
            self.interrupts.raise(Irq::CLOCK_MONITOR, cycle);
        }
        self.clock_changed(Change::Rates, cycle);
    }

    /// What a UART has sent since the last call, with the cycle at which each ended.
    pub(crate) fn take_sent(&mut self, number: u8) -> Vec<(u64, serial::Sent)> {
        std::mem::take(&mut self.serials[usize::from(number)].sent)
    }
}
