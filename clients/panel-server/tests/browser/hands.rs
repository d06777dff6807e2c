//! Other hands than one pad and a keyboard: two pads, a thumb on the screen, a tilted phone, another client. Each drives, is
//! lost, and the wheels stop.

use std::time::{Duration, Instant};

use serde_json::json;

use crate::browser::{Browser, Screen};
use crate::losses::{Losses, ready_to_drive, stays, times};
use crate::mixes::{is_ready, plug_in};
use crate::robot::Observer;
use crate::teller::Teller;

/// Drives by this mix: the page reads it from a file into its editor, and the robot keeps it.
pub(crate) async fn drive_by(browser: &Browser, profile: &str) {
    browser.click("#edit-mixes").await;
    browser
        .until("return document.getElementById('mix-file') !== null")
        .await;
    let script = format!(
        "const files = new DataTransfer(); files.items.add(new File([`{profile}`], 'mix.json'));
         const field = document.getElementById('mix-file'); field.files = files.files;
         field.dispatchEvent(new Event('change', {{ bubbles: true }})); return ''"
    );
    browser.text(&script).await;
    browser
        .until("return document.getElementById('mix-name')?.value === 'Hands'")
        .await;
    browser.click("#mix-save").await;
    browser.says("mix-remark", "is kept by the robot").await;
    browser.click("#edit-mixes").await;
    browser
        .until("return document.getElementById('mix').value === 'Hands'")
        .await;
    is_ready(browser).await;
}

/// A mix in which these inputs turn the robot, half to each side.
pub(crate) fn turning_by(inputs: &[&str]) -> String {
    let line = |input: &&str| json!({ "name": "Turns", "input": input });
    let lines: Vec<_> = inputs.iter().map(line).collect();
    json!({
        "version": 1, "name": "Hands",
        "outputs": [{ "output": "turn", "low": -1, "high": 1, "lines": lines }],
    })
    .to_string()
}

/// Does something that should turn the robot, from rest on; on a machine that is too busy a lease ends between two words, and the
/// wheels wait for a new hold: so does this.
async fn turn_by(browser: &Browser, witness: &Observer, [rest, push]: [&str; 2]) {
    for _ in 0..5 {
        browser.text(rest).await;
        is_ready(browser).await;
        browser.text(push).await;
        if witness.moves_within(Duration::from_secs(4)) {
            return;
        }
    }
    browser.fail("the robot does not turn").await
}

/// A second pad beside the one of [`plug_in`].
const SECOND_PAD: &str = "
    window.second = { ...window.pad, index: 1, id: 'Second pad', axes: [0, 0, 0, 0] };
    window.secondPlugged = true;
    setInterval(() => { window.second.timestamp = performance.now(); }, 100);
    navigator.getGamepads = () =>
        [window.plugged ? window.pad : null, window.secondPlugged ? window.second : null, null, null];
    window.secondStick = (value) => { window.second.axes[0] = value; window.second.timestamp = performance.now(); };
    return ''";

#[tokio::test]
async fn two_pads_drive_by_lines_of_their_own_and_each_loss_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    drive_by(browser, &turning_by(&["pad-0-axis-0", "pad-1-axis-0"])).await;
    plug_in(browser).await;
    browser.text(SECOND_PAD).await;
    browser.says("gamepads", "pad-1 is Second pad").await;
    let first = ["stick(0, 0); return ''", "stick(0, -1); return ''"];
    let second = ["secondStick(0); return ''", "secondStick(-1); return ''"];
    let [mut of_first, mut of_second, mut of_idle] = [(); 3].map(|()| Losses::default());
    for _ in 0..times() {
        turn_by(browser, &witness, second).await;
        browser.text("window.secondPlugged = false; return ''").await;
        of_second.watch(&witness, Instant::now());
        browser.text("window.secondPlugged = true; return ''").await;
        stays(&witness, "a second stick");
        browser.text(second[0]).await;

        turn_by(browser, &witness, first).await;
        browser.text("window.plugged = false; return ''").await;
        of_first.watch(&witness, Instant::now());
        browser.text("window.plugged = true; return ''").await;
        stays(&witness, "a first stick");
        browser.text(first[0]).await;

        turn_by(browser, &witness, first).await;
        browser.text("window.secondPlugged = false; return ''").await;
        of_idle.watch(&witness, Instant::now());
        browser.text("window.secondPlugged = true; return ''").await;
        browser.text(first[0]).await;
        is_ready(browser).await;
    }
    of_first.tell("the first of two pads was lost");
    of_second.tell("the second of them was lost");
    of_idle.tell("the second was lost while the first drove");
}

