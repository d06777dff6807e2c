//! The robot's node: what it publishes, what it listens to, what can be asked of it.

use std::net::IpAddr;

use anyhow::Context as _;
use ros2_client::action::{ActionServerQosPolicies, AsyncActionServer};
use ros2_client::dds::rustdds::DomainParticipantBuilder;
use ros2_client::qos::{Durability, History, WhenFull};
use ros2_client::{
    ActionTypeName, Context, Message, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher,
    QosProfile, Server, ServiceMapping, ServiceTypeName, Subscription,
};
use serde::Serialize;

use crate::docking::{DockFeedback, DockGoal, DockResult};
use crate::messages::{
    BatteryState, DiagnosticArray, OccupancyGrid, Odometry, Path, PoseWithCovarianceStamped, Transforms,
    TriggerRequest, TriggerResponse, Twist, TwistStamped,
};
use crate::order::Order;

/// Name of the node.
const NODE: &str = "vacuum";

/// A server of `std_srvs/Trigger`.
pub(crate) type TriggerServer = Server<TriggerRequest, TriggerResponse>;

/// A server of `nav2_msgs/DockRobot`.
pub(crate) type DockServer = AsyncActionServer<DockGoal, DockResult, DockFeedback>;

/// How services go over DDS: implementations of ROS 2 differ in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Middleware {
    /// Fast DDS, the default of ROS 2 (`rmw_fastrtps_cpp`)
    Fast,
    /// Cyclone DDS (`rmw_cyclonedds_cpp`)
    Cyclone,
}

impl Middleware {
    const fn mapping(self) -> ServiceMapping {
        match self {
            Self::Fast => ServiceMapping::Enhanced,
            Self::Cyclone => ServiceMapping::Cyclone,
        }
    }
}

/// Where the node lives.
#[derive(Clone, Debug)]
pub(crate) struct Site {
    /// `ROS_DOMAIN_ID`.
    pub(crate) domain: u16,
    /// With a slash at its beginning.
    pub(crate) namespace: String,
    /// Addresses of the networks to use; none = all.
    pub(crate) networks: Vec<IpAddr>,
    pub(crate) middleware: Middleware,
}

/// Everything that the robot says.
pub(crate) struct Publishers {
    pub(crate) transforms: Publisher<Transforms>,
    pub(crate) odometry: Publisher<Odometry>,
    pub(crate) pose: Publisher<PoseWithCovarianceStamped>,
    pub(crate) map: Publisher<OccupancyGrid>,
    pub(crate) plan: Publisher<Path>,
    pub(crate) battery: Publisher<BatteryState>,
    pub(crate) diagnostics: Publisher<DiagnosticArray>,
}

/// Everything that it listens to.
pub(crate) struct Listeners {
    pub(crate) velocity: Subscription<Twist>,
    pub(crate) stamped: Subscription<TwistStamped>,
    pub(crate) orders: Vec<(Order, TriggerServer)>,
    pub(crate) docking: DockServer,
}

/// The node with all its ends.
pub(crate) struct Robot {
    pub(crate) node: Node,
    pub(crate) publishers: Publishers,
    pub(crate) listeners: Listeners,
}

/// Joins the domain.
pub(crate) fn join(site: &Site) -> anyhow::Result<Robot> {
    let mut builder = DomainParticipantBuilder::new(site.domain);
    if !site.networks.is_empty() {
        builder = builder.with_only_networks(site.networks.iter().copied());
    }
    let participant = builder
        .build()
        .with_context(|| format!("cannot join domain {}", site.domain))?;
    let context = Context::from_domain_participant(participant)?;
    let name = NodeName::new(&site.namespace, NODE)
        .with_context(|| format!("the namespace {:?}", site.namespace))?;
    // The robot has no parameters, and says what is wrong in /diagnostics.
    let options = NodeOptions::new()
        .enable_rosout(false)
        .start_parameter_services(false);
    let mut node = context.new_node(name, options)?;
    let publishers = publishers(&mut node)?;
    let listeners = listeners(&mut node, site.middleware)?;
    Ok(Robot {
        node,
        publishers,
        listeners,
    })
}

