//! Homes as other programs write them: what loads, what is told of it, and the sentence of each refusal.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use home::{Home, HomeNotice};

use crate::loaders::{FLOOR_M2, YAML, check_area, complaint, load, pgm, pixels, png_of, valetudo};
use crate::scene::{file, sr8730};

/// Loads a YAML whose image is the usual one.
fn load_yaml(name: &str, yaml: &str) -> Home {
    file("usual.pgm", &pgm(&pixels()));
    load(name, yaml.as_bytes()).unwrap()
}

#[test]
fn yaml_of_every_writer_loads() {
    let spellings = [
        ("plain", format!("image: usual.pgm\n{YAML}")),
        (
            "windows",
            format!("image: usual.pgm\n{YAML}").replace('\n', "\r\n"),
        ),
        ("mark", format!("\u{feff}image: usual.pgm\n{YAML}")),
        (
            "document",
            format!("%YAML 1.2\n---\nimage: usual.pgm\n{YAML}...\n"),
        ),
        (
            "quoted keys",
            format!("'image': \"usual.pgm\"\n{}", YAML.replace("negate", "\"negate\"")),
        ),
        (
            "two lines",
            format!(
                "image: usual.pgm\n{}",
                YAML.replace("-1.0, -2.0,", "-1.0,\n    -2.0,")
            ),
        ),
        (
            "braces",
            format!("{{image: usual.pgm, {}}}", YAML.trim().replace('\n', ", ")),
        ),
        (
            "mode",
            format!("mode: trinary\nimage: usual.pgm # as saved\n{YAML}"),
        ),
        (
            "truth",
            format!("image: usual.pgm\n{}", YAML.replace("negate: 0", "negate: No")),
        ),
        (
            "quoted number",
            format!("image: usual.pgm\n{}", YAML.replace("0.65", "'0.65'")),
        ),
        (
            "other keys",
            format!("image: usual.pgm\n{YAML}extra: {{a: [1, {{b: c}}]}}\n"),
        ),
    ];
    for (name, yaml) in spellings {
        let home = load_yaml(&format!("{name}.yaml"), &yaml);
        check_area(home.free_area_m2(), FLOOR_M2);
        assert!((home.file_from_plan().x_m + 1.0).abs() < 0.2, "{name}");
        assert_eq!(home.notices(), [], "{name}");
    }
}

#[test]
fn images_are_found_where_writers_mean_them() {
    let image = file("it's #1.pgm", &pgm(&pixels()));
    let address = format!("image: \"file://{}\"\n{YAML}", image.display());
    check_area(load_yaml("address.yaml", &address).free_area_m2(), FLOOR_M2);
    let hash = format!("image: 'it''s #1.pgm'\n{YAML}");
    check_area(load_yaml("hash.yaml", &hash).free_area_m2(), FLOOR_M2);

    let twice = load_yaml("twice.yaml", &format!("image: maps/usual.pgm\n{YAML}"));
    check_area(twice.free_area_m2(), FLOOR_M2);
    let [notice @ HomeNotice::ImageBeside { .. }] = twice.notices() else {
        panic!("{:?}", twice.notices());
    };
    let text = notice.to_string();
    assert!(
        text.contains("maps/usual.pgm") && text.contains("twice.yaml"),
        "{text}"
    );

    // Addresses write spaces as `%20`, and other systems part folders otherwise.
    let spaced = image.with_file_name("usual plan.pgm");
    std::fs::copy(&image, &spaced).unwrap();
    let address = format!("file://localhost{}", spaced.display()).replace(' ', "%20");
    let localhost = load_yaml("localhost.yaml", &format!("image: \"{address}\"\n{YAML}"));
    check_area(localhost.free_area_m2(), FLOOR_M2);
    assert_eq!(localhost.notices(), []);
    for elsewhere in ["C:\\maps\\usual.pgm", "maps\\usual.pgm"] {
        let home = load_yaml("windows-path.yaml", &format!("image: {elsewhere}\n{YAML}"));
        check_area(home.free_area_m2(), FLOOR_M2);
        assert!(
            matches!(home.notices(), [HomeNotice::ImageBeside { .. }]),
            "{elsewhere}"
        );
    }

    let home = complaint(
        "tilde.yaml",
        format!("image: ~/no such folder/x.pgm\n{YAML}").as_bytes(),
    );
    assert!(
        home.contains("/no such folder/x.pgm") && !home.contains('~'),
        "{home}"
    );
    assert!(!home.contains("os error"), "{home}");
}

