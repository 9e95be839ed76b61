//! The refusals of the command, each with a command line that brings it about.

/// A reason, the words of a command line, the exit status, and what is said, with `…` for
/// what depends on the machine.
pub type Case = (&'static str, &'static str, i32, &'static str);

/// Nothing here is compiled.
pub const CASES: &[Case] = &[
    (
        "UnknownName",
        "show slider_cranc",
        2,
        "there is no mechanism `slider_cranc`; did you mean `slider_crank`?\nthere are: …",
    ),
    (
        "NoColumn",
        "simulate slider_crank --columns L1",
        2,
        "`L1` is a parameter, which stays as it is; leave it out",
    ),
    (
        "OutOfRange",
        "simulate slider_crank --step 0",
        2,
        "--step must be a positive number, not 0",
    ),
    (
        "Twice",
        "simulate slider_crank --set m1=2 --set m1=3",
        2,
        "--set gives `m1` two values; leave one out",
    ),
    (
        "InvalidSetting",
        "simulate slider_crank --set m1=sin(t)",
        2,
        "`--set m1=…`: `t` has no value here; the constants are `pi` and `deg`; a parameter is a \
         number",
    ),
    (
        "Several",
        "simulate slider_crank --set mass=1 --set length=2 --columns force",
        2,
        "there is no parameter or input `mass` in `slider_crank`\nthere is no parameter or input \
         `length` in `slider_crank`\nthere are: …\nerror: there is no column or output `force` in \
         `slider_crank`\nthere are: …",
    ),
    (
        "TwoLists",
        "simulate slider_crank --set L1=0.4,0.5 --set L2=1,2",
        2,
        "`--set L1` and `--set L2` have several values each, and runs are compared by one of \
         them; give the other a single value",
    ),
    (
        "Runs",
        "simulate slider_crank --set L1=0.4,0.5 --film x.gif",
        2,
        "--film shows one run, and `--set L1` asks for 2; give it one value",
    ),
    (
        "SameFile",
        "simulate slider_crank --out x.svg --plot x.svg",
        2,
        "--out and --plot can't both be written to x.svg; give them different names",
    ),
    (
        "ReadHere",
        "simulate broken.mech --checkpoint broken.mech",
        2,
        "--checkpoint would replace broken.mech, which the mechanism is read from; give it another \
         name",
    ),
    (
        "UselessOption",
        "simulate slider_crank --method rk4 --rtol 1e-6",
        2,
        "rk4 has no use for --rtol; give --step, or take --method dp5, dop853, radau5 or radau9",
    ),
    (
        "FileKind",
        "simulate slider_crank --film run.mp4",
        2,
        "run.mp4 can't be written: films are GIF, strips of configurations SVG, PNG or PDF; write \
         `--film run.gif` or `--film run.svg`",
    ),
    (
        "Read",
        "check brocken.mech",
        1,
        "could not read brocken.mech: …; did you mean `broken.mech`?",
    ),
    (
        "NoCheckout",
        "new swing --path crane",
        2,
        "crane is no checkout of bricard: one has codegen/Cargo.toml and runtime/Cargo.toml in it; \
         name another folder, or leave --path out",
    ),
    (
        "UselessOption",
        "simulate slider_crank --stabilisation none --keep-energy",
        2,
        "--stabilisation none has no use for --keep-energy; where nothing keeps the constraints, \
         the energy is not kept either; take --stabilisation projection",
    ),
    (
        "OutOfRange",
        "simulate slider_crank --rtol 1e-300",
        2,
        "--rtol must be at least 2.3e-15, where the round-off of numbers begins, not 1e-300",
    ),
    (
        "Write",
        "simulate slider_crank --out crane",
        1,
        "could not write crane: …; name a file in it",
    ),
    (
        "Write",
        "simulate slider_crank --out missing/run.csv",
        1,
        "could not write missing/run.csv: there is no folder missing; make it, or name another file",
    ),
    (
        "Description",
        "check broken.mech",
        1,
        "the description is wrong\n\nbroken.mech:1:42: error: `L9` is not declared\n…",
    ),
    (
        "Run",
        "simulate slider_crank --form multipliers --until 2 --out run.csv",
        1,
        "at t = 0.… s only 1 of the 2 constraint equations is independent: `L1*cos(q1) + \
         L2*cos(q2) = q3` (line …), `L1*sin(q1) = L2*sin(q2)` (line …), and the form \
         `multipliers` cannot pass a singular position; use the form `reduced` or `full`\nthe … \
         rows computed before, up to t = 0.… s, were written: run.csv",
    ),
    (
        "Checkpoint",
        "simulate slider_crank --resume broken.mech",
        2,
        "can't go on from broken.mech: it is no checkpoint, or damaged; give a file as --checkpoint wrote it",
    ),
    (
        "NoFile",
        "check slider_crank",
        2,
        "`slider_crank` is a name, and this takes the file of a description, such as \
         `./slider_crank.mech`",
    ),
    (
        "Watch",
        "watch missing/x.mech",
        1,
        "can't watch missing/x.mech: there is no folder missing",
    ),
    (
        "Compile",
        "cache",
        1,
        "there is no folder for compiled descriptions; name one with XDG_CACHE_HOME",
    ),
    (
        "Exists",
        "new crane",
        1,
        "crane is there already, and nothing in it was changed; choose another name",
    ),
    (
        "Name",
        "new Crane",
        2,
        "a crate can't be called `Crane`: it begins with a lower-case letter and goes on with these, \
         digits, `-` and `_`",
    ),
    (
        "NameOfFile",
        "simulate broken",
        2,
        "there is no mechanism `broken` in the library; for the description here write its file, \
         `broken.mech`",
    ),
    (
        "NameOfFile",
        "simulate notes.txt",
        2,
        "there is no mechanism `notes.txt` in the library; for the description here write its \
         file, `./notes.txt`",
    ),
    (
        "Repeated",
        "workprecision slider_crank --methods dp5,rk4,dp5",
        2,
        "--methods has `dp5` twice; leave one out",
    ),
    (
        "UselessOption",
        "simulate double_pendulum --published",
        2,
        "a mechanism without constraints has no use for --published; leave it out",
    ),
    (
        "UselessOption",
        "simulate double_pendulum --stabilisation none",
        2,
        "a mechanism without constraints has no use for --stabilisation; leave it out",
    ),
    (
        "UselessOption",
        "watch broken.mech --checkpoint c.json",
        2,
        "`watch` has no use for --checkpoint; a checkpoint belongs to the text of the file, which \
         changes: say `bricard simulate` with --checkpoint",
    ),
    (
        "UselessOption",
        "watch broken.mech --resume c.json",
        2,
        "`watch` has no use for --resume; a checkpoint belongs to the text of the file, which \
         changes: say `bricard simulate` with --resume",
    ),
    (
        "Read",
        "simulate ./broken",
        1,
        "could not read ./broken: …; did you mean `./broken.mech`?",
    ),
    (
        "InvalidSetting",
        "simulate slider_crank --set g=1.62",
        2,
        "`--set g=…`: it is a constant, which is a number in the code; where the description says \
         `const g`, write `param g`",
    ),
    (
        "InvalidSetting",
        "simulate slider_crank --set der(q1)=1",
        2,
        "`--set der(q1)=…`: it is a part of the state; write `--start der(q1)=…` for where it \
         begins",
    ),
    (
        "SetInstead",
        "simulate slider_crank --start m1=2",
        2,
        "`--start m1=…`: it is a parameter or an input; write `--set m1=…`",
    ),
    (
        "NoColumn",
        "simulate slider_crank --columns inputs",
        2,
        "`inputs` stands for all inputs, and there are none",
    ),
    (
        "Runs",
        "workprecision slider_crank --set L1=0.4,0.5",
        2,
        "workprecision measures one mechanism from one start, and `--set L1` asks for 2; give it \
         one value",
    ),
    (
        "FileKind",
        "workprecision slider_crank --out work.jpg",
        2,
        "work.jpg can't be written: the diagram is SVG, PNG or PDF; write `--out work.svg`, `--out \
         work.png` or `--out work.pdf`",
    ),
    (
        "FileKind",
        "workprecision slider_crank --csv work.xlsx",
        2,
        "work.xlsx can't be written: the numbers are written as CSV; write `--csv work.csv`",
    ),
    (
        "NoColumn",
        "simulate slider_crank --columns q1",
        2,
        "`q1` is in every row; `--columns` adds others",
    ),
    (
        "OutOfRange",
        "simulate slider_crank --rtol 2",
        2,
        "--rtol must be less than 1, as the part of a value that may be wrong, not 2",
    ),
    (
        "Runs",
        "simulate slider_crank --set L1=0.4,0.5 --plot run.html --live",
        2,
        "--live moves one run, and `--set L1` asks for 2; give it one value, which a slider \
         changes, or compare the runs without --live",
    ),
    (
        "Runs",
        "simulate slider_crank --set L1=0.4,0.5 --out run.csv --checkpoint c.json",
        2,
        "--checkpoint is of one run, and `--set L1` asks for 2; give it one value",
    ),
    (
        "Runs",
        "simulate slider_crank --set L1=1,2,3,4,5,6,7,8 --plot run.svg",
        2,
        "a picture has colours for seven runs, and `--set L1` asks for 8; give it fewer values, \
         or write the rows by --out alone",
    ),
    (
        "UselessOption",
        "simulate slider_crank --plot run.svg --live",
        2,
        "a plot that is no page has no use for --live; write `--plot run.html`",
    ),
    (
        "UselessOption",
        "simulate slider_crank --width 88mm",
        2,
        "a run without a picture has no use for --width; add `--plot run.pdf`",
    ),
    (
        "UselessOption",
        "simulate slider_crank --width 88mm --film run.gif",
        2,
        "what moves has no use for --width; write `--plot run.pdf` or `--film run.pdf`, or \
         another name in .svg or .png",
    ),
    (
        "FileKind",
        "simulate slider_crank --out run.xlsx",
        2,
        "run.xlsx can't be written: rows are written as CSV or as Parquet; write `--out run.csv` \
         or `--out run.parquet`",
    ),
    (
        "FileKind",
        "simulate slider_crank --plot run.txt",
        2,
        "run.txt can't be written: plots are pages, SVG, PNG or PDF; write `--plot run.html`, \
         `--plot run.svg`, `--plot run.png` or `--plot run.pdf`",
    ),
    (
        "FileKind",
        "simulate slider_crank --plot run.html --phase q1,q2",
        2,
        "run.html can't be written: one quantity over another is drawn as SVG, PNG or PDF; write \
         `--plot run.svg`",
    ),
    (
        "SameFile",
        "simulate slider_crank --json",
        2,
        "--json and --out can't both be written to standard output; write the rows to a file, such \
         as `--out run.csv`",
    ),
    (
        "Name",
        "new crane__1",
        2,
        "a crate can't be called `crane__1`: `-` and `_` stand alone and between letters",
    ),
    (
        "Name",
        "new match",
        2,
        "a crate can't be called `match`: it means something in Rust or to cargo",
    ),
    ("Said", "check --json broken.mech", 1, ""),
    ("Said", "check --json missing.mech", 1, ""),
];

/// What is said of Parquet files.
pub const PARQUET: Case = (
    "FileKind",
    "simulate slider_crank --out run.parquet --checkpoint c.json",
    2,
    "run.parquet can't be written: rows can't be added to Parquet after a checkpoint; write \
     `--out run.csv`",
);

/// What is said of Parquet files by a command that was built without them.
pub const WITHOUT_PARQUET: Case = (
    "FileKind",
    "simulate slider_crank --out run.parquet",
    2,
    "run.parquet can't be written: this bricard was built without Parquet; write `--out run.csv`, \
     or build it with its default features",
);
