//! Fields on the mesh, as pictures and arrays.

use crate::document::defaults::is_default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fields on the mesh, as pictures and arrays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Fields {
    /// Steps between two numbered pictures and arrays; zero writes them only at the end.
    pub every: u64,
    /// The format of the arrays.
    #[serde(skip_serializing_if = "is_default")]
    pub format: FieldFormat,
    /// Which fields.
    #[schemars(length(max = 16))]
    pub quantities: Vec<FieldQuantity>,
    /// Ranges of colours.
    pub ranges: FieldRanges,
}

impl Default for Fields {
    fn default() -> Self {
        let quantities = vec![FieldQuantity::Depth, FieldQuantity::PotentialVorticity];
        Self { every: 0, format: FieldFormat::default(), quantities, ranges: FieldRanges::default() }
    }
}

/// The format of arrays of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FieldFormat {
    /// A `.npy` file of `NumPy` of every field and time (default); the first index is that of x.
    #[default]
    Npy,
    /// A `NetCDF` file of all fields of a time, with their coordinates and the names of the CF conventions: `fields.nc`, and numbered ones.
    Netcdf,
}

/// The lowest and the highest value on the colour scale of each field, for all pictures of the run. A range that is left out follows
/// from the first of several numbered pictures, or from the only picture.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FieldRanges {
    /// The range of the depth, in mean depths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<[f64; 2]>,
    /// The range of the potential vorticity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub potential_vorticity: Option<[f64; 2]>,
    /// The range of the vorticity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vorticity: Option<[f64; 2]>,
    /// The range of the speed of the flow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<[f64; 2]>,
    /// The range of the velocity along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_x: Option<[f64; 2]>,
    /// The range of the velocity along y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_y: Option<[f64; 2]>,
}

impl FieldRanges {
    /// The range of a field, if it is given.
    ///
    /// ```
    /// use mesoscope::scene::{FieldQuantity, FieldRanges};
    /// let ranges = FieldRanges { depth: Some([0.8, 1.2]), ..FieldRanges::default() };
    /// assert_eq!(ranges.of(FieldQuantity::Depth), Some([0.8, 1.2]));
    /// assert_eq!(ranges.of(FieldQuantity::Speed), None);
    /// ```
    #[must_use]
    pub fn of(&self, quantity: FieldQuantity) -> Option<[f64; 2]> {
        match quantity {
            FieldQuantity::Depth => self.depth,
            FieldQuantity::PotentialVorticity => self.potential_vorticity,
            FieldQuantity::Vorticity => self.vorticity,
            FieldQuantity::Speed => self.speed,
            FieldQuantity::VelocityX => self.velocity_x,
            FieldQuantity::VelocityY => self.velocity_y,
        }
    }
}

/// A field on the mesh of shallow water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "snake_case")]
pub enum FieldQuantity {
    /// The smoothed depth h.
    Depth,
    /// The potential vorticity (ζ + f₀)/h with ζ = ∂v/∂x - ∂u/∂y.
    PotentialVorticity,
    /// The vorticity ζ.
    Vorticity,
    /// The speed of the flow.
    Speed,
    /// The velocity along x.
    VelocityX,
    /// The velocity along y.
    VelocityY,
}

impl FieldQuantity {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Depth, Self::PotentialVorticity, Self::Vorticity, Self::Speed, Self::VelocityX, Self::VelocityY];

    /// The stem of the names of its files.
    #[must_use]
    pub fn stem(self) -> &'static str {
        self.into()
    }
}
