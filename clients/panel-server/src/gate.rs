//! What stands between the network and a robot: its certificate, its clients, and the names it goes by.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;

use pairing::console::Trust;
use pairing::wire::{Forgotten, OpenWindow, OpenedHere};
use rustls::ServerConfig;
use rustls::server::{ClientHello, ResolvesServerCert};
use rustls::sign::CertifiedKey;
use tokio::io::AsyncWriteExt as _;
use tokio::net::UnixStream;
use tokio::sync::Notify;
use tokio_rustls::TlsAcceptor;
use tracing::{info, warn};

use crate::guarded::{ClientsError, Guarded, NotDone};
use crate::identity::{Authority, IdentityError, Leaf, Subjects, own_addresses, reckoned_now_s};
use crate::reset_file::Wish;
use crate::rules::{Rules, Scheme};
use crate::settings::Guard;
use crate::software::SoftwareDesk;
use crate::upstream::Upstream;

/// How often names, addresses and the certificate's age are checked.
const LOOK_EVERY: Duration = Duration::from_secs(60);

/// A daemon that takes longer for a beep is left alone.
const BEEP_LIMIT: Duration = Duration::from_secs(2);

/// Why there is no gate.
#[derive(Debug, thiserror::Error)]
pub enum GateError {
    /// No certificate.
    #[error(transparent)]
    Identity(#[from] IdentityError),
    /// No clients.
    #[error(transparent)]
    Clients(#[from] ClientsError),
    /// The folder cannot be used.
    #[error("cannot use the folder {path}: {source}; choose another with --state")]
    Folder {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// The gate of one robot.
#[derive(Debug)]
pub(crate) struct Gate {
    pub(crate) guarded: Guarded,
    pub(crate) software: Arc<SoftwareDesk>,
    authority: RwLock<Arc<Authority>>,
    identity: PathBuf,
    /// The certificate and the names must be checked now.
    renamed: Notify,
    extra_names: Vec<String>,
    port: u16,
    vthal: PathBuf,
    clock: fn() -> u64,
    leaf: RwLock<Leaf>,
}

impl Gate {
    /// The gate that is kept in the folder of `guard`, for a server that listens at `address`.
    pub(crate) fn new(
        guard: &Guard,
        extra_names: Vec<String>,
        address: SocketAddr,
        vthal: PathBuf,
    ) -> Result<Self, GateError> {
        let folder = guard.state.as_path();
        let unusable = |source| GateError::Folder {
            path: folder.to_owned(),
            source,
        };
        make_folder(folder).map_err(unusable)?;
        let software =
            SoftwareDesk::new(folder, guard.updates.clone(), guard.free_bytes).map_err(unusable)?;
        let identity = folder.join("identity.json");
        let authority = Authority::at(&identity, &extra_names)?;
        let guarded = Guarded::at(&folder.join("clients.json"), authority.robot().clone())?;
        let now = subjects(&authority, &extra_names);
        let leaf = Leaf::issue(&authority, now, reckoned_now_s((guard.clock)()))?;
        Ok(Self {
            guarded,
            software: Arc::new(software),
            authority: RwLock::new(Arc::new(authority)),
            identity,
            renamed: Notify::new(),
            extra_names,
            port: address.port(),
            vthal,
            clock: guard.clock,
            leaf: RwLock::new(leaf),
        })
    }

    fn authority(&self) -> Arc<Authority> {
        Arc::clone(&self.authority.read().unwrap_or_else(PoisonError::into_inner))
    }

    /// Forgets what the file on the card asks for.
    pub(crate) async fn forget(&self, wish: Wish) -> Result<(), NotDone> {
        match wish {
            Wish::Devices => self.guarded.forget_all(Forgotten::File).await?,
            Wish::Everything => self.forget_everything(Forgotten::File).await?,
        }
        self.renew();
        Ok(())
    }

    /// Forgets all devices, and becomes another robot to all that trusted this one.
    pub(crate) async fn forget_everything(&self, why: Forgotten) -> Result<(), NotDone> {
        self.guarded.forget_all(why).await?;
        let authority = Authority::anew(&self.identity, &self.extra_names)?;
        self.guarded.rename(authority.robot().clone()).await;
        *self.authority.write().unwrap_or_else(PoisonError::into_inner) = Arc::new(authority);
        self.renamed.notify_one();
        Ok(())
    }

    /// What accepts connections: TLS 1.3 and nothing older.
    pub(crate) fn acceptor(self: &Arc<Self>) -> Result<TlsAcceptor, IdentityError> {
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let mut config = ServerConfig::builder_with_provider(provider)
            .with_protocol_versions(&[&rustls::version::TLS13])?
            .with_no_client_auth()
            .with_cert_resolver(Arc::new(Present(Arc::clone(self))));
        config.alpn_protocols = vec![b"http/1.1".to_vec()];
        Ok(TlsAcceptor::from(Arc::new(config)))
    }

    /// The rules for the names and addresses of the moment.
    pub(crate) fn rules(&self) -> Rules {
        let subjects = subjects(&self.authority(), &self.extra_names);
        let addresses = subjects
            .addresses
            .iter()
            .map(|ip| crate::rules::in_authority(*ip));
        Rules::new(
            Scheme::Https,
            self.port,
            subjects.names.into_iter().chain(addresses),
        )
    }

    /// Renews the certificate and the rules when it is time, for ever.
    pub(crate) async fn keep(&self, rules: &RwLock<Rules>) {
        let mut pulse = tokio::time::interval(LOOK_EVERY);
        loop {
            tokio::select! {
                _ = pulse.tick() => {}
                () = self.renamed.notified() => {}
            }
            if self.renew() {
                *rules.write().unwrap_or_else(PoisonError::into_inner) = self.rules();
            }
        }
    }

    /// Whether there is a new certificate.
    fn renew(&self) -> bool {
        let authority = self.authority();
        let wanted = subjects(&authority, &self.extra_names);
        let now_s = reckoned_now_s((self.clock)());
        let due = self
            .leaf
            .read()
            .unwrap_or_else(PoisonError::into_inner)
            .is_due(&wanted, now_s);
        if !due {
            return false;
        }
        match Leaf::issue(&authority, wanted, now_s) {
            Ok(leaf) => {
                info!("the certificate was renewed");
                *self.leaf.write().unwrap_or_else(PoisonError::into_inner) = leaf;
                true
            }
            Err(error) => {
                warn!(%error, "the certificate could not be renewed");
                false
            }
        }
    }

    /// Opens the window, and lets the robot beep, so that people near it are warned.
    pub(crate) async fn open(&self, wanted: OpenWindow) -> Result<OpenedHere, NotDone> {
        let opened = self.guarded.open(wanted).await?;
        self.beep();
        Ok(OpenedHere {
            opened,
            addresses: self.addresses(),
        })
    }

    /// A connection to the daemon, to be made.
    pub(crate) fn daemon(&self) -> Upstream {
        Upstream::new(self.vthal.clone())
    }

    /// Lets the robot beep once, if its daemon runs.
    pub(crate) fn beep(&self) {
        let path = self.vthal.clone();
        tokio::spawn(async move {
            let said = tokio::time::timeout(BEEP_LIMIT, async {
                let mut stream = UnixStream::connect(path).await?;
                stream.write_all(b"{\"c\":\"locate\"}\x1f").await?;
                stream.shutdown().await
            });
            if !matches!(said.await, Ok(Ok(()))) {
                info!("the robot could not be asked to beep");
            }
        });
    }

    /// Where devices find the robot.
    pub(crate) fn addresses(&self) -> Vec<String> {
        let subjects = subjects(&self.authority(), &self.extra_names);
        let hosts = subjects.names.into_iter().chain(
            subjects
                .addresses
                .iter()
                .map(|ip| crate::rules::in_authority(*ip)),
        );
        let port = self.port;
        hosts
            .map(|host| match port {
                443 => format!("https://{host}/"),
                _ => format!("https://{host}:{port}/"),
            })
            .collect()
    }

    /// The robot's name on the network.
    pub(crate) fn host_name(&self) -> String {
        self.authority().robot().host_name()
    }

    /// What devices may trust.
    pub(crate) fn trust(&self) -> Trust {
        let authority = self.authority();
        Trust {
            robot: authority.robot().full().to_owned(),
            host_name: authority.robot().host_name(),
            addresses: self.addresses(),
            pem: authority.pem().to_owned(),
            fingerprint: authority.fingerprint(),
        }
    }
}

fn subjects(authority: &Authority, extra_names: &[String]) -> Subjects {
    let own = std::iter::once(authority.robot().host_name());
    Subjects {
        names: own.chain(extra_names.iter().cloned()).collect(),
        addresses: own_addresses(),
    }
}

/// A folder for the server's owner alone.
fn make_folder(folder: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::DirBuilderExt as _;
    std::fs::DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(folder)
}

/// Gives each connection the certificate of the moment.
#[derive(Debug)]
struct Present(Arc<Gate>);

impl ResolvesServerCert for Present {
    fn resolve(&self, _hello: ClientHello<'_>) -> Option<Arc<CertifiedKey>> {
        let leaf = self.0.leaf.read().unwrap_or_else(PoisonError::into_inner);
        Some(Arc::clone(&leaf.key))
    }
}
