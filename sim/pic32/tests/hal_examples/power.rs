//! The examples that change the clock or stop it.

use crate::{MS, assert_clean, image, pin, run, text};
use pic32::machine::{Machine, Uart};
use pic32::pins::Level;

#[test]
fn each_clock_has_its_speed_for_core_and_peripherals() {
    let Some(image) = image("clock_switch") else {
        return;
    };
    let mut machine = Machine::new(&image);
    machine.watch(pin("RG7"));
    machine.watch(pin("RD0"));
    run(&mut machine, 40 * MS);
    assert_eq!(machine.level(pin("RE0")), Level::Low, "no switch failed");
    let changes: Vec<u64> = machine.take_edges(pin("RG7")).iter().map(|edge| edge.0).collect();
    let pulses: Vec<u64> = machine
        .take_edges(pin("RD0"))
        .iter()
        .filter(|edge| edge.1.is_high())
        .map(|edge| edge.0)
        .collect();
    // 1000 counts at half of 80, 8, 60 and 8 MHz, and 4000 clocks at 80, 8, 15 and 8 MHz, in cycles of 80 MHz.
    let expected = [
        (2_000, 4_000),
        (20_000, 40_000),
        (2_667, 21_333),
        (20_000, 40_000),
        (2_000, 4_000),
    ];
    for (turn, (change, period)) in expected.into_iter().enumerate() {
        let begin = turn * 20;
        let of_turn = &changes[begin..begin + 20];
        let mean = (of_turn[19] - of_turn[0]) as f64 / 19.0;
        assert!(
            (mean - f64::from(change)).abs() < 8.0,
            "turn {turn}: {mean} cycles"
        );
        let inside: Vec<u64> = pulses
            .iter()
            .copied()
            .filter(|pulse| (of_turn[1]..of_turn[19]).contains(pulse))
            .collect();
        assert!(inside.len() >= 2, "turn {turn}: {} pulses", inside.len());
        let period_there = (inside[inside.len() - 1] - inside[0]) as f64 / (inside.len() - 1) as f64;
        assert!(
            (period_there - f64::from(period)).abs() < 2.0,
            "turn {turn}: {period_there} cycles"
        );
    }
    assert_clean(&machine);
}

#[test]
fn a_sleeping_chip_wakes_by_a_switch_and_its_core_timer_stood_still() {
    let Some(image) = image("deep_sleep") else { return };
    let mut machine = Machine::new(&image);
    let (switch, lamp) = (pin("RG9"), pin("RG7"));
    machine.watch(lamp);
    for press in 1..=4_u64 {
        machine.schedule_input(
            press * 200 * MS,
            switch,
            if press % 2 == 1 { Level::Low } else { Level::High },
        );
    }
    run(&mut machine, 1_000 * MS);
    let edges = machine.take_edges(lamp);
    assert_eq!(edges.len(), 4, "{edges:?}");
    for (press, (cycle, _)) in (1..).zip(edges) {
        // 10 us, 1024 cycles of the crystal, 2 ms for the PLL; then the handler and the way back.
        let late = cycle - press * 200 * MS;
        assert!(
            (171_040..171_040 + 800).contains(&late),
            "press {press}: {late} cycles"
        );
    }
    assert_eq!(text(&mut machine, Uart::One), "Sleep, few counts\n".repeat(4));
    assert_clean(&machine);
}