/// A finger on the screen, as far from the middle of the pad as its radius, or gone from there.
pub(crate) fn touch(browser: &Browser, kind: &str, places: &[[f64; 2]]) {
    let points: Vec<_> = places.iter().map(|[x, y]| json!({ "x": x, "y": y })).collect();
    browser.devtools(
        "Input.dispatchTouchEvent",
        &json!({ "type": kind, "touchPoints": points }),
    );
}

/// Middle and radius of the pad on the screen.
pub(crate) async fn pad_on_screen(browser: &Browser) -> [f64; 3] {
    let told = browser
        .text(
            "const pad = document.getElementById('pad'); pad.scrollIntoView({ block: 'center' });
             const box = pad.getBoundingClientRect();
             return JSON.stringify([box.x + box.width / 2, box.y + box.height / 2, box.width / 2])",
        )
        .await;
    serde_json::from_str(&told).unwrap()
}

/// Drags the knob from the middle to the left until the robot turns; the finger stays there.
async fn drag_until_it_turns(browser: &Browser, witness: &Observer) {
    for _ in 0..5 {
        is_ready(browser).await;
        let [x, y, radius] = pad_on_screen(browser).await;
        touch(browser, "touchStart", &[[x, y]]);
        for step in 1..=4 {
            let left = radius * f64::from(step) / 4.0;
            touch(browser, "touchMove", &[[x - left, y]]);
        }
        if witness.moves_within(Duration::from_secs(4)) {
            return;
        }
        touch(browser, "touchEnd", &[]);
    }
    browser.fail("the robot does not turn").await
}

