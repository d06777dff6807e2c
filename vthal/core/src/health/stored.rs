//! What is kept of the loads, as JSON of the file `health.json`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::consumable::{Before, Consumable, PartWork};
use super::gauge::{Gauge, MARKS};
use super::{Component, Health};
use crate::stored_version::OtherVersion;

const VERSION: u32 = 1;

/// Version and gauges by the names of their components.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredHealth {
    version: u32,
    gauges: BTreeMap<String, StoredGauge>,
    /// Absent in files of daemons that counted no hours.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    works: BTreeMap<String, StoredWork>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct StoredWork {
    worked_s: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    since_s: Option<i64>,
    #[serde(default)]
    is_told: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    before: Option<StoredBefore>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct StoredBefore {
    worked_s: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    since_s: Option<i64>,
    #[serde(default)]
    is_told: bool,
}

impl From<&PartWork> for StoredWork {
    fn from(work: &PartWork) -> Self {
        Self {
            worked_s: work.worked_s,
            since_s: work.since_s,
            is_told: work.is_told,
            before: work.before.map(|before| StoredBefore {
                worked_s: before.worked_s,
                since_s: before.since_s,
                is_told: before.is_told,
            }),
        }
    }
}

impl StoredWork {
    /// `None` when no part can have worked so.
    fn checked(&self) -> Option<PartWork> {
        let can_be = |seconds: f64| seconds.is_finite() && seconds >= 0.0;
        let work = PartWork {
            worked_s: self.worked_s,
            since_s: self.since_s,
            is_told: self.is_told,
            before: self.before.map(|before| Before {
                worked_s: before.worked_s,
                since_s: before.since_s,
                is_told: before.is_told,
            }),
        };
        let before_can_be = work.before.is_none_or(|before| can_be(before.worked_s));
        (can_be(work.worked_s) && before_can_be).then_some(work)
    }
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
    /// No part can have worked so.
    #[error("the hours of {0} cannot be: they are 0 or more")]
    Hours(&'static str),
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
        let works = Consumable::ALL
            .into_iter()
            .map(|part| (part, health.consumables.work(part)))
            .filter(|(_, work)| **work != PartWork::default())
            .map(|(part, work)| (part.name().to_owned(), StoredWork::from(work)));
        Self {
            version: VERSION,
            gauges: gauges.collect(),
            works: works.collect(),
        }
    }
}

impl TryFrom<StoredHealth> for Health {
    type Error = HealthError;

    /// A component or part that is not in it, or that this daemon does not know, starts empty.
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
        for part in Consumable::ALL {
            if let Some(stored) = stored.works.get(part.name()) {
                let work = stored.checked().ok_or(HealthError::Hours(part.name()))?;
                *health.consumables.work_mut(part) = work;
            }
        }
        Ok(health)
    }
}
