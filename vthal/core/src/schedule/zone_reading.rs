//! What a system says of its time zone.

use std::fmt::Display;

use super::Zone;

/// Read at the start, and again when it has changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ZoneReading {
    /// Name of the zone, or a phrase that says why there is none.
    pub name: Result<String, String>,
    /// Without a name: what stands in the place of one.
    pub tried: Option<String>,
    /// The environment's `TZ`, if it is set and names no zone.
    pub wrong_variable: Option<String>,
}

impl ZoneReading {
    /// From the name or why there is none, what stands in the place of a name, and a `TZ` that names no zone.
    pub fn new(
        name: &Result<String, impl Display>,
        tried: Option<&str>,
        wrong_variable: Option<&str>,
    ) -> Self {
        Self {
            name: name
                .as_ref()
                .map_or_else(|why| Err(why.to_string()), |name| Ok(name.clone())),
            tried: tried.map(str::to_owned),
            wrong_variable: wrong_variable.map(str::to_owned),
        }
    }

    /// The zone, or a phrase that says why there is none, with the name that may be meant.
    pub(crate) fn zone(&self) -> Result<Zone, String> {
        let name = self.name.as_ref().map_err(|why| match &self.tried {
            Some(tried) => format!("{why}{}", meant(tried)),
            None => why.clone(),
        })?;
        Zone::named(name).ok_or_else(|| format!("there is no time zone {name}{}", meant(name)))
    }

    /// A phrase that says what is wrong with `TZ`, with the name that may be meant.
    pub(crate) fn variable_complaint(&self) -> Option<String> {
        let text = self.wrong_variable.as_deref()?;
        Some(format!("TZ is {text:?}, which names no time zone{}", meant(text)))
    }
}

/// The name that is most like one which no zone has, as a question.
fn meant(name: &str) -> String {
    Zone::name_like(name).map_or_else(String::new, |like| format!(": did you mean {like}?"))
}

#[cfg(test)]
mod tests {
    use super::ZoneReading;

    fn unnamed(tried: Option<&str>, variable: Option<&str>) -> ZoneReading {
        ZoneReading {
            name: Err("there is no file".to_owned()),
            tried: tried.map(str::to_owned),
            wrong_variable: variable.map(str::to_owned),
        }
    }

    #[test]
    fn a_name_that_is_nearly_one_is_asked_for() {
        let told = |variable| unnamed(None, Some(variable)).variable_complaint();
        assert_eq!(
            told("Europe/Tallin").as_deref(),
            Some(r#"TZ is "Europe/Tallin", which names no time zone: did you mean Europe/Tallinn?"#)
        );
        assert_eq!(
            told("Moon").as_deref(),
            Some(r#"TZ is "Moon", which names no time zone"#)
        );
        let why = |tried| unnamed(tried, None).zone().expect_err("no zone");
        assert_eq!(why(None), "there is no file");
        assert_eq!(
            why(Some("Europe/Tallin")),
            "there is no file: did you mean Europe/Tallinn?"
        );
        let of_old_rules = ZoneReading {
            name: Ok("Europe/Talin".to_owned()),
            ..unnamed(None, None)
        };
        assert_eq!(
            of_old_rules.zone().expect_err("no zone"),
            "there is no time zone Europe/Talin: did you mean Europe/Tallinn?"
        );
    }
}
