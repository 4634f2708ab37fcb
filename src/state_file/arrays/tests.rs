#![allow(clippy::unwrap_used)]
use super::*;
use rawzip::CompressionMethod;
use std::fs;

/// An array of version 1 with this header and these bytes.
fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    [b"\x93NUMPY\x01\x00", &(header.len() as u16).to_le_bytes()[..], header.as_bytes(), data].concat()
}

fn described(descr: &str, by_columns: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if by_columns { "True" } else { "False" };
    npy(&format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({shape}), }}\n"), data)
}

#[test]
fn arrays_of_any_order_have_the_same_numbers() {
    // 0 1 2
    // 3 4 5
    let rows = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    let columns = [0.0, 3.0, 1.0, 4.0, 2.0, 5.0];
    let singles = |values: [f64; 6]| values.map(|value| value as f32);
    for bytes in [
        described("<f8", false, "2, 3", &rows.map(f64::to_le_bytes).concat()),
        described(">f8", false, "2, 3", &rows.map(f64::to_be_bytes).concat()),
        described("<f4", false, "2, 3,", &singles(rows).map(f32::to_le_bytes).concat()),
        described(">f4", true, "2, 3", &singles(columns).map(f32::to_be_bytes).concat()),
        described("<f8", true, "2, 3", &columns.map(f64::to_le_bytes).concat()),
    ] {
        let array = npy::read(&bytes, "").unwrap();
        assert_eq!((array.shape, array.values), (vec![2, 3], rows.to_vec()));
    }
    let three = described("<f8", true, "2, 1, 2", &[0.0, 2.0, 1.0, 3.0].map(f64::to_le_bytes).concat());
    assert_eq!(npy::read(&three, "").unwrap().values, [0.0, 1.0, 2.0, 3.0]);
}

#[test]
fn what_is_no_array_of_numbers_is_refused() {
    for (bytes, expected) in [
        (described("|O", false, "2", &[0; 16]), "it holds objects of Python"),
        (described("<i8", false, "2", &[0; 16]), "its type is `<i8`"),
        (npy("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (2,), }", &[0; 16]), "its type is `[('a'"),
        (described("<f8", false, "3", &[0; 16]), "its shape [3] takes another number of bytes than the 16 that it has"),
        (described("<f8", false, "4294967296, 4294967296", &[]), "its shape"),
        (described("<f8", false, "-1", &[]), "it is cut short or no array"),
        (b"\x93NUMPY\x09\x00\x00\x00".to_vec(), "it is cut short or no array"),
    ] {
        let found = npy::read(&bytes, "").unwrap_err().found;
        assert!(found.starts_with(expected), "{found}");
    }
    let whole = described("<f8", false, "2", &[0; 16]);
    assert!((0..whole.len()).all(|length| npy::read(&whole[..length], "").is_err()));
}

/// An archive with an array that is stored and one that is deflated.
fn archive() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    let data = described("<f8", false, "2", &[1.5, -2.0].map(f64::to_le_bytes).concat());
    let packed = miniz_oxide::deflate::compress_to_vec(&data, 6);
    for (name, method, content) in
        [("h.npy", CompressionMethod::STORE, &data), ("u.npy", CompressionMethod::DEFLATE, &packed)]
    {
        let (mut entry, config) = archive.new_file(name).compression_method(method).start().unwrap();
        // The sum is that of what is packed.
        let mut writer = config.wrap(std::io::sink());
        std::io::Write::write_all(&mut writer, &data).unwrap();
        let (_, descriptor) = writer.finish().unwrap();
        std::io::Write::write_all(&mut entry, content).unwrap();
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

#[test]
fn archives_are_read_and_damage_is_found() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("fields.npz");
    let whole = archive();
    fs::write(&path, &whole).unwrap();
    let file = ArrayFile::open(&path).unwrap();
    assert_eq!(file.names(), ["h", "u"]);
    for name in ["h", "u"] {
        assert_eq!(file.read(name).unwrap().values, [1.5, -2.0]);
    }
    // Not a byte of the arrays can change without notice.
    let read = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        ArrayFile::open(&path).and_then(|file| Ok((file.read("h")?, file.read("u")?)))
    };
    let good = read(&whole).unwrap();
    for place in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[place] ^= 0x55;
        assert!(read(&damaged).map_or(true, |found| found == good), "byte {place}");
    }
    for length in 0..whole.len() {
        assert!(read(&whole[..length]).is_err(), "{length} bytes");
    }
    for (bytes, expected) in [
        (&b"\x89HDF\r\n\x1a\n"[..], "it is a file of HDF5"),
        (b"\x93NUMPY", "it is a single array of NumPy"),
        (b"CDF\x03", "its format is CDF-3"),
        (b"CDF\x02\x00", "its header is cut short"),
        (b"a table", "it has no format that is known"),
        (b"", "it has no format that is known"),
    ] {
        let found = read(bytes).unwrap_err().found;
        assert!(found.starts_with(expected), "{found}");
    }
}
