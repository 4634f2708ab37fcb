//! Draws the grid, the axes and their labels.

use super::axis_range::Prepared;
use super::canvas::{Anchor, Type};
use super::chart::Panel;
use super::chart_layout::{Layout, Placed, Sizes};
use super::text::{CAPITAL_HEIGHT, LINE_HEIGHT, Weight};

/// Labels of y axes that are too long for their panels are set smaller, down to this part of the size of labels.
const Y_LABEL_SIZES: [f64; 4] = [1.0, 0.88, 0.76, 0.64];

impl Layout {
    /// The label of the y axis in lines of a size that fit beside a panel of this height, the unit preferably in its own,
    /// and whether all of it is there.
    pub(super) fn y_label_lines(&self, panel: &Panel, height: f64, size: f64) -> (Vec<String>, bool) {
        let Sizes { label, gap, .. } = self.sizes;
        let setter = &self.canvas.typesetter;
        let text = panel.y.label.as_str();
        // Labels may reach into the row of the legend above the panel.
        let room = height + 2.0 * gap + if self.legends_above { LINE_HEIGHT * label } else { 0.0 };
        let fits = |text: &str| setter.width(text, Weight::Regular, size) <= room;
        if !fits(text)
            && let Some(unit) = text.rfind(" (")
            && fits(&text[unit + 1..])
        {
            let mut lines = setter.wrap(&text[..unit], Weight::Regular, size, room, 2);
            if lines.join(" ") == text[..unit] {
                lines.push(text[unit + 1..].to_owned());
                return (lines, true);
            }
        }
        let lines = setter.wrap(text, Weight::Regular, size, room, 3);
        let whole = lines.join(" ") == text;
        (lines, whole)
    }

    /// The largest size, of a few, at which the labels of the y axes of panels of a height are whole.
    pub(super) fn y_label_size(&self, panels: &[&Panel], height: f64) -> f64 {
        let whole = |size: &f64| panels.iter().all(|panel| self.y_label_lines(panel, height, *size).1);
        let sizes = Y_LABEL_SIZES.map(|part| part * self.sizes.label);
        sizes.into_iter().find(whole).unwrap_or(sizes[sizes.len() - 1])
    }

    pub(super) fn grid(&mut self, place: &Placed<'_>) {
        let area = place.area;
        let rule = 0.7 * self.sizes.rule;
        let grid = self.canvas.inks.grid;
        for (value, _) in &place.x_ticks.major {
            if let Some(x) = place.x_pixel(*value) {
                self.canvas.vertical_rule(x, area.top, area.bottom, rule, grid);
            }
        }
        for (value, _) in &place.y_ticks.major {
            if let Some(y) = place.y_pixel(*value) {
                self.canvas.horizontal_rule(area.left, area.right, y, rule, grid);
            }
        }
    }

    pub(super) fn axes(&mut self, place: &Placed<'_>) {
        let Sizes { label, gap, rule, .. } = self.sizes;
        let Prepared { panel, shares_x_below, has_data, .. } = place.prepared;
        let (area, ink) = (place.area, self.canvas.inks.ink);
        let style = self.text_style(ink);
        let half = 0.5 * rule;
        self.canvas.vertical_rule(area.left, area.top, area.bottom + half, rule, ink);
        self.canvas.horizontal_rule(area.left - half, area.right, area.bottom, rule, ink);
        let (long, short) = (0.8 * gap, 0.45 * gap);
        let labelled = !shares_x_below;
        for (value, text) in place.x_ticks.all() {
            let Some(x) = place.x_pixel(value).filter(|x| *x >= area.left - 1.0 && *x <= area.right + 1.0) else {
                continue;
            };
            let length = if text.is_some() { long } else { short };
            self.canvas.vertical_rule(x, area.bottom, area.bottom + length, rule, ink);
            if let Some(text) = text.filter(|_| labelled) {
                let baseline = area.bottom + long + 0.6 * gap + CAPITAL_HEIGHT * label;
                self.canvas.text(text, [x, baseline], Anchor::Middle, style);
            }
        }
        for (value, text) in place.y_ticks.all() {
            let Some(y) = place.y_pixel(value).filter(|y| *y >= area.top - 1.0 && *y <= area.bottom + 1.0) else {
                continue;
            };
            let length = if text.is_some() { long } else { short };
            self.canvas.horizontal_rule(area.left - length, area.left, y, rule, ink);
            self.canvas.text_centred(text.unwrap_or(""), [area.left - long - 0.6 * gap, y], Anchor::End, style);
        }
        if let Some(multiplier) = &place.y_ticks.multiplier {
            self.canvas.text(multiplier, [area.left - long, area.top - 0.8 * gap], Anchor::Start, style);
        }
        if labelled {
            let baseline = area.bottom + long + 0.6 * gap + 2.0 * CAPITAL_HEIGHT * label + 1.2 * gap;
            let mut room = area.width();
            let mut centre = area.centre()[0];
            if let Some(multiplier) = &place.x_ticks.multiplier {
                self.canvas.text(multiplier, [area.right, baseline], Anchor::End, style);
                room -= self.canvas.typesetter.width(multiplier, Weight::Regular, label) + 2.0 * gap;
                centre = centre.min(area.left + 0.5 * room.max(0.0));
            }
            let shortened = self.canvas.typesetter.shorten(&panel.x.label, Weight::Regular, label, room);
            let half_width = 0.5 * self.canvas.typesetter.width(&shortened, Weight::Regular, label);
            // Centred under the axis unless the power of ten at its end needs the place.
            let middle = area.centre()[0];
            let x = if middle + half_width <= area.left + room { middle } else { centre };
            self.canvas.text(&shortened, [x, baseline], Anchor::Middle, style);
        }
        if !has_data {
            let style = self.text_style(self.canvas.inks.muted);
            // Without data a reference is in the middle; between it and the next rule there is room.
            let below = if panel.references.is_empty() { 0.0 } else { 0.125 * area.height() };
            let [x, y] = area.centre();
            self.canvas.text_centred("no data", [x, y + below], Anchor::Middle, style);
        }
    }

    pub(super) fn y_labels(&mut self, placed: &[Placed<'_>], margin: f64) {
        let panels: Vec<&Panel> = placed.iter().map(|place| place.prepared.panel).collect();
        // All panels are of one height.
        let height = placed.first().map_or(0.0, |place| place.area.height());
        let style = Type { size: self.y_label_size(&panels, height), ..self.text_style(self.canvas.inks.ink) };
        let labels: Vec<Vec<String>> =
            panels.iter().map(|panel| self.y_label_lines(panel, height, style.size).0).collect();
        let most = labels.iter().map(Vec::len).max().unwrap_or(0);
        for (place, lines) in placed.iter().zip(labels) {
            let first = 0.5 * (most - lines.len()) as f64;
            for (number, text) in lines.iter().enumerate() {
                let line = first + number as f64;
                let baseline = margin + line * LINE_HEIGHT * style.size + CAPITAL_HEIGHT * style.size;
                self.canvas.text_upwards(text, [baseline, place.area.centre()[1]], Anchor::Middle, style);
            }
        }
    }
}
