// Twice the velocity of each wall, as momentum of a unit of mass: of the lower and of the upper wall across an axis, along each other axis.
override LOWER_X_Y: f32;
override LOWER_X_Z: f32;
override LOWER_Y_X: f32;
override LOWER_Y_Z: f32;
override LOWER_Z_X: f32;
override LOWER_Z_Y: f32;
override UPPER_X_Y: f32;
override UPPER_X_Z: f32;
override UPPER_Y_X: f32;
override UPPER_Y_Z: f32;
override UPPER_Z_X: f32;
override UPPER_Z_Y: f32;

fn wall_push(axis: u32, upper: bool, species: i32) -> Steps {
    let x = select(vec3<f32>(0.0, LOWER_X_Y, LOWER_X_Z), vec3<f32>(0.0, UPPER_X_Y, UPPER_X_Z), upper);
    let y = select(vec3<f32>(LOWER_Y_X, 0.0, LOWER_Y_Z), vec3<f32>(UPPER_Y_X, 0.0, UPPER_Y_Z), upper);
    let z = select(vec3<f32>(LOWER_Z_X, LOWER_Z_Y, 0.0), vec3<f32>(UPPER_Z_X, UPPER_Z_Y, 0.0), upper);
    let push = select(select(z, y, axis == 1u), x, axis == 0u);
    return steps_of(vec4<i32>(vec4<f32>(round(push / inverse_mass_of(species)), 0.0)));
}
