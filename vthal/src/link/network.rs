//! A network as the link: something beside the robot, such as an ESP32 or ser2net, passes its bytes on.

use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use robot_link::{NetworkAddress, SecureAddress};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
use rustls::{ClientConfig, RootCertStore};
use tokio::net::TcpStream;
use tokio::time::timeout;
use tokio_rustls::TlsConnector;
use tokio_rustls::client::TlsStream;

use super::LinkOpenError;

/// Longest wait for a connection.
const CONNECT: Duration = Duration::from_secs(5);
/// A peer that confirms nothing for so long is gone; otherwise the system would wait for minutes.
const UNCONFIRMED_MS: u32 = 3_000;

/// Connects.
pub(super) async fn connect(peer: &NetworkAddress) -> Result<TcpStream, LinkOpenError> {
    in_time(open(peer))
        .await
        .map_err(|error| unreachable(peer, error))
}

/// Connects, and believes nobody but the holder of the certificate that the owner has named.
pub(super) async fn connect_secured(peer: &SecureAddress) -> Result<TlsStream<TcpStream>, LinkOpenError> {
    let connector = TlsConnector::from(Arc::new(configure(peer)?));
    let name = peer.name.as_ref().unwrap_or(&peer.peer.host).clone();
    let name = ServerName::try_from(name)
        .map_err(|error| unreachable(&peer.peer, io::Error::new(io::ErrorKind::InvalidInput, error)))?;
    let shake = async { connector.connect(name, open(&peer.peer).await?).await };
    in_time(shake)
        .await
        .map_err(|error| unreachable(&peer.peer, error))
}

async fn in_time<T>(work: impl Future<Output = io::Result<T>>) -> io::Result<T> {
    timeout(CONNECT, work)
        .await
        .unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()))
}

async fn open(peer: &NetworkAddress) -> io::Result<TcpStream> {
    let stream = TcpStream::connect((peer.host.as_str(), peer.port)).await?;
    // A command must not wait for the next one to share a packet with it.
    stream.set_nodelay(true)?;
    rustix::net::sockopt::set_tcp_user_timeout(&stream, UNCONFIRMED_MS)?;
    Ok(stream)
}

fn unreachable(peer: &NetworkAddress, error: io::Error) -> LinkOpenError {
    LinkOpenError::Network {
        host: peer.host.clone(),
        port: peer.port,
        error,
    }
}

fn configure(peer: &SecureAddress) -> Result<ClientConfig, LinkOpenError> {
    let mut roots = RootCertStore::empty();
    for certificate in certificates(&peer.ca)? {
        roots
            .add(certificate)
            .map_err(|error| unusable(&peer.ca, &error))?;
    }
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let builder = ClientConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()
        .map_err(|error| unusable(&peer.ca, &error))?
        .with_root_certificates(roots);
    let Some((certificate, key)) = &peer.identity else {
        return Ok(builder.with_no_client_auth());
    };
    let secret = PrivateKeyDer::from_pem_file(key).map_err(|error| unusable(key, &error))?;
    builder
        .with_client_auth_cert(certificates(certificate)?, secret)
        .map_err(|error| unusable(certificate, &error))
}

fn certificates(file: &Path) -> Result<Vec<CertificateDer<'static>>, LinkOpenError> {
    let all: Result<Vec<_>, _> = CertificateDer::pem_file_iter(file)
        .map_err(|error| unusable(file, &error))?
        .collect();
    match all.map_err(|error| unusable(file, &error))? {
        none if none.is_empty() => Err(unusable(file, &"there is no certificate in it")),
        all => Ok(all),
    }
}

fn unusable(file: &Path, reason: &dyn std::fmt::Display) -> LinkOpenError {
    LinkOpenError::Certificate {
        file: file.display().to_string(),
        reason: reason.to_string(),
    }
}
