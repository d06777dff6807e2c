//! A home of 400 square metres with a path of 10,000 points: how long a picture takes, and what the map costs on the wire.

use std::fmt::Write as _;
use std::time::Duration;

use crate::Browser;
use crate::browser::Screen;
use crate::stack::Stack;
use crate::turns::{Company, turn};
use crate::wire_tap::WireTap;

/// Sides of the home, and of its rooms, metres.
const SIDE_M: f64 = 20.0;
const ROOM_M: [f64; 2] = [5.0, 4.0];
/// Points of the path, each at least 2 cm from the previous one.
const POINTS: usize = 10_000;
const LONG_WAY: &str = "return Number(document.getElementById('map').dataset.pathPoints) >= 10000";
/// A daemon on a busy machine plans for so large a home for a while before the robot moves.
const START_MAX: Duration = Duration::from_secs(150);
const CLEANS: &str = "return document.getElementById('now')?.dataset.state === 'cleaning'";
/// How long each view is watched.
const WATCHED: Duration = Duration::from_secs(5);

/// Twenty rooms, each with a door to the next one along the row and one to the next row, and some furniture.
fn home() -> String {
    let mut text = format!(
        "format = \"librervac-home\"\nversion = 1\nname = \"Four hundred\"\n\n[[room]]\nname = \"All\"\n\
         polygon = [[0.0, 0.0], [{SIDE_M:.1}, 0.0], [{SIDE_M:.1}, {SIDE_M:.1}], [0.0, {SIDE_M:.1}]]\n"
    );
    let mut add = |kind: &str, [x, y, far_x, far_y]: [f64; 4], more: &str| {
        writeln!(
            text,
            "\n[[{kind}]]\nfrom = [{x:.2}, {y:.2}]\nto = [{far_x:.2}, {far_y:.2}]\n{more}"
        )
        .unwrap();
    };
    let [wide, deep] = ROOM_M;
    let (columns, rows) = ((SIDE_M / wide) as u32, (SIDE_M / deep) as u32);
    for column in 1..columns {
        let x = f64::from(column) * wide;
        add("wall", [x, 0.0, x, SIDE_M], "thickness-m = 0.1");
        for row in 0..rows {
            let y = f64::from(row) * deep + 1.5;
            add("door", [x, y, x, y + 0.9], "state = \"open\"");
        }
    }
    for row in 1..rows {
        let y = f64::from(row) * deep;
        add("wall", [0.0, y, SIDE_M, y], "thickness-m = 0.1");
        add("door", [2.0, y, 2.9, y], "state = \"open\"");
    }
    for room in 0..columns * rows {
        let (x, y) = (
            f64::from(room % columns) * wide + 3.0,
            f64::from(room / columns) * deep + 2.6,
        );
        let (far_x, far_y) = (x + 1.4, y + 0.7);
        writeln!(
            text,
            "\n[[furniture]]\nname = \"Thing {room}\"\n\
             polygon = [[{x}, {y}], [{far_x}, {y}], [{far_x}, {far_y}], [{x}, {far_y}]]"
        )
        .unwrap();
    }
    text.push_str("\n[dock]\nposition = [0.0, 1.0]\nheading-deg = 0.0\n");
    text
}

/// To and fro over the home in steps of 4 cm, in millimetres of the robot's frame: it begins on the dock and faces it.
fn way_mm() -> Vec<i32> {
    let lanes = 20;
    let along = POINTS / lanes;
    let place = |index: usize| {
        let (lane, step) = (index / along, index % along);
        let step = if lane % 2 == 0 { step } else { along - 1 - step };
        [-200 - step as i32 * 38, 500 - lane as i32 * 950]
    };
    (0..POINTS).flat_map(place).collect()
}

#[tokio::test]
async fn four_hundred_square_metres_and_ten_thousand_points() {
    if std::env::var_os("RVAC_BROWSER_TESTS").is_none() {
        println!("skipped: RVAC_BROWSER_TESTS is not set");
        return;
    }
    let _turn = turn(Company::None).await;
    let mut stack = Stack::start_in(&home());
    let tap = WireTap::before(&stack.daemon_socket(), stack.folder(), &way_mm());
    stack.serve_from(&tap.socket);
    for (screen, name) in [(Screen::Desktop, "desktop"), (Screen::Phone, "phone")] {
        let browser = Browser::open(&stack, screen).await;
        browser.until_state(&["idle", "docked", "cleaning"]).await;
        if name == "desktop" {
            browser.press_start().await;
        }
        browser.until_within(START_MAX, CLEANS).await;
        browser.until(LONG_WAY).await;
        browser.click("#ground-known").await;
        for view in ["2d", "3d"] {
            if view == "3d" {
                browser.click("#view-3d").await;
                browser
                    .until("return Number(document.getElementById('map').dataset.blocks) > 60")
                    .await;
            }
            let [median, p95] = browser.frame_times_ms(WATCHED).await;
            println!("frame time, {name}, {view}: median {median:.1} ms, p95 {p95:.1} ms");
            browser.shot(&format!("{name}-400m2-{view}")).await;
        }
    }
    let costs = tap.costs();
    let mut parts = costs.parts.clone();
    parts.sort_unstable();
    let largest = *parts.last().expect("a robot that cleans adds to the map");
    println!(
        "bytes of the map: whole {:?}, parts {}, median {}, largest {largest}",
        costs.whole,
        parts.len(),
        parts[parts.len() / 2]
    );
    let smallest_whole = costs.whole.iter().min().expect("whole maps were sent");
    assert!(
        largest * 10 < *smallest_whole,
        "a part of the map is as large as the map"
    );
}
