//! `rvac health`: how worn or dirty parts are, by what their motors draw or by hours of work.

use std::fmt::Write as _;
use std::io::{Write as _, stdout};
use std::process::ExitCode;

use rvac_api::{ComponentHealth, PartCare, PartHours, RequestBody, Update};

use crate::arguments::{HealthJob, HealthVerb};
use crate::control;
use crate::history::when;
use crate::socket::Connection;

pub(crate) fn run(job: &HealthJob) -> anyhow::Result<ExitCode> {
    if let Some(verb) = &job.verb {
        return control::send(request(verb), &job.daemon);
    }
    let mut connection = Connection::open(&job.daemon)?;
    let request = RequestBody::Health;
    let (parts, text) = control::answer(
        &mut connection,
        request,
        control::ANSWER,
        |update, text| match update {
            Update::Health { components, .. } => Some((components, text)),
            _ => None,
        },
    )?;
    if job.json {
        writeln!(stdout(), "{text}")?;
    } else {
        write!(stdout(), "{}", table(&parts))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn request(verb: &HealthVerb) -> RequestBody {
    match verb {
        HealthVerb::Reset { component } => RequestBody::ResetHealth {
            component: component.clone(),
        },
        HealthVerb::Renew { component } => RequestBody::RenewPart {
            component: component.clone(),
        },
        HealthVerb::Undo { component } => RequestBody::UndoRenewPart {
            component: component.clone(),
        },
    }
}

/// A line for each part, one for its hours, and what to do about it.
fn table(parts: &[ComponentHealth]) -> String {
    let mut text = String::new();
    for part in parts {
        let load = match (part.share, part.load_a, part.usual_a) {
            (Some(share), Some(load_a), Some(usual_a)) => {
                format!(
                    "{:.0} % of the load after the reset ({load_a:.2} of {usual_a:.2} A)",
                    share * 100.0
                )
            }
            _ if part.verdict == "unmeasured" => "cannot be measured, only its hours are counted".to_owned(),
            _ => format!("{} of 10 minutes of cleaning measured", part.minutes),
        };
        // Writing to a string cannot fail.
        writeln!(text, "{:12} {:10} {load}", part.component, part.verdict).ok();
        if let Some(hours) = &part.hours {
            writeln!(text, "             {}", hours_in_words(hours)).ok();
        }
        if !part.text.is_empty() {
            writeln!(text, "             {}", part.text).ok();
            let is_by_load = matches!(part.verdict.as_str(), "hard" | "light");
            let verb = if is_by_load { "reset" } else { "renew" };
            writeln!(text, "             Then: rvac health {verb} {}", part.component).ok();
        }
    }
    text
}

fn hours_in_words(hours: &PartHours) -> String {
    let done = match hours.care {
        PartCare::Replace => "replaced",
        PartCare::Clean => "cleaned",
    };
    let since = hours
        .since_s
        .map(|since_s| format!(", {done} {}", when(Some(since_s))));
    format!(
        "{:.1} h of work{}; such parts are usually {done} after {:.0} h",
        hours.worked_h,
        since.unwrap_or_default(),
        hours.usual_h
    )
}

#[cfg(test)]
mod tests {
    use super::table;
    use rvac_api::{ComponentHealth, PartCare, PartHours};

    #[test]
    fn a_part_that_runs_hard_is_shown_with_what_to_do() {
        let parts = [
            ComponentHealth {
                component: "brush-main".to_owned(),
                verdict: "hard".to_owned(),
                minutes: 40,
                load_a: Some(0.62),
                usual_a: Some(0.4),
                share: Some(1.55),
                hours: Some(PartHours {
                    worked_h: 310.04,
                    usual_h: 300.0,
                    ..PartHours::default()
                }),
                text: "Take hair off it.".to_owned(),
            },
            ComponentHealth {
                component: "wheel-left".to_owned(),
                verdict: "learning".to_owned(),
                minutes: 4,
                ..ComponentHealth::default()
            },
            ComponentHealth {
                component: "sensors".to_owned(),
                verdict: "unmeasured".to_owned(),
                hours: Some(PartHours {
                    worked_h: 31.0,
                    usual_h: 30.0,
                    care: PartCare::Clean,
                    ..PartHours::default()
                }),
                text: "Wipe them.".to_owned(),
                ..ComponentHealth::default()
            },
        ];
        assert_eq!(
            table(&parts),
            "brush-main   hard       155 % of the load after the reset (0.62 of 0.40 A)\n\
             \u{20}            310.0 h of work; such parts are usually replaced after 300 h\n\
             \u{20}            Take hair off it.\n\
             \u{20}            Then: rvac health reset brush-main\n\
             wheel-left   learning   4 of 10 minutes of cleaning measured\n\
             sensors      unmeasured cannot be measured, only its hours are counted\n\
             \u{20}            31.0 h of work; such parts are usually cleaned after 30 h\n\
             \u{20}            Wipe them.\n\
             \u{20}            Then: rvac health renew sensors\n"
        );
    }
}
