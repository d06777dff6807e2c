//! One connection over TLS 1.3, and one request on it.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context as _, bail};
use pairing::wire::Refused;
use rustls::client::danger::{HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier};
use rustls::crypto::CryptoProvider;
use rustls::pki_types::{CertificateDer, ServerName, UnixTime};
use rustls::{
    ClientConfig, ClientConnection, DigitallySignedStruct, Error, RootCertStore, SignatureScheme, StreamOwned,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Address;

/// A robot that takes longer is not there.
pub(super) const PATIENCE: Duration = Duration::from_secs(10);

/// The longest answer, which is a certificate or a list of devices.
const BODY_BYTES_MAX: u64 = 1 << 20;

/// The stream below.
pub(super) type Tls = StreamOwned<ClientConnection, TcpStream>;

/// A connection on which nothing was said yet.
pub(super) struct Line(pub(super) Tls);

/// What a request was answered.
#[derive(Debug)]
pub(super) struct Answer {
    pub(super) status: u16,
    /// The token, when the robot has just let this computer in.
    pub(super) token: Option<String>,
    pub(super) body: Vec<u8>,
}

impl Answer {
    /// What the robot says.
    pub(super) fn read<T: DeserializeOwned>(&self) -> anyhow::Result<T> {
        if self.status == 200 {
            return serde_json::from_slice(&self.body)
                .context("the robot gave another answer: both must be of one version");
        }
        match serde_json::from_slice::<Refused>(&self.body) {
            Ok(refused) => bail!("{}", refused.text),
            Err(_) => bail!("the robot answered with the status {}", self.status),
        }
    }
}

impl Line {
    /// To the robot with this authority, and to no other one.
    pub(super) fn trusting(address: &Address, authority: &CertificateDer<'static>) -> anyhow::Result<Self> {
        let mut roots = RootCertStore::empty();
        roots
            .add(authority.clone())
            .context("the robot's certificate cannot be used: pair anew")?;
        let config = builder()?.with_root_certificates(roots).with_no_client_auth();
        Self::open(address, config)
    }

    /// To whoever answers. Good for asking who that claims to be, and for nothing else.
    pub(super) fn to_anybody(address: &Address) -> anyhow::Result<Self> {
        let config = builder()?
            .dangerous()
            .with_custom_certificate_verifier(Arc::new(Anybody(provider())))
            .with_no_client_auth();
        Self::open(address, config)
    }

    fn open(address: &Address, config: ClientConfig) -> anyhow::Result<Self> {
        let name = ServerName::try_from(address.name().to_owned())?;
        let stream = TcpStream::connect((address.name(), address.port()))
            .with_context(|| format!("cannot reach {address}: is the robot on, and on this network?"))?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let session = ClientConnection::new(Arc::new(config), name)?;
        let mut stream = StreamOwned::new(session, stream);
        // Says nothing, and shakes hands.
        stream.flush().with_context(|| {
            format!(
                "{address} is not the robot that this computer is paired with, or not by that name: if the robot has forgotten all \
                 devices, `rvac pair --robot {address}`"
            )
        })?;
        Ok(Self(stream))
    }

    /// Reads an address.
    pub(super) fn get(self, address: &Address, path: &str, token: Option<&str>) -> anyhow::Result<Answer> {
        let token = token.map(|token| format!("Authorization: Bearer {token}\r\n"));
        let head = format!("GET {path} HTTP/1.1\r\n{}", token.unwrap_or_default());
        self.ask(address, &head, b"")
    }

    /// Changes something.
    pub(super) fn post(self, address: &Address, path: &str, body: &impl Serialize) -> anyhow::Result<Answer> {
        let body = serde_json::to_vec(body)?;
        let head = format!(
            "POST {path} HTTP/1.1\r\nOrigin: {}\r\nContent-Type: application/json\r\nX-Rvac: 1\r\nContent-Length: {}\r\n",
            address.origin(),
            body.len()
        );
        self.ask(address, &head, &body)
    }

    /// `head` is the first line and the headers that differ from one request to another.
    fn ask(mut self, address: &Address, head: &str, body: &[u8]) -> anyhow::Result<Answer> {
        let head = format!("{head}Host: {}\r\nConnection: close\r\n\r\n", address.authority());
        self.0.write_all(head.as_bytes())?;
        self.0.write_all(body)?;
        self.0.flush()?;
        self.answer().with_context(|| format!("{address} gave no answer"))
    }

    fn answer(self) -> anyhow::Result<Answer> {
        let mut reader = BufReader::new(self.0.take(BODY_BYTES_MAX));
        let (mut line, mut token, mut length) = (String::new(), None, 0);
        reader.read_line(&mut line)?;
        let status = line
            .split_whitespace()
            .nth(1)
            .and_then(|status| status.parse().ok());
        let status = status.context("this is no HTTP")?;
        loop {
            line.clear();
            if reader.read_line(&mut line)? == 0 || line.trim().is_empty() {
                break;
            }
            let Some((name, value)) = line.split_once(':') else {
                continue;
            };
            match name.to_ascii_lowercase().as_str() {
                "content-length" => length = value.trim().parse()?,
                "set-cookie" => token = token_in(value),
                _ => {}
            }
        }
        let mut body = Vec::new();
        reader.take(length).read_to_end(&mut body)?;
        Ok(Answer { status, token, body })
    }
}

/// The token in a cookie.
fn token_in(cookie: &str) -> Option<String> {
    let (pair, _) = cookie.split_once(';')?;
    Some(pair.trim().split_once('=')?.1.to_owned())
}

fn provider() -> Arc<CryptoProvider> {
    Arc::new(rustls::crypto::ring::default_provider())
}

fn builder() -> anyhow::Result<rustls::ConfigBuilder<ClientConfig, rustls::WantsVerifier>> {
    Ok(ClientConfig::builder_with_provider(provider()).with_protocol_versions(&[&rustls::version::TLS13])?)
}

/// Takes any certificate whose key is really there.
#[derive(Debug)]
struct Anybody(Arc<CryptoProvider>);

impl ServerCertVerifier for Anybody {
    fn verify_server_cert(
        &self,
        _end_entity: &CertificateDer<'_>,
        _intermediates: &[CertificateDer<'_>],
        _name: &ServerName<'_>,
        _ocsp: &[u8],
        _now: UnixTime,
    ) -> Result<ServerCertVerified, Error> {
        Ok(ServerCertVerified::assertion())
    }

    fn verify_tls12_signature(
        &self,
        message: &[u8],
        cert: &CertificateDer<'_>,
        signature: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        let known = &self.0.signature_verification_algorithms;
        rustls::crypto::verify_tls12_signature(message, cert, signature, known)
    }

    fn verify_tls13_signature(
        &self,
        message: &[u8],
        cert: &CertificateDer<'_>,
        signature: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, Error> {
        let known = &self.0.signature_verification_algorithms;
        rustls::crypto::verify_tls13_signature(message, cert, signature, known)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        self.0.signature_verification_algorithms.supported_schemes()
    }
}
