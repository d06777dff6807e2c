//! Drawing zones, virtual walls and the dock by two places, and spots by one.

use rvac_api::{HomeView, NoGoShape, SPOT_RADIUS_M};

use crate::dock_place::{DockPose, dock_pose};
use crate::point::MapPoint;
use crate::words::Words;

/// Corners nearer to each other than this are one place that was tapped twice, metres.
pub(crate) const APART_MIN_M: f64 = 0.05;
/// Corners of a spot that is drawn.
const SPOT_CORNERS: u32 = 48;

/// What taps on the map do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Choose rooms.
    #[default]
    Choose,
    /// Draw a virtual wall from one place to another.
    Wall,
    /// Draw a no-go zone between two opposite corners.
    Zone,
    /// Draw a line that cuts a room in two.
    Cut,
    /// Draw a zone to be cleaned.
    CleanZone,
    /// Set a spot to be cleaned.
    Spot,
    /// Set the place to which the robot is sent.
    GoTo,
    /// Draw a zone out of which the robot keeps for one job.
    AvoidZone,
    /// Show where the dock is now: the robot's place on it, and what it faces.
    Dock,
}

impl Tool {
    /// Whether what is drawn stays in the map, and is not only for one job.
    #[must_use]
    pub const fn changes_home(self) -> bool {
        match self {
            Self::Wall | Self::Zone | Self::Cut | Self::Dock => true,
            Self::Choose | Self::CleanZone | Self::Spot | Self::GoTo | Self::AvoidZone => false,
        }
    }
}

/// What was drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawn {
    /// Floor that is forbidden for good.
    Forbidden(NoGoShape),
    /// A zone to be cleaned, by its corners.
    Clean(Vec<[f64; 2]>),
    /// A spot to be cleaned, by its middle.
    Spot([f64; 2]),
    /// A place to which the robot is sent.
    Place([f64; 2]),
    /// Floor that is forbidden for one job.
    Avoid(NoGoShape),
    /// A line that cuts a room in two.
    Cut([[f64; 2]; 2]),
    /// The robot's place on its dock.
    Dock(DockPose),
}

/// What is being drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sketch {
    tool: Tool,
    first: Option<MapPoint>,
    /// The last place that was pointed at would have made it too small.
    is_too_small: bool,
}

impl Sketch {
    /// Takes a tool; what was begun is dropped.
    pub fn take(&mut self, tool: Tool) {
        *self = Self {
            tool,
            ..Self::default()
        };
    }

    /// Whether a line is being drawn, and not a rectangle.
    #[must_use]
    pub fn is_line(self) -> bool {
        matches!(self.tool, Tool::Wall | Tool::Cut)
    }

    /// Whether one place is all that is drawn.
    #[must_use]
    pub fn is_place(self) -> bool {
        matches!(self.tool, Tool::Spot | Tool::GoTo)
    }

    /// The tool in hand.
    #[must_use]
    pub fn tool(self) -> Tool {
        self.tool
    }

    /// Where it was begun, if it was.
    #[must_use]
    pub fn first(self) -> Option<MapPoint> {
        self.first
    }

    /// A place of the map was pointed at; the second one finishes the drawing and lays the tool down. A spot, and a place to go to, have only one.
    pub fn point(&mut self, place: MapPoint) -> Option<Drawn> {
        if self.is_place() {
            let place = place.into();
            let drawn = match self.tool {
                Tool::GoTo => Drawn::Place(place),
                _ => Drawn::Spot(place),
            };
            self.take(Tool::Choose);
            return Some(drawn);
        }
        let Some(first) = self.first else {
            self.first = (self.tool != Tool::Choose).then_some(place);
            return None;
        };
        let shape = self.shape_to(first, place);
        if shape.is_some() {
            self.take(Tool::Choose);
        } else {
            self.is_too_small = true;
        }
        shape
    }

