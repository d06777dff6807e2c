//! Where carpet lies.

use crate::Visit;
use crate::browser::Screen;
use crate::stack::Stack;

/// The map that the robot has made is shown, not that of the simulator, which contains its rug from the start.
#[tokio::test]
async fn carpet_that_was_felt_is_shown_with_a_word_for_it() {
    for (screen, shots) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::with(Stack::start_in_a_cleaned_home, screen).await else {
            return;
        };
        let browser = &visit.browser;
        let key = "return document.querySelector('.key.carpet') !== null";
        browser
            .until("return document.getElementById('map').dataset.ground === 'True'")
            .await;
        assert_eq!(
            browser.text(key).await,
            "false",
            "the map of the simulator is shown"
        );
        browser.click("#ground-known").await;
        browser.until(key).await;
        browser.shot(&format!("{shots}-carpet")).await;
        browser.click("#tab-home").await;
        browser.says("home-sheet", "Carpet detected").await;
        browser.darken().await;
        browser.shot(&format!("{shots}-carpet-dark")).await;
    }
}
