//! Wear in the page: a brush that runs hard is shown with a remedy, until a person says that it is clean.

use std::fmt::Write as _;

use crate::Visit;
use crate::browser::Screen;
use crate::stack::Stack;

/// What a daemon has kept of forty minutes of work in which hair came around the brush.
fn wound() -> String {
    let gauge = |usual_a: f64, newest_a: f64| {
        let mut text = String::new();
        let list = |a: f64| vec![a.to_string(); 10].join(",");
        write!(
            text,
            r#"{{"usual_a":[{}],"newest_a":[{}],"marks":40}}"#,
            list(usual_a),
            list(newest_a)
        )
        .unwrap();
        text
    };
    format!(
        r#"{{"version":1,"gauges":{{"brush-main":{},"wheel-left":{},"wheel-right":{}}},"works":{{
            "brush-main":{{"worked_s":46800.0}},"filter":{{"worked_s":590000.0,"is_told":true}},"sensors":{{"worked_s":9000.0}}}}}}"#,
        gauge(0.5, 0.8),
        gauge(0.25, 0.25),
        gauge(0.25, 0.25)
    )
}

#[tokio::test]
async fn a_brush_that_runs_hard_is_shown_until_somebody_has_cleaned_it() {
    let start = || Stack::start_with_state("health.json", &wound());
    for (screen, name) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::with(start, screen).await else {
            return;
        };
        let browser = &visit.browser;
        browser.darken().await;
        browser.click("#tab-device").await;
        browser.says("parts", "runs hard: 160\u{a0}%").await;
        browser.says("parts", "Take hair and threads off it").await;
        browser.says("parts", "as usual: 100\u{a0}%").await;
        browser
            .text("document.getElementById('parts').scrollIntoView({block: 'center'}); return ''")
            .await;
        browser.shot(&format!("{name}-parts-dark")).await;
        crate::accessibility::expect_none(browser, "parts").await;
        browser.click("#cleaned-brush-main").await;
        browser.says("parts", "0 of 10 minutes").await;
        browser.reload().await;
        browser.until_state(&["idle", "docked"]).await;
        browser.click("#tab-device").await;
        browser.says("parts", "0 of 10 minutes").await;
        browser.says("parts", "as usual: 100\u{a0}%").await;
    }
}

/// A filter that has worked for longer than filters do: told calmly, marked as replaced, and taken back.
#[tokio::test]
async fn a_part_that_is_due_by_its_hours_is_replaced_and_that_is_taken_back() {
    let start = || Stack::start_with_state("health.json", &wound());
    let Some(visit) = Visit::with(start, Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-device").await;
    browser.says("parts", "164 of about 150 hours of work").await;
    browser
        .says("parts", "It has worked for as long as such filters usually last")
        .await;
    browser.says("parts", "13 of about 300 hours of work").await;
    browser.says("parts", "2.5 of about 30 hours of work").await;
    let scroll = "document.getElementById('renewed-filter').scrollIntoView({block: 'center'}); return ''";
    browser.text(scroll).await;
    browser.shot("phone-hours").await;
    crate::accessibility::expect_none(browser, "hours of parts").await;
    assert_eq!(browser.text(crate::accessibility::SMALL_TARGETS).await, "");
    browser.click("#renewed-filter").await;
    browser.says("parts", "0 of about 150 hours of work").await;
    browser.says("undo-toast", "Filter: marked as replaced.").await;
    browser.shot("phone-hours-renewed").await;
    browser.click("#undo-removal").await;
    browser.says("parts", "164 of about 150 hours of work").await;
    crate::language::choose(browser, "et").await;
    browser.click("#tab-device").await;
    browser.says("parts", "töötanud 164 tundi umbes 150-st").await;
    browser.darken().await;
    browser.text(scroll).await;
    browser.shot("phone-hours-estonian-dark").await;
    assert_eq!(browser.text(crate::accessibility::TOO_WIDE).await, "0");
}