    fn shape_to(self, first: MapPoint, last: MapPoint) -> Option<Drawn> {
        let (MapPoint { x, y }, MapPoint { x: far_x, y: far_y }) = (first, last);
        let (wide, high) = ((far_x - x).abs(), (far_y - y).abs());
        let corners = || vec![[x, y], [far_x, y], [far_x, far_y], [x, far_y]];
        let drawn = match self.tool {
            Tool::Choose | Tool::Spot | Tool::GoTo => return None,
            Tool::Wall | Tool::Cut => {
                let line = [[x, y], [far_x, far_y]];
                let drawn = if self.tool == Tool::Cut {
                    Drawn::Cut(line)
                } else {
                    Drawn::Forbidden(NoGoShape::Wall(line))
                };
                return (wide.hypot(high) >= APART_MIN_M).then_some(drawn);
            }
            Tool::Dock => {
                let drawn = Drawn::Dock(dock_pose(first, last));
                return (wide.hypot(high) >= APART_MIN_M).then_some(drawn);
            }
            Tool::Zone => Drawn::Forbidden(NoGoShape::Zone(corners())),
            Tool::CleanZone => Drawn::Clean(corners()),
            Tool::AvoidZone => Drawn::Avoid(NoGoShape::Zone(corners())),
        };
        (wide.min(high) >= APART_MIN_M).then_some(drawn)
    }

    /// Whether what was pointed at last was too small to be meant.
    #[must_use]
    pub fn is_too_small(self) -> bool {
        self.is_too_small
    }

    /// What to do next, for people; nothing while nothing is drawn.
    #[must_use]
    pub fn hint(self, words: &Words) -> Option<&'static str> {
        let texts = &words.map;
        if self.is_too_small {
            return Some(match self.tool {
                Tool::Wall | Tool::Cut | Tool::Dock => texts.too_short,
                Tool::Choose | Tool::Spot | Tool::GoTo | Tool::Zone | Tool::CleanZone | Tool::AvoidZone => {
                    texts.too_narrow
                }
            });
        }
        match (self.tool, self.first) {
            (Tool::Choose, _) => None,
            (Tool::Spot, _) => Some(texts.spot_place),
            (Tool::GoTo, _) => Some(texts.go_place),
            (Tool::Wall, None) => Some(texts.wall_first),
            (Tool::Wall, Some(_)) => Some(texts.wall_second),
            (Tool::Dock, None) => Some(texts.dock_first),
            (Tool::Dock, Some(_)) => Some(texts.dock_second),
            (Tool::Cut, None) => Some(texts.cut_first),
            (Tool::Cut, Some(_)) => Some(texts.cut_second),
            (Tool::Zone | Tool::CleanZone | Tool::AvoidZone, None) => Some(texts.zone_first),
            (Tool::Zone | Tool::CleanZone | Tool::AvoidZone, Some(_)) => Some(texts.zone_second),
        }
    }
}

/// Corners of the border of a spot: enough of them to appear round.
#[must_use]
pub fn spot_border([x, y]: [f64; 2]) -> Vec<[f64; 2]> {
    let corner = |corner: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(corner) / f64::from(SPOT_CORNERS)).sin_cos();
        [x + SPOT_RADIUS_M * cos, y + SPOT_RADIUS_M * sin]
    };
    (0..SPOT_CORNERS).map(corner).collect()
}

/// The border of a zone as strokes `[x0,y0,x1,y1,...]` in metres.
#[must_use]
pub fn zone_strokes(corners: &[[f64; 2]]) -> Vec<f32> {
    let next = corners.iter().cycle().skip(1);
    let ends = corners.iter().zip(next).flat_map(|(from, to)| [*from, *to]);
    ends.flatten().map(|metres| metres as f32).collect()
}

/// The same of what is forbidden.
#[must_use]
pub fn no_go_strokes(shape: &NoGoShape) -> Vec<f32> {
    match shape {
        NoGoShape::Wall(ends) => ends.iter().flatten().map(|metres| *metres as f32).collect(),
        NoGoShape::Zone(corners) => zone_strokes(corners),
    }
}

