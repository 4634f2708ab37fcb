// Begins to solve for the velocities after friction.
@group(0) @binding(38) var<storage, read_write> demands: array<u32>; // workgroups of an iteration, as they are and as needed

@compute @workgroup_size(1)
fn main() {
    solver.key = control.key;
    solver.iterations = 0u;
    solver.running = 1u;
    solver.residual = 0.0;
    for (var axis = 0u; axis < 3u; axis++) { demands[3u + axis] = demands[axis]; }
}
