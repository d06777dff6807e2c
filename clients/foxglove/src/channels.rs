//! The topics: those of the recordings that a client of the daemon can know, and two that only live is of use.

use std::sync::Arc;

use foxglove::messages::{FrameTransform, Grid, Log, PoseInFrame, SceneUpdate};
use foxglove::{Channel, ChannelBuilder, Context, RawChannel, Schema};
use rvac_api::{DeviceTable, Status};
use schemars::{JsonSchema, generate::SchemaSettings};

/// All of them.
pub(crate) struct Channels {
    pub(crate) pose: Channel<PoseInFrame>,
    pub(crate) transform: Channel<FrameTransform>,
    pub(crate) robot: Channel<SceneUpdate>,
    pub(crate) map: Channel<Grid>,
    pub(crate) plan: Channel<SceneUpdate>,
    pub(crate) log: Channel<Log>,
    pub(crate) status: Arc<RawChannel>,
    pub(crate) device: Arc<RawChannel>,
}

impl Channels {
    /// Offers them.
    pub(crate) fn open(context: &Arc<Context>) -> anyhow::Result<Self> {
        let named = |topic: &str| ChannelBuilder::new(topic).context(context);
        Ok(Self {
            pose: named("/pose").build(),
            transform: named("/tf").build(),
            robot: named("/robot").build(),
            map: named("/map").build(),
            plan: named("/plan").build(),
            log: named("/log").build(),
            status: plain::<Status>(named("/status"), "vthal.Status")?,
            device: plain::<DeviceTable>(named("/device"), "vthal.Device")?,
        })
    }
}

/// A channel of JSON, whose fields Foxglove offers by the schema.
fn plain<T: JsonSchema>(channel: ChannelBuilder, name: &str) -> anyhow::Result<Arc<RawChannel>> {
    let mut settings = SchemaSettings::default().for_serialize();
    settings.meta_schema = None;
    // Foxglove follows no references.
    settings.inline_subschemas = true;
    let schema = settings.into_generator().into_root_schema_for::<T>();
    let schema = Schema::new(name, "jsonschema", serde_json::to_vec(&schema)?);
    Ok(channel.message_encoding("json").schema(schema).build_raw()?)
}
