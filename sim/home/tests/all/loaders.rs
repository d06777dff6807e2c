//! Every format from tiny inline files, and every mistake with its clear sentence.

use crate::scene;
use crate::scene::{HEAD, file, room, sr8730};
use home::{Cell, Home, HomeError, Pcg, RobotModel, robot_names};

pub(crate) fn load(name: &str, bytes: &[u8]) -> Result<Home, HomeError> {
    Home::load(&file(name, bytes), &sr8730())
}

/// The complaint about a file, which must name the file and be one line.
pub(crate) fn complaint(name: &str, bytes: &[u8]) -> String {
    let text = load(name, bytes).expect_err("the file is wrong").to_string();
    assert!(text.contains(name), "{text}");
    assert!(!text.contains('\n'), "{text}");
    text
}

pub(crate) fn check_area(found_m2: f64, wanted_m2: f64) {
    assert!(
        (found_m2 - wanted_m2).abs() < 1e-6,
        "{found_m2} instead of {wanted_m2}"
    );
}

/// A grey image of 40 x 20 pixels: an unknown ring, a wall ring, floor inside; the lower left floor quarter is a block.
pub(crate) fn pixels() -> Vec<u8> {
    let mut pixels = vec![205; 40 * 20];
    for row in 1..19 {
        for column in 1..39 {
            let edge = row == 1 || row == 18 || column == 1 || column == 38;
            let block = row >= 14 && column < 6;
            pixels[row * 40 + column] = if edge || block { 0 } else { 254 };
        }
    }
    pixels
}

/// Columns and rows of [`pixels`].
pub(crate) const SIZE: (usize, usize) = (40, 20);

pub(crate) fn pgm(pixels: &[u8]) -> Vec<u8> {
    pgm_of(SIZE, pixels)
}

pub(crate) fn pgm_of((columns, rows): (usize, usize), pixels: &[u8]) -> Vec<u8> {
    let mut bytes = format!("P5\n# made by a test\n{columns} {rows}\n255\n").into_bytes();
    bytes.extend(pixels);
    bytes
}

/// The same with two bytes a pixel.
fn wide_pgm(pixels: &[u8]) -> Vec<u8> {
    let mut bytes = b"P5 40 20 65535\n".to_vec();
    bytes.extend(pixels.iter().flat_map(|pixel| [*pixel, *pixel]));
    bytes
}

pub(crate) fn png_of((columns, rows): (usize, usize), pixels: &[u8], color: png::ColorType) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns as u32, rows as u32);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().expect("the header is valid");
    writer
        .write_image_data(pixels)
        .expect("the pixels fill the image");
    drop(writer);
    bytes
}

pub(crate) const YAML: &str =
    "resolution: 0.05\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
/// Floor of [`pixels`]: 36 x 16 without a block of 4 x 4, 5 cm each.
pub(crate) const FLOOR_M2: f64 = (36.0 * 16.0 - 4.0 * 4.0) * 0.0025;

#[test]
fn ros_maps_load_from_every_image_format() {
    let grey = pixels();
    let text: String = grey.iter().map(|pixel| format!("{pixel} ")).collect();
    let rgba: Vec<u8> = grey
        .iter()
        .flat_map(|pixel| [*pixel, *pixel, *pixel, 255])
        .collect();
    let images: [(&str, Vec<u8>); 5] = [
        ("ros-p5.pgm", pgm(&grey)),
        ("ros-16-bit.pgm", wide_pgm(&grey)),
        ("ros-p2.pgm", format!("P2 40 20 255\n{text}").into_bytes()),
        ("ros-grey.png", png_of(SIZE, &grey, png::ColorType::Grayscale)),
        ("ros-rgba.png", png_of(SIZE, &rgba, png::ColorType::Rgba)),
    ];
    for (name, bytes) in images {
        file(name, &bytes);
        let home = load(
            &format!("{name}.yaml"),
            format!("image: {name}\n{YAML}").as_bytes(),
        )
        .unwrap();
        check_area(home.free_area_m2(), FLOOR_M2);
        assert!(home.grid().cell_m <= 0.025);
        // The block is at the lower left: rows of an image run downward.
        let plan = home.file_from_plan().inverse();
        let at = |x_m: f64, y_m: f64| {
            let (x_m, y_m) = plan.point(x_m, y_m);
            home.grid().at(x_m, y_m)
        };
        assert_eq!(at(-1.0 + 0.15, -2.0 + 0.15), Cell::Obstacle);
        assert_eq!(at(-1.0 + 0.15, -2.0 + 0.80), Cell::Floor);
    }
}

