//! Chromium, driven as a person drives it.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use fantoccini::actions::{InputSource, KeyAction, KeyActions};
use fantoccini::key::Key;
use fantoccini::{Client, ClientBuilder, Locator};
use hyper_util::client::legacy::connect::HttpConnector;
use serde_json::{Value, json};
use tokio::time::sleep;

use crate::folder::Folder;
use crate::frozen::Frozen;
use crate::processes;
use crate::stack::Stack;

/// Whatever is awaited comes within this time or the test fails. A busy machine draws slowly.
const PATIENCE: Duration = Duration::from_secs(40);

/// Pause between two polls of the page.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// Scrolls to an element, and notes whether the next click arrives at it. A page that is left by the click forgets the note.
const AWAIT_CLICK: &str = "
    const selector = arguments[0];
    const wanted = document.querySelector(selector);
    // On a phone the sheet may lie over what belongs to the map, which does not scroll.
    if (wanted?.closest('.map')) window.scrollTo(0, 0);
    else wanted?.scrollIntoView({ block: 'center' });
    const arrives = target => target.closest?.(selector)
        || (target.tagName === 'SELECT' && target.contains(document.querySelector(selector)));
    window.clickMissed = true;
    window.noteClick = event => { if (arrives(event.target)) window.clickMissed = false; };
    window.clickSeen ??= ['click', 'change'].forEach(
        kind => window.addEventListener(kind, event => window.noteClick(event), true)) ?? true;";

/// What a person presses first to see this: the part of the home that it is in, then the menu of its row. Null when it is seen.
const OPENER: &str = "
    const element = document.querySelector(arguments[0]);
    const part = element?.closest('.home-part[hidden]');
    if (part) return `show-${part.id}`;
    const actions = element?.closest('.row-actions[hidden]');
    return actions ? actions.previousElementSibling.id : null;";

/// Size of the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Screen {
    /// 1440 by 900 pixels of page: the frame of the headless window takes 143 rows.
    Desktop,
    /// 390 by 844, two device pixels a pixel, touch.
    Phone,
    /// The first, in a browser without WebGL.
    WithoutWebGl,
}

/// A browser that shows the panel.
#[derive(Debug)]
pub(crate) struct Browser {
    client: Client,
    driver: Child,
    /// Where the driver and the browser keep their temporary files; the browser leaves some when it is killed.
    _folder: Folder,
    /// Host and port of the driver.
    driver_at: String,
    session: String,
}

impl Drop for Browser {
    /// After a test that failed too: the driver itself would leave the browser running for ever.
    fn drop(&mut self) {
        self.end_session().ok(); // A session that ended before is as good.
        self.driver.kill().ok(); // It may have ended by itself.
        self.driver.wait().ok();
    }
}

impl Browser {
    pub(crate) async fn open(stack: &Stack, screen: Screen) -> Self {
        let folder = Folder::new();
        let (driver, driver_at) = start_driver(&folder);
        let capabilities = capabilities(screen).as_object().cloned().unwrap();
        let client = ClientBuilder::new(HttpConnector::new())
            .capabilities(capabilities)
            .connect(&format!("http://{driver_at}"))
            .await
            .unwrap();
        let session = client.session_id().await.unwrap().expect("a session has a name");
        let browser = Self {
            client,
            driver,
            _folder: folder,
            driver_at,
            session,
        };
        browser.client.goto(&stack.address).await.unwrap();
        browser
    }

    fn end_session(&self) -> io::Result<()> {
        self.ask_driver("DELETE", "", "").map(drop)
    }

    /// What the driver answers to a request that the client does not know.
    fn ask_driver(&self, method: &str, below: &str, body: &str) -> io::Result<String> {
        let mut stream = TcpStream::connect(&self.driver_at)?;
        let (session, host, length) = (&self.session, &self.driver_at, body.len());
        write!(
            stream,
            "{method} /session/{session}{below} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\
             Content-Type: application/json\r\nContent-Length: {length}\r\n\r\n{body}"
        )?;
        stream.set_read_timeout(Some(PATIENCE))?;
        // It keeps the connection all the same, so its answer is read by its length.
        let mut answer = BufReader::new(stream);
        let mut length = 0;
        loop {
            let mut line = String::new();
            answer.read_line(&mut line)?;
            if line.trim_end().is_empty() {
                break;
            }
            if let Some(told) = line.to_ascii_lowercase().strip_prefix("content-length:") {
                length = told.trim().parse().unwrap_or(0);
            }
        }
        let mut body = vec![0; length];
        answer.read_exact(&mut body)?;
        Ok(String::from_utf8_lossy(&body).into_owned())
    }

