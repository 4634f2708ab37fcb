//! The Voronoi tessellation of points in a periodic plane, in float64.
//!
//! Points are taken to a lattice of 2⁻⁵⁰ of the box, so that copies of them in neighbouring boxes are exact, and
//! triangulated after Delaunay together with the copies around the box. A cell is final once every circle about one of
//! its corners through its point lies where all copies are known; the margin grows until all cells are. Two cells
//! that share a face are apart by no more than a box edge on each axis, so one box on each side is always enough.

use std::collections::HashSet;

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

/// The Voronoi cells of points in a periodic plane.
///
/// ```
/// use mesoscope::tessellation::Tessellation;
/// let square = Tessellation::new([2.0, 2.0], &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
/// assert!(square.cells.iter().all(|cell| cell.faces.len() == 4 && (cell.volume - 1.0).abs() < 1e-12));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tessellation {
    /// The cells, in order of the points.
    pub cells: Vec<Cell>,
}

/// What is nearer to a point than to any other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cell {
    /// The area.
    pub volume: f64,
    /// The corners relative to the point, counter-clockwise.
    pub corners: Vec<[f64; 2]>,
    /// The faces, counter-clockwise; each begins at the corner of the same index.
    pub faces: Vec<Face>,
}

/// A face of cell k, of two cells k and l.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// The index of l. In a small box l may be k itself, and the same for several faces.
    pub neighbour: usize,
    /// rₖ - rₗ, to the image of l that is behind the face.
    pub separation: [f64; 2],
    /// The length of the face.
    pub length: f64,
    /// How far the middle of the face is from the middle between the points, along t = (-e.y, e.x), where
    /// e = (rₖ - rₗ)/|rₖ - rₗ|. Of the other sign from the other side, as t is.
    pub offset: f64,
    /// Whole box edges s between the image of l behind the face and that nearest to k: `separation` is the minimal image
    /// of rₖ - rₗ, which is in [-½, ½) of the box, less s of them. Each is -1, 0 or 1.
    pub image: [i8; 2],
}

impl Face {
    /// |rₖ - rₗ|.
    pub(crate) fn distance(&self) -> f64 {
        self.separation[0].hypot(self.separation[1])
    }

    /// The unit vector e from l to k.
    pub(crate) fn direction(&self) -> [f64; 2] {
        let distance = self.distance();
        self.separation.map(|component| component / distance)
    }

    /// [`Self::image`] as a number, (s.x + 1) + 3 (s.y + 1).
    #[must_use]
    pub fn image_code(&self) -> u32 {
        ((self.image[0] + 1) + 3 * (self.image[1] + 1)) as u32
    }
}

/// The box in units of positions as they are given.
const BOX: i64 = 1 << 50;
/// Faces as short as this part of the longer box edge are none: rounding makes them where more than three cells meet.
const SHORTEST_FACE: f64 = 1.0 / (1_u64 << 44) as f64;
/// Copies around the box to begin with, in mean distances of points.
const FIRST_MARGIN: f64 = 4.0;

impl Tessellation {
    /// The tessellation of points in a box with such positive edge lengths.
    ///
    /// Positions are taken modulo the box. Points that coincide are parted: the j-th of them, in order of index, is moved
    /// by (j, j²) times 2⁻³² of the box.
    #[must_use]
    pub fn new(lengths: [f64; 2], positions: &[[f64; 2]]) -> Self {
        let turns = |position: &[f64; 2]| {
            std::array::from_fn(|axis| {
                let turns = position[axis] / lengths[axis];
                ((turns - turns.floor()) * BOX as f64).round() as i64 % BOX
            })
        };
        Self::of_turns(lengths, positions.iter().map(turns).collect())
    }

    /// The tessellation of points given as fractions of the box in units of 2⁻³², as in [`crate::state::State`].
    #[must_use]
    pub fn of_fractions(lengths: [f64; 2], fractions: &[[u32; 3]]) -> Self {
        let turns = |fraction: &[u32; 3]| [fraction[0], fraction[1]].map(|fraction| i64::from(fraction) << 18);
        Self::of_turns(lengths, fractions.iter().map(turns).collect())
    }

