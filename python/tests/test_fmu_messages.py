"""What an FMU writes into the log of a simulator that calls it wrongly, on the page of messages.

Said have to be the sentences of the sources in C, each brought about by a call.
"""

import ctypes
import os
import re
import zipfile
from ctypes import CFUNCTYPE, byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p

import pytest
from conftest import ROOT, command
from test_fmi import chain
from test_messages import hold, is_in, prose

SOURCES = ROOT / "cli/export/fmi"

INTRODUCTION = """\
An FMU writes these into the log of a simulator that calls it wrongly, of the category \
`logStatusError`; the call returns `Error`, and others but resetting and freeing are refused \
until the instance is reset. Calls stand here without `fmi2` or `fmi3`. The messages of the \
[C interface](#the-c-interface) are written there, too: they say what is wrong with a value, \
a start or a motion.
"""

#: A sentence that nothing brings about.
NEVER = "there is no memory for the state"

#: Tells what is called, too early or in vain.
OUT_OF_ORDER = "%s can't be called now%s"
FAILED_BEFORE = ": an earlier call has failed; reset the instance"

LOG3 = CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p)
LOG2 = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p, c_char_p)


class Callbacks(ctypes.Structure):
    """`fmi2CallbackFunctions`."""

    _fields_ = [("log", LOG2), *((name, c_void_p) for name in ("give", "free", "end", "host"))]


class Fmu:
    """The library of an FMU, with the log of its simulator."""

    def __init__(self, path, version):
        at = path.with_suffix("")
        with zipfile.ZipFile(path) as archive:
            archive.extractall(at)
        text = (at / "modelDescription.xml").read_text(encoding="utf-8")
        self.variables = variables(text)
        self.token = re.search(r'(?:instantiationToken|guid)="([^"]*)"', text)[1].encode()
        self.library = ctypes.CDLL(str(next(at.glob("binaries/*/*"))))
        self.version = version
        self.log = []
        self.listeners = LOG3(self.heard3), LOG2(self.heard2)
        self.callbacks = Callbacks(self.listeners[1])

    def heard3(self, _host, _status, category, message):
        assert category == b"logStatusError"
        self.log.append(message.decode())

    def heard2(self, _host, _name, _status, category, form, message):
        assert (category, form) == (b"logStatusError", b"%s")
        self.log.append(message.decode())

    def call(self, name, *arguments):
        function = getattr(self.library, f"fmi{self.version}{name}")
        return function(*arguments)

    def made(self, kind, token=None, event_mode=0, between=0):
        """An instance for model exchange (0), co-simulation (1) or scheduled execution (2)."""
        name, token = b"one", token or self.token
        if self.version == 2:
            function = self.library.fmi2Instantiate
            rest = [kind, token, None, byref(self.callbacks), 0, 0]
        else:
            kinds = "ModelExchange", "CoSimulation", "ScheduledExecution"
            function = getattr(self.library, f"fmi3Instantiate{kinds[kind]}")
            modes = [event_mode, 0, (c_uint * 1)(), c_size_t(between)] if kind == 1 else []
            behind = [[], [None], [None, None, None]][kind]
            rest = [token, None, 0, 0, *modes, None, self.listeners[0], *behind]
        function.restype = c_void_p
        instance = function(name, *rest)
        return c_void_p(instance) if instance else None

    def begun(self, kind):
        """An instance whose motion has begun."""
        x = self.made(kind)
        self.begin(x)
        return x

    def begin(self, x, stop=None):
        """Begins the motion of an instance, which may have to end at a time."""
        experiment = 0, c_double(), c_double(), stop is not None, c_double(stop or 0.0)
        if self.version == 2:
            assert self.call("SetupExperiment", x, *experiment) == 0
            assert self.call("EnterInitializationMode", x) == 0
        else:
            assert self.call("EnterInitializationMode", x, *experiment) == 0
        assert self.call("ExitInitializationMode", x) == 0


def variables(description):
    """The value references by name."""
    form = r'<(?:ScalarVariable|Float64)\s+name="([^"]*)"\s+valueReference="(\d+)"'
    return {name: int(reference) for name, reference in re.findall(form, description)}


def one(of, number=0):
    return (of * 1)(number)


