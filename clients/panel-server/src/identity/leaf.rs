//! The certificate that browsers see: for the present names and addresses, short-lived, renewed at half of its life.

use std::net::IpAddr;
use std::sync::Arc;

use rcgen::{
    CertificateParams, DistinguishedName, DnType, ExtendedKeyUsagePurpose, IsCa, KeyPair, KeyUsagePurpose,
    PKCS_ECDSA_P256_SHA256, SanType,
};
use rustls::pki_types::{PrivateKeyDer, PrivatePkcs8KeyDer};
use rustls::sign::CertifiedKey;
use time::OffsetDateTime;

use super::{Authority, IdentityError};

const DAY_S: u64 = 86_400;

/// The strictest limit that browsers have for certificates is 398 days; a day is left for clocks that differ.
const LIFE_S: u64 = 397 * DAY_S;

/// It begins a little in the past, for devices whose clock is behind.
const BEFORE_S: u64 = 2 * DAY_S;

/// No certificate is made for a time before this one (1 November 2026): a board without a clock starts in 1970.
const TIME_FLOOR_S: u64 = 1_793_491_200;

/// No certificate is made for a time after this one (1 January 2100): the authority ends soon after.
const TIME_CEILING_S: u64 = 4_102_444_800;

/// The time as far as it can be true.
pub(crate) fn reckoned_now_s(clock_s: u64) -> u64 {
    clock_s.clamp(TIME_FLOOR_S, TIME_CEILING_S)
}

/// What a certificate is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Subjects {
    pub(crate) names: Vec<String>,
    pub(crate) addresses: Vec<IpAddr>,
}

/// A certificate with its key, ready to be served.
#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    subjects: Subjects,
    begins_s: u64,
    pub(crate) key: Arc<CertifiedKey>,
}

impl Leaf {
    /// Makes one for `subjects` at this time.
    pub(crate) fn issue(
        authority: &Authority,
        subjects: Subjects,
        now_s: u64,
    ) -> Result<Self, IdentityError> {
        let begins_s = now_s - BEFORE_S;
        let mut params = CertificateParams::default();
        params.distinguished_name = DistinguishedName::new();
        params
            .distinguished_name
            .push(DnType::CommonName, authority.robot().host_name());
        params.is_ca = IsCa::ExplicitNoCa;
        params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
        params.extended_key_usages = vec![ExtendedKeyUsagePurpose::ServerAuth];
        params.use_authority_key_identifier_extension = true;
        params.not_before = moment(begins_s);
        params.not_after = moment(begins_s + LIFE_S);
        let names = subjects
            .names
            .iter()
            .map(|name| name.as_str().try_into().map(SanType::DnsName));
        params.subject_alt_names = names.collect::<Result<_, rcgen::Error>>()?;
        params
            .subject_alt_names
            .extend(subjects.addresses.iter().copied().map(SanType::IpAddress));
        let key = KeyPair::generate_for(&PKCS_ECDSA_P256_SHA256)?;
        let certificate = params.signed_by(&key, authority.issuer())?;
        let private = PrivateKeyDer::Pkcs8(PrivatePkcs8KeyDer::from(key.serialize_der()));
        let signing = rustls::crypto::ring::sign::any_ecdsa_type(&private)?;
        let chain = vec![certificate.der().clone(), authority.certificate().clone()];
        Ok(Self {
            subjects,
            begins_s,
            key: Arc::new(CertifiedKey::new(chain, signing)),
        })
    }

    /// Whether another one is due: names or addresses changed, half of its life is over, or the clock jumped to before it.
    pub(crate) fn is_due(&self, subjects: &Subjects, now_s: u64) -> bool {
        self.subjects != *subjects || now_s < self.begins_s || now_s >= self.begins_s + LIFE_S / 2
    }
}

fn moment(unix_s: u64) -> OffsetDateTime {
    let seconds = i64::try_from(unix_s).unwrap_or(i64::MAX);
    OffsetDateTime::from_unix_timestamp(seconds).unwrap_or(OffsetDateTime::UNIX_EPOCH)
}

#[cfg(test)]
mod tests {
    use super::{DAY_S, LIFE_S, Leaf, Subjects, reckoned_now_s};
    use crate::folder::Folder;
    use crate::identity::{Authority, IdentityError};
    use rustls::RootCertStore;
    use rustls::client::WebPkiServerVerifier;
    use rustls::client::danger::ServerCertVerifier as _;
    use rustls::pki_types::{ServerName, UnixTime};
    use std::sync::Arc;
    use std::time::Duration;

