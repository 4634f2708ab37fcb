// Nothing that crosses a face can run out.
fn report_cuts() {}
