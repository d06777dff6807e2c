//! The examples of `firmware/pic32mx3-hal` in the emulated chip: each does what its first comment says.
//!
//! They are built by `cargo xtask test --only emulator`, which names their folder in `RVAC_EXAMPLES`.

mod buses;
mod calendar;
mod comparator;
mod dma;
#[path = "../joined/mod.rs"]
mod joined;
mod parallel;
mod power;

use pic32::image::Image;
use pic32::machine::{Grounded, Halt, LineRate, Machine, Outputs, Surroundings, Uart};
use pic32::peripheral::Sent;
use pic32::pins::{Level, Pin};
use std::path::{Path, PathBuf};

/// Cycles in a millisecond.
const MS: u64 = 80_000;

/// The folder of the examples, if they were built. Where they must be there, it is named.
fn folder() -> Option<PathBuf> {
    let named = std::env::var_os("RVAC_EXAMPLES").map(PathBuf::from);
    let built =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/cross/mipsel-unknown-none/release/examples");
    let folder = named.clone().unwrap_or(built);
    let is_there = folder.join("blink").is_file();
    assert!(
        is_there || named.is_none(),
        "{} holds no examples",
        folder.display()
    );
    if !is_there {
        println!("skipped: the examples are not built (cargo xtask test --only emulator builds them)");
    }
    is_there.then_some(folder)
}

fn image(name: &str) -> Option<Image> {
    let bytes = std::fs::read(folder()?.join(name)).expect("the example was built with the others");
    // `cargo xtask firmware hal` counts these lines.
    println!("runs example {name}");
    Some(Image::from_elf(&bytes).expect("the example fits the chip"))
}

fn pin(name: &str) -> Pin {
    name.parse().expect("the pin exists")
}

fn run(machine: &mut Machine, cycle: u64) {
    assert_eq!(machine.run_until(cycle, &mut Grounded), Halt::Reached);
}

/// Nothing that works by luck, no exception, no register that does not exist.
fn assert_clean(machine: &Machine) {
    assert_eq!(machine.misuses(), []);
    assert_eq!(machine.unknown_accesses(), []);
    assert_eq!(machine.exceptions(), []);
}

fn text(machine: &mut Machine, uart: Uart) -> String {
    let sent = machine.take_sent(uart).into_iter();
    sent.map(|(_, sent)| match sent {
        Sent::Character(character) => char::from(character as u8),
        Sent::Break => '~',
    })
    .collect()
}

#[test]
fn blink_keeps_time_and_sleeps() {
    let Some(image) = image("blink") else { return };
    let mut machine = Machine::new(&image);
    machine.watch(pin("RG7"));
    run(&mut machine, 1_000 * MS);
    let edges = machine.take_edges(pin("RG7"));
    assert!(edges.len() >= 199, "{} changes in a second", edges.len());
    let (first, _) = edges[0];
    for (number, (cycle, level)) in (0..).zip(&edges) {
        let late = *cycle as i64 - (first + number * 5 * MS) as i64;
        assert!(late.abs() < 80, "change {number} is {late} cycles late");
        assert_eq!(*level, Level::of(number % 2 == 0));
    }
    let idle = machine.accounting().idle_share(machine.cycle());
    assert!(idle > 0.995, "idle {idle}");
    assert_clean(&machine);
}

#[test]
fn echo_gives_every_byte_back_and_names_a_broken_one() {
    let Some(image) = image("uart_echo") else { return };
    let mut machine = Machine::new(&image);
    machine.set_input(pin("RF2"), Level::High);
    let all: Vec<u8> = (0..=255).collect();
    let end = machine.send_to_uart(Uart::One, &all, (MS, LineRate { baud: 115_200 }));
    run(&mut machine, end + MS);
    let back = machine.take_sent(Uart::One);
    assert_eq!(back.len(), 256);
    for (byte, (_, sent)) in (0..).zip(back) {
        assert_eq!(sent, Sent::Character(byte));
    }
    // Low for longer than a character: no stop bit.
    let now = machine.cycle();
    machine.schedule_input(now + MS, pin("RF2"), Level::Low);
    machine.schedule_input(now + MS + 8_000, pin("RF2"), Level::High);
    run(&mut machine, now + 3 * MS);
    assert_eq!(text(&mut machine, Uart::One), "!");
    assert_clean(&machine);
}

