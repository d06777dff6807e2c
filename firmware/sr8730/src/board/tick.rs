//! The millisecond: the core timer's interrupt counts it, starts a scan of the converter and wakes the main loop.

use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::Clock;
use pic32mx3_hal::adc::{Channels, Scanner};
use pic32mx3_hal::core_timer::{CoreTimer, Ticker};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{cpu, interrupt};
use rvac_units::Tick;

/// Counts of the core timer in a millisecond: 80 MHz / 2.
const PERIOD_COUNTS: u32 = 40_000;
const COUNTS_PER_US: u32 = 40;

/// Milliseconds since the start, wrapping.
static TICKS: AtomicU32 = AtomicU32::new(0);
/// The core timer when the newest millisecond was counted.
static COUNTED_AT: AtomicU32 = AtomicU32::new(0);
/// 1 while the main loop has not yet taken the newest millisecond.
static NEWS: AtomicU32 = AtomicU32::new(0);
static HANDLER: HandlerCell<vector::CORE_TIMER, Ticking> = HandlerCell::empty();

/// What the handler owns.
#[derive(Debug)]
struct Ticking {
    ticker: Ticker,
    scanner: Scanner,
    channels: Channels,
}

fn on_tick(context: &mut Context<vector::CORE_TIMER>) {
    let Some(ticking) = HANDLER.get(context) else {
        Source::CoreTimer.disable();
        return;
    };
    let ended = ticking.ticker.advance();
    COUNTED_AT.store(cpu::count(), Ordering::Relaxed);
    TICKS.store(
        TICKS.load(Ordering::Relaxed).wrapping_add(ended),
        Ordering::Relaxed,
    );
    ticking.scanner.start(ticking.channels);
    NEWS.store(1, Ordering::Release);
}
interrupt!(CORE_TIMER, on_tick);

/// The board's clock.
#[derive(Debug)]
pub struct TickClock(());

impl TickClock {
    /// Starts the millisecond, with a scan of `channels` in each.
    #[must_use]
    pub fn take(core_timer: CoreTimer, scanner: Scanner, channels: Channels) -> Self {
        let ticking = Ticking {
            ticker: core_timer.into_ticker(PERIOD_COUNTS),
            scanner,
            channels,
        };
        // Given once, because `Peripherals` gives the timer once.
        HANDLER.hand_over(ticking).ok();
        interrupt::set_priority(Vector::CoreTimer, Priority::Level2, SubPriority::Sub0).ok();
        Source::CoreTimer.enable();
        Self(())
    }
}

impl Clock for TickClock {
    fn tick(&mut self) -> Tick {
        Tick(ticks())
    }

    fn microseconds(&mut self) -> u16 {
        let counts = cpu::count().wrapping_sub(COUNTED_AT.load(Ordering::Relaxed));
        (counts / COUNTS_PER_US).min(999) as u16
    }
}

/// Milliseconds since the start, wrapping.
#[inline(always)]
#[must_use]
pub fn ticks() -> u32 {
    TICKS.load(Ordering::Relaxed)
}

/// Sleeps until a millisecond has been counted that [`take_news`] has not returned yet. Other interrupts are served
/// meanwhile.
pub fn wait() {
    while NEWS.load(Ordering::Acquire) == 0 {
        cpu::sleep_while_zero(&NEWS);
    }
}

/// Whether a millisecond has been counted since the last call.
pub fn take_news() -> bool {
    let news = NEWS.load(Ordering::Acquire) != 0;
    // A millisecond that is counted just before this line is not lost: the clock is read afterwards.
    if news {
        NEWS.store(0, Ordering::Relaxed);
    }
    news
}
