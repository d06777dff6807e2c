//! The server as a process, and connections to it.

use std::fmt;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context, bail};
use pairing::console::{Order, Reply, Trust};
use pairing::wire::{Begin, Greeting, Session};
use pairing::{Code, DeviceName, Ends, Guest, Role};
use rustix::net::{AddressFamily, SocketType, bind, connect, socket};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, ServerName};
use rustls::{ClientConfig, ClientConnection, RootCertStore, StreamOwned};
use tungstenite::client::IntoClientRequest as _;
use tungstenite::{Message, WebSocket};
use vthal_bench::{Daemon, Scratch, needed_beside};

use crate::http;

/// For one answer.
pub const PATIENCE: Duration = Duration::from_secs(10);

/// A connection, with TLS or without.
pub trait Stream: Read + Write + Send {}

impl<T: Read + Write + Send> Stream for T {}

/// A connection whose handshake is over.
pub type Tls = StreamOwned<ClientConnection, TcpStream>;

/// One server.
#[derive(Debug)]
pub struct Door {
    server: Daemon,
    address: SocketAddr,
    /// As in the header `Host`.
    host: String,
    /// None without a gate.
    gate: Option<Gate>,
}

/// What lets a paired device in.
struct Gate {
    config: Arc<ClientConfig>,
    name: ServerName<'static>,
    robot: String,
    console: PathBuf,
    owner: Caller,
}

impl fmt::Debug for Gate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Gate").field("name", &self.name).finish()
    }
}

/// Who calls.
#[derive(Clone, Debug, Default)]
pub struct Caller {
    /// This computer's usual address when absent.
    pub from: Option<Ipv4Addr>,
    /// None of a stranger.
    pub token: Option<String>,
}

impl Door {
    /// Starts a server before the daemon of `scratch`; a guarded one keeps its identity below the same folder. Its page is in the
    /// folder `page`, to which files may have been added.
    ///
    /// # Errors
    /// It does not start, or does not let the bench in.
    pub fn start(scratch: &Scratch, is_guarded: bool) -> anyhow::Result<Self> {
        let program = needed_beside("panel-server")?;
        let (page, state) = (scratch.join("page"), scratch.join("panel"));
        std::fs::create_dir_all(&page)?;
        std::fs::write(page.join("index.html"), "<!doctype html><title>x</title>")?;
        let mut command = Command::new(program);
        command.arg("--vthal").arg(scratch.join("vthal.sock"));
        command.args(["--port", "0", "--assets"]).arg(page);
        if is_guarded {
            command.arg("--state").arg(&state);
        }
        let server = Daemon::start_command(command)?;
        let address = address_of(server.ready_line())?;
        let mut door = Self {
            server,
            address,
            host: address.to_string(),
            gate: None,
        };
        if is_guarded {
            door.pair(state.join("console.sock"))?;
        }
        Ok(door)
    }

