//! What all runs come to, in the page: one line that goes on with each run and outlives the daemon.

use crate::Visit;
use crate::accessibility::{SMALL_TARGETS, TOO_WIDE, expect_none};
use crate::browser::{Browser, Screen};
use crate::stack::Stack;

/// What a daemon has kept of 41 runs whose records are gone.
const KEPT: &str = r#"{"version":1,"newest":41,"statistics":{"since_s":1750000000,
    "runs":{"clean":30,"dock":8,"spot":3},"results":{"finished":35,"gave-up":2,"stopped":4},
    "stops":{"command":9,"wheel-drop":5,"dock-not-found":2,"recharging":12},
    "duration_h":41.0,"moving_h":33.5,"swept_m2":1234.0,"path_km":48.25,"bumps":5120}}"#;

fn start() -> Stack {
    Stack::start_with_state("statistics.json", KEPT)
}

async fn look(browser: &Browser, name: &str) {
    browser.shot(name).await;
    expect_none(browser, name).await;
    assert_eq!(browser.text(TOO_WIDE).await, "0", "{name}");
    if name.starts_with("phone") {
        assert_eq!(browser.text(SMALL_TARGETS).await, "", "{name}");
    }
}

#[tokio::test]
async fn what_all_runs_come_to_goes_on_with_each_and_outlives_the_daemon() {
    let Some(mut visit) = Visit::with(start, Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-history").await;
    browser
        .says("lifetime", "All together: 30 cleanings, 33.5 hours, 1234 m²")
        .await;
    browser.click("#lifetime summary").await;
    browser
        .says("lifetime", "cleanings: 30, spots: 3, returns to the dock: 8")
        .await;
    browser.says("lifetime", "48.25 km").await;
    look(browser, "phone-lifetime").await;
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.sweeps_more_than(100).await;
    browser.click("#stop").await;
    browser.says("lifetime", "cleanings: 31").await;
    browser
        .until("return document.getElementById('run-42-open') !== null")
        .await;
    visit.stack.kill_vthal();
    browser.until_state(&["disconnected"]).await;
    visit.stack.start_vthal();
    browser.until_state(&["idle", "docked"]).await;
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    crate::language::choose(browser, "et").await;
    browser.click("#tab-history").await;
    browser.says("lifetime", "31 koristust").await;
    browser.darken().await;
    browser.click("#lifetime summary").await;
    look(browser, "phone-lifetime-estonian-dark").await;
}
