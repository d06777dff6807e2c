//! The map as a picture: PNG with a palette, so that it is small and drawn in a moment on a board.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rvac_api::HomeView;

use crate::rle::cells;
use crate::{Knowledge, rle};

/// Longest side of a picture in pixels.
const SIDE_MAX: usize = 640;
/// Border around what is drawn, cells.
const BORDER_CELLS: i32 = 2;

/// Places in the palette.
mod paint {
    pub(super) const NOTHING: u8 = 0;
    pub(super) const FLOOR: u8 = 1;
    pub(super) const WALL: u8 = 2;
    pub(super) const EDGE: u8 = 3;
    pub(super) const SWEPT: u8 = 4;
    pub(super) const PATH: u8 = 5;
    pub(super) const DOCK: u8 = 6;
    pub(super) const ROBOT: u8 = 7;
    pub(super) const NO_GO: u8 = 8;
    /// The first of the rooms' colours.
    pub(super) const ROOM: u8 = 9;
    pub(super) const ROOMS: u8 = 6;
}

/// Red, green, blue. Light colours that differ for people who see red and green alike.
const PALETTE: [[u8; 3]; 15] = [
    [0xff, 0xff, 0xff],
    [0xdd, 0xe3, 0xe8],
    [0x3a, 0x3f, 0x46],
    [0x7a, 0x50, 0x2a],
    [0x7f, 0xb2, 0xe5],
    [0x1d, 0x4e, 0x89],
    [0x2a, 0x9d, 0x4a],
    [0xe0, 0x7a, 0x1f],
    [0xe5, 0xa3, 0xa3],
    [0xcf, 0xe0, 0xf2],
    [0xf2, 0xe6, 0xc4],
    [0xd8, 0xec, 0xd5],
    [0xe6, 0xd9, 0xee],
    [0xf3, 0xd9, 0xd2],
    [0xd2, 0xea, 0xea],
];

/// A further chunk of a PNG file, before its end.
#[derive(Clone, Copy, Debug)]
pub struct Chunk<'a> {
    /// Its type, four letters.
    pub kind: [u8; 4],
    /// Its content.
    pub data: &'a [u8],
}

/// A window of cells, and what is painted there.
#[derive(Debug)]
struct Canvas {
    cell_m: f64,
    x: i32,
    y: i32,
    width: usize,
    height: usize,
    /// Rows from the lowest y.
    pixels: Vec<u8>,
}

