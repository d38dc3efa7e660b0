//! A render on its way as a file: the raw sums, so that going on gives the bits of a render that was never
//! stopped.
//!
//! ```text
//! magic (8 bytes) | length of the head, u64 | head, JSON | film | BLAKE3 (32 bytes)
//! film = sums, squares: 3 x f64 a pixel | counts: u64 a pixel
//! ```
//!
//! Where samples are cut into randomisations, the sums of the open ones stand behind the squares: 3 x f64 a pixel.
//! Where sampling is adaptive, the film of the scouts follows that of the picture, and then, u64 a tile, the
//! samples that the picture is to have by now.
//!
//! Numbers are little-endian; the hash is over everything before it.

use super::bytes::data;
use super::moments::{Film, NonFinite};
use super::randomisations::{Pictures, Randomisations};
use super::record::Record;
use super::same::difference;
use super::scouts::{Scouts, Tiles};
use crate::error::{Error, Result};
use crate::knobs::{short, shown};
use crate::pack::Rect;
use crate::place::Place;
use crate::wording::named;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};

/// The last character is the format's version.
const MAGIC: [u8; 8] = *b"lampray2";
/// The largest head, in bytes.
const HEAD_LIMIT: u64 = 16 << 20;
/// Of a pixel: two sums of three channels and a count.
const PIXEL: u64 = 56;
/// Of a pixel that has an open randomisation: three channels more.
const OPEN: u64 = 24;
const HASH: u64 = 32;
/// Numbers that are read or written at a time.
const CHUNK: usize = 1 << 13;

/// A render on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// What the render was when this was saved.
    pub record: Record,
    /// The samples of each pixel that were asked for: from the first on, up to and without the second.
    pub samples: [u64; 2],
    pub film: Film,
    /// Of adaptive sampling.
    pub scouts: Option<Scouts>,
}

#[derive(Serialize, Deserialize)]
struct Head {
    record: Record,
    samples: [u64; 2],
    region: [u32; 4],
    /// Sample, row and column.
    first_non_finite: Option<(u64, u32, u32)>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scouts: Option<ScoutsHead>,
    /// Absent where samples are independent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    randomisations: Option<Sets>,
}

/// What the planes of scouts do not say.
#[derive(Serialize, Deserialize)]
struct ScoutsHead {
    asked: u64,
    rung: u64,
    rays: u64,
    non_finite: u64,
    first_non_finite: Option<(u64, u32, u32)>,
}

impl ScoutsHead {
    fn of(scouts: &Scouts) -> Self {
        let film = &scouts.film;
        Self {
            asked: scouts.asked,
            rung: scouts.rung,
            rays: film.rays,
            non_finite: film.non_finite,
            first_non_finite: film.first_non_finite.map(place),
        }
    }

    /// Bytes of a film of scouts and of what the picture's tiles are to have.
    fn announced(region: Rect) -> u64 {
        (region.area() as u64)
            .saturating_mul(PIXEL)
            .saturating_add(8 * Tiles::of(region).count() as u64)
    }

    fn read(&self, reader: &mut impl Read, region: Rect) -> io::Result<Scouts> {
        let mut scouts = Scouts::new(region, 0);
        get_film(reader, &mut scouts.film)?;
        get(reader, &mut scouts.wanted, u64::from_le_bytes)?;
        (scouts.asked, scouts.rung) = (self.asked, self.rung);
        let film = &mut scouts.film;
        (film.rays, film.non_finite) = (self.rays, self.non_finite);
        film.first_non_finite = self.first_non_finite.map(non_finite);
        Ok(scouts)
    }
}

fn place(first: NonFinite) -> (u64, u32, u32) {
    (first.sample, first.y, first.x)
}

fn non_finite((sample, y, x): (u64, u32, u32)) -> NonFinite {
    NonFinite { sample, y, x }
}

/// What the head says of randomisations.
#[derive(Serialize, Deserialize)]
struct Sets {
    length: u64,
    pictures: Option<Pictures>,
}

