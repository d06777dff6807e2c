//! The page in another language: chosen in the bar, stored, declared to the browser, in every sheet.

use crate::Visit;
use crate::browser::{Browser, Screen};

/// English words that the page would show if a text of it were outside of the catalogue.
const ENGLISH: &str = "
    const text = document.body.innerText;
    const words = ['the', 'is', 'robot is', 'nothing', 'settings', 'Save', 'Battery', 'Rooms', 'Cleaned', 'Schedules'];
    return words.filter(word => new RegExp('(^|[^\\\\p{L}])' + word + '([^\\\\p{L}]|$)', 'u').test(text)).join(', ')";

pub(crate) async fn choose(browser: &Browser, language: &str) {
    browser
        .click(&format!("#language option[value={language}]"))
        .await;
    browser
        .until(&format!(
            "return document.documentElement.lang === '{language}' && document.getElementById('start') !== null"
        ))
        .await;
}

#[tokio::test]
async fn estonian_is_chosen_and_kept() {
    for (screen, shots) in [(Screen::Phone, "phone"), (Screen::Desktop, "desktop")] {
        let Some(visit) = Visit::begin_at_home(screen).await else {
            return;
        };
        let browser = &visit.browser;
        assert_eq!(browser.text("return document.documentElement.lang").await, "en");
        choose(browser, "et").await;
        browser.until_state(&["idle", "docked"]).await;
        let start = "return document.getElementById('start').innerText.trim()";
        assert_eq!(browser.text(start).await, "Alusta");
        for tab in ["drive", "home", "schedules", "history", "why", "device"] {
            browser.click(&format!("#tab-{tab}")).await;
            browser
                .until(&format!("return !document.getElementById('sheet-{tab}').hidden"))
                .await;
            browser.shot(&format!("{shots}-et-{tab}")).await;
            assert_eq!(browser.text(ENGLISH).await, "", "English in the sheet {tab}");
            assert_eq!(
                browser.text(crate::accessibility::TOO_WIDE).await,
                "0",
                "too wide while {tab} is open"
            );
        }
        browser.reload().await;
        browser
            .until("return document.getElementById('start')?.innerText.trim() === 'Alusta'")
            .await;
        choose(browser, "en").await;
        browser.until_state(&["idle", "docked"]).await;
        assert_eq!(browser.text(start).await, "Start");
    }
}

/// A browser that is told to let no page keep anything.
const DENY_STORAGE: &str = "Object.defineProperty(window, 'localStorage', {
    get() { throw new DOMException('The request was denied.', 'SecurityError'); },
});";

#[tokio::test]
async fn a_browser_that_keeps_nothing_stays_in_the_language_that_was_chosen() {
    let Some(visit) = Visit::begin(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let denial = serde_json::json!({ "source": DENY_STORAGE });
    browser.devtools("Page.addScriptToEvaluateOnNewDocument", &denial);
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    for (language, start) in [("et", "Alusta"), ("en", "Start")] {
        choose(browser, language).await;
        browser.until_state(&["idle", "docked"]).await;
        browser.reload().await;
        browser.until_state(&["idle", "docked"]).await;
        let shown = browser
            .text("return document.getElementById('start').innerText.trim()")
            .await;
        assert_eq!(shown, start);
    }
}
