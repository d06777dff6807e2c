//! Grey images: PGM (P2, P5) and PNG.

/// A grey image, rows from the top. `None` = transparent.
pub(crate) struct GreyImage {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<Option<u8>>,
}

/// Why an image cannot be used.
#[derive(Debug)]
pub(crate) enum GreyImageError {
    /// It ends too early; where.
    Truncated(String),
    /// Pixels and limit.
    TooManyPixels(u64, u64),
    /// Place and problem.
    Wrong(String, String),
}

/// Most pixels of an image, before cropping: 250 x 250 m at 5 cm.
const PIXELS_MAX: u64 = 25_000_000;

const PNG_MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

pub(crate) fn is_image(bytes: &[u8]) -> bool {
    bytes.starts_with(PNG_MAGIC) || bytes.starts_with(b"P5") || bytes.starts_with(b"P2")
}

pub(crate) fn decode(bytes: &[u8]) -> Result<GreyImage, GreyImageError> {
    if bytes.starts_with(PNG_MAGIC) {
        decode_png(bytes)
    } else if bytes.starts_with(b"P5") || bytes.starts_with(b"P2") {
        decode_pgm(bytes)
    } else {
        Err(wrong(
            "byte 0",
            &format!(
                "it is {}, and neither a PGM (P2, P5) nor a PNG; {}",
                kind_of(bytes),
                remedy_for(bytes)
            ),
        ))
    }
}

/// Pictures and packed files by their first bytes.
const KINDS: [(&[u8], &str); 12] = [
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"BM", "a BMP picture"),
    (b"GIF8", "a GIF picture"),
    (b"II*\0", "a TIFF picture"),
    (b"MM\0*", "a TIFF picture"),
    (b"RIFF", "a WebP picture"),
    (b"P1", "a PBM picture (P1)"),
    (b"P3", "a PPM picture (P3)"),
    (b"P4", "a PBM picture (P4)"),
    (b"P6", "a PPM picture (P6)"),
    (b"\x1f\x8b", "packed with gzip"),
    (b"PK\x03\x04", "packed with zip"),
];

/// What a file is that is no picture of a map.
pub(super) fn kind_of(bytes: &[u8]) -> &'static str {
    let known = KINDS.iter().find(|(first, _)| bytes.starts_with(first));
    match known {
        Some((_, kind)) => kind,
        None if bytes.is_empty() => "empty",
        None => "of no kind that is known",
    }
}

fn remedy_for(bytes: &[u8]) -> &'static str {
    if bytes.starts_with(b"\x1f\x8b") || bytes.starts_with(b"PK") {
        "unpack it"
    } else {
        "save the picture as one of them"
    }
}

fn wrong(place: &str, problem: &str) -> GreyImageError {
    GreyImageError::Wrong(place.to_owned(), problem.to_owned())
}

fn check_size(width: u64, height: u64) -> Result<(usize, usize), GreyImageError> {
    let pixels = width.saturating_mul(height);
    if pixels > PIXELS_MAX {
        return Err(GreyImageError::TooManyPixels(pixels, PIXELS_MAX));
    }
    if width < 2 || height < 2 {
        return Err(wrong("the header", "an image needs at least 2 x 2 pixels"));
    }
    Ok((width as usize, height as usize))
}

/// Tokens of a PNM header: numbers between white space, `#` starts a comment.
struct PnmReader<'a> {
    bytes: &'a [u8],
    position: usize,
}

impl PnmReader<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.position).copied()
    }

    fn skip_blank(&mut self) {
        while let Some(byte) = self.peek() {
            if byte == b'#' {
                while self.peek().is_some_and(|byte| byte != b'\n' && byte != b'\r') {
                    self.position += 1;
                }
            } else if byte.is_ascii_whitespace() {
                self.position += 1;
            } else {
                break;
            }
        }
    }

    fn number(&mut self, what: &str) -> Result<u64, GreyImageError> {
        self.skip_blank();
        let start = self.position;
        let mut value: u64 = 0;
        while let Some(byte) = self.peek().filter(u8::is_ascii_digit) {
            value = value.saturating_mul(10).saturating_add(u64::from(byte - b'0'));
            self.position += 1;
        }
        if self.position > start {
            Ok(value)
        } else if self.peek().is_none() {
            Err(GreyImageError::Truncated(format!("the {what} is missing")))
        } else {
            Err(wrong(
                &format!("byte {start}"),
                &format!("the {what} must be a number"),
            ))
        }
    }
}

