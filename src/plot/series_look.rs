//! How the series of a panel are distinguished: colours, dashes, markers.

#[cfg(test)]
use super::chart::SeriesStyle;
use super::chart::{Panel, Series, SeriesInk};
use super::palette::{Colour, Inks, scale_colour};
use super::species_colours::species_colours;

/// How a series is distinguished from the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    pub colour: Colour,
    /// Lengths drawn and skipped, in line widths; empty for a solid line.
    pub dashes: &'static [f64],
    /// Number of its marker; none where the colour alone has to tell it from its neighbours.
    pub marker: Option<usize>,
}

const DASHES: [&[f64]; 7] = [
    &[],
    &[4.5, 2.6],
    &[10.0, 3.0],
    &[6.5, 2.4, 0.01, 2.4],
    &[0.01, 2.3],
    &[6.5, 2.3, 0.01, 2.3, 0.01, 2.3],
    &[2.0, 2.5],
];
/// Shapes of markers.
pub(super) const MARKERS: usize = 6;

/// References have the secondary ink and dashes that no series has.
const REFERENCE_DASHES: [&[f64]; 4] =
    [&[3.5, 3.0], &[0.01, 3.2], &[8.0, 3.2, 0.01, 3.2, 0.01, 3.2, 0.01, 3.2], &[13.0, 4.0]];

/// The look of the series with this number in its panel.
pub(super) fn look(number: usize, series: &Series, inks: &Inks) -> Look {
    let dashes = |pattern: usize| DASHES[pattern % DASHES.len()];
    let numbered = |number: usize| {
        let count = inks.series.len();
        Look { colour: inks.series[number % count], dashes: dashes(number + number / count), marker: Some(number) }
    };
    match series.ink {
        SeriesInk::Own => numbered(number),
        SeriesInk::Numbered(number) => numbered(number),
        SeriesInk::Scale { place, pattern } => {
            let [first, last] = inks.line_scale;
            let colour = scale_colour(first + (last - first) * place.clamp(0.0, 1.0));
            Look { colour, dashes: dashes(pattern), marker: None }
        }
        SeriesInk::Ink { pattern } => Look { colour: inks.ink, dashes: dashes(pattern), marker: None },
        SeriesInk::Species([first, second]) => {
            let colours = species_colours(inks, first + 1);
            let pattern = if first == second { 0 } else { second };
            Look { colour: colours[first % colours.len()], dashes: dashes(pattern), marker: Some(second) }
        }
        SeriesInk::AllSpecies => Look { colour: inks.muted, dashes: dashes(0), marker: Some(MARKERS - 1) },
        SeriesInk::Faint => Look { colour: inks.faint, dashes: dashes(0), marker: None },
    }
}

/// The look of the reference with this number in its panel.
pub(super) fn reference_look(number: usize, panel: &Panel, inks: &Inks) -> Look {
    // Beside a dashed curve in the ink of the axes, the first reference is dotted.
    let dashed = |series: &Series| matches!(series.ink, SeriesInk::Ink { pattern } if pattern > 0);
    let first = usize::from(panel.series.iter().any(dashed));
    let dashes = REFERENCE_DASHES[(first + number) % REFERENCE_DASHES.len()];
    Look { colour: inks.muted, dashes, marker: None }
}

/// What a reader sees of a look in a legend.
#[cfg(test)]
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Seen {
    colour: Colour,
    line: Option<&'static [f64]>,
    marker: Option<usize>,
    band: bool,
}

/// What a reader sees of every named entry of a panel's legend, where lines are rough and where they are not.
#[cfg(test)]
pub(super) fn seen(panel: &Panel, inks: &Inks, rough: bool) -> Vec<(String, Seen)> {
    let series = panel.series.iter().enumerate().map(|(number, series)| {
        let look = look(number, series, inks);
        let own = look.marker.is_some();
        let lined = series.style != SeriesStyle::Markers;
        let marked = !matches!(series.style, SeriesStyle::Line | SeriesStyle::Band) || rough && own;
        let line = lined.then_some(if rough && own { &[][..] } else { look.dashes });
        let marker = marked.then(|| look.marker.unwrap_or(0) % MARKERS);
        let seen = Seen { colour: look.colour, line, marker, band: series.style == SeriesStyle::Band };
        (series.name.clone(), seen)
    });
    let references = panel.references.iter().enumerate().map(|(number, reference)| {
        let look = reference_look(number, panel, inks);
        let seen = Seen { colour: look.colour, line: Some(look.dashes), marker: None, band: false };
        (reference.label.clone(), seen)
    });
    series.chain(references).filter(|(name, _)| !name.is_empty()).collect()
}

/// That no two entries of a legend of a chart look alike, on either paper.
#[cfg(test)]
pub(super) fn assert_all_told_apart(chart: &super::chart::Chart) {
    use super::palette::inks;
    use crate::scene::Theme;
    for theme in [Theme::Light, Theme::Dark] {
        for panel in &chart.panels {
            for rough in [false, true] {
                let seen = seen(panel, &inks(theme), rough);
                for (index, (name, look)) in seen.iter().enumerate() {
                    let alike = seen[..index].iter().find(|(_, other)| other == look);
                    assert!(alike.is_none(), "`{name}` looks like `{}` in {}", alike.map_or("", |a| &a.0), chart.title);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::chart::Chart;
    use super::*;

    fn panel(count: usize) -> Panel {
        (0..count).fold(Panel::new("x", "y"), |panel, number| {
            panel.with(Series::line(&format!("{number}"), vec![[0.0, 1.0]]))
        })
    }

    #[test]
    fn forty_series_and_four_references_are_told_apart() {
        let mut panel = panel(40);
        for number in 0..4 {
            panel = panel.with_reference(&format!("reference {number}"), f64::from(number));
        }
        assert_all_told_apart(&Chart { panels: vec![panel], ..Chart::default() });
    }

    #[test]
    fn pairs_of_species_are_told_apart_and_have_the_colour_of_the_first() {
        let inks = super::super::palette::inks(crate::scene::Theme::Light);
        let pairs = (0..4).flat_map(|second| (0..=second).map(move |first| [first, second]));
        let named = |pair: [usize; 2]| Series::line(&format!("{pair:?}"), vec![]).with_ink(SeriesInk::Species(pair));
        let panel = pairs.map(named).fold(Panel::new("r", "g"), Panel::with);
        let all = Series::line("all", vec![]).with_ink(SeriesInk::AllSpecies);
        assert_eq!(look(0, &named([2, 3]), &inks).colour, species_colours(&inks, 12)[2]);
        assert_all_told_apart(&Chart { panels: vec![panel.with(all)], ..Chart::default() });
    }

    #[test]
    fn references_are_told_from_dashed_curves_in_ink() {
        let mut panel = panel(3);
        panel.series.push(Series::line("limit", vec![]).with_ink(SeriesInk::Ink { pattern: 1 }));
        let panel = panel.with_reference("a", 0.5).with_reference("b", 0.0);
        assert_all_told_apart(&Chart { panels: vec![panel], ..Chart::default() });
    }

    #[test]
    fn a_number_looks_the_same_wherever_it_stands() {
        let inks = super::super::palette::inks(crate::scene::Theme::Light);
        let third = Series::line("total", vec![]).with_ink(SeriesInk::Numbered(2));
        assert_eq!(look(0, &third, &inks), look(2, &Series::default(), &inks));
    }
}
