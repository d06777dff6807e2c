//! Colours of the map in both looks.

use panel_logic::PlanPalette;

use crate::theme::Theme;

/// Red, green, blue, 0..=1.
pub(crate) type Rgb = [f32; 3];

/// Colours of the map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Palette {
    pub(crate) outside: Rgb,
    pub(crate) grid: Rgb,
    pub(crate) swept: Rgb,
    pub(crate) path: Rgb,
    pub(crate) mark: Rgb,
    pub(crate) body: Rgb,
    pub(crate) front: Rgb,
    pub(crate) halo: Rgb,
    /// Walls that the robot is sure of.
    pub(crate) wall: Rgb,
    /// Where raised walls are cut off, and their sides.
    pub(crate) wall_top: Rgb,
    pub(crate) wall_side: Rgb,
    /// The way it means to drive, and how far it may be from where it believes to be.
    pub(crate) thought: Rgb,
    /// Borders of what a person wants cleaned, and of where the robot must not go.
    pub(crate) wanted: Rgb,
    pub(crate) forbidden: Rgb,
    pub(crate) plan: PlanPalette,
}

const fn rgb(hex: u32) -> Rgb {
    let [_, red, green, blue] = hex.to_be_bytes();
    [red as f32 / 255.0, green as f32 / 255.0, blue as f32 / 255.0]
}

const fn bytes(hex: u32) -> [u8; 3] {
    let [_, red, green, blue] = hex.to_be_bytes();
    [red, green, blue]
}

const LIGHT: Palette = Palette {
    outside: rgb(0xe9_ed_f1),
    grid: rgb(0xdd_e3_e9),
    swept: rgb(0x9f_dc_d2),
    path: rgb(0x0f_76_6e),
    mark: rgb(0xb4_53_09),
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
        obstacle: bytes(0x8a_96_a6),
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

const DARK: Palette = Palette {
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
        obstacle: bytes(0x59_68_7b),
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

impl Palette {
    /// The colours of a look.
    pub(crate) const fn of(theme: Theme) -> Self {
        match theme {
            Theme::Light => LIGHT,
            Theme::Dark => DARK,
        }
    }
}
