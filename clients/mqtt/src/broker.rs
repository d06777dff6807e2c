//! The way to the broker: TCP or TLS, by name, address or a name of multicast DNS.

use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context as _, bail};
use bridge::service::ConfigurationError;
use mdns_sd::{HostnameResolutionEvent, ServiceDaemon};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
use rustls::{ClientConfig, RootCertStore};
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpStream, lookup_host};
use tokio::time::timeout;
use tokio_rustls::TlsConnector;

use crate::configuration::{BrokerPlace, Configuration};

/// A broker of a home answers within this time, or not at all.
const PATIENCE: Duration = Duration::from_secs(8);
/// Of these one is asked for by multicast.
const LOCAL: &str = ".local";
/// Where Debian and others keep the authorities that all programs trust.
const SYSTEM_AUTHORITIES: &str = "/etc/ssl/certs/ca-certificates.crt";

/// Any way that bytes can go both ways on.
pub(crate) trait Stream: AsyncRead + AsyncWrite + Unpin + Send {}
impl<T: AsyncRead + AsyncWrite + Unpin + Send> Stream for T {}

/// Where the broker is, and how it is to be believed.
pub(crate) struct Broker {
    place: BrokerPlace,
    tls: Option<TlsConnector>,
}

impl Broker {
    /// Reads certificates.
    pub(crate) fn new(configuration: &Configuration) -> anyhow::Result<Self> {
        let place = configuration.check()?;
        let tls = if place.is_tls {
            Some(TlsConnector::from(Arc::new(tls(configuration).map_err(unfit)?)))
        } else {
            None
        };
        Ok(Self { place, tls })
    }

    /// A new connection.
    pub(crate) async fn connect(&self) -> anyhow::Result<Box<dyn Stream>> {
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
                    return self.secured(stream).await;
                }
                Err(error) => last = Some(error),
            }
        }
        match last {
            Some(error) => Err(error.into()),
            None => bail!("there is no {}", self.place.host),
        }
    }

    async fn secured(&self, stream: TcpStream) -> anyhow::Result<Box<dyn Stream>> {
        let Some(tls) = &self.tls else {
            return Ok(Box::new(stream));
        };
        let name = ServerName::try_from(self.place.host.clone()).context("the broker's name")?;
        Ok(Box::new(tls.connect(name, stream).await.context("TLS")?))
    }

    async fn addresses(&self) -> anyhow::Result<Vec<SocketAddr>> {
        let (host, port) = (self.place.host.as_str(), self.place.port);
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

fn unfit(error: anyhow::Error) -> ConfigurationError {
    ConfigurationError::Unfit(format!("{error:#}"))
}

fn tls(configuration: &Configuration) -> anyhow::Result<ClientConfig> {
    let mut roots = RootCertStore::empty();
    let file = configuration
        .ca
        .as_deref()
        .unwrap_or(Path::new(SYSTEM_AUTHORITIES));
    for authority in certificates(file)? {
        roots
            .add(authority)
            .with_context(|| format!("{}", file.display()))?;
    }
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let builder = ClientConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()?
        .with_root_certificates(roots);
    let (Some(certificate), Some(key)) = (&configuration.certificate, &configuration.key) else {
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
