//! axe-core finds nothing wrong with the visible page, on every sheet, on both screens, in both themes and languages.

use std::fmt::Write as _;

use crate::Visit;
use crate::browser::{Browser, Screen};

/// Gives a line for each fault: the rule, what is wrong, and where.
const RUN: &str = "
    const tags = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'best-practice'];
    // A colour in transition is not the final one.
    const moving = document.getAnimations().filter(motion => motion.effect.getComputedTiming().endTime < Infinity);
    const still = Promise.allSettled(moving.map(motion => motion.finished));
    return still.then(() => axe.run(document, { runOnly: tags, resultTypes: ['violations'] })).then(
        found => found.violations.map(fault => `${fault.id}: ${fault.help}: `
            + fault.nodes.map(node => `${node.target} ${node.any.concat(node.all).map(check => check.message)}`).join(' | ')).join('\\n'))";

/// How much wider the page is than the screen, pixels.
pub(crate) const TOO_WIDE: &str =
    "return String(document.documentElement.scrollWidth - document.documentElement.clientWidth)";

/// Controls that are seen and smaller in a direction than a thumb hits, 44 pixels: a name and the size of each. A box or a button of
/// choice is pressed by its label, too; the page is skipped to by keys alone; a link in a sentence is as high as the line, which
/// WCAG 2.2 allows (2.5.8).
pub(crate) const SMALL_TARGETS: &str = "
    const all = [...document.querySelectorAll('button, select, input, textarea, summary, a[href], [role=tab], [tabindex=\"0\"], label.check')];
    const isSentence = control => control.matches('p a, li > a:not(.small)');
    const isTicked = control => control.matches('[type=checkbox], [type=radio]');
    const pressed = control => (isTicked(control) ? control.labels[0] : null) ?? control;
    const size = control => pressed(control).getBoundingClientRect();
    return all.filter(control => control.checkVisibility() && !control.matches('.visually-hidden, .skip') && !isSentence(control))
        .filter(control => size(control).width < 43.5 || size(control).height < 43.5)
        .map(control => `${control.id || control.className || control.textContent.trim()} `
            + `${size(control).width.toFixed(0)}x${size(control).height.toFixed(0)}`).join(', ')";

/// Fields that are seen and smaller than 16 pixels: an iPhone enlarges the page when one of them gets the focus.
const ENLARGED_FIELDS: &str = "
    return [...document.querySelectorAll('input:not([type=checkbox], [type=radio], [type=range], [type=file]), select, textarea')]
        .filter(field => field.checkVisibility() && parseFloat(getComputedStyle(field).fontSize) < 16)
        .map(field => field.id || field.className || field.name).join(', ')";

/// Buttons that are seen and break a word at which no line may end, by their texts; and by how much the page is higher than the window,
/// which on a wide screen it never is: its parts scroll.
const TORN: &str = "
    const lines = word => new Set([...word.getClientRects()].map(box => Math.round(box.top))).size;
    const isTorn = button => {
        const texts = document.createTreeWalker(button, NodeFilter.SHOW_TEXT);
        for (let text; (text = texts.nextNode());) {
            for (const word of text.data.matchAll(/[^\\s\\u00ad-]+/g)) {
                const range = document.createRange();
                range.setStart(text, word.index);
                range.setEnd(text, word.index + word[0].length);
                if (word[0].length < 14 && lines(range) > 1) return true;
            }
        }
        return false;
    };
    const tall = document.documentElement.scrollHeight - innerHeight;
    return [...document.querySelectorAll('button')].filter(button => button.checkVisibility() && isTorn(button))
        .map(button => button.textContent).concat(innerWidth > 800 && tall > 0 ? [`the page scrolls by ${tall}`] : []).join(', ')";

/// What is wrong with what the browser shows now, a line for each fault.
pub(crate) async fn faults(browser: &Browser) -> Vec<String> {
    let is_there = browser.text("return typeof axe").await;
    if is_there == "undefined" {
        let path =
            std::env::var_os("RVAC_AXE").expect("RVAC_AXE names axe.min.js; cargo xtask test fetches it");
        let source = std::fs::read_to_string(path).unwrap();
        browser.text(&format!("{source}; return ''")).await;
    }
    let found = browser.text(RUN).await;
    found.lines().map(str::to_owned).collect()
}

