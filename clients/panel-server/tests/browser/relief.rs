//! The map in 3D.

use crate::Visit;
use crate::browser::Screen;

fn shown(view: &str) -> String {
    format!("return document.getElementById('map').dataset.view === '{view}'")
}

#[tokio::test]
async fn the_map_is_seen_in_3d_turned_and_kept_so() {
    for (screen, shots) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let Some(visit) = Visit::begin_at_home(screen).await else {
            return;
        };
        let browser = &visit.browser;
        browser.click("#start").await;
        browser
            .until("return Number(document.getElementById('map').dataset.sweptCells) > 300")
            .await;
        browser.until(&shown("2d")).await;
        browser.shot(&format!("{shots}-2d")).await;
        browser.click("#view-3d").await;
        browser.until(&shown("3d")).await;
        browser
            .until("return Number(document.getElementById('map').dataset.blocks) > 10")
            .await;
        browser.shot(&format!("{shots}-3d-true")).await;
        browser.click("#ground-known").await;
        browser
            .until("return document.getElementById('map').dataset.ground === 'Known'")
            .await;
        browser.shot(&format!("{shots}-3d")).await;
        let kept = "return localStorage.getItem('map-view')";
        let before = browser.text(kept).await;
        let turn = "document.getElementById('map').dispatchEvent(new KeyboardEvent('keydown', \
                    {key: 'ArrowLeft', shiftKey: true, bubbles: true})); return ''";
        for _ in 0..4 {
            browser.text(turn).await;
        }
        browser
            .until(&format!("return localStorage.getItem('map-view') !== '{before}'"))
            .await;
        browser.click("#theme").await;
        browser.shot(&format!("{shots}-3d-dark-turned")).await;
        let turned = browser.text(kept).await;
        browser.reload().await;
        browser.until(&shown("3d")).await;
        assert_eq!(
            browser.text(kept).await,
            turned,
            "the view is another one after a reload"
        );
        browser
            .text("document.getElementById('map').focus(); return ''")
            .await;
        browser.press('3').await;
        browser.until(&shown("2d")).await;
        browser.click("#stop").await;
        browser.until_state(&["idle", "docked"]).await;
    }
}
