//! A sound request of each kind, for whoever tries them all.

/// One of each, as it stands on the wire, without a number.
#[rustfmt::skip]
const EXAMPLES: [&str; 70] = [
    r#"{"c":"hello","name":"phone"}"#,
    r#"{"c":"watch","topics":["status","log"]}"#,
    r#"{"c":"estimate","parts":[{"zone":[[0.5,0.5],[2.0,0.5],[2.0,1.5],[0.5,1.5]]},{"spot":[1.0,1.0]}],"passes":2,"avoid":[{"wall":[[0.0,0.5],[1.0,0.5]]}]}"#,
    r#"{"c":"evidence"}"#,
    r#"{"c":"health"}"#,
    r#"{"c":"learnt"}"#,
    r#"{"c":"calibration"}"#,
    r#"{"c":"maps","floor":1}"#,
    r#"{"c":"mixes"}"#,
    r#"{"c":"runs","count":10}"#,
    r#"{"c":"statistics"}"#,
    r#"{"c":"run","number":1}"#,
    r#"{"c":"run-track","number":1}"#,
    r#"{"c":"run-file","number":1,"from":0}"#,
    r#"{"c":"export-floors","from":0}"#,
    r#"{"c":"stop"}"#,
    r#"{"c":"start","strategy":"bounce"}"#,
    r#"{"c":"clean","parts":[{"room":1},{"place":1}],"passes":1,"pattern":"contour"}"#,
    r#"{"c":"spot"}"#,
    r#"{"c":"go-to","x":1.0,"y":0.5}"#,
    r#"{"c":"pause"}"#,
    r#"{"c":"resume"}"#,
    r#"{"c":"dock"}"#,
    r#"{"c":"drive","v":0.1,"w":0.5,"ttl":250}"#,
    r#"{"c":"release"}"#,
    r#"{"c":"set-inputs","values":{"tilt":0.5},"ttl":300}"#,
    r#"{"c":"locate"}"#,
    r#"{"c":"clear","reason":"wheel-drop"}"#,
    r#"{"c":"run-schedule","number":1}"#,
    r#"{"c":"skip-next","number":1,"skip":true}"#,
    r#"{"c":"choose-floor","floor":1}"#,
    r#"{"c":"add-no-go","shape":{"zone":[[0.0,0.5],[1.0,0.5],[1.0,1.5]]},"name":"Stairs"}"#,
    r#"{"c":"remove-no-go","number":1}"#,
    r#"{"c":"name-no-go","number":1,"name":"Stairs"}"#,
    r#"{"c":"reshape-no-go","number":1,"shape":{"wall":[[0.0,0.5],[1.0,0.5]]}}"#,
    r#"{"c":"keep-place","name":"Table","shape":{"spot":[0.0,0.5]}}"#,
    r#"{"c":"name-place","number":1,"name":"Table"}"#,
    r#"{"c":"reshape-place","number":1,"shape":{"zone":[[0.0,0.5],[1.0,0.5],[1.0,1.5]]}}"#,
    r#"{"c":"forget-place","number":1}"#,
    r#"{"c":"name-room","room":1,"name":"Kitchen"}"#,
    r#"{"c":"set-room","room":1,"settings":{"passes":2}}"#,
    r#"{"c":"split-room","line":[[0.0,0.5],[1.0,0.5]]}"#,
    r#"{"c":"join-rooms","rooms":[1,2]}"#,
    r#"{"c":"undo-room-change","number":1}"#,
    r#"{"c":"move-dock","x":0.5,"y":0.5,"heading":1.5}"#,
    r#"{"c":"reset-health","component":"brush-main"}"#,
    r#"{"c":"renew-part","component":"filter"}"#,
    r#"{"c":"undo-renew-part","component":"filter"}"#,
    r#"{"c":"forget-learnt","device":"sr8730"}"#,
    r#"{"c":"restore-map","number":1}"#,
    r#"{"c":"new-floor"}"#,
    r#"{"c":"name-floor","floor":1,"name":"Ground floor"}"#,
    r#"{"c":"remove-floor","floor":1}"#,
    r#"{"c":"restore-floor","floor":1}"#,
    r#"{"c":"import-floors","from":0,"size":3,"data":"AAEC"}"#,
    r#"{"c":"save-mix","profile":"{}"}"#,
    r#"{"c":"remove-mix","name":"Sofa"}"#,
    r#"{"c":"add-schedule","name":"Kitchen","job":{"start":{}},"when":{"weekly":{"days":["mo","fr"],"at":"07:30"}}}"#,
    r#"{"c":"change-schedule","number":1,"name":"Kitchen","job":{"start":{}},"when":{"once":{"date":"2026-11-23","at":"09:00"}}}"#,
    r#"{"c":"remove-schedule","number":1}"#,
    r#"{"c":"enable-schedule","number":1,"enabled":true}"#,
    r#"{"c":"set-quiet","quiet":{"from":"22:00","to":"07:00"}}"#,
    r#"{"c":"set-zone","zone":"Europe/Tallinn"}"#,
    r#"{"c":"borrow-link","silent":false}"#,
    r#"{"c":"begin-calibration","names":["gyro-scale"]}"#,
    r#"{"c":"answer-calibration","page":1,"answer":"go"}"#,
    r#"{"c":"hold-calibration","held":false}"#,
    r#"{"c":"end-calibration"}"#,
    r#"{"c":"claim-buttons","ms":0}"#,
    r#"{"c":"raw","packet":"{}"}"#,
];

/// A sound request with this word in `c`.
#[must_use]
pub fn example_of(verb: &str) -> Option<&'static str> {
    EXAMPLES.into_iter().find(|example| word_of(example) == verb)
}

/// What stands in `c`, which comes first in each.
fn word_of(example: &str) -> &str {
    example.split('"').nth(3).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{EXAMPLES, example_of, word_of};
    use crate::{Request, VERBS};

    #[test]
    fn each_request_has_an_example_that_reads_and_says_no_more_than_is_read() {
        for (verb, _) in VERBS {
            assert!(example_of(verb).is_some(), "{verb}");
        }
        for example in EXAMPLES {
            let request: Request =
                serde_json::from_str(example).unwrap_or_else(|error| panic!("{example}: {error}"));
            let read = serde_json::to_value(&request).expect("JSON");
            let said: serde_json::Value = serde_json::from_str(example).expect("JSON");
            for (key, value) in said.as_object().expect("an object") {
                assert!(
                    read.get(key).is_some() || value.is_null(),
                    "{example}: {key} is not read"
                );
            }
            assert_eq!(read["c"], word_of(example));
        }
    }
}
