// Faces turn at the rate that follows from the geometry; mass has the logarithmic mean of the densities.
const TURNING: f32 = 1.0;

fn density_between(mine: f32, theirs: f32) -> f32 {
    // (a - b) / ln(a/b) = (a + b)/2 x / artanh(x), by its series where the quotient loses digits.
    let mean = 0.5 * (mine + theirs);
    let x = 0.5 * (mine - theirs) / mean;
    let square = x * x;
    let series = 1.0 + square * (0.33333334 + square * (0.2 + square * (0.14285715 + square * (0.11111111
        + square * 0.09090909))));
    let direct = 0.5 * log(mine / theirs) / select(x, 1.0, x == 0.0);
    return mean / select(direct, series, square < 0.09);
}
