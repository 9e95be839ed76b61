//! A mechanism that is given by the path of its file: compiled once, kept, and moved as
//! one of the library is.
//!
//! All tests but those about the cache itself share one, in the target folder: what is
//! common to all programs is compiled once for each version of the sources.

use crate::command::{Ran, cache, command, end, folder, interrupt, read, start, wait_until, words};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::{Duration, SystemTime};

/// Bytes of rows after which a run has come to the end of a segment.
const SEGMENTS: u64 = 300_000;

/// A pendulum, of which each test has its own by a name and a number.
fn pendulum(name: &str, length: f64) -> String {
    format!(
        "mechanism {name} {{
    param L: m = {length};
    param m: kg = 1;
    const g: m/s^2 = 9.81;
    coord q: rad;
    kinetic 1/2*m*L^2*der(q)^2;
    potential -m*g*L*cos(q);
    start {{ q = 30*deg; }}
    event bottom: sin(q) crossing;
}}
"
    )
}

/// The command in a folder, with the shared cache.
fn bricard(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = command();
    command.current_dir(folder).args(arguments);
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Ran {
    let output = bricard(folder, arguments).output();
    read(output.expect("the command starts"))
}

/// Runs the command, which has to succeed.
fn done(folder: &Path, arguments: &[&str]) -> Ran {
    run(folder, arguments).done()
}

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).expect("the folder is ours");
}

/// The folders in the cache that begin with a name, of all versions.
fn programs(begin: &str) -> Vec<PathBuf> {
    let versions = fs::read_dir(cache().join("bricard"));
    let programs = versions
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|version| fs::read_dir(version.path().join("programs")).ok());
    let begins = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str());
        name.is_some_and(|name| name.starts_with(begin))
    };
    let paths = programs.flatten().flatten().map(|entry| entry.path());
    paths.filter(begins).collect()
}

fn compiles(ran: &Ran, file: &str) -> bool {
    ran.err.contains(&format!("compiling {file}"))
}

// The library has to be optimised as in this workspace's profiles: what the compiler makes
// of a formula without may round otherwise.
#[test]
fn a_file_moves_as_the_mechanism_of_the_library_does() {
    let folder = folder("same");
    let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms");
    let file = "slider_crank.mech";
    fs::copy(library.join(file), folder.join(file)).expect("it is in the library");
    let columns = ["--columns", "energy,constraint_error,rank,reactions"];
    for options in [
        &["--until", "3", "--every", "0.1"][..],
        &["--until", "2", "--step", "0.01", "--form", "full"],
        &words("--until 1 --method radau5 --set m1=2 --start q1=1.2"),
    ] {
        let arguments = |name| [&["simulate", name], options, &columns].concat();
        let (named, given) = (
            done(&folder, &arguments("slider_crank")),
            done(&folder, &arguments(file)),
        );
        assert!(named.out.lines().count() > 10, "{}", named.out);
        assert_eq!(named.out, given.out, "{options:?}");
        let summary = |ran: &Ran| {
            let lines = ran
                .err
                .lines()
                .filter(|line| !line.starts_with("wall time"));
            let lines = lines.skip_while(|line| !line.starts_with("steps"));
            lines.map(String::from).collect::<Vec<_>>()
        };
        assert_eq!(summary(&named), summary(&given));
    }
}

