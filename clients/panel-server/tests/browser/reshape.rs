//! What was drawn is reshaped by its dots, by mouse and by finger, and taken back; and so is what is chosen, and an older map.

use serde_json::json;

use crate::Visit;
use crate::browser::{Browser, Screen};

/// The middle of an element, CSS pixels of the window.
async fn middle(browser: &Browser, id: &str) -> (f64, f64) {
    let script = format!(
        "const element = document.getElementById('{id}'); \
         if (element.closest('.map')) window.scrollTo(0, 0); else element.scrollIntoView({{ block: 'center' }}); \
         const box = element.getBoundingClientRect(); return `${{box.x + box.width / 2}} ${{box.y + box.height / 2}}`"
    );
    let told = browser.text(&script).await;
    let (x, y) = told.split_once(' ').unwrap();
    (x.parse().unwrap(), y.parse().unwrap())
}

/// Drags an element by mouse.
async fn drag(browser: &Browser, id: &str, (right, down): (f64, f64)) {
    let (x, y) = middle(browser, id).await;
    let mouse = |kind: &str, share: f64| {
        let event = json!({
            "type": kind, "x": x + share * right, "y": y + share * down, "button": "left", "buttons": 1, "clickCount": 1,
        });
        browser.devtools("Input.dispatchMouseEvent", &event);
    };
    mouse("mousePressed", 0.0);
    mouse("mouseMoved", 0.5);
    mouse("mouseMoved", 1.0);
    mouse("mouseReleased", 1.0);
}

/// The same with a finger.
async fn drag_by_finger(browser: &Browser, id: &str, (right, down): (f64, f64)) {
    let (x, y) = middle(browser, id).await;
    let touch = |kind: &str, shares: &[f64]| {
        let points: Vec<_> = shares
            .iter()
            .map(|share| json!({ "x": x + share * right, "y": y + share * down }))
            .collect();
        let event = json!({ "type": kind, "touchPoints": points });
        browser.devtools("Input.dispatchTouchEvent", &event);
    };
    touch("touchStart", &[0.0]);
    touch("touchMove", &[0.5]);
    touch("touchMove", &[1.0]);
    touch("touchEnd", &[]);
}

/// Presses keys on the map.
async fn keys(browser: &Browser, keys: &[&str]) {
    browser
        .text("document.getElementById('map').focus(); return ''")
        .await;
    for key in keys {
        crate::keyboard::press(browser, key);
    }
}

const CORNERS: [&str; 6] = ["Enter", "ArrowLeft", "ArrowLeft", "ArrowUp", "ArrowUp", "Enter"];

async fn told(browser: &Browser, selector: &str) -> String {
    browser
        .text(&format!(
            "return document.querySelector('{selector}')?.textContent ?? ''"
        ))
        .await
}

async fn until_other(browser: &Browser, selector: &str, before: &str) {
    browser
        .until(&format!(
            "return (document.querySelector('{selector}')?.textContent ?? '') !== {before:?}"
        ))
        .await;
}

#[tokio::test]
async fn a_no_go_zone_is_dragged_into_another_shape_and_back_and_left_alone() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#draw-zone").await;
    // The same place twice is no zone: that is said, and the second corner can be shown again.
    keys(browser, &["Enter", "Enter"]).await;
    browser
        .says("sketch-bar", "Too narrow: a zone is at least 5 cm")
        .await;
    browser.shot("desktop-too-narrow").await;
    crate::accessibility::expect_none(browser, "a zone that is too narrow").await;
    keys(browser, &CORNERS[1..]).await;
    browser.says("no-go", "No-go zone 1").await;
    let drawn = told(browser, "#no-go .words").await;
    browser.click("#reshape-no-go-1").await;
    let larger_yet = told(browser, "#reshape-told").await;
    drag(browser, "handle-3", (-60.0, -40.0)).await;
    until_other(browser, "#reshape-told", &larger_yet).await;
    browser.shot("desktop-reshape-dragged").await;
    browser.click("#reshape-save").await;
    until_other(browser, "#no-go .words", &drawn).await;
    let larger = told(browser, "#no-go .words").await;
    browser.click("#undo").await;
    browser.says("no-go", &drawn).await;
    browser.click("#redo").await;
    browser.says("no-go", &larger).await;

    browser.click("#reshape-no-go-1").await;
    drag(browser, "handle-middle", (30.0, 0.0)).await;
    browser.click("#reshape-cancel").await;
    browser
        .until("return document.getElementById('reshape-bar') === null && document.querySelectorAll('.handle').length === 0")
        .await;
    assert_eq!(told(browser, "#no-go .words").await, larger);
}

