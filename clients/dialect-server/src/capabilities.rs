//! What the robot can do, by the names of the dialect, and what is asked for each.

use std::net::IpAddr;

use bridge::FanSpeed;
use dialect::Frame;
use rvac_api::RequestBody;
use serde_json::{Value, json};
use tokio::time::Instant;

use crate::answer::Refusal;
use crate::desk::Asked;
use crate::reads::{self, CONSUMABLES};
use crate::site::{Site, Store};

/// The closed set of what is spoken here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Capability {
    BasicControl,
    FanSpeed,
    Segmentation,
    Zones,
    Restrictions,
    SegmentEdit,
    SegmentRename,
    Snapshots,
    Consumables,
    CurrentStatistics,
    TotalStatistics,
    Locate,
    GoTo,
    ManualControl,
}

impl Capability {
    const ALL: [(&'static str, Self); 14] = [
        ("BasicControlCapability", Self::BasicControl),
        ("FanSpeedControlCapability", Self::FanSpeed),
        ("MapSegmentationCapability", Self::Segmentation),
        ("ZoneCleaningCapability", Self::Zones),
        ("CombinedVirtualRestrictionsCapability", Self::Restrictions),
        ("MapSegmentEditCapability", Self::SegmentEdit),
        ("MapSegmentRenameCapability", Self::SegmentRename),
        ("MapSnapshotCapability", Self::Snapshots),
        ("ConsumableMonitoringCapability", Self::Consumables),
        ("CurrentStatisticsCapability", Self::CurrentStatistics),
        ("TotalStatisticsCapability", Self::TotalStatistics),
        ("LocateCapability", Self::Locate),
        ("GoToLocationCapability", Self::GoTo),
        ("HighResolutionManualControlCapability", Self::ManualControl),
    ];

    /// Whether the robot has what it needs.
    fn is_had(self, store: &Store) -> bool {
        let robot = store.known.robot.as_ref();
        let has = |part: &str| robot.is_some_and(|robot| robot.parts.iter().any(|own| own == part));
        match self {
            Self::FanSpeed => robot.is_some_and(FanSpeed::is_had_by),
            Self::Locate => has("beeper"),
            Self::Consumables => has("currents"),
            Self::ManualControl => {
                robot.is_some_and(|robot| robot.lacking.iter().all(|lack| lack.ability != "drive"))
            }
            _ => true,
        }
    }

    /// The one of this name, if the robot has it.
    pub(crate) fn named(name: &str, store: &Store) -> Option<Self> {
        let row = Self::ALL.into_iter().find(|(known, _)| *known == name);
        row.map(|(_, capability)| capability)
            .filter(|capability| capability.is_had(store))
    }

    /// The names of all that the robot has.
    pub(crate) fn names(store: &Store) -> Vec<&'static str> {
        let had = Self::ALL.into_iter().filter(|(_, one)| one.is_had(store));
        had.map(|(name, _)| name).collect()
    }
}

/// Answers a read.
pub(crate) async fn read(site: &Site, capability: Capability, rest: &str) -> Result<Value, Refusal> {
    match (capability, rest) {
        (Capability::Snapshots, "") => match site.ask(RequestBody::Maps { floor: None }).await? {
            Asked::Maps(maps) => Ok(reads::snapshots(&maps)),
            Asked::Done => Ok(json!([])),
        },
        (Capability::ManualControl, "") => Ok(json!({"enabled": site.driving().is_enabled()})),
        _ => match reads::capability(capability, rest, &site.store()) {
            Some(told) => Ok(told),
            None if is_command(capability, rest) => Err(Refusal::Method("PUT")),
            None => Err(Refusal::NotFound),
        },
    }
}

/// Whether commands go to this place.
fn is_command(capability: Capability, rest: &str) -> bool {
    match capability {
        Capability::FanSpeed => rest == "preset",
        Capability::Consumables => consumable(rest).is_some(),
        Capability::CurrentStatistics | Capability::TotalStatistics => false,
        _ => rest.is_empty(),
    }
}

fn consumable(rest: &str) -> Option<&'static [&'static str]> {
    let part = CONSUMABLES
        .iter()
        .find(|part| rest.split_once('/') == Some((part.kind, part.sub_kind)));
    part.map(|part| part.components)
}

/// The word of `action` must be this one.
fn action(body: &Value, known: &'static str) -> Result<(), Refusal> {
    let is_it = body.get("action").is_some_and(|action| action == known);
    is_it.then_some(()).ok_or(Refusal::Word {
        field: "action",
        known,
    })
}

