//! A guarded server on a free port, spoken to over TLS by clients that trust its authority and by some that do not.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use futures_util::{SinkExt as _, StreamExt as _};
use pairing::console::{Order, Reply, Trust};
use pairing::wire::{AskMatched, Begin, Begun, Finish, Invitation, Join, Joined, Session};
use pairing::{Code, DeviceName, Ends, Guest, Pattern, Role};
use panel_server::{Guard, Server, Settings};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, ServerName};
use rustls::{ClientConfig, RootCertStore};
use serde::Serialize;
use tokio::io::{AsyncBufReadExt as _, AsyncReadExt as _, AsyncWriteExt as _, BufReader};
use tokio::net::{TcpStream, UnixListener, UnixStream};
use tokio::time::timeout;
use tokio_rustls::TlsConnector;
use tokio_rustls::client::TlsStream;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;

use crate::folder::Folder;
pub(crate) use daemon::{DEADLINE, Daemon};

#[path = "../daemon/mod.rs"]
mod daemon;

/// What a request was answered.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: String,
}

impl Answer {
    fn parse(text: &str) -> Self {
        let (head, body) = text.split_once("\r\n\r\n").unwrap_or((text, ""));
        let status = head
            .get(9..12)
            .and_then(|status| status.parse().ok())
            .unwrap_or(0);
        Self {
            status,
            head: head.to_ascii_lowercase(),
            body: body.to_owned(),
        }
    }

    /// The cookie that a browser would keep.
    pub(crate) fn cookie(&self) -> Option<String> {
        let line = self
            .head
            .lines()
            .find_map(|line| line.strip_prefix("set-cookie: "))?;
        let (pair, _) = line.split_once(';')?;
        Some(pair.replace("__host-rvac", "__Host-rvac"))
    }
}

/// A server with its folder; `vthal` is where the daemon would be.
#[derive(Debug)]
pub(crate) struct Rig {
    pub(crate) folder: Folder,
    pub(crate) address: SocketAddr,
    pub(crate) page: SocketAddr,
    pub(crate) vthal: UnixListener,
    /// The connection on which the server receives the robot's buttons.
    pub(crate) buttons: Daemon,
    pub(crate) trust: Trust,
    clock: fn() -> u64,
    server: tokio::task::JoinHandle<()>,
}

impl Drop for Rig {
    fn drop(&mut self) {
        self.server.abort();
    }
}

impl Rig {
    pub(crate) async fn start() -> Self {
        Self::start_at(panel_server::unix_s).await
    }

    /// On a board with this clock.
    pub(crate) async fn start_at(clock: fn() -> u64) -> Self {
        let folder = Folder::new();
        std::fs::write(folder.join("index.html"), "<!doctype html><title>x</title>").unwrap();
        let vthal = UnixListener::bind(folder.join("vthal.sock")).unwrap();
        let (server, address, page) = serve(&folder, clock).await;
        let buttons = ears(&vthal).await;
        let trust = match console(&folder, &Order::Trust).await {
            Reply::Trust(trust) => trust,
            other => panic!("{other:?}"),
        };
        Self {
            folder,
            address,
            page,
            vthal,
            buttons,
            trust,
            clock,
            server,
        }
    }

    /// The server is killed and started again on what it has written.
    pub(crate) async fn restart(&mut self) {
        self.server.abort();
        (&mut self.server).await.ok();
        (self.server, self.address, self.page) = serve(&self.folder, self.clock).await;
        self.buttons = ears(&self.vthal).await;
    }

