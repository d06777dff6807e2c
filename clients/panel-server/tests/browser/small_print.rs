//! What an owner reads and types: nothing lies over something else, times are asked as they are shown, and an empty field looks empty.

use serde_json::json;

use crate::Visit;
use crate::browser::{Browser, Screen};
use crate::owner::{SIZES, ask, resize};

/// What lies over the map at its edges.
const EDGES: &str = "'.ground-switch', '.map-tools', '.legend', '.legend-fold', '.scale'";
/// An order and what it may not lie on. On a phone it is a sheet over the page.
const ORDER: &str =
    "'.ground-switch', '.map-tools', '.legend', '.legend-fold', '.scale', '.order-place:not(.fixed)'";

/// Pairs of things that are seen and cover each other.
fn covered(names: &str) -> String {
    format!(
        "const place = document.querySelector('.order-place');
         place?.classList.toggle('fixed', getComputedStyle(place).position === 'fixed');
         const seen = [{names}].map(name => [name, document.querySelector(name)])
             .filter(([, element]) => element?.checkVisibility())
             .map(([name, element]) => [name, element.getBoundingClientRect()]);
         const covers = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
         return seen.flatMap(([one, a], place) => seen.slice(place + 1)
             .filter(([, b]) => covers(a, b)).map(([other]) => `${{one}} ${{other}}`)).join(', ')"
    )
}

/// Finds the names on the map that are seen, and pairs of them that cover each other.
const NAMES: &str = "
    const names = [...document.querySelectorAll('.room-names span')]
        .filter(name => name.checkVisibility({ visibilityProperty: true })).map(name => name.getBoundingClientRect());
    const covers = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const pairs = names.flatMap((a, place) => names.slice(place + 1).filter(b => covers(a, b)));";

/// Buttons of the map.
const EVERYTHING: &str = ".map-tools button:nth-of-type(3)";
const ZOOM_OUT: &str = ".map-tools button:nth-of-type(2)";

/// Types into a field and leaves it.
async fn type_and_leave(browser: &Browser, id: &str, text: &str) {
    let typed = format!(
        "const field = document.getElementById('{id}'); field.value = '{text}'; \
         for (const name of ['input', 'change']) field.dispatchEvent(new Event(name, {{ bubbles: true }})); return ''"
    );
    browser.text(&typed).await;
}

/// None of these covers another on any size.
async fn expect_none_covered(browser: &Browser, what: &str, names: &str) {
    for size in SIZES {
        resize(browser, size).await;
        let covered = browser.text(&covered(names)).await;
        assert_eq!(covered, "", "{what}, {size:?}");
        browser
            .shot(&format!("over-the-map-{what}-{}x{}", size.0, size.1))
            .await;
    }
}

#[tokio::test]
async fn what_lies_over_the_map_does_not_cover_each_other_with_long_words() {
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser
        .text("localStorage.setItem('language', 'et'); return ''")
        .await;
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    expect_none_covered(browser, "plain", EDGES).await;
    browser.click("#tab-home").await;
    browser.click("#rooms .choose").await;
    browser
        .until("return document.querySelector('.order-bar') !== null")
        .await;
    expect_none_covered(browser, "order", ORDER).await;
}

#[tokio::test]
async fn names_of_rooms_do_not_cover_each_other_on_a_small_phone() {
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-home").await;
    for (room, letter) in [(1, "W"), (2, "M")] {
        let name = letter.repeat(39);
        let request = json!({ "c": "name-room", "room": room, "name": name }).to_string();
        ask(&visit.stack.daemon_socket(), &request);
        browser.says("rooms", &name).await;
    }
    browser.click("#ground-known").await;
    for size in SIZES {
        resize(browser, size).await;
        browser.click(EVERYTHING).await;
        browser
            .until(&format!(
                "{NAMES} return names.length === 2 && pairs.length === 0"
            ))
            .await;
    }
    // From far away the rooms are smaller than their names.
    for _ in 0..12 {
        browser.click(ZOOM_OUT).await;
    }
    browser.until(&format!("{NAMES} return names.length === 0")).await;
}

#[tokio::test]
async fn times_are_asked_on_24_hours_and_an_empty_date_looks_empty() {
    let Some(visit) = Visit::begin_at_home(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-schedules").await;
    browser.click("#add-schedule").await;
    type_and_leave(browser, "schedule-name", "Evening").await;
    // What a person sees in the field, and not its value: the browser's own field writes 07:45 PM for 19:45.
    for (typed, seen) in [("745", "07:45"), ("19.45", "19:45")] {
        type_and_leave(browser, "schedule-at", typed).await;
        browser
            .until(&format!(
                "const at = document.getElementById('schedule-at'); return at.type === 'text' && at.value === '{seen}'"
            ))
            .await;
    }
    type_and_leave(browser, "schedule-at", "25:00").await;
    browser.click("#save-schedule").await;
    browser.says("schedule-wrong", "for example 09:30").await;
    type_and_leave(browser, "schedule-at", "2130").await;

    browser.click("#schedule-once").await;
    let ink = "return getComputedStyle(document.getElementById('schedule-date')).color";
    let empty = browser.text(ink).await;
    type_and_leave(browser, "schedule-date", "2030-01-02").await;
    browser.until(&format!("{ink} !== '{empty}'")).await;
    browser.shot("phone-clock-field").await;
    browser.click("#schedule-once").await;
    browser.click("#save-schedule").await;
    browser.says("schedules", "at 21:30").await;

    type_and_leave(browser, "quiet-from", "half ten").await;
    browser.click("#set-quiet").await;
    browser.says("quiet-wrong", "for example 22:00 and 07:00").await;
    type_and_leave(browser, "quiet-from", "2230").await;
    browser
        .until("return document.getElementById('quiet-wrong').textContent === ''")
        .await;
    browser.click("#set-quiet").await;
    browser.says("quiet-words", "from 22:30 to 07:00").await;
}
