//! Saved zones and spots, which people can have cleaned again.

use super::edit_error::EditError;
use super::geometry::Point2;
use super::no_go::{RoomName, in_micrometres};
use super::order::HomePart;
use super::zone::{COORDINATE_MAX_M, Zone};

/// Shape of a saved place.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaceShape {
    /// A zone.
    Zone(Zone),
    /// A spot, by its centre.
    Spot(Point2),
}

impl PlaceShape {
    /// The part of a job that cleans it.
    #[must_use]
    pub fn part(&self) -> HomePart {
        match self {
            Self::Zone(zone) => HomePart::Zone(zone.clone()),
            Self::Spot(place) => HomePart::Spot(*place),
        }
    }
}

/// A zone or spot with a name. Its coordinates are whole micrometres, as in a stored map.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptPlace {
    name: RoomName,
    shape: PlaceShape,
}

impl KeptPlace {
    /// A place with a name.
    ///
    /// # Errors
    /// [`EditError::BadZone`] for one that is far away.
    pub fn new(name: RoomName, shape: &PlaceShape) -> Result<Self, EditError> {
        let shape = match shape {
            PlaceShape::Zone(zone) => {
                let corners = zone.corners().iter().copied().map(in_micrometres);
                PlaceShape::Zone(Zone::of_stored(corners.collect())?)
            }
            PlaceShape::Spot(place)
                if place.x_m.abs() < COORDINATE_MAX_M && place.y_m.abs() < COORDINATE_MAX_M =>
            {
                PlaceShape::Spot(in_micrometres(*place))
            }
            PlaceShape::Spot(_) => return Err(EditError::BadZone),
        };
        Ok(Self { name, shape })
    }

    /// The same under another name.
    #[must_use]
    pub fn with_name(self, name: RoomName) -> Self {
        Self { name, ..self }
    }

    /// The same with another shape.
    ///
    /// # Errors
    /// [`EditError::BadZone`] for a shape that is far away.
    pub fn with_shape(self, shape: &PlaceShape) -> Result<Self, EditError> {
        Self::new(self.name, shape)
    }

    /// Its name.
    #[must_use]
    pub const fn name(&self) -> &RoomName {
        &self.name
    }

    /// Its shape.
    #[must_use]
    pub const fn shape(&self) -> &PlaceShape {
        &self.shape
    }

    /// The part of a job that cleans it.
    #[must_use]
    pub fn part(&self) -> HomePart {
        self.shape.part()
    }
}
