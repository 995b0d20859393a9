//! Forms of files, known by their first bytes: those that are read, and those that are not, with what to do about them.

use std::io::Read;
use std::path::Path;

use super::error::ImportError;
use crate::file;

/// First bytes that are looked at.
const LOOKED_AT: u64 = 1 << 16;

/// A form that is not text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Signature {
    /// Its name, for people.
    pub what: &'static str,
    /// Value of `form` that reads it; none for one that is not read.
    pub form: Option<&'static str>,
    /// What to do with one that is not read.
    advice: &'static str,
    /// Where its bytes stand.
    at: usize,
    bytes: &'static [u8],
}

const fn read_as(
    form: &'static str,
    what: &'static str,
    at: usize,
    bytes: &'static [u8],
) -> Signature {
    Signature {
        what,
        form: Some(form),
        advice: "",
        at,
        bytes,
    }
}

const fn other(
    what: &'static str,
    at: usize,
    bytes: &'static [u8],
    advice: &'static str,
) -> Signature {
    Signature {
        what,
        form: None,
        advice,
        at,
        bytes,
    }
}

/// Forms that are read, for people.
pub(super) const READ: &str =
    "a text, a spreadsheet, Parquet, MAT of version 5 to 7, TDMS or a bag of ROS 2";

const EXPORT: &str = "the program that recorded it exports CSV, Parquet or MAT of version 5 to 7";
const ASAMMDF: &str = "export it as CSV, Parquet or MAT of version 5 to 7: the program that recorded it does, or Python with `asammdf`, \
    which writes a CSV a channel group: python -c \"from asammdf import MDF; MDF('LOG.mf4').export('csv', 'LOG', single_time_base=False, time_from_zero=False, add_units=True)\"";
const H5: &str = "save it as MAT of version 5 to 7 (in MATLAB save(file, '-v7')), or its columns as CSV or Parquet (Python: `h5py` with `pandas`)";
const PANDAS: &str = "save it as CSV or Parquet (Python: `pandas`)";
const UNPACK: &str = "unpack it and import the file in it";
const PICTURE: &str = "the log itself is asked for, not a picture of it";

