//! PowerSource: the pack.

use rs_matter::dm::clusters::decl::power_source::{
    AttributeId, BatChargeLevelEnum, BatChargeStateEnum, BatReplaceabilityEnum, ClusterHandler, FULL_CLUSTER,
    Feature, PowerSourceStatusEnum,
};
use rs_matter::dm::{ArrayAttributeRead, Cluster, Dataver, EndptId, ReadContext};
use rs_matter::error::{Error, ErrorCode};
use rs_matter::tlv::{Nullable, TLVBuilderParent, ToTLVArrayBuilder, ToTLVBuilder, Utf8StrBuilder};
use rs_matter::with;

use crate::node::ENDPOINT;
use crate::robot::Robot;
use crate::view::{Flow, Level};

#[derive(Debug)]
pub(crate) struct Power<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) version: Dataver,
}

impl ClusterHandler for Power<'_> {
    const CLUSTER: Cluster<'static> = FULL_CLUSTER
        .with_features(Feature::BATTERY.union(Feature::RECHARGEABLE).bits())
        .with_attrs(with!(
            required;
            AttributeId::BatPercentRemaining
                | AttributeId::BatChargeLevel
                | AttributeId::BatReplacementNeeded
                | AttributeId::BatReplaceability
                | AttributeId::BatPresent
                | AttributeId::BatChargeState
                | AttributeId::BatFunctionalWhileCharging
        ))
        .with_cmds(with!());

    fn dataver(&self) -> u32 {
        self.version.get()
    }

    fn dataver_changed(&self) {
        self.version.changed();
    }

    fn status(&self, _: impl ReadContext) -> Result<PowerSourceStatusEnum, Error> {
        let battery = self.robot.view().battery;
        Ok(battery.map_or(PowerSourceStatusEnum::Unspecified, |_| {
            PowerSourceStatusEnum::Active
        }))
    }

    fn order(&self, _: impl ReadContext) -> Result<u8, Error> {
        Ok(0)
    }

    fn description<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        out: Utf8StrBuilder<P>,
    ) -> Result<P, Error> {
        out.set("Battery")
    }

    fn bat_percent_remaining(&self, _: impl ReadContext) -> Result<Nullable<u8>, Error> {
        let battery = self.robot.view().battery;
        Ok(battery.map_or(Nullable::none(), |battery| Nullable::some(battery.half_percent)))
    }

    fn bat_charge_level(&self, _: impl ReadContext) -> Result<BatChargeLevelEnum, Error> {
        let battery = self.robot.view().battery;
        Ok(match battery.map(|battery| battery.level) {
            Some(Level::Critical) => BatChargeLevelEnum::Critical,
            Some(Level::Warning) => BatChargeLevelEnum::Warning,
            Some(Level::Good) | None => BatChargeLevelEnum::OK,
        })
    }

    fn bat_replacement_needed(&self, _: impl ReadContext) -> Result<bool, Error> {
        Ok(self.robot.view().battery.is_some_and(|battery| battery.is_faulty))
    }

    /// Makes differ, and the robot does not say it.
    fn bat_replaceability(&self, _: impl ReadContext) -> Result<BatReplaceabilityEnum, Error> {
        Ok(BatReplaceabilityEnum::Unspecified)
    }

    fn bat_present(&self, _: impl ReadContext) -> Result<bool, Error> {
        Ok(self.robot.view().battery.is_some())
    }

    fn bat_charge_state(&self, _: impl ReadContext) -> Result<BatChargeStateEnum, Error> {
        let battery = self.robot.view().battery;
        Ok(match battery.map(|battery| battery.flow) {
            Some(Flow::Charging) => BatChargeStateEnum::IsCharging,
            Some(Flow::Full) => BatChargeStateEnum::IsAtFullCharge,
            Some(Flow::None) => BatChargeStateEnum::IsNotCharging,
            None => BatChargeStateEnum::Unknown,
        })
    }

    /// It stands on its dock then.
    fn bat_functional_while_charging(&self, _: impl ReadContext) -> Result<bool, Error> {
        Ok(false)
    }

    fn endpoint_list<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<ToTLVArrayBuilder<P, EndptId>, ToTLVBuilder<P, EndptId>>,
    ) -> Result<P, Error> {
        match builder {
            ArrayAttributeRead::ReadAll(all) => all.push(&ENDPOINT)?.end(),
            ArrayAttributeRead::ReadOne(0, one) => one.set(&ENDPOINT),
            ArrayAttributeRead::ReadOne(..) => Err(ErrorCode::ConstraintError.into()),
            ArrayAttributeRead::ReadNone(all) => all.end(),
        }
    }
}
