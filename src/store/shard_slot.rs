//! The place of one part of results that many processes make, each its own: a file of its own in a folder
//! that they share.
//!
//! While it is made the file stands in the workshop and grows by whole records, so that a kill leaves what is
//! finished. Its maker has a lock of its own, and a share in that of the folder, so that nobody else has the
//! folder alone meanwhile.

use std::fs::{self, File};
use std::io::{self, BufReader, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use super::WORKSHOP;
use super::error::{Foreign, StoreError};
use super::files::{plain_file, rename_to_free, stands};
use super::flush::flush_folder;
use super::lock::{Lock, holder_of, refuse_inside_held};
use super::output_folder::refuse_unusable;
use super::record::digest_of;
use super::single_file::SingleFile;

/// End of the name of a file that is being made, behind its own.
pub const WORK_SUFFIX: &str = ".part";
/// End of the name of a lock.
const LOCK_SUFFIX: &str = ".lock";
/// End of the name of a record of completion, in place of that of the file.
const RECORD_EXTENSION: &str = "toml";
/// Bytes of the digest behind each record.
const DIGEST_BYTES: usize = 32;

/// One part in the hands of this process until dropped.
#[derive(Debug)]
pub struct ShardSlot {
    place: PathBuf,
    work: PathBuf,
    magic: &'static [u8],
    cautions: Vec<String>,
    _folder: Lock,
    _own: Lock,
}

impl ShardSlot {
    /// Takes the place of the file `name` in a folder, made if absent.
    ///
    /// * `magic`: how each such file begins.
    ///
    /// # Errors
    /// [`StoreError`]: the folder or the file is in use, or a file of the user's stands there.
    pub fn take(
        folder: &Path,
        name: &str,
        magic: &'static [u8],
        is_forced: bool,
    ) -> Result<Self, StoreError> {
        refuse_unusable(folder)?;
        refuse_inside_held(folder)?;
        let place = folder.join(name);
        refuse_theirs(&place, magic, is_forced)?;
        let workshop = folder.join(WORKSHOP);
        fs::create_dir_all(&workshop).map_err(StoreError::at(&workshop))?;
        let shared = Lock::share(folder, &workshop)?;
        let own = Lock::take_own(&place, &workshop.join(format!("{name}{LOCK_SUFFIX}")))?;
        let cautions = shared.caution.iter().chain(&own.caution).cloned().collect();
        Ok(Self {
            work: workshop.join(format!("{name}{WORK_SUFFIX}")),
            place,
            magic,
            cautions,
            _folder: shared,
            _own: own,
        })
    }

    /// What is worth saying of the folder.
    #[must_use]
    pub fn cautions(&self) -> &[String] {
        &self.cautions
    }

    /// Where the finished file stands.
    #[must_use]
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// The file that was begun, its whole records handed to `take`, which says whether they are to be kept;
    /// what a kill cut short behind them goes. Without one, or where it is not to be kept, an empty file.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn begin(&self, take: &mut dyn FnMut(&[u8]) -> bool) -> Result<ShardWork, StoreError> {
        let at = StoreError::at(&self.work);
        let mut options = plain_file();
        let opened = options.read(true).write(true).create(true).truncate(false);
        let mut file = opened.open(&self.work).map_err(&at)?;
        let mut is_kept = true;
        let end = read_records(&mut file, self.magic, &mut |record, _| {
            is_kept = is_kept && take(record);
            is_kept
        });
        let end = end.map_err(&at)?.filter(|_| is_kept);
        file.set_len(end.unwrap_or(0)).map_err(&at)?;
        file.seek(SeekFrom::End(0)).map_err(&at)?;
        if end.is_none() {
            file.write_all(self.magic).map_err(&at)?;
        }
        Ok(ShardWork { file })
    }

    /// Puts the finished file in its place, with a record of completion beside it: `record` makes the text
    /// from the digest of the file.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn finish(
        &self,
        work: ShardWork,
        record: impl FnOnce(&str) -> String,
    ) -> Result<(), StoreError> {
        let at = StoreError::at(&self.place);
        work.file.sync_all().map_err(StoreError::at(&self.work))?;
        drop(work);
        let digest = digest_of(&self.work).map_err(StoreError::at(&self.work))?;
        // The record of an earlier file must not pass for one of this.
        let path = record_path(&self.place);
        if stands(&path).map_err(StoreError::at(&path))? {
            fs::remove_file(&path).map_err(StoreError::at(&path))?;
        }
        if stands(&self.place).map_err(&at)? {
            fs::rename(&self.work, &self.place).map_err(&at)?;
        } else {
            rename_to_free(&self.work, &self.place).map_err(&at)?;
        }
        if let Some(folder) = self.place.parent() {
            flush_folder(folder).map_err(StoreError::at(folder))?;
        }
        self.write_record(&record(&digest))
    }

    /// Writes the record of completion of a file that stands in its place.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn write_record(&self, text: &str) -> Result<(), StoreError> {
        let path = record_path(&self.place);
        let file = SingleFile {
            path: &path,
            is_ours: None,
            force: true,
        };
        file.write(text)
    }
}

