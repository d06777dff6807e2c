//! Measuring what differs from robot to robot, step by step.

use super::screen;

screen! {
    /// The pages of the calibration.
    CalibrationWords {
        title: "Measured values", "Mõõdetud väärtused";
        why: "No two robots are quite alike. What differs is measured once, step by step.",
            "Ühesuguseid roboteid ei ole. Erinevused mõõdetakse üks kord, samm-sammult.";
        lacks[1]: "Missing until they are measured: {0}.", "Mõõtmiseta puudub: {0}.";
        begin: "Measure what is missing", "Mõõda puuduvad";
        again: "Measure again", "Mõõda uuesti";
        measure: "Measure", "Mõõda";
        not_measured: "not measured", "mõõtmata";
        assumed[1]: "not measured, taken as {0}", "mõõtmata, eeldatakse {0}";
        // Number of the step, of so many.
        step[2]: "Step {0} of {1}", "Samm {0}/{1}";
        kept[1]: "Kept so far: {0}", "Seni salvestatud: {0}";
        found[1]: "Measured: {0}", "Mõõdetud: {0}";
        ready: "I am ready", "Olen valmis";
        done: "Done", "Valmis";
        enter: "Enter", "Sisesta";
        keep: "Keep it", "Salvesta";
        repeat: "Repeat", "Korda";
        skip: "Skip", "Jäta vahele";
        end: "End", "Lõpeta";
        measuring: "Measuring: keep everything still.", "Mõõdan: hoia kõik paigal.";
        // Counts of the left and the right wheel.
        counts[2]: "Left wheel {0}, right wheel {1}", "Vasak ratas {0}, parem ratas {1}";
        reading[1]: "Reading {0}", "Näit {0}";
        duty[1]: "Power {0} per mille", "Võimsus {0} promilli";
        hold: "Hold to run", "Hoia all, et käiks";
        hold_hint: "The motors run only while you hold the button.", "Mootorid käivad ainult seni, kuni hoiad nuppu all.";
        moves: "The robot will move. Put it on the floor with two metres free before it and stay within reach.",
            "Robot hakkab liikuma. Pane ta põrandale nii, et ees on kaks meetrit vaba, ja ole käeulatuses.";
        pulls: "A wheel will pull. Keep fingers and hair out of it and hold the robot firmly.",
            "Ratas hakkab vedama. Hoia sõrmed ja juuksed eemal ning hoia robotist kõvasti kinni.";
        brush: "The main brush will turn. Keep fingers and hair away and the robot on the floor.",
            "Põhihari hakkab pöörlema. Hoia sõrmed ja juuksed eemal ning robot põrandal.";
        push: "Push it straight ahead along a measure, three metres if there is room.",
            "Lükka robotit mõõdulindi kõrval otse edasi, võimaluse korral kolm meetrit.";
        spin: "Turn it ten times around on the spot.", "Pööra robotit kohapeal kümme täispööret.";
        roll_left: "Lift it and turn the left wheel forward by half a turn.", "Tõsta robot üles ja keera vasakut ratast pool pööret edasi.";
        roll_right: "Lift it and turn the right wheel forward by half a turn.", "Tõsta robot üles ja keera paremat ratast pool pööret edasi.";
        light_floor: "Put it on a light floor.", "Pane robot heledale põrandale.";
        dark_floor: "Put it on the darkest floor you have.", "Pane robot oma kodu kõige tumedamale põrandale.";
        drop: "Hold its front over the edge of a table, or lift it to your chest.", "Hoia roboti esiosa üle laua serva või tõsta ta rinna kõrgusele.";
        free_front: "Leave a metre free around its front and step back.", "Jäta roboti ette meeter vaba ruumi ja astu eemale.";
        // Which of the seven sensors.
        paper[1]: "Hold white paper flat against sensor {0} of 7, counted from the right.",
            "Hoia valget paberit tihedalt vastu {0}. andurit seitsmest, paremalt lugedes.";
        hold_wheel_read: "Hold the left wheel fast and get ready to read the ammeter.", "Hoia vasakut ratast kinni ja valmistu ampermeetrit lugema.";
        hold_wheel: "Hold the left wheel fast for two seconds.", "Hoia vasakut ratast kaks sekundit kinni.";
        distance_mm: "How far did it go, in millimetres?", "Kui kaugele robot liikus, millimeetrites?";
        at_rest_ma: "The ammeter at rest, in milliamperes", "Ampermeetri näit puhkeolekus, milliamprites";
        pulled_ma: "The ammeter while the wheel pulled, in milliamperes", "Ampermeetri näit siis, kui ratas vedas, milliamprites";
        pack_mv: "The multimeter at the battery, in millivolts", "Multimeetri näit akul, millivoltides";
        room_dc: "The room's temperature, in tenths of a degree", "Toa temperatuur, kümnendikkraadides";
        value[1]: "The value ({0})", "Väärtus ({0})";
        whole: "A whole number, without unit or point.", "Täisarv, ilma ühiku ja komata.";
        button: "Hold this button down before you begin, until the value comes.", "Hoia seda nuppu all juba enne alustamist, kuni väärtus ilmub.";
        still: "Leave the robot still, off its dock.", "Jäta robot paigale, dokist eemale.";
        ice: "Hang the battery, plugged in and in a watertight bag, in ice water for an hour.", "Hoia ühendatud akut veekindlas kotis tund aega jäävees.";
        warm: "The same in water of 38 to 42 degrees for half an hour.", "Sama 38–42-kraadises vees pool tundi.";
        over: "Finished. What was kept is in the robot's file of values.", "Valmis. Salvestatu on roboti väärtuste failis.";
        next: "The robot uses the values once they are in its flash: run \"rvac flash calibration\" on its board. Until then it says what it still lacks.",
            "Robot kasutab väärtusi siis, kui need on tema mälus: käivita plaadil \"rvac flash calibration\". Seni ütleb ta, mis veel puudub.";
        all: "All values", "Kõik väärtused";
        file: "File of values", "Väärtuste fail";
        drive: "driving", "sõitmine";
        cliffs: "seeing stairs", "treppide nägemine";
        proximity: "seeing obstacles", "takistuste nägemine";
        gyro: "gyro", "güroskoop";
        wheel_currents: "wheel currents", "rataste vool";
        charging: "charging", "laadimine";
        dock_beams: "finding the dock", "doki leidmine";
    }
}