fn publishers(node: &mut Node) -> anyhow::Result<Publishers> {
    let stream = reliable(10);
    // Whoever comes late gets the last one: a map, a state.
    let latched = reliable(1).durability(Durability::TransientLocal);
    Ok(Publishers {
        // Two of the whole system, whatever the robot's namespace.
        transforms: publisher(node, "/tf", ("tf2_msgs", "TFMessage"), &reliable(100))?,
        diagnostics: publisher(
            node,
            "/diagnostics",
            ("diagnostic_msgs", "DiagnosticArray"),
            &stream,
        )?,
        odometry: publisher(node, "odom", ("nav_msgs", "Odometry"), &stream)?,
        pose: publisher(
            node,
            "pose",
            ("geometry_msgs", "PoseWithCovarianceStamped"),
            &latched,
        )?,
        map: publisher(node, "map", ("nav_msgs", "OccupancyGrid"), &latched)?,
        plan: publisher(node, "plan", ("nav_msgs", "Path"), &latched)?,
        battery: publisher(node, "battery_state", ("sensor_msgs", "BatteryState"), &stream)?,
    })
}

fn listeners(node: &mut Node, middleware: Middleware) -> anyhow::Result<Listeners> {
    // The newest counts. Best effort hears reliable publishers, too.
    let newest = QosProfile::subscription_default()
        .reliability_best_effort()
        .history(History::KeepLast { depth: 1 });
    let velocity = subscription(node, "cmd_vel", "Twist", &newest)?;
    let stamped = subscription(node, "cmd_vel_stamped", "TwistStamped", &newest)?;
    let mut orders = Vec::new();
    for order in Order::ALL {
        let name = placed(node, order.service())?;
        let server = node.create_server(
            middleware.mapping(),
            &name,
            &ServiceTypeName::new("std_srvs", "Trigger"),
            reliable(10),
            reliable(10),
        )?;
        orders.push((order, server));
    }
    let docking = docking(node, middleware)?;
    Ok(Listeners {
        velocity,
        stamped,
        orders,
        docking,
    })
}

fn docking(node: &mut Node, middleware: Middleware) -> anyhow::Result<DockServer> {
    let name = placed(node, "dock_robot")?;
    let qos = ActionServerQosPolicies {
        goal_service: reliable(10),
        result_service: reliable(10),
        cancel_service: reliable(10),
        feedback_publisher: reliable(10),
        // Whoever comes late sees which goals there are.
        status_publisher: reliable(1).durability(Durability::TransientLocal),
    };
    let kind = ActionTypeName::new("nav2_msgs", "DockRobot");
    let server = node.create_action_server(middleware.mapping(), &name, &kind, qos)?;
    Ok(AsyncActionServer::new(server))
}

/// A name in the robot's namespace, unless it begins with a slash. Always absolute: relative names of a node in `/` get a slash too many.
fn placed(node: &Node, name: &str) -> anyhow::Result<Name> {
    Ok(match name.strip_prefix('/') {
        Some(name) => Name::new("/", name)?,
        None => Name::new(node.namespace(), name)?,
    })
}

/// Reliable, without ever waiting for a reader that is slow: it misses some.
fn reliable(depth: usize) -> QosProfile {
    QosProfile::publisher_default()
        .reliability_reliable(WhenFull::Fail)
        .durability(Durability::Volatile)
        .history(History::KeepLast { depth })
}

fn publisher<M: Message + Serialize>(
    node: &mut Node,
    name: &str,
    (package, kind): (&str, &str),
    qos: &QosProfile,
) -> anyhow::Result<Publisher<M>> {
    let name = placed(node, name)?;
    let topic = node.create_topic(&name, MessageTypeName::new(package, kind), qos)?;
    Ok(node.create_publisher(&topic, None)?)
}

fn subscription<M: Message + 'static>(
    node: &mut Node,
    name: &str,
    kind: &str,
    qos: &QosProfile,
) -> anyhow::Result<Subscription<M>> {
    let name = placed(node, name)?;
    let topic = node.create_topic(&name, MessageTypeName::new("geometry_msgs", kind), qos)?;
    Ok(node.create_subscription(&topic, None)?)
}
