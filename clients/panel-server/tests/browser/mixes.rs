//! Control mixes in the page, with a gamepad that a script moves.

use std::time::Duration;

use crate::Visit;
use crate::browser::{Browser, Screen};
use crate::robot::Observer;

/// A pad that the page cannot distinguish from a real one; it trembles as in a hand, and counts its rumbles.
const PAD: &str = "
    window.rumbles = 0;
    window.pad = {
        index: 0, id: 'Scripted pad', connected: true, mapping: 'standard', timestamp: 0, axes: [0, 0, 0, 0],
        buttons: Array.from({ length: 17 }, () => ({ value: 0, pressed: false, touched: false })),
        vibrationActuator: { playEffect: () => { window.rumbles += 1; return Promise.resolve('complete'); } },
    };
    window.plugged = true;
    window.trembles = true;
    setInterval(() => { if (window.trembles) window.pad.timestamp = performance.now(); }, 100);
    navigator.getGamepads = () => [window.plugged ? window.pad : null, null, null, null];
    window.stick = (axis, value) => { window.pad.axes[axis] = value; window.pad.timestamp = performance.now(); };
    window.button = (number, value) => { window.pad.buttons[number] = { value }; };
    return ''";

const ACROSS: u8 = 0;
const ALONG: u8 = 1;
const EAST: u8 = 1;
const START: u8 = 9;
const RIGHT_ALONG: u8 = 3;

pub(crate) async fn plug_in(browser: &Browser) {
    browser.text(PAD).await;
    browser
        .until("return document.getElementById('gamepads').textContent.includes('Scripted pad')")
        .await;
    is_ready(browser).await;
}

pub(crate) async fn is_ready(browser: &Browser) {
    browser
        .until("return document.getElementById('drive-state').textContent === ''")
        .await;
}

async fn stick(browser: &Browser, axis: u8, value: f64) {
    browser.text(&format!("stick({axis}, {value}); return ''")).await;
}

/// Presses and lets go, with time for the page to see both.
async fn press(browser: &Browser, button: u8) {
    let script = format!("button({button}, 1); setTimeout(() => button({button}, 0), 300); return ''");
    browser.text(&script).await;
}

/// On a machine that is too busy the lease ends between two words of the page: then the stick is let go and held again.
pub(crate) async fn turn_by_pad(browser: &Browser, witness: &Observer) {
    for _ in 0..5 {
        stick(browser, ACROSS, -1.0).await;
        if witness.moves_within(Duration::from_secs(4)) {
            return;
        }
        stick(browser, ACROSS, 0.0).await;
        is_ready(browser).await;
    }
    panic!("the robot does not turn");
}

/// Until the robot has stood for twice the standstill that the page requires before a start counts.
fn come_to_rest(witness: &Observer) {
    let has_rested = (0..10).any(|_| !witness.moves_within(Duration::from_millis(500)));
    assert!(has_rested, "the robot moves although the stick is at rest");
}

/// Starts from rest until the page has measured how fast the robot follows; the stick is held at the end.
async fn measured_latency(browser: &Browser, witness: &Observer) -> String {
    for _ in 0..5 {
        stick(browser, ACROSS, 0.0).await;
        come_to_rest(witness);
        is_ready(browser).await;
        turn_by_pad(browser, witness).await;
        let latency = browser
            .text("return document.getElementById('latency')?.firstChild.textContent ?? ''")
            .await;
        if !latency.is_empty() {
            return latency;
        }
    }
    panic!("the page does not measure how fast the robot follows");
}

