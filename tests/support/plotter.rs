//! A plotter on the adapter of the tests, and pictures left in `target/tmp` for the eye.

use std::sync::LazyLock;

use image::RgbaImage;
use mesoscope::plot::Plotter;

use super::gpu;

pub fn plotter() -> &'static Plotter<'static> {
    static PLOTTER: LazyLock<Plotter<'static>> = LazyLock::new(|| Plotter::new(gpu()).unwrap());
    &PLOTTER
}

pub fn save(name: &str, picture: RgbaImage) -> RgbaImage {
    picture.save(format!("{}/{name}.png", env!("CARGO_TARGET_TMPDIR"))).unwrap();
    picture
}
