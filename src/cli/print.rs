//! Standard output and standard error, which may be closed at any moment.

use std::io::{ErrorKind, Write as _};

use mesoscope::printable;

use super::Failure;

/// Writes `text` to standard output, without what acts on a terminal. A reader that has seen enough (`| head`) is no
/// failure.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match output.write_all(printable::message(text).as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::input_output(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// A message on standard error, without what acts on a terminal.
pub fn line(text: &str) {
    // There is nobody to inform if standard error is closed.
    let _ = writeln!(std::io::stderr().lock(), "{}", printable::message(text));
}
