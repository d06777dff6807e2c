//! Draws the scene without WebGL: the flat map only, with what every browser can do. Slower, but a map.

use leptos::prelude::document;
use panel_logic::{MapPalette, MapPoint, Pixel, Rgb, plan_pixels};
use rvac_api::Pose;
use wasm_bindgen::{Clamped, JsCast};
use web_sys::{CanvasRenderingContext2d, HtmlCanvasElement, ImageData};

use super::canvas_size::fit_canvas;
use super::scene::{Ground, Places, Redraw, Scene};
use crate::language::words;

/// Radius of a bump mark and widths of lines, CSS pixels.
const BUMP_PX: f64 = 3.5;
const LINE_PX: f64 = 1.6;
const BORDER_PX: f64 = 3.0;
/// How much of the floor shows through what is swept, and through where the robot may be.
const SWEPT: f64 = 0.6;
const SPREAD: f64 = 0.16;

/// Where cells lie on the map: the corner of the first, and their size.
#[derive(Clone, Copy, Debug)]
struct Grid {
    origin: Pose,
    cell_m: f64,
}

/// A picture of cells, drawn larger.
#[derive(Debug)]
struct Cells {
    canvas: HtmlCanvasElement,
    context: CanvasRenderingContext2d,
}

impl Cells {
    fn new() -> Option<Self> {
        let canvas = document().create_element("canvas").ok()?;
        let canvas = canvas.dyn_into::<HtmlCanvasElement>().ok()?;
        let context = context_of(&canvas)?;
        Some(Self { canvas, context })
    }

    /// Takes four bytes a cell. Nothing is shown when they do not fit the size.
    fn replace(&self, width: u32, pixels: &[u8]) {
        let height = pixels.len() as u32 / 4 / width.max(1);
        self.canvas.set_width(width.max(1));
        self.canvas.set_height(height.max(1));
        if let Ok(picture) = ImageData::new_with_u8_clamped_array(Clamped(pixels), width.max(1)) {
            self.context.put_image_data(&picture, 0.0, 0.0).ok(); // It fits.
        }
    }
}

fn context_of(canvas: &HtmlCanvasElement) -> Option<CanvasRenderingContext2d> {
    let context = canvas.get_context("2d").ok().flatten()?;
    context.dyn_into::<CanvasRenderingContext2d>().ok()
}

fn css(rgb: Rgb, opacity: f64) -> String {
    let [red, green, blue] = rgb.map(|share| (share * 255.0).round() as u8);
    format!("rgba({red},{green},{blue},{opacity})")
}

/// The canvas and the pictures that it shows.
#[derive(Debug)]
pub(crate) struct PlainRenderer {
    canvas: HtmlCanvasElement,
    context: CanvasRenderingContext2d,
    plan: Cells,
    swept: Cells,
}

impl PlainRenderer {
    /// None where not even this can be done.
    pub(crate) fn new(canvas: &HtmlCanvasElement) -> Option<Self> {
        Some(Self {
            canvas: canvas.clone(),
            context: context_of(canvas)?,
            plan: Cells::new()?,
            swept: Cells::new()?,
        })
    }

    /// Draws one frame, if anything in it changed.
    pub(crate) fn draw(&self, scene: &mut Scene, places: Places, redraw: Redraw) {
        if scene.camera.orbit().is_some() {
            scene.refuse_relief(words().map.no_webgl.to_owned());
        }
        fit_canvas(&self.canvas, &scene.camera);
        let palette = scene.theme.palette();
        self.take_pictures(scene, &palette);
        if redraw == Redraw::Nothing {
            return;
        }
        let (width, height) = (f64::from(self.canvas.width()), f64::from(self.canvas.height()));
        self.context.reset_transform().ok(); // It can always be.
        self.context.set_fill_style_str(&css(palette.outside, 1.0));
        self.context.fill_rect(0.0, 0.0, width, height);
        self.draw_pictures(scene);
        self.context.reset_transform().ok(); // The same.
        self.draw_lines(scene, &palette);
        self.draw_marks(scene, places, &palette);
    }

    fn take_pictures(&self, scene: &mut Scene, palette: &MapPalette) {
        if std::mem::take(&mut scene.plan_changed) {
            let drawn = scene
                .plan()
                .and_then(|plan| Some((plan.width, plan_pixels(plan, palette.plan)?)));
            let (width, pixels) = drawn.unwrap_or_else(|| (1, vec![0; 4]));
            self.plan.replace(width, &pixels);
        }
        let is_another = scene.swept.take_resized();
        if scene.swept.take_dirty().is_some() || is_another {
            let [red, green, blue] = palette.swept.map(|share| (share * 255.0).round() as u8);
            let pixel = |cell: &u8| [red, green, blue, (f64::from(*cell) * SWEPT) as u8];
            let pixels: Vec<u8> = scene.swept.bytes().iter().flat_map(pixel).collect();
            self.swept.replace(scene.swept.size().0.unsigned_abs(), &pixels);
        }
    }

    fn ratio(&self, scene: &Scene) -> f64 {
        f64::from(self.canvas.width()) / scene.camera.view().width
    }

