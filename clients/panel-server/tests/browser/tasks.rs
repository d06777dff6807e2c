//! Ten things that owners do, on a phone: how many presses each takes, and how long until the page shows that it is done. The table of
//! the book says the same presses.

use std::cell::Cell;
use std::time::{Duration, Instant};

use crate::Visit;
use crate::browser::{Browser, Screen};
use crate::hands::{pad_on_screen, touch};
use crate::stack::Stack;
use crate::turns::Company;

/// The page of the book with the table.
const BOOK: &str = include_str!("../../../../docs/book/src/measurements/panel.md");

/// One task, from the page as it opens to the sight of what came of it.
struct Task<'a> {
    browser: &'a Browser,
    name: &'static str,
    presses: Cell<u32>,
    begun: Instant,
}

impl<'a> Task<'a> {
    fn begin(browser: &'a Browser, name: &'static str) -> Self {
        Self {
            browser,
            name,
            presses: Cell::new(0),
            begun: Instant::now(),
        }
    }

    fn count(&self, presses: usize) {
        self.presses
            .set(self.presses.get() + u32::try_from(presses).unwrap());
    }

    async fn press(&self, selector: &str) {
        let folded = self.browser.reveal(selector).await;
        self.count(usize::try_from(folded).unwrap() + 1);
        self.browser.click(selector).await;
    }

    /// A press into the field, and one for each character.
    async fn fill(&self, id: &str, text: &str) {
        self.count(1 + text.chars().count());
        let typed = format!(
            "const field = document.getElementById('{id}'); field.value = {text:?}; \
             field.dispatchEvent(new Event('input', {{bubbles: true}})); return ''"
        );
        self.browser.text(&typed).await;
    }

    /// A finger goes over the map, from one place to the other, in shares of its size.
    async fn drag_over_map(&self, [from, to]: [[f64; 2]; 2]) {
        self.count(1);
        let box_of_map = "const map = document.getElementById('map'); window.scrollTo(0, 0); \
             const box = map.getBoundingClientRect(); return JSON.stringify([box.x, box.y, box.width, box.height])";
        let [x, y, width, height]: [f64; 4] =
            serde_json::from_str(&self.browser.text(box_of_map).await).unwrap();
        let place = |[along, down]: [f64; 2]| [x + along * width, y + down * height];
        let [first, last] = [place(from), place(to)];
        touch(self.browser, "touchStart", &[first]);
        for step in 1..=4 {
            let share = f64::from(step) / 4.0;
            let between = |axis: usize| first[axis] + share * (last[axis] - first[axis]);
            touch(self.browser, "touchMove", &[[between(0), between(1)]]);
        }
        touch(self.browser, "touchEnd", &[]);
    }

    /// It is done when the page shows this.
    async fn ends_with(self, script: &str) {
        self.browser.until(script).await;
        let seconds = self.begun.elapsed().as_secs_f64();
        let presses = self.presses.get();
        println!("task: {}: {presses} presses, {seconds:.1} s", self.name);
        let row = BOOK
            .lines()
            .find(|line| line.starts_with(&format!("| {} |", self.name)))
            .unwrap_or_else(|| panic!("the book has no row for {}", self.name));
        assert!(
            row.contains(&format!("| {presses} |")),
            "{} takes {presses} presses, and the book says {row}",
            self.name
        );
    }
}

/// State of the page.
fn state(name: &str) -> String {
    format!("return document.getElementById('now').dataset.state === '{name}'")
}

/// As after opening the page: what a task before has opened is closed.
async fn open_anew(browser: &Browser) {
    browser.text("sessionStorage.clear(); return ''").await;
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
}

#[tokio::test]
async fn ten_tasks_take_as_few_presses_as_the_book_says() {
    let Some(visit) = Visit::begin_at_home(Screen::Phone).await else {
        return;
    };
    looks_up(&visit.browser).await;
    edits(&visit.browser).await;
    moves(&visit).await;
    drop(visit);
    pairs().await;
}

