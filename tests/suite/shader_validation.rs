//! Validates every WGSL text of the library with naga, and tests the table that states what each
//! requires.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use wgpu_shadows::shader::{self, MODULES, ShaderModule};

use crate::fixtures::wgsl;

/// Fails with all failures, not only with the first.
fn report(failures: &[String]) {
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn find(name: &str) -> &'static ShaderModule {
    MODULES
        .iter()
        .find(|module| module.name == name)
        .unwrap_or_else(|| panic!("no module {name}"))
}

/// Returns all modules that a module requires, directly or not, without itself.
fn all_required(module: &ShaderModule) -> BTreeSet<&'static str> {
    let mut found = BTreeSet::new();
    let mut open = module.requires.to_vec();
    while let Some(name) = open.pop() {
        if found.insert(name) {
            open.extend_from_slice(find(name).requires);
        }
    }
    found
}

#[test]
fn every_module_validates_with_what_it_requires() {
    let mut failures = Vec::new();
    for module in MODULES {
        let source = shader::compose(&[module.name]).expect("a module of the table");
        if let Err(error) = wgsl::validate(&source) {
            failures.push(format!("{}: {error}", module.name));
        }
        // The union must be the module and what it requires, each once.
        let mut names = all_required(module);
        names.insert(module.name);
        let length: usize = names.iter().map(|name| find(name).source.len()).sum();
        if source.len() != length {
            failures.push(format!(
                "{}: composed {} bytes of {length}",
                module.name,
                source.len()
            ));
        }
    }
    report(&failures);
}

/// Without any one of the modules that it requires, directly or not, a module does not compile; and
/// the modules whose names it uses are required directly. So the table contains nothing too much
/// and nothing too little.
#[test]
fn every_requirement_is_needed_and_direct() {
    let mut failures = Vec::new();
    for module in MODULES {
        let required = all_required(module);
        for dropped in &required {
            let kept = required.iter().filter(|name| *name != dropped);
            let source: String = kept
                .map(|name| find(name).source)
                .chain([module.source])
                .collect();
            if wgsl::validate(&source).is_ok() {
                failures.push(format!("{} compiles without {dropped}", module.name));
            }
        }
        // The pass modules that replace each other give their entry points the same names.
        let own = wgsl::top_level_names(module.source);
        let mentioned: BTreeSet<_> = wgsl::identifiers(module.source)
            .into_iter()
            .filter(|name| !own.contains(name))
            .collect();
        // What a module uses of one that can be replaced, it also uses of the replacement, and it
        // requires only the former.
        let used: BTreeSet<&str> = MODULES
            .iter()
            .filter(|other| other.name != module.name && other.replaces.is_none())
            .filter(|other| {
                wgsl::top_level_names(other.source)
                    .iter()
                    .any(|name| mentioned.contains(name))
            })
            .map(|other| other.name)
            .collect();
        let declared: BTreeSet<&str> = module.requires.iter().copied().collect();
        if used != declared || declared.len() != module.requires.len() {
            failures.push(format!(
                "{} uses {used:?} and requires {declared:?}",
                module.name
            ));
        }
    }
    report(&failures);
}

/// The table and the directory contain the same texts under the same names.
#[test]
fn the_table_is_the_directory() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("wgsl");
    let mut on_disk = BTreeSet::new();
    for directory in [root.clone(), root.join("pass")] {
        for entry in fs::read_dir(&directory).expect("the wgsl directory") {
            let path = entry.expect("a directory entry").path();
            if path.is_dir() {
                let known = ["pass", "template"].map(|name| root.join(name));
                assert!(known.contains(&path), "an unknown directory of shaders");
                continue;
            }
            let name = path.file_stem().and_then(|stem| stem.to_str());
            let name = name.expect("a UTF-8 file name").to_owned();
            assert_eq!(path.extension().and_then(|e| e.to_str()), Some("wgsl"));
            let text = fs::read_to_string(&path).expect("a readable file");
            assert!(find(&name).source == text, "{name} is not the file's text");
            assert!(on_disk.insert(name), "two files of one name: {path:?}");
        }
    }
    let in_table: BTreeSet<String> = MODULES.iter().map(|m| m.name.to_owned()).collect();
    assert_eq!(in_table.len(), MODULES.len(), "a name appears twice");
    assert_eq!(in_table, on_disk);
}