/// AN2 and AN3 stand still, AN12 rises by one count each millisecond.
struct Slope;

impl Surroundings for Slope {
    fn analog(&mut self, channel: u8, cycle: u64, _: &Outputs<'_>) -> u16 {
        match channel {
            2 => 17,
            3 => 1_023,
            12 => (cycle / MS) as u16,
            _ => panic!("AN{channel} is not scanned"),
        }
    }
}

#[test]
fn a_scan_brings_each_channel_at_its_place() {
    let Some(image) = image("adc_scan") else { return };
    let mut machine = Machine::new(&image);
    assert_eq!(machine.run_until(100 * MS, &mut Slope), Halt::Reached);
    let said = text(&mut machine, Uart::Two);
    let mut last = 0;
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.len() > 45, "{} lines in 100 ms", lines.len());
    for line in &lines[..lines.len() - 1] {
        let an12 = line
            .strip_prefix("2=17 3=1023 12=")
            .expect("both channels at rest are right");
        let an12: u64 = an12.parse().expect("a number");
        assert!((last..100).contains(&an12), "{an12} after {last}");
        last = an12;
    }
    assert!(last >= 90, "the last reading is of {last} ms");
    assert_clean(&machine);
}

#[test]
fn pulse_widths_are_exact_from_none_to_all() {
    let Some(image) = image("pwm_sweep") else { return };
    let mut machine = Machine::new(&image);
    let (up, down) = (pin("RD0"), pin("RD3"));
    while machine.high_cycles(down) == 0 {
        let next = machine.cycle() + 100;
        run(&mut machine, next);
    }
    let begin = machine.cycle();
    for step in 0..=21_u64 {
        run(&mut machine, begin + step * 2 * MS + MS / 2);
        let before = (machine.high_cycles(up), machine.high_cycles(down));
        run(&mut machine, begin + step * 2 * MS + 3 * MS / 2);
        let after = (machine.high_cycles(up), machine.high_cycles(down));
        // 20 periods of 4000 counts; after the sweep the pulses of the first are taken off.
        let expected = if step == 21 {
            (0, 0)
        } else {
            (step * 4_000, (20 - step) * 4_000)
        };
        assert_eq!((after.0 - before.0, after.1 - before.1), expected, "step {step}");
    }
    assert_clean(&machine);
}

#[test]
fn a_bouncing_switch_on_its_pull_up_counts_once() {
    let Some(image) = image("change_notice") else {
        return;
    };
    let mut machine = Machine::new(&image);
    let (switch, lamp) = (pin("RG9"), pin("RG7"));
    machine.watch(lamp);
    run(&mut machine, 10 * MS);
    assert_eq!(machine.level(switch), Level::High, "the pull-up is on");
    for press in 0..6_u64 {
        let begin = (20 + press * 20) * MS;
        for bounce in 0..=press {
            machine.schedule_input(begin + bounce * 9_000, switch, Level::Low);
            if bounce < press {
                machine.schedule_input(begin + bounce * 9_000 + 3_000, switch, Level::High);
            }
        }
        machine.schedule_input(begin + 10 * MS, switch, Level::High);
    }
    run(&mut machine, 150 * MS);
    let edges = machine.take_edges(lamp);
    assert_eq!(edges.len(), 6, "{edges:?}");
    for (press, (cycle, _)) in (0..).zip(edges) {
        let delay = cycle - (20 + press * 20) * MS;
        assert!(
            (2 * MS..2 * MS + 1_000).contains(&delay),
            "press {press}: {delay} cycles"
        );
    }
    let idle = machine.accounting().idle_share(machine.cycle());
    assert!(idle > 0.7, "idle {idle}");
    assert_clean(&machine);
}

