//! The pictures of the README: taken into the folder that `RVAC_PICTURES` names, and skipped without it.

use crate::Visit;
use crate::browser::{Browser, Screen};

/// Cells of 25 mm that are swept before a picture is taken: some ten square metres, not half of the home.
const SWEPT_CELLS: u32 = 16_000;

/// Where the pictures go, if they are enabled.
fn are_wanted() -> bool {
    std::env::var_os("RVAC_PICTURES").is_some()
}

/// A robot at work in a known home, with a sheet of the page open.
async fn at_work(browser: &Browser, tab: &str) {
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser.click("#ground-known").await;
    browser.click(&format!("#tab-{tab}")).await;
    let minutes = std::time::Duration::from_secs(600);
    let swept = format!("return Number(document.getElementById('map').dataset.sweptCells) > {SWEPT_CELLS}");
    browser.until_within(minutes, &swept).await;
    // The pressed element has scrolled into view.
    browser
        .text("window.scrollTo(0, 0); document.querySelector('.sheets').scrollTo(0, 0); return ''")
        .await;
}

#[tokio::test]
async fn the_pictures_of_the_readme_are_taken() {
    if !are_wanted() {
        println!("skipped: RVAC_PICTURES is not set");
        return;
    }
    let Some(visit) = Visit::begin_at_home(Screen::Desktop).await else {
        return;
    };
    at_work(&visit.browser, "why").await;
    visit.browser.picture("panel").await;
    visit.browser.click("#view-3d").await;
    visit
        .browser
        .until("return document.getElementById('map').dataset.view === '3d'")
        .await;
    visit.browser.picture("panel-3d").await;
    drop(visit);
    let Some(visit) = Visit::begin_at_home(Screen::Phone).await else {
        return;
    };
    visit.browser.darken().await;
    at_work(&visit.browser, "home").await;
    visit.browser.picture("panel-phone").await;
}
