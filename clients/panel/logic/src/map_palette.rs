//! Colours of the map in both themes. What is drawn as lines and marks, and walls and furniture, differ visibly from every floor that lies
//! beside it by people who see little contrast. Tints of the floor are only tints.

use crate::plan::PlanPalette;

/// Red, green, blue, 0..=1.
pub type Rgb = [f32; 3];

/// Colours of the map.
#[derive(Clone, Copy, Debug)]
pub struct MapPalette {
    /// Where nothing is known.
    pub outside: Rgb,
    /// The lines of the metres there.
    pub grid: Rgb,
    /// Swept floor.
    pub swept: Rgb,
    /// The driven path.
    pub path: Rgb,
    /// Contacts and cliffs.
    pub mark: Rgb,
    /// The robot.
    pub body: Rgb,
    /// Its front.
    pub front: Rgb,
    /// Around it.
    pub halo: Rgb,
    /// Walls that the robot is sure of.
    pub wall: Rgb,
    /// Where raised walls are cut off.
    pub wall_top: Rgb,
    /// Their sides.
    pub wall_side: Rgb,
    /// The planned path, and the uncertainty of the position.
    pub thought: Rgb,
    /// Borders of what a person chose for cleaning.
    pub wanted: Rgb,
    /// Borders of where it must not go.
    pub forbidden: Rgb,
    /// Floor and the things on it.
    pub plan: PlanPalette,
}

const fn rgb(hex: u32) -> Rgb {
    let [_, red, green, blue] = hex.to_be_bytes();
    [red as f32 / 255.0, green as f32 / 255.0, blue as f32 / 255.0]
}

const fn bytes(hex: u32) -> [u8; 3] {
    let [_, red, green, blue] = hex.to_be_bytes();
    [red, green, blue]
}

const LIGHT: MapPalette = MapPalette {
    outside: rgb(0xe9_ed_f1),
    grid: rgb(0xdd_e3_e9),
    swept: rgb(0x9f_dc_d2),
    path: rgb(0x0f_76_6e),
    mark: rgb(0xa8_4c_07),
    body: rgb(0x14_21_3a),
    front: rgb(0x4c_c9_ad),
    halo: rgb(0xff_ff_ff),
    wall: rgb(0x14_21_3a),
    wall_top: rgb(0x6b_79_8d),
    wall_side: rgb(0xd5_dc_e5),
    thought: rgb(0x6d_4a_c9),
    wanted: rgb(0x1d_4e_d8),
    forbidden: rgb(0xb4_23_18),
    plan: PlanPalette {
        floor: bytes(0xff_ff_ff),
        obstacle: bytes(0x7a_87_97),
        cliff: bytes(0xf0_cf_c2),
        rug: bytes(0xf1_ec_e1),
        unsure: bytes(0xd9_cd_f3),
        no_go: bytes(0xf0_b9_b9),
        chosen: bytes(0xa8_cf_fb),
        rooms: [
            bytes(0xe9_f1_fc),
            bytes(0xfd_f1_e4),
            bytes(0xf1_ec_fb),
            bytes(0xfb_f7_de),
            bytes(0xfb_ea_f0),
            bytes(0xea_f2_ea),
        ],
    },
};

const DARK: MapPalette = MapPalette {
    outside: rgb(0x0e_13_1a),
    grid: rgb(0x16_1d_27),
    swept: rgb(0x1d_5a_57),
    path: rgb(0x5e_ea_d4),
    mark: rgb(0xfb_bf_24),
    body: rgb(0xee_f3_f8),
    front: rgb(0x0f_9d_8a),
    halo: rgb(0x0e_13_1a),
    wall: rgb(0xc9_d4_e0),
    wall_top: rgb(0x8b_9c_b2),
    wall_side: rgb(0x46_55_69),
    thought: rgb(0xb7_9c_ff),
    wanted: rgb(0x7c_b4_ff),
    forbidden: rgb(0xff_8f_85),
    plan: PlanPalette {
        floor: bytes(0x1f_29_36),
        obstacle: bytes(0x74_84_9a),
        cliff: bytes(0x53_34_2c),
        rug: bytes(0x28_31_3b),
        unsure: bytes(0x3c_33_63),
        no_go: bytes(0x6b_30_38),
        chosen: bytes(0x2a_56_8c),
        rooms: [
            bytes(0x1f_2d_42),
            bytes(0x35_2d_28),
            bytes(0x2b_29_42),
            bytes(0x32_30_25),
            bytes(0x36_29_33),
            bytes(0x24_32_2c),
        ],
    },
};

impl MapPalette {
    /// On light paper.
    pub const LIGHT: Self = LIGHT;
    /// In the dark.
    pub const DARK: Self = DARK;
}