#: No variable has this value reference.
NOTHING, SIZE = 10_000, c_size_t(1)


def values(fmu, x, what, reference, number=1.0):
    """Reads or writes one number."""
    length = [SIZE] if fmu.version == 3 else []
    name = f"{what}{'Float64' if fmu.version == 3 else 'Real'}"
    return fmu.call(name, x, one(c_uint, reference), SIZE, one(c_double, number), *length)


def integers(fmu, x):
    if fmu.version == 3:
        return fmu.call("GetInt32", x, one(c_uint), SIZE, one(c_int), SIZE)
    return fmu.call("GetInteger", x, one(c_uint), SIZE, one(c_int))


def directional(fmu, x, unknown, known):
    seed, result = one(c_double, 1.0), one(c_double)
    sizes = [SIZE, SIZE] if fmu.version == 3 else [None, None]
    arguments = [one(c_uint, unknown), SIZE, one(c_uint, known), SIZE, seed, sizes[0], result]
    arguments = [a for a in [*arguments, sizes[1]] if a is not None]
    return fmu.call("GetDirectionalDerivative", x, *arguments)


def step(fmu, x, t, length):
    out = [one(c_int) for _ in range(3)] + [one(c_double)] if fmu.version == 3 else []
    return fmu.call("DoStep", x, c_double(t), c_double(length), 1, *out)


def step_beyond_the_end(fmu, x):
    fmu.begin(x, stop=0.15)
    assert step(fmu, x, 0.0, 0.1) == 0
    return step(fmu, x, 0.1, 0.1)


def state_call(fmu, x, what, *more):
    return fmu.call(
        f"{what.replace('State', 'FMUState', 1)}"
        if fmu.version == 3
        else what.replace("State", "FMUstate", 1),
        x,
        *more,
    )


def serialized(fmu, x):
    name = "SerializeFMUState" if fmu.version == 3 else "SerializeFMUstate"
    return fmu.call(name, x, None, one(ctypes.c_byte), SIZE)


def deserialized(fmu, x):
    name = "DeserializeFMUState" if fmu.version == 3 else "DeSerializeFMUstate"
    return fmu.call(name, x, one(ctypes.c_byte), SIZE, byref(c_void_p()))


def lacking(name, *arguments):
    return lambda fmu, x: fmu.call(name, x, *arguments)


#: Calls in both versions: in words, the kind of instance, whether its motion has begun.
CALLS = [
    ("`DoStep` before the motion begins", 1, False, lambda f, x: step(f, x, 0.0, 0.1)),
    ("a value reference that no variable has", 1, True, lambda f, x: values(f, x, "Get", NOTHING)),
    ("to set a coordinate", 1, True, lambda f, x: values(f, x, "Set", 0)),
    (
        "to set a parameter after the beginning",
        1,
        True,
        lambda f, x: values(f, x, "Set", parameter(f)),
    ),
    ("to read an integer", 1, True, integers),
    ("a derivative by a parameter", 0, True, lambda f, x: directional(f, x, 0, parameter(f))),
    ("the derivative of a parameter", 0, True, lambda f, x: directional(f, x, parameter(f), 0)),
    (
        "`SetContinuousStates` of one number",
        0,
        True,
        lambda f, x: f.call("SetContinuousStates", x, one(c_double), SIZE),
    ),
    ("`DoStep` from another time", 1, True, lambda f, x: step(f, x, 0.5, 0.1)),
    ("`DoStep` beyond the stop time of the experiment", 1, False, step_beyond_the_end),
    ("to take over the state NULL", 1, True, lambda f, x: state_call(f, x, "SetState", None)),
    ("to keep a state at NULL", 1, True, lambda f, x: state_call(f, x, "GetState", None)),
    ("to write down a state that isn't there", 1, True, serialized),
    ("to read one byte as a state", 1, True, deserialized),
]