    fn of_turns(lengths: [f64; 2], mut turns: Vec<[i64; 2]>) -> Self {
        // Parting may meet others, so until all are apart.
        while part(&mut turns, |turns, by| [0, 1].map(|axis| (turns[axis] + (i64::from(by[axis]) << 18)) % BOX)) {}
        let points = Points::new(lengths, turns);
        let mut margin = FIRST_MARGIN * (lengths[0] * lengths[1] / points.turns.len().max(1) as f64).sqrt();
        loop {
            let margins = [0, 1].map(|axis| ((margin / points.unit(axis)) as i64).min(points.edges[axis]));
            if let Some(cells) = points.cells(margins) {
                return Self { cells };
            }
            if margins == points.edges {
                // Lengths that are none.
                return Self { cells: vec![Cell::default(); points.turns.len()] };
            }
            margin *= 2.0;
        }
    }
}

/// Parts particles that are at exactly the same place, so that every cell has a volume: the j-th of them, in order of
/// index, is moved by (j, j²) times 2⁻³² of the box, onto a convex curve, where none is enclosed by the others. Says whether
/// there were any.
///
/// ```
/// use mesoscope::tessellation::part_coincident;
///
/// let mut places = [[7, 7, 0], [1, 2, 0], [7, 7, 0]];
/// assert!(part_coincident(&mut places));
/// assert_eq!(places, [[7, 7, 0], [1, 2, 0], [8, 8, 0]]);
/// assert!(!part_coincident(&mut places));
/// ```
pub fn part_coincident(fractions: &mut [[u32; 3]]) -> bool {
    part(fractions, |place, by| [place[0].wrapping_add(by[0]), place[1].wrapping_add(by[1]), place[2]])
}

fn part<Place: Copy + Ord>(places: &mut [Place], moved: impl Fn(Place, [u32; 2]) -> Place) -> bool {
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_unstable_by_key(|&index| (places[index], index));
    let mut found = false;
    let mut first = 0;
    for after in 1..=order.len() {
        if after < order.len() && places[order[after]] == places[order[first]] {
            continue;
        }
        for member in 1..after - first {
            let index = order[first + member];
            let number = member as u32;
            places[index] = moved(places[index], [number, number.wrapping_mul(number)]);
            found = true;
        }
        first = after;
    }
    found
}

/// A point or one of its copies.
struct Site {
    /// Where it is, the longer box edge being 1.
    position: Point2<f64>,
    point: usize,
    /// Whole boxes from the point to this copy.
    boxes: [i8; 2],
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// A face of a point with what names it from both sides.
struct Side {
    face: Face,
    /// From the point to its neighbour in units of the lattice.
    to: [i64; 2],
    /// The smaller index, the larger, and whole boxes from the first point to the image of the second.
    name: (usize, usize, [i8; 2]),
}

/// Points on a lattice so fine that nothing is lost, on which copies of them are exact.
struct Points {
    lengths: [f64; 2],
    /// Positions as given, in units of 1 / [`BOX`] of the box.
    turns: Vec<[i64; 2]>,
    /// Positions in units of the lattice.
    places: Vec<[i64; 2]>,
    /// The box in units of the lattice.
    edges: [i64; 2],
    /// A unit of the lattice, the longer box edge being 1; a power of two, so that coordinates are exact.
    scales: [f64; 2],
}

impl Points {
    fn new(lengths: [f64; 2], turns: Vec<[i64; 2]>) -> Self {
        let longest = lengths[0].max(lengths[1]);
        // A longer box would have coordinates too small to triangulate.
        let shape = lengths.map(|length| (length / longest).max(1e-25));
        let scales = shape.map(|edge| edge.log2().floor().exp2() / BOX as f64);
        let edges = [0, 1].map(|axis| (shape[axis] / scales[axis]).round() as i64);
        let place = |turns: &[i64; 2]| {
            [0, 1].map(|axis| ((i128::from(turns[axis]) * i128::from(edges[axis]) + i128::from(BOX / 2)) >> 50) as i64)
        };
        Self { lengths, places: turns.iter().map(place).collect(), turns, edges, scales }
    }

