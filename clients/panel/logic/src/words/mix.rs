//! The editor of control mixes.

use super::screen;

screen! {
    /// Its fields, buttons and sentences.
    MixWords {
        editor: "Editor of control mixes", "Juhtskeemide muutmine";
        outputs: "Outputs", "Väljundid";
        switches: "Switches", "Lülitid";
        trims: "Trims", "Trimmid";
        modes: "Flight modes", "Lennurežiimid";
        inputs: "Calibrated inputs", "Kalibreeritud sisendid";
        failsafe_state: "The mix waits until every input is at rest: outputs give their failsafe.",
            "Skeem ootab, kuni kõik sisendid on puhkeasendis: väljundid annavad ohutu väärtuse.";
        stands: "The bars stand until what is wrong is corrected.", "Tulbad seisavad, kuni viga on parandatud.";
        none: "none", "puudub";
        so_far: "So far", "Seni kokku";
        input: "Input", "Sisend";
        shaped: "Shaped", "Kujundatud";
        weighted: "Weighted", "Kaalutud";
        reading: "Reading", "Näit";
        output: "Output", "Väljund";
        add_line: "Add a line", "Lisa rida";
        remove_line: "Remove this line", "Eemalda rida";
        add_output: "Add an output", "Lisa väljund";
        which: "Which?", "Milline?";
        not_on_robot: "Not on this robot: it lacks the part.", "Sellel robotil puudub see osa.";
        remove_output: "Remove this output", "Eemalda väljund";
        add_switch: "Add a switch", "Lisa lüliti";
        remove_switch: "Remove this switch", "Eemalda lüliti";
        on_now: "On now", "Praegu sees";
        off_now: "Off now", "Praegu väljas";
        add_trim: "Add a trim", "Lisa trimm";
        remove_trim: "Remove this trim", "Eemalda trimm";
        trim_now[2]: "{0}: {1} now", "{0}: praegu {1}";
        trims_hint: "A trim corrects what pulls to one side. It counts only while something is held, and what is set while driving is taken over here: save to keep it.",
            "Trimm parandab kõrvalekalde. See kehtib ainult siis, kui midagi hoitakse; sõites seatu võetakse siia üle, säilitamiseks salvesta.";
        add_mode: "Add a flight mode", "Lisa lennurežiim";
        remove_mode: "Remove this flight mode", "Eemalda lennurežiim";
        modes_hint: "The first mode whose switch is on holds: it has lines and trims of its own.",
            "Kehtib esimene režiim, mille lüliti on sees: sellel võivad olla oma read ja trimmid.";
        new_mode: "mode", "režiim";
        trim_up: "Button for more", "Suurendamise nupp";
        trim_down: "Button for less", "Vähendamise nupp";
        trim_step: "Step", "Samm";
        trim_value: "Value", "Väärtus";
        fade: "Goes over in, ms", "Ülemineku aeg, ms";
        own_trims: "Trims of its own", "Oma trimmid";
        in_modes: "Only in modes", "Ainult režiimides";
        shape_curve: "Shape it by points", "Kujunda punktidega";
        add_point: "Add a point", "Lisa punkt";
        remove_point: "Remove this point", "Eemalda punkt";
        straighten: "Make it straight", "Tee sirgeks";
        point_of[2]: "Point {0} of {1}", "Punkt {0} / {1}";
        point_is[2]: "{0} becomes {1}", "{0} muutub väärtuseks {1}";
        points_graph: "Points of the curve: drag them, or use the arrow keys", "Kõvera punktid: lohista neid või kasuta nooleklahve";
        add_input: "Add an input", "Lisa sisend";
        read_as_is: "Read this input as it is", "Loe sisendit muutmata";
        take_ends: "Take these ends", "Võta need otsad";
        calibrate: "Let go of it, then calibrate", "Lase lahti ja kalibreeri";
        move_up: "Move up", "Liiguta üles";
        set_long: "Set: take the input that is moved next", "Määra: võta sisend, mida järgmisena liigutatakse";
        set: "Set", "Määra";
        move_it: "Move it …", "Liiguta …";
        to_edit: "Mix to edit", "Muudetav skeem";
        copy_of_standard: "A copy of the standard one", "Tavalise skeemi koopia";
        save_first: "Save or revert before another mix is taken.", "Salvesta või taasta enne teise skeemi võtmist.";
        new: "New", "Uus";
        copy: "Copy", "Kopeeri";
        delete: "Delete", "Kustuta";
        import: "Import", "Impordi";
        export: "Export", "Ekspordi";
        file: "File of a control mix", "Juhtskeemi fail";
        removed[1]: "{0} is removed from the robot; Save keeps it again.", "{0} on robotist eemaldatud; salvestades jääb see jälle alles.";
        of_file[2]: "{0}: {1}.", "{0}: {1}.";
        unreadable: "the browser cannot read the file: choose it again", "veebilehitseja ei saa faili lugeda: vali see uuesti";
        save_to_robot: "Save to the robot", "Salvesta robotisse";
        revert: "Revert", "Taasta";
        kept[1]: "{0} is kept by the robot, and chosen for driving.", "{0} on robotisse salvestatud ja juhtimiseks valitud.";
        absent[1]: "{0} is not there: press a button of the gamepad, or set another input.",
            "{0} puudub: vajuta mängupuldi nuppu või määra teine sisend.";
        name: "Name", "Nimi";
        inverted: "Inverted", "Pööratud";
        weight: "Weight", "Kaal";
        offset: "Offset", "Nihe";
        expo: "Expo", "Kaardus";
        curve: "Curve points", "Kõvera punktid";
        // Reading and value, and then all of these.
        curve_gives[2]: "{0} gives {1}", "{0} annab {1}";
        curve_told[1]: "Curve from input to value: {0}", "Kõver sisendist väärtuseni: {0}";
        joins_by: "Joins by", "Liitub";
        only_while: "Only while on", "Ainult kui sees";
        delay: "Delay, ms", "Viivitus, ms";
        slow_up: "Slow up, per s", "Tõus sekundis";
        slow_down: "Slow down, per s", "Langus sekundis";
        low: "Low", "Alumine";
        centre: "Centre", "Keskmine";
        high: "High", "Ülemine";
        failsafe: "Failsafe", "Ohutu väärtus";
        reversed: "Reversed", "Vastupidine";
        on_when: "On when", "Sees, kui";
        level: "Level", "Tase";
        others: "Switches", "Lülitid";
        how_long: "How long, ms", "Kui kaua, ms";
        dead_band: "Dead band", "Surnud ala";
        adding: "adding", "liites";
        multiplying: "multiplying", "korrutades";
        replacing: "replacing", "asendades";
        switch[1]: "switch {0}", "lüliti {0}";
        always: "always", "alati";
        above: "input above the level", "sisend on üle taseme";
        below: "input below the level", "sisend on alla taseme";
        all_of: "all of these are on", "kõik need on sees";
        any_of: "any of these is on", "mõni neist on sees";
        not_of: "this is off", "see on väljas";
        toggle: "changes over when this goes on", "vahetub, kui see sisse läheb";
        sticky: "from the first to the second", "esimesest teiseni";
        edge: "a while after this went on", "hetk pärast selle sisseminekut";
        new_mix: "New mix", "Uus skeem";
        my_mix: "My mix", "Minu skeem";
        new_line: "New line", "Uus rida";
        new_switch: "switch", "lüliti";
        ends[3]: "Move it to both ends: {0} to {1}, at rest {2}.", "Liiguta mõlema otsani: {0} kuni {1}, puhkeasendis {2}.";
        not_let_go[1]: "{0} is not back at its rest: let it go, then press again", "{0} ei ole puhkeasendis: lase lahti ja vajuta uuesti";
        not_moved[1]: "{0} was not moved: begin again, and move it to both ends", "{0} ei liikunud: alusta uuesti ja liiguta mõlema otsani";
        no_number[3]: "{0}: write a number from {1} to {2}", "{0}: kirjuta arv vahemikust {1} kuni {2}";
        no_time[1]: "`{0}` is no time: write whole milliseconds from 0 to 5000", "„{0}“ ei ole aeg: kirjuta täisarv millisekundeid, 0 kuni 5000";
        no_point[1]: "`{0}` is no point: write two numbers, and a comma before the next, like -1 -1, 0 0.2, 1 1",
            "„{0}“ ei ole punkt: kirjuta kaks arvu ja järgmise ette koma, nagu -1 -1, 0 0.2, 1 1";
        one_switch[1]: "`{0}`: name one switch, with a comma between two", "„{0}“: nimeta üks lüliti";
        two_switches[1]: "`{0}`: name two switches, the one for on first, with a comma between two",
            "„{0}“: nimeta kaks lülitit, esimesena sisselülitaja, vahel koma";
        no_name[1]: "`{0}` is no name: take 1 to 32 letters, digits, blanks, - and _, and no blank at the ends",
            "„{0}“ ei ole nimi: võta 1 kuni 32 tähte, numbrit, tühikut, märki - või _, otstes tühikuta";
        no_input[1]: "`{0}` is no input: write always, pad-0-axis-1, pad-0-button-9, key-KeyW, touch-right, touch-up, tilt-forward, tilt-left, client-NAME or switch-NAME",
            "„{0}“ ei ole sisend: kirjuta always, pad-0-axis-1, pad-0-button-9, key-KeyW, touch-right, touch-up, tilt-forward, tilt-left, client-NIMI või switch-NIMI";
        number_high[3]: "`{0}` has the number {1}: take one below {2}", "„{0}“ sisaldab arvu {1}: võta väiksem kui {2}";
        too_large[2]: "the profile has {0} bytes, {1} at most: remove lines, or make names shorter",
            "skeemis on {0} baiti, lubatud on kuni {1}: eemalda ridu või lühenda nimesid";
        syntax[3]: "line {0}, column {1}: {2}: correct it there, or compare with a profile that was exported",
            "rida {0}, veerg {1}: {2}: paranda see või võrdle eksporditud skeemiga";
        other_version[2]: "the profile has version {0}, this program reads {1}: export it again with a program that fits",
            "skeemi versioon on {0}, see programm loeb versiooni {1}: ekspordi see sobiva programmiga uuesti";
        range[4]: "{0} is {1}: write a number from {2} to {3}", "{0} on {1}: kirjuta arv vahemikus {2} kuni {3}";
        rising[1]: "{0}: low, centre and high must rise, and low must be below high",
            "{0}: alumine, keskmine ja ülemine peavad kasvama ja alumine olema ülemisest väiksem";
        must_rest[2]: "{0} is {1}: it must be 0, so that the robot stands when an input is lost",
            "{0} on {1}: see peab olema 0, et robot sisendi kadudes seisaks";
        slow[2]: "{0} is {1}: write 0 for at once, or 0.5 to 100 a second", "{0} on {1}: kirjuta 0 (kohe) või 0.5 kuni 100 sekundis";
        points[2]: "{0}: give 2 to {1} points that rise from -1 to 1 in their first numbers, or none",
            "{0}: anna 2 kuni {1} punkti, mille esimesed arvud kasvavad -1-st 1-ni, või mitte ühtegi";
        too_many[3]: "{0}: {1} entries, {2} at most: remove some", "{0}: {1} kirjet, lubatud on kuni {2}: eemalda mõni";
        twice[1]: "{0} is there twice: remove one", "{0} on kaks korda: eemalda üks";
        no_trim_value[1]: "`{0}` is no trim: write an output and a number, and a comma before the next, like turn 0.05, forward 0",
            "„{0}“ ei ole trimm: kirjuta väljund ja arv ning järgmise ette koma, nagu turn 0.05, forward 0";
        no_mode[2]: "{0}: no mode has the name `{1}`: add one, or take another",
            "{0}: ühelgi režiimil ei ole nime „{1}“: lisa see või võta teine";
        no_trim[2]: "{0}: `{1}` has no trim: add one, or remove this value", "{0}: väljundil „{1}“ ei ole trimmi: lisa see või eemalda väärtus";
        not_trimmed[1]: "{0}: only forward, turn, left-wheel and right-wheel can be trimmed: remove it",
            "{0}: trimmida saab ainult väljundeid forward, turn, left-wheel ja right-wheel: eemalda see";
        no_switch[2]: "{0}: no switch before it has the name `{1}`: add one, or take another",
            "{0}: ühelgi eelneval lülitil ei ole nime „{1}“: lisa see või võta teine";
        joins_none[1]: "{0}: name at least one switch", "{0}: nimeta vähemalt üks lüliti";
        forward: "forward", "edasi";
        turn: "turn", "pööre";
        left_wheel: "left wheel", "vasak ratas";
        right_wheel: "right wheel", "parem ratas";
        suction: "suction", "imemine";
        main_brush: "main brush", "põhihari";
        side_brushes: "side brushes", "külgharjad";
        start: "start", "alusta";
        stop: "stop", "peata";
        spot: "spot", "üks koht";
        dock: "dock", "dokki";
    }
}