/// A no-go zone or virtual wall as a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoGoRow {
    /// Its number.
    pub number: u16,
    /// `Virtual wall 3`, or what people call it.
    pub name: String,
    /// `1.2 m`, or with a name `Virtual wall 3, 1.2 m`.
    pub words: String,
}

/// What is forbidden, by number.
#[must_use]
pub fn no_go_rows(words: &Words, home: &HomeView) -> Vec<NoGoRow> {
    let row = |no_go: &rvac_api::NoGoView| {
        let (kind, words) = match &no_go.shape {
            NoGoShape::Wall(ends) => (words.home.wall, metres(words, wall_length_m(ends))),
            NoGoShape::Zone(corners) => (words.home.zone, extent(words, corners)),
        };
        let numbered = kind.fill([&no_go.number]);
        NoGoRow {
            number: no_go.number,
            words: no_go
                .name
                .as_ref()
                .map_or_else(|| words.clone(), |_| format!("{numbered}, {words}")),
            name: no_go.name.clone().unwrap_or(numbered),
        }
    };
    home.no_go.iter().map(row).collect()
}

pub(crate) fn wall_length_m([from, to]: &[[f64; 2]; 2]) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1])
}

fn metres(words: &Words, length_m: f64) -> String {
    words.unit.metres.fill([&words.number(length_m, 1)])
}

/// `1.5 x 0.8 m`
pub(crate) fn extent(words: &Words, corners: &[[f64; 2]]) -> String {
    let span = |axis: usize| {
        let values = corners.iter().filter_map(|corner| corner.get(axis).copied());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        (high - low).max(0.0)
    };
    words
        .home
        .extent
        .fill([&words.number(span(0), 1), &words.number(span(1), 1)])
}

#[cfg(test)]
mod tests {
    use super::{Drawn, Sketch, Tool, no_go_rows, no_go_strokes, spot_border};
    use crate::MapPoint;
    use crate::words::{Language, Words};
    use rvac_api::{HomeView, NoGoShape, NoGoView};

    const ENGLISH: &Words = Language::English.words();

    #[test]
    fn two_places_make_a_wall_and_the_tool_is_laid_down() {
        let mut sketch = Sketch::default();
        assert_eq!(sketch.point(MapPoint::new(1.0, 1.0)), None);
        assert_eq!(sketch, Sketch::default(), "without a tool nothing is drawn");
        sketch.take(Tool::Wall);
        assert_eq!(sketch.point(MapPoint::new(1.0, 1.0)), None);
        assert!(!sketch.is_too_small());
        assert_eq!(
            sketch.point(MapPoint::new(1.0, 1.01)),
            None,
            "the same place again"
        );
        assert!(sketch.is_too_small() && sketch.hint(ENGLISH).is_some_and(|hint| hint.contains("5 cm")));
        assert_eq!(
            sketch.first(),
            Some(MapPoint::new(1.0, 1.0)),
            "what was begun stays"
        );
        let wall = sketch.point(MapPoint::new(1.0, 2.0));
        let drawn = NoGoShape::Wall([[1.0, 1.0], [1.0, 2.0]]);
        assert_eq!(no_go_strokes(&drawn), [1.0, 1.0, 1.0, 2.0]);
        assert_eq!(wall, Some(Drawn::Forbidden(drawn)));
        assert_eq!(sketch, Sketch::default());
    }

    #[test]
    fn one_place_makes_a_spot_of_a_metre() {
        let mut sketch = Sketch::default();
        sketch.take(Tool::Spot);
        assert!(sketch.is_place() && sketch.hint(ENGLISH).is_some_and(|hint| hint.contains("spot")));
        assert_eq!(
            sketch.point(MapPoint::new(1.0, 2.0)),
            Some(Drawn::Spot([1.0, 2.0]))
        );
        assert_eq!(sketch, Sketch::default());
        for [x, y] in spot_border([1.0, 2.0]) {
            assert!(((x - 1.0).hypot(y - 2.0) - 0.5).abs() < 1e-9);
        }
    }

