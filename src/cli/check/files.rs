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
    let mut rows = vec![
        (files::ENERGIES.to_owned(), sized(&format!("a row {}", interval(0, output.energies.every)), sizes.energies)),
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
    if let Some(trajectory) = &output.trajectory {
        let name = files::trajectory(trajectory.format);
        rows.push((name.to_owned(), sized(&format!("a frame {}", interval(0, trajectory.every)), sizes.trajectory)));
    }
    // Files of the analyses are written at the end.
    for asked in run::asked_analyses(scene) {
        let sampled = format!("sampled {}", interval(asked.first, asked.every));
        let when = asked.detail.map_or(sampled.clone(), |detail| format!("{detail}, {sampled}"));
        rows.extend(asked.tables.iter().map(|names| (format!("{}, {}", names.file, names.plot), when.clone())));
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
