//! A8 to A12 of the attack table, by real pages: what other sites can do with a robot in the browser of a person whom the robot
//! lets in as an administrator.

use crate::Visit;
use crate::browser::{Browser, Screen};
use crate::pairing::let_in;
use crate::stack::Stack;
use crate::stranger::{NAME, Stranger};
use crate::turns::Company;

/// Reads who may use the robot.
const READ: &str = "return fetch('ROBOT/api/clients', { credentials: 'include' })
    .then(answer => answer.text()).then(text => text.includes('[') ? 'read' : 'refused', () => 'refused')";

/// Opens the pairing window as the panel does it.
const OPEN: &str = "return fetch('ROBOT/api/pairing/open', {
        method: 'POST', credentials: 'include', body: '{\"role\":\"admin\"}',
        headers: { 'Content-Type': 'application/json', 'X-Rvac': '1' },
    }).then(answer => answer.ok ? 'opened' : 'refused', () => 'refused')";

/// The same as a request that browsers send to other sites without asking them first. What comes of it no page may see.
const OPEN_SIMPLY: &str = "return fetch('ROBOT/api/pairing/open', {
        method: 'POST', mode: 'no-cors', credentials: 'include', body: '{\"role\":\"admin\"}',
    }).then(() => 'sent', () => 'sent')";

/// The same by a form, which needs no script.
const OPEN_BY_FORM: &str = "return new Promise(done => {
        const frame = document.createElement('iframe');
        frame.name = 'answer';
        const form = document.createElement('form');
        Object.assign(form, { method: 'POST', action: 'ROBOT/api/pairing/open', enctype: 'text/plain', target: 'answer' });
        const field = document.createElement('input');
        Object.assign(field, { name: '{\"role\":\"admin\",\"x\":\"', value: '\"}' });
        form.append(field);
        document.body.append(frame, form);
        form.submit();
        setTimeout(() => done('sent'), 1000);
    })";

/// Speaks to the robot itself.
const SPEAK: &str = "return new Promise(done => {
        const socket = new WebSocket('ROBOT/api/ws'.replace('https', 'wss'));
        socket.onopen = () => done('speaks');
        socket.onerror = () => done('refused');
    })";

/// Tries `READ`, `OPEN` and `SPEAK` in a frame that has no origin.
const FROM_A_SANDBOX: &str = "return new Promise(done => {
        const inner = `Promise.all([(() => { READ })(), (() => { OPEN })(), (() => { SPEAK })()])
            .then(seen => parent.postMessage(seen.join(' '), '*'))`;
        addEventListener('message', event => done(event.data));
        const frame = document.createElement('iframe');
        frame.sandbox = 'allow-scripts';
        frame.srcdoc = '<script>' + inner + '</scr' + 'ipt>';
        document.body.append(frame);
    })";

/// Shows the panel in a frame, beneath something that invites a click.
const FRAME: &str = "document.body.innerHTML = '<iframe src=\"ROBOT/\"></iframe>';
    return new Promise(done => document.querySelector('iframe').onload = () => done('loaded'))";

/// Whether a pairing window is open, as the panel's own page receives it.
const IS_OPEN: &str =
    "return fetch('/api/pairing').then(answer => answer.json()).then(told => String(told.open))";

/// Everything that a page was able to do and should not.
#[derive(Debug)]
struct Attack<'a> {
    browser: &'a Browser,
    /// The robot's address without a slash at its end.
    robot: String,
    unexpected: Vec<String>,
}

