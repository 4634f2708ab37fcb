//! Counter-based random words: the same words on the host as in the shaders.
//!
//! A word depends on (seed, stream, step, two counters) and on nothing else, so it does not matter who draws it, when,
//! or how often. The counters of a pair are its smaller and its larger particle id.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One stream number per use of random numbers; two uses never share one.
pub mod stream {
    /// Noise of a pair in DPD.
    pub const PAIR: u32 = 1;
    /// Initial positions.
    pub const POSITION: u32 = 2;
    /// Initial velocities.
    pub const VELOCITY: u32 = 3;
    /// Noise of the bath on a mesh node.
    pub const MESH: u32 = 4;
    /// The bath of a pair at the time it enters the neighbour list.
    pub const PAIR_START: u32 = 5;
    /// Noise of the bath on a particle's coordinates.
    pub const PARTICLE: u32 = 6;
    /// Jumps of a coloured noise.
    pub const JUMP: u32 = 7;
    /// Noise of the bath of a bond.
    pub const BOND: u32 = 8;
    /// Directions of bonds at the start.
    pub const CHAIN: u32 = 9;
    /// Noise of a face of two Voronoi cells.
    pub const FACE: u32 = 10;
}

/// A counter-based random number generator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum Generator {
    /// Word w of pcg4d: the fast path (default).
    #[default]
    #[serde(rename = "pcg4d")]
    Pcg4d,
    /// Threefry2x32 with 20 rounds: the conservative choice.
    #[serde(rename = "threefry2x32-20")]
    Threefry2x32,
}

/// One round of the pcg4d hash of Jarzynski and Olano, JCGT 9(3), 2020.
///
/// ```
/// use mesoscope::noise::pcg4d;
/// assert_eq!(pcg4d([1, 2, 3, 4]), [0x3622_cd16, 0xf114_71d8, 0xe110_9b3f, 0x02b9_4c2f]);
/// ```
#[must_use]
pub fn pcg4d(words: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] = words.map(|word| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w] = [x, y, z, w].map(|word| word ^ (word >> 16));
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

/// Threefry2x32 with 20 rounds: Salmon et al. 2011, doi:10.1145/2063384.2063405.
///
/// ```
/// use mesoscope::noise::threefry2x32;
/// // A known answer of the authors' library.
/// let counter = [0x243f_6a88, 0x85a3_08d3];
/// assert_eq!(threefry2x32(counter, [0x1319_8a2e, 0x0370_7344]), [0xc492_3a9c, 0x483d_f7a0]);
/// ```
#[must_use]
pub fn threefry2x32(counter: [u32; 2], key: [u32; 2]) -> [u32; 2] {
    const ROTATIONS: [u32; 8] = [13, 15, 26, 6, 17, 29, 16, 24];
    let keys = [key[0], key[1], 0x1BD1_1BDA ^ key[0] ^ key[1]];
    let mut x = [counter[0].wrapping_add(keys[0]), counter[1].wrapping_add(keys[1])];
    for round in 0..20 {
        x[0] = x[0].wrapping_add(x[1]);
        x[1] = x[1].rotate_left(ROTATIONS[round % 8]) ^ x[0];
        if round % 4 == 3 {
            let injection = round / 4 + 1;
            x[0] = x[0].wrapping_add(keys[injection % 3]);
            x[1] = x[1].wrapping_add(keys[(injection + 1) % 3]).wrapping_add(injection as u32);
        }
    }
    x
}

/// The key of one stream over all steps.
///
/// ```
/// use mesoscope::noise::{seed_key, stream, threefry2x32, step_key};
///
/// // Of step 5 of the run with seed 1: the steps of a stream differ in the counter alone.
/// let key = seed_key(1, stream::PAIR);
/// assert_eq!(step_key(1, stream::PAIR, 5), threefry2x32([5, 0], key));
/// assert_ne!(key, seed_key(1, stream::MESH));
/// ```
#[must_use]
pub fn seed_key(seed: u64, stream: u32) -> [u32; 2] {
    threefry2x32([stream, 0], [seed as u32, (seed >> 32) as u32])
}

/// The seed of a run with that seed whose particles were read somewhere, by the CRC-32 of what was read: noise must not be what has moved
/// them before.
///
/// ```
/// use mesoscope::noise::seed_from_state;
///
/// assert_ne!(seed_from_state(1, 0xcafe), seed_from_state(1, 0xcaff));
/// assert_ne!(seed_from_state(1, 0xcafe), seed_from_state(2, 0xcafe));
/// ```
#[must_use]
pub fn seed_from_state(seed: u64, checksum: u32) -> u64 {
    // Of the words of this key `seed_key` has those whose second counter is zero.
    let [low, high] = threefry2x32([checksum, 1], [seed as u32, (seed >> 32) as u32]);
    u64::from(high) << 32 | u64::from(low)
}

/// The key of one stream at one step, from which all words of that step are drawn.
///
/// ```
/// use mesoscope::noise::{step_key, stream};
///
/// // Steps are counted in 64 bits: nothing repeats after 2³² of them.
/// assert_ne!(step_key(1, stream::PAIR, 7), step_key(1, stream::PAIR, 7 + (1 << 32)));
/// ```
#[must_use]
pub fn step_key(seed: u64, stream: u32, step: u64) -> [u32; 2] {
    threefry2x32([step as u32, (step >> 32) as u32], seed_key(seed, stream))
}

