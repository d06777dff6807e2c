//! Updates of the robot's software.

use super::screen;

screen! {
    /// The file, the steps, and how it ended.
    SoftwareWords {
        title: "Software update", "Tarkvara uuendamine";
        how: "Choose the file of an update. The robot checks who signed it before it changes anything, and goes back by itself if the new programs do not answer. Maps and schedules stay.",
            "Vali uuenduse fail. Robot kontrollib allkirja, enne kui midagi muudab, ja taastab endise seisu ise, kui uued programmid ei vasta. Kaardid ja ajakavad jäävad alles.";
        dock: "Leave the robot on its dock until it has ended.", "Jäta robot dokki, kuni uuendus on lõppenud.";
        choose: "Choose an update", "Vali uuendus";
        file: "File of an update", "Uuenduse fail";
        works: "The robot is at work: stop it first.", "Robot töötab: peata see enne.";
        // The most, in MiB.
        size[1]: "This is no update: it is empty, or larger than {0} MiB.", "See ei ole uuendus: fail on tühi või suurem kui {0} MiB.";
        lost: "The file did not come through: send it again.", "Fail ei jõudnud kohale: saada see uuesti.";
        progress: "Progress of the update", "Uuenduse edenemine";
        receive: "Received", "Kohale jõudnud";
        verify: "Checked", "Kontrollitud";
        unpack: "Unpacked", "Lahti pakitud";
        try_programs: "New programs answer", "Uued programmid vastavad";
        keep_firmware: "Old firmware kept", "Vana püsivara alles hoitud";
        write_firmware: "Firmware written and read back", "Püsivara kirjutatud ja tagasi loetud";
        try_firmware: "Robot answers", "Robot vastab";
        go_back: "Everything as before", "Kõik nagu enne";
        done: "done", "tehtud";
        now: "now", "käib";
        failed: "failed", "ebaõnnestus";
        to_come: "to come", "tulemata";
        // Percent of the file.
        receiving[1]: "Receives the file: {0}\u{a0}%", "Võtab faili vastu: {0}\u{a0}%";
        handing_over: "Waits to be taken …", "Ootab vastuvõtjat …";
        verifying: "Checks signature and files …", "Kontrollib allkirja ja faile …";
        unpacking: "Unpacks the files …", "Pakib faile lahti …";
        trying_programs: "Starts the new programs and waits for them; this page connects again by itself …",
            "Käivitab uued programmid ja ootab neid; leht ühendub ise uuesti …";
        keeping_firmware: "Reads and keeps the old firmware …", "Loeb vana püsivara ja hoiab selle alles …";
        writing_firmware: "Writes the firmware and reads it back: leave the robot on its dock …",
            "Kirjutab püsivara ja loeb selle tagasi: jäta robot dokki …";
        trying_firmware: "Waits for the robot …", "Ootab robotit …";
        going_back: "It does not work: goes back …", "See ei tööta: taastab endise seisu …";
        // Number and version.
        installed[2]: "Update {0} is in use, version {1}.", "Uuendus {0} on kasutusel, versioon {1}.";
        refused: "Refused. Nothing was changed.", "Ei võetud vastu. Midagi ei muudetud.";
        went_back: "It did not work. Everything is as it was before.", "See ei töötanud. Kõik on nii, nagu enne.";
        went_on: "It did not work, but there is no way back: it stays in use.", "See ei töötanud, aga endist ei saa taastada: uuendus jääb kasutusele.";
        not_settled: "It did not work, and going back is not finished. Run “sudo rvac update --settle” on the robot.",
            "See ei töötanud ja endise taastamine on pooleli. Käivita robotis „sudo rvac update --settle“.";
        cut_off: "It was cut off. The next start of the robot's board brings it to an end.",
            "See katkes. Roboti arvuti järgmine käivitus viib selle lõpule.";
        given_up: "It is not in use any more: the programs before it run again.", "See ei ole enam kasutusel: jälle töötavad eelmised programmid.";
        reload: "Reload the page", "Laadi leht uuesti";
    }
}
