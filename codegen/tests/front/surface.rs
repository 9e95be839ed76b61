//! What the crate offers to those who use it, as a list: whatever changes in it is a
//! decision.
//!
//! `BRICARD_BLESS=1` rewrites the list.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use syn::{Fields, ImplItem, Item, UseTree, Visibility};

/// The names at the root of the crate, without what is hidden.
fn names(root: &syn::File) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for item in &root.items {
        match item {
            Item::Use(item) if is_public(&item.vis) => leaves(&item.tree, &mut names),
            Item::Mod(module) if is_public(&module.vis) => {
                let hidden = module.attrs.iter().any(|a| a.path().is_ident("doc"));
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
            item.variants.iter_mut().for_each(|v| v.attrs.clear());
            Some((name, Item::Enum(item)))
        }
        Item::Impl(mut item) if item.trait_.is_none() => {
            let syn::Type::Path(of) = &*item.self_ty else {
                return None;
            };
            let name = of.path.get_ident()?.to_string();
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

#[test]
fn what_users_see_changes_by_decision() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
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
    for name in &names {
        assert!(found.iter().any(|(known, _)| known == name), "no `{name}`");
    }
    root.attrs.clear();
    root.items = found.into_iter().map(|(_, item)| item).collect();
    let listing = prettyplease::unparse(&root);
    let expected = package.join("tests/surface.txt");
    if std::env::var_os("BRICARD_BLESS").is_some() {
        fs::write(&expected, listing).expect("a list that can be written");
    } else {
        let known = fs::read_to_string(&expected).unwrap_or_default();
        assert!(
            known == listing,
            "{listing}\nBRICARD_BLESS=1 rewrites {}",
            expected.display()
        );
    }
}