/// Where the checkpoint before the last is kept.
pub fn previous(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".previous");
    name.into()
}

impl Checkpoint {
    /// Writes the checkpoint; the one that was there stays as [`previous`].
    ///
    /// # Errors
    /// [`Error::Create`] or [`Error::Write`]; what was there before is then still there.
    pub fn save(
        path: &Path,
        record: &Record,
        samples: [u64; 2],
        film: &Film,
        scouts: Option<&Scouts>,
    ) -> Result<()> {
        let rect = film.region;
        let head = Head {
            record: record.clone(),
            samples,
            region: [rect.x0, rect.y0, rect.x1, rect.y1],
            first_non_finite: film.first_non_finite.map(place),
            scouts: scouts.map(ScoutsHead::of),
            randomisations: film.randomisations.as_ref().map(|all| Sets {
                length: all.length,
                pictures: all.pictures.clone(),
            }),
        };
        let head = serde_json::to_vec(&head).map_err(|fault| Error::Internal(fault.to_string()))?;
        Place::prepare(path)?.write_keeping(&previous(path), |sink| {
            let mut sink = Hashing::new(sink);
            sink.write_all(&MAGIC)?;
            sink.write_all(&(head.len() as u64).to_le_bytes())?;
            sink.write_all(&head)?;
            put_film(&mut sink, film)?;
            if let Some(scouts) = scouts {
                put_film(&mut sink, &scouts.film)?;
                put(&mut sink, &scouts.wanted, |count| count.to_le_bytes())?;
            }
            let hash = sink.hasher.finalize();
            sink.inner.write_all(hash.as_bytes())
        })
    }

    /// Reads a checkpoint.
    ///
    /// # Errors
    /// [`Error::Input`]; [`Error::Data`] for what is none, is cut short or has a bit that is not as it was.
    pub fn read(path: &Path) -> Result<Self> {
        let input = |source| Error::Input {
            path: path.into(),
            source,
        };
        let file = File::open(path).map_err(input)?;
        let length = file.metadata().map_err(input)?.len();
        let mut reader = Hashing::new(BufReader::with_capacity(1 << 16, file));
        Self::read_from(&mut reader, length)
            .map_err(input)?
            .map_err(|reason| data(path, reason))
    }

    /// The outer error is the disk's, the inner one the content's.
    fn read_from(
        reader: &mut Hashing<impl Read>,
        length: u64,
    ) -> io::Result<std::result::Result<Self, String>> {
        let no_checkpoint = || Ok(Err("not a checkpoint of this version of lampray".into()));
        let cut = || Ok(Err("the checkpoint is damaged: it is cut short".into()));
        let fixed = MAGIC.len() as u64 + 8 + HASH;
        if length < fixed {
            return no_checkpoint();
        }
        if take::<8>(reader)? != MAGIC {
            return no_checkpoint();
        }
        let head_length = u64::from_le_bytes(take(reader)?);
        if head_length > HEAD_LIMIT || head_length > length - fixed {
            return cut();
        }
        let mut bytes = vec![0; head_length as usize];
        reader.read_exact(&mut bytes)?;
        let Ok(head) = serde_json::from_slice::<Head>(&bytes) else {
            return Ok(Err(
                "the checkpoint is damaged: its head cannot be read".into()
            ));
        };
        let [x0, y0, x1, y1] = head.region;
        if x0 >= x1 || y0 >= y1 {
            return Ok(Err("the checkpoint is damaged: it is of no pixels".into()));
        }
        let region = Rect { x0, y0, x1, y1 };
        // Nothing is allocated that the file does not have.
        let of_scouts = head
            .scouts
            .as_ref()
            .map_or(0, |_| ScoutsHead::announced(region));
        let pixel = PIXEL + head.randomisations.as_ref().map_or(0, |_| OPEN);
        let announced = (region.area() as u64)
            .saturating_mul(pixel)
            .saturating_add(of_scouts);
        if announced != length - fixed - head_length {
            return cut();
        }
        let mut film = Film::new(region);
        if let Some(sets) = &head.randomisations {
            if sets.length == 0 {
                let reason = "the checkpoint is damaged: its randomisations have no samples";
                return Ok(Err(reason.into()));
            }
            film.randomisations = Some(Randomisations {
                length: sets.length,
                open: vec![[0.0; 3]; film.counts.len()],
                pictures: sets.pictures.clone(),
            });
        }
        get_film(reader, &mut film)?;
        let scouts = match &head.scouts {
            Some(scouts) => Some(scouts.read(reader, region)?),
            None => None,
        };
        let hash = reader.hasher.finalize();
        if take::<32>(reader)? != *hash.as_bytes() {
            return Ok(Err(
                "the checkpoint is damaged: its checksum is another".into()
            ));
        }
        Ok(Self::of(head, film, scouts))
    }

