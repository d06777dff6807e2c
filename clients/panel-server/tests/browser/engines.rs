//! The same random gestures in Firefox and in WebKit, with the pointer of a screen of their own, as a person moves it: what an engine
//! makes of a press, a drag and a selection is its own matter.
//!
//! They run only when `RVAC_ENGINES` is set, because they need Firefox, WebKit's driver, Xvfb and xdotool.

use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use fantoccini::{Client, ClientBuilder};
use futures_util::{SinkExt as _, StreamExt as _};
use hyper_util::client::legacy::connect::HttpConnector;
use serde_json::{Value, json};
use tokio::net::TcpStream;
use tokio::time::sleep;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;

use crate::costs::MODULES_ASKED_FOR;
use crate::folder::Folder;
use crate::gestures::{COUNT_MOTIONS, MOTIONS_SINCE, Random, count, judge};
use crate::losses::OFF_DOCK;
use crate::stack::Stack;
use crate::turns::{Company, turn};

/// An engine starts within this time, and whatever is awaited comes.
const PATIENCE: Duration = Duration::from_secs(60);
const LOOK_EVERY: Duration = Duration::from_millis(100);
const SEED: u64 = 31;
/// Where the pointer is moved to find out where the page lies on the screen.
const TRIED: [f64; 2] = [600.0, 500.0];
const NOTE_POINTER: &str = "
    window.addEventListener('mousemove', (event) => { window.seen = [event.clientX, event.clientY]; }, true);
    return ''";
const WHERE_IS_THE_PAD: &str = "
    const pad = document.getElementById('pad');
    pad.scrollIntoView({ block: 'center' });
    const box = pad.getBoundingClientRect();
    return JSON.stringify([box.x + box.width / 2, box.y + box.height / 2, box.width / 2])";
const IS_READY: &str = "
    const state = document.getElementById('now')?.dataset.state;
    return String(state === 'idle' && document.getElementById('drive-state')?.textContent === '')";

/// What shows the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Engine {
    Firefox,
    WebKit,
}

/// A process that ends with the value.
#[derive(Debug)]
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok(); // It may have ended by itself.
        self.0.wait().ok();
    }
}

/// A screen that nobody sees, with a pointer.
#[derive(Debug)]
struct HiddenScreen {
    display: String,
    _server: Running,
    _told: BufReader<ChildStdout>,
}

impl HiddenScreen {
    fn start() -> Self {
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                "1440x1043x24",
                "-nolisten",
                "tcp",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is installed");
        let mut told = BufReader::new(server.stdout.take().unwrap());
        let mut number = String::new();
        told.read_line(&mut number).unwrap();
        Self {
            display: format!(":{}", number.trim()),
            _server: Running(server),
            _told: told,
        }
    }

    /// What a person's hand does to the pointer.
    fn hand(&self, words: &[&str]) {
        let done = Command::new("xdotool")
            .args(words)
            .env("DISPLAY", &self.display)
            .status()
            .expect("xdotool is installed");
        assert!(done.success(), "xdotool {words:?}");
    }
}

/// How scripts reach the page.
#[derive(Debug)]
enum Wire {
    /// WebDriver BiDi, which Firefox speaks itself.
    Socket {
        socket: Box<WebSocketStream<TcpStream>>,
        context: String,
        asked: u64,
    },
    /// WebDriver, by the driver of WebKit.
    Driver(Client),
}

