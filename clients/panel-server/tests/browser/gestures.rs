//! Random gestures of a mouse at the stick on the screen: without a pressed button nothing is asked of the robot.

use serde_json::json;

use crate::browser::{Browser, Screen};
use crate::hands::pad_on_screen;
use crate::losses::ready_to_drive;
use crate::mixes::is_ready;

/// Counts the requests that would move the robot.
pub(crate) const COUNT_MOTIONS: &str = "
    window.motions = 0;
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (text) {
        const said = typeof text === 'string' && text.includes('\"drive\"') ? JSON.parse(text) : {};
        if (said.c === 'drive' && (said.v !== 0 || said.w !== 0)) window.motions += 1;
        return send.call(this, text);
    };
    return ''";
/// Motions asked for while the hands are off. The first steps after that may still say the last position.
pub(crate) const MOTIONS_SINCE: &str = "
    const pause = (ms) => new Promise((done) => setTimeout(done, ms));
    return pause(80).then(() => { window.before = window.motions; return pause(140); })
        .then(() => String(window.motions - window.before))";
/// What a browser or a system may do in the middle of a hold.
const INTERRUPTIONS: [&str; 6] = [
    "window.dispatchEvent(new Event('blur'))",
    "window.dispatchEvent(new Event('pagehide'))",
    "document.body.dispatchEvent(new DragEvent('dragstart', { bubbles: true, cancelable: true }))",
    "document.getElementById('pad').dispatchEvent(new Event('selectstart', { bubbles: true, cancelable: true }))",
    "document.getElementById('pad').dispatchEvent(new MouseEvent('contextmenu', { bubbles: true, cancelable: true }))",
    "document.getElementById('pad').dispatchEvent(new PointerEvent('lostpointercapture', { bubbles: true, pointerId: 1 }))",
];
const SEED: u64 = 9;

/// How many gestures are tried.
pub(crate) fn count() -> u32 {
    let wanted = std::env::var("RVAC_GESTURES").ok();
    wanted.map_or(50, |text| text.parse().expect("RVAC_GESTURES is a number"))
}

/// A small generator, so that the gestures are the same each time.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 33) % end
    }
}

/// A mouse before the page.
struct Mouse<'a> {
    browser: &'a Browser,
    random: Random,
    /// Middle and radius of the pad.
    pad: [f64; 3],
}

impl Mouse<'_> {
    fn tell(&self, kind: &str, buttons: u8, [x, y]: [f64; 2]) {
        let button = if kind == "mouseMoved" { "none" } else { "left" };
        self.browser.devtools(
            "Input.dispatchMouseEvent",
            &json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1 }),
        );
    }

    /// A place in so many radii around the middle of the pad.
    fn place(&mut self, radii: f64) -> [f64; 2] {
        let [x, y, radius] = self.pad;
        let mut offset = || (self.random.below(201) as f64 / 100.0 - 1.0) * radius * radii;
        [(x + offset()).max(1.0), (y + offset()).max(1.0)]
    }

    /// Something between press and release, or in place of both.
    async fn gesture(&mut self) {
        let start = self.place(0.7);
        self.tell("mouseMoved", 0, start);
        self.tell("mousePressed", 1, start);
        for _ in 0..self.random.below(4) + 1 {
            let place = self.place(3.0);
            self.tell("mouseMoved", 1, place);
        }
        tokio::time::sleep(std::time::Duration::from_millis(self.random.below(80))).await;
        let interruption = self.random.below(INTERRUPTIONS.len() as u64 * 2) as usize;
        if let Some(script) = INTERRUPTIONS.get(interruption) {
            self.browser.text(&format!("{script}; return ''")).await;
            let place = self.place(1.0);
            self.tell("mouseMoved", 1, place);
        }
        let end = self.place(3.0);
        // Some ends are not told: a drag, or a window in front.
        if self.random.below(2) == 0 {
            self.tell("mouseReleased", 0, end);
        }
    }

    /// The mouse hovers over the page with no button pressed.
    fn hover(&mut self) {
        for _ in 0..3 {
            let place = self.place(1.0);
            self.tell("mouseMoved", 0, place);
        }
    }
}

/// Of `count()` gestures in an engine so many moved the robot with no button pressed, and all of them moved it so often.
pub(crate) fn judge(engine: &str, wrong: u32, motions: u32) {
    println!(
        "{engine}: {} random gestures: {wrong} moved without a pressed button, {motions} motions in all",
        count()
    );
    assert_eq!(wrong, 0);
    // On a busy machine an engine makes one motion of many moves, or misses a short press.
    assert!(motions > count() / 4, "a pressed button drives: {motions}");
}

#[tokio::test]
async fn random_gestures_move_nothing_without_a_pressed_button() {
    let Some((visit, _)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.text(COUNT_MOTIONS).await;
    let mut mouse = Mouse {
        browser,
        random: Random(SEED),
        pad: pad_on_screen(browser).await,
    };
    let mut wrong = 0;
    for _ in 0..count() {
        mouse.gesture().await;
        mouse.hover();
        let motions = browser.text(MOTIONS_SINCE).await;
        wrong += u32::from(motions != "0");
        let [x, y, _] = mouse.pad;
        mouse.tell("mouseReleased", 0, [x, y]);
    }
    is_ready(browser).await;
    let motions: u32 = browser
        .text("return String(window.motions)")
        .await
        .parse()
        .unwrap();
    judge("Chromium", wrong, motions);
}

/// A hover, a selection and a native drag: what WebKit does with a knob that is dragged beyond the pad twice.
#[tokio::test]
async fn a_knob_that_is_dragged_beyond_the_pad_selects_and_drags_nothing() {
    let Some((visit, _)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.text(COUNT_MOTIONS).await;
    let [x, y, radius] = pad_on_screen(browser).await;
    let mouse = Mouse {
        browser,
        random: Random(SEED),
        pad: [x, y, radius],
    };
    for _ in 0..2 {
        mouse.tell("mouseMoved", 0, [x, y]);
        mouse.tell("mousePressed", 1, [x, y]);
        for step in 1..=8 {
            mouse.tell(
                "mouseMoved",
                1,
                [
                    x - radius * f64::from(step) / 3.0,
                    y - radius * f64::from(step) / 3.0,
                ],
            );
        }
        mouse.tell("mouseReleased", 0, [x - 3.0 * radius, y - 3.0 * radius]);
    }
    assert_eq!(browser.text("return String(getSelection())").await, "");
    assert_eq!(
        browser.text("return document.activeElement.id").await,
        "pad",
        "the keys drive, too"
    );
    mouse.tell("mouseMoved", 0, [x, y]);
    assert_eq!(browser.text(MOTIONS_SINCE).await, "0");
}
