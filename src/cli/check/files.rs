//! The files of a run, when they are written and how long they become.

use mesoscope::families::{Checked, PictureKind};
use mesoscope::numbers::bytes;
use mesoscope::output::files;
use mesoscope::run::{self, Sizes};

use super::interval;
use crate::cli::table::labelled;

pub fn outputs(scene: &Checked, sizes: &Sizes) -> String {
    let model = scene.model();
    let output = &scene.output;
    let stages = scene.of_stages();
    // How often something is done in each stage that does it, or in the run.
    let intervals = |every: &dyn Fn(&Checked) -> Option<u64>| {
        let of_stages = stages.iter().map(every);
        if of_stages.clone().all(|own| own == every(&stages[0])) {
            return every(&stages[0]).map(|every| interval(0, every));
        }
        let said = (1..)
            .zip(of_stages)
            .filter_map(|(number, every)| Some(format!("{} in stage {number}", interval(0, every?))));
        Some(said.collect::<Vec<_>>().join(", "))
    };
    let row = intervals(&|stage| Some(stage.output.energies.every)).unwrap_or_default();
    let mut rows = vec![
        (files::ENERGIES.to_owned(), sized(&format!("a row {row}"), sizes.energies)),
        (format!("{}, {}", files::ENERGIES_PLOT, files::SUMMARY), "at the end".to_owned()),
        (
            files::CHECKPOINT.to_owned(),
            sized(&format!("{} and at the end", interval(0, output.checkpoint.every)), sizes.checkpoint),
        ),
    ];
    if model.picture() == PictureKind::Fields {
        let fields = output.fields.clone().unwrap_or_default();
        for (array, quantities) in files::field_arrays(&fields, None) {
            let pictures = quantities.iter().map(|quantity| files::field(quantity.stem(), None, "png"));
            let names = pictures.chain([array]).collect::<Vec<_>>().join(", ");
            if fields.every > 0 {
                rows.push((names.clone(), "at the end".to_owned()));
                rows.push((names.replace('.', "-…."), interval(0, fields.every)));
            } else {
                rows.push((names, "at the end".to_owned()));
            }
        }
    } else if model.units.dimension > 1 && !output.snapshot.is_off {
        rows.push((files::SNAPSHOT.to_owned(), "at the end".to_owned()));
        if output.snapshot.every > 0 {
            rows.push(("snapshot-….png".to_owned(), sized(&interval(0, output.snapshot.every), sizes.numbered)));
        }
    }
    let frames = intervals(&|stage| Some(stage.output.trajectory.as_ref()?.every));
    let written = stages.iter().find_map(|stage| stage.output.trajectory.as_ref());
    if let (Some(trajectory), Some(frames)) = (written, frames) {
        let name = files::trajectory(trajectory.format);
        rows.push((name.to_owned(), sized(&format!("a frame {frames}"), sizes.trajectory)));
    }
    // Files of the analyses are written at the end, of the run or of a stage.
    for (number, stage) in (1..).zip(&stages) {
        let place = if number == stages.len() { String::new() } else { format!("{}/", files::stage(number)) };
        for asked in run::asked_analyses(stage) {
            let sampled = format!("sampled {}", interval(asked.first, asked.every));
            let when = asked.detail.map_or(sampled.clone(), |detail| format!("{detail}, {sampled}"));
            let names = asked.tables.iter().map(|names| format!("{place}{}, {place}{}", names.file, names.plot));
            rows.extend(names.map(|names| (names, when.clone())));
        }
    }
    let formats: Vec<&str> = output.plot.vector.iter().map(|format| format.extension()).collect();
    if !formats.is_empty() {
        rows.push((format!("all charts as {}", formats.join(", ")), "at the end".to_owned()));
    }
    format!("\nFiles\n{}", labelled(rows, "  "))
}

/// When a file is written and how long it becomes.
fn sized(when: &str, size: u64) -> String {
    format!("{when}, about {}", bytes(size))
}