#[test]
fn only_an_edited_file_is_compiled_again() {
    let folder = folder("edited");
    write(&folder, "once.mech", &pendulum("Once", 0.5));
    let simulate = ["simulate", "once.mech", "--until", "1", "--every", "0.25"];
    let first = done(&folder, &simulate);
    let modified = |path: &PathBuf| -> SystemTime {
        let data = fs::metadata(path.join("mechanism")).or_else(|_| fs::metadata(path));
        data.and_then(|data| data.modified()).expect("it is there")
    };
    let before: Vec<_> = programs("once-").iter().map(modified).collect();
    for more in [&["--set", "L=0.7"][..], &["--start", "q=1"], &[]] {
        let ran = done(&folder, &[&simulate, more].concat());
        assert!(!compiles(&ran, "once.mech"), "{more:?}: {}", ran.err);
        assert_eq!(ran.out == first.out, more.is_empty(), "{more:?}");
    }
    // The same file elsewhere is the same mechanism.
    let inner = folder.join("inner");
    fs::create_dir_all(&inner).expect("the folder is ours");
    write(&inner, "once.mech", &pendulum("Once", 0.5));
    let ran = done(
        &folder,
        &words("simulate inner/once.mech --until 1 --every 0.25"),
    );
    assert!(!compiles(&ran, "inner/once.mech"), "{}", ran.err);
    let after: Vec<_> = programs("once-").iter().map(modified).collect();
    assert_eq!(before, after);

    let edited = format!("{}// {:?}\n", pendulum("Once", 0.7), SystemTime::now());
    write(&folder, "once.mech", &edited);
    let ran = done(&folder, &simulate);
    assert!(compiles(&ran, "once.mech"), "{}", ran.err);
    assert_ne!(ran.out, first.out);
    let set = words("simulate inner/once.mech --until 1 --every 0.25 --set L=0.7");
    assert_eq!(ran.out, done(&folder, &set).out);
}

#[test]
fn a_parameter_that_gets_another_number_in_the_file_needs_no_compiler() {
    let folder = folder("parameter");
    write(&folder, "told.mech", &pendulum("Parameter", 0.5));
    let simulate = ["simulate", "told.mech", "--until", "1", "--every", "0.25"];
    let set = done(&folder, &[&simulate[..], &["--set", "L=0.7"]].concat());
    write(&folder, "told.mech", &pendulum("Parameter", 0.7));
    let edited = done(&folder, &simulate);
    assert!(!compiles(&edited, "told.mech"), "{}", edited.err);
    assert_eq!(edited.out, set.out);
    // What is wrong with a value is said all the same.
    write(
        &folder,
        "told.mech",
        &pendulum("Parameter", -0.7).replace("kg = 1", "kg = -1"),
    );
    let wrong = run(&folder, &simulate);
    wrong.says(&["told.mech:"]);
}

#[test]
fn a_quiet_run_says_nothing_but_errors() {
    let folder = folder("quiet");
    let text = pendulum("Quiet", 0.5).replace("coord q", "param idle = 1;\n    coord q");
    // Earlier runs of this test have left programs of other descriptions.
    write(
        &folder,
        "quiet.mech",
        &format!("{text}// {:?}\n", SystemTime::now()),
    );
    let simulate = ["simulate", "quiet.mech", "--until", "0.1"];
    let quiet = [&simulate[..], &["--quiet"]].concat();
    assert_eq!(done(&folder, &quiet).err, "");
    let loud = done(&folder, &simulate);
    loud.says(&["`idle` is never used", "steps"]);
    let wrong = run(&folder, &[&quiet[..], &["--columns", "idle"]].concat());
    assert_eq!(wrong.status, Some(2));
    assert!(wrong.err.starts_with("error: "), "{}", wrong.err);
}

#[test]
fn a_wrong_file_gets_the_messages_of_check() {
    let folder = folder("wrong");
    write(
        &folder,
        "wrong.mech",
        "mechanism W { coord q: m; kinetic 1/2*m*der(q)^2; }\n",
    );
    let checked = run(&folder, &["check", "wrong.mech"]);
    // With a compiler or without.
    for path in [std::env::var_os("PATH"), None] {
        let mut simulate = bricard(&folder, &["simulate", "wrong.mech"]);
        simulate.env("PATH", path.unwrap_or_default());
        let ran = read(simulate.output().expect("the command starts"));
        assert_eq!((ran.status, &ran.err), (checked.status, &checked.err));
        ran.says(&["`m` is not declared"]);
    }
    let missing = run(&folder, &["simulate", "nowhere.mech"]);
    assert_eq!(missing.status, Some(1));
    missing.says(&["could not read nowhere.mech"]);
    let name = run(&folder, &["simulate", "slider_crnk"]);
    name.says(&["did you mean `slider_crank`?"]);
}

