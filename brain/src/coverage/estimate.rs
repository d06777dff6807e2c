//! What a job will take, estimated before it begins.

use super::order_reach::{OrderRefusal, ReachQuestion};
use super::parameters::{ESTIMATE, MARGINS};
use super::plan::{Area, CoveragePlan, Departure, PlanSettings, plan_area};
use super::target_floor::TargetFloor;
use crate::mapping::{Cell, CellKnowledge, HomeFloor, Map, Raster};
use crate::model::config::BrainConfig;
use crate::model::edit_error::EditError;
use crate::model::energy::{EnergyModel, PackUse, time_to_return_s};
use crate::model::geometry::Pose2;
use crate::model::gradual::StepBudget;
use crate::model::job_refusal::JobRefusal;
use crate::model::order::{CleaningOrder, HomePart};
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{Inflation, reachable};

/// Work to ask whether a cell lies in a part of an order.
const LOOK_WORK: usize = 10;
/// Work to weigh the gaps that two lanes leave in a cell, for both bounds.
const GAP_WORK: usize = 100;

/// The estimate of a job.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobEstimate {
    /// Floor that can be swept, each part counted once, square metres.
    pub floor_m2: f64,
    /// Time, seconds.
    pub time_s: f64,
    /// Share of a full charge that the job and the return to the dock take.
    pub charge: f64,
    /// How often the robot must recharge in between, from what the pack holds now.
    pub recharges: u32,
    /// Share of `floor_m2` that is expected to be swept, 0..=1.
    pub share: f64,
    /// The same if the pose is half as accurate as estimated.
    pub share_low: f64,
}

/// Where and with which robot a job is to be done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JobConditions<'brain> {
    pub(crate) map: &'brain Map,
    /// Pose in which the robot starts, and whether it is sure of it: if not, it does not know what it can reach from there.
    pub(crate) start: Pose2,
    pub(crate) is_sure: bool,
    pub(crate) config: &'brain BrainConfig,
    pub(crate) energy: &'brain EnergyModel,
    /// What the pack holds, 0..=1; `None` = not known, and taken to be as much as after a recharge.
    pub(crate) charge: Option<f64>,
}

/// What an estimate is made of, as it was when somebody asked: the map may change while it is made.
#[derive(Debug)]
pub(crate) struct EstimateBasis {
    order: CleaningOrder,
    start: Pose2,
    is_sure: bool,
    settings: PlanSettings,
    /// Radius of the body, without and with clearance.
    body_m: f64,
    radius_m: f64,
    /// Charge of a full pack.
    full: f64,
    energy: EnergyModel,
    held: Option<f64>,
    frame: LaneFrame,
    home: HomeFloor,
}

impl EstimateBasis {
    /// What the estimate of `order` under these conditions needs. Whether it can be carried out is for the estimate itself to say: that
    /// takes as long.
    pub(crate) fn of(order: &CleaningOrder, conditions: JobConditions<'_>) -> Self {
        let JobConditions {
            map,
            start,
            is_sure,
            config,
            energy,
            charge,
        } = conditions;
        Self {
            order: order.clone(),
            start,
            is_sure,
            settings: plan_settings(config),
            body_m: config.body.radius_m,
            radius_m: config.body.radius_m + MARGINS.clearance_m,
            full: f64::from(config.battery_charged),
            energy: *energy,
            held: charge,
            frame: LaneFrame::along(map.wall_direction_rad().unwrap_or(0.0)),
            home: map.home_floor(),
        }
    }

