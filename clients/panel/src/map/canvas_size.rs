//! The canvas has as many pixels as it covers on the screen.

use panel_logic::Camera;
use web_sys::HtmlCanvasElement;

/// Gives it that many, at most four a CSS pixel. True when that emptied it.
pub(super) fn fit_canvas(canvas: &HtmlCanvasElement, camera: &Camera) -> bool {
    let ratio = leptos::prelude::window().device_pixel_ratio().clamp(1.0, 2.0);
    let view = camera.view();
    let (width, height) = (
        (view.width * ratio).round() as u32,
        (view.height * ratio).round() as u32,
    );
    let resized = canvas.width() != width || canvas.height() != height;
    if resized {
        canvas.set_width(width);
        canvas.set_height(height);
    }
    resized
}
