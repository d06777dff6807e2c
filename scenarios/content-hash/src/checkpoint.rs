//! What a checkpoint holds.

use brain::mapping::HazardKind;
use brain::{Checkpoint, CleaningOrder, HomePart, JobCheckpoint, JobKind, StrategyName, TrackingCheckpoint};

use crate::ContentHash;

impl ContentHash {
    /// Of a brain's checkpoint, without its home, which [`Self::of_stored_map`] is for.
    #[must_use]
    pub fn of_checkpoint(checkpoint: &Checkpoint) -> Self {
        let mut hash = Self::default();
        hash.add_pose(checkpoint.pose);
        hash.add(checkpoint.random_state);
        hash.add_bits(checkpoint.backed_m);
        if let Some(job) = &checkpoint.job {
            hash.add_job(job);
        }
        hash.add_swept(&checkpoint.swept);
        for point in &checkpoint.path {
            hash.add(point.x_mm);
            hash.add(point.y_mm);
        }
        for mark in &checkpoint.hazards {
            hash.add_point(mark.at);
            hash.add_flag(mark.kind == HazardKind::Contact);
        }
        hash.add_bits(checkpoint.energy.cleaning_per_s);
        hash.add_bits(checkpoint.energy.driving_per_s);
        hash.add_bits(checkpoint.energy.seen_s);
        if let Some(gyro) = checkpoint.gyro {
            hash.add_bits(gyro.scale);
            hash.add_bits(gyro.scale_sigma);
            hash.add_bits(gyro.bias_rad_per_s);
        }
        if let Some(tracking) = checkpoint.tracking {
            hash.add_tracking(tracking);
        }
        hash
    }

    fn add_tracking(&mut self, tracking: TrackingCheckpoint) {
        self.add_bits(tracking.sigma_m);
        self.add_bits(tracking.sigma_rad);
        self.add_flag(tracking.lost);
        self.add_bits(tracking.gyro_scale);
        self.add_bits(tracking.gyro_bias_rad_per_s);
        self.add(tracking.unconfirmed_beams);
    }

    fn add_job(&mut self, job: &JobCheckpoint) {
        self.add_kind(Some(job.kind));
        self.add_order(&job.order);
        self.add_bits(job.figures.time_s);
        self.add_bits(job.figures.swept_m2);
        self.add_bits(job.figures.path_m);
        self.add(job.figures.bumps);
        self.add_flag(job.running);
        self.add_kind(job.goes_on);
    }

    fn add_kind(&mut self, kind: Option<JobKind>) {
        self.add(match kind {
            None => 0,
            Some(JobKind::Clean(StrategyName::Bounce)) => 1,
            Some(JobKind::Clean(StrategyName::Statistical)) => 2,
            Some(JobKind::Clean(StrategyName::Systematic)) => 3,
            Some(JobKind::Clean(StrategyName::WallBounce)) => 4,
            Some(JobKind::Spot) => 5,
            Some(JobKind::Dock) => 6,
            Some(JobKind::GoTo) => 7,
        });
    }

    fn add_order(&mut self, order: &CleaningOrder) {
        self.add(order.passes());
        for part in order.parts() {
            match part {
                HomePart::Room(room) => self.add(*room),
                HomePart::Zone(zone) => self.add_zone(zone),
                HomePart::Spot(place) => self.add_point(*place),
            }
        }
        for no_go in order.avoid() {
            self.add_no_go(no_go);
        }
        if let Some(power) = order.power() {
            self.add_power(power);
        }
        if let Some(pattern) = order.pattern() {
            self.add_pattern(pattern);
        }
    }
}
