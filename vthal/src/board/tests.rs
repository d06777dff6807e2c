//! The thread on simulated lines: what is pressed, what is lit, and what happens when the lines are lost.

use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

use tokio::sync::mpsc::{Receiver, channel};
use vthal_core::Lights;

use super::gpio::GpioLines;
use super::{BoardEvent, BoardLines, BoardSettings, LightLines, LinesError, PressedLevel, start_with};
use crate::event::Event;

/// A chip whose levels a test sets and reads.
#[derive(Clone, Debug, Default)]
struct Chip(Arc<(Mutex<Levels>, Condvar)>);

#[derive(Debug, Default)]
struct Levels {
    down: u8,
    lights: Lights,
    /// How often somebody looked at the buttons.
    looks: u32,
    is_broken: bool,
}

impl Chip {
    fn change(&self, change: impl FnOnce(&mut Levels)) {
        change(&mut self.0.0.lock().expect("no panic"));
        self.0.1.notify_all();
    }

    /// Waits until the chip is so.
    fn until(&self, wanted: impl Fn(&Levels) -> bool) {
        let levels = self.0.0.lock().expect("no panic");
        drop(
            self.0
                .1
                .wait_while(levels, |levels| !wanted(levels))
                .expect("no panic"),
        );
    }

    /// Waits until the thread has looked at what was changed.
    fn seen(&self) {
        let looks = self.0.0.lock().expect("no panic").looks;
        self.until(|levels| levels.looks > looks + 1);
    }
}

impl BoardLines for Chip {
    fn buttons(&mut self, _: Duration) -> Result<u8, LinesError> {
        let mut levels = self.0.0.lock().expect("no panic");
        levels.looks += 1;
        self.0.1.notify_all();
        if levels.is_broken {
            let reason = "unplugged".to_owned();
            return Err(LinesError::Lost {
                what: "buttons",
                reason,
            });
        }
        Ok(levels.down)
    }

    fn show(&mut self, lights: Lights) -> Result<(), LinesError> {
        self.change(|levels| levels.lights = lights);
        Ok(())
    }
}

fn next(events: &mut Receiver<Event>) -> BoardEvent {
    match events.blocking_recv() {
        Some(Event::Board(event)) => event,
        other => panic!("not of the board: {other:?}"),
    }
}

#[test]
fn presses_are_told_one_by_one_and_lights_follow() {
    let (sender, mut events) = channel(8);
    let chip = Chip::default();
    let lines = chip.clone();
    let mut lights = start_with(move || Ok(lines.clone()), sender).expect("a thread");
    assert_eq!(next(&mut events), BoardEvent::Opened(0));
    for down in [0b001, 0b101, 0b100, 0] {
        chip.change(|levels| levels.down = down);
        assert_eq!(next(&mut events), BoardEvent::Buttons(down));
    }
    let working = Lights {
        working: true,
        ..Lights::default()
    };
    lights.show(working);
    chip.until(|levels| levels.lights == working);
    drop(lights);
    chip.until(|levels| levels.lights == Lights::default());
}

#[test]
fn a_button_that_was_down_at_the_start_counts_once_it_was_released() {
    let (sender, mut events) = channel(8);
    let chip = Chip::default();
    chip.change(|levels| levels.down = 0b011);
    let lines = chip.clone();
    let _lights = start_with(move || Ok(lines.clone()), sender).expect("a thread");
    assert_eq!(next(&mut events), BoardEvent::Opened(0b011));
    chip.change(|levels| levels.down = 0b010);
    chip.seen();
    chip.change(|levels| levels.down = 0b011);
    assert_eq!(
        next(&mut events),
        BoardEvent::Buttons(0b001),
        "button 1 is stuck still"
    );
}

#[test]
fn lost_lines_are_reported_once_with_the_reason() {
    let (sender, mut events) = channel(8);
    let chip = Chip::default();
    let lines = chip.clone();
    let _lights = start_with(move || Ok(lines.clone()), sender).expect("a thread");
    assert_eq!(next(&mut events), BoardEvent::Opened(0));
    chip.change(|levels| levels.is_broken = true);
    let said = "the buttons can no longer be used: unplugged";
    assert_eq!(next(&mut events), BoardEvent::Absent(said.to_owned()));
    chip.change(|levels| levels.is_broken = false);
    assert_eq!(next(&mut events), BoardEvent::Opened(0), "not a second report");
}

#[test]
fn a_chip_that_is_not_there_is_named_with_what_to_do() {
    let settings = BoardSettings {
        chip: "/does/not/exist".into(),
        buttons: vec![4],
        pressed: PressedLevel::Low,
        lights: LightLines::default(),
    };
    let said = GpioLines::open(&settings).expect_err("no chip").to_string();
    assert!(
        said.starts_with("cannot use the buttons on /does/not/exist: "),
        "{said}"
    );
    assert!(said.contains("check board.chip"), "{said}");
}