    /// A command of the developer tools, with what it gives.
    pub(crate) fn devtools(&self, command: &str, parameters: &Value) -> Value {
        let body = json!({ "cmd": command, "params": parameters }).to_string();
        let answer = self.ask_driver("POST", "/goog/cdp/execute", &body).unwrap();
        let answer: Value = serde_json::from_str(&answer).unwrap();
        assert!(answer["value"]["error"].is_null(), "{command}: {answer}");
        answer["value"].clone()
    }

    /// Memory of the process that shows the page, KiB.
    pub(crate) fn memory_kib(&self) -> u64 {
        let all = processes::descendants_of(self.driver.id()).into_iter();
        let shows = all.filter(|process| processes::is_called_with(*process, "--type=renderer"));
        shows.map(processes::memory_kib).max().unwrap_or(0)
    }

    pub(crate) async fn reload(&self) {
        self.client.refresh().await.unwrap();
    }

    pub(crate) async fn goto(&self, address: &str) {
        self.client.goto(address).await.unwrap();
    }

    /// Sets the dark theme.
    pub(crate) async fn darken(&self) {
        self.click("#theme").await;
        self.until("return document.documentElement.dataset.theme === 'dark'")
            .await;
    }

    /// How many cookies the page that is seen would send, those included that no script can read.
    pub(crate) async fn cookies(&self) -> usize {
        self.client.get_all_cookies().await.unwrap().len()
    }

    /// Title of what the first frame of the page shows.
    pub(crate) async fn title_in_frame(&self) -> String {
        self.client.enter_frame(0).await.unwrap();
        let title = self.text("return document.title").await;
        self.client.enter_parent_frame().await.unwrap();
        title
    }

    /// Clicks in the middle of an element as soon as the page shows it. It is scrolled into the middle first: the driver takes
    /// one below a bar that stays at the edge for visible. A page that grows between the driver's measurement and its press makes
    /// the press land elsewhere; a person presses again then, and so does this.
    pub(crate) async fn click(&self, selector: &str) {
        self.reveal(selector).await;
        self.click_on_seen(selector).await;
    }

    /// Opens what an element is folded away in; how many presses that takes.
    pub(crate) async fn reveal(&self, selector: &str) -> u32 {
        let there = format!("return document.querySelector({selector:?}) !== null");
        self.is_within(PATIENCE, &there).await; // Whoever presses says what is missing.
        let mut presses = 0;
        while let Some(opener) = self.opener_of(selector).await {
            self.click_on_seen(&format!("#{opener}")).await;
            presses += 1;
        }
        presses
    }

    /// The name of the button that unfolds an element, or of what is around that.
    pub(crate) async fn opener_of(&self, selector: &str) -> Option<String> {
        let opener = self.client.execute(OPENER, vec![json!(selector)]).await.ok()?;
        opener.as_str().map(str::to_owned)
    }

    /// Clicks in the middle of an element without scrolling to it.
    pub(crate) async fn click_where_it_is(&self, id: &str) {
        let place = format!(
            "const box = document.getElementById('{id}').getBoundingClientRect();
             const hit = document.elementFromPoint(box.x + box.width / 2, box.y + 8);
             if (hit?.closest('#{id}') === null) return hit.outerHTML.slice(0, 100);
             hit.closest('#{id}').click(); return ''"
        );
        assert_eq!(self.text(&place).await, "", "{id} is covered");
    }

