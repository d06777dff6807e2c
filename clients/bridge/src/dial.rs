//! The way out: TCP or TLS to a host, by name, address or a name of multicast DNS; and one request over HTTP.

use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context as _, bail};
use mdns_sd::{HostnameResolutionEvent, ServiceDaemon};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
use rustls::{ClientConfig, RootCertStore};
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::net::{TcpStream, lookup_host};
use tokio::time::timeout;
use tokio_rustls::TlsConnector;

use crate::service::ConfigurationError;

/// A host of a home answers within this time, or not at all.
const PATIENCE: Duration = Duration::from_secs(8);
/// Of these one is asked for by multicast.
const LOCAL: &str = ".local";
/// Where Debian and others keep the authorities that all programs trust.
const SYSTEM_AUTHORITIES: &str = "/etc/ssl/certs/ca-certificates.crt";

/// Any way that bytes can go both ways on.
pub trait Stream: AsyncRead + AsyncWrite + Unpin + Send {}
impl<T: AsyncRead + AsyncWrite + Unpin + Send> Stream for T {}

/// Files of certificates; absent ones are those of the system, or none.
#[derive(Clone, Debug, Default)]
pub struct TlsFiles {
    /// PEM file of the authorities that may vouch for the host.
    pub ca: Option<PathBuf>,
    /// PEM files of this client's certificate and of its key.
    pub own: Option<(PathBuf, PathBuf)>,
}

/// A host, and how it is to be believed.
pub struct Dial {
    host: String,
    port: u16,
    tls: Option<TlsConnector>,
}

impl std::fmt::Debug for Dial {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(to, "{}:{}", self.host, self.port)
    }
}

impl Dial {
    /// A host that is spoken to in the clear.
    #[must_use]
    pub fn plain(host: &str, port: u16) -> Self {
        Self {
            host: host.to_owned(),
            port,
            tls: None,
        }
    }

    /// A host that is spoken to over TLS.
    ///
    /// # Errors
    /// [`ConfigurationError`] when a file cannot be used.
    pub fn secured(host: &str, port: u16, files: &TlsFiles) -> Result<Self, ConfigurationError> {
        let tls = tls(files).map_err(|error| ConfigurationError::Unfit(format!("{error:#}")))?;
        Ok(Self {
            tls: Some(TlsConnector::from(Arc::new(tls))),
            ..Self::plain(host, port)
        })
    }

    /// A new connection.
    ///
    /// # Errors
    /// Why there is none.
    pub async fn connect(&self) -> anyhow::Result<Box<dyn Stream>> {
        timeout(PATIENCE, self.connect_at_leisure())
            .await
            .unwrap_or_else(|_| bail!("it does not answer"))
    }

    async fn connect_at_leisure(&self) -> anyhow::Result<Box<dyn Stream>> {
        let mut last = None;
        for address in self.addresses().await? {
            match TcpStream::connect(address).await {
                Ok(stream) => {
                    stream.set_nodelay(true)?;
                    return self.handshake(stream).await;
                }
                Err(error) => last = Some(error),
            }
        }
        match last {
            Some(error) => Err(error.into()),
            None => bail!("there is no {}", self.host),
        }
    }

    async fn handshake(&self, stream: TcpStream) -> anyhow::Result<Box<dyn Stream>> {
        let Some(tls) = &self.tls else {
            return Ok(Box::new(stream));
        };
        let name = ServerName::try_from(self.host.clone()).context("the name of the host")?;
        Ok(Box::new(tls.connect(name, stream).await.context("TLS")?))
    }

    async fn addresses(&self) -> anyhow::Result<Vec<SocketAddr>> {
        let (host, port) = (self.host.as_str(), self.port);
        let found = lookup_host((host, port)).await;
        match found {
            Ok(addresses) => Ok(addresses.collect()),
            // Systems without a resolver for it know no names of multicast DNS.
            Err(_) if host.to_ascii_lowercase().ends_with(LOCAL) => heard_by_multicast(host, port).await,
            Err(error) => Err(error.into()),
        }
    }
}

async fn heard_by_multicast(host: &str, port: u16) -> anyhow::Result<Vec<SocketAddr>> {
    let name = format!("{host}.");
    // The responder has a thread of its own, and its channel no way to wait without blocking.
    let found = tokio::task::spawn_blocking(move || ask_multicast(&name)).await??;
    Ok(found
        .into_iter()
        .map(|address| SocketAddr::new(address, port))
        .collect())
}

fn ask_multicast(name: &str) -> Result<Vec<IpAddr>, mdns_sd::Error> {
    let responder = ServiceDaemon::new()?;
    let millis = u64::try_from(PATIENCE.as_millis() / 2).unwrap_or(4_000);
    let events = responder.resolve_hostname(name, Some(millis))?;
    let mut found = Vec::new();
    while let Ok(event) = events.recv() {
        match event {
            HostnameResolutionEvent::AddressesFound(_, addresses) => {
                found.extend(addresses.iter().map(mdns_sd::ScopedIp::to_ip_addr));
                break;
            }
            HostnameResolutionEvent::SearchTimeout(_) | HostnameResolutionEvent::SearchStopped(_) => break,
            _ => {}
        }
    }
    responder.shutdown().ok(); // It ends with the program at the latest.
    Ok(found)
}

