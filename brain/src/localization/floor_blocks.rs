//! Positions on the floor in square blocks, so that a search can reject many positions at once.

use crate::model::geometry::Point2;

/// Positions that lie close together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FloorBlock {
    pub(super) middle: Point2,
    /// Distance from the middle to the farthest position, metres.
    pub(super) radius_m: f64,
    first: usize,
    end: usize,
}

/// All positions where a robot can be, in blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct FloorBlocks {
    positions: Vec<Point2>,
    blocks: Vec<FloorBlock>,
}

impl FloorBlocks {
    /// Adds the positions of a block, if there are any.
    pub(super) fn add(&mut self, positions: impl IntoIterator<Item = Point2>) {
        let first = self.positions.len();
        self.positions.extend(positions);
        let added = self.positions.get(first..).unwrap_or_default();
        let Some(corner) = added.first() else { return };
        let (mut low, mut high) = (*corner, *corner);
        for at in added {
            low = Point2 {
                x_m: low.x_m.min(at.x_m),
                y_m: low.y_m.min(at.y_m),
            };
            high = Point2 {
                x_m: high.x_m.max(at.x_m),
                y_m: high.y_m.max(at.y_m),
            };
        }
        let middle = Point2 {
            x_m: (low.x_m + high.x_m) / 2.0,
            y_m: (low.y_m + high.y_m) / 2.0,
        };
        let radius_m = added.iter().map(|at| at.distance_m(middle)).fold(0.0, f64::max);
        self.blocks.push(FloorBlock {
            middle,
            radius_m,
            first,
            end: self.positions.len(),
        });
    }

    pub(super) fn block(&self, number: usize) -> Option<&FloorBlock> {
        self.blocks.get(number)
    }

    /// Positions of a block.
    pub(super) fn positions(&self, block: &FloorBlock) -> &[Point2] {
        self.positions.get(block.first..block.end).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::FloorBlocks;
    use crate::model::geometry::Point2;

    #[test]
    fn a_block_reaches_to_its_farthest_position() {
        let at = |x_m, y_m| Point2 { x_m, y_m };
        let mut blocks = FloorBlocks::default();
        blocks.add([]);
        blocks.add([at(1.0, 1.0), at(1.6, 1.0), at(1.0, 1.8)]);
        blocks.add([at(9.0, 9.0)]);
        assert!(blocks.block(2).is_none(), "a block without positions is none");
        let block = blocks.block(0).expect("two blocks");
        assert_eq!(block.middle, at(1.3, 1.4));
        assert!((block.radius_m - 0.5).abs() < 1e-9);
        assert_eq!(blocks.positions(block).len(), 3);
        let single = blocks.block(1).expect("two blocks");
        assert_eq!(
            (single.radius_m, blocks.positions(single)),
            (0.0, [at(9.0, 9.0)].as_slice())
        );
    }
}
