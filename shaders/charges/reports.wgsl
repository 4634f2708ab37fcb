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

// == charges/exclusion_report/stress
// The stress of excluded charges at a report, which is taken back.
fn note_excluded_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {
    share_stress(pair.me.position.w, pair.other.position.w, taken.impulse, 0.0, contact);
}
fn finish_excluded_charges(group: u32, lane: u32) {}

// == analyses/stress_share/with_waves
// The stress of particles and of waves of charges, which the first workgroup adds.
override CHARGE_ROWS: u32; // of sums of waves
fn stress_share(id: u32, word: u32) -> Sum64 {
    var sum = sum64_of_i32(reported_stresses[12u * id + word]);
    if (word < FRICTIONAL && id < WORKGROUP) {
        for (var row = id; row < CHARGE_ROWS; row += min(WORKGROUP, PARTICLES)) {
            sum = sum64_add(sum, charge_stresses[6u * row + word]);
        }
    }
    return sum;
}