    /// What the order takes.
    ///
    /// # Errors
    /// Why the order cannot be carried out in this home, or that there is no floor that can be swept.
    pub(crate) async fn estimate(self, budget: &mut StepBudget) -> Result<JobEstimate, OrderRefusal> {
        self.admit(budget).await?;
        let inflation = Inflation {
            radius_m: self.radius_m,
            blocked: &[],
        };
        let open = self.home.avoiding(self.order.avoid(), budget).await;
        let reachable_cells = reachable(&open, &self.frame, inflation, budget).await;
        let estimator = PartEstimator {
            basis: &self,
            reachable_cells,
        };
        let mut sum = OrderTotal::at(self.start);
        let whole = self.order.is_for_whole_home().then_some(None);
        for part in whole.into_iter().chain(self.order.parts().iter().map(Some)) {
            sum.add(estimator.part(part, sum.pose, budget).await);
        }
        if sum.floor_m2 > 0.0 {
            return Ok(self.result(&sum));
        }
        let reason = if self.home.has_floor() {
            JobRefusal::RestOutOfReach
        } else {
            EditError::NoMap.into()
        };
        Err(reason.into())
    }

    /// As the order itself is admitted.
    async fn admit(&self, budget: &mut StepBudget) -> Result<(), OrderRefusal> {
        let admitted = self.home.admit_order(&self.order, budget).await;
        admitted.map_err(JobRefusal::from)?;
        let question = ReachQuestion {
            order: &self.order,
            home: &self.home,
            from: self.start.position(),
            radius_m: self.body_m,
        };
        if self.is_sure
            && let Err(reason) = question.admit(budget).await
        {
            return Err(question.refusal(reason, budget).await);
        }
        Ok(())
    }

    fn result(&self, sum: &OrderTotal) -> JobEstimate {
        let home_m = self
            .home
            .dock()
            .map(|dock| sum.pose.position().distance_m(dock.position()));
        let cruise_m_per_s = self.settings.cruise_m_per_s;
        let home_s = home_m.map_or(0.0, |home_m| time_to_return_s(home_m, cruise_m_per_s));
        let pack = PackUse {
            held: self.held.unwrap_or(self.full),
            recharged: self.full,
            least: self
                .energy
                .charge_to_return(home_m.unwrap_or_default(), cruise_m_per_s),
        };
        JobEstimate {
            floor_m2: sum.floor_m2,
            time_s: sum.time_s,
            charge: self.energy.charge_for(sum.time_s, home_s),
            recharges: pack.recharges(self.energy.charge_for(sum.time_s, 0.0)),
            share: sum.swept_m2 / sum.floor_m2,
            share_low: sum.swept_low_m2 / sum.floor_m2,
        }
    }
}

/// What the lanes are planned by, for a robot that keeps its place as well as one can.
fn plan_settings(config: &BrainConfig) -> PlanSettings {
    PlanSettings {
        swath_m: config.body.swath_m,
        sigma_m: MARGINS.sigma_min_m,
        cruise_m_per_s: config.speeds.cruise_m_per_s,
        turn_rad_per_s: config.speeds.turn_max_rad_per_s,
        takes_along: true,
    }
}

/// The total over the parts of an order.
#[derive(Clone, Copy, Debug)]
struct OrderTotal {
    pose: Pose2,
    floor_m2: f64,
    time_s: f64,
    swept_m2: f64,
    swept_low_m2: f64,
}

impl OrderTotal {
    fn at(pose: Pose2) -> Self {
        Self {
            pose,
            floor_m2: 0.0,
            time_s: 0.0,
            swept_m2: 0.0,
            swept_low_m2: 0.0,
        }
    }

    fn add(&mut self, part: PartEstimate) {
        self.pose = part.end;
        self.floor_m2 += part.plan.floor_m2;
        self.time_s += part.time_s;
        let planned_m2 = part.plan.floor_m2 - part.plan.left_m2;
        self.swept_m2 += planned_m2 * part.kept;
        self.swept_low_m2 += planned_m2 * part.kept_low;
    }
}

/// A part of an order.
struct PartEstimate {
    plan: CoveragePlan,
    end: Pose2,
    time_s: f64,
    /// Share of the planned floor that stays swept under an uncertain pose, and its low bound.
    kept: f64,
    kept_low: f64,
}

/// What the estimates of all parts of an order have in common.
struct PartEstimator<'a> {
    basis: &'a EstimateBasis,
    reachable_cells: Raster<bool>,
}

