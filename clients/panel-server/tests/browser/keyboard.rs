//! Whole tasks in the page without a pointer, by keys as the browser gets them from a keyboard: at each of them the focus is to be
//! seen. And what still moves for people who asked that nothing does.

use serde_json::json;

use crate::Visit;
use crate::browser::{Browser, Screen};

/// More presses of Tab than the page has places for the focus.
const PLACES_MAX: usize = 200;

/// Shift in the words of the developer tools.
const SHIFT: u8 = 8;
/// The same of Ctrl.
const CTRL: u8 = 2;

/// Code of the key and its number, as browsers know them, and the text that it gives.
fn described(key: &str) -> (String, u32, &str) {
    let (code, number, text) = match key {
        "Tab" => ("Tab", 9, ""),
        "Enter" => ("Enter", 13, "\r"),
        "Escape" => ("Escape", 27, ""),
        " " => ("Space", 32, " "),
        "ArrowLeft" => ("ArrowLeft", 37, ""),
        "ArrowUp" => ("ArrowUp", 38, ""),
        "ArrowRight" => ("ArrowRight", 39, ""),
        "ArrowDown" => ("ArrowDown", 40, ""),
        letter => {
            let upper = letter.to_uppercase();
            let number = upper.chars().next().map_or(0, u32::from);
            return (format!("Key{upper}"), number, letter);
        }
    };
    (code.to_owned(), number, text)
}

/// Presses a key and lets it go.
pub(crate) fn press_with(browser: &Browser, key: &str, modifiers: u8) {
    let (code, number, text) = described(key);
    let event = |kind: &str, text: &str| {
        json!({
            "type": kind, "key": key, "code": code, "windowsVirtualKeyCode": number,
            "modifiers": modifiers, "text": text,
        })
    };
    let text = if modifiers == CTRL { "" } else { text };
    let kind = if text.is_empty() { "rawKeyDown" } else { "keyDown" };
    browser.devtools("Input.dispatchKeyEvent", &event(kind, text));
    browser.devtools("Input.dispatchKeyEvent", &event("keyUp", ""));
}

pub(crate) fn press(browser: &Browser, key: &str) {
    press_with(browser, key, 0);
}

/// What is wrong with how the element that has the focus is seen; nothing if it is seen. The choice of the language lies invisible
/// over its sign, which has the outline for it.
const UNSEEN_FOCUS: &str = "
    const focused = document.activeElement;
    const seen = focused.closest('.language') ?? focused;
    const name = focused.id || focused.outerHTML.slice(0, 120);
    const style = getComputedStyle(seen);
    if (style.outlineStyle === 'none' || parseFloat(style.outlineWidth) < 2) return `${name} has no outline`;
    const box = seen.getBoundingClientRect();
    const isInside = box.bottom > 0 && box.right > 0 && box.top < innerHeight && box.left < innerWidth;
    return isInside ? '' : `${name} is out of sight`;";

/// Where the focus has to go to get to an element: -1 back, 1 on, 0 it is there.
fn direction(id: &str) -> String {
    format!(
        "const target = document.getElementById('{id}'), focused = document.activeElement; \
         if (target === null || target === focused) return target === null ? 'absent' : 'there'; \
         return focused.compareDocumentPosition(target) & Node.DOCUMENT_POSITION_PRECEDING ? 'back' : 'on'"
    )
}

/// Goes by Tab to the element `id` as soon as there is one, and unfolds on the way what it is in; at each stop the focus is to be seen.
pub(crate) async fn go_to(browser: &Browser, id: &str) {
    browser
        .until(&format!("return document.getElementById('{id}') !== null"))
        .await;
    while let Some(opener) = browser.opener_of(&format!("#{id}")).await {
        go_to_seen(browser, &opener).await;
        press(browser, "Enter");
        let opened = format!("#{id}");
        let is_open = format!(
            "return document.getElementById('{opener}').matches('[aria-expanded=true], [aria-pressed=true]')"
        );
        browser.until(&is_open).await;
        assert_ne!(browser.opener_of(&opened).await.as_deref(), Some(opener.as_str()));
    }
    go_to_seen(browser, id).await;
}

async fn go_to_seen(browser: &Browser, id: &str) {
    for _ in 0..PLACES_MAX {
        match browser.text(&direction(id)).await.as_str() {
            "there" => return,
            "back" => press_with(browser, "Tab", SHIFT),
            _ => press(browser, "Tab"),
        }
        if browser
            .text("return document.activeElement === document.body")
            .await
            == "false"
        {
            let wrong = browser.text(UNSEEN_FOCUS).await;
            assert_eq!(wrong, "", "on the way to {id}");
        }
    }
    browser.fail(&format!("Tab does not lead to {id}")).await
}

/// Goes to a tab as people who know tabs do: to the one that is open, then by arrow keys.
async fn open_sheet(browser: &Browser, sheet: &str) {
    let open = browser
        .text("return document.querySelector('[role=tab][aria-selected=true]').id")
        .await;
    go_to(browser, &open).await;
    let is_there = format!("return document.activeElement.id === 'tab-{sheet}'");
    for _ in 0..10 {
        if browser.text(&is_there).await == "true" {
            return;
        }
        press(browser, "ArrowRight");
    }
    browser.fail(&format!("no arrow key leads to {sheet}")).await
}

async fn id_of(browser: &Browser, selector: &str) -> String {
    let there = format!("return document.querySelector({selector:?}) !== null");
    browser.until(&there).await;
    browser
        .text(&format!("return document.querySelector({selector:?}).id"))
        .await
}

