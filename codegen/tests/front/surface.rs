//! What the compiler and the runtime offer to those who use them, as lists: whatever changes
//! in them is a decision.
//!
//! `BRICARD_BLESS=1` rewrites the lists.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use syn::{Attribute, Fields, ImplItem, Item, TraitItem, UseTree, Visibility};

/// The packages that users' programs and build scripts name, from this one.
const PACKAGES: [&str; 2] = ["", "../runtime"];

/// The names at the root of a crate, without what is hidden.
fn names(root: &syn::File) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for item in &root.items {
        match item {
            Item::Use(item) if is_public(&item.vis) && !is_hidden(&item.attrs) => {
                leaves(&item.tree, &mut names);
            }
            Item::Mod(module) if is_public(&module.vis) => {
                let hidden = is_hidden(&module.attrs);
                assert!(hidden, "`{}` is neither private nor hidden", module.ident);
            }
            Item::Mod(_) | Item::Use(_) => {}
            _ => panic!("the front page defines something itself"),
        }
    }
    names
}

fn leaves(tree: &UseTree, names: &mut BTreeSet<String>) {
    match tree {
        UseTree::Path(path) => leaves(&path.tree, names),
        UseTree::Name(name) => {
            names.insert(name.ident.to_string());
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, names)),
        UseTree::Rename(_) | UseTree::Glob(_) => panic!("a name that is not written out"),
    }
}

/// Whether an item of a front page has no documentation but that it is hidden.
fn is_hidden(attributes: &[Attribute]) -> bool {
    let hides = |a: &Attribute| {
        let list = a.meta.require_list();
        a.path().is_ident("doc") && list.is_ok_and(|list| list.tokens.to_string() == "hidden")
    };
    attributes.iter().any(hides)
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

/// Every file of the sources.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("the sources");
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    let inside = |path: PathBuf| match path.is_dir() {
        true => files(&path),
        false => vec![path],
    };
    let paths = paths.into_iter().flat_map(inside);
    paths
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .collect()
}

/// What of an item can be seen from outside, without bodies and documentation.
fn seen(item: Item, names: &BTreeSet<String>) -> Option<(String, Item)> {
    let public = |ident: &syn::Ident, visibility: &Visibility| {
        (is_public(visibility) && names.contains(&ident.to_string())).then(|| ident.to_string())
    };
    match item {
        Item::Fn(mut function) => {
            let name = public(&function.sig.ident, &function.vis)?;
            function.attrs.clear();
            function.block.stmts.clear();
            Some((name, Item::Fn(function)))
        }
        Item::Struct(mut item) => {
            let name = public(&item.ident, &item.vis)?;
            item.attrs.retain(|a| !a.path().is_ident("doc"));
            hide(&mut item.fields);
            Some((name, Item::Struct(item)))
        }
        Item::Enum(mut item) => {
            let name = public(&item.ident, &item.vis)?;
            item.attrs.retain(|a| !a.path().is_ident("doc"));
            for variant in &mut item.variants {
                variant.attrs.clear();
                variant
                    .fields
                    .iter_mut()
                    .for_each(|field| field.attrs.clear());
            }
            Some((name, Item::Enum(item)))
        }
        Item::Trait(mut item) => {
            let name = public(&item.ident, &item.vis)?;
            item.attrs.clear();
            item.items.iter_mut().for_each(declared);
            Some((name, Item::Trait(item)))
        }
        Item::Impl(mut item) if item.trait_.is_none() => {
            let syn::Type::Path(of) = &*item.self_ty else {
                return None;
            };
            let name = of.path.segments.last()?.ident.to_string();
            item.attrs.clear();
            let methods = std::mem::take(&mut item.items).into_iter();
            item.items = methods.filter_map(signature).collect();
            let offered = names.contains(&name) && !item.items.is_empty();
            offered.then(|| (format!("{name} does"), Item::Impl(item)))
        }
        _ => None,
    }
}

/// Leaves out the fields that are private.
fn hide(fields: &mut Fields) {
    let (Fields::Named(syn::FieldsNamed { named: list, .. })
    | Fields::Unnamed(syn::FieldsUnnamed { unnamed: list, .. })) = fields
    else {
        return;
    };
    let all = std::mem::take(list).into_iter();
    *list = all.filter(|field| is_public(&field.vis)).collect();
    list.iter_mut().for_each(|field| field.attrs.clear());
}

/// Leaves out of an item of a trait its documentation, and the body that it may have.
fn declared(item: &mut TraitItem) {
    match item {
        TraitItem::Fn(method) => {
            method.attrs.clear();
            if let Some(body) = &mut method.default {
                body.stmts.clear();
            }
        }
        TraitItem::Const(constant) => constant.attrs.clear(),
        TraitItem::Type(kind) => kind.attrs.clear(),
        _ => {}
    }
}

/// A public method without body and documentation.
fn signature(item: ImplItem) -> Option<ImplItem> {
    match item {
        ImplItem::Fn(mut method) if is_public(&method.vis) => {
            method.attrs.clear();
            method.block.stmts.clear();
            Some(ImplItem::Fn(method))
        }
        _ => None,
    }
}

/// The list of a package: its names, and what of each can be seen.
fn listing(package: &Path) -> String {
    let parsed = |path: &Path| {
        let text = fs::read_to_string(path).expect("a source file");
        syn::parse_file(&text).expect("Rust")
    };
    let mut root = parsed(&package.join("src/lib.rs"));
    let names = names(&root);
    let all = files(&package.join("src"));
    let items = all.iter().flat_map(|path| parsed(path).items);
    let mut found: Vec<(String, Item)> = items.filter_map(|item| seen(item, &names)).collect();
    found.sort_by(|(a, _), (b, _)| a.cmp(b));
    root.attrs.clear();
    root.items = found.into_iter().map(|(_, item)| item).collect();
    // Some names are of other crates, or defined by macros.
    let names = Vec::from_iter(names).join("\n");
    format!("{names}\n\n{}", prettyplease::unparse(&root))
}

#[test]
fn what_users_see_changes_by_decision() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for package in PACKAGES.map(|package| here.join(package)) {
        let listing = listing(&package);
        let expected = package.join("tests/surface.txt");
        if std::env::var_os("BRICARD_BLESS").is_some() {
            fs::write(&expected, listing).expect("a list that can be written");
            continue;
        }
        let known = fs::read_to_string(&expected).unwrap_or_default();
        let place = expected.display();
        assert!(
            known == listing,
            "{listing}\nBRICARD_BLESS=1 rewrites {place}"
        );
    }
}
