//! The robot's certificate authority: made once, kept for ever.

use std::io;
use std::path::{Path, PathBuf};

use data_encoding::HEXUPPER;
use pairing::RobotId;
use rcgen::{
    BasicConstraints, CertificateParams, CidrSubnet, DnType, GeneralSubtree, IsCa, Issuer, KeyPair,
    KeyUsagePurpose, NameConstraints, PKCS_ECDSA_P256_SHA256, PublicKeyData as _, date_time_ymd,
};
use rustls::pki_types::CertificateDer;
use serde::{Deserialize, Serialize};

use super::addresses::HOME_NETWORKS;

/// Why the robot has no identity.
#[derive(Debug, thiserror::Error)]
pub enum IdentityError {
    /// The file cannot be read or written.
    #[error("cannot keep the robot's identity in {path}: {source}; choose another folder with --state")]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file is damaged.
    #[error(
        "{path} does not hold an identity ({why}): put back a copy of it, or remove it, after which devices must trust and pair with the robot anew"
    )]
    Damaged {
        /// Which.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// The authority must not vouch for a name.
    #[error(
        "the robot's authority was not made for the name {name}: leave out --host-name {name}, or remove {path}, after which devices must trust and pair with the robot anew"
    )]
    NameNotPermitted {
        /// Which name.
        name: String,
        /// Where the authority is.
        path: PathBuf,
    },
    /// A certificate could not be made.
    #[error("cannot make a certificate: {0}; check the names given with --host-name")]
    Certificate(#[from] rcgen::Error),
    /// The keys do not fit the TLS library.
    #[error("cannot use the certificate: {0}")]
    Tls(#[from] rustls::Error),
}

/// As it lies on the disk; one file, so that key and certificate can never disagree.
#[derive(Serialize, Deserialize)]
struct Stored {
    key_pem: String,
    certificate_pem: String,
    extra_names: Vec<String>,
}

/// The authority.
pub(crate) struct Authority {
    issuer: Issuer<'static, KeyPair>,
    robot: RobotId,
    certificate: CertificateDer<'static>,
    pem: String,
}

impl std::fmt::Debug for Authority {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(to, "Authority({})", self.robot.host_name())
    }
}

impl Authority {
    /// The authority that is kept at `path`, or a new one that may vouch for `extra_names` too.
    pub(crate) fn at(path: &Path, extra_names: &[String]) -> Result<Self, IdentityError> {
        let file_error = |source| IdentityError::File {
            path: path.to_owned(),
            source,
        };
        let Some(text) = kept_text(path).map_err(file_error)? else {
            return Self::anew(path, extra_names);
        };
        let stored: Stored = serde_json::from_str(&text).map_err(|error| damaged(path, &error))?;
        let unknown = extra_names.iter().find(|name| {
            !stored
                .extra_names
                .iter()
                .any(|known| known.eq_ignore_ascii_case(name))
        });
        if let Some(name) = unknown {
            return Err(IdentityError::NameNotPermitted {
                name: name.clone(),
                path: path.to_owned(),
            });
        }
        Self::from_stored(stored).map_err(|error| damaged(path, &error))
    }

    /// A new authority, in place of any that is kept at `path`.
    pub(crate) fn anew(path: &Path, extra_names: &[String]) -> Result<Self, IdentityError> {
        let made = make(extra_names)?;
        let text = serde_json::to_string_pretty(&made).map_err(|error| damaged(path, &error))?;
        // Twice, so that the predecessor of the file holds no older identity that could come back.
        for _ in 0..2 {
            kept_file::replace_secret(path, text.as_bytes()).map_err(|source| IdentityError::File {
                path: path.to_owned(),
                source,
            })?;
        }
        Self::from_stored(made).map_err(|error| damaged(path, &error))
    }

    fn from_stored(stored: Stored) -> Result<Self, rcgen::Error> {
        let key = KeyPair::from_pem(&stored.key_pem)?;
        let robot = RobotId::of_public_key(&key.subject_public_key_info());
        let certificate =
            rustls::pki_types::pem::PemObject::from_pem_slice(stored.certificate_pem.as_bytes())
                .map_err(|_| rcgen::Error::CouldNotParseCertificate)?;
        let issuer = Issuer::new(params(&robot, &stored.extra_names), key);
        Ok(Self {
            issuer,
            robot,
            certificate,
            pem: stored.certificate_pem,
        })
    }

    pub(crate) const fn issuer(&self) -> &Issuer<'static, KeyPair> {
        &self.issuer
    }

    pub(crate) const fn robot(&self) -> &RobotId {
        &self.robot
    }

    /// The certificate, for devices that shall trust it.
    pub(crate) fn pem(&self) -> &str {
        &self.pem
    }

    pub(crate) const fn certificate(&self) -> &CertificateDer<'static> {
        &self.certificate
    }

    /// SHA-256 of the certificate in pairs of digits, as devices show it.
    pub(crate) fn fingerprint(&self) -> String {
        let pairs: Vec<String> = pairing::sha256(&self.certificate)
            .iter()
            .map(|byte| HEXUPPER.encode(&[*byte]))
            .collect();
        pairs.join(":")
    }
}

fn damaged(path: &Path, why: &dyn std::fmt::Display) -> IdentityError {
    IdentityError::Damaged {
        path: path.to_owned(),
        why: why.to_string(),
    }
}

/// The text of a kept file. A crash can leave the predecessor alone; the file that was to replace it was not confirmed to anybody.
fn kept_text(path: &Path) -> io::Result<Option<String>> {
    for version in kept_file::versions(path) {
        match kept_file::read_text(&version) {
            Ok(text) => return Ok(Some(text)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
    }
    Ok(None)
}

fn make(extra_names: &[String]) -> Result<Stored, IdentityError> {
    let key = KeyPair::generate_for(&PKCS_ECDSA_P256_SHA256)?;
    let robot = RobotId::of_public_key(&key.subject_public_key_info());
    let certificate = params(&robot, extra_names).self_signed(&key)?;
    Ok(Stored {
        key_pem: key.serialize_pem(),
        certificate_pem: certificate.pem(),
        extra_names: extra_names.to_vec(),
    })
}

/// What the authority may do: sign certificates of this robot's names and of home networks' addresses, no further authority.
fn params(robot: &RobotId, extra_names: &[String]) -> CertificateParams {
    let mut params = CertificateParams::default();
    params.distinguished_name = rcgen::DistinguishedName::new();
    params
        .distinguished_name
        .push(DnType::CommonName, format!("LibreRVAC {}", robot.host_name()));
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign, KeyUsagePurpose::CrlSign];
    // Fixed, because a robot's board may not know the time when it makes this.
    params.not_before = date_time_ymd(2020, 1, 1);
    params.not_after = date_time_ymd(2120, 1, 1);
    let names = extra_names.iter().cloned().chain([robot.host_name()]);
    let networks = HOME_NETWORKS
        .iter()
        .map(|(network, prefix)| GeneralSubtree::IpAddress(CidrSubnet::from_addr_prefix(*network, *prefix)));
    params.name_constraints = Some(NameConstraints {
        permitted_subtrees: names.map(GeneralSubtree::DnsName).chain(networks).collect(),
        excluded_subtrees: Vec::new(),
    });
    params
}
