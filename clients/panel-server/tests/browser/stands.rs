//! A robot that stops for a reason: the mark on the map, the sensor readings before, and the same in the history afterwards.

use crate::Visit;
use crate::accessibility::{SMALL_TARGETS, expect_none};
use crate::browser::{Browser, Screen};

/// Checks the screen in both themes.
async fn look(browser: &Browser, name: &str) {
    for theme in ["light", "dark"] {
        browser
            .until(&format!(
                "const is = document.documentElement.dataset.theme === '{theme}'; \
                 if (!is) document.getElementById('theme').click(); return is"
            ))
            .await;
        browser
            .until("return document.getAnimations().length === 0")
            .await;
        browser.shot(&format!("{name}-{theme}")).await;
        expect_none(browser, &format!("{name} in {theme}")).await;
    }
    let width = browser
        .text("return document.documentElement.scrollWidth > document.documentElement.clientWidth")
        .await;
    assert_eq!(width, "false", "{name} is wider than the screen");
    if name.starts_with("phone") {
        assert_eq!(browser.text(SMALL_TARGETS).await, "", "{name}");
    }
}

async fn scroll_to(browser: &Browser, selector: &str) {
    browser
        .text(&format!(
            "document.querySelector('{selector}').scrollIntoView(); return ''"
        ))
        .await;
}

/// The mark is on the map as long as the robot stands still.
async fn is_marked(browser: &Browser, is: bool) {
    let seen = "[...document.querySelectorAll('.number.stop')].some(mark => mark.checkVisibility())";
    browser.until(&format!("return {seen} === {is}")).await;
}

#[tokio::test]
async fn a_lifted_robot_is_marked_and_tells_what_it_felt_then_and_in_its_history() {
    for (screen, name) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::begin_at_home(screen).await else {
            return;
        };
        let browser = &visit.browser;
        browser.press_start().await;
        browser.until_state(&["cleaning"]).await;
        browser.click("#ground-known").await;
        browser.sweeps_more_than(200).await;
        is_marked(browser, false).await;
        visit.stack.hand(r#"{"c":"lift"}"#);
        is_marked(browser, true).await;
        look(browser, &format!("{name}-stands")).await;
        browser.click("#now .evidence summary").await;
        browser
            .until("return document.querySelectorAll('#now .evidence tbody tr').length > 1")
            .await;
        scroll_to(browser, "#now .evidence").await;
        look(browser, &format!("{name}-stands-felt")).await;

        visit.stack.hand(r#"{"c":"put-down"}"#);
        browser.click("#stop").await;
        is_marked(browser, false).await;
        browser.click("#tab-history").await;
        browser
            .until("return document.getElementById('run-1-open') !== null")
            .await;
        browser.click("#run-1-open").await;
        browser
            .until("return document.querySelectorAll('.plot .line').length > 0 && document.querySelector('.stop-mark') !== null")
            .await;
        scroll_to(browser, "#run-title").await;
        look(browser, &format!("{name}-stood")).await;
        browser.click("#run-stops .evidence summary").await;
        browser
            .until("return document.querySelectorAll('#run-stops .evidence tbody tr').length > 1")
            .await;
        scroll_to(browser, "#run-stops").await;
        look(browser, &format!("{name}-stood-felt")).await;
    }
}
