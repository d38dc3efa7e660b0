//! A PNG of nothing but its pixels, for the decoder to read.

use super::chunks::{ChunkHead, chunk};
use super::head::Head;
use std::io::{self, BufRead, ErrorKind, Read, Seek, SeekFrom};

/// Signature, header and palette, then the chunks of pixels straight from the file, then an end.
///
/// So the decoder neither sees nor unpacks anything else.
pub(super) struct Image<R> {
    file: R,
    /// What was made here and is to be read before the file is.
    made: io::Cursor<Vec<u8>>,
    /// Bytes that are left of the chunk of pixels in the file.
    left: u64,
    /// The first chunk after the pixels, of which only this has been read.
    pub next: Option<ChunkHead>,
}

impl<R: BufRead> Image<R> {
    pub(super) fn new(file: R, head: &Head) -> Image<R> {
        let mut image = Image {
            file,
            made: io::Cursor::new(head.needed.clone()),
            left: 0,
            next: None,
        };
        image.pass(head.image);
        image
    }

    /// Lets a chunk of pixels through, with its checksum.
    fn pass(&mut self, head: ChunkHead) {
        self.made.get_mut().extend((head.size as u32).to_be_bytes());
        self.made.get_mut().extend(head.kind);
        self.left = head.size + 4;
    }

    /// At the end of a chunk: another chunk of pixels, or the end of the picture.
    fn go_on(&mut self) -> io::Result<()> {
        let mut bytes = [0; 8];
        self.file.read_exact(&mut bytes)?;
        let [s0, s1, s2, s3, kind @ ..] = bytes;
        let head = ChunkHead {
            kind,
            size: u64::from(u32::from_be_bytes([s0, s1, s2, s3])),
        };
        self.made = io::Cursor::default();
        if head.kind == *b"IDAT" {
            self.pass(head);
        } else {
            self.made.get_mut().extend(chunk(*b"IEND", &[]));
            self.next = Some(head);
        }
        Ok(())
    }

    fn made_is_read(&self) -> bool {
        self.made.position() == self.made.get_ref().len() as u64
    }
}

impl<R: BufRead> BufRead for Image<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.made_is_read() && self.left == 0 && self.next.is_none() {
            self.go_on()?;
        }
        if !self.made_is_read() || self.left == 0 {
            return self.made.fill_buf();
        }
        let buffer = self.file.fill_buf()?;
        if buffer.is_empty() {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        // The smaller of the two fits into memory.
        let end = self.left.min(buffer.len() as u64) as usize;
        Ok(&buffer[..end])
    }

    fn consume(&mut self, amount: usize) {
        if self.made_is_read() {
            self.file.consume(amount);
            self.left -= amount as u64;
        } else {
            self.made.consume(amount);
        }
    }
}

impl<R: BufRead> Read for Image<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut available = self.fill_buf()?;
        let amount = available.read(buffer)?;
        self.consume(amount);
        Ok(amount)
    }
}

/// The decoder asks for it, and does not use it: a pipe can be read too.
impl<R> Seek for Image<R> {
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        Err(ErrorKind::Unsupported.into())
    }
}
