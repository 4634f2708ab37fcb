// Three products of oscillators with their baths come before the sums of body forces.
const REPORTED: u32 = 20u;
