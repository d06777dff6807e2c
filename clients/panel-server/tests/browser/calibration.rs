//! An owner measures a robot that was never calibrated, on a phone in Estonian, and then it starts.

use std::time::{Duration, Instant};

use crate::Visit;
use crate::accessibility::{SMALL_TARGETS, TOO_WIDE, expect_none};
use crate::browser::{Browser, Screen};
use crate::hands::touch;
use crate::robot::Observer;
use crate::stack::Stack;
use crate::turns::Company;

/// Free floor of the flat, two metres before the robot.
const ON_FREE_FLOOR: &str = r#"{"c":"place","x":-0.5,"y":0.06,"heading":3.14}"#;
const LIFT: &str = r#"{"c":"lift"}"#;
const PUT_DOWN: &str = r#"{"c":"put-down"}"#;
/// What a robot needs to drive and to see stairs, and two values that need no hands.
const MEASURED: [&str; 10] = [
    "wheel-distance-per-count",
    "wheel-track",
    "wheel-left-order",
    "wheel-right-order",
    "wheel-dead-band",
    "wheel-free-speed",
    "wheel-left-current-zero",
    "wheel-right-current-zero",
    "cliff-emitter-line",
    "cliff-floor-level",
];
/// The first value after those.
const BEYOND: &str = "proximity-none";
/// An emulated robot on a busy machine measures for long.
const PATIENCE: Duration = Duration::from_secs(120);

/// The number of the step, which value it measures, what it asks and what is to be done, as names.
async fn shown(browser: &Browser) -> [String; 4] {
    let told = browser
        .text(
            "const step = document.getElementById('calibration-step')?.dataset ?? {};
             return JSON.stringify([step.page ?? '', step.value ?? '', step.asks ?? '', step.task ?? ''])",
        )
        .await;
    serde_json::from_str(&told).unwrap()
}

/// A person who does what the page says.
struct Owner<'a> {
    visit: &'a Visit,
    /// The step that was answered last. It stays on the page until the robot has heard the answer.
    answered: String,
    has_let_go: bool,
    looked_at: Vec<String>,
}

