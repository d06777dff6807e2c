//! How long the wheels turn after the driver is lost in ways that only a browser has.

use std::time::{Duration, Instant};

use crate::browser::Screen;
use crate::mixes::{is_ready, plug_in, turn_by_pad};
use crate::rival::Rival;
use crate::robot::Observer;
use crate::{Visit, hold_until_it_turns};

/// Longest time from the loss until the wheels stop, as measured ten times a second.
const STANDS_WITHIN: Duration = Duration::from_millis(1000);

/// How often each loss is tried.
pub(crate) fn times() -> usize {
    let wanted = std::env::var("RVAC_LOSSES").ok();
    wanted.map_or(1, |text| text.parse().expect("RVAC_LOSSES is a number"))
}

/// How long the wheels went on in each trial.
#[derive(Debug, Default)]
pub(crate) struct Losses(Vec<Duration>);

impl Losses {
    /// Waits for rest after a loss that is noticed at this moment, now or later.
    pub(crate) fn watch(&mut self, witness: &Observer, lost: Instant) {
        let until_then = lost.saturating_duration_since(Instant::now());
        let stood = witness
            .stands_within(until_then + Duration::from_secs(3))
            .expect("the robot drives on although nobody drives it");
        self.0.push(stood.saturating_duration_since(lost));
    }

    pub(crate) fn tell(mut self, what: &str) {
        self.0.sort_unstable();
        let count = self.0.len();
        let (median, worst) = (self.0[count / 2], self.0[count - 1]);
        println!(
            "the wheels stood {} ms after {what} (worst of {count}: {} ms)",
            median.as_millis(),
            worst.as_millis()
        );
        assert!(worst < STANDS_WITHIN, "{worst:?} after {what}");
    }
}

/// Open floor in front of the dock, which a robot on it faces along x.
pub(crate) const OFF_DOCK: &str = r#"{"c":"place","x":-0.6,"y":0.0,"heading":3.14}"#;

/// A robot that was put beside its dock, and an observer of its pose.
pub(crate) async fn ready_to_drive(screen: Screen) -> Option<(Visit, Observer)> {
    let visit = Visit::begin_alone(screen).await?;
    visit.stack.hand(OFF_DOCK);
    visit.browser.until_state(&["idle"]).await;
    let witness = Observer::watch(&visit.stack.simulator_socket());
    Some((visit, witness))
}

/// What was held when the driver was lost drives no more when the driver is back.
pub(crate) fn stays(witness: &Observer, what: &str) {
    let moves = witness.moves_within(Duration::from_secs(1));
    assert!(!moves, "{what} that was held meanwhile drives");
}

#[tokio::test]
async fn a_hidden_tab_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let mut losses = Losses::default();
    for trial in 0..times() {
        hold_until_it_turns(browser, &witness).await;
        if trial == 0 {
            browser.shot("desktop-driving").await;
        }
        browser.hide_behind_a_new_tab().await;
        losses.watch(&witness, Instant::now());
        browser.close_tab_and_return().await;
        browser.release_key('a').await;
        stays(&witness, "a key");
        is_ready(browser).await;
    }
    losses.tell("the tab was hidden");
}

#[tokio::test]
async fn a_lost_gamepad_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    plug_in(browser).await;
    let mut losses = Losses::default();
    for _ in 0..times() {
        turn_by_pad(browser, &witness).await;
        browser.text("window.plugged = false; return ''").await;
        losses.watch(&witness, Instant::now());
        browser.text("window.plugged = true; return ''").await;
        stays(&witness, "a stick");
        browser.text("stick(0, 0); return ''").await;
        is_ready(browser).await;
    }
    losses.tell("the pad was lost");
}

/// A pushed pad may say nothing for so long.
const PAD_SILENT: Duration = Duration::from_secs(2);

/// The browser goes on to show the last position of a pad without power.
#[tokio::test]
async fn a_pad_without_power_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    plug_in(browser).await;
    let mut losses = Losses::default();
    for _ in 0..times() {
        turn_by_pad(browser, &witness).await;
        browser.text("window.trembles = false; return ''").await;
        losses.watch(&witness, Instant::now() + PAD_SILENT);
        browser.says("drive-state", "says nothing any more").await;
        browser.text("window.trembles = true; return ''").await;
        stays(&witness, "a stick that is heard again");
        browser.text("stick(0, 0); return ''").await;
        is_ready(browser).await;
    }
    losses.tell("a pushed pad had said nothing for two seconds");
}

/// The computer in front of which the person sits stops in the middle of a word: nothing says good-bye.
#[tokio::test]
async fn a_browser_that_freezes_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let mut losses = Losses::default();
    for _ in 0..times() {
        hold_until_it_turns(browser, &witness).await;
        let frozen = browser.freeze();
        assert!(frozen.count() > 2, "a browser has several processes");
        losses.watch(&witness, Instant::now());
        drop(frozen);
        browser.release_key('a').await;
        is_ready(browser).await;
    }
    losses.tell("the browser froze");
}

/// Somebody who wanted to turn the robot for a second while the first driver turned it the other way, and was refused all the
/// time. A browser that does not come to its turn for longer than a lease has lost its seat before the test takes it away: nobody
/// drives then, and the first driver begins again.
async fn second_is_refused(visit: &Visit, witness: &Observer) -> Rival {
    let browser = &visit.browser;
    for _ in 0..3 {
        hold_until_it_turns(browser, witness).await;
        let mut rival = Rival::at(&visit.stack.daemon_socket());
        let (granted, refused) = rival.turn_for_a_second(-0.8);
        assert_eq!(granted, 0, "two drive at once");
        let busy = refused
            .iter()
            .take_while(|reason| *reason == "driver-busy")
            .count();
        if busy == refused.len() {
            return rival;
        }
        assert!(
            busy > 0 && refused.iter().skip(busy).all(|reason| reason == "centre-first"),
            "{refused:?}"
        );
        browser.release_key('a').await;
        is_ready(browser).await;
    }
    browser
        .fail("the first driver loses its seat again and again")
        .await
}

/// Of two clients that ask to drive one does; the other has the seat when the first is lost, and loses it in the same way.
#[tokio::test]
async fn a_second_driver_waits_until_the_first_is_lost() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let [mut of_first, mut of_second] = [Losses::default(), Losses::default()];
    for _ in 0..times() {
        let mut rival = second_is_refused(&visit, &witness).await;
        browser.hide_behind_a_new_tab().await;
        of_first.watch(&witness, Instant::now());
        let (granted, refused) = rival.turn_for_a_second(-0.8);
        assert_eq!(granted, 11, "{refused:?}");
        assert!(witness.moves_within(Duration::from_secs(1)), "the second drives");
        drop(rival);
        of_second.watch(&witness, Instant::now());
        browser.close_tab_and_return().await;
        browser.release_key('a').await;
        stays(&witness, "a key");
        is_ready(browser).await;
    }
    of_first.tell("the first of two drivers was lost");
    of_second.tell("the second of them was lost");
}
