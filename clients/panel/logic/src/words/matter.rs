//! Letting a home in by Matter.

use super::screen;

screen! {
    /// The code, and whether a home can join.
    MatterWords {
        title: "Matter", "Matter";
        // Minutes.
        how[1]: "Choose “add device” in the app of your home, and scan the code or type the digits. For {0} min more a home can join.",
            "Vali oma kodu äpis „lisa seade“ ja skaneeri kood või sisesta numbrid. Kodu saab liituda veel {0} min.";
        code: "Code for Matter", "Matteri kood";
        digits: "Digits", "Numbrid";
        joined: "The robot has joined a home. A second app is let in by the first one, which can share the robot.",
            "Robot on koduga liitunud. Teise äpi laseb sisse esimene, mis saab robotit jagada.";
        closed: "No home can join now. Start rvac-matter again: then the code stands here for 15 minutes.",
            "Praegu ei saa ükski kodu liituda. Käivita rvac-matter uuesti: siis on kood siin 15 minutit.";
        uncertified: "The robot is not certified: some homes warn, some refuse.",
            "Robot ei ole sertifitseeritud: mõni kodu hoiatab, mõni keeldub.";
    }
}
