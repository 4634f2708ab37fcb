//! Body forces: the numbers of their impulses, and the kernels that keep account of what they give. The impulses themselves are added
//! where particles are updated.

use crate::document::ForceProfile;
use crate::families::{FixedImpulse, Model};
use crate::plan::{Kernel, Plan};
use crate::shaders::{Array, Choices, Constant, Entry};

/// Sums in a row of the account, see `shaders/external/body_force.wgsl`.
const ACCOUNT: u64 = 8;
/// Rows of the account: enough workgroups to read particles as fast as memory can, few enough to add up. Where there are fewer particles a lane
/// reads as many as this, for adding up the lanes of a workgroup takes longer.
const ROWS: u64 = 256;
const PARTICLES_OF_LANE: u64 = 8;

/// Rows of the account of workgroups of a size; none without body forces.
pub(crate) fn rows(model: &Model, workgroup: u64) -> u64 {
    let particles = model.particle_count();
    model
        .particles()
        .body_forces
        .as_ref()
        .map_or(0, |_| particles.div_ceil(PARTICLES_OF_LANE * workgroup).clamp(1, ROWS))
}

/// The constants of the impulses; without a table of species those of the only one.
pub(crate) fn add_constants(model: &Model, entries_before: Option<usize>, plan: &mut Plan) {
    let Some(forces) = model.particles().body_forces.as_ref() else {
        plan.constants.push((Constant::Profile, 0.0));
        return;
    };
    let profile = match forces.profile {
        ForceProfile::Uniform if forces.turn.is_some() => 4.0,
        ForceProfile::Uniform => 1.0,
        ForceProfile::Opposed => 2.0,
        ForceProfile::Sinusoidal => 3.0,
    };
    plan.constants.extend([
        (Constant::Profile, profile),
        (Constant::ForceAxis, forces.axis as f64),
        (Constant::Waves, f64::from(forces.turn.unwrap_or(forces.waves))),
    ]);
    if let Some(entries) = entries_before {
        plan.constants.push((Constant::BodyEntries, entries as f64));
        return;
    }
    let [x, y, z] = forces.impulse(model, 0).map(FixedImpulse::parts);
    plan.constants.extend([
        (Constant::BodyX, f64::from(x.0)),
        (Constant::BodyY, f64::from(y.0)),
        (Constant::BodyZ, f64::from(z.0)),
        (Constant::BodyRestX, f64::from(x.1)),
        (Constant::BodyRestY, f64::from(y.1)),
        (Constant::BodyRestZ, f64::from(z.1)),
    ]);
}

/// The entries of a table of species: three for each, of words that single precision holds.
pub(crate) fn entries(model: &Model) -> Vec<f32> {
    let Some(forces) = model.particles().body_forces.as_ref() else { return Vec::new() };
    let axes = (0..forces.forces.len()).flat_map(|species| forces.impulse(model, species));
    let entry = |(whole, rest): (i32, u32)| {
        [(whole >> 16) as f32, (whole & 0xffff) as f32, (rest >> 16) as f32, (rest & 0xffff) as f32]
    };
    axes.flat_map(|impulse| entry(impulse.parts())).collect()
}

/// Adds the kernels that keep account, with what all kernels of the plan choose: the first before anything else in a step, the other to
/// the report, where it leaves rows after the given number of them.
pub(crate) fn add_account(model: &Model, choices: &Choices, workgroup: u64, first_row: u64, plan: &mut Plan) -> u64 {
    let rows = rows(model, workgroup);
    if rows == 0 {
        return 0;
    }
    let groups = (Constant::Groups, rows as f64);
    let book = Kernel::new("book_external", Entry::BookExternal, choices.clone(), rows)
        .with(vec![groups, (Constant::Quantities, ACCOUNT as f64)])
        .renamed(vec![(Array::PartialSums, Array::Account)]);
    let book = plan.add_kernel(book);
    plan.before_report.insert(0, book);
    let report = Kernel::new("report_external", Entry::ReportExternal, choices.clone(), rows.div_ceil(workgroup))
        .with(vec![groups, (Constant::FirstGroup, first_row as f64)]);
    let report = plan.add_kernel(report);
    plan.report.push(report);
    plan.add_buffer(Array::Account, 8 * ACCOUNT * rows);
    plan.operations_per_particle += 40.0;
    rows
}