/// What stands in a sound file, what stands there instead, and what the complaint must say.
const WRONG_KEYS: [(&str, &str, [&str; 2]); 18] = [
    (
        "negate: 0",
        "Negate: 0",
        ["`Negate` is in line 4", "small letters"],
    ),
    ("negate: 0", "\tnegate: 0", ["line 4", "instead of the tab"]),
    ("negate: 0", "negate:\t[0", ["line 5 or the one before", "write"]),
    ("negate: 0", "negate:", ["`negate` in line 4", "no value"]),
    ("negate: 0", "negate: ~", ["`negate`", "write `negate: 0`"]),
    (
        "negate: 0",
        "negate: perhaps",
        ["`negate` in line 4", "`perhaps`"],
    ),
    ("negate: 0\n", "", ["`negate`", "missing"]),
    (
        "free_thresh: 0.196",
        "free_thresh",
        ["line 7 or the one before", "write one `key: value`"],
    ),
    (
        "free_thresh: 0.196",
        "free_thresh: 19,6",
        ["`free_thresh`", "`19,6`"],
    ),
    (
        "free_thresh: 0.196",
        "free_thresh: .nan",
        ["`free_thresh`", "`.nan`"],
    ),
    (
        "origin: [-1.0, -2.0, 0.0]",
        "origin: [-1.0, -2.0]",
        ["`origin` in line 3", "write three"],
    ),
    (
        "origin: [-1.0, -2.0, 0.0]",
        "origin: [[1], 2, 3]",
        ["`origin`", "[0.0, 0.0, 0.0]"],
    ),
    (
        "origin: [-1.0, -2.0, 0.0]",
        "origin: -1.0 -2.0 0.0",
        ["`origin`", "no list"],
    ),
    (
        "origin: [-1.0, -2.0, 0.0]",
        "origin: *place",
        ["line 3", "anchor"],
    ),
    (
        "negate: 0",
        "negate: 0\nnegate: 1",
        ["`negate` in line 5", "twice"],
    ),
    (
        "negate: 0",
        "negate: 0\nmode: gray",
        ["`mode` in line 5", "`gray`"],
    ),
    (
        "resolution: 0.05",
        "resolution: [0.05]",
        ["`resolution`", "write one value"],
    ),
    ("resolution: 0.05", "resolution: 5", ["`resolution`", "metres"]),
];

#[test]
fn each_wrong_key_is_named_with_its_line_and_remedy() {
    file("usual.pgm", &pgm(&pixels()));
    for (right, written, said) in WRONG_KEYS {
        let yaml = format!("image: usual.pgm\n{}", YAML.replace(right, written));
        let text = complaint("wrong.yaml", yaml.as_bytes());
        for part in said {
            assert!(text.contains(part), "{written}: {text}");
        }
    }
    let empty = complaint("bare.yaml", format!("image:\n{YAML}").as_bytes());
    assert!(empty.contains("`image`") && empty.contains("map.pgm"), "{empty}");
    let list = complaint("list.yaml", b"- image: a\n- resolution: b\n");
    assert!(list.contains("no keys"), "{list}");
}

#[test]
fn a_picture_of_another_kind_is_named_with_what_it_is() {
    let kinds: [(&[u8], &str); 8] = [
        (b"\xff\xd8\xff\xe0rest", "JPEG"),
        (b"BMrest", "BMP"),
        (b"GIF89a", "GIF"),
        (b"P6 2 2 255\n000000000000", "PPM"),
        (b"P1 2 2\n0 0 0 0", "PBM"),
        (b"\x1f\x8b\x08rest", "gzip; unpack it"),
        (b"", "empty"),
        (b"letter", "of no kind"),
    ];
    for (bytes, said) in kinds {
        file("kind.pgm", bytes);
        let text = load("kind.yaml", format!("image: kind.pgm\n{YAML}").as_bytes())
            .unwrap_err()
            .to_string();
        let said: Vec<&str> = said.split("; ").collect();
        assert!(
            text.contains("kind.pgm") && said.iter().all(|part| text.contains(part)),
            "{text}"
        );
    }
    assert!(complaint("packed.home", b"PK\x03\x04rest").contains("zip"));
}

