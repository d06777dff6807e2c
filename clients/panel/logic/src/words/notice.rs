//! Notifications of the system.

use super::screen;

screen! {
    /// What the system shows, and how that is switched.
    NoticeWords {
        title: "Notifications on this device", "Teated selles seadmes";
        job_over: "The job is over", "Töö on läbi";
        what: "A word from the system when a job is over, the robot is stuck or has a fault, while this page is open behind something else.",
            "Süsteemi teade, kui töö on läbi, robot on kinni jäänud või rikkis, samal ajal kui see leht on avatud millegi muu taga.";
        on: "Notify me", "Teavita mind";
        off: "Do not notify me any more", "Ära enam teavita";
        is_on: "Notifications are on.", "Teated on sees.";
        no_secure: "Not possible here: browsers notify only of pages over HTTPS, or on the robot's own computer.",
            "Siin ei saa: brauser teavitab ainult HTTPS-iga lehtedest või roboti enda arvutis.";
        no_support: "Not possible here: this browser has no notifications for pages. On an iPhone or iPad, add the page to the home screen first.",
            "Siin ei saa: sellel brauseril ei ole lehtede teateid. iPhone'is või iPadis lisa leht enne avakuvale.";
        denied: "Blocked: this browser does not let the page notify. Its settings for this page change that.",
            "Keelatud: brauser ei luba sellel lehel teavitada. Seda saab muuta brauseris selle lehe seadetest.";
        elsewhere: "While no page is open, ntfy or e-mail can tell you: see Notifications in the guide.",
            "Kui ükski leht ei ole avatud, saab teavitada ntfy või e-kirjaga: vaata juhendist teateid.";
    }
}
