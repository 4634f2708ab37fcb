// Without a sort, the step begins here.
fn begin_unsorted_step() { begin_step(); }
