//! JSON schemas of the channels: what Foxglove needs to offer the fields by name, and to draw what is its own.

use rvac_api::{DeviceTable, Status};
use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

use super::format::{Answered, Given, RunHeader, Seen, SentPacket};
use super::foxglove::{FrameTransform, Log, PoseInFrame, SceneUpdate};
use super::{COMMANDS, DECISIONS, DEVICE, LOG, OBSERVATIONS, PACKETS, POSE, ROBOT, RUN, STATUS, TRANSFORM};

/// A channel of a recording.
pub(super) struct Channel {
    pub(super) topic: &'static str,
    /// Name of the schema.
    pub(super) name: &'static str,
    pub(super) schema: Schema,
}

/// All channels of a recording.
pub(super) fn channels() -> [Channel; 11] {
    [
        channel::<RunHeader>(RUN, "vthal.Run"),
        channel::<Seen>(OBSERVATIONS, "vthal.Observation"),
        channel::<Given>(COMMANDS, "vthal.Command"),
        channel::<Answered<'_>>(DECISIONS, "vthal.Actions"),
        channel::<SentPacket<'_>>(PACKETS, "vthal.Packet"),
        channel::<Status>(STATUS, "vthal.Status"),
        channel::<DeviceTable>(DEVICE, "vthal.Device"),
        channel::<PoseInFrame>(POSE, "foxglove.PoseInFrame"),
        channel::<FrameTransform>(TRANSFORM, "foxglove.FrameTransform"),
        channel::<SceneUpdate>(ROBOT, "foxglove.SceneUpdate"),
        channel::<Log<'_>>(LOG, "foxglove.Log"),
    ]
}

fn channel<T: JsonSchema>(topic: &'static str, name: &'static str) -> Channel {
    let settings = SchemaSettings::default().for_serialize().with_transform(plain);
    let settings = settings.with(|settings| {
        settings.meta_schema = None;
        // Foxglove follows no references.
        settings.inline_subschemas = true;
    });
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".to_owned(), name.into());
    Channel { topic, name, schema }
}

/// Foxglove supports neither unions nor null types, and readers of a recording need neither descriptions nor defaults.
fn plain(schema: &mut Schema) {
    let object = schema.ensure_object();
    object.remove("description");
    object.remove("default");
    if let Some(present) = object.get("type").and_then(|kinds| kinds.get(0)).cloned() {
        object.insert("type".to_owned(), present);
    }
    if let Some(choices) = object.remove("anyOf")
        && let Some(present) = choices.get(0).and_then(|choice| choice.as_object())
    {
        object.extend(present.clone());
    }
    transform_subschemas(&mut plain, schema);
}

/// A list of what is drawn nowhere.
pub(super) fn list(_: &mut SchemaGenerator) -> Schema {
    json_schema!({"type": "array"})
}