impl Attack<'_> {
    async fn run(&self, script: &str) -> String {
        let script = script
            .replace("READ", READ)
            .replace("OPEN", OPEN)
            .replace("SPEAK", SPEAK)
            .replace("ROBOT", &self.robot);
        self.browser.text(&script).await
    }

    fn row(&mut self, (id, who): (&str, &str), what: &str, (expected, seen): (&str, &str)) {
        let line = format!("{id} {who}, {what}: expected {expected}, seen {seen}");
        println!("{line}");
        if expected != seen {
            self.unexpected.push(line);
        }
    }

    async fn try_script(&mut self, by: (&str, &str), (what, script): (&str, &str), expected: &str) {
        let seen = self.run(script).await;
        self.row(by, what, (expected, &seen));
    }

    /// All that a page of another site can try.
    async fn try_page(&mut self, by: (&str, &str), address: &str) {
        self.browser.goto(address).await;
        for tried in [
            ("reading", READ),
            ("opening the window", OPEN),
            ("a WebSocket", SPEAK),
        ] {
            self.try_script(by, tried, "refused").await;
        }
        self.try_script(by, ("a request without asking", OPEN_SIMPLY), "sent")
            .await;
        self.try_script(by, ("a form", OPEN_BY_FORM), "sent").await;
    }

    async fn try_sandbox(&mut self, address: &str) {
        self.browser.goto(address).await;
        let tried = ("reading, opening, a WebSocket", FROM_A_SANDBOX);
        self.try_script(("A11", "a sandboxed frame"), tried, "refused refused refused")
            .await;
    }

    /// The panel in a frame of another page; a page of the stranger's own shows that frames are seen.
    async fn in_frame(&mut self, address: &str) {
        for (what, shown, expected) in [
            (
                "its own page",
                address.trim_end_matches('/').to_owned(),
                "A stranger",
            ),
            ("the panel", self.robot.clone(), "nothing of it"),
        ] {
            self.browser.goto(address).await;
            self.browser.text(&FRAME.replace("ROBOT", &shown)).await;
            let title = self.browser.title_in_frame().await;
            let seen = match title.as_str() {
                "A stranger" => "A stranger",
                title if title.contains("LibreRVAC") => "the panel",
                _ => "nothing of it",
            };
            self.row(("A12", "a frame in a stranger's page"), what, (expected, seen));
        }
    }

    /// A name that its owner has pointed at the robot.
    async fn by_another_name(&mut self, port: &str) {
        self.browser.goto(&format!("https://{NAME}:{port}/")).await;
        let status = "return String(performance.getEntriesByType('navigation')[0].responseStatus)";
        let seen = format!(
            "{}, {} cookies",
            self.browser.text(status).await,
            self.browser.cookies().await
        );
        let expected = ("421, 0 cookies", seen.as_str());
        self.row(
            ("A10", "a name that was pointed to the robot"),
            "its page",
            expected,
        );
    }

    /// The panel's own page can do all of it: what was refused was refused to strangers, and what was sent came to nothing.
    async fn try_own_page(&mut self) {
        let own = ("A8", "the panel itself");
        self.browser.goto(&format!("{}/", self.robot)).await;
        self.try_script(own, ("a window that a stranger opened", IS_OPEN), "false")
            .await;
        self.try_script(own, ("reading", READ), "read").await;
        self.try_script(own, ("a WebSocket", SPEAK), "speaks").await;
        self.try_script(own, ("opening the window", OPEN), "opened").await;
        self.try_script(own, ("the window", IS_OPEN), "true").await;
    }
}

#[tokio::test]
async fn pages_of_other_sites_can_do_nothing_to_a_robot() {
    let Some(visit) = Visit::at_the_door(Stack::start_guarded, Screen::Desktop, Company::Others).await else {
        return;
    };
    let (browser, stack) = (&visit.browser, &visit.stack);
    let_in(browser, stack, "admin").await;
    let robot = stack.address.trim_end_matches('/').to_owned();
    let (host, port) = robot.rsplit_once(':').unwrap();
    let (host, port) = (host.trim_start_matches("https://").to_owned(), port.to_owned());
    let mut attack = Attack {
        browser,
        robot,
        unexpected: Vec::new(),
    };
    let stranger = Stranger::start().await;
    let elsewhere = format!("https://{NAME}:{}/", stranger.port);
    attack.try_page(("A8", "another site"), &elsewhere).await;
    let beside = format!("https://{host}:{}/", stranger.port);
    attack
        .try_page(("A9", "the same host at another port"), &beside)
        .await;
    let file = stack.folder().join("stranger.html");
    std::fs::write(&file, "<!doctype html><title>A stranger</title>").unwrap();
    let file = format!("file://{}", file.display());
    attack.try_page(("A11", "a file"), &file).await;
    attack.try_sandbox(&beside).await;
    attack.in_frame(&beside).await;
    attack.by_another_name(&port).await;
    attack.try_own_page().await;
    assert!(attack.unexpected.is_empty(), "{:#?}", attack.unexpected);
}
