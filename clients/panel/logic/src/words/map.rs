//! The map and what is done on it.

use super::screen;

screen! {
    /// The map, its buttons and legend, and the bar with orders over it.
    MapWords {
        title: "Map", "Kaart";
        canvas: "Map with the robot, its path and the cleaned area. The rooms are listed under Home. Arrow keys move the map, plus and minus zoom. 0 shows everything, F follows the robot, 3 switches between flat and 3D. In 3D, Shift with arrow keys turns the map. Enter points at the middle.",
            "Kaart roboti, selle teekonna ja koristatud alaga. Toad on loeteluna lehel „Kodu“. Nooleklahvid nihutavad, pluss ja miinus suurendavad ja vähendavad. 0 näitab kõike, F jälgib robotit, 3 vahetab tasase ja 3D-vaate vahel. 3D-vaates pöörab kaarti tõstuklahv koos nooltega. Enter osutab keskkohale.";
        relief: "3D view", "3D-vaade";
        relief_key: "3D view (key 3)", "3D-vaade (klahv 3)";
        no_relief: "This browser cannot draw the map in 3D, so it stays flat:", "See veebilehitseja ei oska kaarti 3D-s joonistada, seepärast jääb see tasaseks:";
        undo[1]: "Undo: {0}", "Võta tagasi: {0}";
        redo[1]: "Redo: {0}", "Tee uuesti: {0}";
        edit_wall: "virtual wall", "virtuaalsein";
        edit_zone: "no-go zone", "keeluala";
        edit_no_wall: "removal of a virtual wall", "virtuaalseina eemaldamine";
        edit_no_zone: "removal of a no-go zone", "keeluala eemaldamine";
        edit_keep: "saved zone", "salvestatud ala";
        edit_forget: "removal of a saved zone", "salvestatud ala eemaldamine";
        edit_place_name: "name of a saved zone", "salvestatud ala nimi";
        edit_no_go_name: "name of a restricted area", "keelatud ala nimi";
        edit_no_go_shape: "shape of a restricted area", "keelatud ala kuju";
        edit_place_shape: "shape of a saved zone", "salvestatud ala kuju";
        edit_take_up: "restored map backup", "taastatud kaardi varukoopia";
        edit_choice: "choice for the job", "koristamise valik";
        edit_name: "name of a room", "toa nimi";
        edit_settings: "settings of a room", "toa seaded";
        edit_split: "split of a room", "toa poolitamine";
        edit_unsplit: "removal of a split", "poolitamise tagasivõtmine";
        edit_join: "joining of rooms", "tubade ühendamine";
        edit_unjoin: "removal of a joining", "ühendamise tagasivõtmine";
        edit_dock: "place of the dock", "doki koht";
        changed_meanwhile: "That edit cannot be undone or redone: the map was changed there meanwhile. Earlier edits can be undone.",
            "Seda muudatust ei saa tagasi võtta ega uuesti teha: kaarti on seal vahepeal muudetud. Varasemaid saab.";
        not_reported_yet: "The robot has not confirmed that edit yet. Try again in a few seconds.",
            "Robot ei ole seda muudatust veel kinnitanud. Proovi mõne sekundi pärast uuesti.";
        unsure: "Not known", "Teadmata";
        carpet: "Carpet", "Vaip";
        zone_of[1]: "zone of {0}", "ala {0}";
        spot: "spot", "koht";
        spots[1]: "{0} spots", "{0} kohta";
        zone_alone: "zone", "ala";
        spot_at[2]: "at x {0} m, y {1} m", "kohas x {0} m, y {1} m";
        avoided[1]: "No-go for this job {0}", "Keeluala selleks korraks {0}";
        reshape: "Reshape", "Muuda kuju";
        reshape_named[1]: "Reshape {0}", "Muuda kuju: {0}";
        reshape_hint: "Drag its dots on the map. By keyboard: Tab chooses a dot, arrow keys move it by 5 cm, with Shift by 1 cm, Enter saves.",
            "Lohista kaardil selle täppe. Klaviatuuril: tabeldusklahv valib täpi, nooleklahvid nihutavad 5 cm, tõstuklahviga 1 cm, Enter salvestab.";
        handles[1]: "Dots of {0}", "Täpid: {0}";
        handle_corner[1]: "Corner {0}", "Nurk {0}";
        handle_middle: "All of it", "Tervikuna";
        take_out[1]: "Remove: {0}", "Võta välja: {0}";
        go_place: "Tap where the robot shall drive, or move that to the cross and press Enter. It does not clean on the way.",
            "Puuduta kohta, kuhu robot peab sõitma, või nihuta see ristile ja vajuta Enter. Teel ta ei korista.";
        spot_place: "Tap the middle of the spot, or move it to the cross and press Enter. A circle of one metre is cleaned.",
            "Puuduta koha keskpunkti või nihuta see ristile ja vajuta Enter. Koristatakse meetrilaiune ring.";
        whole_home: "The whole home", "Kogu kodu";
        out_of_one[1]: "{0}, with 1 no-go area", "{0}, 1 keelualaga";
        out_of_many[2]: "{0}, with {1} no-go areas", "{0}, {1} keelualaga";
        keep_out: "No-go for this job", "Keeluala selleks korraks";
        cannot_draw: "The map cannot be drawn; everything else works.", "Kaarti ei saa joonistada; kõik muu töötab.";
        no_webgl: "it offers no WebGL 2.", "see ei toeta WebGL 2.";
        view: "View of the map", "Kaardi vaade";
        zoom_in: "Zoom in", "Suurenda";
        zoom_out: "Zoom out", "Vähenda";
        everything: "Show everything", "Näita kõike";
        follow: "Follow the robot", "Jälgi robotit";
        ground: "What the map shows", "Mida kaart näitab";
        floor_plan: "Floor plan (simulated)", "Põrandaplaan (simulatsioon)";
        robot_map: "Robot's map", "Roboti kaart";
        legend: "Legend", "Leppemärgid";
        swept: "Cleaned; fainter where less certain", "Koristatud; ebakindlam koht on tuhmim";
        path: "Path", "Teekond";
        bump: "Bump", "Puude";
        planned: "Planned", "Kavas";
        door: "Door", "Uks";
        actual_position: "Actual position", "Tegelik koht";
        wall_first: "Tap one end of the wall, or move it to the cross and press Enter.",
            "Puuduta seina üht otsa või nihuta see ristile ja vajuta Enter.";
        wall_second: "Now the other end.", "Nüüd teine ots.";
        cut_first: "Tap where to split the room: first at one wall, or move that to the cross and press Enter.",
            "Puuduta, kust tuba poolitada: kõigepealt ühe seina ääres, või nihuta see ristile ja vajuta Enter.";
        cut_second: "Now at the other wall.", "Nüüd teise seina ääres.";
        dock_first: "Tap where the robot stands on the dock, or move that to the cross and press Enter.",
            "Puuduta, kus robot dokis seisab, või nihuta see ristile ja vajuta Enter.";
        dock_second: "Now behind the dock, where the robot looks when it stands on it.",
            "Nüüd doki taga, kuhu robot dokis seistes vaatab.";
        zone_first: "Tap one corner of the zone, or move it to the cross and press Enter.",
            "Puuduta ala üht nurka või nihuta see ristile ja vajuta Enter.";
        zone_second: "Now the opposite corner.", "Nüüd vastasnurk.";
        too_short: "Too short: the two places must be at least 5 cm apart. Point at the second one again, farther away.",
            "Liiga lühike: kahe koha vahe peab olema vähemalt 5 cm. Osuta teisele kohale uuesti, kaugemale.";
        too_narrow: "Too narrow: a zone is at least 5 cm long and wide. Point at the opposite corner again, farther away.",
            "Liiga kitsas: ala on vähemalt 5 cm pikk ja lai. Osuta vastasnurgale uuesti, kaugemale.";
        too_small: "Too small: at least 5 cm must stay between its ends or sides.",
            "Liiga väike: otste või külgede vahele peab jääma vähemalt 5 cm.";
        chosen: "Chosen rooms, zones and spots", "Valitud toad, alad ja kohad";
        reckons: "Calculating time and battery use.", "Arvutab aega ja akukulu.";
        join_these: "Join these rooms", "Ühenda need toad";
        clear_choice: "Clear", "Tühista valik";
        clean_selected: "Clean selected", "Korista valitud";
        times[1]: "{0}x", "{0}x";
        how_often: "How often each of them is cleaned", "Mitu korda igaüht koristatakse";
        // Floor, minutes, charge, recharges, share, low share.
        prospect[6]: "{0}, about {1} min, {2} of a full battery{3}; expected coverage {4}, or {5} if the position is less accurate than estimated",
            "{0}, umbes {1} min, {2} täis akust{3}; eeldatavalt koristatakse {4}, või {5}, kui asukoht on hinnatust ebatäpsem";
        one_recharge: ", with one pause to charge", ", ühe laadimispausiga";
        recharges[1]: ", with {0} pauses to charge", ", {0} laadimispausiga";
    }
}
