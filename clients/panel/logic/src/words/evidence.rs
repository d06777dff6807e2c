//! Sensor readings before the robot stopped.

use super::screen;

screen! {
    /// Sensor readings and attempts.
    EvidenceWords {
        title: "What it felt and tried", "Mida robot tundis ja proovis";
        felt: "Felt in the ten seconds before", "Tundis kümne eelneva sekundi jooksul";
        tried: "Tried", "Proovis";
        when: "When", "Millal";
        motion: "Motion", "Liikumine";
        echo: "Echo", "Kaja";
        signs: "Felt", "Tundis";
        span[2]: "{0} to {1}\u{a0}s", "{0} kuni {1}\u{a0}s";
        ahead[1]: "ahead, {0}\u{a0}m/s", "edasi, {0}\u{a0}m/s";
        back[1]: "back, {0}\u{a0}m/s", "tagasi, {0}\u{a0}m/s";
        turning[1]: "turning, {0}\u{a0}°/s", "pöörab, {0}\u{a0}°/s";
        standing: "standing", "seisab";
        nothing: "nothing", "ei midagi";
        bumper_left: "bumper on the left", "põrkeraud vasakul";
        bumper_right: "bumper on the right", "põrkeraud paremal";
        cliff_left: "edge on the left", "serv vasakul";
        cliff_front: "edge ahead", "serv ees";
        cliff_right: "edge on the right", "serv paremal";
        wheel_drop: "a wheel hangs", "ratas ripub õhus";
        docked: "the dock's contacts", "doki kontaktid";
        link_lost: "no word from the robot", "robot ei vasta";
    }
}
