"""What the package says where it refuses something, on the page of messages.

The page shows what is really said; with BRICARD_BLESS=1 it is written from that. Said have to
be the sentences of the package's own `raise` statements.
"""

import ast
import os
import re
from pathlib import Path

import pytest
from conftest import ENGINE, ROOT
from test_fmi import chain

import bricard
from bricard import _abi, _compile

PAGE = ROOT / "docs/messages.md"
SOURCES = ROOT / "python/bricard"

INTRODUCTION = """\
These are the messages of the package itself, about the engine of `tests/embedding`; `run` is \
`engine.simulate(until=1)`. In its exceptions stands, too, what the command says \
(`DescriptionError`, `CompileError`, `UnknownName` of a mechanism), and what the \
[C interface](#the-c-interface) and the [runtime](#starts-and-runs) say (`UnknownName`, \
`InvalidValue`, `AssemblyError`, `SimulationError`). `…` stands for what depends on the machine, and for the words of others.
"""

#: A sentence that nothing brings about: the library itself would have failed.
NEVER = "the mechanism could not be made"

#: What the interface says of a mechanism that is too large for its own tests.
TOO_LONG = "this mechanism has no derivatives: the code for them would be too long"

#: Calls, each of which is refused.
CALLS = [
    'bricard.Mechanism("slider_crank")',
    'engine.set(L="half")',
    "engine.set({1: 0.5})",
    'engine.mass_matrix("abc")',
    "engine.mass_matrix([1, 2])",
    "engine.rhs(0, [0, 0, 0])",
    "engine.drive({'torque': lambda t, q: 0.0})",
    "engine.simulate(until=1, method='rk5')",
    "engine.simulate(until=1, stabilisation=('baumgarte', 10))",
    "engine.simulate(until=1, step=0.01, rtol=1e-6)",
    "engine.simulate(until=1, step=0)",
    "engine.simulate(until=1, most_steps=0)",
    "engine.simulate(until=1, every=0)",
    "engine.simulate(until=1, every=1e-12)",
    "run['cronk']",
    "run.at(1.5)",
]


def named(path, monkeypatch):
    """Something of the library, by a command that the variable BRICARD names."""
    monkeypatch.setenv("BRICARD", str(path))
    return bricard.library.slider_crank


def started(path, monkeypatch):
    path.write_bytes(b"\0")
    path.chmod(0o755)
    return named(path, monkeypatch)


def loaded(path, content):
    path.write_bytes(content)
    return bricard.Mechanism.from_library(path)


def of_another_version(monkeypatch):
    monkeypatch.setattr(_abi, "ABI", _abi.ABI + 1)
    return bricard.Mechanism.from_text(ENGINE)


#: What takes more than a call: in words, and in Python.
CIRCUMSTANCES = [
    ("a call without the command", lambda at, patch: named(at / "none", patch)),
    ("BRICARD names a file that is no program", lambda at, patch: started(at / "none", patch)),
    ("BRICARD names `/bin/false`", lambda at, patch: named("/bin/false", patch)),
    (
        "`from_library` of a text",
        lambda at, patch: loaded(at / "libbricard_engine.so", b"no library"),
    ),
    (
        "`from_library` of an engine that was renamed",
        lambda at, patch: loaded(
            at / "libbricard_motor.so",
            _compile.compiled(str(ROOT / "tests/embedding/engine.mech")).read_bytes(),
        ),
    ),
    (
        "a library that another version of bricard has made",
        lambda at, patch: of_another_version(patch),
    ),
    (
        "`slopes` of a chain of four links in space",
        lambda at, patch: bricard.Mechanism.from_text(chain(4)).slopes([0.1] * 8, [0.0] * 8),
    ),
]


def sentences():
    """The texts of `raise` statements, as patterns."""
    found = []
    for path in sorted(SOURCES.glob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        constants = {
            node.targets[0].id: node.value
            for node in tree.body
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
        }
        for statement in ast.walk(tree):
            if not (isinstance(statement, ast.Raise) and isinstance(statement.exc, ast.Call)):
                continue
            for argument in statement.exc.args:
                found += texts(constants.get(getattr(argument, "id", None), argument))
    return [pieces for pieces in found if len(" ".join(pieces).split()) > 2]


def texts(node):
    """The texts in an expression: what stands between their placeholders."""
    if isinstance(node, ast.JoinedStr):
        return [[part.value for part in node.values if isinstance(part, ast.Constant)]]
    if isinstance(node, ast.Constant):
        return [[node.value]] if isinstance(node.value, str) else []
    return [text for child in ast.iter_child_nodes(node) for text in texts(child)]


#: Behind these are the words of others.
QUOTING = r"(could not be loaded|could not be started|has to be numbers): .*"


def is_in(pieces, text):
    return re.search(".*".join(map(re.escape, pieces)), text, re.DOTALL) is not None


def prose(text):
    """A message in a cell: code stays as it is, no other sign means anything to Markdown."""
    parts = text.replace("\n", " ⏎ ").split("`")
    parts[::2] = [re.sub(r"([|*_<>\[\]\\~])", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


def refusal(act):
    with pytest.raises((bricard.BricardError, AttributeError)) as refused:
        act()
    return type(refused.value).__name__, str(refused.value)


def hold(heading, text):
    """Holds a section of the page against a text, or writes it there."""
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(f"\n## {heading}\n")
    end = rest.find("\n## ")
    after = rest[end:] if end >= 0 else ""
    wanted = f"{before}\n## {heading}\n\n{text.strip()}\n{after}"
    if "BRICARD_BLESS" in os.environ:
        PAGE.write_text(wanted, encoding="utf-8")
    else:
        assert page == wanted, "BRICARD_BLESS=1 rewrites it"


@pytest.mark.skipif(os.name != "posix", reason="the page shows what a POSIX system makes of it")
def test_every_refusal_is_on_the_page_of_messages(engine, tmp_path):
    known = {"bricard": bricard, "engine": engine, "run": engine.simulate(until=1)}
    said = [(f"`{call}`", refusal(lambda call=call: eval(call, known))) for call in CALLS]
    for number, (how, act) in enumerate(CIRCUMSTANCES):
        folder = tmp_path / str(number)
        folder.mkdir()
        with pytest.MonkeyPatch.context() as patch:
            kind, message = refusal(lambda: act(folder, patch))
        said.append((how, (kind, re.sub(r"\S*/(lib)?(bricard|mechanism)\S*", "…", message))))
    everything = "\n".join(message for _, (_, message) in said)
    silent = [p for p in sentences() if is_in(p, everything) == (p == [NEVER])]
    assert silent == [], "never said, or said after all"
    assert TOO_LONG in everything

    own = [(how, kind, re.sub(QUOTING, r"\1: …", message)) for how, (kind, message) in said]
    rows = [f"| {prose(message)} | `{kind}` | {how} |" for how, kind, message in own]
    table = "\n".join(["| message | exception | brought about by |", "|---|---|---|", *rows])
    hold("Python", f"{INTRODUCTION}\n{table}")
