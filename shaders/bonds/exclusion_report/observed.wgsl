// A report of excluded pairs: motion and configuration.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    gather_force_of_excluded(pair, repulsion, contact);
    if (!is_counted(pair)) { return; }
    note_virial_of_excluded(pair, repulsion, contact);
    note_configuration_of_excluded(pair, repulsion, contact);
}
fn finish_exclusions(group: u32, lane: u32) { total_reduce(group, lane); }
