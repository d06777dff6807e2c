//! Reading profiles: what is wrong, where, and what to do.

use std::collections::BTreeSet;

use rvac_api::short_number;
use serde::Deserialize;

use crate::{
    Calibration, Condition, FlightMode, Line, Name, Output, OutputKind, OutputName, Profile, Source,
    TRIM_MAX, Trim, VERSION,
};

/// Largest profile in bytes of JSON. It travels inside of one request.
pub const PROFILE_BYTES_MAX: usize = 10 << 10;
/// Most lines of one output.
pub const LINES_MAX: usize = 24;
/// Most switches.
pub const SWITCHES_MAX: usize = 16;
/// Most flight modes.
pub const MODES_MAX: usize = 8;
/// Smallest and largest step of a trim.
const TRIM_STEP: (f64, f64) = (0.001, 0.1);
/// Longest time in which one flight mode goes over into another.
const FADE_MS_MAX: u16 = 5_000;
/// Most points of a curve.
pub const POINTS_MAX: usize = 17;
/// Most inputs with a calibration.
const CALIBRATIONS_MAX: usize = 64;
/// Most switches that one switch joins.
const JOINED_MAX: usize = 8;
/// Longest delay.
const DELAY_MS_MAX: u16 = 5_000;
/// Slower than this a line would drive on for seconds after the stick was let go.
const SLOW_PER_S_MIN: f64 = 0.5;
/// Faster than this is at once.
const SLOW_PER_S_MAX: f64 = 100.0;
/// Largest factor of a line.
const WEIGHT_MAX: f64 = 2.0;
/// Largest reading of any device.
const READING_MAX: f64 = 100_000.0;
/// Largest dead band.
const DEAD_BAND_MAX: f64 = 0.9;

/// Why a text is no profile.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// It is too large.
    #[error(
        "the profile has {bytes} bytes, {PROFILE_BYTES_MAX} at most: remove lines, or make names shorter"
    )]
    TooLarge {
        /// Its size.
        bytes: usize,
    },
    /// It is no JSON, or has a key or a word that no profile has.
    #[error(
        "line {line}, column {column}: {what}: correct it there, or compare with a profile that was exported"
    )]
    Syntax {
        /// Line of the text, from 1.
        line: usize,
        /// Column in it.
        column: usize,
        /// What the reader says.
        what: String,
    },
    /// It is of another version of the form.
    #[error(
        "the profile has version {found}, this program reads {VERSION}: export it again with a program that fits"
    )]
    Version {
        /// The version in it.
        found: u32,
    },
    /// A number is out of its range, or none.
    #[error("{place} is {}: write a number from {low} to {high}", short_number(*found))]
    Range {
        /// Where.
        place: String,
        /// The number.
        found: f64,
        /// Smallest that is allowed.
        low: f64,
        /// Largest that is allowed.
        high: f64,
    },
    /// Lower end, centre and upper end are out of order.
    #[error("{place}: low, centre and high must rise, and low must be below high")]
    Order {
        /// Where.
        place: String,
    },
    /// Something would move or press by itself after a loss.
    #[error("{place} is {}: it must be 0, so that the robot stands when an input is lost", short_number(*found))]
    Failsafe {
        /// Where.
        place: String,
        /// The number.
        found: f64,
    },
    /// A slow that is none.
    #[error("{place} is {}: write 0 for at once, or {SLOW_PER_S_MIN} to {SLOW_PER_S_MAX} a second", short_number(*found))]
    Slow {
        /// Where.
        place: String,
        /// The number.
        found: f64,
    },
    /// The points of a curve are none.
    #[error("{place}: give 2 to {POINTS_MAX} points that rise from -1 to 1 in their first numbers, or none")]
    Curve {
        /// Where.
        place: String,
    },
    /// There is more of something than is kept.
    #[error("{place}: {found} entries, {most} at most: remove some")]
    TooMany {
        /// Where.
        place: String,
        /// How many.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// Something is there twice.
    #[error("{place} is there twice: remove one")]
    Twice {
        /// Where.
        place: String,
    },
    /// A switch is named that is not defined before this place.
    #[error("{place}: no switch before it has the name `{name}`: add one, or take another")]
    NoSwitch {
        /// Where.
        place: String,
        /// The name.
        name: String,
    },
    /// A flight mode is named that is not defined.
    #[error("{place}: no mode has the name `{name}`: add one, or take another")]
    NoMode {
        /// Where.
        place: String,
        /// The name.
        name: String,
    },
    /// A flight mode has a value of a trim that is not defined.
    #[error("{place}: `{output}` has no trim: add one, or remove this value")]
    NoTrim {
        /// Where.
        place: String,
        /// The output.
        output: OutputName,
    },
    /// A trim of what does not move the robot.
    #[error("{place}: only forward, turn, left-wheel and right-wheel can be trimmed: remove it")]
    NotTrimmed {
        /// Where.
        place: String,
    },
    /// A switch that joins none.
    #[error("{place}: name at least one switch")]
    JoinsNone {
        /// Where.
        place: String,
    },
}

