//! What robots have learnt of themselves.

use super::screen;

screen! {
    /// What is kept of each robot, and how it is forgotten.
    LearntWords {
        title: "Calibration", "Kalibreerimine";
        nothing: "No calibration yet: a robot calibrates its gyro and its battery while it cleans.",
            "Kalibreerimist veel ei ole: robot kalibreerib güroskoopi ja akut koristades.";
        gyro: "Gyro", "Güroskoop";
        pack: "Battery", "Aku";
        // Percent, and how sure that is.
        too_little[2]: "counts {0}\u{a0}% too little, ± {1}\u{a0}%", "loeb {0}\u{a0}% liiga vähe, täpsusega {1}\u{a0}%";
        too_much[2]: "counts {0}\u{a0}% too much, ± {1}\u{a0}%", "loeb {0}\u{a0}% liiga palju, täpsusega {1}\u{a0}%";
        bias[1]: "turns {0}° a minute at rest", "seistes näitab pööret {0}° minutis";
        // Cleaning, driving, minutes.
        energy[3]: "an hour of cleaning takes {0}\u{a0}% of a full charge, one of driving {1}\u{a0}%; measured for {2}\u{a0}min",
            "tund koristamist võtab {0}\u{a0}% täislaengust, tund sõitu {1}\u{a0}%; mõõdetud {2}\u{a0}min";
        here: "this robot", "see robot";
        when[1]: "Last calibrated {0}", "Viimati kalibreeritud {0}";
        forget: "Forget", "Unusta";
        // What, and of which robot.
        forget_named[2]: "Forget: {0} of {1}", "Unusta: {0}, robot {1}";
        ask_gyro: "Only if the gyro was replaced. The robot calibrates the new one while it cleans. Until then its position is less accurate.",
            "Ainult siis, kui güroskoop on vahetatud. Robot kalibreerib uue koristades. Seni on tema asukoht ebatäpsem.";
        ask_pack: "Only if the battery was replaced. The robot calibrates the new one while it cleans. Until then it uses the data sheet.",
            "Ainult siis, kui aku on vahetatud. Robot kalibreerib uue koristades. Seni kasutab ta andmelehe näite.";
        yes: "Forget it", "Unusta see";
        no: "Keep it", "Jäta alles";
    }
}
