// How the work of a kernel is divided among lanes, workgroups and dispatches.

// Lanes of a workgroup, a power of two: no result depends on it.
override WORKGROUP: u32 = 64u;

// A dispatch of more than 65 535 workgroups is folded into rows of as many. A constant because DirectX does not provide the
// number of workgroups of an indirect dispatch.
override FOLD: u32 = 65535u;

fn linear_workgroup(workgroup: vec3<u32>) -> u32 { return workgroup.x + workgroup.y * FOLD; }

// Slot core/turns: whether the adapter has left a loop before its end; `nothing` is 0, which the compiler must not know.
// Default: not checked. The plan chooses `counted` for software adapters (src/plan/serial_memory.rs).
fn report_turns(nothing: u32) {}

// Slot core/dispatches: which share of the work a workgroup has.
// Default: one dispatch has all of them. The plan of the pair histogram chooses `in_turn` where one dispatch would take too long.
fn share_of(group: u32) -> u32 { return group; }
