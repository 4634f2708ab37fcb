//! The appearance of plots and pictures.

use super::Axis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The appearance of the plots.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlotStyle {
    /// Width of a plot in pixels.
    #[schemars(range(min = 320, max = 8192))]
    pub width: u32,
    /// Height of a plot in pixels; left out, three quarters of the width, and for fields what follows from the shape of the box.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 240, max = 8192))]
    pub height: Option<u32>,
    /// Factor on all font sizes and line widths.
    #[schemars(range(min = 0.25, max = 8.0))]
    pub scale: f64,
    /// Light or dark.
    pub theme: Theme,
    /// Headings of charts.
    pub headings: Headings,
    /// Formats of vector graphics in which charts are written beside PNG.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 2))]
    pub vector: Vec<VectorFormat>,
    /// Names of the units in charts.
    #[serde(skip_serializing_if = "UnitNames::are_usual")]
    pub units: UnitNames,
}

/// Headings of charts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Headings {
    /// Title and conditions (default).
    #[default]
    All,
    /// Conditions without the title.
    Conditions,
    /// Nothing but what is left out of the panels.
    None,
}

/// A format of vector graphics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VectorFormat {
    /// Scalable Vector Graphics.
    Svg,
    /// Portable Document Format, a page as large as the chart.
    Pdf,
}

impl VectorFormat {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Svg, Self::Pdf];

    /// The end of the names of its files.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Pdf => "pdf",
        }
    }
}

/// Names of the units in charts, such as `r_{c}` for the unit of length; one that is left out has its usual name. Numbers stay those of the scene.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct UnitNames {
    /// The unit of length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<String>,
    /// The unit of mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<String>,
    /// The unit of time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// The unit of energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<String>,
}

impl UnitNames {
    /// True if no unit has another name.
    pub(crate) fn are_usual(&self) -> bool {
        *self == Self::default()
    }

    /// A label with the names of the units.
    ///
    /// ```
    /// use mesoscope::scene::UnitNames;
    ///
    /// let names = UnitNames { length: Some("r_{c}".to_owned()), time: Some("τ".to_owned()), ..UnitNames::default() };
    /// assert_eq!(names.in_label("Velocity u (length units/time unit)"), "Velocity u (r_{c}/τ)");
    /// ```
    #[must_use]
    pub fn in_label(&self, label: &str) -> String {
        let names = [("length", &self.length), ("mass", &self.mass), ("time", &self.time), ("energy", &self.energy)];
        let given = names.into_iter().filter_map(|(unit, name)| Some((unit, name.as_ref()?)));
        given.fold(label.to_owned(), |label, (unit, name)| {
            label.replace(&format!("{unit} units"), name).replace(&format!("{unit} unit"), name)
        })
    }
}

impl Default for PlotStyle {
    fn default() -> Self {
        Self {
            width: 1600,
            height: None,
            scale: 1.0,
            theme: Theme::Light,
            headings: Headings::All,
            vector: Vec::new(),
            units: UnitNames::default(),
        }
    }
}

impl PlotStyle {
    /// Height of a plot in pixels.
    ///
    /// ```
    /// use mesoscope::scene::PlotStyle;
    /// assert_eq!(PlotStyle { width: 800, ..PlotStyle::default() }.height(), 600);
    /// assert_eq!(PlotStyle { height: Some(500), ..PlotStyle::default() }.height(), 500);
    /// ```
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height.unwrap_or(self.width * 3 / 4)
    }
}

/// Colours of background and ink.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Theme {
    /// Dark ink on white (default).
    #[default]
    Light,
    /// Light ink on near-black.
    Dark,
}

/// Pictures of the particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Snapshot {
    /// Steps between two numbered pictures `snapshot-<number>.png`; zero writes only `snapshot.png` at the end.
    pub every: u64,
    /// Width of a picture in pixels; left out, what follows from the shape of the box.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 64, max = 8192))]
    pub width: Option<u32>,
    /// Height of a picture in pixels; left out, what follows from the shape of the box. Without both the longer side has 1200.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 64, max = 8192))]
    pub height: Option<u32>,
    /// Radius of the drawn discs in units of length; left out, a third of the largest cutoff.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-of" = ["particles"], "x-instead" = {
        "voronoi": "no `radius` in Voronoi DPD: pictures show cells, not discs",
    }))]
    pub radius: Option<f64>,
    /// Whether bonds are drawn, where there are any.
    pub bonds: bool,
    /// The side from which a box of three dimensions is seen.
    #[serde(skip_serializing_if = "is_corner")]
    pub view: SnapshotView,
    /// The slice of a box of three dimensions whose particles alone are drawn; left out, all of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slice: Option<SnapshotSlice>,
    /// The species that are shown; left out, all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 256), extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "no `species` in Voronoi DPD: its cells fill the box",
    }))]
    pub species: Vec<String>,
    /// The quantity that the colour of a particle shows; left out, the species, or the density for Voronoi cells of one species.
    pub color: SnapshotColor,
    /// The lowest and the highest value on the scale of colours, of all pictures of the run; left out, they follow from the
    /// first picture and the temperature of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// True where the scene has `null` in its place: nothing is drawn.
    #[serde(skip)]
    pub is_off: bool,
}

impl Snapshot {
    /// No picture.
    fn off() -> Self {
        Self { is_off: true, ..Self::default() }
    }
}

/// A snapshot, or `null` for none.
pub(super) mod nullable {
    use super::Snapshot;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(in super::super) fn serialize<S: Serializer>(snapshot: &Snapshot, serializer: S) -> Result<S::Ok, S::Error> {
        (!snapshot.is_off).then_some(snapshot).serialize(serializer)
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Snapshot, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or_else(Snapshot::off))
    }
}

/// The side from which a box of three dimensions is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SnapshotView {
    /// From beside a corner, a little from above (default).
    #[default]
    Corner,
    /// Against the x axis: y to the right, z upwards.
    X,
    /// Along the y axis: x to the right, z upwards.
    Y,
    /// Against the z axis: x to the right, y upwards.
    Z,
}

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_corner(view: &SnapshotView) -> bool {
    *view == SnapshotView::Corner
}

/// A slice of the box, normal to an axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SnapshotSlice {
    /// The axis that it is normal to.
    pub axis: Axis,
    /// Its middle along this axis, in units of length.
    #[schemars(range(min = 0))]
    pub position: f64,
    /// Its thickness, in units of length: particles are drawn whose centres lie in it.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub thickness: f64,
}

impl SnapshotSlice {
    /// True if it holds a coordinate along its axis, which repeats after `period`, or does not.
    pub(crate) fn holds(&self, coordinate: f64, period: Option<f64>) -> bool {
        let distance = coordinate - self.position;
        let distance = period.map_or(distance, |period| distance - period * (distance / period).round());
        distance.abs() <= 0.5 * self.thickness
    }
}

impl Default for Snapshot {
    fn default() -> Self {
        Self {
            every: 0,
            width: None,
            height: None,
            radius: None,
            bonds: true,
            view: SnapshotView::default(),
            slice: None,
            species: Vec::new(),
            color: SnapshotColor::default(),
            range: None,
            is_off: false,
        }
    }
}

/// The quantity that the colour of a particle shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SnapshotColor {
    /// The species.
    #[default]
    Species,
    /// The speed, on a perceptually uniform scale.
    Speed,
    /// The density, for Voronoi cells only.
    #[schemars(extend("x-of" = ["voronoi"]))]
    Density,
    /// The internal temperature, for Voronoi cells with internal energies only.
    #[schemars(extend("x-of" = ["voronoi"]))]
    Temperature,
}
