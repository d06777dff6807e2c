//! What the panel costs whoever opens it: the time until it is of use on a slow phone and a slow network, and its memory while
//! it stays open.

use std::time::{Duration, Instant};

use serde_json::json;
use tokio::time::sleep;

use crate::Visit;
use crate::browser::{Browser, Screen};

/// The usual slow phone of web measurements: 1.6 Mbit/s down, 750 kbit/s up, 150 ms there and back, a processor that is four
/// times slower than this one.
const DOWN_BYTES_PER_S: u32 = 200_000;
const UP_BYTES_PER_S: u32 = 93_750;
const DELAY_MS: u32 = 150;
const SLOWER: u32 = 4;

/// Notes when the robot's state is seen first, and the last task that kept the page from answering.
const NOTE: &str = "
    window.busyUntil = 0;
    new PerformanceObserver(list => list.getEntries().forEach(
        task => { window.busyUntil = Math.max(window.busyUntil, task.startTime + task.duration); },
    )).observe({ type: 'longtask', buffered: true });
    new MutationObserver(() => {
        const state = document.getElementById('now')?.dataset.state;
        if (['idle', 'docked'].includes(state) && document.getElementById('start')) window.usefulAt ??= performance.now();
    }).observe(document, { subtree: true, childList: true, attributes: true });";

/// First picture, the robot's state with its Start button, and the end of the last long task: milliseconds after the start; the
/// bytes that came over the network until the state was there, and all of them.
const NOTED: &str = "
    const first = performance.getEntriesByName('first-contentful-paint')[0].startTime;
    const all = performance.getEntriesByType('resource').concat(performance.getEntriesByType('navigation'));
    const bytes = parts => parts.reduce((sum, part) => sum + part.transferSize, 0);
    const before = all.filter(part => part.responseEnd <= window.usefulAt);
    return [first, window.usefulAt, window.busyUntil, bytes(before), bytes(all)].map(Math.round).join(' ')";

/// A page that has had nothing long to do for so long is at rest.
const QUIET: &str = "return window.usefulAt !== undefined && performance.now() - Math.max(window.usefulAt, window.busyUntil) > 5000";

/// What a first visit may bring over the network before the robot is on the screen, bytes.
const FIRST_LOAD_MAX: u64 = 500_000;

/// How often the page has asked for the module that it asked for most often.
pub(crate) const MODULES_ASKED_FOR: &str = "
    const names = performance.getEntriesByType('resource').map(part => part.name).filter(name => name.endsWith('.wasm'));
    return String(Math.max(...names.map(name => names.filter(other => other === name).length)))";

/// How much longer than on this computer loading may take.
const SLOW: Duration = Duration::from_secs(120);

/// From now on the browser is a phone that was never here before.
fn become_slow(browser: &Browser, address: &str) {
    browser.devtools("Network.enable", &json!({}));
    browser.devtools("Network.setBypassServiceWorker", &json!({ "bypass": true }));
    browser.devtools("Network.setCacheDisabled", &json!({ "cacheDisabled": true }));
    let origin = address.trim_end_matches('/');
    browser.devtools(
        "Storage.clearDataForOrigin",
        &json!({ "origin": origin, "storageTypes": "all" }),
    );
    let network = json!({
        "offline": false, "latency": DELAY_MS,
        "downloadThroughput": DOWN_BYTES_PER_S, "uploadThroughput": UP_BYTES_PER_S,
    });
    browser.devtools("Network.emulateNetworkConditions", &network);
    browser.devtools("Emulation.setCPUThrottlingRate", &json!({ "rate": SLOWER }));
    browser.devtools(
        "Page.addScriptToEvaluateOnNewDocument",
        &json!({ "source": NOTE }),
    );
}

#[tokio::test]
async fn the_first_visit_of_a_slow_phone() {
    let Some(visit) = Visit::begin_alone(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    become_slow(browser, &visit.stack.address);
    browser.reload().await;
    browser.until_within(SLOW, QUIET).await;
    let noted = browser.text(NOTED).await;
    let noted: Vec<u64> = noted.split(' ').map(|word| word.parse().unwrap()).collect();
    let [first, useful, busy, bytes, all] = noted[..] else {
        panic!("{noted:?}");
    };
    println!(
        "first visit of a slow phone: first picture {first} ms, the robot and its Start button {useful} ms, \
         last long task ends at {busy} ms, \
         {bytes} bytes until then, {all} in all"
    );
    assert!(bytes > 100_000, "the page came over the network: {bytes}");
    assert!(bytes < FIRST_LOAD_MAX, "a first visit brings {bytes} bytes");
    assert!(first <= useful);
    assert!(bytes < all, "the views that nobody sees yet came later");
    assert_eq!(browser.text(MODULES_ASKED_FOR).await, "1");
}

/// How long the page is watched.
fn watched() -> Duration {
    let wanted = std::env::var("RVAC_WATCH_MINUTES").ok();
    let minutes: f64 = wanted.map_or(0.5, |text| text.parse().expect("RVAC_WATCH_MINUTES is a number"));
    Duration::from_secs_f64(minutes * 60.0)
}

/// What a page may take more after it was watched: a leak of a byte a millisecond would take four times as much in an hour.
const MORE_MIB: f64 = 48.0;

/// Memory of scripts, after what is no longer used was given back, and that of the whole process; MiB.
fn memory_mib(browser: &Browser) -> [f64; 2] {
    browser.devtools("HeapProfiler.collectGarbage", &json!({}));
    let heap = browser.devtools("Runtime.getHeapUsage", &json!({}));
    let heap = heap["usedSize"].as_f64().expect("the browser tells its heap");
    [heap / 1_048_576.0, browser.memory_kib() as f64 / 1024.0]
}

/// A robot that has finished is sent again, so that the map goes on changing.
#[tokio::test]
async fn a_page_that_stays_open_does_not_grow() {
    let Some(visit) = Visit::begin_alone(Screen::Phone).await else {
        return;
    };
    let browser = &visit.browser;
    browser.devtools("HeapProfiler.enable", &json!({}));
    let begun = Instant::now();
    let mut seen = Vec::new();
    let looks = 10_u32;
    for look in 0..looks {
        let rests = "return ['idle', 'docked'].includes(document.getElementById('now')?.dataset.state)";
        if browser.text(rests).await == "true" {
            browser.press_start().await;
        }
        let next = watched() * (look + 1) / looks;
        sleep(next.saturating_sub(begun.elapsed())).await;
        let [heap, process] = memory_mib(browser);
        println!(
            "memory after {:.1} min: scripts {heap:.1} MiB, process {process:.0} MiB",
            begun.elapsed().as_secs_f64() / 60.0
        );
        seen.push(process);
    }
    let (first, last) = (seen[0], seen[seen.len() - 1]);
    assert!(last - first < MORE_MIB, "from {first:.0} to {last:.0} MiB");
}