#[tokio::test]
async fn a_kept_zone_is_reshaped_by_a_finger_on_a_phone_in_the_dark() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.darken().await;
    browser.click("#draw-clean").await;
    keys(browser, &CORNERS).await;
    browser.click("#keep-part-1").await;
    let typed = "const field = document.getElementById('place-name'); field.value = 'Table'; \
                 field.dispatchEvent(new Event('input', {bubbles: true})); return ''";
    browser.text(typed).await;
    browser.click("#keep-place").await;
    browser.says("places", "Table").await;
    browser.click("#choose-none").await;
    let drawn = told(browser, "#places .words").await;
    browser.shot("phone-kept-places-dark").await;
    browser.click("#reshape-place-1").await;
    drag_by_finger(browser, "handle-1", (20.0, 15.0)).await;
    until_other(browser, "#reshape-told", &format!("Table: {drawn}")).await;
    browser.shot("phone-reshape-dark").await;
    crate::accessibility::expect_none(browser, "a place in hand").await;
    browser.click("#reshape-save").await;
    until_other(browser, "#places .words", &drawn).await;
    browser.says("places", "Table").await;
    browser.click("#undo").await;
    browser.says("places", &drawn).await;
}

/// How many zones, spots and places to keep out of are in the bar.
async fn chosen(browser: &Browser, (parts, avoided): (usize, usize)) {
    browser
        .until(&format!(
            "return document.querySelectorAll('#drawn-parts .part').length === {parts} \
             && document.querySelectorAll('#avoided-places .part').length === {avoided}"
        ))
        .await;
}

#[tokio::test]
async fn what_is_chosen_for_a_job_is_reshaped_taken_back_and_done_again() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#draw-clean").await;
    keys(browser, &CORNERS).await;
    browser.click("#draw-spot").await;
    keys(browser, &["ArrowRight", "ArrowRight", "Enter"]).await;
    browser.click("#keep-out").await;
    keys(browser, &["Enter", "ArrowRight", "ArrowDown", "Enter"]).await;
    chosen(browser, (2, 1)).await;
    let before = told(browser, "#part-1").await;
    browser.click("#reshape-part-1").await;
    drag(browser, "handle-1", (40.0, 30.0)).await;
    browser.click("#reshape-save").await;
    until_other(browser, "#part-1", &before).await;
    browser.shot("desktop-chosen").await;
    browser.click("#avoided-1").await;
    chosen(browser, (2, 0)).await;
    browser.click("#choose-none").await;
    browser.has_no_order().await;
    for left in [(2, 0), (2, 1)] {
        browser.click("#undo").await;
        chosen(browser, left).await;
    }
    browser.click("#undo").await;
    browser.says("part-1", &before).await;
    browser.click("#undo").await;
    chosen(browser, (2, 0)).await;
    browser.click("#undo").await;
    chosen(browser, (1, 0)).await;
    browser.click("#redo").await;
    chosen(browser, (2, 0)).await;
    browser.click("#clean-chosen").await;
    browser.until_state(&["cleaning"]).await;
    browser.has_no_order().await;
    browser
        .until("return document.getElementById('undo') === null && document.getElementById('redo') === null")
        .await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}

#[tokio::test]
async fn an_older_map_is_taken_up_and_the_newest_brought_back() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser
        .until("return document.querySelectorAll('#maps li').length === 1")
        .await;
    browser.click("#draw-wall").await;
    keys(browser, &["Enter", "ArrowLeft", "ArrowLeft", "Enter"]).await;
    let walls = |count: usize| format!("return document.querySelectorAll('#no-go li').length === {count}");
    browser.until(&walls(1)).await;
    browser
        .until("return document.querySelector('[id^=take-up-]') !== null")
        .await;
    browser.click("[id^=take-up-]").await;
    browser.until(&walls(0)).await;
    browser.shot("desktop-older-map").await;
    // Each is kept as a new version: the third is the first one again, the fourth the second.
    in_use(browser, 3, 1).await;
    browser.click("#undo").await;
    in_use(browser, 4, 2).await;
    browser.until(&walls(1)).await;
    browser.click("#redo").await;
    in_use(browser, 5, 1).await;
    browser.until(&walls(0)).await;
}

/// Waits until a version of the map is the newest, and checks that it has the extent of the one from which it was made. Name and number
/// stand on one line, with a space that does not break.
async fn in_use(browser: &Browser, newest: usize, source: usize) {
    browser
        .until(&format!(
            "const name = row => row?.querySelector('.name').textContent.replace('\\u00a0', ' ');
             const rows = [...document.querySelectorAll('#maps li')];
             const extent = number => rows.find(row => name(row) === `Map ${{number}}`)
                 ?.querySelector('.words').textContent.split(', ').slice(1).join();
             return name(rows[0]) === 'Map {newest}' && extent({newest}) === extent({source})"
        ))
        .await;
}
