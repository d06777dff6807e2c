//! Lines that any program can send: `{"beacon":"kitchen","range_m":3.21}`, with `"sigma_m"` where the program can estimate how far
//! off that may be, or `{"beacon":"kitchen","rssi_dbm":-63}` of a radio that measures signal strength only.

use serde::Deserialize;

use super::reading::{BeaconName, LineError, Reading};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct JsonReading {
    beacon: String,
    range_m: Option<f64>,
    sigma_m: Option<f64>,
    rssi_dbm: Option<f64>,
}

/// What the line says; nothing if it is empty.
pub(super) fn read(line: &str) -> Result<Vec<Reading>, LineError> {
    if line.trim().is_empty() {
        return Ok(Vec::new());
    }
    let line: JsonReading = serde_json::from_str(line).map_err(|error| LineError::Json(error.to_string()))?;
    let name = BeaconName::new(&line.beacon).map_err(|_| LineError::Name(line.beacon))?;
    let reading = match (line.range_m, line.rssi_dbm) {
        (Some(range_m), None) => Reading::range(name, range_m, line.sigma_m)?,
        (None, Some(_)) if line.sigma_m.is_some() => return Err(LineError::SigmaOfStrength),
        (None, Some(dbm)) => Reading::strength(name, dbm)?,
        (Some(_), Some(_)) | (None, None) => return Err(LineError::RangeOrStrength),
    };
    Ok(vec![reading])
}

#[cfg(test)]
mod tests {
    use super::super::reading::Measured;
    use super::read;

    #[test]
    fn a_line_tells_one_distance() {
        let readings = read(r#" {"beacon":"kitchen","range_m":3.21}"#).unwrap();
        assert_eq!(readings.len(), 1);
        assert_eq!(readings[0].beacon.to_string(), "kitchen");
        assert_eq!(readings[0].measured, Measured::Range(3.21, None));
        let surer = read(r#"{"sigma_m":0.05,"range_m":0,"beacon":"a"}"#).unwrap();
        assert_eq!(surer[0].measured, Measured::Range(0.0, Some(0.05)));
        assert_eq!(read("  "), Ok(Vec::new()));
    }

    #[test]
    fn a_line_tells_one_strength() {
        let readings = read(r#"{"beacon":"kitchen","rssi_dbm":-63}"#).unwrap();
        assert_eq!(readings.len(), 1);
        assert_eq!(readings[0].measured, Measured::Strength(-63.0));
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (line, reason) in [
            ("{", "EOF while parsing"),
            (r#"{"beacon":"a"}"#, "one of the two"),
            (r#"{"beacon":"a","range_m":1,"rssi_dbm":-50}"#, "one of the two"),
            (
                r#"{"beacon":"a","rssi_dbm":-50,"sigma_m":1}"#,
                "sigma_m belongs to range_m",
            ),
            (
                r#"{"beacon":"a","rssi_dbm":63}"#,
                "63 dBm is no received power from -130 to 0 dBm",
            ),
            (r#"{"beacon":"a","rssi_dbm":-131}"#, "no received power"),
            (r#"{"beacon":"a","range":1}"#, "unknown field `range`"),
            (r#"{"beacon":"a","range_m":"1"}"#, "invalid type"),
            (r#"{"beacon":"a","range_m":1e999}"#, "number out of range"),
            (r#"{"beacon":"a b","range_m":1}"#, "no blanks"),
            (r#"{"beacon":"","range_m":1}"#, "1 to 32"),
            (r#"{"beacon":"a","range_m":-0.1}"#, "-0.1 m is no distance"),
            (r#"{"beacon":"a","range_m":201}"#, "201 m is no distance"),
            (r#"{"beacon":"a","range_m":1,"sigma_m":0}"#, "0 m is no deviation"),
        ] {
            let error = read(line).unwrap_err().to_string();
            assert!(error.contains(reason), "{line}: {error}");
        }
    }
}
