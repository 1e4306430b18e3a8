//! Page of the files that commands write: the rows of the table of artefacts.

use std::fmt::Write as _;

use fogbench::report::{Place, artefacts};

const HEAD: &str = "\
# Files

<!-- Generated from the table of files in src/report/artefacts.rs by the test `generated_page_of_the_files`. -->

What stands between `<` and `>` differs. Pictures of an assembly of three gyros stand behind the axis, as in
`x-rate.svg`. What the files hold is told in [results](output.md), columns of curves in [metrics](metrics.md).
The files of `export` are those of the [hardware](hardware.md).
";

/// Markdown page of the files.
pub(crate) fn page() -> String {
    let mut page = HEAD.to_owned();
    for place in Place::ALL {
        let (folder, commands) = (place.words(), place.commands().join("`, `"));
        write!(
            page,
            "\n## {folder}\n\nWritten by `{commands}`.\n\n| file | holds | written | by |\n|---|---|---|---|\n"
        )
        .expect("a string takes it");
        let rows = artefacts().into_iter();
        for row in rows.filter(|row| row.places.contains(&place)) {
            let (name, holds, when, by) = (row.name, row.holds, row.when, row.made_by());
            writeln!(page, "| `{name}` | {holds} | {when} | {by} |").expect("a string takes it");
        }
    }
    page
}
