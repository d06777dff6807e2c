//! The page that the browser keeps: it opens without the robot's computer, and a new version takes its place.

use std::fs;
use std::path::{Path, PathBuf};

use crate::browser::Screen;
use crate::folder::Folder;
use crate::{Visit, accessibility};

/// The service worker of this version rules the page.
const IS_KEPT: &str = "return navigator.serviceWorker?.controller?.state === 'activated'";
/// Addresses of all that is kept and is not of the page itself.
const KEPT_ANSWERS: &str = "return (async () => {
        const kept = [];
        for (const name of await caches.keys())
            for (const request of await (await caches.open(name)).keys())
                if (new URL(request.url).pathname.startsWith('/api')) kept.push(request.url);
        return kept.join(' ');
    })()";
/// Only one version is kept, and it is the later one, or not.
const LATER: &str =
    "return caches.keys().then(names => names.length === 1 && names[0].startsWith('shell-later-'))";

/// Files of a later version: the page says so, and so the service worker is another one.
fn later_version(of: &Path) -> Folder {
    let folder = Folder::new();
    for entry in fs::read_dir(of).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_none_or(|ending| ending != "gz" && ending != "br")
        {
            fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
        }
    }
    let change = |file: &str, from: &str, to: &str| {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        assert!(text.contains(from), "{file} has {from}");
        fs::write(folder.join(file), text.replacen(from, to, 1)).unwrap();
    };
    change("index.html", "<html lang", "<html data-later=\"yes\" lang");
    change("sw.js", "'shell-", "'shell-later-");
    folder
}

#[tokio::test]
async fn the_page_opens_without_the_robot_and_a_new_version_takes_over() {
    let Some(mut visit) = Visit::begin(Screen::Phone).await else {
        return;
    };
    visit.browser.until(IS_KEPT).await;
    assert_eq!(visit.browser.text(LATER).await, "false");
    assert_eq!(visit.browser.text(KEPT_ANSWERS).await, "");

    visit.stack.stop_server();
    visit.browser.reload().await;
    visit
        .browser
        .until("return document.getElementById('reason')?.textContent.startsWith('The robot cannot be reached.')")
        .await;
    visit.browser.shot("phone-offline").await;
    accessibility::expect_none(&visit.browser, "without the robot").await;

    let later = later_version(&PathBuf::from(std::env::var_os("RVAC_PANEL").unwrap()));
    visit.stack.serve_again(&later);
    visit.browser.until_state(&["idle", "docked"]).await;
    visit.browser.reload().await;
    visit
        .browser
        .until("return document.documentElement.dataset.later === 'yes'")
        .await;
    visit.browser.until_state(&["idle", "docked"]).await;
    visit.browser.until(LATER).await;
}