/// Does a command of the client at `by`.
pub(crate) async fn command(
    site: &Site,
    (capability, rest): (Capability, &str),
    body: &Value,
    by: IpAddr,
) -> Result<(), Refusal> {
    if !is_command(capability, rest) {
        let is_read = reads::capability(capability, rest, &site.store()).is_some();
        return Err(if is_read {
            Refusal::Method("GET, HEAD")
        } else {
            Refusal::NotFound
        });
    }
    if capability == Capability::ManualControl {
        return control_by_hand(site, body, by).await;
    }
    let asked = requests(site, (capability, rest), body)?;
    // A stop is never too much.
    if asked != [RequestBody::Stop] {
        site.count_command()?;
    }
    if capability == Capability::FanSpeed {
        site.set_speed(speed(body)?);
    }
    for request in asked {
        site.ask(request).await?;
    }
    Ok(())
}

fn speed(body: &Value) -> Result<FanSpeed, Refusal> {
    let name = body.get("name").and_then(Value::as_str);
    name.and_then(dialect::preset_named).ok_or(Refusal::Word {
        field: "name",
        known: "custom, low, medium, max",
    })
}

/// What the daemon is asked for a command.
fn requests(
    site: &Site,
    (capability, rest): (Capability, &str),
    body: &Value,
) -> Result<Vec<RequestBody>, Refusal> {
    let frame = site.frame();
    let store = site.store();
    let frame = frame.as_ref();
    Ok(vec![match capability {
        Capability::BasicControl => reads::operation(body)
            .ok_or(Refusal::Word {
                field: "action",
                known: reads::OPERATIONS,
            })?
            .request(&store.known, store.speed),
        Capability::FanSpeed => {
            speed(body)?;
            return Ok(Vec::new());
        }
        Capability::Segmentation => {
            action(body, "start_segment_action")?;
            dialect::with_speed(dialect::clean_segments(body)?, store.speed)
        }
        Capability::Zones => {
            action(body, "clean")?;
            dialect::with_speed(dialect::clean_zones(body, frame)?, store.speed)
        }
        Capability::Restrictions => {
            let (home, frame) = store
                .known
                .home
                .as_ref()
                .zip(frame)
                .ok_or(dialect::BodyError::NoMap)?;
            return Ok(dialect::restriction_changes(home, *frame, body)?);
        }
        Capability::SegmentEdit => segment_edit(body, frame)?,
        Capability::SegmentRename => {
            action(body, "rename_segment")?;
            dialect::rename_segment(body)?
        }
        Capability::Snapshots => {
            action(body, "restore")?;
            RequestBody::RestoreMap {
                number: snapshot(body)?,
                floor: None,
            }
        }
        Capability::Consumables => {
            action(body, "reset")?;
            let components = consumable(rest).unwrap_or_default();
            return Ok(reads::resets(components));
        }
        Capability::GoTo => {
            action(body, "goto")?;
            dialect::go_to(body, frame)?
        }
        Capability::Locate => {
            action(body, "locate")?;
            RequestBody::Locate
        }
        Capability::CurrentStatistics | Capability::TotalStatistics | Capability::ManualControl => {
            return Err(Refusal::NotFound);
        }
    }])
}

fn segment_edit(body: &Value, frame: Option<&Frame>) -> Result<RequestBody, Refusal> {
    match body.get("action").and_then(Value::as_str) {
        Some("join_segments") => Ok(dialect::join_segments(body)?),
        Some("split_segment") => Ok(dialect::split_segment(body, frame)?),
        _ => Err(Refusal::Word {
            field: "action",
            known: "join_segments, split_segment",
        }),
    }
}

fn snapshot(body: &Value) -> Result<u64, Refusal> {
    let number = match body.get("id") {
        Some(Value::String(text)) => text.parse().ok(),
        Some(value) => value.as_u64(),
        None => None,
    };
    number.ok_or(Refusal::Word {
        field: "id",
        known: "the ids that GET lists",
    })
}

async fn control_by_hand(site: &Site, body: &Value, by: IpAddr) -> Result<(), Refusal> {
    match body.get("action").and_then(Value::as_str) {
        Some("enable") => site.driving().enable(by, Instant::now()),
        Some("disable") => {
            site.driving().disable();
            // The wheels are braked at once, not when the lease ends.
            site.ask(RequestBody::Release).await.map(drop)
        }
        Some("move") => site.drive(dialect::stick(body)?, by).await,
        _ => Err(Refusal::Word {
            field: "action",
            known: "enable, disable, move",
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::{Capability, is_command};
    use crate::site::Store;

    #[test]
    fn a_robot_offers_what_it_has() {
        let store = Store::default();
        let names = Capability::names(&store);
        assert!(names.contains(&"BasicControlCapability"));
        for lacking in [
            "LocateCapability",
            "FanSpeedControlCapability",
            "HighResolutionManualControlCapability",
        ] {
            assert!(!names.contains(&lacking), "{lacking}");
            assert_eq!(Capability::named(lacking, &store), None);
        }
        assert!(names.contains(&"GoToLocationCapability"));
        assert_eq!(Capability::named("MapResetCapability", &store), None);
        assert!(is_command(Capability::Consumables, "brush/main"));
        for nowhere in ["", "brush", "brush/main/", "brush/side_left"] {
            assert!(!is_command(Capability::Consumables, nowhere), "{nowhere}");
        }
    }
}
