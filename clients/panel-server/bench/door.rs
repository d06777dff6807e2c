//! The server as a process, and connections to it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use anyhow::{Context, bail};
use pairing::console::{Order, Reply, Trust};
use pairing::wire::{Greeting, Session};
use pairing::{DeviceName, Role};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, ServerName};
use rustls::{ClientConfig, ClientConnection, RootCertStore, StreamOwned};
use tungstenite::client::IntoClientRequest as _;
use tungstenite::{Message, WebSocket};
use vthal_bench::{Daemon, Scratch, needed_beside};

use crate::http;
use crate::peer::{LOOK, PATIENCE};

/// A connection, with TLS or without.
pub(crate) trait Stream: Read + Write + Send {}

impl<T: Read + Write + Send> Stream for T {}

/// One server.
pub(crate) struct Door {
    server: Daemon,
    address: SocketAddr,
    /// As in the header `Host`.
    host: String,
    /// None without a gate.
    pass: Option<Pass>,
}

/// What a paired device has.
struct Pass {
    config: Arc<ClientConfig>,
    name: ServerName<'static>,
    token: String,
}

impl Door {
    /// Starts a server before the daemon of `scratch`; a guarded one keeps its identity below the same folder.
    pub(crate) fn start(scratch: &Scratch, is_guarded: bool) -> anyhow::Result<Self> {
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
            pass: None,
        };
        if is_guarded {
            door.pair(&state.join("console.sock"))?;
        }
        Ok(door)
    }

    /// Its process number.
    pub(crate) fn id(&self) -> u32 {
        self.server.id()
    }

    fn pair(&mut self, console: &Path) -> anyhow::Result<()> {
        let Reply::Trust(trust) = tell(console, &Order::Trust)? else {
            bail!("the console does not tell whom to trust");
        };
        let add = Order::Add {
            name: DeviceName::new("bench")?,
            role: Role::Admin,
        };
        let Reply::Added { token } = tell(console, &add)? else {
            bail!("the console does not let the bench in");
        };
        self.host = format!("{}:{}", trust.host_name, self.address.port());
        self.pass = Some(Pass {
            config: trusting(&trust)?,
            name: ServerName::try_from(trust.host_name)?,
            token,
        });
        Ok(())
    }

    /// A new connection, whose reads wait long.
    pub(crate) fn connect(&self) -> anyhow::Result<Box<dyn Stream>> {
        self.over(self.dial()?)
    }

    fn dial(&self) -> anyhow::Result<TcpStream> {
        let stream = TcpStream::connect(self.address)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        Ok(stream)
    }

    fn over(&self, stream: TcpStream) -> anyhow::Result<Box<dyn Stream>> {
        let Some(pass) = &self.pass else {
            return Ok(Box::new(stream));
        };
        let connection = ClientConnection::new(Arc::clone(&pass.config), pass.name.clone())?;
        Ok(Box::new(StreamOwned::new(connection, stream)))
    }

    /// The lines of the head that let a request in.
    pub(crate) fn headers(&self) -> String {
        let mut lines = format!("Host: {}\r\n", self.host);
        if let Some(pass) = &self.pass {
            lines += &format!("Authorization: Bearer {}\r\n", pass.token);
        }
        lines
    }

    /// A new WebSocket of a paired client, whose reads wait for one polling period.
    pub(crate) fn open_socket(&self) -> anyhow::Result<WebSocket<Box<dyn Stream>>> {
        let scheme = if self.pass.is_some() { "s" } else { "" };
        let mut request = format!("ws{scheme}://{}/api/ws", self.host).into_client_request()?;
        let origin = format!("http{scheme}://{}", self.host);
        request.headers_mut().insert("origin", origin.parse()?);
        if let Some(pass) = &self.pass {
            let bearer = format!("Bearer {}", pass.token);
            request.headers_mut().insert("authorization", bearer.parse()?);
        }
        let line = self.dial()?;
        let connection = self.over(line.try_clone()?)?;
        let (mut socket, _) =
            tungstenite::client(request, connection).map_err(|error| anyhow::anyhow!("{error}"))?;
        if self.pass.is_some() {
            let body = http::get(&mut self.connect()?, "/api/session", &self.headers())?;
            let session: Session = serde_json::from_slice(&body)?;
            let nonce = session.nonce.context("a paired device gets a nonce")?;
            socket.send(Message::text(serde_json::to_string(&Greeting { nonce })?))?;
        }
        line.set_read_timeout(Some(LOOK))?;
        Ok(socket)
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

fn trusting(trust: &Trust) -> anyhow::Result<Arc<ClientConfig>> {
    let mut roots = RootCertStore::empty();
    roots.add(CertificateDer::from_pem_slice(trust.pem.as_bytes())?)?;
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = ClientConfig::builder_with_provider(provider)
        .with_protocol_versions(&[&rustls::version::TLS13])?
        .with_root_certificates(roots)
        .with_no_client_auth();
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
