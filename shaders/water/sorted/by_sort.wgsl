// Off: the sort has begun the step.
fn begin_unsorted_step() {}
