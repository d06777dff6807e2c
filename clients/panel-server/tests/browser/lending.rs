//! A phone lends its stick to the driver at another browser: the robot follows, and stops whenever the phone is lost.

use std::time::{Duration, Instant};

use crate::accessibility::{SMALL_TARGETS, expect_none};
use crate::browser::{Browser, Screen};
use crate::hands::{drive_by, pad_on_screen, touch, turning_by};
use crate::losses::{Losses, ready_to_drive, stays, times};
use crate::mixes::{is_ready, plug_in};
use crate::robot::Observer;

/// Opens what lends, and lends.
async fn lend(phone: &Browser) {
    phone.click("#lending summary").await;
    phone
        .until("return document.getElementById('lend').checkVisibility()")
        .await;
    phone.click("#lend").await;
    phone.says("lend-state", "client-phone-right").await;
}

/// The thumb drags the stick of the phone to the left until the robot turns; it stays there.
async fn push_until_it_turns([driver, phone]: [&Browser; 2], witness: &Observer) {
    for _ in 0..5 {
        is_ready(driver).await;
        let [x, y, radius] = pad_on_screen(phone).await;
        touch(phone, "touchStart", &[[x, y]]);
        for step in 1..=4 {
            let left = radius * f64::from(step) / 4.0;
            touch(phone, "touchMove", &[[x - left, y]]);
        }
        if witness.moves_within(Duration::from_secs(4)) {
            return;
        }
        touch(phone, "touchEnd", &[]);
    }
    phone.fail("the robot does not turn").await
}

/// On a machine that is too busy the driver's lease ends between two messages, and nobody drives: then the stick is pushed again.
async fn the_driver_is_told([driver, phone]: [&Browser; 2], witness: &Observer) {
    let is_told =
        "return document.getElementById('lend-state').textContent.includes('the driver now is panel')";
    for _ in 0..5 {
        for _ in 0..20 {
            if phone.text(is_told).await == "true" {
                return;
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
        touch(phone, "touchEnd", &[]);
        push_until_it_turns([driver, phone], witness).await;
    }
    phone.fail("it is not told who drives").await
}

#[tokio::test]
async fn a_phone_lends_its_stick_and_each_loss_of_it_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let driver = &visit.browser;
    drive_by(driver, &turning_by(&["client-phone-right"])).await;
    let phone = &Browser::open(&visit.stack, Screen::Phone).await;
    phone.until_state(&["idle"]).await;
    phone.click("#tab-drive").await;
    lend(phone).await;
    phone.says("lend-state", "nobody drives").await;
    let [mut of_end, mut of_tab, mut of_taking] = [(); 3].map(|()| Losses::default());
    for trial in 0..times() {
        push_until_it_turns([driver, phone], &witness).await;
        if trial == 0 {
            the_driver_is_told([driver, phone], &witness).await;
            phone.shot("phone-lending").await;
            expect_none(phone, "lending").await;
            assert_eq!(phone.text(SMALL_TARGETS).await, "");
            driver.shot("desktop-driven-by-lent").await;
        }
        touch(phone, "touchEnd", &[]);
        of_end.watch(&witness, Instant::now());

        push_until_it_turns([driver, phone], &witness).await;
        phone.hide_behind_a_new_tab().await;
        of_tab.watch(&witness, Instant::now());
        phone.close_tab_and_return().await;
        stays(&witness, "a lent stick");
        touch(phone, "touchEnd", &[]);
        phone.says("lend-state", "client-phone-right").await;

        push_until_it_turns([driver, phone], &witness).await;
        phone
            .text("document.getElementById('lend').click(); return ''")
            .await;
        of_taking.watch(&witness, Instant::now());
        touch(phone, "touchEnd", &[]);
        phone
            .until("return document.getElementById('lend-state').hidden")
            .await;
        phone.click("#lend").await;
        phone.says("lend-state", "client-phone-right").await;
    }
    of_end.tell("the thumb left the lent stick");
    of_tab.tell("the page that lends was hidden");
    of_taking.tell("the lent stick was taken back");
}

#[tokio::test]
async fn a_lent_gamepad_drives_elsewhere_and_its_loss_stops_the_wheels() {
    let Some((visit, witness)) = ready_to_drive(Screen::Desktop).await else {
        return;
    };
    let driver = &visit.browser;
    drive_by(driver, &turning_by(&["client-couch-axis-0"])).await;
    let lender = &Browser::open(&visit.stack, Screen::Desktop).await;
    lender.until_state(&["idle"]).await;
    lender
        .text("localStorage.setItem('lend-name', 'couch'); return ''")
        .await;
    lender.reload().await;
    lender.until_state(&["idle"]).await;
    plug_in(lender).await;
    lender.click("#lending summary").await;
    lender.click("#lend").await;
    lender.says("lend-state", "client-couch-axis-0").await;
    let mut losses = Losses::default();
    for _ in 0..times() {
        let mut turns = false;
        for _ in 0..5 {
            lender.text("stick(0, 0); return ''").await;
            is_ready(driver).await;
            lender.text("stick(0, -1); return ''").await;
            turns = witness.moves_within(Duration::from_secs(4));
            if turns {
                break;
            }
        }
        assert!(turns, "the robot does not turn");
        lender.text("window.plugged = false; return ''").await;
        losses.watch(&witness, Instant::now());
        lender.text("window.plugged = true; return ''").await;
        stays(&witness, "a lent pad");
    }
    losses.tell("the lent pad was lost");
}
