//! What an order would take, at once or in steps beside whatever else the shell does.

use core::task::Poll;

use super::Brain;
use crate::coverage::{EstimateBasis, JobConditions, JobEstimate, OrderRefusal, ReachQuestion};
use crate::model::gradual::{Gradual, StepBudget, at_once};
use crate::model::job_refusal::JobRefusal;
use crate::model::order::CleaningOrder;

/// An estimate in the making, of the map as it was when it began.
#[derive(Debug)]
pub struct EstimateWork(Gradual<Result<JobEstimate, OrderRefusal>>);

impl EstimateWork {
    /// Does the next step. Must not be called again after it returned the estimate, or why there is none.
    pub fn go_on(&mut self) -> Option<Result<JobEstimate, OrderRefusal>> {
        match self.0.go_on() {
            Poll::Ready(result) => Some(result),
            Poll::Pending => None,
        }
    }
}

impl Brain {
    /// What carrying out an order from the present pose will take. Plans the whole order, which takes tens of milliseconds.
    ///
    /// # Errors
    /// Why the order cannot be carried out in this map.
    pub fn estimate_order(&self, order: &CleaningOrder) -> Result<JobEstimate, OrderRefusal> {
        at_once(self.estimate_basis(order).estimate(&mut StepBudget::unlimited()))
    }

    /// As [`Self::estimate_order`], in steps: for a shell that answers others meanwhile.
    #[must_use]
    pub fn begin_estimate(&self, order: &CleaningOrder) -> EstimateWork {
        let basis = self.estimate_basis(order);
        let estimate = async move { basis.estimate(&mut StepBudget::limited()).await };
        EstimateWork(Gradual::new(estimate))
    }

    /// Why an order was refused by [`Self::admit`], with what is in its way.
    #[must_use]
    pub fn order_refusal(&self, reason: JobRefusal, order: &CleaningOrder) -> OrderRefusal {
        let question = ReachQuestion {
            order,
            home: &self.map.home_floor(),
            from: self.pose().position(),
            radius_m: self.config.body.radius_m,
        };
        at_once(question.refusal(reason, &mut StepBudget::unlimited()))
    }

    fn estimate_basis(&self, order: &CleaningOrder) -> EstimateBasis {
        let conditions = JobConditions {
            map: &self.map,
            start: self.pose(),
            is_sure: self.estimate().is_sure(),
            config: &self.config,
            energy: &self.energy(),
            charge: self.behavior.battery_charge(),
        };
        EstimateBasis::of(order, conditions)
    }
}
