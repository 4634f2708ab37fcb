// Begins to solve for the velocities after friction.
@compute @workgroup_size(1)
fn main() {
    solver.key = clock_key();
    solver.iterations = 0u;
    solver.running = 1u;
    solver.residual = 0.0;
    demand_iterations();
}
