//! Which module imports which, from the source text of a package.
//!
//! In:  modules with their texts.
//! Out: the imports of each, and circles of modules that import one another.
//!
//! A module imports what its `use` items and its paths name. Whoever names what a module
//! hands on (`pub use`) imports the module that defines it. That a module declares another
//! (`mod`) or hands on what is in it makes it no importer, unless it uses the name itself.
//! Tests inside modules don't count.

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};
use syn::{Item, UseTree, Visibility};

/// A path of names: of a module below its package's root, or of what is in one.
type Path = Vec<String>;

/// The path of a module, from the path of its file below the sources.
pub fn module_of(file: &str) -> Path {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let mut path: Path = stem.split('/').map(str::to_string).collect();
    if matches!(
        path.last().map(String::as_str),
        Some("mod" | "lib" | "main")
    ) {
        path.pop();
    }
    path
}

/// What each module imports from its own package.
pub type Imports = BTreeMap<Path, BTreeSet<Path>>;

/// The imports of modules, from their texts.
pub fn imports(modules: impl IntoIterator<Item = (Path, String)>) -> Imports {
    let modules = modules.into_iter();
    let read: BTreeMap<Path, Names> = modules
        .map(|(path, text)| (path, Names::of(&text)))
        .collect();
    let modules = read.iter();
    modules
        .map(|(module, names)| (module.clone(), imported(module, names, &read)))
        .collect()
}

/// The circles among modules, each with the imports that make it up.
pub fn circles(imports: &Imports) -> Vec<Vec<String>> {
    let reach: BTreeMap<&Path, BTreeSet<&Path>> = imports
        .keys()
        .map(|module| (module, reachable(module, imports)))
        .collect();
    let mut circles: BTreeMap<BTreeSet<&Path>, Vec<String>> = BTreeMap::new();
    for (module, targets) in imports {
        let back = |other: &&&Path| reach[**other].contains(module);
        let circle: BTreeSet<&Path> = reach[module].iter().filter(back).copied().collect();
        let inside = targets.iter().filter(|target| circle.contains(target));
        let said = inside.map(|target| format!("{} imports {}", shown(module), shown(target)));
        circles.entry(circle.clone()).or_default().extend(said);
    }
    let circles = circles.into_values();
    circles.filter(|said| !said.is_empty()).collect()
}

fn shown(module: &Path) -> String {
    match module.is_empty() {
        true => "the root".to_string(),
        false => module.join("::"),
    }
}

fn reachable<'a>(from: &Path, imports: &'a Imports) -> BTreeSet<&'a Path> {
    let mut found = BTreeSet::new();
    let mut pending: Vec<&Path> = imports[from].iter().collect();
    while let Some(module) = pending.pop() {
        if found.insert(module) {
            pending.extend(&imports[module]);
        }
    }
    found
}

/// The names in a module's text.
#[derive(Default)]
struct Names {
    /// What it imports or names, as it is written.
    paths: BTreeSet<Path>,
    /// What it hands on, by the name under which it does.
    handed_on: BTreeMap<String, Path>,
}

impl Names {
    fn of(text: &str) -> Self {
        let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{error} in {text}"));
        let mut names = Names::default();
        let mut words = BTreeSet::new();
        let mut handed_on = Vec::new();
        for item in file.items {
            match item {
                Item::Use(item) => match item.vis {
                    Visibility::Inherited => leaves(&item.tree, &Path::new(), &mut |_, path| {
                        names.paths.insert(path);
                    }),
                    _ => leaves(&item.tree, &Path::new(), &mut |name, path| {
                        handed_on.push((name, path));
                    }),
                },
                Item::Mod(module) if module.attrs.iter().any(|a| a.path().is_ident("cfg")) => {}
                Item::Mod(module) if module.content.is_none() => {}
                other => read(other.to_token_stream(), &mut names.paths, &mut words),
            }
        }
        for (name, path) in handed_on {
            if words.contains(&name) {
                names.paths.insert(path.clone());
            }
            names.handed_on.insert(name, path);
        }
        names
    }
}

/// The paths of a tree of imports, each with the name that it is given.
fn leaves(tree: &UseTree, before: &Path, show: &mut dyn FnMut(String, Path)) {
    let with = |name: &dyn ToString| [before.as_slice(), &[name.to_string()]].concat();
    match tree {
        UseTree::Path(path) => leaves(&path.tree, &with(&path.ident), show),
        UseTree::Name(name) if name.ident == "self" => {
            show(before.last().cloned().unwrap_or_default(), before.clone());
        }
        UseTree::Name(name) => show(name.ident.to_string(), with(&name.ident)),
        UseTree::Rename(rename) => show(rename.rename.to_string(), with(&rename.ident)),
        UseTree::Glob(_) => show("*".to_string(), before.clone()),
        UseTree::Group(group) => group
            .items
            .iter()
            .for_each(|tree| leaves(tree, before, show)),
    }
}

