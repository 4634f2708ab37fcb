// Room for the corners of a Voronoi cell: enough for particles that do not crowd around an empty circle.
const CORNERS: u32 = 24u;