#[test]
fn ros_options_are_understood() {
    let negated: Vec<u8> = pixels().iter().map(|pixel| 255 - pixel).collect();
    file("negated.pgm", &pgm(&negated));
    let yaml = format!(
        "image: \"negated.pgm\" # quoted\n{}",
        YAML.replace("negate: 0", "negate: true")
    );
    check_area(
        load("negated.yaml", yaml.as_bytes()).unwrap().free_area_m2(),
        FLOOR_M2,
    );

    file("plain.pgm", &pgm(&pixels()));
    let block_list = YAML.replace("origin: [-1.0, -2.0, 0.0]", "origin:\n- -1.0\n- -2.0\n- 1.5");
    let turned = load(
        "turned.yaml",
        format!("image: plain.pgm\n{block_list}").as_bytes(),
    )
    .unwrap();
    assert_eq!(turned.file_from_plan().heading_rad, 1.5);

    // 205 is a shade of 0.196, in scale mode nearer to free than to occupied: floor, not unknown.
    let scale = format!("image: plain.pgm\nmode: scale\n{YAML}");
    let scaled = load("scale.yaml", scale.as_bytes()).unwrap();
    check_area(
        scaled.free_area_m2(),
        FLOOR_M2 + (40.0 * 20.0 - 38.0 * 18.0) * 0.0025,
    );
}

const VALETUDO: &str = r#"{"__class":"ValetudoMap","metaData":{"version":2},"size":{"x":5120,"y":5120},"pixelSize":5,
"layers":[
{"__class":"MapLayer","type":"floor","pixels":[],"compressedPixels":[100,200,SIDE,100,201,SIDE]},
{"__class":"MapLayer","type":"segment","metaData":{"segmentId":"1"},"compressedPixels":[ROWS]},
{"__class":"MapLayer","type":"wall","pixels":[100,200,101,200],"compressedPixels":[]}],
"entities":[{"__class":"PointMapEntity","type":"charger_location","points":[600,1198],"metaData":{"angle":90}},
{"__class":"LineMapEntity","type":"virtual_wall","points":[500,1020,700,1020]}]}"#;

pub(crate) fn valetudo() -> String {
    valetudo_of(40)
}

/// A square room of so many pixels.
pub(crate) fn valetudo_of(side: u32) -> String {
    let rows: Vec<String> = (202..200 + side).map(|row| format!("100,{row},{side}")).collect();
    VALETUDO
        .replace("ROWS", &rows.join(","))
        .replace("SIDE", &side.to_string())
}

#[test]
fn valetudo_maps_load_with_y_upward_and_the_dock_at_the_charger() {
    let home = load("valetudo.json", valetudo().as_bytes()).unwrap();
    check_area(home.free_area_m2(), (40.0 * 40.0 - 2.0) * 0.0025);
    // The charger is in the middle below the lowest row, y down: in the plan that is the lower wall.
    let dock = home.dock().unwrap();
    let (x_m, y_m) = home.file_from_plan().point(dock.x_m, dock.y_m);
    assert!((x_m - 6.0).abs() < 0.1 && (y_m + 12.0).abs() < 0.1, "{x_m} {y_m}");
    assert!((dock.heading_rad - core::f64::consts::FRAC_PI_2).abs() < 0.1);
    let from_dock = home.start().distance_m(dock);
    assert!((from_dock - 0.185).abs() < 1e-9, "the robot starts on its dock");
}

#[test]
fn valetudo_maps_of_version_1_have_plain_pixels() {
    let mut pixels = String::new();
    for row in 10..30 {
        for column in 10..30 {
            pixels.push_str(&format!("{column},{row},"));
        }
    }
    let text = format!(
        r#"{{"__class":"ValetudoMap","metaData":{{"version":1}},"pixelSize":5,"layers":[{{"type":"floor","pixels":[{}]}}]}}"#,
        pixels.trim_end_matches(',')
    );
    let home = load("valetudo1.json", text.as_bytes()).unwrap();
    check_area(home.free_area_m2(), 1.0);
}

#[test]
fn carpets_of_valetudo_are_rugs() {
    let carpet = r#""entities":[{"__class":"PolygonMapEntity","type":"carpet","points":[550,1050,600,1050,600,1100,550,1100]},"#;
    let text = valetudo().replace("\"entities\":[", carpet);
    let home = load("carpet.json", text.as_bytes()).unwrap();
    let rugs = home
        .grid()
        .cells
        .iter()
        .filter(|cell| **cell == Cell::Rug)
        .count();
    check_area(rugs as f64 * home.grid().cell_area_m2(), 0.25);
}

