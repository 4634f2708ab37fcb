//! Pictures as PNG, with the id of their run.

use super::{Id, RunDirectory};
use super::{OutputError, id, own_file};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ExtendedColorType, ImageEncoder, RgbaImage};
use std::io::{self, Read};
use std::path::Path;

/// Signature of the format and the first chunk, which describes the picture: a text may follow.
const BEGINNING: usize = 8 + 12 + 13;
/// The signature.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

impl RunDirectory {
    /// Writes a picture with the id of its run or sweep (a `tEXt` chunk), which appears complete or not at all.
    ///
    /// # Errors
    /// [`OutputError::Io`] when the file cannot be written.
    pub fn write_picture(&self, name: &str, id: Id, picture: RgbaImage) -> Result<(), OutputError> {
        // Pictures are opaque. Level 4 takes a third of the time of the default and a twentieth more space.
        let picture = DynamicImage::from(picture).into_rgb8();
        self.write(name, |writer| {
            let mut encoded = Vec::new();
            PngEncoder::new_with_quality(&mut encoded, CompressionType::Level(4), FilterType::Adaptive)
                .write_image(picture.as_raw(), picture.width(), picture.height(), ExtendedColorType::Rgb8)
                .map_err(io::Error::other)?;
            let (beginning, rest) = encoded.split_at_checked(BEGINNING).ok_or(io::ErrorKind::InvalidData)?;
            writer.write_all(beginning)?;
            writer.write_all(&text_chunk(id.key(), &id.to_string()))?;
            writer.write_all(rest)
        })?;
        Ok(())
    }
}

/// A chunk of text: length, name, keyword and text with a zero between, CRC-32.
fn text_chunk(keyword: &str, text: &str) -> Vec<u8> {
    let content = [b"tEXt", keyword.as_bytes(), &[0], text.as_bytes()].concat();
    let length = (content.len() - 4) as u32;
    [&length.to_be_bytes(), &content[..], &crc32fast::hash(&content).to_be_bytes()].concat()
}

/// The id in a picture; none where there is no picture of mesoscope.
pub(super) fn id_of(path: &Path) -> Option<Id> {
    let mut beginning = Vec::new();
    let longest = BEGINNING + text_chunk(id::SWEEP_KEY, &"-".repeat(id::LENGTH)).len();
    own_file::open(path).ok()?.take(longest as u64).read_to_end(&mut beginning).ok()?;
    if !beginning.starts_with(SIGNATURE) {
        return None;
    }
    let chunk = beginning.get(BEGINNING..)?;
    [id::RUN_KEY, id::SWEEP_KEY].into_iter().find_map(|key| {
        let start = 8 + key.len() + 1;
        let id = Id::parse(std::str::from_utf8(chunk.get(start..start + id::LENGTH)?).ok()?)?;
        (id.key() == key && chunk.starts_with(&text_chunk(key, &id.to_string()))).then_some(id)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene;

    #[test]
    fn pictures_hold_the_id_of_their_run() {
        let place = tempfile::tempdir().unwrap();
        let directory = RunDirectory::create(place.path()).unwrap();
        let run = Id::of_run(&scene::load("dpd-fluid", &[]).unwrap());
        let picture = RgbaImage::from_fn(30, 20, |x, y| image::Rgba([x as u8, y as u8, 7, 255]));
        for id in [run, Id::of_sweep([run])] {
            directory.write_picture("a.png", id, picture.clone()).unwrap();
            assert_eq!(id_of(&directory.file("a.png")), Some(id));
            assert!(image::open(directory.file("a.png")).unwrap().to_rgba8() == picture);
        }
        picture.save(directory.file("b.png")).unwrap();
        assert_eq!(id_of(&directory.file("b.png")), None);
        assert_eq!(id_of(&directory.file("none.png")), None);
        std::fs::write(directory.file("c.png"), "text").unwrap();
        assert_eq!(id_of(&directory.file("c.png")), None);
    }
}
