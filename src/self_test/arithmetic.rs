//! What a driver does where it is free to: whether products are contracted into sums, and whether everywhere alike.

use super::Finding;
use super::compute::compute;
use super::random::uniform;
use crate::gpu::{Gpu, GpuError};

const POINTS: u32 = 1 << 12;

/// How a difference of two products is rounded, and whether its mirror image is the same number; and whether products are
/// contracted anywhere.
pub(super) fn contraction(gpu: &Gpu) -> Result<(Finding, bool), GpuError> {
    let points: Vec<[f32; 4]> =
        (0..POINTS).map(|number| std::array::from_fn(|part| (1.0 + uniform(number, part as u32)) as f32)).collect();
    let text = include_str!("../../shaders/check/mirror.wgsl");
    let values = compute(gpu, text, &[], bytemuck::cast_slice(&points), 2 * points.len())?;
    let values: Vec<[f32; 2]> = values.chunks_exact(2).map(|pair| [pair[0], pair[1]].map(f32::from_bits)).collect();
    let contracted = points.iter().zip(&values).filter(|([a, b, c, d], [there, _])| *there != a * b - c * d).count();
    let unlike = values.iter().filter(|[there, back]| *there != -back).count();
    let contraction = match contracted {
        0 => "products are rounded before they are added",
        _ => "products are contracted into sums",
    };
    let mirror = match unlike {
        0 => "mirrored expressions agree",
        _ => "mirrored expressions differ",
    };
    let found = format!("{contraction}; {mirror} ({unlike} of {POINTS} differ)");
    Ok((Finding::noted("contraction", found), contracted > 0))
}