#[test]
fn what_stands_in_the_way_of_compiling_is_said() {
    let folder = folder("hindered");
    let file = "hindered.mech";
    let new = format!("{}// {:?}\n", pendulum("Hindered", 0.5), SystemTime::now());
    write(&folder, file, &new);
    let refused = |command: &mut Command, said: &str| {
        let ran = read(command.output().expect("the command starts"));
        assert_eq!(ran.status, Some(1), "{}", ran.err);
        ran.says(&[said]);
    };
    let simulate = || bricard(&folder, &["simulate", file]);
    refused(simulate().env("PATH", ""), "`rustc` was not found");
    // A file is no place for a cache.
    let place = folder.join(file);
    refused(
        simulate().env("XDG_CACHE_HOME", &place),
        "name another folder with XDG_CACHE_HOME",
    );
    refused(
        simulate().env_remove("XDG_CACHE_HOME").env_remove("HOME"),
        "name one with XDG_CACHE_HOME",
    );
}

#[test]
fn what_was_left_half_built_is_cleared_away_and_never_used() {
    let folder = folder("left");
    let before = programs("left-");
    let new = format!("{}// {:?}\n", pendulum("Left", 0.5), SystemTime::now());
    write(&folder, "left.mech", &new);
    done(&folder, &["simulate", "left.mech", "--until", "0.1"]);
    let mut entries = programs("left-").into_iter();
    let entry = entries.find(|entry| !before.contains(entry));
    let entry = entry.expect("it was compiled");
    let version = entry.ancestors().nth(2).expect("it lies in a version");
    let left = version.join("building-0-0");
    fs::create_dir_all(left.join("program")).expect("the cache is ours");
    // Without its description an entry is not whole.
    fs::remove_file(entry.join("description.mech")).expect("the cache is ours");
    fs::write(entry.join("mechanism"), "").expect("the cache is ours");
    let ran = done(&folder, &["simulate", "left.mech", "--until", "0.1"]);
    assert!(compiles(&ran, "left.mech"), "{}", ran.err);
    assert!(!left.exists());
}

#[test]
fn two_commands_compile_one_file_once() {
    let folder = folder("twice");
    let new = format!("{}// {:?}\n", pendulum("Twice", 0.5), SystemTime::now());
    write(&folder, "twice.mech", &new);
    let simulate = ["simulate", "twice.mech", "--until", "1"];
    let both = [(); 2].map(|()| start(&mut bricard(&folder, &simulate)));
    let both = both.map(|child| end(child).done());
    let [one, other] = &both;
    assert_eq!(one.out, other.out);
    let compiled = both.iter().filter(|ran| compiles(ran, "twice.mech"));
    assert_eq!(compiled.count(), 1, "{}{}", one.err, other.err);
}

#[test]
fn the_cache_is_shown_and_cleared() {
    let folder = folder("cache");
    let command = |arguments: &[&str]| {
        let mut command = bricard(&folder, arguments);
        command.env("XDG_CACHE_HOME", &folder);
        read(command.output().expect("the command starts"))
    };
    let ran = command(&["cache"]);
    ran.prints(&["nothing has been compiled yet"]);
    let program = folder.join("bricard/0.1.0-abc/programs/crane-123");
    fs::create_dir_all(&program).expect("the folder is ours");
    fs::write(program.join("mechanism"), vec![0; 2_500_000]).expect("the folder is ours");
    for other in ["programs/two\nlines-4", "sizes/3-2"] {
        let other = folder.join("bricard/0.1.0-abc").join(other);
        fs::create_dir_all(other).expect("the folder is ours");
    }
    let ran = command(&["cache"]).done();
    ran.prints(&["two?lines-4", "of 1 pair of sizes"]);
    let line = |begin: &str| {
        let mut lines = ran.out.lines().map(str::trim);
        let found = lines.rfind(|line| line.starts_with(begin));
        found.unwrap_or_default().to_string()
    };
    assert!(line("crane-123").ends_with(" 2.5"), "{}", ran.out);
    assert!(line("0.1.0-abc").ends_with(" 0.0"), "{}", ran.out);
    let ran = command(&["cache", "--clear"]);
    ran.prints(&["2.5 MB were removed"]);
    assert!(!program.exists());
    assert!(folder.is_dir());
}

