//! Arrays that are larger than a kernel may bind lie in portions: the same bytes.

use mesoscope::engine::Engine;
use mesoscope::gpu::{Gpu, Requirements};
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::Checked;
use mesoscope::shaders::Array;

use crate::support::bytes::{Bytes, harvest};
use crate::support::{GROOT_WARREN, MIXTURE, MIXTURE_FORCE, adapter, built_in, cells, oscillators, start, water};

/// Bytes of the smallest portions that there are: 2520 particles.
const PORTION: u64 = 80_640;

fn bytes(gpu: &Gpu, scene: &Checked, plan: Plan) -> Bytes {
    let (_, state) = start(scene);
    let mut engine = Engine::new(gpu, plan, &state).unwrap();
    engine.advance(12, 5).unwrap();
    harvest(engine, Vec::new())
}

#[test]
fn arrays_in_portions_give_the_same_bytes() {
    let (mut compared, mut bound) = (0, 0);
    let diffusion = r#"output.diffusion={"every":2,"window":4}"#;
    let box_of_fluid = "space.box=[14,13,12]";
    for (scene, divided) in [
        (built_in("dpd-fluid", &[box_of_fluid, diffusion]), &[Array::Particles, Array::Sorted, Array::Trackers][..]),
        (
            built_in("dpd-fluid", &[box_of_fluid, MIXTURE, MIXTURE_FORCE, GROOT_WARREN]),
            &[Array::Particles, Array::Sorted],
        ),
        (built_in("edpd-fluid", &["space.box=[17,17,17]"]), &[Array::Neighbours, Array::Memories]),
        (
            built_in("polymer-melt", &["space.box=[13,13,12]", "particles.2.count=4000"]),
            &[Array::Particles, Array::Kicks],
        ),
        (built_in("drop", &[]), &[Array::Sorted, Array::Samples]),
        (oscillators(&["particles.0.count=6000", "time.steps=20", diffusion]), &[Array::Particles, Array::Tethers]),
        (cells(2600, &[]), &[Array::Particles]),
        (water(&["particles.0.count=16384"]), &[Array::Bins]),
    ] {
        let title = &scene.title;
        // In as small portions as the adapter has buffers for, with a queue of pairs, and to the device and back in many stretches.
        let open = |portion: u64| {
            let hardware =
                Hardware { queues_pairs: true, largest_binding: Some(portion * PORTION), ..Hardware::default() };
            let plan = run::plan(&scene, hardware, Options { particles_at_once: Some(700), ..Options::default() });
            let (largest_buffer, storage_buffers) = (plan.largest_buffer(), plan.storage_buffers);
            Some((Gpu::open(&adapter(), Requirements { largest_buffer, storage_buffers, portable: true }).ok()?, plan))
        };
        let (gpu, plan) = (1..20).find_map(open).unwrap();
        // Adapters with few buffers take larger portions only, which hold small arrays whole.
        if !divided.iter().any(|array| plan.portions.contains_key(array)) {
            continue;
        }
        compared += 1;
        bound = bound.max(plan.storage_buffers);
        let whole = run::plan(&scene, Hardware::default(), Options::default());
        assert!(whole.portions.is_empty());
        assert!(bytes(&gpu, &scene, whole) == bytes(&gpu, &scene, plan), "{title}");
    }
    assert!(compared > 3, "{compared}");
    // More than wgpu allows unless it is requested.
    assert!(bound > 28 || compared < 8, "{bound}");
}