screen! {
    /// Names of the values.
    CalibrationNames {
        wheel_distance_per_count: "Distance per count of the wheels", "Rataste tee ühe impulsi kohta";
        wheel_track: "Distance between the wheels", "Rataste vahe";
        wheel_left_order: "Direction of the left wheel", "Vasaku ratta suund";
        wheel_right_order: "Direction of the right wheel", "Parema ratta suund";
        wheel_dead_band: "Least power of the wheels", "Rataste väikseim võimsus";
        wheel_free_speed: "Top speed of the wheels", "Rataste suurim kiirus";
        wheel_left_current_zero: "Zero of the left wheel's current", "Vasaku ratta voolu nullnäit";
        wheel_right_current_zero: "Zero of the right wheel's current", "Parema ratta voolu nullnäit";
        wheel_current_scale: "Scale of the wheel currents", "Rataste voolu mõõtkava";
        wheel_stall_current: "Current of a blocked wheel", "Kinnihoitud ratta vool";
        brush_main_pulse_rate: "Speed of the main brush", "Põhiharja kiirus";
        brush_main_dead_band: "Least power of the main brush", "Põhiharja väikseim võimsus";
        button_ladder_1: "First button from the left", "Esimene nupp vasakult";
        button_ladder_2: "Second button from the left", "Teine nupp vasakult";
        button_ladder_3: "Third button from the left", "Kolmas nupp vasakult";
        cliff_emitter_line: "Light of the floor sensors", "Põrandaandurite valgus";
        cliff_floor_level: "Floor or drop", "Põrand või tühjus";
        cliff_drop_level: "Level over a drop", "Näit tühjuse kohal";
        proximity_none: "Obstacle sensors: nothing there", "Takistusandurid: midagi pole ees";
        proximity_touching: "Obstacle sensors: touching", "Takistusandurid: vastu puutumas";
        battery_scale: "Scale of the battery's voltage", "Aku pinge mõõtkava";
        charge_current_zero: "Zero of the charging current", "Laadimisvoolu nullnäit";
        battery_capacity: "Capacity, from the battery's label", "Mahutavus aku sildilt";
        charge_stage_checked: "Charging stage checked on the bench (1 = yes)", "Laadija laual kontrollitud (1 = jah)";
        dock_code_ones: "Code for the dock's full current", "Doki täisvoolu kood";
        dock_beam_left: "Code of the dock's left beam", "Doki vasaku kiire kood";
        dock_beam_right: "Code of the dock's right beam", "Doki parema kiire kood";
        dock_beam_near: "Code close to the dock", "Kood doki lähedal";
        dock_beam_short: "Shortest burst of the dock's beams", "Doki kiirte lühim impulss";
        gyro_uart: "Port of the gyro", "Güroskoobi port";
        gyro_rate: "Rate of the gyro", "Güroskoobi andmekiirus";
        gyro_frame: "Frame of the gyro", "Güroskoobi kaader";
        thermistor_ice: "Battery in ice water", "Aku jäävees";
        thermistor_warm: "Battery in warm water", "Aku soojas vees";
        thermistor_warm_temperature: "Temperature of the warm water, tenths of a degree", "Sooja vee temperatuur, kümnendikkraadides";
        thermistor_checked: "Battery at room temperature", "Aku toatemperatuuril";
    }
}
