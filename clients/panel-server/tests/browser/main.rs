//! The panel in a real browser, in front of the real daemon and the real simulator.
//!
//! They run only when `RVAC_BROWSER_TESTS` is set, because they need Chromium, its driver, a packed panel in the folder named by
//! `RVAC_PANEL`, the robot's firmware named by `RVAC_FIRMWARE`, and the binaries `vthal`, `rvac` and `rvac-sim` beside that of
//! the server. Screenshots go to the folder named by `RVAC_SCREENSHOTS`. `RVAC_AXE` names `axe.min.js` of axe-core.
//! `RVAC_PICTURES` names the folder for the pictures of the README, which are taken only then.
//! `RVAC_LOSSES` says how often each loss of the driver is tried, `RVAC_GESTURES` how many random gestures, `RVAC_ENGINES` that they are made in other engines, too, `RVAC_WATCH_MINUTES` how long the memory of the page is watched.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

mod accessibility;
mod browser;
mod calibration;
mod carpets;
mod costs;
mod edits;
mod engines;
mod floors;
#[path = "../folder/mod.rs"]
mod folder;
mod foreign;
mod frozen;
mod gestures;
mod hands;
mod history;
mod keyboard;
mod language;
mod large_home;
mod late;
mod learnt;
mod lending;
mod lifetime;
mod losses;
mod matter;
mod mixes;
mod offline;
mod owner;
mod pairing;
mod parts;
mod pictures;
mod processes;
mod relief;
mod reshape;
mod rival;
mod robot;
mod roles;
mod schedules;
mod sheets;
mod slow_wire;
mod small_print;
mod software;
#[path = "../stack/mod.rs"]
mod stack;
mod stands;
mod stranger;
mod system;
mod tasks;
mod teller;
mod turns;
mod wire_tap;

use std::time::{Duration, Instant};

use accessibility::SMALL_TARGETS;
use browser::{Browser, Screen};
use robot::Observer;
use stack::Stack;
use turns::{Company, Turn, turn};

/// A browser that shows the panel of a robot at rest.
struct Visit {
    browser: Browser,
    stack: Stack,
    _turn: Turn,
}

impl Visit {
    /// Starts all parts and waits for the robot; `None`, with a message, when browser tests are off.
    async fn begin(screen: Screen) -> Option<Self> {
        Self::with(Stack::start, screen).await
    }

    /// With nothing else going on, for what depends on time.
    async fn begin_alone(screen: Screen) -> Option<Self> {
        Self::alone_with(Stack::start, screen).await
    }

    /// In a home that is on the robot's map.
    async fn begin_at_home(screen: Screen) -> Option<Self> {
        Self::with(Stack::start_at_home, screen).await
    }

    /// The same with the list of its rooms in sight.
    async fn begin_among_rooms(screen: Screen) -> Option<Self> {
        let visit = Self::begin_at_home(screen).await?;
        visit.browser.click("#tab-home").await;
        visit
            .browser
            .until("return document.querySelectorAll('#rooms .choose').length > 1")
            .await;
        Some(visit)
    }

    /// With the robot's real firmware in an emulated chip.
    async fn begin_emulated(screen: Screen) -> Option<Self> {
        Self::alone_with(Stack::start_emulated, screen).await
    }

    async fn with(start: fn() -> Stack, screen: Screen) -> Option<Self> {
        Self::at_the_door(start, screen, Company::Others)
            .await?
            .greeted()
            .await
    }

    async fn alone_with(start: fn() -> Stack, screen: Screen) -> Option<Self> {
        Self::at_the_door(start, screen, Company::None)
            .await?
            .greeted()
            .await
    }

    /// Waits for the robot.
    async fn greeted(self) -> Option<Self> {
        self.browser.until_state(&["idle", "docked"]).await;
        Some(self)
    }

    /// Without waiting for a robot that may not be shown.
    async fn at_the_door(start: fn() -> Stack, screen: Screen, company: Company) -> Option<Self> {
        if std::env::var_os("RVAC_BROWSER_TESTS").is_none() {
            println!("skipped: RVAC_BROWSER_TESTS is not set");
            return None;
        }
        let turn = turn(company).await;
        let stack = start();
        let browser = Browser::open(&stack, screen).await;
        Some(Self {
            browser,
            stack,
            _turn: turn,
        })
    }
}

