//! Jobs for parts of the home as recordings and checkpoints store them.

use brain::{CleaningOrder, RoomPower};
use rvac_api::JobOrder;
use serde::{Deserialize, Serialize};
use vthal_core::api_forms;

/// [`CleaningOrder`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GivenOrder {
    /// Suction, main brush and side brushes in percent, in place of the shares that clients send.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    power: Option<[u8; 3]>,
    #[serde(flatten)]
    rest: JobOrder,
}

fn from_power(power: RoomPower) -> [u8; 3] {
    [power.suction, power.main_brush, power.side_brushes]
}

fn to_power([suction, main_brush, side_brushes]: [u8; 3]) -> RoomPower {
    RoomPower {
        suction,
        main_brush,
        side_brushes,
    }
}

impl From<&CleaningOrder> for GivenOrder {
    fn from(order: &CleaningOrder) -> Self {
        Self {
            power: order.power().map(from_power),
            rest: api_forms::order(order),
        }
    }
}

impl GivenOrder {
    /// Back to the brain's own type; `None` for one that the brain would refuse.
    pub(super) fn to_brain(&self) -> Option<CleaningOrder> {
        let order = api_forms::to_order(&self.rest)?;
        match self.power {
            Some(power) => order.with_power(to_power(power)).ok(),
            None => Some(order),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::GivenCommand;

    /// As recordings have kept them since there are orders.
    const RECORDED: [&str; 2] = [
        r#"{"clean-parts":{"parts":[{"room":3},{"zone":[[0.0,0.1],[0.3333333333333333,0.0],[-1.0,2.0]]},{"spot":[0.5,1.5]}],"passes":2}}"#,
        r#"{"clean-parts":{"parts":[],"passes":1,"avoid":[{"wall":[[0.0,0.0],[1.0,0.5]]}],"power":[30,100,0],"pattern":"contour"}}"#,
    ];

    #[test]
    fn recorded_orders_are_read_and_written_as_ever() {
        for text in RECORDED {
            let given: GivenCommand = serde_json::from_str(text).expect("is read");
            let command = given.to_brain().expect("a good one");
            let again = serde_json::to_value(GivenCommand::from(&command)).expect("plain");
            let before: serde_json::Value = serde_json::from_str(text).expect("is JSON");
            assert_eq!(again, before);
        }
    }
}
