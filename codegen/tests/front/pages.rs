//! What the pages of the documentation show is right: descriptions with the messages
//! beside them, the program of the tutorial, links from page to page.

use bricard_codegen::CompileSettings;
use bricard_codegen::internals::examine;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Descriptions that the cookbook has at least.
const RECIPES: usize = 25;

/// Folders whose pages are read.
const FOLDERS: [&str; 7] = [
    ".",
    "docs",
    "docs/gallery",
    "tests",
    "editors",
    "benches",
    "examples/host",
];

/// A page of the documentation.
struct Page {
    path: PathBuf,
    text: String,
}

/// A block of a page between two fences.
struct Block<'a> {
    language: &'a str,
    text: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn page(name: &str) -> Page {
    let path = root().join(name);
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    Page { path, text }
}

/// All pages, in order.
fn pages() -> Vec<Page> {
    let mut names = Vec::new();
    for folder in FOLDERS {
        let Ok(entries) = fs::read_dir(root().join(folder)) else {
            continue;
        };
        for entry in entries {
            let name = entry.expect("it can be read").file_name();
            let name = name.to_string_lossy().into_owned();
            if name.ends_with(".md") {
                names.push(format!("{folder}/{name}"));
            }
        }
    }
    names.sort();
    names.iter().map(|name| page(name)).collect()
}

impl Page {
    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn blocks(&self) -> Vec<Block<'_>> {
        let mut blocks: Vec<Block> = Vec::new();
        let mut open = false;
        for line in self.text.lines() {
            match (line.strip_prefix("```"), open) {
                (Some(language), false) => {
                    open = true;
                    blocks.push(Block {
                        language,
                        text: String::new(),
                    });
                }
                (Some(_), true) => open = false,
                (None, true) => {
                    let block = blocks.last_mut().expect("a block is open");
                    block.text += line;
                    block.text += "\n";
                }
                (None, false) => {}
            }
        }
        assert!(!open, "{}: a block without an end", self.name());
        blocks
    }

    /// The lines outside blocks.
    fn prose(&self) -> Vec<&str> {
        let mut open = false;
        let lines = self.text.lines().filter(|line| {
            let fence = line.starts_with("```");
            open ^= fence;
            !open && !fence
        });
        lines.collect()
    }

    /// What links to headings of this page end with.
    fn anchors(&self) -> BTreeSet<String> {
        let headings = self
            .prose()
            .into_iter()
            .filter(|line| line.starts_with('#'));
        headings
            .map(|line| anchor(line.trim_start_matches('#').trim()))
            .collect()
    }

    /// The targets of links.
    fn links(&self) -> Vec<String> {
        let prose = self.prose().join("\n");
        let rest = prose.split("](").skip(1);
        let targets = rest.filter_map(|rest| rest.split(')').next());
        targets.map(str::to_string).collect()
    }
}

/// How a heading is linked to: small letters, spaces as hyphens, no other signs.
fn anchor(heading: &str) -> String {
    let signs = heading.chars().filter_map(|sign| match sign {
        ' ' => Some('-'),
        '-' | '_' => Some(sign),
        sign if sign.is_alphanumeric() => Some(sign.to_ascii_lowercase()),
        _ => None,
    });
    signs.collect()
}

/// The file that a description belongs into: its name in snake case.
fn file(description: &str) -> String {
    let rest = description.split("mechanism ").nth(1).unwrap_or_default();
    let name = rest.split([' ', '{']).next().unwrap_or_default();
    let mut file = String::new();
    for (place, sign) in name.chars().enumerate() {
        if sign.is_uppercase() && place > 0 {
            file.push('_');
        }
        file.push(sign.to_ascii_lowercase());
    }
    file + ".mech"
}

/// What `bricard check` says of a description but that it is in order.
fn said(file: &str, description: &str) -> String {
    match examine(description, &CompileSettings::default()) {
        Ok((_, warnings)) => warnings.render(file, description),
        Err(errors) => panic!("{}", errors.render(file, description)),
    }
}