async fn looks_up(browser: &Browser) {
    let task = Task::begin(browser, "read the battery's health");
    task.press("#tab-device").await;
    task.ends_with("return document.getElementById('device-table')?.innerText.includes('Voltage') === true")
        .await;

    open_anew(browser).await;
    browser
        .text("HTMLAnchorElement.prototype.click = function () { window.saved = this.download; }; return ''")
        .await;
    let task = Task::begin(browser, "send a bug report");
    task.press("#tab-device").await;
    task.press("#save-report").await;
    task.ends_with("return (window.saved ?? '').startsWith('rvac-report-')")
        .await;
}

async fn edits(browser: &Browser) {
    open_anew(browser).await;
    let task = Task::begin(browser, "schedule weekdays at 9");
    task.press("#tab-schedules").await;
    task.press("#add-schedule").await;
    task.fill("schedule-name", "Work").await;
    task.fill("schedule-at", "09:00").await;
    task.press("#save-schedule").await;
    task.ends_with("return document.getElementById('schedules')?.innerText.includes('at 09:00') === true")
        .await;

    open_anew(browser).await;
    let task = Task::begin(browser, "draw a no-go zone");
    task.press("#tab-home").await;
    task.press("#draw-zone").await;
    task.drag_over_map([[0.4, 0.4], [0.55, 0.5]]).await;
    task.ends_with("return document.querySelectorAll('#no-go li').length === 1")
        .await;

    open_anew(browser).await;
    let task = Task::begin(browser, "go back one map");
    task.press("#tab-home").await;
    task.press("#maps [id^=take-up-]").await;
    task.ends_with("return document.querySelectorAll('#no-go li').length === 0")
        .await;
}

async fn moves(visit: &Visit) {
    let browser = &visit.browser;
    open_anew(browser).await;
    let task = Task::begin(browser, "clean two rooms in order");
    task.press("#tab-home").await;
    task.press("#rooms li:nth-of-type(1) .choose").await;
    task.press("#rooms li:nth-of-type(2) .choose").await;
    task.press("#clean-chosen").await;
    task.ends_with(&state("cleaning")).await;
    browser.click("#stop").await;

    open_anew(browser).await;
    let task = Task::begin(browser, "start");
    task.press("#start").await;
    task.ends_with(&state("cleaning")).await;
    browser.sweeps_more_than(20).await;
    let task = Task::begin(browser, "find why it stopped");
    visit.stack.hand(r#"{"c":"lift"}"#);
    task.ends_with("return document.getElementById('now').innerText.includes('wheel')")
        .await;
    visit.stack.hand(r#"{"c":"put-down"}"#);
    browser.click("#stop").await;
    browser.until_state(&["idle"]).await;

    open_anew(browser).await;
    let task = Task::begin(browser, "drive by pad");
    task.press("#tab-drive").await;
    task.count(1);
    let [x, y, radius] = pad_on_screen(browser).await;
    // A wheel counts as hanging for a while after it was put down, and a stick that was refused is let go before it counts again.
    for _ in 0..5 {
        touch(browser, "touchStart", &[[x, y]]);
        touch(browser, "touchMove", &[[x - radius / 2.0, y]]);
        touch(browser, "touchMove", &[[x - radius, y]]);
        if browser.is_within(Duration::from_secs(2), &state("manual")).await {
            break;
        }
        touch(browser, "touchEnd", &[]);
    }
    task.ends_with(&state("manual")).await;
    touch(browser, "touchEnd", &[]);
}

async fn pairs() {
    let Some(visit) = Visit::at_the_door(Stack::start_guarded, Screen::Phone, Company::Others).await else {
        return;
    };
    let (browser, stack) = (&visit.browser, &visit.stack);
    browser
        .until("return document.getElementById('pair') !== null")
        .await;
    let said = stack.console(&["pair", "--role", "drive"]);
    let code = said.lines().find_map(|line| line.strip_prefix("Code: "));
    let task = Task::begin(browser, "pair a phone");
    task.fill("pair-name", "Phone").await;
    task.fill("pair-code", &code.unwrap().replace(' ', "")).await;
    task.press("#pair-now").await;
    task.ends_with(&format!(
        "{} || {}",
        state("idle"),
        state("docked").replace("return ", "")
    ))
    .await;
}
