//! Whether the robot is on carpet, by what its motors draw.
//!
//! *Load*: what the wheels and the main brush draw. *Steady*: ahead, as good as straight and at one speed, with nothing in the
//! way; only then do the loads of both tell of the floor. *Usual load*: the load of the same way of driving on this home's hard
//! floor, see [`usual`]. *Excess*: by how much a load is above the usual one, relative.
//!
//! A pile takes force from a wheel that rolls in it and from bristles that turn in it. A robot of this class was pulled over a
//! loop pile with 18 N (robotreviews.com, topic 16830), and makers tell floors by steps of the roller's current above a base
//! (US 11882986). Both must be in excess here, because each alone has other reasons: a slope, a threshold or a chair that is
//! pushed loads the wheels, hair loads the brush. In simulated homes flat mats raise the wheels' load by some 45 % and the
//! brush's by 35 %, deep piles by 200 % and 100 %, over readings that scatter by less than 5 %.
//!
//! What it does not tell: carpet in a home that has nothing else, since loads are compared and not known beforehand; it then
//! says nothing at all. A robot that does not measure its currents is told of as such and never as one without carpets.

mod steady;
mod usual;

use crate::model::observation::Observation;
use steady::{Drawn, SteadyWatch};
use usual::{Load, UsualLoad, Way};

/// What lies under the brush.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FloorKind {
    /// Hard floor, or whatever the home has most of.
    Hard,
    /// A rug or a carpet.
    Carpet,
}

/// What was felt, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FloorFelt {
    pub(crate) kind: FloorKind,
    /// So far behind the robot it was, in millimetres: loads are looked at for a while before they are believed.
    pub(crate) behind_mm: u8,
}

/// Least excess of carpet, and that below which it ends. Half of what the flattest mats add, and four times the scatter.
const EXCESS_ON: f32 = 0.20;
const EXCESS_OFF: f32 = 0.12;
/// A mark of the usual load is taken this often, microseconds.
const MARK_US: u64 = 500_000;
/// Marks on carpet from which on the robot knows both kinds of floor, and may say of one that it is hard: half a metre of way.
const CONTRAST_MARKS: u32 = 4;
/// Ways of driving whose usual loads are kept: powers of the brush and speeds.
const WAYS_MAX: usize = 6;

/// Decides from observations what the robot is on.
#[derive(Clone, Debug, Default)]
pub(crate) struct CarpetSense {
    watch: SteadyWatch,
    /// The one used last is the last.
    usual: Vec<UsualLoad>,
    is_on_carpet: bool,
    carpet_marks: u32,
    marked_us: u64,
}

impl CarpetSense {
    /// Takes an observation in; `brush_percent` is the power of the main brush, `None` while it rests or nobody knows it.
    pub(crate) fn feel(&mut self, observation: &Observation, brush_percent: Option<u8>) -> Option<FloorFelt> {
        let Some(drawn) = self.watch.take(observation, brush_percent) else {
            self.is_on_carpet = false;
            return None;
        };
        let kind = match drawn.way {
            Some(way) => self.judge(observation.time_us, way, drawn.load),
            None => self.lasts(&drawn).then_some(FloorKind::Carpet),
        };
        self.is_on_carpet = kind == Some(FloorKind::Carpet);
        kind.map(|kind| FloorFelt {
            kind,
            behind_mm: drawn.behind_mm,
        })
    }

    /// What a load of steady driving says. Of a home that seems to be all alike nothing is said.
    fn judge(&mut self, now_us: u64, way: Way, load: Load) -> Option<FloorKind> {
        let is_mark = now_us >= self.marked_us.saturating_add(MARK_US);
        if is_mark {
            self.marked_us = now_us;
        }
        let least = if self.is_on_carpet { EXCESS_OFF } else { EXCESS_ON };
        let usual = self.usual_of(way);
        let excess = usual.excess(load);
        let is_carpet = excess.is_some_and(|excess| excess.wheels >= least && excess.brush >= least);
        if is_mark && !is_carpet {
            usual.learn(load);
        }
        self.carpet_marks = self.carpet_marks.saturating_add(u32::from(is_mark && is_carpet));
        match excess? {
            _ if is_carpet => Some(FloorKind::Carpet),
            _ if self.carpet_marks >= CONTRAST_MARKS => Some(FloorKind::Hard),
            _ => None,
        }
    }

    /// Carpet that was felt in steady driving goes on in curves and against things as long as the brush stays loaded: what loads
    /// the wheels there does not load the brush.
    fn lasts(&self, drawn: &Drawn) -> bool {
        let same_power = |usual: &&UsualLoad| usual.way.brush_percent == drawn.brush_percent;
        let usual = self.usual.iter().rev().find(same_power);
        let excess = usual.and_then(|usual| usual.excess(drawn.load));
        self.is_on_carpet && excess.is_some_and(|excess| excess.brush >= EXCESS_ON)
    }

    fn usual_of(&mut self, way: Way) -> &mut UsualLoad {
        let known = self.usual.iter().position(|usual| usual.way == way);
        let usual = match known {
            Some(place) => self.usual.remove(place),
            None => UsualLoad::new(way),
        };
        if self.usual.len() >= WAYS_MAX {
            self.usual.remove(0);
        }
        let last = self.usual.len();
        self.usual.push(usual);
        &mut self.usual[last]
    }
}

#[cfg(test)]
mod layer_tests;
#[cfg(test)]
mod tests;
