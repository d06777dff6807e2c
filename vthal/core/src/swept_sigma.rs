//! How sure the robot was of its place when it swept: beside the swept cells in their order, cells of one deviation joined.

/// Deviations are sent in whole centimetres up to this; with a larger one the robot does not know where it sweeps.
const SIGMA_CM_MAX: f64 = 100.0;

/// Pairs of a number of cells and their deviation in centimetres.
#[derive(Clone, Debug, Default)]
pub(crate) struct SweptSigma {
    runs: Vec<u32>,
}

impl SweptSigma {
    /// So many cells were swept with this deviation.
    pub(crate) fn add(&mut self, cells: usize, sigma_m: f64) {
        let cells = u32::try_from(cells).unwrap_or(u32::MAX);
        let sigma_cm = centimetres(sigma_m);
        match self.runs.as_mut_slice() {
            _ if cells == 0 => {}
            [.., count, last_cm] if *last_cm == sigma_cm => *count = count.saturating_add(cells),
            _ => self.runs.extend([cells, sigma_cm]),
        }
    }

    /// The pairs of the last so many cells.
    pub(crate) fn of_last(&self, cells: usize) -> Vec<u32> {
        let mut left = u32::try_from(cells).unwrap_or(u32::MAX);
        let mut pairs = Vec::new();
        for run in self.runs.rchunks_exact(2) {
            let &[count, sigma_cm] = run else { continue };
            if left == 0 {
                break;
            }
            let taken = count.min(left);
            left -= taken;
            pairs.push([taken, sigma_cm]);
        }
        pairs.reverse();
        pairs.into_flattened()
    }
}

/// Unknown deviations count as the largest.
fn centimetres(sigma_m: f64) -> u32 {
    let rounded = (100.0 * sigma_m).round();
    if rounded.is_nan() {
        return SIGMA_CM_MAX as u32;
    }
    rounded.clamp(0.0, SIGMA_CM_MAX) as u32
}

#[cfg(test)]
mod tests {
    use super::SweptSigma;

    #[test]
    fn cells_of_one_deviation_are_one_pair() {
        let mut sigma = SweptSigma::default();
        for (cells, sigma_m) in [
            (3, 0.021),
            (4, 0.019),
            (0, 0.5),
            (1, 0.3),
            (2, f64::NAN),
            (1, 9.0),
        ] {
            sigma.add(cells, sigma_m);
        }
        assert_eq!(sigma.of_last(11), [7, 2, 1, 30, 3, 100]);
        assert_eq!(sigma.of_last(5), [1, 2, 1, 30, 3, 100]);
        assert_eq!(sigma.of_last(2), [2, 100]);
        assert!(sigma.of_last(0).is_empty());
    }
}
