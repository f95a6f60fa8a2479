//! Fills the WGSL templates under `wgsl/template/`. Each template is a struct here, with a field
//! for every hole.
//!
//! A hole is the part of an identifier that is in capitals, such as `NAME` in `shadow_views_NAME`.
//! The library's own constants, which begin with `SHADOW_`, have no holes, and comments have none
//! either. Together with the declarations in `wgsl/template/holes.wgsl` the templates are valid
//! WGSL as they stand. The tests below check that the fields of every struct are exactly the holes
//! of its file, so filling a template cannot fail.

use std::ops::Range;

macro_rules! templates {
    ($($(#[$doc:meta])* $template:ident($file:literal) { $($hole:ident),* })*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug)]
            pub(crate) struct $template<'a> {
                $(pub $hole: &'a str),*
            }

            impl $template<'_> {
                const SOURCE: &'static str = include_str!(concat!("../../wgsl/template/", $file));

                /// Returns the template's text with its holes filled.
                pub(crate) fn fill(&self) -> String {
                    fill(Self::SOURCE, &[$((stringify!($hole), self.$hole)),*])
                }
            }
        )*

        /// Lists the file, the text and the fields of every template.
        #[cfg(test)]
        const ALL: &[(&str, &str, &[&str])] = &[
            $(($file, <$template<'static>>::SOURCE, &[$(stringify!($hole)),*])),*
        ];
    };
}

templates! {
    /// Declares the number of the bind group.
    Group("group.wgsl") { group }
    /// Declares a sampler, which all lights share.
    Sampler("sampler.wgsl") { sampler_binding, sampler, sampler_type }
    /// Declares the uniforms and the map of a light.
    Bindings("bindings.wgsl") { views_binding, map_binding, name, array_length, map_type }
    /// Defines where a position falls in a cascade or the next ones.
    Cascade("cascade.wgsl") { name, cascade, next }
    /// Defines where a position falls in the last cascade.
    LastCascade("last_cascade.wgsl") { name, next }
    /// Defines where a position falls in the map of a directional light.
    Cascades("cascades.wgsl") { name, index, cascade }
    /// Defines where a position falls in the map of a spot light.
    OneView("one_view.wgsl") { name, index, first_view, any_view, view_count }
    /// Defines where a position falls in the map of a point light.
    CubeFace("cube_face.wgsl") { name, index, first_view, any_view, inner_view, view_count }
    /// Defines `shadow_view_NAME`.
    View("view.wgsl") { name, index, view_count }
    /// Defines `shadow_NAME` as one lookup in one view.
    SingleLookup("single_lookup.wgsl") {
        name, index, any_view, bias, filter, sampler, weight, faded, layer
    }
    /// Defines `shadow_NAME` as the weighted mean of a lookup in each of the cascades that blend at
    /// a position.
    BlendedLookup("blended_lookup.wgsl") {
        name, index, view_count, bias, filter, sampler, weight, faded, layer
    }
    /// Defines `shadow_NAME` as the mean of lookups in many directions from a point light.
    MeanLookup("mean_lookup.wgsl") {
        name, index, any_view, pattern, sample_count, sample_count_f32, surface, normal, bias, filter, sampler,
        weight, faded, layer
    }
    /// Defines the pass that asks a light's lookup at the places of an error meter.
    ErrorMeterPass("error_meter.wgsl") { name, index }
}

/// Returns `source` with each hole replaced by the value of its name. Where the value is empty, the
/// rest of the list item is removed as well, up to and including the comma.
fn fill(source: &str, values: &[(&str, &str)]) -> String {
    let mut text = String::with_capacity(source.len());
    for line in source.split_inclusive('\n') {
        let (mut code, comment) = line.split_at(line.find("//").unwrap_or(line.len()));
        while let Some(hole) = first_hole(code) {
            text += &code[..hole.start];
            let name = &code[hole.clone()];
            code = &code[hole.end..];
            let found = values
                .iter()
                .find(|(other, _)| other.eq_ignore_ascii_case(name));
            let value = found.map_or(name, |(_, value)| value);
            if let ("", Some((_, rest))) = (value, code.split_once(',')) {
                code = rest.trim_start();
            }
            text += value;
        }
        text += code;
        text += comment;
    }
    text
}

/// Returns the range of the first hole in `code`, which is WGSL without comments.
fn first_hole(code: &str) -> Option<Range<usize>> {
    let in_identifier = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut from = 0;
    loop {
        let start = from + code[from..].find(in_identifier)?;
        let length = code[start..].find(|c| !in_identifier(c));
        let end = length.map_or(code.len(), |length| start + length);
        if let Some(hole) = hole_of(&code[start..end]) {
            return Some(start + hole.start..start + hole.end);
        }
        from = end;
    }
}

/// Returns the range of the hole in an identifier, which consists of the words in capitals between
/// underscores.
fn hole_of(identifier: &str) -> Option<Range<usize>> {
    if identifier.starts_with("SHADOW_") {
        return None;
    }
    let start = identifier.find(|c: char| c.is_ascii_uppercase())?;
    let (before, rest) = identifier.split_at(start);
    let length = rest.find(|c: char| c.is_ascii_lowercase());
    let capitals = &rest[..length.unwrap_or(rest.len())];
    let begins = before.is_empty() || before.ends_with('_');
    let ends = length.is_none() || capitals.ends_with('_');
    let hole = capitals.trim_end_matches('_');
    (begins && ends).then_some(start..start + hole.len())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::{ALL, fill, first_hole};

    /// Returns the names of all holes of a text, in lower case.
    fn holes(source: &str) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for line in source.lines() {
            let mut code = line.split("//").next().unwrap_or_default();
            while let Some(hole) = first_hole(code) {
                found.insert(code[hole.clone()].to_ascii_lowercase());
                code = &code[hole.end..];
            }
        }
        found
    }

    #[test]
    fn fields_are_the_holes() {
        let mut failures = Vec::new();
        for (file, source, fields) in ALL {
            let fields: BTreeSet<_> = fields.iter().map(|field| (*field).to_owned()).collect();
            let holes = holes(source);
            if fields != holes {
                failures.push(format!(
                    "{file}: the fields {fields:?} fill the holes {holes:?}"
                ));
            }
        }
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    }

    /// Checks that every file of the folder is a template, except the one that declares their
    /// holes, and that this file declares exactly the holes of the templates.
    #[test]
    fn files_are_the_templates() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("wgsl/template");
        let mut files = BTreeSet::new();
        for entry in std::fs::read_dir(folder).expect("the folder of templates") {
            let name = entry.expect("a file").file_name();
            files.insert(name.into_string().expect("a UTF-8 name"));
        }
        assert!(files.remove("holes.wgsl"));
        let templates: BTreeSet<_> = ALL.iter().map(|(file, ..)| (*file).to_owned()).collect();
        assert_eq!(files, templates);

        let declared = holes(include_str!("../../wgsl/template/holes.wgsl"));
        let used: BTreeSet<_> = ALL
            .iter()
            .flat_map(|(_, source, _)| holes(source))
            .collect();
        let by_templates = ["name", "sampler"].map(str::to_owned);
        assert_eq!(declared, &used - &BTreeSet::from(by_templates));
    }

    #[test]
    fn holes_are_replaced_as_whole_words() {
        let values = [("name", "sun"), ("name_count", "2u"), ("index", "")];
        let filled = |source| fill(source, &values);
        assert_eq!(filled("shadow_NAME(NAME)"), "shadow_sun(sun)");
        assert_eq!(
            filled("NAME_COUNT NAME_radius my_NAME_b"),
            "2u sun_radius my_sun_b"
        );
        // Constants of the library, types, comments, and words that merely contain the letters are
        // not holes.
        let kept = "SHADOW_NAME ShadowNAME NAMEs aNAME // NAME\n";
        assert_eq!(filled(kept), kept);
        assert_eq!(filled("f(INDEX: u32, a: f32)"), "f(a: f32)");
        assert_eq!(filled("f(b, INDEX, NAME)"), "f(b, sun)");
        // A hole without a value remains, so that the text does not compile.
        assert_eq!(filled("OTHER NAME"), "OTHER sun");
    }
}