/// Looks at what is seen and stops the test at a fault.
pub(crate) async fn expect_none(browser: &Browser, what: &str) {
    let found = faults(browser).await;
    assert!(found.is_empty(), "{what}:\n{}", found.join("\n"));
}

/// Sets a language and a theme for the visit.
async fn dress(browser: &Browser, language: &str, look: &str) {
    let keep = format!(
        "localStorage.setItem('language', '{language}'); localStorage.setItem('theme', '{look}'); return ''"
    );
    browser.text(&keep).await;
    browser.reload().await;
    browser
        .until(&format!(
            "return document.documentElement.lang === '{language}' && document.documentElement.dataset.theme === '{look}'"
        ))
        .await;
    browser.until_state(&["idle", "docked"]).await;
}

/// The steps to a view, and a script that is true when it is there.
const VIEWS: [(&str, &[&str], &str); 15] = [
    ("drive", &["#tab-drive"], "#pad"),
    (
        "mixes",
        &[
            "#tab-drive",
            "#edit-mixes",
            "[data-output=turn] .unfold",
            "#line-1-0",
        ],
        "#mixes .mix-curve",
    ),
    ("home", &["#edit-mixes", "#tab-home"], "#rooms .choose"),
    ("menu", &["#more-room-1"], ".row-actions:not([hidden])"),
    ("zones", &["#show-home-zones"], "#no-go-title"),
    ("maps", &["#show-home-maps"], "#maps-title"),
    ("rename", &["#rename-floor-1"], "#floor-name"),
    // The only floor must stay.
    ("refusal", &["#rename-floor-1", "#remove-floor-1"], "#refusal"),
    ("felt", &["#refusal summary"], "#refusal .evidence tbody tr"),
    (
        "room",
        &[
            "#refusal button",
            "#rooms .choose",
            "#rooms [id^=rename-room]",
            "#rooms [id$=-settings]",
        ],
        "#order-bar",
    ),
    (
        "schedules",
        &["#choose-none", "#tab-schedules", "#add-schedule"],
        "#schedule-form",
    ),
    ("history", &["#tab-history"], "#history-sheet"),
    ("why", &["#tab-why"], "#decisions"),
    ("device", &["#tab-device"], "#device-table table"),
    ("log", &["#tab-log"], "#log-entries"),
];

/// Walks through all views and collects what is wrong.
async fn walk(browser: &Browser, dressed: &str) -> String {
    let mut all = String::new();
    for (name, clicks, there) in VIEWS {
        for click in clicks {
            browser.click(click).await;
        }
        browser
            .until(&format!("return document.querySelector('{there}') !== null"))
            .await;
        for fault in faults(browser).await {
            writeln!(all, "{dressed}, {name}: {fault}").unwrap();
        }
        let small = browser.text(SMALL_TARGETS).await;
        if !small.is_empty() && dressed.starts_with("phone") {
            writeln!(all, "{dressed}, {name}: controls that a thumb misses: {small}").unwrap();
        }
        let enlarged = browser.text(ENLARGED_FIELDS).await;
        if !enlarged.is_empty() {
            writeln!(
                all,
                "{dressed}, {name}: fields that enlarge the page of an iPhone: {enlarged}"
            )
            .unwrap();
        }
        let torn = browser.text(TORN).await;
        if !torn.is_empty() {
            writeln!(
                all,
                "{dressed}, {name}: torn words, or a page that scrolls: {torn}"
            )
            .unwrap();
        }
        browser.shot(&format!("axe-{dressed}-{name}")).await;
    }
    all
}

#[tokio::test]
async fn nothing_is_wrong_for_those_who_hear_or_type() {
    for (screen, screen_name) in [(Screen::Phone, "phone"), (Screen::Desktop, "desktop")] {
        let Some(visit) = Visit::begin_at_home(screen).await else {
            return;
        };
        let browser = &visit.browser;
        let mut all = String::new();
        // Words and colours have nothing to do with each other: each of them once on each screen, and each pair on one.
        let dresses = match screen {
            Screen::Phone => [("en", "light"), ("et", "dark")],
            _ => [("en", "dark"), ("et", "light")],
        };
        for (language, look) in dresses {
            dress(browser, language, look).await;
            all += &walk(browser, &format!("{screen_name}-{language}-{look}")).await;
        }
        assert!(all.is_empty(), "{all}");
    }
}
