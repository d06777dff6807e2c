//! The views that the page loads after its first picture, on a connection that breaks just then.

use serde_json::json;

use crate::Visit;
use crate::browser::{Browser, Screen};

/// Nothing of the page is kept, and requests for such names end without an answer.
fn block(browser: &Browser, names: &[&str]) {
    browser.devtools("Network.enable", &json!({}));
    browser.devtools("Network.setBypassServiceWorker", &json!({ "bypass": true }));
    browser.devtools("Network.setCacheDisabled", &json!({ "cacheDisabled": true }));
    browser.devtools("Network.setBlockedURLs", &json!({ "urls": names }));
}

#[tokio::test]
async fn a_part_of_the_page_that_does_not_come_is_asked_for_again() {
    let Some(visit) = Visit::begin_alone(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    block(browser, &["*split_late*"]);
    browser.reload().await;
    browser.click("#tab-home").await;
    browser
        .until("return document.querySelector('#sheet-home [role=alert]')?.textContent.includes('could not be loaded')")
        .await;
    browser.shot("phone-part-missing").await;
    // What drives and stops the robot came with the first picture.
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
    block(browser, &[]);
    browser.click("#sheet-home button").await;
    browser
        .until("return document.querySelector('#sheet-home #show-home-rooms') !== null")
        .await;
}
