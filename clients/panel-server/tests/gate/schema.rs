//! As much of JSON Schema as the description of the interface uses. A word that is not known here stops the test, so that nothing
//! is left unchecked.

use serde_json::Value;

/// What of `value` does not fit the schema, with its place; none if all of it does.
pub(crate) fn misfit(root: &Value, schema: &Value, value: &Value) -> Option<String> {
    let keywords = schema.as_object().expect("a schema is an object");
    keywords
        .iter()
        .find_map(|(keyword, wanted)| match keyword.as_str() {
            "description" => None,
            "$ref" => {
                let pointer = wanted.as_str().unwrap().trim_start_matches('#');
                misfit(
                    root,
                    root.pointer(pointer).expect("the reference leads somewhere"),
                    value,
                )
            }
            "type" => (!is_of(wanted.as_str().unwrap(), value)).then(|| format!("{value} is no {wanted}")),
            "enum" => {
                (!wanted.as_array().unwrap().contains(value)).then(|| format!("{value} is none of {wanted}"))
            }
            "minLength" | "maxLength" => {
                let length = value.as_str().map_or(0, |text| text.chars().count() as u64);
                let limit = wanted.as_u64().unwrap();
                let fits = if keyword == "minLength" {
                    length >= limit
                } else {
                    length <= limit
                };
                (!fits).then(|| format!("{value} has {length} characters"))
            }
            "minimum" => (value.as_f64() < wanted.as_f64()).then(|| format!("{value} is below {wanted}")),
            "required" => {
                let mut keys = wanted.as_array().unwrap().iter().filter_map(Value::as_str);
                keys.find(|key| value.get(key).is_none())
                    .map(|key| format!("{value} lacks {key}"))
            }
            "additionalProperties" => {
                let known = &schema["properties"];
                let mut keys = value.as_object().into_iter().flat_map(|entries| entries.keys());
                keys.find(|key| known.get(key.as_str()).is_none())
                    .map(|key| format!("{value} has {key}"))
            }
            "properties" => wanted.as_object().unwrap().iter().find_map(|(key, schema)| {
                let found = value.get(key)?;
                misfit(root, schema, found).map(|what| format!("{key}: {what}"))
            }),
            "items" => value
                .as_array()
                .into_iter()
                .flatten()
                .find_map(|item| misfit(root, wanted, item)),
            other => panic!("the test does not know {other}"),
        })
}

fn is_of(kind: &str, value: &Value) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        other => panic!("the test does not know the type {other}"),
    }
}
