//! The shader modules, embedded in the program.

macro_rules! library {
    ($($name:literal),* $(,)?) => {
        /// Names of all modules, as `folder/name`.
        #[must_use]
        pub fn module_names() -> &'static [&'static str] {
            &[$($name),*]
        }

        /// The text of a module, by name.
        #[must_use]
        pub fn module_text(name: &str) -> Option<&'static str> {
            match name {
                $($name => Some(include_str!(concat!("../../shaders/", $name, ".wgsl"))),)*
                _ => None,
            }
        }
    };
}

library![
    "common/advance",
    "common/begin_step",
    "common/cells",
    "common/coefficients_single",
    "common/coefficients_table",
    "common/contact",
    "common/control",
    "common/dispatch",
    "common/drift",
    "common/drift_halves",
    "common/eight_hits",
    "common/found",
    "common/friction_discrete_gradient",
    "common/friction_off",
    "common/friction_velocity",
    "common/grid2",
    "common/grid3",
    "common/hits_of_clusters",
    "common/hits_of_rows",
    "common/keep_off",
    "common/keep_on",
    "common/kept_hits",
    "common/kept_hits_of_clusters",
    "common/kept_hits_of_rows",
    "common/noise_gaussian",
    "common/noise_uniform",
    "common/observation",
    "common/other_species_single",
    "common/other_species_table",
    "common/particle",
    "common/particle_predicted",
    "common/probe2",
    "common/probe3",
    "common/random_off",
    "common/random_on",
    "common/reduce",
    "common/relaxation",
    "common/repulsion_off",
    "common/repulsion_on",
    "common/row_scan",
    "common/same_step",
    "common/shuffle2",
    "common/shuffle3",
    "common/sorted",
    "common/space2",
    "common/space3",
    "common/span2",
    "common/span3",
    "common/stretches",
    "common/sum64",
    "common/threefry",
    "common/weight_general",
    "common/weight_standard",
    "common/words_pcg4d",
    "common/words_threefry",
    "common/workgroup_scan",
    "kernels/alone",
    "kernels/bin",
    "kernels/clusters",
    "kernels/drift_rest",
    "kernels/pair_histogram",
    "kernels/record_histogram",
    "kernels/record_sample",
    "kernels/rows",
    "kernels/scan",
    "kernels/scan_blocks",
    "kernels/scan_rows",
    "kernels/scan_tops",
    "kernels/scatter",
    "kernels/track",
    "kernels/transverse_modes",
    "passes/find",
    "passes/leapfrog",
    "passes/observe_configuration",
    "passes/observe_leapfrog",
    "passes/observe_motion",
    "passes/relax",
];