fn decode_pgm(bytes: &[u8]) -> Result<GreyImage, GreyImageError> {
    let binary = bytes.starts_with(b"P5");
    let mut reader = PnmReader { bytes, position: 2 };
    let (width, height) = (reader.number("width")?, reader.number("height")?);
    let (width, height) = check_size(width, height)?;
    let white = reader.number("largest grey value")?;
    if !(1..=65_535).contains(&white) {
        return Err(wrong(
            "the header",
            "the largest grey value must lie in 1 to 65535",
        ));
    }
    let pixels = if binary {
        binary_pixels(&reader, width * height, white)?
    } else {
        text_pixels(&mut reader, width * height, white)?
    };
    Ok(GreyImage {
        width,
        height,
        pixels,
    })
}

fn grey(value: u64, white: u64) -> Option<u8> {
    Some((value.min(white) * 255 / white) as u8)
}

fn binary_pixels(
    reader: &PnmReader<'_>,
    count: usize,
    white: u64,
) -> Result<Vec<Option<u8>>, GreyImageError> {
    let wide = if white > 255 { 2 } else { 1 };
    let raster = raster(reader, count * wide);
    let Some(raster) = raster.get(..count * wide) else {
        return Err(GreyImageError::Truncated(format!(
            "{} of {} bytes of pixels are there",
            raster.len(),
            count * wide
        )));
    };
    Ok(raster
        .chunks_exact(wide)
        .map(|pixel| {
            grey(
                pixel.iter().fold(0, |sum, byte| sum * 256 + u64::from(*byte)),
                white,
            )
        })
        .collect())
}

/// The bytes after the header, which one white space ends. Some programs write two (CR LF) or a comment; what belongs
/// to the header is what would make the file longer than its pixels.
fn raster<'a>(reader: &PnmReader<'a>, wanted: usize) -> &'a [u8] {
    let rest = reader.bytes.get(reader.position..).unwrap_or(&[]);
    let usual = rest.get(1..).unwrap_or(&[]);
    let mut header = PnmReader {
        bytes: rest,
        position: 0,
    };
    let blank = |byte: &u8| matches!(byte, b' ' | b'\t');
    let comment = rest.iter().find(|byte| !blank(byte)) == Some(&b'#')
        || usual.iter().find(|byte| !blank(byte)) == Some(&b'#');
    if comment {
        while header.peek().is_some_and(|byte| byte != b'#') {
            header.position += 1;
        }
        while header.peek().is_some_and(|byte| byte != b'\n' && byte != b'\r') {
            header.position += 1;
        }
    }
    let rest = rest.get(header.position..).unwrap_or(&[]);
    let longest = match rest {
        [b'\r', b'\n', pixels @ ..] => pixels,
        [_, pixels @ ..] => pixels,
        [] => &[],
    };
    if longest.len() >= wanted { longest } else { usual }
}

fn text_pixels(
    reader: &mut PnmReader<'_>,
    count: usize,
    white: u64,
) -> Result<Vec<Option<u8>>, GreyImageError> {
    // Two bytes a pixel at least, so a lying header cannot make us take more memory than the file allows.
    if reader.bytes.len() < count {
        return Err(GreyImageError::Truncated(format!(
            "{} bytes cannot hold {count} pixels",
            reader.bytes.len()
        )));
    }
    (0..count)
        .map(|index| Ok(grey(reader.number(&format!("pixel {index}"))?, white)))
        .collect()
}

fn decode_png(bytes: &[u8]) -> Result<GreyImage, GreyImageError> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(png_error)?;
    let (width, height) = check_size(reader.info().width.into(), reader.info().height.into())?;
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| wrong("the header", "its size cannot be represented"))?;
    let mut raster = vec![0; size];
    let frame = reader.next_frame(&mut raster).map_err(png_error)?;
    let samples = frame.color_type.samples();
    let has_alpha = matches!(
        frame.color_type,
        png::ColorType::GrayscaleAlpha | png::ColorType::Rgba
    );
    let pixels: Vec<Option<u8>> = raster
        .chunks_exact(samples)
        .take(width * height)
        .map(|pixel| mean_grey(pixel, has_alpha))
        .collect();
    if pixels.len() < width * height {
        return Err(GreyImageError::Truncated("pixels are missing".to_owned()));
    }
    Ok(GreyImage {
        width,
        height,
        pixels,
    })
}

fn mean_grey(pixel: &[u8], has_alpha: bool) -> Option<u8> {
    let (colors, alpha) = match pixel.split_last() {
        Some((alpha, colors)) if has_alpha => (colors, *alpha),
        _ => (pixel, 255),
    };
    let sum: u32 = colors.iter().map(|color| u32::from(*color)).sum();
    (alpha > 0).then(|| (sum / colors.len().max(1) as u32) as u8)
}

fn png_error(error: png::DecodingError) -> GreyImageError {
    match error {
        png::DecodingError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            GreyImageError::Truncated("the PNG ends in the middle of a chunk".to_owned())
        }
        error => GreyImageError::Wrong(
            "the PNG".to_owned(),
            format!("{error}; save it again with an image editor"),
        ),
    }
}