#[test]
fn every_description_on_a_page_draws_the_warnings_that_stand_below_it_and_no_others() {
    let mut seen = 0;
    for page in pages() {
        let blocks = page.blocks();
        for (place, block) in blocks.iter().enumerate() {
            if block.language != "mech" {
                continue;
            }
            let file = file(&block.text);
            let below = blocks.get(place + 1).map_or("", |next| &next.text);
            let shown = match below.starts_with(&format!("{file}:")) && below.contains("warning") {
                true => below,
                false => "",
            };
            let said = said(&file, &block.text);
            assert_eq!(said.trim_end(), shown.trim_end(), "{}", page.name());
            seen += 1;
        }
    }
    assert!(seen > RECIPES, "only {seen} descriptions");
}

#[test]
fn the_cookbook_has_enough_descriptions_of_different_names() {
    let cookbook = page("docs/cookbook.md");
    let blocks = cookbook.blocks();
    let recipes = blocks.iter().filter(|block| block.language == "mech");
    let names: Vec<String> = recipes.map(|block| file(&block.text)).collect();
    let different: BTreeSet<&String> = names.iter().collect();
    assert!(names.len() >= RECIPES, "{} descriptions", names.len());
    assert_eq!(names.len(), different.len(), "{names:?}");
}

#[test]
fn the_mistake_in_the_tutorial_is_answered_as_it_says() {
    let tutorial = page("docs/tutorial.md");
    let blocks = tutorial.blocks();
    let right = blocks.iter().find(|block| block.language == "mech");
    let right = &right.expect("the first description").text;
    let wrong = right.replace("1/24*m*L^2*der(phi)^2", "1/24*m*L*der(phi)^2");
    let errors = examine(&wrong, &CompileSettings::default()).expect_err("it is wrong");
    let shown = format!(
        "error: the description is wrong\n\n{}",
        errors.render("swing.mech", &wrong).trim_end()
    );
    let has = |block: &Block| block.text.trim_end() == shown;
    assert!(blocks.iter().any(has), "the tutorial lacks\n{shown}");
}

#[test]
fn the_program_of_the_tutorial_is_the_one_that_is_built() {
    let tutorial = page("docs/tutorial.md");
    let files = [
        ("mech", "examples/swing/mechanisms/swing.mech"),
        ("rust", "examples/swing/src/main.rs"),
    ];
    for (language, name) in files {
        let text = page(name).text;
        // Files of Rust begin by saying what they are.
        let shown = match text.split_once("\n\n") {
            Some((head, rest)) if head.starts_with("//! ") => rest,
            _ => &text,
        };
        let block = format!("```{language}\n{shown}```\n");
        assert!(
            tutorial.text.contains(&block),
            "the tutorial lacks\n{block}"
        );
    }
}

/// Whether the lines of a block follow each other in a file, indented as a whole or not.
/// Lines between some of them may be left out, each time with `…` in their place.
fn is_excerpt(block: &str, file: &str) -> bool {
    let lines: Vec<&str> = file.lines().map(str::trim).collect();
    block.split("…\n").all(|part| {
        let part: Vec<&str> = part.lines().map(str::trim).collect();
        lines.windows(part.len().max(1)).any(|lines| lines == part)
    })
}

#[test]
fn code_on_the_pages_about_other_machines_is_that_of_the_examples() {
    let pages: [(&str, &[&str]); 2] = [
        (
            "docs/bare_metal.md",
            &[
                "examples/bare_metal/Cargo.toml",
                "examples/bare_metal/src/lib.rs",
                "examples/bare_metal/firmware/src/bin/double.rs",
            ],
        ),
        (
            "docs/browser.md",
            &[
                "examples/web/Cargo.toml",
                "examples/web/src/lib.rs",
                "examples/web/package/package.json",
                "examples/web/package/README.md",
                "examples/web/page/index.html",
            ],
        ),
    ];
    for (name, files) in pages {
        let files = files.iter().map(|file| page(file).text);
        let files: Vec<String> = files.collect();
        let page = page(name);
        let blocks = page.blocks();
        let code = blocks.iter().filter(|block| block.language != "text");
        let mut seen = 0;
        for block in code {
            let found = files.iter().any(|file| is_excerpt(&block.text, file));
            assert!(found, "{name}: in no file of the example:\n{}", block.text);
            seen += 1;
        }
        assert!(seen > 2, "{name}: only {seen} blocks");
    }
}

#[test]
fn an_excerpt_has_the_lines_of_a_file_in_their_order() {
    let file = "a {\n    b;\n    c;\n    d;\n}\n";
    assert!(is_excerpt("b;\nc;\n", file));
    assert!(is_excerpt("a {\n…\nd;\n", file));
    assert!(!is_excerpt("b;\nd;\n", file));
    assert!(!is_excerpt("e;\n", file));
}