#[test]
fn pgm_headers_of_every_writer_load() {
    let headers = [
        "P5\r\n40 20\r\n255\r\n",
        "P5\r40 20\r255\r",
        "P5 # by hand\n40 # wide\n20\n# white\n255\n",
        "P5\n40 20\n255 # here as well\n",
        "P5\n40 20\n255\n# and here\n",
        "P5\r\n# made elsewhere\r\n40 20\r\n255\r\n",
        "P5#close\n40#w\n20#h\n255\n",
    ];
    for header in headers {
        let mut bytes = header.as_bytes().to_vec();
        bytes.extend(pixels());
        file("header.pgm", &bytes);
        let home = load("header.yaml", format!("image: header.pgm\n{YAML}").as_bytes())
            .unwrap_or_else(|error| panic!("{header:?}: {error}"));
        check_area(home.free_area_m2(), FLOOR_M2);
        let (x_m, y_m) = home.file_from_plan().inverse().point(-1.0 + 0.15, -2.0 + 0.15);
        assert_eq!(
            home.grid().at(x_m, y_m),
            home::Cell::Obstacle,
            "{header:?}: not shifted"
        );
    }
    // A picture whose first pixel is as a line feed or a hash is no longer header.
    for first in [b'\n', b'#'] {
        let mut grey = pixels();
        grey[0] = first;
        let mut bytes = b"P5 40 20 255\r".to_vec();
        bytes.extend(grey);
        file("first.pgm", &bytes);
        let home = load("first.yaml", format!("image: first.pgm\n{YAML}").as_bytes()).unwrap();
        check_area(home.free_area_m2(), FLOOR_M2);
    }
}

/// What is told of a map of these pixels and this YAML.
fn told(name: &str, grey: &[u8], yaml: &str) -> Vec<String> {
    let image = format!("{name}.pgm");
    file(&image, &pgm(grey));
    let home = load(
        &format!("{name}.yaml"),
        format!("image: {image}\n{yaml}").as_bytes(),
    )
    .unwrap();
    let told: Vec<String> = home.notices().iter().map(ToString::to_string).collect();
    assert!(
        told.iter()
            .all(|text| text.contains(name) && !text.contains('\n')),
        "{told:?}"
    );
    told
}

#[test]
fn what_a_file_may_mean_otherwise_is_told() {
    let nav2 = YAML.replace("0.196", "0.25");
    let grey = told("nav2", &pixels(), &nav2).join("; ");
    assert!(
        grey.contains("free_thresh: 0.25") && grey.contains("1.7 m2 of floor instead of 1.4 m2"),
        "{grey}"
    );
    assert!(grey.contains("% of the edge"), "floor without walls: {grey}");

    // A saver's 205 is half-way between the thresholds of `scale`, and so floor.
    let scale = told("scale", &pixels(), &format!("{YAML}mode: scale\n")).join("; ");
    assert!(
        scale.contains("`mode: scale`") && scale.contains("write `mode: trinary`"),
        "{scale}"
    );

    // With `negate: 1` the walls are floor.
    file("negated.pgm", &pgm(&pixels()));
    let negated = YAML.replace("negate: 0", "negate: 1");
    let negated = complaint(
        "negated.yaml",
        format!("image: negated.pgm\n{negated}").as_bytes(),
    );
    assert!(
        negated.contains("no place") && negated.contains("write `negate: 0`"),
        "{negated}"
    );

    // Floor of 254 is unknown in raw mode and walls are floor: no robot fits, and the refusal says why.
    file("raw.pgm", &pgm(&pixels()));
    let raw = complaint(
        "raw.yaml",
        format!("image: raw.pgm\nmode: raw\n{YAML}").as_bytes(),
    );
    assert!(
        raw.contains("no place") && raw.contains("write `mode: trinary`"),
        "{raw}"
    );

    let negated: Vec<u8> = pixels().iter().map(|grey| 254 - grey).collect();
    let outside: Vec<u8> = negated
        .iter()
        .map(|grey| if *grey == 49 { 254 } else { *grey })
        .collect();
    file("swapped.pgm", &pgm(&outside));
    let swapped = complaint("swapped.yaml", format!("image: swapped.pgm\n{YAML}").as_bytes());
    assert!(
        swapped.contains("100 % of the edge") && swapped.contains("negate"),
        "{swapped}"
    );

    let blank = vec![205; 40 * 20];
    file("blank.pgm", &pgm(&blank));
    let refused = complaint("blank.yaml", format!("image: blank.pgm\n{YAML}").as_bytes());
    assert!(
        refused.contains("100.0 %") && refused.contains("grey 205") && refused.contains("free_thresh"),
        "{refused}"
    );
}

