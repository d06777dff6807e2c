//! An update goes from the page to the robot: refused, put in use with a real daemon, undone; told in both languages, across restarts of
//! daemon and server. What systemd does on a board, a thread and the test itself do here.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use flash_trials::signed_update::update_of_daemon;
use minisign::KeyPair;
use serde_json::json;
use tokio::time::sleep;

use crate::Visit;
use crate::accessibility::{TOO_WIDE, expect_none};
use crate::browser::{Browser, Screen};
use crate::pairing::let_in;
use crate::stack::{Stack, binary};
use crate::turns::Company;

/// A large file, signatures and two starts of a daemon, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(180);

/// What systemd does on a board when a file is handed over: it starts `rvac update`.
struct Watcher {
    ends: Arc<AtomicBool>,
}

impl Drop for Watcher {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
    }
}

impl Watcher {
    fn start(stack: &Stack, keys: &Path) -> Self {
        let restart = stack.folder().join("restart");
        let (wanted, done) = (stack.folder().join("wanted"), stack.folder().join("done"));
        let script = format!(
            "#!/bin/sh\nrm -f {1}\ntouch {0}\nwhile [ ! -e {1} ]; do sleep 0.1; done\n",
            wanted.display(),
            done.display()
        );
        fs::write(&restart, script).unwrap();
        fs::set_permissions(&restart, fs::Permissions::from_mode(0o755)).unwrap();
        let offer = stack.folder().join("panel/update/offer.update");
        let words = [
            ("--folder", stack.updates()),
            ("--keys", keys.to_owned()),
            ("--wiring", stack.folder().join("no-wiring")),
            ("--socket", stack.daemon_socket()),
            ("--restart", restart),
            ("--page-port", "0".into()),
            ("--patience-s", "40".into()),
            ("--take", offer.clone()),
        ];
        let ends = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&ends);
        std::thread::spawn(move || {
            while !ended.load(Ordering::Relaxed) {
                if offer.exists() {
                    let mut update = Command::new(binary("rvac"));
                    update.arg("update").stdout(Stdio::null()).stderr(Stdio::null());
                    update.args(
                        words
                            .iter()
                            .flat_map(|(name, value)| [name.as_ref(), value.as_os_str()]),
                    );
                    update.status().unwrap();
                }
                std::thread::sleep(Duration::from_millis(100));
            }
        });
        Self { ends }
    }
}

/// Starts daemon and server again when `rvac update` asks for it, until the page says so; gives how often.
async fn until_headline(visit: &mut Visit, says: &str) -> u32 {
    let (wanted, done) = (
        visit.stack.folder().join("wanted"),
        visit.stack.folder().join("done"),
    );
    let headline = "return document.getElementById('update-headline')?.textContent ?? ''";
    let deadline = std::time::Instant::now() + PATIENCE;
    let mut restarts = 0;
    while !visit.browser.text(headline).await.contains(says) {
        if wanted.exists() {
            fs::remove_file(&wanted).unwrap();
            let current = visit.stack.updates().join("current/bin/vthal");
            visit.stack.kill_vthal();
            match fs::canonicalize(current) {
                Ok(program) => visit.stack.start_vthal_of(&program),
                Err(_) => visit.stack.start_vthal_of(&binary("vthal")),
            };
            visit.stack.restart_guarded();
            fs::write(&done, "").unwrap();
            restarts += 1;
        }
        if std::time::Instant::now() > deadline {
            visit
                .browser
                .fail(&format!("the page does not say {says:?}"))
                .await;
        }
        sleep(Duration::from_millis(50)).await;
    }
    restarts
}

async fn show_section(browser: &Browser) {
    browser.click("#tab-device").await;
    browser
        .until("return document.getElementById('software') !== null")
        .await;
    let scroll = "document.getElementById('software').scrollIntoView(); return ''";
    browser.text(scroll).await;
}

/// As the browser's tools have it.
const UNLIMITED: i64 = -1;

/// From now on the page sends so many bytes a second at most.
fn upload_at(browser: &Browser, bytes_per_s: i64) {
    let network = json!({
        "offline": false,
        "latency": 0,
        "downloadThroughput": UNLIMITED,
        "uploadThroughput": bytes_per_s,
    });
    browser.devtools("Network.enable", &json!({}));
    browser.devtools("Network.emulateNetworkConditions", &network);
}

/// The last picture of a state: no fault of accessibility, and nothing wider than the screen.
async fn look(browser: &Browser, name: &str) {
    let scroll = "document.getElementById('software').scrollIntoView(); return ''";
    browser.text(scroll).await;
    browser.shot(name).await;
    expect_none(browser, name).await;
    assert_eq!(
        browser.text(TOO_WIDE).await,
        "0",
        "{name} is wider than the screen"
    );
}

