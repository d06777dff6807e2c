//! `rvac health`: how worn or dirty the parts are that turn, by what their motors draw.

use std::fmt::Write as _;
use std::io::{Write as _, stdout};
use std::process::ExitCode;

use rvac_api::{ComponentHealth, RequestBody, Update};

use crate::arguments::{HealthJob, HealthVerb};
use crate::control;
use crate::socket::Connection;

pub(crate) fn run(job: &HealthJob) -> anyhow::Result<ExitCode> {
    if let Some(HealthVerb::Reset { component }) = &job.verb {
        let component = component.clone();
        return control::send(RequestBody::ResetHealth { component }, &job.daemon);
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

/// A line for each part, and what to do about it.
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
            _ => format!("{} of 10 minutes of cleaning measured", part.minutes),
        };
        // Writing to a string cannot fail.
        writeln!(text, "{:12} {:9} {load}", part.component, part.verdict).ok();
        if !part.text.is_empty() {
            writeln!(text, "             {}", part.text).ok();
            writeln!(text, "             Then: rvac health reset {}", part.component).ok();
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::table;
    use rvac_api::ComponentHealth;

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
                text: "Take hair off it.".to_owned(),
            },
            ComponentHealth {
                component: "wheel-left".to_owned(),
                verdict: "learning".to_owned(),
                minutes: 4,
                ..ComponentHealth::default()
            },
        ];
        assert_eq!(
            table(&parts),
            "brush-main   hard      155 % of the load after the reset (0.62 of 0.40 A)\n\
             \u{20}            Take hair off it.\n\
             \u{20}            Then: rvac health reset brush-main\n\
             wheel-left   learning  4 of 10 minutes of cleaning measured\n"
        );
    }
}
