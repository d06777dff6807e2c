//! The examples of DMA, whichever way requests that stay up start its cells.

use crate::{MS, assert_clean, image, pin, run, text};
use pic32::machine::{Halt, LineRate, Machine, Outputs, Surroundings, Uart};
use pic32::peripheral::{DmaRequests, Sent};
use pic32::pins::Level;

const BOTH: [DmaRequests; 2] = [DmaRequests::WhileUp, DmaRequests::OncePerEvent];

#[test]
fn memory_is_copied_filled_and_summed_up() {
    let Some(image) = image("dma_memory") else { return };
    let mut machine = Machine::new(&image);
    run(&mut machine, 30 * MS);
    let expected = "copied 64 words, same: true, waited: true\nfilled 64 words: true\nstopped midway: true, true\n\
                    up to its end and ..................\ncrc 31c3 Ok(())\n";
    assert_eq!(text(&mut machine, Uart::One), expected);
    assert_clean(&machine);
}

#[test]
fn the_echo_by_dma_gives_every_byte_back() {
    let Some(image) = image("dma_uart") else { return };
    for requests in BOTH {
        let mut machine = Machine::new(&image);
        machine.set_dma_requests(requests);
        machine.set_input(pin("RF2"), Level::High);
        let all: Vec<u8> = (0..=255).cycle().take(1_000).collect();
        let end = machine.send_to_uart(Uart::One, &all, (2 * MS, LineRate { baud: 115_200 }));
        run(&mut machine, end + 20 * MS);
        let back: Vec<Sent> = machine
            .take_sent(Uart::One)
            .into_iter()
            .map(|(_, sent)| sent)
            .collect();
        let expected: Vec<Sent> = all.iter().map(|byte| Sent::Character(u16::from(*byte))).collect();
        assert!(back == expected, "{requests:?}: {} bytes came back", back.len());
        // Low for longer than a character: no stop bit.
        let now = machine.cycle();
        machine.schedule_input(now + MS, pin("RF2"), Level::Low);
        machine.schedule_input(now + MS + 8_000, pin("RF2"), Level::High);
        run(&mut machine, now + 10 * MS);
        let said = text(&mut machine, Uart::One);
        assert!(said.starts_with('?'), "{requests:?}: {said:?}");
        assert_clean(&machine);
    }
}

#[test]
fn words_are_exchanged_without_a_pause_while_the_core_idles() {
    let Some(image) = image("dma_spi") else { return };
    for requests in BOTH {
        let mut machine = Machine::new(&image);
        machine.set_dma_requests(requests);
        machine.watch(pin("RG6"));
        let (mut clocks, mut idle, mut rounds) = (Vec::new(), 0, 0);
        while machine.cycle() < 31 * MS {
            if machine.level(pin("RG9")).is_high() || machine.cycle() < MS {
                let next = machine.cycle() + 20;
                run(&mut machine, next);
                continue;
            }
            // What goes out comes back: the line follows within the half period of four cycles.
            let before = machine.accounting().idle_cycles();
            while machine.level(pin("RG9")) == Level::Low {
                let next = machine.cycle() + 1;
                run(&mut machine, next);
                let level = machine.level(pin("RG8"));
                machine.set_input(pin("RG7"), level);
            }
            idle += machine.accounting().idle_cycles() - before;
            rounds += 1;
            clocks.push(machine.take_edges(pin("RG6")));
        }
        assert!(rounds >= 5, "{rounds} rounds");
        for edges in &clocks[1..] {
            assert_eq!(edges.len(), 16 * 16, "{requests:?}");
            let (first, last) = (edges[0].0, edges[edges.len() - 1].0);
            assert_eq!(
                last - first,
                16 * 8 * 8 - 4,
                "{requests:?}: no pause between words"
            );
        }
        // An exchange lasts 1024 cycles, and around it there is little to do.
        assert!(
            idle / rounds > 700,
            "idle for {} cycles of an exchange",
            idle / rounds
        );
        let said = text(&mut machine, Uart::One);
        let lines: Vec<&str> = said.lines().collect();
        for (round, line) in (0_u8..).zip(&lines[..lines.len() - 1]) {
            let expected: String = (0..16).map(|place| format!("{:02X}", round + place)).collect();
            // The device is joined only once the first exchange has begun.
            if round > 0 {
                assert_eq!(*line, expected, "{requests:?}");
            }
        }
        assert_clean(&machine);
    }
}

/// AN2 rises by one each 2 ms.
struct Slope;

impl Surroundings for Slope {
    fn analog(&mut self, channel: u8, cycle: u64, _: &Outputs<'_>) -> u16 {
        assert_eq!(channel, 2);
        (cycle / (2 * MS)) as u16
    }
}

#[test]
fn samples_come_at_the_timers_pace_while_the_core_idles() {
    let Some(image) = image("dma_adc") else { return };
    let mut machine = Machine::new(&image);
    assert_eq!(machine.run_until(700 * MS, &mut Slope), Halt::Reached);
    let said = text(&mut machine, Uart::Two);
    let means: Vec<Vec<u64>> = said
        .lines()
        .map(|line| {
            line.split(' ')
                .map(|number| number.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert!((5..=6).contains(&means.len()), "{said}");
    for pair in means.windows(2) {
        // 100 blocks of 64 samples are 128 ms, less than a block of 1.28 ms for the pause of each.
        let rise = pair[1][1] - pair[0][1];
        assert!((64..=66).contains(&rise), "{rise} of 2 ms between two lines");
    }
    for line in means {
        assert!(
            line[2] - line[0] <= 1 && line[0] <= line[1] && line[1] <= line[2],
            "{line:?}"
        );
    }
    let idle = machine.accounting().idle_share(machine.cycle());
    assert!(idle > 0.97, "idle {idle}");
    assert_clean(&machine);
}
