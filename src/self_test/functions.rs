//! How far the functions of an adapter are from the true ones, and how far WGSL lets them be:
//! <https://www.w3.org/TR/WGSL/#floating-point-accuracy>.

use super::Finding;
use super::compute::compute;
use super::random::{of_any_magnitude, uniform};
use crate::gpu::{Gpu, GpuError};

/// Points of each function.
const POINTS: u32 = 1 << 14;

/// A function that kernels rest on, in the order of `shaders/check/functions.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// x / y.
    Quotient,
    /// √x.
    SquareRoot,
    /// 1/√x.
    InverseSquareRoot,
    /// eˣ.
    Exponential,
    /// The natural logarithm.
    Logarithm,
    /// Within a turn.
    Sine,
    /// Within a turn.
    Cosine,
    /// xʸ of x up to one.
    Power,
    /// x + y.
    Sum,
    /// x y.
    Product,
    /// To the next integer, to the even one of two that are equally near.
    Rounding,
}

/// The largest error of a function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FunctionError {
    /// Of which function.
    pub function: Function,
    /// The largest difference from the true value.
    pub absolute: f64,
    /// The largest difference in units of the last place of the true value.
    pub last_places: f64,
    /// The largest part of what WGSL allows; more than one is wrong.
    pub of_allowed: f64,
}

/// The distance between numbers of single precision near a value; 2⁻¹⁴⁹ × 2²³ at least, for what is smaller may be flushed to zero.
fn last_place(value: f64) -> f64 {
    let exponent = value.abs().max(f64::from(f32::MIN_POSITIVE)).log2().floor();
    (exponent - 23.0).exp2()
}

impl Function {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Quotient,
        Self::SquareRoot,
        Self::InverseSquareRoot,
        Self::Exponential,
        Self::Logarithm,
        Self::Sine,
        Self::Cosine,
        Self::Power,
        Self::Sum,
        Self::Product,
        Self::Rounding,
    ];

    /// As WGSL writes it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Quotient => "x / y",
            Self::SquareRoot => "sqrt",
            Self::InverseSquareRoot => "inverseSqrt",
            Self::Exponential => "exp",
            Self::Logarithm => "log",
            Self::Sine => "sin",
            Self::Cosine => "cos",
            Self::Power => "pow",
            Self::Sum => "x + y",
            Self::Product => "x * y",
            Self::Rounding => "round",
        }
    }

    /// The point of a number, in the range in which kernels ask for it.
    fn point(self, number: u32) -> [f32; 2] {
        let [u, v] = [0, 1].map(|part| uniform(number, 2 * self as u32 + part));
        let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        let point = match self {
            Self::Quotient | Self::Product => [sign * of_any_magnitude(1e-6, 1e6, u), of_any_magnitude(1e-6, 1e6, v)],
            Self::SquareRoot | Self::InverseSquareRoot => [of_any_magnitude(1e-20, 1e20, u), 0.0],
            Self::Exponential => [20.0 - 40.0 * u, 0.0],
            // Every other one near one, where the logarithm is near zero.
            Self::Logarithm if number.is_multiple_of(2) => [1.0 - of_any_magnitude(6e-8, 0.5, u), 0.0],
            Self::Logarithm => [u, 0.0],
            Self::Sine | Self::Cosine => [std::f64::consts::PI * (2.0 * u - 1.0), 0.0],
            Self::Power => [u, 4.0 * v],
            Self::Sum => [sign * of_any_magnitude(1e-3, 1e3, u), of_any_magnitude(1e-3, 1e3, v)],
            // Every other one halfway between two integers.
            Self::Rounding if number.is_multiple_of(2) => [(8e6 * u).floor() - 4e6 + 0.5, 0.0],
            Self::Rounding => [8e6 * u - 4e6, 0.0],
        };
        point.map(|coordinate| coordinate as f32)
    }

    /// The true value at a point.
    fn at(self, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Quotient => x / y,
            Self::SquareRoot => x.sqrt(),
            Self::InverseSquareRoot => 1.0 / x.sqrt(),
            Self::Exponential => x.exp(),
            Self::Logarithm => x.ln(),
            Self::Sine => x.sin(),
            Self::Cosine => x.cos(),
            Self::Power => x.powf(y),
            Self::Sum => x + y,
            Self::Product => x * y,
            Self::Rounding => x.round_ties_even(),
        }
    }

    /// How far from the true value the answer may be.
    fn allowed(self, [x, y]: [f64; 2]) -> f64 {
        let value = self.at([x, y]);
        let places = |count: f64| count * last_place(value);
        match self {
            Self::Quotient => places(2.5),
            // As one over the inverse square root.
            Self::SquareRoot => places(2.0 + 2.5),
            Self::InverseSquareRoot => places(2.0),
            Self::Exponential => places(3.0 + 2.0 * x.abs()),
            Self::Logarithm if (0.5..=2.0).contains(&x) => 0.5_f64.powi(21),
            Self::Logarithm => places(3.0),
            Self::Sine | Self::Cosine => 0.5_f64.powi(11),
            // As the exponential to base two of y times the logarithm to base two.
            Self::Power => {
                let logarithm = x.log2();
                let error = if x >= 0.5 { 0.5_f64.powi(21) } else { 3.0 * last_place(logarithm) };
                let exponent = y * logarithm;
                let error = y * error + 0.5 * last_place(exponent);
                value * (error * std::f64::consts::LN_2).exp_m1() + places(3.0 + 2.0 * exponent.abs())
            }
            // Rounded to one of the two neighbours, whichever the mode.
            Self::Sum | Self::Product => places(1.0),
            Self::Rounding => 0.0,
        }
    }

    fn error(self, gpu: &Gpu) -> Result<FunctionError, GpuError> {
        let points: Vec<[f32; 2]> = (0..POINTS).map(|number| self.point(number)).collect();
        let number = Self::ALL.iter().position(|known| *known == self).unwrap_or(0);
        let text = include_str!("../../shaders/check/functions.wgsl");
        let constants = [("FUNCTION", number as f64)];
        let values = compute(gpu, text, &constants, bytemuck::cast_slice(&points), points.len())?;
        let mut largest = FunctionError { function: self, absolute: 0.0, last_places: 0.0, of_allowed: 0.0 };
        for (point, value) in points.iter().zip(values) {
            let point = point.map(f64::from);
            let exact = self.at(point);
            let found = f64::from(f32::from_bits(value));
            // What is not a number is as wrong as can be.
            let error = if found.is_finite() { (found - exact).abs() } else { f64::INFINITY };
            let of_allowed = if error == 0.0 { 0.0 } else { error / self.allowed(point) };
            largest.absolute = largest.absolute.max(error);
            largest.last_places = largest.last_places.max(error / last_place(exact));
            largest.of_allowed = largest.of_allowed.max(of_allowed);
        }
        Ok(largest)
    }
}

