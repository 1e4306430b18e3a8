//! Values as bytes and back, to the bit: little-endian numbers, texts and lists behind their lengths.

use std::collections::BTreeMap;

use crate::report::interned;

/// What can be written as bytes and read back as the same value.
pub(super) trait Coded: Sized {
    /// Appends the bytes.
    fn put(&self, out: &mut Vec<u8>);
    /// The value whose bytes come next; none where they are none of such a value.
    fn take(from: &mut &[u8]) -> Option<Self>;
}

/// The bytes of a value.
pub(super) fn encoded(value: &impl Coded) -> Vec<u8> {
    let mut out = Vec::new();
    value.put(&mut out);
    out
}

/// The value of some bytes, which are its own to the last.
pub(super) fn decoded<T: Coded>(mut bytes: &[u8]) -> Option<T> {
    let value = T::take(&mut bytes)?;
    bytes.is_empty().then_some(value)
}

fn next<'a>(from: &mut &'a [u8], length: usize) -> Option<&'a [u8]> {
    let (own, rest) = from.split_at_checked(length)?;
    *from = rest;
    Some(own)
}

/// Numbers of a fixed size.
macro_rules! coded_numbers {
    ($($number:ty),*) => {
        $(impl Coded for $number {
            fn put(&self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                let bytes = next(from, size_of::<Self>())?;
                Some(Self::from_le_bytes(bytes.try_into().ok()?))
            }
        })*
    };
}

coded_numbers!(u8, u32, u64, f64);

impl Coded for usize {
    fn put(&self, out: &mut Vec<u8>) {
        (*self as u64).put(out);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        usize::try_from(u64::take(from)?).ok()
    }
}

impl Coded for bool {
    fn put(&self, out: &mut Vec<u8>) {
        u8::from(*self).put(out);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        match u8::take(from)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl Coded for String {
    fn put(&self, out: &mut Vec<u8>) {
        self.len().put(out);
        out.extend_from_slice(self.as_bytes());
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let length = usize::take(from)?;
        let text = std::str::from_utf8(next(from, length)?).ok()?;
        Some(text.to_owned())
    }
}

/// A constant word of the program.
impl Coded for &'static str {
    fn put(&self, out: &mut Vec<u8>) {
        self.len().put(out);
        out.extend_from_slice(self.as_bytes());
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        String::take(from).map(|word| interned(&word))
    }
}

impl<T: Coded> Coded for Option<T> {
    fn put(&self, out: &mut Vec<u8>) {
        self.is_some().put(out);
        if let Some(value) = self {
            value.put(out);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        if bool::take(from)? {
            T::take(from).map(Some)
        } else {
            Some(None)
        }
    }
}

impl<T: Coded> Coded for Vec<T> {
    fn put(&self, out: &mut Vec<u8>) {
        self.len().put(out);
        for value in self {
            value.put(out);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let length = usize::take(from)?;
        // No value is shorter than a byte, so that a damaged length asks for no more than there is.
        let mut values = Vec::with_capacity(length.min(from.len() / size_of::<T>().max(1)));
        for _ in 0..length {
            values.push(T::take(from)?);
        }
        Some(values)
    }
}

impl<K: Coded + Ord, V: Coded> Coded for BTreeMap<K, V> {
    fn put(&self, out: &mut Vec<u8>) {
        self.len().put(out);
        for (key, value) in self {
            key.put(out);
            value.put(out);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let length = usize::take(from)?;
        let pairs = (0..length).map(|_| Some((K::take(from)?, V::take(from)?)));
        pairs.collect()
    }
}

impl<A: Coded, B: Coded> Coded for (A, B) {
    fn put(&self, out: &mut Vec<u8>) {
        self.0.put(out);
        self.1.put(out);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some((A::take(from)?, B::take(from)?))
    }
}

/// A struct as its fields one after the other; a field that is forgotten does not compile.
macro_rules! coded {
    ($($name:ty { $($field:ident),* $(,)? })*) => {
        $(impl $crate::experiment::shard::codec::Coded for $name {
            fn put(&self, out: &mut Vec<u8>) {
                let Self { $($field),* } = self;
                $($field.put(out);)*
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                $(let $field = $crate::experiment::shard::codec::Coded::take(from)?;)*
                Some(Self { $($field),* })
            }
        })*
    };
}

pub(super) use coded;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_to_the_bit_and_damaged_bytes_are_none() {
        let value: Vec<(String, Option<f64>)> = vec![
            ("a".to_owned(), Some(-0.0)),
            ("é".to_owned(), None),
            (String::new(), Some(f64::MIN_POSITIVE / 3.0)),
        ];
        let bytes = encoded(&value);
        let back: Vec<(String, Option<f64>)> = decoded(&bytes).expect("its own bytes");
        assert_eq!(encoded(&back), bytes);
        for cut in 0..bytes.len() {
            assert!(decoded::<Vec<(String, Option<f64>)>>(&bytes[..cut]).is_none());
        }
        let huge = u64::MAX.to_le_bytes();
        assert!(decoded::<Vec<f64>>(&huge).is_none());
        assert!(decoded::<bool>(&[2]).is_none());
    }
}
