//! The sentences for codes, in English.

use super::{Explanation, entry};

/// Codes of the brain, of the firmware, of the daemon and of this panel.
pub(super) const CATALOGUE: &[(&str, Explanation)] = &[
    entry(
        "no-daemon",
        "The robot's software is not running.",
        "The panel connects by itself as soon as it is.",
    ),
    entry(
        "no-server",
        "The robot cannot be reached.",
        "Check that it is switched on and that this device is on its network; the panel tries again by itself.",
    ),
    entry(
        "no-robot",
        "No robot answers.",
        "Check its cable and whether it is switched on.",
    ),
    entry(
        "job-runs",
        "A job runs or waits.",
        "Stop it first; a map is taken up again only by a robot at rest.",
    ),
    entry(
        "recharging",
        "It waits on the dock for charge, and then goes on.",
        "",
    ),
    entry(
        "dock-unknown",
        "Nobody knows where the dock is.",
        "Put it on its dock once.",
    ),
    entry(
        "place-unknown",
        "It does not know where it is.",
        "Put it on its dock, or let it clean: it looks for places that it knows.",
    ),
    entry(
        "way-blocked",
        "No way is left to where it wants to go.",
        "Clear the way.",
    ),
    entry("no-map", "It has no map of the home to plan on.", ""),
    entry("rest-out-of-reach", "What is left cannot be reached.", ""),
    entry("start-up", "The software has just started.", ""),
    entry("command", "As you asked.", ""),
    entry("finished", "The job is done.", ""),
    entry("continued", "It went on by itself after an interruption.", ""),
    entry("restored", "It took up the job again after a restart.", ""),
    entry(
        "not-armed",
        "The robot was reset and has not been released to move yet.",
        "It releases itself when you start a job.",
    ),
    entry(
        "arm-refused",
        "The robot's firmware does not release its wheels.",
        "Look at what inhibits it in the device table.",
    ),
    entry(
        "link-lost",
        "The connection to the robot broke, so it stopped.",
        "Check the cable; it comes back by itself.",
    ),
    entry("link-restored", "The connection to the robot is back.", ""),
    entry(
        "link-bad",
        "The connection to the robot is too noisy to drive safely.",
        "Check the cable and its length.",
    ),
    entry("stopped", "It was told to stop.", ""),
    entry(
        "button-stop",
        "A button on the robot was pressed.",
        "Start it again when you are ready.",
    ),
    entry(
        "wheel-drop",
        "A wheel hangs in the air.",
        "Put the robot flat on the floor.",
    ),
    entry("docked", "It stands on the dock.", ""),
    entry("bump-left", "It touched something on its left.", ""),
    entry("bump-right", "It touched something on its right.", ""),
    entry("bump-front", "It touched something ahead.", ""),
    entry(
        "bumper",
        "The bumper is pressed.",
        "It may only move away from the obstacle.",
    ),
    entry("cliff-left", "There is no floor on its left.", ""),
    entry("cliff-right", "There is no floor on its right.", ""),
    entry("cliff-front", "There is no floor ahead.", ""),
    entry(
        "cliff",
        "A sensor sees no floor.",
        "It may only back away slowly.",
    ),
    entry(
        "contact-held",
        "The bumper stays pressed although it backed off.",
        "Free the bumper and clear the fault.",
    ),
    entry(
        "cliff-held",
        "It backed off and still sees no floor.",
        "Put it on firm floor and clear the fault.",
    ),
    entry(
        "boxed-in",
        "It found no way out of a tight place.",
        "Move it into the open.",
    ),
    entry(
        "shut-in",
        "It does not get out of a small place.",
        "Open the door or move it into the open.",
    ),
    entry(
        "not-moving",
        "Its wheels turn but it does not get on.",
        "Lift it off whatever holds it.",
    ),
    entry(
        "slip",
        "Its wheels slip.",
        "Move it to firm floor and clean the wheels.",
    ),
    entry(
        "task-budget",
        "The time for this job is used up.",
        "Start again if the floor needs more.",
    ),
    entry("battery-low", "The battery is low.", "Charge it."),
    entry(
        "battery-weak",
        "The battery is so low that brushes and suction are off.",
        "Let it drive to its dock, or carry it there.",
    ),
    entry(
        "battery-empty",
        "The battery is empty, everything is off.",
        "Carry it to the dock.",
    ),
    entry(
        "battery-hot",
        "The battery is hot.",
        "Let it cool; it goes on by itself below 50 °C.",
    ),
    entry(
        "battery-overheated",
        "The battery was dangerously hot.",
        "Take the battery out and have it checked before you clear the fault.",
    ),
    entry(
        "thermistor",
        "The battery's temperature cannot be measured.",
        "Check the battery's plug, then clear the fault.",
    ),
    entry(
        "charger-fault",
        "The charger has stopped because something is wrong.",
        "Look at the charger fault in the device table, remove its cause, then clear the fault.",
    ),
    entry(
        "charger-shorted",
        "Current flows into the battery although the charger is off.",
        "Keep it off the dock, take the battery out and have the electronics repaired.",
    ),
    entry(
        "clock",
        "The clock of the robot's controller failed.",
        "Switch it off and on; keep the log if it comes back.",
    ),
    entry(
        "memory",
        "The memory of the robot's controller failed a check.",
        "Switch it off and on; keep the log if it comes back.",
    ),
    entry(
        "dock-not-found",
        "It did not find the dock in time.",
        "Carry it to the dock.",
    ),
    entry(
        "no-charge-current",
        "It stands on the dock, but no current flows.",
        "See whether the dock has power; wipe its contacts and those of the robot.",
    ),
    entry("dock-beam", "It hears the dock.", ""),
    entry(
        "planning",
        "It makes a plan, and drives on when that is made.",
        "",
    ),
    entry(
        "lease-ended",
        "Driving by hand ended because the connection paused.",
        "Hold the pad again.",
    ),
    entry("released", "You let go.", ""),
    entry("already-running", "That is what it is doing already.", ""),
    entry("no-job", "There is no job to do that with.", "Start one first."),
    entry(
        "error-stands",
        "A fault must be cleared first.",
        "Remove its cause, then press Clear.",
    ),
    entry(
        "reset-loop",
        "The robot's controller restarted three times within a minute.",
        "Check its battery and cable, then clear the fault.",
    ),
    entry(
        "bumper-stuck",
        "The bumper does not come free.",
        "Clean around the bumper, then clear the fault.",
    ),
    entry(
        "cliff-trapped",
        "It keeps finding edges.",
        "Put it on firm floor, then clear the fault.",
    ),
    entry(
        "cliff-sensor",
        "A floor sensor does not work.",
        "Clean the windows below the bumper, then clear the fault.",
    ),
    entry(
        "wheel-stall",
        "A wheel is blocked.",
        "Remove what holds the wheel, then clear the fault.",
    ),
    entry(
        "brush-stall",
        "The main brush is blocked.",
        "Take out the brush and clean it, then clear the fault.",
    ),
    entry(
        "runaway",
        "A wheel turned without a command.",
        "Switch the robot off and have its electronics checked.",
    ),
    entry(
        "encoder",
        "A wheel's sensor contradicts its motor.",
        "Clean the wheel; if it comes back, check the sensor.",
    ),
    entry(
        "internal",
        "The robot's firmware failed a check of itself.",
        "Switch it off and on; keep the log if it comes back.",
    ),
    entry(
        "unknown-inhibit",
        "Newer firmware stops it for a reason that this version does not know.",
        "Update the software.",
    ),
    entry(
        "driver-busy",
        "Somebody else is driving.",
        "Wait until they let go, or press Stop.",
    ),
    entry(
        "centre-first",
        "The robot was stopped while you drove.",
        "Let go once, then drive on.",
    ),
    entry("busy", "Too much was asked at once.", "Try again."),
    entry(
        "unknown-component",
        "The robot knows no such part.",
        "Reload the page.",
    ),
    entry(
        "health-unwritable",
        "The robot could not write down that the part was cleaned.",
        "Check its disk, then say it again.",
    ),
    entry(
        "unknown-strategy",
        "This way of cleaning is not known.",
        "Choose another one.",
    ),
    entry(
        "expert-off",
        "Raw packets are switched off.",
        "Allow them in the configuration of the daemon.",
    ),
    entry("syntax", "The request could not be read.", "Reload the page."),
    entry(
        "unknown",
        "The software does not know this request.",
        "Update it, or reload the page.",
    ),
    entry("range", "A value was out of range.", "Reload the page."),
    entry(
        "stale",
        "The picture of the robot was too old to move it safely.",
        "Try again.",
    ),
    entry(
        "inhibited",
        "The robot does not let itself be moved now.",
        "Look at what inhibits it in the device table.",
    ),
    entry("absent", "This robot has no such part.", ""),
    entry("skipped", "Somebody wanted it left out.", ""),
    entry("missed", "Nobody was there to start it in time.", ""),
    entry("quiet-hours", "It fell into the quiet hours.", ""),
    entry(
        "interrupted",
        "The robot's software ended just before it could start.",
        "",
    ),
    entry(
        "no-such-room",
        "The map has no such room any more.",
        "Choose other rooms.",
    ),
    entry(
        "map-not-taken-up",
        "It does not know yet where in the map of which floor it is.",
        "Put it on its dock, or let it clean until it knows.",
    ),
    entry("cause-remains", "The cause is still there.", "Remove it first."),
];