/// A visit of an owner whose key the robot accepts.
struct OwnersVisit {
    visit: Visit,
    pair: KeyPair,
    folder: PathBuf,
    _watcher: Watcher,
}

impl OwnersVisit {
    async fn begin() -> Option<Self> {
        let visit = Visit::at_the_door(Stack::start_guarded, Screen::Phone, Company::Others).await?;
        let pair = KeyPair::generate_unencrypted_keypair().unwrap();
        let folder = visit.stack.folder().to_owned();
        let keys = folder.join("keys");
        fs::create_dir_all(&keys).unwrap();
        fs::write(keys.join("own.pub"), pair.pk.to_box().unwrap().into_string()).unwrap();
        let watcher = Watcher::start(&visit.stack, &keys);
        let_in(&visit.browser, &visit.stack, "admin").await;
        visit.browser.darken().await;
        show_section(&visit.browser).await;
        Some(Self {
            visit,
            pair,
            folder,
            _watcher: watcher,
        })
    }

    async fn send(&self, (epoch, pair): (u64, &KeyPair), daemon: &[u8]) {
        let file = update_of_daemon(&self.folder, (epoch, pair), daemon).unwrap();
        self.visit.browser.choose_file("update-file", &file).await;
    }

    async fn is_refused(&mut self) {
        let stranger = KeyPair::generate_unencrypted_keypair().unwrap();
        self.send((1, &stranger), b"daemon").await;
        let restarts = until_headline(&mut self.visit, "Refused. Nothing was changed.").await;
        assert_eq!(restarts, 0);
        let browser = &self.visit.browser;
        browser
            .says("update-why", "a key that this robot does not accept")
            .await;
        look(browser, "phone-update-refused").await;
    }

    async fn is_put_in_use(&mut self) {
        let daemon = fs::read(binary("vthal")).unwrap();
        // Over a wireless network of a home, so that there is something to see.
        upload_at(&self.visit.browser, 8 << 20);
        self.send((1, &self.pair), &daemon).await;
        until_headline(&mut self.visit, "Receives the file").await;
        let bar = "const bar = document.getElementById('update-progress'); \
                   return `${bar?.getAttribute('role')} ${bar?.getAttribute('aria-label')}`";
        let seen = self.visit.browser.text(bar).await;
        assert_eq!(seen, "progressbar Progress of the update");
        look(&self.visit.browser, "phone-update-receives").await;
        upload_at(&self.visit.browser, UNLIMITED);
        let restarts = until_headline(&mut self.visit, "Update 1 is in use, version 0.1.0.").await;
        assert_eq!(restarts, 1);
        let program = self.visit.stack.vthal_program();
        assert!(program.ends_with("updates/a/bin/vthal"), "{}", program.display());
        self.visit.browser.until_state(&["idle", "docked"]).await;
        look(&self.visit.browser, "phone-update-in-use").await;
    }

    async fn is_undone(&mut self) {
        self.send((2, &self.pair), b"#!/bin/sh\nexit 1\n").await;
        let restarts = until_headline(&mut self.visit, "Everything is as it was before.").await;
        assert_eq!(
            restarts, 2,
            "the new daemon is tried, and the one before comes back"
        );
        let browser = &self.visit.browser;
        browser.says("update-why", "The daemon does not answer").await;
        assert!(self.visit.stack.vthal_program().ends_with("updates/a/bin/vthal"));
        let steps = "return [...document.querySelectorAll('#update-steps li')].map(row => row.dataset.state).join(' ')";
        assert_eq!(browser.text(steps).await, "done done done failed done");
        look(browser, "phone-update-undone").await;
    }
}

#[tokio::test]
async fn an_update_is_refused_put_in_use_and_undone_in_sight_of_its_owner() {
    let Some(mut owner) = OwnersVisit::begin().await else {
        return;
    };
    owner.visit.browser.tab_to("choose-update").await;
    look(&owner.visit.browser, "phone-update-none").await;
    owner.is_refused().await;
    owner.is_put_in_use().await;
    owner.is_undone().await;
    let browser = &owner.visit.browser;
    // A page that is loaded afterwards says the same, in its own language.
    let estonian = "localStorage.setItem('language', 'et'); return ''";
    browser.text(estonian).await;
    browser.reload().await;
    show_section(browser).await;
    browser.says("update-headline", "Kõik on nii, nagu enne.").await;
    look(browser, "phone-update-undone-estonian").await;
    browser.press_start().await;
    browser.until_state(&["cleaning"]).await;
    browser
        .until("return document.getElementById('choose-update').disabled && !document.getElementById('update-obstacle').hidden")
        .await;
    browser.click("#stop").await;
    browser.until_state(&["idle", "docked"]).await;
}