impl Wire {
    /// A command of WebDriver BiDi and what it gives.
    async fn ask(&mut self, method: &str, parameters: Value) -> Value {
        let Self::Socket { socket, asked, .. } = self else {
            unreachable!("only Firefox is asked so");
        };
        *asked += 1;
        let packet = json!({ "id": *asked, "method": method, "params": parameters }).to_string();
        socket.send(Message::text(packet)).await.unwrap();
        loop {
            let message = socket.next().await.expect("Firefox answers").unwrap();
            let Ok(text) = message.to_text() else { continue };
            let answer: Value = serde_json::from_str(text).unwrap_or_default();
            if answer["id"] == json!(*asked) {
                assert_eq!(answer["type"], "success", "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }

    async fn open(&mut self, address: &str) {
        match self {
            Self::Driver(client) => client.goto(address).await.unwrap(),
            Self::Socket { context, .. } => {
                let parameters = json!({ "context": context, "url": address, "wait": "complete" });
                self.ask("browsingContext.navigate", parameters).await;
            }
        }
    }

    /// The text that a script gives, or promises.
    async fn text(&mut self, script: &str) -> String {
        match self {
            Self::Driver(client) => {
                let value = client.execute(script, Vec::new()).await.unwrap();
                value.as_str().map_or_else(|| value.to_string(), str::to_owned)
            }
            Self::Socket { context, .. } => {
                let parameters = json!({
                    "expression": format!("(function () {{ {script} }})()"),
                    "target": { "context": context },
                    "awaitPromise": true,
                });
                let answer = self.ask("script.evaluate", parameters).await;
                assert_eq!(answer["type"], "success", "{script}: {answer}");
                answer["result"]["value"].as_str().unwrap_or_default().to_owned()
            }
        }
    }

    async fn until(&mut self, script: &str, patience: Duration) -> bool {
        let deadline = Instant::now() + patience;
        while self.text(script).await != "true" {
            if Instant::now() > deadline {
                return false;
            }
            sleep(LOOK_EVERY).await;
        }
        true
    }
}

async fn firefox(screen: &HiddenScreen, folder: &Folder) -> (Wire, Running) {
    let mut child = Command::new("firefox-esr")
        .args([
            "--no-remote",
            "--remote-debugging-port",
            "0",
            "--width",
            "1400",
            "--height",
            "1000",
        ])
        .arg("--profile")
        .arg(&**folder)
        .env("DISPLAY", &screen.display)
        .env("HOME", &**folder)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("Firefox is installed");
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let running = Running(child);
    let address = lines
        .by_ref()
        .map_while(Result::ok)
        .find_map(|line| {
            Some(
                line.split_once("WebDriver BiDi listening on ws://")?
                    .1
                    .trim()
                    .to_owned(),
            )
        })
        .expect("Firefox names its port");
    // What it says later must not stop it.
    std::thread::spawn(move || lines.map_while(Result::ok).for_each(drop));
    let request = format!("ws://{address}/session").into_client_request().unwrap();
    let stream = TcpStream::connect(&address).await.unwrap();
    let (socket, _) = tokio_tungstenite::client_async(request, stream).await.unwrap();
    let mut wire = Wire::Socket {
        socket: Box::new(socket),
        context: String::new(),
        asked: 0,
    };
    wire.ask("session.new", json!({ "capabilities": {} })).await;
    let tree = wire.ask("browsingContext.getTree", json!({})).await;
    if let Wire::Socket { context, .. } = &mut wire {
        *context = tree["contexts"][0]["context"].as_str().expect("a tab").to_owned();
    }
    (wire, running)
}

async fn webkit(screen: &HiddenScreen) -> (Wire, Running) {
    let port = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap()
        .port();
    let child = Command::new("WebKitWebDriver")
        .arg(format!("--port={port}"))
        .env("DISPLAY", &screen.display)
        // Tests run as root on build machines, where its sandbox cannot be made.
        .env("WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS", "1")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("WebKit's driver is installed");
    let running = Running(child);
    let deadline = Instant::now() + PATIENCE;
    while TcpStream::connect(("127.0.0.1", port)).await.is_err() {
        assert!(Instant::now() < deadline, "WebKit's driver does not listen");
        sleep(LOOK_EVERY).await;
    }
    let client = ClientBuilder::new(HttpConnector::new())
        .capabilities(serde_json::Map::new())
        .connect(&format!("http://127.0.0.1:{port}"))
        .await
        .unwrap();
    client.set_window_rect(0, 0, 1400, 1000).await.unwrap();
    (Wire::Driver(client), running)
}

/// A hand on the pointer before the page.
struct Hand<'a> {
    screen: &'a HiddenScreen,
    wire: &'a mut Wire,
    random: Random,
    /// Where the page begins on the screen.
    origin: [f64; 2],
    /// Middle and radius of the pad on the page.
    pad: [f64; 3],
}

impl Hand<'_> {
    fn move_to(&self, [x, y]: [f64; 2]) {
        let on_screen = |at: f64, origin: f64| ((at + origin).max(1.0) as i32).to_string();
        let [x, y] = [on_screen(x, self.origin[0]), on_screen(y, self.origin[1])];
        self.screen.hand(&["mousemove", &x, &y]);
    }

    /// A place in so many radii around the middle of the pad.
    fn place(&mut self, radii: f64) -> [f64; 2] {
        let [x, y, radius] = self.pad;
        let mut offset = || (self.random.below(201) as f64 / 100.0 - 1.0) * radius * radii;
        [(x + offset()).max(1.0), (y + offset()).max(1.0)]
    }

    /// A press, a way that may lead beyond the pad, and the release, which comes wherever the pointer is then.
    async fn gesture(&mut self) {
        let start = self.place(0.7);
        self.move_to(start);
        self.screen.hand(&["mousedown", "1"]);
        for _ in 0..self.random.below(4) + 1 {
            let place = self.place(3.0);
            self.move_to(place);
        }
        sleep(Duration::from_millis(self.random.below(120))).await;
        self.screen.hand(&["mouseup", "1"]);
    }

    /// The pointer hovers over the pad with no button pressed; gives the motions that were asked for meanwhile.
    async fn hover(&mut self) -> String {
        for _ in 0..3 {
            let place = self.place(0.9);
            self.move_to(place);
        }
        self.wire.text(MOTIONS_SINCE).await
    }

    /// Finds out where the page lies, by what it sees of the pointer.
    async fn find_page(&mut self) {
        self.wire.text(NOTE_POINTER).await;
        let deadline = Instant::now() + PATIENCE;
        loop {
            self.move_to([TRIED[0] - 3.0, TRIED[1]]);
            self.move_to(TRIED);
            sleep(LOOK_EVERY).await;
            let seen = self.wire.text("return JSON.stringify(window.seen ?? null)").await;
            if let Ok(Some([x, y])) = serde_json::from_str::<Option<[f64; 2]>>(&seen) {
                self.origin = [TRIED[0] - x, TRIED[1] - y];
                return;
            }
            assert!(Instant::now() < deadline, "the page sees no pointer");
        }
    }
}

async fn random_gestures(engine: Engine) {
    if std::env::var_os("RVAC_ENGINES").is_none() {
        println!("skipped: RVAC_ENGINES is not set");
        return;
    }
    let _turn = turn(Company::None).await;
    let (stack, screen, folder) = (Stack::start(), HiddenScreen::start(), Folder::new());
    let (mut wire, _running) = match engine {
        Engine::Firefox => firefox(&screen, &folder).await,
        Engine::WebKit => webkit(&screen).await,
    };
    wire.open(&stack.address).await;
    stack.hand(OFF_DOCK);
    assert!(wire.until(IS_READY, PATIENCE).await, "nobody can drive");
    assert_eq!(
        wire.text(MODULES_ASKED_FOR).await,
        "1",
        "each of the large files comes once"
    );
    wire.text(COUNT_MOTIONS).await;
    let pad = serde_json::from_str(&wire.text(WHERE_IS_THE_PAD).await).unwrap();
    let mut hand = Hand {
        screen: &screen,
        wire: &mut wire,
        random: Random(SEED),
        origin: [0.0; 2],
        pad,
    };
    hand.find_page().await;
    let mut wrong = 0;
    for _ in 0..count() {
        hand.gesture().await;
        wrong += u32::from(hand.hover().await != "0");
    }
    let motions: u32 = hand
        .wire
        .text("return String(window.motions)")
        .await
        .parse()
        .unwrap();
    judge(&format!("{engine:?}"), wrong, motions);
}

#[tokio::test]
async fn random_gestures_move_nothing_in_firefox() {
    random_gestures(Engine::Firefox).await;
}

#[tokio::test]
async fn random_gestures_move_nothing_in_webkit() {
    random_gestures(Engine::WebKit).await;
}
