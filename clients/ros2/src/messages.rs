//! Messages of ROS 2, as in their `.msg` and `.srv` files: the fields in the order in which they are sent. Metres, radians, seconds, frames
//! by REP-103 and REP-105.

use ros2_client::Message;
use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

/// A 6 by 6 matrix, row by row: x, y, z, then the turns about them.
pub(crate) const COVARIANCE: usize = 36;

macro_rules! messages {
    ($($(#[$about:meta])* $name:ident { $($(#[$with:meta])* $field:ident: $kind:ty,)* })*) => {
        $(
            $(#[$about])*
            #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
            pub(crate) struct $name {
                $($(#[$with])* pub(crate) $field: $kind,)*
            }
            impl Message for $name {}
        )*
    };
}

messages! {
    /// builtin_interfaces/Time
    Time { sec: i32, nanosec: u32, }
    /// std_msgs/Header
    Header { stamp: Time, frame_id: String, }
    /// geometry_msgs/Point and Vector3, which are sent alike
    Vector3 { x: f64, y: f64, z: f64, }
    /// geometry_msgs/Quaternion
    Quaternion { x: f64, y: f64, z: f64, w: f64, }
    /// geometry_msgs/Pose and Transform, which are sent alike
    Pose { position: Vector3, orientation: Quaternion, }
    /// geometry_msgs/Twist
    Twist { linear: Vector3, angular: Vector3, }
    /// geometry_msgs/TwistStamped
    TwistStamped { header: Header, twist: Twist, }
    /// geometry_msgs/PoseStamped
    PoseStamped { header: Header, pose: Pose, }
    /// geometry_msgs/PoseWithCovariance
    PoseWithCovariance { pose: Pose, #[serde(with = "BigArray")] covariance: [f64; COVARIANCE], }
    /// geometry_msgs/PoseWithCovarianceStamped
    PoseWithCovarianceStamped { header: Header, pose: PoseWithCovariance, }
    /// geometry_msgs/TwistWithCovariance
    TwistWithCovariance { twist: Twist, #[serde(with = "BigArray")] covariance: [f64; COVARIANCE], }
    /// geometry_msgs/TransformStamped
    TransformStamped { header: Header, child_frame_id: String, transform: Pose, }
    /// tf2_msgs/TFMessage
    Transforms { transforms: Vec<TransformStamped>, }
    /// nav_msgs/Odometry
    Odometry { header: Header, child_frame_id: String, pose: PoseWithCovariance, twist: TwistWithCovariance, }
    /// nav_msgs/MapMetaData
    MapMetaData { map_load_time: Time, resolution: f32, width: u32, height: u32, origin: Pose, }
    /// nav_msgs/OccupancyGrid
    OccupancyGrid { header: Header, info: MapMetaData, data: Vec<i8>, }
    /// nav_msgs/Path
    Path { header: Header, poses: Vec<PoseStamped>, }
    /// sensor_msgs/BatteryState
    BatteryState {
        header: Header,
        voltage: f32,
        temperature: f32,
        current: f32,
        charge: f32,
        capacity: f32,
        design_capacity: f32,
        percentage: f32,
        power_supply_status: u8,
        power_supply_health: u8,
        power_supply_technology: u8,
        present: bool,
        cell_voltage: Vec<f32>,
        cell_temperature: Vec<f32>,
        location: String,
        serial_number: String,
    }
    /// diagnostic_msgs/KeyValue
    KeyValue { key: String, value: String, }
    /// diagnostic_msgs/DiagnosticStatus
    DiagnosticStatus {
        level: u8,
        name: String,
        message: String,
        hardware_id: String,
        values: Vec<KeyValue>,
    }
    /// diagnostic_msgs/DiagnosticArray
    DiagnosticArray { header: Header, status: Vec<DiagnosticStatus>, }
    /// std_srvs/Trigger, what is asked: nothing, for which the middleware sends a byte
    TriggerRequest { structure_needs_at_least_one_member: u8, }
    /// std_srvs/Trigger, what is answered
    TriggerResponse { success: bool, message: String, }
}

impl Vector3 {
    /// On the floor.
    pub(crate) const fn flat(x: f64, y: f64) -> Self {
        Self { x, y, z: 0.0 }
    }
}

impl Twist {
    pub(crate) const STOP: Self = Self {
        linear: Vector3::flat(0.0, 0.0),
        angular: Vector3::flat(0.0, 0.0),
    };

    pub(crate) fn is_zero(&self) -> bool {
        *self == Self::STOP
    }
}

impl Quaternion {
    /// A turn about the vertical, radians counter-clockwise.
    pub(crate) fn of_heading(heading_rad: f64) -> Self {
        let (z, w) = (heading_rad / 2.0).sin_cos();
        Self { x: 0.0, y: 0.0, z, w }
    }
}