    /// The length of a unit of the lattice.
    fn unit(&self, axis: usize) -> f64 {
        self.lengths[axis] / self.edges[axis] as f64
    }

    fn vector(&self, units: [i64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| units[axis] as f64 * self.unit(axis))
    }

    /// The cells, if copies of the points up to `margins` outside the box are enough to be sure of them.
    fn cells(&self, margins: [i64; 2]) -> Option<Vec<Cell>> {
        let count = self.turns.len();
        let triangulation = DelaunayTriangulation::<Site>::bulk_load_stable(self.sites(margins)).ok()?;
        let shortest = SHORTEST_FACE * self.lengths[0].max(self.lengths[1]);
        let mut cells = Vec::with_capacity(count);
        let mut names = Vec::with_capacity(count);
        let mut dropped = HashSet::new();
        // The points themselves come first.
        for (point, vertex) in triangulation.vertices().take(count).enumerate() {
            let mut sides = Vec::with_capacity(8);
            for edge in vertex.out_edges() {
                if edge.is_outer_edge() {
                    return None;
                }
                sides.push(self.side(point, edge.to().data()));
            }
            let cell = self.polygon(&sides)?;
            if !self.is_final(&cell, point, margins) {
                return None;
            }
            // Rounding differs between the two sides of a face.
            let short = cell.faces.iter().zip(&sides).filter(|(face, _)| face.length <= shortest);
            dropped.extend(short.map(|(_, side)| side.name));
            names.push(sides.iter().map(|side| side.name).collect::<Vec<_>>());
            cells.push(cell);
        }
        for (cell, names) in cells.iter_mut().zip(&names) {
            if names.iter().any(|name| dropped.contains(name)) {
                let mut kept = names.iter().map(|name| !dropped.contains(name));
                cell.faces.retain(|_| kept.next().unwrap_or(true));
                let mut kept = names.iter().map(|name| !dropped.contains(name));
                cell.corners.retain(|_| kept.next().unwrap_or(true));
            }
        }
        (cells.len() == count).then_some(cells)
    }