/// The paths and the single words in tokens, at any depth.
fn read(tokens: TokenStream, paths: &mut BTreeSet<Path>, words: &mut BTreeSet<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let is_colon =
        |at: usize| matches!(tokens.get(at), Some(TokenTree::Punct(p)) if p.as_char() == ':');
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        at += 1;
        match token {
            TokenTree::Group(group) => read(group.stream(), paths, words),
            // `pub(super)` imports nothing.
            TokenTree::Ident(word) if word == "pub" => {
                at += usize::from(matches!(tokens.get(at), Some(TokenTree::Group(_))));
            }
            TokenTree::Ident(first) => {
                let mut path = vec![first.to_string()];
                while is_colon(at) && is_colon(at + 1) {
                    let Some(TokenTree::Ident(next)) = tokens.get(at + 2) else {
                        break;
                    };
                    path.push(next.to_string());
                    at += 3;
                }
                words.extend(path.first().cloned());
                paths.insert(path);
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

/// The modules that a module imports.
fn imported(module: &Path, names: &Names, modules: &BTreeMap<Path, Names>) -> BTreeSet<Path> {
    let target = |path: &Path| defined_in(&absolute(module, path, modules)?, modules);
    let mut found: BTreeSet<Path> = names.paths.iter().filter_map(target).collect();
    found.remove(module);
    found
}

/// A path from the root of the package; none if it leads to another one.
fn absolute(module: &Path, path: &Path, modules: &BTreeMap<Path, Names>) -> Option<Path> {
    let mut base = module.clone();
    let mut rest = path.iter().peekable();
    match rest.peek().map(|first| first.as_str()) {
        Some("crate") => base.clear(),
        Some("self" | "super") => {}
        Some(first) => {
            let child = [module.as_slice(), &[first.to_string()]].concat();
            return modules.contains_key(&child).then(|| {
                let whole = module.iter().chain(path);
                whole.cloned().collect()
            });
        }
        None => return None,
    }
    for name in rest {
        match name.as_str() {
            "crate" | "self" => {}
            "super" => {
                base.pop();
            }
            _ => base.push(name.clone()),
        }
    }
    Some(base)
}

/// The module that defines what an absolute path names, wherever it is handed on.
fn defined_in(path: &Path, modules: &BTreeMap<Path, Names>) -> Option<Path> {
    let length = (0..=path.len()).rev();
    let length = length
        .into_iter()
        .find(|l| modules.contains_key(&path[..*l]))?;
    let (module, rest) = (path[..length].to_vec(), &path[length..]);
    let further = rest.first().and_then(|name| {
        let onward = absolute(&module, modules[&module].handed_on.get(name)?, modules)?;
        (onward != *path).then_some(onward)
    });
    match further {
        Some(onward) => defined_in(&onward, modules),
        None => Some(module),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(modules: &[(&str, &str)]) -> Vec<Vec<String>> {
        let modules = modules.iter();
        let modules = modules.map(|(file, text)| (module_of(file), text.to_string()));
        circles(&imports(modules))
    }

    #[test]
    fn two_modules_that_import_one_another_are_a_circle() {
        let modules = [
            ("a.rs", "use crate::b::B; pub struct A;"),
            ("b.rs", "pub struct B; fn f() { super::a::A; }"),
            ("c.rs", "use crate::{a::A, b};"),
        ];
        let said = ["a imports b", "b imports a"].map(str::to_string).to_vec();
        assert_eq!(found(&modules), [said]);
    }

    #[test]
    fn a_module_that_hands_on_what_is_in_it_is_no_importer() {
        let page = "mod part; mod other; pub use part::Part;";
        let modules = [
            ("stage/mod.rs", page),
            ("stage/part.rs", "pub struct Part;"),
            ("stage/other.rs", "use super::Part;"),
        ];
        assert!(found(&modules).is_empty());
    }

    #[test]
    fn what_is_handed_on_is_imported_from_where_it_is_defined() {
        let modules = [
            ("stage/mod.rs", "mod part; mod other; pub use part::Part;"),
            ("stage/part.rs", "use super::other::Other; pub struct Part;"),
            (
                "stage/other.rs",
                "use crate::stage::Part; pub struct Other;",
            ),
        ];
        let circle = [
            "stage::other imports stage::part",
            "stage::part imports stage::other",
        ];
        assert_eq!(found(&modules), [circle.map(str::to_string).to_vec()]);
    }

    #[test]
    fn a_front_page_and_a_part_that_use_one_another_are_a_circle() {
        let modules = [
            (
                "stage/mod.rs",
                "mod part; pub struct Whole; fn f() { part::g(); }",
            ),
            ("stage/part.rs", "use super::Whole; pub fn g() {}"),
        ];
        assert_eq!(found(&modules).len(), 1);
        let handed_on = "mod part; pub use part::g; pub struct Whole; fn f() { g(); }";
        assert_eq!(found(&[("stage/mod.rs", handed_on), modules[1]]).len(), 1);
    }

    #[test]
    fn tests_and_other_packages_make_no_circle() {
        let modules = [
            ("lib.rs", "mod a; pub use a::A;"),
            (
                "a.rs",
                "use std::b::C; pub struct A; #[cfg(test)] mod tests { use crate::b::B; }",
            ),
            ("b.rs", "use crate::A; pub struct B { pub(crate) a: A }"),
        ];
        assert!(found(&modules).is_empty());
    }
}
