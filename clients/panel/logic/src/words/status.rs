//! What the robot does and why.

use super::screen;

screen! {
    /// The card with the state, and the figures of the job.
    StatusWords {
        ready_to_clean: "Ready to clean.", "Valmis koristama.";
        // Floor, minutes, charge, recharges.
        whole_home[4]: "The whole home: {0}, about {1} min, {2} of a full battery{3}.",
            "Kogu kodu: {0}, umbes {1} min, {2} täis akust{3}.";
        beeps: "It beeps before its wheels turn.", "Robot annab enne liikumist helisignaali.";
        waits_for_resume: "The job waits until you resume it.", "Töö ootab, kuni seda jätkad.";
        in_control[1]: "In control: {0}.", "Juhib: {0}.";
        strategy[1]: "Cleaning pattern: {0}.", "Koristusmuster: {0}.";
        reason[1]: "Reason: {0}.", "Põhjus: {0}.";
        left_and_done[2]: "About {0} min left, {1} done.", "Jäänud umbes {0} min, tehtud {1}.";
        minutes_left[1]: "About {0} min left.", "Jäänud umbes {0} min.";
        done_so_far[1]: "{0} of the mapped floor done.", "Kaardistatud põrandast tehtud {0}.";
        progress: "Progress", "Edenemine";
        getting_ready: "Getting ready: it stands still to calibrate its gyro.",
            "Valmistub: seisab paigal, et güroskoopi kalibreerida.";
        summary[2]: "{0} in {1}.", "{0}, aeg {1}.";
        summary_whole[2]: "{0} in {1}: all of the floor.", "{0}, aeg {1}: kogu põrand.";
        summary_left[4]: "{0} in {1}: {2} of the floor. {3} could not be reached or was left.",
            "{0}, aeg {1}: {2} põrandast. {3} jäi koristamata või ei olnud ligipääsetav.";
        last_job: "Last job", "Viimane töö";
        figures: "Figures", "Näitajad";
        silent[1]: "No news for {0} s: what you see is that old.",
            "Uudiseid pole olnud {0} s: kõik siin nähtav on nii vana.";
        silent_remedy: "The robot goes on with what it does. Check the Wi-Fi of this device; to stop the robot, press a button on it.",
            "Robot jätkab oma tööd. Kontrolli selle seadme Wi-Fi ühendust; roboti saab peatada selle enda nupust.";
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
        map_doubted[1]: "The map is doubted, so no share is told. {0}",
            "Kaardis on kahtlus, seepärast osa ei näidata. {0}";
        covered[1]: "Estimated coverage: {0} of the reachable floor.",
            "Hinnanguliselt koristatud: {0} ligipääsetavast põrandast.";
        covered_at_least[2]: "Estimated coverage: {0} of the reachable floor, at least {1}.",
            "Hinnanguliselt koristatud: {0} ligipääsetavast põrandast, vähemalt {1}.";
    }
}
