// Room for the corners of a Voronoi cell with a crowd around an empty circle.
const CORNERS: u32 = 1024u;