    /// A person does something with the robot's buttons.
    pub(crate) async fn gesture(&mut self, gesture: &str) {
        let update = format!(r#"{{"e":"button","gesture":"{gesture}","button":0,"t":1.5}}"#);
        self.buttons.say(&update).await;
    }

    /// START is held until a window is open; gives the invitation.
    pub(crate) async fn hold_start(&mut self) -> Invitation {
        self.gesture("pairing-hold").await;
        loop {
            let invitation: Invitation =
                serde_json::from_str(&self.get("/api/pairing", "").await.body).unwrap();
            if invitation.open {
                return invitation;
            }
        }
    }

    /// A device asks for presses.
    pub(crate) async fn join(&self, name: &str) -> Result<Joined, Answer> {
        let name = DeviceName::new(name).unwrap();
        let answer = self.post("/api/pairing/match", "", &Join { name }).await;
        if answer.status != 200 {
            return Err(answer);
        }
        Ok(serde_json::from_str(&answer.body).unwrap())
    }

    /// START is pressed so often, with a pause between.
    pub(crate) async fn press(&mut self, pattern: Pattern) {
        let [first, second] = pattern;
        for (count, pause) in [(first, Duration::from_millis(1500)), (second, Duration::ZERO)] {
            for _ in 0..count {
                self.gesture("press").await;
            }
            tokio::time::sleep(pause).await;
        }
    }

    /// What becomes of a device that asked, when it is no longer waited for.
    pub(crate) async fn matched(&self, joined: &Joined) -> Answer {
        let session = joined.session;
        loop {
            let answer = self
                .post("/api/pairing/matched", "", &AskMatched { session })
                .await;
            if answer.status != 200 || answer.body.contains("role") {
                return answer;
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
    }

    /// As in the header `Host`.
    pub(crate) fn host(&self) -> String {
        format!("{}:{}", self.trust.host_name, self.address.port())
    }

    pub(crate) fn origin(&self) -> String {
        format!("https://{}", self.host())
    }

    pub(crate) async fn console(&self, order: &Order) -> Reply {
        console(&self.folder, order).await
    }

    /// A connection of a device that trusts the robot's authority.
    pub(crate) async fn tls(&self) -> TlsStream<TcpStream> {
        let authority = CertificateDer::from_pem_slice(self.trust.pem.as_bytes()).unwrap();
        self.tls_trusting(authority).await.unwrap()
    }

    pub(crate) async fn tls_trusting(
        &self,
        authority: CertificateDer<'static>,
    ) -> std::io::Result<TlsStream<TcpStream>> {
        self.tls_as(&self.trust.host_name, authority).await
    }

    pub(crate) async fn tls_as(
        &self,
        host_name: &str,
        authority: CertificateDer<'static>,
    ) -> std::io::Result<TlsStream<TcpStream>> {
        let mut roots = RootCertStore::empty();
        roots.add(authority).unwrap();
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let config = ClientConfig::builder_with_provider(provider)
            .with_protocol_versions(&[&rustls::version::TLS13])
            .unwrap()
            .with_root_certificates(roots)
            .with_no_client_auth();
        let name = ServerName::try_from(host_name.to_owned()).unwrap();
        let stream = TcpStream::connect(self.address).await?;
        TlsConnector::from(Arc::new(config)).connect(name, stream).await
    }

    /// Sends a file as an update, announced as so many bytes.
    pub(crate) async fn upload(&self, cookie: &str, file: &[u8], announced: u64) -> Answer {
        let (host, origin) = (self.host(), self.origin());
        let head = format!(
            "POST /api/update HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nContent-Type: application/octet-stream\r\n\
             X-Rvac: 1\r\nConnection: close\r\nContent-Length: {announced}\r\n{}\r\n",
            cookie_line(cookie)
        );
        let mut stream = self.tls().await;
        stream.write_all(head.as_bytes()).await.unwrap();
        // A server that refuses does not read the rest.
        stream.write_all(file).await.ok();
        if (file.len() as u64) < announced {
            stream.shutdown().await.ok();
        }
        Answer::parse(&read_all(&mut stream).await)
    }

    /// Sends a request unchanged.
    pub(crate) async fn raw(&self, request: &str) -> Answer {
        let mut stream = self.tls().await;
        stream.write_all(request.as_bytes()).await.unwrap();
        Answer::parse(&read_all(&mut stream).await)
    }

    /// A request of our own page, with these further header lines.
    pub(crate) async fn ask(&self, (method, path): (&str, &str), more: &str, body: &str) -> Answer {
        let (host, origin) = (self.host(), self.origin());
        self.raw(&format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nContent-Type: application/json\r\nX-Rvac: 1\r\n\
             Connection: close\r\nContent-Length: {}\r\n{more}\r\n{body}",
            body.len()
        ))
        .await
    }

    pub(crate) async fn get(&self, path: &str, cookie: &str) -> Answer {
        self.ask(("GET", path), &cookie_line(cookie), "").await
    }

    pub(crate) async fn post(&self, path: &str, cookie: &str, body: &impl Serialize) -> Answer {
        let body = serde_json::to_string(body).unwrap();
        self.ask(("POST", path), &cookie_line(cookie), &body).await
    }

    /// Opens a window at the console; gives the code.
    pub(crate) async fn open(&self, role: Role) -> Result<Code, String> {
        match self.console(&Order::Pair { role }).await {
            Reply::Opened(invitation) => Ok(Code::parse(&invitation.opened.code).unwrap()),
            Reply::Refused(refused) => Err(refused.reason),
            other => panic!("{other:?}"),
        }
    }

    /// The first half of pairing; gives the proof to show.
    pub(crate) async fn begin(&self, code: &Code, name: &str, random: u8) -> Result<Finish, Answer> {
        let name = DeviceName::new(name).unwrap();
        let ends = Ends {
            guest: &name,
            robot: &self.trust.robot,
        };
        let (guest, message) = Guest::begin(code, ends, [random; 64]);
        let begin = Begin {
            name: name.clone(),
            message,
        };
        let answer = self.post("/api/pairing/begin", "", &begin).await;
        if answer.status != 200 {
            return Err(answer);
        }
        let begun: Begun = serde_json::from_str(&answer.body).unwrap();
        let (_, proof) = guest.hear(&begun.message).unwrap();
        Ok(Finish {
            attempt: begun.attempt,
            proof,
        })
    }

    pub(crate) async fn finish(&self, finish: &Finish) -> Answer {
        self.post("/api/pairing/finish", "", finish).await
    }

    /// Lets a device in; gives its cookie.
    pub(crate) async fn pair(&self, role: Role) -> String {
        let code = self.open(role).await.unwrap();
        let finish = self.begin(&code, role.name(), 7).await.unwrap();
        self.finish(&finish).await.cookie().expect("a cookie")
    }

    pub(crate) async fn session(&self, cookie: &str) -> Session {
        let answer = self.get("/api/session", cookie).await;
        assert_eq!(answer.status, 200, "{answer:?}");
        serde_json::from_str(&answer.body).unwrap()
    }

    /// Opens a WebSocket and says the word that it needs.
    pub(crate) async fn socket(&self, cookie: &str) -> Socket {
        let nonce = self.session(cookie).await.nonce.unwrap();
        let mut socket = self.mute_socket(cookie).await;
        socket.say(&format!(r#"{{"nonce":"{nonce}"}}"#)).await;
        socket
    }

    /// Opens a WebSocket and says nothing.
    pub(crate) async fn mute_socket(&self, cookie: &str) -> Socket {
        let mut request = format!("wss://{}/api/ws", self.host())
            .into_client_request()
            .unwrap();
        let headers = request.headers_mut();
        headers.insert("origin", self.origin().parse().unwrap());
        headers.insert("cookie", cookie.parse().unwrap());
        let (socket, _) = tokio_tungstenite::client_async(request, self.tls().await)
            .await
            .unwrap();
        Socket(socket)
    }

    /// The connection that the daemon gets for the next WebSocket; connections that only beep are answered with patience.
    pub(crate) async fn daemon(&self) -> Daemon {
        Daemon::accept(&self.vthal).await
    }
}

fn cookie_line(cookie: &str) -> String {
    if cookie.is_empty() {
        return String::new();
    }
    format!("Cookie: {cookie}\r\n")
}

/// The connection of a server that has just begun to listen for the buttons; beeps of the one before may wait still.
async fn ears(vthal: &UnixListener) -> Daemon {
    loop {
        let mut daemon = Daemon::accept(vthal).await;
        let hello = daemon.hear().await;
        if hello.is_some_and(|hello| hello.contains("panel-server")) {
            assert_eq!(
                daemon.hear().await.unwrap(),
                r#"{"c":"watch","topics":["buttons"]}"#
            );
            return daemon;
        }
    }
}

async fn serve(
    folder: &std::path::Path,
    clock: fn() -> u64,
) -> (tokio::task::JoinHandle<()>, SocketAddr, SocketAddr) {
    let settings = Settings {
        vthal: folder.join("vthal.sock"),
        simulator: None,
        matter: Some(folder.join("matter.sock")),
        address: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
        guard: Some(Guard {
            state: folder.join("state"),
            console: None,
            card: Some(folder.join("card")),
            page_port: Some(0),
            announce: false,
            updates: folder.join("updates"),
            free_bytes: told_free_bytes,
            clock,
        }),
        assets: folder.to_owned(),
        host_names: Vec::new(),
    };
    let server = Server::bind(settings).await.unwrap();
    let (address, page) = (server.address(), server.page_address().unwrap());
    (tokio::spawn(server.run()), address, page)
}

/// What a file in the server's folder of updates says is free on its disk; a lot without one.
fn told_free_bytes(folder: &std::path::Path) -> std::io::Result<u64> {
    let told = std::fs::read_to_string(folder.join("free-bytes")).unwrap_or_default();
    Ok(told.parse().unwrap_or(1 << 40))
}

async fn console(folder: &std::path::Path, order: &Order) -> Reply {
    let mut stream = UnixStream::connect(folder.join("state/console.sock"))
        .await
        .unwrap();
    let mut line = serde_json::to_vec(order).unwrap();
    line.push(b'\n');
    stream.write_all(&line).await.unwrap();
    let mut answer = String::new();
    BufReader::new(stream).read_line(&mut answer).await.unwrap();
    serde_json::from_str(&answer).unwrap()
}

/// Everything until the end, however it comes.
pub(crate) async fn read_all(stream: &mut (impl tokio::io::AsyncRead + Unpin)) -> String {
    let mut bytes = Vec::new();
    timeout(DEADLINE, stream.read_to_end(&mut bytes))
        .await
        .expect("an answer in time")
        .ok();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The end of a browser.
#[derive(Debug)]
pub(crate) struct Socket(pub(crate) WebSocketStream<TlsStream<TcpStream>>);

impl Socket {
    pub(crate) async fn say(&mut self, text: &str) {
        self.0.send(Message::text(text)).await.unwrap();
    }

    /// The next text; none when the connection has ended.
    pub(crate) async fn hear(&mut self) -> Option<String> {
        loop {
            match timeout(DEADLINE, self.0.next())
                .await
                .expect("a message or an end in time")
            {
                Some(Ok(Message::Text(text))) => return Some(text.as_str().to_owned()),
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                Some(_) | None => return None,
            }
        }
    }

    /// Waits for the end and skips other messages.
    pub(crate) async fn until_ended(&mut self) {
        while self.hear().await.is_some() {}
    }
}