// Long enough that no text begins so.
#[rustfmt::skip] // A table: a form a line. A longer signature stands before a shorter one that it begins with.
const SIGNATURES: &[Signature] = &[
    read_as("parquet", "a Parquet table", 0, b"PAR1\x15"),
    read_as("mat5", "a MAT file of version 5 to 7", 0, b"MATLAB 5.0 MAT-file"),
    read_as("bag", "a bag in MCAP", 0, b"\x89MCAP0\r\n"),
    read_as("bag", "a SQLite file", 0, b"SQLite format 3\0"),
    read_as("tdms", "a TDMS file", 0, b"TDSm"),
    read_as("text", "packed with gzip", 0, b"\x1f\x8b"),
    read_as("text", "packed with zstd", 0, b"\x28\xb5\x2f\xfd"),
    other("a pointer of Git LFS, not the file itself", 0, b"version https://git-lfs.github.com/spec/", "`git lfs pull` in its repository fetches the file"),
    other("a pointer of git-annex, not the file itself", 0, b"/annex/objects/", "`git annex get` in its repository fetches the file"),
    other("the index of a TDMS file", 0, b"TDSh", "the numbers stand in the .tdms file beside it"),
    other("a measurement file of ASAM MDF (MF4, DAT)", 0, b"MDF     ", ASAMMDF),
    other("a measurement file of ASAM MDF that was not closed", 0, b"UnFinMF ", ASAMMDF),
    other("a bag of ROS 1", 0, b"#ROSBAG V", "`rosbags-convert --src FILE --dst FOLDER` (Python: `rosbags`) makes a bag of ROS 2 of it"),
    other("an HDF5 file (HDF5, MATLAB 7.3, NetCDF 4)", 0, b"\x89HDF\r\n\x1a\n", H5),
    other("a MAT file of version 7.3", 0, b"MATLAB 7.3 MAT-file", H5),
    other("an HDF5 file (HDF5, MATLAB 7.3, NetCDF 4)", 512, b"\x89HDF\r\n\x1a\n", H5),
    other("a NetCDF file", 0, b"CDF\x01", "save it as CSV or Parquet (Python: `xarray`)"),
    other("a NetCDF file", 0, b"CDF\x02", "save it as CSV or Parquet (Python: `xarray`)"),
    other("an Arrow or Feather file", 0, b"ARROW1\0\0", "save it as Parquet (Python: `pyarrow.parquet.write_table(pyarrow.feather.read_table(FILE), ..)`)"),
    other("a Feather file", 0, b"FEA1\0", "save it as Parquet (Python: `pandas.read_feather(FILE).to_parquet(..)`)"),
    other("an Avro file", 0, b"Obj\x01", PANDAS),
    other("an array of NumPy", 0, b"\x93NUMPY", "save it as CSV (Python: `numpy.savetxt(FILE, array, delimiter=\",\")`) or Parquet"),
    other("a pickle of Python", 0, b"\x80\x03", PANDAS),
    other("a pickle of Python", 0, b"\x80\x04\x95", PANDAS),
    other("a pickle of Python", 0, b"\x80\x05\x95", PANDAS),
    other("packed with bzip2", 0, b"BZh", "`bunzip2` unpacks it"),
    other("packed with xz", 0, b"\xfd7zXZ\0", "`unxz` unpacks it"),
    other("packed with lz4", 0, b"\x04\x22\x4d\x18", "`lz4 -d` unpacks it"),
    other("packed with compress", 0, b"\x1f\x9d", "`uncompress` unpacks it"),
    other("an archive of 7-Zip", 0, b"7z\xbc\xaf\x27\x1c", UNPACK),
    other("an archive of RAR", 0, b"Rar!\x1a\x07", UNPACK),
    other("an archive of tar", 257, b"ustar", UNPACK),
    other("a PDF", 0, b"%PDF-", "the numbers themselves are asked for, as CSV or another form"),
    other("a text with formats (RTF)", 0, b"{\\rtf", "save it as plain text"),
    other("a PNG picture", 0, b"\x89PNG\r\n", PICTURE),
    other("a JPEG picture", 0, b"\xff\xd8\xff", PICTURE),
    other("a log of PX4 (ULog)", 0, b"ULog\x01\x12\x35", "`ulog2csv` (Python: `pyulog`) makes CSV of it, a file a topic"),
    other("a log of a CAN bus (BLF)", 0, b"LOGG\x90\0\0\0", "decode it with its DBC and export it as CSV (`asammdf`, or Python: `cantools` with `python-can`)"),
    other("a capture of a network (pcap)", 0, b"\xd4\xc3\xb2\xa1", "the measured numbers as CSV are asked for; `tshark -T fields` exports them"),
    other("a capture of a network (pcapng)", 0, b"\x0a\x0d\x0d\x0a", "the measured numbers as CSV are asked for; `tshark -T fields` exports them"),
    other("a file of imc FAMOS", 0, b"|CF,", EXPORT),
    other("a file of imc FAMOS", 0, b"|CK,", EXPORT),
    other("a recording of Rerun", 0, b"RRF2", "`samples.parquet` beside it, or another Parquet table, can be read"),
    other("a recording of Rerun", 0, b"RRIO", "`samples.parquet` beside it, or another Parquet table, can be read"),
    other("a WAV file", 8, b"WAVEfmt ", "save it as CSV with a column of times"),
    other("a program", 0, b"\x7fELF", "a log is asked for"),
    other("a program", 0, b"MZ\x90\0", "a log is asked for"),
    other("a journal of SQLite", 0, b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7", "the .db3 file beside it is the bag; the journal is read with it"),
    other("a journal of SQLite", 0, b"\x37\x7f\x06\x82", "the .db3 file beside it is the bag; the journal is read with it"),
    other("a journal of SQLite", 0, b"\x37\x7f\x06\x83", "the .db3 file beside it is the bag; the journal is read with it"),
];

const SPREADSHEET: Signature = read_as("spreadsheet", "a spreadsheet", 0, b"");
const NPZ: Signature = other(
    "an archive of NumPy arrays (npz)",
    0,
    b"",
    "save its arrays as the columns of a CSV or Parquet table",
);
const ZIP: Signature = other("a zip archive", 0, b"", UNPACK);
const JSON: Signature = other(
    "JSON",
    0,
    b"",
    "make CSV of it: `jq -r '[.time, .force] | @csv' FILE > FILE.csv` where each line is an object, `jq -r '.[] | [.time, .force] | @csv' FILE > FILE.csv` where all are in a list",
);
const WEB_PAGE: Signature = other(
    "a web page",
    0,
    b"",
    "was the page of the download saved in place of the file?",
);
const XML: Signature = other("XML", 0, b"", EXPORT);

impl Signature {
    /// Why a file of this form cannot be read as the form that is expected, or at all.
    pub fn refusal(&self, path: &Path, expected: &str) -> ImportError {
        ImportError::Form {
            file: path.to_owned(),
            what: self.what.to_owned(),
            expected: expected.to_owned(),
            advice: match self.form {
                Some("text") => {
                    "unpack it (`gunzip`, `zstd -d`) and import the file in it".to_owned()
                }
                Some(form) => format!("`form = {form:?}` in the map's [[file]] reads it"),
                None => self.advice.to_owned(),
            },
        }
    }
}

impl Signature {
    /// As [`Signature::refusal`], of what a packed file holds.
    pub fn refusal_inside(&self, path: &Path, expected: &str) -> ImportError {
        let advice = match self.form {
            Some(_) => "unpack it (`gunzip`, `zstd -d`) and import the file in it",
            None => self.advice,
        };
        ImportError::Form {
            file: path.to_owned(),
            what: format!(
                "packed, and holds {}",
                self.what.trim_start_matches("packed with ")
            ),
            expected: expected.to_owned(),
            advice: advice.to_owned(),
        }
    }
}

/// Form of a file that is not text, if it is one.
///
/// # Errors
/// It cannot be read.
pub(super) fn of_file(path: &Path) -> Result<Option<Signature>, ImportError> {
    let mut start = Vec::new();
    file::open(path)
        .and_then(|file| file.take(LOOKED_AT).read_to_end(&mut start))
        .map_err(|cause| ImportError::Read {
            file: path.to_owned(),
            cause: cause.to_string(),
        })?;
    if start.starts_with(b"PK\x03\x04") {
        // Names of its members stand in its directory, at its end.
        return Ok(Some(of_archive(&file::read(path).unwrap_or(start))));
    }
    Ok(of_bytes(&start))
}

/// Form that bytes begin with, if it is no text.
pub(super) fn of_bytes(bytes: &[u8]) -> Option<Signature> {
    let begins = |signature: &&Signature| {
        let own = bytes.get(signature.at..);
        own.is_some_and(|own| own.starts_with(signature.bytes))
    };
    if let Some(signature) = SIGNATURES.iter().find(begins) {
        return Some(*signature);
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return Some(of_archive(bytes));
    }
    if bytes.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") {
        return Some(SPREADSHEET);
    }
    of_text(bytes)
}

