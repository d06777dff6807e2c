//! The node: its endpoints, and the stack that serves them.

use std::io::Write as _;
use std::net::{Ipv6Addr, SocketAddr, UdpSocket};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow};
use async_io::Async as AsyncSocket;
use bridge::Knowledge;
use bridge::service::{self, ConfigurationError};
use rs_matter::crypto::{Crypto, default_crypto};
use rs_matter::dm::clusters::decl::{rvc_clean_mode, rvc_operational_state, rvc_run_mode};
use rs_matter::dm::clusters::desc::{ClusterHandler as _, DescHandler};
use rs_matter::dm::clusters::identify::{self, IdentifyHandler};
use rs_matter::dm::clusters::{decl::power_source, decl::service_area};
use rs_matter::dm::devices::DEV_TYPE_POWER_SOURCE;
use rs_matter::dm::devices::test::{DAC_PRIVKEY, TEST_DEV_ATT};
use rs_matter::dm::endpoints::EthSysHandlerBuilder;
use rs_matter::dm::networks::SysNetifs;
use rs_matter::dm::networks::eth::EthNetwork;
use rs_matter::dm::{Async, DataModel, Dataver, DeviceType, Endpoint, EndptId, Node};
use rs_matter::error::Error;
use rs_matter::im::{EthInteractionModelState, InteractionModel};
use rs_matter::respond::DefaultResponder;
use rs_matter::sc::pase::MAX_COMM_WINDOW_TIMEOUT_SECS;
use rs_matter::transport::exchange::MatterBuffers;
use rs_matter::{Matter, clusters, devices, root_endpoint};
use rvac_api::MatterInvitation;
use tokio::net::UnixListener;

use crate::choices::Choices;
use crate::clusters::{Areas, Operation, Power, RunMode, Suction};
use crate::code_socket;
use crate::identity::Identity;
use crate::network;
use crate::relay;
use crate::robot::Robot;
use crate::store::Folder;
use crate::view::View;

/// A robotic vacuum cleaner.
pub(crate) const DEVICE_TYPE: u16 = 0x0074;
/// Of the device library that the cluster definitions in use belong to.
const DEVICE_TYPE_REVISION: u16 = 4;
/// Where the robot is; 0 is the node itself.
pub(crate) const ENDPOINT: EndptId = 1;

const NODE: Node<'static> = Node {
    endpoints: &[
        root_endpoint!(eth),
        Endpoint::new(
            ENDPOINT,
            devices!(
                DeviceType {
                    dtype: DEVICE_TYPE,
                    drev: DEVICE_TYPE_REVISION,
                },
                DEV_TYPE_POWER_SOURCE,
            ),
            clusters!(
                DescHandler::CLUSTER,
                identify::CLUSTER,
                <RunMode<'_> as rvc_run_mode::ClusterAsyncHandler>::CLUSTER,
                <Suction<'_> as rvc_clean_mode::ClusterHandler>::CLUSTER,
                <Operation<'_> as rvc_operational_state::ClusterAsyncHandler>::CLUSTER,
                <Areas<'_> as service_area::ClusterHandler>::CLUSTER,
                <Power<'_> as power_source::ClusterHandler>::CLUSTER,
            ),
        ),
    ],
};

/// Where the robot is to be found, and where its daemon is.
#[derive(Debug)]
pub(crate) struct Site {
    pub(crate) socket: PathBuf,
    pub(crate) network: Option<String>,
    pub(crate) port: u16,
    /// Where the panel's server may ask for the code.
    pub(crate) code_socket: Option<PathBuf>,
}

/// Works until the stack gives up.
pub(crate) async fn run(
    site: Site,
    identity: &Identity,
    (folder, choices): (Folder, Choices),
) -> anyhow::Result<()> {
    let details = identity.details();
    // It is too large for the stack of a thread.
    let matter = Box::new(Matter::new(
        &details,
        identity.commissioning(),
        &TEST_DEV_ATT,
        site.port,
    ));
    let buffers: Box<MatterBuffers> = Box::new(MatterBuffers::new());
    let state: Box<EthInteractionModelState> =
        Box::new(EthInteractionModelState::new(EthNetwork::new_default()));
    let values = matter.kv(folder);
    matter.startup(&values).map_err(failed("what was kept"))?;
    let crypto = default_crypto(rand::rng(), DAC_PRIVKEY);
    let (robot, ends) = Robot::new(View::of(&Knowledge::default()), choices);
    let model = model(&robot, &crypto).map_err(failed("the endpoints"))?;
    let node = InteractionModel::new(&matter, &crypto, &*buffers, model, &values, &state);
    node.startup().await.map_err(failed("what was kept"))?;

    let socket = listen(site.port)?;
    let codes = listen_for_panel(site.code_socket.as_deref())?;
    let responder = DefaultResponder::new(&node);
    let mut opened_at = None;
    if matter.has_fabrics() {
        writeln!(std::io::stdout(), "ready on port {}", site.port)?;
    } else {
        node.open_basic_comm_window(MAX_COMM_WINDOW_TIMEOUT_SECS)
            .map_err(failed("letting a home in"))?;
        opened_at = Some(Instant::now());
        writeln!(
            std::io::stdout(),
            "ready to join a home for 15 minutes, on port {}",
            site.port
        )?;
        write!(std::io::stdout(), "{}", identity.code()?)?;
    }
    service::tell_ready();
    let code = (identity.code_text()?, identity.digits());
    let invitation = || {
        let since = opened_at.map(|at| at.elapsed());
        invitation(&code, since, matter.has_fabrics())
    };
    tokio::select! {
        ended = matter.run(&crypto, &socket, &socket, &socket) => ended.map_err(failed("the network")),
        ended = responder.run::<4, 4>() => ended.map_err(failed("the answers")),
        ended = node.run() => ended.map_err(failed("the subscriptions")),
        () = network::announce(&matter, &crypto, (site.network.as_deref(), identity.serial())) => Ok(()),
        () = relay::run(&site.socket, (&robot, ends), &node) => Ok(()),
        () = code_socket::tell(codes, invitation) => Ok(()),
    }
}