/// Reads and checks a profile.
pub(crate) fn parse(text: &str) -> Result<Profile, ProfileError> {
    #[derive(Deserialize)]
    struct Head {
        version: u32,
    }

    // What people laid out with blanks and lines is measured without them.
    if text.len() > 8 * PROFILE_BYTES_MAX {
        return Err(ProfileError::TooLarge { bytes: text.len() });
    }
    let head: Head = serde_json::from_str(text).map_err(syntax)?;
    if head.version != VERSION {
        return Err(ProfileError::Version { found: head.version });
    }
    let profile: Profile = serde_json::from_str(text).map_err(syntax)?;
    check(&profile)?;
    Ok(profile)
}

fn syntax(error: serde_json::Error) -> ProfileError {
    let text = error.to_string();
    // The reader repeats the place at the end.
    let what = text
        .rsplit_once(" at line ")
        .map_or(text.as_str(), |(what, _)| what);
    ProfileError::Syntax {
        line: error.line(),
        column: error.column(),
        what: what.to_owned(),
    }
}

/// Checks a profile.
pub(crate) fn check(profile: &Profile) -> Result<(), ProfileError> {
    if profile.version != VERSION {
        return Err(ProfileError::Version {
            found: profile.version,
        });
    }
    let bytes = profile.to_json().len();
    if bytes > PROFILE_BYTES_MAX {
        return Err(ProfileError::TooLarge { bytes });
    }
    calibrations(&profile.inputs)?;
    let switches = switches(profile)?;
    trims(&profile.trims, &switches)?;
    let known = Known {
        modes: modes(profile, &switches)?,
        switches,
    };
    let mut seen = BTreeSet::new();
    for (number, output) in profile.outputs.iter().enumerate() {
        if !seen.insert(output.output) {
            return Err(ProfileError::Twice {
                place: output.place(),
            });
        }
        check_output(output)?;
        for (line_number, line) in output.lines.iter().enumerate() {
            check_line(&profile.line_place(number, line_number), line, &known)?;
        }
    }
    Ok(())
}

/// Names that lines may refer to.
struct Known<'profile> {
    switches: BTreeSet<&'profile Name>,
    modes: BTreeSet<&'profile Name>,
}

fn trims(all: &[Trim], switches: &BTreeSet<&Name>) -> Result<(), ProfileError> {
    let mut seen = BTreeSet::new();
    for trim in all {
        let place = trim.place();
        if !seen.insert(trim.output) {
            return Err(ProfileError::Twice { place });
        }
        if trim.output.kind() != OutputKind::Motion {
            return Err(ProfileError::NotTrimmed { place });
        }
        for button in [&trim.up, &trim.down] {
            source(&place, button, switches)?;
        }
        range((&place, "step"), trim.step, TRIM_STEP)?;
        range((&place, "value"), trim.value, (-TRIM_MAX, TRIM_MAX))?;
    }
    Ok(())
}

/// Checks the flight modes and gives their names.
fn modes<'profile>(
    profile: &'profile Profile,
    switches: &BTreeSet<&Name>,
) -> Result<BTreeSet<&'profile Name>, ProfileError> {
    at_most("modes", profile.modes.len(), MODES_MAX)?;
    let mut known = BTreeSet::new();
    for mode in &profile.modes {
        let place = mode.place();
        is_known(&place, &mode.when, switches)?;
        range(
            (&place, "fade-ms"),
            f64::from(mode.fade_ms),
            (0.0, f64::from(FADE_MS_MAX)),
        )?;
        own_trims(&place, mode, &profile.trims)?;
        if !known.insert(&mode.name) {
            return Err(ProfileError::Twice { place });
        }
    }
    Ok(known)
}

fn own_trims(place: &str, mode: &FlightMode, trims: &[Trim]) -> Result<(), ProfileError> {
    let mut seen = BTreeSet::new();
    for own in &mode.trims {
        let place = format!("{place}, trim {}", own.output);
        if !trims.iter().any(|trim| trim.output == own.output) {
            let output = own.output;
            return Err(ProfileError::NoTrim { place, output });
        }
        range((&place, "value"), own.value, (-TRIM_MAX, TRIM_MAX))?;
        if !seen.insert(own.output) {
            return Err(ProfileError::Twice { place });
        }
    }
    Ok(())
}

fn calibrations(all: &[Calibration]) -> Result<(), ProfileError> {
    at_most("inputs", all.len(), CALIBRATIONS_MAX)?;
    let mut seen = BTreeSet::new();
    for calibration in all {
        let place = calibration.place();
        if !seen.insert(&calibration.input) {
            return Err(ProfileError::Twice { place });
        }
        for (name, value) in [
            ("low", calibration.low),
            ("centre", calibration.centre),
            ("high", calibration.high),
        ] {
            range((&place, name), value, (-READING_MAX, READING_MAX))?;
        }
        range((&place, "dead-band"), calibration.dead_band, (0.0, DEAD_BAND_MAX))?;
        in_order(place, [calibration.low, calibration.centre, calibration.high])?;
    }
    Ok(())
}