async fn focus_is_on(browser: &Browser, id: &str) {
    browser
        .until(&format!("return document.activeElement.id === '{id}'"))
        .await;
    assert_eq!(browser.text(UNSEEN_FOCUS).await, "");
}

#[tokio::test]
async fn a_room_is_cleaned_and_the_run_seen_again_by_keys_alone() {
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    open_sheet(browser, "home").await;
    let room = id_of(browser, "#rooms .choose").await;
    go_to(browser, &room).await;
    press(browser, " ");
    browser.says("prospect", "of a full battery").await;
    go_to(browser, "clean-chosen").await;
    press(browser, "Enter");
    browser.until_state(&["cleaning"]).await;
    browser.sweeps_more_than(100).await;
    go_to(browser, "stop").await;
    press(browser, "Enter");
    browser.until_state(&["idle", "docked"]).await;

    open_sheet(browser, "history").await;
    go_to(browser, "run-1-open").await;
    press(browser, "Enter");
    focus_is_on(browser, "all-runs").await;
    go_to(browser, "replay-play").await;
    let place = "document.getElementById('replay-robot').getAttribute('transform')";
    let before = browser.text(&format!("return {place}")).await;
    press(browser, "Enter");
    browser
        .until(&format!("return {place} !== {}", json!(before)))
        .await;
    go_to(browser, "all-runs").await;
    press(browser, "Enter");
    focus_is_on(browser, "run-1-open").await;
}

async fn is_forbidden(browser: &Browser, words: &str) {
    browser.says("no-go", words).await;
}

#[tokio::test]
async fn a_no_go_zone_is_drawn_reshaped_and_given_its_shape_back_by_keys_alone() {
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    open_sheet(browser, "home").await;
    go_to(browser, "draw-zone").await;
    press(browser, "Enter");
    focus_is_on(browser, "map").await;
    for key in ["Enter", "ArrowLeft", "ArrowLeft", "ArrowUp", "ArrowUp", "Enter"] {
        press(browser, key);
    }
    is_forbidden(browser, "No-go zone 1").await;
    let size = "return document.querySelector('#no-go .words').textContent";
    let drawn = browser.text(size).await;
    go_to(browser, "reshape-no-go-1").await;
    press(browser, "Enter");
    focus_is_on(browser, "handle-1").await;
    let told = format!("No-go zone 1: {drawn}");
    browser.says("reshape-told", &told).await;
    for _ in 0..6 {
        press(browser, "ArrowRight");
        press(browser, "ArrowDown");
    }
    browser.shot("desktop-reshape").await;
    let reshaped = browser
        .text("return document.getElementById('reshape-told').textContent")
        .await;
    assert!(!reshaped.ends_with(&drawn), "{reshaped}");
    press(browser, "Enter");
    browser
        .until(&format!(
            "return document.querySelector('#no-go .words').textContent !== {drawn:?}"
        ))
        .await;
    focus_is_on(browser, "more-no-go-1").await;
    press_with(browser, "z", CTRL);
    is_forbidden(browser, &drawn).await;
    press_with(browser, "z", CTRL);
    browser
        .until("return document.querySelectorAll('#no-go li').length === 0")
        .await;
}

#[tokio::test]
async fn a_schedule_is_made_by_keys_alone() {
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    open_sheet(browser, "schedules").await;
    go_to(browser, "add-schedule").await;
    press(browser, "Enter");
    go_to(browser, "schedule-name").await;
    for letter in ["d", "a", "i", "l", "y"] {
        press(browser, letter);
    }
    go_to(browser, "day-sa").await;
    press(browser, " ");
    let room = id_of(browser, "#schedule-form .rooms input").await;
    go_to(browser, &room).await;
    press(browser, " ");
    go_to(browser, "save-schedule").await;
    press(browser, "Enter");
    browser.says("next-runs", "daily: ").await;
    browser.says("schedules", "Sat at 09:30").await;
}

/// Names of elements whose style changes over time, by a transition or an animation.
const MOVING: &str = "
    const parts = [undefined, '::before', '::after'];
    const isLong = times => times.split(',').some(time => parseFloat(time) > 0);
    const moves = element => parts.some(part => {
        const style = getComputedStyle(element, part);
        return isLong(style.transitionDuration) || (style.animationName !== 'none' && isLong(style.animationDuration));
    });
    return [...document.querySelectorAll('*')].filter(moves)
        .map(element => element.id || element.className || element.tagName).join(', ')";

#[tokio::test]
async fn nothing_moves_by_itself_for_people_who_asked_for_that() {
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    assert_ne!(
        browser.text(MOVING).await,
        "",
        "the page has motion that could be left out"
    );
    let still = json!({ "features": [{ "name": "prefers-reduced-motion", "value": "reduce" }] });
    browser.devtools("Emulation.setEmulatedMedia", &still);
    browser.click("#tab-home").await;
    browser.click("#rooms .choose").await;
    browser
        .until("return document.getElementById('clean-chosen')?.getAttribute('aria-disabled') === 'false'")
        .await;
    browser.click("#clean-chosen").await;
    browser.until_state(&["cleaning"]).await;
    browser.click("#theme").await;
    for tab in ["drive", "home", "schedules", "history", "why", "device", "log"] {
        browser.click(&format!("#tab-{tab}")).await;
        assert_eq!(browser.text(MOVING).await, "", "while {tab} is open");
        let running = browser.text("return document.getAnimations().length").await;
        assert_eq!(running, "0", "while {tab} is open");
    }
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}
