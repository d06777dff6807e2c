//! The computer in the robot.

use super::screen;

screen! {
    /// Its addresses, clock, disk, memory, heat, and the file for a bug report.
    SystemWords {
        title: "The computer in the robot", "Arvuti robotis";
        board: "Computer", "Arvuti";
        reached_at: "Reached at", "Aadress";
        network[1]: "Network {0}", "Võrk {0}";
        clock: "Clock", "Kell";
        clock_unset: "not set: schedules start nothing", "seadmata: ajakavad ei käivita midagi";
        clock_off[1]: "{0} apart from this device", "selle seadmega võrreldes {0} nihkes";
        clock_fine: "as on this device", "sama mis selles seadmes";
        zone: "Time zone", "Ajavöönd";
        zone_unknown: "not known: schedules are in UTC", "teadmata: ajakavad on UTC-s";
        disk: "Disk", "Ketas";
        disk_free[2]: "{0} free of {1}", "{0} vaba, kokku {1}";
        disk_read_only: "read-only: nothing is kept", "ainult lugemiseks: midagi ei säili";
        memory: "Memory", "Mälu";
        memory_free[2]: "{0} available of {1}", "{0} saadaval, kokku {1}";
        heat: "Processor", "Protsessor";
        up: "Switched on for", "Sees olnud";
        days[2]: "{0} d {1}", "{0} p {1}";
        server: "Panel server", "Paneeli server";
        mebibytes[1]: "{0} MiB", "{0} MiB";
        gibibytes[1]: "{0} GiB", "{0} GiB";
        doctor: "More is checked, at the robot's console, by", "Rohkem kontrollib roboti konsoolis käsk";
        report: "Save a report for a bug", "Salvesta veateate jaoks kõik";
        report_what: "One file with all of this sheet, the log, the decisions and the last runs. It names your rooms and addresses on your network: look at it before you send it. Recordings of runs are under History.",
            "Üks fail kogu selle lehe, logi, otsuste ja viimaste töödega. Selles on sinu tubade nimed ja aadressid sinu võrgus: vaata see enne saatmist üle. Tööde salvestised leiad ajaloost.";
    }
}