    #[test]
    fn two_places_make_a_line_across_a_room() {
        let mut sketch = Sketch::default();
        sketch.take(Tool::Cut);
        assert!(sketch.is_line() && sketch.hint(ENGLISH).is_some_and(|hint| hint.contains("split")));
        sketch.point(MapPoint::new(1.0, 1.0));
        assert_eq!(
            sketch.point(MapPoint::new(1.0, 4.0)),
            Some(Drawn::Cut([[1.0, 1.0], [1.0, 4.0]]))
        );
        assert_eq!(sketch, Sketch::default());
    }

    #[test]
    fn two_places_make_a_dock_that_looks_from_one_to_the_other() {
        let mut sketch = Sketch::default();
        sketch.take(Tool::Dock);
        assert!(sketch.hint(ENGLISH).is_some_and(|hint| hint.contains("dock")));
        assert_eq!(sketch.point(MapPoint::new(1.0, 1.0)), None);
        assert_eq!(sketch.point(MapPoint::new(1.01, 1.0)), None, "it looks nowhere");
        assert_eq!(
            sketch.point(MapPoint::new(2.0, 1.0)),
            Some(Drawn::Dock([1.0, 1.0, 0.0]))
        );
        assert_eq!(sketch, Sketch::default());
    }

    #[test]
    fn a_zone_lies_between_opposite_corners_and_has_a_width() {
        let mut sketch = Sketch::default();
        sketch.take(Tool::Zone);
        assert!(sketch.hint(ENGLISH).is_some_and(|hint| hint.contains("corner")));
        sketch.point(MapPoint::new(2.0, 3.0));
        assert_eq!(sketch.first(), Some(MapPoint::new(2.0, 3.0)));
        assert_eq!(sketch.point(MapPoint::new(0.0, 3.01)), None);
        let told = sketch.hint(ENGLISH).expect("it says why");
        assert!(
            told.contains("narrow") && told.contains("opposite corner"),
            "{told}"
        );
        let zone = sketch.point(MapPoint::new(0.0, 1.0));
        let corners = vec![[2.0, 3.0], [0.0, 3.0], [0.0, 1.0], [2.0, 1.0]];
        assert_eq!(no_go_strokes(&NoGoShape::Zone(corners.clone())).len(), 16);
        assert_eq!(zone, Some(Drawn::Forbidden(NoGoShape::Zone(corners.clone()))));
        for (tool, drawn) in [
            (Tool::CleanZone, Drawn::Clean(corners.clone())),
            (Tool::AvoidZone, Drawn::Avoid(NoGoShape::Zone(corners.clone()))),
        ] {
            sketch.take(tool);
            sketch.point(MapPoint::new(2.0, 3.0));
            assert_eq!(sketch.point(MapPoint::new(0.0, 1.0)), Some(drawn));
        }
    }

    #[test]
    fn what_is_forbidden_has_a_name_and_a_size() {
        let view = |number, shape| NoGoView {
            number,
            shape,
            name: (number == 5).then(|| "Cats".to_owned()),
        };
        let home = HomeView {
            no_go: vec![
                view(2, NoGoShape::Wall([[0.0, 0.0], [3.0, 4.0]])),
                view(5, NoGoShape::Zone(vec![[0.0, 0.0], [1.5, 0.0], [1.5, 0.8]])),
                view(6, NoGoShape::Zone(vec![])),
            ],
            ..HomeView::default()
        };
        let words: Vec<String> = no_go_rows(ENGLISH, &home)
            .iter()
            .map(|row| format!("{}, {}", row.name, row.words))
            .collect();
        assert_eq!(
            words,
            [
                "Virtual wall\u{a0}2, 5.0\u{a0}m",
                "Cats, No-go zone\u{a0}5, 1.5 x 0.8\u{a0}m",
                "No-go zone\u{a0}6, 0.0 x 0.0\u{a0}m"
            ]
        );
    }
}
