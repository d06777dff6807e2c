//! The sheet over the map on a phone, the parts of the home, and the menus of rows: what is folded away, and how it is reached.

use crate::Visit;
use crate::browser::{Browser, Screen};
use crate::keyboard::{go_to, press};
use crate::owner::resize;

/// Where the sheet and the map begin and end, and how far the page is scrolled: whole CSS pixels.
const PLACES: &str = "
    const [side, map] = ['.side', '.map'].map(name => document.querySelector(name).getBoundingClientRect());
    return [side.top, map.top, map.bottom, scrollY].map(Math.round).join(' ');";
/// What a press in the middle of the map would arrive at.
const AT_MIDDLE_OF_MAP: &str = "
    const box = document.getElementById('map').getBoundingClientRect();
    const hit = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
    return hit?.id ?? '';";
/// Parts of an open menu that lie outside of the window or under the bar of buttons, and actions too small for a thumb.
const FAULTS_OF_MENU: &str = "
    const edge = document.getElementById('actions').getBoundingClientRect().top;
    return [...document.querySelectorAll('.row-actions:not([hidden]) button')].filter(button => {
        const box = button.getBoundingClientRect();
        return box.height < 44 || box.left < 0 || box.right > innerWidth || box.top < 0 || box.bottom > edge;
    }).map(button => button.id).join(', ');";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Places {
    sheet_top: i32,
    map_top: i32,
    map_bottom: i32,
    scrolled: i32,
}

impl Places {
    async fn seen(browser: &Browser) -> Self {
        let told = browser.text(PLACES).await;
        let numbers: Vec<i32> = told.split(' ').map(|number| number.parse().unwrap()).collect();
        let [sheet_top, map_top, map_bottom, scrolled] = numbers[..] else {
            panic!("{told}");
        };
        Self {
            sheet_top,
            map_top,
            map_bottom,
            scrolled,
        }
    }
}

/// The handle pulls the sheet up over a map that stays, and pushes it down; a tool for the map does so, too.
#[tokio::test]
async fn on_a_phone_the_sheet_is_pulled_up_over_a_map_that_stays() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    for size in [(390, 844), (320, 640)] {
        resize(browser, size).await;
        browser.text("window.scrollTo(0, 0); return ''").await;
        let low = Places::seen(browser).await;
        assert_eq!(low.scrolled, 0, "{size:?}");
        assert!(
            low.sheet_top < low.map_bottom,
            "the sheet lies over the edge of the map: {low:?}"
        );
        browser.click_where_it_is("sheet-handle").await;
        let high = Places::seen(browser).await;
        assert_eq!(
            (high.map_top, high.map_bottom),
            (low.map_top, low.map_bottom),
            "the map stays, {size:?}"
        );
        assert!(high.sheet_top + 100 < low.sheet_top, "{high:?} after {low:?}");
        browser.click_where_it_is("sheet-handle").await;
        assert_eq!(Places::seen(browser).await, low, "{size:?}");
    }
    resize(browser, (390, 844)).await;
    browser.click("#tab-home").await;
    browser.click("#draw-zone").await;
    browser.shot("phone-drawing").await;
    assert_eq!(
        Places::seen(browser).await.scrolled,
        0,
        "whoever draws sees the map"
    );
    assert_eq!(browser.text(AT_MIDDLE_OF_MAP).await, "map");
    browser.click("#sketch-cancel").await;
}

/// Rooms, zones and maps are shown one at a time, and the one that was open is open again when the tab is.
#[tokio::test]
async fn the_home_has_three_parts_and_menus_at_its_rows() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#tab-home").await;
    browser.shot("phone-home-rooms").await;
    for part in ["home-zones", "home-maps"] {
        browser.click(&format!("#show-{part}")).await;
        let shown = "return [...document.querySelectorAll('.home-part')].filter(part => part.checkVisibility()).map(part => part.id).join()";
        assert_eq!(browser.text(shown).await, part);
        browser.shot(&format!("phone-{part}")).await;
    }
    browser.click("#tab-why").await;
    browser.click("#tab-home").await;
    browser
        .until("return document.getElementById('home-maps').checkVisibility()")
        .await;
    browser.click("#show-home-rooms").await;
    menus_close_as_people_expect(browser).await;
    keys_go_into_a_menu_and_out_of_it(browser).await;
}

async fn menus_close_as_people_expect(browser: &Browser) {
    let open = "return document.querySelectorAll('.row-actions:not([hidden])').length === 1";
    let closed = "return document.querySelectorAll('.row-actions:not([hidden])').length === 0";
    for size in [(390, 844), (320, 640), (844, 390), (1440, 900)] {
        resize(browser, size).await;
        browser.click("#more-room-1").await;
        browser.until(open).await;
        browser
            .until(&format!("return (() => {{ {FAULTS_OF_MENU} }})() === ''"))
            .await;
        browser.shot(&format!("row-menu-{}x{}", size.0, size.1)).await;
        browser.click("#show-home-rooms").await;
        browser.until(closed).await;
    }
}

async fn keys_go_into_a_menu_and_out_of_it(browser: &Browser) {
    let focused = "return document.activeElement.id";
    go_to(browser, "rename-room-1").await;
    press(browser, "Escape");
    browser
        .until("return document.getElementById('actions-room-1').hidden")
        .await;
    assert_eq!(browser.text(focused).await, "more-room-1");
    go_to(browser, "rename-room-1").await;
    press(browser, "Enter");
    assert_eq!(
        browser.text(focused).await,
        "more-room-1",
        "the action is folded away"
    );
    go_to(browser, "room-name").await;
    press(browser, "Enter");
    browser
        .until("return document.activeElement.id === 'more-room-1'")
        .await;
}