#[test]
fn links_between_pages_lead_somewhere() {
    let mut seen = 0;
    let mut broken = Vec::new();
    for page in pages() {
        for link in page.links() {
            if link.contains("://") {
                continue;
            }
            seen += 1;
            let (target, heading) = link.split_once('#').unwrap_or((&link, ""));
            let folder = page.path.parent().expect("a page has a folder");
            let path = match target {
                "" => page.path.clone(),
                target => folder.join(target),
            };
            let leads = path.exists()
                && (heading.is_empty()
                    || fs::read_to_string(&path).is_ok_and(|text| {
                        let path = path.clone();
                        Page { path, text }.anchors().contains(heading)
                    }));
            if !leads {
                broken.push(format!("{}: {link}", page.name()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(seen > 100, "only {seen} links");
}

#[test]
fn the_table_of_contents_lists_every_page() {
    let contents = page("docs/README.md").links();
    let names = pages().into_iter().filter_map(|page| {
        let folder = page.path.parent()?;
        let own = ["README.md", "SUMMARY.md"];
        let is_other = folder.ends_with("docs") && !own.iter().any(|own| page.path.ends_with(own));
        is_other.then(|| {
            page.path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned())
        })?
    });
    let missing: Vec<String> = names.filter(|name| !contents.contains(name)).collect();
    assert!(missing.is_empty(), "docs/README.md lacks {missing:?}");
}

/// The pages that the book has, as files of the repository.
fn chapters() -> Vec<PathBuf> {
    let summary = page("docs/SUMMARY.md");
    let folder = root().join("docs");
    let real = |link: String| folder.join(link).canonicalize().ok();
    summary.links().into_iter().filter_map(real).collect()
}

#[test]
fn the_book_has_every_page_of_the_documentation_once() {
    let chapters = chapters();
    let different: BTreeSet<&PathBuf> = chapters.iter().collect();
    assert_eq!(chapters.len(), different.len(), "a page is a chapter twice");
    let pages = pages()
        .into_iter()
        .filter(|page| !page.path.ends_with("SUMMARY.md"));
    let of_the_book = |path: &Path| path.components().any(|part| part.as_os_str() == "docs");
    let real: Vec<PathBuf> = pages
        .filter_map(|page| page.path.canonicalize().ok())
        .filter(|path| of_the_book(path) && !chapters.contains(path))
        .collect();
    assert!(real.is_empty(), "docs/SUMMARY.md lacks {real:?}");
}

/// In the book a link to a page that is no chapter leads nowhere.
#[test]
fn pages_of_the_book_link_to_chapters() {
    let chapters = chapters();
    let mut lost = Vec::new();
    for chapter in &chapters {
        let text = fs::read_to_string(chapter).expect("a chapter can be read");
        let folder = chapter.parent().expect("a page has a folder").to_path_buf();
        let path = chapter.clone();
        for link in (Page { path, text }).links() {
            let target = link.split('#').next().unwrap_or_default();
            let is_page = target.ends_with(".md") && !link.contains("://");
            let found = || folder.join(target).canonicalize().ok();
            if is_page && !found().is_some_and(|target| chapters.contains(&target)) {
                lost.push(format!("{}: {link}", chapter.display()));
            }
        }
    }
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}

#[test]
fn the_gallery_shows_every_mechanism_of_the_library() {
    let gallery = page("docs/gallery.md");
    let links = gallery.links();
    let entries = fs::read_dir(root().join("mechanisms")).expect("the library");
    let mut seen = 0;
    for entry in entries {
        let path = entry.expect("it can be read").path();
        if path.extension().is_none_or(|kind| kind != "mech") {
            continue;
        }
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let shown = [format!("gallery/{name}.svg"), format!("gallery/{name}.md")];
        assert!(shown.iter().all(|link| links.contains(link)), "no {name}");
        let svg = fs::read_to_string(root().join("docs").join(&shown[0]));
        assert!(
            svg.is_ok_and(|svg| svg.contains("<animate ")),
            "{name} stands still"
        );
        seen += 1;
    }
    assert!(seen > 30, "only {seen} mechanisms");
}
