//! What an owner sees on a small or a wide screen, with long names, after a refusal, with something chosen, and when the network falls
//! silent.

use std::io::Write;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::json;

use crate::Visit;
use crate::browser::{Browser, Screen};
use crate::slow_wire::SlowWire;

/// Widths and heights on which everything must be in reach: desktops, a phone upright and on its side, the narrowest one, and a desktop
/// that is enlarged to twice its size.
pub(crate) const SIZES: [(u32, u32); 6] = [
    (1440, 900),
    (1024, 768),
    (390, 844),
    (844, 390),
    (320, 640),
    (720, 450),
];

/// Job buttons that are not wholly in view, or too small for a thumb.
const OUT_OF_REACH: &str = "
    return [...document.querySelectorAll('#actions .action')].filter(button => {
        const box = button.getBoundingClientRect();
        const middle = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
        return box.left < 0 || box.top < 0 || box.right > innerWidth || box.bottom > innerHeight
            || box.width < 44 || box.height < 44 || !button.contains(middle);
    }).map(button => button.id).join(' ')";

/// Where the one button that goes on and Stop beside it are.
const PLACES: &str = "
    return [...document.querySelectorAll('#actions .primary:not(#clear), #stop')].map(button => {
        const box = button.getBoundingClientRect();
        return [box.x, box.y, box.width, box.height].map(Math.round).join(',');
    }).join(' ')";

/// What is said of a refusal is wholly in view.
const REFUSAL_IN_VIEW: &str = "
    const box = document.getElementById('refusal')?.getBoundingClientRect();
    return box !== undefined && box.left >= 0 && box.top >= 0 && box.right <= innerWidth && box.bottom <= innerHeight";

/// The window has this size from now on.
pub(crate) async fn resize(browser: &Browser, (width, height): (u32, u32)) {
    let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
    browser.devtools("Emulation.setDeviceMetricsOverride", &size);
    browser
        .until(&format!(
            "return innerWidth === {width} && innerHeight === {height}"
        ))
        .await;
}

/// On each size: all buttons are in reach; gives where the first two are.
async fn places(browser: &Browser, state: &str) -> Vec<String> {
    let mut places = Vec::new();
    for (width, height) in SIZES {
        resize(browser, (width, height)).await;
        browser
            .until(&OUT_OF_REACH.replace(".join(' ')", ".length === 0"))
            .await;
        assert_eq!(
            browser.text(crate::accessibility::TOO_WIDE).await,
            "0",
            "{width} x {height}"
        );
        browser.shot(&format!("owner-{width}x{height}-{state}")).await;
        places.push(browser.text(PLACES).await);
    }
    places
}

#[tokio::test]
async fn all_job_buttons_are_in_reach_on_every_size_and_start_and_stop_never_move() {
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let at_rest = places(browser, "ready").await;
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.sweeps_more_than(100).await;
    let at_work = places(browser, "cleaning").await;
    assert_eq!(at_rest, at_work, "Start, Stop: x, y, width, height on {SIZES:?}");
    browser
        .until("return document.querySelector('#pause.primary .label')?.textContent === 'Pause'")
        .await;
    browser.click("#pause").await;
    browser
        .until("return document.querySelector('#pause.primary .label')?.textContent === 'Resume'")
        .await;
    assert_eq!(at_rest, places(browser, "paused").await, "on {SIZES:?}");
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
    // What became of the job is said where its progress was.
    browser.says("summary", "m² in ").await;
    resize(browser, (390, 844)).await;
    browser.shot("owner-summary").await;
}

/// Asks the daemon for something, as another client.
pub(crate) fn ask(socket: &Path, request: &str) {
    let mut stream = UnixStream::connect(socket).unwrap();
    stream.write_all(format!("{request}\u{1f}").as_bytes()).unwrap();
}

/// The longest name that a room can have, of the widest letters, without a place to break it.
fn long_name() -> String {
    "W".repeat(39)
}

/// On narrow screens each sheet is as wide as the screen, with the long name in it.
async fn fits(browser: &Browser, what: &str) {
    for size in [(390, 844), (320, 640), (844, 390)] {
        resize(browser, size).await;
        for tab in ["home", "schedules", "history"] {
            browser.click(&format!("#tab-{tab}")).await;
            browser
                .until(&format!("return !document.getElementById('sheet-{tab}').hidden"))
                .await;
            assert_eq!(
                browser.text(crate::accessibility::TOO_WIDE).await,
                "0",
                "{what}, {tab}, {size:?}"
            );
            let reach = browser.text(OUT_OF_REACH).await;
            assert_eq!(reach, "", "{what}, {tab}, {size:?}");
        }
        browser.click("#tab-home").await;
        browser.shot(&format!("owner-{what}-{}x{}", size.0, size.1)).await;
    }
}

/// A room with a long name, the same chosen, and split.
async fn long_names_fit(visit: &Visit) {
    let browser = &visit.browser;
    let name = long_name();
    let request = json!({ "c": "name-room", "room": 1, "name": name }).to_string();
    ask(&visit.stack.daemon_socket(), &request);
    browser.says("rooms", &name).await;
    fits(browser, "long-name").await;
    browser.click("#rooms .choose").await;
    browser.says("chosen-rooms", "WWW").await;
    fits(browser, "long-name-chosen").await;
    browser.click("#choose-none").await;
    browser.has_no_order().await;
}