/// What the panel is told: the code as long as a home can join by it, and no longer. The stack closes the window when one has.
fn invitation(
    (code, digits): &(String, String),
    open_since: Option<Duration>,
    joined: bool,
) -> MatterInvitation {
    let window = Duration::from_secs(u64::from(MAX_COMM_WINDOW_TIMEOUT_SECS));
    let left = open_since
        .filter(|_| !joined)
        .map(|since| window.saturating_sub(since));
    let open_s = left.map_or(0, |left| u32::try_from(left.as_secs()).unwrap_or(u32::MAX));
    let while_open = |text: &String| (open_s > 0).then(|| text.clone());
    MatterInvitation {
        code: while_open(code),
        digits: while_open(digits),
        open_s,
        joined,
    }
}

fn listen_for_panel(path: Option<&Path>) -> anyhow::Result<Option<UnixListener>> {
    let Some(path) = path else { return Ok(None) };
    let unfit = |error| {
        ConfigurationError::Unfit(format!(
            "cannot listen at {}: {error}; choose another --code-socket",
            path.display()
        ))
    };
    let listener = code_socket::listen(path)
        .map_err(unfit)
        .context("the code's socket")?;
    Ok(Some(listener))
}

fn failed(what: &str) -> impl FnOnce(Error) -> anyhow::Error {
    move |error| anyhow!("{what}: {error}")
}

fn listen(port: u16) -> anyhow::Result<AsyncSocket<UdpSocket>> {
    let place = SocketAddr::from((Ipv6Addr::UNSPECIFIED, port));
    let unfit = |error| {
        ConfigurationError::Unfit(format!(
            "cannot listen on port {port}: {error}; choose another --port"
        ))
    };
    AsyncSocket::<UdpSocket>::bind(place)
        .map_err(unfit)
        .context("the socket")
}

/// Whether something is asked of this cluster of the robot.
fn is<const CLUSTER: u32>(endpoint: EndptId, asked: u32) -> bool {
    endpoint == ENDPOINT && asked == CLUSTER
}

/// The clusters behind the endpoints of [`NODE`].
fn model<'a>(robot: &'a Robot, crypto: &impl Crypto) -> Result<impl DataModel + 'a, Error> {
    let mut random = crypto.rand()?;
    let root = EthSysHandlerBuilder::new()
        .netif_diag(&SysNetifs)
        .build(&mut random);
    let mut version = || Dataver::new_rand(&mut random);
    let descriptor = DescHandler::new(version()).adapt();
    let identified = IdentifyHandler::new_with(version(), robot).adapt();
    let run_mode = RunMode {
        robot,
        version: version(),
    };
    let suction = Suction {
        robot,
        version: version(),
    };
    let operation = Operation {
        robot,
        version: version(),
    };
    let areas = Areas {
        robot,
        version: version(),
    };
    let power = Power {
        robot,
        version: version(),
    };
    Ok((
        NODE,
        root.chain(is::<{ DescHandler::CLUSTER.id }>, Async(descriptor))
            .chain(is::<{ identify::CLUSTER.id }>, Async(identified))
            .chain(
                is::<{ rvc_run_mode::FULL_CLUSTER.id }>,
                rvc_run_mode::HandlerAsyncAdaptor(run_mode),
            )
            .chain(
                is::<{ rvc_clean_mode::FULL_CLUSTER.id }>,
                Async(rvc_clean_mode::HandlerAdaptor(suction)),
            )
            .chain(
                is::<{ rvc_operational_state::FULL_CLUSTER.id }>,
                rvc_operational_state::HandlerAsyncAdaptor(operation),
            )
            .chain(
                is::<{ service_area::FULL_CLUSTER.id }>,
                Async(service_area::HandlerAdaptor(areas)),
            )
            .chain(
                is::<{ power_source::FULL_CLUSTER.id }>,
                Async(power_source::HandlerAdaptor(power)),
            ),
    ))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{ENDPOINT, NODE, invitation};

    #[test]
    fn the_panel_is_told_the_code_only_while_a_home_can_join() {
        let code = ("MT:X".to_owned(), "3497-011-2332".to_owned());
        let after = |seconds: u64, joined| invitation(&code, Some(Duration::from_secs(seconds)), joined);
        let open = after(100, false);
        assert_eq!(
            (open.code.as_deref(), open.open_s, open.joined),
            (Some("MT:X"), 800, false)
        );
        assert_eq!(open.digits.as_deref(), Some("3497-011-2332"));
        for told in [
            after(100, true),
            after(900, false),
            after(90_000, false),
            invitation(&code, None, true),
        ] {
            assert_eq!((told.code, told.digits, told.open_s), (None, None, 0));
        }
    }

    #[test]
    fn the_endpoint_has_what_a_vacuum_cleaner_must_have() {
        let endpoint = NODE.endpoints.iter().find(|endpoint| endpoint.id == ENDPOINT);
        let clusters = endpoint.expect("an endpoint").clusters;
        // Identify, run mode, operational state are mandatory; clean mode, areas and power source are its own.
        for wanted in [0x1d, 0x03, 0x54, 0x55, 0x61, 0x150, 0x2f] {
            assert!(clusters.iter().any(|cluster| cluster.id == wanted), "{wanted:#x}");
        }
    }
}
