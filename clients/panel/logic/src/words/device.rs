//! The table of readings.

use super::screen;

screen! {
    /// Labels and values of the device table.
    DeviceWords {
        none: "The readings appear as soon as the robot is connected.", "Näidud ilmuvad kohe, kui robot on ühendatud.";
        proximity: "Proximity, from the left side to the right", "Lähedus, vasakult paremale";
        battery: "Battery", "Aku";
        link: "Link to the robot", "Ühendus robotiga";
        motion: "Wheels and brushes", "Rattad ja harjad";
        sensors: "Sensors", "Andurid";
        versions: "Versions", "Versioonid";
        discharging: "In use", "Kasutusel";
        charging: "Charging", "Laeb";
        full: "Full", "Täis";
        fault: "Charging fault", "Laadimisrike";
        not_measured: "not measured", "mõõtmata";
        charge: "Charge", "Laetus";
        state: "State", "Olek";
        voltage: "Voltage", "Pinge";
        current: "Current", "Vool";
        temperature: "Temperature", "Temperatuur";
        charger: "Charger", "Laadija";
        charge_end: "Last charge ended by", "Viimase laadimise lõpetas";
        charger_fault: "Charger fault", "Laadija rike";
        connection: "Connection", "Ühendus";
        up: "Up", "Toimib";
        lost: "Lost", "Katkenud";
        main_loop: "Main loop", "Põhitsükkel";
        to_robot: "To the robot", "Robotile";
        from_robot: "From the robot", "Robotilt";
        bad_packets: "Bad packets, last 5 s", "Vigased paketid, viimased 5 s";
        round_trip: "Round trip", "Edasi-tagasi aeg";
        age: "Age of the newest reading", "Uusima näidu vanus";
        telemetry: "Telemetry", "Telemeetria";
        binary: "Binary", "Kahendkujul";
        text: "Text", "Tekstina";
        resets_last[2]: "{0}, last: {1}", "{0}, viimane: {1}";
        resets: "Resets of the robot", "Roboti taaskäivitused";
        reconnects: "Reconnects", "Taasühendumised";
        with_current[2]: "{0}, {1} A", "{0}, {1} A";
        running: "Running", "Töötab";
        off: "Off", "Väljas";
        left_wheel: "Left wheel", "Vasak ratas";
        right_wheel: "Right wheel", "Parem ratas";
        main_brush: "Main brush", "Põhihari";
        side_brushes: "Side brushes", "Külgharjad";
        suction: "Suction", "Imemine";
        wheels: "Wheels", "Rattad";
        no_stall_detection: "No stall detection", "Kinnijäämist ei märgata";
        dust_box: "Dust box", "Tolmukonteiner";
        in_place: "In place", "Paigas";
        missing: "Missing", "Puudub";
        bumper: "Bumper", "Põrkeraud";
        free: "Free", "Vaba";
        cliff_sensors: "Cliff sensors", "Servaandurid";
        no_cliff: "Clear", "Serva ei ole";
        hanging: "Hanging wheel", "Rippuv ratas";
        none_hangs: "None", "Ükski";
        left: "left", "vasak";
        middle: "middle", "keskmine";
        right: "right", "parem";
        dock: "Dock contacts", "Doki kontaktid";
        closed: "Closed", "Suletud";
        open: "Open", "Avatud";
        robot: "Robot", "Robot";
        firmware: "Firmware", "Püsivara";
        protocol: "Wire protocol", "Sideprotokoll";
        brain: "Brain", "Aju";
        panel: "Panel", "Juhtpaneel";
        volts[1]: "{0} V", "{0} V";
        amperes[1]: "{0} A", "{0} A";
        celsius[1]: "{0} °C", "{0} °C";
        milliseconds[1]: "{0} ms", "{0} ms";
        hertz[1]: "{0} Hz", "{0} Hz";
        metres_per_s[1]: "{0} m/s", "{0} m/s";
        kilobytes_per_s[1]: "{0} kB/s", "{0} kB/s";
    }
}
