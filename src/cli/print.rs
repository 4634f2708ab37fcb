//! Standard output and standard error, which may be closed at any moment.

use std::io::{self, ErrorKind, IsTerminal, Write as _};

use mesoscope::printable;
use terminal_size::{Width, terminal_size_of};

use super::Failure;

/// Lines on a terminal narrower than this are left as they are.
const NARROW: usize = 40;

/// Writes `text` to standard output, without what acts on a terminal; on one, lines break at blanks. A reader that has seen enough
/// (`| head`) is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    print_exactly(&fitted(text, width(&io::stdout())))
}

/// The same with the lines as they are: text that another program may read.
pub fn print_exactly(text: &str) -> Result<(), Failure> {
    let mut output = io::stdout().lock();
    match output.write_all(printable::message(text).as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::input_output(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// A line on standard error as it is; an error of a stream that is closed has no reader.
pub fn write_error(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// A message on standard error, without what acts on a terminal; on one, lines break at blanks.
pub fn line(text: &str) {
    let text = fitted(text, width(&io::stderr()));
    write_error(&printable::message(&text));
}

/// The columns of a terminal; none where it is none.
#[cfg(any(unix, windows))]
fn width<S: IsTerminal + Handle>(stream: &S) -> Option<usize> {
    let (Width(width), _) = terminal_size_of(stream).filter(|_| stream.is_terminal())?;
    Some(usize::from(width)).filter(|width| *width >= NARROW)
}

#[cfg(unix)]
use std::os::fd::AsFd as Handle;
#[cfg(windows)]
use std::os::windows::io::AsHandle as Handle;

/// A text whose lines are no longer than so many characters, as far as blanks allow it.
fn fitted(text: &str, width: Option<usize>) -> String {
    let Some(width) = width else { return text.to_owned() };
    let mut fitted = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (line, end) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\n"));
        break_line(line, width, &mut fitted);
        fitted.push_str(end);
    }
    fitted
}

/// Adds a line, broken at blanks. What goes on begins below the last column of a table, and within a list further in than its entry.
fn break_line(line: &str, width: usize, fitted: &mut String) {
    let letters: Vec<char> = line.chars().collect();
    let indent = letters.iter().take_while(|letter| **letter == ' ').count();
    let ends_gap = |at: &usize| letters[at - 1] == ' ' && letters[at - 2] == ' ' && letters[*at] != ' ';
    let column = (indent + 2..letters.len().min(width / 2)).rev().find(ends_gap);
    let hang = column.unwrap_or(if indent > 0 { indent + 2 } else { 0 });
    let mut rest = &letters[..];
    let mut before = 0;
    while before + rest.len() > width {
        let first = if before == 0 { hang.max(indent) } else { 0 };
        let room = width - before;
        let blanks = || (first + 1..rest.len()).filter(|at| rest[*at] == ' ');
        let Some(at) = blanks().take_while(|at| *at <= room).last().or_else(|| blanks().next()) else { break };
        fitted.extend(&rest[..at]);
        fitted.truncate(fitted.trim_end_matches(' ').len());
        fitted.push('\n');
        fitted.extend(std::iter::repeat_n(' ', hang));
        rest = &rest[at..];
        rest = &rest[rest.iter().take_while(|letter| **letter == ' ').count()..];
        before = hang;
    }
    fitted.extend(rest);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_blanks_within_the_width() {
        let broken = |text: &str| fitted(text, Some(20));
        assert_eq!(broken("error: one two three four five\nsix\n"), "error: one two three\nfour five\nsix\n");
        assert_eq!(broken("  a.b: found 3; accepted: 4 or 5"), "  a.b: found 3;\n    accepted: 4 or 5");
        // Below the second column, whatever the first one is.
        assert_eq!(broken("  time   about 9 s for 20 steps"), "  time   about 9 s\n         for 20\n         steps");
        // What has no blanks stays whole, and so does what fits.
        assert_eq!(broken("wrote a-long-directory/of-a-run: b"), "wrote\na-long-directory/of-a-run:\nb");
        assert_eq!(broken("12345678901234567890"), "12345678901234567890");
        assert_eq!(fitted("one line, as long as it is\n", None), "one line, as long as it is\n");
        // The dash is one column and three bytes.
        assert_eq!(broken("— — — — — — — — — — — —"), "— — — — — — — — — —\n— —");
        for text in ["", " ", "\n\n", "                              ", "  x                              y"] {
            assert!(broken(text).split_whitespace().eq(text.split_whitespace()), "{text:?}");
        }
    }
}
