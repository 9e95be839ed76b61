//! The command, run as a user would: status, messages, what is written and what
//! is left alone.

use std::ffi::OsStr;
use std::fmt::Debug;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Long enough for any machine to compile a description, and to write rows of it.
const PATIENCE: Duration = Duration::from_secs(240);

/// What a run of the command gave.
pub struct Ran {
    pub status: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Ran {
    /// The same, of a command that has to succeed.
    #[track_caller]
    pub fn done(self) -> Self {
        assert_eq!(self.status, Some(0), "{}\n{}", self.out, self.err);
        self
    }

    /// Checks that all of some messages are there.
    #[track_caller]
    pub fn says(&self, messages: &[&str]) {
        for said in messages {
            assert!(self.err.contains(said), "no `{said}` in\n{}", self.err);
        }
    }

    /// Checks that all of some texts are in what is printed.
    #[track_caller]
    pub fn prints(&self, texts: &[&str]) {
        for text in texts {
            assert!(self.out.contains(text), "no `{text}` in\n{}", self.out);
        }
    }
}

/// The folder in which tests keep compiled descriptions.
pub fn cache() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache")
}

/// The command, with the cache of all tests.
pub fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bricard"));
    command.env("XDG_CACHE_HOME", cache());
    command
}

pub fn bricard<W: AsRef<OsStr>>(arguments: &[W]) -> Ran {
    let output = command().args(arguments).output();
    read(output.expect("the command starts"))
}

/// The words of a command line.
pub fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Starts a command, of which what it writes is kept.
pub fn start(command: &mut Command) -> Child {
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the command starts")
}

/// Waits for the end of a command.
pub fn end(child: Child) -> Ran {
    read(child.wait_with_output().expect("the command ends"))
}

/// Waits until something is the case.
pub fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < PATIENCE, "{what} never came");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Presses Ctrl-C, which has to end a command.
pub fn interrupt(child: Child) -> Ran {
    let id = child.id().to_string();
    let pressed = Command::new("kill").args(["-INT", &id]).status();
    assert!(pressed.is_ok_and(|status| status.success()));
    let ran = end(child);
    assert_eq!(ran.status, Some(130), "{}", ran.err);
    ran
}

pub fn read(output: Output) -> Ran {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ran {
        status: output.status.code(),
        out: text(&output.stdout),
        err: text(&output.stderr),
    }
}

/// An empty folder of one test's own.
pub fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
        .join("command")
        .join(test);
    let _nothing_there = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}

/// Runs the command, which has to fail with a status and say all of `said`.
pub fn check_refused<W: AsRef<OsStr> + Debug>(arguments: &[W], status: i32, said: &[&str]) {
    let ran = bricard(arguments);
    assert_eq!(ran.status, Some(status), "{arguments:?} said {}", ran.err);
    for part in said {
        assert!(
            ran.err.contains(part),
            "{arguments:?} does not say `{part}`:\n{}",
            ran.err
        );
    }
    assert!(!ran.err.contains("panicked"), "{}", ran.err);
}

/// The columns of a CSV text by name.
fn column(csv: &str, name: &str) -> Vec<f64> {
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let place = header.iter().position(|column| *column == name);
    let place = place.unwrap_or_else(|| panic!("no column `{name}` in {header:?}"));
    let cell = |line: &str| {
        line.split(',')
            .nth(place)
            .and_then(|cell| cell.parse().ok())
    };
    lines.map(|line| cell(line).unwrap_or(f64::NAN)).collect()
}

#[test]
fn every_mechanism_is_listed_with_its_sizes() {
    let ran = bricard(&["list"]).done();
    for name in bricard::NAMES {
        assert!(
            ran.out.lines().any(|line| line.starts_with(name)),
            "{name}\n{}",
            ran.out
        );
    }
    let line = ran
        .out
        .lines()
        .find(|line| line.starts_with("slider_crank "))
        .unwrap_or("");
    let cells: Vec<&str> = line.split_whitespace().take(3).collect();
    assert_eq!(cells, ["slider_crank", "3", "2"]);
}