/// A picture of so many pixels with the usual one in its lower left corner.
fn wide_picture(width: usize, height: usize, grey: u8) -> Vec<u8> {
    let mut bytes = vec![grey; width * height];
    for (row, line) in pixels().chunks_exact(40).enumerate() {
        let start = (height - 20 + row) * width;
        bytes[start..start + 40].copy_from_slice(line);
    }
    bytes
}

#[test]
fn a_stray_pixel_far_away_is_left_out_and_told() {
    let (width, height) = (6_000, 400);
    let mut grey = wide_picture(width, height, 205);
    grey[5_990] = 254;
    let mut bytes = format!("P5 {width} {height} 255\n").into_bytes();
    bytes.extend(&grey);
    file("stray.pgm", &bytes);
    let home = load("stray.yaml", format!("image: stray.pgm\n{YAML}").as_bytes()).unwrap();
    check_area(home.free_area_m2(), FLOOR_M2);
    assert!(home.grid().width < 200, "{}", home.grid().width);
    let told: Vec<String> = home.notices().iter().map(ToString::to_string).collect();
    let told = told.join("; ");
    assert!(
        told.contains("1 crumbs of floor") && told.contains("298 m"),
        "{told}"
    );
    assert!(told.contains("grey 205"), "nearly all of it is one grey: {told}");
}

#[test]
fn packed_homes_load() {
    let json = valetudo();
    let usual_m2 = load("plain.json", json.as_bytes()).unwrap().free_area_m2();
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    gzip.write_all(json.as_bytes()).unwrap();
    let gzip = gzip.finish().unwrap();
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::default());
    zlib.write_all(json.as_bytes()).unwrap();
    let zlib = zlib.finish().unwrap();
    let picture = png_of(crate::loaders::SIZE, &pixels(), png::ColorType::Grayscale);
    let mut carrier = picture[..picture.len() - 12].to_vec();
    let chunk = [b"ValetudoMap\0\0".as_slice(), &zlib].concat();
    carrier.extend((chunk.len() as u32).to_be_bytes());
    carrier.extend(
        [
            b"zTXt".as_slice(),
            &chunk,
            &[0; 4],
            &picture[picture.len() - 12..],
        ]
        .concat(),
    );
    for (name, bytes) in [("map.gz", &gzip), ("map.zlib", &zlib), ("map.png", &carrier)] {
        check_area(load(name, bytes).unwrap().free_area_m2(), usual_m2);
    }
    assert!(complaint("cut.gz", &gzip[..gzip.len() / 2]).contains("cut off"));
    let mut bomb = GzEncoder::new(Vec::new(), Compression::best());
    bomb.write_all(&vec![b' '; 17 << 20]).unwrap();
    assert!(complaint("bomb.gz", &bomb.finish().unwrap()).contains("limit"));
    assert!(complaint("utf16.yaml", b"\xff\xfei\0m\0").contains("UTF-8"));
    assert!(
        Home::load(
            &file("mark.json", ["\u{feff}", &json].concat().as_bytes()),
            &sr8730()
        )
        .is_ok()
    );
}
