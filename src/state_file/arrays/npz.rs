//! The archive `.npz` of `NumPy`: a zip file with an array in every member, stored or deflated.

use super::{Array, LARGEST, npy, of_array};
use crate::state_file::Mistake;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder};
use std::io::Read;

/// A member of the archive.
pub(super) struct Member {
    /// The name of its array.
    pub name: String,
    place: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
}

const ACCEPTED: &str = "an archive as `numpy.savez` or `numpy.savez_compressed` writes it";

fn damaged(place: &str, error: impl std::fmt::Display) -> Mistake {
    Mistake::new(place, format!("the archive is damaged ({error})"), ACCEPTED)
}

/// The members of an archive.
pub(super) fn members(bytes: &[u8]) -> Result<Vec<Member>, Mistake> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| damaged("", error))?;
    let mut members = Vec::new();
    let mut entries = archive.entries();
    while let Some(entry) = entries.next_entry().map_err(|error| damaged("", error))? {
        let path = String::from_utf8_lossy(entry.file_path().as_ref()).into_owned();
        let name = path.strip_suffix(".npy").unwrap_or(&path).to_owned();
        members.push(Member { name, place: entry.wayfinder(), method: entry.compression_method() });
    }
    Ok(members)
}

/// The array of a name.
pub(super) fn read(bytes: &[u8], members: &[Member], name: &str) -> Result<Array, Mistake> {
    let place = of_array(name);
    let wrong = |error: &dyn std::fmt::Display| damaged(&place, error);
    let archive = ZipArchive::from_slice(bytes).map_err(|error| wrong(&error))?;
    let member = members.iter().find(|member| member.name == name).ok_or_else(|| wrong(&"it is not there"))?;
    let entry = archive.get_entry(member.place).map_err(|error| wrong(&error))?;
    let inflated = match member.method {
        CompressionMethod::STORE => entry.data().to_vec(),
        CompressionMethod::DEFLATE => {
            // What an entry says of its size may be anything.
            let most = member.place.uncompressed_size_hint().min(LARGEST) as usize;
            miniz_oxide::inflate::decompress_to_vec_with_limit(entry.data(), most).map_err(|error| wrong(&error))?
        }
        _ => return Err(Mistake::new(place, "it is compressed in another way than by deflation", ACCEPTED)),
    };
    let mut content = Vec::with_capacity(inflated.len());
    entry.verifying_reader(inflated.as_slice()).read_to_end(&mut content).map_err(|error| wrong(&error))?;
    npy::read(&content, &place)
}
