//! Sensor readings and attempts of the robot, as a table.

use std::fmt::Write as _;
use std::io::{Write as _, stdout};

use anyhow::bail;
use rvac_api::{Evidence, EvidenceSample, RequestBody, Standstill, Topic, Update};

use super::{PATIENCE, ago, past_updates};
use crate::control;
use crate::socket::Connection;

/// Prints the recent sensor readings and attempts.
pub(super) fn print_evidence(mut connection: Connection, json: bool) -> anyhow::Result<()> {
    let request = RequestBody::Evidence;
    let (evidence, text) =
        control::answer(&mut connection, request, PATIENCE, |update, text| match update {
            Update::Evidence { evidence, .. } => Some((evidence, text)),
            _ => None,
        })?;
    if json {
        writeln!(stdout(), "{text}")?;
    } else if evidence.is_empty() {
        bail!("nothing was heard of the robot in the last ten seconds");
    } else {
        write!(stdout(), "{}", table(&evidence, 0.0))?;
    }
    Ok(())
}

/// Prints why the robot last stopped by itself.
pub(super) fn print_stop(mut connection: Connection, json: bool) -> anyhow::Result<()> {
    let mut newest = None;
    let now_s = past_updates(&mut connection, Topic::Standstills, |update, text| {
        if let Update::Standstill(told) = update {
            newest = Some((told, text));
        }
    })?;
    match newest {
        None => bail!("the robot has not stood still by itself since the daemon's start"),
        Some((_, text)) if json => writeln!(stdout(), "{text}")?,
        Some((told, _)) => write!(stdout(), "{}", in_words(&told, now_s))?,
    }
    Ok(())
}

fn in_words(told: &Standstill, now_s: f64) -> String {
    let place = if told.lost {
        "it did not know where it was".to_owned()
    } else {
        format!("at x {:.2} m, y {:.2} m", told.place.x, told.place.y)
    };
    let remedy = if told.remedy.is_empty() {
        String::new()
    } else {
        format!("{}\n", told.remedy)
    };
    format!(
        "{} ({}, {}, {place})\n{remedy}{}",
        told.text,
        told.reason,
        ago(now_s - told.t),
        table(&told.evidence, told.t)
    )
}

/// Decisions and readings. Decisions have their time in seconds before `moment_s`, or none when that is 0.
fn table(evidence: &Evidence, moment_s: f64) -> String {
    let mut text = String::new();
    for decision in &evidence.tried {
        let when = if moment_s > 0.0 {
            format!("{:>7.1} s  ", decision.t - moment_s)
        } else {
            "  tried  ".to_owned()
        };
        let _ = writeln!(text, "{when}{}", decision.text);
    }
    if !evidence.samples.is_empty() {
        let _ = writeln!(
            text,
            "{:>9}  {:>6}  {:>6}  {:>5}  felt",
            "", "m/s", "rad/s", "echo"
        );
    }
    for sample in &evidence.samples {
        let _ = writeln!(text, "{}", row(sample));
    }
    text
}

fn row(sample: &EvidenceSample) -> String {
    let echo = sample.echo.map_or_else(String::new, |echo| format!("{echo:.2}"));
    let mut signs = sample.signs.join(", ");
    if let Some([left, right, brush]) = sample.currents_a {
        let between = if signs.is_empty() { "" } else { "; " };
        let _ = write!(signs, "{between}{left:.2} A, {right:.2} A");
        // A main brush whose current is not measured shows exactly 0.
        if brush != 0.0 {
            let _ = write!(signs, ", brush {brush:.2} A");
        }
    }
    let row = format!(
        "{:>7.1} s  {:>6.2}  {:>6.2}  {echo:>5}  {signs}",
        plain(sample.at_s, 10.0),
        plain(sample.v, 100.0),
        plain(sample.w, 100.0)
    );
    row.trim_end().to_owned()
}

/// Rounded to so many steps of one; no zero has a sign.
fn plain(value: f64, steps: f64) -> f64 {
    (steps * value).round() / steps + 0.0
}

#[cfg(test)]
mod tests {
    use rvac_api::{Decision, Evidence, EvidenceSample, Pose, Standstill};

    use super::{in_words, table};

    #[test]
    fn a_stop_is_shown_with_what_to_do() {
        let mut told = Standstill {
            number: 1,
            t: 60.0,
            state: "paused".to_owned(),
            reason: "wheel-drop".to_owned(),
            text: "Paused: a wheel hangs in the air.".to_owned(),
            remedy: "Put the robot flat on the floor.".to_owned(),
            place: Pose::default(),
            lost: false,
            evidence: Evidence::default(),
        };
        let head = "Paused: a wheel hangs in the air. (wheel-drop, 5 s ago, at x 0.00 m, y 0.00 m)\n";
        assert_eq!(
            in_words(&told, 65.0),
            format!("{head}Put the robot flat on the floor.\n")
        );
        told.remedy.clear();
        assert_eq!(in_words(&told, 65.0), head);
    }

    #[test]
    fn what_was_felt_stands_below_what_was_tried() {
        let evidence = Evidence {
            samples: vec![
                EvidenceSample {
                    at_s: -0.2,
                    v: 0.25,
                    w: -0.001,
                    echo: Some(0.8),
                    ..EvidenceSample::default()
                },
                EvidenceSample {
                    signs: vec!["bumper-left".to_owned()],
                    currents_a: Some([0.5, 0.25, 0.125]),
                    ..EvidenceSample::default()
                },
            ],
            tried: vec![Decision {
                number: 3,
                t: 97.5,
                what: "back-off".to_owned(),
                reason: "bump-left".to_owned(),
                value: 1.0,
                text: "Backed off.".to_owned(),
            }],
        };
        let lines: Vec<String> = table(&evidence, 100.0).lines().map(str::to_owned).collect();
        assert_eq!(
            lines,
            [
                "   -2.5 s  Backed off.",
                "              m/s   rad/s   echo  felt",
                "   -0.2 s    0.25    0.00   0.80",
                "    0.0 s    0.00    0.00         bumper-left; 0.50 A, 0.25 A, brush 0.12 A",
            ]
        );
    }
}