impl FunctionError {
    pub(super) fn finding(&self) -> Finding {
        let Self { function, absolute, last_places, of_allowed } = self;
        let found = match function {
            Function::Logarithm | Function::Sine | Function::Cosine => format!("off by {absolute:.1e} at most"),
            _ => format!("off by {last_places:.2} in the last place at most"),
        };
        let share = if of_allowed.is_finite() {
            format!("{found}, {:.0} % of what WGSL allows", 100.0 * of_allowed)
        } else {
            format!("{found}, which is wrong")
        };
        Finding::new(format!("function {}", function.name()), *of_allowed <= 1.0, share)
    }
}

/// The largest errors of all functions on an adapter.
///
/// ```
/// use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
/// use mesoscope::self_test::errors_of_functions;
///
/// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
/// for error in errors_of_functions(&gpu)? {
///     assert!(error.of_allowed <= 1.0, "{error:?}");
/// }
/// # Ok::<(), mesoscope::gpu::GpuError>(())
/// ```
///
/// # Errors
/// [`GpuError`] if the adapter refuses the kernel.
pub fn errors_of_functions(gpu: &Gpu) -> Result<Vec<FunctionError>, GpuError> {
    Function::ALL.into_iter().map(|function| function.error(gpu)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_place_is_that_of_single_precision() {
        for value in [1.0_f32, 1.5, 0.3, 6e-20, 3e30] {
            let next = f32::from_bits(value.to_bits() + 1);
            assert_eq!(last_place(f64::from(value)), f64::from(next) - f64::from(value));
        }
    }

    /// Values rounded to single precision are allowed, and some that are off are not.
    #[test]
    fn what_is_allowed_is_more_than_rounding_and_less_than_anything() {
        for function in Function::ALL {
            for point in (0..1000).map(|number| function.point(number).map(f64::from)) {
                let exact = function.at(point);
                assert!(exact.is_finite(), "{function:?} {point:?}");
                let allowed = function.allowed(point);
                assert!((f64::from(exact as f32) - exact).abs() <= allowed, "{function:?} {point:?}");
                assert!(allowed <= 1e-3 * exact.abs().max(1.0), "{function:?} {point:?}: {allowed}");
            }
        }
    }
}