    /// What a whole file says, if it can be.
    fn of(
        head: Head,
        mut film: Film,
        mut scouts: Option<Scouts>,
    ) -> std::result::Result<Self, String> {
        let no_sums = || "the checkpoint holds no sums of a render".to_string();
        film.paths = paths(&film)
            .filter(|paths| *paths == head.record.paths)
            .ok_or_else(no_sums)?;
        if let Some(scouts) = &mut scouts {
            scouts.film.paths = paths(&scouts.film).ok_or_else(no_sums)?;
        }
        film.rays = head.record.rays;
        film.non_finite = head.record.non_finite;
        film.first_non_finite = head.first_non_finite.map(non_finite);
        Ok(Self {
            record: head.record,
            samples: head.samples,
            film,
            scouts,
        })
    }

    /// Whether a file begins as a checkpoint does.
    pub fn is_one(path: &Path) -> bool {
        let head = File::open(path).and_then(|mut file| take::<8>(&mut file));
        head.is_ok_and(|head| head == MAGIC)
    }

    /// The last whole checkpoint: that at `path`, or where it is damaged, empty or missing the one before, with a
    /// remark. None where there is neither.
    ///
    /// # Errors
    /// Those of reading the one at `path`, where the one before is no better.
    pub fn newest(path: &Path) -> Result<Option<(Self, Option<String>)>> {
        let missing = |error: &Error| matches!(error, Error::Input { source, .. } if source.kind() == io::ErrorKind::NotFound);
        let fault = match Self::read(path) {
            Ok(checkpoint) => return Ok(Some((checkpoint, None))),
            Err(fault) => fault,
        };
        // A render that was killed before it saved anything leaves an empty file.
        let is_empty = fs::metadata(path).is_ok_and(|found| found.len() == 0);
        let before = previous(path);
        match Self::read(&before) {
            Ok(checkpoint) => {
                let remark = format!("{fault}; going on from {}", named(&before));
                Ok(Some((checkpoint, Some(remark))))
            }
            Err(error) if (is_empty || missing(&fault)) && missing(&error) => Ok(None),
            // What the one before is like matters only where it is all there is.
            Err(error) if missing(&fault) => Err(error),
            Err(_) => Err(fault),
        }
    }

