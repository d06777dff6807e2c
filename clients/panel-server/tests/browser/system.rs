//! The end of the sheet Device: the computer in the robot, the file for a bug report, notifications, and About.

use serde_json::{Value, json};

use crate::Visit;
use crate::accessibility::{SMALL_TARGETS, TOO_WIDE, expect_none};
use crate::browser::{Browser, Screen};

async fn look(browser: &Browser, section: &str, name: &str) {
    let scroll =
        format!("document.getElementById('{section}').scrollIntoView({{block: 'center'}}); return ''");
    browser.text(&scroll).await;
    browser.shot(name).await;
    expect_none(browser, name).await;
    assert_eq!(browser.text(TOO_WIDE).await, "0", "{name}");
    if name.starts_with("phone") {
        assert_eq!(browser.text(SMALL_TARGETS).await, "", "{name}");
    }
}

/// The file that the page would save, in place of a download.
const CATCH_FILE: &str = "
    window.saved = [];
    URL.createObjectURL = (blob) => { blob.text().then((text) => saved.push(text)); return 'about:blank#file'; };
    HTMLAnchorElement.prototype.click = function () { saved.push(this.download); };
    return ''";

#[tokio::test]
async fn the_computer_is_shown_and_a_report_holds_what_the_page_knows() {
    for (screen, name) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::begin(screen).await else {
            return;
        };
        let browser = &visit.browser;
        browser.click("#tab-device").await;
        browser.says("system", "as on this device").await;
        browser.says("system", "Disk").await;
        browser.says("system", "Panel server").await;
        look(browser, "system", &format!("{name}-system")).await;
        browser.text(CATCH_FILE).await;
        browser.click("#save-report").await;
        browser.until("return window.saved.length === 2").await;
        let of = |what: &str| format!("return window.saved.find((text) => text.startsWith('{what}'))");
        let file = browser.text(&of("rvac-report-")).await;
        assert!(file.ends_with(".json"), "{file}");
        let report: Value = serde_json::from_str(&browser.text(&of("{")).await).unwrap();
        assert_eq!(report["robot"]["device"], "sr8730");
        assert!(report["system"]["disk"]["total_bytes"].as_u64() > Some(0));
        assert!(report["log"].as_array().is_some_and(|log| !log.is_empty()));
        crate::language::choose(browser, "et").await;
        browser.click("#tab-device").await;
        browser.says("system", "sama mis selles seadmes").await;
        browser.darken().await;
        look(browser, "system", &format!("{name}-system-estonian-dark")).await;
        browser.says("about", "Lähtekood").await;
        let about = browser
            .text("return document.getElementById('about').innerText")
            .await;
        assert!(!about.contains('`'), "{about}");
        look(browser, "about", &format!("{name}-about-estonian-dark")).await;
    }
}

/// The system's part of a notification is the browser's own; here it is only written down. The page lies behind another window.
const WATCH_NOTICES: &str = "
    window.notices = [];
    const keep = function (title, options) { notices.push(title + ' | ' + options.body); return Promise.resolve(); };
    ServiceWorkerRegistration.prototype.showNotification = keep;
    document.hasFocus = () => false;
    return ''";

#[tokio::test]
async fn a_job_that_is_over_is_told_to_who_asked_for_it_and_looks_away() {
    let Some(visit) = Visit::begin(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-device").await;
    browser
        .until("return document.getElementById('notify') !== null")
        .await;
    let asked = "return String(document.getElementById('notify-off') !== null)";
    assert_eq!(browser.text(asked).await, "false", "nobody asked for it yet");
    let origin = browser.text("return location.origin").await;
    let set = |setting: &str| {
        let parameters =
            json!({"permission": {"name": "notifications"}, "setting": setting, "origin": &origin});
        browser.devtools("Browser.setPermission", &parameters);
    };
    set("denied");
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    browser.says("notify", "Blocked").await;
    look(browser, "notify", "phone-notify-blocked").await;
    set("granted");
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    browser.text(WATCH_NOTICES).await;
    browser.click("#notify-on").await;
    browser.says("notify", "Notifications are on.").await;
    look(browser, "notify", "phone-notify-on").await;
    browser.press_start().await;
    browser.sweeps_more_than(100).await;
    browser.click("#stop").await;
    browser
        .until("return window.notices.length === 1 && notices[0].startsWith('The job is over | Stopped by panel.')")
        .await;
    browser.click("#notify-off").await;
    browser
        .until("return document.getElementById('notify-on') !== null")
        .await;
}
