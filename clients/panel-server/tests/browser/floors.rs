//! Floors as a file in the page: saved, taken again beside those that there are, and refused when it is damaged.

use crate::Visit;
use crate::accessibility::expect_none;
use crate::browser::{Browser, Screen};

/// Saves the file that the link gives, and keeps it in the page.
async fn save(browser: &Browser) {
    let fetch = "const link = document.getElementById('export-floors'); window.told = ''; \
                 fetch(link.href).then(async answer => { \
                     window.saved = new Uint8Array(await answer.arrayBuffer()); \
                     window.told = answer.headers.get('content-disposition') + ' ' + new TextDecoder().decode(window.saved.slice(0, 8)); \
                 }); return ''";
    browser.text(fetch).await;
    browser.until("return window.told !== ''").await;
    assert_eq!(
        browser.text("return window.told").await,
        "attachment; filename=\"home.rvacfloors\" RVACFLRS"
    );
}

/// Chooses the file that was saved, changed by a script.
async fn choose(browser: &Browser, change: &str) {
    let script = format!(
        "const bytes = window.saved.slice(); {change} \
         const files = new DataTransfer(); files.items.add(new File([bytes], 'home.rvacfloors')); \
         const field = document.getElementById('floors-file'); field.files = files.files; \
         field.dispatchEvent(new Event('change', {{ bubbles: true }})); return ''"
    );
    browser.text(&script).await;
}

#[tokio::test]
async fn floors_are_saved_as_a_file_and_taken_again_on_a_phone_in_the_dark() {
    let Some(visit) = Visit::begin_at_home(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.darken().await;
    browser.click("#tab-home").await;
    browser
        .until("return document.getElementById('export-floors') !== null")
        .await;
    save(browser).await;
    choose(browser, "bytes[bytes.length >> 1] ^= 1;").await;
    browser.says("floors-remark", "is cut or damaged").await;
    let count = "return String(document.querySelectorAll('#floors li').length)";
    assert_eq!(browser.text(count).await, "1", "nothing was taken");
    choose(browser, "").await;
    browser.says("floors-remark", "Maps imported").await;
    browser
        .until("return document.getElementById('rename-floor-2') !== null")
        .await;
    expect_none(browser, "floors of a file").await;
    browser
        .text("document.getElementById('floors-title').scrollIntoView(); return ''")
        .await;
    browser.shot("phone-floors-taken").await;
    assert_eq!(
        browser.text(crate::accessibility::TOO_WIDE).await,
        "0",
        "the page is wider than the phone"
    );
}