impl Owner<'_> {
    fn hand(&self, request: &str) {
        self.visit.stack.hand(request);
    }

    /// Looks at each kind of page once.
    async fn look(&mut self, asks: &str, task: &str) {
        let name = format!("phone-et-calibration-{}{task}", asks.to_lowercase());
        if self.looked_at.contains(&name) {
            return;
        }
        let browser = &self.visit.browser;
        browser
            .text("document.getElementById('calibration').scrollIntoView(); return ''")
            .await;
        browser.shot(&name).await;
        expect_none(browser, &name).await;
        assert_eq!(browser.text(SMALL_TARGETS).await, "", "{name}");
        assert_eq!(browser.text(TOO_WIDE).await, "0", "{name} is too wide");
        self.looked_at.push(name);
    }

    /// Answers the page that is shown; whether there is more to measure.
    async fn answer(&mut self) -> bool {
        let browser = &self.visit.browser;
        let [step, value, asks, task] = shown(browser).await;
        if value == BEYOND {
            return false;
        }
        if asks.is_empty() || step == self.answered {
            return true;
        }
        self.look(&asks, &task).await;
        match asks.as_str() {
            "Ready" if MEASURED.contains(&value.as_str()) => {
                if matches!(value.as_str(), "wheel-dead-band" | "wheel-free-speed") {
                    self.hand(ON_FREE_FLOOR);
                }
                browser.click("#calibration-go").await;
            }
            "Ready" => browser.click("#calibration-skip").await,
            "Done" => {
                self.do_task(&task);
                browser.click("#calibration-go").await;
            }
            "Number" => {
                browser
                    .text(
                        "const field = document.getElementById('calibration-number'); field.value = '1900';
                         field.dispatchEvent(new Event('input', { bubbles: true })); return ''",
                    )
                    .await;
                browser.click("#calibration-enter").await;
            }
            "Hold" => self.hold(&value).await,
            "Keep" => {
                if value.ends_with("-order") || value == "cliff-floor-level" {
                    self.hand(PUT_DOWN);
                }
                browser.says("calibration-found", "Mõõdetud: ").await;
                browser.click("#calibration-go").await;
            }
            "Retry" => browser.fail(&format!("{value} failed")).await,
            other => panic!("nobody knows how to answer {other}"),
        }
        self.answered = step;
        true
    }

    fn do_task(&self, task: &str) {
        match task {
            "push" => self.hand(r#"{"c":"push","distance":1.9}"#),
            "spin" => self.hand(r#"{"c":"turn","turns":10}"#),
            "roll-left" | "roll-right" => {
                let wheel = task.trim_start_matches("roll-");
                self.hand(LIFT);
                self.hand(&format!(r#"{{"c":"roll","wheel":"{wheel}","distance":0.1}}"#));
            }
            "drop" => self.hand(LIFT),
            _ => {}
        }
    }

    /// Holds the button until the value is there. The first time it is let go too early, and everything stops.
    async fn hold(&mut self, value: &str) {
        let browser = &self.visit.browser;
        let told = browser
            .text(
                "const button = document.getElementById('calibration-hold'); button.scrollIntoView({ block: 'center' });
                 const box = button.getBoundingClientRect();
                 return JSON.stringify([box.x + box.width / 2, box.y + box.height / 2])",
            )
            .await;
        let place: [f64; 2] = serde_json::from_str(&told).unwrap();
        touch(browser, "touchStart", &[place]);
        let asks = |what: &str| {
            format!("return document.getElementById('calibration-step')?.dataset.asks === '{what}'")
        };
        if !std::mem::replace(&mut self.has_let_go, true) {
            browser
                .until("return document.getElementById('calibration-live').textContent.includes('promilli')")
                .await;
            touch(browser, "touchEnd", &[]);
            let witness = Observer::watch(&self.visit.stack.simulator_socket());
            assert!(witness.stands_within(Duration::from_secs(3)).is_some());
            browser.until(&asks("Retry")).await;
            browser.says("calibration-failed", "Nupp lasti lahti").await;
            self.look("Retry", "").await;
            let [failed, ..] = shown(browser).await;
            browser.click("#calibration-again").await;
            browser
                .until(&format!(
                    "return document.getElementById('calibration-step')?.dataset.page !== '{failed}'"
                ))
                .await;
            return;
        }
        println!("{value} is measured while the button is held");
        browser.until_within(PATIENCE, &asks("Keep")).await;
        touch(browser, "touchEnd", &[]);
    }
}

#[tokio::test]
async fn a_new_robot_is_calibrated_on_a_phone_and_starts() {
    let begun = Visit::at_the_door(Stack::start_uncalibrated, Screen::Phone, Company::None).await;
    let Some(mut visit) = begun else {
        return;
    };
    let browser = &visit.browser;
    browser.darken().await;
    browser.click("#language option[value=et]").await;
    browser
        .until("return document.documentElement.lang === 'et' && document.getElementById('start') !== null")
        .await;
    visit.stack.hand(ON_FREE_FLOOR);
    browser.click("#tab-device").await;
    browser
        .says("calibration-lacks", "sõitmine, treppide nägemine")
        .await;
    browser.shot("phone-et-calibration").await;
    browser.click("#calibration-begin").await;
    let mut owner = Owner {
        visit: &visit,
        answered: String::new(),
        has_let_go: false,
        looked_at: Vec::new(),
    };
    let deadline = Instant::now() + 4 * PATIENCE;
    while owner.answer().await {
        assert!(Instant::now() < deadline, "it takes too long");
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    browser.click("#stop").await;
    browser.says("calibration-over", "Kalibreerimine lõpetati.").await;
    browser.says("calibration-file", "cliff-floor-level = ").await;
    browser.shot("phone-et-calibration-list").await;
    expect_none(browser, "the list of measured values").await;

    // The firmware gets the values as the console's would: built into its image.
    let file = visit.stack.folder().join("state/calibration.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    for name in MEASURED {
        assert!(text.contains(&format!("{name} = ")), "{name} in {text}");
    }
    let file = file.into_os_string();
    visit.stack.reprogram(&["--measured".as_ref(), &file]);
    let browser = &visit.browser;
    browser
        .until("return !document.getElementById('calibration-lacks').textContent.includes('sõitmine')")
        .await;
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.shot("phone-et-calibrated").await;
}
