//! Pictures of Voronoi cells: what is shown, and its layout around the view of the box.

use super::canvas::Canvas;
use super::error::PlotError;
use super::periodic;
use super::snapshot_page::{Key, Page, check};
use crate::scene::{Snapshot, Theme};
use crate::tessellation::Tessellation;

/// The cells of one moment and what to write beside them.
#[derive(Debug, Clone, Copy)]
pub struct CellPicture<'a> {
    /// Edge lengths of the box, which spans from zero to these.
    pub lengths: [f64; 2],
    /// The place of each cell, in units of length.
    pub positions: &'a [[f64; 2]],
    /// The cells at these places.
    pub tessellation: &'a Tessellation,
    /// One index into `species_names` per cell.
    pub species: &'a [u32],
    /// Names of the species.
    pub species_names: &'a [String],
    /// What colours show, with one value per cell; left out, the species.
    pub shown: Option<ShownValues<'a>>,
    /// One line that says what is shown; may be empty.
    pub title: &'a str,
    /// Conditions, in smaller type; may be empty.
    pub subtitle: &'a str,
}

/// Values of cells, from dark blue at the lowest to yellow at the highest.
#[derive(Debug, Clone, Copy)]
pub struct ShownValues<'a> {
    /// Name with the unit in parentheses.
    pub label: &'a str,
    /// One value per cell; what is not finite has the colour of the lowest.
    pub values: &'a [f64],
}

/// Colours leave this part of the cells beyond each end of their scale, if that makes it much shorter.
const BEYOND: f64 = 0.005;
/// A scale this many times as long as that without the cells beyond hides all others.
const MUCH_LONGER: f64 = 1.3;
/// Width of the lines between cells in their mean width; no line is drawn where it could not be seen.
const LINE: f64 = 0.06;
const THINNEST_LINE: f64 = 0.2;

/// Lays out a picture of Voronoi cells. A cell that crosses an edge of the box is cut off there and comes in again on the
/// other side.
///
/// # Errors
/// [`PlotError::Input`] if the lists differ in length or a length is not positive; [`PlotError::Font`].
pub(super) fn lay_out(picture: &CellPicture<'_>, style: &Snapshot, theme: Theme) -> Result<Canvas, PlotError> {
    let count = picture.positions.len();
    let values = picture.shown.map_or(count, |shown| shown.values.len());
    let lists = [(picture.tessellation.cells.len(), "cells"), (picture.species.len(), "species"), (values, "values")];
    check(count, &lists, (picture.species, picture.species_names), &picture.lengths)?;
    let mut page = Page::new(style, theme, picture.lengths)?;
    let key = match picture.shown {
        Some(ShownValues { label, values }) => Key::scale(label, style.range, fitting_range(values), values),
        None => Key::species(picture.species_names, picture.species, &[], &page.canvas.inks),
    };
    let mut notes = vec![picture.subtitle.to_owned()];
    // In a film this would flicker; the arrowheads of the scale say it there.
    if let (Key::Scale { values, map, .. }, None) = (&key, style.range) {
        let beyond = |value: &&f64| value.is_finite() && !(map.low..=map.high).contains(*value);
        let count = values.iter().filter(beyond).count();
        notes.extend((count > 0).then(|| format!("{count} cells are beyond the scale")));
    }
    let frame = page.frame(picture.title, notes, &key);
    let (outline, pixels_per_length) = page.outline(&frame, picture.lengths, 0.0);
    page.canvas.clip(Some(outline));
    draw(&mut page.canvas, picture, [outline.left, outline.bottom], pixels_per_length, &key);
    page.canvas.clip(None);
    let corners = outline.corners();
    for (number, from) in corners.iter().enumerate() {
        page.canvas.line(*from, corners[(number + 1) % corners.len()], page.rule, page.canvas.inks.ink);
    }
    let [corner, right, above] = [corners[3], corners[2], corners[0]];
    page.edge_length("x", picture.lengths[0], [corner, right]);
    page.edge_length("y", picture.lengths[1], [corner, above]);
    page.footer(&key, outline, pixels_per_length);
    Ok(page.canvas)
}

/// Paints all cells and the lines between them; `origin` is the place of the lower left corner of the box.
fn draw(canvas: &mut Canvas, picture: &CellPicture<'_>, origin: [f64; 2], pixels_per_length: f64, key: &Key<'_>) {
    let cells = &picture.tessellation.cells;
    let pixel = |[x, y]: [f64; 2]| [origin[0] + x * pixels_per_length, origin[1] - y * pixels_per_length];
    // The corners of all images of the cells.
    let mut outlines: Vec<(usize, Vec<[f64; 2]>)> = Vec::new();
    for (index, cell) in cells.iter().enumerate() {
        let corners = |place: [f64; 2]| cell.corners.iter().map(move |[x, y]| pixel([place[0] + x, place[1] + y]));
        outlines.extend(images(picture, index).into_iter().map(|place| (index, corners(place).collect())));
    }
    for (index, corners) in &outlines {
        let Some((first, rest)) = corners.split_first() else { continue };
        // Cells are convex: a fan of triangles fills one.
        for pair in rest.windows(2) {
            canvas.triangle([*first, pair[0], pair[1]], key.colour(*index));
        }
    }
    let spacing = (picture.lengths[0] * picture.lengths[1] / cells.len().max(1) as f64).sqrt() * pixels_per_length;
    let width = (LINE * spacing).min(0.0022 * f64::from(canvas.width.min(canvas.height)));
    if width < THINNEST_LINE {
        return;
    }
    for (index, corners) in &outlines {
        for (number, face) in cells[*index].faces.iter().enumerate() {
            // A face is seen from both sides, and drawn once.
            if face.neighbour > *index || face.neighbour == *index && face.separation > [0.0, 0.0] {
                canvas.line(corners[number], corners[(number + 1) % corners.len()], width, canvas.inks.paper);
            }
        }
    }
}

