//! Spectra of energy and enstrophy.

use super::{Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Sampling, Setting};
use crate::families::Checked;
use crate::measure::blocks::BlockSums;
use crate::measure::statistics::Estimate;
use crate::plot::{Axis, Chart, Panel, Series, SeriesInk};
use crate::state::Reported;
use crate::table::Table;
use serde_json::json;

/// Columns of the table, and names in the result.
const COLUMNS: [&str; 4] = ["kinetic_energy", "potential_energy", "potential_enstrophy", "enstrophy"];
const WAVE_NUMBER: &str = "wave_number";
/// Parts of the largest value that rounding leaves in shells without a wave.
const ROUNDING: f64 = 1e-12;

/// Spectra of energy and enstrophy.
pub(super) struct Spectra;

fn shells(scene: &Checked) -> usize {
    scene.model().physics().wave_shells(scene.model()).len()
}

impl Descriptor for Spectra {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let sampling = Sampling::after_equilibration(scene, scene.output.spectra.as_ref()?.every);
        Some(Sampling { numbers: 10 * shells(scene) as u64, ..sampling })
    }

    fn takes_states(&self) -> bool {
        true
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        let asked = scene.output.spectra.iter();
        asked.map(|_| Part::Blocks(BlockSums::with_most(COLUMNS.len() * shells(scene), 64))).collect()
    }

    fn numbers_of_state(&self, Setting { scene, .. }: &Setting<'_>, state: &Reported) -> Option<Vec<f64>> {
        Some(scene.model().physics().spectra(scene.model(), state)?.concat())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let (model, sums) = (scene.model(), gathered.blocks()?);
        let shells = model.physics().wave_shells(model);
        let width = COLUMNS.len();
        let rows = shells.iter().enumerate().map(|(place, shell)| {
            let cells = (0..width)
                .flat_map(|column| sums.mean(|row| row[width * place + column]).map_or([f64::NAN; 2], Estimate::cells));
            [shell.wave_number, shell.modes as f64].into_iter().chain(cells).collect()
        });
        let columns = COLUMNS.iter().flat_map(|column| [(*column).to_owned(), format!("{column}_error")]);
        let columns = [WAVE_NUMBER, "modes"].map(str::to_owned).into_iter().chain(columns);
        let table = Table::new(columns, rows.collect());
        let result = if sums.samples() == 0 {
            Err(NO_SAMPLE.to_owned())
        } else {
            let mut result = json!({ "samples": sums.samples() });
            for (column, name) in COLUMNS.iter().enumerate() {
                let total = |row: &[f64]| row.iter().skip(column).step_by(width).sum::<f64>();
                result[name] = json!(sums.mean(total));
            }
            Ok(result)
        };
        Some(Conclusion::new(table, result))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let series = |column: &str, name: &str, ink: usize| {
            let values = drawn.column(column);
            // Of the mean there is no wave, and what is left by rounding is none.
            let least = ROUNDING * values.iter().skip(1).fold(0.0, |most: f64, value| most.max(*value));
            let points = drawn.column(WAVE_NUMBER).into_iter().zip(values).skip(1);
            let shown = points.filter(|(_, value)| *value > least);
            Series::line(name, shown.map(|(wave_number, value)| [wave_number, value]).collect())
                .with_ink(SeriesInk::Numbered(ink))
        };
        let panel =
            |y: &str| Panel { x: Axis::log("Wave number (1/length unit)"), y: Axis::log(y), ..Panel::default() };
        let [kinetic, potential, of_potential, plain] = COLUMNS;
        let energy = panel("Energy of a shell (energy units)").with(series(kinetic, "kinetic", 0)).with(series(
            potential,
            "potential",
            1,
        ));
        let enstrophy = panel("Enstrophy of a shell (1/time unit²)")
            .with(series(of_potential, "potential enstrophy", 2))
            .with(series(plain, "enstrophy", 3));
        Chart { title: drawn.title().to_owned(), subtitle: String::new(), panels: vec![energy, enstrophy] }
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("kinetic energy of the flow", COLUMNS[0]), ("enstrophy of the flow", COLUMNS[3])]
    }

    fn finds(&self, _: &Checked) -> Vec<&'static str> {
        COLUMNS.to_vec()
    }
}