/// What a zip archive is.
fn of_archive(bytes: &[u8]) -> Signature {
    let has = |name: &[u8]| bytes.windows(name.len()).any(|window| window == name);
    if has(b"xl/workbook.") || has(b"application/vnd.oasis.opendocument.spreadsheet") {
        SPREADSHEET
    } else if has(b".npyPK") || has(b".npy") {
        NPZ
    } else {
        ZIP
    }
}

/// Texts that are no tables.
fn of_text(bytes: &[u8]) -> Option<Signature> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let start = bytes.trim_ascii_start();
    let begins = |word: &[u8]| {
        let own = start.get(..word.len());
        own.is_some_and(|own| own.eq_ignore_ascii_case(word))
    };
    let after = |mark: u8| {
        let rest = start.strip_prefix(&[mark])?;
        rest.trim_ascii_start().first().copied()
    };
    if begins(b"<!doctype html") || begins(b"<html") {
        return Some(WEB_PAGE);
    }
    if begins(b"<?xml") {
        return Some(XML);
    }
    let is_object = after(b'{') == Some(b'"');
    // A list of lists, or of objects; `[Header]` and `[1.5, 2]` begin texts of other kinds.
    let is_list = matches!(after(b'['), Some(b'{' | b'['));
    (is_object || is_list).then_some(JSON)
}

/// Refuses a file that is known to be of another form than the map's, so far as its first bytes say.
///
/// # Errors
/// What it is, and what to do.
pub(super) fn check(path: &Path, form: &str, expected: &str) -> Result<(), ImportError> {
    match of_file(path)? {
        Some(found) if found.form != Some(form) => Err(found.refusal(path, expected)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_signature_hides_another() {
        for (index, later) in SIGNATURES.iter().enumerate() {
            let hides = |earlier: &&Signature| {
                earlier.at == later.at && later.bytes.starts_with(earlier.bytes)
            };
            assert_eq!(SIGNATURES[..index].iter().find(hides), None, "{later:?}");
        }
    }

    #[test]
    fn texts_that_are_tables_are_no_form_of_their_own() {
        for text in [
            "t;p\n0;1\n",
            "[Header]\nRate=100\n",
            "[1.5, 2.0, 3.0]\n[1.6, 2.0, 3.0]\n",
            "{0.5 1}\n",
            "# <xml>\n1 2\n",
            "MDF;1\n",
            "PAR1;PAR2\n0;1\n",
            "LOGG,1\n",
            "BZ;1\n",
        ] {
            assert_eq!(of_bytes(text.as_bytes()), None, "{text}");
        }
        for (bytes, what) in [
            (&b"\xef\xbb\xbf  {\"t\": 1, \"f\": 2}\n"[..], "JSON"),
            (b"[{\"t\": 1}]", "JSON"),
            (b"[\n [0, 1.5],\n [1, 1.6]]", "JSON"),
            (b"\n<!DOCTYPE HTML><head>", "a web page"),
            (b"<?xml version=\"1.0\"?>", "XML"),
            (b"PK\x03\x04 .. data.csv ..", "a zip archive"),
            (b"PK\x03\x04 .. xl/workbook.xml ..", "a spreadsheet"),
            (
                b"PK\x03\x04 .. arr_0.npy ..",
                "an archive of NumPy arrays (npz)",
            ),
        ] {
            assert_eq!(of_bytes(bytes).map(|found| found.what), Some(what));
        }
    }
}