#[cfg(test)]
mod tests {
    use super::MapPalette;

    /// What lines, marks and borders need beside what they lie on, and text of the usual size (WCAG 2.2, 1.4.11 and 1.4.3).
    const GRAPHICS_MIN: f64 = 3.0;
    const TEXT_MIN: f64 = 4.5;

    /// The page's own colours: `--name: light-dark(#light, #dark)`.
    const STYLE: &str = include_str!("../../static/panel.css");

    type Colour = [f64; 3];

    /// Relative luminance of an sRGB colour, as WCAG 2.2 defines it.
    fn luminance(colour: Colour) -> f64 {
        let linear = |share: f64| {
            if share <= 0.04045 {
                share / 12.92
            } else {
                ((share + 0.055) / 1.055).powf(2.4)
            }
        };
        let [red, green, blue] = colour.map(linear);
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    }

    fn contrast(one: Colour, other: Colour) -> f64 {
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    fn of_shares(colour: [f32; 3]) -> Colour {
        colour.map(f64::from)
    }

    fn of_bytes(colour: [u8; 3]) -> Colour {
        colour.map(|byte| f64::from(byte) / 255.0)
    }

    #[test]
    fn a_ratio_is_that_of_the_standard() {
        let (black, white) = ([0.0; 3], [1.0; 3]);
        assert!((contrast(black, white) - 21.0).abs() < 1e-9);
        assert!((contrast(of_bytes([0x77; 3]), white) - 4.478).abs() < 0.001);
    }

    #[test]
    fn lines_and_marks_are_told_from_every_floor_and_furniture_from_floor() {
        for (look, palette) in [("light", MapPalette::LIGHT), ("dark", MapPalette::DARK)] {
            let plan = palette.plan;
            let floors = [plan.floor, plan.rug].into_iter().chain(plan.rooms);
            let carpets = floors.clone().map(|floor| of_bytes(plan.carpeted(floor)));
            let bare = floors.map(of_bytes);
            let tinted: Vec<Colour> = [plan.unsure, plan.no_go, plan.chosen]
                .map(of_bytes)
                .into_iter()
                .chain(carpets)
                .collect();
            let open = [palette.outside, palette.swept].map(of_shares);
            let grounds: Vec<Colour> = bare.clone().chain(tinted).chain(open).collect();
            let drawn = [
                ("path", palette.path),
                ("bump", palette.mark),
                ("robot", palette.body),
                ("wall", palette.wall),
                ("planned way", palette.thought),
                ("zone", palette.wanted),
                ("no-go zone", palette.forbidden),
            ];
            for (name, colour) in drawn {
                for ground in &grounds {
                    let ratio = contrast(of_shares(colour), *ground);
                    assert!(ratio >= GRAPHICS_MIN, "{look}: {name} on {ground:?}: {ratio:.2}");
                }
            }
            for floor in bare {
                let ratio = contrast(of_bytes(plan.obstacle), floor);
                assert!(
                    ratio >= GRAPHICS_MIN,
                    "{look}: furniture on {floor:?}: {ratio:.2}"
                );
            }
        }
    }

    /// A colour of the page in both themes.
    fn page_colours(name: &str) -> [Colour; 2] {
        let begin = format!("--{name}: light-dark(#");
        let (_, behind) = STYLE.split_once(&begin).expect("is a colour of the page");
        let (light, behind) = behind.split_once(", #").expect("comes in pairs");
        let (dark, _) = behind.split_once(')').expect("ends");
        [light, dark].map(|hex| {
            let hex = u32::from_str_radix(hex, 16).expect("is hexadecimal");
            let [_, red, green, blue] = hex.to_be_bytes();
            of_bytes([red, green, blue])
        })
    }

    #[test]
    fn texts_and_edges_of_the_page_are_told_from_what_they_lie_on() {
        let grounds = ["page", "sheet", "sunk", "accent-wash", "alarm-wash"];
        let on_grounds = [
            ("ink", TEXT_MIN),
            ("soft", TEXT_MIN),
            ("accent", TEXT_MIN),
            ("alarm", TEXT_MIN),
            ("edge", GRAPHICS_MIN),
        ];
        let pairs = on_grounds
            .iter()
            .flat_map(|(name, least)| grounds.map(|ground| (*name, ground, *least)))
            .chain([("on-accent", "accent", TEXT_MIN), ("page", "ink", TEXT_MIN)]);
        for (name, ground, least) in pairs {
            let (colours, grounds) = (page_colours(name), page_colours(ground));
            for (colour, beneath) in colours.into_iter().zip(grounds) {
                let ratio = contrast(colour, beneath);
                assert!(ratio >= least, "{name} on {ground}: {ratio:.2}");
            }
        }
    }
}