#[test]
fn a_wrong_name_is_answered_with_the_nearest_and_all_there_are() {
    let wrong: [(&[&str], &str, &str); 7] = [
        (
            &["simulate", "slider_cranc"],
            "did you mean `slider_crank`?",
            "double_four_bar",
        ),
        (
            &["simulate", "slider_crank", "--set", "L9=1"],
            "did you mean `L1`?",
            "J2",
        ),
        (
            &["simulate", "slider_crank", "--start", "q9=1"],
            "did you mean `q1`?",
            "q3",
        ),
        (
            &["simulate", "slider_crank", "--start", "der(q9)=1"],
            "did you mean `der(q1)`?",
            "der(q3)",
        ),
        (
            &["simulate", "slider_crank", "--columns", "enrgy"],
            "did you mean `energy`?",
            "constraint_error",
        ),
        (
            &["simulate", "slider_crank", "--columns", "energy,der(q1)"],
            "`der(q1)` is in every row",
            "`--columns` adds others",
        ),
        (
            &["simulate", "slider_crank", "--columns", "x3"],
            "did you mean `x2`?",
            "reactions",
        ),
    ];
    for (arguments, nearest, listed) in wrong {
        check_refused(arguments, 2, &[nearest, listed]);
    }
}

#[test]
fn a_number_that_makes_no_sense_is_a_wrong_command_line() {
    let wrong: [(&[&str], &str); 8] = [
        (
            &["--step", "-0.01"],
            "--step must be a positive number, not -0.01",
        ),
        (&["--until", "-1"], "--until must be zero or positive"),
        (&["--rtol", "0"], "--rtol must be a positive number"),
        (&["--atol", "-1e-9"], "--atol must be a positive number"),
        (&["--every", "0"], "--every must be a positive number"),
        (&["--step", "abc"], "`abc` has no value here"),
        (&["--set", "L1"], "write NAME=VALUE"),
        (&["--until", "1/0"], "not a finite number"),
    ];
    for (options, said) in wrong {
        let arguments = [&["simulate", "slider_crank"], options].concat();
        check_refused(&arguments, 2, &[said]);
    }
}

#[test]
fn a_wrong_command_line_is_told_before_the_description_is_read() {
    for options in [&[][..], &["--set", "m=1,2"]] {
        let wrong = ["simulate", "absent.mech", "--until", "-1"];
        check_refused(&[&wrong, options].concat(), 2, &["--until must be"]);
        let wrong = ["simulate", "absent.mech", "--plot", "run.xyz"];
        check_refused(&[&wrong, options].concat(), 2, &["--plot run.html"]);
        let wrong = ["simulate", "absent.mech", "--tolerance", "0"];
        check_refused(&[&wrong, options].concat(), 2, &["--rtol must be"]);
    }
}

#[test]
fn options_that_contradict_each_other_are_refused() {
    let name = ["simulate", "slider_crank"];
    let both = [&name[..], &["--step", "0.01", "--rtol", "1e-6"]].concat();
    check_refused(&both, 2, &["--step", "--rtol"]);
    let alone = [&name[..], &["--live"]].concat();
    check_refused(&alone, 2, &["--plot"]);
    let no_page = [&name[..], &["--live", "--plot", "run.svg"]].concat();
    let wanted = [
        "a plot that is no page has no use for --live",
        "--plot run.html",
    ];
    check_refused(&no_page, 2, &wanted);
    let several = ["--live", "--plot", "run.html", "--set", "m1=1,2"];
    let several = [&name[..], &several].concat();
    check_refused(
        &several,
        2,
        &["--live moves one run, and `--set m1` asks for 2"],
    );
    let followed = ["watch", "absent.mech", "--live", "--plot", "run.html"];
    check_refused(
        &followed,
        2,
        &["`watch` has no use for --live", "bricard simulate"],
    );
    bricard(&["watch", "--help"]).prints(&["<FILE.mech>"]);
    let unknown = [&name[..], &["--method", "rk5"]].concat();
    check_refused(&unknown, 2, &["rk4, dp5, dop853"]);
    check_refused(&["simulat"], 2, &["simulate"]);
    let greeted = bricard::<&str>(&[]).done();
    greeted.prints(&["bricard list", "bricard simulate", "bricard new"]);
}

