//! Schedules in the page: one is added, seen, left out and removed.

use crate::Visit;
use crate::browser::{Browser, Screen};

/// Types into a field, with the events that a person causes.
async fn fill(browser: &Browser, id: &str, text: &str) {
    let typed = format!(
        "const field = document.getElementById('{id}'); field.value = '{text}'; \
         field.dispatchEvent(new Event('input', {{bubbles: true}})); return ''"
    );
    browser.text(&typed).await;
}

/// A zone is chosen, another one refused because there is none of that name, and the choice taken back.
async fn choose_a_zone(browser: &Browser) {
    browser
        .until("return document.querySelectorAll('#zones option').length > 300")
        .await;
    fill(browser, "zone", "Asia/Kathmandu").await;
    browser.click("#set-zone").await;
    browser.says("schedule-zone", "those of Asia/Kathmandu").await;
    browser
        .text("document.getElementById('zone-title').scrollIntoView({block: 'center'}); return ''")
        .await;
    browser.shot("phone-zone").await;
    fill(browser, "zone", "Mars/Base").await;
    browser.click("#set-zone").await;
    browser
        .until("return document.querySelector('.alert') !== null")
        .await;
    browser.says("schedule-zone", "those of Asia/Kathmandu").await;
    browser.click("#system-zone").await;
    browser
        .until("return document.getElementById('system-zone') === null")
        .await;
}

#[tokio::test]
async fn a_schedule_is_added_left_out_once_and_removed_on_a_phone_in_the_dark() {
    let Some(visit) = Visit::begin_at_home(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser
        .text("document.documentElement.dataset.theme = 'dark'; return ''")
        .await;
    browser.click("#tab-schedules").await;
    browser.click("#add-schedule").await;
    browser.click("#save-schedule").await;
    browser.says("schedule-wrong", "Give it a name.").await;
    fill(browser, "schedule-name", "Every morning").await;
    browser
        .until("return document.getElementById('schedule-wrong').innerText === ''")
        .await;
    fill(browser, "schedule-at", "07:30").await;
    browser.click("#day-sa").await;
    browser.click("#schedule-form .rooms input").await;
    browser.choose("schedule-power", "quiet").await;
    fill(browser, "schedule-late", "90").await;
    browser.shot("phone-schedule-form").await;
    browser.click("#save-schedule").await;

    browser.says("next-runs", "Every morning: ").await;
    browser
        .says("schedules", "Mon, Tue, Wed, Thu, Fri, Sat at 07:30")
        .await;
    browser.says("schedules", ", quiet, up to 90 minutes late").await;
    assert_eq!(
        browser
            .text("return document.querySelectorAll('#next-runs li').length")
            .await,
        "10"
    );
    browser.click("#skip-1").await;
    browser.says("next-runs", "07:30, skipped").await;
    browser.click("#set-quiet").await;
    browser.says("quiet-words", "from 22:00 to 07:00").await;
    browser
        .text("document.getElementById('schedules-title').scrollIntoView(); return ''")
        .await;
    browser.shot("phone-schedules").await;
    let width = browser
        .text("return document.documentElement.scrollWidth > document.documentElement.clientWidth")
        .await;
    assert_eq!(width, "false", "the page is wider than the phone");

    choose_a_zone(browser).await;
    browser.click("#remove-1").await;
    browser
        .until("return document.querySelectorAll('#schedules li').length === 0")
        .await;
    browser.says("sheet-schedules", "Nothing starts by itself.").await;
}