#[tokio::test]
async fn start_cleans_and_stop_stands() {
    let Some(visit) = Visit::begin_alone(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser
        .until("return document.querySelector('#presence.up') !== null")
        .await;
    browser.shot("desktop-ready").await;

    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.click("#spot").await;
    browser
        .until("return document.getElementById('refusal')?.innerText.includes('A job is running') === true")
        .await;
    browser.shot("desktop-not-now").await;
    let first = browser
        .text("return document.getElementById('map').dataset.pose")
        .await;
    browser
        .until(&format!(
            "return document.getElementById('map').dataset.pose !== '{first}'"
        ))
        .await;
    browser.sweeps_more_than(200).await;
    browser
        .until("return Number(document.getElementById('map').dataset.framesPerSecond) > 0")
        .await;
    browser.shot("desktop-cleaning").await;
    let frames = browser.frames_per_second(Duration::from_secs(6)).await;
    println!("frames per second while the robot moves: {frames:.1}");
    assert!(frames > 20.0, "{frames}");

    browser.click("#stop").await;
    browser.until_state(&["idle"]).await;
    browser
        .until("return document.getElementById('refusal') === null")
        .await;
    let witness = Observer::watch(&visit.stack.simulator_socket());
    let stood = witness.stands_within(Duration::from_secs(3));
    assert!(stood.is_some(), "the robot still moves three seconds after Stop");
}

/// The very bytes that would be written to a robot, behind the same page.
#[tokio::test]
async fn the_real_firmware_cleans_and_stop_stands() {
    let Some(visit) = Visit::begin_emulated(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let witness = Observer::watch(&visit.stack.simulator_socket());
    browser.click("#strategy option[value=bounce]").await;
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser
        .until("return document.body.innerText.includes('Cleaning pattern: Random.')")
        .await;
    browser.sweeps_more_than(200).await;
    browser.shot("desktop-emulated").await;

    browser.click("#stop").await;
    let clicked = Instant::now();
    let stood = witness
        .stands_within(Duration::from_secs(3))
        .expect("the robot still moves three seconds after Stop");
    let after = stood.saturating_duration_since(clicked);
    println!("the emulated robot stood {} ms after Stop", after.as_millis());
    browser.until_state(&["idle"]).await;
    assert!(
        !witness.moves_within(Duration::from_secs(1)),
        "the robot moves again after Stop"
    );
}

/// Holds a key until the robot turns on the spot, which is possible wherever the short job has left it. On a machine
/// that is too busy the lease ends between two words of the page, and the wheels wait for a new hold: so does this.
async fn hold_until_it_turns(browser: &Browser, witness: &Observer) {
    for _ in 0..5 {
        browser.hold_key_in("#pad", 'a').await;
        if witness.moves_within(Duration::from_secs(4)) {
            return;
        }
        browser.release_key('a').await;
    }
    browser.fail("the robot does not turn").await
}

#[tokio::test]
async fn the_keyboard_is_enough() {
    let Some(visit) = Visit::begin(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.tab_to("start").await;
    browser.press_enter().await;
    browser.until_state(&["cleaning"]).await;
    browser.shot("desktop-keyboard-focus").await;
    browser.tab_to("stop").await;
    browser.press_enter().await;
    browser.until_state(&["idle", "docked"]).await;
}

#[tokio::test]
async fn a_phone_shows_everything_without_sideways_scrolling() {
    let Some(visit) = Visit::begin(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.press_start().await;
    browser.sweeps_more_than(100).await;
    for tab in ["drive", "home", "why", "device", "log"] {
        browser.click(&format!("#tab-{tab}")).await;
        browser
            .until(&format!("return !document.getElementById('sheet-{tab}').hidden"))
            .await;
        let wide = browser.text(accessibility::TOO_WIDE).await;
        assert_eq!(wide, "0", "the page is wider than the phone while {tab} is open");
        browser.shot(&format!("phone-{tab}")).await;
    }
    browser.click("#stop").await;
    browser.until_state(&["idle"]).await;
}

#[tokio::test]
async fn the_dark_look_is_kept() {
    let Some(visit) = Visit::begin(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let background = "return getComputedStyle(document.body).backgroundColor";
    let light = browser.text(background).await;
    browser.darken().await;
    let dark = browser.text(background).await;
    assert_ne!(light, dark);
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    assert_eq!(browser.text(background).await, dark);
    browser.press_start().await;
    browser.sweeps_more_than(100).await;
    browser.click("#tab-device").await;
    browser
        .until("return document.querySelectorAll('#device-table tr').length > 20")
        .await;
    browser.shot("desktop-dark").await;
}

#[tokio::test]
async fn what_the_robot_knows_and_decides_is_shown() {
    let Some(visit) = Visit::begin(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser
        .until("return document.getElementById('lately')?.textContent.length > 10")
        .await;
    browser.click("#tab-why").await;
    browser
        .until("return [...document.querySelectorAll('#decisions li')].some(line => line.textContent.includes('Cleaning started'))")
        .await;
    browser.click("#tab-home").await;
    browser
        .until("return document.querySelector('#home-sheet .sentences li')?.textContent.includes('Position known to')")
        .await;
    browser
        .until("return document.getElementById('place')?.textContent.includes('cm')")
        .await;
    let ground = |name: &str| format!("return document.getElementById('map').dataset.ground === '{name}'");
    browser.until(&ground("True")).await;
    browser.sweeps_more_than(400).await;
    browser.click("#ground-known").await;
    browser.until(&ground("Known")).await;
    browser.shot("desktop-knows").await;
    browser.click("#ground-true").await;
    browser.until(&ground("True")).await;
    browser.click("#stop").await;
    browser.until_state(&["idle"]).await;
    // A run that is over leaves a map behind, some seconds later; the sheet that is open shows it then.
    browser
        .until("return document.querySelectorAll('#maps li').length > 0")
        .await;
}

/// Number of rooms that are chosen, by the list.
const CHOSEN: &str = "return String(document.querySelectorAll('#rooms [aria-pressed=true]').length)";

/// The first room of the list is chosen, named, and cleaned twice; the estimate is shown before.
async fn clean_one_room(browser: &Browser, shots: &str) {
    browser.click("#tab-home").await;
    browser
        .until("return document.querySelectorAll('#rooms .choose').length > 1")
        .await;
    browser.says("whole-home", "of a full battery").await;
    browser.shot(&format!("{shots}-before-the-start")).await;
    browser.click("#rooms .choose").await;
    assert_eq!(browser.text(CHOSEN).await, "1");
    browser
        .until("return document.getElementById('whole-home') === null")
        .await;
    browser.says("prospect", "of a full battery").await;
    browser.shot(&format!("{shots}-room-chosen")).await;
    browser.click("#manner summary").await;
    browser.click("#passes-2").await;
    browser.choose("job-power", "quiet").await;
    browser.choose("job-pattern", "contour").await;
    browser.says("manner", "2x, quiet, along the walls").await;
    browser.shot(&format!("{shots}-manner")).await;
    browser.click("#clean-chosen").await;
    browser.until_state(&["cleaning"]).await;
    browser.has_no_order().await;
    assert_eq!(browser.text(CHOSEN).await, "0", "the choice has become a job");
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}

#[tokio::test]
async fn one_room_is_chosen_in_the_list_and_cleaned() {
    for (screen, shots) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::begin_at_home(screen).await else {
            return;
        };
        clean_one_room(&visit.browser, shots).await;
    }
}

#[tokio::test]
async fn a_daemon_that_dies_is_shown_and_found_again() {
    let Some(mut visit) = Visit::begin(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    visit.stack.kill_vthal();
    browser.until_state(&["disconnected"]).await;
    let reason = browser
        .text("return document.getElementById('reason').textContent")
        .await;
    assert!(reason.contains("not running"), "{reason}");
    browser.shot("desktop-disconnected").await;
    visit.stack.start_vthal();
    browser.until_state(&["idle", "docked"]).await;
}
