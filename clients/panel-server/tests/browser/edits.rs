//! What people draw on the map and say of rooms, taken back and done again; rooms split and joined; and zones and spots for one job.

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;

use rvac_api::{CleaningPattern, HomeView, SEPARATOR, Update};

use crate::Visit;
use crate::browser::{Browser, Screen};

/// Another client, which follows the home.
struct Onlooker {
    updates: BufReader<UnixStream>,
}

impl Onlooker {
    fn watch(socket: &Path) -> Self {
        let mut stream = UnixStream::connect(socket).unwrap();
        stream
            .set_read_timeout(Some(std::time::Duration::from_secs(40)))
            .unwrap();
        let mut watch = br#"{"c":"watch","topics":["home"]}"#.to_vec();
        watch.push(SEPARATOR);
        stream.write_all(&watch).unwrap();
        Self {
            updates: BufReader::new(stream),
        }
    }

    /// Waits until it receives such a home.
    fn sees(&mut self, mut is_it: impl FnMut(&HomeView) -> bool) {
        loop {
            let mut message = Vec::new();
            self.updates.read_until(SEPARATOR, &mut message).unwrap();
            message.pop();
            if let Ok(Update::Home(home)) = serde_json::from_slice(&message)
                && is_it(&home)
            {
                return;
            }
        }
    }
}

/// Presses keys on the map.
async fn keys(browser: &Browser, keys: &[&str]) {
    browser
        .text("document.getElementById('map').focus(); return ''")
        .await;
    for key in keys {
        let press = format!(
            "document.getElementById('map').dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}', bubbles: true}})); return ''"
        );
        browser.text(&press).await;
    }
}

/// `Ctrl+Z`, or with Shift.
async fn undo(browser: &Browser, shift: bool) {
    let press = format!(
        "window.dispatchEvent(new KeyboardEvent('keydown', {{key: 'z', ctrlKey: true, shiftKey: {shift}, bubbles: true}})); return ''"
    );
    browser.text(&press).await;
}

async fn forbidden(browser: &Browser, count: usize) {
    browser
        .until(&format!(
            "return document.querySelectorAll('#no-go li').length === {count}"
        ))
        .await;
}

#[tokio::test]
async fn a_wall_and_a_name_are_taken_back_and_done_again_for_all_clients() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let mut onlooker = Onlooker::watch(&visit.stack.daemon_socket());
    browser.click("#draw-wall").await;
    keys(browser, &["Enter", "ArrowLeft", "ArrowLeft", "Enter"]).await;
    forbidden(browser, 1).await;
    onlooker.sees(|home| home.no_go.len() == 1);
    browser.shot("desktop-virtual-wall").await;
    undo(browser, false).await;
    forbidden(browser, 0).await;
    onlooker.sees(|home| home.no_go.is_empty());
    undo(browser, true).await;
    forbidden(browser, 1).await;
    onlooker.sees(|home| home.no_go.len() == 1);
    browser.click("#no-go [id^=remove-no-go]").await;
    forbidden(browser, 0).await;
    browser.click("#undo").await;
    forbidden(browser, 1).await;

    browser.click("#rooms [id^=rename-room]").await;
    let typed = "const field = document.getElementById('room-name'); field.value = 'Kitchen'; \
                 field.dispatchEvent(new Event('input', {bubbles: true})); return ''";
    browser.text(typed).await;
    browser.click("#save-name").await;
    let is_kitchen = "document.querySelector('#rooms .choose')?.textContent.includes('Kitchen')";
    browser.until(&format!("return {is_kitchen}")).await;
    browser.click("#undo").await;
    browser.until(&format!("return !{is_kitchen}")).await;
    browser.click("#redo").await;
    browser.until(&format!("return {is_kitchen}")).await;
    onlooker.sees(|home| {
        home.rooms
            .iter()
            .any(|room| room.name.as_deref() == Some("Kitchen"))
    });
}

