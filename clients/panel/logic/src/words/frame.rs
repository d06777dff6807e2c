//! The frame around all screens: bar, buttons, tabs, log, names of states, units.

use super::screen;

screen! {
    /// The bar at the top, the tabs, and what is found everywhere.
    FrameWords {
        skip: "Skip to the controls", "Liigu juhtnuppude juurde";
        simulated[1]: "Simulated: {0}", "Simulatsioon: {0}";
        use_light: "Light theme", "Hele kujundus";
        use_dark: "Dark theme", "Tume kujundus";
        language: "Language", "Keel";
        battery: "Battery", "Aku";
        connected: "Connected", "Ühendatud";
        not_connected: "Not connected", "Ühendamata";
        not_current: "Not current", "Ei ole ajakohane";
        details: "Details", "Üksikasjad";
        drive: "Drive", "Juhi";
        home: "Home", "Kodu";
        schedules: "Schedules", "Ajakavad";
        history: "History", "Ajalugu";
        why: "Why", "Miks";
        device: "Device", "Seade";
        log: "Log", "Logi";
        decisions: "Decisions, newest first", "Otsused, uusimad eespool";
        no_decisions: "No decisions yet.", "Otsuseid veel ei ole.";
        dismiss: "Dismiss", "Sulge teade";
        on_its_way: "Loading …", "Laadib …";
        did_not_come: "This part of the page could not be loaded.", "Seda lehe osa ei õnnestunud laadida.";
        load_again: "Try again", "Proovi uuesti";
        good: "OK", "Selge";
        save: "Save", "Salvesta";
        cancel: "Cancel", "Loobu";
        remove: "Remove", "Eemalda";
        rename: "Rename", "Nimeta ümber";
        more_for[1]: "More for {0}", "Veel: {0}";
        raise_sheet: "Show more", "Näita rohkem";
        lower_sheet: "Show the map", "Näita kaarti";
        not_now[1]: ", not now: {0}", ", praegu mitte: {0}";
    }
}

screen! {
    /// Numbers with their units.
    UnitWords {
        kilometres[1]: "{0} km", "{0} km";
        metres[1]: "{0} m", "{0} m";
        centimetres[1]: "{0} cm", "{0} cm";
        square_metres[1]: "{0} m²", "{0} m²";
        percent[1]: "{0} %", "{0} %";
        percent_said[1]: "{0} percent", "{0} protsenti";
        // From Monday on, with blanks between.
        weekdays: "Mon Tue Wed Thu Fri Sat Sun", "E T K N R L P";
        months: "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec",
            "jaan veebr märts apr mai juuni juuli aug sept okt nov dets";
        // Day of the week, day, month, time.
        moment[4]: "{0} {1} {2}, {3}", "{0} {1}. {2} kell {3}";
        // Year, month, day, time.
        date[4]: "{0}-{1}-{2} {3}", "{2}.{1}.{0} {3}";
    }
}

screen! {
    /// The buttons for jobs.
    ActionWords {
        controls: "Controls", "Juhtnupud";
        start: "Start", "Alusta";
        stop: "Stop", "Peata";
        resume: "Resume", "Jätka";
        pause: "Pause", "Paus";
        spot: "Spot", "Koht";
        dock: "Dock", "Dokki";
        find: "Find", "Leia";
        clear: "Clear the fault", "Tühista rike";
        pending: "Sent, waiting for the robot", "Saadetud, ootan roboti vastust";
        found: "The robot beeps. Listen for it.", "Robot piiksub. Kuula, kust heli tuleb.";
        no_answer[1]: "{0}: no answer yet. To stop the robot at once, press a button on it.",
            "{0}: vastust veel ei ole. Roboti saab kohe peatada selle enda nupust.";
        not_sent[1]: "{0} was not sent: there is no connection. To stop the robot, press a button on it.",
            "{0}: ei saadetud, sest ühendust ei ole. Roboti saab peatada selle enda nupust.";
        cleaning_pattern: "Cleaning pattern", "Koristusmuster";
        robot_chooses: "The robot chooses", "Robot valib ise";
        random: "Random", "Juhuslik";
        random_with_walls: "Random with walls", "Juhuslik ja piki seinu";
        by_statistics: "By statistics", "Statistika järgi";
        rows: "Rows", "Ridadena";
    }
}

screen! {
    /// Why a button waits.
    OfferWords {
        away: "The robot is not connected.", "Robot ei ole ühendatud.";
        fault: "Clear the fault first.", "Tühista enne rike.";
        paused: "A paused job waits: resume or stop it.", "Pausil töö ootab: jätka seda või peata see.";
        by_hand: "The robot is under manual control.", "Robotit juhitakse käsitsi.";
        runs: "A job is running.", "Töö käib.";
        no_job: "No job is running.", "Ükski töö ei käi.";
        docking: "The robot is already returning to the dock.", "Robot on juba teel dokki.";
        docked: "The robot is on the dock.", "Robot on dokis.";
        not_allowed: "Not allowed for this device: an administrator can give it another role.",
            "Sellel seadmel ei ole selleks õigust: haldusõigusega seadmes saab anda sellele teise rolli.";
        drawing: "Finish the drawing on the map first, or cancel it.", "Lõpeta enne joonis kaardil või loobu sellest.";
        only_looks: "This device may not change anything here: an administrator can give it another role.",
            "See seade ei tohi siin midagi muuta: haldusõigusega seadmes saab anda sellele teise rolli.";
    }
}

screen! {
    /// Headlines of the states.
    StateWords {
        disconnected: "Not connected", "Ühendamata";
        idle: "Ready", "Valmis";
        starting: "Starting", "Alustab";
        cleaning: "Cleaning", "Koristab";
        spot: "Cleaning a spot", "Koristab üht kohta";
        going: "Driving to a place", "Sõidab määratud kohta";
        docking: "Returning to the dock", "Teel dokki";
        docked: "On the dock", "Dokis";
        manual: "Manual control", "Käsijuhtimisel";
        paused: "Paused", "Pausil";
        stuck: "Stuck", "Kinni jäänud";
        error: "Stopped by a fault", "Rikke tõttu peatunud";
        unknown: "Unknown state", "Tundmatu olek";
    }
}

screen! {
    /// The log. Its entries are the robot's own and stay English.
    LogWords {
        since_start[1]: "{0} after the daemon's start", "{0} pärast deemoni käivitumist";
        level: "Level", "Tase";
        everything: "Everything", "Kõik";
        information: "Information", "Teated";
        warnings: "Warnings", "Hoiatused";
        errors: "Errors", "Vead";
        search: "Search", "Otsing";
        entries: "Log, newest first", "Logi, uusimad eespool";
        none_fits: "No matching entries.", "Sobivaid kirjeid ei ole.";
        debug: "Debug", "Silumine";
        info: "Info", "Teade";
        warn: "Warning", "Hoiatus";
        error: "Error", "Viga";
    }
}