#[test]
fn files_that_cannot_be_written_are_found_out_before_the_run() {
    let name = ["simulate", "slider_crank"];
    let missing = [&name[..], &["--out", "/nonexistent/run.csv"]].concat();
    check_refused(&missing, 1, &["could not write /nonexistent/run.csv"]);
    let missing = [&name[..], &["--plot", "/nonexistent/run.svg"]].concat();
    check_refused(&missing, 1, &["could not write /nonexistent/run.svg"]);
    let bmp = [&name[..], &["--plot", "run.bmp"]].concat();
    check_refused(&bmp, 2, &["run.bmp", "--plot run.svg", "--plot run.html"]);
    let phase = [&name[..], &["--plot", "run.html", "--phase", "q1,q2"]].concat();
    check_refused(&phase, 2, &["run.html", "--plot run.svg"]);
    let alone = [&name[..], &["--plot", "run.svg", "--phase", "q1"]].concat();
    check_refused(&alone, 2, &["two names", "q1,der(q1)"]);
    let missing = [&name[..], &["--film", "/nonexistent/run.gif"]].concat();
    check_refused(&missing, 1, &["could not write /nonexistent/run.gif"]);
    let both = [&name[..], &["--json"]].concat();
    check_refused(&both, 2, &["--json and --out", "standard output"]);
    let curve = [&name[..], &["--plot", "run.svg", "--curves", "q1,enrgy"]].concat();
    check_refused(&curve, 2, &["`enrgy`", "did you mean `energy`"]);
    check_refused(
        &["reproduce", "--out", "/proc/figures"],
        1,
        &["could not write /proc/figures"],
    );
}

#[test]
fn an_impossible_start_names_the_equations_and_leaves_an_old_file_alone() {
    let file = folder("impossible").join("run.csv");
    fs::write(&file, "old").expect("the folder is ours");
    let path = file.to_string_lossy();
    let arguments = [
        "simulate",
        "slider_crank",
        "--set",
        "L2=0.1",
        "--start",
        "q1=80*deg",
        "--out",
        &path,
    ];
    let said = ["L1*sin(q1) = L2*sin(q2)", "q1", "nothing was written"];
    check_refused(&arguments, 1, &said);
    assert_eq!(fs::read_to_string(&file).ok().as_deref(), Some("old"));
}

#[test]
fn rows_have_names_and_begin_at_the_held_start() {
    let run = words("simulate slider_crank --until 0.1 --every 0.05 --columns");
    let columns = words("energy,rank,reactions,x2,energy,r(q1)");
    let start = words("--start q1=pi/3 --start der(q1)=-2 --set m3=1/4");
    let ran = bricard(&[run, columns, start].concat()).done();
    let header = "t,q1,q2,q3,der(q1),der(q2),der(q3),energy,rank,r(q1),r(q2),r(q3),x2";
    assert_eq!(ran.out.lines().next(), Some(header));
    assert_eq!(column(&ran.out, "t"), [0.0, 0.05, 0.1]);
    let angle = column(&ran.out, "q1")[0] - std::f64::consts::FRAC_PI_3;
    assert!(angle.abs() < 1e-15, "{angle}");
    assert_eq!(column(&ran.out, "der(q1)")[0], -2.0);
    assert_eq!(column(&ran.out, "rank"), [2.0; 3]);
    assert!(
        (column(&ran.out, "q3")[0] - 0.5).abs() < 1e-14,
        "2 L cos 60° = 0.5 m"
    );
    let energy = column(&ran.out, "energy");
    assert!((energy[2] - energy[0]).abs() < 1e-7, "{energy:?}");
    ran.says(&["passages through singular positions"]);
}

#[test]
fn printed_numbers_are_the_shortest_that_read_back() {
    let ran = bricard(&words("simulate double_pendulum --until 1 --step 0.01")).done();
    let mut count = 0;
    for cell in ran.out.lines().skip(1).flat_map(|line| line.split(',')) {
        let value: f64 = cell
            .parse()
            .unwrap_or_else(|_| panic!("`{cell}` is no number"));
        let again = format!("{value:?}");
        assert_eq!(cell, again.strip_suffix(".0").unwrap_or(&again));
        count += 1;
    }
    assert_eq!(count, 101 * 5);
}

