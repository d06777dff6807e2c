//! What starts by itself.

use super::screen;

screen! {
    /// Schedules, their form, quiet hours.
    ScheduleWords {
        theirs[1]: "Now it is: {0}", "Praegu on see: {0}";
        take_theirs: "Take theirs", "Võta nende oma";
        keep_mine: "Keep mine", "Jäta minu oma";
        was_removed[1]: "Removed: {0}.", "Eemaldatud: {0}.";
        schedules: "Schedules", "Ajakavad";
        none: "Nothing starts by itself.", "Midagi ei alga iseenesest.";
        add: "Add a schedule", "Lisa ajakava";
        next_runs: "Next runs", "Järgmised korrad";
        no_next: "No upcoming runs.", "Eelseisvaid kordi ei ole.";
        past_runs: "Past runs", "Möödunud korrad";
        no_past: "No past runs.", "Möödunud kordi ei ole.";
        skip_named[1]: "Skip the next run of {0}", "Jäta järgmine kord vahele: {0}";
        skip: "Skip next", "Jäta vahele";
        run_named[1]: "Run now: {0}", "Käivita kohe: {0}";
        run: "Run now", "Käivita kohe";
        edit_named[1]: "Edit {0}", "Muuda: {0}";
        edit: "Edit", "Muuda";
        remove_named[1]: "Remove {0}", "Eemalda: {0}";
        new: "New schedule", "Uus ajakava";
        change: "Change the schedule", "Muuda ajakava";
        name: "Name", "Nimi";
        time: "Time", "Kellaaeg";
        once: "On one day only", "Ainult ühel päeval";
        date: "Date", "Kuupäev";
        days: "Days of the week", "Nädalapäevad";
        rooms: "Rooms and saved zones; none for the whole home", "Toad ja salvestatud alad; valimata jättes kogu kodu";
        no_rooms: "No room is known yet.", "Ühtki tuba veel ei teata.";
        passes: "Passes over each room", "Mitu korda iga tuba koristatakse";
        late: "Start up to this many minutes late, if the robot was off at its time",
            "Mitu minutit hiljem võib alustada, kui robot oli õigel ajal väljas";
        waits: "Wait for the end of the quiet hours", "Oota vaikse aja lõppu";
        may_be_late[1]: "up to {0} minutes late", "kuni {0} minutit hiljem";
        may_wait: "waits for the end of the quiet hours", "ootab vaikse aja lõppu";
        bad_name: "The name must have at most 40 visible characters, and not only digits.",
            "Nimes peab olema kuni 40 nähtavat tähemärki, ja mitte ainult numbrid.";
        need_name: "Give it a name.", "Anna ajakavale nimi.";
        need_time: "Say at what time it starts, for example 09:30.", "Määra kellaaeg, millal see algab, näiteks 09:30.";
        need_date: "Choose the day on which it starts.", "Vali päev, millal see algab.";
        need_days: "Choose at least one day of the week.", "Vali vähemalt üks nädalapäev.";
        quiet: "Quiet hours", "Vaikne aeg";
        quiet_are[2]: "Nothing starts by itself from {0} to {1}.", "Ajavahemikus {0}–{1} ei alga midagi iseenesest.";
        quiet_none: "There are none.", "Vaikset aega ei ole.";
        need_quiet: "Say from when to when, for example 22:00 and 07:00.", "Määra, mis ajast mis ajani, näiteks 22:00 ja 07:00.";
        from: "From", "Alates";
        to: "To", "Kuni";
        set: "Set", "Määra";
        no_quiet: "None", "Puudub";
        zone_title: "Time zone", "Ajavöönd";
        zone_name: "Name, for example Europe/Tallinn", "Nimi, näiteks Europe/Tallinn";
        device_zone[1]: "Use this device's time zone: {0}", "Kasuta selle seadme ajavööndit: {0}";
        system_zone: "Use the time zone of the robot's computer", "Kasuta roboti arvuti ajavööndit";
        next[1]: "Next: {0}", "Järgmine: {0}";
        no_run: "No upcoming runs.", "Eelseisvaid kordi ei ole.";
        off: "Switched off.", "Välja lülitatud.";
        would_not[1]: "It would not start now: {0}", "Praegu see ei algaks: {0}";
        fired: "Started.", "Algas.";
        zone[2]: "All times are those of {0}, where it is {1}.", "Kõik ajad on vööndis {0}, kus praegu on {1}.";
        no_clock: "The robot's clock is not set, so nothing starts by itself until it is.",
            "Roboti kell on seadmata, seni ei alga midagi iseenesest.";
        skipped[1]: "{0}, skipped", "{0}, jääb vahele";
        blocked_by_quiet[1]: "{0}, blocked by quiet hours", "{0}, jääb vaikse aja tõttu ära";
        kept[2]: "{0}, blocked: {1}", "{0}, jääb ära: {1}";
        after_quiet[1]: "{0}, after the quiet hours", "{0}, pärast vaikset aega";
        when_answers[1]: "{0}, when the robot answers", "{0}, kui robot vastab";
        daily[1]: "Daily at {0}", "Iga päev kell {0}";
        weekly[2]: "{0} at {1}", "{0} kell {1}";
        once_at[1]: "Once, {0}", "Üks kord, {0}";
        whole_home: "the whole home", "kogu kodu";
        whole_home_by[1]: "the whole home, {0}", "kogu kodu, {0}";
        room[1]: "room {0}", "tuba {0}";
        place[1]: "place {0}", "koht {0}";
        a_zone: "a zone", "üks ala";
        a_spot: "a spot", "üks koht";
        on_floor[2]: "{0}, on {1}", "{0}, korrus: {1}";
        other_floor[1]: "Its rooms are those of {0}. Others can be chosen while the robot is there.",
            "Selle toad on korrusel {0}. Teisi saab valida, kui robot on seal.";
        times[1]: "{0} times", "{0} korda";
    }
}
