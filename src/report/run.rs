//! The page of a run.

use super::entry::{Difference, Entry, TextTable, WIDTH, in_a_line, inside, pictures};
use crate::numbers::{counted, grouped, prefixed, with_error};
use crate::output::{Found, OutputError, Summary, files, read_table};
use crate::run::printed_results;
use crate::scene::{self, WrittenScene};
use serde_json::Value;
use std::path::Path;

/// The most pictures of a run as it went on.
const STRIP: usize = 12;

/// The entry of a run, finished or not; none of a directory without any.
pub(super) fn entry(directory: &Path) -> Option<Entry> {
    let mut entry = Entry::of("run", directory);
    match Summary::load(&directory.join(files::SUMMARY)) {
        Ok(summary) => describe(&mut entry, directory, &summary),
        Err(error) => {
            let has = |name: &str| directory.join(name).exists();
            let is_missing = matches!(error, OutputError::Unfinished { .. });
            if is_missing && !has(files::ENERGIES) && !has(files::CHECKPOINT) {
                return None;
            }
            entry.missing.push(if is_missing {
                "the run has not ended, or was interrupted: there is no summary, and `mesoscope resume` goes on with it"
                    .to_owned()
            } else {
                error.to_string()
            });
            if let Ok(table) = read_table(&directory.join(files::ENERGIES)) {
                last_row(&mut entry, &table.columns, table.rows.last().map_or(&[], Vec::as_slice));
            }
        }
    }
    add_pictures(&mut entry, directory);
    Some(entry)
}

fn describe(entry: &mut Entry, directory: &Path, summary: &Summary) {
    let scene = &summary.scene;
    entry.title.clone_from(&scene.title);
    entry.description = Some(scene.description.clone()).filter(|text| !text.is_empty());
    let edges = scene.space.lengths.iter().map(|edge| format!("{edge:.6}"));
    let edges: Vec<String> = edges.map(|edge| edge.trim_end_matches('0').trim_end_matches('.').to_owned()).collect();
    entry.add_fact("particles", format!("{} in a box of {}", grouped(summary.particles), edges.join(" × ")));
    for line in &summary.composition {
        entry.add_fact("", line.clone());
    }
    let (steps, step) = (summary.steps, scene.time.step);
    if let Some(last) = summary.stages.last() {
        let stages = counted(summary.stages.len() as u64, "stage");
        let time = with_error(last.times[1], None);
        entry.add_fact("steps", format!("{} in {stages}, to t = {time}", grouped(steps)));
    } else {
        let time = with_error(steps as f64 * step, None);
        entry.add_fact("steps", format!("{} of {step}, to t = {time}", grouped(steps)));
    }
    entry.add_fact("equilibration", format!("{} steps, which means leave out", grouped(scene.time.equilibration)));
    let later = scene.stages.iter().any(|stage| stage.keys().iter().any(|key| key == "temperature"));
    entry.add_fact("temperature", format!("{}{}", scene.temperature, if later { " at first" } else { "" }));
    for (number, stage) in (1..).zip(&summary.stages) {
        let numbers = stage.set.iter().chain(&stage.ramp).map(|(key, value)| format!("{key} = {value}"));
        let push_off = stage.push_off.map(|force| format!("push_off = {force}"));
        let numbers = numbers.chain(push_off).collect::<Vec<_>>().join(", ");
        let steps = format!("stage {number}: to step {}", grouped(stage.last_step));
        entry.add_fact("", if numbers.is_empty() { steps } else { format!("{steps}, {numbers}") });
    }
    entry.add_fact("adapter", format!("{}, {}", summary.adapter.name, summary.adapter.driver));
    if let Some(ranks) = &summary.ranks {
        entry.add_fact("ranks", ranks.ranks.len().to_string());
    }
    let speed = prefixed(summary.particle_steps_per_second);
    entry.add_fact("speed", format!("{:.1} s, {speed} particle-steps a second", summary.wall_seconds));
    differences(entry, summary);
    entry.warnings.clone_from(&summary.warnings);
    entry.tables.extend(means(summary));
    let of_stages = (1..).zip(&summary.stages).map(|(number, stage)| (format!(" in stage {number}"), &stage.results));
    for (stage, results) in of_stages.chain([(String::new(), &summary.results)]) {
        let rows: Vec<_> = printed_results(results).into_iter().map(|(name, text)| vec![name, text]).collect();
        if !rows.is_empty() {
            let title = format!("What analyses found{stage}");
            entry.tables.push(TextTable::new(&title, &["quantity", "value"], rows));
        }
    }
    entry.conserved.clone_from(&summary.conserved_exactly);
    entry.not_conserved.clone_from(&summary.not_conserved);
    if summary.files.is_none() {
        let note = "the run ended before all of its pictures were written: `mesoscope resume` writes them";
        entry.missing.push(note.to_owned());
    }
    for (name, extent) in &summary.tables {
        let found = entry.readable(extent.find_in(&directory.join(name)));
        if found.is_some_and(|found| !matches!(found, Found::Whole)) {
            entry.missing.push(format!("`{name}` is not what the run wrote"));
        }
    }
    for name in summary.files.iter().flatten().filter(|name| !directory.join(name).exists()) {
        entry.missing.push(format!("`{name}` is not there any more"));
    }
    let sum = summary.tables.get(files::ENERGIES).map(|extent| format!("{:08x}", extent.crc32)).unwrap_or_default();
    entry.repeat = vec![format!(
        "Version {} on the same adapter and driver gives the same bytes; the table of energies then has the \
             checksum (CRC-32) {sum}. The seed is {}, the id of the run {}.",
        summary.mesoscope_version, scene.seed, summary.run_id
    )];
    if let Some(state) = &scene.state {
        entry.repeat.push(format!("It starts from the file `{}`, which has to be where the scene says.", state.file));
    }
    "Save the scene below as scene.json.".clone_into(&mut entry.scene_use);
    entry.command = Some("mesoscope run scene.json".to_owned());
    entry.scene = serde_json::to_string_pretty(scene).ok();
}