    async fn click_on_seen(&self, selector: &str) {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let prepare = vec![json!(selector)];
            self.client.execute(AWAIT_CLICK, prepare).await.unwrap();
            let pressed = match self.client.find(Locator::Css(selector)).await {
                Ok(element) => element.click().await,
                Err(error) if error.is_no_such_element() => Err(error),
                Err(error) => panic!("{selector} cannot be looked for: {error}"),
            };
            // The driver may complain of a page that its press has changed; a page that is another one by now knows of no press.
            let landed = self.text("return String(window.clickMissed)").await;
            if landed == "false" || (pressed.is_ok() && landed != "true") {
                return;
            }
            assert!(
                Instant::now() < deadline,
                "{selector} cannot be clicked: {pressed:?}"
            );
        }
    }

    /// Presses Start as soon as it can be pressed: before the robot is there it only says why not.
    pub(crate) async fn press_start(&self) {
        self.until("return document.getElementById('start')?.getAttribute('aria-disabled') === 'false'")
            .await;
        self.click("#start").await;
    }

    /// The text that a script gives, or promises.
    pub(crate) async fn text(&self, script: &str) -> String {
        let value = self.client.execute(script, Vec::new()).await.unwrap();
        value.as_str().map_or_else(|| value.to_string(), str::to_owned)
    }

    /// Waits until a script gives true.
    pub(crate) async fn until(&self, script: &str) {
        self.until_within(PATIENCE, script).await;
    }

    /// The same, for what may take longer on a busy machine.
    pub(crate) async fn until_within(&self, patience: Duration, script: &str) {
        if !self.is_within(patience, script).await {
            self.fail(&format!("not before the deadline: {script}")).await;
        }
    }

    /// Whether a script gives true within this time.
    pub(crate) async fn is_within(&self, patience: Duration, script: &str) -> bool {
        let deadline = Instant::now() + patience;
        while !matches!(
            self.client.execute(script, Vec::new()).await,
            Ok(Value::Bool(true))
        ) {
            if Instant::now() > deadline {
                return false;
            }
            sleep(LOOK_EVERY).await;
        }
        true
    }

    /// Ends the test with what the page shows.
    pub(crate) async fn fail(&self, what: &str) -> ! {
        self.shot("failed").await;
        panic!(
            "{what}; page: {}",
            self.text("return document.body.innerText").await
        );
    }

    /// Waits until the element `id` is there and says this, whether or not a line may break within.
    pub(crate) async fn says(&self, id: &str, words: &str) {
        let words = words.replace('\u{a0}', " ");
        self.until(&format!(
            "return document.getElementById('{id}')?.textContent.replaceAll('\\u00a0', ' ').includes('{words}') === true"
        ))
        .await;
    }

    /// Waits until the map shows more swept cells than this.
    pub(crate) async fn sweeps_more_than(&self, cells: u32) {
        self.until(&format!(
            "return Number(document.getElementById('map').dataset.sweptCells) > {cells}"
        ))
        .await;
    }

    /// Waits until nothing is chosen for a job.
    pub(crate) async fn has_no_order(&self) {
        self.until("return document.getElementById('order-bar') === null")
            .await;
    }

    /// Chooses an entry of the list `id` by its value, with the events that a person causes.
    pub(crate) async fn choose(&self, id: &str, value: &str) {
        let chosen = format!(
            "const list = document.getElementById('{id}'); list.value = '{value}'; \
             list.dispatchEvent(new Event('change', {{bubbles: true}})); return list.value"
        );
        assert_eq!(self.text(&chosen).await, value, "{id} offers it");
    }

    /// Chooses a file of this computer in a field.
    pub(crate) async fn choose_file(&self, id: &str, path: &Path) {
        let field = self.client.find(Locator::Id(id)).await.unwrap();
        field.send_keys(&path.to_string_lossy()).await.unwrap();
    }

    /// Waits until the robot is in one of these states.
    pub(crate) async fn until_state(&self, states: &[&str]) {
        let states = json!(states);
        self.until(&format!(
            "return {states}.includes(document.getElementById('now')?.dataset.state)"
        ))
        .await;
    }

    /// The median of what the page measures over `span`.
    pub(crate) async fn frames_per_second(&self, span: Duration) -> f64 {
        let end = Instant::now() + span;
        let mut rates = Vec::new();
        while Instant::now() < end {
            let rate = self
                .text("return document.getElementById('map').dataset.framesPerSecond")
                .await;
            rates.push(rate.parse::<f64>().unwrap());
            sleep(Duration::from_millis(250)).await;
        }
        rates.sort_by(f64::total_cmp);
        rates[rates.len() / 2]
    }

    /// Median and 95th percentile of the times between two pictures in ms, as the page measures them: the medians of what it
    /// tells over `span`.
    pub(crate) async fn frame_times_ms(&self, span: Duration) -> [f64; 2] {
        let end = Instant::now() + span;
        let mut seen = [Vec::new(), Vec::new()];
        while Instant::now() < end {
            let told = self
                .text("return document.getElementById('map').dataset.frameMs ?? ''")
                .await;
            for (list, word) in seen.iter_mut().zip(told.split(' ')) {
                list.extend(word.parse::<f64>());
            }
            sleep(Duration::from_millis(250)).await;
        }
        seen.map(|mut list| {
            list.sort_by(f64::total_cmp);
            list[list.len() / 2]
        })
    }

    /// Holds a key down while an element has the focus.
    pub(crate) async fn hold_key_in(&self, selector: &str, key: char) {
        self.client
            .execute(
                &format!("document.querySelector('{selector}').focus()"),
                Vec::new(),
            )
            .await
            .unwrap();
        let down = KeyActions::new("keyboard".to_owned()).then(KeyAction::Down { value: key });
        self.client.perform_actions(down).await.unwrap();
    }

    pub(crate) async fn release_key(&self, key: char) {
        let up = KeyActions::new("keyboard".to_owned()).then(KeyAction::Up { value: key });
        self.client.perform_actions(up).await.unwrap();
    }

    /// Presses Tab until the element with this id has the focus, and checks that the focus is visible.
    pub(crate) async fn tab_to(&self, id: &str) {
        for _ in 0..40 {
            self.press(Key::Tab.into()).await;
            if self.text("return document.activeElement.id").await == id {
                let outline = self
                    .text("return getComputedStyle(document.activeElement).outlineStyle")
                    .await;
                assert_ne!(outline, "none", "the focus on {id} cannot be seen");
                return;
            }
        }
        panic!("Tab does not lead to {id}");
    }

    pub(crate) async fn press_enter(&self) {
        self.press(Key::Enter.into()).await;
    }

    pub(crate) async fn press(&self, key: char) {
        let keys = KeyActions::new("keyboard".to_owned());
        let keys = keys
            .then(KeyAction::Down { value: key })
            .then(KeyAction::Up { value: key });
        self.client.perform_actions(keys).await.unwrap();
    }

    /// Opens another tab in front of the panel.
    pub(crate) async fn hide_behind_a_new_tab(&self) {
        let tab = self.client.new_window(true).await.unwrap();
        self.client.switch_to_window(tab.handle).await.unwrap();
    }

    /// Closes the tab that is seen and shows the first one.
    pub(crate) async fn close_tab_and_return(&self) {
        self.client.close_window().await.unwrap();
        let first = self.client.windows().await.unwrap().remove(0);
        self.client.switch_to_window(first).await.unwrap();
    }

    /// Stops the browser and all its processes until the value is dropped; the driver lives on.
    pub(crate) fn freeze(&self) -> Frozen {
        Frozen::descendants_of(self.driver.id())
    }

    /// Saves the view, if screenshots are enabled.
    pub(crate) async fn shot(&self, name: &str) {
        self.save_in("RVAC_SCREENSHOTS", name).await;
    }

    /// Saves the view as a picture of the README, if those are enabled.
    pub(crate) async fn picture(&self, name: &str) {
        self.save_in("RVAC_PICTURES", name).await;
    }

    /// Saves what is seen in the folder that a variable names.
    async fn save_in(&self, variable: &str, name: &str) {
        let Some(folder) = std::env::var_os(variable) else {
            return;
        };
        let folder = std::path::PathBuf::from(folder);
        std::fs::create_dir_all(&folder).unwrap();
        let picture = self.client.screenshot().await.unwrap();
        std::fs::write(folder.join(format!("{name}.png")), picture).unwrap();
    }
}

