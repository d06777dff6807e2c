//! Runs that are over.

use super::screen;

screen! {
    /// The list of runs, one of them, its replay and plots.
    HistoryWords {
        runs: "Runs, newest first", "Tööd, uusimad eespool";
        none: "No runs yet: a run appears some seconds after a job ends.",
            "Töid veel ei ole: töö ilmub siia mõni sekund pärast lõppu.";
        // Runs, hours, area.
        lifetime[3]: "All together: {0}, {1}, {2}", "Kõik kokku: {0}, {1}, {2}";
        cleanings[1]: "{0} cleanings", "{0} koristust";
        one_cleaning: "1 cleaning", "1 koristus";
        hours[1]: "{0} hours", "{0} tundi";
        runs_of_all: "Runs", "Tööd";
        since_day[1]: "Since {0}", "Alates {0}";
        count_cleanings[1]: "cleanings: {0}", "koristusi: {0}";
        count_spots[1]: "spots: {0}", "üksikuid kohti: {0}";
        count_drives[1]: "drives to a place: {0}", "sõite määratud kohta: {0}";
        count_returns[1]: "returns to the dock: {0}", "naasmisi dokki: {0}";
        ended_by: "Ends", "Lõpud";
        end_finished[1]: "{0} finished", "{0} lõpetatud";
        end_stopped[1]: "{0} stopped by somebody", "{0} kellegi peatatud";
        end_gave_up[1]: "{0} given up", "{0} poolikut";
        end_other[1]: "{0} cut short", "{0} katkenud";
        times_stopped[1]: "{0}x", "{0}x";
        older: "Show older ones", "Näita vanemaid";
        numbered[2]: "{0}. {1}", "{0}. {1}";
        no_clock: "Clock not set", "Kell seadmata";
        all: "All runs", "Kõik tööd";
        run[2]: "Run {0}, {1}", "Töö {0}, {1}";
        stops: "Stops and waits", "Peatused ja ootamised";
        more_stops[1]: "And {0} more stops.", "Ja veel {0} peatust.";
        figures: "Figures", "Arvud";
        report: "For a bug report", "Veateate jaoks";
        show_stop[1]: "Show the moment of stop {0}", "Näita peatuse {0} hetke";
        not_recorded: "This run was not recorded.", "Seda tööd ei salvestatud.";
        recording_gone: "The recording was removed to make room for newer ones.",
            "Salvestis eemaldati, sest uuemad vajasid ruumi.";
        recording_part_gone: "A part of the recording was removed to make room for newer ones.",
            "Osa salvestisest eemaldati, sest uuemad vajasid ruumi.";
        save_recording[1]: "Save the recording ({0} MB)", "Salvesta salvestis ({0} MB)";
        no_replay: "There is no replay without a recording.", "Salvestiseta ei saa tööd uuesti vaadata.";
        play: "Play", "Esita";
        pause: "Pause", "Paus";
        time: "Time into the run", "Aeg töö algusest";
        speed: "Speed", "Kiirus";
        picture[2]: "Picture of the run: {0} square metres cleaned, {1} stops",
            "Pilt tööst: koristatud {0} ruutmeetrit, {1} peatust";
        // Title, lines, low, high.
        plot[4]: "{0}: {1}, between {2} and {3}", "{0}: {1}, vahemikus {2} kuni {3}";
        plot_charge: "Battery charge in %", "Aku laetus, %";
        plot_battery: "Current into the battery in A", "Akusse minev vool, A";
        plot_motors: "Currents of the motors in A", "Mootorite voolud, A";
        plot_link: "Bad packets on the cable in %", "Vigased paketid kaablis, %";
        charge: "Charge", "Laetus";
        battery: "Battery", "Aku";
        left_wheel: "Left wheel", "Vasak ratas";
        right_wheel: "Right wheel", "Parem ratas";
        main_brush: "Main brush", "Põhihari";
        bad_packets: "Bad packets", "Vigased paketid";
        battery_from_to[2]: "battery {0} to {1}", "aku {0} kuni {1}";
        clock_set_back[1]: "the clock was set back by {0}", "kell pandi vahepeal {0} võrra tagasi";
        clock_set_forward[1]: "the clock was set forward by {0}", "kell pandi vahepeal {0} võrra edasi";
        from_to[2]: "{0} to {1}", "{0} kuni {1}";
        spot: "Spot", "Üks koht";
        to_place: "To a place", "Määratud kohta";
        to_dock: "To the dock", "Dokki";
        a_zone: "a zone", "üks ala";
        zones[1]: "{0} zones", "{0} ala";
        a_spot: "a spot", "üks koht";
        spots[1]: "{0} spots", "{0} kohta";
        everything: "All", "Kõik";
        times[2]: "{0}, {1} times", "{0}, {1} korda";
        by_button: "Button on the robot", "Nupp robotil";
        by_schedule[1]: "Schedule {0}", "Ajakava {0}";
        by_robot: "The robot itself", "Robot ise";
        of_floor[1]: " ({0} of that floor)", " ({0} sellest põrandast)";
        order: "Order", "Ülesanne";
        asked_by: "Asked by", "Andis";
        duration: "Time", "Aeg";
        in_motion: "In motion", "Liikus";
        swept: "Cleaned", "Koristatud";
        distance: "Distance", "Teekond";
        bumps: "Bumps", "Puuted";
        map: "Map", "Kaart";
        version[1]: "version {0}", "versioon {0}";
        lasted[1]: "for {0}", "kestis {0}";
        until_end: "until the end", "kuni lõpuni";
        by[1]: " By {0}.", " Andis {0}.";
        // What, by whom, when, how long.
        stop[4]: "{0}{1} At {2}, {3}.", "{0}{1} Ajal {2}, {3}.";
        finished: "Finished.", "Lõpetatud.";
        finished_as[1]: "Finished: {0}.", "Lõpetatud: {0}.";
        stopped: "Stopped.", "Peatatud.";
        gave_up[1]: "Gave up: {0}.", "Robot andis alla: {0}.";
        daemon_ended: "Ended because vthal was shut down.", "Lõppes, sest vthal lõpetas korrapäraselt töö.";
        cut_short: "Cut short: vthal or its board stopped without notice; what is shown was known shortly before.",
            "Katkes: vthal või selle arvuti seiskus ootamatult; näha on see, mis oli veidi enne seda teada.";
        other_robot: "Ended because another robot was attached.", "Lõppes, sest ühendati teine robot.";
    }
}
