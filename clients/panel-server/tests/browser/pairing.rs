//! Pairing in the page: a stranger's device, a wrong code, the right one, what its role allows, and the end.

use std::time::Duration;

use tokio::time::sleep;

use crate::Visit;
use crate::accessibility::expect_none;
use crate::browser::{Browser, Screen};
use crate::robot::Observer;
use crate::stack::Stack;
use crate::turns::Company;

/// Types into a field, with the events that a person causes.
async fn fill(browser: &Browser, id: &str, text: &str) {
    let typed = format!(
        "const field = document.getElementById('{id}'); field.value = {text:?}; \
         field.dispatchEvent(new Event('input', {{bubbles: true}})); return ''"
    );
    browser.text(&typed).await;
}

/// The code of a window that is opened at the console.
fn open(stack: &Stack, role: &str) -> String {
    let said = stack.console(&["pair", "--role", role]);
    let code = said.lines().find_map(|line| line.strip_prefix("Code: "));
    code.expect("a code").to_owned()
}

/// The first address that has no name in it, as a window that is opened at the console prints it.
fn address(stack: &Stack) -> Option<String> {
    let said = stack.console(&["pair", "--role", "drive"]);
    let host = |line: &str| line.strip_prefix("https://").map(str::to_owned);
    let is_numeric = |host: &String| host.starts_with(|first: char| first == '[' || first.is_ascii_digit());
    said.lines().map(str::trim).filter_map(host).find(is_numeric)
}

/// The number of the only device.
fn number(stack: &Stack) -> String {
    let listed = stack.console(&["clients"]);
    listed.split_whitespace().next().expect("a device").to_owned()
}

async fn pair(browser: &Browser, code: &str) {
    fill(browser, "pair-code", code).await;
    browser.click("#pair-now").await;
}

/// Lets the browser in by a code of the console, and waits for the robot.
pub(crate) async fn let_in(browser: &Browser, stack: &Stack, role: &str) {
    browser
        .until("return document.getElementById('pair') !== null")
        .await;
    fill(browser, "pair-name", "Mari's computer").await;
    pair(browser, &open(stack, role)).await;
    browser.until_state(&["idle", "docked"]).await;
}

/// What is no code, a code without a window, and a wrong one; gives the right one.
async fn try_in_vain(browser: &Browser, stack: &Stack) -> String {
    fill(browser, "pair-name", "Mari's phone").await;
    let wrong = "return document.getElementById('pair-wrong').textContent";
    pair(browser, "1234").await;
    browser.until(&format!("{wrong}.includes('eight digits')")).await;
    pair(browser, "12345678").await;
    browser
        .until(&format!("{wrong}.includes('Nobody can be let in now')"))
        .await;
    let code = open(stack, "drive");
    let other = if code.starts_with('0') {
        "11111111"
    } else {
        "00000000"
    };
    pair(browser, other).await;
    browser
        .until(&format!(
            "{wrong}.includes('The code is wrong; 4 more attempts.')"
        ))
        .await;
    browser.shot("phone-pair-wrong").await;
    expect_none(browser, "a wrong code").await;
    code
}

