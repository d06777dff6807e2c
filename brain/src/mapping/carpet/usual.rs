//! The usual load: what the motors draw on hard floor while the robot drives in one way.
//!
//! A low quantile of marks, so that it holds in a home that is mostly carpet and also when the robot begins on a rug. Marks on
//! carpet are not taken in, so that a large carpet does not become usual; old marks are dropped, so that hair that winds itself
//! around the brush and a pack that empties do.

use std::collections::VecDeque;

/// What wheels and main brush draw, amperes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Load {
    /// Mean of both wheels.
    pub(super) wheels_a: f32,
    pub(super) brush_a: f32,
}

/// By how much a load is above the usual one, relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Excess {
    pub(super) wheels: f32,
    pub(super) brush: f32,
}

/// A way of driving: only loads of the same one are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Way {
    pub(super) brush_percent: u8,
    /// Speed in steps of 5 cm/s.
    pub(super) budget: u8,
}

/// Marks kept: two and a half minutes of steady driving.
const MARKS_MAX: usize = 300;
/// Marks before anything is said: a quarter of a minute.
const MARKS_MIN: usize = 30;
/// Share of the marks that are below the usual load.
const QUANTILE: f32 = 0.2;
/// Below this a motor's load cannot be told from the converter's noise, amperes.
const LOAD_MIN_A: f32 = 0.02;

/// Loads of one way of driving.
#[derive(Clone, Debug)]
pub(super) struct UsualLoad {
    pub(super) way: Way,
    marks: VecDeque<Load>,
    usual: Option<Load>,
}

impl UsualLoad {
    pub(super) const fn new(way: Way) -> Self {
        Self {
            way,
            marks: VecDeque::new(),
            usual: None,
        }
    }

    /// Takes in a load that is not one of carpet.
    pub(super) fn learn(&mut self, load: Load) {
        if self.marks.len() >= MARKS_MAX {
            self.marks.pop_front();
        }
        self.marks.push_back(load);
        if self.marks.len() >= MARKS_MIN {
            let low = |of: fn(&Load) -> f32| quantile(self.marks.iter().map(of), QUANTILE);
            self.usual = Some(Load {
                wheels_a: low(|load| load.wheels_a),
                brush_a: low(|load| load.brush_a),
            });
        }
    }

    /// How far a load is above the usual one; `None` while that is not known, or so small that it tells nothing.
    pub(super) fn excess(&self, load: Load) -> Option<Excess> {
        let usual = self.usual?;
        let is_told = usual.wheels_a >= LOAD_MIN_A && usual.brush_a >= LOAD_MIN_A;
        is_told.then(|| Excess {
            wheels: load.wheels_a / usual.wheels_a - 1.0,
            brush: load.brush_a / usual.brush_a - 1.0,
        })
    }
}

/// The value below which `share` of the values are; 0 of none.
pub(super) fn quantile(values: impl Iterator<Item = f32>, share: f32) -> f32 {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_by(f32::total_cmp);
    let place = (share * sorted.len() as f32) as usize;
    sorted.get(place).copied().unwrap_or_default()
}
