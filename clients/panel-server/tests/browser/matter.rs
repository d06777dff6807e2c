//! The code for Matter under Device: an administrator sees it while the program that has it runs and a home can join.

use std::io::Write as _;
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::sync::{Arc, Mutex};

use crate::Visit;
use crate::accessibility::{TOO_WIDE, expect_none};
use crate::browser::{Browser, Screen};
use crate::pairing::let_in;
use crate::stack::Stack;
use crate::turns::Company;

const OPEN: &str =
    r#"{"code":"MT:-24J0AFN00KA0648G00","digits":"3497-011-2332","open_s":840,"joined":false}"#;
const JOINED: &str = r#"{"open_s":0,"joined":true}"#;

/// Stands in for `rvac-matter`: whoever connects is told what is said last.
fn tell(socket: &Path) -> Arc<Mutex<&'static str>> {
    let listener = UnixListener::bind(socket).unwrap();
    let said = Arc::new(Mutex::new(OPEN));
    let says = Arc::clone(&said);
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            let text = *says.lock().unwrap();
            stream.unwrap().write_all(text.as_bytes()).ok();
        }
    });
    said
}

async fn look_again(browser: &Browser) {
    browser.reload().await;
    browser.click("#tab-device").await;
    browser
        .until("return document.getElementById('software') !== null")
        .await;
}

async fn picture(browser: &Browser, name: &str) {
    let scroll = "document.getElementById('matter').scrollIntoView({block: 'center'}); return ''";
    browser.text(scroll).await;
    browser.shot(name).await;
    expect_none(browser, name).await;
    assert_eq!(browser.text(TOO_WIDE).await, "0", "{name}");
}

#[tokio::test]
async fn an_administrator_sees_the_code_for_matter_while_a_home_can_join() {
    let Some(visit) = Visit::at_the_door(Stack::start_guarded, Screen::Phone, Company::Others).await else {
        return;
    };
    let (browser, stack) = (&visit.browser, &visit.stack);
    let_in(browser, stack, "admin").await;
    look_again(browser).await;
    let nothing = "return String(document.getElementById('matter') === null)";
    assert_eq!(browser.text(nothing).await, "true", "rvac-matter does not run");
    let said = tell(&stack.matter_socket());
    look_again(browser).await;
    browser.says("matter", "scan the code or type the digits").await;
    browser.says("matter-digits", "3497-011-2332").await;
    let cells =
        "return String(document.querySelector('#matter-qr path').getAttribute('d').split('M').length > 200)";
    assert_eq!(browser.text(cells).await, "true", "a code is drawn");
    picture(browser, "phone-matter").await;
    *said.lock().unwrap() = JOINED;
    look_again(browser).await;
    browser.says("matter", "The robot has joined a home").await;
    let gone = "return String(document.getElementById('matter-qr') === null)";
    assert_eq!(browser.text(gone).await, "true");
    picture(browser, "phone-matter-joined").await;
}