#[test]
fn each_reset_is_reported_by_the_start_after_it() {
    let Some(image) = image("reset_cause") else { return };
    let mut machine = Machine::new(&image);
    run(&mut machine, 1_000 * MS);
    let said = text(&mut machine, Uart::One);
    // Power-on and brown-out; software, after an interrupt that nobody handles; watchdog; watchdog in Idle, which wakes the
    // program by a non-maskable interrupt, and the software reset by which that ends; software; software, after a bus error.
    assert_eq!(
        said,
        "0 3\n1 40 UnhandledInterrupt\n2 10\n3 54\n4 40\n5 40 BusErrorOfData\n"
    );
    let resets: Vec<u64> = machine.resets().iter().map(|reset| reset.cycle).collect();
    assert_eq!(resets.len(), 5, "{resets:?}");
    // The watchdog's clock is not exact.
    for watchdog in [1, 2] {
        let after = resets[watchdog] - resets[watchdog - 1];
        assert!((100 * MS..170 * MS).contains(&after), "{after} cycles");
    }
}

#[test]
fn handlers_of_six_levels_leave_each_other_alone() {
    let Some(image) = image("nesting") else { return };
    let mut machine = Machine::new(&image);
    let timers = [
        ("RE1", 4_001),
        ("RE2", 3_001),
        ("RE3", 2_503),
        ("RE4", 2_003),
        ("RE5", 1_511),
    ];
    machine.watch(pin("RG7"));
    for (name, _) in timers {
        machine.watch(pin(name));
    }
    run(&mut machine, 500 * MS);
    assert_eq!(
        machine.high_cycles(pin("RG8")),
        0,
        "a calculation came out differently"
    );
    let rounds = machine.take_edges(pin("RG7")).len();
    assert!(rounds > 500, "{rounds} calculations");
    for (name, period) in timers {
        let edges = machine.take_edges(pin(name)).len() as u64;
        let expected = 500 * MS / period;
        assert!(
            (expected - 20..=expected).contains(&edges),
            "{name}: {edges} of {expected}"
        );
    }
    assert_clean(&machine);
}

#[test]
fn no_wake_up_is_lost() {
    let Some(image) = image("wake") else { return };
    let mut machine = Machine::new(&image);
    machine.watch(pin("RG7"));
    run(&mut machine, 1_000 * MS);
    let edges = machine.take_edges(pin("RG7"));
    assert!(edges.len() > 35_000, "{} changes", edges.len());
    let pulses = edges.chunks_exact(2).map(|pulse| pulse[1].0 - pulse[0].0);
    let longest = pulses.max().expect("there are pulses");
    assert!(longest < 300, "the word waited {longest} cycles");
    assert_clean(&machine);
}

#[test]
fn captured_times_are_those_of_the_edges() {
    let Some(image) = image("capture") else { return };
    let mut machine = Machine::new(&image);
    run(&mut machine, 2 * MS);
    let mut at = 3 * MS;
    let mut expected = Vec::new();
    for period_us in [1_250_u64, 2_000, 40_000, 1_600, 100_000] {
        let pulse = |machine: &mut Machine, begin: u64| {
            machine.schedule_input(begin, pin("RD8"), Level::High);
            machine.schedule_input(begin + 20_000, pin("RD8"), Level::Low);
        };
        pulse(&mut machine, at);
        pulse(&mut machine, at + period_us * 80);
        expected.push(period_us);
        at += (period_us + 5_000) * 80;
    }
    run(&mut machine, at + 5 * MS);
    let said = text(&mut machine, Uart::One);
    let times: Vec<(u64, u64)> = said
        .lines()
        .map(|line| line.split_once(' ').expect("two numbers"))
        .map(|(short, long)| (short.parse().expect("a number"), long.parse().expect("a number")))
        .collect();
    assert_eq!(times.len(), 10, "{said}");
    // Of each pair the second edge tells the period. A count is 0.8 us, and the handler reads the long timer a little later.
    for (period_us, (short, long)) in expected.iter().zip(times.iter().skip(1).step_by(2)) {
        assert!(long.abs_diff(*period_us) <= 3, "{long} instead of {period_us}");
        let turned = period_us % 52_428;
        assert!(short.abs_diff(turned) <= 2, "{short} instead of {turned}");
    }
    let now = machine.cycle();
    for (after, level) in [(1, Level::High), (2, Level::Low), (3, Level::High)] {
        machine.schedule_input(now + after * MS, pin("RE8"), level);
    }
    run(&mut machine, now + 5 * MS);
    assert_eq!(text(&mut machine, Uart::One), "x\n");
    assert_clean(&machine);
}