/// Starts the driver on a port that it chooses itself, with its temporary files in this folder; gives its address.
fn start_driver(temporary: &Path) -> (Child, String) {
    let mut command = Command::new("chromedriver");
    command
        .arg("--port=0")
        .env("TMPDIR", temporary)
        .stdout(Stdio::piped())
        .stderr(Stdio::null());
    let mut child = command.spawn().expect("chromedriver is installed");
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let port = lines
        .by_ref()
        .map_while(Result::ok)
        .find_map(|line| {
            line.rsplit_once("successfully on port ")
                .map(|(_, port)| port.trim_end_matches('.').to_owned())
        })
        .expect("chromedriver names its port");
    (child, format!("127.0.0.1:{port}"))
}

fn capabilities(screen: Screen) -> Value {
    let mut options = json!({
        "args": [
            "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
            "--disable-background-networking", "--disable-component-update", "--disable-sync", "--window-size=1440,1043",
            // Where the tests' strangers have their site.
            "--host-resolver-rules=MAP *.example 127.0.0.1",
        ],
    });
    if matches!(screen, Screen::Phone) {
        options["mobileEmulation"] =
            json!({ "deviceMetrics": { "width": 390, "height": 844, "pixelRatio": 2.0 } });
    }
    if let (Screen::WithoutWebGl, Some(list)) = (screen, options["args"].as_array_mut()) {
        list.push(json!("--disable-3d-apis"));
    }
    // As a person who accepts the warning about a robot's own certificate.
    json!({ "browserName": "chrome", "acceptInsecureCerts": true, "goog:chromeOptions": options })
}
