// Layers between walls: the integer part of LAYERS times the fraction of the way from one wall to the other.
override LAYER_SCALE: u32; // layers in 2^46 places

fn layer_of(fraction: u32) -> u32 { return min(high_of_product(fraction, LAYER_SCALE) >> 14u, LAYERS - 1u); }