/// Path of the record of completion of a file.
#[must_use]
pub fn record_path(place: &Path) -> PathBuf {
    place.with_extension(RECORD_EXTENSION)
}

/// A file that is being made.
#[derive(Debug)]
pub struct ShardWork {
    file: File,
}

impl ShardWork {
    /// Appends a record whole.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn append(&mut self, record: &[u8]) -> io::Result<()> {
        let length = record.len() as u64;
        // In one piece, so that a kill leaves as little as can be of half a record.
        let mut bytes = Vec::with_capacity(record.len() + 8 + DIGEST_BYTES);
        bytes.extend_from_slice(&length.to_le_bytes());
        bytes.extend_from_slice(record);
        bytes.extend_from_slice(blake3::hash(record).as_bytes());
        self.file.write_all(&bytes)
    }
}

/// Takes a record with its place, first byte and length, and says whether to go on.
pub type TakeRecord<'a> = dyn FnMut(&[u8], (u64, usize)) -> bool + 'a;

/// Hands over the whole records of a file until one is refused; where the last of them ends, none if the file
/// does not begin as it must.
///
/// # Errors
/// Whatever the file system says.
pub fn read_records(
    file: &mut File,
    magic: &[u8],
    take: &mut TakeRecord,
) -> io::Result<Option<u64>> {
    let size = file.metadata()?.len();
    file.rewind()?;
    let mut reader = BufReader::with_capacity(1 << 16, file);
    let mut begin = vec![0; magic.len()];
    if reader.read_exact(&mut begin).is_err() || begin != magic {
        return Ok(None);
    }
    let mut end = magic.len() as u64;
    let mut record = Vec::new();
    loop {
        let mut length = [0; 8];
        let mut digest = [0; DIGEST_BYTES];
        let left = size.saturating_sub(end + (length.len() + digest.len()) as u64);
        if reader.read_exact(&mut length).is_err() {
            return Ok(Some(end));
        }
        let length = u64::from_le_bytes(length);
        let Some(bytes) = usize::try_from(length).ok().filter(|_| length <= left) else {
            return Ok(Some(end));
        };
        record.resize(bytes, 0);
        let is_read =
            reader.read_exact(&mut record).is_ok() && reader.read_exact(&mut digest).is_ok();
        if !is_read
            || *blake3::hash(&record).as_bytes() != digest
            || !take(&record, (end + 8, bytes))
        {
            return Ok(Some(end));
        }
        end += 8 + length + DIGEST_BYTES as u64;
    }
}

/// Opens a file of a place for reading; none where none stands.
///
/// # Errors
/// Whatever the file system says.
pub fn open_place(place: &Path) -> io::Result<Option<File>> {
    if !stands(place)? {
        return Ok(None);
    }
    plain_file().read(true).open(place).map(Some)
}

/// A folder of places that nobody else writes into until this is dropped.
#[derive(Debug)]
pub struct HeldFolder {
    _lock: Lock,
}

impl HeldFolder {
    /// Takes a folder that holds places; none where nothing was ever written into it here.
    ///
    /// # Errors
    /// [`StoreError::InUse`] while somebody writes there, or whatever the file system says.
    pub fn take(folder: &Path) -> Result<Option<Self>, StoreError> {
        let workshop = folder.join(WORKSHOP);
        if !workshop.is_dir() {
            return Ok(None);
        }
        let lock = Lock::take(folder, &workshop).map_err(|error| named(error, &workshop))?;
        Ok(Some(Self { _lock: lock }))
    }
}

/// A refusal of the lock of a folder that names those who hold places of it: they share the lock, and only
/// their own ones name them.
pub(super) fn named(error: StoreError, workshop: &Path) -> StoreError {
    match error {
        StoreError::InUse { folder, holder } => StoreError::InUse {
            holder: holders(workshop).unwrap_or(holder),
            folder,
        },
        other => other,
    }
}

