//! Parts of a home as they stand in recordings and checkpoints.

use brain::{CleaningOrder, HomePart, NoGo, NoGoShape, Pattern, PlaceShape, Point2, RoomPower, Zone};
use serde::{Deserialize, Serialize};

/// [`CleaningOrder`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GivenOrder {
    parts: Vec<GivenPart>,
    passes: u8,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    avoid: Vec<GivenNoGo>,
    /// Suction, main brush and side brushes in percent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    power: Option<[u8; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pattern: Option<GivenPattern>,
}

/// [`Pattern`]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenPattern {
    /// [`Pattern::Lines`]
    #[default]
    Lines,
    /// [`Pattern::Contour`]
    Contour,
}

impl From<Pattern> for GivenPattern {
    fn from(pattern: Pattern) -> Self {
        match pattern {
            Pattern::Lines => Self::Lines,
            Pattern::Contour => Self::Contour,
        }
    }
}

impl GivenPattern {
    pub(super) const fn to_brain(self) -> Pattern {
        match self {
            Self::Lines => Pattern::Lines,
            Self::Contour => Pattern::Contour,
        }
    }

    pub(super) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

pub(super) fn from_power(power: RoomPower) -> [u8; 3] {
    [power.suction, power.main_brush, power.side_brushes]
}

pub(super) fn to_power([suction, main_brush, side_brushes]: [u8; 3]) -> RoomPower {
    RoomPower {
        suction,
        main_brush,
        side_brushes,
    }
}

/// [`HomePart`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenPart {
    /// A room by its identity.
    Room(u16),
    /// Corners, x and y in metres.
    Zone(Vec<[f64; 2]>),
    /// A place, x and y in metres.
    Spot([f64; 2]),
}

impl From<&HomePart> for GivenPart {
    fn from(part: &HomePart) -> Self {
        match part {
            HomePart::Room(id) => Self::Room(*id),
            HomePart::Zone(zone) => Self::Zone(from_zone(zone)),
            HomePart::Spot(place) => Self::Spot([place.x_m, place.y_m]),
        }
    }
}

impl GivenPart {
    /// What a person keeps under a name; `None` for a room, and for what the brain would refuse.
    pub(super) fn to_shape(&self) -> Option<PlaceShape> {
        match self {
            Self::Room(_) => None,
            Self::Zone(corners) => to_zone(corners).map(PlaceShape::Zone),
            Self::Spot([x_m, y_m]) => Some(PlaceShape::Spot(Point2 { x_m: *x_m, y_m: *y_m })),
        }
    }
}

impl From<&CleaningOrder> for GivenOrder {
    fn from(order: &CleaningOrder) -> Self {
        Self {
            parts: order.parts().iter().map(GivenPart::from).collect(),
            passes: order.passes(),
            avoid: order.avoid().iter().map(GivenNoGo::from).collect(),
            power: order.power().map(from_power),
            pattern: order.pattern().map(GivenPattern::from),
        }
    }
}

impl GivenOrder {
    /// Back to the brain's own type; `None` for one that the brain would refuse.
    pub(super) fn to_brain(&self) -> Option<CleaningOrder> {
        let part = |part: &GivenPart| {
            Some(match part {
                GivenPart::Room(id) => HomePart::Room(*id),
                GivenPart::Zone(corners) => HomePart::Zone(to_zone(corners)?),
                GivenPart::Spot([x_m, y_m]) => HomePart::Spot(Point2 { x_m: *x_m, y_m: *y_m }),
            })
        };
        let parts: Option<Vec<HomePart>> = self.parts.iter().map(part).collect();
        let avoid: Option<Vec<NoGo>> = self.avoid.iter().map(GivenNoGo::to_brain).collect();
        let mut order = CleaningOrder::new(parts?, self.passes)
            .ok()?
            .avoiding(avoid?)
            .ok()?;
        if let Some(power) = self.power {
            order = order.with_power(to_power(power)).ok()?;
        }
        Some(match self.pattern {
            Some(pattern) => order.with_pattern(pattern.to_brain()),
            None => order,
        })
    }
}

/// [`NoGo`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenNoGo {
    /// Corners, x and y in metres.
    Zone(Vec<[f64; 2]>),
    /// Both ends.
    Wall([[f64; 2]; 2]),
}

impl From<&NoGo> for GivenNoGo {
    fn from(no_go: &NoGo) -> Self {
        match no_go.shape() {
            NoGoShape::Zone => Self::Zone(from_zone(no_go.area())),
            NoGoShape::Wall { from, to } => Self::Wall([[from.x_m, from.y_m], [to.x_m, to.y_m]]),
        }
    }
}

impl GivenNoGo {
    /// Back to the brain's own type; `None` for one that the brain would refuse.
    pub(super) fn to_brain(&self) -> Option<NoGo> {
        match self {
            Self::Zone(corners) => NoGo::zone(&to_zone(corners)?).ok(),
            Self::Wall(ends) => {
                let [from, to] = ends.map(|[x_m, y_m]| Point2 { x_m, y_m });
                NoGo::wall(from, to).ok()
            }
        }
    }
}

fn from_zone(zone: &Zone) -> Vec<[f64; 2]> {
    zone.corners()
        .iter()
        .map(|corner| [corner.x_m, corner.y_m])
        .collect()
}

fn to_zone(corners: &[[f64; 2]]) -> Option<Zone> {
    let corners = corners.iter().map(|&[x_m, y_m]| Point2 { x_m, y_m });
    Zone::new(corners.collect()).ok()
}
