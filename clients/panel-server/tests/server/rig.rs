//! A real server on a free port in front of a Unix socket that the test answers.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;

use futures_util::{SinkExt, StreamExt};
use panel_server::{Server, Settings};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpStream, UnixListener};
use tokio::time::timeout;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::{Error, Message};

use crate::folder::Folder;
pub(crate) use daemon::{DEADLINE, Daemon};

#[path = "../daemon/mod.rs"]
mod daemon;

/// A folder with a packed panel of two small files.
pub(crate) fn assets() -> Folder {
    let folder = Folder::new();
    std::fs::write(folder.join("index.html"), "<!doctype html><title>x</title>").unwrap();
    std::fs::write(folder.join("boot-1.js"), "export {}").unwrap();
    std::fs::write(folder.join("boot-1.js.gz"), "packed").unwrap();
    folder
}

/// Settings for loopback and any free port.
pub(crate) fn settings(folder: &Path) -> Settings {
    Settings {
        vthal: folder.join("vthal.sock"),
        simulator: None,
        matter: None,
        address: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
        guard: None,
        assets: folder.to_owned(),
        host_names: vec!["robot.local".to_owned()],
    }
}

/// A server and the socket where vthal would be.
#[derive(Debug)]
pub(crate) struct Rig {
    pub(crate) address: SocketAddr,
    pub(crate) vthal: UnixListener,
    pub(crate) folder: Folder,
}

impl Rig {
    pub(crate) async fn start() -> Self {
        let folder = assets();
        let vthal = UnixListener::bind(folder.join("vthal.sock")).unwrap();
        let server = Server::bind(settings(&folder)).await.unwrap();
        let address = server.address();
        tokio::spawn(server.run());
        Self {
            address,
            vthal,
            folder,
        }
    }

    /// Sends a request with `PORT` replaced and gives the whole answer.
    pub(crate) async fn raw(&self, request: &str) -> String {
        let mut stream = TcpStream::connect(self.address).await.unwrap();
        let request = request.replace("PORT", &self.address.port().to_string());
        stream.write_all(request.as_bytes()).await.unwrap();
        let mut answer = Vec::new();
        timeout(DEADLINE, stream.read_to_end(&mut answer))
            .await
            .expect("an answer in time")
            .ok();
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// The status of a WebSocket upgrade with these header lines beside the usual ones.
    pub(crate) async fn upgrade(&self, lines: &str) -> String {
        let lines = lines.replace("PORT", &self.address.port().to_string());
        let request = format!(
            "GET /api/ws HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
             Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n{lines}\r\n"
        );
        let mut stream = TcpStream::connect(self.address).await.unwrap();
        stream.write_all(request.as_bytes()).await.unwrap();
        let mut begin = [0; 12];
        timeout(DEADLINE, stream.read_exact(&mut begin))
            .await
            .expect("an answer in time")
            .unwrap();
        String::from_utf8_lossy(&begin[9..]).into_owned()
    }

    /// A browser on our own page.
    pub(crate) async fn browser(&self) -> Browser {
        let mut request = format!("ws://{}/api/ws", self.address)
            .into_client_request()
            .unwrap();
        request
            .headers_mut()
            .insert("origin", format!("http://{}", self.address).parse().unwrap());
        let stream = TcpStream::connect(self.address).await.unwrap();
        let (socket, _) = tokio_tungstenite::client_async(request, stream).await.unwrap();
        Browser(socket)
    }

    /// The connection on vthal's side.
    pub(crate) async fn accept(&self) -> Daemon {
        Daemon::accept(&self.vthal).await
    }
}

/// The browser's end.
#[derive(Debug)]
pub(crate) struct Browser(pub(crate) WebSocketStream<TcpStream>);

impl Browser {
    pub(crate) async fn say(&mut self, text: &str) {
        self.0.send(Message::text(text)).await.unwrap();
    }

    /// The next text.
    pub(crate) async fn hear(&mut self) -> String {
        loop {
            match timeout(DEADLINE, self.0.next())
                .await
                .expect("a message in time")
                .unwrap()
                .unwrap()
            {
                Message::Text(text) => return text.as_str().to_owned(),
                Message::Ping(_) | Message::Pong(_) => {}
                other => panic!("{other:?}"),
            }
        }
    }

    /// Waits until the server ends the connection.
    pub(crate) async fn until_dropped(&mut self) {
        loop {
            match timeout(DEADLINE, self.0.next()).await.expect("an end in time") {
                None
                | Some(
                    Err(Error::ConnectionClosed | Error::Protocol(_) | Error::Io(_)) | Ok(Message::Close(_)),
                ) => return,
                Some(_) => {}
            }
        }
    }
}