#[tokio::test]
async fn a_gamepad_starts_stops_drives_and_shakes_at_a_wall() {
    let Some(visit) = Visit::begin_alone(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    plug_in(browser).await;
    press(browser, START).await;
    browser.until_state(&["cleaning"]).await;
    browser.sweeps_more_than(40).await;
    press(browser, EAST).await;
    browser.until_state(&["idle"]).await;

    let witness = Observer::watch(&visit.stack.simulator_socket());
    println!("{}", measured_latency(browser, &witness).await);
    browser.shot("desktop-gamepad").await;

    stick(browser, ACROSS, 0.0).await;
    is_ready(browser).await;
    feel_a_wall(browser).await;
}

/// Drives ahead, with a short rest now and then, until the pad shakes.
async fn feel_a_wall(browser: &Browser) {
    let ahead = format!(
        "stick({ALONG}, -1);
         window.rests = setInterval(() => {{
             stick({ALONG}, 0);
             setTimeout(() => stick({ALONG}, -1), 400);
         }}, 6000);
         return ''"
    );
    browser.text(&ahead).await;
    browser.until("return window.rumbles > 0").await;
    let rest = format!("clearInterval(window.rests); stick({ALONG}, 0); return ''");
    browser.text(&rest).await;
}

/// Writes into a field as a person does.
async fn write(browser: &Browser, id: &str, text: &str) {
    let script = format!(
        "const field = document.getElementById('{id}'); field.focus(); field.value = '{text}';
         field.dispatchEvent(new Event('input', {{ bubbles: true }})); return ''"
    );
    browser.text(&script).await;
}

async fn holds(browser: &Browser, id: &str, text: &str) {
    browser
        .until(&format!(
            "return document.getElementById('{id}')?.value === '{text}'"
        ))
        .await;
}

/// Opens the editor, and in it the first line of the output that turns.
async fn open_line(browser: &Browser) {
    browser.click("#edit-mixes").await;
    browser
        .until("return document.querySelector('[data-output=turn] .unfold') !== null")
        .await;
    browser.click("[data-output=turn] .unfold").await;
    browser.click("#line-1-0").await;
    browser
        .until("return document.getElementById('line-1-0-weight') !== null")
        .await;
}

/// Where a point of the curve is on the screen, as `x y`.
const SECOND_POINT: &str = "
    const point = document.querySelectorAll('.mix-points .point')[1];
    point.scrollIntoView({ block: 'center' });
    const box = point.querySelector('.thumb').getBoundingClientRect();
    return `${box.x + box.width / 2} ${box.y + box.height / 2}`;";

#[tokio::test]
async fn a_curve_is_dragged_and_a_trim_and_a_mode_are_added_and_kept() {
    let Some(visit) = Visit::begin_alone(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    open_line(browser).await;
    browser.click("#shape-1-0").await;
    holds(browser, "line-1-0-curve", "-1 -1, -0.5 -0.5, 0 0, 0.5 0.5, 1 1").await;
    let told = browser.text(SECOND_POINT).await;
    let (x, y) = told.split_once(' ').unwrap();
    let (x, y): (f64, f64) = (x.parse().unwrap(), y.parse().unwrap());
    for (kind, right, down) in [
        ("mousePressed", 0.0, 0.0),
        ("mouseMoved", 9.0, 9.0),
        ("mouseMoved", 18.0, 27.0),
        ("mouseReleased", 18.0, 27.0),
    ] {
        let event = serde_json::json!({
            "type": kind, "x": x + right, "y": y + down, "button": "left", "buttons": 1, "clickCount": 1,
        });
        browser.devtools("Input.dispatchMouseEvent", &event);
    }
    browser
        .until("const [at, value] = document.getElementById('line-1-0-curve').value.split(', ')[1].split(' ').map(Number);
                return at > -0.45 && at < -0.2 && value < -0.6")
        .await;
    browser
        .until("document.querySelectorAll('.mix-points .point')[3].focus(); return true")
        .await;
    for _ in 0..2 {
        crate::keyboard::press(browser, "ArrowUp");
    }
    browser
        .until("return document.getElementById('line-1-0-curve').value.split(', ')[3] === '0.5 0.6'")
        .await;
    browser.shot("desktop-mix-points").await;
    browser.click("#add-trim").await;
    browser.click("#add-mode").await;
    holds(browser, "trim-0-output", "turn").await;
    write(browser, "mode-0-name", "indoors").await;
    write(browser, "line-1-0-modes", "indoors").await;
    browser.shot("desktop-mix-flight").await;
    browser.click("#mix-save").await;
    browser.says("mixes", "is kept by the robot").await;
    browser.reload().await;
    browser.click("#edit-mixes").await;
    holds(browser, "mode-0-name", "indoors").await;
}

/// Whether the page has the browser ask before it is left.
const IS_ASKED_FIRST: &str =
    "return String(!window.dispatchEvent(new Event('beforeunload', { cancelable: true })))";

#[tokio::test]
async fn a_mix_is_edited_tried_saved_and_there_again_after_a_reload() {
    let Some(visit) = Visit::begin(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let witness = Observer::watch(&visit.stack.simulator_socket());
    plug_in(browser).await;
    open_line(browser).await;
    holds(browser, "mix-name", "My mix").await;

    browser.click("#line-1-0-input-set").await;
    stick(browser, RIGHT_ALONG, 1.0).await;
    holds(browser, "line-1-0-input", "pad-0-axis-3").await;
    stick(browser, RIGHT_ALONG, 0.0).await;

    write(browser, "line-1-0-weight", "3").await;
    browser
        .says("line-1-0-weight-problem", "write a number from -2 to 2")
        .await;
    browser
        .until("return document.getElementById('mix-save').disabled")
        .await;
    browser.shot("desktop-mix-wrong").await;
    write(browser, "line-1-0-weight", "0.5").await;
    browser
        .until("return document.getElementById('mix-state').textContent === ''")
        .await;
    stick(browser, RIGHT_ALONG, 1.0).await;
    // The line is inverted, so that right is clockwise.
    browser
        .until("return document.querySelector('[data-output=turn] [role=meter]').ariaValueNow === '-50'")
        .await;
    assert!(
        !witness.moves_within(Duration::from_secs(1)),
        "the robot follows a mix that is edited"
    );
    browser.shot("desktop-mixes").await;
    stick(browser, RIGHT_ALONG, 0.0).await;

    assert_eq!(
        browser.text(IS_ASKED_FIRST).await,
        "true",
        "changes would be lost"
    );
    browser.click("#mix-save").await;
    browser.says("mix-remark", "is kept by the robot").await;
    assert_eq!(browser.text(IS_ASKED_FIRST).await, "false");
    write(browser, "line-1-0-weight", "1").await;
    browser.click("#mix-revert").await;
    holds(browser, "line-1-0-weight", "0.5").await;

    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    holds(browser, "mix", "My mix").await;
    open_line(browser).await;
    holds(browser, "line-1-0-input", "pad-0-axis-3").await;
    holds(browser, "line-1-0-weight", "0.5").await;

    import(
        browser,
        r#"{"version":1,"name":"a","outputs":[{"output":"fly"}]}"#,
    )
    .await;
    browser.says("mix-remark", "broken.json: line 1, column").await;
    browser.click("#mix-delete").await;
    browser
        .until("return [...document.querySelectorAll('#mix option')].length === 1")
        .await;
}

/// Chooses a file with this text.
async fn import(browser: &Browser, text: &str) {
    let script = format!(
        "const files = new DataTransfer(); files.items.add(new File(['{text}'], 'broken.json'));
         const field = document.getElementById('mix-file'); field.files = files.files;
         field.dispatchEvent(new Event('change', {{ bubbles: true }})); return ''"
    );
    browser.text(&script).await;
}

#[tokio::test]
async fn a_phone_in_the_dark_edits_mixes_without_sideways_scrolling() {
    let Some(visit) = Visit::begin(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.darken().await;
    open_line(browser).await;
    learn_tilt(browser).await;
    browser.shot("phone-mixes-dark").await;
    let wide = browser.text(crate::accessibility::TOO_WIDE).await;
    assert_eq!(
        wide, "0",
        "the page is wider than the phone while mixes are edited"
    );
    let small = browser.text(crate::SMALL_TARGETS).await;
    assert_eq!(small, "", "controls that a thumb misses");
    let nameless = browser.text(NAMELESS).await;
    assert_eq!(nameless, "", "fields that a screen reader cannot name");
}

/// A phone that is held at forty degrees, and then tilted away from the person by a good half of a quarter turn.
async fn learn_tilt(browser: &Browser) {
    browser.click("#tilt").await;
    browser
        .until("return document.getElementById('tilt').ariaPressed === 'true'")
        .await;
    held_at(browser, 40).await;
    browser.click("#line-1-0-input-set").await;
    browser
        .until("return document.getElementById('line-1-0-input-set').ariaPressed === 'true'")
        .await;
    held_at(browser, -20).await;
    holds(browser, "line-1-0-input", "tilt-forward").await;
}

async fn held_at(browser: &Browser, top_edge_raised_deg: i32) {
    let script = format!(
        "const held = {{ alpha: 0, beta: {top_edge_raised_deg}, gamma: 0 }};
         window.dispatchEvent(new DeviceOrientationEvent('deviceorientation', held)); return ''"
    );
    browser.text(&script).await;
    // Some readings of the inputs pass.
    browser
        .text("return new Promise((done) => setTimeout(() => done(''), 300))")
        .await;
}

/// Fields and bars without a label.
const NAMELESS: &str = "
    const named = (element) => element.ariaLabel || element.labels?.length > 0;
    return [...document.querySelectorAll('#mixes :is(input, select, [role=meter])')]
        .filter((element) => !named(element)).map((element) => element.id || element.className).join(', ')";

/// The page gets a robot without side brushes: they are cut out of the messages to the page.
const WITHOUT_SIDE_BRUSHES: &str = "
    const told = Object.getOwnPropertyDescriptor(MessageEvent.prototype, 'data');
    Object.defineProperty(MessageEvent.prototype, 'data', { get() {
        const data = told.get.call(this);
        return typeof data === 'string' ? data.replace(/\"brush-sides\",|,\"brush-sides\"/, '') : data;
    } });";

#[tokio::test]
async fn an_output_of_a_part_that_the_robot_lacks_says_so() {
    for (screen, name) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::begin(screen).await else {
            return;
        };
        let browser = &visit.browser;
        let cut = serde_json::json!({ "source": WITHOUT_SIDE_BRUSHES });
        browser.devtools("Page.addScriptToEvaluateOnNewDocument", &cut);
        browser.reload().await;
        browser.until_state(&["idle", "docked"]).await;
        if matches!(screen, Screen::Phone) {
            browser.click("#tab-drive").await;
        }
        browser.click("#edit-mixes").await;
        browser
            .until("return document.querySelector('[data-output=side-brushes] .absent')?.textContent.includes('lacks the part') === true")
            .await;
        let told = browser
            .text("return String(document.querySelectorAll('.outputs .absent').length)")
            .await;
        assert_eq!(told, "1", "the other parts are there");
        for look in ["light", "dark"] {
            if look == "dark" {
                browser.darken().await;
            }
            browser
                .text("document.querySelector('[data-output=side-brushes]').scrollIntoView({block: 'center'}); return ''")
                .await;
            browser.shot(&format!("{name}-mix-part-absent-{look}")).await;
            crate::accessibility::expect_none(browser, "a mix with a part that the robot lacks").await;
        }
    }
}
