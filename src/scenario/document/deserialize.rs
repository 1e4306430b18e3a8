//! Checked values as what serde reads a configuration from, without a copy of the tree.

use serde::de::value::{Error, MapAccessDeserializer, MapDeserializer, SeqDeserializer};
use serde::de::{Deserialize, Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;

use crate::scenario::document::tree::{Node, Table, Value};

/// Reads a configuration from a checked table.
///
/// # Errors
/// The first value that does not fit.
pub(crate) fn from_table<'de, T: Deserialize<'de>>(table: &'de Table) -> Result<T, Error> {
    T::deserialize(map(table))
}

/// The entries of a table.
fn map(table: &Table) -> MapDeserializer<'_, impl Iterator<Item = (&str, Checked<'_>)>, Error> {
    MapDeserializer::new(table.iter().map(entry))
}

fn entry<'a>((key, node): (&'a String, &'a Node)) -> (&'a str, Checked<'a>) {
    (key, Checked(&node.value))
}

/// A checked value.
#[derive(Clone, Copy)]
struct Checked<'de>(&'de Value);

impl<'de> IntoDeserializer<'de, Error> for Checked<'de> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Checked<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Text(text) | Value::Beyond(text, _) | Value::Date(text) => {
                visitor.visit_borrowed_str(text)
            }
            Value::Integer(number) => visitor.visit_i64(*number),
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(is_set) => visitor.visit_bool(*is_set),
            Value::Array(nodes) => {
                let values = nodes.iter().map(|node| Checked(&node.value));
                SeqDeserializer::new(values).deserialize_any(visitor)
            }
            Value::Table(table) => map(table).deserialize_any(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            // An alternative with nothing to set.
            Value::Table(table) if table.is_empty() => visitor.visit_unit(),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self.0 {
            Value::Table(table) => visitor.visit_enum(MapAccessDeserializer::new(map(table))),
            Value::Text(word) => visitor.visit_enum(word.as_str().into_deserializer()),
            _ => self.deserialize_any(visitor),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf
        unit_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}
