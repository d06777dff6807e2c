//! Driving by hand.

use super::screen;

screen! {
    /// The pad and its surroundings.
    DriveWords {
        while_edited: "While mixes are edited nothing drives: move what you like.",
            "Juhtskeemide muutmise ajal robot ei liigu: katseta julgelt.";
        how: "Hold the knob, move a gamepad's stick, or focus the pad and hold W\u{a0}A\u{a0}S\u{a0}D or arrow keys. Letting go stops.",
            "Hoia nuppu, liiguta mängupuldi hooba või vali juhtpadi ja hoia all klahvi W\u{a0}A\u{a0}S\u{a0}D või nooleklahvi. Lahti lastes robot peatub.";
        pad: "Drive pad", "Juhtpadi";
        editor_close: "Close the editor", "Sulge muutmine";
        editor_open: "Edit mixes", "Muuda juhtskeeme";
        clean: "Clean while driving", "Korista juhtimise ajal";
        no_gamepad: "No gamepad is seen: press one of its buttons.", "Mängupulti ei leitud: vajuta selle mõnda nuppu.";
        gamepad[2]: "pad-{0} is {1}", "pad-{0} on {1}";
        away_from_rest[2]: "Waits until this is at rest: {0} reads {1}. If nobody touches it, calibrate it in the control mix.",
            "Ootab puhkeasendit: {0} näit on {1}. Kui seda keegi ei puuduta, kalibreeri see juhtskeemis.";
        waits_for_rest: "Waits until every stick and key is at rest.", "Ootab, kuni kõik hoovad ja klahvid on lahti lastud.";
        latency[3]: "From stick to wheels: {0} ms, median of {1}: {2} ms", "Hoovast ratasteni: {0} ms, {1} mõõtmise mediaan {2} ms";
        latency_long: "From the browser's time of the input that starts a standing robot to the first pose that shows it moving: the way there, its start, and the way back, with up to 50 ms until the next pose.",
            "Alates hetkest, mil veebilehitseja märkas seisva roboti liikuma panekut, kuni esimese asukohateateni, mis näitab liikumist: tee robotini, liikumise algus ja tee tagasi, lisaks kuni 50 ms järgmise teateni.";
        mix: "Control mix", "Juhtskeem";
        standard: "Standard, built in", "Tavaline, sisseehitatud";
        tilt_stop: "Stop driving by tilt", "Lõpeta kallutusega juhtimine";
        tilt: "Drive by tilt", "Juhi kallutades";
        tilt_refused: "The browser does not tell this page how the device is held: allow motion sensors for it.",
            "Veebilehitseja ei anna sellele lehele teada, kuidas seadet hoitakse: luba talle liikumisandurid.";
        lend_title: "Lend this stick to another driver", "Laena juhtpadi teisele juhile";
        lend_how: "Whoever drives at another device can use the stick, the tilt and the gamepad of this one as inputs of a control mix. This device then drives nothing itself.",
            "Kes juhib teises seadmes, saab selle seadme juhtpatja, kallutust ja mängupulti kasutada juhtskeemi sisenditena. See seade ise siis ei juhi.";
        lend_name: "Its name in the mix", "Nimi juhtskeemis";
        // As long as no other name is given.
        lend_usual: "phone", "telefon";
        // Characters.
        lend_name_wrong[1]: "A name has 1 to {0} letters, digits, blanks, - or _.", "Nimes on 1 kuni {0} tähte, numbrit, tühikut, - või _.";
        lend: "Lend it", "Laena";
        lend_end: "Take it back", "Võta tagasi";
        lend_waits: "The robot has not taken it yet.", "Robot ei ole seda veel vastu võtnud.";
        // Who drives, and the inputs.
        lent_to[2]: "Lent; the driver now is {0}. Inputs for a mix: {1}", "Välja laenatud; praegu juhib {0}. Juhtskeemi sisendid: {1}";
        lent_to_nobody[1]: "Lent; nobody drives at this moment. Inputs for a mix: {0}", "Välja laenatud; praegu ei juhi keegi. Juhtskeemi sisendid: {0}";
        while_lent: "This stick is lent: it moves what another driver's mix makes of it. Letting go stops.",
            "Juhtpadi on välja laenatud: see liigutab seda, mida teise juhi juhtskeem ette näeb. Lahti lastes robot peatub.";
    }
}
