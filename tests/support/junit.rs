//! What a JUnit report may hold, by the schema of Jenkins xUnit and the parser of GitLab.

use std::collections::BTreeSet;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

/// An element of the schema: its children, its attributes, those of them that it must have.
struct Element {
    name: &'static str,
    children: &'static [&'static str],
    attributes: &'static [&'static str],
    required: &'static [&'static str],
}

/// `junit-10.xsd` of the Jenkins plugin xUnit 3.1.6 without reruns, which the reports never hold.
const SCHEMA: &[Element] = &[
    Element {
        name: "testsuites",
        children: &["testsuite"],
        attributes: &["name", "time", "tests", "failures", "errors"],
        required: &[],
    },
    Element {
        name: "testsuite",
        children: &[
            "testsuite",
            "properties",
            "testcase",
            "system-out",
            "system-err",
        ],
        attributes: &[
            "name",
            "tests",
            "failures",
            "errors",
            "group",
            "time",
            "skipped",
            "timestamp",
            "hostname",
            "id",
            "package",
            "file",
            "log",
            "url",
            "version",
        ],
        required: &["name", "tests", "failures", "errors"],
    },
    Element {
        name: "properties",
        children: &["property"],
        attributes: &[],
        required: &[],
    },
    Element {
        name: "property",
        children: &[],
        attributes: &["name", "value"],
        required: &["name", "value"],
    },
    Element {
        name: "testcase",
        children: &["skipped", "error", "failure", "system-out", "system-err"],
        attributes: &["name", "time", "classname", "group"],
        required: &["name"],
    },
    Element {
        name: "failure",
        children: &[],
        attributes: &["type", "message"],
        required: &[],
    },
    Element {
        name: "error",
        children: &[],
        attributes: &["type", "message"],
        required: &[],
    },
    Element {
        name: "skipped",
        children: &[],
        attributes: &["type", "message"],
        required: &[],
    },
    Element {
        name: "system-out",
        children: &[],
        attributes: &[],
        required: &[],
    },
];

/// An element of a report with its attributes.
pub(crate) struct Found {
    pub(crate) name: String,
    pub(crate) attributes: Vec<(String, String)>,
}

impl Found {
    /// The value of an attribute, empty where it has none.
    pub(crate) fn get(&self, name: &str) -> &str {
        let found = self.attributes.iter().find(|(key, _)| key == name);
        found.map_or("", |(_, value)| value)
    }

    fn of(start: &BytesStart) -> Self {
        let attributes = start.attributes().map(|attribute| {
            let attribute = attribute.expect("an attribute is well formed");
            let value = attribute.normalized_value(XmlVersion::Explicit1_0);
            let value = value.expect("its value is escaped");
            let key = String::from_utf8_lossy(attribute.key.as_ref()).into_owned();
            (key, value.into_owned())
        });
        Self {
            name: String::from_utf8_lossy(start.name().as_ref()).into_owned(),
            attributes: attributes.collect(),
        }
    }
}

/// Every element of a report, each with the name of its parent, in order.
pub(crate) fn elements(xml: &str) -> Vec<(String, Found)> {
    let mut reader = Reader::from_str(xml);
    let (mut open, mut found) = (vec![String::new()], Vec::new());
    loop {
        let parent = open.last().expect("the root is never closed").clone();
        match reader.read_event().expect("the report is XML") {
            Event::Eof => return found,
            Event::Start(start) => {
                let element = Found::of(&start);
                open.push(element.name.clone());
                found.push((parent, element));
            }
            Event::Empty(start) => found.push((parent, Found::of(&start))),
            Event::End(_) => drop(open.pop()),
            Event::Text(text) => {
                let text = String::from_utf8_lossy(&text).into_owned();
                let may_hold_text = ["failure", "error", "skipped", "system-out"];
                let is_blank = text.trim().is_empty();
                assert!(
                    is_blank || may_hold_text.contains(&parent.as_str()),
                    "{text}"
                );
            }
            _ => {}
        }
    }
}

/// Asserts that both servers take a report.
#[track_caller]
pub(crate) fn assert_valid(xml: &str) {
    let mut cases = BTreeSet::new();
    for (parent, element) in elements(xml) {
        let rule = SCHEMA.iter().find(|rule| rule.name == element.name);
        let rule = rule.unwrap_or_else(|| panic!("<{}> is not in the schema", element.name));
        let of_parent = SCHEMA.iter().find(|rule| rule.name == parent);
        let is_child = of_parent.is_none_or(|rule| rule.children.contains(&rule_name(&element)));
        assert!(is_child, "<{}> in <{parent}>", element.name);
        assert!(!parent.is_empty() || element.name == "testsuites");
        for (key, value) in &element.attributes {
            assert!(
                rule.attributes.contains(&key.as_str()),
                "{key} of <{}>",
                element.name
            );
            let decimals = value.split_once('.').map_or("", |(_, decimals)| decimals);
            let is_time = value.parse::<f64>().is_ok_and(|time| time >= 0.0) && decimals.len() <= 3;
            assert!(key != "time" || is_time, "time=\"{value}\"");
        }
        for key in rule.required {
            assert!(
                !element.get(key).is_empty(),
                "<{}> without {key}",
                element.name
            );
        }
        if element.name == "testcase" {
            // GitLab tells cases apart by these, and shows the first alone of several.
            let id = (
                element.get("classname").to_owned(),
                element.get("name").to_owned(),
            );
            assert!(!id.0.is_empty(), "a case without a class");
            assert!(cases.insert(id.clone()), "{id:?} stands twice");
        }
    }
}

fn rule_name(element: &Found) -> &str {
    &element.name
}
