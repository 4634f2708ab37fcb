// Contributions of excluded charges to reports.

// == charges/exclusion_report/observed
// A report of excluded charges: motion and configuration.
fn note_excluded_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {
    gather_force_of_charges(pair, taken, contact);
    if (!is_own(pair.me.position)) { return; }
    note_virial_of_charges(pair, taken, contact);
    note_configuration_of_charges(pair, taken, contact);
}
fn finish_excluded_charges(group: u32, lane: u32) { total_reduce(group, lane); }

// == charges/exclusion_report/configuration
// A report of excluded charges where a split step measures the configuration.
fn note_excluded_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {
    if (is_own(pair.me.position)) { note_configuration_of_charges(pair, taken, contact); }
}
fn finish_excluded_charges(group: u32, lane: u32) { total_reduce(group, lane); }

// == charges/exclusion_report/motion
// A report of excluded charges where a split step measures the motion: the virial of all forces.
fn note_excluded_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {
    if (is_own(pair.me.position)) { note_virial_of_charges(pair, taken, contact); }
}
fn finish_excluded_charges(group: u32, lane: u32) { total_reduce(group, lane); }
