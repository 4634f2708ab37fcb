//! The part of a page that is of one directory.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::ImageFormat;
use image::codecs::jpeg::JpegEncoder;
use serde::Serialize;
use serde_json::Value;
use std::fmt::Display;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// The widest pictures of a page, in pixels: twice what a column shows.
pub(super) const WIDTH: u32 = 960;

/// Bytes of the widest picture from which on it is a JPEG: charts stay sharp, and snapshots of many particles, of which
/// a page may have a dozen, are a fifth of what they were.
const MOST_BYTES: usize = 400_000;

/// Quality of JPEGs, of 100: dots keep their edges.
const QUALITY: u8 = 80;

/// A fact in a line.
#[derive(Debug, Serialize)]
pub(super) struct Fact {
    pub name: &'static str,
    pub text: String,
}

/// A key whose value is not that of a built-in scene.
#[derive(Debug, Serialize)]
pub(super) struct Difference {
    pub key: String,
    pub before: String,
    pub after: String,
}

/// A table of text.
#[derive(Debug, Default, Serialize)]
pub(super) struct TextTable {
    pub heading: String,
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
    /// Places of columns with numbers.
    pub numbers: Vec<usize>,
    pub note: Option<String>,
}

impl TextTable {
    pub(super) fn new(heading: &str, header: &[&str], rows: Vec<Vec<String>>) -> Self {
        let header = header.iter().map(|name| (*name).to_owned()).collect();
        Self { heading: heading.to_owned(), header, rows, ..Self::default() }
    }
}

/// A picture inside of the page.
#[derive(Debug, Serialize)]
pub(super) struct Inside {
    pub name: String,
    /// Its kind, as addresses of data name it.
    pub kind: &'static str,
    pub data: String,
}

/// All that is said.
#[derive(Debug, Default, Serialize)]
pub(super) struct Entry {
    pub title: String,
    pub kind: &'static str,
    pub directory: String,
    pub when: Option<String>,
    pub description: Option<String>,
    pub missing: Vec<String>,
    pub facts: Vec<Fact>,
    pub builtin: Option<String>,
    pub differences: Vec<Difference>,
    pub warnings: Vec<String>,
    pub tables: Vec<TextTable>,
    /// HTML that was made of the page of a study.
    pub words: Option<String>,
    /// That page without its title, in Markdown.
    #[serde(skip)]
    pub markdown: Option<String>,
    pub conserved: Vec<String>,
    pub not_conserved: Vec<String>,
    pub pictures: Vec<Inside>,
    pub strip: Vec<Inside>,
    pub repeat: Vec<String>,
    /// The use of the scene or the request.
    pub scene_use: String,
    pub command: Option<String>,
    /// Text of the scene or the request, and which of them it is.
    pub scene: Option<String>,
    pub scene_is: &'static str,
}

impl Entry {
    /// Nothing yet of a directory.
    pub(super) fn of(kind: &'static str, directory: &Path) -> Self {
        let name = directory.file_name().map(|name| name.to_string_lossy().into_owned());
        let title = name.clone().unwrap_or_default();
        Self {
            kind,
            title,
            directory: name.unwrap_or_else(|| ".".to_owned()),
            scene_is: "The scene, with every default",
            ..Self::default()
        }
    }

    pub(super) fn add_fact(&mut self, name: &'static str, text: impl Into<String>) {
        self.facts.push(Fact { name, text: text.into() });
    }

    /// The value, or nothing where it cannot be read: the reason is then among what is missing.
    pub(super) fn readable<T>(&mut self, read: Result<T, impl Display>) -> Option<T> {
        read.map_err(|error| self.missing.push(error.to_string())).ok()
    }
}

/// Pictures of a directory by their names.
pub(super) fn pictures(directory: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "png")).collect();
    found.sort();
    found
}

/// A picture inside of the page, at most so many pixels wide: a page is to be sent around.
pub(super) fn inside(path: &Path, width: u32) -> Result<Inside, String> {
    let name = path.file_stem().map(|stem| stem.to_string_lossy().replace('_', " ")).unwrap_or_default();
    let bytes = fs::read(path).map_err(|error| format!("`{name}` cannot be read: {error}"))?;
    let damaged = |error: image::ImageError| format!("`{name}` is damaged: {error}");
    let picture = image::load_from_memory_with_format(&bytes, ImageFormat::Png).map_err(damaged)?;
    let is_small = picture.width() <= width;
    let picture =
        if is_small { picture } else { picture.resize(width, u32::MAX, image::imageops::FilterType::CatmullRom) };
    // Pictures have no holes, and JPEG knows none.
    let picture = image::DynamicImage::from(picture.into_rgb8());
    let bytes = if is_small { bytes } else { encoded(&picture, ImageFormat::Png).map_err(damaged)? };
    if bytes.len() <= MOST_BYTES * width as usize / WIDTH as usize {
        return Ok(Inside { name, kind: "png", data: STANDARD.encode(bytes) });
    }
    let bytes = encoded(&picture, ImageFormat::Jpeg).map_err(damaged)?;
    Ok(Inside { name, kind: "jpeg", data: STANDARD.encode(bytes) })
}

fn encoded(picture: &image::DynamicImage, format: ImageFormat) -> image::ImageResult<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    match format {
        ImageFormat::Jpeg => picture.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, QUALITY))?,
        format => picture.write_to(&mut bytes, format)?,
    }
    Ok(bytes.into_inner())
}

/// A value in a line.
pub(super) fn in_a_line(value: &Value) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
