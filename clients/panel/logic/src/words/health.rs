//! How worn or dirty parts are.

use super::screen;

screen! {
    /// Parts that turn, by what their motors draw.
    HealthWords {
        title: "Wear, by what the motors draw", "Kulumine, mootorite voolu järgi";
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
