//! JSON schemas of the channels: what Foxglove needs to offer the fields by name.

/// Name, topic and schema of each channel.
pub(crate) const CHANNELS: [(&str, &str, &str); 7] = [
    (
        super::RUN,
        "vthal.Run",
        r#"{"type":"object","properties":{"format":{"type":"integer"},"vthal":{"type":"string"},"time_us":{"type":"integer"},"run":{"type":"integer"},"cause":{"type":"string"},"seed":{"type":"integer"},"device":{"type":"string"},"firmware":{"type":"string"},"config":{"type":"object"},"state":{"type":"object"}}}"#,
    ),
    (
        super::OBSERVATIONS,
        "vthal.Observation",
        r#"{"type":"object","properties":{"time_us":{"type":"integer"},"left_m":{"type":"number"},"right_m":{"type":"number"},"gyro_rad":{"type":"number"},"contacts":{"type":"array","items":{"type":"boolean"}},"cliffs":{"type":"array","items":{"type":"boolean"}},"wheel_drop":{"type":"boolean"},"proximity":{"type":"array","items":{"type":"number"}},"dock_beams":{"type":"array","items":{"type":"integer"}},"docked":{"type":"boolean"},"battery":{"type":"number"},"inhibits":{"type":"array","items":{"type":"string"}},"link_up":{"type":"boolean"},"speed_share":{"type":"number"}}}"#,
    ),
    (
        super::COMMANDS,
        "vthal.Command",
        r#"{"type":"object","properties":{"time_us":{"type":"integer"},"command":{}}}"#,
    ),
    (
        super::DECISIONS,
        "vthal.Actions",
        r#"{"type":"object","properties":{"motion":{},"cleaners":{"type":"boolean"},"arm":{"type":"object"},"tones":{"type":"array"},"decisions":{"type":"array","items":{"type":"object","properties":{"what":{"type":"string"},"reason":{"type":"string"},"value":{"type":"number"}}}}}}"#,
    ),
    (
        super::PACKETS,
        "vthal.Packet",
        r#"{"type":"object","properties":{"direction":{"type":"string"},"text":{"type":"string"}}}"#,
    ),
    (
        super::STATUS,
        "vthal.Status",
        r#"{"type":"object","properties":{"state":{"type":"string"},"reason":{"type":"string"},"strategy":{"type":"string"},"inhibits":{"type":"array","items":{"type":"string"}},"job_s":{"type":"number"},"swept_m2":{"type":"number"},"path_m":{"type":"number"},"bumps":{"type":"integer"},"driver":{"type":"string"}}}"#,
    ),
    (
        super::POSE,
        "foxglove.PoseInFrame",
        r#"{"title":"foxglove.PoseInFrame","type":"object","properties":{"timestamp":{"type":"object","title":"time","properties":{"sec":{"type":"integer","minimum":0},"nsec":{"type":"integer","minimum":0,"maximum":999999999}}},"frame_id":{"type":"string"},"pose":{"title":"foxglove.Pose","type":"object","properties":{"position":{"title":"foxglove.Vector3","type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},"orientation":{"title":"foxglove.Quaternion","type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}}}"#,
    ),
];
