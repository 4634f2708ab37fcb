// Room for the corners of a Voronoi cell with many neighbours.
const CORNERS: u32 = 128u;