/// The places of all images of a cell of which a part is in the box.
fn images(picture: &CellPicture<'_>, index: usize) -> Vec<[f64; 2]> {
    let [x, y] = picture.positions[index];
    let corners = &picture.tessellation.cells[index].corners;
    let reach = [0, 1].map(|axis| {
        let parts = corners.iter().map(|corner| picture.positions[index][axis] + corner[axis]);
        parts.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], part| [low.min(part), high.max(part)])
    });
    // A cell is no wider than the box.
    periodic::images(reach, picture.lengths).into_iter().map(|shift| [x + shift[0], y + shift[1]]).collect()
}

/// Ends of the scale that fits values, a few of which may lie beyond.
fn fitting_range(values: &[f64]) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (Some(low), Some(high)) = (sorted.first(), sorted.last()) else { return [0.0, 1.0] };
    let left = (BEYOND * sorted.len() as f64) as usize;
    let inner = [sorted[left], sorted[sorted.len() - 1 - left]];
    let cut = left > 0 && high - low > MUCH_LONGER * (inner[1] - inner[0]) && inner[1] > inner[0];
    if cut { inner } else { [*low, *high] }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn picture<'a>(
        lengths: [f64; 2],
        positions: &'a [[f64; 2]],
        tessellation: &'a Tessellation,
        species: &'a [u32],
        names: &'a [String],
    ) -> CellPicture<'a> {
        CellPicture {
            lengths,
            positions,
            tessellation,
            species,
            species_names: names,
            shown: None,
            title: "",
            subtitle: "",
        }
    }

    #[test]
    fn images_are_those_with_a_part_in_the_box() {
        let positions = [[0.5, 2.0], [2.0, 2.0], [3.5, 2.0], [2.0, 0.0]];
        let tessellation = Tessellation::new([4.0, 4.0], &positions);
        let names = ["A".to_owned()];
        let picture = picture([4.0, 4.0], &positions, &tessellation, &[0; 4], &names);
        assert_eq!(images(&picture, 1), [[2.0, 2.0]], "inside");
        // Cut by the lower edge, the one at its corner by both.
        assert!(images(&picture, 3).contains(&[2.0, 4.0]), "{:?}", images(&picture, 3));
        // All images together cover the box: what they show of it adds up to its area.
        let lone = [[1.0, 3.5]];
        let whole = Tessellation::new([4.0, 4.0], &lone);
        let one = self::picture([4.0, 4.0], &lone, &whole, &[0], &names);
        assert_eq!(images(&one, 0).len(), 4, "a cell as large as the box");
    }

    #[test]
    fn every_face_is_a_line_once() {
        let positions: Vec<[f64; 2]> = (0..16).map(|site| [f64::from(site % 4), f64::from(site / 4) + 0.5]).collect();
        let tessellation = Tessellation::new([4.0, 4.0], &positions);
        let names = ["A".to_owned()];
        let picture = picture([4.0, 4.0], &positions, &tessellation, &[0; 16], &names);
        let style = Snapshot { width: Some(190), height: Some(190), ..Snapshot::default() };
        let canvas = lay_out(&picture, &style, Theme::Light).unwrap();
        // Cells centred on the left edge show on the right too: 20 of two triangles each. Each of 32 faces once, and once
        // more the 12 that belong to those cells, which have the lower numbers. Four lines are the box.
        let shapes = || canvas.batches.iter().flat_map(|batch| &batch.shapes);
        let lines = shapes().filter(|shape| shape.kind == 0).count();
        let triangles = shapes().filter(|shape| shape.kind == 4).count();
        assert_eq!((triangles, lines), (40, 32 + 12 + 4));
    }

    #[test]
    fn a_few_extreme_cells_do_not_set_the_scale() {
        let mut values: Vec<f64> = (0..1000).map(|index| 1.0 + 1e-3 * f64::from(index)).collect();
        assert_eq!(fitting_range(&values), [1.0, 1.999]);
        values[3] = 1e6;
        let ends = fitting_range(&values);
        assert!(ends[1] < 2.0 && ends[0] < 1.01, "{ends:?}");
        assert_eq!(fitting_range(&[f64::NAN]), [0.0, 1.0]);
        assert_eq!(fitting_range(&[1.0, 1e6]), [1.0, 1e6], "few cells");
    }

    #[test]
    fn lists_have_to_fit() {
        let positions = [[0.5, 0.5]];
        let tessellation = Tessellation::new([1.0, 1.0], &positions);
        let names = ["A".to_owned()];
        let right = picture([1.0, 1.0], &positions, &tessellation, &[0], &names);
        let style = Snapshot::default();
        assert!(lay_out(&right, &style, Theme::Dark).is_ok());
        let shown = Some(ShownValues { label: "x", values: &[] });
        for wrong in [
            CellPicture { species: &[], ..right },
            CellPicture { species: &[1], ..right },
            CellPicture { shown, ..right },
            CellPicture { lengths: [1.0, 0.0], ..right },
        ] {
            assert!(matches!(lay_out(&wrong, &style, Theme::Dark), Err(PlotError::Input(_))));
        }
    }
}
