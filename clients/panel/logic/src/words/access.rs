//! Pairing, and the devices that are paired.

use super::screen;

screen! {
    /// What strangers see, and what administrators decide.
    AccessWords {
        title: "Pair this device with the robot", "Seo see seade robotiga";
        // The two commands are between the parts.
        how_before: "Hold START on the robot for five seconds until it beeps. Or run ", "Hoia robotil nuppu START viis sekundit, kuni kostab helisignaal. Või käivita robotis ";
        how_after: " on the robot, or choose “Add a device” on a device that is its administrator. The robot beeps and a code of eight digits is shown, which holds for two minutes.",
            " või vali haldusõigusega seadmes „Lisa seade“. Robot annab helisignaali ja näidatakse kaheksakohalist koodi, mis kehtib kaks minutit.";
        forgotten_buttons: "START and DOCK were held on the robot: it has forgotten all devices. Pair this one anew.",
            "Robotil hoiti nuppe START ja DOCK: see on kõik seadmed unustanud. Seo see seade uuesti.";
        forgotten_file: "A file on the robot's card had all devices forgotten. Pair this one anew.",
            "Fail roboti kaardil lasi kõik seadmed unustada. Seo see seade uuesti.";
        forgotten_console: "At the robot's console all devices were forgotten. Pair this one anew.",
            "Roboti konsoolil unustati kõik seadmed. Seo see seade uuesti.";
        how_presses: "The robot has beeped: START was held. Give this device a name, and it shows how often to press START.",
            "Robot andis helisignaali: nuppu START hoiti. Anna sellele seadmele nimi ja see näitab, mitu korda nuppu vajutada.";
        show_presses: "Show what to press", "Näita, mida vajutada";
        waiting: "Waiting for START …", "Ootab nupuvajutusi …";
        // How often before and after the pause.
        presses[2]: "Press START on the robot {0}×, pause for two seconds, then press it {1}×.",
            "Vajuta robotil nuppu START {0}×, oota kaks sekundit ja vajuta veel {1}×.";
        device_name: "Name of this device", "Selle seadme nimi";
        example_name: "Mari's phone", "Mari telefon";
        code: "Code", "Kood";
        pairing: "Pairing …", "Sidumine …";
        pair: "Pair", "Seo";
        trust_before: "No warning from the browser next time: install the ", "Et veebilehitseja edaspidi ei hoiataks, paigalda ";
        certificate: "robot's certificate", "roboti sertifikaat";
        trust_between: " (", " (";
        profile: "profile for iPhones", "profiil iPhone'ile";
        trust_after: ") after comparing its fingerprint with what ", "), kui oled selle sõrmejälge võrrelnud sellega, mida ";
        trust_end: " shows on the robot.", " robotis näitab.";
        not_paired: "This device is not paired with the robot any more.", "See seade ei ole enam robotiga seotud.";
        unreachable: "The robot does not answer: try again.", "Robot ei vasta: proovi uuesti.";
        no_random: "This browser gives no random numbers: try a newer one.", "See veebilehitseja ei anna juhuarve: proovi uuemat.";
        impostor: "The answer is not that of the robot whose code this is: somebody may stand between. Do not go on.",
            "Vastus ei tulnud robotilt, kelle kood see on: keegi võib vahel olla. Ära jätka.";
        bad_code: "A code has eight digits.", "Koodis on kaheksa numbrit.";
        malformed: "The message of the other end is malformed.", "Teise poole sõnum on vigane.";
        name_empty: "Give the device a name.", "Anna seadmele nimi.";
        name_long: "A name has at most 40 characters.", "Nimes on kuni 40 tähemärki.";
        name_control: "A name has no control characters.", "Nimes ei tohi olla juhtmärke.";
        // Name, role, address.
        newcomer[3]: "A new device is paired with the robot: {0}, with the role {1}, from {2}.",
            "Robotiga seoti uus seade: {0}, õigus: {1}, aadressilt {2}.";
        devices: "Paired devices", "Seotud seadmed";
        new_may: "A new device may", "Uus seade võib";
        add: "Add a device", "Lisa seade";
        type_code[2]: "Type {0} on the new device within {1} seconds.", "Sisesta uues seadmes {0}; aega on {1} sekundit.";
        qr_code: "QR code of the robot's address", "Roboti aadressi QR-kood";
        scan[1]: "The camera of the new device finds the robot by this: {0}", "Uue seadme kaamera leiab selle järgi roboti: {0}";
        this_device: "this device", "see seade";
        may_named[1]: "What {0} may do", "Mida {0} võib teha";
        remove_named[1]: "Remove {0}", "Eemalda {0}";
        remove: "Remove", "Eemalda";
        may_view: "look and stop", "vaadata ja peatada";
        may_drive: "drive and clean", "juhtida ja koristada";
        may_admin: "change everything", "kõike muuta";
    }
}
