//! A device with the role `view`: controls that it may not use say so beforehand, and nothing that can be pressed is refused.

use crate::Visit;
use crate::accessibility::expect_none;
use crate::browser::{Browser, Screen};
use crate::stack::Stack;
use crate::turns::Company;

/// Presses all that can be pressed in a sheet, one after the other, and gives what was refused.
async fn refused(browser: &Browser, sheet: &str) -> String {
    let press_all = format!(
        "const sheet = document.getElementById('sheet-{sheet}'), refused = []; \
         const pause = () => new Promise(next => setTimeout(next, 300)); \
         return (async () => {{ \
             for (const button of [...sheet.querySelectorAll('button:enabled, input:enabled, select:enabled')]) {{ \
                 if (!button.isConnected || !button.checkVisibility()) continue; \
                 button.click(); await pause(); \
                 const told = document.querySelector('#refusal'); \
                 if (told) {{ refused.push(`${{button.id || button.textContent}}: ${{told.innerText}}`); told.querySelector('.round').click(); }} \
             }} \
             return refused.join('\\n'); \
         }})()"
    );
    browser.text(&press_all).await
}

#[tokio::test]
async fn a_device_that_may_only_look_is_informed_before_it_presses_anything() {
    let Some(visit) = Visit::at_the_door(Stack::start_guarded, Screen::Phone, Company::Others).await else {
        return;
    };
    let (browser, stack) = (&visit.browser, &visit.stack);
    crate::pairing::let_in(browser, stack, "view").await;
    for (sheet, least) in [("home", 3), ("schedules", 5), ("device", 1)] {
        browser.click(&format!("#tab-{sheet}")).await;
        let shut = format!(
            "const shut = [...document.querySelectorAll('#sheet-{sheet} .needs :is(button, input)')]; \
             return shut.length >= {least} && shut.every(control => control.matches(':disabled'))"
        );
        browser.until(&shut).await;
        let note = format!("return document.querySelector('#sheet-{sheet} .only-looks') !== null");
        browser.until(&note).await;
        assert_eq!(refused(browser, sheet).await, "", "{sheet}");
        browser.shot(&format!("phone-looks-{sheet}")).await;
        expect_none(browser, sheet).await;
    }
}