    /// The device pixel of a place.
    fn pixel(&self, scene: &Scene, place: MapPoint) -> Pixel {
        let pixel = scene.camera.screen_from_map(place);
        let ratio = self.ratio(scene);
        Pixel::new(pixel.x * ratio, pixel.y * ratio)
    }

    fn draw_pictures(&self, scene: &Scene) {
        self.context.set_image_smoothing_enabled(false);
        if let Some(plan) = scene.plan() {
            let grid = Grid {
                origin: plan.origin,
                cell_m: plan.cell_m,
            };
            self.draw_cells(scene, &self.plan, grid);
        }
        let (x0, y0) = scene.swept.origin();
        let grid = Grid {
            origin: Pose {
                x: f64::from(x0) * scene.cell_m,
                y: f64::from(y0) * scene.cell_m,
                ..Pose::default()
            },
            cell_m: scene.cell_m,
        };
        if scene.swept_cells > 0 {
            self.draw_cells(scene, &self.swept, grid);
        }
    }

    fn draw_cells(&self, scene: &Scene, cells: &Cells, grid: Grid) {
        let size = scene.camera.scale() * self.ratio(scene) * grid.cell_m;
        let (sin, cos) = grid.origin.heading.sin_cos();
        let Pixel { x, y } = self.pixel(scene, MapPoint::of(&grid.origin));
        let placed = self
            .context
            .set_transform(size * cos, -size * sin, -size * sin, -size * cos, x, y);
        if placed.is_ok() {
            self.context
                .draw_image_with_html_canvas_element(&cells.canvas, 0.0, 0.0)
                .ok(); // A canvas of at least one pixel can be drawn.
        }
    }

    fn draw_lines(&self, scene: &mut Scene, palette: &MapPalette) {
        let driven: Vec<f32> = scene
            .path
            .chunks_exact(2)
            .zip(scene.path.chunks_exact(2).skip(1))
            .flat_map(|(from, to)| [from, to].concat())
            .collect();
        let walls = if scene.ground() == Ground::Known {
            scene.walls.as_slice()
        } else {
            &[]
        };
        for (strokes, (width_px, colour)) in [
            (walls, (LINE_PX, palette.wall)),
            (&driven, (LINE_PX, palette.path)),
            (&scene.planned_path, (LINE_PX, palette.thought)),
            (&scene.forbidden, (BORDER_PX, palette.forbidden)),
            (&scene.avoided, (BORDER_PX, palette.forbidden)),
            (&scene.wanted, (BORDER_PX, palette.wanted)),
        ] {
            self.context.begin_path();
            for stroke in strokes.chunks_exact(4) {
                if let &[x, y, far_x, far_y] = stroke {
                    let from = self.pixel(scene, MapPoint::new(x.into(), y.into()));
                    let to = self.pixel(scene, MapPoint::new(far_x.into(), far_y.into()));
                    self.context.move_to(from.x, from.y);
                    self.context.line_to(to.x, to.y);
                }
            }
            self.context.set_line_width(width_px * self.ratio(scene));
            self.context.set_stroke_style_str(&css(colour, 1.0));
            self.context.stroke();
        }
    }

    fn draw_marks(&self, scene: &Scene, places: Places, palette: &MapPalette) {
        let ratio = self.ratio(scene);
        let size = |metres: f64| metres * scene.camera.scale() * ratio;
        for bump in &scene.bumps {
            self.disc(
                self.pixel(scene, MapPoint::new(bump.x, bump.y)),
                BUMP_PX * ratio,
                css(palette.mark, 1.0),
            );
        }
        let radius = size(scene.body_radius_m());
        if let Some(dock) = scene.dock() {
            self.disc(
                self.pixel(scene, MapPoint::of(&dock)),
                radius * 0.6,
                css(palette.front, 1.0),
            );
        }
        if let Some(pose) = places.believed {
            let spread = size(scene.uncertainty_m());
            let at = self.pixel(scene, MapPoint::of(&pose));
            self.disc(at, spread, css(palette.thought, SPREAD));
            self.disc(at, radius, css(palette.body, 1.0));
            let ahead = scene.body_radius_m() * 0.6;
            let (sin, cos) = pose.heading.sin_cos();
            let nose = MapPoint::new(pose.x + ahead * cos, pose.y + ahead * sin);
            self.disc(self.pixel(scene, nose), radius * 0.3, css(palette.front, 1.0));
        }
        if let Some(pose) = places.truth {
            let Pixel { x, y } = self.pixel(scene, MapPoint::of(&pose));
            self.context.begin_path();
            self.context.arc(x, y, radius, 0.0, core::f64::consts::TAU).ok(); // No radius is negative.
            self.context.set_line_width(LINE_PX * ratio);
            self.context.set_stroke_style_str(&css(palette.mark, 1.0));
            self.context.stroke();
        }
    }

    fn disc(&self, Pixel { x, y }: Pixel, radius: f64, colour: String) {
        self.context.begin_path();
        self.context.arc(x, y, radius, 0.0, core::f64::consts::TAU).ok(); // No radius is negative.
        self.context.set_fill_style_str(&colour);
        self.context.fill();
    }
}
