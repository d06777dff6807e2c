//! The robot's map of the home: floors, rooms, what is forbidden, stored maps.

use super::screen;

screen! {
    /// The sheet with all of it.
    HomeWords {
        name_long[2]: "{0} characters: at most {1}.", "{0} tähemärki: kõige rohkem {1}.";
        name_invisible: "The name holds a character that nobody sees. Type it instead of pasting.",
            "Nimes on märk, mida ei ole näha. Kirjuta nimi ise, ära kleebi.";
        name_digits: "A number alone is taken for another room. Add a word.",
            "Ainult arv tähendab teist tuba. Lisa mõni sõna.";
        maps: "Map backups", "Kaartide varukoopiad";
        no_maps: "None yet: a map backup is made when a run ends.", "Veel ühtegi: varukoopia tehakse, kui töö lõpeb.";
        room_one: "1 room", "1 tuba";
        room_many[1]: "{0} rooms", "{0} tuba";
        map[1]: "Map {0}", "Kaart {0}";
        in_use: "in use", "kasutusel";
        was_doubted: "doubted", "kahtlane";
        last_good: "last good", "viimane hea";
        restore_map[1]: "Restore map {0}", "Taasta kaart {0}";
        take_up: "Restore", "Taasta";
        floors: "Floors", "Korrused";
        floor_open: "The robot finds out on which floor it is on its dock, or while it cleans.",
            "Robot saab dokis või koristades teada, mis korrusel ta on.";
        which_dock: "It is on a dock, and several floors have one: choose the floor on which it is.",
            "Robot on dokis, aga dokk on mitmel korrusel: vali korrus, millel ta on.";
        floor_unknown: "It does not recognise the floor: choose the one on which it is, or say that it is new.",
            "Robot ei tunne korrust ära: vali, millel ta on, või ütle, et see on uus.";
        new_floor: "Add a floor", "Lisa korrus";
        floor[1]: "Floor {0}", "Korrus {0}";
        is_on[1]: "It is here: {0}", "Robot on siin: {0}";
        it_is_here: "It is here", "Robot on siin";
        is_here: "the robot is here", "robot on siin";
        remove_named[1]: "Remove {0}", "Eemalda {0}";
        bring_back_named[1]: "Bring back {0}", "Too tagasi: {0}";
        bring_back: "Bring back", "Too tagasi";
        rename_named[1]: "Rename {0}", "Nimeta ümber: {0}";
        no_map: "no map yet", "kaarti veel ei ole";
        removed: ", removed", ", eemaldatud";
        floor_name[1]: "New name of floor {0}; empty for its number", "Korruse {0} uus nimi; tühjana jääb number";
        export_floors: "Export maps", "Ekspordi kaardid";
        import_floors: "Import maps", "Impordi kaardid";
        floors_file: "File with floors", "Korruste fail";
        floors_sent[1]: "{0} % of the file has been sent to the robot.", "Robotile on saadetud {0} % failist.";
        floors_taken: "Maps imported. The floors that were there are unchanged.",
            "Kaardid on imporditud. Varasemad korrused on muutmata.";
        floors_lost: "The connection broke, and nothing was imported: choose the file again.",
            "Ühendus katkes ja midagi ei imporditud: vali fail uuesti.";
        floors_unreadable: "The file cannot be read: choose it again.", "Faili ei saa lugeda: vali see uuesti.";
        floors_file_size[1]: "This is no file with floors: such files have up to {0} MB and are not empty.",
            "See ei ole korruste fail: selline fail ei ole tühi ja selles on kuni {0} MB.";
        carpet_felt[2]: "Carpet detected: {0}. Hard floor: {1}.",
            "Tuvastatud vaip: {0}. Kõva põrand: {1}.";
        carpet_unknown: "Carpet is not detected: this robot does not measure the currents of its motors.",
            "Vaipa ei tuvastata: see robot ei mõõda oma mootorite voolu.";
        parts: "Parts of the home", "Kodu osad";
        zones: "Zones", "Alad";
        all_maps: "Maps", "Kaardid";
        rooms: "Rooms", "Toad";
        room[1]: "Room {0}", "Tuba {0}";
        no_rooms: "No room is known yet: the robot finds them while it cleans.",
            "Ühtki tuba veel ei teata: robot leiab need koristades.";
        zones_need_rooms: "Zones can be drawn as soon as a room is known.",
            "Alasid saab joonistada, kui mõni tuba on teada.";
        choose_rooms: "Press a room here or tap it on the map to choose it for cleaning.",
            "Koristamiseks vali tuba siin või puuduta seda kaardil.";
        draw_clean: "Draw a zone to clean", "Joonista koristatav ala";
        draw_spot: "Set a spot to clean", "Märgi koristatav koht";
        draw_go: "Send it to a place", "Saada robot kohta";
        draw_avoid: "No-go for this job", "Keeluala selleks korraks";
        set_room: "Settings", "Seaded";
        set_room_named[1]: "Settings of {0}", "Toa „{0}“ seaded";
        set_passes: "Cleaned at least", "Koristatakse vähemalt";
        set_usual: "Reset to defaults", "Taasta vaikeseaded";
        set_suction: "Suction", "Imemine";
        set_main_brush: "Main brush", "Põhihari";
        set_side_brushes: "Side brushes", "Külgharjad";
        set_once: "once", "üks kord";
        set_times[1]: "{0} times", "{0} korda";
        set_hint: "Power and pattern apply to every job. The number of passes applies to jobs that name the room.",
            "Võimsus ja muster kehtivad igal koristamisel. Kordade arv kehtib siis, kui tuba on valitud.";
        set_pattern: "Pattern", "Muster";
        pattern_lines: "In straight lines", "Sirgete ridadena";
        pattern_contour: "Along the walls", "Mööda seinu";
        job_power: "Power", "Võimsus";
        as_rooms: "As set for the rooms", "Nagu tubadele määratud";
        level_quiet: "Quiet", "Vaikne";
        level_normal: "Normal", "Tavaline";
        level_full: "Full", "Täisvõimsus";
        level_other[3]: "Suction {0}, main brush {1}, side brushes {2}", "Imemine {0}, põhihari {1}, külgharjad {2}";
        with_passes[1]: ", {0} times", ", {0} korda";
        draw_cut: "Split a room", "Poolita tuba";
        join_hint: "To make two rooms one, choose both: they must lie beside each other.",
            "Kahe toa ühendamiseks vali mõlemad: need peavad olema kõrvuti.";
        room_changes: "Rooms that were split or joined", "Poolitatud ja ühendatud toad";
        was_split[2]: "{1} was split from {0}", "{1} on lõigatud toast „{0}“";
        was_joined[2]: "{1} is a part of {0}", "{1} on toa „{0}“ osa";
        take_back: "Undo", "Võta tagasi";
        take_back_named[1]: "Undo: {0}", "Võta tagasi: {0}";
        room_name[1]: "New name of {0}; empty for its number", "Uus nimi toale „{0}“; tühjana jääb number";
        door_to[1]: ", door to {0}", ", uks: {0}";
        doors_to[2]: ", doors to {0} and {1}", ", uksed: {0} ja {1}";
        places: "Saved zones", "Salvestatud alad";
        no_places: "None yet: draw a zone or set a spot to clean, then save it here.",
            "Veel ühtegi: joonista koristatav ala või märgi koht ja salvesta see siin.";
        keep_named[1]: "Save: {0}", "Salvesta: {0}";
        keep_name[1]: "Name under which to save: {0}", "Nimi, millega salvestada: {0}";
        place_name[1]: "New name of {0}", "Uus nimi kohale „{0}“";
        no_go: "Restricted areas", "Keelatud alad";
        nothing_forbidden: "No restricted areas.", "Keelatud alasid ei ole.";
        dock: "Dock", "Dokk";
        dock_felt: "The dock is where the robot has docked.", "Dokk on seal, kus robot on dokkinud.";
        dock_reported: "The dock is where somebody marked it. The robot measures its exact position when it docks.",
            "Dokk on seal, kuhu see märgiti. Täpse koha mõõdab robot, kui ta dokib.";
        draw_dock: "The dock was moved", "Dokki on nihutatud";
        draw_wall: "Draw a virtual wall", "Joonista virtuaalsein";
        draw_zone: "Draw a no-go zone", "Joonista keeluala";
        wall[1]: "Virtual wall {0}", "Virtuaalsein {0}";
        zone[1]: "No-go zone {0}", "Keeluala {0}";
        no_go_name[1]: "New name of {0}; empty for its number", "Uus nimi kohale „{0}“; tühjana jääb number";
        extent[2]: "{0} x {1} m", "{0} × {1} m";
    }
}