/// Keys in which the scene differs from the built-in one of its title.
fn differences(entry: &mut Entry, summary: &Summary) {
    let same = |known: &&scene::Builtin| {
        serde_json::from_str::<Value>(known.text).is_ok_and(|found| found["title"] == summary.scene.title.as_str())
    };
    let Some(builtin) = scene::builtin().iter().find(same) else { return };
    let Ok(base) = WrittenScene::new(builtin.name, builtin.text).check() else { return };
    let [before, after] =
        [serde_json::to_value(&*base), serde_json::to_value(&summary.scene)].map(Result::unwrap_or_default);
    entry.builtin = Some(builtin.name.to_owned());
    compare(String::new(), &before, &after, &mut entry.differences);
}

fn compare(place: String, before: &Value, after: &Value, found: &mut Vec<Difference>) {
    let inner = |key: &str| if place.is_empty() { key.to_owned() } else { format!("{place}.{key}") };
    match (before, after) {
        (Value::Object(one), Value::Object(other)) => {
            for key in one.keys().chain(other.keys().filter(|key| !one.contains_key(*key))) {
                compare(inner(key), &before[key], &after[key], found);
            }
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() && one.iter().any(Value::is_object) => {
            for (index, (one, other)) in one.iter().zip(other).enumerate() {
                compare(inner(&index.to_string()), one, other, found);
            }
        }
        _ if before == after => {}
        _ => found.push(Difference { key: place, before: in_a_line(before), after: in_a_line(after) }),
    }
}

fn means(summary: &Summary) -> Option<TextTable> {
    let columns = summary.columns.get(files::ENERGIES);
    let (mut few, mut rows) = (false, Vec::new());
    for (name, mean) in &summary.means {
        let Some(value) = mean["value"].as_f64() else { continue };
        let described = columns.and_then(|columns| columns.iter().find(|column| column.name == *name));
        let is_few = mean["few"] == true;
        few |= is_few;
        let unequilibrated = summary.unequilibrated.as_ref().is_some_and(|found| found.includes(name));
        let shown = with_error(value, mean["error"].as_f64());
        rows.push(vec![
            name.replace('_', " "),
            described.map(|column| column.meaning.clone()).unwrap_or_default(),
            described.map(|column| column.symbol.clone()).unwrap_or_default(),
            format!("{shown}{}", if is_few { " *" } else { "" }),
            mean["unit"].as_str().unwrap_or_default().to_owned(),
            if unequilibrated { "includes the way to equilibrium" } else { "" }.to_owned(),
        ]);
    }
    let note =
        few.then(|| "* from few samples: the error is not known to a quarter of itself, and may be larger".to_owned());
    let header = ["column", "mean after equilibration", "symbol", "value ± standard error", "unit", ""];
    (!rows.is_empty()).then(|| TextTable { numbers: vec![3], note, ..TextTable::new("Means", &header, rows) })
}

fn last_row(entry: &mut Entry, columns: &[String], row: &[f64]) {
    let rows: Vec<_> =
        columns.iter().zip(row).map(|(name, value)| vec![name.replace('_', " "), with_error(*value, None)]).collect();
    if !rows.is_empty() {
        let table = TextTable::new("The last row of the table of energies", &["quantity", "value"], rows);
        entry.tables.push(TextTable { numbers: vec![1], ..table });
    }
}

fn add_pictures(entry: &mut Entry, directory: &Path) {
    let (mut numbered, mut single): (Vec<_>, Vec<_>) = pictures(directory).into_iter().partition(|path| {
        path.file_name().is_some_and(|name| files::snapshot_number(&name.to_string_lossy()).is_some())
    });
    single.sort_by_key(|path| !path.ends_with(files::ENERGIES_PLOT));
    // As many as fit, from the first to the last.
    if numbered.len() > STRIP {
        let all = numbered.len();
        numbered = (0..STRIP).map(|place| numbered[place * (all - 1) / (STRIP - 1)].clone()).collect();
    }
    entry.pictures = single.iter().filter_map(|path| entry.readable(inside(path, WIDTH))).collect();
    entry.strip = numbered.iter().filter_map(|path| entry.readable(inside(path, WIDTH / 3))).collect();
}
