"""The ctypes declarations against the header, name by name and size by size."""

import ctypes
import re
import shutil
import subprocess

import pytest
from conftest import ROOT

from bricard import _abi

HEADER = (ROOT / "capi/include/bricard.h").read_text(encoding="utf-8")


def body(name: str) -> str:
    """The members of a structure of the header, without comments."""
    text = re.search(rf"typedef struct {name} {{(.*?)}} {name};", HEADER, re.S).group(1)
    return re.sub(r"/\*.*?\*/", "", text, flags=re.S)


def members(name: str) -> list:
    """Their names, in order."""
    found = []
    for member in body(name).split(";"):
        function = re.search(r"\(\*(\w+)\)", member)
        if function:
            found.append(function.group(1))
        elif member.strip():
            found += re.findall(r"(\w+)(?=\s*(?:,|$))", member.strip())
    return found


@pytest.mark.parametrize(
    "name, declared",
    [
        ("bricard_point", _abi.Point),
        ("bricard_options", _abi.Options),
        ("bricard_watch", _abi.Watch),
        ("bricard_summary", _abi.Summary),
        ("bricard_interface", _abi.Interface),
    ],
)
def test_structures_have_the_members_of_the_header(name, declared):
    assert [field[0] for field in declared._fields_] == members(name)


def test_functions_have_as_many_arguments_as_in_the_header():
    text = re.sub(r"\s+", " ", body("bricard_interface"))
    for name, kind in _abi.Interface._fields_[1:]:
        arguments = re.search(rf"\(\*{name}\)\((.*?)\);?", text).group(1)
        assert len(kind._argtypes_) == len(arguments.split(",")), name


def test_constants_are_those_of_the_header():
    for name, value in re.findall(r"BRICARD_(\w+) = (-?\d+)", HEADER):
        ours = getattr(_abi, name.removeprefix("ERROR_"), None)
        if name != "ERROR_ABI" and isinstance(ours, int):
            assert ours == int(value), name
    assert f"#define BRICARD_ABI {_abi.ABI}u" in HEADER


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_sizes_are_those_of_c(tmp_path):
    program = tmp_path / "sizes.c"
    names = ["point", "options", "watch", "summary", "interface"]
    sizes = ", ".join(f"(unsigned)sizeof(bricard_{name})" for name in names)
    program.write_text(
        '#include "bricard.h"\n#include <stdio.h>\n'
        f'int main(void) {{ printf("%u %u %u %u %u", {sizes}); return 0; }}\n'
    )
    command = ["cc", program, f"-I{ROOT}/capi/include", "-o", tmp_path / "sizes"]
    subprocess.run(command, check=True)
    said = subprocess.run([tmp_path / "sizes"], capture_output=True, text=True, check=True)
    declared = [_abi.Point, _abi.Options, _abi.Watch, _abi.Summary, _abi.Interface]
    assert [int(size) for size in said.stdout.split()] == [ctypes.sizeof(x) for x in declared]