/// With the declarations of their holes, the templates of a light's functions are valid WGSL as
/// they stand: each that finds a place with each that looks the visibility up. All names that they
/// declare begin with the library's prefix, so that no light declares a name of an engine's.
#[test]
fn templates_validate_as_they_stand() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("wgsl/template");
    let (mut shared, mut selections, mut lookups) = (Vec::new(), Vec::new(), Vec::new());
    let mut failures = Vec::new();
    for entry in fs::read_dir(&folder).expect("the folder of templates") {
        let path = entry.expect("a directory entry").path();
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.expect("a UTF-8 file name").to_owned();
        let text = fs::read_to_string(&path).expect("a readable file");
        let declared = wgsl::top_level_names(&text);
        let foreign = |declared: &&String| !declared.to_lowercase().starts_with("shadow_");
        // The whole name of a sampler is a hole, so it has no prefix in the template.
        if let Some(foreign) = declared.iter().find(foreign)
            && !["holes.wgsl", "sampler.wgsl"].contains(&&*name)
        {
            failures.push(format!("{name}: {foreign} is not the library's"));
        }
        let kind = if declared.contains("shadow_place_of_NAME") {
            &mut selections
        } else if declared.contains("shadow_NAME") {
            &mut lookups
        } else {
            &mut shared
        };
        kind.push((name, text));
    }
    assert!(!selections.is_empty() && !lookups.is_empty() && !shared.is_empty());
    let modules = [
        "view",
        "place",
        "cube_face",
        "filter_direction",
        "error_meter",
    ];
    let modules = shader::compose(&modules).expect("modules of the table");
    for (selection, selecting) in &selections {
        for (lookup, looking_up) in &lookups {
            let mut source = modules.clone();
            source.extend(shared.iter().map(|(_, text)| text.as_str()));
            source.extend([selecting.as_str(), looking_up]);
            if let Err(error) = wgsl::validate(&source) {
                failures.push(format!("{selection} with {lookup}: {error}"));
            }
        }
    }
    report(&failures);
}

/// These properties allow the texts to be concatenated with an engine's, and to be loaded unchanged
/// as WESL or naga_oil modules.
#[test]
fn texts_are_plain_and_names_are_the_librarys_own() {
    let mut failures = Vec::new();
    for module in MODULES {
        let text = wgsl::without_comments(module.source);
        for line in text.lines() {
            let line = line.trim_start();
            let directive = [
                "enable ",
                "requires ",
                "diagnostic(",
                "diagnostic ",
                "#",
                "import ",
            ];
            if directive.iter().any(|word| line.starts_with(word)) {
                failures.push(format!("{}: directive {line:?}", module.name));
            }
        }
        for name in wgsl::identifiers(module.source) {
            if name.ends_with('_') && name != "_" {
                failures.push(format!("{}: {name} ends in _", module.name));
            }
        }
        let names = wgsl::top_level_names(module.source);
        if names.is_empty() {
            failures.push(format!("{}: declares nothing", module.name));
        }
        for name in names {
            let prefixes = ["shadow_", "Shadow", "SHADOW_"];
            if !prefixes.iter().any(|prefix| name.starts_with(prefix)) {
                failures.push(format!("{}: {name} is not the library's", module.name));
            }
        }
        let composed = shader::compose(&[module.name]).expect("a module of the table");
        let parsed = naga::front::wgsl::parse_str(&composed).expect("valid WGSL");
        for (_, ty) in parsed.types.iter() {
            let naga::TypeInner::Struct { members, .. } = &ty.inner else {
                continue;
            };
            for member in members {
                let name = member.name.as_deref().unwrap_or_default();
                if name.ends_with(|c: char| c.is_ascii_digit()) {
                    failures.push(format!("{}: member {name} ends in a digit", module.name));
                }
            }
        }
    }
    report(&failures);
}

/// All modules can be put together in one text, except those that replace another and passes that
/// are drawn instead of each other: no two modules declare the same name, unless it is that of an
/// entry point in both.
#[test]
fn names_do_not_collide() {
    let entry_points = |module: &ShaderModule| -> BTreeSet<String> {
        let composed = shader::compose(&[module.name]).expect("a module of the table");
        let parsed = wgsl::validate(&composed).unwrap_or_else(|error| panic!("{error}"));
        parsed
            .entry_points
            .iter()
            .map(|entry| entry.name.clone())
            .collect()
    };
    let mut failures = Vec::new();
    for (index, module) in MODULES.iter().enumerate() {
        let names = wgsl::top_level_names(module.source);
        for other in &MODULES[index + 1..] {
            let replaces =
                |one: &ShaderModule, another: &ShaderModule| one.replaces == Some(another.name);
            if replaces(module, other) || replaces(other, module) {
                continue;
            }
            for name in names.intersection(&wgsl::top_level_names(other.source)) {
                let both = [module, other].map(|module| entry_points(module).contains(name));
                if both != [true, true] {
                    failures.push(format!("{name} is in {} and {}", module.name, other.name));
                }
            }
        }
    }
    report(&failures);
}
