//! Cells as pairs of value and length, as the daemon sends them.

/// Single cells of `runs`, at most `count` of them: what a damaged message claims beyond that is not believed.
pub fn cells(runs: &[u32], count: usize) -> impl Iterator<Item = u32> {
    runs.chunks_exact(2)
        .flat_map(|pair| match pair {
            [value, length] => std::iter::repeat_n(*value, *length as usize),
            _ => std::iter::repeat_n(0, 0),
        })
        .take(count)
}

#[cfg(test)]
mod tests {
    use super::cells;

    #[test]
    fn runs_become_cells_and_no_more_than_there_are() {
        let all: Vec<u32> = cells(&[1, 2, 0, 1, 7, u32::MAX], 5).collect();
        assert_eq!(all, [1, 1, 0, 7, 7]);
    }
}
