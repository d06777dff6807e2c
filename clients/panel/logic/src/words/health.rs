//! How worn or dirty parts are.

use super::screen;

screen! {
    /// Parts by what their motors draw, and by hours of work.
    HealthWords {
        title: "Parts and wear", "Osad ja kulumine";
        filter: "Filter", "Tolmufilter";
        hours[2]: "{0} of about {1} hours of work", "töötanud {0} tundi umbes {1}-st";
        since[1]: "Since {0}.", "Alates {0}.";
        counted: "Hours are counted: nothing measures how worn such a part is. The usual life is the one that Xiaomi and Roborock reckon with; yours may be another.",
            "Tunnid on loendatud: nende osade kulumist ei mõõda miski. Tavaline eluiga on see, millega arvestavad Xiaomi ja Roborock; sinu omal võib see olla teine.";
        brush_due: "It has worked for as long as such brushes usually last. Replace it if its bristles are worn.", "Hari on töötanud nii kaua, kui sellised tavaliselt kestavad. Vaheta see, kui harjased on kulunud.";
        sides_due: "They have worked for as long as such brushes usually last. Replace them if they are bent or worn.", "Harjad on töötanud nii kaua, kui sellised tavaliselt kestavad. Vaheta need, kui nad on kõverad või kulunud.";
        filter_due: "It has worked for as long as such filters usually last. Replace it.", "Filter on töötanud nii kaua, kui sellised tavaliselt kestavad. Vaheta see.";
        sensors_due: "Wipe the windows of the sensors below and around the robot with a dry cloth.", "Pühi roboti all ja ümber olevate andurite aknad kuiva lapiga puhtaks.";
        replaced: "Mark as replaced", "Märgi vahetatuks";
        replaced_named[1]: "Mark as replaced: {0}", "Märgi vahetatuks: {0}";
        was_replaced[1]: "{0}: marked as replaced.", "{0}: märgitud vahetatuks.";
        was_cleaned[1]: "{0}: marked as cleaned.", "{0}: märgitud puhastatuks.";
        learning[1]: "learning what is usual: {0} of 10 minutes of cleaning", "õpib, mis on tavaline: {0} minutit 10-st";
        fine[1]: "as usual: {0}\u{a0}%", "nagu ikka: {0}\u{a0}%";
        hard[1]: "runs hard: {0}\u{a0}%", "käib raskelt: {0}\u{a0}%";
        light[1]: "runs light: {0}\u{a0}%", "käib kergelt: {0}\u{a0}%";
        share_of: "Percent of the load in the first ten minutes after the part was cleaned.", "Protsent koormusest esimese kümne minuti jooksul pärast osa puhastamist.";
        brush_hard: "Take hair and threads off it and off its bearings.", "Eemalda harjalt ja selle laagritelt juuksed ning niidid.";
        brush_light: "Look whether it sits in its place, its belt is whole, and its bristles still reach the floor.", "Vaata, kas hari on paigas, rihm terve ja kas harjased ulatuvad veel põrandani.";
        wheel_hard: "Take hair and threads off its axle, and look whether its gears are clean.", "Eemalda teljelt juuksed ja niidid ning vaata, kas hammasrattad on puhtad.";
        wheel_light: "Look whether its tyre is worn or lost, and whether it presses on the floor.", "Vaata, kas rehv on kulunud või kadunud ja kas ratas surub põrandale.";
        cleaned: "Mark as cleaned", "Märgi puhastatuks";
        cleaned_named[1]: "Mark as cleaned: {0}", "Märgi puhastatuks: {0}";
    }
}
