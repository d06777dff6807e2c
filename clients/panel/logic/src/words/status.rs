//! What the robot does and why.

use super::screen;

screen! {
    /// The card with the state, and the figures of the job.
    StatusWords {
        ready_to_clean: "Ready to clean.", "Valmis koristama.";
        beeps: "It beeps before its wheels turn.", "Robot annab enne liikumist helisignaali.";
        waits_for_resume: "The job waits until you resume it.", "Töö ootab, kuni seda jätkad.";
        in_control[1]: "In control: {0}.", "Juhib: {0}.";
        strategy[1]: "Cleaning pattern: {0}.", "Koristusmuster: {0}.";
        now_in[1]: "Now in {0}.", "Praegu: {0}.";
        reason[1]: "Reason: {0}.", "Põhjus: {0}.";
        swept: "Cleaned", "Koristatud";
        time: "Time", "Aeg";
        distance: "Distance", "Teekond";
        bumps: "Bumps", "Puuted";
        actual_coverage: "Actual coverage", "Tegelikult kaetud";
        actual_coverage_long: "Share of the simulated home's reachable floor that was actually cleaned",
            "Simuleeritud kodu ligipääsetava põranda tegelikult kaetud osa";
        place: "Position accuracy", "Asukoha täpsus";
        place_long: "Standard deviation of the estimated position", "Hinnatud asukoha standardhälve";
        lost: "lost", "teadmata";
        within[1]: "± {0}", "± {0}";
        is_lost: "The robot does not know where it is. It does not change its map until it does.",
            "Robot ei tea, kus ta on. Seda, mida ta praegu näeb, kaardile ei kanta.";
        believes[2]: "Position known to {0}, heading to {1}°.",
            "Asukoht on teada täpsusega {0}, suund täpsusega {1}°.";
        agreement[1]: "Sensors match the map: {0}.", "Andurid klapivad kaardiga: {0}.";
        covered[1]: "Estimated coverage: {0} of the reachable floor.",
            "Hinnanguliselt koristatud: {0} ligipääsetavast põrandast.";
        covered_at_least[2]: "Estimated coverage: {0} of the reachable floor, at least {1}.",
            "Hinnanguliselt koristatud: {0} ligipääsetavast põrandast, vähemalt {1}.";
    }
}
