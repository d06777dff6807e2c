//! The history in the page: a run is stopped, found, seen again and saved.

use crate::Visit;
use crate::accessibility::expect_none;
use crate::browser::{Browser, Screen};

#[tokio::test]
async fn a_run_that_was_stopped_is_found_seen_again_and_saved_on_a_phone_in_the_dark() {
    let Some(visit) = Visit::begin(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.darken().await;
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.sweeps_more_than(200).await;
    browser.click("#pause").await;
    browser.until_state(&["paused"]).await;
    browser.click("#tab-history").await;
    browser
        .until("return document.getElementById('history-sheet').innerText.includes('No runs yet')")
        .await;
    browser.click("#stop").await;
    browser
        .until("return document.querySelector('#runs li')?.innerText.includes('Stopped by panel.') === true")
        .await;
    browser.shot("phone-history").await;

    browser.click("#run-1-open").await;
    browser
        .until("return document.getElementById('run-stops')?.innerText.includes('Paused: it was requested. By panel.') === true")
        .await;
    browser
        .until("return document.querySelectorAll('.plot .line').length > 0 && document.getElementById('replay-time') !== null")
        .await;
    see_again(browser).await;
    browser
        .text("document.getElementById('run-title').scrollIntoView(); return ''")
        .await;
    browser.shot("phone-run").await;
    expect_none(browser, "an opened run").await;
    let width = browser
        .text("return document.documentElement.scrollWidth > document.documentElement.clientWidth")
        .await;
    assert_eq!(width, "false", "the page is wider than the phone");

    save(browser).await;
}

/// Moves the slider to the begin, and lets the run go on to its end.
async fn see_again(browser: &Browser) {
    let place = "return document.getElementById('replay-robot').getAttribute('transform')";
    let end = browser.text(place).await;
    let slide = "const slider = document.getElementById('replay-time'); slider.value = 0; \
                 slider.dispatchEvent(new Event('input', {bubbles: true})); return ''";
    browser.text(slide).await;
    browser
        .until(&format!(
            "return document.getElementById('replay-robot').getAttribute('transform') !== '{end}'"
        ))
        .await;
    browser.click("#replay-play").await;
    browser
        .until("return document.querySelector('.run-picture .sweeping').getAttribute('d').length > 20")
        .await;
    browser
        .until(&format!(
            "return document.getElementById('replay-robot').getAttribute('transform') === '{end}'"
        ))
        .await;
}

/// Fetches what the link gives: a recording.
async fn save(browser: &Browser) {
    let fetch = "const link = document.getElementById('save-recording'); window.saved = ''; \
                 fetch(link.href).then(async answer => { \
                     const bytes = new Uint8Array(await answer.arrayBuffer()); \
                     window.saved = answer.headers.get('content-disposition') + ' ' + Array.from(bytes.slice(0, 8)).join(' '); \
                 }); return ''";
    browser.text(fetch).await;
    browser.until("return window.saved !== ''").await;
    let saved = browser.text("return window.saved").await;
    // The magic of MCAP.
    assert!(
        saved.starts_with("attachment; filename=\"recording-")
            && saved.ends_with(" 137 77 67 65 80 48 13 10"),
        "{saved}"
    );
}
