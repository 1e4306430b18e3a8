//! Text in other encodings as UTF-8.

use std::io::{self, BufRead, Read};

use crate::recording::input::read_buffered;
use crate::recording::layout::words::Encoding;

/// A byte order mark in each encoding that has one.
const MARKS: [(&[u8], Encoding); 3] = [
    (b"\xef\xbb\xbf", Encoding::Utf8),
    (b"\xff\xfe", Encoding::Utf16Le),
    (b"\xfe\xff", Encoding::Utf16Be),
];

/// The encoding that the first bytes of a text tell: by their mark, or by letters of two bytes of which
/// every other one is 0.
pub(in crate::recording) fn encoding_of(first: &[u8]) -> Encoding {
    if let Some((_, encoding)) = MARKS.iter().find(|(mark, _)| first.starts_with(mark)) {
        return *encoding;
    }
    let zeros = |from: usize| {
        let mut every_other = first.iter().skip(from).step_by(2);
        first.len() >= 4 && every_other.all(|byte| *byte == 0)
    };
    match (zeros(0), zeros(1)) {
        (false, true) => Encoding::Utf16Le,
        (true, false) => Encoding::Utf16Be,
        _ => Encoding::Utf8,
    }
}

/// Bytes of a text as UTF-8; what is UTF-8 already passes as it is.
pub(in crate::recording) fn as_utf8<'a>(
    reader: impl BufRead + Send + 'a,
    encoding: Encoding,
) -> Box<dyn BufRead + Send + 'a> {
    match encoding {
        Encoding::Utf8 => Box::new(reader),
        encoding => Box::new(Transcoded {
            reader,
            encoding,
            high: None,
            text: Vec::new(),
            taken: 0,
        }),
    }
}

/// A text while its letters are written in UTF-8.
struct Transcoded<R> {
    reader: R,
    encoding: Encoding,
    /// The first half of a letter beyond 16 bits.
    high: Option<u16>,
    text: Vec<u8>,
    taken: usize,
}

impl<R: BufRead> Transcoded<R> {
    /// Takes one unit of the encoding; whether there was one.
    fn unit(&mut self) -> io::Result<Option<u16>> {
        let mut bytes = [0; 2];
        let count = match self.encoding {
            Encoding::Latin1 => 1,
            _ => 2,
        };
        let mut read = 0;
        while read < count {
            match self.reader.read(&mut bytes[read..count]) {
                Ok(0) if read == 0 => return Ok(None),
                Ok(0) => {
                    let message = "the text in UTF-16 ends within a letter";
                    return Err(io::Error::new(io::ErrorKind::InvalidData, message));
                }
                Ok(more) => read += more,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Some(match self.encoding {
            Encoding::Utf16Be => u16::from_be_bytes(bytes),
            _ => u16::from_le_bytes(bytes),
        }))
    }

    fn push(&mut self, letter: char) {
        let mut buffer = [0; 4];
        let letter = letter.encode_utf8(&mut buffer);
        self.text.extend_from_slice(letter.as_bytes());
    }

    /// Writes the letter that a unit ends; halves without the other are no letters.
    fn write(&mut self, unit: u16) {
        let units = self.high.take().into_iter().chain([unit]);
        for letter in char::decode_utf16(units) {
            match letter {
                Ok(letter) => self.push(letter),
                Err(half) if (0xd800..0xdc00).contains(&half.unpaired_surrogate()) => {
                    self.high = Some(half.unpaired_surrogate());
                }
                Err(_) => self.push(char::REPLACEMENT_CHARACTER),
            }
        }
    }
}

impl<R: BufRead> BufRead for Transcoded<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        const LETTERS: usize = 1 << 15;
        if self.taken == self.text.len() {
            self.text.clear();
            self.taken = 0;
            while self.text.len() < LETTERS {
                match self.unit()? {
                    Some(unit) => self.write(unit),
                    None => break,
                }
            }
        }
        Ok(&self.text[self.taken..])
    }

    fn consume(&mut self, count: usize) {
        self.taken += count;
    }
}

impl<R: BufRead> Read for Transcoded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        read_buffered(self, buffer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_every_length_come_out_as_utf_8() {
        let text = "\u{feff}t;°/s;\u{1d6c0}\r\n1;2,5;3\n".repeat(9000);
        for (encoding, order) in [
            (Encoding::Utf16Le, u16::to_le_bytes as fn(u16) -> [u8; 2]),
            (Encoding::Utf16Be, u16::to_be_bytes),
        ] {
            let bytes: Vec<u8> = text.encode_utf16().flat_map(order).collect();
            assert_eq!(encoding_of(&bytes[..8]), encoding);
            // Without its mark as well.
            let plain: Vec<u8> = "t;r1\n".encode_utf16().flat_map(order).collect();
            assert_eq!(encoding_of(&plain[..8]), encoding);
            let mut read = String::new();
            as_utf8(&bytes[..], encoding)
                .read_to_string(&mut read)
                .unwrap();
            assert!(read == text);
        }
        let mut read = String::new();
        as_utf8(&b"\xb0/s"[..], Encoding::Latin1)
            .read_to_string(&mut read)
            .unwrap();
        assert_eq!(read, "°/s");
        assert_eq!(encoding_of(b"1.5\n2.5\n"), Encoding::Utf8);
        assert!(
            as_utf8(&b"a\0b"[..], Encoding::Utf16Le)
                .read_to_string(&mut read)
                .is_err()
        );
    }
}