#[test]
fn the_same_run_prints_the_same_bits() {
    let run = || bricard(&words("simulate double_four_bar --until 2 --method dp5")).out;
    assert_eq!(run(), run());
}

#[test]
fn a_form_that_ends_at_a_singular_position_keeps_its_rows() {
    let folder = folder("multipliers");
    let (csv, svg) = (folder.join("run.csv"), folder.join("run.svg"));
    let (csv_path, svg_path) = (csv.to_string_lossy(), svg.to_string_lossy());
    let files = ["--out", &csv_path, "--plot", &svg_path];
    let options = ["--form", "multipliers", "--step", "0.01"];
    let arguments = [&["simulate", "slider_crank"], &options[..], &files[..]].concat();
    check_refused(
        &arguments,
        1,
        &["form `multipliers`", "rows computed before", &csv_path],
    );
    let rows = fs::read_to_string(csv).unwrap_or_default();
    let last = column(&rows, "t").last().copied().unwrap_or(0.0);
    assert!(
        (0.5..0.878).contains(&last),
        "the first singular position is at 0.877 s, not {last}"
    );
    assert!(rows.ends_with('\n'), "the last row is whole");
    assert!(fs::read_to_string(svg).is_ok_and(|svg| svg.contains("</svg>")));
}

#[test]
fn a_plot_is_a_whole_svg_with_axes_and_names() {
    let file = folder("plot").join("run.svg");
    let path = file.to_string_lossy();
    let ran = bricard(&["simulate", "slider_crank", "--until", "2", "--plot", &path]).done();
    assert_eq!(ran.out, "", "rows go nowhere unless they are asked for");
    let svg = fs::read_to_string(&file).unwrap_or_default();
    for part in [
        "<svg",
        "angle [rad]",
        "position [m]",
        "time t [s]",
        "q1, q2",
        "</svg>",
    ] {
        assert!(svg.contains(part), "no `{part}` in the plot");
    }
}

#[test]
fn equations_are_shown_entry_by_entry() {
    let ran = bricard(&["show", "slider_crank"]).done();
    let lines: Vec<&str> = ran.out.lines().collect();
    for line in [
        "M[1,3] = 0",
        "M[3,3] = m3",
        "C[3,3] = 0",
        "G[1,1] = -L1*sin(q1)",
        "G[1,3] = -1",
        "g[2] = L1*sin(q1) - L2*sin(q2)",
    ] {
        assert!(lines.contains(&line), "no line `{line}` in\n{}", ran.out);
    }
    let entries = |symbol: &str| lines.iter().filter(|line| line.starts_with(symbol)).count();
    let counts = ["M[", "C[", "Cv[", "h[", "Q[", "G[", "p2["].map(entries);
    assert_eq!(counts, [9, 9, 3, 3, 3, 6, 2]);
    ran.prints(&["1 degree of freedom"]);
    assert!(
        ran.out.contains("sine–cosine pairs"),
        "operations are counted"
    );
}

/// In joint angles an entry holds all links from there on: parts that many entries share would
/// be written out again in each.
#[test]
fn entries_that_nobody_would_read_to_their_end_are_shown_by_their_length() {
    let chain = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/fixtures/chains/long_chain.mech"
    );
    for notation in [&["show", chain][..], &["show", chain, "--latex"]] {
        let ran = bricard(notation).done();
        let lines: Vec<&str> = ran.out.lines().collect();
        let long = |line: &&&str| line.contains("too long to be written out: ");
        assert!(lines.iter().any(|line| long(&line)), "nothing is too long");
        let longest = lines.iter().map(|line| line.len()).max();
        assert!(longest < Some(500_000), "a line of {longest:?} bytes");
    }
    let ran = bricard(&["show", "stewart_platform"]);
    assert!(!ran.out.contains("too long"), "the library is shown whole");
}

