//! The passages of all faults as a table.

use core::fmt;

use serde::Serialize;

use super::trial::FaultPassage;

/// Passages over several seeds: means of ways, the worst of times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LineFaultTable {
    /// Seeds of each fault.
    pub seeds: u64,
    /// One row for each fault.
    pub rows: Vec<FaultPassage>,
}

impl LineFaultTable {
    /// Joins the passages of several seeds, each list in the same order.
    #[must_use]
    pub fn of(seeds: &[Vec<FaultPassage>]) -> Self {
        let mut rows = seeds.first().cloned().unwrap_or_default();
        for (index, row) in rows.iter_mut().enumerate() {
            let all: Vec<&FaultPassage> = seeds.iter().filter_map(|seed| seed.get(index)).collect();
            *row = joined(&all, row);
        }
        Self {
            seeds: seeds.len() as u64,
            rows,
        }
    }

    /// Rules of safety that were broken.
    #[must_use]
    pub fn violations(&self) -> u64 {
        self.rows.iter().map(|row| u64::from(row.violations)).sum()
    }
}

fn joined(all: &[&FaultPassage], first: &FaultPassage) -> FaultPassage {
    let count = all.len() as f64;
    FaultPassage {
        way_m: all.iter().map(|row| row.way_m).sum::<f64>() / count,
        standing_s: all.iter().map(|row| row.standing_s).sum::<f64>() / count,
        named: all.iter().flat_map(|row| row.named.iter().cloned()).collect(),
        healed_s: all
            .iter()
            .map(|row| row.healed_s)
            .reduce(|worst, one| Some(worst?.max(one?)))
            .flatten(),
        log_lines: all.iter().map(|row| row.log_lines).max().unwrap_or_default(),
        violations: all.iter().map(|row| row.violations).sum(),
        ..first.clone()
    }
}

impl fmt::Display for LineFaultTable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "{:<38}{:>7}{:>10}{:>10}{:>6}  what it says",
            "fault of the line", "m/min", "stands s", "goes on s", "log"
        )?;
        for row in &self.rows {
            let healed = row.healed_s.map_or("never".to_owned(), |s| format!("{s:.1}"));
            let named: Vec<&str> = row.named.iter().map(String::as_str).collect();
            writeln!(
                formatter,
                "{:<38}{:>7.2}{:>10.1}{healed:>10}{:>6}  {}",
                row.fault,
                row.way_m,
                row.standing_s,
                row.log_lines,
                named.join(" ")
            )?;
        }
        write!(formatter, "violations: {}", self.violations())
    }
}