/// What is wrong with a name is said at its field, and what was typed stays.
async fn names_are_checked_at_the_field(browser: &Browser) {
    resize(browser, (390, 844)).await;
    browser.click("#tab-home").await;
    browser.click("#rename-room-2").await;
    for (typed, told) in [
        ("W".repeat(60), "60 characters"),
        ("6".to_owned(), "A number alone"),
    ] {
        let fill = format!(
            "const field = document.getElementById('room-name'); field.value = '{typed}'; \
             field.dispatchEvent(new Event('input', {{ bubbles: true }})); return ''"
        );
        browser.text(&fill).await;
        browser.click("#save-name").await;
        browser.says("room-name-wrong", told).await;
        assert_eq!(
            browser
                .text("return document.getElementById('room-name').value")
                .await,
            typed,
            "nothing is cut or lost"
        );
    }
    browser.shot("owner-name-wrong").await;
    browser.click("#rename-room-2").await;
}

/// A refusal is seen wherever the page is scrolled to, with what to do.
async fn refusals_are_seen(browser: &Browser) {
    for size in [(1440, 900), (390, 844), (844, 390), (320, 640)] {
        resize(browser, size).await;
        browser.click("#tab-schedules").await;
        browser
            .text(
                "const zone = document.getElementById('zone'); zone.value = 'Mars/Base'; \
                 zone.dispatchEvent(new Event('input', { bubbles: true })); return ''",
            )
            .await;
        browser.click("#set-zone").await;
        browser.until(REFUSAL_IN_VIEW).await;
        browser
            .shot(&format!("owner-refusal-{}x{}", size.0, size.1))
            .await;
        browser.click("#refusal .round").await;
        browser
            .until("return document.getElementById('refusal') === null")
            .await;
    }
}

/// With something chosen the big button cleans that; while something is drawn it does nothing else.
async fn what_is_chosen_is_cleaned(browser: &Browser) {
    browser.click("#tab-home").await;
    browser.click("#draw-clean").await;
    browser
        .until("return document.querySelector('#start.primary')?.getAttribute('aria-disabled') === 'true'")
        .await;
    browser.click("#start").await;
    browser.says("refusal", "Finish the drawing").await;
    browser.until_state(&["idle", "docked"]).await;
    browser.click("#sketch-cancel").await;
    browser.click("#rooms .choose").await;
    browser
        .until(
            "return document.querySelector('#clean-chosen.primary .label')?.textContent === 'Clean selected'",
        )
        .await;
    assert_eq!(
        browser
            .text("return String(document.getElementById('start'))")
            .await,
        "null",
        "no button would clean the whole home now"
    );
    browser.shot("owner-clean-selected").await;
    browser.click("#clean-chosen").await;
    browser.until_state(&["cleaning"]).await;
    browser.has_no_order().await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
    browser.click("#tab-history").await;
    browser.says("history-sheet", "WWW").await;
}

#[tokio::test]
async fn long_names_refusals_and_choices_do_what_an_owner_expects() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    long_names_fit(&visit).await;
    names_are_checked_at_the_field(&visit.browser).await;
    refusals_are_seen(&visit.browser).await;
    resize(&visit.browser, (390, 844)).await;
    what_is_chosen_is_cleaned(&visit.browser).await;
}

/// Notes whether the headline was ever that of a lost connection.
const WATCH_HEADLINE: &str = "
    window.wasAway = false;
    new MutationObserver(() => {
        if (document.getElementById('now').dataset.state === 'disconnected') window.wasAway = true;
    }).observe(document.getElementById('now'), { attributes: true });
    return ''";

/// Presses a button, and gives after how many ms it says that the press is on its way.
const PRESS_STOP: &str = "
    const button = document.getElementById('stop'), pressed = performance.now();
    button.click();
    return new Promise(done => {
        const look = () => button.getAttribute('aria-busy') === 'true'
            ? done(String(Math.round(performance.now() - pressed))) : requestAnimationFrame(look);
        look();
    })";

/// The wheels need no page: what is shown says only how old it is.
async fn silence_is_told(browser: &Browser) {
    let silent = Instant::now();
    browser
        .until("return document.getElementById('silence') !== null")
        .await;
    let after = silent.elapsed();
    println!("silence was told after {} ms", after.as_millis());
    assert!(after < Duration::from_millis(4_500), "{after:?}");
    browser.says("presence", "Not current").await;
    browser
        .until("return getComputedStyle(document.getElementById('map')).filter.includes('grayscale')")
        .await;
    let pending_ms: u32 = browser.text(PRESS_STOP).await.parse().unwrap();
    println!("a press was seen to be on its way after {pending_ms} ms");
    assert!(pending_ms <= 100);
    browser.shot("owner-silence").await;
    browser.says("refusal", "Stop: no answer yet").await;
    browser.until(REFUSAL_IN_VIEW).await;
    browser.shot("owner-no-answer").await;
}

