//! Tests the layers of the source: modules use only those below them, and no two files need each
//! other.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Lists the folders of `src` from the ground up. A folder may use itself and those before it. The
/// files directly in `src` and those of `src/error` may be used by all, and use what they need.
const FLOORS: [&str; 7] = ["gpu", "fit", "cast", "receive", "debug", "light", "meter"];

/// Holds what the files under `src` use of each other: for each file, the files from which it
/// imports a name.
struct House {
    uses: BTreeMap<PathBuf, BTreeSet<PathBuf>>,
}

/// Returns the paths of a `use` declaration, with its braces expanded.
fn paths(declaration: &str) -> Vec<Vec<String>> {
    let declaration = declaration.trim();
    let Some(open) = declaration.find('{') else {
        let name = declaration.split(" as ").next().unwrap_or_default();
        return vec![
            name.split("::")
                .map(|part| part.trim().to_owned())
                .collect(),
        ];
    };
    let head: Vec<_> = declaration[..open]
        .split("::")
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .map(str::to_owned)
        .collect();
    let inside = &declaration[open + 1..declaration.rfind('}').expect("a closing brace")];
    let mut depth = 0;
    let items = inside.split(|letter| {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        letter == ',' && depth == 0
    });
    let items = items.filter(|item| !item.trim().is_empty());
    items
        .flat_map(paths)
        .map(|tail| head.iter().cloned().chain(tail).collect())
        .collect()
}

/// Returns the `use` declarations of a source file before its tests, without comments.
fn declarations(source: &str) -> Vec<String> {
    let code: String = source
        .split("#[cfg(test)]")
        .next()
        .unwrap_or_default()
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| [line, "\n"])
        .collect();
    let starts = code.split("\nuse ").skip(1).map(|rest| (false, rest));
    let exports = ["\npub use ", "\npub(crate) use "];
    let exports = exports
        .iter()
        .flat_map(|word| code.split(*word).skip(1).map(|rest| (true, rest)));
    starts
        .chain(exports)
        .map(|(_, rest)| rest.split(';').next().unwrap_or_default().to_owned())
        .collect()
}

/// Returns the file of a module path such as `["fit", "view"]`, if there is one.
fn module_file(source: &Path, module: &[String]) -> Option<PathBuf> {
    let folder: PathBuf = module.iter().collect();
    let candidates = [folder.with_extension("rs"), folder.join("mod.rs")];
    let candidates = candidates.into_iter().filter(|_| !module.is_empty());
    candidates
        .into_iter()
        .find(|file| source.join(file).is_file())
}

impl House {
    fn read(source: &Path) -> Self {
        let mut files = Vec::new();
        let mut folders = vec![source.to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).expect("a folder of sources") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|ending| ending == "rs") {
                    let file = path.strip_prefix(source).expect("a file under src");
                    files.push((
                        file.to_owned(),
                        std::fs::read_to_string(&path).expect("text"),
                    ));
                }
            }
        }
        // This maps each name that a `mod.rs` or `lib.rs` exports to the file that it comes from.
        let mut exports = BTreeMap::new();
        for (file, text) in &files {
            let is_index = file.ends_with("mod.rs") || file == Path::new("lib.rs");
            if !is_index {
                continue;
            }
            let here: Vec<String> = file
                .parent()
                .into_iter()
                .flat_map(Path::components)
                .map(|part| part.as_os_str().to_string_lossy().into_owned())
                .collect();
            for path in declarations(text).iter().flat_map(|text| paths(text)) {
                let Some((name, module)) = path.split_last() else {
                    continue;
                };
                let full: Vec<_> = here.iter().chain(module).cloned().collect();
                exports.insert((here.clone(), name.clone()), full);
            }
        }
        let resolve = |path: &[String]| {
            let (name, module) = path.split_last()?;
            let mut module = module.to_vec();
            // The loop follows one export after the other, down to the file that declares the name.
            while let Some(next) = exports.get(&(module.clone(), name.clone())) {
                module.clone_from(next);
            }
            module_file(source, path).or_else(|| module_file(source, &module))
        };
        let mut uses = BTreeMap::new();
        for (file, text) in &files {
            let paths = declarations(text).into_iter().flat_map(|text| paths(&text));
            let own = paths.filter(|path| path[0] == "crate");
            let found: BTreeSet<_> = own.filter_map(|path| resolve(&path[1..])).collect();
            uses.insert(
                file.clone(),
                found.into_iter().filter(|used| used != file).collect(),
            );
        }
        Self { uses }
    }

    /// Returns a path from a file back to itself, if there is one.
    fn circle(&self) -> Option<Vec<&Path>> {
        let mut done = BTreeSet::new();
        self.uses
            .keys()
            .find_map(|file| self.circle_from(file, &mut Vec::new(), &mut done))
    }

    fn circle_from<'a>(
        &'a self,
        file: &'a Path,
        way: &mut Vec<&'a Path>,
        done: &mut BTreeSet<&'a Path>,
    ) -> Option<Vec<&'a Path>> {
        if let Some(start) = way.iter().position(|passed| *passed == file) {
            return Some(way[start..].to_vec());
        }
        if !done.insert(file) {
            return None;
        }
        way.push(file);
        let mut next = self.uses.get(file).into_iter().flatten();
        let found = next.find_map(|used| self.circle_from(used, way, done));
        way.pop();
        found
    }

    /// Returns the uses of a folder above the file's own.
    fn upward(&self) -> Vec<(&Path, &Path)> {
        let floor = |file: &Path| {
            let folder = file
                .components()
                .next()?
                .as_os_str()
                .to_string_lossy()
                .into_owned();
            FLOORS.iter().position(|floor| *floor == folder)
        };
        let uses = self.uses.iter().flat_map(|(file, used)| {
            let file = file.as_path();
            used.iter().map(move |used| (file, used.as_path()))
        });
        uses.filter(|(file, used)| {
            floor(file).is_some_and(|own| floor(used).is_some_and(|used| used > own))
        })
        .collect()
    }
}

#[test]
fn floors_only_look_down() {
    let house = House::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let files = house.uses.len();
    let uses: usize = house.uses.values().map(BTreeSet::len).sum();
    assert!(
        files > 50 && uses > 2 * files,
        "{files} files with {uses} uses"
    );
    assert_eq!(house.upward(), [], "a floor that looks up");
    assert_eq!(house.circle(), None, "files that need each other");
}

#[test]
fn circles_and_upward_looks_are_found() {
    let house = |uses: &[(&str, &str)]| {
        let mut all: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
        for (file, used) in uses {
            all.entry(PathBuf::from(file))
                .or_default()
                .insert(PathBuf::from(used));
        }
        House { uses: all }
    };
    let straight = house(&[
        ("cast/a.rs", "fit/b.rs"),
        ("fit/b.rs", "error.rs"),
        ("cast/a.rs", "error.rs"),
    ]);
    assert!(straight.circle().is_none() && straight.upward().is_empty());
    let round = house(&[
        ("fit/a.rs", "fit/b.rs"),
        ("fit/b.rs", "fit/c.rs"),
        ("fit/c.rs", "fit/a.rs"),
    ]);
    assert_eq!(round.circle().map(|way| way.len()), Some(3));
    let up = house(&[("fit/a.rs", "light/b.rs")]);
    assert_eq!(up.upward().len(), 1);
    assert_eq!(
        paths("crate::{a::{B, c::D}, E as F}")
            .iter()
            .map(|path| path.join("::"))
            .collect::<Vec<_>>(),
        ["crate::a::B", "crate::a::c::D", "crate::E"]
    );
}