#[test]
fn a_dead_crystal_takes_the_pulses_off() {
    let Some(image) = image("clock_failure") else {
        return;
    };
    let mut machine = Machine::new(&image);
    let motor = pin("RD0");
    run(&mut machine, 10 * MS);
    let before = machine.high_cycles(motor);
    run(&mut machine, 20 * MS);
    assert_eq!(machine.high_cycles(motor) - before, 10 * MS / 4);
    machine.fail_oscillator();
    // The monitor takes some milliseconds to see it, and the handler runs at a tenth of the speed.
    run(&mut machine, 25 * MS);
    let stopped = machine.high_cycles(motor);
    assert!(machine.level(pin("RG7")).is_high() && machine.level(pin("RG8")).is_high());
    run(&mut machine, 100 * MS);
    assert_eq!(machine.high_cycles(motor), stopped);
    assert_eq!(machine.reset_count(), 0);
    assert_clean(&machine);
}

fn crc_32c(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| (crc >> 1) ^ (0x82F6_3B78 & (crc & 1).wrapping_neg());
    !bytes
        .iter()
        .fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

#[test]
fn ram_is_tested_in_place_and_the_image_knows_its_bytes() {
    let Some(image) = image("self_test") else { return };
    let mut machine = Machine::new(&image);
    run(&mut machine, 400 * MS);
    let said = text(&mut machine, Uart::One);
    let words: Vec<&str> = said.split_whitespace().collect();
    let [
        tested,
        bad,
        program,
        program_crc,
        boot,
        boot_crc,
        check_word,
        check,
        stack,
    ] = words[..]
    else {
        panic!("{said}")
    };
    assert_eq!((tested, bad), ("8192", "0"));
    let part = |bytes: &[u8], length: &str| {
        let length: usize = length.parse().expect("a length");
        assert!(length > 1_000, "{length} bytes");
        format!("{:08x}", crc_32c(&bytes[..length]))
    };
    assert_eq!(program_crc, part(image.flash(), program));
    assert_eq!(boot_crc, part(image.boot(), boot));
    assert_eq!((check_word, check), ("5ea15ea1", "ffffffff"));
    let deepest = machine.deepest_stack().expect("functions were called");
    let stack: u32 = stack.parse().expect("bytes");
    // The paint shows what was written, the stack pointer what could have been.
    let reached = 0x8000_8000 - deepest;
    assert!(stack <= reached && stack + 200 > reached, "{stack} of {reached}");
    assert_eq!(
        machine.high_cycles(pin("RG8")),
        0,
        "a test changed somebody's word"
    );
    assert_clean(&machine);
}

const DATA_PAGE: u32 = 0x1D03_F000;
const MARK: [u8; 4] = *b"KRAM";

fn marks(machine: &Machine) -> usize {
    let mut page = vec![0; 4096];
    machine
        .memory()
        .read(DATA_PAGE, &mut page)
        .expect("the page exists");
    page.chunks_exact(4).take_while(|word| **word == MARK).count()
}

#[test]
fn the_data_page_keeps_words_and_begins_anew_when_full() {
    let Some(mut image) = image("data_flash") else {
        return;
    };
    let mut machine = Machine::new(&image);
    machine.watch(pin("RG7"));
    run(&mut machine, 10 * MS);
    let starts = machine.reset_count() as usize;
    assert!(starts > 3, "{starts} starts");
    assert!((starts..=starts + 1).contains(&marks(&machine)));
    // One pulse in the first start, two in the second ..
    let pulses = machine.take_edges(pin("RG7")).len() / 2;
    let expected = starts * (starts + 1) / 2;
    assert!(
        (expected..=expected + starts + 1).contains(&pulses),
        "{pulses} pulses in {starts} starts"
    );

    image
        .write(DATA_PAGE, &MARK.repeat(1024))
        .expect("the page exists");
    let mut machine = Machine::new(&image);
    assert_eq!(marks(&machine), 1024);
    while machine.reset_count() == 0 {
        let next = machine.cycle() + MS;
        run(&mut machine, next);
        assert!(machine.cycle() < 100 * MS, "the page is not erased within 100 ms");
    }
    assert!((1..5).contains(&marks(&machine)), "{} marks", marks(&machine));
    assert_clean(&machine);
}

/// Puts characters on a pin as a UART would, 8N1, and returns when the last stop bit ends.
fn schedule(machine: &mut Machine, to: Pin, bytes: &[u8], (begin, baud): (u64, u64)) -> u64 {
    let mut bits = 0;
    for byte in bytes {
        let levels = 0x200 | u16::from(*byte) << 1;
        for bit in 0..10 {
            let cycle = begin + bits * 80_000_000 / baud;
            machine.schedule_input(cycle, to, Level::of(levels >> bit & 1 != 0));
            bits += 1;
        }
    }
    begin + bits * 80_000_000 / baud
}

/// What a UART would receive from these edges: looks at the middle of each bit.
fn decode(edges: &[(u64, Level)], baud: f64) -> Vec<u8> {
    let bit = 80_000_000.0 / baud;
    let level = |cycle: f64| {
        let after = edges.partition_point(|(at, _)| (*at as f64) <= cycle);
        after == 0 || edges[after - 1].1.is_high()
    };
    let (mut bytes, mut from) = (Vec::new(), 0.0);
    for (at, falls) in edges.iter().map(|(at, level)| (*at as f64, !level.is_high())) {
        if !falls || at < from {
            continue;
        }
        let sample = |position: f64| level(at + (position + 0.5) * bit);
        assert!(!sample(0.0) && sample(9.0), "start and stop bit at cycle {at}");
        bytes.push((0..8).fold(0, |byte, data| {
            byte | u8::from(sample(f64::from(data + 1))) << data
        }));
        from = at + 9.5 * bit;
    }
    bytes
}

/// Both directions at full speed, every rate; what the interrupts cost is printed (`--nocapture`).
#[test]
fn a_uart_on_pins_without_one_echoes_at_every_rate() {
    let Some(image) = image("soft_uart") else { return };
    for baud in [9_600, 19_200, 38_400, 57_600, 115_200, 230_400_u64] {
        let mut machine = Machine::new(&image);
        machine.set_input(pin("RC13"), Level::High);
        machine.watch(pin("RB7"));
        run(&mut machine, 2 * MS);
        assert!(
            machine.level(pin("RB7")).is_high(),
            "the line is idle before anything is sent"
        );
        let end = schedule(&mut machine, pin("RC13"), b"U", (2 * MS, baud));
        run(&mut machine, end + 5 * MS);
        machine.restart_accounting();
        let mut number = 1_u32;
        let bytes: Vec<u8> = (0..1_500)
            .map(|_| {
                number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (number >> 24) as u8
            })
            .collect();
        let begin = machine.cycle();
        let end = schedule(&mut machine, pin("RC13"), &bytes, (begin, baud));
        run(&mut machine, end);
        let account = machine.accounting();
        let busy = 1.0 - account.idle_share(machine.cycle());
        for (vector, name) in [(26, "edge"), (16, "bit")] {
            let vector = account.vector(vector).expect("the vector exists");
            println!(
                "{baud:>6} {name}: {} times, {:.1} cycles each, longest {}, latest {}, {:.1} % of the time",
                vector.entries,
                vector.cycles as f64 / vector.entries as f64,
                vector.longest_cycles,
                vector.worst_latency_cycles,
                100.0 * vector.cycles as f64 / (machine.cycle() - begin) as f64,
            );
        }
        println!("{baud:>6} busy {:.1} %", 100.0 * busy);
        assert!(busy < 0.8, "{baud}: busy {busy}");
        let later = machine.cycle() + 12 * 80_000_000 / baud + 3 * MS;
        run(&mut machine, later);
        let edges = machine.take_edges(pin("RB7"));
        assert!(decode(&edges, baud as f64) == bytes, "{baud}: the echo differs");
        assert_clean(&machine);
    }
}
