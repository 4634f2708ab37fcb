//! Pictures of the particles: what is shown, and its layout around the view of the box.

use super::canvas::Canvas;
use super::error::PlotError;
use super::palette::{Colour, Inks, linear};
use super::periodic;
use super::snapshot_page::{self, Key, Page};
use super::sphere_renderer::{Camera, SphereScene};
use crate::scene::{Snapshot, SnapshotColor, SnapshotView, Theme};
use bytemuck::{Pod, Zeroable};

/// The particles of one moment and what to write beside them.
#[derive(Debug, Clone, Copy)]
pub struct ParticlePicture<'a> {
    /// Two or three; in two dimensions the third coordinates are ignored.
    pub dimension: u32,
    /// Edge lengths of the box, which spans from zero to these.
    pub lengths: [f64; 3],
    /// One position per particle, in units of length; what is not finite is left out.
    pub positions: &'a [[f64; 3]],
    /// One index into `species_names` per particle.
    pub species: &'a [u32],
    /// Names of the species.
    pub species_names: &'a [String],
    /// One speed per particle; needed only to colour by speed.
    pub speeds: Option<&'a [f64]>,
    /// Pairs of particles that are bonded: a rod is drawn between the two, the shortest way.
    pub bonds: &'a [[u32; 2]],
    /// Radius of the drawn discs in units of length.
    pub radius: f64,
    /// One line that says what is shown; may be empty.
    pub title: &'a str,
    /// Conditions, in smaller type; may be empty.
    pub subtitle: &'a str,
}

/// One particle of `spheres.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct ParticleInstance {
    /// Relative to the centre of the box.
    pub position: [f32; 3],
    pub colour: Colour,
}

/// Half of a bond in `spheres.wgsl`: from one of its particles to its middle.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct RodInstance {
    /// Of the particle, relative to the centre of the box.
    pub position: [f32; 3],
    pub reach: [f32; 3],
    pub colour: Colour,
}

/// Radius of a bond in radii of a particle.
const ROD: f64 = 0.35;

/// Compass bearing and height of the viewer of a three-dimensional box, in degrees.
const AZIMUTH: f64 = -62.0;
const ELEVATION: f64 = 20.0;