#[tokio::test]
async fn the_robot_is_sent_to_a_place_that_is_tapped_and_stands_there() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#draw-go").await;
    browser
        .says("sketch-bar", "Tap where the robot shall drive")
        .await;
    keys(browser, &["ArrowLeft", "ArrowLeft", "Enter"]).await;
    browser.until_state(&["going"]).await;
    browser.shot("desktop-going").await;
    browser
        .until_within(
            std::time::Duration::from_secs(120),
            "return document.getElementById('now').dataset.state === 'idle'",
        )
        .await;
    browser.says("now", "It stands where it was sent").await;
}

#[tokio::test]
async fn a_zone_is_drawn_and_cleaned_and_a_place_kept_out_of_for_that_job() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#draw-clean").await;
    let corner = ["Enter", "ArrowLeft", "ArrowLeft", "ArrowUp", "ArrowUp", "Enter"];
    keys(browser, &corner).await;
    browser.says("chosen-rooms", "zone of").await;
    browser.click("#keep-out").await;
    keys(browser, &["Enter", "ArrowRight", "ArrowDown", "Enter"]).await;
    browser.says("chosen-rooms", "with 1 no-go area").await;
    browser.says("prospect", "of a full battery").await;
    browser.shot("desktop-zone").await;
    browser.click("#view-3d").await;
    browser.shot("desktop-zone-3d").await;
    browser.click("#clean-chosen").await;
    browser.until_state(&["cleaning"]).await;
    browser.has_no_order().await;
    forbidden(browser, 0).await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}

/// How many zones and spots are in the bar, and how many numbers are on the map.
async fn drawn_parts(browser: &Browser, count: usize) {
    for labels in ["#drawn-parts .part", ".room-names .number"] {
        let script = format!("return document.querySelectorAll('{labels}').length === {count}");
        browser.until(&script).await;
    }
}

#[tokio::test]
async fn a_spot_is_set_taken_out_by_a_tap_and_by_its_button_and_cleaned() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    browser.click("#draw-spot").await;
    keys(browser, &["ArrowLeft", "Enter"]).await;
    drawn_parts(browser, 1).await;
    browser.click("#draw-spot").await;
    keys(browser, &["ArrowRight", "ArrowRight", "ArrowRight"]).await;
    browser.shot("desktop-spot-drawn").await;
    keys(browser, &["Enter"]).await;
    drawn_parts(browser, 2).await;
    browser.says("prospect", "of a full battery").await;
    browser.darken().await;
    browser.shot("desktop-spots-dark").await;
    keys(browser, &["Enter"]).await;
    drawn_parts(browser, 1).await;
    browser.click("#part-1").await;
    browser.has_no_order().await;
    browser.click("#draw-spot").await;
    browser.click("#map").await;
    drawn_parts(browser, 1).await;
    browser.click("#clean-chosen").await;
    browser.until_state(&["cleaning"]).await;
    browser.sweeps_more_than(20).await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}

async fn rooms(browser: &Browser, count: usize) {
    browser
        .until(&format!(
            "return document.querySelectorAll('#rooms .choose').length === {count}"
        ))
        .await;
}