#[test]
fn areas_of_simple_rooms_are_exact() {
    let home = scene::home(&room(4.0, 5.0));
    check_area(home.free_area_m2(), 20.0);
    // All of it but the corners that a disc of 0.15 m radius, 0.175 m from both walls, cannot reach.
    let corner = 0.175_f64;
    let unswept = 4.0 * (5.0 + 4.0 - 4.0 * corner) * 0.025 / 2.0 + 4.0 * corner * corner;
    let swept_m2 = home.reachable_area_m2();
    assert!(swept_m2 < 20.0 && swept_m2 > 20.0 - unswept - 0.3, "{swept_m2}");
    let t0_s = swept_m2 / (0.30 * 0.25);
    assert!((home.t0_s() - t0_s).abs() < 1e-6);
}

#[test]
fn what_lies_behind_a_gap_too_narrow_for_the_body_is_not_reachable() {
    let wall = |gap_m: f64| {
        format!(
            "{}[[wall]]\nfrom = [2.0, 0.0]\nto = [2.0, {}]\n",
            room(5.0, 3.0),
            3.0 - gap_m
        )
    };
    let narrow = scene::home(&wall(0.32)).reachable_area_m2();
    let wide = scene::home(&wall(0.42)).reachable_area_m2();
    assert!(narrow < 9.5 && wide > 13.5, "{narrow} {wide}");
}

#[test]
fn a_closed_door_hides_a_room_unless_it_opens_later() {
    let plan = |door: &str| {
        let home = scene::home(&format!(
            "{}[[wall]]\nfrom = [2.0, 0.0]\nto = [2.0, 3.0]\n[[door]]\nfrom = [2.0, 1.0]\nto = [2.0, 2.0]\n{door}",
            room(5.0, 3.0)
        ));
        home.reachable_area_m2()
    };
    let closed = plan("state = \"closed\"\n");
    let later = plan("state = \"closed\"\nschedule = [{ at-s = 9.0, state = \"open\" }]\n");
    let open = plan("state = \"open\"\n");
    assert!(closed < 9.5, "{closed}");
    assert_eq!(later, open);
    assert!(open > 13.5, "{open}");
}

#[test]
fn a_threshold_that_is_too_high_is_a_wall() {
    let plan = |height_m: f64| {
        let threshold = format!(
            "[[threshold]]\nfrom = [2.0, 0.0]\nto = [2.0, 3.0]\nwidth-m = 0.1\nheight-m = {height_m}\n"
        );
        scene::home(&format!("{}{threshold}", room(5.0, 3.0))).reachable_area_m2()
    };
    assert!(plan(0.03) < 9.5);
    assert!(plan(0.01) > 13.5);
}

#[test]
fn an_open_door_does_not_take_away_a_threshold_that_is_too_high() {
    let plan = |height_m: f64| {
        scene::home(&format!(
            "{}[[wall]]\nfrom = [2.0, 0.0]\nto = [2.0, 3.0]\n\
             [[door]]\nfrom = [2.0, 1.0]\nto = [2.0, 2.0]\nthickness-m = 0.16\nstate = \"open\"\n\
             [[threshold]]\nfrom = [2.0, 1.0]\nto = [2.0, 2.0]\nwidth-m = 0.08\nheight-m = {height_m}\n",
            room(5.0, 3.0)
        ))
    };
    let barred = plan(0.03);
    assert!(barred.reachable_area_m2() < 9.5);
    assert_eq!(
        barred.with_doors_open().grid().cells,
        barred.grid().cells,
        "the door stood open before"
    );
    assert!(plan(0.01).reachable_area_m2() > 13.5);
}

#[test]
fn drops_are_neither_floor_nor_reachable() {
    let cliff = "[[cliff]]\npolygon = [[2.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0]]\n";
    let home = scene::home(&format!("{}{cliff}", room(5.0, 3.0)));
    check_area(home.free_area_m2(), 12.0);
    assert!(home.reachable_area_m2() < 6.0, "one side only");
}

