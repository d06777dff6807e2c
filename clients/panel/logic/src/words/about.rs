//! What this is, and its licence.

use super::screen;

screen! {
    /// The end of the sheet with the device.
    AboutWords {
        title: "About", "Teave";
        what: "LibreRVAC is free software for robotic vacuum cleaners. It sends nothing to anybody.",
            "LibreRVAC on robottolmuimejate vaba tarkvara. See ei saada andmeid kellelegi.";
        page[1]: "This page: {0}.", "See leht: {0}.";
        daemon[2]: "Daemon: {0}. Brain: {1}.", "Deemon: {0}. Aju: {1}.";
        licence: "The page is under the GNU Affero General Public License 3 or later: you may use, study, share and change it.",
            "Lehe litsents on GNU Affero General Public License 3 või uuem: seda tohib kasutada, uurida, jagada ja muuta.";
        source: "Source code", "Lähtekood";
        help: "The guide is the book in the folder docs/book of the source.", "Juhend on lähtekoodi kaustas docs/book.";
        // With the command behind it.
        doctor: "The whole chain is checked, at the robot's console, by", "Kogu ahelat kontrollib roboti konsoolis käsk";
    }
}