    const NOW_S: u64 = 1_800_000_000;

    fn authority_in(folder: &Folder) -> Authority {
        Authority::at(&folder.join("identity.json"), &[]).unwrap()
    }

    fn subjects(authority: &Authority, more: &str, address: &str) -> Subjects {
        let mut names = vec![authority.robot().host_name()];
        names.extend((!more.is_empty()).then(|| more.to_owned()));
        Subjects {
            names,
            addresses: vec![address.parse().unwrap()],
        }
    }

    /// Whether a device that trusts the authority takes the certificate for `name` at this time.
    fn is_taken(authority: &Authority, leaf: &Leaf, name: &str, now_s: u64) -> bool {
        let mut roots = RootCertStore::empty();
        roots.add(authority.certificate().clone()).unwrap();
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let verifier = WebPkiServerVerifier::builder_with_provider(Arc::new(roots), provider)
            .build()
            .unwrap();
        let name = ServerName::try_from(name.to_owned()).unwrap();
        let now = UnixTime::since_unix_epoch(Duration::from_secs(now_s));
        let (end, chain) = leaf.key.cert.split_first().unwrap();
        verifier.verify_server_cert(end, chain, &name, &[], now).is_ok()
    }

    #[test]
    fn the_authority_vouches_for_this_robot_at_home_and_for_nothing_else() {
        let folder = Folder::new();
        let authority = authority_in(&folder);
        let own = authority.robot().host_name();
        let good = Leaf::issue(&authority, subjects(&authority, "", "192.168.1.7"), NOW_S).unwrap();
        assert!(is_taken(&authority, &good, &own, NOW_S));
        assert!(is_taken(&authority, &good, "192.168.1.7", NOW_S));
        assert!(!is_taken(&authority, &good, "192.168.1.8", NOW_S));
        for (name, address) in [
            ("bank.example", "192.168.1.7"),
            ("", "8.8.8.8"),
            ("evil.local", "10.0.0.1"),
        ] {
            let misused = Leaf::issue(&authority, subjects(&authority, name, address), NOW_S).unwrap();
            assert!(!is_taken(&authority, &misused, &own, NOW_S), "{name} {address}");
        }
    }

    #[test]
    fn it_stays_the_same_after_a_restart_and_takes_no_name_later() {
        let folder = Folder::new();
        let first = authority_in(&folder);
        let leaf = Leaf::issue(&first, subjects(&first, "", "10.0.0.2"), NOW_S).unwrap();
        let again = authority_in(&folder);
        assert_eq!(first.robot(), again.robot());
        assert_eq!(first.fingerprint(), again.fingerprint());
        assert!(is_taken(&again, &leaf, &first.robot().host_name(), NOW_S));
        let path = folder.join("identity.json");
        let later = Authority::at(&path, &["robot.example".to_owned()]).unwrap_err();
        assert!(matches!(later, IdentityError::NameNotPermitted { .. }), "{later}");
        std::fs::write(&path, "{").unwrap();
        let damaged = Authority::at(&path, &[]).unwrap_err();
        assert!(matches!(damaged, IdentityError::Damaged { .. }), "{damaged}");
    }

    #[test]
    fn it_lives_at_most_398_days_and_is_renewed_at_half_of_that() {
        let folder = Folder::new();
        let authority = authority_in(&folder);
        let wanted = subjects(&authority, "", "10.0.0.2");
        let leaf = Leaf::issue(&authority, wanted.clone(), NOW_S).unwrap();
        let own = authority.robot().host_name();
        assert!(is_taken(&authority, &leaf, &own, NOW_S - DAY_S));
        assert!(!is_taken(&authority, &leaf, &own, NOW_S + LIFE_S));
        assert!(!leaf.is_due(&wanted, NOW_S + 150 * DAY_S));
        assert!(leaf.is_due(&wanted, NOW_S + 198 * DAY_S));
        assert!(
            leaf.is_due(&wanted, NOW_S - 10 * DAY_S),
            "the clock was ahead before"
        );
        assert!(leaf.is_due(&subjects(&authority, "", "10.0.0.3"), NOW_S));
    }

    #[test]
    fn a_board_without_a_clock_serves_too() {
        let folder = Folder::new();
        let authority = authority_in(&folder);
        for clock_s in [0, u64::MAX] {
            let now_s = reckoned_now_s(clock_s);
            let leaf = Leaf::issue(&authority, subjects(&authority, "", "10.0.0.2"), now_s).unwrap();
            assert!(is_taken(&authority, &leaf, &authority.robot().host_name(), now_s));
        }
    }
}