#[tokio::test]
async fn a_phone_is_paired_drives_sees_who_else_may_and_is_shut_out() {
    let Some(visit) = Visit::at_the_door(Stack::start_guarded, Screen::Phone, Company::Others).await else {
        return;
    };
    let (browser, stack) = (&visit.browser, &visit.stack);
    browser
        .until("return document.getElementById('pair') !== null")
        .await;
    browser.shot("phone-pair").await;
    expect_none(browser, "the pairing page").await;
    let code = try_in_vain(browser, stack).await;
    pair(browser, &code).await;
    browser.until_state(&["idle", "docked"]).await;
    assert_eq!(
        browser.text("return document.cookie").await,
        "",
        "no script can read the token"
    );
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
    browser.click("#tab-device").await;
    assert_eq!(
        browser
            .text("return document.getElementById('devices') === null")
            .await,
        "true",
        "only administrators see the devices"
    );

    let number = number(stack);
    stack.console(&["clients", "role", &number, "admin"]);
    browser.reload().await;
    browser.until_state(&["idle", "docked"]).await;
    browser.click("#tab-device").await;
    browser
        .until("return document.querySelectorAll('#devices li').length === 1")
        .await;
    browser.click("#add-device").await;
    browser
        .until("return /Type [0-9]{4} [0-9]{4} on/.test(document.getElementById('pairing-code').textContent)")
        .await;
    let caption = "return document.querySelector('#pairing-qr figcaption')?.textContent ?? ''";
    let seen = browser.text(caption).await;
    assert_eq!(
        seen.split_once("https://").map(|(_, address)| address),
        address(stack).as_deref(),
        "{seen}"
    );
    crate::accessibility::expect_none(browser, "the devices").await;
    let show = "document.getElementById('pairing-qr')?.scrollIntoView({ block: 'center' }); return ''";
    browser.text(show).await;
    browser.shot("phone-devices").await;
    expect_none(browser, "a pairing window").await;
    stack.console(&["clients", "add", "<b>script</b>", "--role", "view"]);
    browser
        .until("return document.getElementById('newcomer')?.textContent.includes('<b>script</b>')")
        .await;
    browser
        .until("return document.querySelectorAll('#devices li').length === 2")
        .await;
    assert_eq!(
        browser.text(crate::accessibility::TOO_WIDE).await,
        "0",
        "the page is wider than the phone"
    );

    stack.console(&["clients", "revoke", &number]);
    browser
        .until("return document.getElementById('pair') !== null")
        .await;
}

/// Presses START as the page asks for it.
async fn press_as_shown(browser: &Browser, stack: &Stack) {
    browser
        .until("return document.querySelectorAll('#pair-presses .dots')[0].textContent.includes('●')")
        .await;
    let dots = browser
        .text("return document.querySelector('#pair-presses .dots').textContent")
        .await;
    let groups: Vec<usize> = dots
        .split_whitespace()
        .map(|group| group.chars().count())
        .collect();
    assert_eq!(groups.len(), 2, "{dots}");
    for group in groups {
        for _ in 0..group {
            stack.hand(r#"{"c":"press","button":0,"ms":200}"#);
            sleep(Duration::from_millis(500)).await;
        }
        sleep(Duration::from_secs(2)).await;
    }
}

/// Holds START until the page has seen a window. On a machine that is too busy for the robot's reports a hold is not believed.
async fn hold_start(browser: &Browser, stack: &Stack) {
    while !stack.daemon_knows_a_robot() {
        sleep(Duration::from_millis(200)).await;
    }
    for _ in 0..5 {
        stack.hand(r#"{"c":"press","button":0,"ms":6000}"#);
        sleep(Duration::from_secs(9)).await;
        let said = "return document.getElementById('pair-by-presses').textContent";
        if browser.text(said).await.contains("START was held") {
            return;
        }
    }
    panic!("START was held five times, and no window is open");
}

async fn let_in_by_presses(start: fn() -> Stack, company: Company) {
    let Some(visit) = Visit::at_the_door(start, Screen::Phone, company).await else {
        return;
    };
    let (browser, stack) = (&visit.browser, &visit.stack);
    browser
        .until("return document.getElementById('pair') !== null")
        .await;
    let witness = Observer::watch(&stack.simulator_socket());
    hold_start(browser, stack).await;
    fill(browser, "pair-name", "Mari's phone").await;
    browser.click("#pair-now").await;
    browser
        .until("return document.getElementById('pair-presses').textContent.includes('Press START')")
        .await;
    browser.shot("phone-pair-presses").await;
    expect_none(browser, "the presses of pairing").await;
    press_as_shown(browser, stack).await;
    browser.until_state(&["idle", "docked"]).await;
    assert!(
        stack.console(&["clients"]).contains("drive  Mari's phone"),
        "let in to drive"
    );
    assert!(
        !witness.moves_within(Duration::from_secs(1)),
        "presses that were counted have started the robot"
    );
}

#[tokio::test]
async fn whoever_stands_beside_the_robot_lets_a_phone_in_without_a_code() {
    let_in_by_presses(Stack::start_guarded, Company::Others).await;
}

#[tokio::test]
async fn the_buttons_of_the_real_firmware_let_a_phone_in() {
    let_in_by_presses(Stack::start_guarded_emulated, Company::None).await;
}
