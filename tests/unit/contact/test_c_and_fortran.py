"""What C and Fortran compute with carom's library is what Python computes with `carom.contact`."""

import io
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import twins

ROOT = Path(__file__).parents[3]
CRATE = ROOT / "crates" / "carom-c"
PREFIX = Path(os.environ.get("CAROM_C_PREFIX", ROOT / "target" / "c"))
STRICT = {
    "c": ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O1"],
    "f90": ["-std=f2018", "-Wall", "-Werror", "-O1"],
}


def tool(*names):
    """The first of several programs that there is, or skip with the reason."""
    found = next((path for name in names if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip(f"there is no {' nor '.join(names)} here")
    return found


@pytest.fixture
def library():
    """Where `make c` has laid out the library."""
    if not (PREFIX / "include" / "carom.h").exists():
        pytest.skip(f"there is no library at {PREFIX}; run make c")
    for name in ("carom.h", "carom.f90"):
        built, here = (folder / "include" / name for folder in (PREFIX, CRATE))
        if built.read_bytes() != here.read_bytes():
            pytest.skip(f"the library at {PREFIX} is older; run make c")
    return PREFIX


def run(program):
    """What a program of the library writes."""
    where = {**os.environ, "LD_LIBRARY_PATH": str(PREFIX / "lib")}
    done = subprocess.run([program], env=where, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return np.loadtxt(io.StringIO(done.stdout))


def made(command, folder):
    """Let a compiler do its work."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def expected():
    return {"bars": twins.bars(), "incline": twins.incline()}


@pytest.mark.parametrize("example", ["bars", "incline"])
@pytest.mark.parametrize("language", ["c", "f90"])
def test_examples_give_what_python_gives(library, expected, tmp_path, example, language):
    compiler = tool("cc", "gcc", "clang") if language == "c" else tool("gfortran")
    program = tmp_path / example
    sources = [CRATE / "examples" / f"{example}.{language}"]
    if language == "f90":
        sources.insert(0, library / "include" / "carom.f90")
    command = [compiler, *STRICT[language], f"-I{library / 'include'}", *sources, "-o", program]
    made([*command, f"-L{library / 'lib'}", "-lcarom", "-lm"], tmp_path)
    time, energies = expected[example][:, 0], expected[example][:, 1:5]
    rows = run(program)
    assert np.array_equal(rows[:, 0], time)
    # Measured: 1e-13 of the largest energy.
    assert np.abs(rows[:, 1:5] - energies).max() < 1e-12 * np.abs(energies).max()
    assert np.abs(rows[:, 5:] - expected[example][:, 5:]).max(initial=0.0) < 1e-12


def test_pkg_config_says_how_to_build(library, tmp_path):
    where = {**os.environ, "PKG_CONFIG_PATH": str(library / "lib" / "pkgconfig")}
    ask = [tool("pkg-config"), "--cflags", "--libs", "carom"]
    flags = subprocess.run(ask, env=where, capture_output=True, text=True, check=True).stdout
    program = tmp_path / "bars"
    source = CRATE / "examples" / "bars.c"
    made([tool("cc", "gcc", "clang"), source, *flags.split(), "-lm", "-o", program], tmp_path)
    assert run(program).shape == (12, 4)


def test_cmake_finds_the_library(library, tmp_path):
    cmake = tool("cmake")
    tool("cc", "gcc", "clang")
    has_fortran = shutil.which("gfortran") is not None
    lines = [
        "cmake_minimum_required(VERSION 3.16)",
        f"project(user LANGUAGES C {'Fortran' if has_fortran else ''})",
        "find_package(carom 0.1 REQUIRED)",
        f"add_executable(shared {CRATE / 'examples' / 'bars.c'})",
        "target_link_libraries(shared PRIVATE carom::carom m)",
        f"add_executable(static {CRATE / 'examples' / 'bars.c'})",
        "target_link_libraries(static PRIVATE carom::static)",
    ]
    if has_fortran:
        example = CRATE / "examples" / "bars.f90"
        lines.append(f"add_executable(fortran ${{carom_FORTRAN_MODULE}} {example})")
        lines.append("target_link_libraries(fortran PRIVATE carom::carom)")
    (tmp_path / "CMakeLists.txt").write_text("\n".join(lines), encoding="utf-8")
    made([cmake, f"-DCMAKE_PREFIX_PATH={library}", "-B", "build", "."], tmp_path)
    made([cmake, "--build", "build"], tmp_path)
    rows = run(tmp_path / "build" / "shared")
    for name in ("static", *["fortran"] * has_fortran):
        assert np.abs(run(tmp_path / "build" / name) - rows).max() < 1e-14


def test_another_version_is_not_found(library, tmp_path):
    cmake = tool("cmake")
    text = "cmake_minimum_required(VERSION 3.16)\nproject(user NONE)\nfind_package(carom 0.2)\n"
    (tmp_path / "CMakeLists.txt").write_text(text, encoding="utf-8")
    command = [cmake, f"-DCMAKE_PREFIX_PATH={library}", "-B", "build", "."]
    said = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stderr
    assert "not accepted" in said or "compatible" in said, said


def test_cpp_takes_the_header(library, tmp_path):
    source = tmp_path / "user.cpp"
    source.write_text(
        "#include <carom.h>\nint main() { return carom_version()[0] == '0' ? 0 : 1; }\n",
        encoding="utf-8",
    )
    program = tmp_path / "user"
    flags = ["-Wall", "-Wextra", "-pedantic", "-Werror", f"-I{library / 'include'}"]
    compiler = tool("c++", "g++", "clang++")
    made([compiler, *flags, source, f"-L{library / 'lib'}", "-lcarom", "-o", program], tmp_path)
    where = {**os.environ, "LD_LIBRARY_PATH": str(library / "lib")}
    assert subprocess.run([program], env=where, check=False).returncode == 0


def test_fortran_knows_every_function_of_the_header():
    header = (CRATE / "include" / "carom.h").read_text(encoding="utf-8")
    module = (CRATE / "include" / "carom.f90").read_text(encoding="utf-8")
    functions = set(re.findall(r"\b(carom_\w+)\(", re.sub(r"/\*.*?\*/", "", header, flags=re.S)))
    known = set(re.findall(r"^    (?:function|subroutine) (carom_\w+)\(", module, re.MULTILINE))
    assert len(functions) > 40
    assert functions == known - {"carom_solver"}
