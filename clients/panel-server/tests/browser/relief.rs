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
        browser.press_start().await;
        browser.sweeps_more_than(300).await;
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
        browser.darken().await;
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

/// Number of colours in the picture.
const COLOURS: &str = "
    const map = document.getElementById('map');
    const bytes = map.getContext('2d').getImageData(0, 0, map.width, map.height).data;
    const seen = new Set();
    for (let at = 0; at < bytes.length; at += 4) seen.add(bytes[at] << 16 | bytes[at + 1] << 8 | bytes[at + 2]);
    return seen.size";

#[tokio::test]
async fn without_webgl_the_map_is_flat_and_says_why() {
    let Some(visit) = Visit::begin_at_home(Screen::WithoutWebGl).await else {
        return;
    };
    let browser = &visit.browser;
    browser
        .until("return document.getElementById('map').dataset.painter === 'plain'")
        .await;
    browser.press_start().await;
    browser.sweeps_more_than(300).await;
    let colours: u32 = browser.text(COLOURS).await.parse().unwrap();
    assert!(colours > 5, "{colours} colours are no map");
    browser.click("#view-3d").await;
    browser
        .until("return document.getElementById('no-relief')?.textContent.includes('WebGL') === true")
        .await;
    browser.until(&shown("2d")).await;
    browser.click("#ground-known").await;
    browser
        .until("return document.getElementById('map').dataset.ground === 'Known'")
        .await;
    browser.shot("desktop-without-webgl").await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}
