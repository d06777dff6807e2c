//! The live map: the scene is what is to be seen, the renderer draws it with WebGL2, the view puts it on the page.

mod canvas;
mod canvas_size;
mod edit_bar;
mod gestures;
mod gl;
mod handle;
mod labels;
mod marks;
mod order_bar;
mod orders;
mod plain;
mod relief;
mod relief_shaders;
mod renderer;
mod reshape_view;
mod scene;
mod shaders;
mod sketch_view;
mod uploads;
mod view;
mod view_memory;

pub(crate) use edit_bar::{EditBar, Edits};
pub(crate) use handle::MapHandle;
pub(crate) use order_bar::OrderBar;
pub(crate) use orders::Orders;
pub(crate) use reshape_view::ReshapeView;
pub(crate) use sketch_view::SketchView;
pub(crate) use view::MapView;
