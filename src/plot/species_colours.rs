//! Colours for any number of species.

use super::color_map::{oklab, srgb_from_oklab};
use super::palette::{Colour, Inks};
use std::f64::consts::TAU;

/// With more species than this, colours repeat: no reader could tell them apart.
const MOST: usize = 64;

/// A colour for each species: those of the theme, then always the one that is farthest from all before it and from the paper.
pub(super) fn species_colours(inks: &Inks, count: usize) -> Vec<Colour> {
    let mut colours = inks.species.to_vec();
    if count <= colours.len() {
        colours.truncate(count.max(1));
        return colours;
    }
    let candidates = candidates();
    let kept_from = [inks.paper, inks.ink].into_iter().chain(colours.iter().copied());
    let mut distances = vec![f64::INFINITY; candidates.len()];
    let approach = |distances: &mut Vec<f64>, colour: Colour| {
        for (distance, candidate) in distances.iter_mut().zip(&candidates) {
            *distance = distance.min(difference(*candidate, colour));
        }
    };
    for colour in kept_from.collect::<Vec<_>>() {
        approach(&mut distances, colour);
    }
    while colours.len() < count.min(MOST) {
        let farthest = (0..candidates.len()).max_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        let Some(colour) = farthest.map(|index| candidates[index]) else { break };
        colours.push(colour);
        approach(&mut distances, colour);
    }
    colours
}

/// Colours of all hues that lie within sRGB, from dull to vivid and from dark to light.
fn candidates() -> Vec<Colour> {
    let mut colours = Vec::new();
    for lightness in 0..8 {
        for chroma in 1..5 {
            for hue in 0..36 {
                let (lightness, chroma) = (0.42 + 0.07 * f64::from(lightness), 0.05 * f64::from(chroma));
                let angle = f64::from(hue) / 36.0 * TAU;
                let wanted = [lightness, chroma * angle.cos(), chroma * angle.sin()];
                let colour = srgb_from_oklab(wanted);
                let found = oklab(colour);
                // What was cut off at the edge of sRGB has another hue.
                if (0..3).all(|axis| (found[axis] - wanted[axis]).abs() < 0.01) {
                    colours.push(colour);
                }
            }
        }
    }
    colours
}

/// How different two colours look: their distance in Oklab.
fn difference(one: Colour, other: Colour) -> f64 {
    let (one, other) = (oklab(one), oklab(other));
    (0..3).map(|axis| (one[axis] - other[axis]).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::palette::inks;
    use super::*;
    use crate::scene::Theme;

    #[test]
    fn many_species_are_told_apart_on_both_papers() {
        for theme in [Theme::Light, Theme::Dark] {
            let inks = inks(theme);
            assert_eq!(species_colours(&inks, 3), inks.species[..3]);
            for (count, least) in [(12, 0.09), (24, 0.07), (48, 0.045)] {
                let colours = species_colours(&inks, count);
                assert_eq!(colours.len(), count);
                assert_eq!(colours[..8], inks.species, "the first are those of fewer species");
                for (index, colour) in colours.iter().enumerate().skip(8) {
                    let nearest = colours[..index].iter().chain([&inks.paper]);
                    let nearest = nearest.map(|other| difference(*colour, *other)).fold(1.0, f64::min);
                    assert!(nearest > least, "{theme:?}: {index} of {count} is {nearest} from another");
                }
            }
            assert_eq!(species_colours(&inks, 20_000).len(), MOST);
        }
    }
}