/// Checks the switches and gives their names.
fn switches(profile: &Profile) -> Result<BTreeSet<&Name>, ProfileError> {
    at_most("switches", profile.switches.len(), SWITCHES_MAX)?;
    let mut known = BTreeSet::new();
    for switch in &profile.switches {
        let place = switch.place();
        let joined = switch.on.switches();
        at_most(&place, joined.len(), JOINED_MAX)?;
        if joined.is_empty() && matches!(switch.on, Condition::All(_) | Condition::Any(_)) {
            return Err(ProfileError::JoinsNone { place });
        }
        for name in joined {
            is_known(&place, name, &known)?;
        }
        if let Some(input) = switch.on.input() {
            source(&place, input, &known)?;
        }
        match &switch.on {
            Condition::Above { level, .. } | Condition::Below { level, .. } => {
                range((&place, "level"), *level, (-1.0, 1.0))?;
            }
            Condition::Edge { hold_ms, .. } => delay((&place, "hold-ms"), *hold_ms)?,
            _ => {}
        }
        if !known.insert(&switch.name) {
            return Err(ProfileError::Twice { place });
        }
    }
    Ok(known)
}

fn check_output(output: &Output) -> Result<(), ProfileError> {
    let place = output.place();
    let kind = output.output.kind();
    let least = if kind == OutputKind::Motion { -1.0 } else { 0.0 };
    for (name, value) in [
        ("low", output.low),
        ("centre", output.centre),
        ("high", output.high),
    ] {
        range((&place, name), value, (least, 1.0))?;
    }
    in_order(place.clone(), [output.low, output.centre, output.high])?;
    range((&place, "failsafe"), output.failsafe, (output.low, output.high))?;
    if kind != OutputKind::Cleaner && output.failsafe != 0.0 {
        return Err(ProfileError::Failsafe {
            place: format!("{place}, failsafe"),
            found: output.failsafe,
        });
    }
    at_most(&place, output.lines.len(), LINES_MAX)
}

fn check_line(place: &str, line: &Line, known: &Known<'_>) -> Result<(), ProfileError> {
    source(place, &line.input, &known.switches)?;
    if let Some(name) = &line.when {
        is_known(place, name, &known.switches)?;
    }
    if let Some(name) = line.modes.iter().find(|name| !known.modes.contains(name)) {
        return Err(ProfileError::NoMode {
            place: place.to_owned(),
            name: name.to_string(),
        });
    }
    range((place, "expo"), line.expo, (-1.0, 1.0))?;
    range((place, "weight"), line.weight, (-WEIGHT_MAX, WEIGHT_MAX))?;
    range((place, "offset"), line.offset, (-1.0, 1.0))?;
    delay((place, "delay-ms"), line.delay_ms)?;
    for (name, found) in [
        ("slow-up-per-s", line.slow_up_per_s),
        ("slow-down-per-s", line.slow_down_per_s),
    ] {
        // Written so that NaN is refused too.
        if !(found == 0.0 || (SLOW_PER_S_MIN..=SLOW_PER_S_MAX).contains(&found)) {
            return Err(ProfileError::Slow {
                place: format!("{place}, {name}"),
                found,
            });
        }
    }
    if is_curve(&line.curve) {
        Ok(())
    } else {
        Err(ProfileError::Curve {
            place: format!("{place}, curve"),
        })
    }
}

fn is_curve(points: &[[f64; 2]]) -> bool {
    let (Some([first, _]), Some([last, _])) = (points.first(), points.last()) else {
        return true;
    };
    let spans = *first == -1.0 && *last == 1.0 && points.len() <= POINTS_MAX;
    let rises = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    spans && rises && points.iter().all(|[_, height]| (-1.0..=1.0).contains(height))
}

fn source(place: &str, source: &Source, switches: &BTreeSet<&Name>) -> Result<(), ProfileError> {
    match source {
        Source::Switch(name) => is_known(place, name, switches),
        _ => Ok(()),
    }
}

fn is_known(place: &str, name: &Name, known: &BTreeSet<&Name>) -> Result<(), ProfileError> {
    if known.contains(name) {
        return Ok(());
    }
    Err(ProfileError::NoSwitch {
        place: place.to_owned(),
        name: name.to_string(),
    })
}

fn range((place, name): (&str, &str), found: f64, (low, high): (f64, f64)) -> Result<(), ProfileError> {
    // NaN is in no range.
    if (low..=high).contains(&found) {
        return Ok(());
    }
    Err(ProfileError::Range {
        place: format!("{place}, {name}"),
        found,
        low,
        high,
    })
}

fn delay((place, name): (&str, &str), found: u16) -> Result<(), ProfileError> {
    range((place, name), f64::from(found), (0.0, f64::from(DELAY_MS_MAX)))
}

fn in_order(place: String, [low, centre, high]: [f64; 3]) -> Result<(), ProfileError> {
    if low <= centre && centre <= high && low < high {
        Ok(())
    } else {
        Err(ProfileError::Order { place })
    }
}

fn at_most(place: &str, found: usize, most: usize) -> Result<(), ProfileError> {
    if found <= most {
        return Ok(());
    }
    Err(ProfileError::TooMany {
        place: place.to_owned(),
        found,
        most,
    })
}