/// The two random words of a pair of counters under a step's key.
///
/// ```
/// use mesoscope::noise::{Generator, step_key, stream, words};
///
/// // The noise of particles 7 and 12 at step 1000 of the run with seed 1: the same whenever it is drawn.
/// let key = step_key(1, stream::PAIR, 1000);
/// let noise = words(Generator::Threefry2x32, key, [7, 12]);
/// assert_ne!(noise, words(Generator::Threefry2x32, key, [7, 13]));
/// assert_ne!(noise, words(Generator::Threefry2x32, step_key(1, stream::PAIR, 1001), [7, 12]));
/// ```
#[must_use]
pub fn words(generator: Generator, key: [u32; 2], counters: [u32; 2]) -> [u32; 2] {
    match generator {
        Generator::Pcg4d => {
            let hash = pcg4d([counters[0], counters[1], key[0], key[1]]);
            [hash[3], hash[2]]
        }
        Generator::Threefry2x32 => threefry2x32(counters, key),
    }
}

/// The counters of the words of the face between two Voronoi cells.
///
/// In a small box two cells may share several faces, each with another image of the other. `image` is the code of the
/// face's image as the cell `smaller` sees it, the tessellation's `Face::image_code`; `part` tells the draws of one
/// face from each other. There are at most 2²⁸ cells.
///
/// ```
/// use mesoscope::noise::face_counters;
///
/// // Cells 3 and 8 of a small box touch twice: over the boundary the face has noise of its own, and each draw too.
/// let [across, inside] = [1, 0].map(|image| face_counters(3, 8, image, 0));
/// assert_ne!(across, inside);
/// assert_ne!(inside, face_counters(3, 8, 0, 1));
/// ```
#[must_use]
pub fn face_counters(smaller: u32, larger: u32, image: u32, part: u32) -> [u32; 2] {
    [smaller | image << 28, larger | part << 28]
}

/// A word as a number in (-½, ½): its top 24 bits, centred so that the mean is exactly zero.
///
/// ```
/// use mesoscope::noise::centred_uniform;
/// let [lowest, highest] = [0x8000_0000, 0x7fff_ffff].map(centred_uniform);
/// assert_eq!(lowest, -highest);
/// assert_eq!(highest, 0.5 - 0.5_f64.powi(25));
/// ```
#[must_use]
pub fn centred_uniform(word: u32) -> f64 {
    (f64::from((word as i32) >> 8) + 0.5) / 16_777_216.0
}

/// Two words as one standard Gaussian number, by Box and Muller's transform.
///
/// ```
/// use mesoscope::noise::{gaussian, seed_key, threefry2x32};
/// let key = seed_key(1, 99);
/// let numbers = || (0..10_000).map(|counter| gaussian(threefry2x32([counter, 0], key)));
/// let moment = |power| numbers().map(|number| number.powi(power)).sum::<f64>() / 10_000.0;
/// // 0, 1 and 3 within four standard errors.
/// assert!(moment(1).abs() < 0.04 && (moment(2) - 1.0).abs() < 0.06 && (moment(4) - 3.0).abs() < 0.4);
/// ```
#[must_use]
pub fn gaussian(words: [u32; 2]) -> f64 {
    let radius_uniform = centred_uniform(words[0]) + 0.5;
    let angle = std::f64::consts::TAU * centred_uniform(words[1]);
    (-2.0 * radius_uniform.ln()).sqrt() * angle.cos()
}

/// Two words as two independent standard Gaussian numbers; the first is that of [`gaussian`].
///
/// ```
/// use mesoscope::noise::{gaussian, two_gaussians};
/// // Radius √(2 log 2), and a quarter of a turn.
/// let [x, y] = two_gaussians([0, 0x4000_0000]);
/// assert!(x.abs() < 1e-6 && (y - (2.0 * 2_f64.ln()).sqrt()).abs() < 1e-6);
/// assert_eq!(x, gaussian([0, 0x4000_0000]));
/// ```
#[must_use]
pub fn two_gaussians(words: [u32; 2]) -> [f64; 2] {
    let radius_uniform = centred_uniform(words[0]) + 0.5;
    let angle = std::f64::consts::TAU * centred_uniform(words[1]);
    let radius = (-2.0 * radius_uniform.ln()).sqrt();
    [radius * angle.cos(), radius * angle.sin()]
}

/// Two words as a unit vector, even over all directions of so many dimensions; zero on axes beyond.
///
/// ```
/// use mesoscope::noise::{direction, seed_key, threefry2x32};
/// let words = threefry2x32([0, 0], seed_key(1, 9));
/// assert_eq!(direction(words, 2)[2], 0.0);
/// let length = direction(words, 3).iter().map(|part| part * part).sum::<f64>();
/// assert!((length - 1.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn direction(words: [u32; 2], dimension: usize) -> [f64; 3] {
    let [height, turn] = words.map(|word| 2.0 * centred_uniform(word));
    let (sine, cosine) = (std::f64::consts::PI * turn).sin_cos();
    match dimension {
        1 => [height.signum(), 0.0, 0.0],
        2 => [cosine, sine, 0.0],
        _ => {
            let across = (1.0 - height * height).sqrt();
            [across * cosine, across * sine, height]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known answers of Random123's `kat_vectors`.
    #[test]
    fn threefry_gives_the_published_answers() {
        assert_eq!(threefry2x32([0, 0], [0, 0]), [0x6b20_0159, 0x99ba_4efe]);
        assert_eq!(threefry2x32([0x243f_6a88, 0x85a3_08d3], [0x1319_8a2e, 0x0370_7344]), [0xc492_3a9c, 0x483d_f7a0]);
    }

    #[test]
    fn seed_and_step_are_separate_words() {
        assert_ne!(step_key(1, 1, 2), step_key(2, 1, 1));
        assert_ne!(step_key(1, 1, 1 << 32), step_key(1, 1, 0));
    }
}