#[test]
fn the_homes_of_the_project_load() {
    for (name, free_m2) in [
        ("two-room-flat", 28.2),
        ("furnished-room", 18.1),
        ("stairs", 21.1),
    ] {
        let path = format!("{}/../../homes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let home = Home::load(path.as_ref(), &sr8730()).unwrap();
        assert!(
            (home.free_area_m2() - free_m2).abs() < 0.1,
            "{name}: {}",
            home.free_area_m2()
        );
        assert!(home.reachable_area_m2() > 0.9 * home.free_area_m2(), "{name}");
        assert!(home.dock().is_some());
    }
}

#[test]
fn mistakes_get_one_clear_sentence() {
    let missing = Home::load("no/such/home.yaml".as_ref(), &sr8730()).unwrap_err();
    assert!(matches!(missing, HomeError::Missing { .. }), "{missing}");
    let folder = Home::load(env!("CARGO_TARGET_TMPDIR").as_ref(), &sr8730()).unwrap_err();
    assert!(matches!(folder, HomeError::Unreadable { .. }), "{folder}");

    assert!(complaint("empty.toml", b"").contains("empty file"));
    assert!(complaint("noise.bin", &[0xff, 0xfe, 0, 1]).contains("not text"));
    assert!(complaint("letter.txt", b"Dear robot,\n").contains("homes/README.md"));
    assert!(complaint("image.yaml", &pgm(&pixels())).contains("give the .yaml"));

    let absent = complaint("absent.yaml", format!("image: gone.pgm\n{YAML}").as_bytes());
    assert!(
        absent.contains("gone.pgm") && absent.contains("`image:`"),
        "{absent}"
    );
    file("short.pgm", &pgm(&pixels())[..300]);
    let short = load("short.yaml", format!("image: short.pgm\n{YAML}").as_bytes()).unwrap_err();
    assert!(matches!(short, HomeError::Truncated { .. }), "{short}");
    file("giant.pgm", b"P5 99999 99999 255\n");
    let giant = load("giant.yaml", format!("image: giant.pgm\n{YAML}").as_bytes()).unwrap_err();
    assert!(matches!(giant, HomeError::TooManyCells { .. }), "{giant}");
    file("text.pgm", b"P5 words\n");
    assert!(load("text.yaml", format!("image: text.pgm\n{YAML}").as_bytes()).is_err());
    let resolution = complaint("nan.yaml", b"image: short.pgm\nresolution: nan\n");
    assert!(resolution.contains("line 2"), "{resolution}");

    let cut = load("cut.json", &valetudo().as_bytes()[..400]).unwrap_err();
    assert!(matches!(cut, HomeError::Truncated { .. }), "{cut}");
    let other = complaint("other.json", br#"{"__class":"Else","pixelSize":5,"layers":[]}"#);
    assert!(other.contains("ValetudoMap"), "{other}");
    let future = valetudo().replace("\"version\":2", "\"version\":7");
    assert!(complaint("future.json", future.as_bytes()).contains("versions 1 and 2"));
    let far = valetudo().replace("[100,200,40,", "[100,200,4000000000,");
    assert!(complaint("far.json", far.as_bytes()).contains("beyond"));

    let unknown_key = format!("{HEAD}{}[[sofa]]\n", room(3.0, 3.0));
    let line = complaint("sofa.toml", unknown_key.as_bytes());
    assert!(line.contains("sofa") && line.contains("line 5"), "{line}");
    let line_room = format!("{HEAD}[[room]]\npolygon = [[0.0, 0.0], [1.0, 1.0]]\n");
    assert!(complaint("line.toml", line_room.as_bytes()).contains("3 to 1000 corners"));
    let giant_room = format!("{HEAD}{}", room(900.0, 900.0));
    assert!(complaint("giant.toml", giant_room.as_bytes()).contains("limit"));
    let no_room = format!("{HEAD}name = \"nothing\"\n");
    assert!(complaint("nothing.toml", no_room.as_bytes()).contains("no floor"));
    let narrow = format!("{HEAD}{}", room(3.0, 0.3));
    assert!(complaint("narrow.toml", narrow.as_bytes()).contains("0.150"));
    let walled_dock = format!(
        "{HEAD}{}[dock]\nposition = [3.0, 1.0]\nheading-deg = 0.0\n",
        room(3.0, 3.0)
    );
    assert!(complaint("walled-dock.toml", walled_dock.as_bytes()).contains("`dock`"));
}

#[test]
fn a_file_that_is_too_long_is_not_read() {
    let path = file("long.json", b"{");
    let long = std::fs::OpenOptions::new().write(true).open(&path).unwrap();
    long.set_len(17 << 20).unwrap();
    let error = Home::load(&path, &sr8730()).unwrap_err();
    assert!(matches!(error, HomeError::TooLong { .. }), "{error}");
}

#[test]
fn mutated_files_are_refused_or_loaded_but_never_panic() {
    file("seed.pgm", &pgm(&pixels()));
    file("seed.png", &png_of(SIZE, &pixels(), png::ColorType::Grayscale));
    let plan = format!(
        "{HEAD}{}[[furniture]]\nlegs = [[1.0, 1.0]]\n[[door]]\nfrom = [2.0, 1.0]\nto = [2.0, 2.0]\nstate = \"open\"\n[dock]\nposition = [0.0, 1.5]\nheading-deg = 0.0\n",
        room(3.0, 3.0)
    );
    let seeds: [(&str, Vec<u8>); 4] = [
        ("mutant.toml", plan.into_bytes()),
        ("mutant.json", valetudo().into_bytes()),
        ("mutant.yaml", format!("image: seed.pgm\n{YAML}").into_bytes()),
        (
            "mutant.png.yaml",
            format!("image: mutant.png\n{YAML}").into_bytes(),
        ),
    ];
    let png = png_of(SIZE, &pixels(), png::ColorType::Grayscale);
    let mut random = Pcg::new(2, 2);
    let (mut loaded, mut refused) = (0, 0);
    for (name, seed) in &seeds {
        for _ in 0..150 {
            if name.contains("png") {
                file("mutant.png", &mutate(&png, &mut random));
            }
            let bytes = if name.contains("png") {
                seed.clone()
            } else {
                mutate(seed, &mut random)
            };
            match load(name, &bytes) {
                Ok(_) => loaded += 1,
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().contains('\n'), "{error}");
                }
            }
        }
    }
    assert!(loaded > 10 && refused > 100, "{loaded} loaded, {refused} refused");
}

