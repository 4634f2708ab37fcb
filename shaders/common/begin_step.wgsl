// Moves the clock to the next step and draws the step's key.
fn begin_step() {
    let step = control.next;
    control.step = step;
    control.next = vec2<u32>(step.x + 1u, step.y + select(0u, 1u, step.x == 0xffffffffu));
    control.key = threefry2x32(step, control.seed_key);
    control.closing = closing_of(step);
    control.elapsed += 1u;
    show_clock();
}
