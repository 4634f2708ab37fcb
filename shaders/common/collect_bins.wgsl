// Brings those that have arrived at the top of a bin down to those that have stayed.
@group(0) @binding(3) var<storage, read_write> stayed: array<u32>;
@group(0) @binding(5) var<storage, read_write> arrived: array<u32>;

fn collect(cell: u32) {
    let low = stayed[cell];
    // More than fit were refused as they arrived.
    let high = min(arrived[cell], CAPACITY - low);
    let bottom = cell * CAPACITY + low;
    let top = (cell + 1u) * CAPACITY - 1u;
    // Where the two stretches overlap, some are in their place already.
    let moves = min(high, CAPACITY - high - low);
    for (var k = 0u; k < moves; k++) { bins[bottom + k] = bins[top - k]; }
    residents[cell] = low + high;
    stayed[cell] = low + high;
    arrived[cell] = 0u;
}