#[tokio::test]
async fn a_room_is_split_on_a_phone_in_the_dark_one_half_cleaned_joined_again_and_set() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.darken().await;
    let mut onlooker = Onlooker::watch(&visit.stack.daemon_socket());
    let before: usize = browser
        .text("return String(document.querySelectorAll('#rooms .choose').length)")
        .await
        .parse()
        .unwrap();
    // A line that lies in no room is refused in words.
    browser.click("#draw-cut").await;
    let beyond = ["ArrowUp"; 12];
    keys(browser, &beyond).await;
    keys(browser, &["Enter", "ArrowUp", "Enter"]).await;
    browser
        .until("return document.body.innerText.includes('lies in no room')")
        .await;
    browser.click("#draw-cut").await;
    keys(browser, &["0", "ArrowLeft", "ArrowLeft"]).await;
    keys(browser, &["ArrowUp"; 8]).await;
    keys(browser, &["Enter"]).await;
    keys(browser, &["ArrowDown"; 16]).await;
    keys(browser, &["Enter", "0"]).await;
    rooms(browser, before + 1).await;
    assert_eq!(
        browser.text(crate::accessibility::TOO_WIDE).await,
        "0",
        "the page is wider than the phone"
    );
    browser.shot("phone-room-split-dark").await;
    let mut halves = [0, 0];
    onlooker.sees(|home| {
        halves = home.room_changes.first().map_or([0, 0], |change| change.rooms);
        halves != [0, 0]
    });
    let [_, part] = halves;

    browser.click(&format!("#room-{part}")).await;
    browser.click("#clean-chosen").await;
    browser.until_state(&["cleaning"]).await;
    browser.sweeps_more_than(200).await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;

    for half in halves {
        browser.click(&format!("#room-{half}")).await;
    }
    browser.click("#join-rooms").await;
    rooms(browser, before).await;
    onlooker.sees(|home| home.room_changes.len() == 2 && home.rooms.len() == before);
    browser.shot("phone-rooms-joined-dark").await;
    // The list of changes takes the newest one back.
    browser.click("#room-changes li:last-child button").await;
    rooms(browser, before + 1).await;
    browser.click("#undo").await;
    rooms(browser, before).await;
    settings_are_undone(browser, &mut onlooker, halves[0]).await;
}

/// A room gets other settings, which the daemon has, and they are taken back.
async fn settings_are_undone(browser: &Browser, onlooker: &mut Onlooker, room: u16) {
    let shown = "document.getElementById('rooms').innerText.includes('suction 50')";
    browser.click(&format!("#room-{room}-settings")).await;
    let slide = "const field = document.getElementById('room-vacuum'); field.value = '50'; \
                 field.dispatchEvent(new Event('input', {bubbles: true})); return ''";
    browser.text(slide).await;
    browser.choose("room-pattern", "contour").await;
    browser.shot("phone-room-settings-dark").await;
    browser.click("#save-settings").await;
    browser.until(&format!("return {shown}")).await;
    let pattern_of = move |home: &HomeView| {
        let known = home.rooms.iter().find(|known| known.id == room);
        known
            .and_then(|known| known.settings)
            .map(|settings| settings.pattern)
    };
    onlooker.sees(move |home| pattern_of(home) == Some(CleaningPattern::Contour));
    browser.click("#undo").await;
    browser.until(&format!("return !{shown}")).await;
    onlooker.sees(move |home| pattern_of(home).is_none());
}

#[tokio::test]
async fn a_dock_that_was_moved_is_shown_by_two_places_and_taken_back() {
    let Some(visit) = Visit::begin_among_rooms(Screen::Desktop).await else {
        return;
    };
    let browser = &visit.browser;
    let mut onlooker = Onlooker::watch(&visit.stack.daemon_socket());
    browser.says("dock-place", "where the robot has docked").await;
    browser.click("#draw-dock").await;
    keys(browser, &["Enter", "ArrowLeft", "ArrowLeft"]).await;
    browser.shot("desktop-dock-drawn").await;
    keys(browser, &["Enter"]).await;
    browser.says("dock-place", "where somebody marked it").await;
    let mut moved = None;
    onlooker.sees(|home| {
        moved = home.dock.filter(|_| home.dock_reported);
        moved.is_some()
    });
    browser.shot("desktop-dock-moved").await;
    browser.click("#undo").await;
    browser.says("dock-place", "where the robot has docked").await;
    onlooker.sees(|home| !home.dock_reported);
    browser.click("#redo").await;
    onlooker.sees(|home| home.dock_reported && home.dock == moved);
    // Far outside there is no floor for it; a message says so over the hint of the drawing.
    browser.click("#draw-dock").await;
    keys(browser, &["ArrowUp"; 16]).await;
    keys(browser, &["Enter", "ArrowUp", "Enter"]).await;
    browser
        .until("return document.body.innerText.includes('knows no floor under a robot on a dock')")
        .await;
}