impl PartEstimator<'_> {
    async fn part(&self, part: Option<&HomePart>, start: Pose2, budget: &mut StepBudget) -> PartEstimate {
        let EstimateBasis {
            order,
            frame,
            settings,
            home,
            ..
        } = self.basis;
        let target = TargetFloor::within(order, part, home);
        let area = Area {
            pattern: |cell: Cell| target.pattern_at(frame.cell_in_map(cell)),
            is_swept: |_| false,
        };
        let from = Departure {
            start: frame.pose(start),
            settings: *settings,
        };
        let plan = plan_area(&self.reachable_cells, area, from, budget).await;
        let plan = plan.in_map(frame);
        let end = plan.segments.last().map_or(start, |last| last.at(1.0));
        let passes = home.annotations().passes_over(order, part);
        let (kept, kept_low) = self.kept(&target, passes, budget).await;
        PartEstimate {
            end,
            time_s: ESTIMATE.plan_to_job_time * f64::from(passes) * plan.time_s,
            kept,
            kept_low,
            plan,
        }
    }

    /// Share of the target floor that stays swept when lanes are displaced, averaged over its cells, and its low bound.
    async fn kept(&self, target: &TargetFloor, passes: u8, budget: &mut StepBudget) -> (f64, f64) {
        let EstimateBasis { home, settings, .. } = self.basis;
        let left = |sigma_m: f64| libm::pow(gap_share(sigma_m, settings), f64::from(passes));
        let (mut cells, mut sum, mut sum_low) = (0_u32, 0.0, 0.0);
        for (index, known) in home.knowledge().values().iter().enumerate() {
            if *known != CellKnowledge::Free {
                continue;
            }
            let cell = home.knowledge().cell(index);
            budget.spend(LOOK_WORK).await;
            if target.pattern_at(cell).is_some() {
                let sigma_m = sigma_or_default_m(home.sigma_m(cell));
                cells += 1;
                sum += 1.0 - left(sigma_m);
                sum_low += 1.0 - left(ESTIMATE.low_bound_factor * sigma_m);
                budget.spend(GAP_WORK).await;
            }
        }
        let cells = f64::from(cells.max(1));
        (sum / cells, sum_low / cells)
    }
}

/// Share of the floor that one pass sweeps where the position has this deviation, with twice the deviation for the low
/// bound.
pub(super) fn kept_low(sigma_m: Option<f64>, settings: &PlanSettings) -> f64 {
    1.0 - gap_share(ESTIMATE.low_bound_factor * sigma_or_default_m(sigma_m), settings)
}

/// Standard deviation of the position that the estimate uses.
fn sigma_or_default_m(sigma_m: Option<f64>) -> f64 {
    sigma_m
        .unwrap_or(ESTIMATE.sigma_unknown_m)
        .max(MARGINS.sigma_min_m)
}

/// Expected share of the floor between two lanes that neither sweeps, when the position of each is uncertain.
fn gap_share(sigma_m: f64, settings: &PlanSettings) -> f64 {
    let apart_m = core::f64::consts::SQRT_2 * sigma_m;
    let overlap_m = 2.0 * settings.sigma_m;
    let spacing_m = (settings.swath_m - overlap_m).max(overlap_m);
    let times = overlap_m / apart_m;
    let density = libm::exp(-0.5 * times * times) / libm::sqrt(core::f64::consts::TAU);
    let beyond = 0.5 * libm::erfc(times / core::f64::consts::SQRT_2);
    ((apart_m * density - overlap_m * beyond) / spacing_m).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::{PlanSettings, gap_share};

    #[test]
    fn less_certain_positions_leave_wider_gaps() {
        let settings = PlanSettings {
            swath_m: 0.25,
            sigma_m: 0.01,
            cruise_m_per_s: 0.25,
            turn_rad_per_s: 1.0,
            takes_along: true,
        };
        let shares = [0.005, 0.02, 0.05, 0.1, 0.3].map(|sigma_m| gap_share(sigma_m, &settings));
        assert!(shares.is_sorted(), "{shares:?}");
        assert!(shares[0] < 0.001 && shares[4] > 0.5, "{shares:?}");
        assert!((0.0..=1.0).contains(&gap_share(50.0, &settings)));
    }
}
