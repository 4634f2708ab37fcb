// Cells stay where they are in this part of the step.
fn moved(cell: Particle, before: Vector) -> vec4<u32> { return cell.position; }