#[test]
fn programs_are_shown_operation_by_operation() {
    let ran = bricard(&["show", "slider_crank", "--programs"]).done();
    ran.prints(&[
        "terms: ",
        "%9 = sin(q1)\n",
        "mass[3,3] = m3\n",
        "\nenergy: ",
    ]);
    check_refused(
        &["show", "slider_crank", "--programs", "--latex"],
        2,
        &["--programs", "--latex"],
    );
}

#[test]
fn equations_are_shown_as_latex() {
    let ran = bricard(&["show", "cart_pole", "--latex"]).done();
    ran.prints(&["\\begin{align*}", "\\sin \\phi"]);
    assert!(!ran.out.contains("der("), "velocities have dots");
    assert_eq!(
        ran.out.matches("\\begin{").count(),
        ran.out.matches("\\end{").count()
    );
}

#[test]
fn a_description_outside_the_library_is_shown_and_checked() {
    let file = folder("outside").join("pendulum.mech");
    let source = "mechanism P { param J: kg*m^2 = 1; param c: N*m = 2; coord q: rad; \
                  kinetic 1/2*J*der(q)^2; potential -c*cos(q); }";
    fs::write(&file, source).expect("the folder is ours");
    let path = file.to_string_lossy();
    let shown = bricard(&["show", &path]).done();
    shown.prints(&["M[1,1] = J"]);
    shown.prints(&["; 1 operation a factorisation"]);
    let checked = bricard(&["check", &path]).done();
    checked.prints(&["in order"]);
}

#[test]
fn a_wrong_description_is_answered_with_places() {
    let file = folder("wrong").join("wrong.mech");
    fs::write(
        &file,
        "mechanism P {\n    coord q: rad;\n    kinetic L9*der(q)^2;\n}\n",
    )
    .expect("the folder is ours");
    let path = file.to_string_lossy();
    for command in ["check", "show"] {
        check_refused(&[command, &path], 1, &["wrong.mech:3:13", "L9"]);
    }
}

#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let long = words("simulate double_pendulum --until 500 --step 0.01");
    let mut child = start(command().args(long));
    drop(child.stdout.take());
    let ran = end(child).done();
    assert_eq!(ran.err, "");
}

#[test]
fn the_papers_experiments_are_reproduced_within_their_bounds() {
    let folder = folder("reproduce");
    let ran = bricard(&["reproduce", "--out", &folder.to_string_lossy()]).done();
    let exact = "exact  0.684  1.095  2.463  2.874  4.242  4.653  6.020  6.432  7.799";
    ran.prints(&[
        exact,
        "double four-bar, 8 s: 9",
        "The paper speaks of 6",
        "every bound is kept",
    ]);
    for figure in ["2", "3", "4", "6", "6_configurations"] {
        let svg = fs::read_to_string(folder.join(format!("figure_{figure}.svg")));
        assert!(
            svg.is_ok_and(|svg| svg.contains("</svg>")),
            "figure {figure}"
        );
    }
}

#[test]
#[ignore = "long: compiles for numbers of 106 bits what all descriptions of three coordinates share"]
fn time_is_measured_over_errors_that_fall_with_the_tolerance() {
    let folder = folder("workprecision");
    let (csv, png) = (folder.join("points.csv"), folder.join("points.png"));
    let [csv_path, png_path] = [&csv, &png].map(|path| path.to_string_lossy().into_owned());
    let ran = bricard(&[
        "workprecision",
        "slider_crank",
        "--until",
        "2",
        "--methods",
        "dop853",
        "--forms",
        "reduced,multipliers",
        "--csv",
        &csv_path,
        "--out",
        &png_path,
    ])
    .done();
    ran.prints(&["dop853, multipliers ends"]);
    let text = fs::read_to_string(csv).expect("the CSV");
    let errors = column(&text, "error");
    let (first, last) = (errors[0], errors[errors.len() - 1]);
    assert!(first > 1e-7 && last < 1e-11, "{errors:?}");
    assert!(column(&text, "seconds").iter().all(|time| *time > 0.0));
    let picture = fs::read(png).expect("the PNG");
    assert!(picture.starts_with(b"\x89PNG"));
}

