//! A plotter on whatever adapter there is, and pictures left in `target/tmp` for the eye.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::sync::LazyLock;

use image::RgbaImage;
use mesoscope::plot::Plotter;

pub fn device() -> &'static (wgpu::Device, wgpu::Queue) {
    static DEVICE: LazyLock<(wgpu::Device, wgpu::Queue)> = LazyLock::new(|| {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .expect("these tests need a Vulkan, Metal or DX12 adapter; lavapipe will do");
        let request = wgpu::DeviceDescriptor {
            label: Some("tests of pictures"),
            required_limits: wgpu::Limits::defaults(),
            ..Default::default()
        };
        pollster::block_on(adapter.request_device(&request)).unwrap()
    });
    &DEVICE
}

pub fn plotter() -> &'static Plotter {
    static PLOTTER: LazyLock<Plotter> = LazyLock::new(|| {
        let (device, queue) = device();
        Plotter::new(device, queue).unwrap()
    });
    &PLOTTER
}

pub fn save(name: &str, picture: RgbaImage) -> RgbaImage {
    picture.save(format!("{}/{name}.png", env!("CARGO_TARGET_TMPDIR"))).unwrap();
    picture
}
