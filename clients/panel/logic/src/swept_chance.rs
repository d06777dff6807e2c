//! How likely each cell was swept: the swept cells, blurred with the deviation of the place that the robot had when it swept them.
//!
//! The true position of a robot lies somewhere around the estimated one. So the floor that it counts as swept was
//! swept somewhere around: the chance of a cell is the share of that, weighed with the deviation. Two boxes one after the other in each
//! direction come near enough to a bell, and cost the same for every width. Deviations are given in few levels, each of which
//! is blurred by itself.

/// Deviations of the levels, metres. Beyond the last one a map says little, and a picture of it would say less.
const LEVELS_M: [f64; LEVELS] = [0.0, 0.03, 0.06, 0.12, 0.25];
const LEVELS: usize = 5;

/// The level of a cell: 0 = not swept, else one more than its place among the deviations.
pub(crate) fn level(sigma_m: f64) -> u8 {
    let upper = |place: usize| LEVELS_M.get(place + 1).map(|next| 0.5 * (LEVELS_M[place] + next));
    let place = (0..LEVELS).find(|place| upper(*place).is_none_or(|upper| sigma_m <= upper));
    place.map_or(LEVELS as u8, |place| place as u8 + 1)
}

/// Half of the width of a box, in cells: two of them have together the deviation of the level.
fn half_width(level: u8, cell_m: f64) -> usize {
    let sigma_m = LEVELS_M.get(usize::from(level).wrapping_sub(1)).copied();
    let cells = sigma_m.unwrap_or(0.0) / cell_m.max(1e-3);
    let width = (6.0 * cells * cells + 1.0).sqrt();
    ((width - 1.0) / 2.0).round() as usize
}

/// How far a cell of a level reaches, in cells.
pub(crate) fn reach(level: u8, cell_m: f64) -> i32 {
    i32::try_from(2 * half_width(level, cell_m)).unwrap_or(0)
}

/// A window of levels, row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Levels<'cells> {
    pub(crate) cells: &'cells [u8],
    pub(crate) width: usize,
}

/// The chance of each cell of a window, 255 = sure. What lies outside counts as not swept, so a window must be larger than what is
/// asked by the reach of its levels.
pub(crate) fn chances(levels: Levels<'_>, cell_m: f64) -> Vec<u8> {
    let mut sum = vec![0.0_f32; levels.cells.len()];
    for level in 1..=LEVELS as u8 {
        if !levels.cells.contains(&level) {
            continue;
        }
        let mask: Vec<f32> = levels
            .cells
            .iter()
            .map(|cell| f32::from(u8::from(*cell == level)))
            .collect();
        let blurred = blur(mask, levels.width, half_width(level, cell_m));
        for (total, share) in sum.iter_mut().zip(blurred) {
            *total += share;
        }
    }
    sum.iter()
        .map(|share| (255.0 * share.clamp(0.0, 1.0)).round() as u8)
        .collect()
}

fn blur(cells: Vec<f32>, width: usize, half: usize) -> Vec<f32> {
    if half == 0 || width == 0 {
        return cells;
    }
    let height = cells.len() / width;
    let across = turned(&boxed(boxed(cells, width, half), width, half), width);
    turned(&boxed(boxed(across, height, half), height, half), height)
}

/// The mean of each cell and of so many on both sides in its row.
fn boxed(mut cells: Vec<f32>, width: usize, half: usize) -> Vec<f32> {
    let share = 1.0 / (2 * half + 1) as f32;
    let mut sums = vec![0.0_f32; width + 1];
    for row in cells.chunks_exact_mut(width) {
        for (place, cell) in row.iter().enumerate() {
            sums[place + 1] = sums[place] + cell;
        }
        for (place, cell) in row.iter_mut().enumerate() {
            let (first, end) = (place.saturating_sub(half), (place + half + 1).min(width));
            *cell = share * (sums[end] - sums[first]);
        }
    }
    cells
}

/// Rows become columns.
fn turned(cells: &[f32], width: usize) -> Vec<f32> {
    (0..width)
        .flat_map(|column| cells.iter().skip(column).step_by(width).copied())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{LEVELS_M, Levels, chances, level, reach};

    const CELL_M: f64 = 0.025;

    #[test]
    fn deviations_have_the_nearest_level() {
        for (place, sigma_m) in LEVELS_M.iter().enumerate() {
            assert_eq!(usize::from(level(*sigma_m)), place + 1, "{sigma_m}");
        }
        assert_eq!((level(0.014), level(0.016), level(9.0)), (1, 2, 5));
        assert_eq!(reach(1, CELL_M), 0);
    }

    /// A square of 21 by 21 cells, all swept but a border of nothing.
    fn square(level: u8) -> Vec<u8> {
        (0..61 * 61)
            .map(|index: i32| {
                let (x, y) = (index % 61 - 30, index / 61 - 30);
                if x.abs() <= 10 && y.abs() <= 10 { level } else { 0 }
            })
            .collect()
    }

    fn at(cells: &[u8], x: i32, y: i32) -> u8 {
        cells[((y + 30) * 61 + x + 30) as usize]
    }

    #[test]
    fn a_sure_robot_swept_what_it_swept_and_an_unsure_one_around_it() {
        let of = |level| {
            let levels = square(level);
            let window = Levels {
                cells: &levels,
                width: 61,
            };
            chances(window, CELL_M)
        };
        let sure = of(1);
        assert_eq!((at(&sure, 10, 0), at(&sure, 11, 0)), (255, 0));
        let unsure = of(3);
        assert_eq!(at(&unsure, 0, 0), 255, "far from the border nothing changes");
        let border = i32::from(at(&unsure, 10, 0)) + i32::from(at(&unsure, 11, 0));
        assert!((border - 255).abs() <= 2, "half inside, half outside: {border}");
        assert!(at(&unsure, 14, 0) > 0 && at(&unsure, 24, 0) == 0);
        let lost = of(5);
        assert!(at(&lost, 0, 0) < 200, "{}", at(&lost, 0, 0));
        assert_eq!(
            at(&unsure, -13, 5),
            at(&unsure, 5, 13),
            "the same in all directions"
        );
    }

    #[test]
    fn the_swept_area_stays_the_same() {
        let area = |level: u8| {
            let levels = square(level);
            let window = Levels {
                cells: &levels,
                width: 61,
            };
            let sum: u32 = chances(window, CELL_M).iter().map(|cell| u32::from(*cell)).sum();
            f64::from(sum) / 255.0
        };
        for level in 1..=4 {
            assert!((area(level) - 441.0).abs() < 4.0, "{level}: {}", area(level));
        }
    }
}
