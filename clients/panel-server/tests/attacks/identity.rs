//! A23, A24: misuse of the robot's authority, and clocks that are wrong.

use std::sync::Arc;
use std::time::Duration;

use pairing::Role;
use rcgen::{BasicConstraints, CertificateParams, DnType, IsCa, Issuer, KeyPair, SanType};
use rustls::client::WebPkiServerVerifier;
use rustls::client::danger::ServerCertVerifier as _;
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, ServerName, UnixTime};
use rustls::time_provider::TimeProvider;
use rustls::{ClientConfig, RootCertStore};
use serde_json::Value;
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;
use tokio_rustls::TlsConnector;

use crate::report::Report;
use crate::rig::{Rig, read_all};

/// A time at which the robot's certificates hold, seconds since 1970.
const IN_2026_S: u64 = 1_794_000_000;
const IN_2100_S: u64 = 4_102_444_800;

pub(crate) async fn try_all(report: &mut Report) {
    let rig = Rig::start().await;
    misuse(&rig, report);
    for (what, clock, device_s) in [
        ("1970", (|| 0) as fn() -> u64, IN_2026_S),
        ("2100", || IN_2100_S, IN_2100_S),
        ("the year 4000", || 64_060_588_800, IN_2100_S),
    ] {
        wrong_clock((what, clock), device_s, report).await;
    }
}

/// Whoever has the robot's card has the key of its authority.
struct Thief {
    issuer: Issuer<'static, KeyPair>,
    authority: CertificateDer<'static>,
}

impl Thief {
    fn of(rig: &Rig) -> Self {
        let text = std::fs::read_to_string(rig.folder.join("state/identity.json")).unwrap();
        let kept: Value = serde_json::from_str(&text).unwrap();
        let key = KeyPair::from_pem(kept["key_pem"].as_str().unwrap()).unwrap();
        let mut params = CertificateParams::default();
        let name = format!("LibreRVAC {}", rig.trust.host_name);
        params.distinguished_name = rcgen::DistinguishedName::new();
        params.distinguished_name.push(DnType::CommonName, name);
        Self {
            issuer: Issuer::new(params, key),
            authority: CertificateDer::from_pem_slice(rig.trust.pem.as_bytes()).unwrap(),
        }
    }

    /// What a device that trusts the robot makes of `end`, shown for `name`.
    fn shows(&self, name: &str, end: &CertificateDer<'_>, chain: &[CertificateDer<'_>]) -> &'static str {
        let mut roots = RootCertStore::empty();
        roots.add(self.authority.clone()).unwrap();
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let verifier = WebPkiServerVerifier::builder_with_provider(Arc::new(roots), provider);
        let name = ServerName::try_from(name.to_owned()).unwrap();
        let now = UnixTime::since_unix_epoch(Duration::from_secs(IN_2026_S));
        let verifier = verifier.build().unwrap();
        match verifier.verify_server_cert(end, chain, &name, &[], now) {
            Ok(_) => "taken",
            Err(_) => "refused",
        }
    }

    fn forges(&self, name: &str) -> &'static str {
        let key = KeyPair::generate().unwrap();
        let end = leaf(name).signed_by(&key, &self.issuer).unwrap();
        self.shows(name, end.der(), &[])
    }

    /// The same through an authority of the thief's own, which the stolen one signs.
    fn forges_through_another(&self, name: &str) -> &'static str {
        let mut params = CertificateParams::default();
        params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
        let (between_key, key) = (KeyPair::generate().unwrap(), KeyPair::generate().unwrap());
        let between = params.signed_by(&between_key, &self.issuer).unwrap();
        let issuer = Issuer::new(params, between_key);
        let end = leaf(name).signed_by(&key, &issuer).unwrap();
        self.shows(name, end.der(), &[between.der().clone()])
    }
}

fn leaf(name: &str) -> CertificateParams {
    let mut params = CertificateParams::default();
    params.subject_alt_names = vec![match name.parse() {
        Ok(address) => SanType::IpAddress(address),
        Err(_) => SanType::DnsName(name.try_into().unwrap()),
    }];
    params
}

fn misuse(rig: &Rig, report: &mut Report) {
    let (thief, own) = (Thief::of(rig), rig.trust.host_name.clone());
    for (name, expected) in [
        (own.as_str(), "taken"),
        ("192.168.1.7", "taken"),
        ("bank.example", "refused"),
        ("rvac-aaaaaaaa.local", "refused"),
        ("8.8.8.8", "refused"),
    ] {
        report.row(
            (
                "A23",
                format!("the authority's key is stolen: a certificate for {name}"),
            ),
            expected,
            thief.forges(name),
        );
    }
    report.row(
        ("A23", "the same for bank.example through an authority below it"),
        "refused",
        thief.forges_through_another("bank.example"),
    );
}

#[derive(Debug)]
struct At(u64);

impl TimeProvider for At {
    fn current_time(&self) -> Option<UnixTime> {
        Some(UnixTime::since_unix_epoch(Duration::from_secs(self.0)))
    }
}

async fn wrong_clock((what, clock): (&str, fn() -> u64), device_s: u64, report: &mut Report) {
    let rig = Rig::start_at(clock).await;
    let seen = status_at(&rig, device_s)
        .await
        .unwrap_or_else(|error| error.to_string());
    let name = format!("the board's clock says {what}: a device is answered over TLS");
    report.row(("A24", name), "200", seen);
    let opened = rig.open(Role::View).await;
    let seen = opened.map_or_else(|why| why, |_| "open".to_owned());
    report.row(("A24", format!("and a window opens in {what}")), "open", seen);
}

/// What a device whose clock shows this time is answered.
async fn status_at(rig: &Rig, device_s: u64) -> std::io::Result<String> {
    let mut roots = RootCertStore::empty();
    let authority = CertificateDer::from_pem_slice(rig.trust.pem.as_bytes()).unwrap();
    roots.add(authority).unwrap();
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = ClientConfig::builder_with_details(provider, Arc::new(At(device_s)))
        .with_protocol_versions(&[&rustls::version::TLS13])
        .unwrap()
        .with_root_certificates(roots)
        .with_no_client_auth();
    let name = ServerName::try_from(rig.trust.host_name.clone()).unwrap();
    let stream = TcpStream::connect(rig.address).await?;
    let mut stream = TlsConnector::from(Arc::new(config)).connect(name, stream).await?;
    let host = rig.host();
    let request = format!("GET /api/pairing HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
    stream.write_all(request.as_bytes()).await?;
    let answer = read_all(&mut stream).await;
    Ok(answer.get(9..12).unwrap_or("nothing").to_owned())
}