#[test]
fn the_benchmark_problems_keep_their_bounds() {
    let folder = folder("validate");
    let ran = bricard(&["validate", "--quick", "--out", &folder.to_string_lossy()]).done();
    ran.prints(&["every bound is kept"]);
    let markdown = fs::read_to_string(folder.join("validation.md")).expect("a table is written");
    assert!(
        markdown.contains("| A04 Bricard, 30 coordinates |"),
        "{markdown}"
    );
    let json = fs::read_to_string(folder.join("validation.json")).expect("numbers are written");
    let json: serde_json::Value = serde_json::from_str(&json).expect("they are JSON");
    let problems = json["problems"].as_array().expect("problems are a list");
    assert!(problems.len() >= 10, "{json}");
    assert!(problems.iter().all(|p| p["passed"] == true), "{json}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said_and_fails_the_run() {
    let run = words("simulate double_pendulum --until 100 --out /dev/full");
    check_refused(&run, 1, &["could not write /dev/full to its end"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_rows_and_says_so() {
    let csv = folder("interrupted").join("rows.csv");
    let long = words("simulate double_pendulum --until 1e7 --step 0.01 --out");
    let child = start(command().args(long).arg(&csv));
    wait_until("a row", || {
        fs::metadata(&csv).is_ok_and(|file| file.len() > 0)
    });
    let ran = interrupt(child);
    let rows = fs::read_to_string(&csv).expect("the rows are kept");
    let count = rows.lines().count() - 1;
    let said = format!("the {count} rows computed before");
    ran.says(&["interrupted", &said]);
    assert!(rows.ends_with('\n'));
}

#[test]
fn stages_beside_a_singular_position_are_as_good_as_others_wherever_they_are_placed() {
    let ran = bricard(&["passage", "slider_crank", "--methods", "rk4"]).done();
    let rows = ran.out.lines().filter(|line| line.ends_with("  ok"));
    assert_eq!(rows.count(), 4, "{}", ran.out);
    let never = [
        "cart_pole: looking for a singular position",
        "passes no singular position",
    ];
    check_refused(&["passage", "cart_pole"], 1, &never);
    // The name that the command had before.
    check_refused(&["landing", "cart_pole"], 1, &never);
    assert!(!bricard(&["help"]).out.contains("landing"));
}

#[test]
fn a_guess_can_be_given_on_the_command_line() {
    let start = words("simulate slider_crank --until 0.1 --every 0.1");
    let held = [&start[..], &["--start", "q3=0.6"]].concat();
    let said = ["turn one of them into a guess", "--start 'NAME~VALUE'"];
    check_refused(&held, 1, &said);
    let ran = bricard(&[&held[..], &["--start", "q1~0.8"]].concat()).done();
    assert_eq!(column(&ran.out, "q3")[0], 0.6);
    let angle = column(&ran.out, "q1")[0] - 0.6_f64.acos();
    assert!(angle.abs() < 1e-14, "2 L cos(q1) = q3 is off by {angle}");
}

#[test]
fn a_negative_mass_is_refused_by_its_coordinate() {
    let arguments = ["simulate", "slider_crank", "--set", "m3=-3"];
    let said = ["kinetic energy is negative where `q3` moves", "parameters"];
    check_refused(&arguments, 1, &said);
    // Without constraints it is refused, too.
    let arguments = ["simulate", "cart_pole", "--set", "m1=-3"];
    let said = ["kinetic energy is negative where `", "parameters"];
    check_refused(&arguments, 1, &said);
    // The second link moves with the first one, so that the energy stays positive.
    let ran = bricard(&words("simulate slider_crank --until 0.1 --set m1=-3")).done();
    ran.says(&["warning: `m1` is an inertia, and negative"]);
}

#[test]
fn an_energy_that_does_not_add_up_is_warned_of() {
    let warning = "warning: the energy is off by ";
    let ran = bricard(&words("simulate cart_pole --until 20 --step 1")).done();
    ran.says(&[warning, "take smaller steps"]);
    let ran = bricard(&words("simulate cart_pole --until 20 --step 0.05")).done();
    assert!(!ran.err.contains(warning), "{}", ran.err);
}

#[test]
fn values_that_would_do_silently_what_nobody_wants_are_refused() {
    let name = ["simulate", "slider_crank", "--until", "1"];
    let wrong: [(&[&str], &[&str]); 7] = [
        (
            &["--every", "1e-12"],
            &["--every must be at least 1e-10 s", "not 1e-12"],
        ),
        (&["--step", "1e-11"], &["--step must be at least 1e-10 s"]),
        (&["--step", "100"], &["--step must be at most the 1 s"]),
        (&["--rtol", "10"], &["--rtol must be less than 1"]),
        (&["--out", "x.xlsx"], &["x.xlsx", "--out run.csv"]),
        (
            &["--out", "x.csv", "--checkpoint", "x.csv"],
            &["--out and --checkpoint", "x.csv"],
        ),
        (&["--start", "q1=60deg"], &["write `60*deg`"]),
    ];
    for (options, said) in wrong {
        check_refused(&[&name[..], options].concat(), 2, said);
    }
}

#[test]
fn rows_at_intervals_have_decimal_times_and_the_end_of_the_run() {
    let times = |every: &str, until: &str| {
        let run = ["simulate", "slider_crank", "--every", every];
        column(&bricard(&[&run[..], &["--until", until]].concat()).out, "t")
    };
    assert_eq!(times("0.3", "1"), [0.0, 0.3, 0.6, 0.9, 1.0]);
    assert_eq!(times("0.3", "0.9"), [0.0, 0.3, 0.6, 0.9]);
    for longer in ["2", "1e300"] {
        assert_eq!(times(longer, "1"), [0.0, 1.0]);
    }
}

#[test]
fn a_held_velocity_is_written_as_it_was_given() {
    let run = ["simulate", "peaucellier_lipkin", "--until", "0.01"];
    let ran = bricard(&[&run[..], &["--start", "der(crank)=3"]].concat());
    assert_eq!(column(&ran.out, "der(crank)")[0], 3.0, "{}", ran.err);
}

#[test]
fn an_output_that_is_a_vector_is_asked_for_by_its_name() {
    let run = ["simulate", "jansen_leg", "--until", "0.01", "--columns"];
    let ran = bricard(&[&run[..], &["foot"]].concat());
    let header = ran.out.lines().next().unwrap_or("");
    assert!(header.ends_with(",foot.x,foot.y"), "{header}\n{}", ran.err);
}

#[test]
fn a_file_that_is_not_utf_8_is_answered_with_the_place() {
    let file = folder("bytes").join("latin.mech");
    let text = b"mechanism P {\n    coord q: rad;\n    // gr\xfc\xdfe\n    kinetic der(q)^2;\n}\n";
    fs::write(&file, text).expect("the folder is ours");
    let said = [
        "latin.mech",
        "line 3 is not UTF-8 at column 10",
        "save the file as UTF-8",
    ];
    check_refused(&["check", &file.to_string_lossy()], 1, &said);
}

#[test]
fn a_plot_names_outputs_marks_events_and_sets_turning_angles_apart() {
    let file = folder("named").join("run.svg");
    let path = file.to_string_lossy();
    let run = ["simulate", "quick_return", "--until", "3", "--plot", &path];
    let columns = ["--columns", "speed,rank", "--start", "der(crank)=9"];
    bricard(&[&run[..], &columns].concat()).done();
    let svg = fs::read_to_string(&file).unwrap_or_default();
    assert!(
        svg.contains("speed [m/s]"),
        "the axis has the output's name"
    );
    assert!(svg.contains("\nturn\n"), "events are explained");
    assert!(!svg.contains("4.4"), "a rank is a whole number");
    assert_eq!(svg.matches("angle [rad]").count(), 2, "the crank turns");
}

#[test]
fn a_plot_is_drawn_though_the_reader_of_the_rows_has_gone() {
    let file = folder("gone").join("run.svg");
    let long = words("simulate double_pendulum --until 500 --step 0.01 --out - --plot");
    let mut child = start(command().args(long).arg(&file));
    drop(child.stdout.take());
    end(child).done();
    assert!(fs::read_to_string(file).is_ok_and(|svg| svg.contains("</svg>")));
}
