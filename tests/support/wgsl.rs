//! Parses WGSL as text and by naga.

use std::collections::BTreeSet;

use crate::support::wgsl_operators::mixed_operators;

/// Parses and validates; the error is naga's own, with the position in the source. In addition to naga's checks,
/// operators must be separated by parentheses where WGSL's grammar requires them, as browsers do.
pub fn validate(source: &str) -> Result<naga::Module, String> {
    let faults = mixed_operators(source);
    if !faults.is_empty() {
        return Err(faults.join("\n"));
    }
    let module =
        naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::all(),
    )
    .validate(&module)
    .map_err(|error| error.emit_to_string(source))?;
    Ok(module)
}

/// Returns the text without line comments; the library's WGSL has no others.
pub fn without_comments(source: &str) -> String {
    assert!(!source.contains("/*"), "block comments are not understood");
    source
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .fold(String::new(), |text, line| text + line + "\n")
}

/// Returns every word outside comments.
pub fn identifiers(source: &str) -> BTreeSet<String> {
    without_comments(source)
        .split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with(|c: char| c.is_alphabetic() || c == '_'))
        .map(str::to_owned)
        .collect()
}

/// Returns the names declared at module scope: the word after `fn`, `struct`, `const`, `alias`, `override` or `var`
/// outside all braces.
pub fn top_level_names(source: &str) -> BTreeSet<String> {
    let text = without_comments(source);
    let mut names = BTreeSet::new();
    let mut depth = 0;
    let mut word = String::new();
    let mut declares = false;
    // In `var<uniform> name`, the word between the angle brackets is not a name.
    let mut in_template = false;
    for c in text.chars() {
        if c.is_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        if !word.is_empty() && depth == 0 && !in_template {
            if declares {
                names.insert(word.clone());
                declares = false;
            } else {
                let keywords = ["fn", "struct", "const", "alias", "override", "var"];
                declares = keywords.contains(&word.as_str());
            }
        }
        word.clear();
        match c {
            '{' | '(' => depth += 1,
            '}' | ')' => depth -= 1,
            '<' if declares => in_template = true,
            '>' => in_template = false,
            _ => {}
        }
    }
    names
}

#[test]
fn top_level_names_are_found() {
    let source = "const A: u32 = 1; // fn b() {}\n@group(0) @binding(0) var<uniform> c: array<D, 2>;\n\
                  struct D { e: f32 }\nfn f(g: f32) -> f32 { let h = g; return h; }";
    let names = ["A", "D", "c", "f"].map(str::to_owned);
    assert_eq!(top_level_names(source), BTreeSet::from(names));
}
