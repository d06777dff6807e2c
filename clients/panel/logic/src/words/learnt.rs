//! What robots have learnt of themselves.

use super::screen;

screen! {
    /// What is kept of each robot, and how it is forgotten.
    LearntWords {
        title: "Learnt of itself", "Enda kohta õpitud";
        nothing: "Nothing is known yet: a robot learns its gyro and its battery while it cleans.",
            "Midagi ei ole veel teada: robot õpib oma güroskoopi ja akut tundma koristades.";
        gyro: "Gyro", "Güroskoop";
        pack: "Battery", "Aku";
        // Percent, and how sure that is.
        too_little[2]: "counts {0}\u{a0}% too little, give or take {1}\u{a0}%", "loeb {0}\u{a0}% liiga vähe, täpsusega {1}\u{a0}%";
        too_much[2]: "counts {0}\u{a0}% too much, give or take {1}\u{a0}%", "loeb {0}\u{a0}% liiga palju, täpsusega {1}\u{a0}%";
        bias[1]: "turns {0}° a minute when it stands", "seistes näitab pööret {0}° minutis";
        // Cleaning, driving, minutes.
        energy[3]: "an hour of cleaning takes {0}\u{a0}% of a full charge, one of driving {1}\u{a0}%; seen for {2}\u{a0}min",
            "tund koristamist võtab {0}\u{a0}% täislaengust, tund sõitu {1}\u{a0}%; jälgitud {2}\u{a0}min";
        here: "this robot", "see robot";
        when[1]: "Learnt last {0}", "Viimati õpitud {0}";
        forget: "Forget", "Unusta";
        // What, and of which robot.
        forget_named[2]: "Forget: {0} of {1}", "Unusta: {0}, robot {1}";
        ask_gyro: "Only if its gyro was changed: the robot then learns the new one while it cleans, and finds its way less surely until it knows it.",
            "Ainult siis, kui güroskoop on vahetatud: robot õpib uut koristades tundma ja teab seni oma asukohta ebakindlamalt.";
        ask_pack: "Only if its battery was changed: the robot then learns the new one while it cleans, and until then reckons with the figures of its data sheet.",
            "Ainult siis, kui aku on vahetatud: robot õpib uut koristades tundma ja arvestab seni andmelehe näitudega.";
        yes: "Forget it", "Unusta see";
        no: "Keep it", "Jäta alles";
    }
}