fn tls(files: &TlsFiles) -> anyhow::Result<ClientConfig> {
    let mut roots = RootCertStore::empty();
    let file = files.ca.as_deref().unwrap_or(Path::new(SYSTEM_AUTHORITIES));
    for authority in certificates(file)? {
        roots
            .add(authority)
            .with_context(|| format!("{}", file.display()))?;
    }
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let builder = ClientConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()?
        .with_root_certificates(roots);
    let Some((certificate, key)) = &files.own else {
        return Ok(builder.with_no_client_auth());
    };
    let key_file = || format!("{}", key.display());
    let secret = PrivateKeyDer::from_pem_file(key).with_context(key_file)?;
    builder
        .with_client_auth_cert(certificates(certificate)?, secret)
        .with_context(key_file)
}

fn certificates(file: &Path) -> anyhow::Result<Vec<CertificateDer<'static>>> {
    let named = || format!("cannot read certificates from {}", file.display());
    let all: Result<Vec<_>, _> = CertificateDer::pem_file_iter(file).with_context(named)?.collect();
    let all = all.with_context(named)?;
    if all.is_empty() {
        bail!("there is no certificate in {}", file.display());
    }
    Ok(all)
}

/// An address of HTTP.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HttpPlace {
    host: String,
    port: u16,
    is_tls: bool,
    path: String,
}

/// A host and port as they stand in an address; `[...]` around an address of IPv6.
#[must_use]
pub fn host_and_port(text: &str, usual_port: u16) -> Option<(String, u16)> {
    let (host, port) = match text.strip_prefix('[') {
        Some(address) => {
            let (host, after) = address.split_once(']')?;
            let port = after.strip_prefix(':');
            (port.is_some() || after.is_empty()).then_some((host, port))?
        }
        None => match text.split_once(':') {
            Some((host, port)) => (host, Some(port)),
            None => (text, None),
        },
    };
    let port = match port {
        Some(port) => port.parse().ok()?,
        None => usual_port,
    };
    let fits = !host.is_empty()
        && host.len() <= 253
        && host
            .bytes()
            .all(|byte| byte.is_ascii_graphic() && !b"/@?#".contains(&byte));
    fits.then(|| (host.to_owned(), port))
}

impl HttpPlace {
    /// Reads `http://HOST[:PORT]/PATH` or `https://...`.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let (scheme, rest) = text.split_once("://")?;
        let (is_tls, usual_port) = match scheme {
            "http" => (false, 80),
            "https" => (true, 443),
            _ => return None,
        };
        let (authority, path) = rest.split_once('/').unwrap_or((rest, ""));
        let (host, port) = host_and_port(authority, usual_port)?;
        let is_path = path.bytes().all(|byte| byte.is_ascii_graphic());
        is_path.then(|| Self {
            host,
            port,
            is_tls,
            path: format!("/{path}"),
        })
    }
}

/// Sends a body once; gives the code of the answer.
///
/// # Errors
/// Why there is no answer.
pub async fn post(place: &HttpPlace, headers: &[(&str, &str)], body: &[u8]) -> anyhow::Result<u16> {
    let dial = if place.is_tls {
        Dial::secured(&place.host, place.port, &TlsFiles::default())?
    } else {
        Dial::plain(&place.host, place.port)
    };
    let mut stream = dial.connect().await?;
    let host = if place.host.contains(':') {
        format!("[{}]", place.host)
    } else {
        place.host.clone()
    };
    let more: String = headers
        .iter()
        .map(|(name, value)| format!("{name}: {value}\r\n"))
        .collect();
    let head = format!(
        "POST {} HTTP/1.1\r\nHost: {host}:{}\r\nConnection: close\r\nContent-Length: {}\r\n{more}\r\n",
        place.path,
        place.port,
        body.len()
    );
    stream.write_all(head.as_bytes()).await?;
    stream.write_all(body).await?;
    stream.flush().await?;
    let mut answer = Vec::new();
    // The first line is enough, and no server may fill the memory with more.
    stream.take(64).read_to_end(&mut answer).await?;
    let line = String::from_utf8_lossy(&answer).into_owned();
    let code = line.split(' ').nth(1).and_then(|code| code.parse().ok());
    code.with_context(|| format!("no answer of HTTP: {line:?}"))
}

#[cfg(test)]
mod tests {
    use super::HttpPlace;

    #[test]
    fn an_address_is_read_exactly() {
        let place = |host: &str, port, is_tls, path: &str| {
            Some(HttpPlace {
                host: host.to_owned(),
                port,
                is_tls,
                path: path.to_owned(),
            })
        };
        assert_eq!(
            HttpPlace::read("https://ntfy.sh/robot"),
            place("ntfy.sh", 443, true, "/robot")
        );
        assert_eq!(
            HttpPlace::read("http://[::1]:8123/api/x?y=1"),
            place("::1", 8123, false, "/api/x?y=1")
        );
        for wrong in [
            "ntfy.sh",
            "ftp://a/b",
            "http:///x",
            "http://a b/",
            "http://a/b\r\nX: y",
            "http://u@a/",
            "http://a:99999/",
        ] {
            assert_eq!(HttpPlace::read(wrong), None, "{wrong}");
        }
    }
}