/// What points to the right, upwards and towards the viewer.
fn view(dimension: u32, from: SnapshotView) -> [[f64; 3]; 3] {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    match from {
        _ if dimension == 2 => return [x, y, z],
        SnapshotView::Corner => {}
        SnapshotView::X => return [y, z, x],
        SnapshotView::Y => return [x, z, [0.0, -1.0, 0.0]],
        SnapshotView::Z => return [x, y, z],
    }
    let (sin_a, cos_a) = AZIMUTH.to_radians().sin_cos();
    let (sin_e, cos_e) = ELEVATION.to_radians().sin_cos();
    [[-sin_a, cos_a, 0.0], [-sin_e * cos_a, -sin_e * sin_a, cos_e], [cos_e * cos_a, cos_e * sin_a, sin_e]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn check(picture: &ParticlePicture<'_>, style: &Snapshot) -> Result<(), PlotError> {
    let count = picture.positions.len();
    let refuse = |message: String| Err(PlotError::Input(message));
    if picture.dimension != 2 && picture.dimension != 3 {
        return refuse(format!("{} dimensions; there must be 2 or 3", picture.dimension));
    }
    let lists = [(picture.species.len(), "species"), (picture.speeds.map_or(count, <[f64]>::len), "speeds")];
    let lengths = &picture.lengths[..picture.dimension as usize];
    snapshot_page::check(count, &lists, (picture.species, picture.species_names), lengths)?;
    if let Some([a, b]) = picture.bonds.iter().find(|ends| ends.iter().any(|end| *end as usize >= count)) {
        return refuse(format!("a bond of {a} and {b} among {count} particles"));
    }
    if picture.speeds.is_none() && style.color == SnapshotColor::Speed {
        return refuse("colouring by speed needs the speeds".to_owned());
    }
    if !(picture.radius.is_finite() && picture.radius > 0.0) {
        return refuse(format!("the radius of the discs is {}", picture.radius));
    }
    Ok(())
}

/// Width and height in pixels of a snapshot of a box.
pub(crate) fn snapshot_size(style: &Snapshot, dimension: u32, lengths: [f64; 3]) -> [f64; 2] {
    let [right, up, _] = view(dimension, style.view);
    let lengths = visible(dimension, lengths);
    snapshot_page::size(style, [extent(right, lengths), extent(up, lengths)])
}

/// Edges of the box that are drawn: a plane has no depth.
fn visible(dimension: u32, mut lengths: [f64; 3]) -> [f64; 3] {
    if dimension == 2 {
        lengths[2] = 0.0;
    }
    lengths
}

/// Extent of a box along an axis of the view.
fn extent(axis: [f64; 3], lengths: [f64; 3]) -> f64 {
    (0..3).map(|i| axis[i].abs() * lengths[i]).sum()
}

/// Lays out a picture of the particles: shapes below and above them, and the view.
///
/// # Errors
/// [`PlotError::Input`] if the lists differ in length or a length is not positive.
pub(super) fn lay_out(
    picture: &ParticlePicture<'_>,
    style: &Snapshot,
    theme: Theme,
) -> Result<(Canvas, SphereScene), PlotError> {
    check(picture, style)?;
    let [right, up, toward] = view(picture.dimension, style.view);
    let lengths = visible(picture.dimension, picture.lengths);
    let extent = |axis| extent(axis, lengths);
    let shape = [right, up].map(extent);
    let mut page = Page::new(style, theme, shape)?;
    let Inks { paper, ink, muted, .. } = page.canvas.inks;
    let key = match (style.color, picture.speeds) {
        (SnapshotColor::Speed, Some(speeds)) => {
            let fastest = speeds.iter().copied().filter(|speed| speed.is_finite()).fold(0.0, f64::max);
            let fitting = [0.0, if fastest > 0.0 { fastest } else { 1.0 }];
            Key::scale("speed (length/time)", style.range, fitting, speeds)
        }
        _ => Key::species(picture.species_names, picture.species, &style.species, &page.canvas.inks),
    };
    let frame = page.frame(picture.title, vec![picture.subtitle.to_owned()], &key);

    // Spheres may stand out of a three-dimensional box; discs of a flat one are cut off at its edge.
    let overhang = if picture.dimension == 3 { 2.0 * picture.radius.min(0.1 * extent(right)) } else { 0.0 };
    let (outline, pixels_per_length) = page.outline(&frame, shape, overhang);
    let centre = frame.centre();
    let project = |corner: [f64; 3]| {
        let relative = [0, 1, 2].map(|axis| (corner[axis] - 0.5) * lengths[axis]);
        [centre[0] + dot(relative, right) * pixels_per_length, centre[1] - dot(relative, up) * pixels_per_length]
    };
    let edges = box_edges(picture.dimension, toward);
    for (from, to, _) in edges.iter().filter(|(_, _, front)| !front) {
        page.canvas.line(project(*from), project(*to), 0.8 * page.rule, muted);
    }
    page.canvas.end_of_background();
    for (from, to, _) in edges.iter().filter(|(_, _, front)| *front) {
        page.canvas.line(project(*from), project(*to), page.rule, ink);
    }
    let is_seen = |axis: usize| right[axis] != 0.0 || up[axis] != 0.0;
    let axes = ["x", "y", "z"].into_iter().enumerate().take(picture.dimension as usize);
    for (axis, name) in axes.filter(|(axis, _)| is_seen(*axis)) {
        let is_oblique = picture.dimension == 3 && style.view == SnapshotView::Corner;
        let [from, to] = measured_edge(axis, is_oblique).map(project);
        // Beside spheres that stand out of the box.
        let [away, is_upright] = [0.5 * overhang * pixels_per_length, f64::from(u8::from(from[0] == to[0]))];
        let [from, to] = [from, to].map(|[x, y]| [x - is_upright * away, y + (1.0 - is_upright) * away]);
        page.edge_length(name, lengths[axis], [from, to]);
    }
    page.footer(&key, outline, pixels_per_length);

    // A particle smaller than a pixel is drawn as large as one.
    let radius = picture.radius.max(0.7 / pixels_per_length);
    let particles = instances(picture, &key, lengths, radius);
    let rods = rods(picture, &key, lengths);
    let fragments = particles.len() as f64 * 3.2 * (radius * pixels_per_length).powi(2);
    // More samples where they cost little.
    let samples = if fragments < 4e6 { 3 } else { 2 };
    let scale = pixels_per_length * f64::from(samples);
    let flat = picture.dimension == 2;
    let [lighting, rim, fog] = if flat { [0.3, 0.35, 0.0] } else { [1.0, 0.12, 0.4] };
    let paper = [0, 1, 2].map(|channel| f64::from(linear(paper[channel]).sqrt()));
    let with = |[x, y, z]: [f64; 3], last: f64| [x, y, z, last].map(|value| value as f32);
    let camera = Camera {
        right: with(right, scale),
        up: with(up, 0.0),
        toward: with(toward, 0.5 * extent(toward) + 1.01 * radius),
        fog: with(paper, fog),
        look: [radius, radius * scale, lighting, rim].map(|value| value as f32),
        rods: [ROD * radius, ROD * radius * scale, 0.0, 0.0].map(|value| value as f32),
        ..Camera::default()
    };
    let area = if flat { outline } else { frame.grown(radius * pixels_per_length) };
    Ok((page.canvas, SphereScene { particles, rods, camera, centre, area, samples }))
}

/// Edges of the unit box and whether they lie on its near side.
fn box_edges(dimension: u32, toward: [f64; 3]) -> Vec<([f64; 3], [f64; 3], bool)> {
    let mut edges = Vec::new();
    for axis in 0..dimension as usize {
        let others: Vec<usize> = (0..3).filter(|other| *other != axis).collect();
        for corner in 0..4 {
            let mut from = [0.0; 3];
            from[others[0]] = f64::from(corner & 1);
            from[others[1]] = f64::from(corner >> 1);
            if dimension == 2 && from[2] > 0.0 {
                continue;
            }
            let mut to = from;
            to[axis] = 1.0;
            // An edge is hidden if both faces that meet in it look away from the viewer.
            let faces_viewer = |other: usize| (from[other] > 0.5) == (toward[other] > 0.0);
            edges.push((from, to, dimension == 2 || others.iter().any(|other| faces_viewer(*other))));
        }
    }
    edges
}

/// The edge along an axis beside which its length is written: at the outline of the view, below it or to its left.
fn measured_edge(axis: usize, is_oblique: bool) -> [[f64; 3]; 2] {
    let from = if axis == 1 && is_oblique { [1.0, 0.0, 0.0] } else { [0.0; 3] };
    let mut to = from;
    to[axis] = 1.0;
    [from, to]
}

fn instances(picture: &ParticlePicture<'_>, key: &Key<'_>, lengths: [f64; 3], radius: f64) -> Vec<ParticleInstance> {
    let mut instances = Vec::with_capacity(picture.positions.len());
    for (index, position) in picture.positions.iter().enumerate() {
        if position.iter().take(picture.dimension as usize).any(|coordinate| !coordinate.is_finite()) {
            continue;
        }
        let colour = key.colour(index);
        let relative = [0, 1, 2].map(|axis| position[axis] - 0.5 * lengths[axis]);
        if picture.dimension == 3 {
            instances.push(ParticleInstance { position: relative.map(|x| x as f32), colour });
            continue;
        }
        // A disc that crosses an edge comes in again on the other side.
        let reach = [position[0], position[1]].map(|centre| [centre - radius, centre + radius]);
        for [x, y] in periodic::images(reach, [lengths[0], lengths[1]]) {
            let position = [(relative[0] + x) as f32, (relative[1] + y) as f32, 0.0];
            instances.push(ParticleInstance { position, colour });
        }
    }
    instances
}

/// The halves of all bonds.
fn rods(picture: &ParticlePicture<'_>, key: &Key<'_>, lengths: [f64; 3]) -> Vec<RodInstance> {
    let dimension = picture.dimension as usize;
    let flat = |position: [f64; 3]| [0, 1, 2].map(|axis| if axis < dimension { position[axis] } else { 0.0 });
    let mut rods = Vec::with_capacity(2 * picture.bonds.len());
    for [a, b] in picture.bonds.iter().map(|ends| ends.map(|end| end as usize)) {
        for (near, far) in [(a, b), (b, a)] {
            let [from, to] = [near, far].map(|end| flat(picture.positions[end]));
            let half = [0, 1, 2].map(|axis| {
                let (way, edge) = (to[axis] - from[axis], lengths[axis]);
                0.5 * if axis < dimension { way - edge * (way / edge).round() } else { 0.0 }
            });
            if half.iter().chain(&from).all(|part| part.is_finite()) {
                let position = [0, 1, 2].map(|axis| (from[axis] - 0.5 * lengths[axis]) as f32);
                rods.push(RodInstance { position, reach: half.map(|part| part as f32), colour: key.colour(near) });
            }
        }
    }
    rods
}