    /// The points, and their copies around the box.
    fn sites(&self, margins: [i64; 2]) -> Vec<Site> {
        let site = |point: usize, boxes: [i8; 2]| {
            let place = [0, 1].map(|axis| self.places[point][axis] + i64::from(boxes[axis]) * self.edges[axis]);
            let known = |axis: usize| (-margins[axis]..=self.edges[axis] + margins[axis]).contains(&place[axis]);
            let position = Point2::new(place[0] as f64 * self.scales[0], place[1] as f64 * self.scales[1]);
            (known(0) && known(1)).then_some(Site { position, point, boxes })
        };
        let points = || 0..self.turns.len();
        let mut sites: Vec<Site> = points().filter_map(|point| site(point, [0, 0])).collect();
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [x, y])).filter(|boxes| *boxes != [0, 0]);
        for boxes in around {
            sites.extend(points().filter_map(|point| site(point, boxes)));
        }
        sites
    }

    /// The side that a point sees of the face between it and a site; not yet how long it is.
    fn side(&self, point: usize, site: &Site) -> Side {
        let to = [0, 1].map(|axis| {
            self.places[site.point][axis] - self.places[point][axis] + i64::from(site.boxes[axis]) * self.edges[axis]
        });
        let separation = self.vector(to).map(|component| -component);
        let image = std::array::from_fn(|axis| {
            let difference = self.turns[point][axis] - self.turns[site.point][axis];
            site.boxes[axis] - (difference + BOX / 2).div_euclid(BOX) as i8
        });
        let back = site.boxes.map(|boxes| -boxes);
        let name = (point, site.point, site.boxes).min((site.point, point, back));
        Side { face: Face { neighbour: site.point, separation, length: 0.0, offset: 0.0, image }, to, name }
    }

    /// The cell with such faces in counter-clockwise order, each of which reaches from the centre of the circle through the
    /// point, the neighbour before and the neighbour behind it to that of the next.
    fn polygon(&self, sides: &[Side]) -> Option<Cell> {
        let count = sides.len();
        if count < 3 {
            return None;
        }
        let corner = |index: usize| self.centre(sides[(index + count - 1) % count].to, sides[index].to);
        let corners: Vec<_> = (0..count).map(corner).collect();
        let mut cell = Cell { volume: 0.0, faces: Vec::with_capacity(count), corners };
        for (index, side) in sides.iter().enumerate() {
            let [from, to] = [cell.corners[index], cell.corners[(index + 1) % count]];
            let direction = side.face.direction();
            let along = |vector: [f64; 2]| direction[0] * vector[1] - direction[1] * vector[0];
            let length = along([from[0] - to[0], from[1] - to[1]]);
            // The middle between the points is on the line through them, of which only the other component counts.
            let offset = along([0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])]);
            cell.faces.push(Face { length, offset, ..side.face });
            cell.volume += 0.5 * (from[0] * to[1] - from[1] * to[0]);
        }
        Some(cell)
    }

    /// The centre of the circle through the origin and two points, from the shorter two edges of their triangle: with a
    /// long one the area of a thin triangle would be lost in rounding.
    fn centre(&self, a: [i64; 2], b: [i64; 2]) -> [f64; 2] {
        let between = self.vector([b[0] - a[0], b[1] - a[1]]);
        let [a, b] = [self.vector(a), self.vector(b)];
        let dot = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
        // The centre is as far along an edge as the edge's middle.
        let mut edges =
            [(a, 0.5 * dot(a, a)), (b, 0.5 * dot(b, b)), (between, 0.5 * dot(between, [a[0] + b[0], a[1] + b[1]]))];
        edges.sort_by(|(u, _), (v, _)| dot(*u, *u).total_cmp(&dot(*v, *v)));
        let [(u, along_u), (v, along_v), _] = edges;
        let area = u[0] * v[1] - u[1] * v[0];
        [(along_u * v[1] - along_v * u[1]) / area, (along_v * u[0] - along_u * v[0]) / area]
    }

    /// Whether no unknown copy of a point can reach a cell: one that did would be in the circle about a corner through the
    /// cell's point.
    fn is_final(&self, cell: &Cell, point: usize, margins: [i64; 2]) -> bool {
        (0..2).all(|axis| {
            let below = (self.places[point][axis] + margins[axis]) as f64 * self.unit(axis);
            let above = (self.edges[axis] + margins[axis] - self.places[point][axis]) as f64 * self.unit(axis);
            margins[axis] == self.edges[axis]
                || cell.corners.iter().all(|corner| {
                    let radius = corner[0].hypot(corner[1]);
                    radius - corner[axis] < below && radius + corner[axis] < above
                })
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

    use super::*;
    use crate::noise;

    /// Points drawn at random in a box.
    fn random(lengths: [f64; 2], count: u32, seed: u64) -> Vec<[f64; 2]> {
        let key = noise::seed_key(seed, u32::MAX);
        let place = |point| {
            let words = noise::threefry2x32([point, 0], key);
            std::array::from_fn(|axis| (noise::centred_uniform(words[axis]) + 0.5) * lengths[axis])
        };
        (0..count).map(place).collect()
    }

    fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
        a[0] * b[0] + a[1] * b[1]
    }

    #[track_caller]
    fn assert_close(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected} ± {tolerance}");
    }

    /// The area of a cell by clipping the plane with every copy of every point in the 24 boxes around.
    fn clipped_area(lengths: [f64; 2], positions: &[[f64; 2]], cell: usize) -> f64 {
        let [x, y] = lengths;
        let mut polygon = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
        for (other, position) in positions.iter().enumerate() {
            for boxes in (-2..=2).flat_map(|x| (-2..=2).map(move |y| [x, y])) {
                if other == cell && boxes == [0, 0] {
                    continue;
                }
                let to: [f64; 2] = std::array::from_fn(|axis| {
                    position[axis] - positions[cell][axis] + f64::from(boxes[axis]) * lengths[axis]
                });
                let beyond = |corner: [f64; 2]| dot(corner, to) - 0.5 * dot(to, to);
                let mut clipped = Vec::new();
                for index in 0..polygon.len() {
                    let [here, next] = [polygon[index], polygon[(index + 1) % polygon.len()]];
                    let [out, next_out] = [beyond(here), beyond(next)];
                    if out <= 0.0 {
                        clipped.push(here);
                    }
                    if (out <= 0.0) != (next_out <= 0.0) {
                        let part = out / (out - next_out);
                        clipped.push(std::array::from_fn(|axis| here[axis] + part * (next[axis] - here[axis])));
                    }
                }
                polygon = clipped;
            }
        }
        let edges = (0..polygon.len()).map(|index| (polygon[index], polygon[(index + 1) % polygon.len()]));
        edges.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
    }

    /// All that holds of any tessellation.
    #[track_caller]
    fn assert_consistent(lengths: [f64; 2], tessellation: &Tessellation) {
        let volume = lengths[0] * lengths[1];
        let longest = lengths[0].max(lengths[1]);
        let total: f64 = tessellation.cells.iter().map(|cell| cell.volume).sum();
        assert_close(total, volume, 1e-12 * volume);
        for (index, cell) in tessellation.cells.iter().enumerate() {
            assert_eq!(cell.corners.len(), cell.faces.len());
            let mut closure = [0.0; 2];
            let mut parts = 0.0;
            for face in &cell.faces {
                assert!(face.length > 0.0 && face.image.iter().all(|boxes| boxes.abs() <= 1));
                for axis in 0..2 {
                    closure[axis] += face.length * face.direction()[axis];
                    assert!(face.separation[axis].abs() <= lengths[axis] * (1.0 + 1e-12));
                }
                parts += 0.25 * face.length * face.distance();
                let back = face.separation.map(|component| -component);
                let same = |other: &&Face| other.neighbour == index && other.separation == back;
                let other = tessellation.cells[face.neighbour].faces.iter().find(same).expect("the other side");
                assert_close(other.length, face.length, 1e-11 * longest);
                assert_close(other.offset, -face.offset, 1e-11 * longest);
            }
            assert_close(closure[0], 0.0, 1e-11 * longest);
            assert_close(closure[1], 0.0, 1e-11 * longest);
            assert_close(parts, cell.volume, 1e-12 * volume);
        }
    }

    fn faces(tessellation: &Tessellation) -> usize {
        tessellation.cells.iter().map(|cell| cell.faces.len()).sum()
    }

    #[test]
    fn cells_fill_the_box_and_have_six_neighbours_on_average() {
        for (lengths, count) in [([10.0, 10.0], 3000), ([30.0, 4.0], 1000), ([1e-3, 1e-3], 50)] {
            let tessellation = Tessellation::new(lengths, &random(lengths, count, 3));
            assert_consistent(lengths, &tessellation);
            assert_eq!(faces(&tessellation), 6 * count as usize);
        }
    }

    #[test]
    fn areas_are_those_that_half_planes_cut_out() {
        for (lengths, count) in [([3.0, 2.0], 60), ([100.0, 0.5], 25), ([0.2, 7.0], 9)] {
            let positions = random(lengths, count, 5);
            let tessellation = Tessellation::new(lengths, &positions);
            for (index, cell) in tessellation.cells.iter().enumerate() {
                // Positions are rounded to 2⁻⁵⁰ of the box.
                assert_close(cell.volume, clipped_area(lengths, &positions, index), 1e-12 * lengths[0] * lengths[1]);
            }
        }
    }

    #[test]
    fn few_points_border_their_own_copies() {
        for count in 1..=9 {
            for lengths in [[1.0, 1.0], [100.0, 0.5], [0.3, 40.0]] {
                let tessellation = Tessellation::new(lengths, &random(lengths, count, 7));
                assert_consistent(lengths, &tessellation);
                // One point alone is a lattice.
                assert_eq!(faces(&tessellation), if count == 1 { 4 } else { 6 * count as usize });
            }
        }
        assert_eq!(Tessellation::new([1.0, 1.0], &[]), Tessellation::default());
    }

    #[test]
    fn lattices_have_no_faces_where_four_cells_meet() {
        for (columns, rows) in [(1, 1), (2, 2), (3, 7), (70, 70)] {
            let lengths = [f64::from(columns), 1.7 * f64::from(rows)];
            let sites = (0..columns).flat_map(|x| (0..rows).map(move |y| [f64::from(x), 1.7 * f64::from(y)]));
            let tessellation = Tessellation::new(lengths, &sites.collect::<Vec<_>>());
            assert_consistent(lengths, &tessellation);
            for cell in &tessellation.cells {
                assert_eq!(cell.faces.len(), 4);
                assert_close(cell.volume, 1.7, 1e-11);
            }
        }
        let height = 0.75_f64.sqrt();
        let sites = (0..12).flat_map(|x| (0..8).map(move |y| [f64::from(x) + 0.5 * f64::from(y % 2), f64::from(y)]));
        let sites: Vec<_> = sites.map(|[x, y]| [x, y * height]).collect();
        let tessellation = Tessellation::new([12.0, 8.0 * height], &sites);
        assert_consistent([12.0, 8.0 * height], &tessellation);
        for face in tessellation.cells.iter().flat_map(|cell| &cell.faces) {
            assert_close(face.length, 1.0 / 3.0_f64.sqrt(), 1e-12);
        }
        assert_eq!(faces(&tessellation), 6 * 96);
    }

    #[test]
    fn points_that_coincide_are_parted() {
        for count in [2, 3, 40] {
            let lengths = [5.0, 3.0];
            let mut positions = random(lengths, 20, 9);
            positions.extend(vec![[4.999, 1.0]; count]);
            let tessellation = Tessellation::new(lengths, &positions);
            assert_consistent(lengths, &tessellation);
            assert!(tessellation.cells.iter().all(|cell| cell.volume > 0.0));
            assert_eq!(faces(&tessellation), 6 * positions.len());
        }
        let mut fractions = vec![[7, u32::MAX, 0]; 3];
        assert!(part_coincident(&mut fractions));
        assert_eq!(fractions, [[7, u32::MAX, 0], [8, 0, 0], [9, 3, 0]]);
        assert!(!part_coincident(&mut fractions));
    }

    #[test]
    fn fractions_of_the_box_are_exact() {
        // Cells 2⁻³² of the box apart, across its edge.
        let fractions = [[u32::MAX, 5, 0], [0, 5, 0], [1, 6, 0], [1 << 31, 1 << 30, 0]];
        let lengths = [3.0, 2.0];
        let tessellation = Tessellation::of_fractions(lengths, &fractions);
        assert_consistent(lengths, &tessellation);
        let face = tessellation.cells[0].faces.iter().find(|face| face.neighbour == 1).unwrap();
        assert_eq!(face.separation, [-3.0 / 4_294_967_296.0, 0.0]);
        assert_eq!((face.image, face.image_code()), ([0, 0], 4));
    }

    /// dV/dt = Σ l [e·U/2 + (c·U)/r] against a difference over 2·10⁻⁵ mean distances.
    #[test]
    fn volumes_change_as_their_faces_move() {
        let lengths = [12.0, 9.0];
        let (positions, velocities) = (random(lengths, 108, 11), random([2.0, 2.0], 108, 13));
        let at = |time: f64| {
            let moved = positions
                .iter()
                .zip(&velocities)
                .map(|(position, velocity)| std::array::from_fn(|axis| position[axis] + time * (velocity[axis] - 1.0)));
            Tessellation::new(lengths, &moved.collect::<Vec<[f64; 2]>>())
        };
        let [before, now, after] = [at(-1e-5), at(0.0), at(1e-5)];
        for (index, cell) in now.cells.iter().enumerate() {
            let rate: f64 = cell
                .faces
                .iter()
                .map(|face| {
                    let [e, r] = [face.direction(), [face.distance(); 2]];
                    let relative = [0, 1].map(|axis| velocities[index][axis] - velocities[face.neighbour][axis]);
                    let turning = face.offset * dot([-e[1], e[0]], relative) / r[0];
                    face.length * (0.5 * dot(e, relative) + turning)
                })
                .sum();
            let difference = (after.cells[index].volume - before.cells[index].volume) / 2e-5;
            assert_close(rate, difference, 1e-7);
        }
    }
}