/// Who holds a place of a folder, in words; none if nobody does.
#[must_use]
pub fn holder_of_place(folder: &Path, name: &str) -> Option<String> {
    holder_of(&folder.join(WORKSHOP).join(format!("{name}{LOCK_SUFFIX}")))
}

/// Who holds places of the folder of a workshop, in words; none if nobody does.
fn holders(workshop: &Path) -> Option<String> {
    let entries = fs::read_dir(workshop).ok()?.flatten();
    let mut held: Vec<String> = entries
        .filter_map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let place = name.strip_suffix(LOCK_SUFFIX)?;
            let holder = holder_of(&entry.path())?;
            Some(format!("{holder}, which makes {place}"))
        })
        .collect();
    held.sort();
    let more = held.len().saturating_sub(1);
    let first = held.into_iter().next()?;
    Some(if more == 0 {
        first
    } else {
        format!("{first}, and {more} more")
    })
}

/// Refuses to replace a file that does not begin as one of the tool's.
fn refuse_theirs(place: &Path, magic: &[u8], is_forced: bool) -> Result<(), StoreError> {
    let at = StoreError::at(place);
    if !stands(place).map_err(&at)? {
        return Ok(());
    }
    let refused = |reason| {
        Err(StoreError::FileNotOurs {
            path: place.to_owned(),
            reason,
        })
    };
    let kind = fs::symlink_metadata(place).map_err(&at)?;
    if kind.is_symlink() {
        return refused(Foreign::Link);
    }
    if !kind.is_file() {
        return refused(Foreign::NoFile);
    }
    let mut begin = vec![0; magic.len()];
    let mut file = plain_file().read(true).open(place).map_err(&at)?;
    let is_ours = file.read_exact(&mut begin).is_ok() && begin == magic;
    if is_ours || is_forced {
        Ok(())
    } else {
        refused(Foreign::Unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAGIC: &[u8] = b"magic\n";

    fn slot(folder: &Path) -> ShardSlot {
        ShardSlot::take(folder, "one.shard", MAGIC, false).expect("free")
    }

    fn kept(slot: &ShardSlot) -> (Vec<Vec<u8>>, ShardWork) {
        let mut records = Vec::new();
        let work = slot.begin(&mut |record| {
            records.push(record.to_vec());
            true
        });
        (records, work.expect("writable"))
    }

    #[test]
    fn whole_records_outlive_a_kill_and_half_ones_go() {
        let folder = tempfile::tempdir().unwrap();
        let slot = slot(folder.path());
        let (none, mut work) = kept(&slot);
        assert!(none.is_empty());
        work.append(b"first").unwrap();
        work.append(b"second").unwrap();
        drop(work);
        let whole = fs::read(&slot.work).unwrap();
        for cut in MAGIC.len()..=whole.len() {
            fs::write(&slot.work, &whole[..cut]).unwrap();
            let (records, mut work) = kept(&slot);
            work.append(b"third").unwrap();
            drop(work);
            let (again, _) = kept(&slot);
            assert_eq!(again.len(), records.len() + 1, "cut at {cut}");
            assert_eq!(again.last().unwrap(), b"third");
        }
        fs::write(&slot.work, &whole[..2]).unwrap();
        assert!(kept(&slot).0.is_empty(), "no beginning");
        let mut damaged = whole;
        damaged[MAGIC.len() + 9] ^= 1;
        fs::write(&slot.work, &damaged).unwrap();
        assert!(kept(&slot).0.is_empty(), "a digest that does not fit");
    }

    #[test]
    fn places_of_a_folder_are_taken_side_by_side_but_each_by_one_and_none_with_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let _first = slot(folder.path());
        let _other = ShardSlot::take(folder.path(), "two.shard", MAGIC, false).expect("free");
        let again = ShardSlot::take(folder.path(), "one.shard", MAGIC, false);
        assert!(matches!(again, Err(StoreError::InUse { .. })), "{again:?}");
        let workshop = folder.path().join(WORKSHOP);
        let alone = Lock::take(folder.path(), &workshop);
        assert!(matches!(alone, Err(StoreError::InUse { .. })));
        assert!(holders(&workshop).unwrap().contains("makes one.shard"));
    }

    #[test]
    fn a_file_of_the_users_stays() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("one.shard"), "thesis").unwrap();
        let refused = ShardSlot::take(folder.path(), "one.shard", MAGIC, false);
        assert!(matches!(refused, Err(StoreError::FileNotOurs { .. })));
    }
}