#[cfg(unix)]
#[test]
fn a_run_by_path_goes_on_from_its_checkpoint_unless_the_file_is_edited() {
    let folder = folder("resumed");
    write(&folder, "p.mech", &pendulum("Resumed", 0.5));
    let long = ["simulate", "p.mech", "--step", "0.002", "--until", "600"];
    let with = |more: &[&'static str]| [&long[..], more].concat();
    done(
        &folder,
        &with(&["--out", "whole.csv", "--checkpoint", "whole"]),
    );
    let child = start(&mut bricard(
        &folder,
        &with(&["--out", "parts.csv", "--checkpoint", "parts"]),
    ));
    let [whole, parts] = ["whole.csv", "parts.csv"].map(|name| folder.join(name));
    wait_until("a segment", || {
        fs::metadata(&parts).is_ok_and(|file| file.len() > SEGMENTS)
    });
    let ran = interrupt(child);
    ran.says(&["`--resume parts`"]);
    let torn = fs::read(&parts).expect("the rows are kept");
    let resume = with(&["--out", "parts.csv", "--resume", "parts"]);
    write(&folder, "p.mech", &pendulum("Resumed", 0.6));
    let refused = run(&folder, &resume);
    assert_eq!(refused.status, Some(2), "{}", refused.err);
    refused.says(&["one of another run", "what differs: mechanism\n"]);
    write(&folder, "p.mech", &pendulum("Resumed", 0.5));
    done(&folder, &resume);
    let [one, two] = [&whole, &parts].map(|path| fs::read(path).expect("rows"));
    assert!(
        torn.len() < one.len(),
        "it was over before it was interrupted"
    );
    assert!(one == two, "the bytes differ");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_by_path_keeps_its_rows_and_says_what_was_done() {
    let folder = folder("interrupted_by_path");
    write(&folder, "long.mech", &pendulum("Long", 0.5));
    let long = ["simulate", "long.mech", "--until", "1e7", "--step", "0.01"];
    let child = start(&mut bricard(
        &folder,
        &[&long[..], &["--out", "rows.csv"]].concat(),
    ));
    let rows = folder.join("rows.csv");
    wait_until("a row", || {
        fs::metadata(&rows).is_ok_and(|file| file.len() > 0)
    });
    let ran = interrupt(child);
    let rows = fs::read_to_string(&rows).expect("the rows are kept");
    let said = format!("the {} rows computed before", rows.lines().count() - 1);
    ran.says(&[&said, "energy drift"]);
}

#[cfg(unix)]
#[test]
fn a_watched_file_runs_again_when_it_is_saved() {
    let folder = folder("watched");
    write(&folder, "seen.mech", &pendulum("Seen", 0.5));
    let child = start(&mut bricard(
        &folder,
        &["watch", "seen.mech", "--until", "0.5", "--out", "rows.csv"],
    ));
    let rows = || fs::read_to_string(folder.join("rows.csv")).unwrap_or_default();
    // The end of a run is its last row.
    let is_whole = |rows: &str| {
        rows.lines()
            .last()
            .is_some_and(|row| row.starts_with("0.5,"))
    };
    wait_until("the first run", || is_whole(&rows()));
    let first = rows();
    // A mistake is said, and the watch goes on.
    write(&folder, "seen.mech", "mechanism Seen {");
    thread::sleep(Duration::from_millis(300));
    write(&folder, "seen.mech", &pendulum("Seen", 0.9));
    wait_until("the second run", || rows() != first && is_whole(&rows()));
    let ran = interrupt(child);
    ran.says(&[
        "the description is wrong",
        "waiting until seen.mech is saved",
    ]);
    let name = run(&folder, &["watch", "slider_crank"]);
    assert_eq!(name.status, Some(2), "{}", name.err);
    name.says(&["takes the file of a description"]);
}

#[cfg(unix)]
#[test]
fn a_watched_file_runs_again_when_what_it_reads_is_saved() {
    let folder = folder("watched_data");
    let source = "mechanism Pulled { param m: kg = 1; coord x: m; kinetic 1/2*m*der(x)^2; \
                  input pull: N = table(\"pull.csv\", t); force pull on x; }";
    write(&folder, "pulled.mech", source);
    write(&folder, "pull.csv", "0, 1\n1, 1\n");
    let arguments = ["watch", "pulled.mech", "--until", "1", "--out", "rows.csv"];
    let child = start(&mut bricard(&folder, &arguments));
    // A constant force F moves the unit mass by F/2 in the first second.
    let end = || {
        let rows = fs::read_to_string(folder.join("rows.csv")).unwrap_or_default();
        let last = rows.lines().last().map(|row| row.to_string());
        let last = last.filter(|row| row.starts_with("1,")).unwrap_or_default();
        last.split(',').nth(1).and_then(|x| x.parse::<f64>().ok())
    };
    let moved = |by: f64| end().is_some_and(|x| (x - by).abs() < 1e-9);
    wait_until("the first run", || moved(0.5));
    thread::sleep(Duration::from_millis(300));
    write(&folder, "pull.csv", "0, 4\n1, 4\n");
    wait_until("the second run", || moved(2.0));
    interrupt(child);
}

#[test]
#[ignore = "long: compiles for numbers of 106 bits what all descriptions of three coordinates share"]
fn a_file_is_compared_with_many_digits_as_the_mechanism_of_the_library_is() {
    let folder = folder("precise");
    let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms");
    let file = "slider_crank.mech";
    fs::copy(library.join(file), folder.join(file)).expect("it is in the library");
    let measure = |name| {
        let options = words("--until 0.5 --methods dp5 --set m1=0.3 --csv a.csv");
        done(&folder, &[&["workprecision", name], &options[..]].concat());
        let table = fs::read_to_string(folder.join("a.csv")).expect("it was written");
        let without_time = |line: &str| {
            let cells = line.split(',').enumerate().filter(|(place, _)| *place != 4);
            cells.map(|(_, cell)| cell.to_string()).collect::<Vec<_>>()
        };
        table.lines().map(without_time).collect::<Vec<_>>()
    };
    let (named, given) = (measure("slider_crank"), measure(file));
    assert!(named.len() > 10, "{named:?}");
    assert_eq!(named, given);
}

#[test]
#[ignore = "long: compiles for numbers of 106 bits what all descriptions of one coordinate share"]
fn time_is_measured_over_errors_of_a_motion_with_an_input_by_formula() {
    let folder = folder("measured");
    let pushed = "coord q: rad;\n    input u: N*m = 0;\n    force u on q;";
    write(
        &folder,
        "plain.mech",
        &pendulum("Measured", 1.0).replace("coord q: rad;", pushed),
    );
    let law = "u=3*sin(2*t)";
    let arguments = ["workprecision", "plain.mech", "--set", law];
    let some = ["--until", "0.05", "--methods", "rk4,dop853"];
    let ran = done(&folder, &[&arguments[..], &some].concat());
    let lines: Vec<&str> = ran.out.lines().collect();
    assert!(
        lines.iter().all(|line| !line.contains("h = 0.08")),
        "longer than the run"
    );
    let errors = lines.iter().filter(|line| line.contains("tolerance 1e-13"));
    let error = errors.filter_map(|line| line.split_whitespace().find(|x| x.contains("e-1")));
    assert!(error.count() > 0, "{}", ran.out);
}

#[test]
fn an_input_follows_a_formula_of_the_command_line_as_it_would_one_of_its_file() {
    let folder = folder("laws");
    let description = |law: &str| {
        pendulum("Pushed", 1.0).replace(
            "coord q: rad;",
            &format!(
                "coord q: rad;\n    input u: N*m = {law};\n    force u on q;\n    \
                 input p[2]: N*m = [0, t];\n    force p[0] + 0*p[1] on q;"
            ),
        )
    };
    let law = "if t < 1.5 then 3*sin(t) - m*der(q)*L else 0";
    write(&folder, "plain.mech", &description("0"));
    write(&folder, "pushed.mech", &description(law));
    let run_of = |name: &str, options: &[&str]| {
        let end = ["--until", "3", "--every", "0.1", "--columns", "u"];
        run(&folder, &[&["simulate", name][..], options, &end].concat())
    };
    let set = format!("u={law}");
    let given = run_of("plain.mech", &["--set", &set, "--set", "m=2"]);
    let written = run_of("pushed.mech", &["--set", "m=2"]);
    assert_eq!(given.status, Some(0), "{}", given.err);
    assert!(given.out.lines().count() > 10);
    assert_eq!(given.out, written.out);
    let other = run_of("plain.mech", &["--set", "u=1"]);
    assert_ne!(given.out, other.out);

    let wrong = run_of("plain.mech", &["--set", "u=3*sin(x)"]);
    assert_eq!(wrong.status, Some(1));
    wrong.says(&["with `--set 'u=3*sin(x)'`", "`x` is not declared"]);
    let unit = run_of("plain.mech", &["--set", "u=L*sin(q)"]);
    unit.says(&["N*m"]);
    let parameter = run_of("plain.mech", &["--set", "m=sin(t)"]);
    assert_eq!(parameter.status, Some(2));
    parameter.says(&["a parameter is a number"]);
    for (set, said) in [
        (
            "p[0]=sin(t)",
            "the law of `p` is given as a whole: write `p=[…]`",
        ),
        ("p=1", "what it consists of is set one by one: `p[0]=…`"),
    ] {
        let part = run_of("plain.mech", &["--set", set]);
        assert_eq!(part.status, Some(2));
        part.says(&[said]);
    }
    let nobody = run_of("plain.mech", &["--set", "w=sin(t)"]);
    nobody.says(&["there is no parameter or input `w`"]);
}

#[test]
fn a_file_of_numbers_is_a_part_of_its_description() {
    let folder = folder("data");
    let text = pendulum("Told", 1.0).replace(
        "coord q: rad;",
        "coord q: rad;\n    state z: rad*s;\n    der(z) = q;\n    \
         /* a 3\" pipe */ force table(\"told.csv\", \"torque\", t) on q;",
    );
    // Earlier runs of this test have left programs of other descriptions.
    let text = format!("{text}// {:?}\n", SystemTime::now());
    write(&folder, "told.mech", &text);
    write(&folder, "told.csv", "time,torque\n0,0\n1,2\n2,0\n");
    let arguments = ["simulate", "told.mech", "--until", "1", "--every", "0.5"];
    let first = done(&folder, &arguments);
    assert!(compiles(&first, "told.mech"), "{}", first.err);
    assert!(first.out.starts_with("t,q,der(q),z\n"), "{}", first.out);
    let again = done(&folder, &arguments);
    assert!(!compiles(&again, "told.mech"), "{}", again.err);
    assert_eq!(again.out, first.out);
    write(&folder, "told.csv", "time,torque\n0,0\n1,3\n2,0\n");
    let edited = done(&folder, &arguments);
    assert!(compiles(&edited, "told.mech"), "{}", edited.err);
    assert_ne!(edited.out, first.out);
    let over = run(
        &folder,
        &[&arguments[..], &["--out", "./told.csv"]].concat(),
    );
    let said = "--out would replace ./told.csv, which the mechanism is read from";
    over.says(&[said]);
    write(&folder, "told.csv", "time,torque\n0,0\n1,a\n");
    let wrong = run(&folder, &["check", "told.mech"]);
    wrong.says(&["line 3, column 2: `a` is not a number"]);
}