/// The map as a PNG file with these chunks beside its own; `None` while nothing is known of the home.
#[must_use]
pub fn png(known: &Knowledge, more: &[Chunk<'_>]) -> Option<Vec<u8>> {
    let canvas = draw(known)?;
    Some(encode(&canvas.shrunk(), more))
}

fn draw(known: &Knowledge) -> Option<Canvas> {
    let mut canvas = Canvas::around(known)?;
    if let Some(home) = &known.home {
        canvas.paint_home(home);
    }
    let ratio = known.map.cell_m / canvas.cell_m;
    for pair in known.map.swept.chunks_exact(2) {
        if let [x, y] = pair {
            canvas.paint_swept(f64::from(*x) * ratio, f64::from(*y) * ratio, ratio);
        }
    }
    for corners in known.map.path_mm.windows(4).step_by(2) {
        if let [x0, y0, x1, y1] = corners {
            let metres = |mm: &i32| f64::from(*mm) / 1e3;
            canvas.paint_line([metres(x0), metres(y0)], [metres(x1), metres(y1)]);
        }
    }
    if let Some(dock) = known.home.as_ref().and_then(|home| home.dock) {
        canvas.paint_disc(dock.x, dock.y, (0.12, paint::DOCK));
    }
    if let Some(place) = known.place() {
        let radius_m = known.robot.as_ref().map_or(0.17, |robot| robot.radius_m);
        canvas.paint_disc(place.x, place.y, (radius_m, paint::ROBOT));
    }
    Some(canvas)
}

impl Canvas {
    /// A window around all that is known.
    fn around(known: &Knowledge) -> Option<Self> {
        let home = known
            .home
            .as_ref()
            .filter(|home| home.width > 0 && home.height > 0);
        let (cell_m, low, high) = match home {
            Some(home) => {
                let high_x = home.x.checked_add(i32::try_from(home.width).ok()?)?;
                let high_y = home.y.checked_add(i32::try_from(home.height).ok()?)?;
                (home.cell_m, [home.x, home.y], [high_x, high_y])
            }
            None => {
                let (low, high) = borders(&known.map.swept)?;
                (known.map.cell_m, low, high)
            }
        };
        let side = |low: i32, high: i32| {
            let cells = high.checked_sub(low)?.checked_add(2 * BORDER_CELLS)?;
            usize::try_from(cells).ok().filter(|cells| *cells <= 1 << 13)
        };
        let (width, height) = (side(low[0], high[0])?, side(low[1], high[1])?);
        (cell_m > 0.0).then(|| Self {
            cell_m,
            x: low[0] - BORDER_CELLS,
            y: low[1] - BORDER_CELLS,
            width,
            height,
            pixels: vec![paint::NOTHING; width * height],
        })
    }

    fn pixel(&mut self, x: i32, y: i32) -> Option<&mut u8> {
        let column = usize::try_from(x.checked_sub(self.x)?).ok()?;
        let row = usize::try_from(y.checked_sub(self.y)?).ok()?;
        if column >= self.width {
            return None;
        }
        self.pixels.get_mut(row * self.width + column)
    }

    fn paint_home(&mut self, home: &HomeView) {
        let count = home.width as usize * home.height as usize;
        let rooms = rle::cells(&home.room_cells, count).chain(std::iter::repeat(0));
        for (index, (kind, room)) in cells(&home.cells, count).zip(rooms).enumerate() {
            let (column, row) = (index % home.width as usize, index / home.width as usize);
            let paint = match (kind, room) {
                (1, 0) => paint::FLOOR,
                (1, room) => paint::ROOM + u8::try_from(room % u32::from(paint::ROOMS)).unwrap_or(0),
                (2, _) => paint::WALL,
                (3, _) => paint::EDGE,
                (4, _) => paint::NO_GO,
                _ => continue,
            };
            let place = (i32::try_from(column), i32::try_from(row));
            if let (Ok(column), Ok(row)) = place
                && let Some(pixel) = self.pixel(home.x + column, home.y + row)
            {
                *pixel = paint;
            }
        }
    }

    fn paint_swept(&mut self, x: f64, y: f64, ratio: f64) {
        let cells = whole(ratio).max(1);
        for (dx, dy) in (0..cells).flat_map(|dx| (0..cells).map(move |dy| (dx, dy))) {
            if let Some(pixel) = self.pixel(whole(x) + dx, whole(y) + dy)
                && *pixel != paint::WALL
            {
                *pixel = paint::SWEPT;
            }
        }
    }

    fn paint_line(&mut self, from: [f64; 2], to: [f64; 2]) {
        let length_cells = (to[0] - from[0]).hypot(to[1] - from[1]) / self.cell_m;
        // A jump in a map is no path that was driven, and a robot that was carried draws none.
        let steps = whole(length_cells).clamp(1, 1 << 10);
        for step in 0..=steps {
            let part = f64::from(step) / f64::from(steps);
            let at = |axis: usize| {
                let [low, high] = [from, to].map(|end| end.get(axis).copied().unwrap_or(0.0));
                whole((low + (high - low) * part) / self.cell_m)
            };
            let (x, y) = (at(0), at(1));
            if let Some(pixel) = self.pixel(x, y) {
                *pixel = paint::PATH;
            }
        }
    }

    fn paint_disc(&mut self, x_m: f64, y_m: f64, (radius_m, paint): (f64, u8)) {
        let cells = whole(radius_m / self.cell_m).clamp(1, 64);
        let (x, y) = (whole(x_m / self.cell_m), whole(y_m / self.cell_m));
        for (dx, dy) in (-cells..=cells).flat_map(|dx| (-cells..=cells).map(move |dy| (dx, dy))) {
            if dx * dx + dy * dy <= cells * cells
                && let Some(pixel) = self.pixel(x.saturating_add(dx), y.saturating_add(dy))
            {
                *pixel = paint;
            }
        }
    }

    /// Every n-th cell only, until it is small enough.
    fn shrunk(self) -> Self {
        let factor = self.width.max(self.height).div_ceil(SIDE_MAX);
        if factor <= 1 {
            return self;
        }
        let (width, height) = (self.width / factor, self.height / factor);
        let rows = self.pixels.chunks_exact(self.width).step_by(factor).take(height);
        let pixels = rows
            .flat_map(|row| row.iter().step_by(factor).take(width).copied())
            .collect();
        Self {
            width,
            height,
            pixels,
            ..self
        }
    }
}

fn borders(swept: &[i32]) -> Option<([i32; 2], [i32; 2])> {
    let mut found: Option<([i32; 2], [i32; 2])> = None;
    for pair in swept.chunks_exact(2) {
        let &[x, y] = pair else { continue };
        let (low, high) = found.get_or_insert(([x, y], [x, y]));
        *low = [low[0].min(x), low[1].min(y)];
        *high = [high[0].max(x), high[1].max(y)];
    }
    found.map(|(low, [x, y])| (low, [x.saturating_add(1), y.saturating_add(1)]))
}

/// The cell in which a value lies; a value that is no cell lies in the outermost.
#[expect(clippy::cast_possible_truncation, reason = "it saturates, and NaN becomes 0")]
fn whole(value: f64) -> i32 {
    value.floor() as i32
}

fn encode(canvas: &Canvas, more: &[Chunk<'_>]) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut head = Vec::with_capacity(13);
    for side in [canvas.width, canvas.height] {
        head.extend_from_slice(&u32::try_from(side).unwrap_or(0).to_be_bytes());
    }
    // Eight bits, palette, and the only methods that there are.
    head.extend_from_slice(&[8, 3, 0, 0, 0]);
    let mut rows = Vec::with_capacity(canvas.pixels.len() + canvas.height);
    for row in canvas.pixels.chunks_exact(canvas.width.max(1)).rev() {
        rows.push(0);
        rows.extend_from_slice(row);
    }
    let image = deflated(&rows);
    let own = [
        (*b"IHDR", head.as_slice()),
        (*b"PLTE", PALETTE.as_flattened()),
        (*b"IDAT", image.as_slice()),
    ];
    for (kind, data) in own {
        push_chunk(&mut file, Chunk { kind, data });
    }
    more.iter().for_each(|chunk| push_chunk(&mut file, *chunk));
    push_chunk(
        &mut file,
        Chunk {
            kind: *b"IEND",
            data: &[],
        },
    );
    file
}

/// A stream of zlib.
#[must_use]
pub fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
    // A vector takes all that is written to it.
    packer
        .write_all(bytes)
        .and_then(|()| packer.finish())
        .unwrap_or_default()
}

fn push_chunk(file: &mut Vec<u8>, chunk: Chunk<'_>) {
    file.extend_from_slice(&u32::try_from(chunk.data.len()).unwrap_or(0).to_be_bytes());
    file.extend_from_slice(&chunk.kind);
    file.extend_from_slice(chunk.data);
    let mut crc = flate2::Crc::new();
    crc.update(&chunk.kind);
    crc.update(chunk.data);
    file.extend_from_slice(&crc.sum().to_be_bytes());
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use flate2::read::ZlibDecoder;
    use rvac_api::{HomeView, MapSnapshot, Update};

    use super::{Chunk, paint, png};
    use crate::Knowledge;

    fn known() -> Knowledge {
        let mut known = Knowledge::default();
        known.take(&Update::Home(HomeView {
            cell_m: 0.05,
            width: 3,
            height: 2,
            // The lower row is floor with a wall at its end, the upper one unknown.
            cells: vec![1, 2, 2, 1, 0, 3],
            ..HomeView::default()
        }));
        known
    }

    /// Kinds and contents of the chunks, with their checksums checked.
    fn chunks(file: &[u8]) -> Vec<([u8; 4], Vec<u8>)> {
        let mut rest = file.strip_prefix(b"\x89PNG\r\n\x1a\n").expect("a PNG file");
        let mut found = Vec::new();
        while let Some((head, more)) = rest.split_first_chunk::<8>() {
            let length = u32::from_be_bytes(head[..4].try_into().unwrap()) as usize;
            let (data, tail) = more.split_at(length);
            let mut crc = flate2::Crc::new();
            crc.update(&head[4..]);
            crc.update(data);
            assert_eq!(tail[..4], crc.sum().to_be_bytes());
            found.push((head[4..].try_into().unwrap(), data.to_vec()));
            rest = &tail[4..];
        }
        found
    }

    #[test]
    fn the_picture_has_the_home_the_right_way_up_and_further_chunks_before_its_end() {
        let file = png(
            &known(),
            &[Chunk {
                kind: *b"zTXt",
                data: b"x",
            }],
        )
        .expect("a picture");
        let chunks = chunks(&file);
        let kinds: Vec<&[u8]> = chunks.iter().map(|(kind, _)| &kind[..]).collect();
        assert_eq!(kinds, [&b"IHDR"[..], b"PLTE", b"IDAT", b"zTXt", b"IEND"]);
        let mut rows = Vec::new();
        ZlibDecoder::new(&chunks[2].1[..])
            .read_to_end(&mut rows)
            .expect("zlib");
        // Two cells of border; the lowest row of the home is the third from below; each row begins with its filter.
        let row = &rows[8 * 3..8 * 4];
        assert_eq!(row[0], 0);
        let (nothing, floor, wall) = (paint::NOTHING, paint::FLOOR, paint::WALL);
        assert_eq!(row[1..], [nothing, nothing, floor, floor, wall, nothing, nothing]);
    }

    #[test]
    fn no_message_of_the_daemon_makes_it_fail() {
        assert!(png(&Knowledge::default(), &[]).is_none());
        let mut wild = Knowledge::default();
        wild.take(&Update::Home(HomeView {
            cell_m: 0.05,
            x: i32::MAX,
            width: u32::MAX,
            height: 7,
            cells: vec![1, u32::MAX],
            ..HomeView::default()
        }));
        assert!(png(&wild, &[]).is_none());
        let mut far = known();
        far.take(&Update::Map(MapSnapshot {
            cell_m: f64::NAN,
            swept: vec![i32::MIN, i32::MAX, 3],
            path_mm: vec![i32::MIN, 0, i32::MAX, 5, 1],
            ..MapSnapshot::default()
        }));
        assert!(png(&far, &[]).is_some());
    }
}
