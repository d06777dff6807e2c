//! Learned calibration in the page: shown with its uncertainty, and deleted after a second confirmation.

use crate::Visit;
use crate::accessibility::{SMALL_TARGETS, expect_none};
use crate::browser::{Browser, Screen};
use crate::stack::Stack;

/// What a daemon has kept of the robot of these tests, and of another one.
const KEPT: &str = r#"{"version":1,"devices":[
    {"device":"relax","energy":{"cleaning_per_s":0.0003,"driving_per_s":0.0001,"seen_s":600.0}},
    {"device":"sr8730","gyro":{"scale":0.012,"scale_sigma":0.001,"bias_rad_per_s":-0.0001},
     "energy":{"cleaning_per_s":0.00025,"driving_per_s":0.0001,"seen_s":1200.0},"learnt_s":1800000000}]}"#;

fn start() -> Stack {
    Stack::start_with_state("learnt.json", KEPT)
}

async fn is_shown(browser: &Browser, row: &str, is: bool) {
    browser
        .until(&format!(
            "return (document.getElementById('{row}') !== null) === {is}"
        ))
        .await;
}

/// Checks the sheet in the theme that the page has now.
async fn look(browser: &Browser, name: &str) {
    browser
        .text("document.getElementById('learnt').scrollIntoView({ block: 'center' }); return ''")
        .await;
    browser.shot(name).await;
    expect_none(browser, name).await;
    if name.starts_with("phone") {
        assert_eq!(browser.text(SMALL_TARGETS).await, "", "{name}");
    }
}

#[tokio::test]
async fn what_was_learnt_is_shown_and_forgotten_only_after_a_second_word() {
    for (screen, name) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::with(start, screen).await else {
            return;
        };
        let browser = &visit.browser;
        browser.click("#tab-device").await;
        browser
            .says("learnt", "counts 1.20\u{a0}% too little, ± 0.10\u{a0}%")
            .await;
        browser.says("learnt", "Last calibrated 2027-01-15").await;
        browser.says("learnt", "takes 90\u{a0}% of a full charge").await;
        browser.click("#forget-gyro-sr8730").await;
        browser
            .until("return document.activeElement.id === 'learnt-keep'")
            .await;
        look(browser, &format!("{name}-learnt")).await;
        browser.darken().await;
        look(browser, &format!("{name}-learnt-dark")).await;
        browser.click("#learnt-keep").await;
        browser
            .until("return document.activeElement.id === 'forget-gyro-sr8730'")
            .await;
        is_shown(browser, "learnt-forget", false).await;

        browser.click("#forget-gyro-sr8730").await;
        browser.click("#learnt-forget").await;
        is_shown(browser, "forget-gyro-sr8730", false).await;
        is_shown(browser, "forget-energy-sr8730", true).await;
        browser.click("#forget-energy-relax").await;
        browser.click("#learnt-forget").await;
        is_shown(browser, "learnt-relax", false).await;
        browser.reload().await;
        browser.until_state(&["idle", "docked"]).await;
        browser.click("#tab-device").await;
        is_shown(browser, "forget-energy-sr8730", true).await;
        is_shown(browser, "forget-gyro-sr8730", false).await;
    }
}
