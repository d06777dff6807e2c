//! What is kept of the loads, as JSON of the file `health.json`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::gauge::{Gauge, MARKS};
use super::{Component, Health};
use crate::stored_version::OtherVersion;

const VERSION: u32 = 1;

/// Version and gauges by the names of their components.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredHealth {
    version: u32,
    gauges: BTreeMap<String, StoredGauge>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct StoredGauge {
    usual_a: Vec<f32>,
    newest_a: Vec<f32>,
    marks: u32,
}

/// Why what was kept cannot be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HealthError {
    /// Of another daemon.
    #[error(transparent)]
    Version(#[from] OtherVersion),
    /// No load can be that.
    #[error("the loads of {0} cannot be: at most {MARKS} of 0 A and above are kept of each kind")]
    Loads(&'static str),
}

impl From<&Health> for StoredHealth {
    fn from(health: &Health) -> Self {
        let gauges = Component::ALL.into_iter().map(|component| {
            let gauge = health.gauge(component);
            let stored = StoredGauge {
                usual_a: gauge.usual_a.clone(),
                newest_a: gauge.newest_a.iter().copied().collect(),
                marks: gauge.marks,
            };
            (component.name().to_owned(), stored)
        });
        Self {
            version: VERSION,
            gauges: gauges.collect(),
        }
    }
}

impl TryFrom<StoredHealth> for Health {
    type Error = HealthError;

    /// A component that is not in it, or that this daemon does not know, starts empty.
    fn try_from(stored: StoredHealth) -> Result<Self, HealthError> {
        OtherVersion::expect(stored.version, VERSION)?;
        let mut health = Self::default();
        for component in Component::ALL {
            let Some(gauge) = stored.gauges.get(component.name()) else {
                continue;
            };
            let all = || gauge.usual_a.iter().chain(&gauge.newest_a);
            let fit = gauge.usual_a.len() <= MARKS && gauge.newest_a.len() <= MARKS;
            if !fit || all().any(|load_a| !load_a.is_finite() || *load_a < 0.0) {
                return Err(HealthError::Loads(component.name()));
            }
            let newest_a = gauge.newest_a.iter().copied().collect();
            *health.gauge_mut(component) = Gauge::kept(gauge.usual_a.clone(), newest_a, gauge.marks);
        }
        Ok(health)
    }
}
