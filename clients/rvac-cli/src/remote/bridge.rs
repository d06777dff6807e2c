//! Messages between a robot's WebSocket and a socket like that of its daemon.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::os::unix::net::UnixStream;
use std::time::Duration;

use anyhow::Context as _;
use pairing::wire::Greeting;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rvac_api::SEPARATOR;
use tungstenite::client::IntoClientRequest as _;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket};

use super::Address;
use super::https::{Line, Tls};

/// What could not be sent is tried again after so long at the latest.
const TRY_AGAIN: Duration = Duration::from_millis(100);

/// A message longer than this is no message of ours.
const MESSAGE_BYTES_MAX: usize = 64 << 20;

/// Opens the WebSocket; gives the near end.
pub(super) fn build(line: Line, address: &Address, token: &str, nonce: &str) -> anyhow::Result<UnixStream> {
    let mut request = format!("wss://{}/api/ws", address.authority()).into_client_request()?;
    let headers = request.headers_mut();
    headers.insert("origin", address.origin().parse()?);
    headers.insert("authorization", format!("Bearer {token}").parse()?);
    let config = WebSocketConfig::default()
        .max_message_size(Some(MESSAGE_BYTES_MAX))
        .max_frame_size(Some(MESSAGE_BYTES_MAX));
    let (mut socket, _) = tungstenite::client::client_with_config(request, line.0, Some(config))
        .map_err(|error| anyhow::anyhow!("{error}"))
        .with_context(|| format!("{address} opens no connection to the daemon"))?;
    let nonce = nonce.to_owned();
    socket.send(Message::text(serde_json::to_string(&Greeting { nonce })?))?;
    let tcp: &TcpStream = &socket.get_ref().sock;
    tcp.set_nonblocking(true)?;
    let (near, far) = UnixStream::pair()?;
    let bridge = Bridge {
        socket,
        far,
        said: Vec::new(),
    };
    std::thread::spawn(move || bridge.carry());
    Ok(near)
}

struct Bridge {
    socket: WebSocket<Tls>,
    far: UnixStream,
    /// The beginning of a message of this program.
    said: Vec<u8>,
}

/// Why a bridge ends: one of its ends is gone, which the other one notices.
struct Ended;

impl Bridge {
    fn carry(mut self) {
        while self.turn().is_ok() {}
        // There is no one to report a failure to.
        self.socket.close(None).ok();
        self.socket.flush().ok();
    }

    fn turn(&mut self) -> Result<(), Ended> {
        self.carry_near()?;
        let pause = Timespec::try_from(TRY_AGAIN).map_err(|_| Ended)?;
        let mut ends = [
            PollFd::new(&self.socket.get_ref().sock, PollFlags::IN),
            PollFd::new(&self.far, PollFlags::IN),
        ];
        let waits = !matches!(poll(&mut ends, Some(&pause)), Ok(0) | Err(_));
        let [_, near] = &ends;
        if waits && !near.revents().is_empty() {
            self.carry_far()?;
        }
        match self.socket.flush() {
            Err(error) if !is_pause(&error) => Err(Ended),
            _ => Ok(()),
        }
    }

    /// What the robot says.
    fn carry_near(&mut self) -> Result<(), Ended> {
        loop {
            match self.socket.read() {
                Ok(Message::Text(text)) => {
                    let mut bytes = text.as_bytes().to_vec();
                    bytes.push(SEPARATOR);
                    self.far.write_all(&bytes).map_err(|_| Ended)?;
                }
                Ok(Message::Close(_)) => return Err(Ended),
                Ok(_) => {}
                Err(error) if is_pause(&error) => return Ok(()),
                Err(_) => return Err(Ended),
            }
        }
    }

    /// What this program says.
    fn carry_far(&mut self) -> Result<(), Ended> {
        let mut chunk = [0; 16_384];
        let count = match self.far.read(&mut chunk) {
            Ok(0) | Err(_) => return Err(Ended),
            Ok(count) => count,
        };
        self.said
            .extend_from_slice(chunk.get(..count).unwrap_or_default());
        while let Some(end) = self.said.iter().position(|byte| *byte == SEPARATOR) {
            let rest = self.said.split_off(end + 1);
            let mut message = std::mem::replace(&mut self.said, rest);
            message.truncate(end);
            let text = String::from_utf8(message).map_err(|_| Ended)?;
            match self.socket.send(Message::text(text)) {
                Err(error) if !is_pause(&error) => return Err(Ended),
                _ => {}
            }
        }
        Ok(())
    }
}

/// Nothing is there yet, or there is no room yet: the message is kept.
fn is_pause(error: &Error) -> bool {
    matches!(error, Error::Io(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted))
}
