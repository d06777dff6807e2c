//! Sentences for the named reasons of failures: what, and what to do.

/// A sentence for people that belongs to a named reason.
pub(super) fn explain(reason: &str) -> &'static str {
    match reason {
        "no-robot" => "No robot is attached: check the serial cable and the robot's power.",
        "driver-busy" => "Somebody else drives the robot by hand: ask them to let go, or press Stop.",
        "centre-first" => "The robot was stopped while you drove: let go of the stick once, then drive on.",
        "lease-range" => "The lease must be 1 to 400 ms.",
        "range" => "The speed is beyond what this robot can do; see its description.",
        "unknown-component" => "There is no such part; the answer to health lists them.",
        "unknown-strategy" => "There is no such strategy; the answer to hello lists them.",
        "expert-off" => "Raw packets are not allowed: set socket.expert in the configuration of vthal.",
        "raw-syntax" => {
            "This is not a packet of the wire: it must be one JSON object with a known command and its keys."
        }
        "job-runs" => "A job runs or waits: stop it first.",
        "ending" => "vthal is about to end.",
        "wheel-drop" => "A wheel hangs: put the robot on the floor.",
        "link-lost" => "The robot does not answer: check the cable and its power.",
        "link-bad" => "Too many packets are broken on the cable between board and robot: check the wires.",
        "already-running" => "Such a job already runs.",
        "no-job" => "There is no job that this could change.",
        "error-stands" => "An error stands: remove its cause and acknowledge it first.",
        "docked" => "The robot is on its dock.",
        "battery-low" => "The battery is too low: charge the robot first.",
        "map-not-taken-up" => {
            "The robot does not know yet where in the map of which floor it is: put it on its dock, or let it clean until it \
             knows."
        }
        "floor-unknown" => {
            "The robot does not know on which floor it is: choose the floor, or begin a new one."
        }
        "which-dock" => {
            "Several floors have a dock, and the robot stands on one: choose the floor on which it is."
        }
        "last-floor" => "This is the only floor: there must be one.",
        "not-removed" => "There is no removed floor of this number.",
        "place-unknown" => "The robot does not know where it is: put it on its dock.",
        "rest-out-of-reach" => {
            "No way leads there from where the robot stands: look at doors and no-go zones."
        }
        "no-map" => "The robot has no map yet: let it clean once.",
        "no-heading" => {
            "Nothing but the wheels tells this robot its heading, so it has no map to find rooms by."
        }
        "too-many-no-gos" => {
            "There are as many no-go zones and virtual walls as a home can have: remove one first."
        }
        "too-many-room-changes" => {
            "The rooms were split and joined as often as those of a home can be: take a change back first."
        }
        "disk-busy" => "The disk is too slow to take more changes now; try again.",
        "not-sent" => "The robot did not take the command.",
        _ => "The robot cannot do this in its present state; the reason has the name of the cause.",
    }
}
