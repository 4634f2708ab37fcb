//! `mesoscope schema`: the scene format for editors and validators.

use mesoscope::scene;

use super::{Failure, print_exactly};

/// Print the JSON Schema of a scene, for completion and checking in an editor
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope schema > scene.schema.json   then write \"$schema\": \"./scene.schema.json\" at the top of a scene")]
pub struct Arguments {}

/// Prints the schema.
pub fn execute(_: &Arguments) -> Result<(), Failure> {
    print_exactly(&format!("{:#}\n", scene::schema()))
}