#[tokio::test]
async fn a_silent_network_is_seen_within_seconds_and_a_glitch_is_not() {
    let Some(mut visit) = Visit::begin_alone(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.press_start().await;
    browser.sweeps_more_than(50).await;
    let frozen = visit.stack.freeze_server();
    silence_is_told(browser).await;
    drop(frozen);
    browser
        .until("return document.getElementById('silence') === null && document.querySelector('#presence.up') !== null")
        .await;
    browser.until_state(&["idle", "docked"]).await;

    browser.text(WATCH_HEADLINE).await;
    visit.stack.restart_server();
    let browser = &visit.browser;
    // The press goes through the connection that was made again.
    browser
        .until("document.getElementById('locate').click(); return document.getElementById('note') !== null")
        .await;
    browser.says("note", "The robot beeps").await;
    assert_eq!(browser.text("return String(window.wasAway)").await, "false");
    visit.stack.stop_server();
    visit.browser.until_state(&["disconnected"]).await;
    assert_eq!(
        visit
            .browser
            .text("return String(document.getElementById('swept'))")
            .await,
        "null",
        "figures of nothing are shown"
    );
}

/// 400 kbit/s, 300 ms there and back.
const SLOW_BYTES_PER_S: u64 = 50_000;
const LATE: Duration = Duration::from_millis(150);

/// Presses Start as soon as it can be pressed, and gives after how many ms the robot has answered and the state is another one.
const PRESS_START: &str = "
    return new Promise(done => {
        let pressed;
        const look = () => {
            const start = document.getElementById('start');
            if (pressed === undefined && start?.getAttribute('aria-disabled') === 'false') {
                pressed = performance.now();
                start.click();
            }
            const state = document.getElementById('now')?.dataset.state;
            if (pressed !== undefined && ['starting', 'cleaning'].includes(state)) done(String(Math.round(performance.now() - pressed)));
            else requestAnimationFrame(look);
        };
        look();
    })";

#[tokio::test]
async fn on_a_slow_network_a_press_does_not_wait_behind_the_map() {
    let Some(visit) = Visit::begin_at_home(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    let wire = SlowWire::before(&visit.stack.address, LATE);
    browser.goto(&wire.address).await;
    browser.until_state(&["idle", "docked"]).await;
    browser
        .until("return navigator.serviceWorker?.controller?.state === 'activated'")
        .await;
    wire.slow_down(SLOW_BYTES_PER_S);
    browser.reload().await;
    let after_ms: u64 = browser.text(PRESS_START).await.parse().unwrap();
    println!("on a slow network a press was answered after {after_ms} ms");
    assert!(after_ms <= 2_500, "{after_ms}");
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}

/// Gives a schedule another time, in the form that is open.
async fn save_at(browser: &Browser, at: &str) {
    let fill = format!(
        "const at = document.getElementById('schedule-at'); at.value = '{at}'; \
         at.dispatchEvent(new Event('input', {{ bubbles: true }})); return ''"
    );
    browser.text(&fill).await;
    browser.click("#save-schedule").await;
}

/// Somebody else takes this schedule in the meantime.
fn change_elsewhere(socket: &Path, at: &str) {
    let days = json!(["mo"]);
    let request = json!({
        "c": "change-schedule", "number": 1, "name": "Theirs", "job": { "start": {} },
        "when": { "weekly": { "days": days, "at": at } },
    });
    ask(socket, &request.to_string());
}

#[tokio::test]
async fn two_people_who_change_one_schedule_see_it_and_a_removed_one_comes_back() {
    let Some(visit) = Visit::begin(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    let socket = visit.stack.daemon_socket();
    ask(
        &socket,
        r#"{"c":"add-schedule","name":"Ours","job":{"start":{}},"when":{"weekly":{"days":["mo"],"at":"07:00"}}}"#,
    );
    browser.click("#tab-schedules").await;
    browser.says("schedules", "Ours").await;
    browser.click("#edit-1").await;
    change_elsewhere(&socket, "08:00");
    browser.says("schedules", "Theirs").await;
    save_at(browser, "09:00").await;
    browser.says("conflict", "Theirs").await;
    browser.shot("owner-conflict").await;
    browser.click("#keep-mine").await;
    browser.says("schedules", "09:00").await;
    browser.says("schedules", "Ours").await;

    browser.click("#edit-1").await;
    change_elsewhere(&socket, "10:00");
    browser.says("schedules", "Theirs").await;
    save_at(browser, "11:00").await;
    browser.click("#take-theirs").await;
    browser
        .until("return document.getElementById('schedule-at')?.value === '10:00'")
        .await;
    browser.click("#cancel-schedule").await;

    // The tab is open again after the page was loaded anew.
    browser.reload().await;
    browser.says("schedules", "10:00").await;
    browser.click("#remove-1").await;
    browser.says("undo-toast", "Removed: Theirs.").await;
    browser.shot("owner-undo").await;
    browser.click("#undo-removal").await;
    browser.says("schedules", "Theirs").await;
}
