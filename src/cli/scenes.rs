//! `mesoscope scenes`: the scenes inside the program.

use mesoscope::scene;

use super::{Failure, print, print_exactly};

/// List the built-in scenes, or print one as JSON to start your own from
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope scenes                            name, particles, dimension and title of each
  mesoscope scenes dpd-fluid > my-scene.json  a copy to change")]
pub struct Arguments {
    /// The scene to print
    name: Option<String>,
}

/// Prints the list, or the scene that is named.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let Some(name) = &arguments.name else { return print(&table()?) };
    match scene::builtin().iter().find(|scene| scene.name == name) {
        Some(scene) => print_exactly(scene.text),
        None if std::path::Path::new(name).exists() => Err(Failure::usage(format!(
            "`{name}` is not built in; `mesoscope scenes` lists those that are, and `mesoscope check {name}` reads a file"
        ))),
        None => Err(scene::unknown_builtin(name).into()),
    }
}

fn table() -> Result<String, Failure> {
    let width = scene::builtin().iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    let mut lines = vec![format!("{:width$}  {:>9}  {:>9}  TITLE\n", "NAME", "PARTICLES", "DIMENSION")];
    for builtin in scene::builtin() {
        let scene = scene::parse(builtin.name, builtin.text, &[])?;
        let particles = scene.model().particle_count();
        let dimension = scene.space.lengths.len();
        lines.push(format!("{:width$}  {particles:>9}  {dimension:>9}  {}\n", builtin.name, scene.title));
    }
    Ok(lines.concat())
}
