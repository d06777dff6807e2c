//! What the robot does and why.

use super::screen;

screen! {
    /// The card with the state, and the figures of the job.
    StatusWords {
        press_start: "Press Start and it cleans the floor.", "Vajuta „Alusta“ ja robot koristab põranda.";
        beeps: "It beeps before its wheels turn.", "Robot annab enne liikumist helisignaali.";
        waits_for_resume: "The job waits until you resume it.", "Töö ootab, kuni seda jätkad.";
        in_seat[1]: "In the driver's seat: {0}.", "Juhib: {0}.";
        strategy[1]: "Way of cleaning: {0}.", "Koristusviis: {0}.";
        now_in[1]: "Now in {0}.", "Praegu: {0}.";
        reason[1]: "Reason: {0}.", "Põhjus: {0}.";
        swept: "Swept", "Koristatud";
        time: "Time", "Aeg";
        way: "Way", "Teekond";
        bumps: "Bumps", "Puuted";
        truly_covered: "Truly covered", "Tegelikult kaetud";
        truly_covered_long: "True share of the reachable floor of the simulated home",
            "Simuleeritud kodu ligipääsetava põranda tegelikult kaetud osa";
        place: "Its place", "Asukoht";
        place_long: "Standard deviation of where the robot believes to be", "Roboti arvatava asukoha standardhälve";
        lost: "lost", "teadmata";
        within[1]: "± {0}", "± {0}";
        is_lost: "It does not know where it is. What it sees now is not drawn into the map.",
            "Robot ei tea, kus ta on. Seda, mida ta praegu näeb, kaardile ei kanta.";
        believes[2]: "It believes its place to {0} and its heading to {1}°.",
            "Robot teab oma asukohta täpsusega {0} ja suunda täpsusega {1}°.";
        agreement[1]: "Its map explains {0} of what its sensors see.", "Kaart selgitab {0} sellest, mida andurid näevad.";
        covered[1]: "By its own estimate {0} of the floor it can reach is swept.",
            "Roboti enda hinnangul on ligipääsetavast põrandast koristatud {0}.";
        covered_at_least[2]: "By its own estimate {0} (at least {1}) of the floor it can reach is swept.",
            "Roboti enda hinnangul on ligipääsetavast põrandast koristatud {0} (vähemalt {1}).";
    }
}
