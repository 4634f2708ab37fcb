// Six walls have three components of momentum each.
const REPORTED: u32 = 34u;
