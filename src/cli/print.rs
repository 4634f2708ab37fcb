//! Standard output that may be closed at any moment.

use std::io::{ErrorKind, Write as _};

use super::Failure;

/// Writes `text` to standard output. A reader that has seen enough (`| head`) is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::input_output(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