#[tokio::test]
async fn a_thumb_drives_on_the_screen_and_the_wheels_stand_when_it_is_gone() {
    let Some((visit, witness)) = ready_to_drive(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-drive").await;
    let [mut of_end, mut of_cancel, mut of_tab] = [(); 3].map(|()| Losses::default());
    for trial in 0..times() {
        drag_until_it_turns(browser, &witness).await;
        if trial == 0 {
            browser.shot("phone-driving").await;
        }
        touch(browser, "touchEnd", &[]);
        of_end.watch(&witness, Instant::now());

        // The system takes the finger away: a call comes, or a gesture of its own begins.
        drag_until_it_turns(browser, &witness).await;
        touch(browser, "touchCancel", &[]);
        of_cancel.watch(&witness, Instant::now());

        drag_until_it_turns(browser, &witness).await;
        browser.hide_behind_a_new_tab().await;
        of_tab.watch(&witness, Instant::now());
        browser.close_tab_and_return().await;
        stays(&witness, "a thumb");
        touch(browser, "touchEnd", &[]);
    }
    of_end.tell("the thumb was lifted");
    of_cancel.tell("the system took the thumb away");
    of_tab.tell("the tab was hidden under the thumb");
}

/// How a phone is held: the browser itself sends it to the page, as from its sensors.
fn hold(browser: &Browser, top_edge_raised_deg: f64, right_edge_lowered_deg: f64) {
    browser.devtools(
        "DeviceOrientation.setDeviceOrientationOverride",
        &json!({ "alpha": 0, "beta": top_edge_raised_deg, "gamma": right_edge_lowered_deg }),
    );
}

/// For so long no tilt may be sent.
const TILT_SILENT: Duration = Duration::from_secs(1);

/// A hand that trembles, for what is never so still is not held.
async fn tremble(browser: &Browser, right_edge_lowered_deg: f64, times: u32) {
    for time in 0..times {
        hold(browser, 40.0, right_edge_lowered_deg + f64::from(time % 2) * 0.5);
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
}

/// Tilts the phone to the left until the robot turns.
async fn tilt_until_it_turns(browser: &Browser, witness: &Observer) {
    for _ in 0..5 {
        tremble(browser, 0.0, 3).await;
        is_ready(browser).await;
        for _ in 0..8 {
            tremble(browser, -60.0, 3).await;
            if witness.moves_within(Duration::from_millis(300)) {
                return;
            }
        }
    }
    browser.fail("the robot does not turn").await
}

async fn tilt_is(browser: &Browser, pressed: bool) {
    let wanted = format!("return document.getElementById('tilt').ariaPressed === '{pressed}'");
    browser.until(&wanted).await;
}

#[tokio::test]
async fn a_tilted_phone_drives_and_the_wheels_stand_when_it_is_not_followed() {
    let Some((visit, witness)) = ready_to_drive(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-drive").await;
    drive_by(browser, &turning_by(&["tilt-left"])).await;
    let [mut of_button, mut of_sensor, mut of_tab] = [(); 3].map(|()| Losses::default());
    for _ in 0..times() {
        hold(browser, 40.0, 0.0);
        browser.click("#tilt").await;
        tilt_is(browser, true).await;
        tilt_until_it_turns(browser, &witness).await;
        browser.click("#tilt").await;
        of_button.watch(&witness, Instant::now());
        tilt_is(browser, false).await;

        // The phone lies on a table, as it was held: its sensor says nothing more.
        hold(browser, 40.0, 0.0);
        browser.click("#tilt").await;
        tilt_is(browser, true).await;
        tilt_until_it_turns(browser, &witness).await;
        of_sensor.watch(&witness, Instant::now() + TILT_SILENT);
        browser.click("#tilt").await;
        tilt_is(browser, false).await;

        hold(browser, 40.0, 0.0);
        browser.click("#tilt").await;
        tilt_is(browser, true).await;
        tilt_until_it_turns(browser, &witness).await;
        browser.hide_behind_a_new_tab().await;
        of_tab.watch(&witness, Instant::now());
        browser.close_tab_and_return().await;
        stays(&witness, "a tilt");
        if browser
            .text("return document.getElementById('tilt').ariaPressed")
            .await
            == "true"
        {
            browser.click("#tilt").await;
        }
        tilt_is(browser, false).await;
    }
    of_button.tell("the tilt was not followed any more");
    of_sensor.tell("nothing had been told of the tilt for a second");
    of_tab.tell("the tab was hidden while the phone was tilted");
}

/// The other client sends a push until the robot turns.
async fn steer_until_it_turns(browser: &Browser, teller: &Teller, witness: &Observer) {
    for _ in 0..5 {
        teller.tell(0.0);
        tokio::time::sleep(Duration::from_millis(300)).await;
        is_ready(browser).await;
        teller.tell(-1.0);
        if witness.moves_within(Duration::from_secs(4)) {
            return;
        }
    }
    browser.fail("the robot does not turn").await
}

#[tokio::test]
async fn another_client_drives_by_the_mix_of_the_page_and_its_loss_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let socket = visit.stack.daemon_socket();
    drive_by(browser, &turning_by(&["client-steer"])).await;
    let [mut of_death, mut of_silence, mut of_tab] = [(); 3].map(|()| Losses::default());
    for _ in 0..times() {
        let teller = Teller::of("steer", &socket);
        steer_until_it_turns(browser, &teller, &witness).await;
        drop(teller);
        of_death.watch(&witness, Instant::now());

        let teller = Teller::of("steer", &socket);
        steer_until_it_turns(browser, &teller, &witness).await;
        teller.fall_silent();
        of_silence.watch(&witness, Instant::now());
        teller.tell(-1.0);
        stays(&witness, "an input");

        // Who drives is lost, and the other client goes on.
        steer_until_it_turns(browser, &teller, &witness).await;
        browser.hide_behind_a_new_tab().await;
        of_tab.watch(&witness, Instant::now());
        browser.close_tab_and_return().await;
        stays(&witness, "an input");
        teller.tell(0.0);
        is_ready(browser).await;
    }
    of_death.tell("the client that steered died");
    of_silence.tell("the client that steered fell silent");
    of_tab.tell("the tab was hidden while a client steered");
}

/// **Set** takes what another client moves.
#[tokio::test]
async fn an_input_of_another_client_is_learnt_in_the_editor() {
    let Some(visit) = crate::Visit::begin_alone(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let teller = Teller::of("front left", &visit.stack.daemon_socket());
    browser.click("#edit-mixes").await;
    browser
        .until("return document.querySelector('[data-output=turn] .unfold') !== null")
        .await;
    browser.click("[data-output=turn] .unfold").await;
    browser.click("#line-1-0").await;
    browser.click("#line-1-0-input-set").await;
    browser
        .until("return document.getElementById('line-1-0-input-set').ariaPressed === 'true'")
        .await;
    // Some readings of the inputs pass with the stick at rest.
    tokio::time::sleep(Duration::from_millis(300)).await;
    teller.tell(0.8);
    browser
        .until("return document.getElementById('line-1-0-input').value === 'client-front left'")
        .await;
}