/// Flips, cuts, doubles or overwrites a few bytes.
pub(crate) fn mutate(seed: &[u8], random: &mut Pcg) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=random.below(3) {
        let place = random.below(bytes.len().max(1) as u32) as usize;
        match random.below(5) {
            0 => bytes.truncate(place),
            1 => bytes.extend_from_within(place..),
            2 => bytes.insert(
                place.min(bytes.len()),
                b"0123456789-.,[]{}\"="[random.below(19) as usize],
            ),
            _ => {
                if let Some(byte) = bytes.get_mut(place) {
                    *byte ^= 1 << random.below(8);
                }
            }
        }
    }
    bytes
}

#[test]
fn the_former_key_of_the_distance_per_count_is_read() {
    let text = include_str!("../../../../robots/samsung-sr8730/robot.toml");
    let former = text.replace("\ndistance-per-count =", "\ncount-way =");
    assert_ne!(former, text);
    let count_m = |text: &str| RobotModel::parse(text, "test.toml").unwrap().drive.count_m;
    assert_eq!(count_m(&former), count_m(text));
}

#[test]
fn robots_are_found_by_name_and_unknown_ones_named() {
    for name in robot_names() {
        let model = RobotModel::by_name(name).unwrap();
        assert_eq!(model.name, name);
    }
    let error = RobotModel::by_name("hal9000").unwrap_err().to_string();
    assert!(
        error.contains("hal9000") && error.contains("sr8730") && error.contains("relax"),
        "{error}"
    );
    let text = include_str!("../../../../robots/samsung-sr8730/robot.toml");
    let wrong_unit = text.replacen("unit = \"m\"", "unit = \"mm\"", 1);
    let error = RobotModel::parse(&wrong_unit, "test.toml")
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("test.toml") && error.contains("body.radius"),
        "{error}"
    );
    let cut = &text[..text.len() / 2];
    assert!(RobotModel::parse(cut, "test.toml").is_err());
}

#[test]
fn robot_files_load_and_wrong_ones_are_named() {
    let text = include_str!("../../../../robots/vileda-relax/robot.toml");
    let model = RobotModel::load(&file("relax.toml", text.as_bytes())).unwrap();
    assert_eq!(model, RobotModel::by_name("relax").unwrap());
    assert_eq!((model.gyro, model.cliffs.len(), model.wheel_drops), (None, 4, 1));

    let error = RobotModel::load("no/such/robot.toml".as_ref())
        .unwrap_err()
        .to_string();
    assert!(error.contains("no/such/robot.toml"), "{error}");
    let error = RobotModel::load(&file("long-robot.toml", &vec![b'#'; 300_000])).unwrap_err();
    assert!(error.to_string().contains("300000"), "{error}");
}

#[test]
fn mutated_robot_files_never_panic() {
    let text = include_str!("../../../../robots/samsung-sr8730/robot.toml");
    let mut random = Pcg::new(4, 4);
    let mut refused = 0;
    for _ in 0..300 {
        let mutant = mutate(text.as_bytes(), &mut random);
        let mutant = String::from_utf8_lossy(&mutant);
        if let Err(error) = RobotModel::parse(&mutant, "mutant.toml") {
            refused += 1;
            assert!(error.to_string().contains("mutant.toml"), "{error}");
        }
    }
    assert!(refused > 100, "{refused}");
}
