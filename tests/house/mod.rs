//! Rules of the repository: imports, generated files, documents, packages, the library as others see it.

mod architecture;
mod circles;
mod documents;
mod generated;
mod library;
mod packages;
mod registry;
