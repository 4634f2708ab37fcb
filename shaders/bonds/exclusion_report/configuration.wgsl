// A report of excluded pairs where a split step measures the configuration.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    if (is_counted(pair)) { note_configuration_of_excluded(pair, repulsion, contact); }
}
fn finish_exclusions(group: u32, lane: u32) { total_reduce(group, lane); }