    /// Refuses to go on with another render than `wanted`, which has the `samples`.
    ///
    /// # Errors
    /// [`Error::Data`] with the name of what is another.
    pub fn refuse_other(&self, path: &Path, wanted: &Record, samples: [u64; 2]) -> Result<()> {
        let other = |what: &str, here: &str, there: &str| {
            let [what, here, there] = [what, here, there].map(short);
            Err(data(
                path,
                format!(
                    "{what} is {there} in the checkpoint, and {here} now: it is of another render; go on with the same command, or leave out --resume and give --checkpoint another name"
                ),
            ))
        };
        let versions = [&wanted.version, &self.record.version];
        if versions[0] != versions[1] {
            return other("lampray's version", versions[0], versions[1]);
        }
        if let Some(found) = difference(wanted, &self.record, None) {
            return other(&found.what, &found.one, &found.other);
        }
        let targets = [wanted.target_error, self.record.target_error];
        if targets[0] != targets[1] {
            let [here, there] = targets.map(|target| target.map_or("none".into(), shown));
            return other("the target error", &here, &there);
        }
        let rules = [&wanted.adaptive, &self.record.adaptive];
        let rules = rules.map(|rule| rule.as_ref().map_or("even", |rule| &rule.rule));
        if rules[0] != rules[1] {
            return other("how the samples are shared out", rules[0], rules[1]);
        }
        if samples != self.samples {
            let shown = |[from, to]: [u64; 2]| format!("{from}..{to}");
            return other(
                "the range of samples",
                &shown(samples),
                &shown(self.samples),
            );
        }
        let took_part = self.record.all_devices();
        if !took_part
            .iter()
            .any(|device| device.is_like(&wanted.device))
        {
            let shown =
                |record: &Record| format!("{} ({})", record.device.name, record.device.driver);
            return other("the device", &shown(wanted), &shown(&self.record));
        }
        // After the device, which decides it too.
        if wanted.kernel != self.record.kernel {
            return other("the kernel", &wanted.kernel, &self.record.kernel);
        }
        Ok(())
    }
}

/// How many paths a film's sums are of, if they can be sums.
fn paths(film: &Film) -> Option<u64> {
    let mut sums = planes(film).flat_map(|plane| plane.as_flattened());
    let finite = sums.all(|sum| sum.is_finite());
    let add = |sum: u64, count: &u64| sum.checked_add(*count);
    film.counts.iter().try_fold(0, add).filter(|_| finite)
}

/// Bytes on their way through a hash.
struct Hashing<T> {
    inner: T,
    hasher: blake3::Hasher,
}

impl<T> Hashing<T> {
    fn new(inner: T) -> Self {
        Self {
            inner,
            hasher: blake3::Hasher::new(),
        }
    }
}

impl<T: Write> Write for Hashing<T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<T: Read> Read for Hashing<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(bytes)?;
        self.hasher.update(&bytes[..read]);
        Ok(read)
    }
}

fn take<const N: usize>(reader: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    reader.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn put<T: Copy>(
    sink: &mut impl Write,
    values: &[T],
    bytes: impl Fn(T) -> [u8; 8],
) -> io::Result<()> {
    let mut buffer = Vec::with_capacity(8 * CHUNK);
    for chunk in values.chunks(CHUNK) {
        buffer.clear();
        buffer.extend(chunk.iter().flat_map(|value| bytes(*value)));
        sink.write_all(&buffer)?;
    }
    Ok(())
}

fn get<T>(
    reader: &mut impl Read,
    values: &mut [T],
    value: impl Fn([u8; 8]) -> T,
) -> io::Result<()> {
    let mut buffer = vec![0; 8 * CHUNK];
    for chunk in values.chunks_mut(CHUNK) {
        let bytes = &mut buffer[..8 * chunk.len()];
        reader.read_exact(bytes)?;
        let (numbers, _) = bytes.as_chunks::<8>();
        for (place, number) in chunk.iter_mut().zip(numbers) {
            *place = value(*number);
        }
    }
    Ok(())
}

/// What a film adds up in, but for its counts.
fn planes(film: &Film) -> impl Iterator<Item = &Vec<[f64; 3]>> {
    let open = film.randomisations.iter().map(|all| &all.open);
    [&film.sums, &film.squares].into_iter().chain(open)
}

fn put_film(sink: &mut impl Write, film: &Film) -> io::Result<()> {
    for plane in planes(film) {
        put(sink, plane.as_flattened(), |value| value.to_le_bytes())?;
    }
    put(sink, &film.counts, |count| count.to_le_bytes())
}

fn get_film(reader: &mut impl Read, film: &mut Film) -> io::Result<()> {
    let open = film.randomisations.iter_mut().map(|all| &mut all.open);
    for plane in [&mut film.sums, &mut film.squares].into_iter().chain(open) {
        get(reader, plane.as_flattened_mut(), f64::from_le_bytes)?;
    }
    get(reader, &mut film.counts, u64::from_le_bytes)
}
