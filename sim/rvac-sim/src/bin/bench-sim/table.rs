//! What is printed of the cases.

use std::fmt::Write;

use serde::Serialize;

use crate::apart::Shares;

/// The figures of a case.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CaseFigures {
    pub(crate) case: &'static str,
    pub(crate) sim_seconds: f64,
    pub(crate) wall_seconds: f64,
    /// Processor time of the run: other work on the machine matters little to it.
    pub(crate) processor_s: f64,
    pub(crate) times_real_time: f64,
    /// Seconds of the processor by part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) parts: Option<Shares>,
}

/// One line a case, and where the time goes.
pub(crate) fn table(figures: &[CaseFigures]) -> String {
    let mut text = format!(
        "{:<24} {:>16} {:>12} {:>12}   of the processor: world, firmware with line and monitor, link and daemon's core, brain\n",
        "", "times real time", "processor s", "on the wall"
    );
    for case in figures {
        let parts = case.parts.map_or_else(String::new, |parts| {
            let all = [parts.world_s, parts.firmware_s, parts.core_s, parts.brain_s];
            let percent = all.map(|part_s| format!("{:.0} %", 100.0 * part_s / case.processor_s));
            percent.join(", ")
        });
        // Writing into a string cannot fail.
        writeln!(
            text,
            "{:<24} {:>16.0} {:>12.2} {:>12.2}   {parts}",
            case.case, case.times_real_time, case.processor_s, case.wall_seconds
        )
        .ok();
    }
    text
}
