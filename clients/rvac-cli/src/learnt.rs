//! `rvac learnt`: what robots have learnt of themselves.

use std::fmt::Write as _;
use std::io::{Write as _, stdout};
use std::process::ExitCode;

use rvac_api::{LearntPart, LearntView, RequestBody, Update};

use crate::arguments::{LearntJob, LearntVerb};
use crate::control;
use crate::history::when;
use crate::socket::Connection;

pub(crate) fn run(job: &LearntJob) -> anyhow::Result<ExitCode> {
    if let Some(LearntVerb::Forget { device, part }) = &job.verb {
        let (device, part) = (device.clone(), part.map(LearntPart::from));
        return control::send(RequestBody::ForgetLearnt { device, part }, &job.daemon);
    }
    let mut connection = Connection::open(&job.daemon)?;
    let request = RequestBody::Learnt;
    let (devices, text) =
        control::answer(
            &mut connection,
            request,
            control::ANSWER,
            |update, text| match update {
                Update::Learnt { devices, .. } => Some((devices, text)),
                _ => None,
            },
        )?;
    if job.json {
        writeln!(stdout(), "{text}")?;
    } else {
        write!(stdout(), "{}", in_words(&devices))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn in_words(devices: &[LearntView]) -> String {
    if devices.is_empty() {
        return "no calibration yet: a robot calibrates itself while it cleans\n".to_owned();
    }
    let mut text = String::new();
    for LearntView {
        device,
        here,
        gyro,
        energy,
        learnt_s,
    } in devices
    {
        let here = if *here { ", attached" } else { "" };
        // Writing to a string cannot fail.
        let when = learnt_s.map(|learnt_s| format!(", last calibrated {}", when(Some(learnt_s))));
        writeln!(text, "{device}{here}{}", when.unwrap_or_default()).ok();
        if let Some(gyro) = gyro {
            writeln!(
                text,
                "  gyro    counts {:+.2} % too little (sure to {:.2} %), bias {:+.2} deg/min",
                100.0 * gyro.scale,
                100.0 * gyro.scale_sigma,
                60.0 * gyro.bias_rad_per_s.to_degrees(),
            )
            .ok();
        }
        if let Some(energy) = energy {
            writeln!(
                text,
                "  energy  an hour of cleaning takes {:.0} % of the charge, one of driving {:.0} % (from {:.0} min)",
                100.0 * energy.cleaning_per_h,
                100.0 * energy.driving_per_h,
                energy.seen_s / 60.0,
            )
            .ok();
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::in_words;
    use rvac_api::{EnergyLearnt, GyroLearnt, LearntView};

    #[test]
    fn each_robot_is_shown_with_what_is_kept_of_it() {
        let devices = [
            LearntView {
                device: "relax".to_owned(),
                energy: Some(EnergyLearnt {
                    cleaning_per_h: 0.9,
                    driving_per_h: 0.3,
                    seen_s: 600.0,
                }),
                ..LearntView::default()
            },
            LearntView {
                device: "sr8730".to_owned(),
                here: true,
                gyro: Some(GyroLearnt {
                    scale: -0.012,
                    scale_sigma: 0.001,
                    bias_rad_per_s: 0.0001,
                }),
                energy: None,
                learnt_s: None,
            },
        ];
        assert_eq!(
            in_words(&devices),
            "relax\n  energy  an hour of cleaning takes 90 % of the charge, one of driving 30 % (from 10 min)\n\
             sr8730, attached\n  gyro    counts -1.20 % too little (sure to 0.10 %), bias +0.34 deg/min\n"
        );
        assert!(in_words(&[]).starts_with("no calibration yet"));
    }
}
