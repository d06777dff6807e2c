//! The home drawn with letters.

use rvac_api::{HomeView, Pose};

/// Widest picture, in letters.
const COLUMNS_MAX: u64 = 76;
/// Highest picture, in lines.
const LINES_MAX: u64 = 60;
/// Largest window that is drawn, in cells: more than any home has.
const CELLS_MAX: u64 = 1 << 24;

/// A letter is about twice as high as it is wide: so many cells go into one.
#[derive(Clone, Copy)]
struct Scale {
    across: u64,
    up: u64,
}

/// The home with the robot in it: `#` obstacle, `.` floor, `!` end of the floor, `x` not to be entered, digits for the rooms,
/// `D` dock, and the robot as an arrow. Nothing for a home that is unknown or malformed.
pub(super) fn picture(home: &HomeView, pose: Option<Pose>) -> String {
    let (width, height) = (u64::from(home.width), u64::from(home.height));
    if width == 0 || height == 0 || width * height > CELLS_MAX || home.cell_m.is_nan() || home.cell_m <= 0.0 {
        return String::new();
    }
    let across = width
        .div_ceil(COLUMNS_MAX)
        .max(height.div_ceil(2 * LINES_MAX))
        .max(1);
    let scale = Scale {
        across,
        up: 2 * across,
    };
    let columns = width.div_ceil(scale.across) as usize;
    let lines = height.div_ceil(scale.up) as usize;
    let mut letters = vec![b' '; columns * lines];
    draw_cells(home, scale, columns, &mut letters);
    let mut put = |x_m: f64, y_m: f64, letter: u8| {
        let column = (x_m / home.cell_m - f64::from(home.x)) / scale.across as f64;
        let line = (y_m / home.cell_m - f64::from(home.y)) / scale.up as f64;
        let is_inside = (0.0..columns as f64).contains(&column) && (0.0..lines as f64).contains(&line);
        if is_inside && let Some(place) = letters.get_mut(line as usize * columns + column as usize) {
            *place = letter;
        }
    };
    for room in &home.rooms {
        let name = room.id.to_string();
        for (place, digit) in name.bytes().enumerate() {
            put(
                room.x + place as f64 * scale.across as f64 * home.cell_m,
                room.y,
                digit,
            );
        }
    }
    if let Some(dock) = home.dock {
        put(dock.x, dock.y, b'D');
    }
    if let Some(pose) = pose {
        put(pose.x, pose.y, arrow(pose.heading));
    }
    // The lowest row of the map is the last line of the picture.
    let mut text = String::new();
    for line in letters.chunks_exact(columns).rev() {
        text += String::from_utf8_lossy(line).trim_end();
        text.push('\n');
    }
    text
}

fn draw_cells(home: &HomeView, scale: Scale, columns: usize, letters: &mut [u8]) {
    let (width, total) = (
        u64::from(home.width),
        u64::from(home.width) * u64::from(home.height),
    );
    let mut at = 0;
    for run in home.cells.chunks_exact(2) {
        let &[kind, length] = run else { continue };
        let end = (at + u64::from(length)).min(total);
        let letter = letter(kind);
        for cell in at..end {
            let (column, line) = (cell % width / scale.across, cell / width / scale.up);
            if let Some(place) = letters.get_mut(line as usize * columns + column as usize)
                && weight(letter) > weight(*place)
            {
                *place = letter;
            }
        }
        at = end;
    }
}

fn letter(kind: u32) -> u8 {
    match kind {
        1 => b'.',
        2 => b'#',
        3 => b'!',
        4 => b'x',
        _ => b' ',
    }
}

/// What wins when several cells share a letter.
fn weight(letter: u8) -> u8 {
    match letter {
        b'!' => 4,
        b'#' => 3,
        b'x' => 2,
        b'.' => 1,
        _ => 0,
    }
}

fn arrow(heading_rad: f64) -> u8 {
    let quarter = (heading_rad / core::f64::consts::FRAC_PI_2)
        .round()
        .rem_euclid(4.0);
    match quarter as u8 {
        0 => b'>',
        1 => b'^',
        2 => b'<',
        _ => b'v',
    }
}

#[cfg(test)]
mod tests {
    use super::picture;
    use rvac_api::{HomeView, Pose, RoomView};

    fn home(width: u32, height: u32, cells: Vec<u32>) -> HomeView {
        HomeView {
            cell_m: 0.5,
            width,
            height,
            cells,
            ..HomeView::default()
        }
    }

    #[test]
    fn walls_floor_room_and_robot_stand_where_they_are() {
        let mut home = home(5, 4, vec![2, 5, 2, 1, 1, 3, 2, 1, 2, 1, 1, 3, 2, 1, 2, 5]);
        home.rooms = vec![RoomView {
            id: 7,
            area_m2: 1.5,
            x: 0.75,
            y: 0.75,
            name: None,
            settings: None,
        }];
        let robot = Pose {
            x: 1.75,
            y: 1.25,
            heading: 1.6,
            t: 0.0,
        };
        // Two rows of cells share a line, and an obstacle wins over floor.
        assert_eq!(picture(&home, Some(robot)), "###^#\n#7###\n");
    }

    #[test]
    fn a_large_home_becomes_a_small_picture_and_a_strange_one_does_no_harm() {
        let text = picture(&home(2_000, 1_000, vec![1, 2_000_000]), None);
        assert!(text.lines().count() <= 60 && text.lines().all(|line| line.len() <= 76));
        for strange in [
            home(0, 0, vec![1, 5]),
            home(u32::MAX, u32::MAX, vec![1, u32::MAX]),
            HomeView {
                cell_m: f64::NAN,
                ..home(2, 2, vec![1])
            },
        ] {
            assert_eq!(picture(&strange, None), "");
        }
        let short = picture(&home(2, 2, vec![1, u32::MAX, 2]), Some(Pose::default()));
        assert_eq!(short, ">.\n");
    }
}
