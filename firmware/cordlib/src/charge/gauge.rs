//! How much charge is left, from the voltage.

use rvac_units::Ratio;

/// Millivolts of one cell and the charge in thousandths: a resting NiMH cell at room temperature. The same curve up and
/// down, so that the end points agree.
const CURVE: [(i32, i32); 8] = [
    (1_000, 0),
    (1_190, 100),
    (1_220, 200),
    (1_245, 400),
    (1_265, 600),
    (1_300, 800),
    (1_335, 900),
    (1_400, 1_000),
];

/// Charge of a pack of `cells` cells that rests at `pack_mv`.
pub(crate) fn charge_of(pack_mv: i32, cells: u8) -> Ratio {
    let cell_mv = pack_mv / i32::from(cells.max(1));
    let mut below = (0, 0);
    let mut thousandths = 1_000;
    for above in CURVE {
        if cell_mv < above.0 {
            let span_mv = above.0.saturating_sub(below.0).max(1);
            let rise = above.1.saturating_sub(below.1);
            thousandths = below
                .1
                .saturating_add(cell_mv.saturating_sub(below.0).max(0).saturating_mul(rise) / span_mv);
            break;
        }
        below = above;
    }
    Ratio::from_millionths(thousandths.saturating_mul(1_000)).unwrap_or_default()
}