#: Calls that one version has.
OF_VERSION = {
    2: [
        ("`CancelStep`", 1, True, lacking("CancelStep")),
        ("`SetRealInputDerivatives`", 1, True,
         lacking("SetRealInputDerivatives", None, SIZE, None, None)),
        ("`GetRealOutputDerivatives`", 1, True,
         lacking("GetRealOutputDerivatives", None, SIZE, None, None)),
    ],
    3: [
        ("`GetNumberOfVariableDependencies`", 0, True,
         lacking("GetNumberOfVariableDependencies", c_uint(0), None)),
        ("`GetAdjointDerivative`", 0, True,
         lacking("GetAdjointDerivative", None, SIZE, None, SIZE, None, SIZE, None, SIZE)),
        ("`EnterConfigurationMode`", 1, False, lacking("EnterConfigurationMode")),
        ("`GetShiftDecimal`", 1, False, lacking("GetShiftDecimal", None, SIZE, None)),
        ("`EnterStepMode`", 1, True, lacking("EnterStepMode")),
        ("`GetOutputDerivatives`", 1, True,
         lacking("GetOutputDerivatives", None, SIZE, None, None, SIZE)),
    ],
}  # fmt: skip


def parameter(fmu):
    return fmu.variables["L"]


def sentences():
    """The texts in the sources that are sentences."""
    found = set()
    for path in sorted(SOURCES.glob("*.c")):
        source = re.sub(r"/\*.*?\*/", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        found |= {text for text in re.findall(r'"([^"\n]*)"', source) if len(text.split()) > 2}
    return found - {OUT_OF_ORDER, FAILED_BEFORE}


def said(fmu, tell):
    """What each call writes into the log."""
    for how, kind, has_begun, act in CALLS + OF_VERSION[fmu.version]:
        x = (fmu.begun if has_begun else fmu.made)(kind)
        fmu.log.clear()
        assert act(fmu, x) == 3, how
        assert len(fmu.log) == 1, (how, fmu.log)
        tell(how, fmu.log[0])
        assert step(fmu, x, 0.0, 0.1) == 3
        assert fmu.log[1].endswith(FAILED_BEFORE)
        assert fmu.call("Reset", x) == 0
        fmu.call("FreeInstance", x)
    fmu.log.clear()
    refused = [("to instantiate another mechanism", fmu.made(1, token=b"another"))]
    if fmu.version == 3:
        refused += [
            ("`InstantiateCoSimulation` with event mode", fmu.made(1, event_mode=1)),
            ("`InstantiateCoSimulation` with intermediate variables", fmu.made(1, between=1)),
            ("`InstantiateScheduledExecution`", fmu.made(2)),
        ]
    assert len(refused) == len(fmu.log)
    for (how, instance), message in zip(refused, fmu.log):
        assert instance is None
        tell(how, message.replace(fmu.token.decode(), "…"))


def exported(folder, description, version):
    path = folder / f"fmi{version}" / f"{description.stem}.fmu"
    path.parent.mkdir(exist_ok=True)
    command("export", str(description), "--to", f"fmi{version}", "--out", str(path))
    return Fmu(path, version)


@pytest.mark.skipif(os.name != "posix", reason="the page is written where C's names are POSIX's")
def test_every_line_of_an_fmu_s_log_is_on_the_page_of_messages(tmp_path):
    rows = {}
    for version in (2, 3):
        fmu = exported(tmp_path, ROOT / "tests/embedding/engine.mech", version)

        def tell(how, message, version=version):
            how, versions = rows.setdefault(message.replace(f"fmi{version}", ""), (how, []))
            if version not in versions:
                versions.append(version)

        said(fmu, tell)
    large = tmp_path / "large.mech"
    large.write_text(chain(4), encoding="utf-8")
    fmu = exported(tmp_path, large, 3)
    x = fmu.begun(0)
    assert directional(fmu, x, 0, 1) == 3
    rows[fmu.log[0]] = ("`GetDirectionalDerivative` of a chain of four links in space", [2, 3])

    silent = [
        text
        for text in sentences()
        if any(is_in([text], message) for message in rows) == (text == NEVER)
    ]
    assert silent == [], "never said, or said after all"
    head = ["| message | FMI | brought about by |", "|---|---|---|"]
    table = [
        f"| {prose(message)} | {', '.join(map(str, versions))} | {how} |"
        for message, (how, versions) in rows.items()
    ]
    hold("FMUs", INTRODUCTION + "\n" + "\n".join(head + table))