    /// Its process number.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.server.id()
    }

    fn pair(&mut self, console: PathBuf) -> anyhow::Result<()> {
        let Reply::Trust(trust) = tell(&console, &Order::Trust)? else {
            bail!("the console does not tell whom to trust");
        };
        let token = add(&console, "bench", Role::Admin)?;
        self.host = format!("{}:{}", trust.host_name, self.address.port());
        self.gate = Some(Gate {
            config: trusting(&trust)?,
            robot: trust.robot.clone(),
            name: ServerName::try_from(trust.host_name)?,
            console,
            owner: Caller {
                from: None,
                token: Some(token),
            },
        });
        Ok(())
    }

    /// The bench itself, which may do everything.
    #[must_use]
    pub fn owner(&self) -> Caller {
        self.gate
            .as_ref()
            .map_or_else(Caller::default, |gate| gate.owner.clone())
    }

    /// Lets one more device in, and gives its token.
    ///
    /// # Errors
    /// The server has no gate, or its console refuses.
    pub fn add(&self, name: &str, role: Role) -> anyhow::Result<String> {
        add(&self.gate()?.console, name, role)
    }

    /// Opens a window for a new device.
    ///
    /// # Errors
    /// The server has no gate, or its console refuses.
    pub fn open_window(&self) -> anyhow::Result<()> {
        match tell(&self.gate()?.console, &Order::Pair { role: Role::View })? {
            Reply::Opened(_) => Ok(()),
            other => bail!("the console opens no window: {other:?}"),
        }
    }

    /// The request of somebody who guesses the code of the open window.
    ///
    /// # Errors
    /// The server has no gate.
    pub fn guess(&self, random: [u8; 64]) -> anyhow::Result<String> {
        let name = DeviceName::new("guess")?;
        let ends = Ends {
            guest: &name,
            robot: &self.gate()?.robot,
        };
        let code = Code::from_random([random[0]; 8]);
        let (_, message) = Guest::begin(&code, ends, random);
        let begin = Begin {
            name: name.clone(),
            message,
        };
        Ok(self.post("/api/pairing/begin", &serde_json::to_string(&begin)?))
    }

    fn gate(&self) -> anyhow::Result<&Gate> {
        self.gate.as_ref().context("a server without a gate")
    }

    /// A new connection, whose reads wait long.
    ///
    /// # Errors
    /// The server does not take it.
    pub fn connect(&self, caller: &Caller) -> anyhow::Result<Box<dyn Stream>> {
        self.over(self.dial(caller, PATIENCE)?)
    }

    /// A new connection without TLS; reads and writes wait for so long.
    ///
    /// # Errors
    /// The server does not take it.
    pub fn dial(&self, caller: &Caller, patience: Duration) -> anyhow::Result<TcpStream> {
        let line = socket(AddressFamily::INET, SocketType::STREAM, None)?;
        if let Some(from) = caller.from {
            bind(&line, &SocketAddr::from((from, 0)))?;
        }
        connect(&line, &self.address)?;
        let stream = TcpStream::from(line);
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(patience))?;
        stream.set_write_timeout(Some(patience))?;
        Ok(stream)
    }

    /// The same with TLS, whose handshake is over.
    ///
    /// # Errors
    /// The server does not take it, or has no gate.
    pub fn shake_hands(&self, caller: &Caller, patience: Duration) -> anyhow::Result<Tls> {
        let mut stream = self.dial(caller, patience)?;
        let mut connection = self.connection(self.gate()?)?;
        while connection.is_handshaking() {
            connection.complete_io(&mut stream)?;
        }
        Ok(StreamOwned::new(connection, stream))
    }

    /// What a client says first.
    ///
    /// # Errors
    /// The server has no gate.
    pub fn client_hello(&self) -> anyhow::Result<Vec<u8>> {
        let mut hello = Vec::new();
        self.connection(self.gate()?)?.write_tls(&mut hello)?;
        Ok(hello)
    }

    fn connection(&self, gate: &Gate) -> anyhow::Result<ClientConnection> {
        Ok(ClientConnection::new(
            Arc::clone(&gate.config),
            gate.name.clone(),
        )?)
    }

    fn over(&self, stream: TcpStream) -> anyhow::Result<Box<dyn Stream>> {
        let Some(gate) = &self.gate else {
            return Ok(Box::new(stream));
        };
        Ok(Box::new(StreamOwned::new(self.connection(gate)?, stream)))
    }

    /// The lines of the head that let a request of this caller in.
    #[must_use]
    pub fn headers(&self, caller: &Caller) -> String {
        let mut lines = format!("Host: {}\r\n", self.host);
        if let Some(token) = &caller.token {
            lines += &format!("Authorization: Bearer {token}\r\n");
        }
        lines
    }

    /// The lines of the head of a change, with its body.
    #[must_use]
    pub fn post(&self, path: &str, body: &str) -> String {
        let (host, length) = (&self.host, body.len());
        format!(
            "POST {path} HTTP/1.1\r\nHost: {host}\r\nOrigin: https://{host}\r\nContent-Type: application/json\r\nX-Rvac: 1\r\n\
             Content-Length: {length}\r\n\r\n{body}"
        )
    }

    /// A new WebSocket of a paired client, opened as a page does it; gives its line beside it, by which its time of waiting is set.
    ///
    /// # Errors
    /// The server does not let it in in so much time for each step.
    pub fn open_socket(
        &self,
        caller: &Caller,
        patience: Duration,
    ) -> anyhow::Result<(WebSocket<Box<dyn Stream>>, TcpStream)> {
        let scheme = if self.gate.is_some() { "s" } else { "" };
        let mut request = format!("ws{scheme}://{}/api/ws", self.host).into_client_request()?;
        let origin = format!("http{scheme}://{}", self.host);
        request.headers_mut().insert("origin", origin.parse()?);
        if let Some(token) = &caller.token {
            let bearer = format!("Bearer {token}");
            request.headers_mut().insert("authorization", bearer.parse()?);
        }
        let line = self.dial(caller, patience)?;
        let connection = self.over(line.try_clone()?)?;
        let (mut socket, _) =
            tungstenite::client(request, connection).map_err(|error| anyhow::anyhow!("{error}"))?;
        if self.gate.is_some() {
            let mut page = self.over(self.dial(caller, patience)?)?;
            let body = http::get(&mut page, "/api/session", &self.headers(caller))?;
            let session: Session = serde_json::from_slice(&body)?;
            let nonce = session.nonce.context("a paired device gets a nonce")?;
            socket.send(Message::text(serde_json::to_string(&Greeting { nonce })?))?;
        }
        Ok((socket, line))
    }
}

fn address_of(ready: &str) -> anyhow::Result<SocketAddr> {
    let address = ready
        .split("://")
        .nth(1)
        .map(|address| address.trim_end_matches('/'));
    let address = address.with_context(|| format!("no address in {ready:?}"))?;
    Ok(address.parse()?)
}

fn add(console: &Path, name: &str, role: Role) -> anyhow::Result<String> {
    let name = DeviceName::new(name)?;
    match tell(console, &Order::Add { name, role })? {
        Reply::Added { token } => Ok(token),
        _ => bail!("the console does not let the bench in"),
    }
}

fn trusting(trust: &Trust) -> anyhow::Result<Arc<ClientConfig>> {
    let mut roots = RootCertStore::empty();
    roots.add(CertificateDer::from_pem_slice(trust.pem.as_bytes())?)?;
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let mut config = ClientConfig::builder_with_provider(provider)
        .with_protocol_versions(&[&rustls::version::TLS13])?
        .with_root_certificates(roots)
        .with_no_client_auth();
    // Each handshake is one of somebody who was never here.
    config.resumption = rustls::client::Resumption::disabled();
    Ok(Arc::new(config))
}

fn tell(console: &Path, order: &Order) -> anyhow::Result<Reply> {
    let mut stream = UnixStream::connect(console)?;
    let mut line = serde_json::to_vec(order)?;
    line.push(b'\n');
    stream.write_all(&line)?;
    let mut answer = String::new();
    BufReader::new(stream).read_line(&mut answer)?;
    Ok(serde_json::from_str(&answer)?)
}
